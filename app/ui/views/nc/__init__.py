"""The NC view: a program's text, its path, and the way from each to the other."""
