"""Dwells that look as if they were told in another unit than the control counts in."""

from __future__ import annotations

import re
from collections.abc import Iterator

import numpy as np

from ...model.motion import MotionKind
from ..interpreter.dialect import DIALECT_RULES, Dialect
from ..interpreter.program import EventKind, NcProgram, ProgramProblem, Severity

_LONG_S, _SHORT_S = 100.0, 0.01
"""A dwell in seconds that may have been told in milliseconds: few programs that cut wait so long. And one in
milliseconds that may have been told in seconds: it is over before the control has gone to the next block.
"""

_WHOLE = re.compile(rb"([PXU])[ \t]*(\d+)(?![\d.])", re.IGNORECASE)
"""A word of a dwell without a decimal point; who writes the point has thought of the unit."""


def doubtful_dwells(program: NcProgram, data: bytes, dialect: Dialect) -> Iterator[ProgramProblem]:
    """Yield a warning of the first dwell of a program whose unit is doubtful.

    Args:
        data: the program's bytes.
        dialect: of its control.
    """
    rules = DIALECT_RULES[dialect]
    in_seconds = rules.dwell_unit_s == 1.0
    if in_seconds and not (program.motions.kind != MotionKind.RAPID).any():
        return  # warms up a spindle
    lines: list[bytes] | None = None
    for event in program.events:
        strange = event.value >= _LONG_S if in_seconds else 0 < event.value < _SHORT_S
        if event.kind is not EventKind.DWELL or not strange:
            continue
        lines = data.split(b"\n") if lines is None else lines
        words = _WHOLE.finditer(lines[event.line - 1]) if event.line <= len(lines) else ()
        for word in words:
            if np.isclose(int(word[2]) * rules.dwell_unit_s, event.value, rtol=1e-9):
                letter = word[1].decode().upper()
                yield ProgramProblem(event.line, 0, letter, _text(letter, event.value, dialect), Severity.WARNING)
                return


def _text(letter: str, seconds: float, dialect: Dialect) -> str:
    rules = DIALECT_RULES[dialect]
    if rules.dwell_unit_s == 1.0:
        return (
            f"the dwell is {seconds:g} s, for {rules.title} counts {letter} in seconds; if milliseconds are meant, "
            f"write {letter}{seconds / 1000:g}."
        )
    return (
        f"the dwell is {seconds * 1000:g} ms, for {rules.title} counts one without a decimal point in milliseconds; "
        f"if seconds are meant, write {letter}{seconds * 1e6:.0f}."
    )
