"""Surfaces as rational patches: how they are made, placed, trimmed and divided into facets."""
