"""The kinds of operation that come with the program: importing this registers them."""

from __future__ import annotations

from . import adaptive, bore, chamfer, contour, countersink, drill, face, pocket, ream, rest, slot, tap, thread, vcarve

__all__ = [
    "adaptive",
    "bore",
    "chamfer",
    "contour",
    "countersink",
    "drill",
    "face",
    "pocket",
    "ream",
    "rest",
    "slot",
    "tap",
    "thread",
    "vcarve",
]
