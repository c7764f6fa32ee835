"""The header that `make` writes, read again: everything that a cut needs, in every control's kind of comment."""

import math
from dataclasses import replace

import numpy as np
import pytest

from app.gcode.interpreter.notes import notes
from app.gcode.interpreter.options import ReadOptions
from app.gcode.interpreter.program import HeaderNote, OperationNote, ToolNote
from app.gcode.interpreter.reader import read_program
from app.gcode.posts import load_post, post_names
from app.gcode.writer.write import write_files
from app.model.contour_operation import ContourOperation
from app.model.curve_selectors import on_layers, read_selector
from app.model.entry import Entry, EntryKind, Lead, LeadKind, Tabs
from app.model.fields import parameters_of
from app.model.hole_operations import DrillOperation
from app.model.job import Copies, Job, OriginXY, OriginZ
from app.model.moves import DogBone, Tab
from app.model.operation import CutParameters, Direction, Operation, PocketOperation, RestOperation, Side
from app.model.part import Units
from app.model.read_options import AS_DRAWN
from app.model.read_options import DrawingOptions as Reading
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from tests.gcode.programs import job, two_tools

BULL = Tool(1, 6.0, ToolKind.BULL, corner_radius=0.5)
TAPER = Tool(2, 3.0, ToolKind.TAPER, tip_angle=math.radians(7.5), tip_diameter=0.4)
LAYERS = ("Außen, 1/2+ x", "long " * 25 + "end")


def shaped() -> Job:
    origin = {"origin_xy": OriginXY.LOWER_LEFT, "origin_z": OriginZ.BOTTOM}
    return job(tools=(BULL, TAPER), layer_names=LAYERS, join_tolerance=0.02, **origin)


@pytest.mark.parametrize("name", post_names())
def test_what_every_post_writes_is_read_again(name: str) -> None:
    post = load_post(name)
    read = [
        read_program(file.nc.text.encode(), ReadOptions(post.dialect))
        for file in write_files(two_tools().program(), shaped(), post)
    ]
    told = [
        (note.number, note.kind, note.diameter, note.corner_radius, round(note.angle, 9), note.tip_diameter)
        for program in read
        for note in program.tools
    ]
    assert told == [(1, "bull", 6.0, 0.5, 0.0, 0.0), (2, "taper", 3.0, 0.0, round(TAPER.tip_angle, 9), 0.4)]
    assert [note for program in read if program.header for note in program.header.operations] == [
        noted(PocketOperation(CutParameters(1, 2.0))),
        noted(ContourOperation(CutParameters(2, 2.0))),
    ]
    for program in read:
        assert program.header is not None
        assert program.stock is not None
        assert program.stock.low == (0.0, 0.0, 0.0)
        assert program.header.origin == tuple(-size for size in (2.0, 2.0, 8.0))
        assert (program.header.drawing_units, program.header.join_tolerance) == (Units.MM, 0.02)
        assert [layer.casefold() for layer in program.header.layers] == [layer.casefold() for layer in LAYERS]
        assert 0.001 <= (program.header.path_tolerance or 0.0) < 0.01


@pytest.mark.parametrize("name", post_names())
def test_what_a_part_depends_on_is_read_again(name: str) -> None:
    """Sides, layers, holes, copies, clamps, tabs and dog-bones go through the comments of every control."""
    operations = (
        PocketOperation(CutParameters(1, 4.0, floor_to_leave=0.25, curves=on_layers(LAYERS))),
        RestOperation(CutParameters(1, 4.0)),
        ContourOperation(CutParameters(2, 4.0, stock_to_leave=0.1), Side.OUTSIDE),
        ContourOperation(CutParameters(2, curves=on_layers(("x",))), Side.ON),
        DrillOperation(CutParameters(2, 5.0), least=2.5, most=3.0, through=0.5),
        DrillOperation(CutParameters(2, 6.0)),
    )
    tabs = tuple(Tab(10.5 * k, -0.125, 5.0, -1.5, 3.0, holds_part=k != 1) for k in range(3))
    bones = (DogBone(1.0, 2.0, 1.25, 2.25, 3.0),)
    copies = Copies(7, 3, 40.1 / 3, -25.4)
    path = two_tools()
    made = job(
        tools=(BULL, TAPER), operations=operations, copies=copies, keep_out_layers=("clämps", "b"), keep_out_height=3.5
    )
    program = replace(path.program(), tabs=tabs, dog_bones=bones)
    program = replace(
        program,
        moves=replace(
            program.moves,
            operation=np.where(
                program.moves.tool == 1, np.arange(len(program.moves)) % 2, 2 + np.arange(len(program.moves)) % 4
            ).astype(np.int16),
        ),
    )
    post = load_post(name)
    headers = [
        read_program(file.nc.text.encode(), ReadOptions(post.dialect)).header
        for file in write_files(program, made, post)
    ]
    told = [note for header in headers if header is not None for note in header.operations]
    assert [lowered(note.operation()) for note in told] == [
        lowered(
            replace(
                each, cut=replace(each.cut, stepdown=each.cut.depth if each.cut.stepdown == 2.0 else each.cut.stepdown)
            )
        )
        for each in operations
    ]
    for header in headers:
        assert header is not None
        assert (header.tabs, header.dog_bones) == (tabs, bones)
        assert header.copies is not None
        assert (header.copies.columns, header.copies.rows) == (7, 3)
        assert header.copies.shifts[-1] == pytest.approx(copies.shifts[-1], abs=1e-8)
        assert ([layer.casefold() for layer in header.keep_out[0]], header.keep_out[1]) == (["clämps", "b"], 3.5)


def lowered(operation: Operation) -> Operation:
    return replace(
        operation,
        cut=replace(operation.cut, curves=tuple(read_selector(e.text.casefold()) for e in operation.cut.curves)),
    )


def noted(operation: Operation) -> OperationNote:
    return OperationNote(
        type(operation),
        tuple((key, parameters_of(type(operation))[key].of(operation)) for key in ("tool", "depth", "stock_to_leave")),
    )


ANGLE = math.radians(2.5)


@pytest.mark.parametrize("name", post_names())
@pytest.mark.parametrize(
    "operation",
    [
        ContourOperation(
            CutParameters(
                2,
                4.0,
                1.5,
                0.1,
                Direction.CONVENTIONAL,
                True,
                0.2,
                0.25,
                Entry(EntryKind.RAMP, ANGLE),
                on_layers(LAYERS),
            ),
            Side.OUTSIDE,
            Lead(LeadKind.LINE, 1.25, 0.0),
            Tabs(3, 4.0, 0.5, ((10.0, -0.125), (1 / 3, 5.0))),
            2,
            True,
            0.2,
            True,
            0.4,
        ),
        DrillOperation(CutParameters(2, 5.0), 2.5, 3.0, 0.5, through=0.5),
        PocketOperation(CutParameters(2, 4.0, 1.0), 1.25, True, 0.55),
        RestOperation(CutParameters(2, 4.0, 1.0), 1.25, 0.55),
    ],
    ids=lambda operation: operation.WORD,
)
def test_every_parameter_goes_through_the_comments_of_every_control(name: str, operation: Operation) -> None:
    post, path = load_post(name), two_tools()
    first = PocketOperation(CutParameters(1))
    files = write_files(path.program(), job(tools=(BULL, TAPER), operations=(first, operation)), post)
    headers = [read_program(file.nc.text.encode(), ReadOptions(post.dialect)).header for file in files]
    told = lowered(
        next(note for header in reversed(headers) if header for note in reversed(header.operations)).operation()
    )
    for key, placed in parameters_of(type(operation)).items():
        mine, theirs = placed.of(lowered(operation)), placed.of(told)
        if key == "tab_places":
            mine, theirs = np.ravel(mine), np.ravel(theirs)
        assert theirs == (pytest.approx(mine, abs=1e-8) if isinstance(mine, float | np.ndarray) else mine), key


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("operation=pocket,1,2,0.1", PocketOperation(CutParameters(1, 2.0, stock_to_leave=0.1))),
        (
            "operation=contour,2,2,0,outside)\n(hitofude: leads_mm=1,3.5",
            ContourOperation(CutParameters(2, 2.0), Side.OUTSIDE, Lead(radius=3.5)),
        ),
        (
            "operation=drill,2,5,0)\n(hitofude: holes_mm=1,2.5,3,0.5",
            DrillOperation(CutParameters(2, 5.0), 2.5, 3.0, through=0.5),
        ),
        (
            "operation=rest,1,2,0)\n(hitofude: operation_layer=1,a/b)\n(hitofude: floor_to_leave_mm=1,0.25",
            RestOperation(CutParameters(1, 2.0, floor_to_leave=0.25, curves=on_layers(("a/b",)))),
        ),
    ],
)
def test_headers_of_earlier_versions_are_read(text: str, expected: Operation) -> None:
    header = notes(f"(hitofude: {text})\n".encode()).header
    assert header is not None
    (note,) = header.operations
    told = note.operation()
    assert replace(told, cut=replace(told.cut, stepdown=2.0)) == expected


@pytest.mark.parametrize("name", post_names())
@pytest.mark.parametrize(
    "how",
    [
        AS_DRAWN,
        Reading(True, "Blatt (1)", True, 90.5, LAYERS, ("TEXT", "a)\nM3")),
        Reading(layout="+2B+", without_types=("x" * 90,)),
    ],
)
def test_how_the_drawing_was_read_is_read_again(name: str, how: Reading) -> None:
    """Names do not leave their comments; controls that know capitals alone write these so."""
    post = load_post(name)
    made = job(tools=(BULL, TAPER))
    files = write_files(two_tools().program(), replace(made, part=replace(made.part, reading=how)), post)
    for file in files:
        header = read_program(file.nc.text.encode(), ReadOptions(post.dialect)).header
        assert header is not None and plain(header.reading) == plain(how)
        assert not any(line.startswith("M3") for line in file.nc.text.splitlines() if ")" in line)


def plain(how: Reading) -> Reading:
    without_layers, without_types = (
        tuple(each.casefold() for each in names) for names in (how.without_layers, how.without_types)
    )
    return replace(how, layout=how.layout.casefold(), without_layers=without_layers, without_types=without_types)


def test_a_drawing_that_is_read_as_it_is_drawn_has_no_word_of_it() -> None:
    (file,) = write_files(two_tools().program(), shaped(), load_post("linuxcnc"))
    assert not any(key in file.nc.text for key in ("skip_", "layout", "to_zero", "px_per_inch", "overrule"))


def test_a_header_with_thousands_of_tabs_is_read_whole() -> None:
    text = "".join(f"(hitofude: tab={k},0,5,-1,3)\n" for k in range(5000))
    header = notes(text.encode()).header
    assert header is not None
    assert [tab.x for tab in header.tabs] == list(range(5000))


@pytest.mark.parametrize(
    "text",
    [
        "(hitofude: tool=4,bull,8,1.5,0,0)",
        "( Hitofude: tool = 4, bull, 8, 1.5, 0, 0 )",
        "; HITOFUDE: TOOL=4,BULL,8,1.5,0,0",
        "(hitofude: tool=4,bu)\n(hitofude+ll,8,1.5,0,0)",
        "(hitofude: tool=4,bull,8,1.5,0)\n(hitofude: tool=4,bull,8,1.5,0,0)",
    ],
)
def test_a_tool_with_its_shape(text: str) -> None:
    (tool,) = notes(f"G21\n{text}\n".encode()).tools
    assert replace(tool, line=0) == ToolNote(4, "bull", 8.0, 1.5)


@pytest.mark.parametrize(
    "text",
    [
        "operation=saw,1,2,0",
        "operation=contour,1,2,0,beside",
        "operation=contour,1,2,0,on,on",
        "operation=pocket,1,2",
        "operation=pocket,depth=2",
        "operation=pocket,tool=1,depth=x",
        "operation=contour,tool=1,side=up",
        "operation=saw,tool=1",
        "operation_layer=1,a",
        "operation_layer=x,a",
        "floor_to_leave_mm=1,2",
        "leads_mm=1,2",
        "holes_mm=1,2",
        "copies=2,2,0,0",
        "copies=2",
        "tab=1,2,3",
        "dog_bone=1,2,3,4,x",
        "operation=pocket",
        "origin_mm=1,2",
        "origin_mm=1,2,x",
        "drawing_units=yards",
        "to_zero=2",
        "px_per_inch=0",
        "px_per_inch=many",
        "overrule_units=x",
        "join_tolerance_mm=",
        "path_tolerance_mm=1,2",
        "nonsense=1",
        "",
    ],
)
def test_what_is_not_as_it_is_written_is_passed_over(text: str) -> None:
    assert notes(f"(hitofude: {text})\n".encode()) == ((), None, HeaderNote())


def test_another_program_has_no_header() -> None:
    assert notes(b"(made by hand, not by hitofude)\nG0 X1\n").header is None
    assert notes(b"(hitofude+tool=1,flat,6)\n") == ((), None, None)
