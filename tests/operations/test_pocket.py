"""Pockets as a whole: the default stepover, both orders, clamps, depth passes, and what is told of necks."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.core.errors import ParameterError
from app.formats.readers import read_drawing
from app.geometry.distance import DistanceField
from app.geometry.offset.offset import OffsetLevel, offset_levels
from app.geometry.outlines import nest, polygon_contour
from app.geometry.primitives import lengths, pack
from app.model.finding import FindingKind
from app.model.job import Job
from app.model.moves import Purpose
from app.model.operation import CutParameters, Direction, PocketOperation
from app.model.part import Contour, Entity, Part, Region
from app.model.tool import Tool
from app.operations.compute import compute, regions_of
from app.operations.pocket.paths import (
    MOST_COMPARED,
    MOST_LINKED,
    PocketStrokes,
    PocketTarget,
    between_rings,
    candidates,
    shortest,
)
from app.toolpath.coverage.coverage import measure
from app.toolpath.linking.link import LinkOptions
from app.toolpath.machining_areas import MachiningArea
from app.toolpath.narrow_regions import necks
from tests.conftest import ROOT
from tests.part_shapes import circle, fig2, square

R = 1.0
WANTED = PocketTarget(1.5, R, LinkOptions())


def sheet_of(regions: tuple[Region, ...]) -> MachiningArea:
    primitives = pack(regions)
    return MachiningArea(
        regions, primitives, DistanceField.of(primitives.rows), np.zeros(len(primitives.rows), np.bool_)
    )


def job_of(
    contours: list[Contour], diameter: float, stepover: float | None = None, cut: CutParameters | None = None
) -> Job:
    curves = [(curve, contour.layer) for contour in contours for curve in contour.primitives]
    part = Part().with_entities(tuple(Entity(k, curve, layer) for k, (curve, layer) in enumerate(curves, 1)))
    return Job(part, tools=(Tool(1, diameter),), operations=(PocketOperation(cut or CutParameters(1), stepover),))


def neck_of(contour: Contour, diameter: float) -> tuple[float, float, float]:
    primitives = pack(nest([contour]))
    (level,) = offset_levels(primitives, [diameter / 2], frame=True)
    (neck,) = necks(level, primitives, DistanceField.of(primitives.rows), Tool(1, diameter))
    return neck.x or 0.0, neck.y or 0.0, neck.amount or 0.0


def ratio(regions: tuple[Region, ...]) -> tuple[PocketStrokes, float]:
    """(the default, its length against that at s = R)."""
    sheet = sheet_of(regions)
    chosen = shortest(sheet, WANTED, candidates(R, len(sheet.primitives.rows)))
    return chosen, chosen.length / shortest(sheet, WANTED, (R,)).length


def test_the_default_stepover_of_fig2_saves_three_tenths_of_the_path() -> None:
    chosen, share = ratio(nest(fig2()))
    assert share <= 0.70 and len(chosen.strokes) == 2
    assert chosen.linked <= MOST_LINKED


@pytest.mark.exhaustive
def test_the_default_stepover_of_many_islands_saves_two_tenths_of_the_path() -> None:
    path = ROOT / "tests" / "data" / "dxf" / "complex.dxf"
    chosen, share = ratio(regions_of(Job(read_drawing(path.name, path.read_bytes(), None, ()).part))[0])
    assert share <= 0.80
    assert len(chosen.strokes) == sum(ring.area > 0 for ring in chosen.levels[0].rings)
    assert chosen.linked <= MOST_LINKED


def test_what_is_reported_of_a_way_is_what_its_strokes_measure() -> None:
    chosen, _ = ratio(nest([square(30)]))
    assert chosen.length == pytest.approx(sum(float(lengths(stroke.rows).sum()) for stroke in chosen.strokes))
    rings = sum(ring.length for level in chosen.levels for ring in level.rings)
    assert chosen.linked == pytest.approx(1 - rings / chosen.length)


@pytest.mark.parametrize(
    "contours",
    [fig2(), [square(30)], [circle(20)], [square(30), circle(3), circle(2, 9, 9), square(4, -9, -8)]],
    ids=["fig2", "square", "circle", "islands"],
)
def test_what_is_not_linked_would_not_have_been_chosen(contours: list[Contour]) -> None:
    """The lengths by which stepovers are ruled out before their rings are linked are not above the true ones."""
    sheet = sheet_of(nest(contours))
    stepovers = candidates(R, len(sheet.primitives.rows))
    chosen = shortest(sheet, WANTED, stepovers)
    alone = [shortest(sheet, WANTED, (each,)) for each in stepovers]
    assert (chosen.stepover, chosen.length) == min(
        ((each.linked > MOST_LINKED, each.length), (each.stepover, each.length)) for each in alone
    )[1]
    for each in alone:
        rings = sum(ring.length for level in each.levels for ring in level.rings)
        least = rings + each.filling.length + between_rings(each.levels, each.filling.halves)
        assert least <= each.length + 1e-6


def test_drawings_with_very_many_rows_take_one_stepover_unmeasured() -> None:
    assert len(candidates(2.0, MOST_COMPARED)) > 1
    assert candidates(2.0, MOST_COMPARED + 1) == (candidates(2.0, 1)[0],)
    assert all(1.0 < each / 2.0 < 2.0 for each in candidates(2.0, 1))


@pytest.mark.parametrize("stepover", [None, 3.0, 5.9, 6.0])
def test_any_stepover_up_to_the_diameter_clears_all_that_the_tool_reaches(stepover: float | None) -> None:
    task = job_of(fig2(), 6.0, stepover)
    program = compute(task)
    assert measure(program, task).reachable_left_mm2 == 0
    assert program.strokes == 2


def test_a_stepover_of_more_than_the_diameter_is_refused() -> None:
    with pytest.raises(ParameterError, match="6 mm"):
        compute(job_of(fig2(), 6.0, 6.01))


def test_strokes_are_counted_by_depth_pass() -> None:
    assert compute(job_of(fig2(), 6.0, None, CutParameters(1, depth=3.0, stepdown=1.0))).strokes == 3 * 2


@pytest.mark.parametrize("direction", list(Direction))
@pytest.mark.parametrize("outside_in", [False, True])
def test_metal_is_on_the_same_side_in_both_orders(direction: Direction, outside_in: bool) -> None:
    """Round pocket: from inside out the metal is outside, from outside in it is inside: the sense of rotation turns
    round.
    """
    chosen = shortest(
        sheet_of(nest([circle(20)])), replace(WANTED, link_options=LinkOptions(direction, outside_in)), (1.7,)
    )
    (stroke,) = chosen.strokes
    rings = stroke.rows[(stroke.rows[:, 7] != 0) & (stroke.purpose == Purpose.POCKET)]
    assert set(rings[:, 7]) == {1.0 if (direction is Direction.CLIMB) != outside_in else -1.0}
    growth = np.diff(rings[:, 6])
    assert np.all(growth <= 1e-9) if outside_in else np.all(growth >= -1e-9)


def test_a_straight_chain_of_rings_is_gone_without_a_way_back() -> None:
    chosen = shortest(sheet_of(nest([circle(20)])), WANTED, (1.7,))
    (stroke,) = chosen.strokes
    bridges = float(lengths(stroke.rows[stroke.purpose == Purpose.LINK]).sum())
    trips = sum(trip.length for trip in chosen.filling.detours)
    assert bridges <= (len(chosen.levels) - 1) * 1.7 + trips + 1e-6


def test_clamps_are_kept_off_by_bridges_and_runs_too() -> None:
    contours = [square(60), replace(circle(6, 20, 33), layer="clamps"), replace(square(8, 36, 14), layer="clamps")]
    task = replace(job_of(contours, 4.0), keep_out_layers=("clamps",))
    program = compute(task)
    assert program.strokes == 1
    held = DistanceField.of(pack(nest(contours[1:])).rows)
    moves = program.moves
    low = moves.end[moves.end[:, 2] < 0]
    assert held.nearest(low[:, :2])[0].min() >= 2.0 - 1e-3


def bone(width: float) -> Contour:
    y0, y1 = 10 - width / 2, 10 + width / 2
    right = [(20, 0), (20, y0), (30, y0), (30, 0), (50, 0), (50, 20), (30, 20), (30, y1)]
    return polygon_contour([(0, 0), *right, (20, y1), (20, 20), (0, 20)])


@pytest.mark.parametrize("width", [0.2, 1.0, 2.5, 3.5, 3.99, 3.9985])
def test_a_neck_is_as_wide_as_it_is_and_never_wider_than_the_tool_needs(width: float) -> None:
    x, y, told = neck_of(bone(width), 4.0)
    assert told <= 4.0 - 1e-3 and told == pytest.approx(width, abs=0.03)
    assert 18 <= x <= 32 and y == pytest.approx(10, abs=0.6)


def test_a_neck_round_the_corner_is_found_there_and_not_in_the_wall_between_the_rooms() -> None:
    """Two rooms side by side, 0.5 mm of wall between them, joined by a passage 2 mm wide far above."""
    left, right = [(19.75, 0), (19.75, 38)], [(20.25, 38), (20.25, 0)]
    contour = polygon_contour([(0, 0), *left, *right, (40, 0), (40, 30), (30, 40), (10, 40), (0, 30)])
    x, y, told = neck_of(contour, 4.0)
    assert told == pytest.approx(2.0, abs=0.05)
    assert abs(x - 20) < 1 and 37.9 < y < 40


def test_many_necks_are_told_together() -> None:
    rooms = [(k * 12.0, k * 12.0 + 10.0) for k in range(30)]
    low = [point for a, b in rooms for point in ((a, 0.0), (b, 0.0), (b, 4.0), (b + 2, 4.0))][:-2]
    high = [point for a, b in reversed(rooms) for point in ((b, 10.0), (a, 10.0), (a, 6.0), (a - 2, 6.0))][:-2]
    program = compute(job_of([polygon_contour([*low, *high])], 4.0))
    told = [finding for finding in program.findings if finding.kind is FindingKind.NECK_TOO_NARROW]
    assert len(told) == 21 and "9 more necks" in told[-1].text + told[0].text


def test_a_region_in_one_part_has_no_neck() -> None:
    primitives = pack(nest([square(20)]))
    assert necks(OffsetLevel(2.0, ()), primitives, DistanceField.of(primitives.rows), Tool(1, 4.0)) == []
    assert not [f for f in compute(job_of([square(20)], 4.0)).findings if f.kind is FindingKind.NECK_TOO_NARROW]
