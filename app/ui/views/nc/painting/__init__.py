"""What the NC view paints: motions, their key, lines of text."""
