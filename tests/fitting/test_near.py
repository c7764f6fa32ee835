"""Places at others are found as by all distances, also where the reach and the places are round numbers."""

import numpy as np
import pytest

from app.geometry.coincident_points import near


@pytest.mark.parametrize("reach", [1e-4, 0.01, 0.3])
def test_as_by_all_distances(reach: float) -> None:
    rng = np.random.default_rng(1)
    for _ in range(50):
        others = np.round(rng.uniform(-1, 1, (30, 3)), 2)
        beside = others[rng.integers(0, 30, 10)] + rng.uniform(-reach, reach, (10, 3))
        places = np.concatenate([beside, rng.uniform(-1, 1, (20, 3)), others[:3]])
        expected = np.linalg.norm(places[:, None] - others[None], axis=2).min(axis=1) <= reach
        assert np.array_equal(near(places, others, reach), expected)


def test_of_none_none_is_near() -> None:
    assert not near(np.zeros((2, 3)), np.zeros((0, 3)), 1.0).any()
    assert len(near(np.zeros((0, 3)), np.zeros((2, 3)), 1.0)) == 0
