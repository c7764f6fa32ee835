"""What paths leave, against areas known by hand and against points measured one by one."""

from __future__ import annotations

import threading

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.core.errors import Cancelled
from app.core.progress import Progress
from app.geometry.distance import DistanceField
from app.geometry.offset.offset import OffsetLevel, offset_levels
from app.geometry.outlines import nest
from app.geometry.overlay.overlay import without_crossings
from app.geometry.primitives import Rows, pack
from app.model.part import Contour
from app.operations.pocket.paths import pocket_distances, without_empty
from tests import plain_distance
from tests.examples import examples
from tests.part_shapes import circle, random_part, square
from tests.toolpath.uncut_squares import UncutSquares, uncut


def ringed(contours: list[Contour], first: float, step: float) -> tuple[DistanceField, tuple[OffsetLevel, ...]]:
    primitives = pack(nest(without_crossings(contours).contours))
    field = DistanceField.of(primitives.rows)
    return field, without_empty(offset_levels(primitives, pocket_distances(first, step, field), frame=True))


def paths(levels: tuple[OffsetLevel, ...], radius: float) -> list[tuple[Rows, float]]:
    return [(ring.rows, radius) for level in levels for ring in level.rings]


def area(left: UncutSquares) -> float:
    return float((4 * left.halves[left.sure] ** 2).sum())


def holds(left: UncutSquares, points: np.ndarray) -> np.ndarray:
    away = np.abs(points[:, None] - left.centres[None]).max(axis=2)
    held: np.ndarray = (away <= left.halves + 1e-9).any(axis=1)
    return held


def test_the_middle_of_a_disc_is_left_and_its_size_is_right() -> None:
    field, levels = ringed([circle(10.0)], 1.0, 20.0)
    left = uncut(field, levels[0], 1.0, paths(levels[:1], 1.0))
    assert area(left) == pytest.approx(np.pi * 64, rel=0.02)
    assert not left.thicker(8.1).centres.size and left.thicker(6.5).centres.size
    inside = np.hypot(*left.centres[left.sure].T)
    assert inside.max() <= 8.0


def test_nothing_is_left_of_a_square_but_edges_and_nothing_is_sure() -> None:
    field, levels = ringed([square(20)], 1.0, 0.9)
    left = uncut(field, levels[0], 1.0, paths(levels, 1.0))
    assert not left.sure.any()
    everything = uncut(field, levels[0], 1.0, [])
    assert area(everything) == pytest.approx(400 - (4 - np.pi), rel=0.01)


def test_a_smaller_tool_is_told_the_corners_alone() -> None:
    """Of a square cleared to its walls by R 2, a tool of radius 0.5 finds the corners: (4 - pi)(R² - r²)."""
    field, levels = ringed([square(20)], 2.0, 1.0)
    (frame,) = offset_levels(pack(nest([square(20)])), [0.5], frame=True)
    left = uncut(field, frame, 0.5, paths(levels, 2.0)).thicker(1e-6)
    assert area(left) == pytest.approx((4 - np.pi) * (4 - 0.25), rel=0.1)


def test_without_room_for_the_tool_there_is_nothing_to_cut() -> None:
    assert not uncut(ringed([square(20)], 1.0, 1.0)[0], OffsetLevel(12.0, ()), 1.0, []).halves.size


def test_it_can_be_stopped() -> None:
    field, levels = ringed([square(20)], 1.0, 3.0)
    stop = threading.Event()
    stop.set()
    with pytest.raises(Cancelled):
        uncut(field, levels[0], 1.0, paths(levels, 1.0), Progress(cancelled=stop))


@settings(max_examples=examples(15), deadline=None)
@given(st.integers(0, 10**6))
def test_every_point_that_is_left_lies_in_a_square(seed: int) -> None:
    contours, _ = random_part(seed)
    rng = np.random.default_rng(seed)
    outermost, radius = float(rng.uniform(1.0, 2.5)), float(rng.uniform(0.6, 1.0))
    field, levels = ringed(contours, outermost, float(rng.uniform(1.0, 2.4)) * radius)
    if not levels:
        return
    left = uncut(field, levels[0], radius, paths(levels, radius))
    box = field.boxes
    points = rng.uniform(box[:, :2].min(axis=0), box[:, 2:].max(axis=0), (3000, 2))
    centre = (plain_distance.distance(points, contours) >= outermost) & plain_distance.inside(points, contours)
    rings = DistanceField.of(np.concatenate([rows for rows, _ in paths(levels, radius)]))
    alone = points[centre & (rings.nearest(points)[0] > radius)]
    assert holds(left, alone).all() if len(left.halves) else not len(alone)
    sure = left.centres[left.sure]
    assert np.all(rings.nearest(sure)[0] > radius) if len(sure) else True
