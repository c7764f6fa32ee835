"""What is proven of a program: gouges, what is left, rapids, plunges, holders, clearance."""
