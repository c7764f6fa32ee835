"""`cut` with tools in holders: what touches is told with its place, its line and what to do, and fails the job."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from app.cli.main import main

DEEP = """\
G21 G90
T1 M6
S1000 M3
G0 X20 Y50 Z5
G1 Z-10 F300
X80
Z-20
X20
Z-26
X80
G0 Z5
M2
"""
STOCK = "--stock=0,0,-40,100,100,0"


@pytest.fixture
def deep(tmp_path: Path) -> Path:
    path = tmp_path / "deep.ngc"
    path.write_text(DEEP)
    return path


def cut(*arguments: object) -> int:
    return main(["cut", *map(str, arguments)])


def test_a_holder_in_metal_is_a_finding(deep: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert cut(deep, STOCK, "--tool=1=flat:6", "--holder=1=ER20:25", "--report", tmp_path / "r.json", "--grid=256") == 1
    said = capsys.readouterr().out
    assert "1 contact of shank or holder" in said
    assert "sticks out 25 mm, 26.0 mm are needed" in said
    assert "The holder of T1 goes into metal, 1.000 mm deep at (" in said
    assert "stick it out 26.0 mm or more, it has 25." in said
    report = json.loads((tmp_path / "r.json").read_text())
    (contact,) = report["holder_contacts"]
    assert (contact["tool"], contact["part"], contact["motions"]) == (1, "holder", 3)
    assert (contact["line"], contact["depth_mm"], contact["z"]) == (
        9,
        pytest.approx(1.0, abs=1e-4),
        pytest.approx(-1.0, abs=1e-4),
    )
    assert abs(contact["x"] - 20) <= 17.5
    (tool,) = report["tools"]
    assert (tool["holder"], tool["shank"], tool["stick_out_mm"], tool["least_stick_out_mm"]) == (
        "35 mm wide",
        "not known",
        25.0,
        26.0,
    )
    assert [each["kind"] for each in report["findings"] if each["counts"]] == ["holder_contact"]


def test_at_the_stick_out_that_was_told_nothing_touches(deep: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert cut(deep, STOCK, "--tool=1=flat:6", "--holder=1=0,10;20,17.5:26", "--grid=256") == 0
    assert "sticks out 26 mm, 26.0 mm are needed" in capsys.readouterr().out


def test_a_holder_that_nobody_knows_is_said_to_be_unknown(
    deep: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cut(deep, STOCK, "--tool=1=flat:6", "--report", tmp_path / "r.json", "--grid=256") == 0
    assert "holder not known" in capsys.readouterr().out
    report = json.loads((tmp_path / "r.json").read_text())
    assert report["holder_contacts"] == []
    assert report["tools"][0]["least_stick_out_mm"] is None


def test_a_library_tells_of_shank_and_holder(deep: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    library = tmp_path / "mine.toml"
    library.write_text(
        "format = 1\n[[tool]]\nnumber = 1\ndiameter = 6\nflute_length = 9\nshank_diameter = 6\nstick_out = 40\n"
        'holder = "ER16"\n'
    )
    assert cut(deep, STOCK, "--tools", library, "--grid=256") == 1
    said = capsys.readouterr().out
    assert "The shank of T1 goes into metal, 1.000 mm deep" in said
    assert "its flutes end 9 mm over the tip; use longer flutes, or clear the metal above first." in said
    assert "The holder" not in said


def test_in_a_window_the_whole_stock_is_looked_at(deep: Path) -> None:
    assert cut(deep, STOCK, "--tool=1=flat:6", "--holder=1=ER20:25", "--window=0,0,5,5", "--grid=128") == 1


@pytest.mark.parametrize(
    ("holder", "said"),
    [
        ("1=ER99:20", "'ER99' is no holder"),
        ("1=ER20", "write NUMBER=HOLDER:STICKOUT"),
        ("1=ER20:0", "stick-out of 0"),
        ("1=0,10;5:20", "1 number in '5'"),
        ("1=5,10;9,10:20", "must begin with 0"),
        ("7=ER20:20", "T7 does not cut"),
    ],
)
def test_what_is_no_holder_is_refused(deep: Path, holder: str, said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert cut(deep, STOCK, "--tool=1=flat:6", f"--holder={holder}") == 2
    assert said in capsys.readouterr().err
