"""The time estimate against closed forms, and what no estimate may break."""

from __future__ import annotations

import math
import time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.gcode.interpreter.program import Event, EventKind, ModalState, NcProgram
from app.gcode.timing.duration import duration
from app.model.motion import Motions, Nurbs, Plane
from app.model.motion_path import lengths
from tests.examples import examples
from tests.gcode.motion_programs import Course, machine


def seconds(course: Course, *states: ModalState, **changes: object) -> float:
    return duration(course.program(*states), machine(**changes)).total  # type: ignore[arg-type]


def test_a_long_move_is_its_length_over_its_speed_and_one_ramp() -> None:
    assert seconds(Course(feed=600).line(100, 0)) == pytest.approx(100 / 10 + 10 / 100)
    assert seconds(Course(feed=600).line(30, 40)) == pytest.approx(50 / 10 + 10 / (100 / 0.8))


def test_a_short_move_is_a_triangle() -> None:
    assert seconds(Course(feed=6000).line(1, 0)) == pytest.approx(2 * math.sqrt(1 / 100))


def test_rapids_go_at_the_axes_own_rates() -> None:
    assert seconds(Course().rapid(300, 0)) == pytest.approx(300 / 100 + 1)
    assert seconds(Course().rapid(300, 300)) == pytest.approx(300 / 100 + 1)


def test_a_reversal_stops() -> None:
    there = seconds(Course(feed=600).line(50, 0))
    assert seconds(Course(feed=600).line(50, 0).line(0, 0)) == pytest.approx(2 * there)


def test_a_right_corner_stops_where_the_path_is_exact_and_not_where_it_blends() -> None:
    corner = Course(feed=600).line(50, 0).line(50, 50)
    stopped = 2 * seconds(Course(feed=600).line(50, 0))
    assert seconds(corner, ModalState(path="G61")) == pytest.approx(stopped)
    assert seconds(corner, ModalState(path="G64", path_tolerance=0.5)) < stopped - 0.03
    s = math.sqrt(0.5)
    v = math.sqrt(100 * math.sqrt(2) * 0.1 * s / (1 - s))  # both axes help to turn
    assert v < 10
    leg = 50 / 10 + (10**2 + (10 - v) ** 2) / (2 * 10 * 100)
    assert seconds(corner, ModalState(path="G64", path_tolerance=0.1)) == pytest.approx(2 * leg)


@pytest.mark.parametrize("plane", list(Plane))
@pytest.mark.parametrize("ccw", [True, False])
def test_a_full_circle_is_bounded_by_its_centripetal_acceleration(plane: Plane, ccw: bool) -> None:
    centre = [0.0, 0.0, 0.0]
    centre[plane.axes[0]] = 4.0
    course = Course(feed=60000).arc((0, 0, 0), tuple(centre), ccw, (plane, 1))  # type: ignore[arg-type]
    v = math.sqrt(100 * 4)
    assert seconds(course) == pytest.approx(8 * math.pi / v + v / 100)


def test_turns_and_helices_count_whole() -> None:
    twice = Course(feed=60).arc((0, 0, 0), (5, 0, 0), arc=(Plane.XY, 2))
    assert seconds(twice) == pytest.approx(20 * math.pi / 1 + 1 / 100, rel=1e-3)
    helix = Course(feed=60).arc((0, 0, 3), (5, 0, 0))
    assert seconds(helix) == pytest.approx(math.hypot(10 * math.pi, 3) / 1 + 1 / 100, rel=1e-3)


@settings(max_examples=examples(60), deadline=None)
@given(st.lists(st.floats(0.01, 30), min_size=1, max_size=30), st.floats(10, 20000), st.sampled_from(["G61", "G64"]))
def test_a_chain_of_collinear_pieces_is_one_move(pieces: list[float], feed: float, path: str) -> None:
    chain, whole = Course(feed=feed), Course(feed=feed)
    for end in np.cumsum(pieces):
        chain.line(end * 0.6, end * 0.8)
    whole.line(sum(pieces) * 0.6, sum(pieces) * 0.8)
    assert seconds(chain, ModalState(path=path)) == pytest.approx(seconds(whole, ModalState(path=path)), rel=1e-6)


def test_an_exact_stop_stops_even_on_a_straight_line() -> None:
    chain = Course(feed=600).line(20, 0).line(40, 0)
    assert seconds(chain, ModalState(path="G61.1")) == pytest.approx(2 * seconds(Course(feed=600).line(20, 0)))


def test_a_circle_split_in_arcs_is_one_circle() -> None:
    whole = Course(feed=3000).arc((0, 0, 0), (20, 0, 0))
    halves = Course(feed=3000).arc((40, 0, 0), (20, 0, 0)).arc((0, 0, 0), (20, 0, 0))
    assert seconds(halves) == pytest.approx(seconds(whole), rel=1e-6)


@pytest.mark.parametrize("plane", list(Plane))
def test_a_line_that_touches_an_arc_runs_into_it_in_every_plane(plane: Plane) -> None:
    def at(first: float, second: float) -> tuple[float, float, float]:
        place = [0.0, 0.0, 0.0]
        place[plane.axes[0]], place[plane.axes[1]] = first, second
        return place[0], place[1], place[2]

    touching = Course(feed=600).line(*at(20, 0)).arc(at(20, 40), at(20, 20), arc=(plane, 1))
    assert seconds(touching, ModalState(path="G61")) == pytest.approx((20 + 20 * math.pi) / 10 + 10 / 100)


def around(plane: Plane, radius: float, angles: list[float], feed: float) -> Course:
    """Chords from angle to angle round the origin of a plane."""
    first, second, _ = plane.axes

    def at(angle: float) -> tuple[float, float, float]:
        place = [0.0, 0.0, 0.0]
        place[first], place[second] = radius * math.cos(angle), radius * math.sin(angle)
        return place[0], place[1], place[2]

    course = Course(at(angles[0]), feed=feed)
    for angle in angles[1:]:
        course.line(*at(angle))
    return course


@pytest.mark.parametrize("plane", list(Plane))
@pytest.mark.parametrize(("count", "slower"), [(48, 1.03), (90, 1.02), (360, 1.005), (5000, 1.001)])
@pytest.mark.parametrize("begin", [0.0, 0.4, math.pi / 4])
def test_a_circle_of_chords_takes_the_time_of_the_arc_and_not_less(
    plane: Plane, count: int, slower: float, begin: float
) -> None:
    for radius, feed in ((10.0, 6000.0), (2.0, 3000.0), (10.0, 600.0)):
        chords = around(plane, radius, [begin + 2 * math.pi * k / count for k in range(count + 1)], feed)
        first: tuple[float, float, float] = chords.rows[0][0]  # type: ignore[assignment]
        arc = seconds(Course(first, feed=feed).arc(first, (0, 0, 0), arc=(plane, 1)))
        shorter = math.sin(math.pi / count) * count / math.pi
        took = seconds(chords, ModalState(path="G64", path_tolerance=0.5))
        assert arc * shorter * 0.9999 <= took <= arc * slower
        if feed == 6000:
            assert took >= arc * 0.9999, (
                "where the curve bounds the speed, chords are not faster though they are shorter"
            )


@pytest.mark.parametrize("seed", range(6))
def test_chords_of_unlike_lengths_are_not_faster_than_the_arc_either(seed: int) -> None:
    chance = np.random.default_rng(seed)
    parts = np.cumsum(np.concatenate([[0.0], chance.uniform(0.3, 1.7, 400)]))
    chords = around(Plane.XY, 10.0, (chance.uniform(0, 6) + 2 * math.pi * parts / parts[-1]).tolist(), 6000.0)
    arc = seconds(Course((10, 0, 0), feed=6000).arc((10, 0, 0), (0, 0, 0)))
    assert arc * 0.9995 <= seconds(chords, ModalState(path="G64", path_tolerance=0.5)) <= arc * 1.03


@settings(max_examples=examples(40), deadline=None)
@given(
    st.lists(st.tuples(st.floats(-0.9, 0.9), st.floats(0.02, 8), st.integers(1, 6)), min_size=2, max_size=25),
    st.floats(100, 9000),
)
def test_a_bent_path_takes_as_long_however_its_straight_pieces_are_split(
    legs: list[tuple[float, float, int]], feed: float
) -> None:
    whole, split, angle = Course(feed=feed), Course(feed=feed), 0.3
    for turn, size, parts in legs:
        angle += turn
        x, y, _ = whole.at
        for part in range(1, parts + 1):
            split.line(x + size * part / parts * math.cos(angle), y + size * part / parts * math.sin(angle))
        whole.line(x + size * math.cos(angle), y + size * math.sin(angle))
    state = ModalState(path="G64", path_tolerance=0.05)
    assert seconds(split, state) == pytest.approx(seconds(whole, state), rel=1e-6)


def test_a_long_leg_to_a_corner_is_no_curve() -> None:
    """A corner with long legs is bounded by its tolerance alone; as a curve it would be no slower than the legs are."""
    corner = Course(feed=600).line(50, 0).line(50, 50)
    wide, wider = (seconds(corner, ModalState(path="G64", path_tolerance=p)) for p in (0.5, 1e6))
    assert wider == pytest.approx(100 / 10 + 10 / 100)
    assert wide == pytest.approx(wider)


def walk(seed: int, count: int = 60) -> Course:
    """A random path of lines, arcs, rapids."""
    chance = np.random.default_rng(seed)
    course = Course(feed=float(chance.uniform(60, 5000)))
    for _ in range(count):
        x, y, z = (float(v) for v in np.array(course.at) + chance.normal(0, 10.0 ** chance.uniform(-3, 1.5), 3))
        kind = chance.integers(4)
        if kind == 0:
            course.rapid(x, y, z)
        elif kind == 1:
            middle = ((x + course.at[0]) / 2, (y + course.at[1]) / 2, course.at[2])
            course.arc((x, y, z), middle, bool(chance.integers(2)))
        else:
            course.line(x, y, z)
    return course


@pytest.mark.parametrize("seed", range(20))
def test_it_is_never_faster_than_without_limits_and_shrinks_as_acceleration_grows(seed: int) -> None:
    program = walk(seed).program()
    totals = [duration(program, machine(a, corner=0.02)).total for a in (10.0, 50.0, 300.0, 3000.0, 1e7)]
    assert totals == sorted(totals, reverse=True)
    assert totals[0] > totals[-1]
    motions = program.motions
    chebyshev = np.max(np.abs(motions.end - motions.start), axis=1) / 100
    least = np.where(motions.kind == 0, chebyshev, 60 * lengths(motions) / np.where(motions.feed > 0, motions.feed, 1))
    each = duration(program, machine(1e7, corner=0.02)).moving
    assert np.all(each >= least * (1 - 1e-9))


def test_blending_wider_is_never_slower() -> None:
    for seed in range(10):
        course = walk(seed)
        totals = [seconds(course, ModalState(path="G64", path_tolerance=p)) for p in (0.0, 0.001, 0.05, 1.0)]
        assert totals == sorted(totals, reverse=True)


def test_dwells_and_tool_changes_are_waited_for_and_stop_the_path() -> None:
    chain, whole = Course(feed=600).line(20, 0).line(40, 0), Course(feed=600).line(40, 0)
    events = (Event(EventKind.TOOL_CHANGE, 0, 1, 3), Event(EventKind.DWELL, 1, 2, 2.5), Event(EventKind.END, 2, 3))
    states = (ModalState(tool=3),)
    told = duration(chain.program(*states, events=events), machine(tool_change=30.0))
    assert told.total == pytest.approx(30 + 2.5 + 2 * seconds(Course(feed=600).line(20, 0)))
    assert told.waiting.tolist() == [30.0, 2.5, 0.0]
    assert told.by_tool == pytest.approx({3: told.total})
    assert told.parts["wait"] == 32.5
    assert told.ends[-1] == pytest.approx(told.total)
    assert told.total > seconds(whole) + 32.5


def test_time_is_told_by_tool_and_by_rapid() -> None:
    course = Course().rapid(100, 0).line(200, 0)
    course.state = 1
    course.rapid(200, 100).line(200, 150)
    states = (ModalState(tool=1), ModalState(tool=2))
    events = (
        Event(EventKind.TOOL_CHANGE, 0, 1, 1),
        Event(EventKind.TOOL_CHANGE, 2, 3, 2),
        Event(EventKind.TOOL_CHANGE, 3, 4, 2),
    )
    told = duration(course.program(*states, events=events), machine(tool_change=10.0))
    assert told.waiting.tolist() == [10, 0, 10, 0, 0]
    assert sum(told.by_tool.values()) == pytest.approx(told.total) == pytest.approx(sum(told.parts.values()))
    assert told.by_tool[2] == pytest.approx(10 + told.moving[2] + told.moving[3])


def test_motions_without_a_feed_are_counted_and_finite() -> None:
    told = duration(Course(feed=math.nan).line(10, 0).line(20, 0).program(), machine())
    assert told.feedless == 2
    assert math.isfinite(told.total)


def test_motions_of_no_length_change_nothing() -> None:
    plain = Course(feed=600).line(20, 0).line(40, 0)
    still = Course(feed=600).line(20, 0).line(20, 0).line(40, 0)
    assert seconds(still) == pytest.approx(seconds(plain))
    assert duration(NcProgram(Motions.none()), machine()).total == 0.0


def test_a_spline_that_is_a_line_takes_as_long_as_the_line_and_a_bend_longer() -> None:
    def curve(*points: tuple[float, float, float]) -> Nurbs:
        return Nurbs(np.array(points, float), np.ones(4), np.array([0, 0, 0, 0, 1, 1, 1, 1.0]), 3)

    straight = seconds(Course(feed=600).spline(curve((0, 0, 0), (20, 0, 0), (40, 0, 0), (60, 0, 0))))
    assert straight == pytest.approx(seconds(Course(feed=600).line(60, 0)), rel=1e-6)
    sharp = Course(feed=6000).spline(curve((0, 0, 0), (60, 0, 0), (0, 1, 0), (60, 1, 0)))
    assert seconds(sharp) > 2 * seconds(Course(feed=6000).line(60, 1))


def test_two_hundred_thousand_motions_take_well_under_a_tenth_of_a_second() -> None:
    turns = np.linspace(0, 2000 * math.pi, 200_001)
    points = np.column_stack([50 * np.cos(turns), 50 * np.sin(turns), turns * 0.01])
    small, whole = np.ones(200_000, np.uint8), np.zeros(200_000, np.int32)
    nothing = np.full((200_000, 3), math.nan)
    motions = Motions(
        points[:-1], points[1:], nothing, small, small * 0, whole, np.full(200_000, 3000.0), whole + 1, whole
    )
    program = NcProgram(motions)
    duration(program, machine())
    took = []
    for _ in range(5):
        before = time.process_time()
        duration(program, machine(corner=0.01))
        took.append(time.process_time() - before)
    assert min(took) < 0.3
