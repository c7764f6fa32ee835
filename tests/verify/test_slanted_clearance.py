"""How far cones on slanted moves reach beyond walls: closed forms against dense samples."""

from __future__ import annotations

import numpy as np
import pytest

from app.geometry.distance import DistanceField
from app.geometry.outlines import nested
from app.geometry.primitives import pack, within_half_turn
from app.verify.verdict import SlantedMoves, reach_beyond
from tests.part_shapes import circle, random_star, square


def moves_of(rows: list[list[float]], rate: float = 1.0, tip: float = 0.0) -> SlantedMoves:
    ends = np.array(rows, float)
    count = len(ends)
    return SlantedMoves(ends[:, :3], ends[:, 3:], np.full(count, tip), np.full(count, rate), np.full(count, 99.0))


WALLS = within_half_turn(pack(nested([square(20)]).regions).rows)


def test_into_a_corner_it_touches_and_a_little_deeper_it_gouges() -> None:
    into, deeper = moves_of([[0, 0, 0, 5, 5, -5]]), moves_of([[0, 0, 0, 5, 5, -5.25]])
    assert reach_beyond(into, WALLS)[0] == pytest.approx([0.0], abs=1e-12)
    depth, places = reach_beyond(deeper, WALLS)
    assert depth == pytest.approx([0.25]) and places[0] == pytest.approx([5, 5])


def test_the_worst_may_be_between_the_ends() -> None:
    hole = within_half_turn(pack(nested([square(40), circle(5, 20, 20)]).regions).rows)
    beside = moves_of([[12, 13, -2.0, 28, 13, -2.0001]])
    depth, places = reach_beyond(beside, hole)
    assert depth == pytest.approx([0.0], abs=1e-4) and places[0] == pytest.approx([20, 13], abs=1e-3)
    through = moves_of([[10, 20, 0.0, 30, 20, -1.0]])
    assert reach_beyond(through, hole)[0][0] > 0.7


@pytest.mark.parametrize("seed", range(8))
def test_no_sample_is_worse_and_some_is_as_bad(seed: int) -> None:
    made = np.random.default_rng(seed)
    region = nested([random_star(made, (0.0, 0.0), (4.0, 12.0), 0.6)])
    walls = within_half_turn(pack(region.regions).rows)
    ends = np.column_stack([made.uniform(-10, 10, (40, 2)), made.uniform(-4, 0, 40)])
    moves = SlantedMoves(
        ends,
        ends + made.normal(0, 2, (40, 3)) * [1, 1, 0.3],
        made.uniform(0, 1, 40),
        made.uniform(0.2, 3.0, 40),
        np.full(40, 9.0),
    )
    depth, _ = reach_beyond(moves, walls)
    field, sampled = DistanceField.of(walls), np.full(40, -np.inf)
    for share in np.linspace(0, 1, 2001):
        part = np.full(40, share)
        sampled = np.maximum(sampled, moves.width(part) - field.nearest(moves.at(part))[0])
    told = np.isfinite(depth)
    assert (sampled[~told] < 0).all()
    assert (sampled[told] <= depth[told] + 1e-9).all()
    assert (depth[told] - sampled[told]).max() < 0.02
