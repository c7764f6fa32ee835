"""The bitmap fill and the exact offset agree, and a lost or wrong ring does not go unseen."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.geometry.distance import DistanceField
from app.geometry.offset.offset import OffsetLevel, offset_levels
from app.geometry.outlines import nest
from app.geometry.overlay.overlay import without_crossings
from app.geometry.primitives import pack
from app.model.part import Contour
from app.toolpath.bitmap_check import BitmapCheck, check_on_bitmap
from tests.part_shapes import circle, fig2, random_part, square


def field_and_level(
    contours: list[Contour], distance: float, crossing: bool = False
) -> tuple[DistanceField, OffsetLevel]:
    primitives = pack(nest(without_crossings(contours).contours if crossing else contours))
    return DistanceField.of(primitives.rows), offset_levels(primitives, [distance])[0]


def checked(contours: list[Contour], distance: float, crossing: bool = False) -> BitmapCheck:
    return check_on_bitmap(*field_and_level(contours, distance, crossing))


def test_fig2_agrees_in_every_pixel_and_in_area() -> None:
    check = checked(fig2(), 1.5)
    assert check.wrong == 0 and check.findings() == []
    assert check.bitmap_area == pytest.approx(check.exact_area, rel=2e-3)


@pytest.mark.parametrize("seed", range(20))
def test_random_parts_agree(seed: int) -> None:
    contours, crossing = random_part(seed)
    assert checked(contours, 0.8, crossing).wrong == 0


def test_a_lost_ring_is_seen_and_located() -> None:
    field, level = field_and_level([square(60), circle(5, 30, 30)], 1.5)
    lost = replace(level, rings=level.rings[:1])
    check = check_on_bitmap(field, lost)
    assert check.wrong > 100
    (finding,) = check.findings()
    assert finding.counts and (30 - finding.x) ** 2 + (30 - finding.y) ** 2 < 6.6**2


def test_a_ring_at_the_wrong_distance_is_seen() -> None:
    field, level = field_and_level(fig2(), 1.5)
    assert check_on_bitmap(field, replace(level, distance=2.4)).wrong > 100


def test_the_observer_sees_the_numbered_steps() -> None:
    steps = []
    field, level = field_and_level(fig2(), 1.5)
    check_on_bitmap(field, level, lambda number, plane: steps.append((number, plane.shape)))
    assert [number for number, _ in steps] == [201, 202, 203, 206, 208, 130]
    assert {shape for _, shape in steps} == {(400, 400)}
