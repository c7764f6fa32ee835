"""What is proven of single operations on the written text, as it was read back."""
