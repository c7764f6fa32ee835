# mypy: allow-untyped-defs
"""Which cells a straight move must be evaluated at, when the moves before and behind it are evaluated as well.

Let u be a move's horizontal direction, s its rise per mm, L its horizontal length, t a cell's place along it. Give the
cutter's profile a little curvature everywhere (and let that go to 0): then it touches the surface that it leaves at one
place for each cell, with the surface's slope T in (0, inf], the place at a distance rho(T) from the axis, at the
bearing phi from u. Over a cell the whole chain of moves is lowest

* inside a move: there T cos(phi) = s, so t lies in [0, L] + v with |v| <= `lead`, and v has the sign of s; or
* at a corner between the moves i and j: there going on along i would lower it and along j raise it,
  T cos(phi_i) >= s_i and T cos(phi_j) <= s_j. The cell is then evaluated by i, at t = L + rho(T) cos(phi_i); or
* at an end of the chain: there the whole disc is evaluated.

So nothing is lost on the rectangle |c| <= R, t in [low, high], of this file's `reach`. Bounds of t at a corner, with
the horizontal turn w, the turn in space th and the pitch a = atan(s_i), rho = flat + fillet sin(tilt) or, on the cone,
T = m:

* s_j <= 0: then cos(phi_j) <= 0, so cos(phi_i) <= sin(w): t <= R sin(w), for any profile (R where w > 90 degrees).
* the flat's part is flat cos(phi_i): at most flat, and flat sin(w) where s_j <= 0.
* the fillet's part is fillet * n·u_i with the unit normal n, n·d_i >= 0 >= n·d_j, n_z <= 0. As n and d_j are 90 degrees
  or more apart, n·d_i <= sin(th); so n·u_i <= sin(a + th) for a >= 0 (1 from 90 degrees on), <= sin(th) / cos(a) for a
  < 0, where a normal that points down would only help.
* on the cone and its rim T >= m, so cos(phi_j) <= s_j / m, and phi_i is at most w less: t <= R sin(asin(s_j / m) + w).
"""

from __future__ import annotations

import math

from ...core.jit import kernel

SLACK = 1e-4
"""Added to sines, and as a part of the radius to bounds: far more than rounding, far less than a cell."""

_SHAPE = "UniTuple(float64, 7)"
"""Of a cutter: radius, flat, fillet, span of the fillet, slope of the cone (0 = none), lift over the tip, kind of
runs.
"""

_COURSE = "UniTuple(float64, 5)"
"""Of a move: its horizontal length, direction (2) and rise, and the cosine of its pitch."""

SHORT = 1e-7
"""mm; a move that goes no farther to the side goes straight up or down."""


@kernel(f"{_COURSE}(UniTuple(float64, 3))")
def course_of(way):
    """Return the course of a way; its length is 0 where it goes straight up or down."""
    x, y, z = way
    size = math.sqrt(x * x + y * y)
    if size <= SHORT:
        return 0.0, 1.0, 0.0, 0.0, 1.0
    share = 1.0 / size
    s = z * share
    return size, x * share, y * share, s, 1.0 / math.sqrt(1.0 + s * s)


@kernel(f"float64({_SHAPE}, {_COURSE})")
def lead(shape, course):
    """Return how far ahead (or behind, where it falls) of its axis a cutter touches at most on a move, mm."""
    size = abs(course[3])
    if size == 0.0:
        return 0.0
    # flat + fillet sin(pitch): where the fillet's slope is the move's
    ahead = shape[1] + shape[2] * size * course[4]
    if shape[4] > 0.0:
        ahead = max(ahead, shape[0] * min(size / shape[4], 1.0))
    return min(ahead, shape[0])


@kernel(f"float64({_COURSE}, {_COURSE}, float64)")
def normal_bound(course, onward, cos_turn):
    """Return the most that a normal of a corner's wedge leans along the first move's horizontal direction."""
    s, cos_a = course[3], course[4]
    sin_a = s * cos_a
    # the turn in space from the turn on the plane and both pitches: d_i·d_j
    cos_th = (cos_turn + s * onward[3]) * cos_a * onward[4]
    sin_th = math.sqrt(max(0.0, 1.0 - cos_th * cos_th)) + SLACK
    if s < 0.0:
        return min(1.0, sin_th / cos_a) if cos_th > 0.0 else 1.0
    return min(1.0, sin_a * cos_th + cos_a * sin_th) if cos_a * cos_th - sin_a * sin_th > 0.0 else 1.0


@kernel(f"float64({_SHAPE}, {_COURSE}, {_COURSE})")
def corner(shape, course, onward):
    """Return how far beyond a move's end the wedge of its corner with the next move reaches, mm.

    Args:
        shape: of the cutter.
        course, onward: of both moves.
    """
    s_next, cos_turn = onward[3], course[1] * onward[1] + course[2] * onward[2]
    sin_turn = math.sqrt(max(0.0, 1.0 - cos_turn * cos_turn)) + SLACK
    aside = min(1.0, sin_turn) if cos_turn > 0.0 else 1.0
    beyond = shape[1] * (1.0 if s_next > 0.0 else aside) + shape[2] * normal_bound(course, onward, cos_turn)
    if s_next <= 0.0:
        return shape[0] * aside if shape[4] > 0.0 else min(beyond, shape[0] * aside)
    if shape[4] > 0.0:
        sin_x = min(s_next / shape[4], 1.0)
        cos_x = math.sqrt(1.0 - sin_x * sin_x)
        # the sine of a sum that has passed 90 degrees is no bound any more; 1 is
        within = cos_x * cos_turn - sin_x * sin_turn > 0.0
        beyond = max(beyond, shape[0] * (sin_x * cos_turn + cos_x * sin_turn if within else 1.0))
    return min(beyond, shape[0])


@kernel(f"UniTuple(float64, 2)({_SHAPE}, {_COURSE}, {_COURSE}, boolean, boolean)")
def reach(shape, course, onward, joins, goes_on):
    """Return from where to where along a straight move cells must be evaluated, mm from its start.

    Args:
        shape: of the cutter.
        course, onward: of the move and of the next one.
        joins: whether it begins where a straight move with the same cutter has ended. goes_on: whether such a one
            follows.
    """
    length, s, radius = course[0], course[3], shape[0]
    ahead = lead(shape, course)
    low, high = -radius, length + radius
    # cells before the start belong to the move before, whose corner with this one reaches over them
    if joins:
        low = max(low, (-ahead if s < 0.0 else 0.0) - SLACK * radius)
    if goes_on:
        high = min(high, length + max(corner(shape, course, onward), ahead if s > 0.0 else 0.0) + SLACK * radius)
    return low, high
