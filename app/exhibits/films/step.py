"""A step of one of the five texts: what it says, what came of it here, and a picture of that."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from ...formats.plot.page import PlotPage


class PublishedText(Enum):
    """The five texts.

    Attributes:
        title: what it is about. number: of the publication.
    """

    title: str
    number: str

    def __new__(cls, letter: str, title: str, number: str) -> PublishedText:
        """Keep title and number beside the letter."""
        text = object.__new__(cls)
        text._value_ = letter
        text.title, text.number = title, number
        return text

    A = "A", "Tool paths from a line drawing", "JPH07107645B2"
    B = "B", "Seeing the cut before cutting", "JP3571564B2"
    C = "C", "A compound surface, told apart by surface", "JPH0661675B2"
    D = "D", "A smooth curve from approximate points", "JP4800873B2"
    E = "E", "A curve with a proven shape error", "JP 2014-242013"


TEXTS = {text.value: text for text in PublishedText}
"""The texts by their letters."""


@dataclass(frozen=True, slots=True)
class FilmFigure:
    """A number that a step came to.

    Attributes:
        name: what it is. value: the number, or a word. unit: "mm" and the like, or "".
        published: what the text has in its place, or what its rule gives here, in the same unit; "" = nothing.
    """

    name: str
    value: float | str
    unit: str = ""
    published: float | str = ""

    @property
    def words(self) -> str:
        """The number with its unit."""
        return _spelled(self.value) + (f" {self.unit}" if self.unit else "")

    @property
    def published_words(self) -> str:
        """What the text has in its place, or ""."""
        unit = f" {self.unit}" if self.unit and self.published != "" else ""
        return _spelled(self.published) + unit


def _spelled(value: float | str) -> str:
    if isinstance(value, str):
        return value
    return f"{value:,}" if isinstance(value, int) else f"{value:.6g}"


@dataclass(frozen=True, eq=False)
class FilmStep:
    """A step.

    Attributes:
        number: as the text numbers it: S104, (f), figure 4.
        name: what it is called, in a few words.
        says: what the text says, in a sentence.
        settled: what is done here where the text leaves it open or errs, with what was computed for it; "" = nothing.
        page: the picture, a sheet.
        figures: what came of it.
        table: further numbers, a row each, the first one the heads; () = none.
    """

    number: str
    name: str
    says: str
    settled: str
    page: PlotPage
    figures: tuple[FilmFigure, ...] = ()
    table: tuple[tuple[str, ...], ...] = ()


@dataclass(frozen=True, eq=False)
class TextFilm:
    """All steps of a text on one part.

    Attributes:
        text: which. source: what it was made of. steps: in the order in which they are done.
    """

    text: PublishedText
    source: str
    steps: tuple[FilmStep, ...]
