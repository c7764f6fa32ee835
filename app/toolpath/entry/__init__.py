"""Ways down into metal."""
