"""Two programs side by side: what is the same however it is written, and every change that matters."""

import math
import random
import time
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.gcode.interpreter.dialect import Dialect
from app.gcode.interpreter.options import ReadOptions
from app.gcode.interpreter.program import Event, EventKind, ModalState, NcProgram
from app.gcode.interpreter.reader import read_program
from app.gcode.rework.compare import DifferenceKind, compare
from app.model.motion import MotionKind, Motions, Nurbs, Plane
from tests.examples import examples
from tests.gcode.motion_programs import Course

TOLERANCE = 1e-3
CUTTING = ModalState(tool=1, speed=12000.0, spindle=1, flood=True)


def pocket() -> Course:
    """A pocket in two depths: rapids, plunges, lines and arcs, a full circle, a helix."""
    course = Course((0.0, 0.0, 50.0))
    course.rapid(5, 5, 50).rapid(5, 5, 2)
    for z in (-1.0, -2.0):
        course.line(5, 5, z).line(25, 5, z).arc((30, 10, z), (25, 10, z)).line(30, 25, z).line(5, 25, z).line(5, 5, z)
        course.arc((5, 5, z), (10, 5, z)).arc((15, 5, z - 0.5), (10, 5, z))
        course.line(5, 5, z).rapid(5, 5, 2)
    return course.rapid(0, 0, 50)


def kinds(a: NcProgram, b: NcProgram) -> list[DifferenceKind]:
    return [item.kind for item in compare(a, b, TOLERANCE).items]


def rows(program: NcProgram, **columns: object) -> NcProgram:
    """The program with some columns of its motions replaced."""
    return replace(program, motions=replace(program.motions, **columns))


def test_a_program_is_itself():
    program = pocket().program(CUTTING)
    found = compare(program, program)
    assert found.items == ()
    assert found.same_motion
    assert [(run.a, run.b, run.count) for run in found.runs] == [(0, 0, len(program.motions))]


def test_an_empty_program_lacks_everything():
    nothing, program = NcProgram(Motions.none()), pocket().program(CUTTING)
    assert kinds(nothing, nothing) == []
    assert kinds(program, nothing) == [DifferenceKind.MISSING]
    assert kinds(nothing, program) == [DifferenceKind.EXTRA]


def test_a_line_in_two_halves_is_the_same_path():
    whole, halves = (
        Course().line(10, 0).line(10, 10).line(0, 10),
        Course().line(10, 0).line(10, 4).line(10, 10).line(0, 10),
    )
    found = compare(whole.program(), halves.program(), TOLERANCE)
    (item,) = found.items
    assert (item.kind, item.a.first, item.a.stop, item.b.first, item.b.stop) == (DifferenceKind.SAME_PATH, 1, 2, 1, 3)
    assert (item.a.first_line, item.b.last_line) == (2, 3)
    assert found.same_motion
    assert item.distance < 1e-9


@pytest.mark.parametrize("plane", list(Plane))
def test_an_arc_as_chords_is_the_same_path_as_long_as_they_keep_to_it(plane):
    first, second, normal = plane.axes

    def at(angle: float) -> tuple[float, float, float]:
        place = [0.0] * 3
        place[first], place[second], place[normal] = 20 * math.cos(angle), 20 * math.sin(angle), angle
        return place[0], place[1], place[2]

    arc = Course(at(0.0)).line(*at(0.0)).arc(at(4.0), (0.0, 0.0, 0.0), True, (plane, 1))
    for count, kind in ((700, DifferenceKind.SAME_PATH), (60, DifferenceKind.PATH)):
        chords = Course(at(0.0)).line(*at(0.0))
        for step in range(count):
            chords.line(*at(4.0 * (step + 1) / count))
        (item,) = compare(arc.program(), chords.program(), TOLERANCE).items
        assert item.kind is kind
        sagitta = 20 * (1 - math.cos(2.0 / count))
        assert item.distance == pytest.approx(sagitta, rel=0.3)


def test_an_arc_the_other_way_round_is_another_path():
    there, other = (Course().line(10, 0).arc((-10, 0, 0), (0, 0, 0), ccw).program() for ccw in (True, False))
    (item,) = compare(there, other, TOLERANCE).items
    assert item.kind is DifferenceKind.PATH
    assert item.distance == pytest.approx(10 * math.sqrt(2), rel=1e-3), "from the top of the one to the other's end"
    assert item.place is not None


def test_two_turns_are_not_one():
    once, twice = (
        Course().line(10, 0).arc((10, 0, 0), (0, 0, 0), True, (Plane.XY, turns)).program() for turns in (1, 2)
    )
    (item,) = compare(once, twice, TOLERANCE).items
    assert item.kind is DifferenceKind.PATH
    assert "order or sense" in item.text


def test_going_back_over_its_own_path_is_another_path():
    straight, back = Course().line(10, 0).line(10, 10), Course().line(6, 0).line(4, 0).line(10, 0).line(10, 10)
    (item,) = compare(straight.program(), back.program(), TOLERANCE).items
    assert item.kind is DifferenceKind.PATH
    assert "order or sense" in item.text


def test_a_spline_is_the_arc_that_it_draws():
    half = math.sqrt(0.5)
    curve = Nurbs(
        np.array([[10.0, 0, 0], [10, 10, 0], [0, 10, 0]]), np.array([1, half, 1]), np.array([0.0, 0, 0, 1, 1, 1]), 2
    )
    spline, arc = (
        Course().line(10, 0).spline(curve).line(0, 0),
        Course().line(10, 0).arc((0, 10, 0), (0, 0, 0)).line(0, 0),
    )
    assert kinds(spline.program(), arc.program()) == [DifferenceKind.SAME_PATH]
    assert kinds(spline.program(), spline.program()) == []


def test_a_shifted_program_is_apart_by_the_shift():
    program = pocket().program(CUTTING)
    shift = np.array([0.3, 0.0, 0.4])
    motions = program.motions
    moved = rows(program, start=motions.start + shift, end=motions.end + shift, centre=motions.centre + shift)
    (item,) = compare(program, moved, TOLERANCE).items
    assert item.kind is DifferenceKind.PATH
    assert 0.3 <= item.distance <= 0.5 + 1e-9
    assert compare(program, moved, 0.6).items == ()


def test_what_is_left_out_and_what_is_put_in():
    whole, short = Course().line(10, 0).line(10, 10).line(0, 10), Course().line(10, 0).line(0, 10)
    (item,) = compare(whole.program(), short.program(), TOLERANCE).items
    assert item.kind is DifferenceKind.PATH
    assert item.distance == pytest.approx(math.sqrt(50))
    tail = Course().line(10, 0).line(10, 10)
    (item,) = compare(whole.program(), tail.program(), TOLERANCE).items
    assert (item.kind, item.a.first, item.a.stop, item.b.first, item.b.last_line) == (
        DifferenceKind.MISSING,
        2,
        3,
        2,
        2,
    )
    assert kinds(tail.program(), whole.program()) == [DifferenceKind.EXTRA]


def test_motions_without_length_are_no_difference():
    twice, once = Course().line(10, 0).line(10, 0).line(5, 5), Course().line(10, 0).line(5, 5)
    assert kinds(twice.program(), once.program()) == [DifferenceKind.SAME_PATH]


def test_a_rapid_instead_of_a_feed_is_told():
    fed, rapid = Course().line(10, 0).line(10, 10).line(0, 10), Course().line(10, 0).rapid(10, 10).line(0, 10)
    (item,) = compare(fed.program(), rapid.program(), TOLERANCE).items
    assert (item.kind, item.a.first_line) == (DifferenceKind.RAPID, 2)


@pytest.mark.parametrize(
    ("state", "kind", "told"),
    [
        (replace(CUTTING, tool=2), DifferenceKind.TOOL, "T1 in the first, T2 in the second"),
        (replace(CUTTING, speed=11999.0), DifferenceKind.SPINDLE, "S 12000 M3 in the first, S 11999 M3 in the second"),
        (replace(CUTTING, spindle=-1), DifferenceKind.SPINDLE, "M3 in the first, S 12000 M4 in the second"),
        (replace(CUTTING, spindle=0), DifferenceKind.SPINDLE, "spindle off in the second"),
        (replace(CUTTING, flood=False), DifferenceKind.COOLANT, "flood in the first, no coolant in the second"),
        (replace(CUTTING, work_offset="G55"), DifferenceKind.WORK_OFFSET, "G54 in the first, G55 in the second"),
        (
            replace(CUTTING, length_offset=2),
            DifferenceKind.LENGTH_OFFSET,
            "no length (G49) in the first, G43 H2 in the second",
        ),
        (
            replace(CUTTING, path="G61", path_tolerance=0.0),
            DifferenceKind.PATH_MODE,
            "G64 in the first, G61 in the second",
        ),
    ],
)
def test_what_is_in_force_is_compared(state, kind, told):
    program = pocket().program(CUTTING, state)
    state_of_row = program.motions.state.copy()
    state_of_row[5:9] = 1
    (item,) = compare(program, rows(program, state=state_of_row)).items
    assert item.kind is kind
    assert (item.a.first, item.a.stop) == (5, 9)
    assert told in item.text


@pytest.mark.parametrize(
    ("dialect", "word", "other", "kind", "told"),
    [
        (Dialect.LINUXCNC, "G54", "G55", DifferenceKind.WORK_OFFSET, "G54 in the first, G55 in the second"),
        (Dialect.HAAS, "G54", "G54.1 P12", DifferenceKind.WORK_OFFSET, "G54 in the first, G54.1 P12 in the second"),
        (Dialect.HAAS, "G43 H2", "G43 H1", DifferenceKind.LENGTH_OFFSET, "G43 H2 in the first, G43 H1 in the second"),
        (
            Dialect.LINUXCNC,
            "G43",
            "",
            DifferenceKind.LENGTH_OFFSET,
            "G43 H2 in the first, no length (G49) in the second",
        ),
        (
            Dialect.LINUXCNC,
            "G64 P0.01",
            "G64",
            DifferenceKind.PATH_MODE,
            "G64 P 0.01 mm in the first, G64 in the second",
        ),
        (
            Dialect.LINUXCNC,
            "G64 P0.01",
            "G64 P0.1",
            DifferenceKind.PATH_MODE,
            "P 0.01 mm in the first, G64 P 0.1 mm in the second",
        ),
        (Dialect.LINUXCNC, "G64 P0.01", "G61", DifferenceKind.PATH_MODE, "P 0.01 mm in the first, G61 in the second"),
    ],
)
def test_every_word_that_changes_what_the_machine_does_is_a_difference(dialect, word, other, kind, told):
    first, second = (
        read_program(f"G21\nT2 M6\n{each}\nG0 Z5.\nG0 X1. Y2.\nG1 Z-1. F50.\nX5.\nM30\n".encode(), ReadOptions(dialect))
        for each in (word, other)
    )
    found = compare(first, second)
    (item,) = found.items
    assert (item.kind, item.a.first_line, item.a.last_line) == (kind, 4, 7)
    assert told in item.text
    assert not found.same_motion
    assert compare(first, first).items == ()


def test_one_path_tolerance_in_mm_and_in_inch_is_no_difference():
    mm, inch = (
        read_program(text, ReadOptions())
        for text in (b"G21 G64 P0.01\nG1 X25.4 F254\nM2\n", b"G20 G64 P0.0004\nG1 X1 F10\nM2\n")
    )
    assert compare(mm, inch).items == ()


def test_feeds_are_compared_also_where_blocks_differ():
    a, b = Course().line(10, 0).line(10, 10).line(0, 10), Course().line(10, 0).line(10, 4)
    b.feed = 300.0
    b.line(10, 10)
    b.feed = 600.0
    b.line(0, 10)
    found = compare(a.program(), b.program(), TOLERANCE)
    assert [item.kind for item in found.items] == [DifferenceKind.SAME_PATH, DifferenceKind.FEED]
    assert found.items[1].text == "F 600.0 mm/min in the first, F 300.0 mm/min in the second"
    assert not found.same_motion


def test_dwells_and_stops_are_compared():
    dwell, stop = Event(EventKind.DWELL, 4, 5, 2.5), Event(EventKind.STOP, 21, 30)
    a, b = pocket().program(CUTTING, events=(dwell, stop)), pocket().program(CUTTING)
    found = compare(a, b)
    assert [(item.kind, item.a.first, item.text) for item in found.items] == [
        (DifferenceKind.PAUSE, 4, "dwell 2.5 s in the first, none in the second"),
        (DifferenceKind.PAUSE, 21, "stop in the first, none in the second"),
    ]
    assert len(compare(b, a).items) == 2
    assert compare(a, a).items == ()


def zigzag(count: int) -> Motions:
    """A program of short lines over a wavy ground, each of its points another one."""
    step = np.arange(count + 1)
    points = np.column_stack([step * 0.05 % 100, step // 2000 * 0.5, np.sin(step / 37) * np.cos(step / 911)]).round(4)
    small, line = np.zeros(count, np.uint8), np.arange(1, count + 1, dtype=np.int32)
    nowhere = np.full((count, 3), np.nan)
    feeds = np.full(count, 800.0)
    return Motions(
        points[:-1], points[1:], nowhere, small + np.uint8(MotionKind.LINE), small, line * 0, feeds, line, line * 0
    )


@settings(deadline=None, max_examples=examples(12))
@given(st.integers(0, 2**32), st.integers(1, 12))
def test_every_changed_point_is_found_and_nothing_else(seed, changes):
    motions, rng = zigzag(4000), random.Random(seed)
    chosen = sorted(rng.sample(range(10, 3990, 7), changes))
    end, start = motions.end.copy(), motions.start.copy()
    for row in chosen:
        end[row, 2] += rng.choice([-1, 1]) * rng.uniform(0.002, 3)
        start[row + 1] = end[row]
    a, b = NcProgram(motions), NcProgram(replace(motions, start=start, end=end))
    found = compare(a, b, TOLERANCE)
    assert not found.same_motion
    touched = {row for item in found.items for row in range(item.a.first, item.a.stop)}
    assert touched <= {row for each in chosen for row in (each, each + 1)}
    paths = [item for item in found.items if item.kind is DifferenceKind.PATH]
    assert {row for row in chosen if any(item.a.first <= row < item.a.stop for item in paths)} == set(chosen)
    assert all(item.distance > TOLERANCE / 4 for item in paths)


@settings(deadline=None, max_examples=examples(12))
@given(st.integers(0, 2**32))
def test_points_rounded_anew_and_lines_split_are_no_difference(seed):
    rng, motions = np.random.default_rng(seed), zigzag(3000)
    points = np.vstack([motions.start[:1], motions.end])
    split = np.sort(rng.choice(3000, 40, replace=False))
    share = rng.uniform(0.1, 0.9, (40, 1))
    extra = points[split] + share * (points[split + 1] - points[split])
    more = np.insert(points, split + 1, extra, axis=0) + rng.uniform(-2e-4, 2e-4, (3041, 3))
    course = Course(tuple(more[0]))
    for point in more[1:].tolist():
        course.line(*point)
    found = compare(
        NcProgram(motions),
        replace(course.program(), motions=replace(course.motions(), feed=np.full(3040, 800.0))),
        TOLERANCE,
    )
    assert found.same_motion, found.items[:3]
    assert sum(run.count for run in found.runs) >= 3000 - 5 * 40


@pytest.mark.exhaustive
def test_200_000_motions_are_compared_in_seconds():
    motions = zigzag(200_000)
    end, start = motions.end.copy(), motions.start.copy()
    chosen = np.arange(500, 199_000, 977)
    end[chosen, 2] += 0.01
    start[chosen + 1] = end[chosen]
    keep = np.delete(np.arange(200_000), np.arange(100_000, 100_200))
    changed = replace(
        motions,
        **{
            name: getattr(replace(motions, start=start, end=end), name)[keep]
            for name in ("start", "end", "centre", "kind", "plane", "turns", "feed", "line", "state")
        },
    )
    begin = time.process_time()
    found = compare(NcProgram(motions), NcProgram(changed), TOLERANCE)
    assert time.process_time() - begin < 10
    assert len([item for item in found.items if item.kind is DifferenceKind.PATH]) >= len(chosen) - 1
    assert sum(run.count for run in found.runs) >= 200_000 - 200 - 2 * len(chosen) - 4


def test_a_short_motion_at_another_feed_is_told_in_a_path_of_other_blocks():
    """Only what lies between one end and the same end is passed over, not a motion of its own."""
    a, b = (
        read_program(b"G21 G90\nF100\n" + text + b"M2\n")
        for text in (b"G1 X10\nX10.01 F900\nX20 F100\n", b"G1 X5\nX10\nX10.01\nX20\n")
    )
    told = [item for item in compare(a, b, TOLERANCE).items if item.kind is DifferenceKind.FEED]
    assert [item.a.first_line for item in told] == [4]
