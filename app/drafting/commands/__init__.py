"""What the commands of the shape language do."""
