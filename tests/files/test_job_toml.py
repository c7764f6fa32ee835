"""Job files: the sample is the default job, every mistake is told with its line and key."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import pytest

from app.errors import InputError
from app.files.job_toml import parse_origin, read_job
from app.model.job import Job, OriginXY, OriginZ, Stock
from app.model.operation import ContourOperation, Cut, Direction, Order, PocketOperation
from app.model.part import Part, Units
from app.model.tool import Tool, ToolKind


def test_the_sample_says_the_defaults(samples: Path) -> None:
    read = read_job("job.toml", (samples / "job.toml").read_bytes())
    pocket, contour = read.job.operations
    assert pocket == PocketOperation(Cut(1), stepover=3.0)
    assert replace(read.job, operations=(PocketOperation(Cut(1)), contour)) == Job(Part())
    assert read.units is Units.MM


def test_an_empty_file_is_the_default_job() -> None:
    assert read_job("j", b"").job == Job(Part())
    assert read_job("j", b"").units is None


def test_every_key_is_read() -> None:
    text = b"""
    [drawing]
    units = "in"
    layers = ["a", "b"]
    join_tolerance = 0.3
    [stock]
    margin = 2
    thickness = 20.5
    [origin]
    xy = "centre"
    z = "bottom"
    [heights]
    safe_z = 9
    retract_z = 3
    [output]
    post = "other"
    units = "in"
    order = "1986"
    exact_path = true
    [[tool]]
    number = 7
    diameter = 1.5
    kind = "ball"
    name = "small"
    flutes = 3
    spindle_speed = 20000
    feed_rate = 111
    plunge_rate = 22
    [[operation]]
    kind = "contour"
    tool = 7
    depth = 5
    stepdown = 1
    stock_to_leave = 0.2
    direction = "conventional"
    enabled = false
    """
    read = read_job("j", text)
    tool = Tool(7, 1.5, ToolKind.BALL, "small", 3, 20000.0, 111.0, 22.0)
    cut = Cut(7, 5.0, 1.0, 0.2, Direction.CONVENTIONAL, False)
    assert read.job == Job(
        Part(), (tool,), (ContourOperation(cut),), Stock(2.0, 20.5), OriginXY.CENTRE, OriginZ.BOTTOM, 9.0, 3.0, Order.PATENT_1986, 0.3,
        ("a", "b"), "other", Units.INCH, True,
    )  # fmt: skip
    assert read.units is Units.INCH
    assert read.tables == {"drawing", "stock", "origin", "heights", "output", "tool", "operation"}


def test_a_tool_has_the_shape_that_its_kind_has() -> None:
    shapes = """
    [[tool]]
    number = 1
    diameter = 8
    kind = "bull"
    corner_radius = 1.5
    [[tool]]
    number = 2
    diameter = 6
    kind = "taper"
    tip_angle = 7.5
    tip_diameter = 0.4
    """
    assert read_job("j", shapes.encode()).job.tools == (
        Tool(1, 8.0, ToolKind.BULL, corner_radius=1.5), Tool(2, 6.0, ToolKind.TAPER, tip_angle=math.radians(7.5), tip_diameter=0.4),
    )  # fmt: skip
    with pytest.raises(InputError, match="j:1: T1: a tool of kind flat has no corner radius"):
        read_job("j", (TOOL + "corner_radius = 1\n").encode())


TOOL = "[[tool]]\nnumber = 1\ndiameter = 6\n"


@pytest.mark.parametrize(("text", "message"), [
    ("a = ", "j:1: Invalid value"),
    ("\n\n[stock", "j:3: Expected ']'"),
    ("[stock]\nmargin == 3\n", "j:2: Invalid value, column 9"),
    ("x = 1", "j:1: x is no table of a job file"),
    ("\nstock = 3", "j:2: stock is a table"),
    ("[tool]\nnumber = 1", "j:1: tool is a list of tables; write [[tool]] before each"),
    ("[stock]\nthick = 1", "j:2: thick is no key of [stock]; use margin, thickness"),
    ("[stock]\nmargin = -1", "j:1: Stock margin is -1 mm"),
    ("[stock]\nmargin = '3'", "j:2: margin is '3': it must be a number"),
    ("[origin]\n\nxy = 'left'", "j:3: xy is 'left': 'left' is no origin in the plane; use drawing or lower-left"),
    ("[heights]\nsafe_z = nan", "Safe Z is nan mm"),
    ("[drawing]\nlayers = 'a'", "j:2: layers is 'a': it must be a list of texts"),
    ("[drawing]\njoin_tolerance = -1", "j:2: join_tolerance must be 0 or more"),
    ("[output]\nexact_path = 1", "j:2: exact_path is 1: it must be true or false"),
    ("[output]\nunits = 'm'", "j:2: units is 'm'"),
    ("[[tool]]\nnumber = 1", "j:1: diameter is missing in this [[tool]]"),
    ("[[tool]]\nnumber = true\ndiameter = 2", "j:2: number is true: it must be a whole number"),
    (TOOL + "[[tool]]\nnumber = 2\ndiameter = -2", "j:4: T2: diameter is -2"),
    (TOOL + "[[tool]]\nnumber = 1\ndiameter = 2", "j:5: number 1 is taken by another tool"),
    (TOOL + "[[tool]]\nnumber = 2\ndiameter = 2\nkind = 'saw'", "j:7: kind is 'saw'"),
    ("[[operation]]\nkind = 'pocket'", "j:1: tool is missing in this [[operation]]"),
    ("[[operation]]\nkind = 'pocket'\ntool = 9", "j:1: The job has no tool T9"),
    ("[[operation]]\nkind = 'contour'\ntool = 1\nstepover = 2", "j:4: stepover belongs to a pocket operation"),
    ("[[operation]]\nkind = 'drill'\ntool = 1", "j:2: kind is 'drill'"),
    (TOOL + "[[operation]]\nkind = 'pocket'\ntool = 1\n[[operation]]\nkind = 'pocket'\ntool = 1\ndepth = 0", "j:7: Depth is 0 mm"),
])  # fmt: skip
def test_mistakes_are_told_with_line_and_key(text: str, message: str) -> None:
    with pytest.raises(InputError) as error:
        read_job("j", text.encode())
    assert message in str(error.value)
    assert "\n" not in str(error.value)


def test_bytes_that_are_no_text() -> None:
    with pytest.raises(InputError, match="byte 1 is no UTF-8"):
        read_job("j", b"a\xff")


@pytest.mark.parametrize(("text", "expected"), [
    ("drawing", (OriginXY.DRAWING, None)), ("lower-left", (OriginXY.LOWER_LEFT, None)), ("center", (OriginXY.CENTRE, None)),
    ("bottom", (None, OriginZ.BOTTOM)), ("Centre, Bottom", (OriginXY.CENTRE, OriginZ.BOTTOM)),
    ("top,drawing", (OriginXY.DRAWING, OriginZ.TOP)),
])  # fmt: skip
def test_origins(text: str, expected: tuple[object, object]) -> None:
    assert parse_origin(text) == expected


@pytest.mark.parametrize("text", ["", "left", "top,bottom", "drawing,centre", "centre,bottom,top"])
def test_what_is_no_origin(text: str) -> None:
    with pytest.raises(InputError, match="is no origin"):
        parse_origin(text)
