"""The medial axis against closed forms, and against the distance field: discs about it fill the region exactly."""

from __future__ import annotations

import math
import time
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from app.core.errors import GeometryError
from app.geometry.distance import DistanceField
from app.geometry.medial_axis import axis as medial_axis_module
from app.geometry.medial_axis.axis import MedialAxis, medial_axes
from app.geometry.outlines import nest, polygon_contour
from app.geometry.primitives import Primitives, pack
from app.model.curves import Arc, Circle, Line, Primitive
from app.model.part import Contour
from tests.part_shapes import bulged

Floats = NDArray[np.float64]
Points = list[tuple[float, float]]

SQUARE: Points = [(0, 0), (10, 0), (10, 10), (0, 10)]
ELL: Points = [(0, 0), (20, 0), (20, 8), (8, 8), (8, 20), (0, 20)]


def ring(x: float, y: float, r: float) -> Contour:
    return Contour((Circle((x, y), r),), True)


def packed(*contours: Contour) -> Primitives:
    return pack(nest(contours))


def axis_of(*contours: Contour) -> MedialAxis:
    (axis,) = medial_axes(packed(*contours))
    return axis


def length_of(axis: MedialAxis) -> float:
    points = axis.discs(np.linspace(0, 1, 1001))[:, :, :2]
    return float(np.hypot(*np.diff(points, axis=1).transpose(2, 0, 1)).sum())


def greatest(axis: MedialAxis) -> float:
    return float(axis.discs(np.linspace(0, 1, 101))[:, :, 2].max())


def fills(primitives: Primitives, samples: int = 400, seed: int = 1) -> None:
    """Compare the roof that stands on the axes with the distance field, at points of the regions, both ways.

    The roof at a point is the greatest radius less the way to the centre. Between samples of an axis both change by no
    more than the way gone, so the roof of the samples lacks at most one step.
    """
    field = DistanceField.of(primitives.rows)
    low, high = primitives.rows[:, :2].min(axis=0) - 1, primitives.rows[:, :2].max(axis=0) + 1
    points = np.random.default_rng(seed).uniform(low, high, (300, 2))
    points = points[field.inside(points)]
    along = [axis.discs(np.linspace(0, 1, samples)) for axis in medial_axes(primitives)]
    step = max(float(np.hypot(*np.diff(each[:, :, :2], axis=1).transpose(2, 0, 1)).max()) for each in along)
    assert step < 0.25
    discs = np.concatenate([each.reshape(-1, 3) for each in along])
    roof = np.array([(discs[:, 2] - np.hypot(*(discs[:, :2] - point).T)).max() for point in points])
    lacking = field.nearest(points)[0] - roof
    assert lacking.min() > -1e-9
    assert lacking.max() < step


def test_square() -> None:
    axis = axis_of(polygon_contour(SQUARE))
    assert len(axis.pieces) == 4
    assert greatest(axis) == pytest.approx(5, abs=1e-12)
    assert length_of(axis) == pytest.approx(4 * math.sqrt(50), abs=1e-5)


def test_triangle_of_sides_5_12_13() -> None:
    axis = axis_of(polygon_contour([(0, 0), (12, 0), (0, 5)]))
    assert greatest(axis) == pytest.approx(2, abs=1e-12)
    corners = math.hypot(2, 2) + math.hypot(10, 2) + math.hypot(2, 3)
    assert length_of(axis) == pytest.approx(corners, abs=1e-5)


def test_letter_l() -> None:
    assert greatest(axis_of(polygon_contour(ELL))) == pytest.approx(8 * (2 - math.sqrt(2)), abs=1e-12)


def test_concentric_ring_is_a_circle() -> None:
    axis = axis_of(ring(3, -2, 5), ring(3, -2, 3))
    discs = axis.discs(np.linspace(0, 1, 51)).reshape(-1, 3)
    assert np.abs(discs[:, 2] - 1).max() < 1e-12
    assert np.abs(np.hypot(discs[:, 0] - 3, discs[:, 1] + 2) - 4).max() < 1e-12
    assert length_of(axis) == pytest.approx(8 * math.pi, abs=1e-4)


def test_eccentric_ring_is_an_ellipse() -> None:
    axis = axis_of(ring(0, 0, 5), ring(1, 0, 2))
    x, y, r = axis.discs(np.linspace(0, 1, 51)).reshape(-1, 3).T
    assert np.abs(np.hypot(x, y) + np.hypot(x - 1, y) - 7).max() < 1e-12
    assert np.abs(5 - np.hypot(x, y) - r).max() < 1e-12
    assert length_of(axis) == pytest.approx(21.8784, abs=1e-3)


def test_a_circle_has_its_centre_and_no_way() -> None:
    assert len(axis_of(ring(0, 0, 4)).pieces) == 0


def test_a_vertex_and_a_line_are_a_parabola() -> None:
    axis = axis_of(polygon_contour(ELL))
    discs = axis.discs(np.linspace(0, 1, 21))
    n = len(axis.rows)
    by_vertex = [k for k, piece in enumerate(axis.pieces) if piece[1] >= n]
    assert by_vertex
    for k in by_vertex:
        assert np.abs(np.hypot(discs[k, :, 0] - 8, discs[k, :, 1] - 8) - discs[k, :, 2]).max() < 1e-12


def slot() -> Contour:
    sides: list[Primitive] = [
        Line((0, 0), (10, 0)),
        Arc((10, 0), (10, 4), (10, 2), True),
        Line((10, 4), (0, 4)),
        Arc((0, 4), (0, 0), (0, 2), True),
    ]
    return Contour(tuple(sides), True)


def test_slot_is_its_middle_line() -> None:
    axis = axis_of(slot())
    discs = axis.discs(np.linspace(0, 1, 11)).reshape(-1, 3)
    assert np.abs(discs[:, 1] - 2).max() < 1e-12
    assert np.abs(discs[:, 2] - 2).max() < 1e-12
    assert length_of(axis) == pytest.approx(10, abs=1e-9)


@pytest.mark.parametrize("scale", [0.01, 1, 1000])
def test_scaled_and_moved_it_is_the_same(scale: float) -> None:
    plain, moved = (
        axis_of(polygon_contour(ELL)),
        axis_of(polygon_contour([(scale * x + 1e4, scale * y - 1e4) for x, y in ELL])),
    )
    assert length_of(moved) == pytest.approx(scale * length_of(plain), rel=1e-5)
    assert greatest(moved) == pytest.approx(scale * greatest(plain), rel=1e-6)


def star(seed: int, count: int) -> Contour:
    rng = np.random.default_rng(seed)
    angle, r = np.arange(count) * math.tau / count, rng.uniform(3, 10, count)
    return polygon_contour([(float(p * math.cos(a)), float(p * math.sin(a))) for a, p in zip(angle, r, strict=True)])


@pytest.mark.parametrize("seed", range(6))
def test_discs_fill_a_star(seed: int) -> None:
    fills(packed(star(seed, 5 + 3 * seed)))


def islands(seed: int) -> list[Contour]:
    rng = np.random.default_rng(seed)
    found = [polygon_contour([(0, 0), (40, 0), (40, 40), (0, 40)])]
    for cell in rng.permutation(16)[: int(rng.integers(1, 16))].tolist():
        x, y = 5 + 10 * (cell % 4), 5 + 10 * (cell // 4)
        r = float(rng.integers(1, 5))
        square = polygon_contour([(x - r, y - r), (x + r, y - r), (x + r, y + r), (x - r, y + r)])
        found.append(ring(x, y, r) if rng.random() < 0.5 else square)
    return found


@pytest.mark.parametrize("seed", range(4))
def test_discs_fill_a_square_round_islands_on_a_grid(seed: int) -> None:
    fills(packed(*islands(seed)))


@pytest.mark.exhaustive
@pytest.mark.parametrize("seed", range(100, 160))
def test_discs_fill_many_figures(seed: int) -> None:
    fills(packed(*islands(seed)))
    fills(packed(star(seed, 5 + seed % 60)))


def test_islands_that_touch_a_wall_or_one_another() -> None:
    frame = polygon_contour([(0, 0), (20, 0), (20, 20), (0, 20)])
    fills(packed(frame, ring(3, 10, 3), ring(9, 10, 3)))


def test_each_region_has_its_own() -> None:
    first, second = medial_axes(packed(polygon_contour(SQUARE), ring(30, 0, 5), ring(30, 0, 3)))
    assert sorted([greatest(first), greatest(second)]) == pytest.approx([1, 5])


def test_one_that_lacks_a_piece_is_not_handed_out() -> None:
    """The areas of the cells tell: a boundary that crosses itself has none that add up."""
    bow = polygon_contour([(0, 0), (10, 10), (10, 0), (0, 12)])
    rows = pack(nest([polygon_contour(SQUARE)])).rows.copy()
    rows[:, :4] = np.array([[*a.start, *a.end] for a in bow.primitives])
    crossed = Primitives(rows, np.array([3, 0, 1, 2]), np.ones(4, np.int64))
    with pytest.raises(GeometryError, match="not proven right near"):
        medial_axes(crossed)


def test_an_axis_without_one_piece_has_less_area() -> None:
    """What the proof by areas stands on: no piece of a cell is too small to be missed."""
    area = medial_axis_module.cells_area
    axis = axis_of(polygon_contour(SQUARE))
    assert len(axis.pieces) == 4
    assert area(axis) == pytest.approx(50, abs=1e-9)  # each piece from one of its two sides
    fewer = MedialAxis(axis.region, axis.rows, axis.angles, axis.pieces[1:].copy(), axis.middle)
    assert area(fewer) < area(axis) - 1


def test_an_island_between_two_walls_that_are_the_same_from_end_to_end() -> None:
    fills(packed(slot(), ring(3, 2, 0.5)))


def rounded(width: float, height: float, short: float, angle: float) -> Contour:
    """A rectangle, turned by an angle, whose corners are rounded but for so much of half its width."""
    r, bulge = width / 2 - short, math.tan(math.pi / 8)
    x, y, c, s = width / 2, height / 2, math.cos(angle), math.sin(angle)
    quarter = [(x - r, -y, bulge), (x, r - y, 0.0), (x, y - r, bulge), (x - r, y, 0.0)]
    points = quarter + [(-u, -v, b) for u, v, b in quarter]
    return bulged([(c * u - s * v, s * u + c * v, b) for u, v, b in points])


@pytest.mark.parametrize("width", [5.0, 6.35, 10.0])
@pytest.mark.parametrize("angle", [0.3, 1.0])
@pytest.mark.parametrize("short", [1e-4, 1e-5])
def test_a_slot_with_a_trace_of_a_straight_end_has_its_axis(width: float, angle: float, short: float) -> None:
    """Rows that go on smoothly are rounded, and so apart by less than anybody sees: nothing slips through between."""
    axis = axis_of(rounded(width, 20.0, short, angle))
    assert greatest(axis) == pytest.approx(width / 2, abs=1e-6)


def test_a_letter_whose_last_pieces_are_tiny_is_added_up_in_no_time() -> None:
    """Against what waited alone the last digits of tiny pieces never agreed: they were halved millions of times."""
    rows = np.load(Path(__file__).parents[1] / "data" / "letter_g.npy")
    starts = [tuple(each) for each in rows[:, :2].tolist()]
    previous = np.array([int(np.argmin(np.hypot(*(rows[:, 2:4] - start).T))) for start in starts])
    begin = time.process_time()
    (axis,) = medial_axes(Primitives(rows, previous, np.ones(len(rows), np.int64)))
    assert len(axis.pieces) > 100
    assert time.process_time() - begin < 2.0


def test_regions_that_are_alike_share_their_axis_and_others_do_not() -> None:
    """A square, the same elsewhere, and one whose corner is off by ten nanometres: axes are where each belongs."""
    off = [(50.0, 7.0), (60.0, 7.0), (60.0, 17.00001), (50.0, 17.0)]
    squares = [SQUARE, [(x + 20.1, y - 3.3) for x, y in SQUARE], off]
    primitives = packed(*map(polygon_contour, squares))
    first, second, third = medial_axes(primitives)
    assert first.pieces is second.pieces and third.pieces is not first.pieces
    for axis in (first, second, third):
        rows = primitives.rows[primitives.region == axis.region]
        discs = axis.discs(np.linspace(0.0, 1.0, 9)).reshape(-1, 3)
        assert np.allclose(DistanceField.of(rows).nearest(discs[:, :2])[0], discs[:, 2], atol=1e-9)
