"""What of a part and its tool paths goes on paper: curves by layer, dimensions at a readable size, paths by tool and
purpose.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...geometry.dimension_lines import dimension_lines
from ...geometry.sample import bounds, union
from ...model.curves import Arc, Circle, Curve, Line, Point
from ...model.moves import MoveKind, Moves, Purpose
from ...model.notes import Dimension, Mark
from ...model.part import Layer, Part, Units
from .page import Box, FilledPolygon, PageContent, Pen, PenStroke, TextLine

INK = "#000000"
TOOL_COLOURS = ("#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#7A6BC2", "#D55E00", "#882255", "#3B4F9E")
PART_MM, NOTE_MM, PATH_MM, LINK_MM = 0.35, 0.18, 0.25, 0.13
"""Widths of pens on paper, mm."""
ARROW_MM, FIGURE_MM, _MARK_MM = 2.5, 3.5, 1.0
"""On paper, mm: length of an arrow, height of a figure, arm of a mark."""
_LIFT_MM = 0.8
"""Between a line of a dimension and its figure, mm on paper."""
CONTOUR_DASH = (3.0, 1.5)
"""Dash and gap, mm on paper."""
_DASHED = (Purpose.CONTOUR, Purpose.TAB, Purpose.DOG_BONE)


@dataclass(frozen=True)
class DrawingContent:
    """What is plotted.

    Attributes:
        part: its visible layers; construction lines are never plotted.
        moves: tool paths seen from above, without rapids; None = none.
        notes: with points and dimensions. black: all in one ink.
    """

    part: Part
    moves: Moves | None = None
    notes: bool = True
    black: bool = False

    strip = 0.0

    @property
    def title(self) -> str:
        """The part's name."""
        return self.part.name

    @property
    def units(self) -> Units:
        """The part's."""
        return self.part.units

    def legend(self, box: Box) -> PageContent:
        """Return nothing: layers and tools are told apart by colour alone."""
        return PageContent()

    @property
    def _layers(self) -> dict[str, tuple[int, Layer]]:
        return {layer.name: (number, layer) for number, layer in enumerate(self.part.layers, 1) if layer.visible}

    def _pen(self, layer: str, width: float) -> Pen:
        number, look = self._layers[layer]
        return Pen(number, INK if self.black else look.colour or INK, width)

    def box(self) -> Box | None:
        """Return x0, y0, x1, y1 round all of it, mm; None when there is nothing."""
        layers = self._layers
        found = [bounds(entity.curve) for entity in self.part.entities if entity.layer in layers]
        for note in self.part.notes if self.notes else ():
            if note.layer in layers and isinstance(note.shape, Mark | Dimension):
                points = (note.shape.at,) if isinstance(note.shape, Mark) else (*note.shape.points, note.shape.place)
                xs, ys = zip(*points, strict=True)
                found.append((min(xs), min(ys), max(xs), max(ys)))
        found += [bounds(curve) for stroke in self._paths() for curve in stroke.curves]
        return union(found)

    def ink(self, scale: float) -> PageContent:
        """Return the ink, in the part's mm, for paper on which the part is `scale` times as large."""
        curves: dict[str, list[Curve]] = {name: [] for name in self._layers}
        for entity in self.part.entities:
            if entity.layer in curves:
                curves[entity.layer].append(entity.curve)
        drawn = tuple(PenStroke(self._pen(name, PART_MM), tuple(those)) for name, those in curves.items() if those)
        made = PageContent(tuple(self._paths()) + drawn)
        for note in self.part.notes if self.notes else ():
            if note.layer in curves and isinstance(note.shape, Mark | Dimension):
                made += self._note(note.shape, self._pen(note.layer, NOTE_MM), scale)
        return made

    def _note(self, shape: Mark | Dimension, pen: Pen, scale: float) -> PageContent:
        if isinstance(shape, Mark):
            (x, y), arm = shape.at, _MARK_MM / scale
            return PageContent((PenStroke(pen, (Line((x - arm, y), (x + arm, y)), Line((x, y - arm), (x, y + arm)))),))
        inch = self.part.units in (Units.INCH, Units.FOOT)
        drawn = dimension_lines(shape, ARROW_MM / scale, Units.INCH.value if inch else 1.0)
        words = TextLine(drawn.figure, drawn.at, FIGURE_MM, 0.5, drawn.angle, _LIFT_MM, pen)
        return PageContent(
            (PenStroke(pen, drawn.lines + drawn.arcs),),
            tuple(FilledPolygon(pen, head) for head in drawn.heads),
            (words,),
        )

    def _paths(self) -> Iterator[PenStroke]:
        """Yield a stroke for each tool and line style."""
        moves = self.moves
        if moves is None:
            return
        tools = [int(tool) for tool in dict.fromkeys(moves.tool.tolist())]
        links = ~np.isin(moves.purpose, (Purpose.POCKET, *_DASHED))
        dashed = np.isin(moves.purpose, _DASHED)
        for at, tool in enumerate(tools):
            colour = INK if self.black else TOOL_COLOURS[at % len(TOOL_COLOURS)]
            for which, width, dash in (
                (links, LINK_MM, ()),
                (~links & ~dashed, PATH_MM, ()),
                (dashed, PATH_MM, CONTOUR_DASH),
            ):
                rows = np.flatnonzero(which & (moves.tool == tool) & (moves.kind != MoveKind.RAPID))
                curves = tuple(_curves(moves, rows))
                if curves:
                    yield PenStroke(Pen(len(self.part.layers) + 1 + at, colour, width, dash), curves)


def _curves(moves: Moves, rows: np.ndarray) -> Iterator[Curve]:
    """Yield the curves of some moves seen from above; those straight up and down are points and left out."""
    starts, ends, centres, kinds = moves.start[rows, :2], moves.end[rows, :2], moves.centre[rows], moves.kind[rows]
    for (ax, ay), (bx, by), (cx, cy), kind in zip(
        starts.tolist(), ends.tolist(), centres.tolist(), kinds.tolist(), strict=True
    ):
        start, end, centre = (ax, ay), (bx, by), (cx, cy)
        if kind >= MoveKind.ARC_CW:
            yield from _round(start, end, centre, kind == MoveKind.ARC_CCW)
        elif start != end:
            yield Line(start, end)


def _round(start: Point, end: Point, centre: Point, ccw: bool) -> Iterator[Curve]:
    if start != end:
        yield Arc(start, end, centre, ccw)
    elif start == (centre[0] + math.dist(start, centre), centre[1]):
        yield Circle(centre, math.dist(start, centre), ccw)
    else:
        across = (2 * centre[0] - start[0], 2 * centre[1] - start[1])
        yield Arc(start, across, centre, ccw)
        yield Arc(across, end, centre, ccw)
