"""Ellipses and splines to lines and arcs: measured both ways by other means than the code's own."""

import math
from itertools import pairwise

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.interpolate import BSpline

from app.core.errors import GeometryError
from app.geometry.arcs.arcs import LinesAndArcs, lines_and_arcs
from app.model.curves import Arc, Circle, Ellipse, Line, Point, Primitive, Spline, reversed_curve
from tests.examples import examples

UM = 1e-3
CUBIC = (0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 4.0, 4.0, 4.0, 4.0)
WAVE = Spline(3, ((0, 0), (10, 30), (30, -20), (40, 10), (60, 60), (20, 70), (0, 40)), CUBIC)


def on_curve(curve: Ellipse | Spline, count: int) -> NDArray[np.float64]:
    if isinstance(curve, Ellipse):
        points = np.array([curve.at(t) for t in np.linspace(curve.start_parameter, curve.end_parameter, count)])
        return points if curve.ccw else points[::-1]
    weights = np.array(curve.weights or [1.0] * len(curve.control_points))
    homogeneous = np.column_stack([np.array(curve.control_points) * weights[:, None], weights])
    knots = np.array(curve.knots)
    values = BSpline(knots, homogeneous, curve.degree)(
        np.linspace(knots[curve.degree], knots[-curve.degree - 1], count)
    )
    return values[:, :2] / values[:, 2:]


def on_primitive(p: Primitive, count: int) -> NDArray[np.float64]:
    share = np.linspace(0, 1, count)
    if isinstance(p, Line):
        return np.array(p.start) + np.outer(share, np.subtract(p.end, p.start))
    sweep = (math.tau if p.ccw else -math.tau) if isinstance(p, Circle) else p.sweep
    first = 0.0 if isinstance(p, Circle) else p.start_angle
    return np.array(p.centre) + p.radius * np.column_stack(
        [np.cos(first + share * sweep), np.sin(first + share * sweep)]
    )


def off_primitives(points: NDArray[np.float64], primitives: tuple[Primitive, ...]) -> float:
    """Greatest distance of points from the nearest of some primitives."""
    best = np.full(len(points), np.inf)
    for p in primitives:
        ends = np.minimum(np.hypot(*(points - p.start).T), np.hypot(*(points - p.end).T))
        if isinstance(p, Line):
            way = np.subtract(p.end, p.start)
            share = ((points - p.start) @ way) / (way @ way)
            distance = np.where(
                (share >= 0) & (share <= 1), np.abs((points - p.start) @ (-way[1], way[0])) / np.hypot(*way), ends
            )
        else:
            arm = points - p.centre
            ahead = np.arctan2(arm[:, 1], arm[:, 0]) - (0.0 if isinstance(p, Circle) else p.start_angle)
            within = np.mod(ahead if p.ccw else -ahead, math.tau) <= (
                math.tau if isinstance(p, Circle) else abs(p.sweep)
            )
            distance = np.where(within, np.abs(np.hypot(*arm.T) - p.radius), ends)
        best = np.minimum(best, distance)
    return float(best.max())


def off_track(points: NDArray[np.float64], track: NDArray[np.float64]) -> float:
    """Greatest distance of points from a dense polyline."""
    segments = shapely.STRtree(shapely.linestrings(np.stack([track[:-1], track[1:]], axis=1)))
    return float(segments.query_nearest(shapely.points(points), return_distance=True, all_matches=False)[1].max())


def check(curve: Ellipse | Spline, made: LinesAndArcs, tolerance: float = UM) -> None:
    track = on_curve(curve, 20_001)
    path = np.concatenate([on_primitive(p, max(20, 4_000 // len(made.primitives))) for p in made.primitives])
    slack = 1e-8 + made.deviation * 1e-3
    assert made.deviation <= tolerance
    assert off_primitives(track, made.primitives) <= made.deviation + slack
    assert off_track(path, track) <= made.deviation + slack + float(np.abs(np.diff(track, 2, axis=0)).max()) / 4
    for a, b in pairwise(made.primitives):
        assert a.end == b.start


def heading(p: Primitive, at_end: bool) -> float:
    if isinstance(p, Line):
        return math.atan2(p.end[1] - p.start[1], p.end[0] - p.start[0])
    x, y = p.end if at_end else p.start
    return math.atan2(y - p.centre[1], x - p.centre[0]) + (math.pi / 2 if p.ccw else -math.pi / 2)


def corners(made: LinesAndArcs) -> list[Point]:
    return [
        b.start
        for a, b in pairwise(made.primitives)
        if abs(math.remainder(heading(a, True) - heading(b, False), math.tau)) > 1e-4
    ]


@pytest.mark.parametrize("ratio", [0.9999, 0.9, 0.5, 0.1, 0.01, 1e-4])
def test_ellipse_keeps_its_distance_and_is_smooth(ratio: float) -> None:
    curve = Ellipse((3.0, -2.0), (40.0, 25.0), ratio)
    made = lines_and_arcs(curve)
    check(curve, made)
    assert ratio < 0.01 or not corners(made)
    assert made.primitives[-1].end == made.primitives[0].start


@pytest.mark.parametrize("ccw", [True, False])
def test_part_of_an_ellipse_keeps_its_ends_and_direction(ccw: bool) -> None:
    curve = Ellipse((0.0, 0.0), (10.0, 3.0), 0.4, 0.3, 4.0, ccw)
    made = lines_and_arcs(curve)
    check(curve, made)
    assert (made.primitives[0].start, made.primitives[-1].end) == (curve.start, curve.end)
    assert all(isinstance(p, Arc) and p.ccw == ccw for p in made.primitives)


def test_few_arcs_do() -> None:
    """An ellipse of 100 x 50 mm within 1 um; halving by quarters would take 128."""
    assert len(lines_and_arcs(Ellipse((0, 0), (50, 0), 0.5)).primitives) <= 90


@pytest.mark.parametrize("tolerance", [0.1, 0.01, 1e-3, 1e-4])
def test_finer_tolerance_is_kept_with_more_arcs(tolerance: float) -> None:
    made = lines_and_arcs(WAVE, tolerance)
    check(WAVE, made, tolerance)
    assert len(made.primitives) == pytest.approx(9.8 * tolerance ** (-1 / 3), rel=0.5)


def test_round_ellipse_is_a_circle() -> None:
    made = lines_and_arcs(Ellipse((1, 2), (30, 40), 1.0))
    (circle,) = made.primitives
    assert isinstance(circle, Circle) and circle.centre == (1, 2) and circle.radius == pytest.approx(50, abs=1e-12)
    (arc,) = lines_and_arcs(Ellipse((1, 2), (30, 40), 1.0, 0.2, 2.0, ccw=False)).primitives
    assert isinstance(arc, Arc) and not arc.ccw and arc.sweep == pytest.approx(-1.8)


def test_rational_spline_circle_is_a_circle() -> None:
    h = math.sqrt(0.5)
    points = ((1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0))
    curve = Spline(
        2,
        tuple((5 + 7 * x, 7 * y) for x, y in points),
        (0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4),
        (1, h, 1, h, 1, h, 1, h, 1),
    )
    (circle,) = lines_and_arcs(curve).primitives
    assert isinstance(circle, Circle) and circle.ccw
    assert circle.centre == pytest.approx((5, 0), abs=1e-9) and circle.radius == pytest.approx(7, abs=1e-9)


def test_straight_spline_is_one_line() -> None:
    made = lines_and_arcs(Spline(3, ((0, 0), (10, 5), (30, 15), (40, 20), (60, 30), (70, 35), (80, 40)), CUBIC))
    assert made.primitives == (Line((0, 0), (80, 40)),)


def test_corners_stay_where_they_are() -> None:
    curve = Spline(2, ((0, 0), (10, 0), (10, 10), (20, 10), (30, 40)), (0, 0, 0, 1, 1, 2, 2, 2))
    made = lines_and_arcs(curve)
    check(curve, made)
    assert corners(made) == [pytest.approx((10, 10), abs=1e-12)]


def test_polygon_given_as_a_spline_becomes_its_lines() -> None:
    corner_points = ((0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 4.0))
    made = lines_and_arcs(Spline(1, corner_points, (0, 0, 1, 2, 3, 3)))
    assert made.primitives == tuple(Line(a, b) for a, b in pairwise(corner_points))
    assert made.deviation < 1e-12


@pytest.mark.parametrize(
    "middle", [((30, 30), (-10, 30)), ((20, 20), (0, 20)), ((50, 40), (-30, 40))], ids=["bend", "cusp", "loop"]
)
def test_bends_cusps_and_loops(middle: tuple[Point, Point]) -> None:
    curve = Spline(3, ((0, 0), *middle, (20, 0)), (0, 0, 0, 0, 1, 1, 1, 1))
    check(curve, lines_and_arcs(curve))


def test_spline_that_turns_back_on_itself() -> None:
    curve = Spline(3, ((0, 0), (10, 0), (30, 0), (90, 0), (60, 0), (70, 0), (80, 0)), CUBIC)
    made = lines_and_arcs(curve)
    assert all(isinstance(p, Line) for p in made.primitives)
    assert off_primitives(on_curve(curve, 20_001), made.primitives) <= made.deviation <= UM


def test_doubled_control_points_at_the_ends() -> None:
    curve = Spline(3, ((0, 0), (0, 0), (0, 0), (10, 5), (20, 0), (20, 0)), (0, 0, 0, 0, 1, 2, 3, 3, 3, 3))
    check(curve, lines_and_arcs(curve))


def test_spline_that_stands_still_on_the_way() -> None:
    still = (0.0, 0.0)
    curve = Spline(
        3, ((0, 5), (1, 0), still, still, still, still, (3, 3), (0, 1)), (0, 0, 0, 0, 1, 2, 3, 4, 5, 5, 5, 5)
    )
    check(curve, lines_and_arcs(curve))


def test_curve_without_length_becomes_nothing() -> None:
    assert lines_and_arcs(Spline(1, ((1, 1), (1, 1)), (0, 0, 1, 1))).primitives == ()
    assert lines_and_arcs(Ellipse((0, 0), (1e-9, 0), 0.5)).primitives == ()


def test_values_that_are_no_numbers_are_named() -> None:
    with pytest.raises(GeometryError, match="not a number"):
        lines_and_arcs(Ellipse((0, math.nan), (1, 0), 0.5))
    with pytest.raises(GeometryError, match="not a number"):
        lines_and_arcs(Spline(1, ((0, 0), (math.inf, 0)), (0, 0, 1, 1)))


def test_far_from_the_origin() -> None:
    curve = Ellipse((1e5, -2e5), (40.0, 25.0), 0.3)
    check(curve, lines_and_arcs(curve))


coordinate = st.floats(-100, 100).map(lambda v: round(v, 3))


@st.composite
def splines(draw: st.DrawFn) -> Spline:
    degree = draw(st.integers(2, 5))
    points = draw(st.lists(st.tuples(coordinate, coordinate), min_size=degree + 1, max_size=degree + 6))
    steps = draw(st.lists(st.floats(0.2, 3), min_size=len(points) - degree, max_size=len(points) - degree))
    inner = [sum(steps[:k]) for k in range(len(steps) + 1)]
    weights = draw(st.one_of(st.just([]), st.lists(st.floats(0.3, 3), min_size=len(points), max_size=len(points))))
    return Spline(degree, tuple(points), (*[inner[0]] * degree, *inner, *[inner[-1]] * degree), tuple(weights))


@settings(max_examples=examples(25), deadline=None)
@given(splines())
def test_any_spline_keeps_the_stated_distance_both_ways(curve: Spline) -> None:
    made = lines_and_arcs(curve, 0.01)
    if made.primitives:
        check(curve, made, 0.01)


@settings(max_examples=examples(20), deadline=None)
@given(splines())
def test_travelled_backwards_it_keeps_its_ends(curve: Spline) -> None:
    back = reversed_curve(curve)
    assert isinstance(back, Spline)
    made = lines_and_arcs(back, 0.05)
    if made.primitives and not isinstance(made.primitives[0], Circle):
        assert made.primitives[0].start == curve.end
