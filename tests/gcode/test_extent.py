"""The box of motions against samples of them, and what a machine cannot do."""

from __future__ import annotations

import math

import numpy as np
import pytest

from app.gcode.interpreter.program import ModalState, NcProgram
from app.gcode.interpreter.reader import read_program
from app.gcode.timing.extent import extent, misfits
from app.model.motion import Motions, Nurbs, Plane
from app.model.motion_path import arc_paths, lengths, reach, spline_points
from tests.gcode.motion_programs import Course, machine


def random_arc(seed: int) -> Course:
    """An arc in any plane, of any sense, sweep and turns, with any rise."""
    chance = np.random.default_rng(seed)
    plane = Plane(int(chance.integers(3)))
    a, b, normal = plane.axes
    radius, first, last = chance.uniform(1, 50), *chance.uniform(-7, 7, 2)
    centre, start, end = np.zeros((3, 3))
    centre[[a, b]] = chance.uniform(-20, 20, 2)
    start[:], end[:] = centre, centre
    start[[a, b]] += radius * np.array([math.cos(first), math.sin(first)])
    end[[a, b]] += radius * np.array([math.cos(last), math.sin(last)])
    end[normal] = chance.choice([0.0, 5.0, -20.0])
    course = Course(at=tuple(start.tolist()))
    return course.arc(
        tuple(end.tolist()), tuple(centre.tolist()), bool(chance.integers(2)), (plane, int(chance.integers(1, 4)))
    )


@pytest.mark.parametrize("seed", range(60))
def test_arcs_reach_as_far_as_their_points_and_are_as_long_as_their_chords(seed: int) -> None:
    motions = random_arc(seed).motions()
    points = arc_paths(motions).points(np.linspace(0, 1, 40_001))[0]
    assert points[0] == pytest.approx(motions.start[0])
    assert points[-1] == pytest.approx(motions.end[0])
    low, high = reach(motions)
    assert low[0] == pytest.approx(points.min(axis=0), abs=1e-5)
    assert high[0] == pytest.approx(points.max(axis=0), abs=1e-5)
    assert lengths(motions)[0] == pytest.approx(np.sum(np.linalg.norm(np.diff(points, axis=0), axis=1)), rel=1e-6)


def test_a_full_circle_reaches_all_round() -> None:
    box = extent(Course(at=(10, 0, 0)).arc((10, 0, -2), (0, 0, 0), ccw=False).program())
    assert box.low == pytest.approx((-10, -10, -2))
    assert box.high == pytest.approx((10, 10, 0))
    assert box.size == pytest.approx((20, 20, 2))


def test_a_spline_stays_in_the_box_of_its_control_points_and_weights_pull() -> None:
    quarter = Nurbs(
        np.array([[5, 0, 0], [5, 5, 0], [0, 5, 0.0]]),
        np.array([1, math.sqrt(0.5), 1]),
        np.array([0, 0, 0, 1, 1, 1.0]),
        2,
    )
    points = spline_points(quarter)
    assert np.hypot(points[:, 0], points[:, 1]) == pytest.approx(np.full(len(points), 5))
    motions = Course(at=(5, 0, 0)).spline(quarter).motions()
    assert extent(NcProgram(motions)).high == (5, 5, 0)
    assert lengths(motions)[0] == pytest.approx(2.5 * math.pi, rel=1e-4)


def test_an_axis_counts_from_where_the_program_sets_it() -> None:
    course = Course(at=(900.0, 900.0, 900.0)).rapid(900, 900, 5).rapid(10, 20, 5).line(30, 20, -1)
    made = course.motions()
    known = Motions(**{name: getattr(made, name) for name in made.__dataclass_fields__} | {"known_from": (1, 1, 0)})
    assert (extent(NcProgram(known)).low, extent(NcProgram(known)).high) == ((10, 20, -1), (30, 20, 5))
    never = Motions(**{name: getattr(made, name) for name in made.__dataclass_fields__} | {"known_from": (3, 3, 0)})
    assert np.isnan(extent(NcProgram(never)).low[0])
    assert extent(NcProgram(never)).high[2] == 5


def test_the_box_of_chosen_motions_and_of_none() -> None:
    program = Course().rapid(100, 0, 5).line(20, 0, 0).program()
    assert extent(program, program.motions.kind != 0).high == (100, 0, 5)
    assert np.isnan(extent(program, program.motions.kind > 7).low).all()


def test_the_machines_home_is_no_place_of_the_part() -> None:
    text = b"G21 G90 G54\nG0 Z5\nX10 Y10\nG1 Z-1 F100\nX20\nG91 G28 Z0\nG90\nG0 X90 Y3\nZ7\nX30\nG53 G0 Z0\nX-500\nM2\n"
    read = read_program(text)
    assert read.problems == ()
    box = extent(read)
    assert (box.low, box.high) == ((-500, 3, -1), (90, 10, 7))
    for goes in (b"G91 G28 X0 Y0", b"G53 G0 X0 Y0"):
        read = read_program(text.replace(b"M2", goes + b"\nM2"))
        assert (extent(read).low, extent(read).high) == (box.low, box.high)


def told(program: NcProgram, **changes: object) -> list[tuple[int, str]]:
    return [(problem.line, problem.text) for problem in misfits(program, machine(**changes))]  # type: ignore[arg-type]


def test_a_program_that_fits_has_no_problem() -> None:
    program = Course().rapid(400, 0).line(-400, 0).program(ModalState(spindle=1, speed=5000))
    assert told(program, work_origin=(0.0, 0.0, 0.0)) == []


def test_travel_is_held_against_each_end_from_the_work_origin() -> None:
    program = Course().rapid(400, 0).line(401, 0).line(0, 0, -501).program()
    found = told(program, work_origin=(100.0, 0.0, 0.0))
    assert [line for line, _ in found] == [2, 3]
    assert (
        "goes to X401.000, 1.000 mm beyond the travel of Test mill, which ends at 400 from the work origin"
        in found[0][1]
    )
    assert "Z-501.000, 1.000 mm beyond" in found[1][1]


def test_without_a_work_origin_only_the_size_counts() -> None:
    program = Course(at=(2000, 0, 0)).rapid(2400, 0).line(2000, 0).program()
    assert told(program) == []
    (found,) = told(Course().rapid(600, 0).line(-600, 0).program())
    assert "spans 1200.000 mm along X (-600.000 to 600.000), and Test mill travels 1000 mm there" in found[1]


def test_arcs_that_bulge_over_the_end_are_seen() -> None:
    program = Course(at=(490, 0, 0)).arc((490, 40, 0), (490, 20, 0)).program()
    ((line, text),) = told(program, work_origin=(0.0, 0.0, 0.0))
    assert line == 1
    assert "X510.000, 10.000 mm beyond" in text


def test_feeds_and_speeds_out_of_range() -> None:
    course = Course(feed=5000).line(1, 0).line(2, 0)
    course.state, course.feed = 1, 100
    course.line(3, 0)
    found = told(course.program(ModalState(spindle=1, speed=24000), ModalState(speed=50)), largest_feed=4000.0)
    assert [text.split(",")[0] for _, text in found] == [
        "feed is up to 5000 mm/min in 2 motions",
        "the spindle is to turn at 24000 rpm",
    ]


def test_a_way_home_that_a_block_names_and_fails_to_go_is_none() -> None:
    """The second G53 has a feed mode's word missing: its block fails after it has said where to."""
    program = read_program(b"G0 X1\nG53 G1 X3 Y3\n")
    assert program.error is not None and program.homeward == () and extent(program).high[0] == 1
