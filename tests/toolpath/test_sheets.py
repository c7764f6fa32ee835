"""Areas that operations may be in, against polygons: sides, layers, clamps, copies."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import shapely

from app.geometry.outlines import nest, polygon_contour
from app.geometry.overlay.overlay import without_outlines
from app.model.contour_operation import ContourOperation
from app.model.curve_selectors import on_layers
from app.model.hole_operations import DrillOperation
from app.model.job import Copies, Job
from app.model.operation import CutParameters, Operation, PocketOperation, RestOperation, Side
from app.model.part import Contour, Region
from app.model.tool import Tool
from app.toolpath.coverage.areas import region_shapes
from app.toolpath.drawn_contours import drawn_contours
from app.toolpath.machining_areas import MachiningArea, MachiningAreas
from tests.part_shapes import circle, layered_part, random_part, square

INSIDE, OUTSIDE, ON = (ContourOperation(CutParameters(2), side) for side in Side)


def sheets(layers: dict[str, list[Contour]], *operations: Operation, **changes: object) -> MachiningAreas:
    job = replace(Job(layered_part(layers), operations=operations), **changes)  # type: ignore[arg-type]
    return MachiningAreas(job, drawn_contours(job))


def sheet(layers: dict[str, list[Contour]], operation: Operation, **changes: object) -> MachiningArea:
    found = sheets(layers, operation, **changes).of(operation)
    assert found is not None
    return found


def shape(regions: tuple[Region, ...]) -> shapely.Geometry:
    return shapely.union_all(region_shapes(regions, 1e-4))


def polygon(contours: list[Contour]) -> shapely.Geometry:
    """The even-odd area of contours, by shapely alone."""
    area = shapely.Polygon()
    for contour in contours:
        each = shapely.union_all(region_shapes([Region(1, contour)], 1e-4))
        area = shapely.symmetric_difference(area, each)
    return area


PLATE = [square(60), circle(8, 20, 20), square(10, 40, 40)]
CLAMPS = [square(15, 50, 10), circle(6, 20, 30), square(4, 43, 43), square(10, -5, -5), square(10, 0, 0)]


def test_sides() -> None:
    area = polygon(PLATE)
    assert shapely.symmetric_difference(shape(sheet({"a": PLATE}, INSIDE).regions), area).area < 0.05
    outside = sheet({"a": PLATE}, OUTSIDE)
    frame = shapely.envelope(shape(outside.regions))
    assert frame.bounds == pytest.approx((-12, -12, 72, 72))
    assert shapely.symmetric_difference(shape(outside.regions), shapely.difference(frame, area)).area < 0.05
    assert int(outside.bare.sum()) == 4
    on = sheet({"a": PLATE}, ON)
    assert on.lines == tuple(drawn_contours(Job(layered_part({"a": PLATE}))).closed)
    assert shape(on.regions).area == pytest.approx(84**2)
    assert on.bare.all()


@pytest.mark.parametrize("operation", [INSIDE, OUTSIDE, ON], ids=["inside", "outside", "on"])
def test_clamps_are_taken_out(operation: ContourOperation) -> None:
    """Clamps over a wall, over an island, in a hole, over a corner, and two over one another."""
    held = shapely.union_all([polygon([clamp]) for clamp in CLAMPS])
    free = sheet({"a": PLATE}, operation)
    kept = sheet({"a": PLATE, "k": CLAMPS}, operation, keep_out_layers=("k",))
    wide = shapely.envelope(shape(kept.regions)) if operation is not INSIDE else shape(free.regions)
    whole = (
        shape(free.regions)
        if operation is INSIDE
        else shapely.union(shape(free.regions), wide)
        if operation is ON
        else None
    )
    if whole is None:
        whole = shapely.difference(wide, polygon(PLATE))
    assert shapely.symmetric_difference(shape(kept.regions), shapely.difference(whole, held)).area < 0.1


@pytest.mark.parametrize("seed", range(20))
def test_random_parts_under_random_clamps(seed: int) -> None:
    rng = np.random.default_rng(seed)
    contours, _ = random_part(seed)
    x0, y0, x1, y1 = polygon(contours).bounds
    size = max(x1 - x0, y1 - y0)
    clamps = []
    for _ in range(int(rng.integers(1, 6))):
        x, y = rng.uniform(x0, x1), rng.uniform(y0, y1)
        clamps.append(
            circle(size * rng.uniform(0.03, 0.2), x, y)
            if rng.random() < 0.5
            else square(size * rng.uniform(0.05, 0.3), x, y)
        )
    job = Job(layered_part({"a": contours, "k": clamps}), operations=(INSIDE,), keep_out_layers=("k",))
    made = MachiningAreas(job, drawn_contours(job)).of(INSIDE)
    wanted = shapely.difference(polygon(contours), shapely.union_all([polygon([clamp]) for clamp in clamps]))
    found = shape(made.regions) if made is not None else shapely.Polygon()
    assert shapely.symmetric_difference(found, wanted).area < 1e-4 * size**2


def test_what_follows_a_clamp_is_bare_and_walls_are_not() -> None:
    kept = sheet({"a": [square(60)], "k": [square(10, 20, 20), square(20, 50, 20)]}, INSIDE, keep_out_layers=("k",))
    middle = (kept.primitives.rows[:, :2] + kept.primitives.rows[:, 2:4]) / 2
    outlines = shapely.union_all(
        [shapely.boundary(polygon([each])) for each in (square(10, 20, 20), square(20, 50, 20))]
    )
    on_clamp = shapely.distance(outlines, shapely.points(middle)) < 1e-6
    assert (kept.bare == on_clamp).all()
    assert on_clamp.sum() == 7
    assert kept.follows_bare(kept.primitives.rows).sum() == 7
    assert not sheet({"a": [square(60)]}, INSIDE).follows_bare(kept.primitives.rows).any()


def test_a_clamp_along_a_wall() -> None:
    """An edge that clamp and wall share is kept off and not followed."""
    kept = sheet({"a": [square(60)], "k": [square(10, 0, 20)]}, INSIDE, keep_out_layers=("k",))
    assert shape(kept.regions).area == pytest.approx(3500)
    assert kept.bare.sum() == 3


def test_a_region_wholly_under_a_clamp_is_none() -> None:
    layers = {"a": [square(20)], "k": [square(40, -10, -10)]}
    assert sheets(layers, INSIDE, keep_out_layers=("k",)).of(INSIDE) is None
    assert sheets(layers, INSIDE, keep_out_layers=("k",)).areas()[0].regions == ()


def test_operations_machine_their_own_layers() -> None:
    layers = {"a": [square(60)], "b": [circle(5, 20, 20)]}
    inner, outer = (
        PocketOperation(CutParameters(1, curves=on_layers(("b",)))),
        ContourOperation(CutParameters(2, curves=on_layers(("a",))), Side.OUTSIDE),
    )
    made = sheets(layers, inner, outer, RestOperation(CutParameters(2)), INSIDE)
    small, beyond, rest, walls = made.areas()
    assert shape(small.regions).area == pytest.approx(np.pi * 25, rel=1e-4)
    assert (small.whole, beyond.whole, rest.whole, walls.whole) == (True, False, True, False)
    assert shape(rest.regions).area == pytest.approx(3600 - np.pi * 25, rel=1e-4)
    assert rest.regions is walls.regions
    assert len(beyond.bare) == 1
    off = replace(inner, cut=replace(inner.cut, enabled=False))
    assert sheets(layers, off).areas()[0].regions == ()


def test_copies() -> None:
    made = sheet({"a": PLATE}, INSIDE, copies=Copies(3, 2, 70.0, -80.0))
    assert shape(made.regions).area == pytest.approx(6 * polygon(PLATE).area, rel=1e-6)
    assert shape(made.regions).bounds == pytest.approx((0, -80, 200, 60))


def test_copies_that_lie_over_one_another_count_even_odd() -> None:
    made = sheet({"a": [square(20)]}, INSIDE, copies=Copies(2, 1, 15.0))
    assert shape(made.regions).area == pytest.approx(2 * 20 * 15)


def test_a_drill_stays_in_its_circles() -> None:
    operation = DrillOperation(CutParameters(3))
    tools = (Tool(1, 6.0), Tool(2, 3.0), Tool(3, 5.08))
    layers = {"a": [square(60), circle(2.5, 10, 10), circle(2.56, 30, 10), circle(8, 40, 40)]}
    (area,) = sheets(layers, operation, tools=tools).areas()
    assert [
        (region.boundary.primitives[0].centre, region.boundary.primitives[0].radius) for region in area.regions
    ] == [  # type: ignore[union-attr]
        ((10, 10), 2.54),
        ((30, 10), 2.56),
    ]


def test_clamps_keep_the_area_apart_where_they_cut_it() -> None:
    bar = polygon_contour([(0, 0), (100, 0), (100, 10), (0, 10)])
    (clamp,) = drawn_contours(
        Job(layered_part({"k": [square(20, 40, -5)], "a": []}), operations=(), keep_out_layers=("k",))
    ).clamps
    regions = nest(without_outlines([bar], [clamp.boundary]).contours)
    assert [region.number for region in regions] == [1, 2]
    assert sorted(shape((region,)).area for region in regions) == pytest.approx([400, 400])


def test_parts_of_an_area_tell_the_same_as_the_whole() -> None:
    corners = [(20.0 * k, 15.0 * row) for k in range(4) for row in range(3)]
    contours = [c for x, y in corners for c in (square(12, x, y), circle(2, x + 6, y + 6))]
    area = sheet({"a": contours}, INSIDE)
    parts = area.parts(5, 1.5)
    assert len(parts) == 4
    assert sorted(region.number for part in parts for region in part.regions) == [r.number for r in area.regions]
    assert sum(len(part.frame(1.5).rings) for part in parts) == len(area.frame(1.5).rings) == 24
    for part in parts:
        rows = part.primitives.rows
        np.testing.assert_array_equal(rows[part.primitives.previous, 2:4], rows[:, :2])
        places = np.concatenate([ring.rows[:, :2] for ring in part.frame(1.5).rings])
        np.testing.assert_allclose(part.distances.nearest(places)[0], area.distances.nearest(places)[0], atol=1e-12)
    assert area.parts(12, 1.5) == [area]
