"""Which tool? Widths, corners and reaches in closed form, against independent shapes, and times against programs that
were made.
"""

from __future__ import annotations

import math
import threading
from pathlib import Path

import numpy as np
import pytest
import shapely
from hypothesis import example, given, settings
from hypothesis import strategies as st

from app.core.errors import Cancelled, ParameterError
from app.core.progress import Progress
from app.formats.readers import read_drawing
from app.gcode.posts import load_post
from app.geometry.distance import DistanceField
from app.geometry.outlines import nest, polygon_contour
from app.geometry.overlay.overlay import without_crossings
from app.geometry.primitives import pack
from app.model.contour_operation import ContourOperation
from app.model.job import Job
from app.model.operation import CutParameters, PocketOperation
from app.model.part import Contour
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.operations.compute import compute, regions_of
from app.toolpath.advice.advise import Advice, CuttingPlan, RegionAdvice, SizedPlace, advise, distances, times
from app.toolpath.advice.reach import FITS, centres
from app.toolpath.coverage.areas import region_shapes
from app.usecases.making.written import write_and_check
from tests.examples import examples
from tests.part_shapes import bulged, circle, fig2, random_part, square

QUARTER = math.tan(math.pi / 8)
"""Bulge of a quarter turn."""


def tools(*diameters: float) -> list[Tool]:
    return [Tool(k, diameter) for k, diameter in enumerate(diameters, 1)]


def advised(contours: list[Contour], *diameters: float) -> Advice:
    return advise(nest(contours), tools(*(diameters or (1.0,))))


def only(contours: list[Contour], *diameters: float) -> RegionAdvice:
    (region,) = advised(contours, *diameters).regions
    return region


def near(spot: SizedPlace | None, x: float, y: float, size: float, within: float = 1e-3) -> bool:
    return spot is not None and math.dist((spot.x, spot.y), (x, y)) < within and abs(spot.size - size) < within


def slot(length: float, width: float) -> list[Contour]:
    r = width / 2
    return [bulged([(0, -r, 0), (length, -r, 1.0), (length, r, 0), (0, r, 1.0)])]


def test_a_slot_is_as_wide_as_it_is_everywhere() -> None:
    region = only(slot(40, 6), 4, 6, 8)
    assert region.passage.size == pytest.approx(6, abs=1e-6) and region.passage.y == pytest.approx(0, abs=1e-6)
    assert region.disc.size == pytest.approx(6, abs=1e-6) and region.clearing.size == pytest.approx(6, abs=1e-6)
    assert region.corners == 0 and region.corner is None and region.smallest_radius == pytest.approx(3)
    assert region.area_mm2 == pytest.approx(240 + 9 * math.pi)
    small, exact, large = region.reaches
    assert (small.share, small.parts, small.left_mm2, small.left_disc) == (1, 1, 0, 0)
    assert (exact.share, exact.parts) == (1, 1)
    assert (large.share, large.parts) == (0, 0)
    assert large.left_mm2 == region.area_mm2 and large.left_disc == pytest.approx(6, abs=1e-6)


def keyhole(radius: float, width: float, length: float) -> list[Contour]:
    """A circle about the origin, and a slot with a square end that leads out of it to x = length."""
    half = width / 2
    mouth = math.sqrt(radius**2 - half**2)
    sweep = math.tau - 2 * math.asin(half / radius)
    middle = math.tan(sweep / 8)
    return [
        bulged([(mouth, half, middle), (-radius, 0, middle), (mouth, -half, 0), (length, -half, 0), (length, half, 0)])
    ]


def test_a_keyhole_has_the_passage_of_its_slot_and_the_disc_of_its_hole() -> None:
    region = only(keyhole(10, 5, 40), 4, 5, 6)
    assert region.passage.size == pytest.approx(5, abs=1e-6) and region.passage.x > 9.5
    assert near(region.disc, 0, 0, 20) and region.clearing.size == pytest.approx(5, abs=1e-6)
    assert region.corners == 2 and region.corner is not None
    assert region.corner.x == 40 and region.corner.size == pytest.approx(math.pi / 2) and region.smallest_radius == 0
    assert [reach.parts for reach in region.reaches] == [1, 1, 1]
    assert region.reaches[1].left_mm2 == pytest.approx((2 - math.pi / 2) * 2.5**2, abs=0.02)
    half = math.asin(2.5 / 3)  # a disc of 6 mm stands in the mouth and reaches into the slot by a segment
    reached = 9 * (half - math.sin(half) * math.cos(half))
    assert region.reaches[2].left_mm2 == pytest.approx(5 * (40 - math.sqrt(100 - 6.25)) - reached, abs=0.05)
    assert region.reaches[2].left_disc == pytest.approx(5, rel=0.01)


def comb(teeth: int, gap: float, tooth: float, depth: float) -> list[Contour]:
    """A bar 10 mm high with slots that are dead ends, upwards."""
    top: list[tuple[float, float]] = []
    for k in range(teeth):
        x = tooth + k * (gap + tooth)
        top += [(x, 10.0), (x, 10.0 + depth), (x + gap, 10.0 + depth), (x + gap, 10.0)]
    end = tooth + teeth * (gap + tooth)
    return [polygon_contour([(0, 0), (end, 0), (end, 10.0), *top[::-1], (0, 10.0)])]


def test_a_comb_is_as_narrow_as_its_dead_ends() -> None:
    region = only(comb(5, 3, 4, 12), 3, 4)
    assert region.passage.size == pytest.approx(3, abs=1e-6) and region.clearing.size == pytest.approx(3, abs=1e-6)
    assert region.passage.y >= 10 and region.corners == 14
    assert region.disc.size > 10
    fits, over = region.reaches
    assert fits.parts == over.parts == 1
    assert fits.left_mm2 == pytest.approx(14 * (1 - math.pi / 4) * 1.5**2, abs=0.05)
    half = math.asin(1.5 / 2)  # a disc of 4 mm in the mouth of a gap
    reached = 4 * (half - math.sin(half) * math.cos(half))
    assert over.left_mm2 == pytest.approx(5 * (3 * 12 - reached) + 4 * (1 - math.pi / 4) * 4, abs=0.05)
    assert over.left_disc == pytest.approx(3, rel=0.01)


def gear(teeth: int, width: float, root: float, tip: float) -> list[Contour]:
    """An inner gear: notches of some width that go outwards from radius `root` to `tip`."""
    points = []
    for k in range(teeth):
        angle = math.tau * k / teeth
        along, across = np.array([math.cos(angle), math.sin(angle)]), np.array([-math.sin(angle), math.cos(angle)])
        inner = math.sqrt(root**2 - width**2 / 4)
        points += [
            tuple(p)
            for p in (
                inner * along - width / 2 * across,
                tip * along - width / 2 * across,
                tip * along + width / 2 * across,
                inner * along + width / 2 * across,
            )
        ]
    return [polygon_contour([(float(x), float(y)) for x, y in points])]


def test_a_gear_asks_for_the_width_of_its_gaps() -> None:
    region = only(gear(12, 2.5, 20, 26), 2.5, 3)
    assert region.passage.size == pytest.approx(2.5, abs=1e-6) and region.clearing.size == pytest.approx(2.5, abs=1e-6)
    assert region.corners == 24 and near(region.disc, 0, 0, region.disc.size, 1e-2)
    assert region.reaches[0].left_mm2 == pytest.approx(24 * (1 - math.pi / 4) * 1.25**2, abs=0.05)
    assert region.reaches[1].left_disc == pytest.approx(2.5, rel=0.01)


def rounded(width: float, height: float, r: float) -> list[Contour]:
    return [
        bulged(
            [
                (r, 0, 0),
                (width - r, 0, QUARTER),
                (width, r, 0),
                (width, height - r, QUARTER),
                (width - r, height, 0),
                (r, height, QUARTER),
                (0, height - r, 0),
                (0, r, QUARTER),
            ]
        )
    ]


def test_a_rectangle_with_fillets_asks_for_their_radius() -> None:
    region = only(rounded(50, 30, 4), 8, 10, 40)
    assert region.clearing.size == pytest.approx(8, abs=1e-6) and region.smallest_radius == pytest.approx(4)
    assert region.passage.size == pytest.approx(30, abs=1e-6) and region.disc.size == pytest.approx(30, abs=1e-6)
    assert region.corners == 0
    assert [reach.parts for reach in region.reaches] == [1, 1, 0]
    assert region.reaches[0].left_mm2 == 0
    assert region.reaches[1].left_mm2 == pytest.approx((4 - math.pi) * (25 - 16), abs=0.05)


def test_a_rectangle_leaves_nothing_but_its_corners_up_to_its_width() -> None:
    region = only([polygon_contour([(0, 0), (50, 0), (50, 30), (0, 30)])], 10)
    assert region.corners == 4 and region.clearing.size == pytest.approx(30, abs=1e-6)
    assert region.reaches[0].left_mm2 == pytest.approx((4 - math.pi) * 25, abs=0.05)
    corner = 5 * (math.sqrt(2) - 1)  # from the corner to the cutter's disc along the diagonal
    assert region.reaches[0].left_disc == pytest.approx(2 * corner / (math.sqrt(2) + 1), rel=0.01)


@pytest.mark.parametrize("off", [0.0, 0.5, 4.0])
def test_a_ring_is_as_narrow_as_its_walls_are_near(off: float) -> None:
    region = only([circle(20, 5, 5), circle(8, 5 + off, 5)], 7, 13)
    assert region.passage.size == pytest.approx(12 - off, abs=1e-6)
    assert region.disc.size == pytest.approx(12 + off, abs=1e-6)
    assert region.clearing.size == pytest.approx(12 - off, abs=1e-6)
    if off:
        assert near(region.passage, 5 + 14 + off / 2, 5, 12 - off) and near(region.disc, 5 - 14 + off / 2, 5, 12 + off)
    assert region.inner_radius is not None and region.inner_radius.size == pytest.approx(20)


def test_tips_make_a_passage() -> None:
    region = only([polygon_contour([(0, 0), (20, 8), (40, 0), (40, 20), (21, 11), (0, 20)])], 2, 4)
    assert near(region.passage, 20.5, 9.5, math.hypot(1, 3))
    assert [reach.parts for reach in region.reaches] == [1, 2]


def test_a_wedge_with_a_flat_end_asks_for_a_tool_that_touches_the_end() -> None:
    bottom = 2.0
    region = only([polygon_contour([(-bottom / 2, 0), (bottom / 2, 0), (bottom / 2 + 20, 20), (-bottom / 2 - 20, 20)])])
    assert region.clearing.size == pytest.approx(bottom * math.tan(math.radians(135 / 2)), abs=1e-4)


def test_a_round_wall_of_chords_is_as_wide_as_the_circle_in_it() -> None:
    many = [(10 * math.cos(a), 10 * math.sin(a)) for a in np.arange(100) * math.tau / 100]
    region = only([polygon_contour([(x + 3, y) for x, y in many])])
    inner = 20 * math.cos(math.pi / 100)
    assert region.corners == 0
    assert region.clearing.size == pytest.approx(inner, rel=5e-3) and region.disc.size == pytest.approx(inner, rel=5e-3)


def test_a_chamfer_too_small_to_matter_is_part_of_its_corner() -> None:
    region = only([polygon_contour([(0.03, 0), (20, 0), (20, 10), (0, 10), (0, 0.03)])])
    assert region.clearing.size == pytest.approx(10, abs=1e-4)


def test_where_contours_touch_is_a_sharp_corner() -> None:
    diamonds = [polygon_contour([(x - 10, 30), (x, 20), (x + 10, 30), (x, 40)]) for x in (20, 40)]
    region = only([square(60), *diamonds])
    assert region.passage.size == pytest.approx(10, abs=1e-6) and region.clearing.size == pytest.approx(10, abs=1e-6)
    assert region.corners == 6


def whole(shape: shapely.Geometry, islands: int) -> bool:
    """Tell whether a shape is one piece round so many islands."""
    return bool(shape.geom_type == "Polygon" and len(shape.interiors) == islands)


def check_widths(contours: list[Contour], crossing: bool) -> None:
    """Against shapely: discs are free and touch, the passage and the clearing tool are not too large."""
    regions = nest(without_crossings(contours).contours if crossing else contours)
    if not regions:
        return
    field = DistanceField.of(pack(regions).rows)
    for region, found in zip(regions, advise(regions, tools(1)).regions, strict=True):
        for spot in (found.passage, found.disc, found.clearing):
            assert field.nearest(np.array([[spot.x, spot.y]]))[0][0] == pytest.approx(spot.size / 2, rel=5e-3, abs=1e-6)
        assert found.clearing.size <= found.passage.size * (1 + 1e-9) <= found.disc.size * (1 + 2e-9)
        shape = shapely.union_all(region_shapes([region], 1e-3))
        fine = shapely.union_all(region_shapes([region], 1e-5))  # coarser chords move sharp tips by 30 um
        radius = shapely.maximum_inscribed_circle(fine, tolerance=1e-3).length
        assert found.disc.size / 2 >= radius - 5e-3  # that it is free is shown above: the library's can be smaller
        assert shape.buffer(1e-3).contains(shapely.Point(found.disc.x, found.disc.y))
        if found.passage.size < 0.2 or not whole(shapely.buffer(shape, -1e-3), len(region.islands)):
            continue  # contours touch
        eroded = shapely.buffer(shape, -(found.passage.size / 2 - 5e-3), quad_segs=64)
        assert whole(eroded, len(region.islands))


@settings(max_examples=examples(20), deadline=None)
@given(st.integers(0, 10**6))
@example(15)  # whose largest disc touches tips alone
@example(373)
def test_random_parts(seed: int) -> None:
    check_widths(*random_part(seed))


@settings(max_examples=examples(12), deadline=None)
@given(st.integers(0, 10**6))
def test_a_tool_that_clears_leaves_nothing_but_corners(seed: int) -> None:
    contours, crossing = random_part(seed)
    regions = nest(without_crossings(contours).contours if crossing else contours)
    for region, found in zip(regions, advise(regions, tools(1)).regions, strict=True):
        if found.clearing.size < 0.5:
            continue
        shape = shapely.union_all(region_shapes([region], 1e-4))
        r = 0.995 * found.clearing.size / 2 - 1e-3
        opened = shapely.buffer(shapely.buffer(shape, -r, quad_segs=200), r, quad_segs=200)
        points = [curve.start for contour in region.contours for curve in contour.primitives]  # type: ignore[union-attr]
        left = shapely.get_parts(shapely.difference(shape, opened))
        for piece in left[~shapely.is_empty(shapely.buffer(left, -4e-3))]:
            assert shapely.distance(piece, shapely.MultiPoint(points)) < 0.02


def test_reach_is_the_opening() -> None:
    regions = nest(fig2())
    for region, found in zip(regions, advise(regions, tools(3, 8, 16, 30)).regions, strict=True):
        (shape,) = region_shapes([region], 1e-2)  # finer, and the library loses parts
        for reach in found.reaches:
            r = reach.diameter / 2 - FITS
            eroded = shapely.buffer(shape, -r, quad_segs=16)
            opened = shapely.buffer(eroded, r, quad_segs=16)
            assert reach.share == pytest.approx(opened.area / shape.area, abs=1e-3)
            assert reach.parts == (0 if eroded.is_empty else shapely.get_num_geometries(eroded))


def test_the_pair_with_the_least_time_is_advised() -> None:
    found = advised([square(100)], 2, 6, 10, 20)
    assert found.contour.diameter == 20 and found.pocket is found.contour
    found = advised(rounded(100, 100, 2.5), 2, 5, 12, 20)
    assert found.contour.diameter == 5 and found.pocket.diameter == 20
    timed = {choice.tool.diameter: choice.times.total for choice in found.choices if choice.times is not None}
    assert sorted(timed) == [5, 12, 20] and min(timed, key=lambda d: timed[d]) == 20
    assert found.times.total == timed[20]
    assert "T2" in found.why and "T4" in found.why and "5.000 mm" in found.why


def test_slow_tools_and_tool_changes_count() -> None:
    slow = [Tool(1, 5), Tool(2, 20, feed_rate=60)]
    assert advise(nest(rounded(100, 100, 2.5)), slow).pocket.number == 1
    assert advise(nest(rounded(100, 100, 2.5)), tools(5, 20), CuttingPlan(tool_change=3600)).pocket.number == 1


def test_a_drawing_too_small_for_all_tools_says_so() -> None:
    found = advised([square(2)], 3, 6)
    assert found.why.startswith("No tool fits") and "2.000 mm" in found.why
    assert found.times.total == 0
    found = advised([square(20), circle(1, 40, 40)], 3, 6)
    assert found.contour.diameter == 3 and "smallest tool" in found.why


def test_only_tools_that_clear_a_floor_are_asked() -> None:
    found = advise(nest([square(20)]), [Tool(1, 10, kind=ToolKind.V), Tool(2, 3), Tool(3, 6, kind=ToolKind.DRILL)])
    assert [choice.tool.number for choice in found.choices] == [2]
    with pytest.raises(ParameterError, match="flat"):
        advise(nest([square(20)]), [Tool(1, 10, kind=ToolKind.BALL)])
    with pytest.raises(ParameterError, match="no closed contour"):
        advise(())


def test_it_stops_when_asked() -> None:
    regions = nest(fig2())
    for limit in (0.0, 0.4, 0.7, 0.95):
        stop = threading.Event()
        with pytest.raises(Cancelled):
            advise(regions, progress=Progress(lambda f, _, s=stop, most=limit: s.set() if f >= most else None, stop))  # type: ignore[misc]


def made_and_estimated(path: Path, pocket: Tool, contour: Tool) -> tuple[tuple[float, float], tuple[float, float]]:
    """Seconds of motions of both tools in the program that is made, and as estimated."""
    drawing = read_drawing(path.name, path.read_bytes(), None, ())
    operations = (
        PocketOperation(CutParameters(tool=1, depth=4), stepover=pocket.radius),
        ContourOperation(CutParameters(tool=2, depth=4)),
    )
    job = Job(drawing.part, tools=(pocket, contour), operations=operations)
    written = write_and_check(compute(job), job, load_post(job.post), None)
    moving = [sum(float(d.moving[d.tool[:-1] == k].sum()) for d in written.durations) for k in (1, 2)]
    where = centres(pack(regions_of(job)[0]), distances(pocket, contour))
    told = times(pocket, contour, where, CuttingPlan(depth=4))
    return (moving[0], moving[1]), (told.pocket, told.contour)


@pytest.mark.parametrize(
    ("name", "pocket", "contour"),
    [("fig2", 12, 3), ("gear", 2, 1), ("apu-mount", 6, 3), ("genshi", 4, 2), ("insert", 20, 10), ("LM2", 20, 4)],
)
def test_times_are_those_of_programs(data: Path, name: str, pocket: float, contour: float) -> None:
    made, told = made_and_estimated(data / "dxf" / f"{name}.dxf", Tool(1, pocket), Tool(2, contour))
    print(f"{name}: made {made[0]:.0f} + {made[1]:.0f} s, estimated {told[0]:.0f} + {told[1]:.0f} s")
    for ours, true in zip(told, made, strict=True):
        assert true / 1.5 <= ours <= 1.5 * true
    assert sum(made) / 1.5 <= sum(told) <= 1.5 * sum(made)


@pytest.mark.parametrize("name", [pytest.param("complex", marks=pytest.mark.exhaustive), "forms"])
def test_drawings_of_thousands_of_lines(data: Path, name: str) -> None:
    drawing = read_drawing(f"{name}.dxf", (data / "dxf" / f"{name}.dxf").read_bytes(), None, ())
    regions, _ = regions_of(Job(drawing.part))
    found = advise(regions, tools(1, 2, 6))
    field = DistanceField.of(pack(regions).rows)
    for region in found.regions:
        assert region.clearing.size <= region.passage.size <= region.disc.size
        assert field.nearest(np.array([[region.disc.x, region.disc.y]]))[0][0] == pytest.approx(region.disc.size / 2)
    shares = [choice.share for choice in found.choices]
    assert shares == sorted(shares, reverse=True)
