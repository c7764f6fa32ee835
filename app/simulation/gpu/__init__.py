"""Heights by graphics hardware: the depth buffer of 1999, and quads."""
