"""Programs in another control's words: every number and mode said as that control takes it, or refused by line and
word.
"""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from app.core.errors import InputError
from app.gcode.interpreter.dialect import Dialect
from app.gcode.interpreter.dialect_guess import guess_dialect
from app.gcode.interpreter.options import ReadOptions, ToolOffset
from app.gcode.interpreter.program import EventKind, NcProgram
from app.gcode.interpreter.reader import read_program
from app.gcode.posts import load_post
from app.gcode.translate.program import translated
from app.gcode.writer.blocks import Blocks
from app.model.motion import MotionKind, Motions
from app.model.motion_path import lengths as lengths_of
from tests.examples import examples
from tests.gcode.interpreter.rs274_motions import assert_same, rs274
from tests.gcode.rs274_oracle import RS274
from tests.gcode.translations import CONTROLS, GOLDEN, HEAD, blocks, into, told


def test_a_length_without_a_point_gets_one() -> None:
    """Or it would be a thousandth there: 0.010 mm."""
    assert blocks("fanuc", "G21 G90\nG0 X10\nG1 Y5 Z-1 F100\nM2\n")[2:] == ["G0 X10.", "G1 Y5. Z-1. F100."]
    after = into("fanuc", "G21 G90\nG0 X10\nM2\n").program
    assert after.motions.end.tolist() == [[10, 0, 0]]


def test_a_length_of_thousandths_is_written_out() -> None:
    assert blocks("linuxcnc", "G21 G90\nG0 X10 Y2.5\nM30\n", "fanuc")[3:] == ["G0 X0.0100 Y2.5000"]


def test_dwells_count_as_the_control_counts_them() -> None:
    assert "G4 P1500" in blocks("fanuc", "G4 P1.5\nG0 X1\nM2\n")
    assert "G4 P1.5" in blocks("grbl", "G4 P1500\nG0 X1.\nM30\n", "fanuc")
    assert "a.ngc:1:4: P0.0004: Haas counts dwells in 0.001 s" in told("haas", "G4 P0.0004\nG0 X1\nM2\n")


def test_pecks_are_moves_where_the_control_has_settings_of_its_own() -> None:
    hole = "G0 X5 Y6 Z2\nG99 G83 X5 Y6 Z-3 R1 Q2 F80\nG80\nM2\n"
    made = ["G1 Z-1. F80.", "G0 Z1.", "Z-0.746", "G1 Z-3.", "G0 Z1."]
    assert blocks("fanuc", hole)[-6:] == ["Z1.", *made]


def test_holes_without_pecks_stay_a_cycle() -> None:
    text = "G0 X5 Y6 Z9\nG98 G81 X5 Y6 Z-3 R1 F80\nX7\nG80\nG0 X0\nM2\n"
    expected = ["G98 G81 X5. Y6. Z-3. R1. F80.", "G98 G81 X7. Y6. Z-3. R1.", "G80", "G0 X0."]
    assert blocks("fanuc", text)[-4:] == expected
    assert not any("G81" in line for line in blocks("grbl", text)), "grbl has no cycles"


def test_a_length_stands_with_the_move_that_takes_it_up() -> None:
    """Alone G43 may move Z by the offset on a Fanuc."""
    assert blocks("fanuc", HEAD + "G43\nG0 X1\nZ15\nG1 Z-1 F100\nG49\nG0 Z20\nM2\n")[-4:] == [
        "G0 X1.",
        "G0 G43 H1 Z15.",
        "G1 Z-1. F100.",
        "G0 G49 Z20.",
    ]
    assert blocks("linuxcnc", "G21 G90\nT3 M6\nG0 G43 H3 Z15.\nM30\n", "fanuc")[-2:] == ["G43 H3", "G0 Z15.0000"]


def test_path_modes_are_those_of_the_control() -> None:
    text = "G64 P0.05\nG0 X1\nG61\nG1 X2 F100\nM2\n"
    assert blocks("haas", text)[1:] == ["G187 E0.010", "G187 E0.050", "G0 X1.", "G61", "G1 X2. F100."]
    assert blocks("fanuc", text)[1:] == ["G64", "G0 X1.", "G61", "G1 X2. F100."]
    assert "G64 P0.0200 Q0" in blocks("linuxcnc", "G21\nG187 E0.02\nG0 X1.\nM30\n", "haas")


def test_units_and_what_they_round_to() -> None:
    assert blocks("fanuc", "G20 G90\nG0 X1\nG21\nG1 X10.12345 F100\nM2\n")[-3:] == ["G0 X1.", "G21", "G1 X10.123 F100."]
    assert into("fanuc", "G20 G90\nG0 X1\nM2\n").data.decode().splitlines()[3] == "G17 G20 G90 G94 G40 G49 G80"


def test_increments_do_not_add_up_their_rounding() -> None:
    text = "G21 G90 G0 X0 Y0 Z0\nG91\n" + "G1 X0.0004 F100\n" * 1000 + "M2\n"
    after = into("fanuc", text).program
    assert after.motions.end[-1, 0] == pytest.approx(0.4, abs=1e-9)


def test_arcs_have_their_centre_from_the_start_and_no_full_turn() -> None:
    assert blocks("fanuc", "G90.1\nG0 X10 Y0\nG3 X-10 Y0 I0 J0 F100\nM2\n")[-1] == "G3 X-10. Y0. I-10. J0. F100."
    assert blocks("haas", "G0 X10 Y0\nG2 X10 Y0 I-10 F100\nM2\n")[-2:] == [
        "G2 X-10. Y0. I-10. J0. F100.",
        "X10. Y0. I10. J0.",
    ]
    assert blocks("linuxcnc", "G0 X10. Y0.\nG18 G3 X12. Z0. R1. F100.\nM30\n", "fanuc")[-1].startswith(
        "G3 X12.0000 Z0.0000 I1.0000 K"
    )


def test_comments_are_in_the_controls_signs() -> None:
    made = into("fanuc", '(slot 1; "deep")\nG0 X1 ;go\nM2\n').data.decode()
    assert "(SLOT 1, ,DEEP,)\n" in made and "(GO)\n" in made
    text = (GOLDEN / "linuxcnc_mm.ngc").read_text()
    assert "(Hitofude for LinuxCNC" in text
    after = into("fanuc", text).data
    assert b"HITOFUDE FOR LINUXCNC" not in after and guess_dialect(after) is Dialect.FANUC


REFUSED = [
    ("fanuc", "G0 X[#5420+1]\nM2\n", "a.ngc:1: what #5420 is the program does not say"),
    ("fanuc", "G0 X1\nG0 Y#<_y>\nM2\n", "a.ngc:2: what #<_y> is the program does not say"),
    ("fanuc", "G0 X1\nG0 X#100\nM2\n", "a.ngc:2: what #100 is the program does not say"),
    ("grbl", "o1 if [#5221 gt 0]\nG0 X1\no1 endif\nG0 X2\nM2\n", "a.ngc:1: what #5221 is the program does not say"),
    ("grbl", "/G0 X1\nG0 X2\nM2\n", "a.ngc:1: a block that may be left out (/) is always done by grbl"),
    ("fanuc", "G0 X1\n/2 G0 X2\nM2\n", "a.ngc:2: a switch of its own for some blocks (/2)"),
    ("fanuc", "F100\nG1 X1\n/X2 F50\nX3\nM2\n", "a.ngc:4: what is written for Fanuc is not the same there (feed"),
    ("fanuc", "G0 X1\nM2\nG0 X5\n", "a.ngc:3: what stands behind the end"),
    ("fanuc", "F100\nG2 X0 I1 P3\nM2\n", "a.ngc:2:10: P3: several turns in one block"),
    ("haas", "G59.1\nG0 X1\nM2\n", "a.ngc:1:1: G59.1: Haas has no G59.1"),
    ("haas", "G0 X1 A5\nM2\n", "a.ngc:1:7: A5: the axis A is not written for Haas"),
    ("haas", "M62 P1\nG0 X1\nM2\n", "a.ngc:1:1: M62: M62 has no counterpart"),
    ("haas", "M101\nG0 X1\nM2\n", "a.ngc:1:1: M101: M101 has no counterpart"),
    ("haas", "S100.5 M3\nG0 X1\nM2\n", "a.ngc:1:1: S100.5: Haas takes whole speeds only"),
    ("haas", "S100 M3\nF100\nG0 Z5\nG84 X1 Y1 Z-1 R1 P0.1\nM2\n", "a.ngc:4:1: G84: the dwell of G84 is at another"),
    ("haas", "S100 M3\nF100\nG0 Z5\nG91 G99 G84 X1 Y1 Z-1 R1\nM2\n", "a.ngc:4:9: G84: G84 under G91"),
    ("mach3", "S100 M3\nF100\nG0 Z5\nG99 G84 X1 Y1 Z-1 R1\nM2\n", "a.ngc:4:5: G84: G84 does not tap alike on Mach3"),
    ("fanuc", "S100 M3\nF100\nG0 Z5\nG88 X1 Y1 Z-1 R1 P1\nM2\n", "a.ngc:4:1: G88: behind G88 the operator"),
    ("fanuc", "S9 M3\nF1\nG0 Z5\nG87 X1 Y1 Z-1 R1 I1 J0 K0\nM2\n", "a.ngc:4:1: G87: G87 goes in beside the axis"),
    ("haas", "G38.2 Z-5 F100\nM2\n", "a.ngc:1:1: G38.2: Haas has no G38.2"),
    ("haas", "F100\nG53 G1 X5\nM2\n", "a.ngc:2:1: G53: G53 has no counterpart"),
    ("haas", "G0 @5 ^30\nM2\n", "a.ngc:1:4: @5: polar coordinates are not written"),
    ("grbl", "T1 M6\nG0 X1\nM2\n", "a.ngc:1:4: M6: grbl changes no tools"),
    ("grbl", "G43.1 Z5\nG0 X1\nM2\n", "a.ngc:1:1: G43.1: G43.1 has no counterpart"),
]


@pytest.mark.parametrize(("control", "text", "words"), REFUSED)
def test_what_has_no_counterpart_is_named(control: str, text: str, words: str) -> None:
    assert words in told(control, text)
    assert told(control, text).endswith("keep the program for LinuxCNC.")


SUBS = {
    "fanuc": "G21 G90 F100.\nG0 X9.\nM30\nO7 (corner)\nG91 G1 X1.\nG90\nM99\n",
    "mach3": "G21 G90 F100\nG0 X9\nM30\nO7\nG1 X1\nM99\n",
    "linuxcnc": "G21 G90 F100\nG0 X9\nM2\no7 sub\nG1 X1\no7 endsub\n",
}


@pytest.mark.parametrize("control", [*CONTROLS, "grbl"])
@pytest.mark.parametrize("came", SUBS)
def test_a_subprogram_that_nothing_calls_is_not_written_and_the_head_says_so(came: str, control: str) -> None:
    if came == control:
        return
    made = into(control, SUBS[came], came)
    assert made.program.motions.end[:, 0].tolist() == [9.0]
    assert b"o7 is not called, so it is not written" in made.data.lower()


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("G0 X9.\nM30\nG1 X5.\nO7\nG1 X1.\nM99\n", 3),
        ("G0 X9.\nM30\nO7\nG1 X1.\nM99\nG1 X5.\n", 6),
        ("G0 X9.\nM30\nG1 X5.\n", 3),
    ],
)
def test_what_stands_beside_such_a_subprogram_is_still_refused(text: str, line: int) -> None:
    assert f"a.ngc:{line}: what stands behind the end" in told("linuxcnc", "G21 F100. " + text, "fanuc")


def test_subprograms_that_nothing_calls_are_counted_where_they_are_many() -> None:
    calls = "G21 F100.\nM98 P3\nM30\n" + "".join(f"O{k}\nG1 X{k}.\nM99\n" for k in range(1, 9))
    assert b"7 subprograms are not called, so they are not written" in into("linuxcnc", calls, "fanuc").data


CURVES = "G21 G90 G17\nF100\nG0 X0 Y0 Z5\nG5 X20 Y10 I10 J0 P-3 Q8\nG5.1 X40 Y0 I10 J12\nG1 X50\nM2\n"


def driven_along(motions: Motions, chord: float = 2e-5) -> np.ndarray:
    """Points (n, 2) of level lines and arcs, from their centres and directions; chords keep within `chord` mm."""
    points = [motions.start[:1, :2]]
    for k in range(len(motions)):
        a, b, centre = motions.start[k, :2], motions.end[k, :2], motions.centre[k, :2]
        if motions.kind[k] >= MotionKind.ARC_CW:
            first, last = (math.atan2(*(place - centre)[::-1]) for place in (a, b))
            sign = 1 if motions.kind[k] == MotionKind.ARC_CCW else -1
            turn = sign * ((sign * (last - first)) % math.tau)
            count = 2 + math.ceil(abs(turn) * math.sqrt(math.hypot(*(a - centre)) / (8 * chord)))
            share = np.linspace(0, 1, count)[1:-1, None]
            size = math.hypot(*(a - centre)) * (1 - share) + math.hypot(*(b - centre)) * share
            points.append(centre + size * np.hstack([np.cos(first + share * turn), np.sin(first + share * turn)]))
        points.append(b[None])
    return np.concatenate(points)


def bezier(points: list[tuple[float, float]], at: np.ndarray) -> np.ndarray:
    """De Casteljau."""
    rows = [np.tile(np.array(point), (len(at), 1)) for point in points]
    while len(rows) > 1:
        rows = [(1 - at[:, None]) * a + at[:, None] * b for a, b in pairwise(rows)]
    return rows[0]


@pytest.mark.parametrize(("control", "step"), [("fanuc", 1e-3), ("haas", 1e-3), ("grbl", 1e-4), ("mach3", 1e-4)])
def test_splines_are_written_as_arcs_within_the_last_decimals(control: str, step: float) -> None:
    made = into(control, CURVES)
    assert not {"G5", "G5.1"} & set(made.data.decode().split()) and b"spline" in made.data.lower()
    motions = made.program.motions
    at = np.linspace(0, 1, 2001)
    meant = np.vstack(
        [bezier([(0, 0), (10, 0), (17, 18), (20, 10)], at), bezier([(20, 10), (30, 22), (40, 0)], at), [(50, 0)]]
    )
    driven = shapely.LineString(driven_along(motions))
    assert driven.hausdorff_distance(shapely.LineString(meant)) < 2.5 * step
    assert len(motions) < 120


WIDE = "G20 G90 G17\nF10\nG0 X0 Y0 Z1\nG5 X{} Y{} I{} J0 P-{} Q{}\nM2\n"


@pytest.mark.parametrize("control", ["mach3", "grbl"])
@pytest.mark.parametrize("wide", [1, 10, 40])
def test_a_spline_a_metre_wide_is_written_in_hundred_thousandths_of_an_inch(control: str, wide: int) -> None:
    """Its chords in the proof are as fine as the last decimal asks, not a thousand however wide it is."""
    numbers = (0.8 * wide, 0.4 * wide, 0.4 * wide, 0.1 * wide, 0.3 * wide)
    made = into(control, WIDE.format(*(f"{number:g}" for number in numbers)))
    x, y, i, p, q = (25.4 * number for number in numbers)
    meant = bezier([(0, 0), (i, 0), (x - p, y + q), (x, y)], np.linspace(0, 1, 20_001))
    turns = made.program.motions.kind >= MotionKind.ARC_CW
    assert np.any(turns) and b"spline" in made.data.lower()
    driven, curve = shapely.LineString(driven_along(made.program.motions)), shapely.LineString(meant)
    shapely.prepare([driven, curve])
    assert shapely.dwithin(driven, shapely.points(meant), 2 * 25.4e-5).all()
    assert shapely.dwithin(curve, shapely.points(driven.coords), 2 * 25.4e-5).all()


@pytest.mark.parametrize("milliseconds", [119, 351, 407, 348, 18, 773, 103])
def test_a_dwell_in_thousandths_is_the_same_in_seconds(milliseconds: int) -> None:
    """351 x 0.001 is not 0.351 to the last bit."""
    assert f"G4 P{milliseconds / 1000:g}" in blocks("linuxcnc", f"G0 X1.\nG4 P{milliseconds}\nG0 X2.\nM30\n", "fanuc")


def test_p_of_a_call_behind_an_arc_counts_no_turns() -> None:
    text = "G21 G90 F100.\nG0 X0. Y0.\nG2 X4. R3.\nM98 P7\nM30\nO7\nG1 X9.\nM99\n"
    assert blocks("linuxcnc", text, "fanuc")[-1] == "G1 X9.0000"


def test_what_is_wrong_behind_a_slash_is_found_whichever_way_the_switch_stands() -> None:
    assert "a.ngc:3:" in told("fanuc", "F100\nG1 X1\n/G1 X[1/0]\nG0 X2\nM2\n")


SWITCHED = (
    "G21 G90 G17\nF100\nG0 X0 Y0 Z5\nG1 Z-1\nX10\n/G1 X20 F50\n/G2 X30 I5\nG1 X40 F100\nY5\n/M8\n/G81 X1 Z-2 R1\n/G80\n"
    "G0 Z11\nM2\n"
)


@pytest.mark.parametrize("control", ["fanuc", "haas", "mach3"])
@pytest.mark.parametrize("left_out", [True, False])
def test_blocks_that_a_switch_leaves_out_keep_their_slash(control: str, left_out: bool) -> None:
    made = into(control, SWITCHED)
    assert sum(line.startswith("/") for line in made.data.decode().splitlines()) >= 4
    before, after = (
        read_program(text, ReadOptions(Dialect(name), block_delete=left_out))
        for text, name in ((SWITCHED.encode(), "linuxcnc"), (made.data, control))
    )
    assert_moves_alike(before, after, made.off)


def test_a_switch_that_changes_what_follows_is_proven_in_both_positions() -> None:
    """What is modal behind it is said again; what hangs on it otherwise is refused."""
    assert blocks("fanuc", "F100\nG1 X1\n/G0 X2\nG1 X3\nM2\n")[-3:] == ["G1 X1. F100.", "/G0 X2.", "G1 X3. F100."]
    assert "is not the same there (rapid or feed" in told("fanuc", "F100\nG1 X1\n/G0 X2\nX3\nM2\n")


LOOP = (
    "G21 F100 (slots)\nG0 X0 Y0 Z5\n#1=0\no1 while [#1 lt 3]\nG1 X[#1*10] Z-1 (slot)\nG0 Z5\n#1=[#1+1]\no1 "
    "endwhile\nM2\n"
)
CALLS = "F100\no<s> sub\nG1 X#1 Y#2\nG2 X[#1+2] I1\no<s> endsub\nG0 X0 Y0\no<s> call [5] [3]\no<s> call [15] [4]\nM2\n"
ROUND = "F100\nG0 X-10 Y0 Z5\nG1 Z-1\nG41.1 D6\nG1 X0 Y0\nY20\nX20\nY0\nG40\nG0 X30\nM2\n"
FANUC_CALLS = (
    "G21 G90 F100.\nG0 X0. Y0.\n#1=2\nWHILE [#1 GT 0] DO1\nM98 P7 L2\n#1=#1-1\nEND1\nM30\nO7\nG91 G1 X1.\nG90\nM99\n"
)


def test_loops_are_written_as_what_they_do() -> None:
    assert blocks("fanuc", LOOP)[2:] == [
        "G0 X0. Y0. Z5.",
        "G1 X0. Z-1. F100.",
        "G0 Z5.",
        "G1 X10. Z-1.",
        "G0 Z5.",
        "G1 X20. Z-1.",
        "G0 Z5.",
    ]
    made = into("fanuc", LOOP).data
    assert b"(LOOPS, SUBROUTINES AND JUMPS ARE WRITTEN OUT" in made and b"(PARAMETERS AND EXPRESSIONS" in made
    assert made.count(b"(SLOT)") == 1, "a comment stands where its line is done first"


def test_subroutines_are_written_where_they_are_called() -> None:
    assert blocks("grbl", CALLS)[-5:] == [
        "G0 X0.0000 Y0.0000",
        "G1 X5.0000 Y3.0000 F100",
        "G2 X7.0000 Y3.0000 I1.0000 J0.0000",
        "G1 X15.0000 Y4.0000",
        "G2 X17.0000 Y4.0000 I1.0000 J0.0000",
    ]


def test_calls_of_fanuc_are_written_for_linuxcnc() -> None:
    made = into("linuxcnc", FANUC_CALLS, "fanuc")
    assert (
        made.program.motions.end[:, 0].tolist() == [0, 1, 2, 3, 4] and b"M98" not in made.data and b"#" not in made.data
    )


def test_cutter_compensation_is_written_as_its_path() -> None:
    """About a square on its left, 3 mm beside it: its outer corners are arcs of that radius."""
    made = blocks("fanuc", ROUND)
    assert made[-6:-1] == ["Y20.", "G2 X0. Y23. I3. J0.", "G1 X20.", "G2 X23. Y20. I0. J-3.", "G1 Y0."]
    assert (
        not any("G41" in line for line in made) and b"CUTTER COMPENSATION IS WRITTEN OUT" in into("fanuc", ROUND).data
    )


@pytest.mark.parametrize("control", ["fanuc", "haas", "mach3", "grbl"])
@pytest.mark.parametrize("text", [LOOP, CALLS, ROUND])
def test_what_is_written_out_moves_alike(control: str, text: str) -> None:
    before = read_program(text.encode())
    made = into(control, text)
    assert_moves_alike(before, made.program, made.off)


@pytest.mark.parametrize("control", CONTROLS)
@pytest.mark.parametrize("came", CONTROLS)
@pytest.mark.parametrize("units", ["mm", "inch"])
def test_our_own_programs_are_the_same_on_every_control(came: str, control: str, units: str) -> None:
    if came == control:
        return
    data = next(GOLDEN.glob(f"{came}_{units}.*")).read_bytes()
    made = translated("a", data, ReadOptions(Dialect(came)), load_post(control))
    before = read_program(data, ReadOptions(Dialect(came)))
    assert_moves_alike(before, made.program, made.off)
    if control == "linuxcnc" and RS274 is not None:
        tools = {number: ToolOffset() for number in (1, 2)}
        printed, complaint = rs274(made.data, tools)
        assert not complaint
        assert_same(made.program, printed)


def travelled(program: NcProgram) -> tuple[np.ndarray, np.ndarray]:
    """Where the tool stands at first and behind each motion, and how far it has gone by then, but for ways to the
    machine's own places.
    """
    motions = program.motions
    kept = np.ones(len(motions), bool)
    kept[list(program.homeward)] = False
    begin = motions.start[:1] if len(motions) else np.zeros((1, 3))
    return np.concatenate([begin, motions.end[kept]]), np.concatenate([[0.0], np.cumsum(lengths_of(motions)[kept])])


def assert_moves_alike(before: NcProgram, after: NcProgram, off: float, parted: int = 2) -> None:
    """The same places in the same order, reached after as long a way, but for those where arcs are parted; and the same
    waits.

    A motion whose ends are written as one place is none there; a full circle, whose ends are one too, has its length.
    """
    assert after.error is None
    (old, gone), (new, by_then) = travelled(before), travelled(after)
    at = 0
    for n, (place, way) in enumerate(zip(old, gone, strict=True)):
        while np.abs(new[at] - place).max() > off or abs(by_then[at] - way) > 2 * math.pi * off * n + 1e-9:
            at += 1
    assert abs(by_then[-1] - gone[-1]) <= 2 * math.pi * off * len(new) + 1e-9, "it goes on"
    assert len(new) - len(old) <= parted * np.sum(before.motions.kind > MotionKind.LINE)
    waits = [[event.value for event in program.events if event.kind is EventKind.DWELL] for program in (before, after)]
    assert waits[0] == waits[1]


TINY = {
    "a rapid": "G0 X0.0001",
    "a rapid between others": "G0 X5.\nG0 X5.0001\nG0 X6.",
    "a cut at the end": "G0 X5.\nG1 X5.0001",
    "cuts between rapids": "G1 X0.0001\nG0 X3.\nG1 X2.9999\nG0 X5.",
    "in inch": "G20\nG1 X0.00001\nG0 X1.",
    "rapids and cuts in turn": "G91\n" + "G0 X0.0004\nG1 X0.0003\n" * 9 + "G90\nG0 X4.",
    "an arc": "G0 X10.\nG2 X10.0001 Y0.0001 R1.",
    "an arc by its centre": "G0 X10.\nG2 X10.0001 Y0. I-5.\nG0 X3.",
    "a full circle that is not": "G0 X10.\nG2 I-5.\nG0 X3.",
    "a narrow one that is": "G0 X10.\nG2 I-0.0001\nG0 X3.",
    "a narrow helix": "G0 X10.\nG2 I-0.0001 Z-1.\nG0 X3.",
    "an arc that turns nearly round": "G0 X10.\nG3 X10. Y-0.0004 R5.\nG0 X3.",
    "with dwells": "G0 X0.0001\nG4 {wait}\nG0 X0.0002\nG4 {wait}\nG0 X4.",
    "a dwell before a full circle": "G0 X5.\nG4 {wait}\nG2 I-1. J0.",
    "a dwell between": "G0 X5.\nG1 X5.0001\nG4 {wait}\nG2 X5.0001 Y0. I-1. J0.\nG0 X9.",
}
"""Motions whose ends another control's last decimal may make one, or only seems to."""


@pytest.mark.parametrize("came", [*CONTROLS, "grbl"])
@pytest.mark.parametrize("what", TINY)
def test_what_is_less_than_the_last_digit_is_no_motion_there(what: str, came: str) -> None:
    for head in ("G21 G90 G17 F100.0", "G20 G90 G17 F10.0"):
        text = "\n".join([head, TINY[what].format(wait="P0.5" if came in ("linuxcnc", "grbl") else "P500."), "M30", ""])
        before = read_program(text.encode(), ReadOptions(Dialect(came)))
        if before.error is not None:
            continue  # an arc whose radii differ too much for this control
        for control in {*CONTROLS, "grbl"} - {came}:
            narrow_arcs_are_lines = 16
            assert_moves_alike(before, (made := into(control, text, came)).program, made.off, narrow_arcs_are_lines)


def test_a_lost_circle_and_a_moved_dwell_are_found_out(monkeypatch: pytest.MonkeyPatch) -> None:
    """What is dropped for being small is held to its path, not to its ends."""
    right = Blocks.block
    lost = {
        "G3 ": "G0 X10\nG3 X10 Y0 I-5 J0 F50",
        "G1 X10.": "G0 X5\nG1 X10.003 F50\nX5",
        "G4 ": "G1 X5 F50\nG4 P0.5\nX5.0001",
    }
    for was, text in lost.items():
        monkeypatch.setattr(
            Blocks, "block", lambda self, line, was=was: right(self, "" if line.startswith(was) else line)
        )
        with pytest.raises(InputError, match="is not the same there"):
            pytest.fail(f"{was} went unseen: {into('fanuc', text + chr(10) + 'M2' + chr(10)).data!r}")


lengths = st.decimals(-40, 40, places=4).map(lambda value: f"{value:.4f}")
axes = st.lists(st.sampled_from("XYZ"), min_size=1, max_size=3, unique=True).flatmap(
    lambda letters: st.tuples(*(lengths for _ in letters)).map(
        lambda values: " ".join(map("".join, zip(letters, values, strict=True)))
    )
)
lines = st.one_of(
    st.builds("G0 {}".format, axes),
    st.builds("G1 {}".format, axes),
    axes,
    st.builds("G91 G1 {}\nG90".format, axes),
    st.builds(
        "G91 G2 {}\nG90".format, st.sampled_from(["X10.0 I5.0", "Y2.0 R1.0", "I3.0 J1.0", "X1.0 Y1.0 I1.0 Z-1.0"])
    ),
    st.builds(
        "G0 Z50.0\n{} X{} Y{} Z-5.0 R2.0\nX{}\nG80".format,
        st.sampled_from(["G98 G81", "G99 G81", "G83 Q2.5", "G82 P0.5"]),
        lengths,
        lengths,
        lengths,
    ),
    st.sampled_from(
        [
            "G20",
            "G21",
            "S900 M3",
            "M5",
            "M8",
            "M9",
            "G4 P0.5",
            "M1",
            "G54",
            "G55",
            "G61",
            "G64",
            "F55.5",
            "T2 M6",
            "(text)",
        ]
    ),
)


@settings(max_examples=examples(60), deadline=None)
@given(st.lists(lines, max_size=10), st.sampled_from(CONTROLS), st.sampled_from(CONTROLS))
def test_random_programs_move_alike_on_every_control(some: list[str], came: str, control: str) -> None:
    text = "\n".join(["G21 G90 G17 F100.0", "G0 X1.0 Y2.0 Z3.0", *some, "M30", ""])
    before = read_program(text.encode(), ReadOptions(Dialect(came)))
    if came == control or before.error is not None:
        return
    assert_moves_alike(before, (made := into(control, text, came)).program, made.off)


def test_a_post_that_does_not_say_its_modes_is_refused() -> None:
    post = load_post("fanuc")
    silent = replace(post, program=replace(post.program, start=("G54",)))
    with pytest.raises(
        InputError,
        match=r"hangs on modes that another job may have left in force; let the post's program\.start say them",
    ):
        translated("a.ngc", b"G21 G90\nG0 X1\nM2\n", ReadOptions(), silent)


def test_a_writer_that_errs_is_found_out(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever the writer does, what the other control makes of it is held against the program that came."""
    right = Blocks.block
    for was, now in (
        ("X10.", "X10.1"),
        ("F100.", "F1000."),
        ("M3", "M4"),
        ("P1500", "P150"),
        ("G1 ", "G0 "),
        ("H1", "H2"),
        ("G55", "G54"),
    ):
        monkeypatch.setattr(Blocks, "block", lambda self, text, was=was, now=now: right(self, text.replace(was, now)))
        text = HEAD + "G4 P1.5\nG43\nG55\nG10 L2 P2 X5\nG0 Z5\nX3\nG1 X10 F100\nM2\n"
        with pytest.raises(InputError, match="is not the same there"):
            pytest.fail(f"{was} went unseen: {into('fanuc', text).data!r}")
    monkeypatch.setattr(Blocks, "block", right)
    into("fanuc", text)


ARCS_OF_OTHERS = """G21 G90
G0 X-23.44 Y-33.83
G2 X-17.195 Y-37.482 I-4.028 J-14.055 F600
G3 X-22.067 Y-36.112 I-2.876 J-0.879 F800
G3 X-21.976 Y-34.166 I-1.736 J1.056 F600
M2
"""


@pytest.mark.parametrize("control", [*CONTROLS, "grbl"])
def test_arcs_whose_radii_differ_in_the_last_digit_change_their_feeds_where_they_end(control: str) -> None:
    """Their centres go to the middle, so that lengths differ, and each program is at its end a little earlier."""
    after = into(control, ARCS_OF_OTHERS).program
    assert after.motions.feed[after.motions.kind != MotionKind.RAPID].tolist() == [600, 800, 600]


def test_older_names_of_units_are_written_as_the_others_have_them() -> None:
    after = into("haas", "G70 G90\nG0 X1.\nG71\nG1 X2. F100.\nM30\n%\n", "mach3")
    assert after.program.motions.end[:, 0].tolist() == pytest.approx([25.4, 2.0])


def test_what_dos_puts_behind_a_text_is_nothing() -> None:
    assert len(into("haas", "G21 G90\nG0 X1.\nM30\n\x1a").program.motions) == 1


@pytest.mark.parametrize("control", ["linuxcnc", "haas"])
def test_repeats_by_k_and_dwells_by_u_go_across(control: str) -> None:
    text = "G21 G90 G0 X0. Y0. Z10.\nG4 U1.5\nG91 G99 G81 X5. Z-8. R-7. K3 F100.\nG80 G90\nG0 Z20.\nM30\n"
    after = into(control, text, "fanuc").program
    lowest = after.motions.end[after.motions.end[:, 2] == -5.0]
    assert lowest[:, 0].tolist() == [5, 10, 15]
    assert [event.value for event in after.events if event.kind is EventKind.DWELL] == [1.5]


def test_commands_of_the_control_itself_are_refused_as_such() -> None:
    assert "a command of the control itself ($)" in told("linuxcnc", "$H\nG21 G90 G0 X1\nM2\n", "grbl")
