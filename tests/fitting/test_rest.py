"""Free curves (step 407) come out without the slight bends that arcs of best fit leave, and as near to their points."""

import math

import numpy as np
import pytest

from app.fitting.corner_smoothing.rest import without_bends
from app.fitting.corner_smoothing.smooth import CornerSmoothingOptions, moved, smooth
from app.fitting.corner_smoothing.smoothed_path import PieceKind, SmoothedPath
from app.geometry.outlines import polygon_contour
from app.model.curves import Arc, Line
from app.model.part import Contour
from app.raster.frame import BitmapFrame
from tests.fitting.paths import sampled, traces
from tests.fitting.test_smooth import along, joins
from tests.plain_distance import distance

FRAME = BitmapFrame(400, 400, 0.25)
TOLERANCE = 0.75 * FRAME.pitch


def curve(radius: float, waves: dict[int, float]) -> Contour:
    """A closed curve round (50, 50) mm whose radius swings."""
    t = np.linspace(0, math.tau, 4000, endpoint=False)
    r = radius + sum(height * np.sin(count * t) for count, height in waves.items())
    return polygon_contour(list(zip((50 + r * np.cos(t)).tolist(), (50 + r * np.sin(t)).tolist(), strict=True)))


CURVES = {
    "bean": curve(30, {2: 8, 3: 3}),
    "egg": curve(35, {1: 4, 2: 5}),
    "three": curve(34, {3: 5}),
    "five": curve(34, {5: 2.5}),
}


def bends(path: SmoothedPath) -> np.ndarray:
    """By how much the path turns where each row begins, degrees."""

    def direction(at: int) -> np.ndarray:
        rows = path.rows
        x, y = rows[:, at], rows[:, at + 1]
        lines = rows[:, 2:4] - rows[:, :2]
        arcs = np.column_stack((-rows[:, 7] * (y - rows[:, 5]), rows[:, 7] * (x - rows[:, 4])))
        ahead = np.where(rows[:, 7:] == 0, lines, arcs)
        return np.asarray(np.arctan2(ahead[:, 1], ahead[:, 0]))

    turn = (direction(0) - np.roll(direction(2), 1) + math.pi) % math.tau - math.pi
    return np.asarray(np.degrees(np.abs(turn)))


@pytest.mark.parametrize("name", CURVES)
def test_a_free_curve_is_smooth_where_its_arcs_meet(name: str) -> None:
    path = smooth(traces(FRAME, [CURVES[name]])[0], CornerSmoothingOptions(TOLERANCE))
    free = path.kinds == PieceKind.SPLINE
    assert joins(path)
    assert free.mean() > 0.4
    both = free & np.roll(free, 1)
    assert bends(path)[both].max() < 1.0, "bends below one degree stay"
    assert path.tangent[both].mean() > 0.9
    assert bends(path)[path.tangent & both].max() < 1e-6
    assert path.deviation <= 2 * TOLERANCE
    assert distance(along(path, 0.05), [CURVES[name]]).max() < 2 * TOLERANCE + FRAME.pitch / 2


def test_hardly_a_bend_is_left() -> None:
    left = [
        bends(smooth(traces(FRAME, [curve])[0], CornerSmoothingOptions(TOLERANCE))) > 1 for curve in CURVES.values()
    ]
    assert sum(each.sum() for each in left) <= sum(len(each) for each in left) / 6


def test_a_fine_free_curve_comes_back_finely() -> None:
    points = sampled(CURVES["three"], 0.05)
    path = smooth(points, CornerSmoothingOptions(0.02))
    assert bends(path).max() < 1.0
    assert distance(along(path, 0.02), [CURVES["three"]]).max() < 0.04


def test_a_free_curve_moved_out_stays_smooth() -> None:
    points = traces(FRAME, [CURVES["egg"]])[0]
    path = smooth(points, CornerSmoothingOptions(TOLERANCE))
    assert path.tangent.mean() > 0.6
    out = moved(path, points, np.full(len(path.rows), 0.3), TOLERANCE)
    assert joins(out)
    assert bends(out)[path.tangent].max() < 0.5, (
        "next to a slight bend, which moves along its arcs, ends are no circle's own"
    )
    assert distance(along(out, 0.05), [CURVES["egg"]]).max() < 0.3 + 2 * TOLERANCE


def test_bends_that_no_curve_near_enough_avoids_stay() -> None:
    points = traces(FRAME, [CURVES["bean"]])[0]
    path = smooth(points, CornerSmoothingOptions(TOLERANCE))
    rounds = np.concatenate([points] * 3)
    assert without_bends(path, rounds, 0.0) is path
    assert without_bends(path, rounds, math.inf).kinds.tolist() != path.kinds.tolist()


def test_arcs_that_turn_opposite_ways_touch_where_they_nearly_do() -> None:
    """A lobe on fillets, as tools leave it: its arcs stay circles, and no corner stays between them."""
    lobe = Contour(
        (
            Line((10, 10), (70, 10)),
            Line((70, 10), (70, 38)),
            Arc((70, 38), (78, 46), (78, 38), ccw=False),
            Arc((78, 46), (78, 60), (78, 53)),
            Arc((78, 60), (70, 68), (78, 68), ccw=False),
            Line((70, 68), (70, 90)),
            Line((70, 90), (10, 90)),
            Line((10, 90), (10, 10)),
        )
    )
    for tolerance, points in ((TOLERANCE, traces(FRAME, [lobe])[0]), (0.01, sampled(lobe, 0.1))):
        path = smooth(points, CornerSmoothingOptions(tolerance))
        arc = path.kinds == PieceKind.ARC
        assert arc.sum() == 3
        assert not np.any(path.kinds == PieceKind.SPLINE)
        assert path.tangent[arc & np.roll(arc, 1)].all()
        assert bends(path)[arc & np.roll(arc, 1)].max() < 0.5
