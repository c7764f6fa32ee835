# mypy: allow-untyped-defs
"""Compiled: how much a path turns at each of its points, seen over a length and not over single chords."""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel


@kernel("void(float64[:, ::1], float64, float64[::1], float64[::1])")
def turns(points, reach, along, turn):
    """Write the length up to each point (n,), mm, and the turn there (n,), radians; 0 at the outer ones.

    Args:
        reach: the directions are those to the places of the path so far before and behind, mm; where the chord itself
            is longer, its own.
    """
    n = len(points)
    along[0] = 0.0
    for i in range(1, n):
        size = 0.0
        for axis in range(3):
            size += (points[i, axis] - points[i - 1, axis]) ** 2
        along[i] = along[i - 1] + math.sqrt(size)
    turn[0] = turn[n - 1] = 0.0
    low, high, before, behind = 0, 1, np.empty(3), np.empty(3)
    for i in range(1, n - 1):
        # Both ends of the window only move on with i, so all windows together cost one pass.
        while along[low + 1] <= along[i] - reach:
            low += 1
        high = max(high, i + 1)
        while high < n - 1 and along[high] < along[i] + reach:
            high += 1
        here = max(along[i] - reach, 0.0)
        share = min(max((here - along[low]) / max(along[low + 1] - along[low], 1e-300), 0.0), 1.0)
        there = min(along[i] + reach, along[n - 1])
        other = min(max((there - along[high - 1]) / max(along[high] - along[high - 1], 1e-300), 0.0), 1.0)
        dot, one, two = 0.0, 0.0, 0.0
        for axis in range(3):
            before[axis] = points[i, axis] - (points[low, axis] + share * (points[low + 1, axis] - points[low, axis]))
            behind[axis] = (
                points[high - 1, axis] + other * (points[high, axis] - points[high - 1, axis]) - points[i, axis]
            )
            dot += before[axis] * behind[axis]
            one += before[axis] ** 2
            two += behind[axis] ** 2
        if one == 0.0 or two == 0.0:  # it comes back to where it was
            turn[i] = math.pi
            continue
        turn[i] = math.acos(min(max(dot / math.sqrt(one * two), -1.0), 1.0))


@kernel("void(float64[::1], float64[::1], float64, float64, boolean[::1])")
def peaks(turn, along, angle, reach, kept):
    """Mark the points that turn by more than an angle, and more than all others within a reach: the first of equals."""
    n = len(turn)
    kept[:] = False
    kept[0] = kept[n - 1] = True
    for i in range(1, n - 1):
        if turn[i] <= angle:
            continue
        best = True
        k = i - 1
        while best and k > 0 and along[i] - along[k] < reach:
            # Strictly more than those before, no less than those behind: of equals the first one stays.
            best = turn[k] < turn[i] - 1e-12
            k -= 1
        k = i + 1
        while best and k < n - 1 and along[k] - along[i] < reach:
            best = turn[k] <= turn[i] + 1e-12
            k += 1
        kept[i] = best
