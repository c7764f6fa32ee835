"""Cutting tools."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from app.errors import ParameterError


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
        diameter: cutting diameter, mm, > 0.
        kind: shape of its end.
        name: remark for lists and NC comments, or "".
        flutes: cutting edges, >= 1.
        spindle_speed: rpm, > 0.
        feed_rate, plunge_rate: mm/min, > 0.
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
        for name in ("diameter", "spindle_speed", "feed_rate", "plunge_rate"):
            value = getattr(self, name)
            if not 0 < value < 1e6:
                raise ParameterError(f"T{self.number}: {name.replace('_', ' ')} is {value:g}; it must be greater than 0.")

    @property
    def radius(self) -> float:
        """Half the diameter, mm."""
        return self.diameter / 2

    @property
    def label(self) -> str:
        """A short name for lists, such as "Flat 6 mm"."""
        return self.name or f"{self.kind.value.capitalize()} {self.diameter:g} mm"
