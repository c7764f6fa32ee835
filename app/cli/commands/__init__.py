"""One file a command: its arguments, its work, its exit status."""
