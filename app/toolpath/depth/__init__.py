"""Depth passes, and ways between them over ground that is cut."""
