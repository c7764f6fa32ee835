"""What of a tool does not cut: shank and holder."""
