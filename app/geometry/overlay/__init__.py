"""Regions and outlines laid over one another, without a crossing that is left."""
