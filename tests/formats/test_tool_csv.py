"""Tools from spreadsheets, as different programs and countries write them."""

import math

import pytest

from app.core.errors import InputError
from app.formats.tools.csv import read_tool_csv
from app.model.tool import FeedRow, Tool
from app.model.tool_kind import ToolKind


def read(text: str) -> tuple[Tool, ...]:
    return read_tool_csv("t.csv", text.encode())[0].tools


@pytest.mark.parametrize(
    "text",
    [
        "number,diameter_mm,name\n1,6.35,Fräser\n",
        "number;diameter;name\r\n1;6,35;Fräser\r\n",
        "number;diameter_mm;name\n1;6.35;Fräser\n",
        "T\tDia (mm)\tDescription\n1\t6,35\tFräser\n",
        "Tool number;Diameter [in];Name\n1;0,25;Fräser\n;;\n",
        '\ufeff\n"number","diameter_mm","name"\n"1.0"," 6.35 ","Fräser"\n',
        "name,number,diameter_inch\nFräser,1,.25",
    ],
)
def test_a_spreadsheet_is_read_however_it_was_written(text):
    assert read(text) == (Tool(1, 6.35, name="Fräser"),)


def test_other_encodings_are_read():
    text = "number;diameter;name\n1;6,35;Fräser\n"
    for encoding in ("utf-16", "latin-1", "utf-8"):
        assert read_tool_csv("t.csv", text.encode(encoding))[0].tools[0].name == "Fräser"


def test_decimal_commas_go_with_points_for_thousands():
    (tool,) = read("number;diameter;speed;feed;plunge\n1;6,35;12.000;1.234,5;300\n")
    assert (tool.diameter, tool.spindle_speed, tool.feed_rate, tool.plunge_rate) == (6.35, 12000.0, 1234.5, 300.0)
    (tool,) = read("number;diameter;speed\n1;6.35;12.000\n")
    assert (tool.diameter, tool.spindle_speed) == (6.35, 12.0)


def test_units_and_kinds_are_read():
    (tool,) = read(
        "t,dia,type,tip_angle_deg,feed (in/min),teeth,Wood: surface speed (m/min),Wood: feed_per_tooth_in,holder\n"
        "2,10,V-bit,90,10,4,400,0.001,0 x 10; 12.5 x 10; 12.5 x 20\n"
    )
    assert (tool.kind, tool.tip_angle, tool.feed_rate, tool.flutes) == (
        ToolKind.V,
        pytest.approx(math.pi / 2),
        pytest.approx(254),
        4,
    )
    assert tool.feeds == (FeedRow("Wood", 400.0, 0.001 * 25.4),)
    assert tool.holder == ((0, 10), (12.5, 10), (12.5, 20))


def test_columns_of_something_else_are_told():
    library, passed = read_tool_csv("t.csv", b"number,Price,diameter_mm,diameter_furlong\n1,12,6,7\n")
    assert library.tools == (Tool(1, 6.0),)
    assert passed == (
        "t.csv: column 'Price' is none of a tool and is passed over.",
        "t.csv: column 'diameter_furlong' is none of a tool and is passed over.",
    )


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "t.csv: the file is empty"),
        ("\n\n", "t.csv: the file is empty"),
        ("name\nx", "t.csv:1: there must be one column named number, and there is none"),
        ("number,name\n1,x", "one column named diameter_mm"),
        ("number,diameter,dia\n1,2,3", "there are several"),
        ("number,diameter\n1,\n", "t.csv:2: the row has no diameter"),
        ("number,diameter\n1,six\n", "t.csv:2: diameter is 'six'"),
        ("number,diameter\n1,nan\n", "t.csv:2: diameter is nan"),
        ("number,diameter\n1.5,6\n", "t.csv:2: number is 1.5; it must be a whole number"),
        ("number,diameter\n1,0\n", "t.csv:2: T1: diameter is 0 mm"),
        ("number,diameter\n1,6\n1,7\n", "T1 is there 2 times"),
        ("number;diameter;speed\n1;6,5;12.5\n", "decimal commas; use one sign"),
        ("number,diameter,kind\n\n1,6,spoon\n", "t.csv:3: kind: 'spoon' is no kind of tool; use flat, ball"),
        ("number,diameter,holder\n1,6,wide\n", "t.csv:2: holder: 'wide' is no holder"),
        ("number,diameter,holder\n1,6,0 x 1 x 2\n", "is no holder"),
        ("number,diameter,wood: surface_speed_m_min\n1,6,100\n", "t.csv:2: the feeds for wood lack feed_per_tooth"),
        ("number,diameter\n1,6\n" + '"' + "x" * 200_000, "t.csv"),
    ],
)
def test_what_is_wrong_is_told_with_its_place(text, told):
    with pytest.raises(InputError) as error:
        read(text)
    assert all(part in str(error.value) for part in told.split("|")), str(error.value)


@pytest.mark.parametrize(
    "text",
    [
        "number,diameter_mm,corner_radius_mm\n1,6," + "a b " * 500,
        "number,diameter_mm,kind\n1,6," + "a b " * 500,
        "number,diameter_mm," + "a b " * 500 + ": surface_speed\n1,6,90",
    ],
)
def test_a_long_cell_makes_no_long_sentence(text: str) -> None:
    with pytest.raises(InputError) as caught:
        read(text)
    assert len(str(caught.value)) < 300
