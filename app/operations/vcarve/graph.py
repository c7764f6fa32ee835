"""Branches that meet as a graph: those that say nothing are pruned, the rest is walked with few lifts."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from ...geometry.near_points import groups_within
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
        discs: (n, 3) x, y and radius of each node, mm: of the end that made it.
        ends: from node and to node of each branch.
        at: numbers of the branches at each node.
    """

    branches: list[AxisBranch]
    discs: Floats
    ends: list[tuple[int, int]]
    at: list[list[int]]

    def remove(self, number: int) -> None:
        """Take out a branch."""
        for node in self.ends[number]:
            self.at[node].remove(number)

    def other(self, number: int, node: int) -> int:
        """Return the node at the other end of a branch."""
        a, b = self.ends[number]
        return b if node == a else a

    def from_node(self, number: int, node: int) -> Floats:
        """Return the discs (n, 3) of a branch as it goes on from a node."""
        discs = self.branches[number].discs
        return discs if self.ends[number][0] == node else discs[::-1]


def graph_of(branches: Iterable[AxisBranch]) -> BranchGraph:
    """Return branches as a graph."""
    branches = list(branches)
    discs = end_discs(branches)
    number = groups_within(discs[:, :2], np.arange(len(discs)), len(discs), _SAME)
    _, first = np.unique(number, return_index=True)
    ends = [(a, b) for a, b in number.reshape(-1, 2).tolist()]
    at: list[list[int]] = [[] for _ in first]
    for k, pair in enumerate(ends):
        for node in pair:
            at[node].append(k)
    return BranchGraph(branches, discs[first], ends, at)


def end_discs(branches: Sequence[AxisBranch]) -> Floats:
    """Return the discs (2 n, 3) at which branches begin and end, one branch after the other."""
    all_discs = np.concatenate([np.zeros((0, 3)), *(branch.discs for branch in branches)])
    upto = np.cumsum([len(branch.discs) for branch in branches], dtype=np.int64)
    ends: Floats = all_discs[np.stack([np.append(0, upto[:-1])[: len(upto)], upto - 1], axis=1).ravel()]
    return ends


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
    deep = graph.discs[:, 2].tolist()
    # the shallowest last; none is ever added, since ways end where nothing is left, so no node becomes an odd one
    odd = sorted(((deep[node], node) for node, own in enumerate(left) if len(own) % 2), reverse=True)
    some = sorted(((deep[node], node) for node, own in enumerate(left) if own), reverse=True)

    def next_from(node: int) -> int:
        """Return the branch that leads on to the most others, of those the longest one."""
        if len(left[node]) == 1:
            return left[node][0]
        onward = [len(left[graph.other(number, node)]) for number in left[node]]
        most = max(onward)
        best = [number for number, count in zip(left[node], onward, strict=True) if count == most]
        return best[0] if len(best) == 1 else max(best, key=lambda number: graph.branches[number].length)

    found: list[AxisBranch] = []
    while some:
        while odd and not len(left[odd[-1][1]]) % 2:
            odd.pop()
        if not odd and not left[some[-1][1]]:
            some.pop()
            continue
        node = (odd or some)[-1][1]
        parts: list[Floats] = []
        while left[node]:
            number = next_from(node)  # dead ends last
            discs, end = graph.from_node(number, node), graph.other(number, node)
            left[node].remove(number)
            left[end].remove(number)
            parts.append(discs[1:] if parts else discs)
            node = end
        found.append(AxisBranch(np.concatenate(parts)))
    return found
