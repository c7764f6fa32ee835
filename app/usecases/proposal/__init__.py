"""What is to be done with a drawing, proposed from how its curves lie in one another."""
