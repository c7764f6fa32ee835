"""A made program played: what frames add up to, when what happens, where the tool is, what is taken along time."""

from dataclasses import replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.gcode.interpreter.options import ReadOptions
from app.gcode.interpreter.reader import read_program
from app.model.motion import MotionKind
from app.model.motion_path import anchored
from app.model.stock_box import StockBox
from app.model.tool import Tool
from app.simulation.cutter import cutter_of
from app.simulation.field.workpiece import BoxStock
from app.simulation.sweeps.course import TrimOptions
from app.simulation.sweeps.sweeps import CutField
from app.simulation.sweeps.trim import trim
from app.usecases.cutting.cut import CutOptions, CutProgram, CutSetup
from app.usecases.cutting.cut import cut as cut_setup
from app.usecases.cutting.playback import Playback, PlayFrame
from app.usecases.cutting.timeline import Timeline, TimelinePlace
from app.verify.course import course_of
from tests.usecases.test_cut import cut


@cache
def played(post: str) -> Playback:
    return Playback(cut(post))


class Screen:
    """What somebody has who takes over every frame."""

    def __init__(self, done: CutProgram) -> None:
        assert done.cut.owner is not None
        self.playback = Playback(done)
        self.field = CutField(done.cut.heights.copy(), done.cut.owner.copy())

    def show(self, moment: TimelinePlace) -> PlayFrame:
        frame = self.playback.frame(moment)
        rows, cols = (
            slice(at, at + size) for at, size in zip((frame.row, frame.col), frame.heights.shape, strict=True)
        )
        self.field.heights[rows, cols], self.field.owner[rows, cols] = frame.heights, frame.owner
        return frame


def from_start(done: CutProgram, motion: int) -> CutField:
    piece, owner, first = done.cut.before, np.full(done.cut.heights.shape, -1, np.int32), 0
    for program in done.setup.programs:
        cutters = {number: cutter_of(tool) for number, tool in done.setup.tools.items()}
        part = trim(piece, course_of(program).course, cutters, TrimOptions(trace=True, stop=motion - first))
        assert part.owner is not None
        owner, piece, first = (
            np.where(part.owner >= 0, part.owner + np.int32(first), owner),
            part.workpiece,
            first + len(program.motions),
        )
    return CutField(piece.heights, owner)


@pytest.mark.parametrize("post", ["linuxcnc", "grbl"])
def test_frames_add_up_to_what_cutting_from_the_start_leaves(post: str) -> None:
    done, screen = cut(post), Screen(cut(post))
    count = len(screen.playback.timeline)
    for motion in (count, count // 2, 3, count - 1, 0, count // 3, count):
        screen.show(TimelinePlace(motion))
        want = from_start(done, motion)
        assert np.array_equal(screen.field.heights, want.heights)
        assert np.array_equal(screen.field.owner, want.owner)
    assert np.array_equal(screen.field.heights, done.cut.heights)


def test_within_a_motion_the_metal_is_between_what_it_was_and_what_it_will_be() -> None:
    screen = Screen(cut("linuxcnc"))
    long = int(np.argmax(np.where(screen.playback.timeline.volume > 0, screen.playback.timeline.length, 0)))
    screen.show(TimelinePlace(long))
    states = [screen.field.heights.copy()]
    for share in (0.25, 0.5, 0.75):
        frame = screen.show(TimelinePlace(long, share))
        states.append(screen.field.heights.copy())
        assert frame.owner.max() == long
        assert frame.tip is not None
    screen.show(TimelinePlace(long + 1))
    states.append(screen.field.heights.copy())
    taken = [float(np.sum(states[0] - state)) for state in states]
    assert taken == sorted(taken)
    assert all(np.all(after <= before + 1e-5) for before, after in pairwise(states))
    assert 0.1 < taken[2] / taken[4] < 0.9


def test_where_nothing_changes_nothing_is_told() -> None:
    screen = Screen(cut("linuxcnc"))
    assert screen.show(screen.playback.timeline.last).heights.size == 0
    screen.show(TimelinePlace(10))
    assert screen.show(TimelinePlace(10)).heights.size == 0
    rapid = int(np.flatnonzero(cut("linuxcnc").setup.programs[0].motions.kind == MotionKind.RAPID)[-1])
    screen.show(TimelinePlace(rapid))
    assert screen.show(TimelinePlace(rapid, 0.5)).heights.size == 0


@given(share=st.floats(0, 1))
@settings(deadline=None)
def test_time_and_moments_are_each_other(share: float) -> None:
    timeline = played("grbl").timeline
    time = share * timeline.total
    moment = timeline.at(time)
    back = timeline.time(moment)
    assert back <= time + 1e-9
    waits = moment.motion >= len(timeline) or time <= timeline.begins[moment.motion] + 1e-9
    assert waits or back == pytest.approx(time, abs=1e-6)
    assert timeline.at(back + 1e-9).motion >= moment.motion


def test_the_tool_is_where_the_motions_are() -> None:
    timeline = played("linuxcnc").timeline
    motions = timeline.programs[0]
    for row in (5, 20, len(motions) - 1):
        assert timeline.place(TimelinePlace(row + 1)) == pytest.approx(motions.end[row])
        assert timeline.place(TimelinePlace(row, 1e-9)) == pytest.approx(motions.start[row], abs=1e-6)
        assert timeline.current(TimelinePlace(row + 1)) == timeline.current(TimelinePlace(row, 0.5)) == row
    assert timeline.current(TimelinePlace(0)) == 0


def test_steps_end_at_lines_and_tools() -> None:
    timeline = played("grbl").timeline
    assert timeline.line_ends[-1] == len(timeline)
    assert np.all(np.diff(timeline.line_ends) > 0)
    assert int(timeline.first[1]) in timeline.line_ends.tolist()
    for motion in timeline.tool_changes.tolist():
        assert timeline.tool[motion - 1] != timeline.tool[motion]
    assert len(timeline.tool_changes) == 1


@pytest.mark.parametrize("columns", [1, 7, 400])
def test_columns_hold_all_that_is_taken(columns: int) -> None:
    timeline = played("linuxcnc").timeline
    sampled = timeline.sampled(columns)
    assert sampled.removed[-1] == pytest.approx(cut("linuxcnc").cut.removed_volume, rel=1e-6)
    assert np.all(np.diff(sampled.removed) >= 0)
    assert np.all(sampled.mean <= sampled.most + 1e-9)
    flat = 4.0 * 2.0  # no cutter takes more than its diameter times the depth
    assert 0 < sampled.mean.max() <= flat * 3 * 1.05
    assert timeline.removed_at(timeline.last) == pytest.approx(sampled.removed[-1])


def test_a_program_without_motions_is_a_point_in_time() -> None:
    nothing = Timeline(
        (),
        np.zeros(1, np.int64),
        np.zeros(0),
        np.zeros(0),
        0.0,
        np.zeros(0, np.int32),
        np.zeros(0, np.int32),
        np.zeros(0),
        np.zeros(0),
        np.zeros(0, bool),
    )
    assert nothing.at(3.0) == nothing.last == TimelinePlace(0)
    assert nothing.place(TimelinePlace(0)) is None
    assert nothing.sampled(5).removed.tolist() == [0] * 6


def test_what_is_kept_stays_within_its_budget() -> None:
    assert 0 < played("linuxcnc").bytes <= 256 << 20


def test_where_the_tool_is_nobody_says_what_nobody_knows() -> None:
    text = "G21 G90\nT1 M6\nG0 X0 Y0 Z5\nG1 Z-1 F100\nX5 Y5\nG53 G0 Z0\nG28\nG0 X1 Y1\nZ-1\nG1 X3\nM2\n"
    timeline = Playback(cut_text(text)).timeline
    places = [timeline.place(TimelinePlace(k)) for k in range(1, len(timeline) + 1)]
    known = [place is not None for place in places]
    assert known[:3] == [True] * 3
    assert not known[3]
    assert known[-1]


def test_programs_without_motions_beside_others() -> None:
    for texts in (("M2\n", LINE), (LINE, "M2\n"), ("M2\n", "M2\n")):
        timeline = Playback(cut_text(*texts)).timeline
        assert timeline.line_ends.tolist() == sorted(set(timeline.line_ends.tolist()))
        assert timeline.line_ends.max(initial=0) == len(timeline)
        assert timeline.sampled(10).removed[-1] == pytest.approx(timeline.volume.sum())


def test_a_share_of_what_moves_leaves_the_waits_out() -> None:
    timeline = played("linuxcnc").timeline
    moving = timeline.ends - timeline.begins
    for share in (0.0, 0.3, 0.77, 0.999):
        moment = timeline.at_share(share)
        gone = moving[: moment.motion].sum() + moment.fraction * moving[min(moment.motion, len(moving) - 1)]
        assert gone == pytest.approx(share * moving.sum(), abs=1e-6)
    assert timeline.at_share(1.0) == timeline.last
    wait = int(np.argmax(timeline.begins - np.concatenate([[0.0], timeline.ends[:-1]])))
    before = timeline.ends[wait - 1] if wait else 0.0
    assert timeline.wait_at((before + timeline.begins[wait]) / 2) == pytest.approx(timeline.begins[wait] - before)
    assert timeline.wait_at((timeline.begins[wait] + timeline.ends[wait]) / 2) == 0.0


LINE = "G21 G90\nT1 M6\nG0 X0 Y0 Z5\nG1 Z-1 F100\nX5 Y5\nG0 Z5\nM2\n"


def cut_text(*texts: str) -> CutProgram:
    reads = [read_program(text.encode(), ReadOptions()) for text in texts]
    programs = tuple(replace(read, motions=anchored(read.motions)) for read in reads)
    stock = BoxStock(StockBox(-2.0, -2.0, -5.0, 8.0, 8.0))
    return cut_setup(CutSetup(programs, {1: Tool(1, 2.0), 0: Tool(1, 2.0)}, stock), CutOptions(60))
