"""Texts that are made to break a reader end in an error, or in what they say: in time, in memory, with a place."""

import pytest

import app.gcode.interpreter.run  # compiled code, loaded before texts are judged  # noqa: F401
from app.gcode.interpreter.dialect import Dialect
from app.gcode.interpreter.reader import read_program
from tests.gcode.interpreter.hostile import HOSTILE
from tests.gcode.interpreter.judged import judged, judged_apart

DIALECTS = (Dialect.LINUXCNC, Dialect.FANUC, Dialect.GRBL)


@pytest.mark.parametrize("name", HOSTILE)
def test_nothing_breaks_the_reader(name: str) -> None:
    """In a process of its own, which may grow by 500 MB."""
    text = HOSTILE[name]()
    for dialect in DIALECTS:
        assert judged_apart([text], dialect) == "", dialect


REFUSED = {
    "brackets in brackets": (1, "longer than"),
    "brackets, many lines": (1, "deep"),
    "parameters of parameters": (2, "deep"),
    "a long sum of parameters": (2, ""),
    "a tower of powers": (1, "no value"),
    "division by zero": (1, "zero"),
    "modulo zero": (1, "zero"),
    "root of a negative": (1, "no value"),
    "logarithm of zero": (1, "no value"),
    "exponent of a million": (1, "no value"),
    "a loop without end": (3, "for ever"),
    "a do loop without end": (3, "repeat"),
    "repeats without end": (1, "repeat"),
    "a subroutine that calls itself": (2, "deep"),
    "numbers that are none": (1, "expected"),
    "far away": (1, "away"),
    "turns without end": (2, "turns"),
    "an unknown subroutine": (1, "subroutine"),
    "utf-8 that is none": (3, "begins no word"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_errors_say_what_and_where(name: str) -> None:
    line, words = REFUSED[name]
    error = judged(HOSTILE[name]()).error
    assert error is not None and error.line == line and words in error.text, error


def test_a_text_in_utf_16_is_read() -> None:
    program = judged(HOSTILE["utf-16"]())
    assert program.error is None and program.motions.end.tolist() == [[1.0, 0.0, 0.0], [1.0, 2.0, 0.0]]


def test_the_judge_sees_a_text_that_takes_too_long(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tests.gcode.interpreter.judged.SECONDS", 0.0)
    with pytest.raises(AssertionError, match=" s for b"):
        judged(b"G0 X1\n")


def test_the_judge_sees_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tests.gcode.interpreter.judged.MEGABYTES", 1)
    # columns of 80 MB: from 32 MB on the system is asked for each, whatever a process that has run long has at hand
    assert "MemoryError" in judged_apart([b"G0 X1\n" * 10_000_000], Dialect.LINUXCNC)
    assert len(read_program(b"G0 X1\n").motions) == 1
