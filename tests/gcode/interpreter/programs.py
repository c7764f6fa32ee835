"""Short ways to read small programs in tests."""

from __future__ import annotations

import numpy as np

from app.gcode.interpreter.dialect import Dialect
from app.gcode.interpreter.options import ReadOptions
from app.gcode.interpreter.program import NcProgram, Severity
from app.gcode.interpreter.reader import read_program
from app.model.motion import MotionKind


def read(text: str, dialect: Dialect = Dialect.LINUXCNC, **options: object) -> NcProgram:
    """Read a text that must be right."""
    program = read_program(text.encode(), ReadOptions(dialect=dialect, **options))  # type: ignore[arg-type]
    assert program.error is None, program.error
    return program


def ends(program: NcProgram) -> list[tuple[float, ...]]:
    """Return where each motion ends, to the nanometre."""
    return [tuple(np.round(end, 6) + 0.0) for end in program.motions.end.tolist()]


def kinds(program: NcProgram) -> list[MotionKind]:
    """Return the kind of each motion."""
    return [MotionKind(kind) for kind in program.motions.kind.tolist()]


def told(text: str, dialect: Dialect = Dialect.LINUXCNC) -> str:
    """Return the error of a text with its place, "" if it has none."""
    error = read_program(text.encode(), ReadOptions(dialect=dialect)).error
    return error.message("a.ngc") if error else ""


def warnings(text: str, dialect: Dialect = Dialect.LINUXCNC) -> list[str]:
    """Return the warnings of a text."""
    program = read_program(text.encode(), ReadOptions(dialect=dialect))
    return [problem.text for problem in program.problems if problem.severity is Severity.WARNING]
