"""What lies on either side of every edge: counted from face to face, never probed.

Across an edge the count changes by what runs along it: even and odd change places where an odd number of contours does;
the number of outlines that hold the place changes with their direction. One face of each connected net is its outer
one, which is that with a negative area; what is counted there comes from the nets round it.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..near_points import groups
from ..primitives import R, sweeps
from .node_order import NodeOrder
from .nodes import PlanarEdges

Indices = NDArray[np.int64]
Flags = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Faces:
    """The faces between edges.

    Attributes:
        left: (2 n,) face to the left of each end as it leaves.
        net: (n,) number of the connected net of each edge, by its first one.
        net_of: (f,) net of each face.
        outer: (c,) outer face of each net.
    """

    left: Indices
    net: Indices
    net_of: Indices
    outer: Indices


@dataclass(frozen=True, eq=False)
class FaceCounts:
    """What is counted in each face.

    Attributes:
        odd: (f,) True where an odd number of contours goes round it.
        held: (f,) how many outlines hold it.
        torn: (c,) True for nets in which ways from face to face tell different counts.
    """

    odd: Flags
    held: Indices
    torn: Flags


@dataclass(frozen=True, eq=False)
class CountSteps:
    """How counts differ across each edge, from its right to its left: odd (n,), held (n,)."""

    odd: Flags
    held: Indices


def faces_of(edges: PlanarEdges, turn: NodeOrder) -> Faces:
    """Return the faces of some edges with their order round the nodes."""
    count = len(edges.rows)
    ends = np.arange(2 * count)
    left = groups(2 * count, np.stack([ends, turn.following() ^ 1], 1))
    nodes = int(max(edges.start.max(), edges.end.max())) + 1
    by_node = groups(nodes, np.stack([edges.start, edges.end], 1))
    net = np.unique(by_node[edges.start], return_index=True, return_inverse=True)
    rank = np.empty(len(net[0]), np.int64)
    rank[np.argsort(net[1])] = np.arange(len(net[0]))
    number = rank[net[2]]
    net_of = np.zeros(int(left.max()) + 1, np.int64)
    net_of[left] = number[ends // 2]
    areas = _areas(edges, left, number)
    order = np.lexsort((areas, net_of))
    outer = order[np.unique(net_of[order], return_index=True)[1]]
    return Faces(left, number, net_of, outer)


def _areas(edges: PlanarEdges, left: Indices, net: Indices) -> NDArray[np.float64]:
    """Return the area that the edges of each face run round, mm2; negative for outer ones."""
    first = np.unique(net, return_index=True)[1]
    origin = edges.rows[first, :2][net]
    a, b = edges.rows[:, :2] - origin, edges.rows[:, 2:4] - origin
    sweep = sweeps(edges.rows)
    part = (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0] + edges.rows[:, R] ** 2 * (sweep - np.sin(sweep))) / 2
    total = int(left.max()) + 1
    areas = np.bincount(left[::2], part, total) - np.bincount(left[1::2], part, total)
    return areas.astype(np.float64)


class _WayAcross(NamedTuple):
    """A way across an edge: to which face, whether the contours' count flips, and by how much the outlines' rises."""

    face: int
    flips: bool
    more: int


def counted(faces: Faces, steps: CountSteps, odd: Flags, held: Indices) -> FaceCounts:
    """Return the counts of all faces from those of the outer ones, odd (c,) and held (c,)."""
    total = len(faces.net_of)
    right, left = faces.left[1::2], faces.left[::2]
    ways: list[list[_WayAcross]] = [[] for _ in range(total)]
    for a, b, flips, more in zip(right.tolist(), left.tolist(), steps.odd.tolist(), steps.held.tolist(), strict=True):
        ways[a].append(_WayAcross(b, flips, more))
        ways[b].append(_WayAcross(a, flips, -more))
    parity, number, known = [False] * total, [0] * total, [False] * total
    for face, begins, holds in zip(faces.outer.tolist(), odd.tolist(), held.tolist(), strict=True):
        parity[face], number[face], known[face] = begins, holds, True
        waiting = deque([face])
        while waiting:
            here = waiting.popleft()
            for there, flips, more in ways[here]:
                if not known[there]:
                    parity[there], number[there], known[there] = parity[here] ^ flips, number[here] + more, True
                    waiting.append(there)
    odds, helds = np.array(parity, np.bool_), np.array(number, np.int64)
    wrong = (odds[left] ^ odds[right] != steps.odd) | (helds[left] - helds[right] != steps.held)
    torn = np.zeros(len(faces.outer), np.bool_)
    torn[faces.net[wrong]] = True
    return FaceCounts(odds, helds, torn)
