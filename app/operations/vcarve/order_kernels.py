# mypy: allow-untyped-defs
"""Compiled: in which order branches make ways, and ways are gone along, the one with the nearest end always next."""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel
from ...geometry.kernels import DEPTH, LEAF


@kernel("float64(float64[:, ::1], int64, float64, float64)", counts=False)
def _square(nodes, k, x, y):
    """Return the square of the distance of a place from the box of node k, mm2."""
    dx = max(nodes[k, 0] - x, x - nodes[k, 2], 0.0)
    dy = max(nodes[k, 1] - y, y - nodes[k, 3], 0.0)
    return dx * dx + dy * dy


@kernel("void(int64[::1], int64, int64)", counts=False)
def _take(waiting, leaf, count):
    """Count so many ends more in a leaf and all nodes above it."""
    waiting[leaf] += count
    while leaf > 0:
        leaf = (leaf - 1) // 2
        waiting[leaf] += count


@kernel("int64(float64[:, ::1], int64[::1], float64[:, ::1], int64[::1], boolean[::1], float64, float64, int64[::1])")
def _nearest(ends, order, nodes, waiting, done, x, y, stack):
    """Return which end that still waits is nearest to a place; of those as far the one of the lowest number."""
    leaves, best, found = (len(nodes) + 1) // 2, math.inf, -1
    stack[0], top = 0, 1
    while top > 0:
        top -= 1
        k = stack[top]
        # a box as far as the best may hold an end as near with a lower number
        if waiting[k] == 0 or _square(nodes, k, x, y) > best:
            continue
        if k < leaves - 1:
            near = 2 * k + 1
            if _square(nodes, near + 1, x, y) < _square(nodes, near, x, y):
                near += 1
            stack[top], stack[top + 1] = 4 * k + 3 - near, near
            top += 2
            continue
        first = (k - leaves + 1) * LEAF
        for place in range(first, min(first + LEAF, len(order))):
            i = order[place]
            if done[i // 2]:
                continue
            dx, dy = ends[i, 0] - x, ends[i, 1] - y
            square = dx * dx + dy * dy
            if square < best or (square == best and i < found):
                best, found = square, i
    return found


@kernel("void(float64[:, ::1], int64[::1], float64[:, ::1], float64, float64, int64[::1])")
def nearest_order(ends, order, nodes, x, y, out):
    """Write the end at which each way begins, in the order in which they come.

    Args:
        ends: (2 n, 2) both ends of each way, one behind the other, mm.
        order, nodes: their tree, see `app.geometry.kernels`.
        x, y: where the first one is gone to from, mm.
        out: (n,) numbers of ends.
    """
    leaves, stack = (len(nodes) + 1) // 2, np.empty(DEPTH, np.int64)
    waiting, leaf, done = np.zeros(len(nodes), np.int64), np.empty(len(ends), np.int64), np.zeros(len(out), np.bool_)
    for place in range(len(order)):
        leaf[order[place]] = leaves - 1 + place // LEAF
        _take(waiting, leaf[order[place]], 1)
    for step in range(len(out)):
        end = _nearest(ends, order, nodes, waiting, done, x, y, stack)
        # a way is gone along from its nearer end, and left at the other one
        other = end + 1 - 2 * (end % 2)
        done[end // 2], out[step] = True, end
        _take(waiting, leaf[end], -1)
        _take(waiting, leaf[other], -1)
        x, y = ends[other, 0], ends[other, 1]


@kernel(
    "int64(int64[:, ::1], int64[::1], int64[::1], float64[::1], int64[::1], boolean[::1], int64)",
    counts=False,
)
def _leading_on(ends, first, at, lengths, left, gone, node):
    """Return which branch at a node leads on to the most others, of those the longest one, of these the first."""
    found, most = -1, -1
    for place in range(first[node], first[node + 1]):
        k = at[place]
        if gone[k]:
            continue
        # the node at its other end: the sum of both less this one
        onward = left[ends[k, 0] + ends[k, 1] - node]
        if onward > most or (onward == most and lengths[k] > lengths[found]):
            found, most = k, onward
    return found


@kernel("void(int64[:, ::1], int64[::1], int64[::1], float64[::1], int64[::1], int64[::1], int64[:, ::1])")
def walked(ends, first, at, lengths, odd, some, steps):
    """Write how ways go along every branch once, each as far as it can: along dead ends last.

    No node becomes an odd one, since ways end where nothing is left.

    Args:
        ends: (m, 2) nodes at which each branch begins and ends.
        first, at: the branches at node k are those from `at[first[k]]` up to `at[first[k + 1]]`, which is left out.
        lengths: (m,) of the branches, mm.
        odd, some: the nodes with an odd number of branches, and those with any, in the order in which ways begin there.
        steps: (m, 3) branch, 1 where it is gone along backwards, 1 where a way begins with it.
    """
    left, gone = first[1:] - first[:-1], np.zeros(len(ends), np.bool_)
    i, j, count = 0, 0, 0
    while j < len(some):
        while i < len(odd) and left[odd[i]] % 2 == 0:
            i += 1
        # a node with an odd number left ends a way in any order; rings, all of whose nodes are even, come last
        if i == len(odd) and left[some[j]] == 0:
            j += 1
            continue
        node, begins = odd[i] if i < len(odd) else some[j], 1
        while left[node] > 0:
            k = _leading_on(ends, first, at, lengths, left, gone, node)
            steps[count, 0], steps[count, 1], steps[count, 2] = k, ends[k, 0] != node, begins
            gone[k] = True
            left[ends[k, 0]] -= 1
            left[ends[k, 1]] -= 1
            node = ends[k, 0] + ends[k, 1] - node
            count, begins = count + 1, 0
