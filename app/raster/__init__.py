"""The display memory of 1986: frame, drawing, tracing, fill."""
