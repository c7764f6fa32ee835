"""Pockets: the area cleared in rings."""
