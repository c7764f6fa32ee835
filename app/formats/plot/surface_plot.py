"""Paths over a compound surface on paper, as they are generated: each surface's part told apart by colour or by line
type.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...model.curves import Circle
from ...model.part import Units
from ...model.scene import LineType
from .content import INK, TOOL_COLOURS
from .page import Box, PageContent, Pen, PenStroke, TextLine, TracedPolyline
from .surface_labels import free_places
from .surface_legend import LegendEntry, legend_height, legend_ink

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
