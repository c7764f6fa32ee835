# mypy: allow-untyped-defs
"""Compiled: a cloud's facets, grown from its flattest places over neighbours within epsilon of one plane."""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel

_ROUNDS = 8
"""How often a facet's plane is laid anew through the points that it reaches."""
_SWEEPS = 12
"""Of Jacobi's rotations, which about double the digits that are right each time."""


@kernel("float64(float64[:, ::1], int64[::1], int64, float64[::1])")
def lay(points, members, count, plane):
    """Write normal and centre (6,) of the plane nearest to members; return the mean square of their distances, mm2.

    By Jacobi's rotations of the 3 x 3 matrix of their spread.
    """
    spread, turned = np.zeros((3, 3)), np.eye(3)
    for a in range(3):
        plane[3 + a] = 0.0
        for m in range(count):
            plane[3 + a] += points[members[m], a] / count
    for m in range(count):
        for a in range(3):
            for b in range(3):
                spread[a, b] += (points[members[m], a] - plane[3 + a]) * (points[members[m], b] - plane[3 + b]) / count
    for _ in range(_SWEEPS):
        for a in range(2):
            for b in range(a + 1, 3):
                if spread[a, b] == 0.0:
                    continue
                # t is the tangent of the smaller of the two angles that make spread[a, b] 0: with it the rotations
                # converge.
                lean = (spread[b, b] - spread[a, a]) / (2 * spread[a, b])
                t = math.copysign(1.0, lean) / (abs(lean) + math.sqrt(lean * lean + 1))
                c = 1 / math.sqrt(t * t + 1)
                s = t * c
                for i in range(3):
                    p, q = spread[i, a], spread[i, b]
                    spread[i, a], spread[i, b] = c * p - s * q, s * p + c * q
                for i in range(3):
                    p, q = spread[a, i], spread[b, i]
                    spread[a, i], spread[b, i] = c * p - s * q, s * p + c * q
                    p, q = turned[i, a], turned[i, b]
                    turned[i, a], turned[i, b] = c * p - s * q, s * p + c * q
    least = 0
    for a in range(1, 3):
        if spread[a, a] < spread[least, least]:
            least = a
    plane[:3] = turned[:, least]
    return max(spread[least, least], 0.0)


@kernel("void(float64[:, ::1], int64[::1], int64[::1], float64[::1])")
def roughness(points, offsets, beside, rough):
    """Write how far each point and its neighbours (beside[offsets[i]:offsets[i + 1]]) lie off one plane, mm2."""
    members, plane = np.empty(len(points), np.int64), np.empty(6)
    for i in range(len(points)):
        count = offsets[i + 1] - offsets[i]
        members[0] = i
        members[1 : count + 1] = beside[offsets[i] : offsets[i + 1]]
        rough[i] = lay(points, members, count + 1, plane)


@kernel(
    "int64(float64[:, ::1], int64[::1], int64[::1], int64, float64, float64[::1], int64[::1], int64[::1], int64, "
    "int64[::1])"
)
def _flood(points, offsets, beside, seed, epsilon, plane, facet, seen, mark, members):
    """Write what is reached from a seed over free points within epsilon of a plane; return how many."""
    members[0] = seed
    seen[seed] = mark
    count, at = 1, 0
    while at < count:
        for row in range(offsets[members[at]], offsets[members[at] + 1]):
            j = beside[row]
            if facet[j] >= 0 or seen[j] == mark:
                continue
            seen[j] = mark
            away = 0.0
            for a in range(3):
                away += plane[a] * (points[j, a] - plane[3 + a])
            if abs(away) <= epsilon:
                members[count] = j
                count += 1
        at += 1
    return count


@kernel("int64(float64[:, ::1], int64[::1], int64[::1], int64[::1], float64, int64[::1], float64[:, ::1])")
def grow(points, offsets, beside, order, epsilon, facet, planes):
    """Write each point's facet (n,) and the facets' planes (normal, centre); return the number of facets.

    Args:
        order: (n,) the points in the order in which they are tried as seeds.
    """
    n, count, mark = len(points), 0, 0
    seen, members, plane, trial = np.full(n, -1, np.int64), np.empty(n, np.int64), np.empty(6), np.empty(6)
    facet[:] = -1
    for seed in order:
        if facet[seed] >= 0:
            continue
        size = 1
        members[0] = seed
        for row in range(offsets[seed], offsets[seed + 1]):
            if facet[beside[row]] < 0:
                members[size] = beside[row]
                size += 1
        best = 0
        # A plane through more points reaches more: on until it reaches no more, and the one that reached most is
        # kept.
        for _ in range(_ROUNDS):
            lay(points, members, size, trial)
            away = 0.0
            for a in range(3):
                away += trial[a] * (points[seed, a] - trial[3 + a])
            if abs(away) > epsilon:
                break
            size = _flood(points, offsets, beside, seed, epsilon, trial, facet, seen, mark, members)
            # `seen` says in which round a point was seen, and so never has to be cleared.
            mark += 1
            if size <= best:
                break
            best = size
            plane[:] = trial
        if best == 0:  # not even its own neighbours lie with it: alone, on any plane through it
            plane[:3] = trial[:3]
            plane[3:] = points[seed]
            members[0], best = seed, 1
        else:
            best = _flood(points, offsets, beside, seed, epsilon, plane, facet, seen, mark, members)
            mark += 1
        for m in range(best):
            facet[members[m]] = count
        planes[count] = plane
        count += 1
    return count
