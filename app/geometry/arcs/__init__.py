"""Free curves as lines and arcs, within a stated distance."""
