"""Files that hold a solid, by their suffix."""

from __future__ import annotations

MESHES, STEPS = (".stl", ".obj", ".ply", ".3mf"), (".step", ".stp")
SOLIDS = (*MESHES, *STEPS)
"""Suffixes of files that hold a solid, in lower case."""


def is_solid(name: str) -> bool:
    """Return whether a file's name says that it holds a solid."""
    return name.lower().endswith(SOLIDS)
