"""The machine that a program is to run on: how far and how fast its axes go, how fast it turns, how it takes
corners.
"""

from __future__ import annotations

from dataclasses import dataclass

from ..core.errors import ParameterError

Triple = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class LinearAxis:
    """One linear axis.

    Attributes:
        low, high: ends of its travel, mm, machine coordinates; low < high.
        rapid: mm/min, > 0; no motion is faster along this axis.
        acceleration: mm/s2, > 0.
    """

    low: float
    high: float
    rapid: float
    acceleration: float

    def __post_init__(self) -> None:
        if not self.low < self.high:
            raise ParameterError(
                f"Travel goes from {self.low:g} to {self.high:g} mm; the low end must be less than the high one."
            )
        if not (self.rapid > 0 and self.acceleration > 0):
            raise ParameterError(
                f"Rapid rate is {self.rapid:g} mm/min and acceleration {self.acceleration:g} mm/s2; "
                "both must be greater than 0."
            )

    @property
    def travel(self) -> float:
        """Length of the travel, mm."""
        return self.high - self.low


@dataclass(frozen=True, slots=True)
class SpindleRange:
    """What the spindle can do.

    Attributes:
        low, high: speeds that it can turn at, rpm; 0 < low <= high.
        power: that it has at the tool, W, >= 0; 0 = not known.
    """

    low: float
    high: float
    power: float = 0.0

    def __post_init__(self) -> None:
        if not 0 < self.low <= self.high:
            raise ParameterError(
                f"Spindle range is {self.low:g} to {self.high:g} rpm; the low end must be greater than 0 "
                "and the high end not less."
            )
        if not self.power >= 0:
            raise ParameterError(f"The spindle's power is {self.power:g} W; it must be 0 (not known) or more.")


@dataclass(frozen=True, slots=True)
class Machine:
    """A machine profile.

    Attributes:
        title: the machine's name for people.
        x, y, z: its axes.
        spindle: its speeds and power.
        largest_feed: mm/min, > 0.
        tool_change: s from the last motion with one tool to the first with the next; >= 0.
        corner: how far the control leaves a corner where the program does not say it (G64 without P), mm, >= 0;
            0 = it goes through every corner exactly.
        work_origin: where the program's zero is, mm, machine coordinates; None = not known, so that only the size of a
            program is held against the travel.
    """

    title: str
    x: LinearAxis
    y: LinearAxis
    z: LinearAxis
    spindle: SpindleRange
    largest_feed: float
    tool_change: float = 0.0
    corner: float = 0.01
    work_origin: Triple | None = None

    def __post_init__(self) -> None:
        if not self.largest_feed > 0:
            raise ParameterError(
                f"{self.title}: largest feed is {self.largest_feed:g} mm/min; it must be greater than 0."
            )
        if not (self.tool_change >= 0 and self.corner >= 0):
            raise ParameterError(
                f"{self.title}: tool change takes {self.tool_change:g} s and corners {self.corner:g} mm; "
                "neither may be less than 0."
            )

    @property
    def axes(self) -> tuple[LinearAxis, LinearAxis, LinearAxis]:
        """X, Y, Z."""
        return (self.x, self.y, self.z)
