"""One stroke: rings joined by a tree of bridges, and walked so that the tool never lifts (step 143).

The walk starts on the innermost ring and goes outwards where it can, so the tool widens what is already cut; or the
other way round, from the outermost frame inwards. A ring that is reached from inside has its metal on the wall side,
one reached from outside has it inside: climb milling takes the first in the ring's own direction and the second the
other way round.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ...geometry.distance import DistanceField
from ...geometry.offset.offset import OffsetLevel, Ring
from ...model.operation import Direction
from ..build import Stroke
from .bridge import RingBridge, RingEdges, RingField, inward_bridges, is_clear, level_bridges, outward
from .runs import NOTHING, GapFilling
from .tree import BridgeForest
from .walk import TreeWalk, WalkedTree

_TRIED = 32
"""Bridges between two rings that are looked at before they are taken to have none."""


@dataclass(frozen=True)
class LinkOptions:
    """How rings are cut.

    Attributes:
        direction: climb or conventional.
        outside_in: begin at the walls, not inside.
    """

    direction: Direction = Direction.CLIMB
    outside_in: bool = False


def link(
    levels: Sequence[OffsetLevel],
    field: DistanceField,
    options: LinkOptions,
    filling: GapFilling = NOTHING,
    step: float = 0.0,
) -> tuple[Stroke, ...]:
    """Return as few strokes as there are connected areas that the tool's centre can be in.

    Args:
        levels: rings of the pocket tool, outermost first.
        field: distances from the drawing.
        filling: what cuts all that the levels leave.
        step: between levels, mm, where it is no more than the tool's radius: then ways between rings save pieces of
            them; 0 = none is.
    """
    if not levels:
        return ()
    rings = [ring for level in (*levels, *filling.halves) for ring in level.rings]
    depth = [float(k) for k, level in enumerate(levels) for _ in level.rings]
    depth += [k + 0.5 for k, level in enumerate(filling.halves) for _ in level.rings]
    bridges = inward_bridges(levels, filling.halves, field)
    areas = sum(ring.area > 0 for ring in levels[0].rings)
    known = RingEdges(rings)
    tree = _grown(_SeparateRings(known, BridgeForest(len(rings)), areas), bridges, levels, field)
    lines = _lines_out(tree.roots(depth), _NumberedRings(rings, depth), levels, field)
    bridges = [*(bridge for line in lines.values() for bridge in line), *bridges]
    tree = _grown(_SeparateRings(known, BridgeForest(len(rings)), areas), bridges, levels, field)
    return _strokes(WalkedTree(rings, depth, tree, filling.detours, (field, levels[0].distance), step), options, lines)


def _grown(
    apart: _SeparateRings, bridges: Sequence[RingBridge], levels: Sequence[OffsetLevel], field: DistanceField
) -> BridgeForest:
    for bridge in bridges:
        apart.tree.add(bridge)
    _join_across(levels, apart, field)
    return apart.tree


def _lines_out(
    roots: Sequence[int], walked: _NumberedRings, levels: Sequence[OffsetLevel], field: DistanceField
) -> dict[int, list[RingBridge]]:
    """Return the straight line of bridges from each root out to the outermost level, innermost first; roots without one
    have none.
    """
    deep = max((walked.depth[root] for root in roots), default=0.0)
    first, targets = 0, []
    for k, level in enumerate(levels):
        if k < deep:
            targets.append((level.distance, RingField.of(level.rings, first)))
        first += len(level.rings)
    counts = np.array([min(math.ceil(walked.depth[root]), len(targets)) for root in roots], np.int64)
    return outward({root: walked.rings[root] for root in roots}, counts, targets, field)


def link_by_proof(
    levels: Sequence[OffsetLevel], field: DistanceField, direction: Direction, spacing: float
) -> tuple[Stroke, ...]:
    """Return few strokes through rings that are no exact levels, such as those of pixels.

    Between such rings no bridge is clear by construction, so every bridge, shortest first, is proven clear step by
    step.

    Args:
        levels: rings of the pocket tool, outermost first; bridges keep the outermost one's distance.
        field: distances from the walls.
        spacing: between points of rings that bridges may begin at, mm.
    """
    rings = [ring for level in levels for ring in level.rings]
    tree = BridgeForest(len(rings))
    if levels:
        apart = _SeparateRings(RingEdges(rings), tree, sum(ring.area > 0 for ring in levels[0].rings))
        _join(range(len(rings)), apart, (field, levels[0].distance), (spacing, _TRIED))
    depth = [float(k) for k, level in enumerate(levels) for _ in level.rings]
    return _strokes(
        WalkedTree(rings, depth, tree, (), (field, levels[0].distance if levels else 0.0)), LinkOptions(direction), {}
    )


def _strokes(walked: WalkedTree, options: LinkOptions, lines: Mapping[int, Sequence[RingBridge]]) -> tuple[Stroke, ...]:
    """Return the walks through all trees of a forest.

    Args:
        lines: bridges that a tree's walk goes along, by root; the longest way through the tree where there are none.
    """
    walk = TreeWalk(walked, options.direction, options.outside_in)
    return tuple(walk.stroke(root, lines.get(root, ())) for root in walked.tree.roots(walked.depth))


@dataclass(frozen=True)
class _NumberedRings:
    """All rings, and how far inside each is: the number of its level."""

    rings: Sequence[Ring]
    depth: Sequence[float]


@dataclass
class _SeparateRings:
    """Rings that should be in as many groups as there are connected areas.

    Attributes:
        edges: of all of them. tree: over them.
        areas: rings of the outermost level that turn left.
    """

    edges: RingEdges
    tree: BridgeForest
    areas: int

    @property
    def too_many(self) -> int:
        """Groups more than there are areas."""
        return len({self.tree.group(k) for k in range(len(self.edges.rings))}) - self.areas


def _join_across(levels: Sequence[OffsetLevel], apart: _SeparateRings, field: DistanceField) -> None:
    """Join what bridges from level to level left apart, over ridges: between rings with nothing inside, outermost ones,
    or any.
    """
    depth = [k for k, level in enumerate(levels) for _ in level.rings]
    tops = [
        k
        for k in range(len(depth))
        if all(there.ring >= len(depth) or depth[there.ring] <= depth[k] for _, there, _ in apart.tree.neighbours[k])
    ]
    for some in (tops, range(len(levels[0].rings)), range(len(apart.edges.rings))):
        _join(some, apart, (field, levels[0].distance), (levels[0].distance / 4, None))


def _join(
    some: Sequence[int], apart: _SeparateRings, clear: tuple[DistanceField, float], spacing: tuple[float, int | None]
) -> None:
    """Join groups of rings by the shortest bridges between some of them that are clear, until there are no more than
    areas.

    Args:
        clear: distances from the walls, and which of them bridges keep, mm.
        spacing: between points that bridges may begin at, mm; bridges between two rings that are tried, None = all.
    """
    too_many = apart.too_many
    if too_many <= 0 or len(some) < 2:
        return
    for bridge, (a, b) in level_bridges(apart.edges, some, apart.tree.group, *spacing):
        if is_clear(clear[0], a, b, clear[1]):
            apart.tree.add(bridge)
            too_many -= 1
            if too_many == 0:
                return
