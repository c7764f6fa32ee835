"""The window itself: bars, keys, help, files, and what connects its parts."""
