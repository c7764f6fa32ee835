"""Drawing tools: points in, one line of the drawing language out, and what to show meanwhile. Knows no widget."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import ClassVar

from app.edit.numbers import number_text
from app.edit.shapes import arc_about, arc_through, circle, on_circle, rectangle
from app.edit.words import point_text
from app.errors import InputError
from app.model.curves import Arc, Curve, Line, Point
from app.tolerances import WELD
from app.ui.canvas.modes import CanvasTool


@dataclass(frozen=True, slots=True)
class Preview:
    """What a running tool shows.

    Attributes:
        curves: the shape as it would become. helpers: lines of construction.
        label: its live measures, shown beside the mouse.
    """

    curves: tuple[Curve, ...] = ()
    helpers: tuple[Line, ...] = ()
    label: str = ""


@dataclass
class DrawingTool:
    """A tool that collects points.

    Attributes:
        points: given so far, mm.
        base: where relative coordinates and ortho start from, or None.
    """

    points: list[Point] = field(default_factory=list)

    name: ClassVar[str] = ""
    prompts: ClassVar[tuple[str, ...]] = ()

    @property
    def base(self) -> Point | None:
        """The point given last."""
        return self.points[-1] if self.points else None

    @property
    def prompt(self) -> str:
        """What is expected next."""
        return f"{self.name}: {self.prompts[min(len(self.points), len(self.prompts) - 1)]}"

    def follow(self, cursor: Point) -> None:
        """See the mouse pass a point, mm."""

    def add(self, point: Point) -> str | None:
        """Take a point; return a line of the drawing language when one is complete."""
        self.points.append(point)
        if len(self.points) < len(self.prompts):
            return None
        line = self.line(self.points)
        self.points = []
        return line

    def word(self, word: str) -> str | None:
        """Take a word such as close; return a finished line, "" when it was used, None when it means nothing here."""
        return None

    def number(self, value: float, cursor: Point) -> Point | None:
        """Return the point at a typed distance from the base towards the mouse, or None without a direction."""
        if self.base is None or math.dist(self.base, cursor) < WELD:
            return None
        (x, y), away = self.base, math.dist(self.base, cursor)
        return (x + (cursor[0] - x) / away * value, y + (cursor[1] - y) / away * value)

    @property
    def anchors(self) -> list[Point]:
        """Points given so far, which the mouse may snap to, mm."""
        return list(self.points)

    def held_straight(self, cursor: Point) -> Point:
        """Return the point straight across or up from the base that is nearest to the mouse."""
        if self.base is None:
            return cursor
        (x, y), (cx, cy) = self.base, cursor
        return (cx, y) if abs(cx - x) >= abs(cy - y) else (x, cy)

    def finish(self) -> str | None:
        """End the shape; return its line when there is one."""
        self.points = []
        return None

    def line(self, points: list[Point]) -> str:
        """Return the line of the drawing language for a whole set of points."""
        raise NotImplementedError

    def preview(self, cursor: Point) -> Preview:
        """Return what the shape would be with a point at the mouse."""
        if not self.points:
            return Preview()
        try:
            return self.show(cursor)
        except InputError:
            return Preview(helpers=tuple(Line(p, cursor) for p in self.points[-1:]))

    def show(self, cursor: Point) -> Preview:
        """Return the preview once there is a point.

        Raises:
            InputError: the shape would be none.
        """
        raise NotImplementedError


@dataclass
class LineTool(DrawingTool):
    """Lines end to end; each click is a line of its own, so that undo takes back one."""

    first: Point | None = None
    name = "Line"
    prompts = ("start point", "next point; Enter ends")

    @property
    def prompt(self) -> str:
        """What is expected next."""
        more = self.points and self.first not in (None, self.points[-1])
        return super().prompt + (", close closes" if more else "")

    def add(self, point: Point) -> str | None:
        """Take a point; from the second on every one makes a line."""
        before = self.base
        self.first = self.first if before is not None else point
        self.points = [point]
        if before is None:
            return None
        if point == self.first:
            self.finish()
        return self.line([before, point])

    @property
    def anchors(self) -> list[Point]:
        """The chain's first point, to close it, and the last."""
        return [*self.points, *([self.first] if self.first is not None else [])]

    def word(self, word: str) -> str | None:
        """Close the chain at `close` or `c`."""
        if word not in ("close", "c") or self.first is None or not self.points or self.points[-1] == self.first:
            return None
        return self.add(self.first)

    def finish(self) -> str | None:
        """End the chain; its lines are drawn already."""
        self.points, self.first = [], None
        return None

    def line(self, points: list[Point]) -> str:
        """Return `line a b`."""
        return f"line {point_text(points[0])} {point_text(points[1])}"

    def show(self, cursor: Point) -> Preview:
        """Return the next line with length and angle."""
        return Preview((Line(self.points[-1], cursor),), label=span_label(self.points[-1], cursor))


@dataclass
class PolylineTool(DrawingTool):
    """Lines and arcs end to end that become one line of the language; `a` begins an arc by way of a point."""

    words: list[str] = field(default_factory=list)
    via: Point | None = None
    arc: bool = False
    name = "Polyline"

    @property
    def prompt(self) -> str:
        """What is expected next."""
        if not self.points:
            return "Polyline: start point"
        if self.arc:
            return f"Polyline: {'a point on the arc' if self.via is None else 'the end of the arc'}"
        return "Polyline: next point; a begins an arc, close closes, Enter ends"

    def add(self, point: Point) -> str | None:
        """Take a point; the first point again closes the polyline."""
        if self.arc and self.via is None:
            self.via = point
            return None
        start = self.points[0] if self.points else None
        if point == start and len(self.points) > 2 and not self.arc:
            return self.word("close")
        self.words += ["arc", point_text(self.via), point_text(point)] if self.arc and self.via is not None else [point_text(point)]
        self.points.append(point)
        self.arc, self.via = False, None
        return self.finish() if point == start and len(self.points) > 2 else None

    def word(self, word: str) -> str | None:
        """Begin an arc at `a` or `arc`, close at `close` or `c`."""
        if word in ("a", "arc") and self.points:
            self.arc, self.via = True, None
            return ""
        if word not in ("close", "c") or len(self.points) < 3:
            return None
        self.words.append("close")
        return self.finish()

    def finish(self) -> str | None:
        """End the polyline and return its line when it has two points or more."""
        line = " ".join(["polyline", *self.words]) if len(self.points) > 1 else None
        self.points, self.words, self.arc, self.via = [], [], False, None
        return line

    def line(self, points: list[Point]) -> str:
        """Return `polyline a b …`."""
        return " ".join(["polyline", *map(point_text, points)])

    def show(self, cursor: Point) -> Preview:
        """Return everything so far and the next segment."""
        done = self._done()
        if self.via is not None:
            arc = arc_through(self.points[-1], self.via, cursor)
            return Preview((*done, arc), label=arc_label(arc))
        return Preview((*done, Line(self.points[-1], cursor)), label=span_label(self.points[-1], cursor))

    def _done(self) -> list[Curve]:
        done: list[Curve] = []
        words, at = iter(self.words[1:]), 1
        for word in words:
            if word == "arc":
                x, y = next(words).split(",")
                next(words)
                done.append(arc_through(self.points[at - 1], (float(x), float(y)), self.points[at]))
            else:
                done.append(Line(self.points[at - 1], self.points[at]))
            at += 1
        return done


@dataclass
class ArcCentreTool(DrawingTool):
    """Centre, start, end; the arc turns the way the mouse went round."""

    turn: float = 0.0
    seen: float | None = None
    name = "Arc"
    prompts = ("centre", "start point", "end point")

    def follow(self, cursor: Point) -> None:
        """Add up how far the mouse has gone round the centre since the start, radians."""
        if len(self.points) != 2:
            self.turn, self.seen = 0.0, None
            return
        (x, y), start = self.points
        here = math.atan2(cursor[1] - y, cursor[0] - x)
        before = math.atan2(start[1] - y, start[0] - x) if self.seen is None else self.seen
        step = math.remainder(here - before, math.tau)
        total = self.turn + step
        self.turn, self.seen = (total if abs(total) < math.tau else math.remainder(total, math.tau)), here

    def line(self, points: list[Point]) -> str:
        """Return `arc start end centre c [cw]`, the end brought onto the circle."""
        arc = self._arc(points)
        return f"arc {point_text(arc.start)} {point_text(arc.end)} centre {point_text(points[0])}" + ("" if arc.ccw else " cw")

    def show(self, cursor: Point) -> Preview:
        """Return the radius, then the arc."""
        spokes = tuple(Line(self.points[0], p) for p in (*self.points[1:], cursor))
        if len(self.points) == 1:
            return Preview(helpers=spokes, label=span_label(self.points[0], cursor, "R"))
        arc = self._arc([*self.points, cursor])
        return Preview((arc,), spokes, arc_label(arc))

    def _arc(self, points: list[Point]) -> Arc:
        centre, start, towards = points
        radius = math.dist(centre, start)
        end = towards if abs(math.dist(centre, towards) - radius) < WELD else on_circle(towards, centre, radius)
        return arc_about(start, _round(end) if end is not towards else end, centre, ccw=self.turn >= 0)


@dataclass
class ArcThreeTool(DrawingTool):
    """Start, a point on the way, end."""

    name = "Arc"
    prompts = ("start point", "a point on the arc", "end point")

    def line(self, points: list[Point]) -> str:
        """Return `arc start via end`."""
        return " ".join(["arc", *map(point_text, points)])

    def show(self, cursor: Point) -> Preview:
        """Return the chord, then the arc."""
        if len(self.points) == 1:
            return Preview(helpers=(Line(self.points[0], cursor),), label=span_label(self.points[0], cursor))
        arc = arc_through(self.points[0], self.points[1], cursor)
        return Preview((arc,), label=arc_label(arc))


@dataclass
class CircleTool(DrawingTool):
    """Centre, then radius by a point or a number."""

    name = "Circle"
    prompts = ("centre", "radius, or a point on the circle")

    def number(self, value: float, cursor: Point) -> Point | None:
        """Return a point at the typed radius; any direction will do."""
        return (self.points[0][0] + value, self.points[0][1]) if self.points else None

    def line(self, points: list[Point]) -> str:
        """Return `circle centre r`."""
        return f"circle {point_text(points[0])} {number_text(round(math.dist(*points), 6))}"

    def show(self, cursor: Point) -> Preview:
        """Return the circle with its radius."""
        radius = math.dist(self.points[0], cursor)
        return Preview((circle(self.points[0], radius),), (Line(self.points[0], cursor),), f"R {radius:.3f}")


@dataclass
class RectangleTool(DrawingTool):
    """Two opposite corners."""

    name = "Rectangle"
    prompts = ("first corner", "opposite corner, or @width,height")

    def number(self, value: float, cursor: Point) -> Point | None:
        """Return nothing: one number is no rectangle."""
        return None

    def held_straight(self, cursor: Point) -> Point:
        """Return the corner of a square."""
        if self.base is None:
            return cursor
        dx, dy = cursor[0] - self.base[0], cursor[1] - self.base[1]
        side = max(abs(dx), abs(dy))
        return (self.base[0] + math.copysign(side, dx), self.base[1] + math.copysign(side, dy))

    def line(self, points: list[Point]) -> str:
        """Return `rect a b`."""
        return f"rect {point_text(points[0])} {point_text(points[1])}"

    def show(self, cursor: Point) -> Preview:
        """Return the rectangle with width and height."""
        (x, y) = self.points[0]
        return Preview(rectangle(self.points[0], cursor), label=f"{abs(cursor[0] - x):.3f} \u00d7 {abs(cursor[1] - y):.3f}")


TOOLS: dict[CanvasTool, Callable[[], DrawingTool]] = {
    CanvasTool.LINE: LineTool, CanvasTool.POLYLINE: PolylineTool, CanvasTool.ARC_CENTRE: ArcCentreTool,
    CanvasTool.ARC_THREE: ArcThreeTool, CanvasTool.CIRCLE: CircleTool, CanvasTool.RECTANGLE: RectangleTool,
}
"""Every drawing tool; SELECT is the absence of one."""

TOOL_WORDS = {"line": CanvasTool.LINE, "polyline": CanvasTool.POLYLINE, "arc": CanvasTool.ARC_THREE, "circle": CanvasTool.CIRCLE,
              "rect": CanvasTool.RECTANGLE, "select": CanvasTool.SELECT}
"""Tools that a command word alone begins."""


def span_label(a: Point, b: Point, sign: str = "L") -> str:
    """Return length and angle of the way from a to b."""
    if math.dist(a, b) < WELD:
        return ""
    return f"{sign} {math.dist(a, b):.3f}   {math.degrees(math.atan2(b[1] - a[1], b[0] - a[0])) % 360:.2f}°"


def arc_label(arc: Arc) -> str:
    """Return radius and sweep of an arc."""
    return f"R {arc.radius:.3f}   {abs(math.degrees(arc.sweep)):.2f}°"


def _round(point: Point) -> Point:
    return (round(point[0], 6) + 0.0, round(point[1], 6) + 0.0)
