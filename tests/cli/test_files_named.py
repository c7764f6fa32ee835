"""Names of files that a command refuses before it works."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.cli.main import main
from app.core.resources import resource


@pytest.mark.parametrize(
    "command",
    [
        ["make", "a.draw", "-o", "-"],
        ["make", "a.draw", "-o-"],
        ["make", "a.draw", "--output=-"],
        ["make", "-", "-o", "a.ngc"],
        ["check", "-"],
        ["cut", "a.ngc", "--image", "-"],
        ["batch", "-", "-o", "out"],
    ],
)
def test_a_dash_is_no_file(
    command: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """No program goes into a file that is called so without a word."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.draw").write_text("rect 0,0 30,20\n")
    assert main(command) == 2
    assert "is '-', and no pipe is read or written; name a file, or ./- for one of that name" in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["a.draw"]


def test_a_file_of_that_name_can_be_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "-").write_text("G21 G90\nG0 X1 Y1 Z1\nM30\n")
    assert main(["check", "./-", "--quiet"]) == 0


def test_an_inlay_looks_for_its_folder_before_it_works(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    drawing, job = resource("samples", "inlay.draw"), resource("samples", "inlay.toml")
    out = tmp_path / "none" / "badge"
    assert main(["inlay", str(drawing), "--job", str(job), "-o", str(out)]) == 2
    said = capsys.readouterr().err
    assert "there is no folder" in said and "make it first" in said and "%" not in said
