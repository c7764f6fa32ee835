"""Program in, better program out: what a program of passes has cut becomes a smooth surface, and that a new program."""
