"""The fewest lines and arcs: closed forms, all choices on small inputs, bends within what is allowed, samples within
the tolerance.
"""

import math
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from app.fitting.line_arcs import fewest
from app.fitting.line_arcs.arc_fit import ArcOptions, fit_arcs
from app.fitting.line_arcs.fewest import FewestPieces
from app.fitting.line_arcs.tangent import PlanarPolyline
from app.fitting.point_curves.corners import corners
from tests.examples import examples
from tests.fitting.test_arc_fit import STEP, along, circle, spread
from tests.fitting.test_tangent import bends

Floats = NDArray[np.float64]
TOLERANCE = 0.05


def wave(count: int, decimals: int = 4) -> Floats:
    t = np.linspace(0, math.tau, count + 1)
    r = 40 + 6 * np.sin(5 * t) + 1.5 * np.sin(23 * t)
    return np.round(np.column_stack([r * np.cos(t), r * np.sin(t), 0 * t]), decimals)


def searched(points: Floats, limit: float, bend: float) -> int:
    line = PlanarPolyline(points[:, :2], 4 * limit)
    chain = FewestPieces(line, limit, np.full(len(points), bend), 1e5).chain(np.array([0, len(points) - 1]))
    assert chain is not None
    return len(chain)


@pytest.mark.parametrize("bend", [0.5, 180.0])
def test_a_line_is_one_and_a_circle_is_two(bend: float) -> None:
    """No arc turns by more than 230 degrees: two for a whole turn are the fewest."""
    line = np.column_stack([np.linspace(0, 50, 300), np.linspace(0, 20, 300), np.zeros(300)])
    assert len(fit_arcs(line, ArcOptions(TOLERANCE, bend=math.radians(bend))).motions) == 1
    assert len(fit_arcs(circle(600), ArcOptions(TOLERANCE, bend=math.radians(bend))).motions) == 2


def test_a_wave_of_known_inflections_takes_one_arc_between_them() -> None:
    """Half circles to the left and to the right in turn, tangent where they meet: none can be joined with the next."""
    t = np.radians(np.arange(0, 181, 2.0))
    parts = [np.column_stack([20 * k - 10 * np.cos(t), (-1) ** k * 10 * np.sin(t), 0 * t])[k > 0 :] for k in range(6)]
    path = fit_arcs(np.concatenate(parts), ArcOptions(0.02))
    assert len(path.motions) == 6
    assert np.allclose(np.abs(path.motions.centre[:, 0] - 20 * np.arange(6)), 0, atol=0.1)


def by_all_choices(points: Floats, limit: float) -> int:
    """The fewest pieces from point to point, whatever they bend by: all heights of all arcs tried, in 800 steps."""
    heights = np.tan(np.linspace(-1.0, 1.0, 801))

    @cache
    def holds(i: int, j: int) -> bool:
        a, b = complex(*points[i, :2]), complex(*points[j, :2])
        inner = points[i : j + 1, 0] + 1j * points[i : j + 1, 1]
        inner = np.concatenate([p + (q - p) * np.linspace(0, 1, 17) for p, q in pairwise(inner)])
        w = (inner - (a + b) / 2) / ((b - a) / 2)
        tried = (
            heights
            if j - i >= 3 and np.abs(np.diff(points[i : j + 1, :2], axis=0)).max() <= abs(b - a) / 2
            else heights[400:401]
        )
        for t in tried:
            if abs(t) < 1e-9:
                off = np.abs(w.imag) if np.all(np.diff(w.real) > 0) else np.full(1, np.inf)
            else:
                centre, radius = 0.5j * (t - 1 / t), abs(t + 1 / t) / 2
                off = np.abs(np.abs(w - centre) - radius)
            if off.max() * abs(b - a) / 2 <= limit:
                return True
        return False

    best = [0] + [10**6] * (len(points) - 1)
    for j in range(1, len(points)):
        best[j] = min(best[i] + 1 for i in range(j) if holds(i, j))
    return best[-1]


@settings(max_examples=examples(8), deadline=None)
@given(st.integers(0, 10**6))
def test_small_inputs_take_no_more_than_all_choices_from_point_to_point(seed: int) -> None:
    """Places beside the points only add choices, so the search never finds more than the oracle, which has none."""
    rng = np.random.default_rng(seed)
    turn = np.cumsum(rng.uniform(-0.5, 0.5, 10))
    steps = np.column_stack([np.cos(turn), np.sin(turn), 0 * turn])
    points = np.concatenate([np.zeros((1, 3)), np.cumsum(steps, axis=0)])
    limit = float(rng.uniform(0.02, 0.2))
    assert searched(points, limit, math.pi) <= by_all_choices(points, 0.999 * limit)


@pytest.mark.exhaustive
def test_without_places_beside_the_points_it_finds_what_all_choices_find(monkeypatch: pytest.MonkeyPatch) -> None:
    """It holds arcs to few samples of each chord, so that it may find what is off by a little more: the proof is for
    that.
    """
    monkeypatch.setattr(fewest, "_ASIDE", np.zeros(1))
    found = []
    for seed in range(6):
        turn = np.cumsum(np.random.default_rng(seed).uniform(-0.5, 0.5, 10))
        points = np.concatenate(
            [np.zeros((1, 3)), np.cumsum(np.column_stack([np.cos(turn), np.sin(turn), 0 * turn]), axis=0)]
        )
        found.append((by_all_choices(points, 0.12), searched(points, 0.1, math.pi), by_all_choices(points, 0.0999)))
    assert all(looser <= count <= exact for looser, count, exact in found)
    assert sum(count == exact for _, count, exact in found) >= 4
    assert len({count for _, count, _ in found}) > 1, "the inputs differ"


@pytest.mark.parametrize("bend", [0.5, 2.0, 15.0])
def test_bends_keep_to_what_is_asked_and_samples_to_the_tolerance(bend: float) -> None:
    points = wave(12_000)
    path = fit_arcs(points, ArcOptions(TOLERANCE, bend=math.radians(bend)))
    assert len(corners(points, math.radians(30), 4 * TOLERANCE)) == 2, "no bend is a kept corner"
    turns = PlanarPolyline(points[:, :2], 4 * TOLERANCE).turns
    assert bends(path).max() <= max(bend, math.degrees(turns.max())) + 1e-3, "or as much as the points do"
    assert bend < 1 or math.degrees(turns.max()) < bend
    made, given_ = along(path), spread(points)
    most = math.hypot(TOLERANCE, STEP / 2) + 1e-6
    assert cKDTree(given_).query(made[::2])[0].max() <= most
    assert cKDTree(made).query(given_[::2])[0].max() <= most


@pytest.mark.exhaustive
def test_a_wider_bend_never_costs_blocks_and_saves_some() -> None:
    counts = [
        len(fit_arcs(wave(4_000), ArcOptions(TOLERANCE, bend=math.radians(bend))).motions) for bend in (0.5, 5.0, 180.0)
    ]
    assert counts == sorted(counts, reverse=True)
    assert counts[-1] < counts[0]


def test_more_pieces_than_are_searched_together_still_meet(monkeypatch: pytest.MonkeyPatch) -> None:
    """Searched in parts: the next sets out in the direction in which the one before arrives, at a point of the
    polyline.
    """
    whole = len(fit_arcs(wave(4_000), ArcOptions(TOLERANCE)).motions)
    monkeypatch.setattr(fewest, "_PIECES", 20)
    path = fit_arcs(wave(4_000), ArcOptions(TOLERANCE))
    assert bends(path).max() <= 0.55
    assert len(path.motions) <= whole + 4
    assert all(np.array_equal(a, b) for a, b in zip(path.motions.start[1:], path.motions.end[:-1], strict=True))


def test_time_grows_with_the_points_and_not_faster() -> None:
    """Counted, not timed: states and samples of a search for twice as many of the same waves."""
    sizes = []
    for turns in (1, 2, 4):
        t = np.linspace(0, turns * math.tau, 2_000 * turns + 1)
        line = PlanarPolyline(np.column_stack([30 * t, 5 * np.sin(3 * t)]), 0.2)
        rough = np.linspace(0, len(t) - 1, 40 * turns + 1).astype(np.int64)
        samples, at = FewestPieces(line, 0.05, np.full(len(t), 0.01), 1e5)._samples(rough, rough)
        sizes.append(len(samples) + len(at))
    assert sizes[2] <= 4.1 * sizes[0]
