"""Engagement against closed forms, against one-dimensional arithmetic, and against exact distances to every earlier
move.
"""

from __future__ import annotations

import math
import threading
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from app.core.errors import Cancelled
from app.core.progress import Progress
from app.formats.readers import read_drawing
from app.geometry.primitives import lengths, points_at
from app.model.contour_operation import ContourOperation
from app.model.job import Job, Stock
from app.model.moves import MoveKind, Program
from app.model.operation import CutParameters, PocketOperation
from app.model.part import Region
from app.model.stock_box import stock_box
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.operations.compute import compute
from app.toolpath.coverage.areas import move_rows
from app.toolpath.engagement import engagement as engagement_field
from app.toolpath.engagement import engagement as engagement_module
from app.toolpath.engagement import places as engagement_places
from app.toolpath.engagement.engagement import engagement, sample_engagement
from app.toolpath.engagement.places import chain_begins, places
from tests.examples import examples
from tests.gcode.programs import Path, job, square
from tests.part_shapes import fig2

D, R = 6.0, 3.0
JOB = job(
    operations=(PocketOperation(CutParameters(tool=1)), PocketOperation(CutParameters(tool=2))), stock=Stock(0.0, 10.0)
)
PLATE = square(-60, -60, 60, 60)


def shares(path: Path, region: Region = PLATE, of: Job = JOB) -> np.ndarray:
    return engagement(path.program(region), of).shares


def bound(path: Path, region: Region = PLATE, tool: int = 1) -> float:
    return sample_engagement(path.program(region), JOB).bound(tool)


def turned(angle: float, x: float, y: float) -> tuple[float, float]:
    return x * math.cos(angle) - y * math.sin(angle), x * math.sin(angle) + y * math.cos(angle)


def along(path: Path, angle: float, y: float, x0: float = -12.0, x1: float = 12.0, z: float = -1.0) -> Path:
    """Add a straight pass, turned about the origin."""
    return path.into_work(*turned(angle, x0, y), z).line(*turned(angle, x1, y), z).out_of_work()


def share_of(angle: float) -> float:
    return (1 - math.cos(angle)) / 2


def test_a_slot_in_full_stock_takes_the_whole_diameter() -> None:
    found = engagement(along(Path(), 0.3, 0.0).program(PLATE), JOB)
    assert found.shares.tolist() == [0, 0, 0, 1, 0]
    assert found.most == 1 and found.largest.tolist() == [1, 0]
    assert found.lengths.sum() == pytest.approx(24)
    assert found.above(0.99) > 0.9 and found.above(1.0) == 0


@settings(max_examples=examples(60), deadline=None)
@given(st.floats(0, math.tau), st.floats(0.02, D - 0.02), st.booleans(), st.floats(-1, 1))
def test_a_side_pass_takes_its_stepover(angle: float, step: float, left: bool, shift: float) -> None:
    path = along(along(Path(), angle, shift), angle, shift + step if left else shift - step, -4, 8)
    seen = sample_engagement(path.program(PLATE), JOB)
    inside = seen.first > seen.begin[8] + R
    assert inside.sum() > 10
    assert np.abs(seen.share[inside] - step / D).max() <= seen.bound(1)


@pytest.mark.parametrize("back", [False, True])
def test_a_second_pass_over_what_is_cut_takes_nothing(back: bool) -> None:
    path = along(Path(), 0.7, 0.0)
    path = along(path, 0.7, 0.0, 12, -12) if back else along(path, 0.7, 0.0)
    assert shares(path)[8] == 0


def test_a_small_cutter_within_a_slot_takes_nothing_and_a_large_one_takes_both_sides() -> None:
    path = along(Path(), 0.2, 0.0)
    path.tool, path.operation = 2, 1
    along(path, 0.2, 1.2)
    assert shares(path)[8] == 0
    path = along(Path(tool=2, operation=1), 0.2, 0.0)
    path.tool, path.operation = 1, 0
    along(path, 0.2, 0.0, -4, 8)
    both = 2 * math.acos(1.5 / R)
    assert shares(path)[8] == pytest.approx(share_of(both), abs=2 * bound(path))


def test_every_depth_counts_for_itself() -> None:
    path = Path()
    for z in (-2.0, -1.0, -3.0, -3.0 - 1e-4):
        along(path, 0.0, 0.0, z=z)
    assert shares(path)[[3, 8, 13, 18]].tolist() == [1, 0, 1, 0]


@pytest.mark.parametrize("ccw", [True, False])
def test_a_ring_outside_of_one_and_inside_of_one(ccw: bool) -> None:
    for first, second in ((12.0, 16.0), (16.0, 12.0), (8.0, 10.5), (10.5, 8.0), (10.0, 6.0)):
        path = Path()
        for radius in (first, second):
            path.into_work(radius, 0.0).arc((radius, 0.0, -1.0), (0.0, 0.0), ccw).out_of_work()
        edge = first + R if second > first else first - R
        cosine = (edge**2 - second**2 - R**2) / (2 * second * R)
        angle = math.acos(cosine) if second > first else math.acos(-cosine)
        seen = sample_engagement(path.program(PLATE), JOB)
        inside = seen.share[(seen.first > seen.begin[8] + R) & (seen.last < seen.end[8] - 2.5 * R)]
        # the rim is looked at a little inside, where it meets the round edge elsewhere
        curved = seen.pitches[1] / (2 * second)
        assert np.abs(inside - share_of(angle)).max() <= seen.bound(1) + curved


def test_beyond_the_stock_there_is_nothing_to_cut() -> None:
    plate = square(0, 0, 40, 30)
    path = along(along(Path(), 0.0, -R, 0, 40), 0.0, 30.0, 0, 40)
    assert shares(path, plate)[3] == 0
    assert shares(path, plate)[8] == pytest.approx(0.5, abs=bound(path, plate))
    for angle, ends in ((0.0, (0, 40)), (0.5, (0, 30)), (1.0, (-40, 0)), (1.5, (-30, 0))):
        for inside, share in ((0.0, 0.5), (-R, 0.0)):
            side = {0.0: 0.0, 0.5: -40.0, 1.0: -30.0, 1.5: 0.0}[angle] + inside
            once = along(Path(), angle * math.pi, side, *ends)
            assert shares(once, plate)[3] == pytest.approx(share, abs=bound(once, plate))
    wide = replace(JOB, stock=Stock(20.0, 10.0))
    assert shares(path, plate, wide)[[3, 8]].tolist() == [1, 1]


def test_cuts_above_the_stock_and_straight_down_take_nothing() -> None:
    path = along(Path(), 0.0, 0.0, z=0.5).into_work(20, 20, -5).out_of_work()
    assert shares(path).max() == 0


def test_ramps_and_helices_are_slots_until_they_run_in_their_own_way() -> None:
    path = (
        Path()
        .rapid(0, 0, 5)
        .rapid(0, 0, 0.5)
        .line(10, 0, -1)
        .line(0, 0, -2)
        .line(10, 0, -2)
        .line(0, 0, -2)
        .out_of_work()
    )
    assert shares(path)[[2, 3, 4, 5]] == pytest.approx([1, 1, 1, 0], abs=bound(path))
    path = Path().rapid(2, 0, 5).rapid(2, 0, 0)
    for z in (-1, -2, -2, -2):
        path.arc((2, 0, z), (0, 0))
    assert shares(path)[2] > 0.9 and shares(path)[3] > 0.9 and shares(path)[5] == 0


def test_passes_side_by_side_against_intervals_on_a_line() -> None:
    """At any depth, parallel passes clear intervals across them: what is left of the front is arithmetic."""
    rng = np.random.default_rng(5)
    front = (np.arange(20_000) + 0.5) / 20_000 * math.pi
    for _ in range(12):
        angle, path, done = rng.uniform(0, math.tau), Path(), []
        expected = []
        for _ in range(8):
            tool, y, z = int(rng.integers(1, 3)), rng.uniform(-8, 8), -float(rng.integers(1, 4))
            radius = JOB.tool(tool).radius
            path.tool, path.operation = tool, tool - 1
            along(path, angle, y, z=z)
            rim = y + radius * np.cos(front)
            cleared = np.zeros(len(front), bool)
            for centre, half, deep in done:
                cleared |= (np.abs(rim - centre) < half) & (deep <= z)
            edges = int(np.count_nonzero(np.diff(cleared))) + 1
            expected.append((share_of(math.pi * (1 - cleared.mean())), edges, tool))
            done.append((y, radius, z))
        seen = sample_engagement(path.program(PLATE), JOB)
        for k, (share, edges, tool) in enumerate(expected):
            move = 5 * k + 3
            inside = (seen.first > seen.begin[move] + 6) & (seen.last < seen.end[move] - 6)
            assert np.abs(seen.share[inside] - share).max() <= max(edges, 1) * seen.bound(tool)


def fig2_program() -> tuple[Program, Job]:
    from tests.operations.test_compute import job_of

    made = job_of(
        fig2(),
        operations=(PocketOperation(CutParameters(1, 2.0, 1.0), stepover=4.8), ContourOperation(CutParameters(2))),
        stock=Stock(1.0, 10.0),
    )
    return compute(made), made


def test_a_job_against_exact_distances_to_every_earlier_move() -> None:
    program, made = fig2_program()
    moves, rows = program.moves, move_rows(program.moves)
    seen, box = sample_engagement(program, made), stock_box(made, program.regions, program.lines)
    owner = np.repeat(
        np.arange(len(moves)), np.maximum(2, moves.lengths() / 0.05).astype(int) * (moves.kind != MoveKind.RAPID)
    )
    when = np.concatenate([np.linspace(0, 1 - 1e-9, n) for n in np.unique(owner, return_counts=True)[1]])
    spots, deep = points_at(rows[owner], when), (moves.start[owner, 2] * (1 - when) + moves.end[owner, 2] * when)
    radius = np.array([made.tool(int(number)).radius for number in moves.tool[owner]])
    tree, errors = cKDTree(spots), []
    angle = (np.arange(180) + 0.5) / 180 * math.pi - math.pi / 2
    for cell in np.random.default_rng(2).choice(len(seen.share), 300, replace=False):
        move = seen.owner[cell]
        at = np.clip(((seen.first + seen.last)[cell] / 2 - seen.begin[move]) / (seen.end - seen.begin)[move], 0, 1)
        here, on = points_at(rows[[move, move]], np.array([at, min(at + 1e-4, 1.0) if at < 0.9 else at - 1e-4]))
        ahead = (on - here) * (1 if at < 0.9 else -1)
        rim = here + made.tool(int(moves.tool[move])).radius * 1.0001 * np.column_stack(
            [np.cos(angle + math.atan2(ahead[1], ahead[0])), np.sin(angle + math.atan2(ahead[1], ahead[0]))]
        )
        near = np.array(tree.query_ball_point(here, 6.1))
        z = moves.start[move, 2] * (1 - at) + moves.end[move, 2] * at
        earlier = near[(owner[near] + when[near] < move + at) & (deep[near] <= z + 1e-3)]
        metal = (rim >= [box.x0, box.y0]).all(axis=1) & (rim <= [box.x1, box.y1]).all(axis=1)
        if len(earlier):
            away = np.linalg.norm(rim[:, None] - spots[earlier], axis=2) - radius[earlier]
            metal &= away.min(axis=1) > 1e-5
        errors.append((seen.share[cell] - share_of(math.pi * metal.mean())) / seen.bound(int(moves.tool[move])))
    assert abs(np.mean(np.clip(errors, -1, 1))) < 0.1
    assert np.quantile(np.abs(errors), 0.9) < 1
    assert np.quantile(np.abs(errors), 0.97) < 3  # the rest: just behind corners and plunges, where it changes at once


def test_what_is_seen_does_not_depend_on_how_moves_are_cut_in_pieces() -> None:
    program, made = fig2_program()
    moves, rng = program.moves, np.random.default_rng(3)
    flat = lengths(move_rows(moves))
    count = np.where((moves.kind == MoveKind.RAPID) | (flat < 0.5), 1, rng.integers(1, 4, len(moves)))
    owner = np.repeat(np.arange(len(moves)), count)
    fraction = (np.arange(len(owner)) - np.repeat(np.cumsum(count) - count, count) + 1) / count[owner]
    columns = {name: column[owner] for name, column in moves.columns().items()}
    inner = fraction < 1
    columns["end"][inner, :2] = points_at(move_rows(moves)[owner[inner]], fraction[inner])
    columns["end"][inner, 2] = (moves.start[owner, 2] * (1 - fraction) + moves.end[owner, 2] * fraction)[inner]
    pieces = replace(program, moves=type(moves)(**columns))
    whole, cut = sample_engagement(program, made), sample_engagement(pieces, made)
    assert len(pieces.moves) > 1.5 * len(moves)
    assert np.array_equal(whole.share, cut.share) and np.array_equal(whole.block, cut.block)
    assert np.allclose(whole.first, cut.first, atol=1e-7)


def test_corners_ends_and_what_goes_straight_down_are_cut_where_they_are() -> None:
    """Cells are looked at in their middles only; there alone the field would lack the tips of the path."""
    path = (
        Path()
        .into_work(0, 0)
        .line(10, 0, -1)
        .line(2, 1, -2)
        .line(4, 1, -2)
        .arc((4, 5, -2), (4, 3))
        .out_of_work()
        .into_work(9, 9, -3)
    )
    found = places(path.moves(), np.array([2, 3, 4, 5, 6, 10]), R)
    still = found.rows[:-1][~found.rows[:-1, 4:].any(axis=1)]
    assert still[:, :3].tolist() == [[0, 0, -1], [0, 0, -1], [10, 0, -1], [2, 1, -2], [4, 5, -2], [9, 9, -3]]
    assert np.all(np.diff(found.rows[:, 3]) >= 0) and np.all(np.diff(found.rows[:, 3])[[0, -2]] >= 2 * R)
    length = 10 + math.hypot(8, 1) + 2 + 2 * math.pi
    assert np.allclose(found.first[1:], found.last[:-1]) and found.last[-1] - found.first[0] == pytest.approx(length)
    sizes = np.bincount(found.block, found.last - found.first)
    assert sizes.min() >= R / 2 and sizes.max() < R and (found.last - found.first).max() <= R / 8
    assert chain_begins(np.array([2, 3, 4, 6]), np.array([0, 1, 1, 1])).tolist() == [True, True, False, True]


def test_long_paths_are_looked_at_in_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    program, made = fig2_program()
    whole = sample_engagement(program, made)
    monkeypatch.setattr(engagement_places, "MOST_PLACES", 100)
    monkeypatch.setattr(engagement_module, "_MOST_KEPT", 500)
    parts = sample_engagement(program, made)
    assert len(list(engagement_places.runs(program.moves, {1: R / 8, 2: R / 16}))) > 4
    assert np.array_equal(whole.share, parts.share) and np.array_equal(whole.owner, parts.owner)
    assert np.array_equal(np.diff(whole.block), np.diff(parts.block)) and np.allclose(
        whole.last - whole.first, parts.last - parts.first
    )


def test_little_memory_makes_it_coarser_and_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    path = along(along(Path(), 0.4, 0.0), 0.4, 2.0, -4, 8)
    fine = engagement(path.program(PLATE), JOB)
    for name, most in (("_MOST_TILES", 4), ("_MOST_INDEXED", 12)):
        with monkeypatch.context() as patch:
            patch.setattr(engagement_field, name, most)
            coarse = engagement(path.program(PLATE), JOB)
        assert coarse.bounds[0] > 1.4 * fine.bounds[0]
        assert coarse.shares[8] == pytest.approx(2 / D, abs=coarse.bounds[0] + 0.01)


def test_a_pointed_cutter_is_as_wide_as_it_is_at_the_top() -> None:
    tool = Tool(1, D, ToolKind.V, tip_angle=math.pi / 2)
    made = replace(JOB, tools=(tool,), operations=JOB.operations[:1])
    path = along(along(Path(), 0.4, 0.0), 0.4, 1.0, -4, 8)
    assert shares(path, of=made)[8] == pytest.approx(0.5, abs=0.04)
    path = along(along(Path(), 0.4, 0.0), 0.4, 2.05, -4, 8)
    assert shares(path, of=made)[8] == 1


def test_lengths_are_told_by_operation() -> None:
    path = along(along(Path(), 0.0, 0.0), 0.0, 1.5, -4, 8)
    path.tool, path.operation = 2, 1
    along(path, 0.0, 20.0)
    found = engagement(path.program(PLATE), JOB)
    assert found.lengths.sum(axis=1) == pytest.approx([36, 24])
    assert found.above(0.5, 0) == pytest.approx(24 / 36, abs=0.05) and found.above(0.5, 1) > 0.9
    assert found.above(0.0, 0) == pytest.approx(1, abs=0.05) and found.above(0.5) == pytest.approx(48 / 60, abs=0.05)
    assert found.bounds.tolist() == pytest.approx([0.036, 0.036], rel=0.01)


def test_nothing_to_cut_is_no_engagement() -> None:
    for path in (Path().rapid(0, 0, 5), Path().rapid(0, 0, 5).line(0, 0, -1)):
        found = engagement(path.program(PLATE), JOB)
        assert found.most == 0 and found.above(0.0) == 0 and not found.shares.any()
    empty = replace(path.program(PLATE), moves=path.moves().part(0, 0))
    assert len(engagement(empty, JOB).shares) == 0


def test_it_can_be_stopped(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(engagement_field, "_SLICE", 256)
    stop = threading.Event()
    steps = []

    def listener(fraction: float, text: str) -> None:
        steps.append(fraction)
        if fraction > 0.3:
            stop.set()

    path = Path()
    for k in range(12):
        along(path, 0.0, 0.1 * k, -50, 50)
    with pytest.raises(Cancelled):
        engagement(path.program(PLATE), JOB, Progress(listener, stop))
    assert steps == sorted(steps) and steps[-1] < 0.9


def test_a_real_drawing(data: object) -> None:
    from pathlib import Path as FilePath

    path = FilePath(str(data)) / "dxf" / "gear.dxf"
    made = Job(
        read_drawing(path.name, path.read_bytes(), None, ()).part,
        (Tool(1, 2.0), Tool(2, 1.0)),
        (PocketOperation(CutParameters(1), stepover=1.0), ContourOperation(CutParameters(2))),
    )
    program = compute(made)
    found = engagement(program, made)
    assert found.most == 1 and 0 < found.above(0.9, 0) < 0.8
    rapid = program.moves.kind == MoveKind.RAPID
    assert not found.shares[rapid].any() and found.shares.min() >= 0 and found.shares.max() <= 1
