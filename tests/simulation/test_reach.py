"""Which cells that are left count as within reach."""

import numpy as np

from app.simulation.sweeps.reach import reachable


def test_the_rim_of_a_place_within_reach_counts_and_a_narrow_place_alone_does_not() -> None:
    left, sure, possible = (np.zeros((12, 20), np.bool_) for _ in range(3))
    left[2:10, 2:9] = possible[2:10, 2:9] = True  # wide
    left[5, 9:13] = possible[5, 9:13] = True  # a rim of one cell beside it
    left[5, 13] = True  # that surely nothing reaches
    left[3:9, 16] = possible[3:9, 16] = True  # as narrow, and alone
    found = reachable(left, sure, possible, 3)
    assert found[2:10, 2:9].all() and found[5, 9:13].all()
    assert found.sum() == 8 * 7 + 4
    sure[4, 16] = True
    assert reachable(left, sure, possible, 3).sum() == 8 * 7 + 4 + 6
