"""Hitofude: from a line drawing to tool paths that can be trusted on a real machine."""

__version__ = "0.1.0"
