"""Every command that takes a drawing asks alike for what its file leaves open, and is answered by the same options."""

from __future__ import annotations

from io import StringIO
from pathlib import Path

import ezdxf
import pytest

from app.cli.main import main

COMMANDS = {
    "make": ("make", "-o", "o.ngc"),
    "make on pixels": ("make", "--bitmap", "100", "-o", "o.ngc"),
    "tools": ("tools",),
    "stages": ("stages", "--bitmap", "100", "-o", "steps"),
}


def drawing(path: Path, units: int, at: float = 0.0, layout: str = "") -> Path:
    """A rectangle of 60 by 40 units."""
    document = ezdxf.new()
    document.header["$INSUNITS"] = units
    if layout:
        document.layouts.new(layout)
    space = document.layouts.get(layout) if layout else document.modelspace()
    corners = [(at, 0.0), (at + 60, 0.0), (at + 60, 40.0), (at, 40.0)]
    for k in range(4):
        space.add_line(corners[k], corners[(k + 1) % 4])
    text = StringIO()
    document.write(text)
    path.write_text(text.getvalue(), "utf-8")
    return path


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize(
    ("units", "at", "layout", "told", "answer"),
    [
        (6, 0.0, "", "60000 x 40000 mm, and the largest tool", ("--units", "mm")),
        (4, 2e6, "", "beyond 1 km", ("--to-zero",)),
        (4, 0.0, "A3", 'say --layout "A3"', ("--layout", "A3")),
    ],
)
def test_what_is_left_open_is_asked_for_and_answered(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    command,
    units,
    at,
    layout,
    told,
    answer,
) -> None:
    monkeypatch.chdir(tmp_path)
    path = drawing(tmp_path / "part.dxf", units, at, layout)
    name, *options = COMMANDS[command]
    assert main([name, str(path), *options]) == 2
    shown = capsys.readouterr()
    assert (
        told in shown.err and shown.err.count("\n") == 1 and [each.name for each in tmp_path.iterdir()] == ["part.dxf"]
    )
    assert main([name, str(path), *options, *answer]) in (0, 1), capsys.readouterr().err


def test_the_density_of_an_svg_that_is_right_is_taken_at_any_size(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "large.svg"
    path.write_text(
        '<svg xmlns="http://www.w3.org/2000/svg"><rect width="3e5" height="1e5" stroke="red" fill="none"/></svg>',
        "ascii",
    )
    assert main(["tools", str(path)]) == 2
    told = capsys.readouterr().err
    assert (
        "say which units are meant, --units mm or --units in or --units m, or --px-per-inch 96 if this is right."
        in told
    )
    assert main(["tools", str(path), "--px-per-inch", "96"]) == 0
