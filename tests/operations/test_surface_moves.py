"""Passes over surfaces as moves: there and back or one way, joined over the surface or in the air, never below it."""

import math
from itertools import pairwise

import numpy as np
import pytest
import shapely

from app.model.moves import MoveKind, Purpose
from app.model.scene import Strategy
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.operations.parallel.surface_moves import PLUNGE_ANGLE, PassFamily, SurfaceMoves, surface_moves
from app.surfaces.passes.path import Follower, FollowOptions, cutter_path
from app.surfaces.sections.compound import NO_SURFACE
from tests.surfaces.scenes import along_x, ball, facets_of, plane

TOOL = Tool(5, 4.0, ToolKind.BALL, feed_rate=800.0, plunge_rate=200.0)


def moves_of(strategy: Strategy, gap: float = 4.0, area: shapely.Geometry | None = None) -> SurfaceMoves:
    follower = Follower(facets_of(plane(0, -10, 40, 10), ball(20, 0, -2, 8)), TOOL, FollowOptions(0.0, 0.01))
    path = cutter_path(follower, along_x(-4.0, -2.0, 0.0, 2.0), area)
    return surface_moves([PassFamily(path, follower, TOOL, strategy, gap)], 30.0, 10.0)


def passes(made: SurfaceMoves) -> list[np.ndarray]:
    """Return the ends of moves of each pass."""
    cut = made.moves.purpose == Purpose.CONTOUR
    edges = np.flatnonzero(np.diff(np.concatenate([[0], cut.astype(int), [0]])))
    return [made.moves.end[first:stop] for first, stop in edges.reshape(-1, 2)]


def test_zigzag_goes_there_and_back_and_never_leaves_the_surface() -> None:
    made = moves_of(Strategy.ZIGZAG)
    ways = [np.sign(each[-1, 0] - each[0, 0]) for each in passes(made)]
    assert ways == [1, -1, 1, -1]
    rapids = np.flatnonzero(made.moves.kind == MoveKind.RAPID)
    assert len(rapids) == 3  # over the first place, down to it, and up at the end
    assert np.sum(made.moves.purpose == Purpose.LINK) >= 3


def test_one_way_comes_back_in_the_air() -> None:
    made = moves_of(Strategy.ONE_WAY)
    assert [np.sign(each[-1, 0] - each[0, 0]) for each in passes(made)] == [1, 1, 1, 1]
    ends, rapid = made.moves.end, made.moves.kind == MoveKind.RAPID
    for before, after in pairwise(range(len(ends))):
        if rapid[after] and np.abs(ends[after, :2] - ends[before, :2]).max() > 0:
            assert ends[before, 2] == ends[after, 2] == 30.0
    assert not (made.moves.purpose == Purpose.LINK).any()


def test_what_is_too_far_apart_is_joined_in_the_air_and_rapids_end_above() -> None:
    made = moves_of(Strategy.ZIGZAG, gap=1.0)
    rapid = made.moves.kind == MoveKind.RAPID
    assert made.moves.end[rapid][:, 2].min() >= 10.0
    plunge = made.moves.purpose == Purpose.PLUNGE
    assert plunge.sum() == 4 and set(made.moves.feed[plunge].tolist()) == {200.0}
    way = np.diff(made.moves.end, axis=0, prepend=made.moves.end[:1])
    steep = -way[:, 2] > math.tan(PLUNGE_ANGLE) * np.hypot(way[:, 0], way[:, 1])
    along = made.moves.purpose == Purpose.CONTOUR
    assert set(made.moves.feed[along & ~steep].tolist()) == {800.0}
    # but for steps of less than a tenth
    assert {200.0} <= set(made.moves.feed[along & steep].tolist()) <= {200.0, 800.0}


def test_links_over_a_gap_do_not_exist() -> None:
    """Where the way between two passes leaves the surfaces, it is not gone at their height."""
    follower = Follower(facets_of(plane(0, -10, 40, -6), plane(0, 6, 40, 10)), TOOL)
    path = cutter_path(follower, along_x(-7.0, 7.0))
    made = surface_moves([PassFamily(path, follower, TOOL, Strategy.ZIGZAG, 50.0)], 30.0, 10.0)
    assert not (made.moves.purpose == Purpose.LINK).any()


@pytest.mark.parametrize("strategy", Strategy)
def test_each_move_knows_its_surface_and_none_goes_below(strategy: Strategy) -> None:
    made = moves_of(strategy)
    ends, on = made.moves.end, made.surface
    assert set(on[made.moves.purpose == Purpose.CONTOUR].tolist()) == {0, 1}
    assert set(on[made.moves.purpose != Purpose.CONTOUR].tolist()) == {NO_SURFACE}
    chords = np.concatenate([ends[:-1], ends[1:]], axis=1)
    steps = np.linspace(0, 1, 9)[:, None, None]
    along = chords[None, :, :3] + steps * (chords[None, :, 3:] - chords[None, :, :3])
    assert along[..., 2].min() >= -1e-4
    off = np.linalg.norm(along + [0, 0, 2.0] - [20, 0, -2], axis=-1) - 10.0
    assert off.min() >= -1e-4
    flat = (on[1:] == 0) & (made.moves.purpose[1:] == Purpose.CONTOUR)
    assert np.abs(chords[flat][:, [2, 5]]).max() <= 1e-4
