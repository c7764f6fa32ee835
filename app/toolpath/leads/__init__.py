"""Ways along a wall: where they begin, on which side, with which tabs."""
