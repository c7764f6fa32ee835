"""Cutting tools: the shape of the cutter, how it is held, how fast it runs."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from enum import Enum
from functools import cache
from itertools import pairwise

from ..core.errors import ParameterError
from .fields import Parameter, Unit, check_kinds, declared_of, parameter, required
from .tool_kind import ToolKind, ToolProfile, ToolShape, shape_keys

__all__ = ["LEAST_RATE", "MOST_LENGTH", "FeedRow", "HolderPoint", "Tool", "ToolKind", "ToolMaterial", "shape_keys"]

LEAST_RATE = 1.0
"""mm/min; a slower feed would be rounded away in the digits of F."""

MOST_LENGTH = 1e4
"""mm; no tool, shank or holder is longer or wider."""

HolderPoint = tuple[float, float]
"""Height above the holder's lower face and radius there, mm."""

LEAST_DIAMETER = 1e-3
"""mm; what is thinner is no cutter, and its paths in any drawing would have no end."""

_NOT_ABOVE = (("flute_length", "overall_length"), ("stick_out", "overall_length"))


class ToolMaterial(Enum):
    """What a tool's edges are made of."""

    UNKNOWN = "unknown"
    HSS = "hss"
    CARBIDE = "carbide"


@dataclass(frozen=True, slots=True)
class FeedRow:
    """How fast a tool cuts one material.

    Attributes:
        material: name for people, such as "aluminium"; not empty.
        surface_speed: of the cutting edge at the full diameter, m/min, in (0, 10,000).
        feed_per_tooth: chip load, mm, in (0, 100).
        plunge_share: feed straight down as a part of the feed, in (0, 1]; a drill's is 1.
    """

    material: str
    surface_speed: float
    feed_per_tooth: float
    plunge_share: float = 0.3

    def __post_init__(self) -> None:
        if not self.material.strip():
            raise ParameterError("A row of feeds names no material; name one, such as aluminium.")
        for name, unit, most in (
            ("surface_speed", " m/min", 1e4),
            ("feed_per_tooth", " mm", 100.0),
            ("plunge_share", "", 1.0),
        ):
            value = getattr(self, name)
            if not 0 < value <= most:
                raise ParameterError(
                    f"{_said(name).capitalize()} for {self.material} is {value:g}{unit}; "
                    f"it must be greater than 0 and not more than {most:g}{unit}."
                )


@dataclass(frozen=True, slots=True)
class Tool:
    """A cutter. A length or an angle of 0 is not known.

    Lengths are mm, angles radians. The holder is straight between its points, so frustums; their heights begin with 0
    and do not fall. The corner radius is less than half the diameter, the tip's diameter less than the diameter.
    """

    number: int = required("number", "Number", "T word", Unit.COUNT, low=1, high=9999)
    diameter: float = required(
        "diameter",
        "Diameter",
        "cutting diameter, the largest one of a tapered tool",
        Unit.LENGTH,
        low=LEAST_DIAMETER,
        high=1e6,
    )
    kind: ToolKind = parameter(ToolKind.FLAT, "kind", "Kind of tool", "shape of its end", Unit.CHOICE)
    name: str = parameter("", "name", "Name", "for lists and comments of programs", Unit.TEXT)
    flutes: int = parameter(2, "flutes", "Flutes", "cutting edges", Unit.COUNT, low=1, high=100)
    spindle_speed: float = parameter(12000.0, "spindle_speed", "Spindle speed", "of the cutter", Unit.SPEED, high=1e6)
    feed_rate: float = parameter(600.0, "feed_rate", "Feed rate", "sideways", Unit.RATE, low=LEAST_RATE, high=1e6)
    plunge_rate: float = parameter(
        200.0, "plunge_rate", "Plunge rate", "straight down", Unit.RATE, low=LEAST_RATE, high=1e6
    )
    corner_radius: float = parameter(
        0.0, "corner_radius", "Corner radius", "of a bull-nose mill", Unit.LENGTH, high=MOST_LENGTH
    )
    tip_diameter: float = parameter(
        0.0,
        "tip_diameter",
        "Tip diameter",
        "of the flat at the point of a V tool, or of the ball at the tip of a tapered mill",
        Unit.LENGTH,
        high=MOST_LENGTH,
    )
    tip_angle: float = parameter(
        0.0, "tip_angle", "Tip angle", "full angle of the point or the cone", Unit.ANGLE, high=math.pi
    )
    flute_length: float = parameter(
        0.0, "flute_length", "Flute length", "from the tip up", Unit.LENGTH, high=MOST_LENGTH
    )
    overall_length: float = parameter(
        0.0, "overall_length", "Overall length", "from the tip up", Unit.LENGTH, high=MOST_LENGTH
    )
    stick_out: float = parameter(
        0.0, "stick_out", "Stick out", "from the tip to the holder's lower face", Unit.LENGTH, high=MOST_LENGTH
    )
    shank_diameter: float = parameter(
        0.0, "shank_diameter", "Shank diameter", "above the flutes", Unit.LENGTH, high=MOST_LENGTH
    )
    length_offset: float = parameter(
        0.0,
        "length_offset",
        "Length offset",
        "what G43 takes off along Z: the control's tool table",
        Unit.LENGTH,
        low=-MOST_LENGTH,
        high=MOST_LENGTH,
    )
    holder: tuple[HolderPoint, ...] = parameter(
        (), "holder", "Holder", "outline above its lower face, or its name", Unit.OUTLINE
    )
    remark: str = parameter("", "remark", "Remark", "anything else worth knowing", Unit.TEXT)
    feeds: tuple[FeedRow, ...] = parameter((), "feeds", "Feeds", "by material", Unit.FEEDS)
    tool_material: ToolMaterial = parameter(
        ToolMaterial.UNKNOWN,
        "tool_material",
        "Edges of",
        "what its edges are made of: unknown, high-speed steel or carbide",
        Unit.CHOICE,
        choices=("Unknown", "HSS", "Carbide"),
    )

    def __post_init__(self) -> None:
        check_kinds(self)
        if not 1 <= self.number <= 9999:
            raise ParameterError(f"Tool number {self.number} is out of range; use 1 to 9999.")
        self._check_above_zero()
        if not 1 <= self.flutes <= 100:
            raise ParameterError(f"T{self.number}: flutes is {self.flutes}; it must be 1 to 100.")
        self._check_lengths()
        self._check_shape()
        self._check_holder()
        self._check_feeds()

    def _check_above_zero(self) -> None:
        for name, declared in (*_declared(Unit.LENGTH)[:1], *_declared(Unit.SPEED), *_declared(Unit.RATE)):
            value, unit = getattr(self, name), declared.sign.strip()
            if not 0 < value < declared.high or value < declared.low:
                least = f"{declared.low:g} {unit} or more" if declared.low else f"greater than 0 {unit}"
                raise ParameterError(
                    f"T{self.number}: {_said(name)} is {value:g} {unit}; it must be {least} and less than "
                    f"{declared.high:.0f} {unit}."
                )

    def _check_lengths(self) -> None:
        for name, declared in _declared(Unit.LENGTH)[1:]:
            value = getattr(self, name)
            above = value > declared.low if declared.low else value >= 0
            if not (above and value < declared.high):
                raise self._wrong(name, _length_rule(declared))
        for name, above in _NOT_ABOVE:
            most = getattr(self, above)
            if most and getattr(self, name) > most:
                raise self._wrong(name, f"it must not be more than the {_said(above)}, {most:g} mm")

    def _check_shape(self) -> None:
        for name in sorted({"corner_radius", "tip_diameter", "tip_angle"} - shape_keys(self.kind)):
            if getattr(self, name):
                raise ParameterError(
                    f"T{self.number}: a tool of kind {self.kind.value} has no {_said(name)}; "
                    "take it out or choose another kind."
                )
        if self.corner_radius >= self.radius:
            raise self._wrong("corner_radius", f"it must be less than half the diameter, {self.radius:g} mm")
        if self.tip_diameter >= self.diameter:
            raise self._wrong("tip_diameter", f"it must be less than the diameter, {self.diameter:g} mm")
        if not 0 <= self.tip_angle < math.pi:
            raise ParameterError(
                f"T{self.number}: tip angle is {math.degrees(self.tip_angle):g} degrees; "
                "it must be less than 180, or 0 (not known)."
            )

    def _check_holder(self) -> None:
        heights = [height for height, _ in self.holder]
        if heights and (heights[0] != 0 or any(above < below for below, above in pairwise(heights))):
            raise ParameterError(
                f"T{self.number}: the holder's heights are {', '.join(f'{h:g}' for h in heights)} mm; "
                "they must begin with 0 and not fall."
            )
        if len(heights) == 1 or not all(
            height < MOST_LENGTH and 0 <= radius < MOST_LENGTH for height, radius in self.holder
        ):
            raise ParameterError(
                f"T{self.number}: the holder must have two points or more, each a height and a radius from 0 to "
                f"{MOST_LENGTH:g} mm."
            )

    def _check_feeds(self) -> None:
        names = [row.material.casefold() for row in self.feeds]
        for row in self.feeds:
            if names.count(row.material.casefold()) > 1:
                raise ParameterError(f"T{self.number}: feeds for {row.material} are given twice; keep one row.")

    def _wrong(self, name: str, rule: str) -> ParameterError:
        return ParameterError(f"T{self.number}: {_said(name)} is {getattr(self, name):g} mm; {rule}.")

    @property
    def radius(self) -> float:
        """Half the diameter, mm."""
        return self.diameter / 2

    @property
    def edges(self) -> ToolMaterial:
        """What its edges are made of; where nobody tells it, carbide, and high-speed steel of what goes into holes."""
        if self.tool_material is not ToolMaterial.UNKNOWN:
            return self.tool_material
        return ToolMaterial.HSS if self.kind.drills else ToolMaterial.CARBIDE

    @property
    def shape(self) -> ToolShape:
        """The numbers that give it its shape."""
        return ToolShape(self.radius, self.corner_radius, self.tip_diameter / 2, self.tip_angle / 2)

    @property
    def profile(self) -> ToolProfile:
        """Its lower side; without a cone where its angle is not known."""
        return self.kind.profile(self.shape)

    @property
    def label(self) -> str:
        """A short name for lists, such as "Flat 6 mm"."""
        return self.name or f"{self.kind.value.capitalize()} {self.diameter:g} mm"

    def as_kind(self, kind: ToolKind) -> Tool:
        """Return the tool with another end, without what tools of that kind do not have."""
        keys = shape_keys(kind)
        return replace(
            self,
            kind=kind,
            corner_radius=self.corner_radius if "corner_radius" in keys else 0.0,
            tip_diameter=self.tip_diameter if "tip_diameter" in keys else 0.0,
            tip_angle=self.tip_angle if "tip_angle" in keys else 0.0,
        )

    def in_material(self, row: FeedRow, most_rpm: float = 24000.0) -> Tool:
        """Return the tool with the speed and the feeds that a row asks for.

        Args:
            row: surface speed and chip load.
            most_rpm: the fastest that the spindle turns, > 0; where the row asks for more the chip load is kept, so the
                feeds fall with the speed.
        """
        speed = min(1000 * row.surface_speed / (math.pi * self.diameter), most_rpm)
        feed = max(speed * self.flutes * row.feed_per_tooth, LEAST_RATE)
        return replace(self, spindle_speed=speed, feed_rate=feed, plunge_rate=max(feed * row.plunge_share, LEAST_RATE))


@cache
def _declared(unit: Unit) -> tuple[tuple[str, Parameter], ...]:
    """Return the parameters of tools of a unit, by name, in the order of their declaration: the diameter first."""
    return tuple((key, placed.parameter) for key, placed in declared_of(Tool).items() if placed.parameter.unit is unit)


def _length_rule(declared: Parameter) -> str:
    """Return what a length must be."""
    if declared.low < 0:
        return f"it must be between {declared.low:g} and {declared.high:g} mm"
    return f"it must be 0 (not known) or more and less than {declared.high:g} mm"


def _said(name: str) -> str:
    """Return a field's name in words."""
    return name.replace("_", " ")
