"""What there is to know about each control."""
