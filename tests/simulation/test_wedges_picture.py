"""The sweep of a few moves in facets, for a picture of the method."""

import math
from itertools import pairwise

import numpy as np
import pytest

from app.core.errors import ParameterError
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.simulation.cutter import cutter_of
from app.simulation.gpu.wedges_picture import FINENESS, has_wedges, wedges_picture

BALL = Tool(1, 6.0, ToolKind.BALL)
TIPS = np.array([[0.0, 0.0, -2.0], [10.0, 0.0, -2.0], [10.0, 8.0, -3.0], [2.0, 8.0, -3.0]])


def distances(points, tips, radius):
    """How far points are from the chain of the ball's centres."""
    centres = tips + (0.0, 0.0, radius)
    found = np.full(len(points), np.inf)
    for a, b in pairwise(centres):
        share = np.clip((points - a) @ (b - a) / max(np.dot(b - a, b - a), 1e-300), 0.0, 1.0)
        found = np.minimum(found, np.linalg.norm(points - a - share[:, None] * (b - a), axis=1))
    return found


def test_facets_lie_on_what_the_ball_sweeps_and_look_down():
    made = wedges_picture(TIPS, BALL)
    corners = made.quads.reshape(-1, 3).astype(float)
    away = distances(corners, TIPS, BALL.radius)
    assert made.facet == BALL.radius / FINENESS
    assert away.max() < BALL.radius + 1e-4 and np.mean(np.abs(away - BALL.radius) < 1e-4) > 0.9
    middles = made.quads.mean(axis=1)
    assert middles[:, 2].max() < TIPS[:, 2].max() + BALL.radius + made.facet
    assert set(np.unique(made.kind)) == {0, 1} and len(made.kind) == len(made.quads)


def test_cylinders_run_along_moves_and_wedges_stand_at_corners():
    made = wedges_picture(TIPS, BALL)
    middles = made.quads.mean(axis=1).astype(float)
    corner = np.array([np.linalg.norm(middles - (tip + (0, 0, BALL.radius)), axis=1) for tip in TIPS]).min(axis=0)
    assert np.all(corner[made.kind == 1] <= BALL.radius + 1e-4)
    assert corner[made.kind == 0].min() > 1.2 * BALL.radius


def test_one_place_is_half_a_ball_and_finer_facets_are_more():
    ball = wedges_picture(TIPS[:1], BALL)
    assert set(np.unique(ball.kind)) == {1}
    assert ball.quads[..., 2].min() == pytest.approx(-2.0, abs=0.02)
    assert len(wedges_picture(TIPS, BALL, 0.1).quads) > 2 * len(wedges_picture(TIPS, BALL, 0.4).quads)


@pytest.mark.parametrize(
    "tool",
    [
        Tool(2, 6.0),
        Tool(3, 6.0, ToolKind.BULL, corner_radius=1.0),
        Tool(4, 6.0, ToolKind.V, tip_angle=math.radians(90)),
        Tool(5, 6.0, ToolKind.TAPER, tip_diameter=1.0, tip_angle=math.radians(20)),
    ],
    ids=lambda tool: tool.kind.value,
)
def test_every_cutter_has_facets_of_what_it_sweeps(tool: Tool) -> None:
    """Corners lie on the cutter at some place of its way, and nowhere within it: by its profile, as high over its tip
    as the nearest place of the way is far.
    """
    tips = np.array([[0.0, 0.0, -2.0], [10.0, 0.0, -2.0]])
    made, cutter = wedges_picture(tips, tool), cutter_of(tool)
    corners = made.quads.reshape(-1, 3).astype(float)
    flat = distances(corners * [1, 1, 0], tips * [1, 1, 0] - [0, 0, tool.radius], tool.radius)
    inside = flat < tool.radius - 1e-6
    off = corners[inside, 2] - (-2.0 + cutter.heights(flat[inside]))
    assert has_wedges(tool) and len(corners) > 100 and inside.any()
    assert np.abs(off).max() < 0.05 and flat.max() <= tool.radius + 1e-4


def test_a_tool_whose_shape_is_not_known_has_none() -> None:
    unknown = Tool(2, 6.0, ToolKind.V)
    assert not has_wedges(unknown)
    with pytest.raises(ParameterError):
        wedges_picture(TIPS, unknown)
