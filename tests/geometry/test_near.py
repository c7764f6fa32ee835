"""Portions change nothing."""

from __future__ import annotations

import numpy as np
import shapely

from app.geometry.near_points import near


def pairs_of(found: np.ndarray) -> set[tuple[int, int]]:
    return set(zip(*found.tolist(), strict=True))


def test_portions_give_what_one_question_gives() -> None:
    rng = np.random.default_rng(1)
    points = shapely.points(rng.uniform(0, 100, (1701, 2)))
    tree = shapely.STRtree(shapely.box(*rng.uniform(0, 100, (2, 300)), *rng.uniform(0, 100, (2, 300))))
    distance = rng.uniform(0, 3, len(points))
    assert pairs_of(near(tree, points)) == pairs_of(tree.query(points))
    assert pairs_of(near(tree, points, distance)) == pairs_of(
        tree.query(points, predicate="dwithin", distance=distance)
    )
    assert pairs_of(near(tree, points, 2.0)) == pairs_of(tree.query(points, predicate="dwithin", distance=2.0))
    assert near(tree, points[:0]).shape == (2, 0)
