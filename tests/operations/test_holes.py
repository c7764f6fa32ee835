"""Holes that are reamed, tapped, countersunk, bored and threaded: closed forms of their moves, and what is refused."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from app.core.errors import ParameterError
from app.model.curve_selectors import read_selectors
from app.model.hole_operations import (
    BoreOperation,
    CountersinkOperation,
    DrillOperation,
    ReamOperation,
    TapOperation,
    ThreadOperation,
)
from app.model.job import Job, Stock
from app.model.moves import MoveKind, Program, Purpose
from app.model.operation import CutParameters, Direction, Operation
from app.model.thread_sizes import ThreadSize
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.operations.bore.paths import ways_of
from app.operations.compute import compute
from app.operations.thread.paths import correction, flank_error, way_of
from app.toolpath.drawn_contours import drawn_contours
from app.toolpath.drill_holes import made_by_drills
from tests.part_shapes import circle, layered_part, square

PLATE = [square(100), circle(3.0, 20, 20), circle(3.0, 80, 20), circle(8.0, 50, 60)]
MILL = Tool(1, 6.0)
DRILL = Tool(9, 5.0, ToolKind.DRILL, tip_angle=math.radians(118))
DRILLED = DrillOperation(CutParameters(9, 10.0), least=5.0, most=6.5)
TAP = Tool(2, 6.0, ToolKind.TAP, spindle_speed=400.0)
CONE = Tool(3, 20.0, ToolKind.V, tip_angle=math.radians(90))
REAMER = Tool(4, 6.0, ToolKind.REAMER)
TEETH = Tool(5, 4.0, ToolKind.THREAD_MILL, flute_length=1.0)


def program_of(*operations: Operation, contours=PLATE, tools: tuple[Tool, ...] = ()) -> Program:
    known = {each.number: each for each in (MILL, DRILL, TAP, CONE, REAMER, TEETH)}
    known |= {each.number: each for each in tools}
    job = Job(layered_part({"a": list(contours)}), tuple(known.values()), operations, stock=Stock(thickness=10.0))
    for each in operations:
        job.cutter(each)
    return compute(job)


def counting(program: Program) -> str:
    return " ".join(each.text for each in program.findings if each.counts)


# Bores


def test_a_bore_is_a_helix_a_turn_at_the_floor_and_one_at_the_wall() -> None:
    program = program_of(BoreOperation(CutParameters(1, 4.0, 1.0), least=16.0, most=16.0))
    moves = program.moves
    round_it = np.hypot(*(moves.end[:, :2] - (50, 60)).T)
    helix = moves.purpose == Purpose.PLUNGE
    assert np.allclose(np.hypot(*(moves.centre[helix] - (50, 60)).T), 0, atol=1e-12)
    drops = np.diff(moves.end[helix, 2], prepend=1.0)
    falling = drops[drops < 0]
    assert falling.min() >= -0.25 - 1e-12  # a quarter of a turn each, a millimetre a turn at the most
    walls = moves.purpose == Purpose.CONTOUR
    assert np.allclose(round_it[walls], 5.0) and np.allclose(moves.end[walls, 2], -4.0)
    assert np.all(moves.kind[walls] == MoveKind.ARC_CCW)  # climb
    assert moves.sweeps()[walls].sum() == pytest.approx(math.tau)
    assert not counting(program)


def test_conventional_bores_go_the_other_way_and_leave_stock() -> None:
    cut = CutParameters(1, 4.0, 1.0, stock_to_leave=0.5, direction=Direction.CONVENTIONAL)
    moves = program_of(BoreOperation(cut, least=16.0, most=16.0)).moves
    walls = moves.purpose == Purpose.CONTOUR
    assert np.all(moves.kind[walls] == MoveKind.ARC_CW)
    assert np.allclose(np.hypot(*(moves.end[walls, :2] - (50, 60)).T), 4.5)


@pytest.mark.parametrize("widest", [0.01, 1.0, 2.9, 3.1, 12.0, 40.0])
@pytest.mark.parametrize("finish", [0.0, 0.2])
def test_the_ways_of_a_bore_leave_no_core_and_no_ridge(widest: float, finish: float) -> None:
    ways = ways_of(widest, 3.0, finish)
    radii = [*ways.helices, *([ways.finish] if ways.finish else [])]
    assert radii[0] <= 3.0 and radii[-1] == pytest.approx(widest)
    assert np.all(np.diff(radii) >= 0) and np.all(np.diff(radii) <= 3.0)
    assert ways.finish is None or widest - ways.helices[-1] <= finish + 1e-12


def test_a_counterbore_has_its_own_diameter_and_what_is_too_narrow_is_told() -> None:
    program = program_of(BoreOperation(CutParameters(1, 3.0, 1.0), diameter=20.0, least=16.0, most=16.0))
    walls = program.moves.purpose == Purpose.CONTOUR
    assert np.allclose(np.hypot(*(program.moves.end[walls, :2] - (50, 60)).T), 7.0)
    (region,) = program.areas[0].regions
    assert region.boundary.primitives[0].radius == 10.0 and program.areas[0].whole
    narrow = counting(program_of(BoreOperation(CutParameters(1, 3.0), least=6.0, most=6.0)))
    assert "2 circles, the first at (20.000, 20.000), are no wider than the mill and not bored" in narrow


# Countersinks


@pytest.mark.parametrize(("angle", "tip"), [(90.0, 0.0), (82.0, 0.0), (60.0, 1.0)])
def test_a_countersink_is_as_wide_at_the_top_as_the_circle(angle: float, tip: float) -> None:
    cone = replace(CONE, tip_angle=math.radians(angle), tip_diameter=tip)
    moves = program_of(CountersinkOperation(CutParameters(3), least=6.0, most=6.0), tools=(cone,)).moves
    bottoms = moves.end[moves.purpose == Purpose.DRILL]
    assert len(bottoms) == 2
    assert bottoms[:, 2] == pytest.approx(-(6.0 - tip) / 2 / math.tan(math.radians(angle / 2)))


def test_a_countersink_of_a_diameter_and_one_too_wide() -> None:
    moves = program_of(CountersinkOperation(CutParameters(3), diameter=2.0)).moves
    assert moves.end[:, 2].min() == pytest.approx(-1.0) and (moves.purpose == Purpose.DRILL).sum() == 3
    wide = counting(program_of(CountersinkOperation(CutParameters(3), diameter=21.0, least=1.0)))
    assert "not countersunk" in wide
    with pytest.raises(ParameterError, match="but the stock is 10 mm thick"):
        pointed = replace(CONE, tip_angle=math.radians(20))
        program_of(CountersinkOperation(CutParameters(3), least=16.0, most=16.0), tools=(pointed,))


# Reamers and taps


def test_a_reamer_goes_out_at_feed_and_wants_a_drilled_hole() -> None:
    narrow = replace(DRILL, diameter=5.8)
    program = program_of(DRILLED, ReamOperation(CutParameters(4, 9.0)), tools=(narrow,))
    mine = program.moves.operation == 1
    lines = mine & (program.moves.kind == MoveKind.LINE)
    assert sorted(np.round(program.moves.end[lines, 2], 6).tolist()) == [-9.0, -9.0, 1.0, 1.0]
    assert not counting(program)
    for undone in ((), (DRILLED,)):  # nothing, or a hole that leaves more than a reamer takes
        assert "drill first" in counting(program_of(*undone, ReamOperation(CutParameters(4, 9.0))))


def test_a_reamer_that_takes_off_all_of_itself_wants_a_hole_too() -> None:
    """As narrow as what a reamer takes off at the most, it was fed into solid metal without a word."""
    fine = Tool(4, 0.4, ToolKind.REAMER)
    assert "drill first" in counting(
        program_of(ReamOperation(CutParameters(4, 9.0)), contours=[square(9), circle(0.2, 4, 4)], tools=(fine,))
    )


def test_a_tap_goes_by_the_pitch_and_back_at_the_same_feed() -> None:
    program = program_of(DRILLED, TapOperation(CutParameters(2, 8.0)))
    mine = (program.moves.operation == 1) & (program.moves.kind == MoveKind.LINE)
    assert set(program.moves.feed[mine]) == {400.0}  # 1 mm a turn
    assert program.moves.end[mine, 2].tolist() == [-8.0, 1.0, -8.0, 1.0]
    assert not counting(program)
    fine = TapOperation(CutParameters(2, 8.0), thread=ThreadSize.M8X1)
    with pytest.raises(ParameterError, match="a tap for M8x1 is 8 mm"):
        program_of(DRILLED, fine)
    assert "the tap would break: drill 5 mm first" in counting(program_of(TapOperation(CutParameters(2, 8.0))))
    shallow = replace(DRILLED, cut=CutParameters(9, 7.0))
    assert "8 mm deep" in counting(program_of(shallow, TapOperation(CutParameters(2, 8.0))))


M6_HOLE: dict[str, Any] = {"least": 5.0, "most": 6.5}
WORK_IN_HOLES = [
    ReamOperation(CutParameters(4, 9.0), **M6_HOLE),
    TapOperation(CutParameters(2, 8.0), **M6_HOLE),
    ThreadOperation(CutParameters(5, 8.0), **M6_HOLE),
]


@pytest.mark.parametrize("work", WORK_IN_HOLES, ids=lambda each: each.WORD)
def test_of_a_hole_with_steps_the_one_as_deep_as_the_work_counts(work: Operation) -> None:
    drill = replace(DRILL, diameter=5.8 if isinstance(work, ReamOperation) else 5.0)
    wider = BoreOperation(CutParameters(1, 3.0), diameter=10.0, **M6_HOLE)  # a seat for the screw's head
    assert not counting(program_of(DRILLED, wider, work, tools=(drill,)))
    assert not counting(program_of(wider, DRILLED, work, tools=(drill,)))
    shallow = replace(DRILLED, cut=CutParameters(9, 7.0))
    assert "No operation before it" in counting(program_of(wider, work, tools=(drill,)))
    assert "No operation before it" in counting(program_of(wider, shallow, work, tools=(drill,)))


@pytest.mark.parametrize("work", WORK_IN_HOLES[1:], ids=lambda each: each.WORD)
def test_a_hole_too_wide_for_a_thread_is_told(work: Operation) -> None:
    d2 = ThreadSize.M6.pitch_diameter
    said = counting(program_of(DRILLED, work, tools=(replace(DRILL, diameter=round(d2 + 0.01, 3)),)))
    assert "2 holes are made too wide before they are threaded" in said and "5.360 mm, more than" in said
    assert not counting(program_of(DRILLED, work, tools=(replace(DRILL, diameter=round(d2 - 0.01, 3)),)))
    assert not counting(program_of(DRILLED, work, work))  # once more over the same thread


def test_a_bore_that_leaves_stock_is_so_much_narrower_for_what_comes_after() -> None:
    bored = BoreOperation(CutParameters(1, 9.0, stock_to_leave=0.4), diameter=7.4, least=5.5, most=6.5)
    m8 = ThreadOperation(CutParameters(5, 8.0), thread=ThreadSize.M8, least=5.5, most=6.5)
    assert ThreadSize.M8.nut_core == pytest.approx(6.647, abs=1e-3)
    assert "as wide as the core of M8" in counting(program_of(bored, m8))  # 6.6 mm
    assert not counting(program_of(replace(bored, cut=CutParameters(1, 9.0, stock_to_leave=0.35)), m8))


@pytest.mark.parametrize(
    ("tool", "operation", "words"),
    [
        (TAP, DrillOperation, "is a tap; a drill operation needs a drill or a mill"),
        (DRILL, TapOperation, "is a drill; a tap operation needs a tap"),
        (MILL, ThreadOperation, "is a flat; a thread operation needs a thread-mill"),
        (TEETH, BoreOperation, "is a thread-mill; a bore operation needs a drill or a mill"),
        (MILL, CountersinkOperation, "needs a V cutter with its angle"),
        (DRILL, BoreOperation, "which cannot cut sideways"),
    ],
)
def test_every_operation_has_its_tools(tool: Tool, operation: type[Operation], words: str) -> None:
    with pytest.raises(ParameterError, match=words):
        program_of(operation(CutParameters(tool.number, 3.0)))


def remarks(program: Program) -> str:
    return " ".join(each.text for each in program.findings if not each.counts)


@pytest.mark.parametrize("curves", [["circles:16"], ["#7"], ["circles:15-17", "#7"]])
def test_circles_that_are_named_are_meant_however_wide_they_are(curves: list[str]) -> None:
    """The circle of 16 mm, no. 7: its middle is drilled, reamed, tapped and threaded as if its diameter were named."""
    named = CutParameters(9, 10.0, curves=read_selectors(curves))
    drilled = DrillOperation(named)
    program = program_of(drilled)
    assert program.moves.end[program.moves.purpose == Purpose.DRILL, :2].tolist() == [[50.0, 60.0]]
    assert not counting(program) and "Holes come out 5 mm wide, as T9 is; drawn are 16 mm (1)." in remarks(program)
    ream = ReamOperation(replace(named, tool=8, depth=9.0))
    reamed = program_of(drilled, ream, tools=(Tool(8, 5.2, ToolKind.REAMER),))
    assert not counting(reamed) and "Holes come out 5.2 mm wide, as T8 is; drawn are 16 mm (1)." in remarks(reamed)
    for operation in (
        TapOperation(replace(named, tool=2, depth=8.0)),
        ThreadOperation(replace(named, tool=5, depth=6.0)),
    ):
        cut = program_of(drilled, operation)
        number = operation.cut.tool
        assert not counting(cut) and (cut.moves.operation == 1).any()
        assert f"T{number} cuts M6 where circles of another width are drawn: 16 mm (1)." in remarks(cut)


def test_circles_that_are_named_and_too_narrow_are_told_and_others_on_their_layer_left_alone() -> None:
    wide = replace(DRILL, diameter=8.0)
    cut = CutParameters(9, 10.0, curves=read_selectors(["circles:6", "#7"]))
    program = program_of(DrillOperation(cut), tools=(wide,))
    assert "2 circles, the first at (20.000, 20.000), are narrower than the drill" in counting(program)
    layer = program_of(DrillOperation(CutParameters(9, 10.0, curves=read_selectors(["layer:a", "#7"]))))
    assert "has nothing to drill" in counting(layer)


# Threads


def test_a_thread_is_a_helix_of_its_pitch_that_goes_up_in_climb() -> None:
    operation = ThreadOperation(CutParameters(5, 6.0), thread=ThreadSize.M6)
    program = program_of(DRILLED, operation)
    mine = (program.moves.operation == 1) & (program.moves.purpose == Purpose.CONTOUR)
    arcs, sweep = program.moves, program.moves.sweeps()
    assert np.all(arcs.kind[mine] == MoveKind.ARC_CCW)
    rise = (arcs.end - arcs.start)[mine, 2]
    assert rise / sweep[mine] * math.tau == pytest.approx(1.0)
    way = way_of(operation, TEETH)
    assert np.allclose(np.hypot(*(arcs.end[mine, :2] - arcs.centre[mine]).T), way.radius)
    assert arcs.end[arcs.operation == 1, 2].min() == pytest.approx(-6.0) and way.starts[0] + way.turns >= 0
    assert not counting(program)


def test_the_half_circles_in_and_out_stay_on_the_threads_surface() -> None:
    """Seen from the axis they turn half as fast: height and angle go together as on the helix."""
    moves = program_of(DRILLED, ThreadOperation(CutParameters(5, 6.0))).moves
    lead = np.flatnonzero((moves.operation == 1) & (moves.purpose == Purpose.LEAD))[:2]
    heights = moves.end[lead, 2] - moves.start[lead, 2]
    assert heights == pytest.approx(1 / 8) and moves.sweeps()[lead] == pytest.approx(math.pi / 2)
    radius = np.hypot(*(moves.end[lead[1], :2] - (moves.end[lead[1] - 2, :2])))
    assert np.hypot(*(moves.end[lead[0], :2] - moves.centre[lead[0]])) == pytest.approx(radius / 2)


@pytest.mark.parametrize("direction", list(Direction))
@pytest.mark.parametrize("external", [False, True])
@pytest.mark.parametrize("left", [False, True])
def test_threads_have_their_hand_whichever_way_they_are_cut(direction: Direction, external: bool, left: bool) -> None:
    boss = [square(100), circle(3.0, 50, 50)]
    cut = CutParameters(5, 5.0, direction=direction)
    moves = program_of(ThreadOperation(cut, external=external, left_hand=left), contours=boss).moves
    mine = moves.purpose == Purpose.CONTOUR
    climb = direction is Direction.CLIMB
    assert np.all((moves.kind[mine] == MoveKind.ARC_CCW) == (climb != external))
    turned = -np.sign(moves.sweeps()[mine]) if left else np.sign(moves.sweeps()[mine])
    assert np.all(np.sign((moves.end - moves.start)[mine, 2]) == turned)
    reach = np.hypot(*(moves.end[mine, :2] - (50, 50)).T) + (-2.0 if external else 2.0)
    edge = ThreadSize.M6.bolt_core / 2 if external else 3.0
    assert np.all(reach >= edge) if external else np.all(reach <= edge)
    assert np.abs(reach - edge).max() == pytest.approx(correction(ThreadSize.M6, 2.0, external))


def test_a_mill_of_many_teeth_goes_round_once() -> None:
    way = way_of(ThreadOperation(CutParameters(5, 6.0)), replace(TEETH, flute_length=10.0))
    assert way.turns == 1 and len(way.starts) == 1
    stacked = way_of(ThreadOperation(CutParameters(5, 6.0)), replace(TEETH, flute_length=2.5))
    assert stacked.turns == 1 and np.diff(stacked.starts) == pytest.approx(2.0) and len(stacked.starts) == 3
    with pytest.raises(ParameterError, match="not even half a turn of M6"):
        way_of(ThreadOperation(CutParameters(5, 0.4)), TEETH)


@pytest.mark.parametrize("thread", [ThreadSize.M3, ThreadSize.M12, ThreadSize.G1_2])
@pytest.mark.parametrize("share", [0.3, 0.7])
def test_the_flanks_error_against_the_swept_tooth(thread: ThreadSize, share: float) -> None:
    """Discs of the tooth at dense heights along the helix, cut by the plane through the axis."""
    radius = share * thread.nut_core / 2
    way = thread.major / 2 - radius - correction(thread, radius, False)
    place, slope = thread.pitch_diameter / 2, math.tan(math.radians(thread.form.value / 2))
    turn = np.linspace(-0.8, 0.8, 20001)
    axis = np.stack([way * np.cos(turn), way * np.sin(turn)], 1)
    far = np.hypot(*(np.array([place, 0.0]) - axis).T)
    crest = thread.pitch / 4 - (thread.major - thread.pitch_diameter) / 2 * slope
    top = thread.pitch * turn / math.tau + crest + (radius - far) * slope
    assert top.max() == pytest.approx(thread.pitch / 4, abs=2e-5)  # the gap is half a pitch wide at the pitch diameter
    assert flank_error(thread, radius, way, place) == pytest.approx(correction(thread, radius, False) * slope, rel=1e-3)


def test_what_holes_make_is_no_wall_for_mills_but_a_boss_is() -> None:
    def made(*operations: Operation) -> set[float]:
        job = Job(layered_part({"a": PLATE}), (MILL, DRILL, TAP, CONE, REAMER, TEETH), operations)
        return {round(hole.diameter, 6) for hole in made_by_drills(job, drawn_contours(job))}

    assert made(BoreOperation(CutParameters(1, 3.0))) == {16.0}
    assert made(TapOperation(CutParameters(2, 3.0))) == {6.0}
    assert made(ThreadOperation(CutParameters(5, 3.0))) == {6.0}
    assert not made(ThreadOperation(CutParameters(5, 3.0), external=True))
    assert not made(DRILLED)
