"""The command line: one parser a command, one line for every error."""
