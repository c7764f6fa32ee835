"""How long a program runs, and whether a machine can hold it."""
