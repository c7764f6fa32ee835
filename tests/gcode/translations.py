"""Programs in another control's words, as the tests of translation ask for them."""

from __future__ import annotations

import pytest

from app.core.errors import InputError
from app.gcode.interpreter.dialect import Dialect
from app.gcode.interpreter.options import ReadOptions
from app.gcode.posts import load_post
from app.gcode.translate.program import TranslatedProgram, translated
from tests.conftest import ROOT

GOLDEN = ROOT / "tests" / "gcode" / "golden"
HEAD = "G21 G90 G17\nT1 M6\nS8000 M3\n"
CONTROLS = ("linuxcnc", "fanuc", "haas", "mach3")


def into(control: str, text: str, came: str = "linuxcnc") -> TranslatedProgram:
    return translated("a.ngc", text.encode(), ReadOptions(Dialect(came)), load_post(control))


def blocks(control: str, text: str, came: str = "linuxcnc") -> list[str]:
    """What is written between the post's own first and last blocks, comments left out."""
    lines = [line for line in into(control, text, came).data.decode().splitlines() if not line.startswith("(")]
    begin = next(k for k, line in enumerate(lines) if line.startswith("G17")) + 1
    return lines[begin : next(k for k, line in enumerate(lines) if line in ("M30", "M2"))]


def told(control: str, text: str, came: str = "linuxcnc") -> str:
    with pytest.raises(InputError) as error:
        into(control, text, came)
    return str(error.value)
