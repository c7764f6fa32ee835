"""The command `figure11` as its user sees it."""

import json
from pathlib import Path

import pytest

from app.cli.main import HELP, main


def test_the_table_is_printed_and_reported(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "r.json"
    assert main(["figure11", "--programs", "a", "--grid=48", "--repeat", "1", "--report", str(path)]) == 0
    shown = capsys.readouterr()
    assert shown.out.startswith("Figure 11: 48 x 48 cells of 2.083 mm, best of 1") and shown.err == ""
    data = json.loads(path.read_text())
    assert [row["program"] for row in data["programs"]] == ["A"] and data["cells"] == 48
    assert main(["figure11", "--programs", "A", "--grid=48", "--repeat", "1", "--quiet"]) == 0
    assert capsys.readouterr() == ("", "")


def test_the_command_has_its_help(capsys: pytest.CaptureFixture[str]) -> None:
    assert "hitofude figure11" in HELP
    assert main(["figure11", "--help"]) == 0
    said = capsys.readouterr().out
    assert all(option in said for option in ("--programs", "--grid", "--repeat", "--report", "--quiet"))


@pytest.mark.parametrize(
    ("option", "said"),
    [
        ("--programs=A,D", "'A,D' names no programs; write some of A,B,C, each once"),
        ("--programs=A,A", "names no programs"),
        ("--grid=8", "'8' is no number of cells; write a whole number from 16 to 4096"),
        ("--grid=1e3", "no number of cells"),
        ("--repeat=0", "'0' is no number of runs; write a whole number from 1 to 100"),
        ("--engine=gpu", "--engine"),
        ("--report=/nowhere/at/all.json", "there is no folder"),
    ],
)
def test_a_bad_value_is_told_in_one_line(option: str, said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["figure11", option]) == 2
    shown = capsys.readouterr()
    assert shown.out == "" and said in shown.err and shown.err.count("\n") == 1
