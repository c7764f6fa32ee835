"""What the Curves view paints over a program's path."""
