"""What is wanted of a floor, and what paths leave of it."""
