"""Closed paths of points become circles, lines and arcs (steps 401-407)."""
