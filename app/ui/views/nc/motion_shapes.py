"""The motions of a program prepared for painting and picking: elements in space, built once by numpy."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, IntEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from PySide6.QtGui import QPainterPath

from ....gcode.interpreter.program import NcProgram
from ....gcode.timing.extent import at_home
from ....model.motion import MotionKind
from ....model.motion_path import arc_paths, lengths, spline_points
from ..canvas.painting.curve_path import CURVE_DATA, CURVE_TO, ELEMENT, LINE_TO, MOVE_TO, PIECE, Elements, path_of

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

_SPLINE_CHORDS = 96
_MOST_PIECES = 1_600
"""Pieces of one arc that are painted: two hundred turns; of more no eye could tell."""

_MOST_LIT = 4_000

CONTOUR_INK = 1
"""The place of contours in the theme's cycle of tools, as in the Paths view."""


class ViewSide(Enum):
    """From where the path is looked at; the value holds the columns that go to the right and up."""

    XY = (0, 1)
    XZ = (0, 2)
    YZ = (1, 2)

    @property
    def depth(self) -> int:
        """The column that is looked along."""
        return 3 - sum(self.value)


class MotionLineStyle(IntEnum):
    """What a motion is, as far as its line style goes."""

    RAPID = 0
    CUT = 1
    PLUNGE = 2
    CONTOUR = 3


@dataclass(frozen=True, eq=False)
class MotionShapes:
    """n motions as columns for painting and picking.

    Attributes:
        program: what they are motions of.
        kinds: (m,) kind of each painter path element; points: (m, 3) its place, mm. Lines have one, arcs three a piece.
        offset: (n + 1,) where the elements of each motion begin.
        low, high: (n, 3) corners of the box round each motion's elements, mm.
        length: (n,) mm.
        look: (n,) uint8 Look. tool: (n,) int32 T number.
        home: (n, 3) whether the motion ends, along an axis, at a place that only the machine knows. away: whether it
            begins there.
        by_line: (n,) the motions in the order of their lines. lines: (n,) those lines, 1-based, not decreasing.
    """

    program: NcProgram
    kinds: NDArray[np.uint8]
    points: Floats
    offset: Ints
    low: Floats
    high: Floats
    length: Floats
    look: NDArray[np.uint8]
    tool: NDArray[np.int32]
    home: Bools
    away: Bools
    by_line: Ints
    lines: NDArray[np.int32]

    def __len__(self) -> int:
        return len(self.look)

    def of_rows(self, first: int, last: int) -> Ints:
        """Return the motions of the lines from row `first` to row `last` (0-based, both included), in order of line."""
        begin, end = np.searchsorted(self.lines, [first + 1, last + 2])
        return self.by_line[begin:end]

    def before_row(self, row: int) -> int | None:
        """Return the last motion of the lines up to a row (0-based), in order of line; None before the first."""
        end = int(np.searchsorted(self.lines, row + 2))
        return int(self.by_line[end - 1]) if end else None

    def seen(self, side: ViewSide, motions: Ints | None = None) -> Ints:
        """Return those of some motions, or of all, whose way seen from a side is known."""
        rows = np.arange(len(self)) if motions is None else motions
        if not self.program.homeward:
            return rows
        columns = list(side.value)
        unknown = (self.home[rows] | self.away[rows])[:, columns].any(axis=1)
        return np.asarray(rows[~unknown])

    def breaks(self, motions: Ints) -> Bools:
        """Return (k,) which of some motions do not begin where the one before in the list ends."""
        broken = np.ones(len(motions), bool)
        broken[1:] = np.any(self.program.motions.start[motions[1:]] != self.program.motions.end[motions[:-1]], axis=1)
        return broken

    def elements(self, motions: Ints, side: ViewSide, heads: Ints | None = None) -> tuple[Elements, Ints]:
        """Return painter path elements of some motions seen from a side, and where each one's begin, (k + 1,).

        A motion that does not begin where the one before it in the list ends begins with MOVE_TO, and so do those that
        `heads` counts.
        """
        start = self.program.motions.start
        head = self.breaks(motions)
        if heads is not None:
            head[heads] = True
        size = self.offset[motions + 1] - self.offset[motions]
        at = np.concatenate([[0], np.cumsum(size + head)]).astype(np.int64)
        made = np.zeros(int(at[-1]), dtype=ELEMENT)
        made["kind"][at[:-1][head]] = MOVE_TO
        body = np.repeat(at[:-1] + head, size) + _counted(size)
        taken = np.repeat(self.offset[motions], size) + _counted(size)
        made["kind"][body] = self.kinds[taken]
        for name, axis in zip("xy", side.value, strict=True):
            made[name][at[:-1][head]] = start[motions[head], axis]
            made[name][body] = self.points[taken, axis]
        return made, at

    def path(self, motions: Ints, side: ViewSide) -> QPainterPath:
        """Return the painter path in mm of what is known of some motions' ways, of very many the first 4,000."""
        seen = self.seen(side, motions[:_MOST_LIT])
        return path_of(self.elements(seen, side)[0].tobytes()) if len(seen) else QPainterPath()


def tools_of(shapes: MotionShapes) -> list[int]:
    """Return the T numbers that feed, in the order of their first cut."""
    tools, first = np.unique(shapes.tool[shapes.look != MotionLineStyle.RAPID], return_index=True)
    return [int(tool) for tool in tools[np.argsort(first)]]


def tool_inks(*files: MotionShapes) -> dict[int, int]:
    """Return the place in the theme's cycle of tools of what each tool of a program feeds, by T number.

    Places go by the order of first cuts. Where it is known which motions go along contours, these have a place of
    their own, and it is left free for them: so nothing has another colour than in the Paths view. The first tool that
    cuts nothing else has it, too; the next ones have places as any tool, since a tool has one colour.

    Args:
        files: of the program, in the order of cutting.
    """
    tools = list(dict.fromkeys(tool for shapes in files for tool in tools_of(shapes)))
    if not any(np.any(shapes.look == MotionLineStyle.CONTOUR) for shapes in files):
        return {tool: at for at, tool in enumerate(tools)}
    others = {tool for shapes in files for tool in _tools_off_contours(shapes)}
    alone = [tool for tool in tools if tool not in others]
    rest = [*(tool for tool in tools if tool in others), *alone[1:]]
    return dict.fromkeys(alone[:1], CONTOUR_INK) | {tool: at + (at >= CONTOUR_INK) for at, tool in enumerate(rest)}


def contour_inks(*files: MotionShapes) -> dict[int, int]:
    """Return the place in the theme's cycle of tools of what each tool cuts along contours, by T number: that of the
    contours, but that of the tool where it cuts nothing else.

    Args:
        files: of the program, in the order of cutting.
    """
    others = {tool for shapes in files for tool in _tools_off_contours(shapes)}
    return {tool: CONTOUR_INK if tool in others else ink for tool, ink in tool_inks(*files).items()}


def _tools_off_contours(shapes: MotionShapes) -> list[int]:
    """Return the T numbers that cut elsewhere than along contours."""
    return [int(tool) for tool in np.unique(shapes.tool[shapes.look == MotionLineStyle.CUT])]


def shape_motions(program: NcProgram, contour: Bools | None = None) -> MotionShapes:
    """Return a program's motions prepared for painting and picking.

    Args:
        program: as it was read.
        contour: (n,) which motions go along a contour.
    """
    motions, home = program.motions, at_home(program)
    away = np.concatenate([np.zeros((1, 3), bool), home])[: len(home)]
    away &= (motions.kind == MotionKind.RAPID)[:, None] | (motions.kind == MotionKind.LINE)[:, None]
    kinds, points, offset = _elements(program)
    low, high = motions.start.copy(), motions.start.copy()
    if len(motions):
        low = np.minimum(low, np.minimum.reduceat(points, offset[:-1]))
        high = np.maximum(high, np.maximum.reduceat(points, offset[:-1]))
    length = lengths(motions)
    length[np.any((home | away) & (motions.start != motions.end), axis=1)] = 0.0
    tools = np.array([state.tool for state in program.states], np.int32)
    by_line = np.argsort(motions.line, kind="stable")
    return MotionShapes(
        program,
        kinds,
        points,
        offset,
        low,
        high,
        length,
        _looks(program, contour),
        tools[motions.state],
        home,
        away,
        by_line,
        motions.line[by_line],
    )


def _looks(program: NcProgram, contour: Bools | None) -> NDArray[np.uint8]:
    """Return the look of each motion; a plunge is a feed straight down."""
    motions = program.motions
    way = motions.end - motions.start
    down = (motions.kind == MotionKind.LINE) & (way[:, 2] < 0) & np.all(way[:, :2] == 0, axis=1)
    along = MotionLineStyle.CUT if contour is None else np.where(contour, MotionLineStyle.CONTOUR, MotionLineStyle.CUT)
    looks = np.where(down, MotionLineStyle.PLUNGE, along)
    return np.where(motions.kind == MotionKind.RAPID, MotionLineStyle.RAPID, looks).astype(np.uint8)


class _PathElements(NamedTuple):
    """Elements of painter's paths: kinds, points (n, 3), mm, and where each motion's begin."""

    kinds: NDArray[np.uint8]
    points: Floats
    offset: Ints


def _elements(program: NcProgram) -> _PathElements:
    """Return the elements of all motions."""
    motions = program.motions
    arcs = arc_paths(motions)
    pieces = np.clip(np.ceil(np.abs(arcs.sweep) / PIECE - 1e-9), 1, _MOST_PIECES).astype(np.int64)
    size = np.ones(len(motions), np.int64)
    size[arcs.rows] = 3 * pieces
    size[list(motions.splines)] = _SPLINE_CHORDS
    offset = np.concatenate([[0], np.cumsum(size)]).astype(np.int64)
    kinds, points = np.full(int(offset[-1]), LINE_TO, np.uint8), np.zeros((int(offset[-1]), 3))
    points[offset[1:] - 1] = motions.end
    for row, spline in motions.splines.items():
        points[offset[row] : offset[row + 1]] = spline_points(spline, _SPLINE_CHORDS + 1)[1:]
    if len(arcs):
        _fill_arcs(program, _PathElements(kinds, points, offset), pieces)
    return _PathElements(kinds, points, offset)


def _fill_arcs(program: NcProgram, elements: _PathElements, pieces: Ints) -> None:
    """Write the cubics of the arcs; along the normal they run evenly, so that helices are helices."""
    kinds, points, offset = elements
    arcs = arc_paths(program.motions)
    at_arc, number = np.repeat(np.arange(len(arcs)), pieces), _counted(pieces)
    whole = np.minimum(np.abs(arcs.sweep), PIECE * pieces) * np.sign(arcs.sweep)
    step = whole[at_arc] / pieces[at_arc]
    handle = 4 / 3 * np.tan(step / 4)
    first, last = number / pieces[at_arc], (number + 1) / pieces[at_arc]
    a, b = arcs.angle[at_arc] + step * number, arcs.angle[at_arc] + step * (number + 1)
    grow = arcs.end_radius - arcs.start_radius
    begin_radius, end_radius = (arcs.start_radius[at_arc] + grow[at_arc] * t for t in (first, last))
    at = offset[arcs.rows][at_arc] + 3 * number
    columns = (
        (
            CURVE_TO,
            begin_radius,
            np.cos(a) - handle * np.sin(a),
            np.sin(a) + handle * np.cos(a),
            first + (last - first) / 3,
        ),
        (
            CURVE_DATA,
            end_radius,
            np.cos(b) + handle * np.sin(b),
            np.sin(b) - handle * np.cos(b),
            last - (last - first) / 3,
        ),
        (CURVE_DATA, end_radius, np.cos(b), np.sin(b), last),
    )
    for k, (kind, radius, u, v, share) in enumerate(columns):
        own = np.column_stack(
            [
                arcs.centre[at_arc, 0] + radius * u,
                arcs.centre[at_arc, 1] + radius * v,
                arcs.height[at_arc] + arcs.rise[at_arc] * share,
            ]
        )
        turned = np.empty_like(own)
        np.put_along_axis(turned, arcs.axes[at_arc], own, axis=1)
        kinds[at + k], points[at + k] = kind, turned
    points[offset[arcs.rows + 1] - 1] = program.motions.end[arcs.rows]


def _counted(sizes: Ints) -> Ints:
    """Return 0, 1, ... for each of the sizes, one behind the other."""
    return np.arange(int(sizes.sum())) - np.repeat(np.cumsum(sizes) - sizes, sizes)
