"""Straight feed moves of a program as lines, arcs or splines, within a proven tolerance."""
