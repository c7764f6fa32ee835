"""What a program is cut out of and with: who is believed before whom, what is assumed and said, what is asked for."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from app.core.errors import InputError
from app.formats.job.toml import read_job
from app.gcode.interpreter.dialect import Dialect
from app.model.contour_operation import ContourOperation
from app.model.finding import FindingKind
from app.model.job import OriginXY, OriginZ
from app.model.operation import PocketOperation, RestOperation
from app.model.stock_box import StockBox
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.simulation.field.workpiece import BoxStock
from app.usecases.cutting.ready_setup import ReadySetup, SetupRequest, setup_of
from app.usecases.cutting.setup_tools import ToolSource
from app.usecases.examine import ExamineOptions, examine
from app.usecases.job.machining import MachiningOptions
from app.usecases.job.options import MakeOptions
from app.usecases.making.make import make
from app.verify.parts import FlatPart

CUT = "G0 Z5\nX10 Y10\nG1 Z-2 F100\nX40 Y20\nG0 Z5\n"
GIVEN = Tool(3, 7.0, ToolKind.BALL)


NOTHING_SAID = SetupRequest()


def ready(*texts: str, wishes: SetupRequest = NOTHING_SAID) -> ReadySetup:
    options = ExamineOptions(Dialect.LINUXCNC)
    return setup_of(
        tuple(examine(f"p{k}.ngc", f"G21 G90\n{text}M2\n".encode(), options) for k, text in enumerate(texts, 1)), wishes
    )


def tools(*texts: str, told: tuple[ToolSource, ...] = ()) -> dict[int, Tool]:
    return dict(ready(*texts, wishes=SetupRequest(tools=told)).setup.tools)


def box(text: str) -> tuple[float, ...]:
    """The stock of a program with a tool of 6 mm, from low to high."""
    stock = ready(f"(T1 flat 6 mm)\n{text}T1 M6\n{CUT}").setup.stock
    assert isinstance(stock, BoxStock)
    solid = stock.solid
    return tuple(round(value, 6) for value in (solid.x0, solid.y0, solid.z0, solid.x1, solid.y1, solid.z1))


def test_tools_are_believed_in_order() -> None:
    text = f"(T3 flat 4 mm)\nT3 M6\n{CUT}"
    option, job, table = (
        ToolSource(name, {3: Tool(3, diameter)})
        for name, diameter in (("--tool", 9.0), ("the job", 8.0), ("t.tbl", 7.0))
    )
    for told, diameter in (((option, job, table), 9.0), ((job, table), 8.0), ((table,), 7.0), ((), 4.0)):
        assert tools(text, told=told)[3].diameter == diameter
    known = ready(text, wishes=SetupRequest(tools=(ToolSource("--tool"), job))).tools[3]
    assert (known.source, known.assumed) == ("the job", "")


def test_a_tool_that_nobody_tells_is_asked_for() -> None:
    with pytest.raises(
        InputError, match=r"p1\.ngc:10: T4 cuts from here on, and nobody says .* such as --tool 4=flat:6"
    ):
        tools(f"(T3 flat 4 mm)\nT3 M6\n{CUT}T4 M6\nG1 Z-1 F100\n")


def test_a_tool_that_does_not_cut_is_not_asked_for() -> None:
    assert list(tools(f"(T3 flat 4 mm)\nT3 M6\n{CUT}T4 M6\nG0 X0\n")) == [3]


@pytest.mark.parametrize(
    ("comment", "tool", "assumed"),
    [
        ("(T1 D=6. CR=0. - ball end mill)", Tool(1, 6.0, ToolKind.BALL), ""),
        ("(T1 D=10. CR=0.5 - bullnose end mill)", Tool(1, 10.0, ToolKind.BULL, corner_radius=0.5), ""),
        ("(T1 D=12.5 CR=0. TAPER=118deg - drill)", Tool(1, 12.5, ToolKind.DRILL, tip_angle=math.radians(118)), ""),
        ("(T1 60 deg V-bit 12 mm)", Tool(1, 12.0, ToolKind.V, tip_angle=math.radians(60)), ""),
        (
            "(T1 D=8. CR=0. - right hand tap)",
            Tool(1, 8.0),
            "T1: the comment in line 2 tells 8 mm but no shape; it is taken to be flat",
        ),
        (
            "(Tool 1: drill dia. 3.3)",
            Tool(1, 3.3, ToolKind.DRILL),
            "no angle; the drill is taken to have 118 degrees; --tool 1=KIND:DIAMETER",
        ),
        (
            "(hitofude: tool=1,taper,6,0,0.4,7.5)",
            Tool(1, 6.0, ToolKind.TAPER, tip_diameter=0.4, tip_angle=math.radians(7.5)),
            "",
        ),
        ("(hitofude: tool=1,bull,6,3,0,0)", Tool(1, 6.0, ToolKind.BALL), ""),
        (
            "(hitofude: tool=1,bull,6)",
            Tool(1, 6.0, ToolKind.BULL),
            "the bull-nose mill is taken to have a square corner",
        ),
    ],
)
def test_tools_of_comments(comment: str, tool: Tool, assumed: str) -> None:
    made = ready(f"{comment}\nT1 M6\n{CUT}")
    assert made.setup.tools == {1: tool}
    said = [finding.text for finding in made.findings if finding.text.startswith("T1")]
    assert len(said) == bool(assumed)
    assert assumed in "".join(said)
    assert not any(finding.counts for finding in made.findings)


@pytest.mark.parametrize(
    ("comment", "words"),
    [
        ("(T1 V-bit 12 mm)", "tells of a v tool of 12 mm but not of its angle; give it: --tool 1=v:DIAMETER:ANGLE"),
        ("(hitofude: tool=1,taper,6)", "--tool 1=taper:TIP:ANGLE:DIAMETER"),
        (
            "(hitofude: tool=1,v,6,0,7,60)",
            "the comment in line 2 tells of a tool that is none: T1: tip diameter is 7 mm",
        ),
    ],
)
def test_comments_that_make_no_tool(comment: str, words: str) -> None:
    with pytest.raises(InputError, match=words):
        ready(f"{comment}\nT1 M6\n{CUT}")


def test_the_angle_of_a_drill_is_said_where_it_is_assumed() -> None:
    def told(angle: float) -> str:
        tool = Tool(3, 8.0, ToolKind.DRILL, tip_angle=angle)
        return ready(f"T3 M6\n{CUT}", wishes=SetupRequest(tools=(ToolSource("--tool", {3: tool}),))).tools[3].assumed

    assert told(0.0) == (
        "T3: --tool tells a drill of 8 mm but no angle; it is taken to have 118 degrees; "
        "--tool 3=drill:8:ANGLE says otherwise."
    )
    assert told(math.radians(90)) == ""


def test_a_table_without_shapes_is_said() -> None:
    made = ready(
        f"T3 M6\n{CUT}", wishes=SetupRequest(tools=(ToolSource("tool.tbl", {3: Tool(3, 8.0)}, shapeless=True),))
    )
    assert (
        made.findings[0].text == "T3: tool.tbl tells no shapes, so it is taken to be flat, 8 mm; --tool says otherwise."
    )


@pytest.mark.parametrize(
    ("comment", "told", "expected"),
    [
        ("", {0: GIVEN}, {3: GIVEN}),
        ("", {3: GIVEN}, {3: GIVEN}),
        ("(T5 flat 4 mm)\n", {}, {5: Tool(5, 4.0)}),
        ("(T5 flat 4 mm)\n", {5: Tool(5, 9.0), 3: GIVEN}, {5: Tool(5, 9.0)}),
        ("(tool radius 3.0)\n", {}, {1: Tool(1, 6.0)}),
        ("(hitofude: tool=2,flat,3)\n", {}, {2: Tool(2, 3.0)}),
    ],
)
def test_the_tool_of_a_program_that_names_none(comment: str, told: dict[int, Tool], expected: dict[int, Tool]) -> None:
    made = ready(comment + CUT, wishes=SetupRequest(tools=(ToolSource("--tool", told),)))
    assert made.setup.tools == expected
    assert set(made.setup.numbers().tolist()) == set(expected)
    assert set(made.programs[0].time.by_tool) == set(expected)


def test_a_nameless_tool_beside_named_ones() -> None:
    text = f"{CUT}T2 M6\n{CUT}"
    assert tools(text, told=(ToolSource("--tool", {0: Tool(1, 5.0), 2: Tool(2, 3.0)}),)) == {
        1: Tool(1, 5.0),
        2: Tool(2, 3.0),
    }
    assert tools(text, told=(ToolSource("--tool", {7: Tool(7, 5.0), 2: Tool(2, 3.0)}),)) == {
        7: Tool(7, 5.0),
        2: Tool(2, 3.0),
    }
    with pytest.raises(
        InputError, match=r"p1\.ngc:4: a tool that the program does not name cuts from here on.*--tool 0=flat:6"
    ):
        tools(text, told=(ToolSource("--tool", {2: Tool(2, 3.0)}),))


def test_files_that_name_no_tool() -> None:
    files = [f"(hitofude: tool={number},flat,{diameter})\n{CUT}" for number, diameter in ((1, 6), (2, 3))]
    assert tools(*files) == {1: Tool(1, 6.0), 2: Tool(2, 3.0)}
    sizes = [f"(tool radius {radius})\n{CUT}" for radius in (3.0, 1.5, 3.0)]
    made = ready(*sizes)
    assert [tool.diameter for tool in made.setup.tools.values()] == [6.0, 3.0]
    assert [{each.program.states[k].tool for k in each.program.motions.state.tolist()} for each in made.programs] == [
        {1},
        {2},
        {1},
    ]


@pytest.mark.parametrize(
    ("comment", "expected"),
    [
        ("", (7, 7, -2, 43, 23, 0)),
        ("(stock: 60 x 40 x 10 mm)\n", (0, 0, -10, 60, 40, 0)),
        ("(stock X0 Y-5 Z-12 X70 Y45 Z0)\n", (0, -5, -12, 70, 45, 0)),
        (
            "(hitofude: origin_mm=1,2,-3)\n(hitofude: stock_mm=0,0,-9,70,45,0)\n(hitofude: tool=1,flat,6)\n",
            (-1, -2, -6, 69, 43, 3),
        ),
    ],
)
def test_the_stock_of_comments(comment: str, expected: tuple[float, ...]) -> None:
    assert box(comment) == expected


def test_a_size_lies_where_the_cuts_suggest() -> None:
    centred = CUT.replace("X10 Y10", "X-20 Y-10")
    made = ready(f"(T1 flat 6 mm)\n(stock: 60 x 40 x 10 mm)\nT1 M6\n{centred.replace('X40 Y20', 'X20 Y10')}")
    assert made.setup.stock.box == (-30, -20, 30, 20)
    assert made.stock.assumed is not None
    assert (
        "centre at X 0, Y 0, top at Z 0, so X -30.000 to 30.000, Y -20.000 to 20.000, Z -10.000 to 0.000 mm"
        in made.stock.assumed.text
    )
    upwards = ready(f"(T1 flat 6 mm)\n(stock: 60 x 40 x 10 mm)\nT1 M6\n{CUT.replace('Z-2', 'Z3')}")
    assert upwards.setup.stock.over
    assert isinstance(upwards.setup.stock, BoxStock)
    assert (upwards.setup.stock.solid.z0, upwards.setup.stock.solid.z1) == (0, 10)
    assert "bottom at Z 0" in upwards.findings[-1].text


def test_a_box_round_the_cuts_is_said_with_all_its_numbers() -> None:
    made = ready(f"(T1 flat 6 mm)\nT1 M6\n{CUT}")
    (finding,) = made.findings
    assert (finding.kind, finding.counts) == (FindingKind.ASSUMED, False)
    assert (
        "X 7.000 to 43.000, Y 7.000 to 23.000, Z -2.000 to 0.000 mm; --stock X0,Y0,Z0,X1,Y1,Z1 gives another"
        in finding.text
    )
    above = ready(f"(T1 flat 6 mm)\nT1 M6\n{CUT.replace('Z-2', 'Z3').replace('X40', 'X40 Z1')}")
    assert isinstance(above.setup.stock, BoxStock)
    assert (above.setup.stock.solid.z0, above.setup.stock.solid.z1) == (1, 5)


def test_a_box_that_is_assumed_holds_the_part(samples: Path) -> None:
    against = ("fig2.dxf", (samples / "fig2.dxf").read_bytes())
    made = ready(f"(T1 flat 6 mm)\nT1 M6\n{CUT.replace('X40', 'X99')}", wishes=SetupRequest(against=against, depth=4.0))
    assert isinstance(made.setup.stock, BoxStock)
    assert made.setup.stock.solid == StockBox(6, 6, -4, 102, 96, 0)
    assert "a box round the cuts and the part is assumed, X 6.000 to 102.000" in made.findings[0].text


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (
            "(T1 flat 6 mm)\nT1 M6\nG0 Z5\nG0 X1 Y1\n",
            r"p1\.ngc: nothing is cut; the program has no motion at feed rate",
        ),
        (
            "(T1 flat 6 mm)\nT1 M6\nG0 Z5 X0 Y0\nG1 X5 Y5 F100\n",
            r"no box can be laid round its cuts, as they do not go down; give it: --stock",
        ),
        ("(T1 flat 6 mm)\nT1 M6\nG1 X5 Y5 F100\n", "no box can be laid round its cuts"),
        ("G1 X[ F100\n", r"p1\.ngc:2:.*What stands behind it cannot be cut; correct it"),
    ],
)
def test_programs_that_cannot_be_cut(text: str, words: str) -> None:
    with pytest.raises(InputError, match=words):
        ready(text)


def test_our_own_header_tells_everything(samples: Path) -> None:
    drawing = (samples / "fig2.dxf").read_bytes()
    machining = MachiningOptions.of(depth=3.0, stock_to_leave=0.1)
    options = MakeOptions(origin_xy=OriginXY.CENTRE, origin_z=OriginZ.BOTTOM, layers=(), machining=machining)
    made = make("fig2.dxf", drawing, options)
    examined = examine("fig2.ngc", made.nc.text.encode(), ExamineOptions())
    got = setup_of((examined,), SetupRequest(against=("fig2.dxf", drawing)))
    part, stock = got.setup.part, got.setup.stock
    assert isinstance(part, FlatPart)
    assert isinstance(stock, BoxStock)
    assert part.origin == (51.0, 51.0, -10.0)
    assert stock.solid == StockBox(-45, -45, 0, 45, 45, 10)
    assert [(type(each), each.cut.tool, each.cut.depth, each.cut.stock_to_leave) for each in part.job.operations] == [
        (PocketOperation, 1, 3.0, 0.1),
        (RestOperation, 2, 3.0, 0.1),
        (ContourOperation, 2, 3.0, 0.1),
    ]
    assert len(part.regions) == len(made.program.regions)
    assert 0.001 < part.wall_tolerance < 0.002
    assert not [finding for finding in got.findings if finding.kind is FindingKind.ASSUMED]


def test_what_is_asked_goes_before_the_job_and_the_job_before_the_header(samples: Path) -> None:
    drawing = (samples / "fig2.dxf").read_bytes()
    examined = examine("fig2.ngc", make("fig2.dxf", drawing, MakeOptions()).nc.text.encode(), ExamineOptions())
    text = (
        b'[stock]\nmargin = 5\nthickness = 20\n[origin]\nxy = "lower-left"\n[[operation]]\nkind = "pocket"\ntool = '
        b"1\ndepth = 5\n"
    )
    job = read_job("j", text)

    def part(wishes: SetupRequest) -> tuple[FlatPart, ReadySetup]:
        got = setup_of((examined,), wishes)
        assert isinstance(got.setup.part, FlatPart)
        return got.setup.part, got

    found, got = part(SetupRequest(against=("fig2.dxf", drawing), job=job))
    assert [each.cut.depth for each in found.job.operations] == [5.0]
    assert (found.origin, got.stock.source) == ((1.0, 1.0, 0.0), "the job file, round the drawing")
    assert got.setup.stock.box == (0, 0, 100, 100)
    asked, _ = part(
        SetupRequest(
            against=("fig2.dxf", drawing), job=job, depth=7.0, leave=0.2, tolerance=0.05, origin=(OriginXY.CENTRE, None)
        )
    )
    assert [(each.cut.depth, each.cut.stock_to_leave) for each in asked.job.operations] == [(7.0, 0.2)]
    assert (asked.origin, asked.tolerance, asked.wall_tolerance) == ((51.0, 51.0, 0.0), 0.05, 0.05)
    given = BoxStock(StockBox(0, 0, -4, 9, 9, 0))
    assert part(SetupRequest(against=("fig2.dxf", drawing), job=job, stock=given))[1].setup.stock is given
