"""The way with most room, against the spanning tree of widest ways."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components, minimum_spanning_tree

from app.toolpath.narrow_kernels import widest_way

SIDE = 12


def joined(room: np.ndarray, pitch: float) -> np.ndarray:
    """Pairs of neighbours whose discs overlap."""
    row, column = np.divmod(np.arange(SIDE**2), SIDE)
    apart = np.maximum(np.abs(row[:, None] - row), np.abs(column[:, None] - column))
    size = pitch * np.hypot(row[:, None] - row, column[:, None] - column)
    return np.argwhere((apart == 1) & (room[:, None] + room > size))


def least_room(room: np.ndarray, pairs: np.ndarray, start: int, end: int) -> float:
    """The greatest room that a way can keep all along, by the tree that holds the widest ways; 0 without one."""
    weights = 2 * room.max() - room[pairs].min(axis=1)
    tree = minimum_spanning_tree(coo_matrix((weights, pairs.T), (SIDE**2, SIDE**2))).tocoo()
    for limit in sorted(set(room.tolist()), reverse=True):
        wide = tree.data <= 2 * room.max() - limit
        part = coo_matrix((tree.data[wide], (tree.row[wide], tree.col[wide])), tree.shape)
        group = connected_components(part, directed=False)[1]
        if group[start] == group[end] and min(room[start], room[end]) >= limit:
            return limit
    return 0.0


@pytest.mark.parametrize("seed", range(12))
def test_no_way_has_more_room(seed: int) -> None:
    rng = np.random.default_rng(seed)
    room, pitch = rng.random(SIDE**2), 0.8
    pairs = joined(room, pitch)
    start, end = rng.choice(SIDE**2, 2, replace=False).tolist()
    way = widest_way(room, SIDE, pitch, start, end)
    expected = least_room(room, pairs, start, end)
    if not expected:
        assert not len(way)
        return
    assert way[0] == end and way[-1] == start
    assert {tuple(step) for step in np.column_stack([way[:-1], way[1:]]).tolist()} <= set(map(tuple, pairs.tolist()))
    assert room[way].min() == expected
