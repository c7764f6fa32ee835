"""One stroke: every ring once, as few strokes as there are connected areas, never nearer to a wall than allowed."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.core import tolerances
from app.geometry.distance import DistanceField
from app.geometry.offset.offset import OffsetLevel, offset_levels
from app.geometry.outlines import nest, polygon_contour
from app.geometry.overlay.overlay import without_crossings
from app.geometry.primitives import lengths, pack, points_at, signed_area
from app.model.moves import Purpose
from app.model.operation import Direction
from app.model.part import Contour
from app.operations.pocket.paths import pocket_distances, without_empty
from app.toolpath.build import Stroke, started_at
from app.toolpath.linking.link import LinkOptions, link
from tests import plain_distance
from tests.examples import examples
from tests.part_shapes import circle, fig2, random_part, square


def pocket(
    contours: list[Contour],
    outermost: float,
    step: float,
    direction: Direction = Direction.CLIMB,
    crossing: bool = False,
) -> tuple[tuple[OffsetLevel, ...], tuple[Stroke, ...]]:
    primitives = pack(nest(without_crossings(contours).contours if crossing else contours))
    field = DistanceField.of(primitives.rows)
    distances = pocket_distances(outermost, step, field)
    levels = without_empty(offset_levels(primitives, distances))
    return levels, link(levels, field, LinkOptions(direction))


def areas_of_tool_centre(levels: tuple[OffsetLevel, ...]) -> int:
    """Connected areas = rings of the outermost level that turn left."""
    return sum(ring.area > 0 for ring in levels[0].rings) if levels else 0


def check(levels: tuple[OffsetLevel, ...], strokes: tuple[Stroke, ...], contours: list[Contour]) -> None:
    assert len(strokes) == areas_of_tool_centre(levels)
    cut = sum(float(lengths(s.rows[s.purpose == Purpose.POCKET]).sum()) for s in strokes)
    rings = sum(float(lengths(ring.rows).sum()) for level in levels for ring in level.rings)
    assert cut == pytest.approx(rings, abs=1e-6 * max(rings, 1))
    for stroke in strokes:
        assert np.array_equal(stroke.rows[1:, :2], stroke.rows[:-1, 2:4])
        arcs = stroke.rows[stroke.rows[:, 7] != 0]
        for x, y in ((0, 1), (2, 3)):
            assert np.allclose(np.hypot(arcs[:, x] - arcs[:, 4], arcs[:, y] - arcs[:, 5]), arcs[:, 6], atol=1e-6)
        for fraction in np.linspace(0, 1, 9):
            points = points_at(stroke.rows, np.full(len(stroke.rows), fraction))
            assert plain_distance.distance(points, contours).min() >= levels[0].distance - tolerances.LEVEL


def test_fig2_takes_two_strokes_for_two_regions() -> None:
    levels, strokes = pocket(fig2(), 4.5, 3.0)
    check(levels, strokes, fig2())
    assert len(strokes) == 2


def test_rings_round_many_islands_are_one_stroke() -> None:
    contours = [square(60), *(circle(3, 12 + 12 * i, 12 + 12 * j) for i in range(4) for j in range(4))]
    levels, strokes = pocket(contours, 1.5, 1.0)
    check(levels, strokes, contours)
    assert len(strokes) == 1 and len(levels[0].rings) == 17


def test_a_narrow_neck_makes_two_strokes() -> None:
    right, left = (
        [(20, 0), (20, 9), (30, 9), (30, 0), (50, 0)],
        [(50, 20), (30, 20), (30, 11), (20, 11), (20, 20), (0, 20)],
    )
    bone = [polygon_contour([(0, 0), *right, *left])]
    levels, strokes = pocket(bone, 2.0, 1.5)
    check(levels, strokes, bone)
    assert len(strokes) == 2


@settings(max_examples=examples(25), deadline=None)
@given(st.integers(0, 10**6))
def test_random_parts(seed: int) -> None:
    contours, crossing = random_part(seed)
    rng = np.random.default_rng(seed)
    levels, strokes = pocket(contours, float(rng.uniform(0.5, 3)), float(rng.uniform(0.4, 2)), crossing=crossing)
    check(levels, strokes, contours)


def test_links_are_short() -> None:
    levels, strokes = pocket(fig2(), 1.5, 1.0)
    linked = sum(float(lengths(s.rows[s.purpose == Purpose.LINK]).sum()) for s in strokes)
    rings = sum(len(level.rings) for level in levels)
    assert linked <= 2 * rings * 1.0 + 1e-9


@pytest.mark.parametrize(("direction", "sense"), [(Direction.CLIMB, 1), (Direction.CONVENTIONAL, -1)])
def test_a_round_pocket_is_climbed_counter_clockwise_from_inside_out(direction: Direction, sense: int) -> None:
    levels, (stroke,) = pocket([circle(20)], 4.0, 3.0, direction)
    turns = stroke.rows[(stroke.rows[:, 7] != 0) & (stroke.purpose == Purpose.POCKET)]
    assert set(turns[:, 7]) == {float(sense)}
    radii = turns[:, 6]
    assert np.all(np.diff(radii) >= -1e-9) and radii[-1] == pytest.approx(levels[0].rings[0].rows[0, 6])


def test_the_frame_round_an_island_is_climbed_clockwise() -> None:
    _, (stroke,) = pocket([square(60), circle(5, 30, 30)], 3.0, 2.0)
    island = stroke.rows[(stroke.rows[:, 7] != 0) & np.isclose(stroke.rows[:, 6], 8.0)]
    assert len(island) and np.all(island[:, 7] == -1)


def test_a_closed_path_started_elsewhere_is_the_same_path() -> None:
    rows = pocket([square(20), circle(2, 10, 10)], 2.0, 1.0)[0][0].rings[0].rows
    for index, fraction in ((0, 0.5), (len(rows) - 1, 0.25), (2, 0.0), (1, 1.0)):
        moved = started_at(rows, index, fraction)
        assert signed_area(moved) == pytest.approx(signed_area(rows)) and np.allclose(
            moved[0, :2], moved[-1, 2:4], atol=1e-12
        )
