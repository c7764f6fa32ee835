"""The proof of the engaged angle: closed forms, programs that keep their limit, and the same programs spoiled."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from app.geometry.outlines import polygon_contour
from app.model.adaptive_operation import AdaptiveOperation
from app.model.job import Job
from app.model.moves import MoveKind, Moves
from app.model.operation import CutParameters, PocketOperation
from app.model.part import Entity, Part
from app.model.tool import Tool
from app.operations.compute import compute
from app.verify.engaged_angle import WIDENING, CutterPath, prove_engagement

R, ANGLE = 3.0, math.radians(60)


def path_of(moves: Moves, radius: float = R) -> CutterPath:
    return CutterPath(moves.start, moves.end, moves.centre, moves.kind, radius, 0.0)


def by_hand(*motions: tuple[float, ...], radius: float = R) -> CutterPath:
    """A path of (x, y, z) for lines and (x, y, z, cx, cy) for arcs counter-clockwise."""
    end = np.array([motion[:3] for motion in motions])
    centre = np.array([motion[3:] if len(motion) == 5 else (math.nan, math.nan) for motion in motions])
    kind = np.array([MoveKind.ARC_CCW if len(motion) == 5 else MoveKind.LINE for motion in motions], np.uint8)
    return CutterPath(np.concatenate([end[:1], end[:-1]]), end, centre, kind, radius, 0.0)


def pocket(depth: float = 2.0, high: float = 14.0) -> Job:
    walls = polygon_contour([(0, 0), (22, 0), (22, high), (0, high)])
    part = Part().with_entities(tuple(Entity(k, c, "0") for k, c in enumerate(walls.primitives, 1)))
    cut = CutParameters(1, depth=depth, stepdown=2.0)
    return Job(part, tools=(Tool(1, 2 * R),), operations=(AdaptiveOperation(cut, ANGLE),))


@pytest.fixture(scope="module")
def kept() -> CutterPath:
    return path_of(compute(pocket()).moves)


def round_a_hole(hole: float, turn: float) -> CutterPath:
    """A hole cleared by full circles of small steps, and one more circle round it."""
    down = [(0.0, 0.0, 1.0), (0.0, 0.0, -1.0)]
    steps = [*np.arange(0.1, hole - R, 0.4).tolist(), hole - R]
    circles = [
        each for rho in steps for each in ((rho, 0.0, -1.0), (-rho, 0.0, -1.0, 0.0, 0.0), (rho, 0.0, -1.0, 0.0, 0.0))
    ]
    return by_hand(*down, *circles, (-turn, 0.0, -1.0, (hole - R - turn) / 2, 0.0), (turn, 0.0, -1.0, 0.0, 0.0))


def test_a_line_through_metal_is_a_slot() -> None:
    proof = prove_engagement(by_hand((0, 0, 1), (0, 0, -1), (4, 0, -1)), ANGLE)
    assert proof.greatest.angle == pytest.approx(math.pi, abs=1e-3)
    (above,) = proof.above
    assert above.motion == 2 and proof.entries == 1 and proof.entry_mm == pytest.approx(2.0)


def test_a_circle_beside_a_cleared_disc_has_the_angle_of_the_closed_form() -> None:
    hole, turn = 5.0, 2.6
    cosine = (hole**2 - turn**2 - R**2) / (2 * turn * R)
    last = prove_engagement(round_a_hole(hole, turn), math.acos(cosine) + 1e-4)
    assert not [each for each in last.above if each.motion == len(round_a_hole(hole, turn).kind) - 1]
    less = prove_engagement(round_a_hole(hole, turn), math.acos(cosine) - 1e-3)
    assert [each for each in less.above if each.motion == len(round_a_hole(hole, turn).kind) - 1]


@pytest.mark.parametrize(("level", "above"), [(0.5 * WIDENING, 0), (1.5 * WIDENING, 1)])
def test_what_digits_make_level_within_a_way_down_belongs_to_it(level: float, above: int) -> None:
    """A ramp along a path of a few micrometres had level pieces, which were told as slots."""
    path = by_hand((0, 0, 1), (1, 0, -0.1), (1 + level, 0, -0.1), (1 + level, 1, -0.2), (1 + level, 1 + 1e-12, -0.2))
    assert len(prove_engagement(path, ANGLE).above) == above


def test_the_first_turn_counts_as_entry_only_as_long_as_it_is_small() -> None:
    def turn(radius: float) -> CutterPath:
        return by_hand((radius, 0, 1), (radius, 0, -1), (-radius, 0, -1, 0, 0), (radius, 0, -1, 0, 0))

    assert not prove_engagement(turn(WIDENING), ANGLE).above
    assert prove_engagement(turn(WIDENING + 0.01), ANGLE).above


def test_a_program_keeps_its_limit_and_hardly_less(kept: CutterPath) -> None:
    proof = prove_engagement(kept, ANGLE)
    assert not proof.above and proof.entries == 1
    assert ANGLE - math.radians(0.6) < proof.greatest.angle <= ANGLE
    assert prove_engagement(kept, proof.greatest.angle - math.radians(0.1)).above


def test_every_depth_is_metal_again() -> None:
    proof = prove_engagement(path_of(compute(pocket(4.0)).moves), ANGLE)
    assert not proof.above and proof.entries == 2


def cutting_arcs(path: CutterPath) -> list[int]:
    """Arcs that clear a disc beside the one before: the longest ones after the spiral."""
    arcs = np.flatnonzero((path.kind == MoveKind.ARC_CCW) & (path.start[:, 2] == path.end[:, 2]))
    size = np.hypot(*(path.end - path.start)[arcs, :2].T)
    late = arcs[np.argsort(-size, kind="stable")]
    return sorted(late[late > len(path.kind) // 3][:12].tolist())


def moved(path: CutterPath, arc: int, before: int) -> CutterPath:
    """The path with one arc 0.05 mm farther from the one before."""
    away = path.centre[arc] - path.centre[before]
    shift = 0.05 * away / max(float(np.hypot(*away)), 1e-9)
    end, start, centre = path.end.copy(), path.start.copy(), path.centre.copy()
    for column in (end, start, centre):
        column[arc, :2] += shift
    return replace(path, end=end, start=start, centre=centre)


def without_half(path: CutterPath) -> CutterPath:
    """The path without its third eighth."""
    n = len(path.kind)
    left = np.r_[0 : n // 4, n // 2 : n]
    return replace(path, start=path.start[left], end=path.end[left], centre=path.centre[left], kind=path.kind[left])


SPOILED: dict[str, Callable[[CutterPath], CutterPath]] = {
    "a part is left out": without_half,
    "a much thinner tool": lambda path: replace(path, radius=R - 1.0),
}


@pytest.mark.parametrize("how", SPOILED)
def test_a_spoiled_program_is_not_proven(kept: CutterPath, how: str) -> None:
    assert prove_engagement(SPOILED[how](kept), ANGLE).above


def test_hardly_an_arc_can_be_moved() -> None:
    """Of a slot that discs alone clear, as there is no room to turn along its walls."""
    kept = path_of(compute(pocket(high=9.0)).moves)
    arcs = cutting_arcs(kept)
    spoiled = [bool(prove_engagement(moved(kept, k, j), ANGLE).above) for j, k in pairwise(arcs) if j + 1 < k]
    assert len(spoiled) >= 4 and sum(spoiled) >= 0.7 * len(spoiled)


@pytest.mark.exhaustive
def test_rings_are_far_above() -> None:
    job = replace(pocket(), operations=(PocketOperation(CutParameters(1), 1.2),))
    proof = prove_engagement(path_of(compute(job).moves), ANGLE)
    assert proof.above and proof.greatest.angle > math.radians(150)


def test_a_way_down_onto_ground_that_several_arcs_have_cleared_is_no_entry(kept: CutterPath) -> None:
    """Before, one disc had to hold the cutter: ways down in wide places counted as entries, the next turn with them."""
    last = kept.end[-1].copy()
    middle = np.array([11.0, 5.0])
    up, over, down = ((*last[:2], 5.0), (*middle, 5.0), (*middle, float(kept.end[:, 2].min())))
    end = np.concatenate([kept.end, [up, over, down]])
    start = np.concatenate([kept.start, [last, up, over]])
    more = np.full(3, MoveKind.LINE, kept.kind.dtype)
    again = replace(
        kept,
        start=start,
        end=end,
        centre=np.concatenate([kept.centre, np.full((3, kept.centre.shape[1]), math.nan)]),
        kind=np.concatenate([kept.kind, more]),
    )
    assert prove_engagement(again, ANGLE).entries == prove_engagement(kept, ANGLE).entries == 1
