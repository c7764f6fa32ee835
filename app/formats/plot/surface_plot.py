"""Paths over a compound surface on paper, as they are generated: each surface's part told apart by colour or by line
type, with a legend, and labels of points where they find room.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...model.curves import Circle
from ...model.part import Units
from ...model.scene import LineType
from .content import INK, TOOL_COLOURS
from .page import Box, PageContent, Pen, PenStroke, TextLine, TracedPolyline, fitted

Floats = NDArray[np.float64]

PATH_MM, SURFACE_MM, MARK_MM = 0.3, 0.15, 0.7
"""Widths of the lines of paths and of the compound surface, radius of a boundary point's circle, mm on paper."""

LABEL_MM = 2.2
"""Height of the letters of labels, mm."""
DASHES = {LineType.SOLID: (), LineType.DOTTED: (0.05, 0.95), LineType.CHAIN: (6.0, 0.95, 0.05, 0.95)}
"""Dash and gap by turns, mm on paper. Dots are round ends with hardly a dash between: painters draw nothing where there
is none.
"""

_CYCLE = (LineType.SOLID, LineType.DOTTED, LineType.CHAIN)
_MARK = Pen(1, INK, 0.18)
"""What points and their labels are drawn with."""


class PlotColouring(Enum):
    """What tells parts of paths apart."""

    COLOURS = "colours"
    LINES = "lines"
    TOOLS = "tools"


@dataclass(frozen=True, slots=True)
class Projection:
    """A parallel projection.

    Attributes:
        turn_deg: how far the viewer has walked round the scene, anticlockwise, from the front, which is -Y.
        tilt_deg: how high the viewer stands: 0 level, 90 above with Y upwards on the paper.
    """

    turn_deg: float = 0.0
    tilt_deg: float = 90.0

    def seen(self, points: Floats) -> Floats:
        """Return where points (n, 3) are seen, (n, 2), mm across and up."""
        turn, tilt = math.radians(self.turn_deg), math.radians(self.tilt_deg)
        (c, s), low, high = (math.cos(turn), math.sin(turn)), math.sin(tilt), math.cos(tilt)
        return np.asarray(points @ np.array([[c, -s * low], [s, c * low], [0.0, high]]), np.float64)


VIEWS = {
    "plan": Projection(),
    "front": Projection(0, 0),
    "side": Projection(90, 0),
    "isometric": Projection(45, math.degrees(math.asin(math.sqrt(1 / 3)))),
}


def colour_of(number: int) -> str:
    """Return the colour of a surface that names none: eight by turns, on paper as in the window."""
    return TOOL_COLOURS[number % len(TOOL_COLOURS)]


def line_of(number: int) -> LineType:
    """Return the line type of a surface that names none: solid, dotted, chain by turns."""
    return _CYCLE[number % len(_CYCLE)]


@dataclass(frozen=True, eq=False, slots=True)
class RunPiece:
    """The part of a run that is on one surface.

    Attributes:
        surface: its number. tool: number of the tool among those of the plot, from 0.
        points: (n, 3) mm, n >= 2, in the order of generation. fine: it is of the compound surface, not of a path.
    """

    surface: int
    tool: int
    points: Floats
    fine: bool = False


@dataclass(frozen=True, slots=True)
class PlottedKind:
    """What is told apart: a surface, or a tool. AUTO and "" mean the next of the cycle."""

    name: str
    colour: str = ""
    line: LineType = LineType.AUTO


@dataclass(frozen=True, eq=False)
class BySurface:
    """A plot of pieces.

    Attributes:
        title: of the sheet. units: that lengths are told in.
        surfaces, tools: by number. pieces: in the order of generation.
        marks: (m, 3) boundary points. labels: m names of them, or none.
        notes: lines under the legend. with_legend: there is one.
    """

    title: str
    surfaces: Sequence[PlottedKind]
    tools: Sequence[PlottedKind]
    pieces: Sequence[RunPiece]
    marks: Floats
    labels: Sequence[str] = ()
    view: Projection = Projection()
    look: PlotColouring = PlotColouring.COLOURS
    notes: Sequence[str] = ()
    with_legend: bool = True
    units: Units = Units.MM

    def pen(self, kind: int, fine: bool = False) -> Pen:
        """Return what draws a surface, or a tool where tools are told apart: pens from 2 on, 1 being black."""
        look = (self.tools if self.look is PlotColouring.TOOLS else self.surfaces)[kind]
        width = SURFACE_MM if fine else PATH_MM
        if self.look is PlotColouring.LINES:
            line = line_of(kind) if look.line is LineType.AUTO else look.line
            return Pen(1, INK, width, DASHES[line])
        return Pen(2 + kind, look.colour or colour_of(kind), width)

    def _kind(self, piece: RunPiece) -> int:
        return piece.tool if self.look is PlotColouring.TOOLS else piece.surface

    @cached_property
    def _seen(self) -> tuple[list[Floats], Floats]:
        """Where the pieces and the marks are seen."""
        return [self.view.seen(piece.points) for piece in self.pieces], self.view.seen(self.marks)

    def box(self) -> Box | None:
        """Return x0, y0, x1, y1 round all of it, mm; None when there is nothing."""
        pieces, marks = self._seen
        if not pieces:
            return None
        every = np.concatenate([*pieces, marks])
        (x0, y0), (x1, y1) = every.min(axis=0).tolist(), every.max(axis=0).tolist()
        return (x0, y0, x1, y1)

    def ink(self, scale: float) -> PageContent:
        """Return the ink, in mm, for paper on which it is `scale` times as large."""
        pieces, marks = self._seen
        traces = tuple(
            TracedPolyline(self.pen(self._kind(piece), piece.fine), points)
            for piece, points in zip(self.pieces, pieces, strict=True)
        )
        circles = tuple(Circle((x, y), MARK_MM / scale) for x, y in marks.tolist())
        words: list[TextLine] = []
        if self.labels:
            places = free_places([points * scale for points in pieces], marks * scale, self.labels, LABEL_MM)
            words = [
                TextLine(text, (at[0] / scale, at[1] / scale), LABEL_MM, pen=_MARK)
                for text, at in zip(self.labels, places, strict=True)
                if at is not None
            ]
        return PageContent((PenStroke(_MARK, circles),) if circles else (), (), tuple(words), traces)

    @cached_property
    def _entries(self) -> list[LegendEntry]:
        kinds = self.tools if self.look is PlotColouring.TOOLS else self.surfaces
        there = sorted({self._kind(piece) for piece in self.pieces})
        numbered = "" if self.look is PlotColouring.TOOLS else "{}  "
        entries = [LegendEntry(numbered.format(kind + 1) + kinds[kind].name, self.pen(kind)) for kind in there]
        if len(self.marks):
            entries.append(LegendEntry("CRij  boundary point of surfaces i and j", _MARK, MARK_MM))
        return [*entries, *(LegendEntry(note) for note in self.notes)]

    @property
    def strip(self) -> float:
        """Height of the legend, mm on paper."""
        return legend_height(len(self._entries)) if self.with_legend else 0.0

    def legend(self, box: Box) -> PageContent:
        """Return the legend for that place on the paper: a sample of each line and its surface, boundary points,
        passes.
        """
        return legend_ink(self._entries, box)


Place = tuple[float, float]

_CELL = 0.4
"""Side of the squares of paper that are either free or taken, mm."""

_MOST_CELLS = 2e7
"""Of the table of what is taken; on larger paper cells are larger."""
_GAP, _POINT, _ROUND = 0.5, 0.7, 3.5
"""mm on paper: round a label, half the side of a point, how far labels may stand beyond all points."""
_WIDE, _BODY = 0.62, 0.75
"""Greatest width of a letter and height of a capital, of the height of a text."""


def free_places(lines: Sequence[Floats], points: Floats, texts: Sequence[str], height: float) -> list[Place | None]:
    """Return where the foot of each point's text begins; None where there is no room.

    Args:
        lines: polylines (n, 2) that labels keep off. points: (m, 2) to be labelled. texts: m. height: of the letters.
            All mm on paper.
    """
    if not len(points):
        return []
    every = np.concatenate([*lines, points])
    corner, far = every.min(axis=0) - _ROUND, every.max(axis=0) + _ROUND
    cell = max(_CELL, math.sqrt(float(np.prod(far - corner)) / _MOST_CELLS))
    taken = np.zeros(np.ceil((far - corner) / cell).astype(int) + 1, bool)
    for line in lines:
        at = np.floor((_dense(line, cell / 2) - corner) / cell).astype(int)
        taken[at[:, 0], at[:, 1]] = True
    for point in points:
        _cells(taken, (point - corner - _POINT) / cell, (point - corner + _POINT) / cell)[:] = True
    found = [
        _place(taken, _LabelledPoint(at, points - corner, cell), len(text) * height * _WIDE, height * _BODY)
        if text
        else None
        for at, text in enumerate(texts)
    ]
    return [None if place is None else (place[0] + float(corner[0]), place[1] + float(corner[1])) for place in found]


class _LabelledPoint(NamedTuple):
    """The number of a point among all, (m, 2), and the side of the squares of paper, mm."""

    number: int
    points: Floats
    cell: float


def _place(taken: NDArray[np.bool_], where: _LabelledPoint, wide: float, high: float) -> Place | None:
    """Return a free place beside one of the points, nearer to it than to the others, and take it; to the right and
    above first.
    """
    number, points, cell = where
    point = points[number]
    for away in (1.0, 2.0, 3.2):
        for side, up in ((1, 1), (-1, 1), (1, -1), (-1, -1), (0, 1), (0, -1), (1, 0), (-1, 0)):
            centre = point + (side * (wide / 2 + away * (0.7 if up else 1.0)), up * (high / 2 + away))
            half = np.array([wide / 2 + _GAP, high / 2 + _GAP])
            cells = _cells(taken, (centre - half) / cell, (centre + half) / cell)
            if not cells.size or cells.any() or np.hypot(*(points - centre).T).argmin() != number:
                continue
            cells[:] = True
            x, y = (centre - (wide / 2, high / 2)).tolist()
            return x, y
    return None


def _cells(taken: NDArray[np.bool_], low: Floats, high: Floats) -> NDArray[np.bool_]:
    """Return the squares of a rectangle; none where it leaves the paper."""
    (x0, y0), (x1, y1) = np.floor(low).astype(int).tolist(), (np.floor(high).astype(int) + 1).tolist()
    inside = min(x0, y0) >= 0 and x1 <= taken.shape[0] and y1 <= taken.shape[1]
    return taken[x0:x1, y0:y1] if inside else taken[:0]


def _dense(line: Floats, step: float) -> Floats:
    """Return places along a polyline no farther apart than a step."""
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
    at = np.union1d(along, np.arange(0.0, along[-1], step))
    return np.stack([np.interp(at, along, line[:, axis]) for axis in (0, 1)], axis=1)


_COLUMNS, _ROW, _EDGE, _SAMPLE, _TEXT = 3, 5.2, 2.0, 15.0, 2.5
"""Columns; mm: from row to row, to the edge, length of a sample, height of letters."""


@dataclass(frozen=True, slots=True)
class LegendEntry:
    """A line of a legend: a text, behind a sample of a pen's line, behind a circle of a radius in mm, or alone."""

    text: str
    pen: Pen | None = None
    radius: float = 0.0


def legend_height(count: int) -> float:
    """Return the height of a legend of so many entries, mm."""
    return 2 * _EDGE + _ROW * math.ceil(count / _COLUMNS)


def legend_ink(entries: Sequence[LegendEntry], box: Box) -> PageContent:
    """Return a legend in a place x0, y0, x1, y1 of the paper, row by row."""
    x0, _, x1, y1 = box
    wide = (x1 - x0) / _COLUMNS
    made = PageContent()
    for number, entry in enumerate(entries):
        x, y = x0 + wide * (number % _COLUMNS) + _EDGE, y1 - _EDGE - _ROW * (number // _COLUMNS + 0.5)
        indent = 0.0
        if entry.pen is not None and entry.radius:
            made += PageContent((PenStroke(entry.pen, (Circle((x + _SAMPLE / 2, y), entry.radius),)),))
        elif entry.pen is not None:
            made += PageContent(traces=(TracedPolyline(entry.pen, np.array([[x, y], [x + _SAMPLE, y]])),))
        if entry.pen is not None:
            indent = _SAMPLE + _EDGE
        made += PageContent(
            words=(
                TextLine(fitted(entry.text, _TEXT, wide - indent - 2 * _EDGE), (x + indent, y - 0.36 * _TEXT), _TEXT),
            )
        )
    return made
