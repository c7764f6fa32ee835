"""A depth buffer in plain arrays: facets drawn by parallel projection along Z into a grid, the lowest in front.

For the film of the method of 1999, where every step has to be seen on any machine; graphics hardware does the same with
`simulation.gpu.depth_buffer`, and the cut itself hangs on neither.
"""

from __future__ import annotations

import numpy as np

from ...core.progress import NO_PROGRESS, Progress
from ...model.motion import Floats
from ...simulation.field.workpiece import Grid

EMPTY = np.inf
"""Depth of a cell that nothing was drawn over."""


def drawn(quads: Floats, grid: Grid, progress: Progress = NO_PROGRESS) -> Floats:
    """Return the depth buffer (rows, cols), mm, after facets were drawn into an empty one: at each cell's centre the
    lowest height of the facets over it, `EMPTY` where there are none.

    Args:
        quads: (m, 4, 3) corners, one after the other round each facet, mm.
        grid: the frame buffer.

    Raises:
        Cancelled: the job was asked to stop.
    """
    depth = np.full((grid.rows, grid.cols), EMPTY)
    xs, ys = grid.xs(), grid.ys()
    corners = np.asarray(quads, np.float64)
    for number, (a, b, c, d) in enumerate(corners):
        if number % 4096 == 0:
            progress.step(number / len(corners), "Drawing facets")
        for triangle in (np.stack([a, b, c]), np.stack([a, c, d])):
            _draw(triangle, depth, xs, ys)
    return depth


def _draw(triangle: Floats, depth: Floats, xs: Floats, ys: Floats) -> None:
    """Draw one triangle (3, 3): its plane's height wherever a cell's centre is over it."""
    low, high = triangle.min(axis=0), triangle.max(axis=0)
    i0, i1 = np.searchsorted(ys, (low[1], high[1]), side="left")
    j0, j1 = np.searchsorted(xs, (low[0], high[0]), side="left")
    i1, j1 = min(i1 + 1, len(ys)), min(j1 + 1, len(xs))
    (x0, y0, z0), (x1, y1, z1), (x2, y2, z2) = triangle
    area = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)
    if i1 <= i0 or j1 <= j0 or area == 0.0:
        return
    x, y = xs[None, j0:j1], ys[i0:i1, None]
    one = ((x - x0) * (y2 - y0) - (x2 - x0) * (y - y0)) / area
    two = ((x1 - x0) * (y - y0) - (x - x0) * (y1 - y0)) / area
    inside = (one >= -_EDGE) & (two >= -_EDGE) & (one + two <= 1 + _EDGE)
    height = z0 + one * (z1 - z0) + two * (z2 - z0)
    part = depth[i0:i1, j0:j1]
    np.minimum(part, np.where(inside, height, EMPTY), out=part)


_EDGE = 1e-9
"""A centre on an edge is over both its facets."""
