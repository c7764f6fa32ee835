"""Drawings on paper: the preview, what is asked of it, and the way to files and printers."""
