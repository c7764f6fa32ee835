"""Splines are the curves that LinuxCNC's interpreter drives, point for point; what it refuses, and worse, is
refused.
"""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.gcode.interpreter.program import BlockFault
from app.gcode.interpreter.reader import read_program
from app.gcode.interpreter.splines import (
    OpenFanucNurbs,
    OpenNurbs,
    check_plane,
    cubic,
    first_offset,
    quadratic,
    second_offset,
)
from app.model.motion import Nurbs, Plane
from tests.examples import examples
from tests.gcode.rs274_oracle import exact_motions
from tests.nurbs_oracle import nurbs_points

START = (1.0, 2.0, 3.0)
HEAD = "G21 G17 G90 F100 G64\nG0 X1 Y2 Z3\n"
POINTS_OF_A_CONTROL_POINT = 15

place = st.integers(-2000, 2000).map(lambda k: k / 100)
weight = st.integers(20, 400).map(lambda k: k / 100)


def assert_driven(curve: Nurbs, text: str, line: int) -> None:
    """Assert that the curve of a line is this one for our reader, and its points those of the interpreter, evenly
    spread.
    """
    program = f"{HEAD}{text}\nM2\n"
    assert_read(curve, program, line)
    theirs = np.array([motion.end for motion in exact_motions(program) if motion.line == line])
    count = POINTS_OF_A_CONTROL_POINT * len(curve.points)
    parameters = curve.knots[0] + (curve.knots[-1] - curve.knots[0]) * np.arange(1, count + 1) / count
    assert len(theirs) - count in (0, 1)  # rounding may give it one more at the end
    assert np.abs(nurbs_points(curve, parameters) - theirs[:count]).max() < 1e-8, text
    assert np.abs(curve.points[-1] - theirs[-1]).max() < 1e-8, text


def assert_read(curve: Nurbs, program: str, line: int) -> None:
    """Assert that our reader makes this curve of a line."""
    done = read_program(program.encode())
    assert done.error is None, done.error
    (read,) = (done.motions.splines[row] for row in np.flatnonzero(done.motions.line == line).tolist())
    assert read.degree == curve.degree
    for name in ("points", "weights", "knots"):
        assert getattr(read, name) == pytest.approx(getattr(curve, name), abs=1e-9)


@settings(max_examples=examples(25), deadline=None)
@given(st.lists(st.tuples(place, place, weight), min_size=2, max_size=8), weight, st.integers(0, 9), st.booleans())
def test_nurbs_of_control_points(
    points: list[tuple[float, float, float]], first: float, order: int, increments: bool
) -> None:
    order = min(order, len(points) + 1)
    block, base = OpenNurbs(START), START if increments else (0.0, 0.0)
    block.add(None, None, first)
    lines = [f"{'G91' if increments else 'G90'} G5.2 P{first}"]
    for k, (x, y, w) in enumerate(points):
        block.add(base[0] + x, base[1] + y, w, order if k == 0 else None)
        lines.append(f"X{x} Y{y} P{w} {f'L{order}' if k == 0 else ''}")
    curve = block.closed()
    assert curve.degree == max(order, 3) - 1
    assert_driven(curve, "\n".join([*lines, "G5.3"]), 3 + len(lines))


def test_the_first_block_may_hold_a_control_point_already() -> None:
    block = OpenNurbs(START)
    block.add(4.0, 6.0, 2.0, 4)
    block.add(7.0, 6.0, 0.5, 3)
    block.add(9.0, 2.0, 1.0)
    curve = block.closed()
    assert curve.weights.tolist() == [1.0, 2.0, 0.5, 1.0]
    assert_driven(curve, "G5.2 X4 Y6 P2 L4\nX7 Y6 P.5 L3\nX9 Y2 P1\nG5.3", 6)


@settings(max_examples=examples(20), deadline=None)
@given(st.tuples(*[place] * 10))
def test_cubics_go_on_smoothly(n: tuple[float, ...]) -> None:
    middle, end = (n[0], n[1], 3.0), (n[2], n[3], 3.0)
    one = cubic(START, middle, first_offset(n[4], n[5], (0.0, 0.0)), second_offset(n[6], n[7]))
    two = cubic(middle, end, first_offset(None, None, (n[6], n[7])), second_offset(n[8], n[9]))
    text = f"G5 X{n[0]} Y{n[1]} I{n[4]} J{n[5]} P{n[6]} Q{n[7]}\nG5 X{n[2]} Y{n[3]} P{n[8]} Q{n[9]}"
    assert_driven(one, text, 3)
    assert_driven(two, text, 4)


def test_a_cubic_goes_on_after_other_motions() -> None:
    one = cubic((0.0, 0.0, 3.0), (5.0, 0.0, 3.0), first_offset(None, None, (-2.0, 3.0)), (-1.0, 1.0))
    assert_driven(one, "G5 X9 Y9 I1 J1 P-2 Q3\nG1 X0 Y0\nG5 X5 Y0 P-1 Q1", 5)


@settings(max_examples=examples(10), deadline=None)
@given(place, place, place, place)
def test_quadratics(x: float, y: float, i: float, j: float) -> None:
    assert_driven(quadratic(START, (x, y, 3.0), (i, j)), f"G5.1 X{x} Y{y} I{i} J{j}", 3)


def test_lengths_in_inches_with_offsets() -> None:
    text = "G20 G17 G90 F100 G64\nG92 X0 Y0 Z0\nG0 X1 Y2 Z3\nG5 X2 Y2 I.1 J.5 P-.2 Q.25\nM2\n"
    curve = cubic((25.4, 50.8, 76.2), (50.8, 50.8, 76.2), (2.54, 12.7), (-5.08, 6.35))
    assert_read(curve, text, 4)
    theirs = np.array([motion.end for motion in exact_motions(text) if motion.line == 4])
    assert np.abs(nurbs_points(curve, np.arange(1, 61) / 60) - theirs[:60]).max() < 1e-8


@pytest.mark.parametrize(
    ("text", "letter"),
    [
        ("G5 X1 Y1 I1 P1 Q1", "J"),
        ("G5 X1 Y1 J1 P1 Q1", "I"),
        ("G5 X1 Y1 P1", "Q"),
        ("G5 X1 Y1 Q1", "P"),
        ("G5.2 X1 P1", "Y"),
        ("G5.2 Y1 P1", "X"),
        ("G5.2 X1 Y1 P1\nP2", "X"),
        ("G5.2 P1\nX1 Y1", "P"),
        ("G5.2 P1\nX1 Y1 P0", "P"),
        ("G5.2 P1\nX1 Y1 P-1", "P"),
        ("G5.2 X1 Y1 P1\nG5.3", ""),
        ("G5.2 X1 Y1 P1 L4\nX2 Y2 P1\nG5.3", ""),
    ],
)
def test_what_linuxcnc_refuses_is_refused(text: str, letter: str) -> None:
    with pytest.raises(AssertionError, match="refused"):
        exact_motions(f"{HEAD}{text}\nM2\n")
    with pytest.raises(BlockFault) as fault:
        run(text)
    assert fault.value.letter == letter


def run(text: str) -> None:
    """Do lines of G5 and G5.2 with absolute coordinates."""
    block = OpenNurbs(START)
    for line in text.splitlines():
        words = {word[0]: float(word[1:]) for word in line.split() if word[0] != "G"}
        if line.startswith("G5.3"):
            block.closed()
        elif line.startswith("G5 "):
            first_offset(words.get("I"), words.get("J"), (0.0, 0.0))
            second_offset(words.get("P"), words.get("Q"))
        else:
            block.add(words.get("X"), words.get("Y"), words.get("P"), int(words["L"]) if "L" in words else None)


def test_nonsense_that_linuxcnc_takes_is_refused_all_the_same() -> None:
    for text in ("G5.2 X1 Y1\nX2 Y2 P1\nG5.3", "G5.2 X1 Y1 P0\nX2 Y2 P1\nG5.3", "G5.2 P1e9\nX2 Y2 P1", "G5.2 P1 L21"):
        with pytest.raises(BlockFault):
            run(text)
    for plane in (Plane.ZX, Plane.YZ):
        with pytest.raises(BlockFault, match="G17"):
            check_plane(plane)
    check_plane(Plane.XY)


MANUAL = [
    (0.0, (0.0, 0.0, 0.0)),
    (0.0, (300.0, 0.0, 100.0)),
    (0.0, (700.0, 0.0, 100.0)),
    (0.0, (1300.0, 0.0, -100.0)),
    (0.5, (1700.0, 0.0, -100.0)),
    (0.5, (2000.0, 0.0, 0.0)),
    (1.0, None),
    (1.0, None),
    (1.0, None),
    (1.0, None),
]


def test_the_example_of_the_fanuc_manual() -> None:
    block = OpenFanucNurbs((0.0, 0.0, 0.0))
    for k, (knot, point) in enumerate(MANUAL):
        assert not block.complete, k
        block.add(point, knot)
    assert block.complete
    curve = block.closed()
    assert (curve.degree, len(curve.points), curve.knots.tolist()) == (3, 6, [0, 0, 0, 0, 0.5, 0.5, 1, 1, 1, 1])
    ends = nurbs_points(curve, np.array([0.0, 1.0]))
    assert ends.tolist() == [[0, 0, 0], [2000, 0, 0]]
    # 1000 = halfway from 700 to 1300
    first_piece = np.array([(0.0, 0.0), (300.0, 100.0), (700.0, 100.0), (1000.0, 0.0)])
    x, z = np.array([1, 3, 3, 1]) @ first_piece / 8
    assert nurbs_points(curve, np.array([0.25])) == pytest.approx(np.array([[x, 0.0, z]]))


def test_a_quarter_circle_of_fanuc_is_round() -> None:
    block = OpenFanucNurbs((10.0, 0.0, 5.0), 3)
    half = math.sqrt(0.5)
    for knot, point, weight in ((0.0, None, None), (0.0, (10.0, 10.0, 5.0), half), (0.0, (0.0, 10.0, 5.0), None)):
        block.add(point, knot, weight)
    assert block.place == (0.0, 10.0, 5.0)
    for _ in range(3):
        block.add(None, 2.0)
    points = nurbs_points(block.closed(), np.linspace(0, 2, 100))
    assert np.abs(np.hypot(points[:, 0], points[:, 1]) - 10.0).max() < 1e-12
    assert points[:, 2] == pytest.approx(5.0, abs=1e-12)


def refused(
    order: int | None, blocks: list[tuple[float | None, tuple[float, float, float] | None, float | None]]
) -> str:
    with pytest.raises(BlockFault) as fault:
        block = OpenFanucNurbs((0.0, 0.0, 0.0), order)
        for knot, point, weight in blocks:
            block.add(point, knot, weight)
        block.closed()
    return fault.value.text


def test_what_fanuc_refuses() -> None:
    a, b = (0.0, 0.0, 0.0), (1.0, 0.0, 0.0)
    assert "order 1" in refused(1, [])
    assert "order 21" in refused(21, [])
    assert "needs a knot" in refused(2, [(None, a, None)])
    assert "never fall" in refused(2, [(1.0, a, None), (0.5, b, None)])
    assert "weight of 0" in refused(2, [(0.0, a, 0.0)])
    assert "not where the tool is" in refused(2, [(0.0, b, None)])
    assert "control point comes after" in refused(
        2, [(0.0, a, None), (0.0, b, None), (1.0, None, None), (1.0, b, None)]
    )
    assert "has 1 control points and 3 knots" in refused(2, [(0.0, a, None), (0.0, None, None), (1.0, None, None)])
    assert "must be alike" in refused(2, [(0.0, a, None), (0.5, b, None), (1.0, None, None), (1.0, None, None)])
    assert "must be alike" in refused(2, [(0.0, a, None), (0.0, b, None), (1.0, None, None), (2.0, None, None)])
    inner = [(0.0, a, None), (0.0, b, None), (1.0, a, None), (1.0, b, None), (2.0, None, None), (2.0, None, None)]
    assert "more than 1 times" in refused(2, inner)
