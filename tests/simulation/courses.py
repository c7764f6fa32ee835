"""Motions to cut along, made of points, and cutters of every kind."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from app.model.motion import Floats, MotionKind, Motions, Plane
from app.model.stock_box import StockBox
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.simulation.cutter import Cutter, cutter_of
from app.simulation.field.workpiece import BoxStock, Grid, Workpiece
from app.simulation.sweeps.course import Course, TrimOptions
from app.simulation.sweeps.trim import CutResult, trim

CUTTERS: dict[str, Cutter] = {
    "ball": cutter_of(Tool(1, 6.0, ToolKind.BALL)),
    "flat": cutter_of(Tool(1, 6.0)),
    "bull": cutter_of(Tool(1, 6.0, ToolKind.BULL, corner_radius=1.0)),
    "thin bull": cutter_of(Tool(1, 6.0, ToolKind.BULL, corner_radius=0.05)),
    "v": cutter_of(Tool(1, 6.0, ToolKind.V, tip_angle=np.radians(90.0))),
    "blunt v": cutter_of(Tool(1, 6.0, ToolKind.V, tip_angle=np.radians(60.0), tip_diameter=1.0)),
    "drill": cutter_of(Tool(1, 6.0, ToolKind.DRILL)),
    "taper": cutter_of(Tool(1, 6.0, ToolKind.TAPER, tip_angle=np.radians(30.0), tip_diameter=2.0)),
}


PLAIN = TrimOptions()


def motions_of(start: Floats, end: Floats, kind: int = MotionKind.LINE) -> Motions:
    """Straight motions, one of each row."""
    count = len(start)
    whole = np.zeros(count, np.int32)
    return Motions(
        np.array(start, float),
        np.array(end, float),
        np.full((count, 3), np.nan),
        np.full(count, kind, np.uint8),
        np.zeros(count, np.uint8),
        whole,
        np.full(count, 600.0),
        np.arange(1, count + 1, dtype=np.int32),
        whole,
    )


def polyline(points: Iterable[Sequence[float]]) -> Motions:
    """Straight motions from point to point."""
    places = np.array(list(points), float)
    return motions_of(places[:-1], places[1:])


def arc(
    start: Sequence[float],
    end: Sequence[float],
    centre: Sequence[float],
    plane: Plane = Plane.XY,
    ccw: bool = True,
    turns: int = 1,
) -> Motions:
    """One arc."""
    one = np.ones(1, np.int32)
    return Motions(
        np.array([start], float),
        np.array([end], float),
        np.array([centre], float),
        np.full(1, MotionKind.ARC_CCW if ccw else MotionKind.ARC_CW, np.uint8),
        np.full(1, plane, np.uint8),
        one * turns,
        np.full(1, 600.0),
        one,
        one * 0,
    )


def joined(parts: Sequence[Motions]) -> Motions:
    """Motions one after another."""
    names = ("start", "end", "centre", "kind", "plane", "turns", "feed", "line", "state")
    return Motions(*(np.concatenate([getattr(part, name) for part in parts]) for name in names))


def box_piece(size: float = 20.0, cells: int = 64, depth: float = 30.0) -> Workpiece:
    """A square box with its top at 0 and its middle at X 0, Y 0."""
    half = size / 2
    return BoxStock(StockBox(-half, -half, -depth, half, half)).over(Grid.over((-half, -half, half, half), cells))


def course_of(motions: Motions) -> Course:
    return Course(motions, np.ones(len(motions), np.int32))


def cut(piece: Workpiece, motions: Motions, cutter: Cutter, options: TrimOptions = PLAIN) -> CutResult:
    return trim(piece, course_of(motions), {1: cutter}, options)


def cut_apart(piece: Workpiece, motions: Motions, cutter: Cutter, options: TrimOptions = PLAIN) -> CutResult:
    """Cut with two tools by turns, both of the same shape: no motion goes on from another, so all are evaluated
    wherever they sweep.
    """
    return trim(
        piece, Course(motions, np.arange(len(motions), dtype=np.int32) % 2 + 1), {1: cutter, 2: cutter}, options
    )


def cells_of(piece: Workpiece) -> Floats:
    """Return (rows * cols, 2) centres of the cells."""
    x, y = np.meshgrid(piece.grid.xs(), piece.grid.ys())
    return np.column_stack([x.ravel(), y.ravel()])
