"""Paths of cutters over a compound surface, every chord proven."""
