"""Cutting tools."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from app.errors import ParameterError

LEAST_RATE = 1.0
"""mm/min; a slower feed would be rounded away in the digits of F."""


class ToolKind(Enum):
    """Shape of the cutter's end."""

    FLAT = "flat"
    BALL = "ball"
    BULL = "bull"
    V = "v"
    DRILL = "drill"


@dataclass(frozen=True, slots=True)
class Tool:
    """A cutter.

    Attributes:
        number: T word, 1 … 9999.
        diameter: cutting diameter, mm, in (0, 1e6).
        kind: shape of its end.
        name: remark for lists and NC comments, or "".
        flutes: cutting edges, >= 1.
        spindle_speed: rpm, in (0, 1e6).
        feed_rate, plunge_rate: mm/min, in [1, 1e6).
    """

    number: int
    diameter: float
    kind: ToolKind = ToolKind.FLAT
    name: str = ""
    flutes: int = 2
    spindle_speed: float = 12000.0
    feed_rate: float = 600.0
    plunge_rate: float = 200.0

    def __post_init__(self) -> None:
        if not 1 <= self.number <= 9999:
            raise ParameterError(f"Tool number {self.number} is out of range; use 1 to 9999.")
        for name, unit in (("diameter", "mm"), ("spindle_speed", "rpm"), ("feed_rate", "mm/min"), ("plunge_rate", "mm/min")):
            value, rate = getattr(self, name), unit == "mm/min"
            if not 0 < value < 1e6 or (rate and value < LEAST_RATE):
                least = f"{LEAST_RATE:g} {unit} or more" if rate else f"greater than 0 {unit}"
                raise ParameterError(f"T{self.number}: {name.replace('_', ' ')} is {value:g} {unit}; "
                                     f"it must be {least} and less than 1000000 {unit}.")

    @property
    def radius(self) -> float:
        """Half the diameter, mm."""
        return self.diameter / 2

    @property
    def label(self) -> str:
        """A short name for lists, such as "Flat 6 mm"."""
        return self.name or f"{self.kind.value.capitalize()} {self.diameter:g} mm"
