"""From regions to moves: contour, pocket, links, depth passes."""
