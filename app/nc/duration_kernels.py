"""Compiled inner loop of the time estimate: look-ahead over the whole program, then a trapezoid of speed for each motion."""

from __future__ import annotations

import math

from app.jit import kernel

SERVO_PERIOD = 1e-3
"""s, in which an axis may change its velocity at a corner by acceleration x period."""


@kernel("void(float64[:, ::1], float64[:, ::1], float64[::1], float64[::1], float64[::1])")
def corners(into, out, tolerance, accelerations, entry):
    """Write the greatest speed between each two of n motions, mm/s; 0 at both ends of all.

    Args:
        into, out: (n, 3) unit vectors in which each motion arrives and sets out.
        tolerance: (n - 1,) how far the control leaves the corner behind each motion, mm; < 0: it stops there.
        accelerations: (3,) of the axes, mm/s2.
        entry: (n + 1,) the answer.
    """
    n = len(into)
    entry[0] = entry[n] = 0.0
    for i in range(n - 1):
        entry[i + 1] = 0.0
        if tolerance[i] < 0.0:
            continue
        x, y, z = out[i + 1, 0] - into[i, 0], out[i + 1, 1] - into[i, 1], out[i + 1, 2] - into[i, 2]
        jolt = math.sqrt(x * x + y * y + z * z)
        a = jolt * min(accelerations[0] / abs(x), accelerations[1] / abs(y), accelerations[2] / abs(z))
        half = math.sqrt(max(0.0, 1.0 - 0.25 * jolt * jolt))
        if half >= 1.0:
            entry[i + 1] = math.inf
        else:
            entry[i + 1] = max(math.sqrt(a * tolerance[i] * half / (1.0 - half)), a * SERVO_PERIOD / jolt)


@kernel("void(float64[::1], float64[::1], float64[::1], float64[::1], float64[::1])")
def run(length, speed, acceleration, entry, seconds):
    """Write how long each motion takes.

    Args:
        length: mm, > 0. speed: greatest one in each motion, mm/s, > 0. acceleration: along the path, mm/s2, > 0.
        entry: (n + 1,) greatest speed at the beginning of each motion and at the end of the last, mm/s; it is lowered
            to what can be reached from one side and braked to from the other.
        seconds: (n,) the answer.
    """
    n = len(length)
    for i in range(n - 1, -1, -1):
        entry[i] = min(entry[i], speed[i], math.sqrt(entry[i + 1] ** 2 + 2.0 * acceleration[i] * length[i]))
    for i in range(n):
        entry[i + 1] = min(entry[i + 1], speed[i], math.sqrt(entry[i] ** 2 + 2.0 * acceleration[i] * length[i]))
        a, first, last = acceleration[i], entry[i], entry[i + 1]
        top = min(speed[i], math.sqrt(a * length[i] + 0.5 * (first * first + last * last)))
        top = max(top, first, last)
        ramps = (top * top - first * first + top * top - last * last) / (2.0 * a)
        seconds[i] = (top - first + top - last) / a + max(0.0, length[i] - ramps) / top
