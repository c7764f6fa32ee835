"""The command `check` as its user sees it, on programs of its own and on real ones."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from app.cli.main import main
from app.core.toml_tables import write_tables
from app.formats.machine_toml import load_machine
from app.gcode.interpreter.options import ReadOptions
from app.gcode.interpreter.reader import read_program
from app.usecases.examine import CONTROLS

ROOT = Path(__file__).resolve().parents[2]
PLATE = """\
(T1 flat 6 mm)
G17 G21 G90 G94 G54
G64 P0.01
T1 M6
G43
S8000 M3
G0 Z5
X10 Y0
Z1
G1 Z-2 F200
X60 F600
G3 X60 Y20 I0 J10
G1 X10
G0 Z5
M5
M2
"""


@pytest.fixture
def plate(tmp_path: Path) -> Path:
    path = tmp_path / "plate.ngc"
    path.write_text(PLATE)
    return path


def checked(*arguments: object) -> int:
    return main(["check", *map(str, arguments)])


def test_a_clean_program(plate: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert checked(plate, "--report", tmp_path / "r.json") == 0
    shown = capsys.readouterr()
    assert shown.err == ""
    assert "plate.ngc: no problem as LinuxCNC reads it; 8 motions in 16 lines" in shown.out
    assert "cuts: X 10.000 to 70.000, Y 0.000 to 20.000, Z -2.000 to 1.000 mm" in shown.out
    report = json.loads((tmp_path / "r.json").read_text())
    assert report["length_mm"]["cut"] == pytest.approx(3 + 50 + 31.4159 + 50, abs=1e-3)
    assert report["length_mm"]["rapid"] == pytest.approx(4 + 7)
    assert report["moves"] == {"G0": 4, "G1": 3, "G2": 0, "G3": 1, "spline": 0}
    assert report["extent_mm"]["all"] == {"low": [10, 0, -2], "high": [70, 20, 5]}
    assert report["tools"] == [
        {"number": 1, "kind": "flat", "diameter_mm": 6.0, "time_s": pytest.approx(report["time_s"])}
    ]
    assert report["time_parts_s"]["cut"] > 60 * (131.4 / 600)
    assert "Small router" in report["time_method"]
    assert report["problems"] == []


def test_a_problem_has_file_line_and_column_and_status_1(plate: Path, capsys: pytest.CaptureFixture[str]) -> None:
    plate.write_text(PLATE.replace("G1 X10", "G1 X10 Y[1+"))
    assert checked(plate) == 1
    shown = capsys.readouterr()
    assert "plate.ngc: 1 problem as LinuxCNC reads it" in shown.out
    assert "  ! plate.ngc:13:" in shown.out


def test_a_machine_that_it_does_not_fit(plate: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert checked(plate, "--machine", "router") == 0
    capsys.readouterr()
    small = tmp_path / "small.toml"
    small.write_bytes(write_tables(load_machine("bench_mill")).encode().replace(b"high = 380.0", b"high = 55.0"))
    assert checked(plate, "--machine", small) == 1
    shown = capsys.readouterr().out
    assert (
        "plate.ngc:12: X: the program spans 60.000 mm along X (10.000 to 70.000), and Bench mill travels 55 mm there."
        in shown
    )
    assert "S: the spindle is to turn at 8000 rpm, and that of Bench mill turns at 100 to 5000." in shown
    assert "machine: Bench mill" in shown
    assert checked(plate, "--machine", "lathe") == 2
    assert "There is no machine 'lathe'" in capsys.readouterr().err


@pytest.mark.parametrize("name", CONTROLS)
def test_every_control_reads_in_its_own_way(name: str, plate: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert checked(plate, "--dialect", name) == (0 if name == "linuxcnc" else 1)
    shown = capsys.readouterr().out
    assert f"as {CONTROLS[name]} reads it" in shown
    if name != "linuxcnc":
        assert ("plate.ngc:3:1: G64" if name == "grbl" else "plate.ngc:5:1: G43: G43 needs a word H") in shown


@pytest.mark.parametrize("control", ["linuxcnc", "grbl"])
def test_a_program_without_units_is_told_and_read_as_asked(
    control: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "a.ngc"
    path.write_text("G90\nG0 Z5\nG1 X10 F100\nM2\n")
    assert checked(path, "--dialect", control) == 0
    shown = capsys.readouterr().out
    assert "  units: the program names none (G20, G21) and is read in mm; say --units in if it is in inches\n" in shown
    assert "X 10.000 to 10.000" in shown
    for units, x in (("in", "254.000"), ("mm", "10.000")):
        assert checked(path, "--dialect", control, "--units", units) == 0
        shown = capsys.readouterr().out
        assert f"X {x} to {x}" in shown and "units:" not in shown


def test_units_that_are_said_change_nothing_in_a_program_that_names_its_own(
    plate: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert checked(plate) == 0
    told = capsys.readouterr().out
    assert checked(plate, "--units", "in") == 0
    assert capsys.readouterr().out == told


def test_tools_from_a_table(plate: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    table = tmp_path / "tool.tbl"
    table.write_text("T1 P1 Z30 D8 ;end mill\n")
    plate.write_text(PLATE.replace("(T1 flat 6 mm)\n", ""))
    assert checked(plate, "--tools", table, "--report", tmp_path / "r.json") == 0
    report = json.loads((tmp_path / "r.json").read_text())
    assert report["tools"][0]["diameter_mm"] == 8.0
    assert report["extent_mm"]["all"]["high"][2] == 5.0
    table.write_text("T2 P2 Z30 D8\n")
    assert checked(plate, "--tools", table) == 1
    assert "tool 1 is not in the tool table" in capsys.readouterr().out


def test_comparing_two_programs(plate: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    other = tmp_path / "other.ngc"
    other.write_text(PLATE.replace("G3 X60 Y20 I0 J10", "G3 X70 Y10 I0 J10\nX60 Y20 I-10 J0"))
    assert checked(plate, "--compare", other) == 0
    assert "other.ngc: the same motion" in capsys.readouterr().out
    other.write_text(PLATE.replace("G1 X10\n", "G1 X11\n"))
    assert checked(plate, "--compare", other, "--report", tmp_path / "r.json") == 1
    assert "other.ngc: other motion" in capsys.readouterr().out
    compare = json.loads((tmp_path / "r.json").read_text())["compare"]
    assert compare["same_motion"] is False
    assert compare["differences"][0]["line"] in (13, 14)
    other.write_text("G0 X[")
    assert checked(plate, "--compare", other) == 2


def test_the_frame_of_a_foreign_program(plate: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    frame = tmp_path / "frame.ngc"
    assert checked(plate, "--frame", frame, "--quiet") == 0
    assert capsys.readouterr().out == ""
    read = read_program(frame.read_bytes(), ReadOptions())
    assert read.problems == ()
    assert set(read.motions.kind.tolist()) == {0}
    assert read.motions.end[1:].tolist() == [[10, 0, 5], [70, 0, 5], [70, 20, 5], [10, 20, 5], [10, 0, 5]]
    plate.write_text(PLATE.replace("G54\n", "G55\n"))
    frame.write_text("old")
    assert checked(plate, "--frame", frame) == 2
    assert "cut under plain G54" in capsys.readouterr().err
    assert frame.read_text() == "old"


def test_a_restart_goes_on_with_the_rest(plate: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "rest.ngc"
    assert checked(plate, "--restart-at", 13, "-o", out) == 0
    assert out.read_bytes().endswith(b"G1 X10\nG0 Z5\nM5\nM2\n")
    capsys.readouterr()
    assert checked(plate, "--restart-at", 99, "-o", out) == 2
    assert "Line 99 is not there" in capsys.readouterr().err
    assert out.read_bytes().endswith(b"M2\n")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ("--restart-at 3", "--restart-at LINE and -o OUT.ngc go together"),
        ("-o out.ngc", "go together"),
        ("--dialect okuma", "--dialect is 'okuma'; choose one of"),
        ("--nonsense", "--nonsense is no option of check and no second program can be named"),
        ("--report", "--report has no value"),
        ("--report no/folder/r.json", "there is no folder"),
        ("--tools nowhere.tbl", "nowhere.tbl does not exist"),
        ("--compare nowhere.ngc", "nowhere.ngc does not exist"),
        ("--restart-at first -o out.ngc", "--restart-at"),
    ],
)
def test_a_wrong_option_is_told_in_one_line(
    arguments: str, words: str, plate: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert checked(plate, *arguments.split(" ")) == 2
    shown = capsys.readouterr()
    assert shown.out == ""
    assert shown.err.count("\n") == 1
    assert words in shown.err
    assert "hitofude make" not in shown.err


def test_block_delete_is_a_switch(plate: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    plate.write_text(PLATE.replace("G1 X10\n", "/G1 X5\nG1 X10\n"))
    counts = {}
    for switch in ((), ("--block-delete", "on"), ("--block-delete=off",)):
        checked(plate, *switch, "--report", tmp_path / "r.json", "--quiet")
        report = json.loads((tmp_path / "r.json").read_text())
        counts[switch] = (report["moves"]["G1"], report["block_delete"])
    assert list(counts.values()) == [(3, True), (3, True), (4, False)]
    assert checked(plate, "--block-delete", "maybe") == 2
    assert "--block-delete is 'maybe'; choose one of" in capsys.readouterr().err


def test_warnings_are_shown_and_said_to_be_such(
    plate: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    plate.write_text(PLATE.replace("M5\n", "M101\nM5\n"))
    assert checked(plate, "--report", tmp_path / "r.json") == 1
    assert "  ! plate.ngc:15" in (shown := capsys.readouterr().out)
    assert "(a warning)" in shown
    (problem,) = json.loads((tmp_path / "r.json").read_text())["problems"]
    assert problem["severity"] == "warning"


def test_a_program_that_begins_in_g91_counts_from_zero(plate: Path, tmp_path: Path) -> None:
    """As LinuxCNC's interpreter moves it: X 1 and 5 more, then half a circle up to Y 2."""
    plate.write_text("G91\nG21\nG1 F100 X1 Y1\nG1 Z-1\nX5\nG2 X2 I1\nM2\n")
    assert checked(plate, "--report", tmp_path / "r.json") == 1
    report = json.loads((tmp_path / "r.json").read_text())
    assert report["extent_mm"]["cut"]["low"] == [0, 0, -1] and report["extent_mm"]["cut"]["high"] == pytest.approx(
        [8, 2, 0]
    )
    assert "begin at X0 Y0 Z0" in report["problems"][0]["text"] and len(report["problems"]) == 1


def test_help_names_every_option(capsys: pytest.CaptureFixture[str]) -> None:
    assert checked("--help") == 0
    text = capsys.readouterr().out
    options = "--dialect --tools --block-delete --machine --compare --frame --restart-at --output --report --quiet"
    for option in options.split():
        assert option in text


def test_a_file_is_no_output_and_input(plate: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert checked(plate, "--frame", plate) == 2
    assert "is also an input" in capsys.readouterr().err
    assert plate.read_text() == PLATE


REAL = ("3dtest.ngc", "cds.ngc", "helical-thread-milling.gcode", "jsdc.gcode", "rs274ngc_canned_cycles.ngc", "tux.ngc")


@pytest.mark.parametrize("name", REAL)
def test_real_programs(name: str, shared: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert checked(shared / "data/nc" / name, "--report", tmp_path / "r.json") in (0, 1)
    assert capsys.readouterr().err == ""
    report = json.loads((tmp_path / "r.json").read_text())
    assert report["time_s"] > 0
    assert sum(tool["time_s"] for tool in report["tools"]) == pytest.approx(report["time_s"])
