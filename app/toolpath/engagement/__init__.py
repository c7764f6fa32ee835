"""How much of the cutter is in standing metal, and the feed that follows from it."""
