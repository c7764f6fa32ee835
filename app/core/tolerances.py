"""Every length below which two things count as the same, in mm, each with its reason."""

LEVEL = 1e-3
"""A path's distance to the part may differ from its level by this much, both ways (1 um)."""

CURVE = 1e-3
"""Ellipses and splines become lines and arcs within this distance, checked both ways (1 um)."""

RIDGE = 1e-3
"""A ring is dropped when the field rises above its level by less than this (parallel walls at a level)."""

FIT = 4e-7
"""A tool passes where its radius is greater than half the gap by less than this, as nothing at all."""

NOMINAL = LEVEL / 2
"""A tool passes where its radius is greater than half the gap by less than this: as wide as the gap by its name, which
was drawn with the digits that drawings have. Its path is the middle line of the gap, and still measures right to 1
um.
"""

WELD = 1e-6
"""Ends closer than this are one point; curves shorter than this are no curves (0.01 of an NC digit)."""

JOIN = 0.01
"""Default distance at which loose ends of a drawing are joined."""
