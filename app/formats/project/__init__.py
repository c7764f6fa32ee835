"""Project files, and what is kept for recovery."""
