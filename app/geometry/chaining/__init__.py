"""Loose curves become contours; what does not meet, lies double or crosses is told."""
