"""What the panel asks of a scene's parts: names, values, ranges, and where each stands in the scene's text. No Qt."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from enum import Enum
from typing import Any

from ....formats.job.toml import ORIGIN_XY, ORIGIN_Z
from ....formats.job.write import word_of
from ....model.scene import LineType, Passes, Scene, Strategy, Surface
from ....model.scene_shapes import ProfileOrientation, Shape
from ....model.tool import LEAST_RATE, Tool
from ....model.tool_kind import shape_keys, tool_kind, tool_kinds

Place = tuple[str | int, ...]
Choices = tuple[tuple[object, str], ...]
_FAR = 99_999.0


class SceneFieldKind(Enum):
    """How something is asked for."""

    NUMBER = "number"
    VECTOR = "vector"
    CHOICE = "choice"
    LIST = "list"
    SWITCH = "switch"
    WORDS = "words"
    COLOUR = "colour"
    TOLD = "told"
    HEADING = "heading"


@dataclass(frozen=True)
class SceneField:
    """One field.

    Attributes:
        kind: how it is asked for. name: before the value. key: where it stands within its table.
        value: a number (None: automatic), a tuple of numbers, a text, a flag, or one of `choices`.
        unit, low, high, decimals, tip, auto: of numbers; see `fields.NumberSpec`. choices: value and text of each.
        edits: what other values, by key, a new value makes; None: that of `key`.
    """

    kind: SceneFieldKind
    name: str
    key: Place = ()
    value: Any = None
    unit: str = "mm"
    low: float = -_FAR
    high: float = _FAR
    decimals: int = 3
    tip: str = ""
    auto: str = ""
    choices: Choices = ()
    edits: Callable[[Any], Mapping[Place, object]] | None = None

    def changes(self, value: object) -> Mapping[Place, object]:
        """Return the values by key that a new value makes."""
        return {self.key: value} if self.edits is None else self.edits(value)

    @property
    def form(self) -> tuple[object, ...]:
        """What stays the same while only values change."""
        return (
            self.kind,
            self.name,
            self.key,
            self.unit,
            self.choices,
            self.auto,
            self.value if self.kind is SceneFieldKind.TOLD else None,
        )


SHAPES: Mapping[str, str] = {
    "plane": "Plane",
    "sphere": "Sphere",
    "cylinder": "Cylinder",
    "cone": "Cone",
    "torus": "Torus",
    "bilinear": "Bilinear",
    "bicubic": "Bicubic",
    "bspline": "B-spline",
    "loft": "Loft",
    "ruled": "Ruled",
    "revolved": "Revolved",
    "swept": "Swept",
    "mesh": "Mesh",
    "step": "STEP faces",
}
"""What the window calls each kind of shape."""
_LINES: Choices = (
    (LineType.AUTO, "Auto"),
    (LineType.SOLID, "Solid"),
    (LineType.DOTTED, "Dotted"),
    (LineType.CHAIN, "Chain"),
)
_KEEP: Choices = ((ProfileOrientation.PARALLEL, "Parallel"), (ProfileOrientation.FOLLOW, "Follows"))
_STRATEGIES: Choices = ((Strategy.ZIGZAG, "Zigzag"), (Strategy.ONE_WAY, "One way"))
_ORIGINS: Choices = (("drawing", "Scene"), ("lower-left", "Lower left"), ("centre", "Centre"))
_HEIGHTS: Choices = ((None, "Scene"), ("top", "Top"), ("bottom", "Bottom"))


def surface_fields(surface: Surface) -> tuple[SceneField, ...]:
    """Return what is asked of a surface."""
    return (
        SceneField(SceneFieldKind.WORDS, "Name", ("name",), surface.name),
        SceneField(SceneFieldKind.COLOUR, "Colour", ("colour",), surface.colour),
        SceneField(SceneFieldKind.CHOICE, "Line", ("line",), surface.line, choices=_LINES),
        SceneField(SceneFieldKind.SWITCH, "Shown", ("visible",), surface.visible, tip="Whether it is drawn"),
        SceneField(SceneFieldKind.SWITCH, "Machined", ("enabled",), surface.enabled, tip="Whether tools go over it"),
        SceneField(SceneFieldKind.HEADING, SHAPES.get(surface.shape.kind, surface.shape.kind)),
        *shape_fields(surface.shape),
        SceneField(SceneFieldKind.HEADING, "Place"),
        SceneField(
            SceneFieldKind.VECTOR,
            "Turned by",
            ("rotate_deg",),
            surface.rotate_deg,
            "°",
            -360,
            360,
            2,
            "About X, then Y, then Z, through the origin",
        ),
        SceneField(
            SceneFieldKind.VECTOR, "Moved by", ("move",), surface.move, tip="Along X, Y and Z, after it is turned"
        ),
        *(
            (SceneField(SceneFieldKind.TOLD, f"{len(surface.trims)} trims; edit them in the text."),)
            if surface.trims
            else ()
        ),
    )


def shape_fields(shape: Shape) -> tuple[SceneField, ...]:
    """Return what is asked of a shape: its numbers and places; of curves and tables of points only how many there
    are.
    """
    asks = []
    for each in fields(shape):
        value, key, name = getattr(shape, each.name), ("shape", each.name), in_words(each.name)
        if each.name == "turn_deg":
            asks.append(
                SceneField(SceneFieldKind.VECTOR, "Turn", key, value, "°", -720, 720, 2, "From and to, about its axis")
            )
        elif isinstance(value, bool):
            asks.append(SceneField(SceneFieldKind.SWITCH, name, key, value))
        elif isinstance(value, int):
            asks.append(SceneField(SceneFieldKind.NUMBER, name, key, value, "", 1, 9, 0))
        elif isinstance(value, float):
            low = 0.0 if "radius" in each.name or each.name in ("major", "minor", "scale") else -_FAR
            asks.append(SceneField(SceneFieldKind.NUMBER, name, key, value, "" if each.name == "scale" else "mm", low))
        elif isinstance(value, ProfileOrientation):
            asks.append(SceneField(SceneFieldKind.CHOICE, name, key, value, choices=_KEEP))
        elif each.name == "faces":
            asks.append(
                SceneField(SceneFieldKind.TOLD, f"Faces {', '.join(map(str, value))}" if value else "All faces")
            )
        elif isinstance(value, str):
            asks.append(SceneField(SceneFieldKind.WORDS, name, key, value))
        elif isinstance(value, tuple) and len(value) == 3 and all(isinstance(part, float) for part in value):
            asks.append(SceneField(SceneFieldKind.VECTOR, name, key, value, "" if each.name == "axis" else "mm"))
    told = curve_texts(shape)
    return (
        (
            *asks,
            SceneField(SceneFieldKind.TOLD, f"{told}; edit {'it' if told.startswith('1 ') else 'them'} in the text."),
        )
        if told
        else tuple(asks)
    )


def curve_texts(shape: Shape) -> str:
    """Return what a shape has beside numbers, in words; "" for nothing."""
    words = (
        ("sections", "section", "sections"),
        ("corners", "corner", "corners"),
        ("points", "row of points", "rows of points"),
    )
    for name, one, many in words:
        held = getattr(shape, name, ())
        if held:
            return f"{len(held)} {one if len(held) == 1 else many}"
    names = [each.name for each in fields(shape) if each.name in ("first", "second", "profile", "guide")]
    return f"{len(names)} curve{'s' if len(names) > 1 else ''} ({', '.join(names)})" if names else ""


def passes_fields(passes: Passes, scene: Scene) -> tuple[SceneField, ...]:
    """Return what is asked of a family of passes."""
    tools = tuple(
        (tool.number, f"T{tool.number} {tool.label}")
        for tool in scene.tools
        if not (tool.kind.drills or tool.kind.threads)
    )
    by_pitch, apart = passes.pitch is not None, passes.pitch if passes.pitch is not None else passes.scallop

    def other(name: object) -> Mapping[Place, object]:
        fresh = {"pitch": 1.0, "scallop": 0.01}
        return {(key,): fresh[key] if key == name else None for key in fresh}

    direction = (
        (SceneField(SceneFieldKind.TOLD, "The first plane goes through a line; edit it in the text."),)
        if passes.line
        else (
            SceneField(
                SceneFieldKind.NUMBER,
                "Direction",
                ("angle_deg",),
                passes.angle_deg,
                "°",
                -360,
                360,
                2,
                "Of the cutting planes to the X axis",
            ),
            SceneField(
                SceneFieldKind.VECTOR, "Through", ("through",), passes.through, tip="A place on the first plane"
            ),
        )
    )
    return (
        SceneField(SceneFieldKind.WORDS, "Name", ("name",), passes.name),
        SceneField(SceneFieldKind.SWITCH, "On", ("enabled",), passes.enabled),
        SceneField(SceneFieldKind.LIST, "Tool", ("tool",), passes.tool, choices=tools),
        *direction,
        SceneField(
            SceneFieldKind.CHOICE,
            "Apart by",
            ("pitch",),
            "pitch" if by_pitch else "scallop",
            edits=other,
            choices=(("pitch", "Pitch"), ("scallop", "Scallop")),
        ),
        SceneField(
            SceneFieldKind.NUMBER,
            "Pitch" if by_pitch else "Scallop",
            ("pitch" if by_pitch else "scallop",),
            apart,
            low=1e-5,
            decimals=4,
            tip="From plane to plane" if by_pitch else "Greatest height of the ridges between passes",
        ),
        SceneField(SceneFieldKind.CHOICE, "Way", ("strategy",), passes.strategy, choices=_STRATEGIES),
        SceneField(
            SceneFieldKind.NUMBER,
            "Leave",
            ("stock_to_leave",),
            passes.stock_to_leave,
            low=0.0,
            tip="Metal left on the surfaces on purpose",
        ),
        SceneField(
            SceneFieldKind.NUMBER,
            "Chords",
            ("chord_tolerance",),
            passes.chord_tolerance,
            low=1e-5,
            high=10.0,
            decimals=4,
            tip="How far chords may be above the true path; into the metal they never go",
        ),
        SceneField(SceneFieldKind.NUMBER, "Floor", ("floor",), passes.floor, tip="The tip goes no lower", auto="none"),
        SceneField(
            SceneFieldKind.NUMBER,
            "Link gap",
            ("link_gap",),
            passes.link_gap,
            low=0.0,
            auto="auto",
            tip="Ends nearer than this are joined over the surface, others by a retract",
        ),
        SceneField(
            SceneFieldKind.NUMBER,
            "Overrun",
            ("overrun",),
            passes.overrun,
            low=0.0,
            auto="auto",
            tip="How far the tool's centre leaves the box round the surfaces; auto: as far as it touches one",
        ),
        _rate("Feed", "feed_rate", passes.feed_rate, "mm/min"),
        _rate("Plunge", "plunge_rate", passes.plunge_rate, "mm/min"),
        _rate("Speed", "spindle_speed", passes.spindle_speed, "rpm"),
        *(
            (SceneField(SceneFieldKind.TOLD, f"{len(passes.boundary)} boundaries; edit them in the text."),)
            if passes.boundary
            else ()
        ),
    )


def _rate(name: str, key: str, value: float | None, unit: str) -> SceneField:
    return SceneField(SceneFieldKind.NUMBER, name, (key,), value, unit, low=LEAST_RATE, decimals=0, auto="tool's")


def _tool_choices() -> Choices:
    """Return the kinds that machine surfaces, round ends first: what a drill leaves is a hole."""
    kinds = sorted(
        (kind for kind in tool_kinds() if not (kind.drills or kind.threads)),
        key=lambda kind: (kind.conical, kind.level),
    )
    return tuple((kind.value, kind.title) for kind in kinds)


def tool_fields(tool: Tool) -> tuple[SceneField, ...]:
    """Return what is asked of a tool."""
    keys = shape_keys(tool.kind)

    def as_kind(word: object) -> Mapping[Place, object]:
        kind = tool_kind(word)
        usual = {
            "corner_radius": tool.diameter / 8,
            "tip_angle": round(math.degrees(kind.usual_angle), 6),
            "tip_diameter": tool.diameter / 4 if kind.needs_tip else 0.0,
        }
        return {("kind",): word, **{(key,): usual[key] if key in shape_keys(kind) else None for key in usual}}

    shape = {
        "corner_radius": SceneField(
            SceneFieldKind.NUMBER, "Corner radius", ("corner_radius",), tool.corner_radius, low=0.0, high=1000
        ),
        "tip_angle": SceneField(
            SceneFieldKind.NUMBER,
            "Full angle",
            ("tip_angle",),
            math.degrees(tool.tip_angle),
            "°",
            1,
            179,
            2,
            "Of the point, or of the cone",
        ),
        "tip_diameter": SceneField(
            SceneFieldKind.NUMBER,
            "Tip",
            ("tip_diameter",),
            tool.tip_diameter,
            low=0.0,
            high=1000,
            tip="Diameter of the flat at the point, or of the ball at the tip",
        ),
    }
    return (
        SceneField(SceneFieldKind.NUMBER, "T number", ("number",), tool.number, "", 1, 9999, 0),
        SceneField(SceneFieldKind.LIST, "Kind", ("kind",), tool.kind.value, choices=_tool_choices(), edits=as_kind),
        SceneField(SceneFieldKind.NUMBER, "Diameter", ("diameter",), tool.diameter, low=0.001, high=1000),
        *(ask for key, ask in shape.items() if key in keys),
        SceneField(SceneFieldKind.NUMBER, "Speed", ("spindle_speed",), tool.spindle_speed, "rpm", 1, 200_000, 0),
        SceneField(SceneFieldKind.NUMBER, "Feed", ("feed_rate",), tool.feed_rate, "mm/min", LEAST_RATE, 100_000, 0),
        SceneField(
            SceneFieldKind.NUMBER, "Plunge", ("plunge_rate",), tool.plunge_rate, "mm/min", LEAST_RATE, 100_000, 0
        ),
    )


def scene_fields(scene: Scene, block: tuple[float, ...], posts: Choices) -> tuple[SceneField, ...]:
    """Return what is asked of the scene itself; `block` is its stock as computed, x0, y0, z0, x1, y1, z1 mm."""
    box = scene.stock.box

    def other(name: object) -> Mapping[Place, object]:
        wanted = tuple(round(value, 3) for value in block) if name == "box" else None
        return {("stock", "margin"): None, ("stock", "box"): wanted}

    def corner(low: bool) -> Callable[[Any], Mapping[Place, object]]:
        return lambda value: {("stock", "box"): (*value, *(box or block)[3:]) if low else (*(box or block)[:3], *value)}

    stock = (
        (
            SceneField(
                SceneFieldKind.NUMBER,
                "Margin",
                ("stock", "margin"),
                scene.stock.margin,
                low=0.0,
                tip="Round the surfaces",
            ),
        )
        if box is None
        else (
            SceneField(SceneFieldKind.VECTOR, "From", ("stock", "box", 0), box[:3], edits=corner(True)),
            SceneField(SceneFieldKind.VECTOR, "To", ("stock", "box", 3), box[3:], edits=corner(False)),
        )
    )
    return (
        SceneField(SceneFieldKind.WORDS, "Name", ("name",), scene.name),
        SceneField(SceneFieldKind.HEADING, "Stock"),
        SceneField(
            SceneFieldKind.CHOICE,
            "Given by",
            ("stock",),
            "margin" if box is None else "box",
            choices=(("margin", "Margin"), ("box", "Box")),
            edits=other,
        ),
        *stock,
        SceneField(SceneFieldKind.HEADING, "Program"),
        SceneField(SceneFieldKind.LIST, "Control", ("output", "post"), scene.post, choices=posts),
        SceneField(
            SceneFieldKind.CHOICE, "Zero X, Y", ("origin", "xy"), word_of(ORIGIN_XY, scene.origin_xy), choices=_ORIGINS
        ),
        SceneField(
            SceneFieldKind.CHOICE,
            "Zero Z",
            ("origin", "z"),
            word_of(ORIGIN_Z, scene.origin_z) if scene.origin_z else None,
            choices=_HEIGHTS,
        ),
        SceneField(
            SceneFieldKind.NUMBER,
            "Safe Z",
            ("heights", "safe_z"),
            scene.safe_z,
            low=0.001,
            tip="Above the stock, between places far apart",
        ),
        SceneField(
            SceneFieldKind.NUMBER,
            "Retract Z",
            ("heights", "retract_z"),
            scene.retract_z,
            low=0.001,
            tip="Above the stock, where plunges begin",
        ),
    )


def in_words(key: str) -> str:
    """Return a key of the text as a name: "start_radius" is "Start radius"."""
    return key.replace("_", " ").capitalize()
