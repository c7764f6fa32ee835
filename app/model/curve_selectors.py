"""Which curves of a drawing an operation machines, in words that survive edits of the drawing.

#12             the curve with this number, and what it is joined with to one contour
layer:holes     contours of a layer: those whose first curve is on it
circles:6       circles of a diameter, mm; circles:5.9-6.1 those from one diameter to another
outer, inner    closed contours that lie in no other closed one; that lie in another one
open            lines that are not closed, strokes of letters among them
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass
from enum import Enum

from ..core.errors import ParameterError
from ..core.wording import trimmed

HELP = '"#12", "layer:holes", "circles:6", "circles:5.9-6.1", "outer", "inner" or "open"'

_MOST_NUMBER = 10**9
"""Numbers of curves are below this, as nine digits can be read."""
_QUOTED = 60
"""Letters of a text that is no selector which an error repeats."""

_NUMBER = r"(\d{1,9}(?:\.\d{1,12})?)"


@dataclass(frozen=True, slots=True)
class CurveNumber:
    """A curve by its number in the drawing, see `Entity.id`.

    Attributes:
        number: > 0; it is never given again, so an edit or an undo leaves it with its curve.
    """

    number: int

    def __post_init__(self) -> None:
        if not 0 < self.number < _MOST_NUMBER:
            raise ParameterError(f"#{self.number} is no number of a curve; use #1 to #{_MOST_NUMBER - 1}.")

    @property
    def text(self) -> str:
        """As it stands in a job file."""
        return f"#{self.number}"

    @property
    def words(self) -> str:
        """In a comment of a program."""
        return f"no. {self.number}"


@dataclass(frozen=True, slots=True)
class OnLayer:
    """The contours of a layer.

    Attributes:
        name: of the layer, in any case.
    """

    name: str

    @property
    def text(self) -> str:
        """As it stands in a job file."""
        return f"layer:{self.name}"

    @property
    def words(self) -> str:
        """In a comment of a program."""
        return f"layer {self.name}"


@dataclass(frozen=True, slots=True)
class CirclesOf:
    """The circles of a diameter.

    Attributes:
        least, most: diameter, mm, > 0; both ends are included.
    """

    least: float
    most: float

    def __post_init__(self) -> None:
        if not 0 < self.least <= self.most < math.inf:
            raise ParameterError(
                f"Circles from {self.least:g} to {self.most:g} mm are asked for; give a diameter greater than 0, "
                "or the least and then the largest one."
            )

    @property
    def text(self) -> str:
        """As it stands in a job file."""
        ends = dict.fromkeys(trimmed(each, 12) for each in (self.least, self.most))
        return f"circles:{'-'.join(ends)}"

    @property
    def words(self) -> str:
        """In a comment of a program."""
        return f"circles {self.text.partition(':')[2]} mm"


class ContourKind(Enum):
    """Contours by where they lie."""

    OUTER = "outer"
    INNER = "inner"
    OPEN = "open"

    @property
    def text(self) -> str:
        """As it stands in a job file."""
        return self.value

    @property
    def words(self) -> str:
        """In a comment of a program."""
        return self.value


Selector = CurveNumber | OnLayer | CirclesOf | ContourKind


def read_selector(text: str) -> Selector:
    """Return what a text selects; its words count in any case, since some controls write capitals alone.

    Raises:
        ParameterError: it is no selector.
    """
    plain = text.strip()
    word = plain.casefold()
    if match := re.fullmatch(r"#(\d{1,9})", word):
        return CurveNumber(int(match[1]))
    if text.casefold().startswith("layer:"):
        return OnLayer(text[len("layer:") :])
    if match := re.fullmatch(rf"circles:\s*{_NUMBER}(?:\s*-\s*{_NUMBER})?", word):
        return CirclesOf(float(match[1]), float(match[2] or match[1]))
    if word in {each.value for each in ContourKind}:
        return ContourKind(word)
    shown = plain if len(plain) <= _QUOTED else f"{plain[:_QUOTED]}…"
    raise ParameterError(f"'{shown}' selects no curves; write {HELP}.")


def read_selectors(texts: str | Iterable[str]) -> tuple[Selector, ...]:
    """Return what texts select, or a single one, each once.

    Raises:
        ParameterError: one is no selector.
    """
    return tuple(dict.fromkeys(map(read_selector, [texts] if isinstance(texts, str) else texts)))


def on_layers(names: Iterable[str]) -> tuple[Selector, ...]:
    """Return the selectors of layers by their names."""
    return tuple(dict.fromkeys(map(OnLayer, names)))


def layer_names(selectors: Iterable[Selector]) -> tuple[str, ...]:
    """Return the names of the layers that are among selectors."""
    return tuple(each.name for each in selectors if isinstance(each, OnLayer))
