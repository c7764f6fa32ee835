"""Walls that are asked for gouges: where the points lie, and what is told of several gouges in one part."""

import numpy as np
import pytest
import shapely

from app.simulation.field.solid import SolidStock
from app.verify.judgement import SpotKind
from app.verify.wall_probe import wall_points
from tests.surfaces.solids import pocketed_block
from tests.verify.test_solid_gouges import judged

PITCH = 0.7
POCKET = shapely.box(10, 7, 30, 23)
BLOCK = shapely.box(0, 0, 40, 30).difference(POCKET)


def test_points_lie_all_along_the_walls_and_look_into_the_solid() -> None:
    points, inwards = wall_points(SolidStock(pocketed_block()), PITCH)
    assert shapely.distance(BLOCK.boundary, shapely.points(points)) == pytest.approx(0.0, abs=1e-12)
    assert np.hypot(*inwards.T) == pytest.approx(1.0)
    assert shapely.contains(BLOCK, shapely.points(points + 0.01 * inwards)).all()
    assert not shapely.intersects(BLOCK, shapely.points(points - 0.01 * inwards)).any()
    near = shapely.union_all(shapely.points(points)).buffer(PITCH / 4 + 1e-6)
    assert BLOCK.boundary.difference(near).length == pytest.approx(0.0, abs=1e-9)


def beyond(right: float, left: float) -> str:
    """Clears the pocket with a flat tool of 6 mm, and bites so far into its walls at X 30 and X 10."""
    lines = ["G21 G90 G94 G17", "T1 M6", "S1000 M3", "G0 Z5", "X20 Y15", "G1 Z-4 F300"]
    for share in np.linspace(0.2, 1.0, 5).tolist():
        (a, b), (c, d) = (20 - 7 * share, 20 + 7 * share), (15 - 5 * share, 15 + 5 * share)
        lines += [f"X{a:.4f} Y{c:.4f}", f"X{b:.4f}", f"Y{d:.4f}", f"X{a:.4f}", f"Y{c:.4f}"]
    lines += ["X20 Y15", f"X{13 - left} Y12", "X20 Y15", f"X{27 + right} Y18", "X20 Y15"]
    return "\n".join([*lines, "G0 Z5", "M2", ""])


@pytest.mark.parametrize("cells", [128, 512])
def test_each_of_two_gouges_is_as_deep_as_it_is_and_the_deeper_one_is_first(cells: int) -> None:
    judgement = judged(beyond(1.0, 0.4), cells).judgement
    assert judgement is not None
    off = 3.0 - np.sqrt(9.0 - (10.0 / cells) ** 2)  # the cutter is round, and a point is asked every half cell
    spots = [spot for spot in judgement.spots if spot.kind is SpotKind.GOUGE]
    found = np.array([(spot.depth_mm, spot.x, spot.y) for spot in spots])
    assert found[:, :2] == pytest.approx(np.array([(1.0, 31.0), (0.4, 9.6)]), abs=off)
    assert found[:, 2] == pytest.approx(np.array([18.0, 12.0]), abs=0.1)
