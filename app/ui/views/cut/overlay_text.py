"""Numbers and facts of the Cut view in words. No Qt."""

from __future__ import annotations

from ...framework.catalogue import tr
from .cell_picking import PickedCell


def number(value: float) -> str:
    """Return a length in mm with three decimals and a true minus."""
    return f"{round(value, 3) + 0.0:.3f}".replace("-", "\u2212")


def pitch_words(pitch: float) -> str:
    """Return the width of a cell: "98 µm", "2.4 µm"."""
    microns = 1000 * pitch
    return f"{microns:.0f} µm" if microns >= 9.95 else f"{microns:.1f} µm"


def facts_of(hit: PickedCell) -> str:
    """Return what there is to say about a cell: depth, tool and line that cut it, deviation."""
    picture, move = hit.picture, hit.move
    depth = picture.top - hit.height
    facts = [f"{number(depth)} deep" if depth > 5e-4 else "not cut"]
    if move >= 0 and picture.moves is not None and move < len(picture.moves.line):
        facts += [f"T{picture.moves.tool[move]}", f"line {picture.moves.line[move]}"]
    if picture.deviation is not None:
        off = float(picture.deviation[hit.row, hit.column])
        if abs(off) > picture.tolerance:
            facts.append(f"{number(abs(off))} {'left' if off > 0 else 'too deep'}")
    return " · ".join(map(tr, facts))


def place_of(hit: PickedCell) -> str:
    """Return the coordinates of a hit."""
    return "   ".join(f"{axis} {number(value)}" for axis, value in zip("XYZ", hit.place, strict=True))
