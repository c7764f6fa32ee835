"""The Stages view: the display memory of 1986 after every numbered step, and pictures as parts."""
