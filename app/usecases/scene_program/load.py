"""A scene's program cut out of its stock: what is left, and how much metal its passes take at a time."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...core.progress import NO_PROGRESS, Progress
from ...gcode.interpreter.program import NcProgram
from ...model.finding import Finding, FindingKind
from ...model.motion import Floats, MotionKind
from ...model.stock_box import StockBox
from ...model.tool import Tool
from ...simulation.cutter import cutter_of
from ...simulation.field.target import MOST_REACH
from ...simulation.field.workpiece import BoxStock, Grid, Workpiece
from ...simulation.sweeps.course import Course, TrimOptions
from ...simulation.sweeps.trim import trim
from ...verify.course import course_of

CELLS, MOST_CELLS = 256, 512
"""Along the longer side of the stock: a slot is many cells wide, or the tool is so fine that its load cannot be told;
more where passes lie close, so that what stays between two of them is some cells wide.
"""

CELLS_A_PASS = 4
"""Cells from pass to pass, so that what one leaves is seen."""

LEAST_CELLS = 4.0
"""Cells in a tool's diameter from which on its load is told."""

STEEP = math.tan(math.radians(60.0))
"""mm along Z per mm sideways from which on a motion is a plunge, or a lift."""


@dataclass(frozen=True, slots=True)
class _Load:
    """The heaviest cut of a tool: how deep a slot of its full width, or a hole, would be for the same volume.

    Attributes:
        row: of the motion, in its program. x, y, z: where, program coordinates, mm.
    """

    depth: float
    row: int
    x: float
    y: float
    z: float
    line: int
    plunges: bool


@dataclass(frozen=True, eq=False)
class SceneCut:
    """A scene's program, cut: what is left of the metal, program coordinates, and what there is to say of how it was
    taken.
    """

    workpiece: Workpiece
    findings: tuple[Finding, ...]


@dataclass(frozen=True, eq=False)
class SceneBlank:
    """What a scene is cut from.

    Attributes:
        stock: scene coordinates. origin: the program's zero in them. spacing: of the passes that lie closest, mm, > 0.
    """

    stock: StockBox
    origin: Floats
    spacing: float

    def metal(self, widest: float) -> Workpiece:
        """Return it on cells, program coordinates: no more of them along the widest tool's radius than the look for
        what is left takes.
        """
        stock = self.stock
        low, high = (
            np.array(corner) - self.origin
            for corner in ((stock.x0, stock.y0, stock.z0), (stock.x1, stock.y1, stock.z1))
        )
        block = BoxStock(StockBox(*low.tolist(), *high.tolist()))
        side = max(stock.x1 - stock.x0, stock.y1 - stock.y0)
        workpiece = min(max(CELLS_A_PASS * side / self.spacing, CELLS), MOST_CELLS, side * MOST_REACH / widest)
        return block.over(Grid.over(block.box, max(int(workpiece), 1)))


def scene_cut(
    programs: Sequence[NcProgram],
    tools: Sequence[Mapping[int, Tool]],
    block: SceneBlank,
    progress: Progress = NO_PROGRESS,
) -> SceneCut:
    """Cut a scene's program, and say, by tool, where it takes more metal at a time than it can be meant to.

    That is a slot or a hole deeper than its diameter or flutes.

    Args:
        programs: in the order of cutting. tools: of each, by T number, 0 standing for one that is not named.

    Raises:
        Cancelled: the job was asked to stop.
    """
    workpiece, worst = block.metal(max(tool.radius for mine in tools for tool in mine.values())), dict[int, _Load]()
    known: dict[int, Tool] = {}
    for k, (program, mine) in enumerate(zip(programs, tools, strict=True)):
        course = course_of(program).course
        cutters = {number: cutter_of(tool) for number, tool in mine.items()}
        done = trim(
            workpiece,
            course,
            cutters,
            TrimOptions(trace=True),
            progress.part(k / len(programs), (k + 1) / len(programs)),
        )
        workpiece = done.workpiece
        for number, tool in mine.items():
            if tool.diameter < LEAST_CELLS * workpiece.grid.pitch:
                continue
            known[tool.number] = tool
            for load in _loads(course, done.volume, number, tool):
                if tool.number not in worst or load.depth > worst[tool.number].depth:
                    worst[tool.number] = load
    return SceneCut(workpiece, tuple(_heavy(worst, known, block.origin)))


def _heavy(worst: Mapping[int, _Load], known: Mapping[int, Tool], origin: Floats) -> Iterator[Finding]:
    """Yield the loads that are too heavy."""
    for number, load in sorted(worst.items()):
        limit = known[number].flute_length or known[number].diameter
        if load.depth > limit:
            yield _told(known[number], replace(load, x=load.x + origin[0], y=load.y + origin[1]), limit)


def _loads(course: Course, volume: Floats, number: int, tool: Tool) -> Iterator[_Load]:
    """Yield the heaviest cut along, each the mean over a diameter of the way or one motion, and the heaviest plunge."""
    motions, way = course.motions, course.motions.end - course.motions.start
    far, mine = np.hypot(way[:, 0], way[:, 1]), (course.tool == number) & (motions.kind != MotionKind.RAPID)
    mine[list(course.left_out)] = False
    upright = np.abs(way[:, 2]) > STEEP * far
    down, along = mine & upright, mine & ~upright
    if down.any():
        yield _load(
            course,
            int(np.argmax(np.where(down, volume, -1.0))),
            float(np.max(volume[down])) / (math.pi * tool.radius**2),
            plunges=True,
        )
    if along.any():
        rows = np.flatnonzero(along)
        piece = np.floor((np.cumsum(far[rows]) - far[rows]) / tool.diameter).astype(np.int64)
        long, taken = np.bincount(piece, far[rows]), np.bincount(piece, volume[rows])
        section = taken / np.maximum(long, tool.diameter)
        heaviest = int(np.argmax(section))
        own = rows[piece == heaviest]
        yield _load(course, int(own[np.argmax(volume[own])]), float(section[heaviest]) / tool.diameter, plunges=False)


def _load(course: Course, row: int, depth: float, plunges: bool) -> _Load:
    x, y, z = course.motions.end[row].tolist()
    return _Load(depth, row, x, y, z, int(course.motions.line[row]), plunges)


def _told(tool: Tool, load: _Load, limit: float) -> Finding:
    what = "goes straight down through" if load.plunges else "takes as much as a slot of its full width through"
    than = f"its flutes are {limit:g} mm long" if tool.flute_length else f"it is {limit:g} mm wide"
    text = (
        f"T{tool.number} {what} {load.depth:.1f} mm of metal at ({load.x:.3f}, {load.y:.3f}), NC line {load.line}, "
        f"and {than}; rough the part first, or give passes before these stock to leave or a higher floor."
    )
    return Finding(
        FindingKind.ENGAGEMENT, text, load.x, load.y, counts=bool(tool.flute_length), amount=load.depth, line=load.line
    )
