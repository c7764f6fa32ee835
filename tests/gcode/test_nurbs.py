"""NURBS in a control's words: read back they are the same curve, and LinuxCNC's interpreter takes its own and drives
along it.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.gcode.interpreter.options import ReadOptions
from app.gcode.interpreter.reader import read_program
from app.gcode.posts import load_post, post_names
from app.gcode.writer.linuxcnc_biarcs import turns_all_along
from app.gcode.writer.nurbs import nurbs_blocks
from app.geometry.arcs.bezier import cut_at_knots
from app.model.motion import MotionKind, Nurbs
from app.model.part import Units
from tests.examples import examples
from tests.gcode.rs274_oracle import canonical_calls, exact_motions

UNITS = pytest.mark.parametrize("units", [Units.MM, Units.INCH], ids=["mm", "inch"])
QUARTER = Nurbs(
    np.array([[10, 0, -1], [10, 10, -1], [0, 10, -1.0]]),
    np.array([1, math.sqrt(0.5), 1]),
    np.array([0, 0, 0, 1, 1, 1.0]),
    2,
)


def curve(points: list[tuple[float, float, float]], weights: list[float], inner: list[float], degree: int) -> Nurbs:
    knots = [0.0] * (degree + 1) + sorted(inner) + [1.0] * (degree + 1)
    return Nurbs(np.array(points), np.array(weights), np.array(knots), degree)


def text_of(meant: Nurbs, name: str, units: Units) -> str:
    """A program that goes to the curve's start and along it."""
    post = load_post(name)
    blocks = nurbs_blocks(meant, post, units)
    assert blocks is not None
    start = " ".join(
        f"{axis}{round(value / units.value, 5):.5f}" for axis, value in zip("XYZ", meant.points[0], strict=True)
    )
    if name == "fanuc":
        start = " ".join(word for word in blocks[0].split() if word[0] in "XYZ")
    return "\n".join(
        [
            f"G17 G90 G94 {'G20' if units is Units.INCH else 'G21'}",
            f"G0 {start}",
            "F100.",
            *blocks,
            "G0 Z50.",
            "M30",
            "",
        ]
    )


def read_back(text: str, name: str) -> list[Nurbs]:
    program = read_program(text.encode(), ReadOptions(dialect=load_post(name).dialect))
    assert program.problems == ()
    motions = program.motions
    assert [int(kind) for kind in motions.kind] == [0] + [MotionKind.SPLINE] * len(motions.splines) + [0]
    return [motions.splines[row] for row in sorted(motions.splines)]


def driven_back(text: str) -> list[np.ndarray]:
    """What LinuxCNC's words drive at the feed: splines of one piece as control points (4, 4), lines as both ends (2,
    4).
    """
    program = read_program(text.encode(), ReadOptions(dialect=load_post("linuxcnc").dialect))
    assert program.problems == ()
    motions = program.motions
    assert motions.kind[0] == motions.kind[-1] == MotionKind.RAPID
    found = []
    for row in range(1, len(motions) - 1):
        if motions.kind[row] == MotionKind.LINE:
            found.append(np.column_stack([[motions.start[row], motions.end[row]], [1, 1]]))
        else:
            pieces = pieces_of(motions.splines[row])
            assert len(pieces) == 1
            found.append(pieces[0])
    return found


def pieces_of(each: Nurbs) -> np.ndarray:
    """(pieces, degree + 1, 4) homogeneous control points of the Bézier pieces."""
    weights = each.weights[:, None]
    return cut_at_knots(np.hstack([each.points * weights, weights]), each.knots, each.degree)


def sampled(piece: np.ndarray, count: int = 33, share: tuple[float, float] = (0, 1)) -> np.ndarray:
    """(count, 3) points of one Bézier piece at evenly spread parameters of a part of it."""
    t = np.linspace(*share, count)[:, None, None]
    b = np.repeat(piece[None], count, axis=0)
    while b.shape[1] > 1:
        b = b[:, :-1] * (1 - t) + b[:, 1:] * t
    return b[:, 0, :3] / b[:, 0, 3:]


def along(curves: list[Nurbs], count: int = 33) -> np.ndarray:
    """(pieces, count, 3) points of each Bézier piece at evenly spread parameters: those of two equal curves are
    equal.
    """
    return np.array([sampled(piece, count) for each in curves for piece in pieces_of(each)])


def left_of(
    seen: list[np.ndarray], meant: np.ndarray, near: float, share: tuple[float, float] = (0, 1)
) -> list[np.ndarray]:
    """What is left of the driven pieces behind a meant one, which they are whole, or in parts of 2 and 3 fifths, and of
    these.
    """
    goal = sampled(meant, share=share)[:, :2]
    if not np.any(np.abs(goal - goal[0]) > near) and (
        not seen or np.abs(seen[0][-1, :2] / seen[0][-1, 3] - goal[-1]).max() > near
    ):
        return seen  # the control need not be told of a place where it stands
    first, *rest = seen
    if len(first) > 2 and np.abs(sampled(first)[:, :2] - goal).max() <= near:
        return rest
    if len(first) == 2 and np.abs(first[[0, 1], :2] - goal[[0, -1]]).max() <= near:
        along_it = (goal - goal[0]) @ (way := (goal[-1] - goal[0]) / math.dist(goal[0], goal[-1]))
        assert np.abs(goal - goal[0] - along_it[:, None] * way).max() <= 4 * near
        assert np.diff(along_it).min() >= -2 * near
        return rest
    assert share[1] - share[0] > 0.06, "no driven piece is a part of the meant one"
    cut = share[0] + 0.4 * (share[1] - share[0])
    return left_of(left_of(seen, meant, near, (share[0], cut)), meant, near, (cut, share[1]))


coordinate = st.floats(-80, 80)
weight = st.floats(0.05, 20)


@st.composite
def curves(draw: st.DrawFn, flat: bool) -> Nurbs:
    degree = draw(st.integers(1, 3))
    inner = draw(
        st.one_of(
            st.lists(st.floats(0.01, 0.99), max_size=4, unique=True),
            st.integers(0, 5).map(lambda n: [k / (n + 1) for k in range(1, n + 1)]),
        )
    )
    count = degree + 1 + len(inner)
    height = st.just(draw(coordinate)) if flat else coordinate
    points = draw(st.lists(st.tuples(coordinate, coordinate, height), min_size=count, max_size=count))
    weights = draw(st.one_of(st.just([1.0] * count), st.lists(weight, min_size=count, max_size=count)))
    return curve(points, weights, inner, degree)


@UNITS
@settings(max_examples=examples(60), deadline=None)
@given(meant=curves(flat=False))
def test_fanuc_reads_the_same_curve(units: Units, meant: Nurbs) -> None:
    seen = along(read_back(text_of(meant, "fanuc", units), "fanuc"))
    step = units.value * 10.0 ** -load_post("fanuc").digits(units).X
    assert np.abs(seen - along([meant])).max() <= 0.5 * step + 3e-4


@UNITS
@settings(max_examples=examples(60), deadline=None)
@given(meant=curves(flat=True))
def test_linuxcnc_reads_the_same_curve(units: Units, meant: Nurbs) -> None:
    seen = driven_back(text_of(meant, "linuxcnc", units))
    step = units.value * 10.0 ** -load_post("linuxcnc").digits(units).X
    for piece in pieces_of(meant):
        seen = left_of(seen, piece, 0.5 * step + 1e-6)
    assert seen == []


@UNITS
@settings(max_examples=examples(10), deadline=None)
@given(meant=curves(flat=True))
def test_linuxcnc_drives_along_it(units: Units, meant: Nurbs) -> None:
    """The interpreter's points are the written pieces' own, at even parameters; it lets no piece out."""
    text = text_of(meant, "linuxcnc", units)
    written = [piece for piece in driven_back(text) if len(piece) > 2]
    assert sum(name == "NURBS_FEED" for name, _ in canonical_calls(text)) == text.count("G5.3")
    ends = [number for number, line in enumerate(text.splitlines(), start=1) if line == "G5.3"]
    driven = [motion for motion in exact_motions(text) if motion.line in ends]
    for line, piece in zip(ends, written, strict=True):
        theirs = np.array([motion.end[:2] for motion in driven if motion.line == line])
        assert np.abs(theirs[:60] - sampled(piece, 61)[1:, :2]).max() <= 1e-6


def test_a_quarter_of_a_circle_in_the_words_of_each_control() -> None:
    assert nurbs_blocks(QUARTER, load_post("linuxcnc"), Units.MM) == (
        "G5.2 P1 L4",
        "X10.0000 Y5.8579 P0.804737854",
        "X5.8579 Y10.0000 P0.804737854",
        "X0.0000 Y10.0000 P1",
        "G5.3",
    )
    assert nurbs_blocks(QUARTER, load_post("fanuc"), Units.MM) == (
        "G6.2 P3 K0. X10. Y0. Z-1. R9999.",
        "K0. X10. Y10. Z-1. R7070.361",
        "K0. X0. Y10. Z-1. R9999.",
        "K1.",
        "K1.",
        "K1.",
    )
    for name, off in (("linuxcnc", 1e-4), ("fanuc", 1e-3)):
        points = along(read_back(text_of(QUARTER, name, Units.MM), name))
        assert np.abs(np.hypot(points[..., 0], points[..., 1]) - 10).max() < off


def test_even_knots_stay_and_uneven_ones_give_way_to_those_of_pieces() -> None:
    points = [
        (0.0, 0.0, 0.0),
        (10.0, 5.0, 0.0),
        (20.0, -5.0, 1.0),
        (30.0, 5.0, 0.0),
        (40.0, 0.0, 0.0),
        (50.0, 3.0, 0.0),
    ]
    fanuc = load_post("fanuc")
    even = nurbs_blocks(curve(points, [1.0] * 6, [1 / 3, 2 / 3], 3), fanuc, Units.MM)
    assert even is not None and [block.split()[-1] for block in even[6:]] == ["K3."] * 4
    assert [block.split()[0] for block in even[1:6]] == ["K0.", "K0.", "K0.", "K1.", "K2."]
    uneven = nurbs_blocks(curve(points, [1.0] * 6, [0.31, math.pi / 5], 3), fanuc, Units.MM)
    assert uneven is not None and len(uneven) == 10 + 4
    assert [block.split()[0] for block in uneven[1:]] == ["K0."] * 3 + ["K1."] * 3 + ["K2."] * 3 + ["K3."] * 4


@pytest.mark.parametrize("name", post_names())
def test_who_carries_what(name: str) -> None:
    post = load_post(name)
    steep = replace(QUARTER, points=QUARTER.points + np.array([[0, 0, 0], [0, 0, 1], [0, 0, 2]]))
    high = curve([(float(k), float(k % 2), 0.0) for k in range(5)], [1.0] * 5, [], 4)
    carried = [nurbs_blocks(each, post, Units.MM) is not None for each in (QUARTER, steep, high)]
    assert carried == {"linuxcnc": [True, False, False], "fanuc": [True, True, False]}.get(name, [False, False, False])


S_SHAPED = curve([(0, 0, -1), (4, 3, -1), (8, -2.0526, -1), (12, 0, -1)], [1.0] * 4, [], 3)
STRAIGHT = curve([(0, 0, -1), (4, 0, -1), (8, 0, -1), (12, 0, -1)], [1.0] * 4, [], 3)


def g52(meant: Nurbs) -> str:
    rows = "\n".join(f"X{x:g} Y{y:g} P1" for x, y, _ in meant.points[1:])
    return f"G17 G90 G94 G21\nG0 X0 Y0 Z-1\nF100\nG5.2 P1 L4\n{rows}\nG5.3\nM30\n"


@pytest.mark.parametrize("meant", [S_SHAPED, STRAIGHT], ids=["s", "straight"])
def test_linuxcnc_is_never_given_a_piece_with_a_step_that_does_not_turn(meant: Nurbs) -> None:
    """Its own formula for two arcs divides by the turn; a straight piece goes out as a line, another is cut
    unevenly.
    """
    post = load_post("linuxcnc")
    assert not turns_all_along(meant), "or this test tests nothing"
    blocks = nurbs_blocks(meant, post, Units.MM)
    assert blocks is not None
    text = "\n".join(["G17 G90 G94 G21", "G0 X0 Y0 Z-1", "F100", *blocks, "M30", ""])
    motions = read_program(text.encode(), ReadOptions(dialect=post.dialect)).motions
    assert len(motions) - 1 == (1 if meant is STRAIGHT else 3)
    assert all(turns_all_along(spline) for spline in motions.splines.values())
    assert (MotionKind.LINE in motions.kind) is (meant is STRAIGHT)
    assert np.allclose(motions.end[-1], (12, 0, -1), atol=1e-9)
