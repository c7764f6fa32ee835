"""Job files: the sample is the default job, every mistake is told with its line and key."""

from __future__ import annotations

import json
import math
import re
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.core.errors import InputError
from app.formats.job.toml import TOOL_KEYS, parse_origin, read_job
from app.model.adaptive_operation import AdaptiveOperation
from app.model.chamfer_operation import ChamferOperation
from app.model.contour_operation import ContourOperation
from app.model.curve_selectors import CirclesOf, ContourKind, CurveNumber, OnLayer
from app.model.entry import Entry, EntryKind, Lead, LeadKind, Tabs
from app.model.face_operation import FaceOperation
from app.model.hole_operations import BoreOperation, DrillOperation, ThreadOperation
from app.model.job import Copies, Job, OriginXY, OriginZ, Stock
from app.model.operation import CutParameters, Direction, Operation, Order, PocketOperation, RestOperation, Side
from app.model.operation_kinds import declared
from app.model.part import Part, Units
from app.model.slot_operation import SlotOperation
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.model.vcarve_operation import VcarveOperation
from tests.examples import examples


def test_the_sample_says_the_defaults(samples: Path) -> None:
    read = read_job("job.toml", (samples / "job.toml").read_bytes())
    assert read.job == Job(Part())
    assert read.units is Units.MM


def test_the_sample_names_every_key_of_every_kind(samples: Path) -> None:
    """Those that have no value by default stand behind a # and are read when that is taken away."""
    text = re.sub(r"(?m)^# (\[\[operation|\[\[tool|\w+ = )", r"\1", (samples / "job.toml").read_text("utf-8"))
    pocket, rest, contour, adaptive, carving, drill, *more = read_job("job.toml", text.encode()).job.operations
    assert isinstance(pocket, PocketOperation) and pocket.stepover == 3.0
    assert isinstance(rest, RestOperation) and rest.stepover == 1.5
    assert isinstance(contour, ContourOperation) and contour.lead.radius == 1.5
    assert adaptive == AdaptiveOperation(CutParameters(1))
    assert carving == VcarveOperation(CutParameters(3), 1)
    assert drill == DrillOperation(CutParameters(1), 5.9, 6.1, 1.0)
    cut = CutParameters(1)
    assert more == [
        ThreadOperation(CutParameters(4)),
        BoreOperation(cut, diameter=12.0),
        ChamferOperation(CutParameters(3), down=0.5),
        SlotOperation(cut, 9.0, trochoidal=True),
        FaceOperation(cut),
    ]
    named = set(re.findall(r"(?m)^(\w+) = ", text))
    assert {"kind", *declared()} | set(TOOL_KEYS) - {"feeds"} <= named


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
    cut = CutParameters(7, 5.0, 1.0, 0.2, Direction.CONVENTIONAL, False)
    assert read.job == Job(
        Part(),
        (tool,),
        (ContourOperation(cut),),
        Stock(2.0, 20.5),
        OriginXY.CENTRE,
        OriginZ.BOTTOM,
        9.0,
        3.0,
        ("a", "b"),
        0.3,
        "other",
        Units.INCH,
        Order.PATENT_1986,
        True,
    )
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
        Tool(1, 8.0, ToolKind.BULL, corner_radius=1.5),
        Tool(2, 6.0, ToolKind.TAPER, tip_angle=math.radians(7.5), tip_diameter=0.4),
    )
    with pytest.raises(InputError, match="j:1: T1: a tool of kind flat has no corner radius"):
        read_job("j", (TOOL + "corner_radius = 1\n").encode())


TOOL = "[[tool]]\nnumber = 1\ndiameter = 6\n"
CONTOUR = "[[operation]]\nkind = 'contour'\ntool = 1\n"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("a = ", "j:1: Invalid value"),
        ("\n\n[stock", "j:3: Expected ']'"),
        ("[stock]\nmargin == 3\n", "j:2: Invalid value, column 9"),
        ("x = 1", "j:1: x is no table of a job file"),
        ("\nstock = 3", "j:2: stock is a table"),
        ("[tool]\nnumber = 1", "j:1: tool is a list of tables; write [[tool]] before each"),
        ("[stock]\nthick = 1", "j:2: thick is no key of [stock]; use margin, thickness"),
        ("[stock]\nmargin = -1", "j:1: Stock margin is -1 mm"),
        ("[stock]\nmargin = '3'", "j:2: margin is '3': it must be a number"),
        ("[origin]\n\nxy = 'left'", "j:3: xy is 'left': 'left' is no origin in the plane; use drawing, lower-left"),
        ("[heights]\nsafe_z = nan", "safe_z is nan: it must be a number up to"),
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
        (
            "[[operation]]\nkind = 'contour'\ntool = 1\nstepover = 2",
            "j:4: stepover belongs to pocket, rest, slot and face operations; remove it",
        ),
        ("[[operation]]\nkind = 'saw'\ntool = 1", "j:2: kind is 'saw'"),
        (
            "[[operation]]\nkind = 'drill'\nstepdown = 1\ntool = 1",
            "j:3: stepdown belongs to pocket, adaptive, rest, contour, slot, vcarve, bore and face operations",
        ),
        (
            "[[operation]]\nkind = 'pocket'\ntool = 1\npeck = 1",
            "j:4: peck belongs to drill operations; remove it from this pocket operation",
        ),
        ("[[operation]]\nkind = 'rest'\ntool = 1\ntabs = 1", "j:4: tabs belongs to contour operations"),
        ("[[operation]]\nkind = 'contour'\ntool = 1\ntabs = 1.5", "j:4: tabs is 1.5: it must be a whole number"),
        (
            "[[operation]]\nkind = 'contour'\ntool = 1\ntab_places = [[1, 2, 3]]",
            "j:4: tab_places is [[1, 2, 3]]: it must be a list of points",
        ),
        (
            "[[operation]]\nkind = 'contour'\ntool = 1\nside = 'left'",
            "j:4: side is 'left': 'left' is no side; use inside, outside or on",
        ),
        (
            "[[operation]]\nkind = 'contour'\ntool = 1\nside = 'on'\ndog_bones = true",
            "j:1: A path on the line has no wall",
        ),
        ("[[operation]]\nkind = 'contour'\ntool = 1\nentry_angle = 60", "j:1: Entry angle is 60 degrees"),
        (
            "[[operation]]\nkind = 'pocket'\ntool = 1\nmost_engaged = '40'",
            "j:4: most_engaged is '40': it must be a share",
        ),
        ("[[operation]]\nkind = 'pocket'\ntool = 1\nmost_engaged = '400%'", "j:1: Limit of engagement is 400 %"),
        ("[copies]\ncolumns = 2", "j:1: Copies along X are 0 mm apart"),
        ("[copies]\ncolumns = 2.5", "j:2: columns is 2.5: it must be a whole number"),
        ("[copies]\ndx = 40", "j:2: dx has no effect without columns; add columns = 2, or take it out"),
        ("[copies]\ncolumns = 2\ndx = 40\ndy = 10", "j:4: dy has no effect without rows; add rows = 2, or take it out"),
        (
            CONTOUR + "finish_each_pass = true",
            "j:4: finish_each_pass has no effect without a finish pass; add finish_width = 0.2",
        ),
        (
            CONTOUR + "lead = 'none'\nlead_radius = 2",
            'j:5: lead_radius has no effect without a lead; write lead = "arc"',
        ),
        (CONTOUR + "lead_overlap = 0\nlead = 'none'", "j:4: lead_overlap has no effect without a lead"),
        (CONTOUR + "lead_overlap = 51", "j:1: Lead overlap is 51 mm; use 0 to 50 mm"),
        (CONTOUR + "entry = 'plunge'\nentry_angle = 5", "j:5: entry_angle has no effect without a slope; write entry"),
        (CONTOUR + "entry = 'predrilled'\nentry_angle = 5", "j:5: entry_angle has no effect"),
        (
            CONTOUR + "tab_width = 4",
            "j:4: tab_width has no effect without tabs; add tabs = 4 or tab_places, or take it out",
        ),
        (CONTOUR + "tabs = 0\ntab_height = 2", "j:5: tab_height has no effect without tabs"),
        (
            TOOL + "kind = 'drill'\n" + CONTOUR,
            "j:5: T1 is a drill, which cannot cut sideways; a contour operation needs a mill",
        ),
        ("[keep_out]\nlayers = 'a'", "j:2: layers is 'a': it must be a list"),
        ("[keep_out]\nheight = 3", "j:2: height has no effect without layers"),
        ("[keep_out]\nlayers = ['a']\nheight = -3", "j:3: height must be 0 or more"),
        (
            TOOL + "[[operation]]\nkind = 'pocket'\ntool = 1\n[[operation]]\nkind = 'pocket'\ntool = 1\ndepth = 0",
            "j:7: Depth is 0 mm",
        ),
    ],
)
def test_mistakes_are_told_with_line_and_key(text: str, message: str) -> None:
    with pytest.raises(InputError) as error:
        read_job("j", text.encode())
    assert message in str(error.value)
    assert "\n" not in str(error.value)


def test_bytes_that_are_no_text() -> None:
    with pytest.raises(InputError, match="byte 1 is no UTF-8"):
        read_job("j", b"a\xff")


LENGTH = st.floats(0.01, 50).map(lambda value: round(value, 6))
SELECTORS = st.one_of(
    st.sampled_from((OnLayer("a"), OnLayer("Außen"), OnLayer("x y"), OnLayer("layer:#1"), *ContourKind)),
    st.integers(1, 10**9 - 1).map(CurveNumber),
    st.tuples(LENGTH, LENGTH).map(lambda ends: CirclesOf(*sorted(ends))),
)
CUT = st.builds(
    CutParameters,
    tool=st.integers(1, 2),
    depth=st.floats(20, 90),
    stepdown=st.floats(1, 90),
    stock_to_leave=st.just(0.0) | LENGTH,
    direction=st.sampled_from(Direction),
    enabled=st.booleans(),
    finish_depth=st.floats(0, 5),
    floor_to_leave=st.floats(0, 9),
    entry=st.builds(Entry, st.sampled_from(EntryKind), st.floats(0.1, 45).map(math.radians)),
    curves=st.lists(SELECTORS, unique=True, max_size=3).map(tuple),
)
HOLE_CUT = st.builds(CutParameters, tool=st.integers(1, 2), depth=st.floats(20, 90), enabled=st.booleans())
SHARE, STEP = st.floats(0.05, 1), st.none() | LENGTH
OPERATIONS = st.one_of(
    st.builds(PocketOperation, CUT, STEP, st.booleans(), SHARE),
    st.builds(RestOperation, CUT, STEP, SHARE),
    st.builds(
        ContourOperation,
        CUT,
        st.sampled_from((Side.INSIDE, Side.OUTSIDE)),
        st.builds(Lead, st.sampled_from(LeadKind), STEP, LENGTH),
        st.builds(
            Tabs,
            st.integers(0, 9),
            st.floats(0.1, 9),
            LENGTH,
            st.lists(st.tuples(LENGTH, LENGTH), max_size=3).map(tuple),
        ),
        st.integers(0, 10),
        st.booleans(),
        LENGTH,
        st.booleans(),
        SHARE,
    ),
    st.builds(
        DrillOperation,
        HOLE_CUT,
        st.none() | st.floats(0.1, 3),
        st.none() | st.floats(3, 9),
        STEP,
        dwell=st.floats(0, 60),
        through=st.floats(0, 9),
    ),
)


def effective(operation: Operation) -> Operation:
    """The operation without values that have no effect: a job file that names them is refused."""
    if not operation.cut.entry.sloped:
        operation = replace(operation, cut=replace(operation.cut, entry=Entry(operation.cut.entry.kind)))
    if isinstance(operation, ContourOperation):
        lead = operation.lead if operation.lead.enabled else Lead(LeadKind.NONE)
        operation = replace(operation, lead=lead, tabs=operation.tabs if operation.tabs.enabled else Tabs())
    return operation


def written(operation: Operation) -> str:
    """An operation as a person would write it, by the keys that its kind has."""
    cut = operation.cut
    keys: dict[str, object] = {
        "kind": operation.WORD,
        "tool": cut.tool,
        "depth": cut.depth,
        "enabled": cut.enabled,
        "curves": [each.text for each in cut.curves],
    }
    if not isinstance(operation, DrillOperation):
        keys |= {
            "stepdown": cut.stepdown,
            "stock_to_leave": cut.stock_to_leave,
            "direction": cut.direction.value,
            "finish_depth": cut.finish_depth,
            "floor_to_leave": cut.floor_to_leave,
            "entry": cut.entry.kind.value,
            "entry_angle": round(math.degrees(cut.entry.angle), 9),
            "most_engaged": operation.most_engaged,
        }
    if isinstance(operation, ContourOperation):
        lead, tabs = operation.lead, operation.tabs
        keys |= {
            "side": operation.side.value,
            "lead": lead.kind.value,
            "lead_radius": lead.radius,
            "lead_overlap": lead.overlap,
            "tabs": tabs.count,
            "tab_width": tabs.width,
            "tab_height": tabs.height,
            "tab_places": [list(p) for p in tabs.places],
            "spring_passes": operation.spring_passes,
            "dog_bones": operation.dog_bones,
            "finish_width": operation.finish_width,
            "finish_each_pass": operation.finish_each_pass,
        }
    else:
        keys |= {
            name: getattr(operation, name)
            for name in ("stepover", "outside_in", "peck", "least", "most", "through", "dwell")
            if hasattr(operation, name)
        }
    lines = [f"{key} = {json.dumps(value, ensure_ascii=False)}" for key, value in keys.items() if value is not None]
    return "\n".join(["[[operation]]", *lines, ""])


@settings(max_examples=examples(60), deadline=None)
@given(st.lists(OPERATIONS, min_size=1, max_size=4))
def test_operations_are_read_as_they_are_written(operations: list[Operation]) -> None:
    operations = [effective(operation) for operation in operations]
    read = read_job("j", "\n".join(map(written, operations)).encode()).job.operations
    for mine, theirs in zip(operations, read, strict=True):
        assert replace(mine, cut=replace(mine.cut, entry=Entry())) == replace(
            theirs, cut=replace(theirs.cut, entry=Entry())
        )
        assert mine.cut.entry.kind is theirs.cut.entry.kind
        assert mine.cut.entry.angle == pytest.approx(theirs.cut.entry.angle)


def test_copies_and_clamps() -> None:
    read = read_job(
        "j", b"[copies]\ncolumns = 3\nrows = 2\ndx = 40\ndy = -25.5\n[keep_out]\nlayers = ['clamps', 'b']\nheight = 12"
    )
    assert read.job.copies == Copies(3, 2, 40.0, -25.5)
    assert (read.job.keep_out_layers, read.job.keep_out_height) == (("clamps", "b"), 12.0)
    assert read.tables == {"copies", "keep_out"}


def test_a_default_may_stand_where_it_has_no_effect() -> None:
    """So that a copy of the sample can be changed key by key."""
    text = (
        f"{CONTOUR}lead = 'none'\nlead_overlap = 0.5\nentry = 'plunge'\nentry_angle = 3\n"
        "tabs = 0\ntab_width = 5\nfinish_each_pass = false"
    )
    (operation,) = read_job("j", f"{text}\n[copies]\ncolumns = 2\ndx = 9\ndy = 0.0".encode()).job.operations
    assert operation == ContourOperation(CutParameters(1, entry=Entry(EntryKind.PLUNGE)), lead=Lead(LeadKind.NONE))
    assert read_job("j", (CONTOUR + "tab_places = [[1, 2]]\ntab_width = 4").encode()).job.operations


@pytest.mark.parametrize(("text", "share"), [("0.4", 0.4), ("'40%'", 0.4), ("' 12.5 % '", 0.125), ("1", 1.0)])
def test_engagement_as_a_share_or_per_cent(text: str, share: float) -> None:
    (operation,) = read_job(
        "j", f"[[operation]]\nkind = 'rest'\ntool = 1\nmost_engaged = {text}".encode()
    ).job.operations
    assert isinstance(operation, RestOperation)
    assert operation.most_engaged == pytest.approx(share)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("drawing", (OriginXY.DRAWING, None)),
        ("lower-left", (OriginXY.LOWER_LEFT, None)),
        ("center", (OriginXY.CENTRE, None)),
        ("bottom", (None, OriginZ.BOTTOM)),
        ("Centre, Bottom", (OriginXY.CENTRE, OriginZ.BOTTOM)),
        ("top,drawing", (OriginXY.DRAWING, OriginZ.TOP)),
    ],
)
def test_origins(text: str, expected: tuple[object, object]) -> None:
    assert parse_origin(text) == expected


@pytest.mark.parametrize("text", ["", "left", "top,bottom", "drawing,centre", "centre,bottom,top"])
def test_what_is_no_origin(text: str) -> None:
    with pytest.raises(InputError, match="is no origin"):
        parse_origin(text)


@pytest.mark.parametrize("word", ["v-bit", "chamfer", "Countersink", "spot"])
def test_a_cone_has_the_trade_s_names(word: str) -> None:
    text = f'[[tool]]\nnumber = 1\nkind = "{word}"\ndiameter = 6.0\ntip_angle = 90\n'
    assert read_job("j.toml", text.encode()).job.tools[0].kind is ToolKind.V


def test_engrave_is_a_contour_on_the_lines() -> None:
    text = '[[tool]]\nnumber = 1\ndiameter = 6.0\n[[operation]]\nkind = "engrave"\ntool = 1\ndepth = 0.3\n'
    (operation,) = read_job("j.toml", text.encode()).job.operations
    assert isinstance(operation, ContourOperation) and operation.side is Side.ON
    assert operation.cut.depth == 0.3
    assert read_job("j.toml", (text + 'side = "on"\n').encode()).job.operations == (operation,)
    with pytest.raises(InputError, match=r"j.toml:8: side is told by the kind already.* kind = \"contour\""):
        read_job("j.toml", (text + 'side = "inside"\n').encode())
