"""What a line of the shape language is made of: words, numbers, units, points, expressions."""
