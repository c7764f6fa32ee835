"""Metal that is cut while the spindle stands is told."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.gcode.interpreter.dialect import Dialect
from app.gcode.interpreter.options import ReadOptions
from app.gcode.interpreter.reader import read_program
from app.model.finding import Finding, FindingKind
from app.model.motion_path import anchored
from app.model.stock_box import StockBox
from app.model.tool import Tool
from app.simulation.field.workpiece import BoxStock
from app.usecases.cutting.cut import CutOptions, CutSetup, cut

PLATE = BoxStock(StockBox(0, 0, -10, 60, 40, 0))
HEAD = "G21 G90 G94 G17\nT1 M6\n"
FIRST = "G0 X5. Y5. Z5.\nG1 Z-1. F300.\nX45.\nG0 Z5.\n"
SECOND = "G0 X5. Y25.\nG1 Z-1. F300.\nX45.\nG0 Z5.\n"


def standing(body: str, dialect: Dialect = Dialect.LINUXCNC, options: CutOptions | None = None) -> list[Finding]:
    """What a cut tells of its spindle."""
    read = read_program(f"{HEAD}{body}M30\n".encode(), ReadOptions(dialect=dialect))
    assert read.error is None, read.error
    tools = {number: Tool(number, 6.0) for number in (1, 2)}
    setup = CutSetup((replace(read, motions=anchored(read.motions)),), tools, PLATE)
    found = cut(setup, options or CutOptions(cells=60)).findings
    return [finding for finding in found if finding.kind is FindingKind.SPINDLE]


@pytest.mark.parametrize("ends", ["T2 M6\n", "M5\n"])
@pytest.mark.parametrize("window", [None, (0.0, 0.0, 10.0, 10.0)])
def test_a_tool_that_nobody_starts_again_is_told(ends: str, window: tuple[float, float, float, float] | None) -> None:
    (told,) = standing(f"S3000 M3\n{FIRST}{ends}{SECOND}", options=CutOptions(cells=60, window=window))
    assert (told.counts, told.line, told.x, told.y) == (True, 10, 5.0, 25.0)
    assert f"T{2 if 'T2' in ends else 1} while the spindle stands, the first of 2 motions" in told.text


def test_a_program_that_leaves_the_spindle_to_somebody_else_has_a_remark() -> None:
    (told,) = standing(f"{FIRST}{SECOND}")
    assert not told.counts and "never starts the spindle" in told.text


def test_mach3_leaves_it_to_a_macro_whether_a_change_stops_the_spindle() -> None:
    assert not standing(f"S3000 M3\n{FIRST}T2 M6\n{SECOND}", Dialect.MACH3)


@pytest.mark.parametrize(
    "body",
    [
        f"S3000 M3\n{FIRST}T2 M6\nM4\n{SECOND}",
        f"S3000 M3\n{FIRST}M5\nG0 X5. Y5.\nG1 Z-1. F300.\nX45.\nG0 Z5.\n",
        f"S3000 M3\n{FIRST}M5\nG0 X5. Y25. Z5.\nG1 Z0.5\nX40.\nG0 Z5.\n",
        f"G0 Z5.\nG38.2 Z-1. F50.\nG0 Z5.\nS3000 M3\n{FIRST}",
    ],
    ids=["started again", "where it has cut", "above the metal", "a probe"],
)
def test_what_cuts_nothing_with_a_standing_spindle_is_none(body: str) -> None:
    assert not standing(body)


def test_builders_words_for_spindle_and_coolant_start_it() -> None:
    """M13 is told as a word of the machine, and is M3 with M8 on most of them."""
    for dialect in (Dialect.FANUC, Dialect.HAAS):
        assert not standing(f"S3000 M13\n{FIRST}M5\nT2 M6\nM14\n{SECOND}", dialect)
    assert len(standing(f"S3000 M3\n{FIRST}M5\nM88\n{SECOND}", Dialect.HAAS)) == 1
    told = [each.text for each in read_program(b"G21 S3000 M14\n", ReadOptions(dialect=Dialect.HAAS)).problems]
    assert told == ["M14 is the machine builder's own; it is taken for M4 with coolant."]


def test_taps_of_fanuc_start_the_spindle_themselves() -> None:
    body = f"S3000 M3\n{FIRST}M5\nM29 S500\nG84 X20. Y30. Z-5. R2. F500.\nG80\n"
    assert not standing(body, Dialect.FANUC)
