"""Sheets as HP-GL/2 for pen plotters and cutters: a pen a layer or tool, true circles and arcs, dashes by line type.

Plotter units are 0.025 mm; the origin is the paper's lower left corner.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from itertools import chain

import numpy as np
from numpy.typing import NDArray

from ...geometry.arcs.arcs import lines_and_arcs
from ...geometry.transform import Similarity, transformed
from ...model.curves import Arc, Circle, Curve, Line, Point
from .page import FilledPolygon, PageContent, Pen, PlotPage, TextLine

UNITS_PER_MM = 40
"""Steps of a plotter, as the language counts them."""
_TOLERANCE = 0.005
"""How far lines and arcs may leave an ellipse or a spline, mm: a fifth of a plotter unit."""
_LINE_TYPES = {1: (0.0, 1.0), 2: (0.5, 0.5), 3: (0.7, 0.3), 4: (0.8, 0.1, 0.0, 0.1), 5: (0.7, 0.1, 0.1, 0.1)}
"""The line types that plotters have: parts of a pattern's length by turns with the pen down and up; 0 is a dot."""

_POINTS_A_LINE = 100
"""Plotters of old take lines of some hundred letters."""
_END = "\x03"
_ANCHORS = {0.0: 1, 0.5: 4, 1.0: 7}
_LETTER = (0.6, 0.7)
"""Width and height of a plotter's capital letter, of the body of the text."""


def hpgl_bytes(pages: Iterable[PlotPage]) -> bytes:
    """Return all sheets as one HP-GL/2 file, parted by page advances; letters beyond ASCII become "?".

    Raises:
        GeometryError: an ellipse or a spline cannot be followed.
    """
    lines: list[str] = []
    for page in pages:
        lines += [*(["PG;"] if lines else []), *_page(page)]
    return "\n".join([*lines, "PU;SP0;", ""]).encode("ascii", "replace")


def _page(page: PlotPage) -> Iterator[str]:
    corner, far = _units((page.window[0], page.window[1])), _units((page.window[2], page.window[3]))
    yield f"IN;PS{round(page.height * UNITS_PER_MM)},{round(page.width * UNITS_PER_MM)};PA;"
    yield f"IW{corner},{far};"
    yield from _ink(page.drawing, page.place)
    yield "IW;"
    yield from _ink(page.frame, Similarity())


def _ink(ink: PageContent, place: Similarity) -> Iterator[str]:
    for trace in ink.traces:
        yield _pen(trace.pen) + _trace(trace.placed(place))
    for stroke in ink.strokes:
        yield _pen(stroke.pen)
        at: str | None = None
        for piece in chain.from_iterable(_simple(transformed(curve, place)) for curve in stroke.curves):
            text, at = _curve(piece, at)
            yield text
    for patch in ink.patches:
        yield _pen(patch.pen) + _patch(patch, place)
    for words in ink.words:
        yield _pen(words.pen) + _label(words, place)


def _pen(pen: Pen) -> str:
    dash = f"LT{_line_type(pen.dash)},{sum(pen.dash):g},1;" if pen.dash else "LT;"
    return f"PU;SP{pen.number};PW{pen.width:g};{dash}"


def _line_type(dash: tuple[float, ...]) -> int:
    """Return the number of the plotter's own line type that comes nearest to lengths of dash and gap."""
    return min(
        (number for number, parts in _LINE_TYPES.items() if len(parts) == len(dash)),
        key=lambda number: sum(
            abs(part - length / sum(dash)) for part, length in zip(_LINE_TYPES[number], dash, strict=True)
        ),
        default=2,
    )


def _trace(points: NDArray[np.float64]) -> str:
    """Return the words for a polyline; what falls on the same plotter unit is one point."""
    units = np.rint(points * UNITS_PER_MM).astype(np.int64)
    units = units[np.concatenate([[True], np.any(np.diff(units, axis=0) != 0, axis=1)])]
    places = [f"{x},{y}" for x, y in units.tolist()]
    parts = (",".join(places[at : at + _POINTS_A_LINE]) for at in range(1, len(places), _POINTS_A_LINE))
    return f"PU{places[0]};" + ("\n".join(f"PD{part};" for part in parts) or f"PD{places[0]};")


def _simple(curve: Curve) -> Iterator[Line | Arc | Circle]:
    if isinstance(curve, Line | Arc | Circle):
        yield curve
    else:
        yield from lines_and_arcs(curve, _TOLERANCE).primitives


def _curve(curve: Line | Arc | Circle, at: str | None) -> tuple[str, str | None]:
    """Return the words for a curve, and where the pen is then; None: somewhere else than a curve goes on from."""
    if isinstance(curve, Circle):
        return f"PU{_units(curve.centre)};CI{max(1, round(curve.radius * UNITS_PER_MM))};", None
    start, end = _units(curve.start), _units(curve.end)
    go = "" if start == at else f"PU{start};"
    if isinstance(curve, Line):
        return f"{go}PD{end};", end
    angle = math.degrees(curve.sweep)
    return f"{go}PD;AA{_units(curve.centre)},{angle:.4f};PD{end};", end


def _patch(patch: FilledPolygon, place: Similarity) -> str:
    corners = [_units(place(corner)) for corner in patch.corners]
    return f"PU{corners[0]};PD{','.join((*corners[1:], corners[0]))};"


def _label(words: TextLine, place: Similarity) -> str:
    at = place(words.at)
    c, s = math.cos(words.angle), math.sin(words.angle)
    foot = (at[0] - words.lift * s, at[1] + words.lift * c)
    wide, high = (words.height * part / 10 for part in _LETTER)
    text = "".join(letter for letter in words.text if letter >= " ")
    return f"PU{_units(foot)};SI{wide:.3f},{high:.3f};DI{c:.4f},{s:.4f};LO{_ANCHORS[words.anchor]};LB{text}{_END}"


def _units(point: Point) -> str:
    return f"{round(point[0] * UNITS_PER_MM)},{round(point[1] * UNITS_PER_MM)}"
