"""The metal that a program is cut out of, where nobody gives it: by the program's comments, or round its cuts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import PurePath

import numpy as np
from numpy.typing import NDArray

from ...core.errors import InputError
from ...core.options import option
from ...gcode.interpreter.program import StockNote
from ...gcode.timing.extent import extent
from ...model.finding import Finding, FindingKind
from ...model.motion import Floats, MotionKind
from ...model.stock_box import StockBox
from ...simulation.field.solid import read_solid
from ...simulation.field.workpiece import MOST_CELLS, BoxStock, StockShape
from ...simulation.heights_file import read_heights
from ..examine import ExaminedProgram

FINEST = MOST_CELLS
"""Cells along a side of a grid, at most."""

_CORNERS = "X0,Y0,Z0,X1,Y1,Z1"
"""What a box of stock is typed as: its lower left corner at the bottom, its upper right one at the top, mm."""


@dataclass(frozen=True, slots=True)
class KnownStock:
    """The metal, and who tells of it.

    Attributes:
        source: in words, such as "--stock".
        assumed: what of it was not told; None = nothing.
    """

    stock: StockShape
    source: str
    assumed: Finding | None = None


def box_stock(corners: Sequence[float]) -> StockShape:
    """Return a box of metal.

    Args:
        corners: x0, y0, z0, x1, y1, z1, mm.

    Raises:
        ParameterError: one of its sides is not longer than 0.
    """
    return BoxStock(StockBox(*corners))


def read_stock(name: str, data: bytes, beside: bytes) -> StockShape:
    """Return the metal that a file describes.

    Args:
        name: of the file: a solid, .stl, or heights, .npy.
        data: its bytes. beside: of heights the JSON file beside it.

    Raises:
        InputError: it cannot be used.
    """
    return read_heights(name, data, beside) if PurePath(name).suffix.lower() == ".npy" else read_solid(name, data)


def cut_box(programs: tuple[ExaminedProgram, ...]) -> Floats:
    """Return (2, 3) lower and upper corner of the motions at feed rate of all programs, mm; NaN along an axis that none
    moves.
    """
    boxes = [extent(each.program, each.program.motions.kind != MotionKind.RAPID) for each in programs]
    low, high = (np.array([getattr(box, end) for box in boxes]) for end in ("low", "high"))
    return np.array([np.fmin.reduce(low), np.fmax.reduce(high)])


def stock_from_comments(programs: tuple[ExaminedProgram, ...], radius: float, part: Floats | None = None) -> KnownStock:
    """Return the stock that comments tell of, or else a box round the cuts, and round the part.

    Args:
        programs: in the order of cutting; the first one that tells is believed.
        radius: of the largest cutter, mm.
        part: (2, 3) lower and upper corner of what is to come out; None = nobody has said.

    Raises:
        InputError: neither gives a box.
    """
    cuts = cut_box(programs)
    around = _round(cuts, radius) if part is None else _with_part(_round(cuts, radius), part)
    for examined in programs:
        note = examined.program.stock
        if note is not None:
            return _noted(note, examined.name, cuts, around)
    if not np.all(around[1] > around[0]):
        raise _nothing(programs[0].name)
    what = "the cuts" if part is None else "the cuts and the part"
    text = f"The stock is not told; a box round {what} is assumed, {_words(*around)}; {_hint()}."
    return KnownStock(BoxStock(_box(*around)), f"round {what}", Finding(FindingKind.ASSUMED, text, counts=False))


def _noted(note: StockNote, name: str, cuts: Floats, around: Floats) -> KnownStock:
    """Return the box of a comment; what it leaves open is as the cuts suggest."""
    source = f"the comment in line {note.line}"
    low, high, size = (np.array(values) for values in (note.low, note.high, note.size))
    if np.isfinite([low, high]).all():
        return KnownStock(BoxStock(_box(low, high)), source)
    sized = np.isnan(low) & np.isfinite(size)
    low, words = _placed(low, size, cuts, sized)
    high = np.where(sized, low + size, high)
    if np.isnan([low, high]).any():
        low, high = np.where(np.isnan(low), around[0], low), np.where(np.isnan(high), around[1], high)
        words.append("where it tells nothing, round the cuts")
    if not np.all(high > low):
        raise _nothing(name)
    text = (
        f"The {source.removeprefix('the ')} tells the stock but not where it lies: {', '.join(words)}, so "
        f"{_words(low, high)}; {_hint()}."
    )
    return KnownStock(BoxStock(_box(low, high)), source, Finding(FindingKind.ASSUMED, text, counts=False))


def _placed(low: Floats, size: Floats, cuts: Floats, sized: NDArray[np.bool_]) -> tuple[Floats, list[str]]:
    """Return the lower corner where only a size is told: where the cuts stick out least, and the top at Z 0 if they go
    below it.
    """
    low, words = low.copy(), []
    flat = [k for k in (0, 1) if sized[k]]
    if flat:
        centre = _beyond(-size / 2, size, cuts, flat) < _beyond(np.zeros(3), size, cuts, flat)
        low[flat] = -size[flat] / 2 if centre else 0.0
        words.append(f"{'centre' if centre else 'lower left'} at X 0, Y 0")
    if sized[2]:
        bottom = bool(cuts[0, 2] >= 0)
        low[2] = 0.0 if bottom else -size[2]
        words.append(f"{'bottom' if bottom else 'top'} at Z 0")
    return low, words


def _beyond(low: Floats, size: Floats, cuts: Floats, axes: list[int]) -> float:
    """Return how far the cuts stick out of a box along some axes, mm."""
    return float(np.nansum((np.fmax(low - cuts[0], 0.0) + np.fmax(cuts[1] - low - size, 0.0))[axes]))


def _round(cuts: Floats, radius: float) -> Floats:
    """Return the box round the cuts, wider by a radius; its top is Z 0 where the cuts go below it, else the highest of
    them.
    """
    wide = np.array([radius, radius, 0.0])
    box = np.array([cuts[0] - wide, cuts[1] + wide])
    box[1, 2] = 0.0 if box[0, 2] < 0 else box[1, 2]
    return box


def _with_part(box: Floats, part: Floats) -> Floats:
    """Return the box that holds another one and a part; its top is the part's."""
    low, high = np.fmin(box[0], part[0]), np.fmax(box[1], part[1])
    return np.array([low, [high[0], high[1], part[1, 2]]])


def _hint() -> str:
    """Return how another stock is given."""
    return f"{option('stock', _CORNERS)} gives another"


def _nothing(name: str) -> InputError:
    return InputError(
        f"{name}: the program does not tell the stock, and no box can be laid round its cuts, as they do not go down; "
        f"give it: {option('stock', _CORNERS)}."
    )


def _words(low: Floats, high: Floats) -> str:
    return ", ".join(f"{axis} {a:.3f} to {b:.3f}" for axis, a, b in zip("XYZ", low, high, strict=True)) + " mm"


def _box(low: Floats, high: Floats) -> StockBox:
    return StockBox(*low.tolist(), *high.tolist())
