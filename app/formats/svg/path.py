"""SVG path data to curves, y downwards as in the file: every command, to the first fault."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import ClassVar, NamedTuple

from ...geometry.affine import ellipse
from ...model.curves import Arc, Curve, Line, Point, Spline
from ..dxf.splines import MOST_POINTS
from .numbers import NUMBER

_NUMBER = re.compile(rf"[\s,]*({NUMBER})")
_NUMBERS = {count: re.compile(rf"[\s,]*+((?>{NUMBER}))" * count) for count in (1, 2, 4, 6)}
"""So many numbers at once; none is parted to make two of it."""
_FLAG = re.compile(r"[\s,]*([01])")
_COMMAND = re.compile(r"[\s,]*([A-Za-z])")
_COUNTS = {"M": 2, "L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2, "A": 7, "Z": 0}
_ROUNDING = 1e-15
"""An arc whose chord is its diameter but for this share of the radius is a half circle: what is left is rounding."""
BEZIER_KNOTS = {degree: (0.0,) * (degree + 1) + (1.0,) * (degree + 1) for degree in (2, 3)}


@dataclass
class SvgPath:
    """What path data draws.

    Attributes:
        runs: one list of curves for each run of the pen, each beginning where the one before ends; may be empty.
        fault: where the data cannot be read on, as a place in it; None where there is no fault.
        why: what stands there, where that is known.
        start: where the pen was first put down, if it was.
    """

    runs: list[list[Curve]] = field(default_factory=list)
    fault: int | None = None
    start: Point | None = None
    why: str = ""


def read_path(text: str, most: int) -> SvgPath:
    """Return the curves of path data; as SVG asks, what stands before a fault is drawn.

    Args:
        text: the attribute d.
        most: after this many curves the rest is left unread (and the count tells the caller), and so it is as soon as
            Béziers that follow one another have more than `MOST_POINTS` points.
    """
    text = text.rstrip(" \t\r\n,")
    pen, at, command = _PathPen(), 0, ""
    while at < len(text) and pen.drawn <= most and pen.points <= MOST_POINTS:
        found = _COMMAND.match(text, at)
        if found:
            command, at = found[1], found.end()
        values, after = _values(text, at, _COUNTS.get(command.upper(), -1))
        known = command and (found or command not in "zZ") and (pen.path.start is not None or command in "Mm")
        if values is None or not known:
            pen.path.fault = at
            pen.path.why = _wrong_flag(text, at) if known and command in "aA" else ""
            break
        pen.do(command, values)
        command = {"M": "L", "m": "l"}.get(command, command)
        at = after
    pen.lift()
    return pen.path


class _Arguments(NamedTuple):
    """The numbers of one command, None when some are missing, and where they end."""

    values: list[float] | None
    end: int


def _values(text: str, at: int, count: int) -> _Arguments:
    """Return the numbers of one command."""
    if count < 0:
        return _Arguments(None, at)
    if count in _NUMBERS:
        all_found = _NUMBERS[count].match(text, at)
        if all_found is None:
            return _Arguments(None, at)
        return _Arguments([*map(float, all_found.groups())], all_found.end())
    values: list[float] = []
    for k in range(count):
        found = (_FLAG if count == 7 and k in (3, 4) else _NUMBER).match(text, at)
        if found is None:
            return _Arguments(None, at)
        values.append(float(found[1]))
        at = found.end()
    return _Arguments(values, at)


def _wrong_flag(text: str, at: int) -> str:
    """Return which of an arc's two flags is neither 0 nor 1, with its place; "" where something else is wrong."""
    for kind in ("", "", "", "large-arc", "sweep"):
        found = (_FLAG if kind else _NUMBER).match(text, at)
        if found is None:
            other = _NUMBER.match(text, at) if kind else None
            return (
                f"the {kind} flag {other[1][:60]} at character {other.start(1) + 1} of its data is neither 0 nor 1"
                if other
                else ""
            )
        at = found.end()
    return ""


class _Handle(NamedTuple):
    """The last handle of a curve that was drawn: of which kind, C or Q ("" = none), and where."""

    kind: str
    at: Point


class _PathPen:
    """Where the pen stands and what it has drawn."""

    def __init__(self) -> None:
        self.path = SvgPath()
        self._run: list[Curve] = []
        self._here = self._first = (0.0, 0.0)
        self._handle = _Handle("", (0.0, 0.0))
        self.drawn = 0
        self.points = 0  # of the Béziers of one degree that were drawn last

    def do(self, command: str, values: list[float]) -> None:
        kind = command.upper()
        dx, dy = self._here if command.islower() else (0.0, 0.0)
        if kind in "HV":
            values = [values[0] + dx, self._here[1]] if kind == "H" else [self._here[0], values[0] + dy]
            kind, dx, dy = "L", 0.0, 0.0
        given = values[5:] if kind == "A" else values
        places = [(given[k] + dx, given[k + 1] + dy) for k in range(0, len(given), 2)]
        handle = self._handle
        self._handle = _Handle("", self._here)
        self._DO[kind](self, places, values, handle)

    def lift(self) -> None:
        if self._run:
            self.path.runs.append(self._run)
        self._run = []

    def _add(self, curve: Curve) -> None:
        self._run.append(curve)
        self.drawn += 1

    def _move(self, places: list[Point], _: list[float], __: object) -> None:
        self.lift()
        self._here = self._first = places[0]
        self.path.start = self.path.start or places[0]

    def _line(self, places: list[Point], _: list[float], __: object) -> None:
        if places[0] != self._here:
            self._add(Line(self._here, places[0]))
        self._here = places[0]

    def _close(self, _: list[Point], __: list[float], ___: object) -> None:
        self._line([self._first], [], None)
        self.lift()

    def _bezier(self, places: list[Point], _: list[float], __: object) -> None:
        degree = len(places)
        if any(place != self._here for place in places):
            before = self._run[-1] if self._run else None
            self.points = (self.points if isinstance(before, Spline) and before.degree == degree else 1) + degree
            self._add(Spline(degree, (self._here, *places), BEZIER_KNOTS[degree]))
        self._handle = _Handle("C" if degree == 3 else "Q", places[-2])
        self._here = places[-1]

    def _smooth(self, places: list[Point], values: list[float], handle: _Handle) -> None:
        """The first handle mirrors the last one of the curve before, if that was of the same degree."""
        kind = "C" if len(places) == 2 else "Q"
        (x, y), (hx, hy) = self._here, handle.at if handle.kind == kind else self._here
        self._bezier([(2 * x - hx, 2 * y - hy), *places], values, handle)

    def _arc(self, places: list[Point], values: list[float], _: object) -> None:
        end = places[-1]
        if end != self._here:
            self._add(arc_between(self._here, end, values[:5]))
        self._here = end

    _DO: ClassVar[dict[str, Callable[[_PathPen, list[Point], list[float], _Handle], None]]] = {
        "M": _move,
        "L": _line,
        "Z": _close,
        "C": _bezier,
        "Q": _bezier,
        "S": _smooth,
        "T": _smooth,
        "A": _arc,
    }


def arc_between(start: Point, end: Point, values: list[float]) -> Curve:
    """Return the arc of an A command: a line without radii, an arc for equal ones, else a part of an ellipse.

    Radii too small for the ends grow until the chord is a diameter.

    Args:
        start, end: different places.
        values: rx, ry, turn of the x axis in degrees, large flag, sweep flag.

    References:
        SVG 1.1, appendix F.6 (end points to centre).
    """
    rx, ry = abs(values[0]), abs(values[1])
    large, sweep = values[3] != 0, values[4] != 0
    if not (rx > 0 and ry > 0):
        return Line(start, end)
    turn = 0.0 if rx == ry else math.radians(values[2] % 360.0)
    c, s = math.cos(turn), math.sin(turn)
    dx, dy = end[0] - start[0], end[1] - start[1]
    # half the chord where the ellipse is the unit circle
    hx, hy = (
        (c * dx + s * dy) / 2 / rx,
        (c * dy - s * dx) / 2 / ry,
    )
    half = math.hypot(hx, hy)
    grown = max(half, 1.0)
    over = 1.0 - half
    off = 0.0 if over <= _ROUNDING else math.sqrt(over * (1.0 + half)) * (1.0 if large != sweep else -1.0)
    ux, uy = -hy / half * off, hx / half * off  # from the middle of the chord to the centre, on the unit circle
    middle = (start[0] + end[0]) / 2, (start[1] + end[1]) / 2
    centre = middle[0] + c * ux * rx - s * uy * ry, middle[1] + s * ux * rx + c * uy * ry
    if rx == ry:
        return Arc(start, end, centre, sweep)
    first, last = math.atan2(-hy - uy, -hx - ux), math.atan2(hy - uy, hx - ux)
    return _part(centre, ((c * rx * grown, s * rx * grown), (-s * ry * grown, c * ry * grown)), (first, last), sweep)


def _part(centre: Point, axes: tuple[Point, Point], angles: tuple[float, float], sweep: bool) -> Curve:
    """Return the part of an ellipse from one angle to the other, the way the flag says."""
    first, last = angles if sweep else angles[::-1]
    last = first + ((last - first) % math.tau or math.tau)
    made = ellipse((centre, *axes), first, last, sweep)
    return made if made is not None else Line(centre, centre)
