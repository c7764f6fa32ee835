"""Errors and findings at the Python door name what a script gives, and no option of the command line."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

import app as hitofude
from app.api.words import in_python
from app.core.errors import HitofudeError
from app.core.options import option, spelled
from app.core.pool import in_bands
from tests.ui.errors import errors_of_the_program
from tests.ui.sentences import HOLE, ROOT, sentences

OPTION = re.compile(r"(?<![\w-])--[a-z]")
SPELLED = re.compile(r"\"--[a-z]|[ ('{]--[a-z][a-z-]+[ ,.;:)\"]")
NO_SENTENCES = ("table.py", "html.py", "style.py")
"""Files whose dashes are those of style sheets."""


@pytest.mark.parametrize(
    ("name", "value", "told"),
    [
        ("units", "in", "units=Units.INCH"),
        ("units", "m", "units=Units.M"),
        ("px-per-inch", "96", "pixels_per_inch=96"),
        ("px-per-inch", "", "pixels_per_inch"),
        ("skip-layer", '"a b"', 'without_layers=("a b",)'),
        ("layer", "0", 'layers=("0",)'),
        ("tool", "7=flat:6", "tools={7: Tool(7, 6, ToolKind.FLAT)}"),
        ("tool", "0=flat:6", "tools={0: Tool(1, 6, ToolKind.FLAT)}"),
        ("tool", "1=bull:DIAMETER:CORNER", "tools={1: Tool(1, DIAMETER, ToolKind.BULL)}"),
        ("tool", "", "tools"),
        ("stock", "X0,Y0,Z0,X1,Y1,Z1", "stock=box_stock((X0, Y0, Z0, X1, Y1, Z1))"),
        ("stock", "HEIGHTS.npy", "stock=HEIGHTS.npy"),
        ("grid", "9000", "cells=9000"),
        ("post", "fanuc", 'post="fanuc"'),
        ("as", "lines", "form=OutputForm.LINES"),
        ("drill", "D", "drills=(D,)"),
        ("skip-type", "HATCH", 'without_types=("HATCH",)'),
        ("layout", '"Sheet 1"', 'layout="Sheet 1"'),
        ("depths", "drawing", "drawn_depths=True"),
        ("compensation", "wear", "compensation=CutterCompensation.WEAR"),
    ],
)
def test_an_option_is_a_parameter(name: str, value: str, told: str) -> None:
    assert option(name, value) == f"--{name} {value}".rstrip()
    with spelled(in_python):
        assert option(name, value) == told
        assert in_bands(lambda _: option(name, value), 8, worth=1) == [told] * 4
    assert option(name, value) == f"--{name} {value}".rstrip()


def _texts(source: str) -> Iterator[str]:
    """Yield the texts of a file, but for its docstrings."""
    tree = ast.parse(source)
    told = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in told:
            yield node.value


def test_no_sentence_of_the_program_spells_an_option_itself() -> None:
    said = [each.text.replace(HOLE, "7") for each in (*sentences(), *errors_of_the_program())]
    assert sum("--" in text for text in said) > 20
    rooms = [path for path in (ROOT / "app").rglob("*.py") if not {"cli", "ui", "exhibits"} & set(path.parts)]
    files = [path for path in rooms if path.name not in NO_SENTENCES and path != ROOT / "app" / "__main__.py"]
    sources = {path: source for path in files if "--" in (source := path.read_text("utf-8"))}
    found = [(path.name, text) for path, source in sources.items() for text in _texts(source) if SPELLED.search(text)]
    assert found == []


def test_errors_and_findings_are_said_so(tmp_path: Path) -> None:
    program = tmp_path / "other.nc"
    program.write_text("G21 G90\nT7 M6\nS9000 M3\nG0 X0 Y0 Z5\nG1 Z-1 F100\nG1 X30\nM30\n")
    with pytest.raises(HitofudeError, match=r"tools=\{7: Tool\(7, 6, ToolKind\.FLAT\)\}"):
        hitofude.cut(program)
    done = hitofude.cut(program, tools={7: hitofude.Tool(7, 4)}, options=hitofude.CutOptions(cells=64))
    texts = [finding.text for finding in done.findings]
    assert any("stock=box_stock((" in text for text in texts) and not any(map(OPTION.search, texts))
