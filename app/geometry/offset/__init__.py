"""Exact offsets of whole regions: lines and arcs in, lines and arcs out."""
