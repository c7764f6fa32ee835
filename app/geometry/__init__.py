"""The plane: chaining, regions, exact offsets, distances."""
