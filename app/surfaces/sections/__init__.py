"""Surfaces cut by upright planes, and the topmost of what is cut."""
