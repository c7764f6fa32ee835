"""One file a command: the whole way from bytes to bytes."""
