"""The feed follows the engagement: slower where it must be, nowhere else, on the very same path, and only once."""

from __future__ import annotations

import math
import threading
from pathlib import Path as FilePath

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.core.errors import Cancelled
from app.core.progress import Progress
from app.formats.readers import read_drawing
from app.model.contour_operation import ContourOperation
from app.model.hole_operations import DrillOperation
from app.model.job import Job, Stock
from app.model.moves import MoveKind, Moves, Program
from app.model.operation import CutParameters, PocketOperation
from app.model.tool import Tool
from app.operations.compute import compute
from app.toolpath.coverage.areas import move_rows
from app.toolpath.engagement.engagement import engagement
from app.toolpath.engagement.feed import LEAST_FEED, followed
from tests.examples import examples
from tests.gcode.programs import Path, job, square

FEED, R = 600.0, 3.0
PLATE = square(-60, -60, 60, 60)


def limited(*limits: float, tools: tuple[Tool, ...] = (Tool(1, 2 * R), Tool(2, R))) -> Job:
    operations = tuple(PocketOperation(CutParameters(tool=k + 1), most_engaged=limit) for k, limit in enumerate(limits))
    return job(operations=operations, tools=tools, stock=Stock(0.0, 10.0))


def slot(x0: float = -20.0, x1: float = 20.0, y: float = 0.0, path: Path | None = None) -> Path:
    return (path or Path()).into_work(x0, y).line(x1, y, -1).out_of_work()


def same(a: Moves, b: Moves) -> bool:
    return all(
        np.array_equal(one, other, equal_nan=True)
        for one, other in zip(a.columns().values(), b.columns().values(), strict=True)
    )


def origin(before: Moves, after: Moves) -> np.ndarray:
    """For each move after, the move before that it is a piece of; every end before must come again, in order."""
    owner, at = np.empty(len(after), np.int64), 0
    for k in range(len(after)):
        owner[k] = at
        at += bool(np.array_equal(after.end[k], before.end[at]) and after.kind[k] == before.kind[at])
    assert at == len(before)
    return owner


def check(before: Program, of: Job) -> Program:
    """Follow a program and hold the answer against everything that must be so whatever the path."""
    after = followed(before, of)
    old, new = before.moves, after.moves
    owner = origin(old, new)
    for name in ("centre", "kind", "purpose", "operation", "tool", "region", "line"):
        assert np.array_equal(getattr(new, name), getattr(old, name)[owner], equal_nan=name == "centre")
    rows, pieces = move_rows(old)[owner], move_rows(new)
    assert np.abs(pieces[:, 6] - rows[:, 6]).max(initial=0) < 1e-9
    assert np.abs(np.bincount(owner, new.lengths()) - old.lengths()).max() < 1e-9
    assert np.abs(np.bincount(owner, new.sweeps()) - old.sweeps()).max() < 1e-9
    cut = np.bincount(owner)[owner] > 1
    radius = np.array([of.tool(int(number)).radius for number in new.tool])
    assert np.all(np.hypot(new.lengths(), 1e-9)[cut] >= radius[cut] / 2 * (1 - 1e-5))
    asked = np.array([of.tool(int(number)).feed_rate for number in new.tool])
    assert np.all(new.feed <= old.feed[owner])
    assert np.all((new.feed == old.feed[owner]) | (new.feed >= LEAST_FEED * asked - 1e-9))
    held = engagement(after, of)
    limit = np.array([operation.engagement_limit for operation in of.operations])[new.operation]
    removed, most = held.shares * new.feed, (limit + held.bounds[new.operation]) * asked
    assert np.all((removed <= most + 1e-6) | (new.feed <= LEAST_FEED * asked + 1e-9) | (limit == 1))
    assert same(followed(after, of).moves, new)
    return after


def test_what_is_never_slowed_is_not_even_looked_at() -> None:
    program = slot().program(PLATE)
    assert followed(program, limited(1.0)) is program
    rapids = Path().rapid(0, 0, 5).rapid(1, 1, 5).program(PLATE)
    assert followed(rapids, limited(0.5)) is rapids


@pytest.mark.parametrize(("limit", "feed"), [(0.9, 540), (0.5, 300), (0.43, 240), (0.3, 180), (0.1, 180)])
def test_a_slot_is_slowed_by_how_much_it_exceeds_the_limit_in_steps(limit: float, feed: float) -> None:
    path = Path().into_work(-20, 0).line(0, 0, -1).arc((0, 10, -1), (0, 5)).out_of_work()
    assert check(path.program(PLATE), limited(limit)).moves.feed.tolist() == [0, 0, 200, feed, feed, 0]


def test_no_feed_falls_below_what_can_be_written() -> None:
    tool = Tool(1, 2 * R, feed_rate=2.0, plunge_rate=1.0)
    path = slot(path=Path(feed=2.0))
    assert followed(path.program(PLATE), limited(0.2, tools=(tool,))).moves.feed[-2] == 1.0


def test_a_feed_that_is_slow_already_stays() -> None:
    path = slot(path=Path(feed=100.0))
    assert followed(path.program(PLATE), limited(0.5)).moves.feed[-2] == 100
    ramp = Path().rapid(0, 0, 5).rapid(0, 0, 0)
    ramp.feed = 200.0
    ramp.arc((0, 0, -1), (2, 0)).arc((0, 0, -2), (2, 0)).out_of_work()
    program = ramp.program(PLATE)
    assert same(followed(program, limited(0.4)).moves, program.moves)


def test_half_the_diameter_is_not_over_a_limit_of_half_the_diameter() -> None:
    rng = np.random.default_rng(7)
    for _ in range(20):
        angle, y = rng.uniform(0, math.tau), rng.uniform(-1, 1)
        u, v = np.array([math.cos(angle), math.sin(angle)]), np.array([-math.sin(angle), math.cos(angle)])
        path = Path().into_work(*(y * v - 20 * u)).line(*(y * v + 20 * u), -1).out_of_work()
        path.into_work(*((y + R) * v - 10 * u)).line(*((y + R) * v + 10 * u), -1).out_of_work()
        after = followed(path.program(PLATE), limited(0.5)).moves
        assert after.feed[-2] == FEED and same(after.part(len(after) - 5, len(after)), path.moves().part(5, 10))


def test_only_the_engaged_part_of_a_line_is_slowed() -> None:
    path = slot(-40, -8)
    slot(8, 40, path=path)
    slot(-40, 40, path=path)
    after = check(path.program(PLATE), limited(0.5)).moves
    last = slice(len(after) - 4, len(after) - 1)
    assert after.feed[last].tolist() == [FEED, FEED / 2, FEED]
    x = after.end[last, 0]
    free = 8 - 2 * R * math.cos(math.pi / 4)  # from here on less than a quarter turn of its front is engaged
    assert -8 - R < x[0] < -8 + R / 8 and free - R / 8 < x[1] < free + R and x[2] == 40
    assert np.all(after.end[last, 1] == 0) and np.all(after.end[last, 2] == -1)


@pytest.mark.parametrize("ccw", [True, False])
def test_a_full_circle_is_cut_into_arcs_of_the_same_circle(ccw: bool) -> None:
    path = Path().into_work(20, 0).arc((-20.0, 0.0, -1.0), (0.0, 0.0), ccw).out_of_work()
    for _ in range(2):
        path.into_work(0, 20).arc((0.0, 20.0, -1.0), (0.0, 0.0), ccw).out_of_work()
    after = check(path.program(PLATE), limited(0.5)).moves
    arcs = np.flatnonzero(after.kind >= MoveKind.ARC_CW)
    free, slow = FEED, FEED / 2
    assert after.feed[arcs[:4]].tolist() == [slow, *((free, slow, free) if ccw else (slow, free, slow))]
    assert after.feed[arcs[-1]] == free and abs(after.sweeps()[arcs[-1]]) == math.tau and len(arcs) <= 6
    assert np.abs(np.hypot(*after.end[arcs, :2].T) - 20).max() < 1e-12 and np.all(after.end[arcs, 2] == -1)


def test_pieces_of_a_ramp_lie_on_its_slope() -> None:
    path = slot(-40, 0)
    path.rapid(-40, 0, 5).rapid(-40, 0, -0.5).line(40, 0, -0.9).out_of_work()
    after = check(path.program(PLATE), limited(0.5)).moves
    ramp = np.flatnonzero((after.end[:, 2] < -0.5) & (after.end[:, 2] > -1))
    assert len(ramp) == 2
    x, z = after.end[ramp[0], 0], after.end[ramp[0], 2]
    assert z == pytest.approx(-0.5 - 0.4 * (x + 40) / 80, abs=1e-12)


def test_each_operation_has_its_own_limit() -> None:
    path = slot()
    path.tool, path.operation = 2, 1
    slot(y=20, path=path)
    for limits, feeds in (((0.5, 1.0), (300, 600)), ((1.0, 0.5), (600, 300)), ((0.5, 0.4), (300, 240))):
        assert followed(path.program(PLATE), limited(*limits)).moves.feed[[3, 8]].tolist() == pytest.approx(feeds)
    assert [operation.engagement_limit for operation in limited(0.5, 1.0).operations] == [0.5, 1.0]
    assert DrillOperation(CutParameters(1)).engagement_limit == 1.0


def test_a_short_slot_slows_no_other_tool_behind_it() -> None:
    path = slot(0, 2.9)
    path.tool, path.operation = 2, 1
    slot(0, 1.4, path=path)
    assert followed(path.program(PLATE), limited(0.5, 0.5)).moves.feed[[3, 8]].tolist() == [FEED / 2, FEED]


def test_many_short_places_of_metal_make_no_crumbs() -> None:
    path = Path()
    for x in range(-45, 50, 9):
        path.into_work(x, -20).line(x, 20, -1).out_of_work()
    slot(-50, 50, path=path)
    after = check(path.program(PLATE), limited(0.5)).moves
    assert len(after) - len(path.rows) < 12


steps = st.lists(
    st.tuples(st.floats(-30, 30), st.floats(-30, 30), st.floats(-3, -0.5), st.sampled_from(["line", "arc", "lift"])),
    min_size=3,
    max_size=12,
)


@settings(max_examples=examples(60), deadline=None)
@given(steps, st.floats(0.1, 0.9), st.sampled_from([0.7, 2.0, 6.0]))
def test_whatever_the_path_it_stays_and_is_slowed_once(
    steps: list[tuple[float, float, float, str]], limit: float, diameter: float
) -> None:
    path = Path().into_work(0, 0)
    x = y = 0.0
    for to_x, to_y, z, kind in steps:
        if math.hypot(to_x - x, to_y - y) < 0.1:
            continue
        if kind == "lift":
            path.out_of_work().into_work(to_x, to_y, z)
        elif kind == "line":
            path.line(to_x, to_y, z)
        else:
            path.arc((to_x, to_y, z), ((x + to_x) / 2 - 0.3 * (to_y - y), (y + to_y) / 2 + 0.3 * (to_x - x)))
        x, y = to_x, to_y
    check(path.out_of_work().program(PLATE), limited(limit, tools=(Tool(1, diameter), Tool(2, diameter))))


@pytest.mark.parametrize("name", ["fig2", "gear", "genshi"])
def test_real_drawings(data: FilePath, name: str) -> None:
    path = data / "dxf" / f"{name}.dxf"
    small = 3.0 if name == "fig2" else 1.0
    made = Job(
        read_drawing(path.name, path.read_bytes(), None, ()).part,
        (Tool(1, 2 * small), Tool(2, small)),
        (
            PocketOperation(CutParameters(1, 2.0, 1.0), stepover=1.5 * small, most_engaged=0.5),
            ContourOperation(CutParameters(2), most_engaged=0.4),
        ),
    )
    program = compute(made)
    after = check(program, made)
    assert 0 < len(after.moves) - len(program.moves) < len(program.moves)
    assert after.findings == program.findings and after.strokes == program.strokes


def test_it_can_be_stopped() -> None:
    stop = threading.Event()
    stop.set()
    with pytest.raises(Cancelled):
        followed(slot().program(PLATE), limited(0.5), Progress(cancelled=stop))
