"""The values that are held while the pointer sets the rest of an answer. Knows no widget."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from ....core.tolerances import WELD
from ....model.curves import Point
from .drawing_tool import DrawingTool
from .prompt_tool import PromptTool
from .snapped_point import tidy
from .value_boxes import Held, NamedValue, PointBoxes, ValueBox, ValueKind

ORIGIN: Point = (0.0, 0.0)


@dataclass(frozen=True, slots=True)
class ValueRow:
    """One of the boxes of a question.

    Attributes:
        word: of the number of the tool that it changes, or "". part: else which value of the answer it is.
    """

    box: NamedValue
    word: str = ""
    part: int = 0

    @property
    def is_length(self) -> bool:
        """Whether it takes a length."""
        return self.box.quantity is ValueKind.LENGTH


def rows_of(tool: DrawingTool) -> tuple[ValueRow, ...]:
    """Return the boxes of a tool's question, in the order of Tab: first what a number alone means."""
    boxes = tool.boxes
    asked = boxes.boxes if isinstance(boxes, PointBoxes) else (boxes.box,) if isinstance(boxes, ValueBox) else ()
    answer = tuple(ValueRow(box, part=part) for part, box in enumerate(asked))
    numbers = tuple(ValueRow(box, word) for word, box in tool.number_boxes.items())
    return (*numbers, *answer) if tool.numbers_first else (*answer, *numbers)


@dataclass
class TypedValues:
    """What is held for the answer to one question.

    Attributes:
        held: values by box. point: a whole point that was typed in their place, mm.
    """

    held: dict[int, float] = field(default_factory=dict)
    point: Point | None = None

    @property
    def free(self) -> bool:
        """True where the pointer sets everything."""
        return not self.held and self.point is None

    def release(self, part: int | None = None) -> None:
        """Leave one value to the pointer, or all of them."""
        self.point = None
        if part is None:
            self.held.clear()
        else:
            self.held.pop(part, None)

    def hold(self, tool: DrawingTool, part: int, value: float) -> None:
        """Hold a value; where the boxes are one value said in several ways, it replaces the others."""
        if isinstance(tool.boxes, PointBoxes) and tool.boxes.either:
            self.held.clear()
        self.point, self.held[part] = None, value

    def answer(self, tool: DrawingTool, pointer: Point) -> Point | float:
        """Return what a question is answered with: the pointer's place, mm, as far as no value is held."""
        if self.point is not None:
            return tidy(self.point)
        boxes = tool.boxes
        if not self.held or boxes is None:
            return pointer
        if isinstance(boxes, ValueBox):
            return self.held[0]
        return tidy(boxes.point(tool.base or ORIGIN, pointer, self._values(boxes)))

    def open(self, tool: DrawingTool, pointer: Point | None) -> int | None:
        """Return the first box of the answer that neither a value nor the pointer sets, or None.

        Args:
            pointer: None where it is elsewhere.
        """
        boxes = tool.boxes
        if self.point is not None or not isinstance(boxes, PointBoxes):
            return None
        base = tool.base or ORIGIN
        if pointer is None and boxes.quiet:
            return next((part for part, value in enumerate(self._values(boxes)) if value is None), None)
        return boxes.open(base, base if pointer is None else pointer, self._values(boxes))

    def shown(self, tool: DrawingTool, row: ValueRow, pointer: Point) -> float | None:
        """Return what a box shows, in mm, degrees or as it is; None where that is open."""
        if isinstance(tool, PromptTool) and row.word:
            return tool.number_shown(row.word, pointer)
        boxes = tool.boxes
        if row.part in self.held:
            return self.held[row.part]
        if isinstance(boxes, ValueBox):
            return boxes.measure(pointer) if boxes.measure is not None else None
        answer = self.answer(tool, pointer)
        if not isinstance(boxes, PointBoxes) or isinstance(answer, float):
            return None
        return boxes.values(tool.base or ORIGIN, answer)[row.part]

    def refused(self, tool: DrawingTool, row: ValueRow, value: float) -> str:
        """Return why a box cannot take a value, or ""."""
        name, boxes = row.box.name, tool.boxes
        if row.box.quantity is ValueKind.COUNT and (value != int(value) or value < 1):
            return f"{name} is {value:g}; use a whole number from 1."
        if row.word or not isinstance(boxes, PointBoxes) or boxes.zero:
            return ""
        if boxes.either and value < WELD:
            return f"{name} is {value:g}; it has to be more than 0."
        return f"{name} is 0; type another." if row.is_length and math.fabs(value) < WELD else ""

    def _values(self, boxes: PointBoxes) -> Held:
        return tuple(self.held.get(part) for part in range(len(boxes.boxes)))
