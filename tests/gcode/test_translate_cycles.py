"""Cycles of holes in another control's words: left to it where it has the same, else written out as moves."""

from __future__ import annotations

import numpy as np
import pytest

from app.gcode.interpreter.dialect import Dialect
from app.gcode.interpreter.options import ReadOptions
from app.gcode.interpreter.reader import read_program
from app.gcode.writer.blocks import Blocks
from app.model.motion import MotionKind
from tests.gcode.interpreter.rs274_motions import assert_same, rs274
from tests.gcode.rs274_oracle import RS274
from tests.gcode.translations import blocks, into, told

HOLES = "G21 G90 G17\nS500{}\nF100.\nG0 X0. Y0. Z10.\n{} X1. Y2. Z-5. R2.\nX8.\nG80\nG0 Z10.\nM30\n"


def test_a_bore_with_a_standing_spindle_is_written_out() -> None:
    """G86: out at rapid rate behind M5, and on again."""
    hole = ["G1 Z-5. F100.", "G4 P500", "M5", "G0 Z2.", "M3", "X8.", "G1 Z-5.", "G4 P500", "M5", "G0 Z2.", "M3", "Z10."]
    assert blocks("fanuc", HOLES.format(" M3", "G99 G86 P0.5"))[-len(hole) :] == hole
    back = into("linuxcnc", HOLES.format(" M4", "G98 G86"), "fanuc")
    assert back.data.decode().count("M5\nG0 Z10.0000\nM4") == 2


@pytest.mark.parametrize(("control", "came"), [("haas", "fanuc"), ("haas", "linuxcnc"), ("fanuc", "linuxcnc")])
def test_tapping_stays_the_controls_own(control: str, came: str) -> None:
    made = blocks(control, HOLES.format(" M4", "G99 G74"), came)
    at = made.index("G99 G74 X1. Y2. Z-5. R2. F100.")
    assert made[at + 1 :] == ["G80", "G0 X8.", "G99 G74 X8. Y2. Z-5. R2.", "G80", "G0 Z10."]


def test_a_tap_that_the_cycle_starts_is_started_over_the_hole() -> None:
    """On Fanuc G84 turns the spindle itself; LinuxCNC refuses it with a standing one."""
    made = blocks("linuxcnc", HOLES.format("", "G98 G84"), "fanuc")
    at = made.index("M3")
    assert made[at - 1 : at + 4] == [
        "Z2.0000",
        "M3",
        "G99 G84 X1.0000 Y2.0000 Z-5.0000 R2.0000 F100",
        "G80",
        "G0 Z10.0000",
    ]


def test_out_of_a_tapped_hole_fanuc_goes_at_feed_to_r_alone() -> None:
    kinds = read_program(HOLES.format(" M3", "G98 G84").encode(), ReadOptions(Dialect.FANUC)).motions
    hole = [(MotionKind(kind), z) for kind, z in zip(kinds.kind.tolist(), kinds.end[:, 2].tolist(), strict=True)][2:6]
    assert hole == [
        (MotionKind.RAPID, 2.0),
        (MotionKind.LINE, -5.0),
        (MotionKind.LINE, 2.0),
        (MotionKind.RAPID, 10.0),
    ]


@pytest.mark.parametrize(("control", "units"), [("haas", "G21"), ("fanuc", "G20")])
def test_a_tap_that_linuxcnc_leaves_up_to_the_first_height_is_left_as_the_control_does(
    control: str, units: str
) -> None:
    """At feed to R, and up the way that it came down at rapid rate; the head says so."""
    made = into(control, HOLES.format(" M3", "G98 G84").replace("G21", units))
    head = b"(OUT OF TAPPED HOLES THE TOOL GOES AT FEED TO R AND AT RAPID RATE FROM THERE)"
    assert made.data.count(b"G99 G84") == 2 and head in made.data
    motions = made.program.motions
    up = np.flatnonzero((motions.end[:, 2] > motions.start[:, 2]) & (motions.start[:, 2] > -4 * made.off))
    assert set(motions.kind[up].tolist()) == {MotionKind.RAPID}
    before = read_program(HOLES.format(" M3", "G98 G84").replace("G21", units).encode()).motions
    fed = np.flatnonzero((before.kind == MotionKind.LINE) & (before.end[:, 2] == before.end[:, 2].max()))
    assert len(fed) == 2 and not np.isin(fed, made.rows).any(), "they are motions of the first program no more"
    kept = made.rows >= 0
    assert np.abs(motions.end[kept] - before.end[made.rows[kept]]).max() <= made.off


def test_a_way_out_of_a_tapped_hole_at_another_height_is_found_out(monkeypatch: pytest.MonkeyPatch) -> None:
    right = Blocks.block
    monkeypatch.setattr(Blocks, "block", lambda self, line: right(self, line.replace("R2.", "R3.")))
    assert "is not the same there" in told("haas", HOLES.format(" M3", "G98 G84"))


@pytest.mark.skipif(RS274 is None, reason="LinuxCNC is not installed")
@pytest.mark.parametrize("cycle", ["G98 G84", "G99 G84", "G98 G86", "G99 G89"])
def test_cycles_of_fanuc_are_what_linuxcnc_makes_of_them(cycle: str) -> None:
    made = into("linuxcnc", HOLES.format(" M3", cycle), "fanuc")
    printed, complaint = rs274(made.data, {})
    assert not complaint
    assert_same(made.program, printed)
