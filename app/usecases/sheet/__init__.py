"""What the sheet of a set-up says of a program: of one that was made, and of any other."""
