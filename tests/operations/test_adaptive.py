"""Adaptive clearing: closed forms of the engaged angle, whole pockets looked at densely, smooth paths."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
import shapely
from numpy.typing import NDArray

from app.core.errors import ParameterError
from app.geometry.outlines import nest, polygon_contour
from app.geometry.primitives import lengths, pack, sample, within_half_turn
from app.model.adaptive_operation import AdaptiveOperation
from app.model.entry import Entry, EntryKind
from app.model.finding import FindingKind
from app.model.job import Job
from app.model.moves import MoveKind, Purpose
from app.model.operation import CutParameters, Direction
from app.model.part import Contour, Entity, Part, Units
from app.model.tool import Tool
from app.operations.adaptive.limit import EngagementLimit
from app.operations.adaptive.plan import ClearingTask, mirrored, mirrored_part, plan
from app.operations.adaptive.plan import ConnectedPath as Cleared
from app.operations.adaptive.spiral import spiral
from app.operations.compute import compute
from app.toolpath.coverage.areas import move_rows
from tests.operations.engaged import at, engaged, size
from tests.part_shapes import bulged, circle, fig2, random_star, square

R, ANGLE = 3.0, math.radians(53.13)
LIMIT = EngagementLimit(R, ANGLE)
MORE = math.radians(0.1)
HARDLY = 0.02
"""Radians of the rim that metal of half a micrometre takes: what ways along metal leave may be as thick."""

Floats = NDArray[np.float64]


def rectangle(wide: float, high: float) -> Contour:
    return polygon_contour([(0, 0), (wide, 0), (wide, high), (0, high)])


SHAPES: dict[str, Sequence[Contour]] = {
    "square": [square(10)],
    "circle": [circle(8)],
    "rectangle": [rectangle(30, 14)],
    "slot a bit wider than the tool": [rectangle(16, 6.4)],
    "ring round a boss": [circle(15), circle(6)],
    "ring round a boss that is not in the middle": [circle(20), circle(6, 5)],
    "L": [polygon_contour([(0, 0), (30, 0), (30, 9), (11, 9), (11, 24), (0, 24)])],
    "neck": [
        polygon_contour(
            [
                (0, 0),
                (12, 0),
                (12, 3),
                (18, 3),
                (18, 0),
                (30, 0),
                (30, 13),
                (18, 13),
                (18, 9.6),
                (12, 9.6),
                (12, 13),
                (0, 13),
            ]
        )
    ],
    "acute": [polygon_contour([(0, 0), (40, 0), (37, 16)])],
    "obtuse": [polygon_contour([(0, 0), (20, -1.4), (40, 0), (40, 14), (0, 14)])],
    "arcs": [bulged([(0, 0, 0.4), (20, 0, 0), (20, 12, -0.3), (0, 12, 0.1)])],
    "two islands": [rectangle(50, 28), circle(4, 14, 14), circle(5, 33, 13)],
    "star": [
        polygon_contour(
            [
                (
                    20 * math.cos(k * math.pi / 5) * (1 - 0.45 * (k % 2)),
                    20 * math.sin(k * math.pi / 5) * (1 - 0.45 * (k % 2)),
                )
                for k in range(10)
            ]
        )
    ],
}
QUICK = ("square", "circle")
EACH = [name if name in QUICK else pytest.param(name, marks=pytest.mark.exhaustive) for name in SHAPES]


def planned(contours: Sequence[Contour], limit: EngagementLimit = LIMIT, leave: float = 0.0) -> tuple[Cleared, ...]:
    return plan(ClearingTask(pack(nest(contours)), leave, 60.0), limit)


def path_of(part: Cleared) -> tuple[Floats, NDArray[np.bool_]]:
    return np.concatenate([run.rows for run in part.runs]), np.concatenate([run.clear for run in part.runs])


def area_of(contours: Sequence[Contour]) -> shapely.Geometry:
    shapes = [shapely.Polygon(sample(pack(nest([each])).rows, 1e-4)) for each in contours]
    area = shapes[0]
    for each in shapes[1:]:
        area = area.symmetric_difference(each)
    return area


def swept(rows: Floats, radius: float) -> shapely.Geometry:
    lines = [
        shapely.LineString(np.concatenate([sample(within_half_turn(row[None]), 1e-3), row[None, 2:4]])) for row in rows
    ]
    return shapely.union_all(shapely.buffer(lines, radius, quad_segs=64))


def greatest(rows: Floats, radius: float = R, step: float = 0.5) -> tuple[float, float]:
    """(the first turn, which is part of the entry; everything after it), radians."""
    most = [float(each.max()) for each in engaged(rows, radius, step=step)]
    return max(most[:2]), max(most[2:])


def engaged_angle(turn: float, clear: float) -> float:
    """A bound of the engaged angle along a circle of radius `turn`, where no metal is within `clear` of its centre."""
    return math.acos((clear * clear - turn * turn - R * R) / (2 * turn * R))


def test_along_a_circle_beside_a_cleared_one_the_angle_is_greatest_where_the_formula_says() -> None:
    cleared, away, turn = 20.0, 0.5, 20.0 - R
    bound = engaged_angle(turn, cleared - away)
    assert math.degrees(bound) == pytest.approx(36.2570, abs=1e-4)
    first = [(x, 0.0, -x, 0.0, 0.0, 0.0, turn, 1.0) for x in (turn, -turn)]
    rows = np.array([*first, (away, -turn, away, turn, away, 0.0, turn, 1.0)])
    inner = spiral((0.0, 0.0), turn, LIMIT, turn)
    seen = engaged(np.concatenate([inner[-2:], rows[2:]]), R, step=0.05)[-1].max()
    assert seen == pytest.approx(bound, abs=2e-4)


@pytest.mark.parametrize("radius", [3.2, 5.0, 20.0])
def test_a_circle_about_the_origin_has_a_path(radius: float) -> None:
    assert len(planned([circle(radius)])) == 1


@pytest.mark.parametrize("turn", [0.5, 3.0, 40.0])
def test_ground_that_is_just_clear_enough_gives_the_planned_angle(turn: float) -> None:
    assert engaged_angle(turn, LIMIT.clear_needed(turn) - LIMIT.slack) == pytest.approx(LIMIT.planned, abs=1e-12)
    straight = EngagementLimit(R, ANGLE).depth
    assert straight == pytest.approx(R * (1 - math.cos(LIMIT.planned)))


def test_a_spiral_is_engaged_by_the_limit_all_the_way_and_clears_its_disc() -> None:
    rows = spiral((2.0, 1.0), 6.0, LIMIT, 0.05)
    _, most = greatest(rows, step=0.1)
    assert LIMIT.planned - math.radians(2) < most < ANGLE + MORE
    assert rows[-1, 6] == 6.0 and rows[-1, 4:6].tolist() == [2.0, 1.0]
    assert shapely.Point(2, 1).buffer(9 - 1e-3, quad_segs=64).difference(swept(rows, R)).area < 1e-6
    assert np.abs(rows[1:, :2] - rows[:-1, 2:4]).max() < 1e-12


TIPS = {"acute": LIMIT.least_turn * (1 / math.sin(math.atan2(16, 37) / 2) - 1) / 2 + 1e-4}
"""mm; half of what stands in the tip: digits allow no smaller circle there, and the report tells what is left."""


@pytest.mark.parametrize("name", EACH)
def test_a_whole_area_is_cleared_within_the_limit(name: str) -> None:
    contours = SHAPES[name]
    (part,) = planned(contours)
    assert not part.stops and not part.unproven
    rows, clear = path_of(part)
    seen = engaged(rows, R)
    assert max(float(each.max()) for each in seen[2:]) < ANGLE + MORE
    assert max((float(each.max()) for each, free in zip(seen, clear, strict=True) if free), default=0.0) < HARDLY
    area, cut = area_of(contours), swept(rows, R)
    left = area.buffer(-R, quad_segs=64).buffer(R - 1e-3, quad_segs=64).difference(cut)
    assert left.buffer(-TIPS.get(name, 0.006)).is_empty
    assert cut.difference(area).buffer(-2e-3).is_empty


@pytest.mark.parametrize("name", EACH)
def test_paths_are_lines_and_arcs_that_touch(name: str) -> None:
    (part,) = planned(SHAPES[name])
    for run in part.runs:
        rows = run.rows[np.array([size(row) for row in run.rows]) > 1e-6]
        assert np.abs(run.rows[1:, :2] - run.rows[:-1, 2:4]).max() < 1e-7
        ahead = np.array([at(row, np.array([0.0, 1.0]))[1] for row in rows])
        turn = (ahead[1:, 0] - ahead[:-1, 1] + math.pi) % math.tau - math.pi
        assert np.abs(turn).max() < 2e-3


@pytest.mark.parametrize("degrees", [pytest.param(30.0, marks=pytest.mark.exhaustive), 90.0])
def test_other_limits_hold_as_well(degrees: float) -> None:
    limit = EngagementLimit(R, math.radians(degrees))
    (part,) = planned([rectangle(11, 9)], limit)
    _, most = greatest(path_of(part)[0], step=0.5)
    assert limit.angle - math.radians(3) < most < limit.angle + MORE


def test_a_smaller_limit_is_a_longer_path() -> None:
    long = []
    for degrees in (40.0, 60.0, 80.0):
        (part,) = planned([rectangle(20, 11)], EngagementLimit(R, math.radians(degrees)))
        rows, clear = path_of(part)
        long.append(float(lengths(rows)[~clear].sum()))
    assert long[0] > 1.3 * long[1] > 1.5 * long[2]


def test_a_mirror_changes_sides_and_nothing_else() -> None:
    shape = [polygon_contour([(0, 0), (13, 0), (13, 8), (0, 11)])]
    walls = pack(nest(shape))
    twice = mirrored(mirrored(walls))
    assert np.array_equal(twice.rows, walls.rows) and np.array_equal(twice.previous, walls.previous)
    (part,) = plan(ClearingTask(mirrored(walls), 0.0, 60.0), LIMIT)
    rows, _ = path_of(mirrored_part(part))
    assert greatest(rows, step=1.0)[1] < ANGLE + MORE
    assert set(rows[:20, 7].tolist()) == {-1.0}
    assert swept(rows, R).difference(area_of(shape)).buffer(-2e-3).is_empty


@pytest.mark.parametrize("seed", [pytest.param(k, marks=pytest.mark.exhaustive) if k else 0 for k in range(12)])
def test_random_areas_keep_the_limit(seed: int) -> None:
    rng = np.random.default_rng(seed)
    contour = random_star(rng, (0.0, 0.0), (4.0, 9.0), 0.0)
    limit = EngagementLimit(1.5, math.radians(float(rng.uniform(50, 85))))
    for part in planned([contour], limit):
        assert not part.unproven
        assert greatest(path_of(part)[0], 1.5, 0.3)[1] < limit.angle + MORE


def job_of(contours: Sequence[Contour], operation: AdaptiveOperation | None = None) -> Job:
    entities = tuple(Entity(k, c, "0") for k, c in enumerate([p for each in contours for p in each.primitives], 1))
    return Job(
        Part().with_entities(entities),
        tools=(Tool(1, 6.0),),
        operations=(operation or AdaptiveOperation(CutParameters(1), ANGLE),),
    )


def test_a_job_clears_at_every_depth_and_lifts_on_the_way_back() -> None:
    program = compute(
        job_of([rectangle(15, 11)], AdaptiveOperation(CutParameters(1, depth=4.0, stepdown=2.0), ANGLE, 0.2))
    )
    moves = program.moves
    assert not [finding for finding in program.findings if finding.counts]
    cut = moves.purpose == Purpose.POCKET
    assert set(moves.end[cut, 2].round(9).tolist()) == {-2.0, -4.0}
    links = moves.end[moves.purpose == Purpose.LINK, 2]
    assert {-1.8, -3.8} <= set(links.round(9).tolist()) <= {-2.0, -1.8, -4.0, -3.8}
    assert program.strokes == 2
    arcs = moves.kind[cut & (moves.kind != MoveKind.LINE)]
    assert (arcs == MoveKind.ARC_CCW).all()


def test_conventional_cuts_have_the_metal_on_their_other_side() -> None:
    cut = CutParameters(1, direction=Direction.CONVENTIONAL)
    moves = compute(job_of([rectangle(11, 9)], AdaptiveOperation(cut, ANGLE))).moves
    cutting = (moves.purpose == Purpose.POCKET) & (moves.kind != MoveKind.LINE)
    assert (moves.kind[cutting] == MoveKind.ARC_CW).all()
    assert (
        greatest(move_rows(moves)[np.isin(moves.purpose, (Purpose.POCKET, Purpose.LINK))], step=1.0)[1] < ANGLE + MORE
    )


def test_stock_to_leave_stays_on_all_walls() -> None:
    (part,) = planned([square(16)], leave=0.5)
    rows, _ = path_of(part)
    assert swept(rows, R).difference(shapely.box(0.5, 0.5, 15.5, 15.5)).buffer(-2e-3).is_empty
    assert np.abs(np.array(swept(rows, R).bounds) - [0.5, 0.5, 15.5, 15.5]).max() < 1e-3


@pytest.mark.parametrize("kind", list(EntryKind))
def test_every_entry_ends_where_the_first_turn_begins(kind: EntryKind) -> None:
    cut = CutParameters(1, entry=Entry(kind))
    program = compute(job_of([square(20)], AdaptiveOperation(cut, ANGLE)))
    moves = program.moves
    first = int(np.argmax(moves.purpose == Purpose.POCKET))
    assert (moves.end[first - 3 : first, 2] == -2.0).all()
    told = [finding for finding in program.findings if finding.kind is FindingKind.ENTRY]
    assert bool(told) == (kind is EntryKind.PREDRILLED)


def test_what_is_too_narrow_is_told_and_not_slotted() -> None:
    narrow = polygon_contour(
        [
            (0, 0),
            (14, 0),
            (14, 4),
            (24, 4),
            (24, 0),
            (38, 0),
            (38, 14),
            (24, 14),
            (24, 10.02),
            (14, 10.02),
            (14, 14),
            (0, 14),
        ]
    )
    program = compute(job_of([narrow]))
    (neck,) = [finding for finding in program.findings if finding.kind is not FindingKind.AREA]
    assert neck.kind is FindingKind.NECK_TOO_NARROW
    assert neck.amount == pytest.approx(6.02, abs=2e-3) and 14 <= (neck.x or 0) <= 24
    cut = program.moves.end[program.moves.purpose == Purpose.POCKET]
    assert not ((cut[:, 0] > 15) & (cut[:, 0] < 23)).any()
    (small,) = [f for f in compute(job_of([square(6.05)])).findings if f.kind is FindingKind.REGION_TOO_SMALL]
    assert small.counts


def test_too_deep_is_refused() -> None:
    with pytest.raises(ParameterError, match="the stock is 10 mm thick"):
        compute(job_of([square(20)], AdaptiveOperation(CutParameters(1, depth=11.0, stepdown=11.0), ANGLE)))


def test_coarser_digits_ask_for_more_room() -> None:
    job = replace(job_of([square(14)]), out_units=Units.INCH)
    assert not [finding for finding in compute(job).findings if finding.counts]


@pytest.mark.exhaustive
def test_figure_2_in_both_its_areas() -> None:
    for part in planned(fig2()):
        assert greatest(path_of(part)[0], step=0.5)[1] < ANGLE + MORE
