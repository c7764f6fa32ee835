"""`hitofude tools`: which tools a drawing wants, in a few lines and as JSON."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from app.cli.main import main

ROOT = Path(__file__).parents[2]
FIG2 = ROOT / "resources/samples/fig2.dxf"


def test_what_fig2_wants(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Its circle has a radius of 12; the polygon has sharp corners alone; the triangle stands 14 mm from the wall
    below.
    """
    assert main(["tools", str(FIG2), "--report", str(tmp_path / "r.json")]) == 0
    shown = capsys.readouterr().out
    assert "fig2.dxf: take T" in shown
    assert "narrowest passage 14.000 mm at" in shown
    assert "smallest inner radius 12.000 mm" in shown
    report = json.loads((tmp_path / "r.json").read_text())
    first, second = report["regions"]
    assert first["narrowest_passage"]["size"] == pytest.approx(14.0)
    assert second["largest_tool_that_clears"]["size"] == pytest.approx(24.0)
    assert report["contour_tool"] in [tool["number"] for tool in report["tools"]]
    assert report["time_s"] > 0


def test_tools_of_a_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    tools = tmp_path / "mine.csv"
    tools.write_text("number,diameter,kind\n1,6,flat\n2,3,flat\n")
    assert main(["tools", str(FIG2), "--tools", str(tools)]) == 0
    shown = capsys.readouterr().out
    assert "T2 Flat 3 mm: reaches 99.93%" in shown
    assert "T3" not in shown


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ([], "DRAWING is missing"),
        ([str(FIG2), "--layer", "walls"], "no layer walls"),
        ([str(FIG2), "--depth", "0"], "--depth is 0 mm"),
        ([str(FIG2), "--tools", "x.doc"], "does not exist"),
        ([str(FIG2), "--report", str(FIG2)], "is also an input"),
    ],
)
def test_what_is_wrong_is_told_in_one_line(
    arguments: list[str], words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["tools", *arguments]) == 2
    shown = capsys.readouterr()
    assert (shown.out, shown.err.count("\n")) == ("", 1)
    assert words in shown.err


def test_help(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["tools", "--help"]) == 0
    assert "--stepdown" in capsys.readouterr().out
    assert main(["--help"]) == 0
    assert "hitofude tools DRAWING" in capsys.readouterr().out
