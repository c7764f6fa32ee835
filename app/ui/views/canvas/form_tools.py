"""Drawing tools that are their questions and a form of the line: arcs, circles, slots, polygons, ellipses, splines,
notes, text.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

from ....core.tolerances import WELD
from ....drafting.curves.shapes import rectangle
from ....drafting.expressions.words import number_text, point_text
from ....model.curves import Curve, Point
from .drawing_tool import InputKind, Pick, ToolContext, ToolPreview
from .prompt_tool import Answer, Prompt, PromptTool, answer_text, distance_aside, distance_from, point_of
from .value_boxes import ANGLE, SIZE, SPAN, NamedValue, PointBoxes, ValueBox, direction


def _radius_through(answers: Sequence[Answer], point: Point) -> float:
    """Return the radius of the arc from the first answer by way of a point to the second, mm."""
    a, b = point_of(answers, 0), point_of(answers, 1)
    size, aside = math.dist(a, b), distance_aside(answers, point)
    if aside < WELD:
        return max(size, 1e6 * WELD)
    return math.dist(a, point) * math.dist(b, point) / (2 * aside)


@dataclass
class ArcRadiusTool(PromptTool):
    """Start, end, radius; the arc bulges towards the mouse."""

    side: bool = True
    large: bool = False
    name = "Arc"
    asks = (
        Prompt("start point"),
        Prompt("end point"),
        Prompt("radius, or a point on the arc", measure=_radius_through, boxes=NamedValue("Radius")),
    )

    def follow(self, cursor: Point) -> None:
        """See on which side of the chord the mouse is, and whether beyond half a circle."""
        if len(self.points) == 2:
            (ax, ay), (bx, by) = self.points
            self.side = (bx - ax) * (cursor[1] - ay) - (by - ay) * (cursor[0] - ax) <= 0
            (mx, my), half = ((ax + bx) / 2, (ay + by) / 2), math.dist(*self.points) / 2
            self.large = math.dist((mx, my), cursor) > half

    def line_of(self, answers: Sequence[Answer]) -> str:
        """Return `arc start end radius r [cw] [large]`."""
        words = "" if self.side else " cw"
        return (
            f"arc {' '.join(map(answer_text, answers[:2]))} radius "
            f"{answer_text(answers[2])}{words}{' large' if self.large else ''}"
        )


@dataclass
class ArcOnTool(PromptTool):
    """Onward from the curve drawn last, without a corner; one arc after the other."""

    name = "Arc onward"
    asks = (Prompt("end point; it goes on from the curve drawn last"),)
    form = "arc on {0}"

    @property
    def base(self) -> Point | None:
        """Where the curve drawn last ends."""
        return self.desk.document.last_point if self.desk is not None else None


@dataclass
class CircleTwoTool(PromptTool):
    """The ends of a diameter."""

    name = "Circle"
    asks = (Prompt("one end of a diameter"), Prompt("the other end", boxes=SPAN.named("Diameter")))
    form = "circle diameter {0} {1}"


@dataclass
class CircleThreeTool(PromptTool):
    """Three points of it."""

    name = "Circle"
    asks = (Prompt("a point on the circle"), Prompt("a second point"), Prompt("a third point"))
    form = "circle through {0} {1} {2}"


@dataclass
class RoundRectangleTool(PromptTool):
    """Opposite corners, then the radius of the round ones."""

    name = "Rounded rectangle"
    asks = (
        Prompt("first corner"),
        Prompt("opposite corner, or @width,height", boxes=SIZE),
        Prompt(
            "radius of the corners, or a point as far from the corner",
            measure=distance_from(1),
            boxes=NamedValue("Radius"),
        ),
    )
    form = "rect {0} {1} round {2}"

    def number(self, value: float, cursor: Point) -> Point | None:
        """Return nothing: one number is no rectangle."""
        return None

    def stand_in(self, answer: Answer) -> tuple[Curve, ...]:
        """Return the rectangle before it is round, or where it cannot be."""
        corner = answer if len(self.answers) == 1 else self.answers[1] if len(self.answers) > 1 else None
        if not isinstance(corner, tuple) or any(abs(a - b) < WELD for a, b in zip(self.points[0], corner, strict=True)):
            return ()
        return rectangle(self.points[0], corner)

    def helpers(self, cursor: Point) -> ToolPreview:
        """Return nothing before the radius."""
        return super().helpers(cursor) if len(self.answers) > 1 else ToolPreview()


@dataclass
class PolygonTool(PromptTool):
    """Centre, then a corner or the middle of a side; a number before them is how many corners."""

    name = "Polygon"
    asks = (
        Prompt("centre, or how many corners", sets="corners"),
        Prompt("a corner; Up and Down change how many", boxes=SPAN.named("Radius")),
    )
    numbers: ClassVar[Mapping[str, float]] = {"corners": 6}
    no_lengths = frozenset({"corners"})
    toggles = ("side",)
    form = "polygon {corners} {0} {side} {1}"


@dataclass
class SlotTool(PromptTool):
    """The centres of both ends, then the width."""

    name = "Slot"
    asks = (
        Prompt("centre of one end"),
        Prompt("centre of the other end"),
        Prompt(
            "width, or a point on its side",
            measure=lambda answers, point: 2 * distance_aside(answers, point),
            boxes=NamedValue("Width"),
        ),
    )
    form = "slot {0} {1} {2}"


@dataclass
class EllipseTool(PromptTool):
    """Centre, end of a half axis, then the other half axis."""

    name = "Ellipse"
    asks = (
        Prompt("centre"),
        Prompt("end of a half axis", boxes=SPAN.named("Half axis")),
        Prompt("the other half axis, or a point as far", measure=distance_aside, boxes=NamedValue("Half axis")),
    )
    form = "ellipse {0} {1} {2}"


@dataclass
class SplineTool(PromptTool):
    """Points that it goes through, until Enter or close."""

    name = "Spline"
    asks = (Prompt("first point"), Prompt("next point; Enter ends, close closes"))
    toggles = ()

    @property
    def options(self) -> tuple[str, ...]:
        """Close, once there are three points."""
        return ("close",) if len(self.answers) > 2 else ()

    def give(self, answer: Answer) -> str | None:
        """Take a point; the first again closes the spline."""
        if len(self.answers) > 2 and answer == self.answers[0]:
            return self.word("close")
        self._keep([*self.answers, answer])
        return None

    def word(self, word: str) -> str | None:
        """Close at `close` or `c`."""
        if word.lower() not in ("close", "c") or len(self.answers) < 3:
            return None
        return self.made() + " close"

    def finish(self) -> str | None:
        """End the spline and return its line when it has two points or more."""
        if len(self.answers) > 1:
            return self.made()
        self.clear()
        return None

    def line_of(self, answers: Sequence[Answer]) -> str:
        """Return `spline a b …`."""
        return " ".join(["spline", *map(answer_text, answers)])

    def draft(self, answer: Point | float, under: Pick | None) -> str | None:
        """Return the spline that goes on to the mouse."""
        if not self.points or (isinstance(answer, tuple) and math.dist(self.points[-1], answer) < WELD):
            return self.line_of(self.answers) if len(self.answers) > 1 else None
        return self.line_of([*self.answers, answer])


@dataclass
class PointTool(PromptTool):
    """Points to snap to."""

    name = "Point"
    asks = (Prompt("where it is"),)
    form = "point {0}"


@dataclass
class GuideTool(PromptTool):
    """Construction lines: a point, then another or the angle; or only across or only up."""

    name = "Construction line"
    asks = (Prompt("a point of it"), Prompt("another point, or the angle", boxes=ANGLE))

    @property
    def boxes(self) -> PointBoxes | ValueBox | None:
        """The angle, once there is a point."""
        return ValueBox(ANGLE, self._angle) if self.answers else super().boxes

    def _angle(self, point: Point) -> float:
        return direction(self.points[0], point) or 0.0

    @property
    def options(self) -> tuple[str, ...]:
        """Across and up."""
        return ("across", "up")

    @property
    def prompt(self) -> str:
        """What is expected next."""
        way = next(iter(self.on), "")
        return f"{self.name}: {self.ask.prompt}   [{'across, up' if not way else way + ' on'}]"

    def word(self, word: str) -> str | None:
        """Draw only across, or only up, or freely again."""
        if word.lower() not in self.options:
            return None
        self.on = set() if word.lower() in self.on else {word.lower()}
        return ""

    def give(self, answer: Answer) -> str | None:
        """Take a point; across and up need no other."""
        self._keep([*self.answers, answer])
        return self.made() if self.on or len(self.answers) == 2 else None

    def typed(self, value: float) -> str | None:
        """Take the angle."""
        return (self.give(value) or "") if self.answers else None

    def line_of(self, answers: Sequence[Answer]) -> str:
        """Return `guide P P`, `guide P angle`, `guide across P` or `guide up P`."""
        return " ".join(["guide", *sorted(self.on), *map(answer_text, answers[:1] if self.on else answers)])

    def draft(self, answer: Point | float, under: Pick | None) -> str | None:
        """Return the line through the mouse, or at an angle."""
        return self.line_of([*self.answers, answer]) if self.on or self.answers else None


@dataclass
class DimensionTool(PromptTool):
    """Two points and where the figure stands; or a curve and where its figure stands; or three points of an angle."""

    name = "Dimension"
    toggles = ("across", "up", "angle")
    asks = (
        Prompt("first point, or a curve", InputKind.EITHER),
        Prompt("second point"),
        Prompt("where the figure stands"),
    )

    @property
    def ask(self) -> Prompt:
        """The question now; a curve needs no second point, an angle a third one."""
        if self.answers and isinstance(self.answers[0], Pick):
            return self.asks[-1]
        if "angle" in self.on and len(self.answers) < 3:
            return (
                Prompt("corner of the angle"),
                Prompt("a point of the first side"),
                Prompt("a point of the second side"),
            )[len(self.answers)]
        return super().ask

    @property
    def wanted(self) -> int:
        """How many answers make a line."""
        return 2 if self.answers and isinstance(self.answers[0], Pick) else 4 if "angle" in self.on else 3

    def word(self, word: str) -> str | None:
        """Switch one of the ways of measuring on, the others off."""
        if word.lower() not in self.toggles:
            return None
        self.on = set() if word.lower() in self.on else {word.lower()}
        return ""

    def give(self, answer: Answer) -> str | None:
        """Take a point or a curve."""
        self._keep([*self.answers, answer])
        return self.made() if len(self.answers) >= self.wanted else None

    def typed(self, value: float) -> str | None:
        """Take nothing: a number is a distance here."""
        return None

    def line_of(self, answers: Sequence[Answer]) -> str:
        """Return `dimension P P place P`, `dimension CURVE place P` or `dimension angle P P P place P`."""
        *what, place = answers
        way = "" if isinstance(what[0], Pick) or "angle" in self.on else " ".join(self.on)
        measured = str(what[0].id) if isinstance(what[0], Pick) else " ".join(map(answer_text, what))
        return " ".join(
            f"dimension {'angle' if 'angle' in self.on else ''} {measured} place {answer_text(place)} {way}".split()
        )

    def draft(self, answer: Point | float, under: Pick | None) -> str | None:
        """Return the line with the figure at the mouse."""
        return self.line_of([*self.answers, answer]) if len(self.answers) == self.wanted - 1 else None


FONT = Prompt("type the name of a font, Tab lists them", InputKind.WORDS)
"""Which font words are drawn in."""


@dataclass
class TextTool(PromptTool):
    """Where it stands, on a point or along a curve, then its words, typed in the command line, then a font if asked."""

    name = "Text"
    toggles = ("along", "centre", "back", "font")
    asks = (
        Prompt("lower left of the words, or their height", sets="height"),
        Prompt("type the words", InputKind.WORDS),
        FONT,
    )
    numbers: ClassVar[Mapping[str, float]] = {"height": 10.0}

    @property
    def ask(self) -> Prompt:
        """The question now; along a curve the first one is which."""
        if "along" in self.on and not self.answers:
            return Prompt("a curve where the words stand, or their height", InputKind.CURVE, sets="height")
        return super().ask

    def give(self, answer: Answer) -> str | None:
        """Take an answer; a font only where it was asked for."""
        self._keep([*self.answers, answer])
        return self.made() if len(self.answers) >= (3 if "font" in self.on else 2) else None

    def draft_of_words(self, words: str) -> str | None:
        """Return the line with what is typed so far; until a font is named, with the words in no font."""
        answers = [*self.answers, words] if words else self.answers
        return self.line_of(answers) if len(answers) > 1 else None

    def line_of(self, answers: Sequence[Answer]) -> str:
        """Return `text P height words` or `text along CURVE height words at P`, with what is switched on."""
        place, words, *font = answers
        where = f"along {place.id}" if isinstance(place, Pick) else answer_text(place)
        options = [
            "align centre" if "centre" in self.on else "",
            f"at {point_text(place.at)}" if isinstance(place, Pick) else "",
            "back" if isinstance(place, Pick) and "back" in self.on else "",
            *(f"font {answer_text(name)}" for name in font),
        ]
        line = f"text {where} {number_text(self.value('height'))} {answer_text(words)}"
        return " ".join([line, *filter(None, options)])


@dataclass
class MeasureTool(PromptTool):
    """The way between two points; with a selection its lengths and areas."""

    name = "Measure"
    asks = (Prompt("from, or a curve", InputKind.EITHER), Prompt("to"))

    def begin(self, desk: ToolContext) -> str | None:
        """Measure what is selected at once."""
        self.desk = desk
        return "measure" if desk.document.selection else None

    def give(self, answer: Answer) -> str | None:
        """Take a point; a curve is measured at once."""
        self._keep([*self.answers, answer])
        return self.made() if len(self.answers) == 2 or isinstance(answer, Pick) else None

    def line_of(self, answers: Sequence[Answer]) -> str:
        """Return `measure P P` or `measure CURVE`."""
        return " ".join(["measure", *(str(a.id) if isinstance(a, Pick) else answer_text(a) for a in answers)])

    def draft(self, answer: Point | float, under: Pick | None) -> str | None:
        """Return nothing: it changes nothing."""
        return None
