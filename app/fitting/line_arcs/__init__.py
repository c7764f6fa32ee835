"""Points become as few lines and arcs as keep within a proven distance."""
