"""Compiled inner loop of the arc check: how far a written motion leaves its stretch of a meant arc, both swept in
step.
"""

from __future__ import annotations

import math

from ...core.jit import kernel

SAMPLES = 8


@kernel("void(float64[:, ::1], float64[:, ::1], float64[:, ::1], float64[:, ::1], float64[::1])")
def in_step(written, ends, meant, span, distance):
    """Write an upper bound of the distance between each written motion and its stretch of a meant arc, in the plane.

    The distance vector is sampled; between two samples it leaves their chord by at most h^2 / 8 times its second
    derivative. That is at most sweep^2 times the distance itself, which goes to the other side of the inequality, and
    what the difference of centres, of sweeps and of radii adds.

    Args:
        written, meant: (m, 6) centre x and y, radius at the start and at the end, angle of the start, sweep; radians.
        ends: (m, 4) start and end of the written motion; it is straight where the written sweep is 0.
        span: (m, 2) which fractions of the meant arc it stands for.
        distance: (m,) the answer.
    """
    for i in range(len(written)):
        first, size = span[i, 0], span[i, 1] - span[i, 0]
        sweep, own = meant[i, 5] * size, written[i, 5]
        largest = 0.0
        for k in range(SAMPLES + 1):
            t = k / SAMPLES
            if own == 0.0:
                x, y = ends[i, 0] + (ends[i, 2] - ends[i, 0]) * t, ends[i, 1] + (ends[i, 3] - ends[i, 1]) * t
            else:
                radius, angle = written[i, 2] + (written[i, 3] - written[i, 2]) * t, written[i, 4] + own * t
                x, y = written[i, 0] + radius * math.cos(angle), written[i, 1] + radius * math.sin(angle)
            f = first + size * t
            radius, angle = meant[i, 2] + (meant[i, 3] - meant[i, 2]) * f, meant[i, 4] + meant[i, 5] * f
            x, y = x - meant[i, 0] - radius * math.cos(angle), y - meant[i, 1] - radius * math.sin(angle)
            largest = max(largest, math.sqrt(x * x + y * y))
        radius, spiral = max(meant[i, 2], meant[i, 3]), 2.0 * abs(sweep * size * (meant[i, 3] - meant[i, 2]))
        # second derivative of a spiral: sweep² radius, and 2 sweep times how fast the radius grows
        bend = sweep * sweep * radius + spiral
        if own != 0.0:
            # both turn alike but for the difference of centres and sweeps, which is all that bends their difference
            shift = math.hypot(written[i, 0] - meant[i, 0], written[i, 1] - meant[i, 1])
            spiral += 2.0 * abs(own * (written[i, 3] - written[i, 2]))
            bend = own * own * shift + abs(own * own - sweep * sweep) * radius + spiral
        distance[i] = (largest + bend / (8.0 * SAMPLES * SAMPLES)) / max(
            0.1, 1.0 - own * own / (8.0 * SAMPLES * SAMPLES)
        )
