"""The middle of the window, one folder a view."""
