"""Rules that say what is done on a layer of a drawing: a template for all drawings of one kind."""

from __future__ import annotations

import re
from dataclasses import dataclass
from fnmatch import fnmatchcase

from ..core.errors import ParameterError
from .drawn_depths import UNIT, size_of
from .layer_names import typed_name, typed_pattern
from .operation import Operation
from .part import Layer

COLOURS = {
    "red": "#ff0000",
    "yellow": "#ffff00",
    "green": "#00ff00",
    "cyan": "#00ffff",
    "blue": "#0000ff",
    "magenta": "#ff00ff",
    "white": "#ffffff",
    "black": "#000000",
}
"""Words for the colours that drawings have most."""

_COLOUR = r"#[0-9a-f]{6}"
_NUMBER = r"(?P<number>\d{1,4}(?:[.,]\d{1,6})?)"
_TOLD = rf"[ _:=-]*{_NUMBER}(?![\d.,]){UNIT}"
_DEPTHS = (
    rf"(?:depth|deep|tiefe|\u6df1\u3055|\u2193|(?<![a-z])[zt]){_TOLD}",
    rf"(?<![a-z])d{_TOLD}",  # a D is a diameter where another word tells the depth
    rf"(?<![\d.,]){_NUMBER} ?(?P<unit>mm)(?![a-z])",
)


@dataclass(frozen=True, slots=True)
class LayerRule:
    """What is done on layers of some name or colour.

    Attributes:
        operation: with all its parameters, and no curves.
        name: of the layers, in any case; * stands for any letters, ? for one.
        colour: of the layers, "#rrggbb" or one of `COLOURS`; "" = any.
        depth_in_name: the depth is the number that a layer's name tells, as "pocket 4mm", "DEPTH_2.5", "z-3".
    """

    operation: Operation
    name: str = "*"
    colour: str = ""
    depth_in_name: bool = False

    def __post_init__(self) -> None:
        if not self.name.strip():
            raise ParameterError("A rule names no layer; write its name, or * for any.")
        if self.colour and self.colour.lower() not in COLOURS and re.fullmatch(_COLOUR, self.colour.lower()) is None:
            raise ParameterError(
                f"'{self.colour}' is no colour; write #rrggbb, such as #ff0000, or {', '.join(COLOURS)}."
            )
        if self.name == "*" and not self.colour:
            raise ParameterError("A rule is to have a layer's name or its colour; add name = 'POCKET*'.")

    @property
    def words(self) -> str:
        """What it is of, in words."""
        name = f"layers '{self.name}'" if self.name != "*" else "layers"
        return f"{name} of the colour {self.colour}" if self.colour else name

    def takes(self, layer: Layer) -> bool:
        """Tell whether it is of a layer."""
        colour = COLOURS.get(self.colour.lower(), self.colour.lower())
        return self._names(layer.name.casefold()) and colour in ("", layer.colour.lower())

    def _names(self, name: str) -> bool:
        """Tell whether its own name means a layer's, casefolded; a layer's whole name means that layer."""
        own = self.name.casefold(), typed_name(self.name).casefold()
        patterns = self.name.casefold(), typed_pattern(self.name).casefold()
        return name in own or any(fnmatchcase(name, pattern) for pattern in patterns)


def depth_in(name: str) -> float | None:
    """Return the depth that a layer's name tells, mm; None where it tells none, or 0."""
    for pattern in _DEPTHS:
        *_, found = (None, *re.finditer(pattern, name, re.IGNORECASE))
        if found is not None:
            return float(found["number"].replace(",", ".")) * size_of(found["unit"], 1.0) or None
    return None
