"""The page that the window begins with: the last files, samples, and what a new part is to be."""
