"""What is proven covered: against distances at many points, and that nothing stays in doubt where a path along the
walls covers all.
"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import affinity

from app.geometry.distance import DistanceField
from app.geometry.primitives import Rows, within_half_turn
from app.toolpath.coverage import proven
from app.toolpath.coverage.proven import uncertain
from tests.examples import examples

RADIUS = 2.0
SLACK = 3.1e-3
OFF_GRID = 0.0031
"""mm by which places lie off the corners of squares, whose sides are binary fractions."""


def _line(*points: tuple[float, float]) -> list[list[float]]:
    return [[*a, *b, 0.0, 0.0, 0.0, 0.0] for a, b in pairwise(points)]


def _arc(start: float, end: float, radius: float, turn: float = 1.0) -> list[float]:
    """An arc round zero, angles in radians."""
    ends = [(radius * math.cos(angle), radius * math.sin(angle)) for angle in (start, end)]
    return [*ends[0], *ends[1], 0.0, 0.0, radius, turn]


def _swath(rows: Rows, radius: float) -> shapely.Geometry:
    """What a cutter covers, in many chords that lie within it."""
    angles = np.linspace(0.0, 1.0, 400)
    lines = []
    for row in rows:
        if row[7] == 0:
            lines.append(shapely.linestrings([row[:2], row[2:4]]))
            continue
        first = math.atan2(row[1] - row[5], row[0] - row[4])
        sweep = (math.atan2(row[3] - row[5], row[2] - row[4]) - first) * row[7] % math.tau * row[7] or math.tau
        angle = first + angles * sweep
        lines.append(shapely.linestrings(row[4:6] + row[6] * np.column_stack([np.cos(angle), np.sin(angle)])))
    return shapely.union_all(shapely.buffer(np.array(lines, object), radius, quad_segs=200))


@pytest.mark.parametrize("angle", [0.0, 17.0, 45.0, 90.0])
def test_next_to_nothing_is_in_doubt_along_walls_and_at_joints_of_lines(angle: float) -> None:
    """But the inner corners, which no one line covers all round."""
    frame = affinity.rotate(shapely.LinearRing([(0, 0), (30, 0), (30, 20), (0, 20)]), angle, origin=(3.0, 5.0))
    rows = np.array(_line(*frame.coords))
    assert (
        shapely.union_all(uncertain(shapely.buffer(frame, RADIUS, quad_segs=200), [(rows, RADIUS)])).area
        < 4 * 4 * (RADIUS / 64) ** 2
    )


@pytest.mark.parametrize("parts", [1, 2, 3, 7])
@pytest.mark.parametrize("turn", [1.0, -1.0])
@pytest.mark.parametrize("radius", [0.7, 1.9, 5.0, 40.0])
def test_nothing_is_in_doubt_along_a_circle_in_any_number_of_arcs(parts: int, turn: float, radius: float) -> None:
    angles = 0.3 + turn * np.linspace(0.0, math.tau, parts + 1)
    rows = np.array([_arc(a, b, radius, turn) for a, b in pairwise(angles.tolist())])
    rows[-1, 2:4] = rows[0, :2]
    hole = shapely.Point(0, 0).buffer(radius - RADIUS, quad_segs=400) if radius > RADIUS else shapely.Polygon()
    wanted = shapely.Point(0, 0).buffer(radius + RADIUS, quad_segs=400).difference(hole)
    assert len(uncertain(wanted, [(rows, RADIUS)])) == 0


def test_nothing_is_in_doubt_round_a_slot_with_arcs_that_go_on_from_lines() -> None:
    half = np.array([[-10.0, -4.0, 10.0, -4.0, 0, 0, 0, 0], [10.0, -4.0, 10.0, 4.0, 10.0, 0.0, 4.0, 1.0]])
    rows = np.vstack([half, -half * [1, 1, 1, 1, 1, 1, -1, -1]])
    around = shapely.LineString([(-10, 0), (10, 0)])
    wanted = around.buffer(4 + RADIUS, quad_segs=300).difference(around.buffer(4 - RADIUS, quad_segs=300))
    assert len(uncertain(wanted, [(rows, RADIUS)])) == 0


def test_nothing_is_in_doubt_along_the_rim_at_a_corner_of_two_arcs() -> None:
    """There it is the disc round the corner that covers, and no sector of an arc."""
    rows = np.array([_arc(0.0, 1.5, 6.0), _arc(1.5, 3.0, 6.0)])
    joint, turn = rows[0, 2:4], np.array([[0.0, 1.0], [-1.0, 0.0]])
    for k in (0, 2, 4):
        rows[1, k : k + 2] = joint + turn @ (rows[1, k : k + 2] - joint)
    wanted = _swath(rows, RADIUS)
    squares = uncertain(wanted, [(rows, RADIUS)])
    # the bend inside of the corner, which two arcs cover together
    beyond = shapely.distance(squares, shapely.Point(joint)) < RADIUS - 0.5
    assert shapely.area(squares[~beyond]).sum() < 0.002


@pytest.mark.parametrize("missing", [0.05, 0.5, 3.0])
def test_a_gap_in_a_circle_stays_in_doubt_and_little_else(missing: float) -> None:
    rows = within_half_turn(np.array([_arc(missing / 10, math.tau - missing / 10, 10.0)]))
    wanted = shapely.Point(0, 0).buffer(12.0, quad_segs=400).difference(shapely.Point(0, 0).buffer(8.0, quad_segs=400))
    left = wanted.difference(_swath(rows, RADIUS))
    boxes = shapely.union_all(uncertain(wanted, [(rows, RADIUS)]))
    assert left.area > 0
    assert boxes.covers(left.buffer(-SLACK)) or left.buffer(-SLACK).is_empty
    assert boxes.area < left.area + 3 * math.sqrt(left.area) + 10 * (RADIUS / 4) ** 2


def test_nothing_is_in_doubt_where_a_path_turns_round_a_pointed_island() -> None:
    """No one stretch covers all round the point; the disc at a joint covers what is as near to it as chords are off."""
    side = np.array([math.cos(0.3), math.sin(0.3)])
    out = RADIUS * np.array([-side[1], side[0]])
    far, near = 10.0 * side + out, out
    rows = np.array(
        [
            [*far, *near, 0.0, 0.0, 0.0, 0.0],
            [*near, near[0], -near[1], 0.0, 0.0, RADIUS, 1.0],
            [near[0], -near[1], far[0], -far[1], 0.0, 0.0, 0.0, 0.0],
        ]
    )
    rows[:, :6] += OFF_GRID
    island = shapely.Polygon([(0, 0), 20 * side, (20 * side[0], -20 * side[1])])
    wanted = affinity.translate(shapely.box(-1, -1, 1, 1).difference(island), OFF_GRID, OFF_GRID)
    assert len(uncertain(wanted, [(rows, RADIUS)])) == 0


def test_nothing_of_a_strip_that_counts_is_out_of_the_boxes() -> None:
    """Squares beside it are covered as far as slack goes; the boxes reach over these."""
    rows = np.array([*_line((-1.0, -0.5), (9.0, 0.5)), *_line((9.0, 4.532), (-1.0, 3.532))])
    wanted = shapely.box(0, 0, 8, 4)
    left = wanted.difference(_swath(rows, RADIUS))
    assert 0.09 < left.area < 0.2  # some 12 um of it
    assert shapely.union_all(uncertain(wanted, [(rows, RADIUS)])).contains(left.buffer(-5e-3).buffer(4.9e-3))


def test_two_cutters_share_the_work() -> None:
    wanted = shapely.box(-5, -2, 25, 2)
    rows = [np.array(_line((-6.0, 0.0), (10.0, 0.0))), np.array(_line((9.0, 0.0), (26.0, 0.0)))]
    assert len(uncertain(wanted, [(rows[0], 2.0), (rows[1], 2.5)])) == 0
    assert shapely.union_all(uncertain(wanted, [(rows[0], 2.0)])).contains(shapely.box(13, -2, 25, 2))


def test_without_a_path_all_is_in_doubt() -> None:
    wanted = shapely.box(0, 0, 3, 2)
    assert shapely.union_all(uncertain(wanted, [])).contains(wanted)
    assert len(uncertain(shapely.Polygon(), [])) == 0


_STEP = st.tuples(st.floats(-6, 6), st.floats(-6, 6)).map(lambda at: (round(at[0], 2), round(at[1], 2)))
_ROUND = st.tuples(
    st.floats(0, 6.2), st.floats(0.1, 6.2), st.sampled_from([0.5, 2.0, 4.0]), st.sampled_from([1.0, -1.0])
)


@given(
    points=st.lists(_STEP, min_size=2, max_size=6), arcs=st.lists(_ROUND, max_size=3), holes=st.lists(_STEP, max_size=3)
)
@settings(max_examples=examples(300), deadline=None)
def test_what_is_not_in_doubt_is_covered(
    points: list[tuple[float, float]], arcs: list[tuple[float, float, float, float]], holes: list[tuple[float, float]]
) -> None:
    rows = np.array(_line(*points) + [_arc(a, a + turn * sweep, radius, turn) for a, sweep, radius, turn in arcs])
    reach = _swath(rows, 1.0)
    wanted = reach.union(shapely.box(-3, -3, 3, 3)).difference(
        shapely.union_all([shapely.Point(at).buffer(0.7) for at in holes])
    )
    doubt = shapely.union_all(uncertain(wanted, [(rows, 1.0)]))
    spots = np.random.default_rng(1).uniform(-9, 9, (4000, 2))
    asked = spots[shapely.contains_xy(wanted, spots) & ~shapely.intersects_xy(doubt, spots)]
    assert np.all(DistanceField.of(within_half_turn(rows)).nearest(asked)[0] <= 1.0 + SLACK)


@pytest.mark.parametrize("missing", [None, 0, 7])
def test_an_area_is_in_doubt_alike_in_portions_and_at_once(
    monkeypatch: pytest.MonkeyPatch, missing: int | None
) -> None:
    """Ten squares, each with its own path, one of them without."""
    squares = [shapely.box(20 * k, 0, 20 * k + 12, 12) for k in range(10)]
    paths = [np.array(_line(*shapely.box(20 * k + 2, 2, 20 * k + 10, 10).exterior.coords)) for k in range(10)]
    paths += [np.array(_line((20 * k + 2, 6), (20 * k + 10, 6))) for k in range(10)]
    rows = np.concatenate([path for k, path in enumerate(paths) if k % 10 != missing])
    wanted = shapely.intersection(
        shapely.multipolygons(squares), shapely.union_all(_swath(np.concatenate(paths), 1.99))
    )
    whole = uncertain(wanted, [(rows, RADIUS)])
    monkeypatch.setattr(proven, "_EDGES_AT_A_TIME", 400)
    portions = uncertain(wanted, [(rows, RADIUS)])
    assert (len(whole) == 0) == (missing is None)
    assert shapely.equals(whole, portions).all() and len(whole) == len(portions)
