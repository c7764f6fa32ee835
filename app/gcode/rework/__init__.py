"""Programs compared, begun in the middle, framed, written anew in parts."""
