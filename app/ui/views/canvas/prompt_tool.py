"""Tools that ask one question after the other, and put the answers in a line of the drawing language."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from itertools import pairwise
from typing import ClassVar

from ....core.tolerances import WELD
from ....drafting.expressions.words import ids_text, name_text, number_text, point_text
from ....model.curves import Curve, Line, Point
from .drawing_tool import DrawingTool, InputKind, Pick, ToolContext, ToolPreview
from .value_boxes import NamedValue, PointBoxes, ValueBox, ValueKind

MOST_SHOWN = 400
"""Of a larger selection so many curves, evenly spread, are shown at their new places before a click."""

Answer = Point | float | Pick | str


@dataclass(frozen=True, slots=True)
class Prompt:
    """One question.

    Attributes:
        prompt: what is asked. wants: what answers it.
        measure: the number that a point means as the answer; None where the point itself is the answer.
        boxes: the values that can be typed for a point, where they are not the usual ones; the one value where that is
            the answer.
        sets: the number of the tool that a typed number changes; "" where it is the answer, or a distance.
        optional: Enter passes the question over.
    """

    prompt: str
    wants: InputKind = InputKind.POINT
    measure: Callable[[Sequence[Answer], Point], float] | None = None
    boxes: PointBoxes | NamedValue | None = None
    sets: str = ""
    optional: bool = False


CHOOSE = Prompt("select curves, then Enter", InputKind.SELECTION)
"""The first question of tools that change curves; what is selected already answers it."""


@dataclass
class PromptTool(DrawingTool):
    """A tool made of questions.

    Attributes:
        asks: the questions. form: the line, with `{0}` for the first answer, and `{word}` for a number or a toggle.
        toggles: words that switch something on and off. numbers: words and first values of numbers that stay as they
            were set; whole ones are counts, which Up and Down change, too.
        no_lengths: those numbers that are counts or angles. box_names: what their boxes are called where the word does
            not say it.
        once: the tool ends with its first line. keeps: so many answers stay for the next line.
        answers: given so far. setting: the number that is being asked for, or "".
    """

    answers: list[Answer] = field(default_factory=list)
    on: set[str] = field(default_factory=set)
    setting: str = ""
    desk: ToolContext | None = None

    asks: ClassVar[tuple[Prompt, ...]] = ()
    form: ClassVar[str] = ""
    toggles: ClassVar[tuple[str, ...]] = ()
    numbers: ClassVar[Mapping[str, float]] = {}
    no_lengths: ClassVar[frozenset[str]] = frozenset()
    box_names: ClassVar[Mapping[str, str]] = {}
    once: ClassVar[bool] = False
    keeps: ClassVar[int] = 0

    @property
    def ask(self) -> Prompt:
        """The question now."""
        return self.asks[min(len(self.answers), len(self.asks) - 1)]

    @property
    def picked(self) -> tuple[Curve, ...]:
        """The curves that were picked so far."""
        return tuple(answer.curve for answer in self.answers if isinstance(answer, Pick))

    @property
    def wants(self) -> InputKind:
        """What is asked for now."""
        return InputKind.POINT if self.setting else self.ask.wants

    @property
    def options(self) -> tuple[str, ...]:
        """Words that may be typed now."""
        return (*self.toggles, *self.numbers)

    @property
    def busy(self) -> bool:
        """True while something has been answered that Esc would give up."""
        return len(self.answers) > (1 if self.asks[0].wants is InputKind.SELECTION else 0) or bool(self.setting)

    @property
    def goes_on(self) -> bool:
        """True where Enter carries on."""
        return self.busy or (self.wants is InputKind.SELECTION and bool(self.selection))

    @property
    def selection(self) -> frozenset[int]:
        """What is selected."""
        return self.desk.document.selection if self.desk is not None else frozenset()

    @property
    def prompt(self) -> str:
        """What is expected next, and how options stand."""
        if self.setting:
            return f"{self.name}: {self.setting}, now {self.shown(self.setting)}"
        stand = [f"{word} {'on' if word in self.on else 'off'}" for word in self.toggles]
        stand += [f"{word} {self.shown(word)}" for word in self.numbers]
        options = f"   [{', '.join(stand)}]" if stand and self.wants is not InputKind.SELECTION else ""
        return f"{self.name}: {self.ask.prompt}{options}"

    def begin(self, desk: ToolContext) -> str | None:
        """Take up work; a selection that is there answers the first question."""
        self.desk = desk
        return self.finish() if self.asks[0].wants is InputKind.SELECTION and desk.document.selection else None

    @property
    def takes_length(self) -> bool:
        """Whether the number that is asked for is a length."""
        word = self.setting or self.ask.sets
        asked = self.ask.boxes
        return (
            word not in self.no_lengths
            if word
            else not isinstance(asked, NamedValue) or asked.quantity is ValueKind.LENGTH
        )

    @property
    def boxes(self) -> PointBoxes | ValueBox | None:
        """What can be typed in the place of a click now."""
        asked, measure = self.ask.boxes, self.ask.measure
        if self.setting or self.wants not in (InputKind.POINT, InputKind.EITHER):
            return None
        if isinstance(asked, NamedValue):
            return ValueBox(asked, partial(measure, tuple(self.answers)) if measure is not None else None)
        return asked or super().boxes

    @property
    def number_boxes(self) -> Mapping[str, NamedValue]:
        """The number that is asked for, else all of the tool; none while it asks for curves to be selected or words."""
        if self.wants in (InputKind.SELECTION, InputKind.WORDS):
            return {}
        return {
            word: NamedValue(self.box_names.get(word, word.capitalize()), self._quantity(word))
            for word in ([self.setting] if self.setting else self.numbers)
        }

    @property
    def numbers_first(self) -> bool:
        """Whether a number typed now is one of the tool."""
        return bool(self.setting or self.ask.sets)

    def number_shown(self, word: str, cursor: Point) -> float:
        """Return a number of the tool."""
        return self.value(word)

    def _quantity(self, word: str) -> ValueKind:
        if isinstance(self.numbers[word], int):
            return ValueKind.COUNT
        return ValueKind.ANGLE if word in self.no_lengths else ValueKind.LENGTH

    def shown(self, word: str) -> str:
        """Return a number of the tool as it is shown."""
        if self.unit == 1.0 or word in self.no_lengths:
            return number_text(self.value(word))
        return f"{number_text(round(self.value(word) / self.unit, 4))} in"

    def value(self, word: str) -> float:
        """Return a number of the tool."""
        given = self.desk.numbers.get(f"{self.name} {word}") if self.desk is not None else None
        return self.numbers[word] if given is None else given

    def set_value(self, word: str, value: float) -> None:
        """Change a number of the tool; a count becomes a whole number from 1."""
        if self.desk is not None:
            self.desk.numbers[f"{self.name} {word}"] = (
                max(1, round(value)) if isinstance(self.numbers[word], int) else value
            )

    def count_on(self, by: int) -> bool:
        """Change the count that is asked about, or the first one; return False where there is none."""
        counts = [word for word, first in self.numbers.items() if isinstance(first, int)]
        word = self.ask.sets if self.ask.sets in counts else next(iter(counts), "")
        if word:
            self.set_value(word, self.value(word) + by)
        return bool(word)

    def add(self, point: Point) -> str | None:
        """Take a point, or the number that it means."""
        return self.give(self.meant(point))

    def give(self, answer: Answer) -> str | None:
        """Take an answer; return the line when it was the last one."""
        self.answers.append(answer)
        self._keep(self.answers)
        return self.made() if len(self.answers) >= len(self.asks) else None

    def made(self) -> str:
        """Return the line of the answers, and begin anew."""
        line = self.line_of(self.answers)
        self._keep(self.answers[: self.keeps or (1 if self.asks[0].wants is InputKind.SELECTION else 0)])
        return line

    def restore(self, answers: list[Answer]) -> None:
        """Go back to answers given before."""
        self._keep(answers)

    def word(self, word: str) -> str | None:
        """Switch a toggle, ask for a number, or take the words that were asked for."""
        if self.wants is InputKind.WORDS:
            return self.give(word) or ""
        return self.choose(word)

    def choose(self, word: str) -> str | None:
        """Switch a toggle or ask for a number, also while words are asked for; return None where it is no option."""
        if word.lower() in self.toggles:
            self.on ^= {word.lower()}
        elif word.lower() in self.numbers:
            self.setting = word.lower()
        else:
            return None
        return ""

    def typed(self, value: float) -> str | None:
        """Take a typed number: for an option, or as an answer that is a number."""
        word = self.setting or self.ask.sets
        if word:
            self.set_value(word, value)
            self.setting = ""
            return ""
        return (self.give(value) or "") if self.ask.measure is not None else None

    def clear(self) -> None:
        """Give up the answers."""
        self.setting = ""
        self._keep(self.answers[:1] if self.asks[0].wants is InputKind.SELECTION and self.selection else [])

    def finish(self) -> str | None:
        """Go on from the selection, pass an optional question over, or give up the answers."""
        if self.wants is InputKind.SELECTION:
            return self.give("") if self.selection else None
        if not self.setting and self.ask.optional:
            return self.made()
        self.clear()
        return None

    def back(self) -> str | None:
        """Take the last answer back."""
        if self.busy:
            self._keep(self.answers[:-1])
        return None

    def line_of(self, answers: Sequence[Answer]) -> str:
        """Return the line of the drawing language for these answers."""
        words = {word: word if word in self.on else "" for word in self.toggles}
        numbers = {word: number_text(self.value(word)) for word in self.numbers}
        return " ".join(self.form.format(*map(answer_text, answers), **words, **numbers).split())

    def draft(self, answer: Point | float, under: Pick | None) -> str | None:
        """Return the line that a click or a typed value now would make, or None where questions stay open."""
        if (
            self.wants in (InputKind.SELECTION, InputKind.WORDS)
            or (self.wants is InputKind.CURVE and under is None)
            or self.setting
        ):
            return None
        given = [*self.answers, under if under is not None else self.meant(answer)]
        if len(given) < sum(not ask.optional for ask in self.asks):
            return None
        return self.line_of(given) + self._some_of_many()

    def draft_of_words(self, words: str) -> str | None:
        """Return the line that words typed so far would make, or None where questions stay open."""
        return self.line_of([*self.answers, words]) if words and len(self.answers) == len(self.asks) - 1 else None

    def meant(self, answer: Point | float) -> Point | float:
        """Return the number that a point means where one is asked for; all else as it is."""
        measure = self.ask.measure
        return answer if measure is None or isinstance(answer, float) else round(measure(self.answers, answer), 6)

    def stand_in(self, answer: Point | float) -> tuple[Curve, ...]:
        """Return what is shown where the line of an answer draws nothing: what is known of the shape already."""
        return tuple(Line(a, b) for a, b in pairwise(self.points) if math.dist(a, b) >= WELD)

    def helpers(self, cursor: Point) -> ToolPreview:
        """Return lines of construction for the mouse at a point."""
        if self.base is None or self.wants in (InputKind.CURVE, InputKind.WORDS) or math.dist(self.base, cursor) < WELD:
            return ToolPreview()
        return ToolPreview(helpers=(Line(self.base, cursor),))

    def _some_of_many(self) -> str:
        """Return what limits a trial to some curves of a large selection."""
        if self.asks[0].wants is not InputKind.SELECTION or len(self.selection) <= MOST_SHOWN:
            return ""
        chosen = sorted(self.selection)
        return " " + ids_text(chosen[:: -(-len(chosen) // MOST_SHOWN)])

    def _keep(self, answers: Sequence[Answer]) -> None:
        self.answers = list(answers)
        self.points = [a for a in self.answers if isinstance(a, tuple)]


def answer_text(answer: Answer) -> str:
    """Return an answer as the language writes it; a pick is its number and its place."""
    if isinstance(answer, Pick):
        return f"{answer.id} {point_text(answer.at)}"
    if isinstance(answer, str):
        return name_text(answer) if answer else ""
    return point_text(answer) if isinstance(answer, tuple) else number_text(answer)


def point_of(answers: Sequence[Answer], index: int) -> Point:
    """Return an answer that is a point, or the place of a pick."""
    answer = answers[index]
    if isinstance(answer, Pick):
        return answer.at
    assert isinstance(answer, tuple)
    return answer


def distance_from(index: int) -> Callable[[Sequence[Answer], Point], float]:
    """Return the measure of how far a point lies from an answer, mm."""
    return lambda answers, point: math.dist(point_of(answers, index), point)


def direction_from(index: int) -> Callable[[Sequence[Answer], Point], float]:
    """Return the measure of the direction in which a point lies from an answer, degrees in [0, 360)."""

    def measure(answers: Sequence[Answer], point: Point) -> float:
        (x, y) = point_of(answers, index)
        return math.degrees(math.atan2(point[1] - y, point[0] - x)) % 360

    return measure


def distance_aside(answers: Sequence[Answer], point: Point) -> float:
    """Return how far a point lies beside the line through the first two answers, mm."""
    (ax, ay), (bx, by) = point_of(answers, 0), point_of(answers, 1)
    size = math.dist((ax, ay), (bx, by))
    return abs((bx - ax) * (point[1] - ay) - (by - ay) * (point[0] - ax)) / size if size > WELD else 0.0
