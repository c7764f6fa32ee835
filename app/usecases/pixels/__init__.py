"""The 1986 way from a drawing or a picture to moves: on the pixels of a display memory alone."""
