"""Bytes to model and back: DXF, job files, plots."""
