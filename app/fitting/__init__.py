"""Point sequences and free curves to lines and arcs within a proven distance."""
