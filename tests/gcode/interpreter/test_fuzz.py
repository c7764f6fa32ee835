"""Random texts, some seconds of them here and some minutes with `-m long`: whatever is read, nothing breaks and
everything is told.

The lane and the core must give the same bits: every text is read with the lane, and by the core alone.
"""

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from app.core.progress import NO_PROGRESS
from app.gcode.interpreter.dialect import Dialect
from app.gcode.interpreter.options import ReadOptions
from app.gcode.interpreter.program import NcProgram
from app.gcode.interpreter.run import InterpreterRun
from tests.conftest import ROOT
from tests.examples import examples
from tests.gcode.interpreter.judged import judged
from tests.gcode.interpreter.nc_texts import damaged, grammatical
from tests.gcode.interpreter.plain_oracle import rows_of, same_bits

texts = st.one_of(grammatical.map(str.encode), damaged(), damaged(), st.binary(max_size=300))
short = settings(max_examples=examples(150), deadline=None, suppress_health_check=list(HealthCheck))
minutes = settings(max_examples=examples(20_000), deadline=None, suppress_health_check=list(HealthCheck))


class Core(InterpreterRun):
    """The reader without its lane."""

    def _plain_lines(self) -> bool:
        return False


def assert_lane_and_core_agree(text: bytes, dialect: Dialect) -> NcProgram:
    """Both must say the same of a text, to the last bit."""
    program, slow = judged(text, dialect), Core(text, ReadOptions(dialect), NO_PROGRESS).read()
    assert same_bits(_told(program), _told(slow))
    assert [program.states[k] for k in program.motions.state] == [slow.states[k] for k in slow.motions.state]
    assert program.motions.known_from == slow.motions.known_from
    assert (program.events, program.problems) == (slow.events, slow.problems)
    return program


def _told(program: NcProgram) -> list[tuple[float, ...]]:
    """Rows without the index of their state: the lane may know of states that no motion has."""
    return [row[:-1] for row in rows_of(program.motions)]


@short
@given(texts, st.sampled_from(Dialect))
@example(b"F1G2X0R1Y1", Dialect.FANUC)
@example(b"G20\nG1 F10 X1\nX1 Y.5\n", Dialect.FANUC)
@example(b"IF [1] THEN #1=1.2.3", Dialect.FANUC)
@example(b"#1=0\nN1 #1=#1+1\nX#1\nIF [#1 GT 2] THEN #2=[1\nIF [#1 LT 5] GOTO 1\n", Dialect.FANUC)
def test_random_texts(text: bytes, dialect: Dialect) -> None:
    assert_lane_and_core_agree(text, dialect)


@pytest.mark.exhaustive
@minutes
@given(texts, st.sampled_from(Dialect))
def test_random_texts_for_minutes(text: bytes, dialect: Dialect) -> None:
    assert_lane_and_core_agree(text, dialect)


@pytest.mark.parametrize("path", sorted((ROOT / "tests" / "data" / "nc").glob("*")), ids=lambda path: path.name)
def test_lane_and_core_agree_on_real_programs(path) -> None:  # type: ignore[no-untyped-def]
    text = b"".join(path.read_bytes().splitlines(keepends=True)[:4000])
    assert len(assert_lane_and_core_agree(text, Dialect.LINUXCNC).motions) > 0
