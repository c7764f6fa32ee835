"""Depth passes: what is cut at which height, when the tool is lifted, and that nothing is touched on the way."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st

from app.core.errors import HitofudeError, ParameterError
from app.geometry.primitives import lengths
from app.model.entry import Entry, EntryKind
from app.model.finding import FindingKind
from app.model.job import Stock
from app.model.moves import MoveKind, Moves, Purpose
from app.model.operation import CutParameters, Direction, PocketOperation
from app.toolpath.build import Stroke
from app.toolpath.depth import pass_heights
from app.toolpath.entry.entry import EntryContext, keeps_off_walls
from app.usecases.making.make import export
from tests.examples import examples
from tests.part_shapes import circle, square
from tests.toolpath.emitting import TOOL, contour_operation, emitted, lifts, loop, path, setting_of
from tests.usecases.test_random_jobs import random_job

PLUNGE = Entry(EntryKind.PLUNGE)


def deep(depth: float = 6.0, stepdown: float = 2.0, **cut: object) -> PocketOperation:
    return PocketOperation(CutParameters(1, depth, stepdown, **cut))  # type: ignore[arg-type]


def heights(moves: Moves, purpose: Purpose = Purpose.POCKET) -> list[float]:
    """At which a purpose is cut, in order."""
    return list(dict.fromkeys(moves.end[moves.purpose == purpose, 2].round(9).tolist()))


@pytest.mark.parametrize(
    ("depth", "step", "finish", "expected"),
    [
        (6.0, 2.0, 0.0, (-2, -4, -6)),
        (5.0, 2.0, 0.0, (-5 / 3, -10 / 3, -5)),
        (6.0, 2.0, 0.3, (-1.9, -3.8, -5.7, -6)),
        (2.0, 5.0, 0.0, (-2,)),
        (2.0, 5.0, 0.5, (-1.5, -2)),
        (0.3, 0.1, 0.0, (-0.1, -0.2, -0.3)),
    ],
)
def test_passes_are_equal_but_for_the_one_that_finishes(
    depth: float, step: float, finish: float, expected: tuple[float, ...]
) -> None:
    found = pass_heights(depth, step, finish)
    assert found == pytest.approx(expected) and found[-1] == -depth
    assert max(np.diff((0.0, *(-z for z in found)))) <= step + 1e-9


def test_the_floor_is_left_as_thick_as_asked() -> None:
    moves = emitted(
        setting_of(operation=deep(6.0, 3.0, floor_to_leave=0.5, finish_depth=0.25)), [path([(20, 20), (60, 20)])]
    )
    assert heights(moves) == pytest.approx([-2.625, -5.25, -5.5])


def test_deeper_than_the_stock_is_refused() -> None:
    with pytest.raises(ParameterError, match="stock is 5 mm thick"):
        emitted(setting_of(operation=deep(6.0), stock=Stock(thickness=5.0)), [path([(20, 20), (60, 20)])])


def test_no_strokes_make_no_moves() -> None:
    assert len(emitted(setting_of(), [])) == 0


def test_a_closed_path_goes_down_in_place() -> None:
    moves = emitted(setting_of(operation=deep()), [loop(square(40, 20, 20), Purpose.POCKET)])
    assert lifts(moves) == 1 and heights(moves) == [-2, -4, -6]
    assert not np.any(moves.purpose == Purpose.LINK)


def test_an_open_path_is_gone_back_over_cut_ground_where_that_is_quicker() -> None:
    short, long = ([(20.0, 20.0), (20.0 + size, 20.0)] for size in (8.0, 70.0))
    moves = emitted(setting_of(operation=deep()), [path(short)])
    assert lifts(moves) == 1 and heights(moves, Purpose.LINK) == [-2, -4]
    assert lifts(emitted(setting_of(operation=deep()), [path(long)])) == 3


def test_a_hook_is_gone_straight_across_only_when_that_is_cut() -> None:
    hook = [(20.0, 20.0), (60.0, 20.0), (60.0, 27.0), (20.0, 27.0)]
    moves = emitted(setting_of(operation=deep()), [path(hook)])
    assert lifts(moves) == 3  # 1 mm of metal stands between its arms
    near = [(20.0, 20.0), (12.0, 20.0), (60.0, 20.0), (60.0, 25.0), (12.0, 25.0), (20.0, 25.0)]
    moves = emitted(setting_of(operation=deep()), [path(near)])
    link = moves.purpose == Purpose.LINK
    assert lifts(moves) == 1 and moves.lengths()[link] == pytest.approx([5.0, 5.0])


def test_no_way_leads_past_a_wall_nearer_than_a_path() -> None:
    setting = setting_of((square(60), circle(0.01, 20, 25)))
    sheet = setting.areas.of(setting.job.operations[0])
    assert sheet is not None
    ground = EntryContext(TOOL, Entry(), sheet.distances, 3.0, True, Direction.CLIMB, setting.cleared)
    assert not keeps_off_walls((10.0, 25.0), (30.0, 25.0), ground) and not keeps_off_walls(
        (10.0, 28.0), (30.0, 28.0), ground
    )
    assert keeps_off_walls((10.0, 28.02), (30.0, 28.02), ground) and not keeps_off_walls(
        (4.0, 4.0), (4.0, 62.0), ground
    )


def test_strokes_side_by_side_are_joined_over_cut_ground() -> None:
    strokes = [path([(20, 20), (40, 20)]), path([(42, 40), (20, 40)])]
    assert lifts(emitted(setting_of(operation=deep(2.0)), strokes)) == 2  # between them metal stands
    strokes = [path([(20, 20), (43, 20)]), path([(42, 22), (20, 22)])]
    moves = emitted(setting_of(operation=deep(2.0)), strokes)
    assert lifts(moves) == 1 and np.all(moves.end[moves.purpose == Purpose.LINK, 2] == -2)


def test_a_lead_in_is_gone_back_to_along_the_path_that_passes_it_again() -> None:
    ring = [(50.0, 20.0), (80.0, 20.0), (80.0, 80.0), (20.0, 80.0), (20.0, 20.0), (50.5, 20.0)]
    body = path(ring, Purpose.CONTOUR)
    lead_in, lead_out = (
        path([(47.0, 23.0), (50.0, 20.0)], Purpose.LEAD),
        path([(50.5, 20.0), (58.0, 27.0)], Purpose.LEAD),
    )
    stroke = lead_in.and_then(body).and_then(lead_out)
    moves = emitted(setting_of(operation=contour_operation(depth=6.0, stepdown=2.0)), [stroke])
    assert lifts(moves) == 1
    link = moves.lengths()[moves.purpose == Purpose.LINK].sum() / 2
    assert link == pytest.approx(np.hypot(7.5, 7) + 0.5 + np.hypot(3, 3))


def tabbed() -> Stroke:
    stroke = path([(20, 20), (40, 20), (46, 20), (70, 20)], Purpose.CONTOUR)
    return replace(stroke, purpose=np.array([2, 7, 2], np.uint8), least_z=np.array([-np.inf, -3.0, -np.inf]))


def test_tabs_are_gone_over_and_stepped_straight() -> None:
    moves = emitted(setting_of(operation=contour_operation(depth=6.0, stepdown=2.0, entry=PLUNGE)), [tabbed()])
    low = moves.end[:, 2] < -3
    over = (np.minimum(moves.start[:, 0], moves.end[:, 0]) < 46) & (np.maximum(moves.start[:, 0], moves.end[:, 0]) > 40)
    assert not np.any(low & over)
    steps = (moves.end[:, 2] != moves.start[:, 2]) & (moves.kind == MoveKind.LINE)
    assert np.all(moves.end[steps, :2] == moves.start[steps, :2])
    assert moves.feed[steps & (moves.end[:, 2] < moves.start[:, 2]) & (moves.start[:, 0] == 46)].tolist() == [
        200.0,
        200.0,
    ]


def test_arcs_under_a_tab_stay_apart_and_others_become_one() -> None:
    ring = loop(circle(20, 50, 50))
    assert len(ring.rows) > 2
    least = np.full(len(ring.rows), -np.inf)
    least[1] = -1.0
    moves = emitted(setting_of(operation=contour_operation(entry=PLUNGE)), [replace(ring, least_z=least)])
    assert np.all(moves.end[(moves.kind >= MoveKind.ARC_CW), 2].round(3) >= -2) and -1.0 in moves.end[:, 2]
    plain = emitted(setting_of(operation=contour_operation(entry=PLUNGE)), [ring])
    assert int((plain.kind >= MoveKind.ARC_CW).sum()) == 2


def test_what_is_for_the_floor_is_cut_there_alone_and_what_follows_stays_behind() -> None:
    rough, finish = path([(20, 20), (60, 20)], Purpose.CONTOUR), path([(20, 21), (60, 21)], Purpose.LEAD)
    far = path([(20, 80), (60, 80)], Purpose.TAB)
    moves = emitted(
        setting_of(operation=deep()), [rough, replace(finish, at_floor=True, follows=True), replace(far, rank=-1)]
    )
    cuts = [Purpose(p) for p in moves.purpose.tolist() if p in (Purpose.CONTOUR, Purpose.LEAD, Purpose.TAB)]
    assert cuts == [Purpose.TAB] * 3 + [Purpose.CONTOUR] * 3 + [Purpose.LEAD]
    assert heights(moves, Purpose.LEAD) == [-6]


def test_where_everything_is_cut_no_metal_is_entered() -> None:
    setting = setting_of(operation=deep())
    emitted(setting, [loop(square(40, 20, 20), Purpose.POCKET)])
    count = len(setting.builder.moves())
    again = emitted(setting, [loop(square(40, 20, 20), Purpose.POCKET)]).part(count, 10_000)
    assert not np.any((again.purpose == Purpose.PLUNGE) & (np.hypot(*(again.end - again.start)[:, :2].T) > 0))
    fast = (again.purpose == Purpose.PLUNGE) & (again.start[:, 2] > -1)
    # slowly only over the last 1 mm
    assert again.feed[fast].tolist() == [600.0] and again.end[fast, 2].tolist() == [-1.0]
    low = again.kind == MoveKind.RAPID
    assert np.all((again.end[low, 2] >= 1.0) | (again.end[low, 2] > again.start[low, 2]))


def test_every_pass_cuts_all_of_every_stroke() -> None:
    strokes = [loop(square(20, 10 + 25 * i, 10 + 25 * j), Purpose.POCKET) for i in range(3) for j in range(3)]
    moves = emitted(setting_of(operation=deep()), strokes)
    assert moves.lengths()[moves.purpose == Purpose.POCKET].sum() == pytest.approx(
        3 * sum(lengths(s.rows).sum() for s in strokes)
    )


@pytest.mark.exhaustive
@settings(max_examples=examples(4), deadline=None, phases=(Phase.explicit, Phase.generate))
@given(st.integers(1000, 10**6), st.sampled_from(EntryKind))
def test_random_jobs_are_cut_without_a_rapid_in_metal_or_a_gouge(seed: int, kind: EntryKind) -> None:
    job = random_job(seed)
    changes = {"depth": 3.0, "stepdown": 1.0, "entry": Entry(kind), "finish_depth": 0.2}
    operations = tuple(replace(op, cut=replace(op.cut, **changes)) for op in job.operations)  # type: ignore[arg-type]
    try:
        made = export(replace(job, operations=operations))
    except HitofudeError as error:
        assert str(error).endswith(".")
        return
    assert made.report.data["gouge"]["max_mm"] <= 1e-3
    assert made.report.data["rapids_in_material"] == []
    unsafe = {FindingKind.GOUGE, FindingKind.RAPID_IN_MATERIAL, FindingKind.START_IN_STOCK, FindingKind.BELOW_TABLE}
    assert not unsafe & {finding.kind for finding in made.findings}
