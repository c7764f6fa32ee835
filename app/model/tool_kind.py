"""The kinds of cutting tools: what each is called, which numbers give it its shape, and what shape that is.

A kind is registered once; tool libraries, job files, NC headers, options, sweeps, contact with surfaces and judges ask
it, and none of them names kinds to tell them apart.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import ClassVar

from ..core.toml_tables import Keyword


@dataclass(frozen=True, slots=True)
class ToolShape:
    """The numbers that give a tool its shape.

    Attributes:
        radius: of the cutter, mm.
        corner_radius: of its rounded corner, mm.
        tip_radius: of the flat or the ball at its tip, mm.
        half_angle: between its axis and its cone, radians; 0 = not known, or no cone.
    """

    radius: float
    corner_radius: float = 0.0
    tip_radius: float = 0.0
    half_angle: float = 0.0

    @property
    def cone(self) -> float:
        """How its cone rises per mm of radius; 0 where it has none, or its angle is not known."""
        return 1.0 / math.tan(self.half_angle) if self.half_angle > 0 else 0.0


@dataclass(frozen=True, slots=True)
class ToolProfile:
    """A cutter's lower side from its axis outwards: a level disc, a rounding, a cone up to the cutter's radius.

    Attributes:
        flat: radius of the disc, mm.
        fillet: radius of the rounding, mm.
        cone: rise of the cone per mm of radius; 0 = there is none, and a vertical wall follows.
    """

    flat: float = 0.0
    fillet: float = 0.0
    cone: float = 0.0


class _KindsAtHand(Keyword):
    """The kinds that come with the program, as names of their class; no field of a kind, as which they would hold one
    another.
    """

    FLAT: ClassVar[ToolKind]
    BALL: ClassVar[ToolKind]
    BULL: ClassVar[ToolKind]
    V: ClassVar[ToolKind]
    DRILL: ClassVar[ToolKind]
    TAPER: ClassVar[ToolKind]
    REAMER: ClassVar[ToolKind]
    TAP: ClassVar[ToolKind]
    THREAD_MILL: ClassVar[ToolKind]


@dataclass(frozen=True, eq=False)
class ToolKind(_KindsAtHand):
    """Shape of a cutter's end.

    Attributes:
        value: its word in libraries, job files, headers and options.
        title: its name for people.
        profile: returns the lower side that numbers of the shape make.
        keys: fields of `Tool` that it has beside the diameter, of corner_radius, tip_diameter and tip_angle.
        given: fields of `Tool` in the order in which an option tells them behind the word.
        omissible: how many of these, the last ones, may be left out.
        level: whether it leaves a level floor, so that it clears one.
        square: whether its lower edge is sharp, so that walls and floor come out as drawn.
        drills: whether it only goes straight down.
        threads: whether its teeth cut a thread: it then clears no more than the core, `tip_radius`, that is left within
            them.
        work: the word of the one kind of operation that it is for; "" = any that it can do.
        assumed_angle: full angle of its point where nobody tells it, radians; 0 = it must be told.
        usual_angle: full angle, radians, that a tool gets which becomes one of these and has none; 0 = it needs none.
        short_title: its name for people where there is little room; "" = the title.
        aliases: other words for it in spreadsheets and job files.
    """

    value: str
    title: str
    profile: Callable[[ToolShape], ToolProfile]
    keys: frozenset[str] = frozenset()
    given: tuple[str, ...] = ("diameter",)
    omissible: int = 0
    level: bool = False
    square: bool = False
    drills: bool = False
    threads: bool = False
    work: str = ""
    assumed_angle: float = 0.0
    usual_angle: float = 0.0
    short_title: str = ""
    aliases: tuple[str, ...] = ()

    @classmethod
    def words(cls) -> Mapping[str, ToolKind]:
        """Return every kind by its word."""
        return _KINDS

    @classmethod
    def other_words(cls) -> Mapping[str, str]:
        """Return the words of kinds that are also called something else, by what they are called."""
        return {alias: kind.value for kind in _KINDS.values() for alias in kind.aliases}

    @property
    def conical(self) -> bool:
        """Whether it has a cone, so that its angle gives it its shape."""
        return "tip_angle" in self.keys

    @property
    def needs_tip(self) -> bool:
        """Whether the diameter of its tip is part of what makes it one of these; else 0 will do."""
        return "tip_diameter" in self.given[: len(self.given) - self.omissible]

    def spelled(self, diameter: str = "D") -> str:
        """Return how an option tells such a tool: "bull:D:CORNER"; with all that may be left out."""
        return ":".join((self.value, *(_SPELLED.get(key, diameter) for key in self.given)))

    def __repr__(self) -> str:
        return f"ToolKind({self.value})"

    def __reduce__(self) -> tuple[Callable[[object], ToolKind], tuple[str]]:
        """Be the same kind wherever it is taken to."""
        return tool_kind, (self.value,)


_SPELLED = {"corner_radius": "CORNER", "tip_diameter": "TIP", "tip_angle": "ANGLE"}

_KINDS: dict[str, ToolKind] = {}


def register(kind: ToolKind) -> ToolKind:
    """Make a kind of tool known, and return it.

    Raises:
        ValueError: another kind has its word.
    """
    if _KINDS.setdefault(kind.value, kind) is not kind:
        raise ValueError(f"two kinds of tool are called {kind.value}")
    return kind


def withdraw(kind: ToolKind) -> None:
    """Forget a kind."""
    _KINDS.pop(kind.value, None)


def tool_kinds() -> tuple[ToolKind, ...]:
    """Return all kinds, in the order of their registration."""
    return tuple(_KINDS.values())


def tool_kind(word: object) -> ToolKind:
    """Return the kind that a word stands for, or that is one already.

    Raises:
        KeyError: there is none.
    """
    return word if isinstance(word, ToolKind) else _KINDS[str(word)]


def shape_keys(kind: ToolKind) -> frozenset[str]:
    """Return which of corner_radius, tip_diameter and tip_angle tools of a kind have beside their diameter."""
    return kind.keys


_CORE = 0.7
"""Of the diameter: the core of a thread-cutting tool where nobody tells it; no coarse thread from M1.6 on has less."""


def core_radius(shape: ToolShape) -> float:
    """Return what a tool that cuts threads clears, mm of radius: what lies within its teeth."""
    return shape.tip_radius or _CORE * shape.radius


ToolKind.FLAT = register(
    ToolKind(
        "flat", "Flat end mill", lambda shape: ToolProfile(shape.radius), level=True, square=True, aliases=("end",)
    )
)

ToolKind.BALL = register(
    ToolKind(
        "ball",
        "Ball end mill",
        lambda shape: ToolProfile(0.0, shape.radius),
        short_title="Ball",
        aliases=("ball-nose", "ballnose"),
    )
)

ToolKind.BULL = register(
    ToolKind(
        "bull",
        "Bull-nose mill",
        lambda shape: ToolProfile(shape.radius - shape.corner_radius, shape.corner_radius),
        keys=frozenset({"corner_radius"}),
        given=("diameter", "corner_radius"),
        level=True,
        short_title="Bull-nose",
        aliases=("bull-nose", "bullnose"),
    )
)

ToolKind.V = register(
    ToolKind(
        "v",
        "V cutter",
        lambda shape: ToolProfile(shape.tip_radius, 0.0, shape.cone),
        keys=frozenset({"tip_angle", "tip_diameter"}),
        given=("diameter", "tip_angle"),
        usual_angle=math.radians(90.0),
        short_title="V",
        aliases=("v-bit", "chamfer", "countersink", "spot"),
    )
)

ToolKind.DRILL = register(
    ToolKind(
        "drill",
        "Drill",
        lambda shape: ToolProfile(shape.tip_radius, 0.0, shape.cone),
        keys=frozenset({"tip_angle"}),
        given=("diameter", "tip_angle"),
        omissible=1,
        drills=True,
        assumed_angle=math.radians(118.0),  # the trade's usual grind
        usual_angle=math.radians(118.0),
    )
)

ToolKind.TAPER = register(
    ToolKind(
        "taper",
        "Tapered ball mill",
        lambda shape: ToolProfile(0.0, shape.tip_radius, shape.cone),
        keys=frozenset({"tip_angle", "tip_diameter"}),
        given=("tip_diameter", "tip_angle", "diameter"),
        usual_angle=math.radians(10.0),
        short_title="Tapered ball",
    )
)

ToolKind.REAMER = register(
    ToolKind("reamer", "Reamer", lambda shape: ToolProfile(shape.radius), square=True, drills=True, work="ream")
)

ToolKind.TAP = register(
    ToolKind(
        "tap",
        "Tap",
        lambda shape: ToolProfile(core_radius(shape)),
        keys=frozenset({"tip_diameter"}),
        given=("diameter", "tip_diameter"),
        omissible=1,
        drills=True,
        threads=True,
        work="tap",
    )
)

ToolKind.THREAD_MILL = register(
    ToolKind(
        "thread-mill",
        "Thread mill",
        lambda shape: ToolProfile(core_radius(shape)),
        keys=frozenset({"tip_diameter"}),
        given=("diameter", "tip_diameter"),
        omissible=1,
        square=True,
        threads=True,
        work="thread",
        aliases=("thread mill", "threadmill"),
    )
)
