"""Branches that meet as a graph: those that say nothing are pruned, the rest is walked with few lifts."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import chain, pairwise

import numpy as np
from numpy.typing import NDArray

from ...geometry.near_points import groups_within
from .branches import AxisBranch, Floats, JoinedBranches, joined

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
        joined: the branches one after the other.
    """

    branches: list[AxisBranch]
    discs: Floats
    ends: list[tuple[int, int]]
    at: list[list[int]]
    joined: JoinedBranches

    def remove(self, number: int) -> None:
        """Take out a branch."""
        for node in self.ends[number]:
            self.at[node].remove(number)

    def other(self, number: int, node: int) -> int:
        """Return the node at the other end of a branch."""
        a, b = self.ends[number]
        return b if node == a else a


def graph_of(branches: Iterable[AxisBranch]) -> BranchGraph:
    """Return branches as a graph."""
    branches = list(branches)
    whole = joined(branches)
    discs = whole.ends()
    number = groups_within(discs[:, :2], np.arange(len(discs)), len(discs), _SAME)
    _, first = np.unique(number, return_index=True)
    ends = [(a, b) for a, b in number.reshape(-1, 2).tolist()]
    at: list[list[int]] = [[] for _ in first]
    for k, pair in enumerate(ends):
        for node in pair:
            at[node].append(k)
    return BranchGraph(branches, discs[first], ends, at, whole)


def end_discs(branches: Sequence[AxisBranch]) -> Floats:
    """Return the discs (2 n, 3) at which branches begin and end, one branch after the other."""
    return joined(branches).ends()


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
    is one; from each node along the branch that leads on to the most others, of those the longest one.
    """
    if not any(graph.at):
        return []
    from .order_kernels import walked  # compiled code: loaded where it is used

    degree = np.array([len(own) for own in graph.at], np.int64)
    at = np.fromiter(chain.from_iterable(graph.at), np.int64, int(degree.sum()))
    shallowest = np.argsort(graph.discs[:, 2], kind="stable")
    steps = np.empty((len(at) // 2, 3), np.int64)
    walked(
        np.array(graph.ends),
        np.append(0, np.cumsum(degree)),
        at,
        graph.joined.lengths(),
        shallowest[degree[shallowest] % 2 == 1],
        shallowest[degree[shallowest] > 0],
        steps,
    )
    return _along(graph.joined, steps)


def _along(whole: JoinedBranches, steps: NDArray[np.int64]) -> list[AxisBranch]:
    """Return the ways that go along branches one after the other.

    Args:
        whole: the branches.
        steps: (k, 3) what `walked` writes.
    """
    discs, upto = whole
    branch, back, begins = steps.T
    skipped = 1 - begins  # the disc at which the branch before ended
    first, last = upto[branch] + np.where(back, 0, skipped), upto[branch + 1] - 1 - np.where(back, skipped, 0)
    count = last - first + 1
    after = np.cumsum(count)
    along = np.arange(int(count.sum())) - np.repeat(after - count, count)
    gone = discs[np.repeat(np.where(back, last, first), count) + np.repeat(1 - 2 * back, count) * along]
    ends = [*(after - count)[np.flatnonzero(begins)].tolist(), len(gone)]
    return [AxisBranch(gone[a:b]) for a, b in pairwise(ends)]
