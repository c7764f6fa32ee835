"""Tools that work on the curve under the mouse: trim, extend, break, fillet, chamfer."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

from ....drafting.expressions.words import number_text
from ....model.curves import Point
from .drawing_tool import InputKind, Pick
from .prompt_tool import Answer, Prompt, PromptTool, answer_text


@dataclass
class TrimTool(PromptTool):
    """The piece under the mouse goes, up to what crosses."""

    name = "Trim"
    asks = (Prompt("click the piece that goes; Enter ends", InputKind.CURVE),)
    form = "trim {0}"


@dataclass
class ExtendTool(PromptTool):
    """The end near the mouse goes on to what lies ahead."""

    name = "Extend"
    asks = (Prompt("click near the end that goes on; Enter ends", InputKind.CURVE),)
    form = "extend {0}"


@dataclass
class BreakTool(PromptTool):
    """In two at a point, or without what lies between two."""

    name = "Break"
    asks = (
        Prompt("click a curve where it breaks", InputKind.CURVE),
        Prompt("a second point, or Enter to break at one", optional=True),
    )

    @property
    def exact(self) -> bool:
        """The place of the break may be a point of the drawing."""
        return True

    def draft(self, answer: Point | float, under: Pick | None) -> str | None:
        """Return the break between both points; at the first one nothing is to be seen."""
        return super().draft(answer, under) if self.answers else None

    def line_of(self, answers: Sequence[Answer]) -> str:
        """Return `break CURVE P [P]`."""
        return " ".join(["break", *map(answer_text, answers)])


@dataclass
class FilletTool(PromptTool):
    """An arc that touches two curves, on the sides where they are clicked."""

    name = "Fillet"
    asks = (
        Prompt("first curve, or the radius", InputKind.CURVE, sets="radius"),
        Prompt("second curve, or the radius", InputKind.CURVE, sets="radius"),
    )
    numbers: ClassVar[Mapping[str, float]] = {"radius": 5.0}
    form = "fillet {radius} {0} {1}"

    @property
    def prompt(self) -> str:
        """What is expected next; Enter does every corner of a selection."""
        return super().prompt + ("; Enter: every corner selected" if self._for_all else "")

    @property
    def goes_on(self) -> bool:
        """True where Enter carries on."""
        return self.busy or self._for_all

    @property
    def _for_all(self) -> bool:
        return not self.answers and not self.setting and len(self.selection) > 1

    def finish(self) -> str | None:
        """Work on every corner of what is selected, or give up the first curve."""
        if self._for_all:
            return self.line_of(["", ""])
        return super().finish()


@dataclass
class ChamferTool(FilletTool):
    """A straight cut across the corner of two lines."""

    name = "Chamfer"
    asks = (
        Prompt("first line, or the size", InputKind.CURVE, sets="size"),
        Prompt("second line, or the size", InputKind.CURVE, sets="size"),
    )
    numbers: ClassVar[Mapping[str, float]] = {"size": 2.0, "second": 0.0}
    box_names: ClassVar[Mapping[str, str]] = {"second": "Second size"}

    def line_of(self, answers: Sequence[Answer]) -> str:
        """Return `chamfer d [and d] CURVE P CURVE P`."""
        second = self.value("second")
        sizes = number_text(self.value("size")) + (f" and {number_text(second)}" if second else "")
        return " ".join(["chamfer", sizes, *filter(None, map(answer_text, answers))])
