"""Parallel passes over surfaces."""
