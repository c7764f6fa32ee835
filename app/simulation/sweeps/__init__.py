"""What motions sweep, and how a field is cut by it."""
