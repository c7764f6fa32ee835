"""Read programs made by hand, motion by motion, for tests that need no text."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from app.gcode.interpreter.program import Event, ModalState, NcProgram
from app.model.machine import LinearAxis, Machine, SpindleRange
from app.model.motion import MotionKind, Motions, Nurbs, Plane

Point = tuple[float, float, float]
NO_CENTRE = (math.nan, math.nan, math.nan)


def machine(acceleration: float = 100.0, rapid: float = 6000.0, **changes: object) -> Machine:
    """A machine whose three axes are alike: 100 mm/s rapids, 100 mm/s2; stops at every corner but for a servo
    period.
    """
    axis = LinearAxis(-500.0, 500.0, rapid, acceleration)
    values: dict[str, object] = {"largest_feed": 60000.0, "corner": 0.0} | changes
    return Machine("Test mill", axis, axis, axis, SpindleRange(100.0, 10000.0), **values)  # type: ignore[arg-type]


@dataclass
class Course:
    """A sequence of motions; each begins where the one before ended."""

    at: Point = (0.0, 0.0, 0.0)
    feed: float = 600.0
    state: int = 0
    rows: list[tuple[object, ...]] = field(default_factory=list)
    splines: dict[int, Nurbs] = field(default_factory=dict)

    def _add(
        self, kind: MotionKind, end: Point, centre: Point = NO_CENTRE, arc: tuple[Plane, int] = (Plane.XY, 0)
    ) -> Course:
        feed = 0.0 if kind is MotionKind.RAPID else self.feed
        self.rows.append((self.at, end, centre, kind, arc[0], arc[1], feed, len(self.rows) + 1, self.state))
        self.at = end
        return self

    def rapid(self, x: float, y: float, z: float = 0.0) -> Course:
        return self._add(MotionKind.RAPID, (x, y, z))

    def line(self, x: float, y: float, z: float = 0.0) -> Course:
        return self._add(MotionKind.LINE, (x, y, z))

    def arc(self, end: Point, centre: Point, ccw: bool = True, arc: tuple[Plane, int] = (Plane.XY, 1)) -> Course:
        return self._add(MotionKind.ARC_CCW if ccw else MotionKind.ARC_CW, end, centre, arc)

    def spline(self, curve: Nurbs) -> Course:
        self.splines[len(self.rows)] = curve
        x, y, z = curve.points[-1].tolist()
        return self._add(MotionKind.SPLINE, (x, y, z))

    def motions(self) -> Motions:
        start, end, centre, kind, plane, turns, feed, line, state = (
            list(column) for column in zip(*self.rows, strict=True)
        )
        return Motions(
            np.array(start, float),
            np.array(end, float),
            np.array(centre, float),
            np.array(kind, np.uint8),
            np.array(plane, np.uint8),
            np.array(turns, np.int32),
            np.array(feed, float),
            np.array(line, np.int32),
            np.array(state, np.int32),
            self.splines,
        )

    def program(self, *states: ModalState, events: tuple[Event, ...] = ()) -> NcProgram:
        return NcProgram(self.motions(), states or (ModalState(path="G64"),), events)
