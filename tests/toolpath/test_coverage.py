"""What is left, against areas known by hand and against a fine grid of exact distances."""

from __future__ import annotations

import math
import pathlib
import threading
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
import shapely

from app.core.errors import Cancelled
from app.core.progress import Progress
from app.model.contour_operation import ContourOperation
from app.model.curves import Circle
from app.model.finding import FindingKind
from app.model.job import Job
from app.model.operation import CutParameters, PocketOperation
from app.model.part import Contour, Part, Region
from app.model.tool import Tool
from app.toolpath.coverage.coverage import _between_reversals, _solid, _widened, coverage_findings, measure
from app.toolpath.coverage.proven import uncertain
from tests.gcode.programs import Path, square

DISC = Region(1, Contour((Circle((0.0, 0.0), 10.0),)))


def one_tool(diameter: float = 6.0, **cut: float) -> Job:
    """A job whose only operation is a pocket, 2 mm deep."""
    return Job(Part(), tools=(Tool(1, diameter),), operations=(PocketOperation(CutParameters(1, **cut)),))


def rings(*radii: float, z: float = -2.0) -> Path:
    """Full circles about the origin."""
    path = Path()
    for radius in radii:
        path.into_work(radius, 0, z).arc((radius, 0.0, z), (0.0, 0.0)).out_of_work()
    return path


def test_a_round_pocket_that_is_cleared() -> None:
    found = measure(rings(7.0, 4.0, 1.0).program(DISC), one_tool())
    assert (found.reachable_left_mm2, found.unreachable_mm2, found.largest_disc_mm, found.places) == (0, 0, 0, ())
    assert found.area_mm2 == pytest.approx(math.pi * 100, rel=1e-3)
    assert found.floor_mm == 2.0
    assert coverage_findings(found) == ()


def test_a_ring_that_is_missing_leaves_its_band() -> None:
    found = measure(rings(7.0).program(DISC), one_tool())
    assert found.reachable_left_mm2 == pytest.approx(math.pi * 16, rel=1e-3)
    assert found.places[0].disc_mm == pytest.approx(8, abs=0.01)
    assert math.hypot(found.places[0].x, found.places[0].y) < 0.01
    (finding,) = coverage_findings(found)
    assert finding.kind is FindingKind.LEFT_REACHABLE
    assert finding.counts
    assert "50.2" in finding.text


def test_a_pass_that_is_not_deep_enough_clears_nothing() -> None:
    found = measure(rings(7.0, 4.0, 1.0, z=-1.99).program(DISC), one_tool())
    assert found.reachable_left_mm2 == pytest.approx(math.pi * 100, rel=1e-3)


def test_corners_are_out_of_reach_and_no_finding_that_counts() -> None:
    path = Path().into_work(3, 3, -2)
    for x, y in ((37, 3), (37, 27), (3, 27), (3, 3)):
        path.line(x, y, -2)
    for y in (7, 11, 15, 19, 23):
        path.line(3, y, -2).line(37, y, -2).line(3, y, -2)
    found = measure(path.out_of_work().program(square()), one_tool())
    assert found.reachable_left_mm2 == 0
    assert found.unreachable_mm2 == pytest.approx((4 - math.pi) * 9, abs=0.02)
    assert len(found.places) == 4
    corner_disc = 2 * 3 * (math.sqrt(2) - 1) / (math.sqrt(2) + 1)
    assert found.largest_disc_mm == pytest.approx(corner_disc, abs=0.01)
    assert [(f.kind, f.counts) for f in coverage_findings(found)] == [(FindingKind.LEFT_UNREACHABLE, False)]


def test_a_smaller_tool_of_the_job_reaches_the_corners_so_what_it_leaves_counts() -> None:
    path = rings(7.0, 4.0, 1.0)
    task = Job(
        Part(),
        tools=(Tool(1, 6.0), Tool(2, 1.0)),
        operations=(PocketOperation(CutParameters(1)), ContourOperation(CutParameters(2))),
    )
    region = replace(square(-10, -10, 10, 10), islands=())
    found = measure(path.program(region), task)
    assert found.unreachable_mm2 == pytest.approx((4 - math.pi) * 0.25, abs=0.005)
    assert found.reachable_left_mm2 == pytest.approx(400 - math.pi * 100 - (4 - math.pi) * 0.25, rel=1e-3)


def test_stock_to_leave_is_not_left_by_mistake() -> None:
    found = measure(rings(6.5, 4.0, 1.0).program(DISC), one_tool(stock_to_leave=0.5))
    assert (found.reachable_left_mm2, found.unreachable_mm2) == (0, 0)
    assert found.area_mm2 == pytest.approx(math.pi * 9.5**2, rel=1e-3)


def test_a_contour_alone_is_asked_for_its_band_only() -> None:
    task = Job(Part(), tools=(Tool(1, 6.0),), operations=(ContourOperation(CutParameters(1)),))
    assert measure(rings(7.0).program(DISC), task).reachable_left_mm2 == 0
    assert measure(rings(6.8).program(DISC), task).reachable_left_mm2 == pytest.approx(
        math.pi * (100 - 9.8**2), rel=1e-2
    )


def test_a_region_too_small_for_every_tool_is_out_of_reach_whole() -> None:
    found = measure(rings(7.0, 4.0, 1.0).program(DISC, Region(2, Contour((Circle((40.0, 0.0), 2.0),)))), one_tool())
    assert found.unreachable_mm2 == pytest.approx(math.pi * 4, rel=1e-2)
    assert found.largest_disc_mm == pytest.approx(4, abs=0.01)
    assert (found.places[0].x, found.places[0].y) == pytest.approx((40, 0), abs=0.01)


def test_agrees_with_a_grid_of_exact_distances() -> None:
    radii = (7.0, 2.9)
    found = measure(rings(*radii).program(square(-10, -10, 10, 10)), one_tool(2.2))
    pitch = 0.01
    axis = np.arange(-10 + pitch / 2, 10, pitch)
    x, y = np.meshgrid(axis, axis)
    r, tool = np.hypot(x, y), 1.1
    cleared = np.min([np.abs(r - ring) for ring in radii], axis=0) <= tool
    inner = 10 - tool
    from_inner = np.hypot(np.maximum(np.abs(x) - inner, 0), np.maximum(np.abs(y) - inner, 0))
    left = float(np.sum(~cleared & (from_inner <= tool))) * pitch**2
    assert found.reachable_left_mm2 == pytest.approx(left, abs=0.05)
    assert found.unreachable_mm2 == pytest.approx((4 - math.pi) * tool**2, abs=0.01)


def test_no_operation_no_region_no_moves() -> None:
    assert measure(rings(7.0).program(DISC), replace(one_tool(), operations=())).area_mm2 == 0
    off = replace(one_tool(), operations=(PocketOperation(CutParameters(1, enabled=False)),))
    assert measure(rings(7.0).program(DISC), off).places == ()


@pytest.mark.parametrize("radii", [(7.0, 4.0, 1.0), (7.0, 1.0), (6.0,)])
def test_what_is_proven_covered_changes_nothing(radii: tuple[float, ...], monkeypatch: pytest.MonkeyPatch) -> None:
    """Every tile taken as uncertain gives the same answer, also for an area of several parts with holes."""
    island = Contour((Circle((30.0, 0.0), 1.5, ccw=False),))
    regions = (
        DISC,
        Region(2, Contour((Circle((30.0, 0.0), 9.0),)), (island,)),
        Region(3, Contour((Circle((0.0, 25.0), 9.0),))),
    )
    program = rings(*radii).program(*regions)
    quick = measure(program, one_tool())
    monkeypatch.setattr(
        "app.toolpath.coverage.coverage.uncertain",
        lambda wanted, paths, progress: np.array([shapely.box(*wanted.bounds)]),
    )
    full = measure(program, one_tool())
    assert quick.reachable_left_mm2 == pytest.approx(full.reachable_left_mm2, abs=1e-3)
    assert quick.reachable_left_mm2 > 300
    assert quick.unreachable_mm2 == full.unreachable_mm2
    assert len(quick.places) == len(full.places)


def test_an_uncertain_tile_lies_wherever_the_floor_is_not_cut() -> None:
    area = shapely.box(0, 0, 40, 30).difference(shapely.Point(20, 15).buffer(4))
    path = np.array([[3.0, 3.0], [37.0, 3.0], [37.0, 27.0]])
    uncut = area.difference(shapely.LineString(path).buffer(3, quad_segs=64))
    rows = np.hstack([path[:-1], path[1:], np.zeros((2, 4))])
    tiles = shapely.union_all(uncertain(area, [(rows, 3.0)]))
    assert tiles.covers(uncut)
    assert 0.75 * (area.area - uncut.area) < area.difference(tiles).area < area.area - uncut.area


def test_ramps_and_rapids_do_not_clear_the_floor() -> None:
    ramp = (
        Path()
        .into_work(-7, 0, 0)
        .line(7, 0, -2)
        .out_of_work()
        .rapid(0, 7, 5)
        .rapid(0, 7, -2)
        .rapid(0, -7, -2)
        .rapid(0, -7, 5)
    )
    assert measure(ramp.program(DISC), one_tool()).reachable_left_mm2 == pytest.approx(math.pi * 100, rel=1e-3)


def test_regions_that_touch_have_a_wall_between_them() -> None:
    """Two slots side by side, each cut along its walls: the tool must not be asked to cross the wall between them."""
    path = Path()
    for low in (0, 7):
        path.into_work(3, low + 3, -2).line(27, low + 3, -2).line(27, low + 4, -2).line(3, low + 4, -2).line(
            3, low + 3, -2
        ).out_of_work()
    slots = (square(0, 0, 30, 7), replace(square(0, 7, 30, 14), number=2))
    found = measure(path.program(*slots), one_tool())
    assert found.reachable_left_mm2 == 0
    assert found.unreachable_mm2 == pytest.approx(8 * (1 - math.pi / 4) * 9, abs=0.02)


def test_a_path_that_crosses_itself_is_never_widened_to_more_than_its_swath(data: pathlib.Path) -> None:
    """Its plain buffer came out at 836 mm2 where 399 mm2 is the most that a 1.2 mm cutter can sweep."""
    points = np.load(data / "crossing_run.npy")
    swath = shapely.union_all(_widened(points, 0.6))
    exact = shapely.union_all([shapely.LineString(pair).buffer(0.6, quad_segs=64) for pair in pairwise(points)])
    assert swath.area == pytest.approx(exact.area, rel=2e-3)


def test_lines_and_slivers_together_are_nothing_that_is_left() -> None:
    sliver, corner = shapely.box(0, 0, 1e-9, 5), shapely.box(7, 0, 9, 2)
    line = shapely.LineString([(2, 0), (5, 5)])
    assert _solid(shapely.GeometryCollection([line, sliver])).is_empty
    assert _solid(shapely.GeometryCollection([line, sliver, corner])).area == pytest.approx(4)


def test_the_end_of_a_spur_there_and_back_is_covered() -> None:
    """The library rounds off no end where a path turns back on itself."""
    path = rings(7.0, 4.0, 1.0).into_work(0, 0, -2)
    for x, y in ((8.5, 0.0), (0.0, 0.0), (0.0, 8.5), (0.0, 0.0), (-8.5, 0.0), (0.0, 0.0)):
        path.line(x, y, -2)
    spur = np.array([[0, 0], [8.5, 0], [8.5, 0], [0, 0.0]])
    swath = shapely.union_all([shape for part in _between_reversals(spur) for shape in _widened(part, 3.0)])
    assert swath.contains(shapely.Point(11.4, 0.0))
    assert measure(path.out_of_work().program(DISC), one_tool()).reachable_left_mm2 == 0


def half_cleared(count: int) -> tuple[Path, list[Region]]:
    """Round pockets in a row, each cleared but for a band."""
    path, regions = Path(), []
    for k in range(count):
        x = 30.0 * k
        regions.append(Region(k + 1, Contour((Circle((x, 0.0), 10.0),))))
        path.into_work(x + 7, 0, -2).arc((x + 7, 0.0, -2.0), (x, 0.0)).out_of_work()
    return path, regions


def test_what_is_left_of_many_is_the_same_of_each() -> None:
    path, regions = half_cleared(20)
    found = measure(path.program(*regions), one_tool())
    assert len(found.places) == 20
    assert [place.area_mm2 for place in found.places] == pytest.approx([math.pi * 16] * 20, rel=1e-3)


def test_measuring_tells_how_far_it_is_and_can_be_stopped_at_every_piece() -> None:
    path, regions = half_cleared(20)
    program, told, stop = path.program(*regions), list[float](), threading.Event()
    measure(program, one_tool(), Progress(lambda fraction, text: told.append(fraction)))
    assert told == sorted(told)
    assert len(set(told)) > 20
    for last in range(0, len(told) - 1, 25):
        stop.clear()
        seen = list[float]()

        def listen(fraction: float, text: str, seen: list[float] = seen, last: int = last) -> None:
            seen.append(fraction)
            if len(seen) > last:
                stop.set()

        with pytest.raises(Cancelled):
            measure(program, one_tool(), Progress(listen, stop))
        assert len(seen) == last + 1
