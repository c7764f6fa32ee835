"""What the width of a thread mill does to the thread's form.

A tooth of half width w(d) = (r - d) tan(a) at distance d from the mill's axis, r its radius, a half the angle between
the flanks, goes round on a helix of radius R and pitch P. In a plane through the hole's axis, at distance q from that,
it is q - R deep at angle 0 of the mill, and at angle t it is P t / 2 pi higher and its distance there is
d(t) = sqrt(R^2 + q^2 - 2 R q cos t). So its flank cuts, beside what it is meant to, up to

    f(q) = max over t of  P t / 2 pi - (d(t) - d(0)) tan(a)  >= 0

which is 0 for a mill without width and grows with r. It is corrected at the pitch diameter: the mill keeps f / tan(a)
farther from the wall, so that the flanks are there where they should be. On a boss the same holds, with R outside.
"""

from __future__ import annotations

import math

import numpy as np

from ...model.thread_sizes import ThreadSize

_SAMPLES = 4096
"""Angles that are looked at: what lies between two of them is less than a nanometre higher."""


_ROUNDS = 6
"""The error changes little with the way: each round is a tenth as far off as the one before, or less."""


def flank_error(thread: ThreadSize, radius: float, way: float, place: float) -> float:
    """Return by how much, mm along the axis, a tooth's flank cuts more than it is meant to.

    Args:
        thread: its pitch and form. radius: of the mill, mm. way: radius of its centre's helix, mm.
        place: distance from the hole's axis, mm.
    """
    slope = math.tan(math.radians(thread.form.value / 2))

    within = (way**2 + place**2 - radius**2) / (2 * way * place)  # beyond this angle the tooth is out of the wall
    angles = np.linspace(0.0, math.acos(max(-1.0, min(1.0, within))), _SAMPLES)
    far = np.sqrt(way**2 + place**2 - 2 * way * place * np.cos(angles))
    gain = thread.pitch * angles / math.tau - (far - abs(place - way)) * slope
    return float(gain.max())


def correction(thread: ThreadSize, radius: float, external: bool) -> float:
    """Return by how much farther from the wall a mill keeps than it is wide, mm, so that the thread has its pitch
    diameter.

    Args:
        thread: that is cut. radius: of the mill, mm. external: on a boss, and not in a hole.
    """
    slope, place = math.tan(math.radians(thread.form.value / 2)), thread.pitch_diameter / 2
    farther = 0.0
    for _ in range(_ROUNDS):
        way = thread.bolt_core / 2 + radius + farther if external else thread.major / 2 - radius - farther
        farther = flank_error(thread, radius, way, place) / slope
    return farther
