"""Errors and findings at the Python door name what a script gives, and no option of the command line."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import app as hitofude
from app.api.words import in_python
from app.core.errors import HitofudeError
from tests.ui.errors import errors_of_the_program
from tests.ui.sentences import HOLE, sentences

OPTION = re.compile(r"(?<![\w-])--[a-z]")


@pytest.mark.parametrize(
    ("said", "told"),
    [
        ("--units in or --units m, or --units mm", "units=Units.INCH or units=Units.M, or units=Units.MM"),
        ("or --px-per-inch 96 if", "or pixels_per_inch=96 if"),
        ('leave it out: --skip-layer "a b"', 'leave it out: without_layers=("a b",)'),
        ("Say --layer Foo --layer 0 to", 'Say layers=("Foo",) layers=("0",) to'),
        ("such as --tool 7=flat:6 (", "such as tools={7: Tool(7, 6, ToolKind.FLAT)} ("),
        ("--tool 1=bull:DIAMETER:CORNER.", "tools={1: Tool(1, DIAMETER, ToolKind.BULL)}."),
        ("--stock X0,Y0,Z0,X1,Y1,Z1.", "stock=box_stock((X0, Y0, Z0, X1, Y1, Z1))."),
        ("(--grid 9000)", "(cells=9000)"),
        ("--post fanuc or --post linuxcnc.", 'post="fanuc" or post="linuxcnc".'),
        ("as lines (--as lines)", "as lines (form=OutputForm.LINES)"),
        ("; --drill D adds one", "; drills=(D,) adds one"),
        ("--skip-type HATCH.", 'without_types=("HATCH",).'),
        ("a -- b, and no--option", "a -- b, and no--option"),
    ],
)
def test_an_option_is_a_parameter(said: str, told: str) -> None:
    assert in_python(said) == told


def test_no_sentence_of_the_program_names_an_option_then() -> None:
    said = [each.text.replace(HOLE, "7") for each in (*sentences(), *errors_of_the_program())]
    assert sum("--" in text for text in said) > 20
    assert [text for text in map(in_python, said) if OPTION.search(text)] == []


def test_errors_and_findings_are_said_so(tmp_path: Path) -> None:
    program = tmp_path / "other.nc"
    program.write_text("G21 G90\nT7 M6\nS9000 M3\nG0 X0 Y0 Z5\nG1 Z-1 F100\nG1 X30\nM30\n")
    with pytest.raises(HitofudeError, match=r"tools=\{7: Tool\(7, 6, ToolKind\.FLAT\)\}"):
        hitofude.cut(program)
    done = hitofude.cut(program, tools={7: hitofude.Tool(7, 4)}, options=hitofude.CutOptions(cells=64))
    texts = [finding.text for finding in done.findings]
    assert any("stock=box_stock((" in text for text in texts) and not any(map(OPTION.search, texts))
