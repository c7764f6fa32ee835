"""Lines and arcs meet without a bend where the points do not bend; what was made of lines and arcs is found again."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from app.fitting.fitted import FittedPath
from app.fitting.line_arcs.arc_fit import ArcOptions, _greedy, fit_arcs
from app.fitting.line_arcs.flat_fit import _last_digit
from app.fitting.line_arcs.tangent import PlanarPolyline
from app.fitting.point_curves.corners import corners
from app.fitting.point_curves.space_curve import curve_of_motions
from app.fitting.point_curves.tube import ToleranceTube, TubeAnswer, judge
from app.model.motion import MotionKind, Plane
from tests.examples import examples

Floats = NDArray[np.float64]
TOLERANCE = 0.02


def directions(path: FittedPath) -> tuple[Floats, Floats]:
    """The unit directions in which each motion sets out and arrives, from its ends and its centre."""
    motions = path.motions
    out, into = np.empty((len(motions), 3)), np.empty((len(motions), 3))
    for k in range(len(motions)):
        a, b = motions.start[k], motions.end[k]
        if motions.kind[k] == MotionKind.LINE:
            out[k] = into[k] = (b - a) / np.linalg.norm(b - a)
            continue
        u, v, w = Plane(motions.plane[k]).axes
        sign = 1 if motions.kind[k] == MotionKind.ARC_CCW else -1
        for place, found in ((a, out), (b, into)):
            radius = place - motions.centre[k]
            found[k, u], found[k, v], found[k, w] = -sign * radius[v], sign * radius[u], 0.0
            found[k] /= np.linalg.norm(found[k])
    return out, into


def bends(path: FittedPath) -> Floats:
    """Degrees by which the path turns where one motion meets the next."""
    out, into = directions(path)
    angles: Floats = np.degrees(np.arccos(np.clip(np.einsum("ij,ij->i", into[:-1], out[1:]), -1, 1)))
    return angles


def chorded(pieces: list[Floats], step: float, decimals: int) -> Floats:
    """Points along polylines that follow one another, a step apart, rounded."""
    dense = np.concatenate([pieces[0], *(piece[1:] for piece in pieces[1:])])
    along = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(dense, axis=0), axis=1))])
    at = np.linspace(0, along[-1], math.ceil(along[-1] / step) + 1)
    points = np.round(np.column_stack([np.interp(at, along, dense[:, k]) for k in range(3)]), decimals)
    return np.ascontiguousarray(points[np.concatenate([[True], np.any(np.diff(points, axis=0) != 0, axis=1)])])


def arc(centre: tuple[float, float], radius: float, first: float, last: float) -> Floats:
    t = np.radians(np.linspace(first, last, 2_000))
    return np.column_stack([centre[0] + radius * np.cos(t), centre[1] + radius * np.sin(t), 0 * t])


def side(a: tuple[float, float], b: tuple[float, float]) -> Floats:
    return np.linspace([*a, 0.0], [*b, 0.0], 2)


def rounded(width: float, height: float, radius: float) -> list[Floats]:
    """A rectangle with round corners from the middle of its lower side on."""
    w, h, r = width, height, radius
    return [
        side((w / 2, 0), (w - r, 0)),
        arc((w - r, r), r, -90, 0),
        side((w, r), (w, h - r)),
        arc((w - r, h - r), r, 0, 90),
        side((w - r, h), (r, h)),
        arc((r, h - r), r, 90, 180),
        side((0, h - r), (0, r)),
        arc((r, r), r, 180, 270),
        side((r, 0), (w / 2, 0)),
    ]


@pytest.mark.parametrize("roll", [0, 1, 2])
@pytest.mark.parametrize(("step", "decimals"), [(0.05, 4), (0.2, 3), (0.01, 5)])
def test_a_rounded_rectangle_is_its_sides_and_corners_again(roll: int, step: float, decimals: int) -> None:
    points = np.roll(chorded(rounded(40, 25, 6), step, decimals), roll, axis=1)
    path = fit_arcs(np.ascontiguousarray(points), ArcOptions(TOLERANCE))
    assert [MotionKind(kind) for kind in path.motions.kind] == [MotionKind.LINE, MotionKind.ARC_CCW] * 4 + [
        MotionKind.LINE
    ]
    assert bends(path).max() < 0.1
    radius = np.linalg.norm((path.motions.start - path.motions.centre)[1::2], axis=1)
    assert np.allclose(radius, 6, atol=0.12), (
        "within the tolerance an arc of 90 degrees may differ by two to three times as much"
    )


def test_an_s_of_arcs_is_few_arcs() -> None:
    low = (5.0, -15 - 10 * math.sin(math.pi / 3))
    way = (low[0] - 8, low[1] - 8 * math.tan(math.pi / 6))
    points = chorded([arc((0, 0), 5, 180, 270), arc((0, -15), 10, 90, -60), side(low, way)], 0.02, 4)
    path = fit_arcs(points, ArcOptions(TOLERANCE))
    assert len(path.motions) <= 4
    assert bends(path).max() < 0.1


def waves(count: int, turns: tuple[int, int], depth: float) -> Floats:
    t = np.linspace(0.3, 0.3 + math.tau, count)
    r = 30 + depth * np.sin(turns[0] * t) + 0.5 * depth * np.cos(turns[1] * t)
    return np.column_stack([r * np.cos(t), r * np.sin(t), 0 * t])


@settings(max_examples=examples(20), deadline=None)
@given(
    st.integers(500, 6_000),
    st.integers(2, 9),
    st.integers(3, 23),
    st.floats(0.1, 4.0),
    st.sampled_from([0.005, 0.02, 0.1]),
)
def test_free_forms_are_smoother_than_their_points_and_within(
    count: int, one: int, other: int, depth: float, tolerance: float
) -> None:
    points = np.round(waves(count, (one, other), depth), 4)
    path = fit_arcs(points, ArcOptions(tolerance))
    assert judge(curve_of_motions(path.motions), points, ToleranceTube(tolerance)).answer is TubeAnswer.INSIDE
    assert len(path.motions) < len(points)
    at = corners(points, math.radians(30), 4 * tolerance)
    meant = np.array([np.abs(points[at] - end).max(axis=1).min() == 0 for end in path.motions.end[:-1]], bool)
    steps = np.diff(points, axis=0)
    steps /= np.linalg.norm(steps, axis=1)[:, None]
    given = np.degrees(np.arccos(np.clip(np.einsum("ij,ij->i", steps[1:], steps[:-1]), -1, 1)))
    kept = np.delete(given, at[1:-1] - 1)
    found = bends(path)[~meant]
    assert not len(found) or found.max() <= max(0.5, kept.max()) + 1e-3


def test_moved_joints_cost_next_to_nothing() -> None:
    """As many pieces, give or take a few, as lines and arcs from point to point, whose joints bend."""
    points = np.round(waves(20_000, (5, 13), 2.0), 6)
    plain, path = _greedy(points, ArcOptions(TOLERANCE)), fit_arcs(points, ArcOptions(TOLERANCE))
    assert bends(plain.path(points)).max() > 1.5
    assert bends(path).max() <= 0.5
    assert len(path.motions) <= 1.15 * len(plain)


@pytest.mark.parametrize("tolerance", [0.01, 0.05])
def test_bends_that_only_rounding_makes_are_not_there_any_more(tolerance: float) -> None:
    """Chords of 4 um in steps of 0.1 um turn by up to 3 degrees, where the wave that they are cut from turns by
    none.
    """
    t = np.linspace(0, math.tau, 100_001)
    r = 60 + 4 * np.sin(9 * t) + 0.8 * np.sin(31 * t)
    points = np.round(np.column_stack([r * np.cos(t), r * np.sin(t), 0 * t]), 4)
    path = fit_arcs(points, ArcOptions(tolerance))
    assert bends(path).max() < 0.5
    assert len(path.motions) <= {0.01: 165, 0.05: 95}[tolerance]


def test_chords_that_were_thinned_become_arcs_that_meet() -> None:
    """Eight chords of a circle and its tangents, far apart: no piece is evidence of an arc, their bends are."""
    t = np.radians(np.arange(0, 91, 7.5))
    bow = np.column_stack([20 * np.sin(t), 20 - 20 * np.cos(t), 0 * t])
    points = np.concatenate([[[-3.0, 0, 0]], bow, [[20, 23, 0]]])
    path = fit_arcs(points, ArcOptions(0.05))
    assert len(path.motions) <= len(points) - 1
    assert bends(path).max() < 0.6 < 7.5


@pytest.mark.parametrize("count", [24, 48])
def test_a_barrel_lets_arcs_stand_for_long_chords(count: int) -> None:
    """The points are on the circle to the last digit, the chords' middles 0.02 and 0.09 mm off it: cylinders hold no
    arc.
    """
    t = np.linspace(0, math.tau, count + 1)
    points = np.column_stack([10 * np.cos(t), 10 * np.sin(t), 0 * t])
    assert not np.any(fit_arcs(points, ArcOptions(0.01)).motions.kind >= MotionKind.ARC_CW)
    path = fit_arcs(points, ArcOptions(0.01, middle=0.1))
    assert len(path.motions) == 2
    assert judge(curve_of_motions(path.motions), points, ToleranceTube(0.01, 0.1)).answer is TubeAnswer.INSIDE
    assert len(fit_arcs(points, ArcOptions(0.01, middle=0.02)).motions) > 2


def test_long_sides_stay_straight_beside_crumbs() -> None:
    """A side of 60 mm between small chamfers is no arc, though one would keep within the tolerance."""
    points = np.array([[0, 0, 0], [60, 0, 0], [60.3, 0.1, 0], [60.5, 0.3, 0], [60.6, 0.6, 0], [60.6, 40, 0.0]])
    path = fit_arcs(points, ArcOptions(0.05))
    long = np.linalg.norm(path.motions.end - path.motions.start, axis=1) > 30
    assert set(path.motions.kind[long].tolist()) == {MotionKind.LINE}
    assert np.array_equal(path.motions.end[long][0][1:], [0, 0]) or abs(path.motions.end[long][0][1]) <= 0.05


def test_corners_are_kept_exactly_at_both_ends_of_a_small_step() -> None:
    """A step of 0.1 mm between two rows turns by 90 degrees at both of its ends."""
    rows = np.array([[0, 0, 0], [5, 0, 0], [5, 0.1, 0], [0, 0.1, 0], [0, 0.2, 0], [5, 0.2, 0.0]])
    path = fit_arcs(rows, ArcOptions(0.05))
    assert np.array_equal(path.motions.end, rows[1:])


@pytest.mark.parametrize("scale", [0.01, 1.0, 100.0])
def test_another_scale_gives_the_same_pieces(scale: float) -> None:
    points = waves(4_000, (5, 13), 2.0)
    path, other = (fit_arcs(k * points, ArcOptions(k * TOLERANCE, largest_radius=k * 1e5)) for k in (1.0, scale))
    assert abs(len(path.motions) - len(other.motions)) <= 1
    assert all(bends(each).max() <= 0.5 for each in (path, other))


def test_pieces_follow_one_another_without_a_gap() -> None:
    path = fit_arcs(np.round(waves(5_000, (5, 13), 2.0), 4), ArcOptions(TOLERANCE))
    assert all(
        np.array_equal(a, b) for (_, a), (b, _) in pairwise(zip(path.motions.start, path.motions.end, strict=True))
    )


@pytest.mark.parametrize(("unit", "digits"), [(1.0, 0), (1.0, 3), (1.0, 4), (25.4, 4), (25.4, 5)])
def test_the_last_digit_of_points_is_seen_in_mm_and_in_inches(unit: float, digits: int) -> None:
    rounded_to = np.round(np.random.default_rng(1).uniform(-90, 90, (50, 3)) / unit, digits) * unit
    assert _last_digit(rounded_to) == pytest.approx(unit * 10.0**-digits)
    assert _last_digit(rounded_to + np.pi * np.arange(50)[:, None]) == 0.0


def test_what_rounding_can_make_is_no_bend_and_bends_that_are_meant_are() -> None:
    """Steps of 1 um turn chords of 10 um by no more than 0.28 radians; facets of 2 degrees, 1 mm long, keep all but
    0.16 degrees.
    """
    rng, step = np.random.default_rng(7), 1e-3
    straight = np.round(
        np.column_stack([np.arange(500) * 0.01, rng.uniform(-0.0005, 0.0005, 500) + 0.37371 * np.arange(500) * 0.01]), 3
    )
    assert PlanarPolyline(straight, 0.04).turns.max() > math.radians(1)
    assert PlanarPolyline(straight, 0.04, step).turns.max() == 0.0
    t = np.radians(np.arange(0, 90, 2.0))
    facets = np.round(np.column_stack([np.cos(t), np.sin(t)]) * 0.5 / math.sin(math.radians(1)), 4)
    turns = np.degrees(PlanarPolyline(facets, 0.04, 1e-4).turns[1:-1])
    assert turns.min() > 2 - 0.04 and turns.max() < 2 + 0.04
