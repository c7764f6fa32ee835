"""What every drawing tool is: points in, one line of the drawing language out. Knows no widget."""

from __future__ import annotations

import math
from collections.abc import Mapping, MutableMapping
from dataclasses import dataclass, field
from enum import Enum, auto
from typing import ClassVar

from ....core.errors import InputError
from ....core.tolerances import WELD
from ....drafting.difference import DrawingDifference
from ....drafting.document import Document
from ....model.curves import Arc, Curve, Line, Point
from .value_boxes import PLACE, SPAN, NamedValue, PointBoxes, ValueBox


class InputKind(Enum):
    """What a tool asks for: a point, a curve, a point or else a curve, curves to be selected, words to be typed."""

    POINT = auto()
    CURVE = auto()
    EITHER = auto()
    SELECTION = auto()
    WORDS = auto()


@dataclass(frozen=True, slots=True)
class Pick:
    """A curve and the place where it was pointed at, mm."""

    id: int
    at: Point
    curve: Curve


@dataclass(frozen=True, slots=True)
class ToolContext:
    """What a tool works at.

    Attributes:
        document: to look things up in; tools never change it.
        numbers: radii, distances and counts given last, by tool and word; they outlive the tool.
    """

    document: Document
    numbers: MutableMapping[str, float]


@dataclass(frozen=True, slots=True)
class ToolPreview:
    """What a running tool shows.

    Attributes:
        curves: the shape as it would become. helpers: lines of construction.
        label: live measures beside those that can be typed, and why the shape would be none.
        trial: what the tool's line would make of the drawing.
    """

    curves: tuple[Curve, ...] = ()
    helpers: tuple[Line, ...] = ()
    label: str = ""
    trial: DrawingDifference = field(default_factory=DrawingDifference)


@dataclass
class DrawingTool:
    """A tool that collects points.

    Attributes:
        points: given so far, mm.
        base: where relative coordinates and ortho start from, or None.
        unit: what lengths are typed and shown in, mm.
    """

    unit = 1.0
    points: list[Point] = field(default_factory=list)

    name: ClassVar[str] = ""
    prompts: ClassVar[tuple[str, ...]] = ()
    asked: ClassVar[tuple[PointBoxes, ...]] = ()
    """The boxes of each of the prompts, where they are not the usual ones."""

    @property
    def boxes(self) -> PointBoxes | ValueBox | None:
        """What can be typed in the place of a click now: `asked` by question, else how far and where from the point
        before.
        """
        if len(self.points) < len(self.asked):
            return self.asked[len(self.points)]
        return SPAN if self.base is not None else PLACE

    @property
    def number_boxes(self) -> Mapping[str, NamedValue]:
        """The numbers of the tool that can be typed now, by their words."""
        return {}

    @property
    def numbers_first(self) -> bool:
        """Whether a number typed now is one of the tool rather than an answer."""
        return False

    @property
    def picked(self) -> tuple[Curve, ...]:
        """The curves that were picked so far."""
        return ()

    @property
    def wants(self) -> InputKind:
        """What is asked for now."""
        return InputKind.POINT

    @property
    def exact(self) -> bool:
        """Whether the mouse aims at points of the drawing now; a curve is picked where the mouse is."""
        return self.wants is not InputKind.CURVE

    @property
    def options(self) -> tuple[str, ...]:
        """Words that may be typed now."""
        return ()

    @property
    def takes_length(self) -> bool:
        """Whether a number typed now is a length, rather than a count, a factor or an angle."""
        return True

    def count_on(self, by: int) -> bool:
        """Change the count of the tool; return False where it has none."""
        return False

    @property
    def busy(self) -> bool:
        """True while a shape has been begun."""
        return bool(self.points)

    @property
    def goes_on(self) -> bool:
        """True where Enter carries on with the shape rather than ends the tool."""
        return self.busy

    def begin(self, desk: ToolContext) -> str | None:
        """Take up work; return a line when nothing has to be asked."""
        return None

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

    def typed(self, value: float) -> str | None:
        """Take a typed number that is no distance; return a finished line, "" when it was used, None when it is a
        distance.
        """
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

    def clear(self) -> None:
        """Give up the shape."""
        self.points = []

    def finish(self) -> str | None:
        """End the shape; return its line when there is one."""
        self.points = []
        return None

    def back(self) -> str | None:
        """Take the last point back; return a line to carry out, if that takes one."""
        del self.points[-1:]
        return None

    def after_undo(self, last: Point) -> None:
        """See that the document has gone back; `last` is the point that it drew last, mm."""

    def line(self, points: list[Point]) -> str:
        """Return the line of the drawing language for a whole set of points."""
        raise NotImplementedError

    def preview(self, cursor: Point) -> ToolPreview:
        """Return what the shape would be with a point at the mouse."""
        if not self.points:
            return ToolPreview()
        try:
            return self.show(cursor)
        except InputError:
            return ToolPreview(helpers=tuple(Line(p, cursor) for p in self.points[-1:]))

    def show(self, cursor: Point) -> ToolPreview:
        """Return the preview once there is a point.

        Raises:
            InputError: the shape would be none.
        """
        raise NotImplementedError


def length_label(length: float, unit: float) -> str:
    """Return a length, mm, in the unit that is shown, of so many mm."""
    return f"{length:.3f}" if unit == 1.0 else f"{length / unit:.4f} in"


def arc_label(arc: Arc, unit: float) -> str:
    """Return radius and sweep of an arc."""
    return f"R {length_label(arc.radius, unit)}   {abs(math.degrees(arc.sweep)):.2f}°"
