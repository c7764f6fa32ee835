"""A scene: surfaces, stock, tools and families of passes. What is edited, saved, and made into tool paths over
surfaces.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from enum import Enum
from itertools import pairwise

from ..core.errors import ParameterError
from .job import OriginXY, OriginZ
from .operation import LEAST_LENGTH
from .part import Units
from .scene_curves import Point2, Point3
from .scene_shapes import MOST_LENGTH, Shape
from .tool import LEAST_RATE, Tool
from .tool_kind import ToolKind

Box = tuple[float, float, float, float, float, float]
Rectangle = tuple[float, float, float, float]


class LineType(Enum):
    """How a surface's part of a path is drawn; AUTO: told apart from the other surfaces."""

    AUTO = "auto"
    SOLID = "solid"
    DOTTED = "dotted"
    CHAIN = "chain"


class KeptSide(Enum):
    """Which side of an outline is kept."""

    INSIDE = "inside"
    OUTSIDE = "outside"


class CentreLimit(Enum):
    """How far the cutter's centre goes at a boundary: up to it, or only so far that the whole cutter stays inside."""

    ON = "on"
    INSIDE = "inside"


class Strategy(Enum):
    """How passes follow each other: there and back, or all the same way."""

    ZIGZAG = "zigzag"
    ONE_WAY = "one-way"


@dataclass(frozen=True)
class SceneOutline:
    """A closed outline in XY, given in exactly one way.

    Attributes:
        outline: its corners, mm, 3 or more. circle: x, y, radius. rectangle: x0, y0, x1, y1.
        drawing, layer: the closed contours of a drawing's layer; "": of all its layers.
    """

    outline: tuple[Point2, ...] = ()
    circle: Point3 | None = None
    rectangle: Rectangle | None = None
    drawing: str = ""
    layer: str = ""

    def __post_init__(self) -> None:
        ways = (bool(self.outline), self.circle is not None, self.rectangle is not None, bool(self.drawing))
        if sum(ways) != 1:
            raise ParameterError(
                "An outline is given in one way: outline, circle, rectangle or drawing; give exactly one of them."
            )
        if not all(
            abs(value) < MOST_LENGTH
            for point in (*self.outline, self.circle or (), self.rectangle or ())
            for value in point
        ):
            raise ParameterError(f"An outline holds a number that is too large; stay within {MOST_LENGTH:g} mm.")
        if self.outline and len(self.outline) < 3:
            raise ParameterError(f"An outline has {len(self.outline)} corners; give 3 or more.")
        if self.circle and not self.circle[2] > 0:
            raise ParameterError(f"A circle's radius is {self.circle[2]:g} mm; it must be greater than 0.")
        if self.rectangle and not (self.rectangle[0] < self.rectangle[2] and self.rectangle[1] < self.rectangle[3]):
            raise ParameterError("A rectangle is x0, y0, x1, y1, with x0 less than x1 and y0 less than y1; correct it.")


@dataclass(frozen=True)
class Trim(SceneOutline):
    """Of a surface only what lies over one side of an outline counts."""

    keep: KeptSide = KeptSide.INSIDE


@dataclass(frozen=True)
class Boundary(SceneOutline):
    """Where passes go: the inside of an outline."""

    centre: CentreLimit = CentreLimit.ON


@dataclass(frozen=True)
class Surface:
    """One surface of a scene.

    Attributes:
        name: unique in its scene, not empty.
        shape: before it is placed.
        colour: "#rrggbb", or "" for the next one of the palette.
        visible: it is shown. enabled: it is machined.
        rotate_deg: about X, then Y, then Z, through the origin. move: mm, after that.
        trims: in XY, of the placed surface; all of them count.
    """

    name: str
    shape: Shape
    colour: str = ""
    line: LineType = LineType.AUTO
    visible: bool = True
    enabled: bool = True
    rotate_deg: Point3 = (0.0, 0.0, 0.0)
    move: Point3 = (0.0, 0.0, 0.0)
    trims: tuple[Trim, ...] = ()

    def __post_init__(self) -> None:
        if not self.name.strip():
            raise ParameterError("A surface has no name; give it one.")
        if self.colour and not re.fullmatch(r"#[0-9a-fA-F]{6}", self.colour):
            raise ParameterError(f'The colour of {self.name} is {self.colour!r}; write it as "#009E73".')
        if not all(abs(value) < MOST_LENGTH for value in (*self.move, *self.rotate_deg)):
            raise ParameterError(f"The placement of {self.name} is out of range; stay within 1000000 mm and degrees.")


@dataclass(frozen=True)
class Passes:
    """One family of upright cutting planes, and how a tool follows the surfaces on them.

    Attributes:
        tool: T number.
        angle_deg: of the planes to the X axis. through: a place of the first of them, mm; both unless `line` is given.
        line: x0, y0, x1, y1 of the first line instead.
        pitch: from plane to plane, mm; or scallop: greatest height of the ridges between passes, mm. Exactly one, but
            for a fan, which has neither.
        fan_deg: first angle, last angle and step of planes that all go through the place `through`, like the ribs of a
            fan, degrees; None: planes are parallel.
        guide: places of a line on the XY plane that planes stand square on, `pitch` from one another along it; none:
            they do not.
        stock_to_leave: metal left on the surfaces on purpose, mm, >= 0.
        chord_tolerance: farthest that a path is above the true one, square to it, mm.
        boundary: where to go; none: wherever there is a surface.
        floor: the tip goes no lower, mm, or None.
        link_gap: ends of passes nearer than this are joined over the surface rather than by a retract, mm; None: as the
            tool needs.
        overrun: how far the tool's centre may leave the box round the surfaces, mm; None: as far as it touches one, and
            stock is there.
        feed_rate, plunge_rate, spindle_speed: other than the tool's, mm/min and rpm.
    """

    tool: int
    name: str = ""
    enabled: bool = True
    angle_deg: float = 0.0
    through: Point2 = (0.0, 0.0)
    line: Rectangle | None = None
    pitch: float | None = None
    scallop: float | None = None
    strategy: Strategy = Strategy.ZIGZAG
    stock_to_leave: float = 0.0
    chord_tolerance: float = 0.01
    floor: float | None = None
    link_gap: float | None = None
    overrun: float | None = None
    feed_rate: float | None = None
    plunge_rate: float | None = None
    spindle_speed: float | None = None
    boundary: tuple[Boundary, ...] = ()
    fan_deg: tuple[float, float, float] | None = None
    guide: tuple[Point2, ...] = ()

    def __post_init__(self) -> None:
        self._check_rule()
        if self.fan_deg is None and (self.pitch is None) == (self.scallop is None):
            raise ParameterError(
                "Passes need either a pitch or a scallop height, and not both; give one of them, in mm."
            )
        for name in ("pitch", "scallop", "chord_tolerance"):
            value = getattr(self, name)
            if value is not None and not 1e-5 <= value < 1e5:
                raise ParameterError(
                    f"{name.replace('_', ' ').capitalize()} is {value:g} mm; use 0.00001 to 100000 mm."
                )
        if not all(
            abs(value) < MOST_LENGTH for value in (self.angle_deg, *self.through, *(self.line or ()), self.floor or 0.0)
        ):
            raise ParameterError(f"The place of passes is out of range; stay within {MOST_LENGTH:g} mm and degrees.")
        for name in ("stock_to_leave", "link_gap", "overrun"):
            value = getattr(self, name)
            if value is not None and not 0 <= value < 1e5:
                raise ParameterError(f"{name.replace('_', ' ').capitalize()} is {value:g} mm; use 0 or more.")
        for name, unit in (("feed_rate", "mm/min"), ("plunge_rate", "mm/min"), ("spindle_speed", "rpm")):
            value = getattr(self, name)
            if value is not None and not LEAST_RATE <= value < 1e6:
                raise ParameterError(
                    f"{name.replace('_', ' ').capitalize()} is {value:g} {unit}; use {LEAST_RATE:g} to 1000000 {unit}."
                )
        if self.line and math.dist(self.line[:2], self.line[2:]) < LEAST_LENGTH:
            raise ParameterError("The first line of passes has no length; give two places.")
        if self.line and (self.angle_deg, self.through) != (0.0, (0.0, 0.0)):
            raise ParameterError("Passes have a line, and an angle or a place beside it; give one or the other.")

    def _check_rule(self) -> None:
        """Refuse rules of planes that cannot be, or that do not go together."""
        if self.fan_deg is not None:
            first, last, step = self.fan_deg
            if self.pitch is not None or self.scallop is not None or self.line or self.guide or self.angle_deg:
                raise ParameterError(
                    "A fan of passes goes through one place, fan_deg = [first, last, step]; take pitch, scallop, line, "
                    "guide and angle_deg away."
                )
            if not (
                0 < step <= 180 and abs(first) <= 360 and first <= last <= first + 360 and last - first <= 1e4 * step
            ):
                raise ParameterError(
                    f"A fan from {first:g} to {last:g} degrees by {step:g}; use a first angle, a last one up to 360 "
                    "degrees on, and a step above 0."
                )
        if self.guide:
            if self.pitch is None or self.line or self.angle_deg or self.through != (0.0, 0.0):
                raise ParameterError(
                    "Passes along a guide stand square on it, a pitch from one another; give a pitch, and neither "
                    "line, angle_deg nor through."
                )
            if len(self.guide) < 2 or any(math.dist(a, b) < LEAST_LENGTH for a, b in pairwise(self.guide)):
                raise ParameterError("The guide of passes needs two places or more, none twice in a row.")
            if not all(abs(value) < MOST_LENGTH for place in self.guide for value in place):
                raise ParameterError(f"The guide of passes is out of range; stay within {MOST_LENGTH:g} mm.")

    @property
    def parallel(self) -> bool:
        """Whether the planes are parallel, as the text's example has them."""
        return self.fan_deg is None and not self.guide

    @property
    def angle(self) -> float:
        """Of the planes to the X axis, radians."""
        if self.line:
            x0, y0, x1, y1 = self.line
            return math.atan2(y1 - y0, x1 - x0)
        return math.radians(self.angle_deg)

    @property
    def origin(self) -> Point2:
        """A place on the first plane, mm."""
        return self.line[:2] if self.line else self.through


@dataclass(frozen=True)
class SceneStock:
    """The block that is machined: a box x0, y0, z0, x1, y1, z1, or the surfaces' extent and a margin round it, mm."""

    box: Box | None = None
    margin: float = 0.0

    def __post_init__(self) -> None:
        if self.box and (
            self.margin
            or not all(-MOST_LENGTH < self.box[axis] < self.box[axis + 3] < MOST_LENGTH for axis in range(3))
        ):
            raise ParameterError(
                "The stock is a box x0, y0, z0, x1, y1, z1, each greater than its partner, or a margin; correct it."
            )
        if not 0 <= self.margin < 1e5:
            raise ParameterError(f"The stock's margin is {self.margin:g} mm; use 0 or more.")


@dataclass(frozen=True)
class Scene:
    """Everything that tool paths over surfaces are computed from.

    Attributes:
        surfaces: in the order of their numbers, 0 on.
        passes: in the order of cutting.
        origin_z: height of the work origin; None: Z 0 of the scene.
        safe_z, retract_z: above the stock's top, mm, as in a job; origin_xy, post and out_units as there.
    """

    name: str = "untitled"
    surfaces: tuple[Surface, ...] = ()
    stock: SceneStock = SceneStock()
    tools: tuple[Tool, ...] = (Tool(1, 6.0, ToolKind.BALL),)
    passes: tuple[Passes, ...] = ()
    origin_xy: OriginXY = OriginXY.DRAWING
    origin_z: OriginZ | None = None
    safe_z: float = 5.0
    retract_z: float = 1.0
    post: str = "linuxcnc"
    out_units: Units = Units.MM
    exact_path: bool = False

    def __post_init__(self) -> None:
        names = [surface.name for surface in self.surfaces]
        for name in names:
            if names.count(name) > 1:
                raise ParameterError(f"Two surfaces are named {name}; give each its own name.")
        if not LEAST_LENGTH <= self.retract_z <= self.safe_z < 1e5:
            raise ParameterError(
                f"Safe Z is {self.safe_z:g} mm and retract Z {self.retract_z:g} mm; "
                f"both must be {LEAST_LENGTH:g} mm or more and retract not above safe Z."
            )

    def tool(self, number: int) -> Tool:
        """Return the tool with this T number, which must be a mill.

        Raises:
            ParameterError: the scene has no such tool, or one that mills no surface.
        """
        tool = next((tool for tool in self.tools if tool.number == number), None)
        if tool is None:
            raise ParameterError(f"The scene has no tool T{number}; add it to the tools or choose another.")
        if tool.kind.drills or tool.kind.threads:
            why = "cannot cut sideways" if tool.kind.drills else "cuts nothing but threads"
            raise ParameterError(f"T{number} is a {tool.kind.value}, which {why}; choose a mill.")
        return tool
