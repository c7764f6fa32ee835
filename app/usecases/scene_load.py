"""How much metal the passes of a scene take at a time, from the cut of its program out of its stock."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..core.progress import NO_PROGRESS, Progress
from ..gcode.interpreter.program import NcProgram
from ..model.finding import Finding, FindingKind
from ..model.motion import Floats, MotionKind
from ..model.stock_box import StockBox
from ..model.tool import Tool
from ..simulation.cutter import cutter_of
from ..simulation.field.workpiece import BoxStock, Grid
from ..simulation.sweeps.course import Course, TrimOptions
from ..simulation.sweeps.trim import trim
from ..verify.course import course_of

CELLS = 256
"""Along the longer side of the stock: a slot is many cells wide, or the tool is so fine that its load cannot be told."""

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


def load_findings(programs: Sequence[NcProgram], tools: Sequence[Mapping[int, Tool]], stock: StockBox, origin: Floats,
                  progress: Progress = NO_PROGRESS) -> Iterator[Finding]:  # fmt: skip
    """Yield, by tool, where it takes more metal at a time than it can be meant to: a slot or a hole deeper than its diameter or flutes.

    Args:
        programs: in the order of cutting. tools: of each, by T number, 0 standing for one that is not named.
        stock: scene coordinates. origin: the program's zero in them.

    Raises:
        Cancelled: the job was asked to stop.
    """
    low, high = np.array([stock.x0, stock.y0, stock.z0]) - origin, np.array([stock.x1, stock.y1, stock.z1]) - origin
    block = BoxStock(StockBox(*low.tolist(), *high.tolist()))
    grid = Grid.over(block.box, CELLS)
    metal, worst = block.over(grid), dict[int, _Load]()
    known: dict[int, Tool] = {}
    for k, (program, mine) in enumerate(zip(programs, tools, strict=True)):
        course = course_of(program).course
        cutters = {number: cutter_of(tool) for number, tool in mine.items()}
        done = trim(metal, course, cutters, TrimOptions(trace=True), progress.part(k / len(programs), (k + 1) / len(programs)))
        metal = done.workpiece
        for number, tool in mine.items():
            if tool.diameter < LEAST_CELLS * grid.pitch:
                continue
            known[tool.number] = tool
            for load in _loads(course, done.volume, number, tool):
                if tool.number not in worst or load.depth > worst[tool.number].depth:
                    worst[tool.number] = load
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
        yield _load(course, int(np.argmax(np.where(down, volume, -1.0))), float(np.max(volume[down])) / (math.pi * tool.radius**2), True)
    if along.any():
        rows = np.flatnonzero(along)
        piece = np.floor((np.cumsum(far[rows]) - far[rows]) / tool.diameter).astype(np.int64)
        long, taken = np.bincount(piece, far[rows]), np.bincount(piece, volume[rows])
        section = taken / np.maximum(long, tool.diameter)
        heaviest = int(np.argmax(section))
        own = rows[piece == heaviest]
        yield _load(course, int(own[np.argmax(volume[own])]), float(section[heaviest]) / tool.diameter, False)


def _load(course: Course, row: int, depth: float, plunges: bool) -> _Load:
    x, y, z = course.motions.end[row].tolist()
    return _Load(depth, row, x, y, z, int(course.motions.line[row]), plunges)


def _told(tool: Tool, load: _Load, limit: float) -> Finding:
    what = "goes straight down through" if load.plunges else "takes as much as a slot of its full width through"
    than = f"its flutes are {limit:g} mm long" if tool.flute_length else f"it is {limit:g} mm wide"
    text = (f"T{tool.number} {what} {load.depth:.1f} mm of metal at ({load.x:.3f}, {load.y:.3f}), NC line {load.line}, and {than}; rough "
            "the part first, or give passes before these stock to leave or a higher floor.")
    return Finding(FindingKind.ENGAGEMENT, text, load.x, load.y, counts=bool(tool.flute_length), amount=load.depth, line=load.line)
