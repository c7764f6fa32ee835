"""Lines and arcs keep within the tolerance of the polyline all along, whatever it is, and are few where it is round or
straight.
"""

import math
from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from app.fitting.fitted import FittedPath
from app.fitting.line_arcs.arc_fit import ArcOptions, fit_arcs
from app.fitting.point_curves.space_curve import curve_of_motions
from app.fitting.point_curves.tube import ToleranceTube, TubeAnswer, judge
from app.model.motion import MotionKind, Plane

Floats = NDArray[np.float64]

TOLERANCE = 0.05
STEP = 2e-3
"""Of places along a path, mm: what is `d` away from a path is at most the hypotenuse of `d` and half a step away from a
place of it.
"""


def spread(points: Floats) -> Floats:
    """Points along a polyline, a step apart at most."""
    parts = [np.linspace(a, b, max(2, math.ceil(math.dist(a, b) / STEP))) for a, b in pairwise(points)]
    return np.concatenate(parts)


def along(path: FittedPath) -> Floats:
    """Points along the motions, from nothing but their ends and centres."""
    parts = []
    for a, b, c, kind, plane in zip(
        *(getattr(path.motions, name) for name in ("start", "end", "centre", "kind", "plane")), strict=True
    ):
        if kind == MotionKind.LINE:
            parts.append(spread(np.array([a, b])))
            continue
        u, v, w = Plane(plane).axes
        sign = 1 if kind == MotionKind.ARC_CCW else -1
        first, last = (math.atan2(p[v] - c[v], p[u] - c[u]) for p in (a, b))
        sweep = (sign * (last - first)) % math.tau
        radius = math.dist((a[u], a[v]), (c[u], c[v]))
        assert math.isclose(radius, math.dist((b[u], b[v]), (c[u], c[v])), abs_tol=1e-7), (
            "both ends are as far from the centre"
        )
        assert sweep < math.radians(230)
        share = np.linspace(0, 1, max(2, math.ceil(radius * sweep / STEP)))
        arc = np.empty((len(share), 3))
        arc[:, u] = c[u] + radius * np.cos(first + sign * sweep * share)
        arc[:, v] = c[v] + radius * np.sin(first + sign * sweep * share)
        arc[:, w] = a[w] + (b[w] - a[w]) * share
        parts.append(arc)
    return np.concatenate(parts)


def fitted(points: Floats, tolerance: float = TOLERANCE, arcs: bool = True) -> FittedPath:
    """Fit, and hold against everything that must be true of any fit."""
    path = fit_arcs(points, ArcOptions(tolerance, arcs=arcs))
    assert len(path.motions) <= len(points) - 1
    assert np.all(np.diff(path.last) >= 0)
    assert path.last[-1] == len(points) - 1
    assert np.array_equal(path.motions.start[0], points[0])
    assert np.array_equal(path.motions.end[-1], points[-1])
    assert np.array_equal(path.motions.start[1:], path.motions.end[:-1])
    made, given = along(path), spread(points)
    most = math.hypot(tolerance, STEP / 2) + 1e-6
    assert cKDTree(given).query(made)[0].max() <= most
    assert cKDTree(made).query(given)[0].max() <= most
    assert judge(curve_of_motions(path.motions), points, ToleranceTube(tolerance + 1e-6)).answer is TubeAnswer.INSIDE
    return path


def circle(count: int, radius: float = 30.0) -> Floats:
    t = np.linspace(0, math.tau, count + 1)
    return np.column_stack([radius * np.cos(t), radius * np.sin(t), np.zeros(count + 1)])


def wavy(count: int, turns: float = 1.0) -> Floats:
    t = np.linspace(0, turns * math.tau, count + 1)
    r = 14 + 2 * np.sin(5 * t) + np.sin(13 * t)
    return np.column_stack([r * np.cos(t), r * np.sin(t), 2 * np.sin(t)])


def kinds(path: FittedPath) -> list[MotionKind]:
    return [MotionKind(kind) for kind in path.motions.kind]


@pytest.mark.parametrize("decimals", [9, 3, 2])
def test_a_circle_of_ten_thousand_chords_is_two_arcs(decimals: int) -> None:
    path = fitted(np.round(circle(10_000), decimals))
    assert kinds(path) == [MotionKind.ARC_CCW] * 2
    assert np.allclose(path.motions.centre, 0, atol=0.03)


def test_chords_of_ten_micrometres_and_the_other_sense() -> None:
    path = fitted(np.round(circle(6_283, 10.0)[::-1], 4), 0.005)
    assert kinds(path) == [MotionKind.ARC_CW] * 2


@pytest.mark.parametrize(("plane", "roll"), [(Plane.XY, 0), (Plane.ZX, 2), (Plane.YZ, 1)])
def test_helices_in_all_planes(plane: Plane, roll: int) -> None:
    """Ten turns rising 1 mm a radian; the axes go round."""
    t = np.linspace(0, 10 * math.tau, 5_001)
    helix = np.column_stack([10 * np.cos(t), 10 * np.sin(t), t])
    path = fitted(np.roll(helix, roll, axis=1))
    assert set(path.motions.plane.tolist()) == {plane}
    assert len(path.motions) <= 20


def test_a_turn_of_the_axes_changes_nothing() -> None:
    points = wavy(2_000)
    counts = {len(fitted(np.roll(points, k, axis=1)).motions) for k in range(3)}
    assert len(counts) == 1


def test_another_scale_changes_nothing() -> None:
    points = wavy(2_000)
    path, large = fitted(points), fit_arcs(1000 * points, ArcOptions(1000 * TOLERANCE, largest_radius=1e8))
    assert np.array_equal(path.last, large.last)
    assert np.array_equal(path.motions.kind, large.motions.kind)


def test_reversal_gives_about_as_many() -> None:
    points = wavy(2_000)
    count, other = len(fitted(points).motions), len(fitted(points[::-1].copy()).motions)
    assert abs(count - other) <= 0.1 * count


def test_chords_in_two_halves_change_nothing() -> None:
    points = wavy(1_500)
    halves = np.empty((2 * len(points) - 1, 3))
    halves[::2], halves[1::2] = points, (points[1:] + points[:-1]) / 2
    path, finer = fitted(points), fitted(halves)
    assert len(finer.motions) <= len(path.motions) + 1


def test_noise_below_the_tolerance_on_a_line_is_one_line() -> None:
    x = np.linspace(0, 100, 2_001)
    noise = np.random.default_rng(5).uniform(-0.5, 0.5, (2, len(x))) * TOLERANCE
    noise[:, (x < 10 * TOLERANCE) | (x > 100 - 10 * TOLERANCE)] = (
        0  # at its ends a path is too short to tell noise from a corner
    )
    assert kinds(fitted(np.column_stack([x, *noise]))) == [MotionKind.LINE]


def test_no_arc_over_a_long_side_with_crumbs() -> None:
    """Crumbs at both ends of a side lie on a circle that the side itself does not follow."""
    crumb = 0.2 * np.arange(6)
    left = np.column_stack([crumb, 0.2 * (crumb - crumb[-1]), 0 * crumb])
    right = np.column_stack([60 + crumb, -0.2 * crumb, 0 * crumb])
    points = np.concatenate([left, right])
    path = fitted(points)
    owner = int(np.searchsorted(path.last, 6))
    assert path.motions.kind[owner] == MotionKind.LINE


def test_a_square_stays_a_square() -> None:
    corners = np.array([[0, 0, 0], [40, 0, 0], [40, 40, 0], [0, 40, 0], [0, 0, 0.0]])
    points = np.concatenate([np.linspace(a, b, 100)[:-1] for a, b in pairwise(corners)] + [corners[-1:]])
    path = fitted(points)
    assert kinds(path) == [MotionKind.LINE] * 4
    assert np.array_equal(path.motions.end, corners[1:])


@pytest.mark.parametrize("name", ["zigzag", "reversal", "crossing", "noise", "stairs", "steep", "hairpin"])
@pytest.mark.parametrize("tolerance", [0.01, 0.1])
def test_adversaries_stay_within(name: str, tolerance: float) -> None:
    rng = np.random.default_rng(7)
    t = np.linspace(0, math.tau, 801)
    points = {
        "zigzag": np.column_stack([np.arange(200) * 0.3, (np.arange(200) % 2) * 0.4, np.zeros(200)]),
        "reversal": np.concatenate([circle(300, 5.0)[:200], circle(300, 5.0)[198:20:-1]]),
        "crossing": np.column_stack([10 * np.sin(t), 5 * np.sin(2 * t), np.sin(3 * t)]),
        "noise": np.column_stack([3 * t, np.sin(t), 0 * t]) + rng.normal(0, 0.4 * tolerance, (801, 3)),
        "stairs": np.round(np.column_stack([10 * np.cos(t), 10 * np.sin(t), 4 * np.sin(t)]), 1)[::4],
        "steep": np.column_stack([0.3 * np.cos(3 * t), 0.3 * np.sin(3 * t), 20 * t])[::20],
        "hairpin": np.array(
            [[0, 0, 0], [5, 0, 0], [5.001, 0, 0], [5.001, 0.001, 0], [0, 0.001, 0], [0, 0.002, 0], [5, 0.002, 0]]
        ),
    }[name]
    points = points[np.concatenate([[True], np.any(np.diff(points, axis=0) != 0, axis=1)])]
    either, lines = (fitted(np.ascontiguousarray(points), tolerance, arcs) for arcs in (True, False))
    assert set(kinds(lines)) == {MotionKind.LINE} and len(either.motions) <= len(lines.motions)


def test_lines_alone_when_asked() -> None:
    path = fitted(circle(10_000), arcs=False)
    assert set(kinds(path)) == {MotionKind.LINE}
    assert len(path.motions) < 80, (
        "a chord of 0.05 mm sagitta at 30 mm spans 6.6 degrees; twice that is allowed by the ends alone"
    )


def test_what_is_flatter_than_the_largest_radius_is_lines() -> None:
    points = circle(10_000, 900.0)[:200]
    assert MotionKind.LINE in kinds(fit_arcs(points, ArcOptions(0.001, largest_radius=500.0)))
    assert kinds(fit_arcs(points, ArcOptions(0.001, largest_radius=2000.0))) == [MotionKind.ARC_CCW]
