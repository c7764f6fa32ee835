"""In which order strokes are cut."""
