"""Hand-made programs for the tests of this folder: a path is a list of steps, each adds one move."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from app.model.contour_operation import ContourOperation
from app.model.curves import Line
from app.model.job import Job, Stock
from app.model.moves import MoveKind, Moves, Program, Purpose
from app.model.operation import CutParameters, PocketOperation
from app.model.part import Contour, Part, Region
from app.model.tool import Tool

NO_CENTRE = (math.nan, math.nan)


@dataclass
class Path:
    """Moves one by one."""

    tool: int = 1
    operation: int = 0
    feed: float = 600.0
    rows: list[tuple[object, ...]] = field(default_factory=list)

    def _add(self, kind: MoveKind, end: tuple[float, float, float], centre: tuple[float, float] = NO_CENTRE) -> Path:
        rapid = kind is MoveKind.RAPID
        purpose = Purpose.RAPID if rapid else Purpose.CONTOUR
        self.rows.append((end, centre, kind, purpose, self.operation, self.tool, 1, 0.0 if rapid else self.feed))
        return self

    def rapid(self, x: float, y: float, z: float) -> Path:
        return self._add(MoveKind.RAPID, (x, y, z))

    def line(self, x: float, y: float, z: float) -> Path:
        return self._add(MoveKind.LINE, (x, y, z))

    def arc(self, end: tuple[float, float, float], centre: tuple[float, float], ccw: bool = True) -> Path:
        return self._add(MoveKind.ARC_CCW if ccw else MoveKind.ARC_CW, end, centre)

    def into_work(self, x: float, y: float, z: float = -1.0) -> Path:
        """Rapid above a point, down to retract Z, and plunge."""
        feed, self.feed = self.feed, 200.0
        self.rapid(x, y, 5.0).rapid(x, y, 1.0).line(x, y, z)
        self.feed = feed
        return self

    def out_of_work(self) -> Path:
        x, y, _ = self.rows[-1][0]  # type: ignore[misc]
        return self.rapid(x, y, 5.0)

    def moves(self) -> Moves:
        end, centre, kind, purpose, operation, tool, region, feed = (
            list(column) for column in zip(*self.rows, strict=True)
        )
        return Moves(
            np.array(end, float),
            np.array(centre, float),
            np.array(kind, np.uint8),
            np.array(purpose, np.uint8),
            np.array(operation, np.int16),
            np.array(tool, np.int16),
            np.array(region, np.int32),
            np.array(feed, float),
            np.zeros(len(kind), np.int32),
        )

    def program(self, *regions: Region) -> Program:
        return Program(self.moves(), regions or (square(),))


def square(x0: float = 0.0, y0: float = 0.0, x1: float = 40.0, y1: float = 30.0) -> Region:
    """A rectangle to machine."""
    corners = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
    return Region(1, Contour(tuple(Line(a, b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True))))


def job(**changes: object) -> Job:
    """A job with T1 for the pocket and T2 for the contour."""
    tools = (Tool(1, 6.0), Tool(2, 3.0, spindle_speed=18000.0))
    operations = (PocketOperation(CutParameters(tool=1)), ContourOperation(CutParameters(tool=2)))
    values: dict[str, object] = {
        "part": Part(name="plate"),
        "tools": tools,
        "operations": operations,
        "stock": Stock(2.0, 8.0),
    }
    return Job(**(values | changes))  # type: ignore[arg-type]


def two_tools() -> Path:
    """A pocket ring with T1 and a contour with arcs, a full circle and a helix with T2."""
    path = (
        Path()
        .into_work(10.0, 10.0)
        .line(30.0, 10.0, -1.0)
        .line(30.0, 20.0, -1.0)
        .line(10.0, 20.0, -1.0)
        .line(10.0, 10.0, -1.0)
    )
    path.out_of_work()
    path.tool, path.operation, path.feed = 2, 1, 450.0
    path.into_work(8.0, 5.0).line(32.0, 5.0, -1.0).arc((35.0, 8.0, -1.0), (32.0, 8.0)).line(35.0, 22.0, -1.0)
    path.arc((35.0, 22.0, -1.0), (30.0, 22.0), ccw=False)
    path.arc((25.0, 22.0, -2.0), (30.0, 22.0)).out_of_work()
    return path
