"""Milling simulation by dexels: a field of heights, cut exactly by the sweep of each move."""
