"""Smoothing gives back the lines and circles that a path was made of, and stays near its points whatever they are."""

import math

import numpy as np
import pytest
from scipy.spatial import cKDTree

from app.core.errors import ParameterError
from app.fitting.corner_smoothing.smooth import CornerSmoothingOptions, moved, smooth, without
from app.fitting.corner_smoothing.smoothed_path import PieceKind, SmoothedPath
from app.geometry.outlines import polygon_contour
from app.geometry.primitives import R, lengths, points_at, row_curve, turns
from app.model.curves import Arc, Line
from app.model.part import Contour
from app.raster.frame import BitmapFrame
from tests.fitting.paths import sampled, traces
from tests.part_shapes import circle, fig2
from tests.plain_distance import distance
from tests.raster.shapes import KINDS

PITCH = 0.25
FRAME = BitmapFrame(400, 400, PITCH)
ON_PIXELS = CornerSmoothingOptions(0.75 * PITCH, 20.0, PITCH)


def plate() -> Contour:
    """A plate with three fillets and a wall aslant, all tangent but for two corners."""
    return Contour(
        (
            Line((10, 0), (90, 0)),
            Arc((90, 0), (100, 10), (90, 10)),
            Line((100, 10), (100, 40)),
            Arc((100, 40), (80, 60), (80, 40)),
            Line((80, 60), (30, 60)),
            Line((30, 60), (0, 45)),
            Line((0, 45), (0, 10)),
            Arc((0, 10), (10, 0), (10, 10)),
        )
    )


def contour_of(path: SmoothedPath) -> Contour:
    if len(path.rows) == 1:
        return circle(float(path.rows[0, R]), *path.rows[0, 4:6].tolist())
    return Contour(tuple(row_curve(row) for row in path.rows if np.any(row[:2] != row[2:4])))


def along(path: SmoothedPath, step: float) -> np.ndarray:
    counts = np.maximum(np.ceil(lengths(path.rows) / step), 1).astype(int)
    part = np.concatenate([np.arange(n) / n for n in counts])
    return points_at(np.repeat(path.rows, counts, axis=0), part)


def joins(path: SmoothedPath) -> bool:
    """Whether each row begins where the one before ends."""
    return bool(np.array_equal(path.rows[:, :2], np.roll(path.rows[:, 2:4], 1, axis=0)))


def test_the_trace_of_a_circle_is_one_circle_again() -> None:
    for centre, radius in (((50.0, 50.0), 40.0), ((31.3, 47.7), 12.0), ((61.21, 40.09), 4.3)):
        path = smooth(traces(FRAME, [circle(radius, *centre)])[0], ON_PIXELS)
        assert path.kinds.tolist() == [PieceKind.CIRCLE]
        cx, cy, r = path.rows[0, [4, 5, 6]]
        assert math.dist((cx, cy), centre) < 0.1 * PITCH
        assert abs(r - radius) < 0.1 * PITCH


def test_the_trace_of_an_island_is_corrected_the_other_way() -> None:
    island = traces(FRAME, [circle(45, 50, 50), circle(20, 50.1, 49.8)])[1]
    path = smooth(island, ON_PIXELS)
    assert path.rows[0, 7] == -1
    assert abs(path.rows[0, R] - 20) < 0.1 * PITCH


@pytest.mark.parametrize("angle", [5, 17, 23, 31, 52, 68, 77])
def test_lines_aslant_come_back_to_a_tenth_of_a_pixel(angle: float) -> None:
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    corners = [(50 + 35 * (c * x - s * y), 50 + 35 * (s * x + c * y)) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    path = smooth(traces(FRAME, [polygon_contour(corners)])[0], ON_PIXELS)
    assert path.kinds.tolist() == [PieceKind.LONG_LINE] * 4
    for carrier in path.carriers:
        off = [abs((x - carrier[0]) * carrier[3] - (y - carrier[1]) * carrier[2]) for x, y in corners]
        assert sorted(off)[1] < 0.1 * PITCH, "each line passes two of the corners"


def test_the_known_part_of_the_text_comes_back_from_its_trace() -> None:
    """Walls on pixel edges, arcs and slants anywhere; only the wall at 45 degrees lies where pixels cannot tell."""
    outer, triangle, hole = (smooth(trace, ON_PIXELS) for trace in traces(FRAME, fig2()))
    assert [len(path.rows) for path in (outer, hole)] == [16, 1]
    for path in (outer, triangle, hole):
        assert joins(path)
        straight = path.carriers[path.carriers[:, 4] == 0]
        level = straight[np.abs(straight[:, 2:4]).min(axis=1) < 1e-6]
        assert distance(level[:, :2], fig2()).max(initial=0.0) < 0.1 * PITCH
    arcs = outer.rows[outer.kinds == PieceKind.ARC]
    assert np.allclose(sorted(arcs[:, 4]), [36, 68], atol=0.1 * PITCH)
    assert np.allclose(arcs[:, R], 8, atol=0.1 * PITCH)
    assert np.allclose(hole.rows[0, 4:7], [84, 84, 12], atol=0.1 * PITCH)


@pytest.mark.parametrize("tolerance", [0.01, 0.1])
def test_a_path_between_pixels_comes_back_exactly(tolerance: float) -> None:
    path = smooth(sampled(plate(), 0.3), CornerSmoothingOptions(tolerance, 40.0))
    assert len(path.rows) == 8
    assert joins(path)
    arcs = path.rows[path.kinds == PieceKind.ARC]
    assert sorted(np.round(arcs[:, R], 6).tolist()) == [10, 10, 20], "arcs to 1 um and better"
    assert distance(path.rows[:, :2], [plate()]).max() < 1e-6
    assert int(path.tangent.sum()) == 6
    assert set(path.kinds.tolist()) == {PieceKind.LONG_LINE, PieceKind.SHORT_LINE, PieceKind.ARC}


def test_a_path_with_little_noise_stays_within_it() -> None:
    points = sampled(plate(), 0.2)
    noise = np.random.default_rng(1).uniform(-0.02, 0.02, points.shape)
    path = smooth(points + noise, CornerSmoothingOptions(0.04))
    assert len(path.rows) <= 10
    assert distance(along(path, 0.1), [plate()]).max() < 0.03


@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind != "beyond"])
def test_random_traces_stay_near_their_pixels(kind: str) -> None:
    frame = BitmapFrame(200, 200, 1.0)
    for seed in range(8):
        for trace in traces(frame, KINDS[kind](np.random.default_rng(seed), 190.0))[:4]:
            path = smooth(trace, CornerSmoothingOptions(0.75))
            assert joins(path)
            assert distance(trace, [contour_of(path)]).max() <= path.deviation + 1e-9, "no point is lost"
            assert path.deviation <= 4 * 0.75, "twice the tolerance, and as much again at corners"
            assert cKDTree(trace).query(along(path, 0.1))[0].max() < 6, "nothing is added but mitres"


def test_few_points_stay_as_they_are() -> None:
    for count in (1, 2, 3):
        path = smooth(np.arange(2.0 * count).reshape(-1, 2), CornerSmoothingOptions(0.5))
        assert not path.exact
        assert len(path.rows) == count
        assert joins(path)


def test_points_that_fit_nothing_stay_a_free_curve_through_them() -> None:
    points = np.random.default_rng(4).uniform(0, 10, (40, 2))
    path = smooth(points, CornerSmoothingOptions(0.01))
    assert distance(points, [polygon_contour(path.rows[:, :2].tolist())]).max() < 0.05


def test_moving_keeps_tangents_and_distance() -> None:
    path = smooth(sampled(plate(), 0.3), CornerSmoothingOptions(0.05))
    out = moved(path, sampled(plate(), 0.3), np.full(len(path.rows), 0.5), 0.05)
    assert joins(out)
    assert np.array_equal(out.joined, path.joined)
    assert np.allclose(distance(along(out, 0.5), [plate()]), 0.5, atol=0.1), "mitres at two corners"
    assert sorted(np.round(out.rows[out.kinds == PieceKind.ARC, R], 6).tolist()) == [10.5, 10.5, 20.5]


def test_a_row_left_out_is_replaced_by_its_neighbours_crossing() -> None:
    corners = [(0.0, 0.0), (20.0, 0.0), (21.0, 1.0), (21.0, 20.0), (0.0, 20.0)]
    points = sampled(polygon_contour(corners), 0.1)
    path = smooth(points, CornerSmoothingOptions(0.02))
    short = np.hypot(*(path.rows[:, 2:4] - path.rows[:, :2]).T) < 2
    fewer = without(path, short)
    assert fewer is not None
    out = moved(fewer, points, np.zeros(4), 5.0)
    assert joins(out)
    assert any(np.allclose(row[:2], (21, 0), atol=1e-6) for row in out.rows)
    assert without(path, ~short) is None


def test_a_tolerance_must_be_a_length() -> None:
    with pytest.raises(ParameterError, match="tolerance is 0 mm"):
        CornerSmoothingOptions(0.0)


def test_points_given_again_and_again_change_nothing() -> None:
    points = sampled(plate(), 0.3)
    once, thrice = (smooth(np.repeat(points, count, axis=0), CornerSmoothingOptions(0.05)) for count in (1, 3))
    assert np.array_equal(once.rows, thrice.rows)
    assert np.array_equal(
        np.repeat(points, 3, axis=0)[thrice.ends % (3 * len(points))], points[once.ends % len(points)]
    )


def test_what_fits_nothing_does_not_spoil_the_rest() -> None:
    """A spiral there and back, with two cusps, and a square with a spot of noise."""
    t = np.linspace(0, 6 * math.pi, 3000)
    spiral = np.column_stack(((2 + t) * np.cos(t), (2 + t) * np.sin(t)))
    path = smooth(np.concatenate([spiral, spiral[::-1]]), CornerSmoothingOptions(0.05))
    assert path.exact
    assert len(path.rows) < 100
    corners = sampled(polygon_contour([(0, 0), (40, 0), (40, 40), (0, 40)]), 0.2)
    corners[300:330] += np.random.default_rng(3).uniform(-1, 1, (30, 2))
    path = smooth(corners, CornerSmoothingOptions(0.05))
    assert path.exact
    assert (lengths(path.rows) > 10).sum() >= 4


@pytest.mark.parametrize("waves", [2, 5, 9])
def test_joints_that_are_said_to_be_tangent_are(waves: int) -> None:
    t = np.linspace(0, math.tau, 2000, endpoint=False)
    r = 20 + 2 * np.sin(waves * t)
    path = smooth(np.column_stack((r * np.cos(t), r * np.sin(t))), CornerSmoothingOptions(0.05))
    assert path.tangent.mean() > 0.5
    assert np.degrees(turns(path.rows, np.arange(-1, len(path.rows) - 1))[path.tangent]).max() < 0.1
