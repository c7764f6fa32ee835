"""Rings and runs become strokes: bridges, trees, chains."""
