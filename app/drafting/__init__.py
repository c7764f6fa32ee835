"""Drawing commands and undo, without a window."""
