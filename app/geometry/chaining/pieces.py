"""What contours are chained from: one drawn curve as lines and arcs, and ends that are moved so that neighbours
meet.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core import tolerances
from ...core.errors import GeometryError
from ...core.wording import in_plane
from ...model.curves import Arc, Circle, Curve, Ellipse, Line, Point, Primitive, Spline, reversed_curve
from ...model.finding import Finding, FindingKind
from ...model.part import Contour, Entity
from ..arcs.alike import arcs_of_all
from ..arcs.arcs import equally_far
from ..near_points import pairs_meeting, pairs_within
from ..primitives import CX, TURN, X0, X1, R, Rows, boxes, curve_rows, distances, points_at, rows_of_each, sweeps
from ..primitives import lengths as row_lengths
from ..primitives import rows_of as primitive_rows

_AMPLIFIED = 2.0
"""An arc that would leave its circle by more than this many gaps is not moved; a line bridges the gap instead."""

_ROUNDING = 1e-9
"""What an arc leaves its circle by, mm, that is but the last digits of its coordinates."""

FARTHEST = 1e6
"""Coordinates beyond 1 km, mm, are no part of a workpiece; below, a double keeps WELD with room to spare."""

_FLAT = 1e-4
"""An arc that rises less than this over its chord, mm, is a line: its centre is too far away to be exact."""


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
                    f"Entity {entity.id} at {in_plane(x, y)} has no length; it is left out.",
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
        return all(abs(x) <= FARTHEST and abs(y) <= FARTHEST for x, y in curve.control_points)
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
    """Return what each entity has become, or why it is nothing."""
    curves = [_straight_or_far(entity.curve) for entity in entities]
    bent = [curve for curve in curves if isinstance(curve, Ellipse | Spline)]
    arcs = iter(arcs_of_all(bent) if bent else [])
    made: list[_PrimitivesNear | GeometryError] = []
    for entity, curve in zip(entities, curves, strict=True):
        if isinstance(curve, GeometryError):
            made.append(curve)
        elif isinstance(curve, Ellipse | Spline):
            near = next(arcs)
            made.append(near if isinstance(near, GeometryError) else _PrimitivesNear(near.primitives, near.deviation))
        elif length_of(curve) < tolerances.WELD:
            made.append(_PrimitivesNear((), 0.0))
        else:
            off = _FLAT if isinstance(curve, Line) and curve is not entity.curve else 0.0
            made.append(_PrimitivesNear((curve,), off))
    return made


def _straight_or_far(curve: Curve) -> Curve | GeometryError:
    """Return a curve, an arc that is none as what it is; or why it is left out."""
    curve = straightened(curve)
    if isinstance(curve, Arc) and curve.start == curve.end and not curve.ccw:  # its sweep is a full turn
        curve = Circle(curve.centre, curve.radius, curve.ccw)
    if not within_reach(curve):
        return GeometryError("it has a coordinate that is not a number or beyond 1 km; delete it or draw it again.")
    return curve


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


# Curves drawn twice, one inside another, or overlapping: found, and removed where no outline needs them.


Nodes = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Overlap:
    """Two pieces that run along one another.

    Attributes:
        first, second: indices of the pieces.
        length: of what they share, mm.
        start, end: ends of (the first stretch of) what they share, mm.
        removed: the second one was left out, as the first covers it.
        trimmed: one was cut to begin where the other ends.
    """

    first: int
    second: int
    length: float
    start: Point
    end: Point
    removed: bool = False
    trimmed: bool = False


def repeated(pieces: Sequence[ChainPiece], nodes: Nodes, reach: float) -> list[Overlap]:
    """Return pieces between the same points that keep within `reach` of an earlier one; those not needed are `removed`.

    All repeats go, but where the outlines left over would then have an odd number of ends at both points the
    repeat was a wall of two outlines, and comes back.
    """
    groups: dict[tuple[object, ...], list[int]] = {}
    for k in _perhaps_alike(pieces, nodes):
        a, b = nodes[k].tolist()
        groups.setdefault(_key(pieces[k], (a, b), reach), []).append(k)
    found: list[tuple[int, int]] = []
    for group in groups.values():
        kept: list[int] = []
        for k in group:
            original = next((j for j in kept if same(pieces[j], pieces[k], reach)), None)
            if original is None:
                kept.append(k)
            else:
                found.append((original, k))
    ends = np.bincount(nodes[nodes >= 0], minlength=1)
    for _, k in found:
        if nodes[k, 0] >= 0:
            np.subtract.at(ends, nodes[k], 1)
    overlaps = []
    for j, k in found:
        a, b = nodes[k]
        wall = a >= 0 and a != b and ends[a] % 2 == 1 and ends[b] % 2 == 1 and ends[a] > 1 and ends[b] > 1
        if wall:
            ends[a] += 1
            ends[b] += 1
        length = sum(map(length_of, pieces[k].primitives))
        overlaps.append(Overlap(j, k, length, pieces[k].start, pieces[k].end, not wall))
    return overlaps


def _perhaps_alike(pieces: Sequence[ChainPiece], nodes: Nodes) -> list[int]:
    """Return the pieces, by their indices, that are circles or end at the same points as another."""
    if not len(pieces):
        return []
    ends = np.sort(nodes, axis=1)
    _, which, count = np.unique(ends @ (int(nodes.max()) + 2, 1), return_inverse=True, return_counts=True)
    round_ones = np.array([piece.is_circle for piece in pieces], np.bool_)
    found: list[int] = np.flatnonzero(round_ones | (count[which] > 1)).tolist()
    return found


def _key(piece: ChainPiece, ends: tuple[int, int], reach: float) -> tuple[object, ...]:
    """Return what repeats have in common for certain; circles fall into cells far wider than `reach`, see `same`."""
    if isinstance(piece.primitives[0], Circle):
        circle = piece.primitives[0]
        return "circle", *(round(v / (1000 * reach)) for v in (*circle.centre, circle.radius))
    return min(ends), max(ends)


def same(a: ChainPiece, b: ChainPiece, reach: float) -> bool:
    """Return whether two circles, or two pieces whose ends are known to pair up, keep within `reach` of one another."""
    if a.is_circle or b.is_circle:
        p, q = a.primitives[0], b.primitives[0]
        return (
            isinstance(p, Circle)
            and isinstance(q, Circle)
            and math.dist(p.centre, q.centre) + abs(p.radius - q.radius) <= reach
        )
    mine, others = _marks(a), _marks(b)
    return min(max(map(math.dist, mine, others)), max(map(math.dist, mine, others[::-1]))) <= reach and (
        len(a.primitives) + len(b.primitives) == 2
        or _run_together(rows_of([a])[0], rows_of([b])[0], reach + tolerances.CURVE)
    )


def _marks(piece: ChainPiece) -> list[Point]:
    """Return the points at a quarter, a half and three quarters of the length, mm."""
    rows = primitive_rows(piece.primitives)[0]
    sizes = row_lengths(rows)
    upto = np.concatenate([[0.0], np.cumsum(sizes)])
    places = upto[-1] * np.array([0.25, 0.5, 0.75])
    index = np.clip(np.searchsorted(upto, places, side="right") - 1, 0, len(rows) - 1)
    points = points_at(rows[index], (places - upto[index]) / np.maximum(sizes[index], 1e-300))
    return [(float(x), float(y)) for x, y in points]


def shared_stretches(pieces: Sequence[ChainPiece], reach: float) -> list[Overlap]:
    """Return pairs of pieces that lie within `reach` of one another for longer than that, none of them removed."""
    rows, owner = rows_of(pieces)
    i, j = near_pairs(rows, reach)
    other = owner[i] != owner[j]
    i, j = i[other], j[other]
    shorter = row_lengths(rows[i]) < row_lengths(rows[j])
    i, j = np.where(shorter, j, i), np.where(shorter, i, j)
    lines, arcs = (rows[i, TURN] == 0) & (rows[j, TURN] == 0), (rows[i, TURN] != 0) & (rows[j, TURN] != 0)
    found: dict[tuple[int, int], Overlap] = {}
    for mask, share in ((lines, _line_share), (arcs, _arc_share)):
        low, high = share(rows[i[mask]], rows[j[mask]], reach)
        long = np.flatnonzero((high - low) * row_lengths(rows[i[mask]]) > max(reach, 2 * tolerances.WELD))
        a, b, low, high = i[mask][long], j[mask][long], low[long], high[long]
        for k, start, end in zip(range(len(long)), points_at(rows[a], low), points_at(rows[a], high), strict=True):
            first, second = sorted((int(owner[a[k]]), int(owner[b[k]])))
            length = float((high[k] - low[k]) * row_lengths(rows[a[k] : a[k] + 1])[0])
            known = found.get((first, second))
            found[first, second] = (
                Overlap(first, second, length, (float(start[0]), float(start[1])), (float(end[0]), float(end[1])))
                if known is None
                else Overlap(first, second, known.length + length, known.start, known.end)
            )
    return [found[key] for key in sorted(found)]


def rows_of(pieces: Sequence[ChainPiece]) -> tuple[Rows, NDArray[np.int64]]:
    """Return the rows (n, 8) of all pieces and the index (n,) of the piece that each is from."""
    counts = [len(piece.primitives) for piece in pieces]
    rows, which = primitive_rows([primitive for piece in pieces for primitive in piece.primitives])
    return rows, np.repeat(np.arange(len(pieces)), counts)[which]


def near_pairs(rows: Rows, reach: float) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the index pairs i < j of rows whose boxes, widened by `reach`, meet."""
    if len(rows) < 2:
        return np.zeros(0, np.int64), np.zeros(0, np.int64)
    split, owner = _quarters(rows)
    i, j = pairs_meeting(boxes(split) + np.array([-reach, -reach, reach, reach]), owner).T
    return i, j


def _quarters(rows: Rows) -> tuple[Rows, NDArray[np.int64]]:
    """Return rows with each arc cut into four, whose boxes are lean, and the index of the row that each is from."""
    arcs = np.flatnonzero(rows[:, TURN] != 0)
    if len(arcs) == 0:
        return rows, np.arange(len(rows))
    cuts = [points_at(rows[arcs], np.full(len(arcs), share)) for share in (0.0, 0.25, 0.5, 0.75, 1.0)]
    parts = [np.hstack([start, end, rows[arcs, CX:]]) for start, end in pairwise(cuts)]
    lines = np.flatnonzero(rows[:, TURN] == 0)
    return np.concatenate([rows[lines], *parts]), np.concatenate([lines, *[arcs] * 4])


def _line_share(a: Rows, b: Rows, reach: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the range of fractions of lines a that lines b cover; empty (high <= low) where they do not run
    together.
    """
    along = a[:, X1 : X1 + 2] - a[:, :2]
    length = np.maximum(np.hypot(along[:, 0], along[:, 1]), 1e-300)
    unit = along / length[:, None]
    fractions, off = [], np.zeros(len(a))
    for column in (X0, X1):
        arm = b[:, column : column + 2] - a[:, :2]
        off = np.maximum(off, np.abs(arm[:, 0] * unit[:, 1] - arm[:, 1] * unit[:, 0]))
        fractions.append((arm * unit).sum(axis=1) / length)
    low, high = np.maximum(np.minimum(*fractions), 0.0), np.minimum(np.maximum(*fractions), 1.0)
    return np.where(off <= reach, low, 1.0), np.where(off <= reach, high, 0.0)


def _arc_share(a: Rows, b: Rows, reach: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the range of fractions of arcs a that arcs b cover; arcs of rows sweep less than 3/4 pi."""
    off = np.zeros(len(a))
    for share in (0.0, 0.5, 1.0):
        point = points_at(b, np.full(len(b), share))
        off = np.maximum(off, np.abs(np.hypot(*(point - a[:, CX:R]).T) - a[:, R]))
    sweep = np.abs(sweeps(a))
    angles = []
    middle = points_at(a, np.full(len(a), 0.5)) - a[:, CX:R]
    for point in (b[:, :2], b[:, X1 : X1 + 2]):
        arm = point - a[:, CX:R]
        angle = np.arctan2(middle[:, 0] * arm[:, 1] - middle[:, 1] * arm[:, 0], (middle * arm).sum(axis=1)) * a[:, TURN]
        angles.append(angle)
    across = np.abs(angles[0] - angles[1]) > math.pi
    low = np.maximum(np.minimum(*angles) / sweep + 0.5, 0.0)
    high = np.minimum(np.maximum(*angles) / sweep + 0.5, 1.0)
    good = (off <= reach) & ~across
    return np.where(good, low, 1.0), np.where(good, high, 0.0)


def covered(pieces: Sequence[ChainPiece], nodes: Nodes, overlaps: Sequence[Overlap], reach: float) -> list[Overlap]:
    """Return the overlaps with `removed` set where one piece lies wholly on the other and no outline needs it.

    An outline needs a piece when an even number of ends meets at both of its points.
    """
    ends = np.bincount(nodes[nodes >= 0], minlength=1)
    gone: set[int] = set()
    result = []
    for overlap in overlaps:
        choices = sorted((sum(map(length_of, pieces[k].primitives)), -k) for k in (overlap.first, overlap.second))
        length, small = choices[0][0], -choices[0][1]
        large = overlap.first + overlap.second - small
        whole = overlap.length >= length - 2 * reach and not pieces[small].is_circle
        idle = whole and bool(ends[nodes[small, 0]] % 2 or ends[nodes[small, 1]] % 2)
        if idle and not {small, large} & gone:
            gone.add(small)
            np.subtract.at(ends, nodes[small], 1)
            result.append(Overlap(large, small, overlap.length, overlap.start, overlap.end, True))
        else:
            result.append(overlap)
    return result


def twin_contours(contours: Sequence[Contour], reach: float) -> dict[int, int]:
    """Return closed contours that run along an earlier one all the way round, each with that earlier one."""
    closed = [k for k, contour in enumerate(contours) if contour.closed]
    if len(closed) < 2:
        return {}
    rows = dict(zip(closed, rows_of_each([contours[k] for k in closed]), strict=True))
    every = boxes(np.concatenate([rows[k] for k in closed]))
    first = np.cumsum([0, *(len(rows[k]) for k in closed[:-1])])
    around = np.hstack([np.minimum.reduceat(every[:, :2], first), np.maximum.reduceat(every[:, 2:], first)])
    twins: dict[int, int] = {}
    for a, b in pairs_within(around, 4 * reach).tolist():
        kept, other = closed[a], closed[b]
        if kept not in twins and _run_together(rows[kept], rows[other], reach):
            twins.setdefault(other, kept)
    return twins


def _run_together(rows: Rows, others: Rows, reach: float) -> bool:
    return _along(rows, others, reach) and _along(others, rows, reach)


def _along(rows: Rows, others: Rows, reach: float) -> bool:
    """Return whether points all along some rows lie within `reach` of the others."""
    points = np.concatenate([points_at(rows, np.full(len(rows), share)) for share in (0.0, 0.3, 0.7)])
    return all(float(distances(others, np.broadcast_to(point, (len(others), 2))).min()) <= reach for point in points)
