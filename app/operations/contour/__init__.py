"""Contours: the tool follows walls."""
