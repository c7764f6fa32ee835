"""V-carving: closed forms of roofs, what is pruned, walked and refused; random areas against the distance field."""

from __future__ import annotations

import math

import numpy as np
import pytest

from app.core.errors import ParameterError
from app.core.progress import NO_PROGRESS
from app.geometry.distance import DistanceField
from app.geometry.offset.offset import offset_levels
from app.geometry.outlines import nested, polygon_contour
from app.geometry.primitives import pack, within_half_turn
from app.model.finding import FindingKind
from app.model.job import Job, Stock
from app.model.moves import MoveKind, Program
from app.model.operation import CutParameters, PocketOperation
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.model.vcarve_operation import VcarveOperation
from app.operations.compute import compute
from app.operations.vcarve.branches import AxisBranch
from app.operations.vcarve.graph import BranchGraph, graph_of, prune, trails
from app.operations.vcarve.paths import RIDGE, VCutter, carved, floor_corners, nearest_next
from tests.part_shapes import circle, layered_part, square

RIGHT = math.radians(90)


def program_of(*curves, depth: float = 9.0, tool: Tool | None = None, more=()) -> Program:
    tool = tool or Tool(1, 40.0, ToolKind.V, tip_angle=RIGHT)
    job = Job(
        layered_part({"a": list(curves)}),
        (tool, Tool(2, 2.0)),
        (*more, VcarveOperation(CutParameters(1, depth=depth, stepdown=99.0))),
        stock=Stock(thickness=20.0),
    )
    return compute(job)


def deepest(program: Program) -> tuple[float, ...]:
    end = program.moves.end
    return tuple(round(each, 6) for each in end[np.argmin(end[:, 2])].tolist())


def test_a_square_is_a_pyramid() -> None:
    program = program_of(square(10))
    cuts = program.moves.end[program.moves.kind == MoveKind.LINE]
    assert deepest(program) == (5, 5, -5)
    corners = {(round(x, 6), round(y, 6)) for x, y, z in cuts.tolist() if abs(z) < 1e-6}
    assert corners == {(0, 0), (10, 0), (10, 10), (0, 10)}
    assert not program.findings


def test_the_angle_and_the_tip_say_how_deep() -> None:
    blunt = Tool(1, 40.0, ToolKind.V, tip_angle=math.radians(60), tip_diameter=1.0)
    program = program_of(square(10), tool=blunt)
    assert deepest(program) == (5, 5, round(-4.5 / math.tan(math.radians(30)), 6))
    assert program.moves.end[:, :2][program.moves.kind == MoveKind.LINE].min() == pytest.approx(0.5, abs=1e-5)


def test_a_circle_is_one_plunge_and_a_ring_a_valley() -> None:
    program = program_of(circle(4, 1, 2))
    assert deepest(program) == (1, 2, -4) and (program.moves.kind == MoveKind.LINE).sum() == 1
    valley = program_of(circle(8, 0, 0), circle(4, 0, 0))
    low = valley.moves.end[valley.moves.end[:, 2] < 0]
    assert np.allclose(low[:, 2], -2.0, atol=1e-3)
    assert np.allclose(np.hypot(low[:, 0], low[:, 1]), 6.0, atol=1e-3)


def test_the_depth_is_clamped_and_the_floor_told_unless_a_pocket_clears_it() -> None:
    program = program_of(square(20), depth=3.0)
    assert program.moves.end[:, 2].min() == -3.0
    (finding,) = program.findings
    assert finding.kind is FindingKind.LEFT_OUT and finding.counts and finding.amount == pytest.approx(14.0**2)
    pocket = PocketOperation(CutParameters(2, depth=3.0, stock_to_leave=3.0))
    assert not program_of(square(20), depth=3.0, more=(pocket,)).findings
    greedy = PocketOperation(CutParameters(2, depth=3.0, stock_to_leave=2.5))
    kinds = [each.kind for each in program_of(square(20), depth=3.0, more=(greedy,)).findings]
    assert FindingKind.GOUGE in kinds and FindingKind.LEFT_OUT in kinds


def test_passes_carve_what_is_deeper_than_the_one_before() -> None:
    walls = pack(nested([polygon_contour([(0, 0), (20, 0), (20, 8), (0, 8)])]).regions)
    upper, lower = carved(walls, VCutter(0.0, 1.0, 20.0), (-3.0, -6.0), NO_PROGRESS)
    assert max(way.discs[:, 2].max() for way in upper.trails) == pytest.approx(3.0)
    assert min(way.discs[:, 2].min() for way in lower.trails) == pytest.approx(3.0, abs=1e-5)
    assert len(upper.rings) == 1 and not lower.rings


@pytest.mark.parametrize("kind", [ToolKind.FLAT, ToolKind.BALL])
def test_other_cutters_are_refused(kind: ToolKind) -> None:
    with pytest.raises(ParameterError, match="needs a V cutter"):
        program_of(square(10), tool=Tool(1, 6.0, kind))


def test_a_cone_that_is_too_low_is_refused() -> None:
    with pytest.raises(ParameterError, match="the cone of T1"):
        program_of(square(10), depth=5.0, tool=Tool(1, 6.0, ToolKind.V, tip_angle=RIGHT))


def test_only_branches_that_say_nothing_are_pruned() -> None:
    trunk = AxisBranch(np.array([[0.0, 0.0, 5.0], [10.0, 0.0, 5.0]]))
    kink = AxisBranch(np.array([[10.0, 0.0, 5.0], [10.0, 5.001, 0.0]]))
    corner = AxisBranch(np.array([[0.0, 0.0, 5.0], [0.0, 5.1, 0.0]]))
    graph = graph_of([trunk, kink, corner])
    assert not prune(graph)
    assert sorted({k for own in graph.at for k in own}) == [0, 2]
    lone = graph_of([kink])
    (disc,) = prune(lone)
    assert disc.tolist() == [10.0, 0.0, 5.0] and not trails(lone)


def test_every_branch_is_walked_once_in_half_as_many_ways_as_there_are_dead_ends() -> None:
    spokes = [AxisBranch(np.array([[math.cos(a), math.sin(a), 0.0], [0.0, 0.0, 1.0]])) for a in range(6)]
    ways = trails(graph_of(spokes))
    assert len(ways) == 3
    assert sum(way.length for way in ways) == pytest.approx(6.0)


def plain_walk(graph: BranchGraph) -> list[np.ndarray]:
    """The ways as told: from the shallowest odd node, along what leads on to the most others, the longest first."""
    left = [list(own) for own in graph.at]
    ways = []
    while any(left):
        odd = [node for node, own in enumerate(left) if len(own) % 2]
        node = min(odd or [k for k, own in enumerate(left) if own], key=lambda k: (graph.discs[k, 2], k))
        parts: list[np.ndarray] = []
        while left[node]:
            onward = [(len(left[graph.other(k, node)]), graph.branches[k].length) for k in left[node]]
            k = left[node][onward.index(max(onward))]
            end, discs = graph.other(k, node), graph.branches[k].discs
            discs = discs if graph.ends[k][0] == node else discs[::-1]
            left[node].remove(k)
            left[end].remove(k)
            parts.append(discs[1:] if parts else discs)
            node = end
        ways.append(np.concatenate(parts))
    return ways


@pytest.mark.parametrize("seed", range(20))
def test_branches_become_ways_as_told(seed: int) -> None:
    """Loops, branches beside one another and as long ones, too."""
    made = np.random.default_rng(seed)
    nodes = np.column_stack([made.uniform(0, 50, (9, 2)), made.integers(0, 4, 9)])
    found = []
    for a, b in made.integers(0, 9, (14, 2)).tolist():
        between = made.uniform(0, 50, (int(made.integers(1, 12)), 3))
        found += [AxisBranch(np.concatenate([nodes[[a]], between, nodes[[b]]]))] * int(made.integers(1, 3))
    graph = graph_of(found)
    ways, expected = trails(graph), plain_walk(graph)
    assert len(ways) == len(expected)
    for way, other in zip(ways, expected, strict=True):
        np.testing.assert_array_equal(way.discs, other)


@pytest.mark.parametrize("seed", range(12))
def test_random_areas_are_carved_to_the_walls(seed: int) -> None:
    """Dense samples: the depth of what was carved is the distance from the walls, divided by the cone's slope."""
    made = np.random.default_rng(seed)
    count = int(made.integers(3, 10))
    angles = (np.arange(count) + made.uniform(-0.4, 0.4, count)) * math.tau / count
    reach = made.uniform(3, 12, count)
    corners = np.column_stack([reach * np.cos(angles), reach * np.sin(angles)]).round(3)
    walls = pack(nested([polygon_contour([tuple(each) for each in corners.tolist()])]).regions)
    cone = VCutter(0.0, 0.5, 99.0)
    (way,) = carved(walls, cone, (-40.0,), NO_PROGRESS)
    a = np.concatenate([each.discs[:-1] for each in way.trails])
    b = np.concatenate([each.discs[1:] for each in way.trails])
    share = np.linspace(0, 1, 200)[:, None]
    discs = np.concatenate([p + (q - p) * share for p, q in zip(a, b, strict=True)])
    field = DistanceField.of(walls.rows)
    points = made.uniform(-12, 12, (600, 2))
    points = points[field.inside(points)]
    far = field.nearest(points)[0]
    apart = np.hypot(points[:, None, 0] - discs[None, :, 0], points[:, None, 1] - discs[None, :, 1])
    carved_to = (discs[None, :, 2] - apart).max(axis=1)
    assert (carved_to <= far + 6e-4).all()
    assert (far - carved_to).max() < 0.02  # the samples along the moves are up to 0.1 mm apart


def test_the_nearest_end_is_next() -> None:
    made = np.random.default_rng(5)
    ways = [AxisBranch(np.column_stack([made.uniform(0, 50, (2, 2)), [1.0, 1.0]])) for _ in range(60)]
    at, left = (0.0, 0.0), list(ways)
    for way in nearest_next(ways, at):
        ends = [(math.dist(each.discs[k, :2], at), each, k) for each in left for k in (0, -1)]
        _, nearest, begins = min(ends, key=lambda each: each[0])
        assert np.array_equal(way.discs, nearest.discs if begins == 0 else nearest.discs[::-1])
        left = [each for each in left if each is not nearest]
        at = (float(way.discs[-1, 0]), float(way.discs[-1, 1]))
    assert not left


def test_ends_that_are_a_little_apart_are_one_node() -> None:
    def way(*places: tuple[float, float]) -> AxisBranch:
        return AxisBranch(np.array([(x, y, 1.0) for x, y in places]))

    graph = graph_of([way((0, 0), (5, 0)), way((5 + 8e-6, 0), (9, 0)), way((5 + 3e-5, 0), (5, 7))])
    assert graph.ends == [(0, 1), (1, 2), (3, 4)] and graph.at == [[0], [0, 1], [1], [2], [2]]


@pytest.mark.parametrize("turn", [0.0, 0.4])
def test_no_ridge_is_higher_than_told_where_the_flat_tool_does_not_reach(turn: float) -> None:
    """Each place of the floor is within half a step of the cone's ways, or within the reach of the flat tool."""
    corners = np.array([(0, 0), (40, 0), (40, 9), (26, 12), (40, 15), (40, 30), (0, 30), (0, 16), (14, 14), (0, 11)])
    turned = corners @ np.array([[math.cos(turn), math.sin(turn)], [-math.sin(turn), math.cos(turn)]])
    walls = pack(nested([polygon_contour([(x, y) for x, y in turned.tolist()])]).regions)
    cone, depth, flat = VCutter(0.0, 1.0, 20.0), 1.0, 3.0
    made = floor_corners(walls, cone, depth, flat, NO_PROGRESS)
    field = DistanceField.of(walls.rows)
    low, high = turned.min(axis=0), turned.max(axis=0)
    places = np.random.default_rng(3).uniform(low, high, (40_000, 2))
    places = places[field.inside(places)]
    places = places[field.nearest(places)[0] >= depth]
    around, level = offset_levels(walls, [depth, depth + flat])
    beyond = DistanceField.of(within_half_turn(np.concatenate([ring.rows for ring in level.rings])))
    places = places[~beyond.inside(places)]
    places = places[beyond.nearest(places)[0] > flat]
    trails = [
        np.column_stack([way.discs[:-1, :2], way.discs[1:, :2], np.zeros((len(way.discs) - 1, 4))])
        for way in made.trails
    ]
    ways = DistanceField.of(
        within_half_turn(np.concatenate([*(ring.rows for ring in (*around.rings, *made.rings)), *trails]))
    )
    assert len(places) > 100
    assert ways.nearest(places)[0].max() <= RIDGE * cone.rate + 1e-3
