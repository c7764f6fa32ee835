"""Engraving: the cutter's centre on the drawn lines."""
