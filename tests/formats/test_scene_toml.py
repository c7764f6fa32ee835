"""Scene files: what is written is read again, and every mistake is told with its line."""

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.core.errors import InputError
from app.formats.scene.toml import read_scene
from app.model.job import OriginXY, OriginZ
from app.model.part import Units
from app.model.scene import (
    Boundary,
    CentreLimit,
    KeptSide,
    LineType,
    Passes,
    Scene,
    SceneStock,
    Strategy,
    Surface,
    Trim,
)
from app.model.scene_curves import CurveForm, SectionCurve, Spacing
from app.model.scene_shapes import (
    BicubicShape,
    BilinearShape,
    BsplineShape,
    ConeShape,
    CylinderShape,
    LoftShape,
    MeshShape,
    PlaneShape,
    ProfileOrientation,
    RevolvedShape,
    RuledShape,
    Shape,
    SphereShape,
    SweptShape,
    TorusShape,
)
from app.model.tool import FeedRow, Tool
from app.model.tool_kind import ToolKind
from tests.examples import examples
from tests.scene_text import write_scene

ZERO, X = (0.0, 0.0, 0.0), (1.0, 0.0, 0.0)
TABLE = SectionCurve(
    ((0.0, 1.0), (2.5, -1.0), (4.0, 0.125)),
    spacing=Spacing.CHORD_LENGTH,
    origin=(0.0, 5.0, 0.0),
    y_axis=(0.0, 0.0, 1.0),
)
SPACE = SectionCurve(
    ((0.0, 1.0, 7.0), (2.0, -1.0, 1e-9), (4.0, 0.0, 0.1)), CurveForm.CONTROL, 2, weights=(1.0, 0.5, 1.0)
)
PAIR = SectionCurve(((0.0, 1.0), (2.0, 3.0)), closed=False, degree=1)
DRAWN = SectionCurve(drawing='a "b".dxf', layer="刃", number=3)
GRID = tuple(tuple((float(i), float(j), i * j / 7) for j in range(4)) for i in range(4))
SHAPES: tuple[Shape, ...] = (
    PlaneShape(ZERO, X, (0.0, 1.0, 0.5)),
    SphereShape(ZERO, 2.0),
    CylinderShape(ZERO, X, 1.5, (-90.0, 90.0)),
    ConeShape(ZERO, X, 1.0, 0.0),
    TorusShape(ZERO, 3.0, 1.0, X),
    BilinearShape((ZERO, X, (1.0, 1.0, 0.0), (0.0, 1.0, 3.0))),
    BicubicShape(GRID),
    BsplineShape(
        GRID,
        2,
        3,
        knots_u=(0.0, 0.0, 0.0, 0.3, 1.0, 1.0, 1.0),
        weights=((1.0,) * 4, (0.5,) * 4, (2.0,) * 4, (1.0,) * 4),
    ),
    LoftShape((TABLE, SPACE, DRAWN, PAIR), 2, True),
    RuledShape(TABLE, DRAWN),
    RevolvedShape(DRAWN, X, ZERO[:2] + (2.0,), (10.0, 20.0)),
    SweptShape(PAIR, SPACE, ProfileOrientation.FOLLOW),
    MeshShape("part.STL", 25.4),
)
TRIMS = (
    Trim(outline=((0.0, 0.0), (1.0, 0.0), (0.0, 1.0)), keep=KeptSide.OUTSIDE),
    Trim(circle=(1.0, 2.0, 3.0)),
    Trim(drawing="a.dxf", layer="x"),
)
FULL = Scene(
    "everything",
    tuple(
        Surface(
            f"no. {n}",
            shape,
            "#009E73",
            tuple(LineType)[n % 4],
            n % 2 == 0,
            n % 3 > 0,
            (1.0, 2.0, float(n)),
            X,
            TRIMS[: n % 4],
        )
        for n, shape in enumerate(SHAPES)
    ),
    SceneStock((0.0, 0.0, -5.0, 100.0, 80.0, 20.0)),
    (
        Tool(1, 6.0, ToolKind.BALL, feeds=(FeedRow("steel", 120.0, 0.05),)),
        Tool(7, 8.0, ToolKind.BULL, corner_radius=1.0),
    ),
    (
        Passes(
            1,
            "finish",
            False,
            30.0,
            (1.0, 2.0),
            pitch=0.5,
            strategy=Strategy.ONE_WAY,
            stock_to_leave=0.25,
            floor=-3.0,
            link_gap=2.0,
            feed_rate=500.0,
            plunge_rate=100.0,
            spindle_speed=9000.0,
            boundary=(Boundary(rectangle=(0.0, 0.0, 9.0, 9.0), centre=CentreLimit.INSIDE),),
        ),
        Passes(7, line=(0.0, 0.0, 100.0, 80.0), scallop=0.01, chord_tolerance=0.002),
    ),
    OriginXY.CENTRE,
    OriginZ.BOTTOM,
    12.0,
    2.0,
    "fanuc",
    Units.INCH,
    True,
)


@pytest.mark.parametrize(
    "scene", [FULL, Scene(), Scene("", tools=(), stock=SceneStock(margin=2.5))], ids=["full", "plain", "no tool"]
)
def test_what_is_written_is_read_again_and_written_alike(scene: Scene) -> None:
    written = write_scene(scene)
    assert read_scene("a.toml", written) == scene
    assert write_scene(read_scene("a.toml", written)) == written


lengths = st.floats(-1e5, 1e5)
places = st.tuples(lengths, lengths, lengths)
spheres = st.builds(SphereShape, places, st.floats(1e-6, 1e5))
meshes = st.builds(MeshShape, st.text(max_size=20).map(lambda text: text + ".stl"), st.floats(1e-6, 1e3))
names = st.text(min_size=1, max_size=20).filter(lambda text: text.strip() and max(text) < "\ud800")
surfaces = st.builds(
    Surface,
    names,
    st.one_of(st.sampled_from(SHAPES), spheres, meshes),
    move=places,
    rotate_deg=places,
    line=st.sampled_from(LineType),
    visible=st.booleans(),
)


@settings(deadline=None, max_examples=examples(60))
@given(st.lists(surfaces, max_size=4, unique_by=lambda each: each.name))
def test_any_surfaces_are_read_again(some: list[Surface]) -> None:
    scene = Scene("any", tuple(some))
    assert read_scene("a.toml", write_scene(scene)) == scene


@pytest.mark.parametrize("name", ["compound", "spheres", "torus", "die"])
def test_samples_are_read_and_written_again(samples: Path, name: str) -> None:
    scene = read_scene(name, (samples / f"{name}.toml").read_bytes())
    assert scene.name == name
    assert read_scene(name, write_scene(scene)) == scene


def test_the_die_is_roughed_and_finished(samples: Path) -> None:
    scene = read_scene("die", (samples / "die.toml").read_bytes())
    *roughing, finishing = scene.passes
    assert len(roughing) >= 2 and all(each.stock_to_leave > 0 and each.tool != finishing.tool for each in roughing)
    depths = [each.floor for each in roughing]
    assert depths == sorted(depths, reverse=True) and finishing.floor < min(depths) and finishing.stock_to_leave == 0
    diameters = {tool.number: tool.diameter for tool in scene.tools}
    assert diameters[finishing.tool] < diameters[roughing[0].tool]


def test_inches_are_mm_inside_but_not_directions_angles_and_defaults() -> None:
    text = b"""units = "in"
[heights]
safe_z = 1
[[tool]]
number = 1
diameter = 0.25
kind = "ball"
feed_rate = 20
spindle_speed = 9000
[[surface]]
name = "a"
rotate_deg = [0, 0, 30]
shape = { kind = "torus", centre = [1, 0, 0], axis = [1, 0, 0], major = 2, minor = 1 }
[[passes]]
tool = 1
pitch = 0.1
angle_deg = 45
"""
    scene = read_scene("a.toml", text)
    assert scene.surfaces[0].shape == TorusShape((25.4, 0.0, 0.0), 50.8, 25.4, (1.0, 0.0, 0.0))
    assert scene.surfaces[0].rotate_deg == (0.0, 0.0, 30.0)
    assert (scene.safe_z, scene.retract_z, scene.tools[0].diameter, scene.tools[0].feed_rate) == pytest.approx(
        (25.4, 1.0, 6.35, 508)
    )
    assert scene.tools[0].spindle_speed == 9000
    passes = scene.passes[0]
    assert (passes.pitch, passes.angle_deg, passes.chord_tolerance) == (pytest.approx(2.54), 45.0, 0.01)


GOOD = """name = "a"
units = "mm"

[[tool]]
number = 1
diameter = 6.0
kind = "ball"

[[surface]]
name = "one"
colour = "#009E73"

[surface.shape]
kind = "sphere"
centre = [0, 0, 0]
radius = 5

[[surface]]
name = "two"

[surface.shape]
kind = "loft"
sections = [
  { points = [[0, 0], [1, 0]] },
  { points = [[0, 1], [1, 1]], y_axis = [0, 0, 1] },
]

[[passes]]
tool = 1
pitch = 1.0
"""
MISTAKES = (
    ('name = "a"', "name = ", r"1: .*, column 8; correct it as resources/samples/compound\.toml shows$"),
    ('units = "mm"', 'units = "yd"', r"2: units is 'yd'; use mm or in$"),
    ('units = "mm"', 'units = ["mm"]', r"2: units is \['mm'\]; use mm or in$"),
    ('units = "mm"', "wings = 2", r"2: wings is not known; expected are name, stock, surface, passes\.$"),
    ("diameter = 6.0", "", r"4: diameter is missing in this \[\[tool\]\]; add diameter = …$"),
    ("diameter = 6.0", "diameter = -6.0", r"4: T1: diameter is -6 mm"),
    ('name = "two"', 'name = "one"', r"19: name one is taken by another surface; give each its own$"),
    ('colour = "#009E73"', 'colour = "green"', r"9: The colour of one is 'green'; write it as \"#009E73\"\.$"),
    (
        'kind = "sphere"',
        'kind = "ball"',
        r"14: surface\[1\]\.shape\.kind is 'ball'; expected is \"plane\", \"sphere\", .*\.$",
    ),
    ('kind = "sphere"', "", r"13: surface\[1\]\.shape\.kind is missing; add kind = \"plane\", .*\.$"),
    ("radius = 5", "", r"13: surface\[1\]\.shape\.radius is missing; add a number\.$"),
    ("radius = 5", "radius = 'big'", r"16: surface\[1\]\.shape\.radius is 'big'; expected is a number\.$"),
    ("radius = 5", "radius = -5", r"13: A sphere's radius is -5 mm; it must be greater than 0\.$"),
    (
        "radius = 5",
        "radius = 5\nminor = 2",
        r"17: surface\[1\]\.shape\.minor is not known; expected are kind, centre, radius\.$",
    ),
    (
        "centre = [0, 0, 0]",
        "centre = [0, 0]",
        r"15: surface\[1\]\.shape\.centre is \[0, 0\]; expected is a list of 3 numbers\.$",
    ),
    (
        "[[0, 0], [1, 0]]",
        "[1, 2]",
        r"23: surface\[2\]\.shape\.sections\[1\]\.points is 1; expected is a list of numbers\.$",
    ),
    ("[[0, 0], [1, 0]]", "[[0, 0]]", r"23: An open section curve has 1 points; it needs 2 or more\.$"),
    (
        "y_axis = [0, 0, 1]",
        "y_axis = [1, 0, 1]",
        r"23: The axes 1, 0, 0 and 1, 0, 1 are not at right angles; correct one of them\.$",
    ),
    ("tool = 1\n", "tool = 2\n", r"29: The scene has no tool T2; add it to the tools or choose another\.$"),
    (
        "pitch = 1.0",
        "pitch = 1.0\nscallop = 1.0",
        r"28: Passes need either a pitch or a scallop height, and not both; .*\.$",
    ),
    (
        "pitch = 1.0",
        "pitch = 1.0\nstrategy = 'spiral'",
        r"31: passes\[1\]\.strategy is 'spiral'; expected is 'zigzag' or 'one-way'\.$",
    ),
)


@pytest.mark.parametrize(("good", "bad", "message"), MISTAKES, ids=[str(n) for n in range(len(MISTAKES))])
def test_a_mistake_is_told_with_its_line(good: str, bad: str, message: str) -> None:
    assert read_scene("s.toml", GOOD.encode()).surfaces[1].name == "two"
    assert GOOD.count(good) == 1
    with pytest.raises(InputError, match=r"^s\.toml:" + message):
        read_scene("s.toml", GOOD.replace(good, bad).encode())


def test_bytes_that_are_no_text_are_told() -> None:
    with pytest.raises(InputError, match=r"^s\.toml: byte 2 is no UTF-8"):
        read_scene("s.toml", b"ab\xff")
