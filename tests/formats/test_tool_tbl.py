"""LinuxCNC's tool table, against LinuxCNC's own interpreter: what it reads we read, what we write it takes as meant."""

import re
import subprocess
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.core.errors import InputError
from app.formats.tools.tbl import LONGEST_LINE, read_tool_table, write_tool_table
from app.model.part import Units
from app.model.tool import Tool
from app.model.tool_table import TableRow, row_of
from tests.examples import examples
from tests.gcode.rs274_oracle import RS274, needs_rs274, own_home

OFFSET = re.compile(r"USE_TOOL_LENGTH_OFFSET\(([-\d. ]+), ([-\d. ]+), ([-\d. ]+)\)")
PLACE = re.compile(r"STRAIGHT_TRAVERSE\(([-\d.]+), ")
CLEAN = [
    "T1 P1 Z0.5 D0.25 ;a",
    "t1 p1 z0.5 d0.25",
    "T1 Z0.5 D0.25",
    "Z0.5 D0.25 P1 T1",
    "T1 P1 Z+0.5 D+.25",
    "T1 P1 Z5e-1",
    "T1.0 P1.0 Z0.5",
    "T1 P1 X1 Y2 Z3 A4 B5 C6 U7 V8 W9 D.5 I10 J20 Q3 ;r;x",
    "T1 P1 Z-0.5 D-0.25",
    "T1 P0 Z.5",
    "T1 P1 Z.5 Z.7",
    "  T1  P1 Z.5;x",
    "T1 P1 Z0.5\r",
    "T1 P1 Z0.5\nT1 P2 Z0.7",
    "; all\n\nT1 P1 Z0.5\nT2 P2",
    "T1 P1 Z-.5 D1.",
]
FAULTY = [
    "T1 P1 Z. D1",
    "T 1 P 1 Z 0.5",
    "T1 P1 Z0.5 K3",
    "T1 P1 Z0.5 hello",
    "T1 P1 Z0.5 (note)",
    "T1 P1 Zabc",
    "P1 Z0.5",
    ";T1 P1 Z0.5",
]
HALF_READ = ["T1P1Z0.5D0.25", "T1\tP1\tZ0.5"]


def control(folder: Path, table: bytes, number: int) -> tuple[tuple[float, ...], float] | None:
    """Return offsets (mm, degrees) and diameter (inch) that LinuxCNC takes for a tool; None where it knows no such
    tool.
    """
    needs_rs274()
    (folder / "tool.tbl").write_bytes(table)
    (folder / "in.ngc").write_text(f"G21\nT{number} M6\nG43 H{number}\nG49\nG0 X[#5410 * 1000]\nM2\n")
    command = [RS274, "-g", "-t", "tool.tbl", "-v", "scratch.var", "in.ngc"]
    run = subprocess.run(command, cwd=folder, capture_output=True, text=True, env=own_home(str(folder)))
    if "not found in the tool table" in run.stderr:
        return None
    assert run.returncode == 0, run.stderr
    groups = OFFSET.search(run.stdout).groups()
    return tuple(float(value) for group in groups for value in group.split()), float(PLACE.search(run.stdout)[1]) / 1000


@pytest.mark.parametrize("text", CLEAN)
def test_a_line_means_what_it_means_to_linuxcnc(tmp_path, text):
    row = read_tool_table("tool.tbl", text.encode(), Units.INCH).rows[0]
    told = control(tmp_path, text.encode() + b"\n", 1)
    assert told is not None
    assert told[0] == pytest.approx((*row.offset, *row.rotary_offset, *row.second_offset), abs=6e-5)
    assert told[1] == pytest.approx(row.diameter / 25.4, abs=1e-6)


@pytest.mark.parametrize("text", FAULTY + HALF_READ)
def test_a_line_that_linuxcnc_passes_over_is_told(tmp_path, text):
    with pytest.raises(InputError, match=r"tool\.tbl:1: |no tool in this file"):
        read_tool_table("tool.tbl", text.encode(), Units.INCH)
    told = control(tmp_path, text.encode() + b"\n", 1)
    assert told is None if text in FAULTY else told == ((0.0,) * 9, 0.0)


def test_every_table_that_comes_with_linuxcnc_is_read():
    needs_rs274()
    files = [path for path in Path("/usr/share/doc/linuxcnc/examples/sample-configs").rglob("*.tbl") if path.exists()]
    old = [path for path in files if b"POCKET" in path.read_bytes()]
    if not set(files) - set(old):
        pytest.skip("the sample configurations of LinuxCNC are not installed (Debian package linuxcnc-doc-en)")
    for path in files:
        if path in old:
            with pytest.raises(InputError, match="'TOOLNO' is no word"):
                read_tool_table(path.name, path.read_bytes())
        else:
            table = read_tool_table(path.name, path.read_bytes())
            assert not table.problems, path
            assert len(table.rows) == len(re.findall(rb"^\s*T\d", path.read_bytes(), re.M)), path


LENGTH = st.floats(-900, 900, allow_nan=False).map(lambda value: round(value, 4) + 0.0)
REMARK = st.text(st.characters(codec="utf-8", exclude_categories=["Cs", "Cc"]), max_size=300)
ROW = st.builds(
    TableRow,
    st.integers(1, 9999),
    st.integers(1, 900),
    st.tuples(LENGTH, LENGTH, LENGTH),
    st.tuples(LENGTH, LENGTH, LENGTH),
    st.tuples(LENGTH, LENGTH, LENGTH),
    st.floats(0, 300).map(lambda value: round(value, 4)),
    LENGTH,
    LENGTH,
    st.integers(0, 9),
    REMARK,
)


@settings(deadline=None, max_examples=examples(60))
@given(st.lists(ROW, min_size=1, max_size=8, unique_by=lambda row: row.number), st.sampled_from([Units.MM, Units.INCH]))
def test_what_is_written_is_read_back(rows, units):
    text = write_tool_table(rows, units)
    assert all(len(line) <= LONGEST_LINE for line in text.split(b"\n"))
    table = read_tool_table("tool.tbl", text, units)
    assert not table.problems
    for meant, read in zip(rows, table.rows, strict=True):
        for name in ("offset", "second_offset", "rotary_offset", "diameter", "front_angle", "back_angle"):
            assert getattr(read, name) == pytest.approx(getattr(meant, name), abs=6e-7), name
        assert (read.number, read.pocket, read.orientation) == (meant.number, meant.pocket, meant.orientation)
        assert " ".join(meant.remark.split()).startswith(read.remark)


@settings(deadline=None, max_examples=examples(12))
@given(st.lists(ROW, min_size=2, max_size=4, unique_by=lambda row: row.number))
def test_linuxcnc_takes_what_is_written(tmp_path_factory, rows):
    folder, text = tmp_path_factory.mktemp("table"), write_tool_table(rows, Units.INCH)
    for row in rows:
        offsets, diameter = control(folder, text, row.number)
        assert offsets == pytest.approx((*row.offset, *row.rotary_offset, *row.second_offset), abs=6e-5)
        assert diameter == pytest.approx(row.diameter / 25.4, abs=1e-6)


def test_a_long_remark_is_no_second_tool(tmp_path):
    row = TableRow(1, 1, remark="T9 P9 Z1 " * 60)
    text = write_tool_table([row], Units.INCH)
    assert control(tmp_path, text, 9) is None
    assert control(tmp_path, text, 1) is not None
    if RS274:
        whole = b"T1 P1 ;" + row.remark.encode() + b"\n"
        assert control(tmp_path, whole, 9) is not None, "the limit is no longer needed"


def test_lines_that_the_control_passes_over_are_told():
    table = read_tool_table("mill.tbl", b"T1 P1 D6\nT2 P2 Y3 what\n P3 Z4\n")
    assert [row.number for row in table.rows] == [1]
    assert table.problems[0].startswith("mill.tbl:2: 'what' is no word")
    assert table.problems[1].startswith("mill.tbl:3: the line has no T word")


def test_rows_become_cutters_where_they_can():
    table = read_tool_table("m.tbl", "T0 P0\nT1 P1 Z50.5 D6 ;Schlichtfräser\nT2 P2 Z1\nT1 P7 D3".encode("latin-1"))
    tools, left_out = table.tools("m.tbl")
    assert tools == (Tool(1, 6.0, name="Schlichtfräser", length_offset=50.5),)
    assert [sentence[:8] for sentence in left_out] == ["m.tbl:1:", "m.tbl:3:"]
    assert row_of(tools[0]) == TableRow(1, 1, (0.0, 0.0, 50.5), diameter=6.0, remark="Schlichtfräser")


@pytest.mark.parametrize("data", [b"", b"\n ; nothing\n", b"\x00\xff" * 40, b"T" * 100_000, b"T1 Z1e999", b"T-3 P1"])
def test_what_holds_no_tool_is_refused(data):
    with pytest.raises(InputError, match=r"m\.tbl"):
        read_tool_table("m.tbl", data)


def test_more_rows_than_linuxcnc_holds_and_doubles_are_refused():
    with pytest.raises(InputError, match="places for 1000"):
        write_tool_table(TableRow(k) for k in range(1, 1002))
    with pytest.raises(InputError, match="T3 is there twice"):
        write_tool_table([TableRow(3), TableRow(3)])
