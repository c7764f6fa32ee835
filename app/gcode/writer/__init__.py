"""Moves become the text of a control."""
