"""NC text: posts and writer."""
