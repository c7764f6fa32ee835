"""Tools that put what is selected elsewhere, or in more places: each acts on the selection, or asks for one first."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

from ....core.tolerances import WELD
from ....drafting.curves.intersections import nearest_point
from ....model.curves import Point
from .drawing_tool import Pick, ToolPreview
from .prompt_tool import CHOOSE, Answer, Prompt, PromptTool, answer_text, direction_from, point_of
from .value_boxes import ANGLE, FACTOR, STEP, PointBoxes, ValueBox


def _shift_text(answers: Sequence[Answer]) -> str:
    """Return `@dx,dy` from the second answer to the third, without the noise of the subtraction."""
    a, b = point_of(answers, 1), point_of(answers, 2)
    return "@" + answer_text((round(b[0] - a[0], 9) + 0.0, round(b[1] - a[1], 9) + 0.0))


@dataclass
class MoveTool(PromptTool):
    """From a base point to another."""

    name = "Move"
    asks = (CHOOSE, Prompt("base point"), Prompt("where it goes, or @dx,dy"))
    once = True

    def line_of(self, answers: Sequence[Answer]) -> str:
        """Return `move @dx,dy`."""
        return f"move {_shift_text(answers)}"


@dataclass
class CopyTool(PromptTool):
    """From a base point to another, and to as many more as wanted."""

    name = "Copy"
    asks = (CHOOSE, Prompt("base point"), Prompt("where the copy goes; Enter ends"))
    numbers: ClassVar[Mapping[str, float]] = {"times": 1}
    no_lengths = frozenset({"times"})
    box_names: ClassVar[Mapping[str, str]] = {"times": "Copies"}
    keeps = 2

    def line_of(self, answers: Sequence[Answer]) -> str:
        """Return `copy @dx,dy [times n]`."""
        times = int(self.value("times"))
        return f"copy {_shift_text(answers)}" + (f" times {times}" if times > 1 else "")


@dataclass
class RotateTool(PromptTool):
    """About a centre."""

    name = "Rotate"
    asks = (
        CHOOSE,
        Prompt("centre"),
        Prompt("angle, or a point in its direction", measure=direction_from(1), boxes=ANGLE),
    )
    toggles = ("copy",)
    form = "rotate {1} {2} {copy}"
    once = True


@dataclass
class ScaleTool(PromptTool):
    """About a centre, by a factor or from one size to another."""

    name = "Scale"
    asks = (
        CHOOSE,
        Prompt("centre"),
        Prompt("factor, or a point of the old size", boxes=FACTOR),
        Prompt("a point of the new size, or the factor", boxes=FACTOR),
    )
    toggles = ("copy",)
    form = "scale {1} {2} {copy}"
    once = True

    @property
    def boxes(self) -> PointBoxes | ValueBox | None:
        """The factor, with a point of the old size also as the mouse says it."""
        return super().boxes if len(self.answers) < 3 else ValueBox(FACTOR, self._factor)

    def typed(self, value: float) -> str | None:
        """Take the factor."""
        if len(self.answers) < 2:
            return None
        self._keep([*self.answers[:2], value])
        return self.made()

    def line_of(self, answers: Sequence[Answer]) -> str:
        """Return `scale P factor [copy]`."""
        if len(answers) == 3:
            return super().line_of(answers)
        return super().line_of([*answers[:2], self._factor(point_of(answers, 3))])

    def draft(self, answer: Point | float, under: Pick | None) -> str | None:
        """Return the line of a factor, or of a point of the new size."""
        if isinstance(answer, float) and len(self.answers) > 1:
            return super().line_of([*self.answers[:2], answer]) + self._some_of_many()
        return super().draft(answer, under)

    def _factor(self, point: Point) -> float:
        """Return how much larger a point says the size is."""
        centre, old = point_of(self.answers, 1), point_of(self.answers, 2)
        return round(math.dist(centre, point) / max(math.dist(centre, old), WELD), 9)


@dataclass
class MirrorTool(PromptTool):
    """About the line through two points."""

    name = "Mirror"
    asks = (CHOOSE, Prompt("a point of the mirror line"), Prompt("another point of it"))
    toggles = ("copy",)
    form = "mirror {1} {2} {copy}"
    once = True


@dataclass
class ArrayTool(PromptTool):
    """Columns and rows, by the way from one place to the next across and up."""

    name = "Array"
    asks = (
        CHOOSE,
        Prompt("base point, or how many columns", sets="columns"),
        Prompt("that point in the next column and row, or @dx,dy", boxes=STEP),
    )
    numbers: ClassVar[Mapping[str, float]] = {"columns": 3, "rows": 2}
    no_lengths = frozenset({"columns", "rows"})
    once = True

    def line_of(self, answers: Sequence[Answer]) -> str:
        """Return `array columns rows @dx,dy`."""
        return f"array {int(self.value('columns'))} {int(self.value('rows'))} {_shift_text(answers)}"


@dataclass
class ArrayPolarTool(PromptTool):
    """Round a centre."""

    name = "Polar array"
    asks = (CHOOSE, Prompt("centre, or how many places; Up and Down change it", sets="places"))
    numbers: ClassVar[Mapping[str, float]] = {"places": 6, "over": 360.0}
    no_lengths = frozenset({"places", "over"})
    box_names: ClassVar[Mapping[str, str]] = {"places": "How many", "over": "Over angle"}
    once = True

    def line_of(self, answers: Sequence[Answer]) -> str:
        """Return `array polar P n [over angle]`."""
        over = self.value("over")
        return f"array polar {answer_text(answers[1])} {int(self.value('places'))}" + (
            "" if over == 360 else f" over {over:g}"
        )


@dataclass
class OffsetTool(PromptTool):
    """Parallels of what is selected, through a point or on its side at a distance."""

    name = "Offset"
    asks = (CHOOSE, Prompt("a point that it goes through, or the distance", sets="distance"))
    numbers: ClassVar[Mapping[str, float]] = {"distance": 0.0}

    @property
    def prompt(self) -> str:
        """What is expected next; with a distance the side only."""
        away = self.value("distance")
        if len(self.answers) == 1 and not self.setting and away:
            return f"Offset: the side where it goes   [distance {self.shown('distance')}, 0 goes through the point]"
        return super().prompt

    def line_of(self, answers: Sequence[Answer]) -> str:
        """Return `offset d P`."""
        away = self.value("distance") or self._away(point_of(answers, 1))
        return f"offset {answer_text(away)} {answer_text(answers[1])}"

    @property
    def boxes(self) -> PointBoxes | ValueBox | None:
        """The distance alone, which is a number of the tool."""
        return None

    def number_shown(self, word: str, cursor: Point) -> float:
        """Return the distance that is set, else the one to the mouse."""
        return self.value(word) or self._away(cursor)

    def helpers(self, cursor: Point) -> ToolPreview:
        """Return nothing."""
        return ToolPreview()

    def _away(self, point: Point) -> float:
        """Return how far the selected curve nearest to a point lies from it, mm."""
        part = self.desk.document.part if self.desk is not None else None
        curves = [
            curve for number in sorted(self.selection)[:100] if part and (curve := part.curve(number)) is not None
        ]
        return round(min((math.dist(nearest_point(curve, point), point) for curve in curves), default=0.0), 6)


@dataclass
class JoinTool(PromptTool):
    """Pieces that are one curve become one; small gaps close."""

    name = "Join"
    asks = (CHOOSE,)
    form = "join"
    once = True


@dataclass
class ExplodeTool(PromptTool):
    """Ellipses and splines become lines and arcs."""

    name = "Explode"
    asks = (CHOOSE,)
    form = "explode"
    once = True


@dataclass
class ReverseTool(PromptTool):
    """Curves run the other way."""

    name = "Reverse"
    asks = (CHOOSE,)
    form = "reverse"
    once = True
