"""A second opinion on what is left: exact distances at many points against the polygons' answer."""

from __future__ import annotations

import numpy as np
import shapely

from app.model.moves import MoveKind
from app.toolpath.coverage.areas import lines, move_rows, region_shapes
from app.usecases.making.make import MakeResult

DOUBT = 0.01
"""mm; points nearer than this to the edge of a cut or of a piece that is left decide nothing."""


def assert_left_is_true(made: MakeResult, count: int = 400) -> int:
    """Assert that points lie in a piece that is left exactly when no move at the floor covers them; return how many
    decided.
    """
    moves, rng = made.program.moves, np.random.default_rng(1)
    area = shapely.union_all(region_shapes(made.program.regions, 1e-3))
    shapely.prepare(area)
    x0, y0, x1, y1 = area.bounds
    points = rng.uniform((x0, y0), (x1, y1), (count, 2))
    spots = np.array([(place.x, place.y) for place in made.coverage.places[:200]]).reshape(-1, 2)
    points = np.concatenate([points[shapely.contains_xy(area, points)], spots])
    floor = (np.maximum(moves.start[:, 2], moves.end[:, 2]) <= -made.coverage.floor_mm + 1e-9) & (
        moves.kind != MoveKind.RAPID
    )
    uncut = np.full(len(points), np.inf)
    for number in np.unique(moves.tool[floor]):
        near = shapely.STRtree(lines(move_rows(moves)[floor & (moves.tool == number)], 1e-4))
        (which, _), distance = near.query_nearest(shapely.points(points), return_distance=True)
        np.minimum.at(uncut, which, distance - made.job.tool(int(number)).radius)
    left = shapely.union_all([shapely.Polygon(place.outline, place.holes) for place in made.coverage.places])
    from_rim = (
        shapely.distance(shapely.boundary(left), shapely.points(points))
        if not left.is_empty
        else np.full(len(points), np.inf)
    )
    sure = (np.abs(uncut) > DOUBT) & (from_rim > DOUBT)
    assert np.array_equal(shapely.contains_xy(left, points)[sure], uncut[sure] > 0), points[sure][
        shapely.contains_xy(left, points)[sure] != (uncut[sure] > 0)
    ]
    return int(np.sum(sure))
