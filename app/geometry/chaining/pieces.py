"""What contours are chained from: one drawn curve as lines and arcs, and ends that are moved so that neighbours
meet.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ...core import tolerances
from ...core.errors import GeometryError
from ...core.pool import in_bands
from ...model.curves import Arc, Circle, Curve, Ellipse, Line, Point, Primitive, Spline, reversed_curve
from ...model.finding import Finding, FindingKind
from ...model.part import Entity
from ..arcs.arcs import equally_far, lines_and_arcs
from ..primitives import boxes, curve_rows

_AMPLIFIED = 2.0
"""An arc that would leave its circle by more than this many gaps is not moved; a line bridges the gap instead."""

_ROUNDING = 1e-9
"""What an arc leaves its circle by, mm, that is but the last digits of its coordinates."""


FARTHEST = 1e6
"""Coordinates beyond 1 km, mm, are no part of a workpiece; below, a double keeps WELD with room to spare."""
_FLAT = 1e-4
"""An arc that rises less than this over its chord, mm, is a line: its centre is too far away to be exact."""

_WORTH_TWO_CORES = 64
"""Ellipses and splines from which a second core is worth its start: half of the time of each is compiled code."""


@dataclass(frozen=True, slots=True)
class ChainPiece:
    """One drawn curve as primitives that join exactly.

    Attributes:
        entity: id of the entity that it came from.
        layer: the entity's layer.
        deviation: greatest distance between the drawn curve and the primitives, mm.
    """

    primitives: tuple[Primitive, ...]
    entity: int
    layer: str = "0"
    deviation: float = 0.0

    @property
    def start(self) -> Point:
        """Where it begins."""
        return self.primitives[0].start

    @property
    def end(self) -> Point:
        """Where it ends."""
        return self.primitives[-1].end

    @property
    def is_circle(self) -> bool:
        """True for a full circle, which has no ends to join."""
        return isinstance(self.primitives[0], Circle)

    def reversed(self) -> ChainPiece:
        """Return the same piece, travelled the other way."""
        back = tuple(reversed_curve(p) for p in reversed(self.primitives))
        return replace(self, primitives=back)  # type: ignore[arg-type]


def length_of(primitive: Primitive) -> float:
    """Return the length of a line, arc or circle, mm."""
    if isinstance(primitive, Line):
        return math.dist(primitive.start, primitive.end)
    if isinstance(primitive, Circle):
        return math.tau * primitive.radius
    return abs(primitive.sweep) * primitive.radius


class PiecesOfEntities(NamedTuple):
    """A piece for every entity that has a length, and findings on those that have none."""

    pieces: list[ChainPiece]
    findings: list[Finding]


class _PrimitivesNear(NamedTuple):
    """Primitives, and how far they are from what they stand for, mm."""

    primitives: Sequence[Primitive]
    deviation: float


def pieces_from(entities: Sequence[Entity]) -> PiecesOfEntities:
    """Return the pieces of entities."""
    pieces: list[ChainPiece] = []
    findings: list[Finding] = []
    for entity, made in zip(entities, _all_primitives(entities), strict=True):
        if isinstance(made, GeometryError):
            findings.append(
                Finding(FindingKind.TINY_ENTITY, f"Entity {entity.id} is left out: {made}", entity_ids=(entity.id,))
            )
            continue
        primitives, deviation = made
        if primitives:
            pieces.append(ChainPiece(tuple(primitives), entity.id, entity.layer, deviation))
        else:
            x, y = entity.curve.start
            findings.append(
                Finding(
                    FindingKind.TINY_ENTITY,
                    f"Entity {entity.id} at ({x:.3f}, {y:.3f}) has no length; it is left out.",
                    x,
                    y,
                    False,
                    (entity.id,),
                    0.0,
                )
            )
    return PiecesOfEntities(pieces, findings)


def within_reach(curve: Curve) -> bool:
    """Return whether all coordinates are numbers and none on the curve is beyond FARTHEST."""
    if isinstance(curve, Line):  # of which there may be very many
        (x0, y0), (x1, y1) = curve.start, curve.end
        return abs(x0) <= FARTHEST and abs(y0) <= FARTHEST and abs(x1) <= FARTHEST and abs(y1) <= FARTHEST
    if isinstance(curve, Spline):
        return bool(np.all(np.abs(np.array(curve.control_points)) <= FARTHEST))
    if isinstance(curve, Arc):
        return _arc_within_reach(curve)
    size = curve.radius if isinstance(curve, Circle) else math.hypot(*curve.major)
    return all(abs(v) + size <= FARTHEST for v in curve.centre)


def _arc_within_reach(arc: Arc) -> bool:
    if not all(abs(v) <= FARTHEST for v in (*arc.start, *arc.end)) or not all(map(math.isfinite, arc.centre)):
        return False
    if all(abs(v) + arc.radius <= FARTHEST for v in arc.centre):
        return True
    return bool((np.abs(boxes(np.array(curve_rows(arc)))) <= FARTHEST).all())


def straightened(curve: Curve) -> Curve:
    """Return an arc that rises less than 0.1 um over its chord as a line, any other curve as it is."""
    if not isinstance(curve, Arc) or curve.start == curve.end:
        return curve
    rise = curve.radius * (2 * math.sin(curve.sweep / 4) ** 2)
    return Line(curve.start, curve.end) if abs(curve.sweep) < 1.0 and rise < _FLAT else curve


def _all_primitives(entities: Sequence[Entity]) -> list[_PrimitivesNear | GeometryError]:
    """Return what each entity has become, or why it is nothing; many curves on all cores."""

    def become(entity: Entity) -> _PrimitivesNear | GeometryError:
        try:
            return _primitives(entity)
        except GeometryError as error:
            return error

    if sum(isinstance(each.curve, Ellipse | Spline) for each in entities) < _WORTH_TWO_CORES:
        return [become(each) for each in entities]
    bands = in_bands(lambda band: [become(each) for each in entities[band]], len(entities), _WORTH_TWO_CORES)
    return [each for band in bands for each in band]


def _primitives(entity: Entity) -> _PrimitivesNear:
    curve = straightened(entity.curve)
    if isinstance(curve, Arc) and curve.start == curve.end and not curve.ccw:  # its sweep is a full turn
        curve = Circle(curve.centre, curve.radius, curve.ccw)
    if not within_reach(curve):
        raise GeometryError("it has a coordinate that is not a number or beyond 1 km; delete it or draw it again.")
    if isinstance(curve, Ellipse | Spline):
        made = lines_and_arcs(curve)
        return _PrimitivesNear(made.primitives, made.deviation)
    if length_of(curve) < tolerances.WELD:
        return _PrimitivesNear((), 0.0)
    return _PrimitivesNear((curve,), _FLAT if isinstance(curve, Line) and curve is not entity.curve else 0.0)


def with_ends(piece: ChainPiece, start: Point, end: Point) -> ChainPiece:
    """Return the piece with its ends moved to meet its neighbours exactly.

    Lines turn, and one that is shorter than its gaps may vanish (no primitives are left). Arcs stay true arcs, with
    the centre moved least or with their sweep, whichever keeps nearer to the old circle. An arc that would leave it by
    more than twice the gap, as nearly full ones do, stays as it is and a short line bridges the gap.
    """
    if piece.is_circle or (start == piece.start and end == piece.end):
        return piece
    if start == end and len(piece.primitives) == 1:
        return _closed_on_itself(piece)
    ends = (start, end) if len(piece.primitives) == 1 else (start, piece.primitives[0].end)
    first, off = _moved(piece.primitives[0], *ends)
    body, deviation = [*first, *piece.primitives[1:]], off
    if len(piece.primitives) > 1:
        last, off = _moved(piece.primitives[-1], piece.primitives[-1].start, end)
        body, deviation = [*first, *piece.primitives[1:-1], *last], max(deviation, off)
    return replace(piece, primitives=tuple(body), deviation=piece.deviation + deviation)


def _closed_on_itself(piece: ChainPiece) -> ChainPiece:
    """Return an arc whose ends meet as a full circle, and a line, or an arc as short as its gap, as nothing."""
    arc = piece.primitives[0]
    if not isinstance(arc, Arc) or abs(arc.sweep) < math.pi:
        return replace(piece, primitives=())
    gap = math.dist(arc.start, arc.end)
    return replace(piece, primitives=(Circle(arc.centre, arc.radius, arc.ccw),), deviation=piece.deviation + gap)


def _moved(primitive: Primitive, start: Point, end: Point) -> _PrimitivesNear:
    """Return primitives from start to end in place of one."""
    gaps = math.dist(primitive.start, start), math.dist(primitive.end, end)
    gap = max(gaps)
    if gap == 0.0:
        return _PrimitivesNear([primitive], 0.0)
    if isinstance(primitive, Line):
        return _PrimitivesNear([Line(start, end)] if start != end else [], gap)
    if isinstance(primitive, Arc) and start != end:
        arc, off = min(
            ((made, off_circle(made, primitive)) for made in _refitted(primitive, start, end)),
            key=lambda choice: choice[1],
        )
        if off <= max(_AMPLIFIED * gap, _ROUNDING):
            return _PrimitivesNear([arc], max(off, gap))
    bridges: list[Primitive] = [primitive]
    if gaps[0] > 0:
        bridges.insert(0, Line(start, primitive.start))
    if gaps[1] > 0:
        bridges.append(Line(primitive.end, end))
    return _PrimitivesNear(bridges, gap)


def _refitted(arc: Arc, start: Point, end: Point) -> list[Arc]:
    """Return arcs between new ends: with the centre moved least, and with the same sweep."""
    half = arc.sweep / 2
    height = 1 / (2 * math.tan(half))
    dx, dy = end[0] - start[0], end[1] - start[1]
    turned = (start[0] + end[0]) / 2 - dy * height, (start[1] + end[1]) / 2 + dx * height
    return [Arc(start, end, centre, arc.ccw) for centre in (equally_far(start, end, arc.centre), turned)]


def off_circle(arc: Arc, old: Arc) -> float:
    """Return how far an arc leaves the circle of the old one, mm; inf when it runs the other way round."""
    if abs(arc.sweep - old.sweep) > math.pi:
        return math.inf
    angles = [arc.start_angle + arc.sweep * k / 16 for k in range(17)]
    points = [(arc.centre[0] + arc.radius * math.cos(a), arc.centre[1] + arc.radius * math.sin(a)) for a in angles]
    return max(abs(math.dist(p, old.centre) - old.radius) for p in points)
