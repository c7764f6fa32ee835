"""Dwells whose unit is doubtful are told of where somebody's program is looked at, and only there."""

from __future__ import annotations

import pytest

from app.gcode.checks.dwells import doubtful_dwells
from app.gcode.interpreter.dialect import Dialect
from app.gcode.interpreter.options import ReadOptions
from app.gcode.interpreter.reader import read_program
from app.usecases.examine import ExamineOptions, examine

CUTS = "G21 G90 G17\nG1 Z1. F100.\n"


def told(text: str, dialect: Dialect) -> list[str]:
    data = text.encode()
    found = doubtful_dwells(read_program(data, ReadOptions(dialect=dialect)), data, dialect)
    return [f"{each.line}: {each.text}" for each in found]


@pytest.mark.parametrize(
    ("dialect", "line", "warning"),
    [
        *(
            (dialect, "G4 P1500", f"the dwell is 1500 s, for {title} counts P in seconds")
            for dialect, title in [(Dialect.GRBL, "grbl"), (Dialect.LINUXCNC, "LinuxCNC"), (Dialect.MACH3, "Mach3")]
        ),
        (Dialect.LINUXCNC, "g4 p 500", "if milliseconds are meant, write P0.5."),
        (Dialect.LINUXCNC, "G82 X1 Z-1 R1 P500 F100", "the dwell is 500 s"),
        (Dialect.FANUC, "G4 P2", "the dwell is 2 ms, for Fanuc counts one without a decimal point in milliseconds"),
        (Dialect.FANUC, "G4 X5", "if seconds are meant, write X5000."),
        (Dialect.HAAS, "G4 P2", "if seconds are meant, write P2000."),
    ],
)
def test_a_dwell_that_looks_like_one_in_another_unit_is_told(dialect: Dialect, line: str, warning: str) -> None:
    (found,) = told(f"{CUTS}{line}\nM30\n", dialect)
    assert found.startswith("3: ") and warning in found


@pytest.mark.parametrize(
    ("dialect", "line"),
    [
        *((dialect, "G4 P1.5") for dialect in Dialect),
        (Dialect.GRBL, "G4 P60"),
        (Dialect.GRBL, "G4 P500."),
        (Dialect.HAAS, "G4 P500"),
        (Dialect.HAAS, "G4 P0"),
        (Dialect.HAAS, "G4 P.005"),
        (Dialect.FANUC, "G4 X0.005"),
    ],
)
def test_a_dwell_whose_unit_is_written_is_not(dialect: Dialect, line: str) -> None:
    assert not told(f"{CUTS}{line}\nM30\n", dialect)


def test_a_spindle_may_warm_up() -> None:
    assert not told("M3 S3000\nG4 P300\nM3 S8000\nG4 P600\nM5\nM2\n", Dialect.LINUXCNC)


def test_it_is_told_of_a_file_and_not_of_what_is_read_back() -> None:
    data = f"{CUTS}G4 P500\nM2\n".encode()
    assert "dwell" in str(examine("a.ngc", data, ExamineOptions(dialect=Dialect.GRBL)).problems)
    assert not read_program(data, ReadOptions(dialect=Dialect.GRBL)).problems
