"""Branches that meet as a graph: those that say nothing are pruned, the rest is walked with few lifts."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from heapq import heapify, heappop

import numpy as np

from .branches import AxisBranch, Floats

_SAME = 1e-5
"""mm; ends that are as near are one node."""

PRUNED = 2e-3
"""mm by which the discs of branches that are left out may reach beyond those that are kept: the fit of splines leaves
kinks, each of which would send the cutter up to the surface.
"""


@dataclass(eq=False)
class BranchGraph:
    """Branches between nodes.

    Attributes:
        discs: x, y and radius of each node, mm.
        ends: from node and to node of each branch.
        at: numbers of the branches at each node.
    """

    branches: list[AxisBranch] = field(default_factory=list)
    discs: list[Floats] = field(default_factory=list)
    ends: list[tuple[int, int]] = field(default_factory=list)
    at: list[list[int]] = field(default_factory=list)
    _places: dict[tuple[int, int], list[int]] = field(default_factory=dict)

    def add(self, branch: AxisBranch) -> None:
        """Put in a branch; its ends are nodes, those that are there already or new ones."""
        number, pair = len(self.branches), (self._node(branch.discs[0]), self._node(branch.discs[-1]))
        self.branches.append(branch)
        self.ends.append(pair)
        for node in pair:
            self.at[node].append(number)

    def remove(self, number: int) -> None:
        """Take out a branch."""
        for node in self.ends[number]:
            self.at[node].remove(number)

    def other(self, number: int, node: int) -> int:
        """Return the node at the other end of a branch."""
        a, b = self.ends[number]
        return b if node == a else a

    def from_node(self, number: int, node: int) -> AxisBranch:
        """Return a branch as it goes on from a node."""
        branch = self.branches[number]
        return branch if self.ends[number][0] == node else branch.backwards()

    def _node(self, disc: Floats) -> int:
        x, y = disc[:2].tolist()
        i, j = math.floor(x / _SAME), math.floor(y / _SAME)
        for di in (-1, 0, 1):
            for dj in (-1, 0, 1):
                for node in self._places.get((i + di, j + dj), ()):
                    if math.dist(self.discs[node][:2].tolist(), (x, y)) <= _SAME:
                        return node
        self._places.setdefault((i, j), []).append(len(self.discs))
        self.discs.append(disc)
        self.at.append([])
        return len(self.discs) - 1


def graph_of(branches: Iterable[AxisBranch]) -> BranchGraph:
    """Return branches as a graph."""
    graph = BranchGraph()
    for branch in branches:
        graph.add(branch)
    return graph


def prune(graph: BranchGraph) -> list[Floats]:
    """Take out branches to dead ends all of whose discs the disc at their other end holds, but for PRUNED.

    Returns:
        The disc (3,) of each node that nothing leads to any more: all that is left of its branches.
    """
    spent = [0.0] * len(graph.discs)
    leaves = [node for node, own in enumerate(graph.at) if len(own) == 1]
    lone: list[Floats] = []
    while leaves:
        leaf = leaves.pop()
        if len(graph.at[leaf]) != 1:
            continue
        (number,) = graph.at[leaf]
        end = graph.other(number, leaf)
        beyond = spent[leaf] + _beyond(graph.branches[number], graph.discs[end])
        if end == leaf or beyond > PRUNED:
            continue
        graph.remove(number)
        spent[end] = max(spent[end], beyond)
        if not graph.at[end]:
            lone.append(graph.discs[end])
        elif len(graph.at[end]) == 1:
            leaves.append(end)
    return lone


def _beyond(branch: AxisBranch, disc: Floats) -> float:
    """Return how far the discs of a branch reach beyond one, mm."""
    discs = branch.discs
    return max(0.0, float((np.hypot(*(discs[:, :2] - disc[:2]).T) + discs[:, 2]).max() - disc[2]))


def trails(graph: BranchGraph) -> list[AxisBranch]:
    """Return ways that go along every branch once, each as far as it can: from a dead end, the shallowest, where there
    is one.
    """
    left = [list(own) for own in graph.at]
    deep = [float(disc[2]) for disc in graph.discs]
    odd = [(deep[node], node) for node, own in enumerate(left) if len(own) % 2]
    some = [(deep[node], node) for node, own in enumerate(left) if own]
    heapify(odd)
    heapify(some)
    found: list[AxisBranch] = []
    while some:
        while odd and not len(left[odd[0][1]]) % 2:
            heappop(odd)
        if not odd and not left[some[0][1]]:
            heappop(some)
            continue
        node = (odd or some)[0][1]  # ways end where nothing is left, so no node becomes an odd one
        parts: list[Floats] = []
        while left[node]:
            # what leads on first, dead ends last
            number = max(left[node], key=lambda each: (len(left[graph.other(each, node)]), graph.branches[each].length))
            branch, end = graph.from_node(number, node), graph.other(number, node)
            left[node].remove(number)
            left[end].remove(number)
            parts.append(branch.discs if not parts else branch.discs[1:])
            node = end
        found.append(AxisBranch(np.concatenate(parts)))
    return found
