"""Ways into metal: their shape, how near they come to walls, and what is taken where one does not fit."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.geometry.outlines import polygon_contour
from app.model.entry import Entry, EntryKind
from app.model.finding import FindingKind
from app.model.moves import MoveKind, Moves, Purpose, Tab
from app.model.operation import CutParameters, Direction, PocketOperation, Side
from app.model.part import Contour
from app.toolpath.build import StrokeLabel
from app.toolpath.operation_context import OperationContext
from tests import plain_distance
from tests.examples import examples
from tests.part_shapes import circle, random_star, square
from tests.toolpath.emitting import contour_operation, dense, emitted, loop, path, setting_of

STEEP = math.radians(3)
INNER = [(30.0, 50.0), (70.0, 50.0)]


def cutting(
    kind: EntryKind, contours: Sequence[Contour] = (square(100),), angle: float = STEEP, **cut: object
) -> OperationContext:
    return setting_of(contours, PocketOperation(CutParameters(1, entry=Entry(kind, angle), **cut)))  # type: ignore[arg-type]


def ways_in(moves: Moves) -> np.ndarray:
    """Moves of entries that go sideways too."""
    return (moves.purpose == Purpose.PLUNGE) & (
        (moves.kind >= MoveKind.ARC_CW) | (np.hypot(*(moves.end - moves.start)[:, :2].T) > 0)
    )


def steepness(moves: Moves) -> np.ndarray:
    chosen = ways_in(moves)
    fall = (moves.start - moves.end)[chosen, 2]
    return np.asarray(fall / np.sqrt(moves.lengths()[chosen] ** 2 - fall**2))


def told(setting: OperationContext) -> list[str]:
    return [finding.text for finding in setting.findings if finding.kind is FindingKind.ENTRY]


@pytest.mark.parametrize("angle", [math.radians(1), STEEP, math.radians(20)])
def test_a_helix_goes_down_beside_the_path_and_ends_tangent_on_its_beginning(angle: float) -> None:
    setting = cutting(EntryKind.HELIX, angle=angle)
    moves = emitted(setting, [path(INNER)])
    turns = ways_in(moves)
    assert np.all(moves.kind[turns] == MoveKind.ARC_CCW) and not told(setting)
    assert np.all(steepness(moves) <= math.tan(angle) + 1e-9) and np.allclose(steepness(moves), steepness(moves)[0])
    radius = np.hypot(*(moves.end[:, :2] - moves.centre)[turns].T)
    assert np.allclose(radius, 2.7)
    last = int(np.flatnonzero(turns)[-1])
    assert moves.end[last].tolist() == [30.0, 50.0, -2.0]
    assert moves.centre[last] == pytest.approx((30.0, 52.7))  # straight beside: the circle touches the path
    assert moves.start[np.flatnonzero(turns)[0], 2] == pytest.approx(0.2)


def test_conventional_cuts_have_their_helix_the_other_way_round() -> None:
    moves = emitted(cutting(EntryKind.HELIX, direction=Direction.CONVENTIONAL), [path(INNER)])
    assert np.all(moves.kind[ways_in(moves)] == MoveKind.ARC_CW)


def test_no_way_in_falls_faster_than_a_plunge_nor_is_faster_than_the_feed() -> None:
    for angle in (STEEP, math.radians(44)):
        for kind in (EntryKind.HELIX, EntryKind.RAMP):
            moves = emitted(cutting(kind, angle=angle, depth=9.0, stepdown=9.0), [path(INNER)])
            chosen = ways_in(moves)
            fall = (moves.start - moves.end)[chosen, 2] / moves.lengths()[chosen]
            assert np.all(moves.feed[chosen] * fall <= 200 + 1e-9) and np.all(moves.feed[chosen] <= 300 + 1e-9)


@settings(max_examples=examples(25), deadline=None)
@given(st.integers(0, 10**6))
def test_no_way_in_comes_nearer_to_a_wall_than_the_cutter_may(seed: int) -> None:
    rng = np.random.default_rng(seed)
    contours = [random_star(rng, (50, 50), (10, 30), 0.0), circle(2, 50, 50)]
    places = rng.uniform(20, 80, (40, 2))
    away = plain_distance.distance(places, contours)
    held = plain_distance.inside(places, contours) & (away > 3.2)
    kind = EntryKind.HELIX if seed % 2 else EntryKind.RAMP
    for place, room in zip(places[held][:4], away[held], strict=False):
        step = (room - 3.2) * np.array([math.cos(seed), math.sin(seed)])
        moves = emitted(cutting(kind, contours, stock_to_leave=0.2), [path([tuple(place), tuple(place + step)])])
        points, owner = dense(moves)
        low = points[:, 2] < 0
        assert plain_distance.distance(points[low, :2], contours).min() >= 3.2 - 1e-6
        assert np.all(steepness(moves) <= math.tan(STEEP) + 1e-9)
        assert np.all(np.isin(moves.kind[owner], [1, 2, 3]))


def test_where_no_helix_fits_a_ramp_goes_there_and_back_along_the_path_and_is_told_once() -> None:
    slot = polygon_contour([(0, 0), (60, 0), (60, 6.4), (0, 6.4)])
    setting = cutting(EntryKind.HELIX, [slot])
    moves = emitted(setting, [path([(10, 3.2), (20, 3.2)]), path([(50, 3.2), (40, 3.2)])])
    assert np.all(moves.kind[ways_in(moves)] == MoveKind.LINE) and len(told(setting)) == 1
    assert "2 entries are a ramp along the path as no helix fits, the first at (10.000, 3.200)" in told(setting)[0]


def test_where_no_ramp_fits_either_the_tool_plunges_and_that_is_told() -> None:
    setting = cutting(EntryKind.HELIX, [square(6.4)])
    moves = emitted(setting, [path([(3.2, 3.2), (3.2, 3.25)])])
    assert not ways_in(moves).any() and len(told(setting)) == 1 and "neither helix nor ramp fits" in told(setting)[0]


def test_a_ramp_on_an_open_path_returns_to_its_beginning() -> None:
    setting = cutting(EntryKind.RAMP)
    moves = emitted(setting, [path(INNER)])
    chosen = np.flatnonzero(ways_in(moves))
    assert len(chosen) == 2 and moves.end[chosen[-1]].tolist() == [30.0, 50.0, -2.0]
    assert np.all(moves.end[chosen, 1] == 50.0) and not told(setting)
    # the turning point may be a crumb farther
    assert steepness(moves) == pytest.approx([math.tan(STEEP)] * 2, rel=2e-2)
    assert moves.end[chosen[-1] + 1].tolist() == [70.0, 50.0, -2.0]  # the ramp's ground is cut again, level


def test_a_short_path_is_ramped_to_and_fro_and_one_shorter_than_the_cutter_plunges() -> None:
    setting = cutting(EntryKind.RAMP)
    moves = emitted(setting, [path([(30, 50), (34, 50)])])
    assert int(ways_in(moves).sum()) == 2 * math.ceil(2.2 / math.tan(STEEP) / 8)
    short = cutting(EntryKind.RAMP)
    moves = emitted(short, [path([(30, 50), (31, 50)])])
    assert (
        not ways_in(moves).any() and "1 entry is straight down as no ramp fits, at (30.000, 50.000)" in told(short)[0]
    )


def test_a_ramp_round_a_closed_path_ends_where_the_level_cut_begins() -> None:
    setting = cutting(EntryKind.RAMP, depth=4.0, stepdown=2.0)
    moves = emitted(setting, [loop(circle(4, 50, 50), Purpose.POCKET)])
    chosen = ways_in(moves)
    assert np.allclose(np.hypot(*(moves.end[chosen, :2] - 50).T), 4.0) and np.all(
        moves.kind[chosen] == MoveKind.ARC_CCW
    )
    level = np.abs(moves.sweeps()[moves.purpose == Purpose.POCKET])
    assert level.sum() == pytest.approx(2 * math.tau)  # all round at both depths
    assert int(((moves.kind == MoveKind.RAPID) & (moves.start[:, 2] < 0)).sum()) == 1
    assert np.all(steepness(moves) <= math.tan(STEEP) + 1e-9)


def test_on_the_line_nothing_is_cut_beside_it() -> None:
    setting = setting_of([square(100)], contour_operation(side=Side.ON))
    moves = emitted(setting, [path(INNER, Purpose.CONTOUR)])
    points, _ = dense(moves)
    assert np.all(points[:, 1] == 50.0) and ways_in(moves).any()


def test_ways_in_keep_off_clamps_outside_of_the_walls() -> None:
    curves = [circle(5, 50, 53.0 + 8.1), square(100)]
    setting = setting_of([square(100)], PocketOperation(CutParameters(1)))
    clamped = setting_of(curves[1:] + curves[:1], PocketOperation(CutParameters(1)))
    free = emitted(setting, [path([(50, 53), (60, 53)])])
    kept = emitted(clamped, [path([(50, 53), (60, 53)])])
    assert free.centre[ways_in(free)][0, 1] > 53 > kept.centre[ways_in(kept)][0, 1]


def test_a_helix_goes_round_no_tab() -> None:
    setting = cutting(EntryKind.HELIX)
    setting.tabs.append(Tab(30.0, 58.0, 2.0, -0.5, 6.0))
    moves = emitted(setting, [path(INNER)])
    assert np.all(moves.centre[ways_in(moves)][:, 1] < 50)


def drilled_at(setting: OperationContext, x: float, y: float, z: float) -> None:
    """A hole that the tool itself was led down in."""
    label = StrokeLabel(0, 1, 600.0, 200.0)
    for end, purpose in (((x, y, 5.0), Purpose.RAPID), ((x, y, z), Purpose.DRILL), ((x, y, 5.0), Purpose.RAPID)):
        setting.builder.straight(end, purpose, label)


def test_a_drilled_hole_is_gone_down_straight_at_every_depth() -> None:
    setting = cutting(EntryKind.PREDRILLED, depth=4.0, stepdown=2.0)
    drilled_at(setting, 28.0, 40.0, -4.0)
    moves = emitted(setting, [path(INNER)])
    assert not ways_in(moves).any() and not told(setting)
    down = (moves.purpose == Purpose.PLUNGE) & (moves.end[:, 2] < 0)
    assert np.all(moves.end[down, :2] == (28.0, 40.0)) and {-2.0, -4.0} <= set(moves.end[down, 2].tolist())


def test_a_hole_not_deep_enough_is_no_entry_and_that_is_told() -> None:
    setting = cutting(EntryKind.PREDRILLED, depth=4.0)
    drilled_at(setting, 28.0, 40.0, -3.0)
    moves = emitted(setting, [path(INNER)])
    assert ways_in(moves).any() and "a helix as no drilled hole is near" in told(setting)[0]


def test_a_closed_path_begins_at_the_hole() -> None:
    setting = cutting(EntryKind.PREDRILLED)
    drilled_at(setting, 50.0, 70.0, -2.0)
    moves = emitted(setting, [loop(circle(20, 50, 50), Purpose.POCKET)])
    assert np.abs(moves.sweeps()[moves.purpose == Purpose.POCKET]).sum() == pytest.approx(math.tau)
    first = int(np.argmax(moves.purpose == Purpose.POCKET))
    assert moves.start[first, :2] == pytest.approx((50, 70))


def test_near_cut_ground_the_tool_goes_straight_down_on_it_and_in_from_the_side() -> None:
    setting = cutting(EntryKind.HELIX)
    emitted(setting, [path([(30, 50), (60, 50)])])
    count = len(setting.builder.moves())
    moves = emitted(setting, [path([(45, 54), (45, 70)])]).part(count, 10_000)
    assert not ways_in(moves).any() and not told(setting)
    assert moves.purpose.tolist().count(Purpose.LINK) == 1
    down = moves.purpose == Purpose.PLUNGE
    assert np.all(np.abs(moves.end[down, 1] - 50) < 0.1)
