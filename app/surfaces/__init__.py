"""Compound curved surfaces: what they are made of, cut by planes, topped by an envelope, followed by cutters."""
