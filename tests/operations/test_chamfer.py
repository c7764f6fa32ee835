"""Chamfers: heights and ways by closed form, corners, small holes, neighbours, and what is refused."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely

from app.core.errors import ParameterError
from app.geometry.distance import DistanceField
from app.geometry.outlines import nested, polygon_contour
from app.geometry.primitives import pack
from app.model.chamfer_operation import ChamferOperation
from app.model.curve_selectors import on_layers
from app.model.finding import FindingKind
from app.model.job import Job, Stock
from app.model.moves import MoveKind, Program, Purpose
from app.model.operation import CutParameters, Direction, Side
from app.model.part import Contour
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.operations.compute import compute
from tests.part_shapes import circle, layered_part, square

CONE = Tool(1, 12.0, ToolKind.V, tip_angle=math.radians(90))


def program_of(operation: ChamferOperation, *contours: Contour, tool: Tool = CONE, others=(), **more) -> Program:
    layers = {"a": list(contours)} | ({"b": list(others)} if others else {})
    return compute(Job(layered_part(layers), (tool,), (operation,), stock=Stock(thickness=10.0), **more))


def cutting(program: Program) -> np.ndarray:
    return program.moves.end[program.moves.purpose == Purpose.CONTOUR]


@pytest.mark.parametrize("side", [Side.INSIDE, Side.OUTSIDE])
@pytest.mark.parametrize(("angle", "tip"), [(90.0, 0.0), (60.0, 0.6)])
def test_a_circle_is_one_turn_beside_its_wall(side: Side, angle: float, tip: float) -> None:
    tool = Tool(1, 12.0, ToolKind.V, tip_angle=math.radians(angle), tip_diameter=tip)
    program = program_of(ChamferOperation(CutParameters(1), side, 1.0, 0.4), circle(10.0, 20, 30), tool=tool)
    rate = math.tan(math.radians(angle / 2))
    off = tip / 2 + 0.4 * rate
    ends = cutting(program)
    assert ends[:, 2] == pytest.approx(-(1.0 / rate + 0.4))
    assert np.hypot(*(ends[:, :2] - (20, 30)).T) == pytest.approx(10.0 - off if side is Side.INSIDE else 10.0 + off)
    assert not program.findings


@pytest.mark.parametrize("direction", list(Direction))
def test_climb_keeps_the_part_on_the_right(direction: Direction) -> None:
    operation = ChamferOperation(CutParameters(1, direction=direction), Side.OUTSIDE)
    moves = program_of(operation, circle(10.0, 0, 0)).moves
    arcs = moves.kind[moves.purpose == Purpose.CONTOUR]
    assert np.all(arcs == (MoveKind.ARC_CW if direction is Direction.CLIMB else MoveKind.ARC_CCW))


def test_round_a_square_the_way_keeps_off_the_corners() -> None:
    """No nearer to a corner than to a side: else the cone would round the edge below the chamfer."""
    program = program_of(ChamferOperation(CutParameters(1), Side.OUTSIDE, 1.0, 0.5), square(20))
    starts, ends = program.moves.start, program.moves.end
    mine = program.moves.purpose == Purpose.CONTOUR
    field = DistanceField.of(pack(nested([square(20)]).regions).rows)
    share = np.linspace(0, 1, 20)[:, None, None]
    straight = mine & (program.moves.kind == MoveKind.LINE)
    points = (starts[straight, :2] + (ends - starts)[straight, :2] * share).reshape(-1, 2)
    assert field.nearest(points)[0] == pytest.approx(0.5)
    round_it = mine & (program.moves.kind != MoveKind.LINE)
    corners = {tuple(np.round(each, 6)) for each in program.moves.centre[round_it].tolist()}
    assert corners == {(0, 0), (20, 0), (20, 20), (0, 20)}


def test_inner_corners_are_broken_to_their_points() -> None:
    program = program_of(ChamferOperation(CutParameters(1), Side.INSIDE, 1.0, 0.5), square(20))
    ends = program.moves.end  # one corner is where the tool goes down
    up = {(round(x, 5), round(y, 5)) for x, y, z in ends.tolist() if z == pytest.approx(-1.0, abs=1e-5)}
    assert up == {(0, 0), (20, 0), (20, 20), (0, 20)}  # the cone is 1 mm wide at the top, right at the corner


def test_a_hole_too_small_for_the_tip_offset_is_a_plunge() -> None:
    program = program_of(ChamferOperation(CutParameters(1), Side.INSIDE, 1.0, 2.0), circle(1.5, 5, 5))
    low = program.moves.end[program.moves.end[:, 2] < 0]
    assert low == pytest.approx(
        np.array([[5.0, 5.0, -2.5]])
    )  # touches the wall 1 mm down, and is 2.5 mm wide at the top


def test_a_neighbour_wall_stops_it_short_and_is_told() -> None:
    neighbour = polygon_contour([(20.9, 8), (30, 8), (30, 12), (20.9, 12)])
    operation = ChamferOperation(CutParameters(1, curves=on_layers(("a",))), Side.OUTSIDE, 1.0, 0.5)
    free = program_of(operation, square(20))
    program = program_of(operation, square(20), others=[neighbour])
    (finding,) = [each for each in program.findings if each.kind is FindingKind.LEFT_OUT]
    # the cone is 1.5 mm wide at the top, its axis 0.4 mm off the neighbour: lost is what is nearer than 1.5
    lost = 4 + 2 * math.sqrt(1.5**2 - 0.4**2)
    assert finding.counts and finding.amount == pytest.approx(lost, abs=0.02)
    assert "stops short of" in finding.text
    field = DistanceField.of(pack(nested([neighbour]).regions).rows)
    starts, ends = (
        each[program.moves.purpose == Purpose.CONTOUR][:, :2] for each in (program.moves.start, program.moves.end)
    )
    for share in np.linspace(0, 1, 50):
        assert field.nearest(starts + (ends - starts) * share)[0].min() > 1.5 - 1e-6 or share not in (0.0, 1.0)
    assert program.moves.lengths()[program.moves.purpose == Purpose.CONTOUR].sum() == pytest.approx(
        free.moves.lengths()[free.moves.purpose == Purpose.CONTOUR].sum() - finding.amount, abs=0.02
    )
    both = ChamferOperation(CutParameters(1), Side.OUTSIDE, 0.2, 0.2)  # a wall that is chamfered itself stops nothing
    assert not program_of(both, square(20), others=[neighbour]).findings


@pytest.mark.parametrize(
    ("operation", "tool", "words"),
    [
        (ChamferOperation(CutParameters(1), width=6.0), CONE, "needs a cone of 12.600 mm"),
        (ChamferOperation(CutParameters(1), width=2.0), Tool(1, 40.0, ToolKind.V, tip_angle=0.3), "13.533 mm deep"),
        (ChamferOperation(CutParameters(1)), Tool(1, 6.0), "needs a V cutter"),
    ],
)
def test_what_cannot_be_chamfered_is_refused(operation: ChamferOperation, tool: Tool, words: str) -> None:
    with pytest.raises(ParameterError, match=words):
        program_of(operation, square(20), tool=tool)


def test_on_the_line_there_is_no_edge() -> None:
    with pytest.raises(ParameterError, match="beside the line"):
        ChamferOperation(CutParameters(1), Side.ON)


@pytest.mark.parametrize("seed", range(6))
def test_random_parts_against_dense_sampling(seed: int) -> None:
    """Metal beside the walls: chamfered to where the wall is far, divided by the cone's slope, and nowhere deeper."""
    made = np.random.default_rng(seed)
    count = int(made.integers(3, 9))
    angles = (np.arange(count) + made.uniform(-0.3, 0.3, count)) * math.tau / count
    reach = made.uniform(6, 14, count)
    corners = np.column_stack([reach * np.cos(angles), reach * np.sin(angles)]).round(3)
    contour = polygon_contour([tuple(each) for each in corners.tolist()])
    program = program_of(ChamferOperation(CutParameters(1), Side.INSIDE, 0.8, 0.3), contour)
    moves = program.moves
    mine = np.flatnonzero((moves.purpose == Purpose.CONTOUR) | (moves.purpose == Purpose.PLUNGE))
    share = np.linspace(0, 1, 400)[:, None, None]
    path = (moves.start[mine] + (moves.end - moves.start)[mine] * share).reshape(-1, 3)
    field = DistanceField.of(pack(nested([contour]).regions).rows)
    points = made.uniform(-15, 15, (4000, 2))
    far = field.nearest(points)[0]
    points, far = (each[~field.inside(points) & (far < 0.8)] for each in (points, far))
    apart = np.hypot(points[:, None, 0] - path[None, :, 0], points[:, None, 1] - path[None, :, 1])
    heights = (path[None, :, 2] + apart).min(axis=1)
    wanted = -(0.8 - far)
    assert (heights >= wanted - 1e-3).all()
    assert np.abs(heights - wanted).max() < 0.01


BALL = Tool(1, 6.0, ToolKind.BALL)


@pytest.mark.parametrize(("width", "down"), [(0.8, None), (0.5, 0.9), (1.2, 0.7)])
@pytest.mark.parametrize("side", [Side.INSIDE, Side.OUTSIDE])
def test_a_ball_goes_through_both_ends_of_the_chamfer(width: float, down: float | None, side: Side) -> None:
    """Round a circle: the meridian of the ball passes `width` beside the edge at the top and `down` below it."""
    program = program_of(ChamferOperation(CutParameters(1), side, width, down=down), circle(10.0, 20, 30), tool=BALL)
    ends = cutting(program)
    (z,) = set(np.round(ends[:, 2], 9).tolist())
    off = (np.hypot(*(ends[:, :2] - (20, 30)).T) - 10.0) * (1 if side is Side.OUTSIDE else -1)
    assert np.ptp(off) < 1e-9
    centre = np.array([off[0], z + BALL.radius])
    assert np.hypot(*(centre - (-width, 0.0))) == pytest.approx(BALL.radius)
    assert np.hypot(*(centre - (0.0, -(width if down is None else down)))) == pytest.approx(BALL.radius)
    assert centre.min() > 0, "it undercuts neither the top nor the wall"
    assert not program.findings


def test_the_ball_of_equal_sides_in_closed_form() -> None:
    """(c + w)^2 + c^2 = r^2: so much keeps the axis off, and so high is the centre."""
    operation = ChamferOperation(CutParameters(1), Side.OUTSIDE, 0.8)
    c = (-0.8 + math.sqrt(2 * 3.0**2 - 0.8**2)) / 2
    ball = operation.ball(BALL)
    assert ball is not None
    assert (ball.off, ball.above) == (pytest.approx(c), pytest.approx(c))
    assert operation.deepest(BALL) == pytest.approx(3.0 - c)


@pytest.mark.parametrize(
    ("operation", "tool", "words"),
    [
        (ChamferOperation(CutParameters(1), width=4.5), BALL, "it would undercut the edge"),
        (ChamferOperation(CutParameters(1), width=0.8, down=0.1), BALL, "it would undercut the edge"),
        (ChamferOperation(CutParameters(1), width=0.8, down=0.9), CONE, "makes chamfers of 0.8 mm 0.8000 mm deep"),
        (ChamferOperation(CutParameters(1)), Tool(1, 6.0, ToolKind.BULL, corner_radius=1.0), "or a ball"),
    ],
)
def test_what_a_ball_or_cone_cannot_break_is_refused(operation: ChamferOperation, tool: Tool, words: str) -> None:
    with pytest.raises(ParameterError, match=words):
        program_of(operation, square(20), tool=tool)


def test_a_ball_keeps_off_a_neighbour_wall_and_tells() -> None:
    neighbour = polygon_contour([(22.0, 8), (30, 8), (30, 12), (22.0, 12)])
    operation = ChamferOperation(CutParameters(1, curves=on_layers(("a",))), Side.OUTSIDE, 0.8)
    program = program_of(operation, square(20), tool=BALL, others=[neighbour])
    (finding,) = [each for each in program.findings if each.kind is FindingKind.LEFT_OUT]
    ball = operation.ball(BALL)
    assert ball is not None
    reach = ball.off + 0.8
    assert finding.amount == pytest.approx(4 + 2 * math.sqrt(reach**2 - (2.0 - ball.off) ** 2), abs=0.02)
    assert "smaller ball" in finding.text


def test_a_hole_too_small_for_the_ball_is_told() -> None:
    operation = ChamferOperation(CutParameters(1), Side.INSIDE, 0.8)
    program = program_of(operation, circle(1.2, 5, 5), circle(9.0, 30, 5), tool=BALL)
    (finding,) = [each for each in program.findings if each.kind is FindingKind.REGION_TOO_SMALL]
    assert finding.counts and (finding.x, finding.y) == (pytest.approx(5.0, abs=0.01), pytest.approx(5.0, abs=0.01))


@pytest.mark.parametrize("seed", range(3))
def test_a_ball_round_random_parts_against_dense_sampling(seed: int) -> None:
    """Metal beside the walls of convex parts: as high as the ball's meridian, and nowhere deeper."""
    made = np.random.default_rng(seed)
    corners = made.uniform(-12, 12, (7, 2))
    hull = shapely.MultiPoint(corners).convex_hull
    contour = polygon_contour([tuple(each) for each in np.round(hull.exterior.coords[:-1], 3).tolist()])
    operation = ChamferOperation(CutParameters(1), Side.OUTSIDE, 0.8, down=1.0)
    moves = program_of(operation, contour, tool=BALL).moves
    mine = np.flatnonzero(moves.purpose == Purpose.CONTOUR)
    share = np.linspace(0, 1, 600)[:, None, None]
    start, end = moves.start[mine], moves.end[mine]
    path = (start + (end - start) * share)[:, moves.kind[mine] == MoveKind.LINE].reshape(-1, 3)
    field = DistanceField.of(pack(nested([contour]).regions).rows)
    points = made.uniform(-13, 13, (4000, 2))
    far = field.nearest(points)[0]
    points, far = (each[field.inside(points) & (far < 0.8)] for each in (points, far))
    apart = np.hypot(points[:, None, 0] - path[None, :, 0], points[:, None, 1] - path[None, :, 1])
    below = np.sqrt(np.maximum(BALL.radius**2 - apart**2, 0.0))
    heights = np.where(apart < BALL.radius, path[None, :, 2] + BALL.radius - below, 0.0).min(axis=1)
    ball = operation.ball(BALL)
    assert ball is not None
    wanted = ball.above - np.sqrt(BALL.radius**2 - (ball.off + far) ** 2)
    assert (heights >= wanted - 1e-3).all()
    assert np.median(np.abs(heights - wanted)) < 1e-3, "at corners the arcs are left out here"
