"""Tools that draw curves end to end: line and polyline."""

from __future__ import annotations

from dataclasses import dataclass, field

from ....drafting.curves.shapes import arc_through
from ....drafting.expressions.words import point_text
from ....model.curves import Curve, Line, Point
from .drawing_tool import DrawingTool, ToolPreview, arc_label


@dataclass
class LineTool(DrawingTool):
    """Lines end to end; each click is a line of its own, so that undo takes back one."""

    name = "Line"
    prompts = ("start point", "next point; Enter ends")

    @property
    def prompt(self) -> str:
        """What is expected next."""
        return super().prompt + (", close closes" if len(self.points) > 2 else "")

    def add(self, point: Point) -> str | None:
        """Take a point; from the second on every one makes a line, and the first again ends the chain."""
        before, first = self.base, self.points[:1]
        self.points.append(point)
        if before is None:
            return None
        if [point] == first:
            self.finish()
        return self.line([before, point])

    def word(self, word: str) -> str | None:
        """Close the chain at `close` or `c`."""
        return self.add(self.points[0]) if word in ("close", "c") and len(self.points) > 2 else None

    def back(self) -> str | None:
        """Take the last line back; the chain follows when it is undone."""
        if len(self.points) > 1:
            return "undo"
        return super().back()

    def after_undo(self, last: Point) -> None:
        """Go on from where the drawing ends now; the chain is cut there, or at its first point."""
        if last in self.points:
            del self.points[self.points.index(last) + 1 :]
        else:
            del self.points[1:]

    def line(self, points: list[Point]) -> str:
        """Return `line a b`."""
        return f"line {point_text(points[0])} {point_text(points[1])}"

    def show(self, cursor: Point) -> ToolPreview:
        """Return the next line."""
        return ToolPreview((Line(self.points[-1], cursor),))


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
        self.words += (
            ["arc", point_text(self.via), point_text(point)]
            if self.arc and self.via is not None
            else [point_text(point)]
        )
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

    def back(self) -> str | None:
        """Take back an arc just begun, or the last point."""
        if self.arc:
            self.arc, self.via = self.via is not None, None
        elif self.points:
            del self.points[-1:], self.words[-3 if self.words[-3:-2] == ["arc"] else -1 :]
        return None

    def line(self, points: list[Point]) -> str:
        """Return `polyline a b …`."""
        return " ".join(["polyline", *map(point_text, points)])

    def show(self, cursor: Point) -> ToolPreview:
        """Return everything so far and the next segment."""
        done = self._done()
        if self.via is not None:
            arc = arc_through(self.points[-1], self.via, cursor)
            return ToolPreview((*done, arc), label=arc_label(arc, self.unit))
        return ToolPreview((*done, Line(self.points[-1], cursor)))

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
