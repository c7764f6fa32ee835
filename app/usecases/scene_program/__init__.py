"""A computed scene as an NC program: written, smoothed, cut out of its stock, and proven against the surfaces."""
