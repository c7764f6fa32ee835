"""A 1986 session: the workstation of the text as its operator saw it."""
