"""One door for tools in and out, whatever the kind of file."""

import pytest

from app.core.errors import InputError
from app.formats.tools.files import read_rows, read_tools, write_tools
from app.formats.tools.library import ToolLibrary
from app.model.part import Units
from app.model.tool import Tool
from app.model.tool_kind import ToolKind

TOOLS = (Tool(1, 6.0, name="Six", length_offset=50.5, flutes=3), Tool(7, 3.0, ToolKind.BALL, name="Ball"))


@pytest.mark.parametrize("name", ["my.toml", "my.csv", "MY.CSV"])
def test_whole_tools_come_back(name):
    library, left_out = read_tools(name, write_tools(name, ToolLibrary("my", TOOLS)))
    assert (library.tools, left_out) == (TOOLS, ())


@pytest.mark.parametrize("units", [Units.MM, Units.INCH])
def test_a_tool_table_keeps_what_it_holds(units):
    library, _ = read_tools("my.tbl", write_tools("my.tbl", ToolLibrary("", TOOLS), units), units)
    assert [(tool.number, tool.name) for tool in library.tools] == [(1, "Six"), (7, "Ball")]
    assert [tool.diameter for tool in library.tools] == pytest.approx([6.0, 3.0])
    assert library.tools[0].length_offset == pytest.approx(50.5)
    assert library.name == "my"


def test_every_kind_gives_the_rows_of_a_control():
    for name in ("my.toml", "my.csv", "my.tbl"):
        rows = read_rows(name, write_tools(name, ToolLibrary("my", TOOLS)))
        assert [(row.number, row.offset[2], row.diameter) for row in rows] == [(1, 50.5, 6.0), (7, 0.0, 3.0)]


@pytest.mark.parametrize(
    ("name", "data", "told"),
    [
        ("tools.xls", b"", r"tools\.xls: tools are read as \.toml, \.csv, \.tbl"),
        ("t.tbl", b"T1 P1\n", r"t\.tbl:1: T1: diameter is 0 mm"),
    ],
)
def test_what_is_no_file_of_tools_is_told(name, data, told):
    with pytest.raises(InputError, match=told):
        read_tools(name, data)
