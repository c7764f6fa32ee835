"""Canned cycles where no interpreter can be asked: Fanuc's ways, hostile words, what stays from block to block."""

import itertools
import time
from dataclasses import replace

import pytest

from app.gcode.interpreter.cycles import (
    CYCLE_WORDS,
    Cycle,
    CycleMove,
    Dwell,
    Spindle,
    Stop,
    cycle_steps,
    taps_astray,
    with_sticky,
)
from app.gcode.interpreter.dialect import Dialect
from app.gcode.interpreter.options import ReadOptions
from app.gcode.interpreter.program import BlockFault, Severity
from app.gcode.interpreter.reader import read_program
from app.model.motion import MotionKind, Plane

HERE = (0.0, 0.0, 5.0)
DRILL = Cycle("G81", Plane.XY, (1.0, 2.0), -3.0, 1.0)


def heights(cycle: Cycle) -> list[float]:
    return [step.target[2] for step in cycle_steps(cycle, HERE, 5.0) if isinstance(step, CycleMove)]


def test_a_hole_step_by_step() -> None:
    tap = replace(DRILL, code="G84", dwell=0.5, spindle=1)
    up, down, bottom = (1.0, 2.0, 5.0), (1.0, 2.0, 1.0), (1.0, 2.0, -3.0)
    assert list(cycle_steps(tap, HERE, 5.0)) == [
        CycleMove(MotionKind.RAPID, up, up),
        CycleMove(MotionKind.RAPID, down, down),
        CycleMove(MotionKind.LINE, bottom, bottom),
        Spindle(0),
        Spindle(-1),
        Dwell(0.5),
        CycleMove(MotionKind.LINE, up, up),
        Spindle(0),
        Spindle(1),
    ]
    by_hand = list(cycle_steps(replace(tap, code="G88"), HERE, 5.0))
    assert by_hand[2:] == [CycleMove(MotionKind.LINE, bottom, up), Dwell(0.5), Spindle(0), Stop(), Spindle(1)]


def test_tapping_goes_astray_on_linuxcnc_alone() -> None:
    for code, plane, fanuc in itertools.product(CYCLE_WORDS, Plane, (False, True)):
        cycle = Cycle(
            code,
            plane,
            (1.0, 2.0),
            -3.0,
            1.0,
            1,
            0.5,
            1.0,
            (0.0, 0.0, 0.0),
            spindle=-1 if code == "G74" else 1,
            fanuc=fanuc,
        )
        moves = [step for step in cycle_steps(cycle, HERE, 5.0) if isinstance(step, CycleMove)]
        astray = any(move.target != move.meant for move in moves if code != "G88")
        assert astray == taps_astray(cycle) == (code in ("G74", "G84") and plane is not Plane.XY and not fanuc)
        assert all(sorted(move.target) == sorted(move.meant) for move in moves if code != "G88")


def test_who_taps_astray_is_told() -> None:
    text = b"G21 G90 F100 M3 S9 {} G84 X0. Y0. Z-3. R1.\nM30\n"
    for plane, dialect, told in (("G18", Dialect.LINUXCNC, 1), ("G17", Dialect.LINUXCNC, 0), ("G18", Dialect.FANUC, 0)):
        program = read_program(text.replace(b"{}", plane.encode()), ReadOptions(dialect))
        assert [problem.severity for problem in program.problems] == [Severity.WARNING] * told
        assert all("wrong axes" in problem.text for problem in program.problems)


def test_on_fanuc_words_stay_from_code_to_code() -> None:
    deep = Cycle("G83", Plane.XY, (1.0, 2.0), -3.0, 1.0, 5, peck=2.0, fanuc=True)
    drill = with_sticky(Cycle("G81", Plane.XY, (4.0, None), fanuc=True), deep)
    assert (drill.depth, drill.r, drill.peck, drill.hole, drill.repeats) == (-3.0, 1.0, 2.0, (4.0, None), 1)
    assert heights(with_sticky(Cycle("G73", Plane.XY, (4.0, None), fanuc=True), drill)) == [
        5.0,
        1.0,
        -1.0,
        -1.0 + 0.254,
        -3.0,
        5.0,
    ]


def test_on_linuxcnc_words_stay_while_the_code_does() -> None:
    before = Cycle("G82", Plane.XY, (1.0, 2.0), -3.0, 1.0, dwell=2.0)
    same = with_sticky(Cycle("G82", Plane.XY, (4.0, None), r=2.0), before)
    assert (same.depth, same.r, same.dwell) == (-3.0, 2.0, 2.0)
    other = with_sticky(Cycle("G81", Plane.XY, (4.0, None)), before)
    assert (other.depth, other.r, other.dwell) == (None, None, 2.0)
    tap = with_sticky(Cycle("G84", Plane.XY, (4.0, None), -3.0, 1.0), other)
    assert tap.dwell == 2.0
    assert with_sticky(Cycle("G89", Plane.XY, (4.0, None), -3.0, 1.0), tap).dwell is None
    assert with_sticky(same, None) is same


def test_fanuc_needs_no_dwell_no_spindle_and_no_repeat() -> None:
    fanuc = replace(DRILL, fanuc=True)
    assert Dwell(0.0) in list(cycle_steps(replace(fanuc, code="G82"), HERE, 5.0))
    assert Spindle(-1) in list(cycle_steps(replace(fanuc, code="G84"), HERE, 5.0))
    assert list(cycle_steps(replace(fanuc, repeats=0), HERE, -9.0)) == []


def test_on_fanuc_a_small_peck_does_not_return_above_r() -> None:
    small = replace(DRILL, code="G83", depth=0.0, peck=0.4, fanuc=True)
    assert heights(small) == pytest.approx([5.0, 1.0, 0.6, 1.0, 0.854, 0.2, 1.0, 0.454, 0.0, 5.0])
    assert max(heights(replace(small, peck=0.1))[1:-1]) == 1.0
    assert max(heights(replace(small, peck=0.1, fanuc=False))[1:-1]) == pytest.approx(1.154)


def test_a_huge_repeat_is_done_as_far_as_it_is_asked_for() -> None:
    begun = time.process_time()
    steps = list(
        itertools.islice(cycle_steps(replace(DRILL, repeats=10**12, absolute=False, depth=-4.0), HERE, 5.0), 1000)
    )
    assert time.process_time() - begun < 1.0
    assert len(steps) == 1000


@pytest.mark.parametrize(("peck", "lowest"), [(1e-12, -3.0), (1e-300, -3.0), (1e-5, -3.0), (1.0, -1e9)])
@pytest.mark.parametrize("code", ["G73", "G83"])
def test_pecks_without_end_are_refused(code: str, peck: float, lowest: float) -> None:
    with pytest.raises(BlockFault, match="pecks") as fault:
        cycle_steps(replace(DRILL, code=code, peck=peck, depth=lowest), HERE, 5.0)
    assert fault.value.letter == "Q"


@pytest.mark.parametrize(
    ("changed", "letter", "words"),
    [
        ({"r": -4.0}, "R", "R at -4 lies below the bottom of the hole at Z -3"),
        ({"r": None}, "R", "no R word"),
        ({"depth": None}, "Z", "no Z word"),
        ({"plane": Plane.ZX, "depth": None}, "Y", "no Y word"),
        ({"repeats": 0}, "L", "0 times"),
        ({"repeats": -2, "fanuc": True}, "L", "-2 times"),
        ({"code": "G82"}, "P", "no P word"),
        ({"code": "G82", "dwell": -1.0}, "P", "negative"),
        ({"code": "G83"}, "Q", "no Q word"),
        ({"code": "G83", "peck": -1.0}, "Q", "above 0"),
        ({"code": "G87", "spindle": 1}, "I", "no I word"),
        ({"code": "G84"}, "", r"clockwise \(M3\), and it stands"),
        ({"code": "G74", "spindle": 1}, "", r"\(M4\), and it turns clockwise"),
        ({"code": "G86", "dwell": 1.0}, "", "it stands"),
    ],
)
def test_faults_name_the_word(changed: dict[str, object], letter: str, words: str) -> None:
    with pytest.raises(BlockFault, match=words) as fault:
        cycle_steps(replace(DRILL, **changed), HERE, 5.0)
    assert fault.value.letter == letter
    assert fault.value.text.endswith(".")
