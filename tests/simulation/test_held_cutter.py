"""What facets leave lies between two closed forms: of the cutter, and of the slimmer one that the facets hold.

The oracle is float64 and knows neither sweeps nor depth buffers: facets are planes that are looked for over a place one
by one, and a closed form is the lowest of very many places along each move, refined about the best.
"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

from app.model.motion import Floats
from app.simulation.cutter import Cutter
from app.simulation.gpu.polyhedron import facet_error, held_cutter
from app.simulation.gpu.wedges import Tessellation, facets_in
from app.simulation.sweeps.chains import Chains
from tests.simulation.test_sweep import walk

BALL = Cutter(3.0, 0.0, 3.0)
CUTTERS = {
    "ball": BALL,
    "bull": Cutter(3.0, 1.8, 1.2),
    "flat": Cutter(3.0, 3.0),
    "V": Cutter(3.0, 0.0, 0.0, math.sqrt(3.0)),
    "frustum": Cutter(3.0, 0.7, 0.0, 1.0),
    "taper": Cutter(3.0, 0.0, 1.0, 4.0),
}
SURE = 1e-5
"""mm: the promise of heights."""
ROUNDED = 5e-6
"""mm: facets are float32, so that their places are sure to that."""


def over_place(quads: Floats, place: Floats) -> float:
    """Return the lowest height of facets (m, 4, 3) over a place (2,); infinite where there is none."""
    lowest = math.inf
    for corners in ([0, 1, 2], [0, 2, 3]):
        a, b, c = (quads[:, k] for k in corners)
        u, v, w = b[:, :2] - a[:, :2], c[:, :2] - a[:, :2], place - a[:, :2]
        area = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
        seen = np.abs(area) > 1e-12
        area = np.where(seen, area, 1.0)
        one = (w[:, 0] * v[:, 1] - w[:, 1] * v[:, 0]) / area
        two = (u[:, 0] * w[:, 1] - u[:, 1] * w[:, 0]) / area
        inside = seen & (one >= 0) & (two >= 0) & (one + two <= 1)
        height = a[:, 2] + one * (b[:, 2] - a[:, 2]) + two * (c[:, 2] - a[:, 2])
        lowest = min(lowest, float(height[inside].min(initial=math.inf)))
    return lowest


def closed_form(cutter: Cutter, path: Floats, place: Floats) -> float:
    """Return the lowest height over a place (2,) of a cutter whose tip goes along a path (n, 3)."""
    lowest = math.inf
    for a, b in pairwise(path):
        way = b - a
        foot = np.clip((place - a[:2]) @ way[:2] / max(float(way[:2] @ way[:2]), 1e-300), 0.0, 1.0)
        share = np.append(np.linspace(0.0, 1.0, 4001), foot)
        for _ in range(3):
            at = a + share[:, None] * way
            height = at[:, 2] + cutter.lift + cutter.heights(np.hypot(*(place - at[:, :2]).T))
            best, step = share[int(np.argmin(height))], np.ptp(share) / 2000
            lowest = min(lowest, float(height.min()))
            share = np.clip(np.linspace(best - step, best + step, 2001), 0.0, 1.0)
    return lowest


@pytest.mark.parametrize("name", CUTTERS)
@pytest.mark.parametrize("facet", [0.1, 0.5])
def test_heights_by_facets_lie_between_two_closed_forms(name: str, facet: float) -> None:
    cutter, random = CUTTERS[name], np.random.default_rng(len(name))
    path = walk(3, 6, 1.2, 0.5)
    quads = next(
        part.quads.astype(float)
        for part, _ in facets_in(cutter, Chains.of(path[:-1], path[1:], np.arange(5) > 0), Tessellation(facet))
    )
    held = held_cutter(cutter, facet)
    assert held is not None
    slimmer, wider = held.shrunk(ROUNDED), cutter.grown(ROUNDED)
    assert slimmer is not None
    low, high = path[:, :2].min(axis=0) - 3.0, path[:, :2].max(axis=0) + 3.0
    met = 0
    for place in random.uniform(low, high, (40, 2)):
        found = over_place(quads, place)
        assert found >= closed_form(wider, path, place) - SURE
        most = closed_form(slimmer, path, place)
        assert found <= most + SURE
        met += math.isfinite(most)
    assert met > 15


def test_facets_fine_enough_are_heights_to_1e5() -> None:
    """What the published way needs for that: on level ground d = sqrt(8 r 1e-5 / 2), here 11 um of a ball of 3 mm."""
    facet = math.sqrt(4.0 * BALL.radius * SURE)
    assert facet_error(BALL, facet) <= SURE
    path = np.array([[0.0, 0.0, 0.0], [0.02, 0.01, 0.005], [0.05, 0.0, 0.0]])
    chains = Chains.of(path[:-1], path[1:], np.array([False, True]))
    parts = [part.quads.astype(float) for part, _ in facets_in(BALL, chains, Tessellation(facet), (-1, -1, 1, 1))]
    quads = np.concatenate(parts)
    for place in np.random.default_rng(1).uniform(-0.9, 0.9, (12, 2)):
        near = quads[np.all(np.abs(quads[:, 0, :2] - place) < 0.2, axis=1)]
        assert over_place(near, place) == pytest.approx(closed_form(BALL, path, place), abs=1.2 * SURE)


def test_a_rounding_that_facets_eat_up_holds_no_cutter() -> None:
    assert held_cutter(Cutter(3.0, 2.99, 0.01), 1.0) is None
    assert held_cutter(Cutter(3.0, 2.9999, 0.0001), 0.5) is None
