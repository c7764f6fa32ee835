"""Whether what is machined is what was drawn, link by link: an independent witness measures the drawn curves
themselves.

Curves → contours → areas of the operations → polygons that the floor is measured with. Each link is asked for its area,
and what it has to be is known without it; a link that lost something is told, and the job is not clean.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import shapely
from numpy.typing import NDArray

from ..core import tolerances
from ..core.errors import GeometryError
from ..geometry.arcs.bezier import pieces_of
from ..geometry.chaining.chain import ChainingResult
from ..geometry.chaining.findings import at
from ..geometry.chaining.pieces import length_of, within_reach
from ..geometry.distance import DistanceField
from ..geometry.even_odd import even_odd
from ..geometry.outlines import NestingResult, Outlines
from ..geometry.overlay.overlay import differing
from ..geometry.primitives import contour_rows, points_at, sample
from ..model.curves import Arc, Circle, Curve, Ellipse, Line, Primitive, Spline
from ..model.finding import Finding, FindingKind
from ..model.moves import Area
from ..model.part import Contour, Entity, Region
from .coverage.areas import region_shapes

Floats = NDArray[np.float64]

_CHORD = 1e-4
"""mm; ellipses and splines are measured as chords this near to them."""

_FINEST = 14
"""Halvings of a spline's pieces after which its chords are taken as they are."""

_QUARTER = 64
"""Chords of a quarter turn of a polygon round a line."""

_NAMED = 5
"""So many curves are named in a sentence."""


def chaining_findings(entities: Sequence[Entity], chaining: ChainingResult, join_tolerance: float) -> list[Finding]:
    """Return the findings that contours are not all that was drawn, or have another area than their curves.

    Args:
        entities: what was chained.
        chaining: into this.
        join_tolerance: mm; curves no longer than gaps may have gone into joints.
    """
    known = {number for contour in chaining.contours for number in contour.entity_ids}
    known.update(number for finding in chaining.findings for number in finding.entity_ids)
    lost = [each for each in entities if each.id not in known and _long(each.curve, 2 * join_tolerance)]
    return [
        *_about_lost(lost),
        *_about_outlines(entities, [contour for contour in chaining.contours if contour.closed]),
    ]


def _long(curve: Curve, least: float) -> bool:
    if not within_reach(curve):
        return False
    try:
        return sum(map(length_of, drawn_as(curve))) > least
    except GeometryError:  # what cannot be measured is told where it is read
        return False


def _about_lost(lost: Sequence[Entity]) -> list[Finding]:
    if not lost:
        return []
    x, y = lost[0].curve.start
    names = ", ".join(str(each.id) for each in lost[:_NAMED]) + (
        f" and {len(lost) - _NAMED} more" if len(lost) > _NAMED else ""
    )
    text = (
        f"{'Curve' if len(lost) == 1 else 'Curves'} {names}, the first at {at((x, y))}, came into no contour, and "
        "nothing says why; do not use this program, draw them again."
    )
    return [Finding(FindingKind.AREA, text, x, y, entity_ids=tuple(each.id for each in lost), amount=float(len(lost)))]


def _about_outlines(entities: Sequence[Entity], contours: Sequence[Contour]) -> list[Finding]:
    """Return the finding that closed contours have not the area of their curves as drawn, but for gaps and what was cut
    from them.
    """
    if not contours:
        return []
    requested = {number for contour in contours for number in contour.entity_ids}
    curves = [each.curve for each in entities if each.id in requested]
    plain = [Contour((curve,)) for curve in curves if isinstance(curve, Line | Circle | Arc) and not _is_nothing(curve)]
    bent = [_places(curve) for curve in curves if isinstance(curve, Ellipse | Spline)]
    drawn = even_odd(plain, (), _chords(bent))
    made = even_odd(contours)
    moved = float(Outlines.of(contours).lengths @ np.array([contour.deviation for contour in contours]))
    starts = [contour.primitives[0].start[0] for contour in contours] + [
        p.end[0] for contour in contours for p in contour.primitives
    ]
    wide = max(starts) - min(starts)
    spare = moved + drawn.loose * wide + drawn.length * 2 * _CHORD * bool(bent)
    return differing(drawn, made.area, contours, spare)


def _chords(ways: Sequence[Floats]) -> Floats:
    """Return the chords (m, 4) from place to place of ways (n, 2)."""
    ways = [way for way in ways if len(way)]
    if not ways:
        return np.zeros((0, 4))
    places, ends = np.concatenate(ways), np.cumsum([len(way) for way in ways])
    before_last = np.ones(len(places), np.bool_)
    before_last[ends - 1] = False
    begin = np.flatnonzero(before_last)
    return np.hstack([places[begin], places[begin + 1]])


def drawn_as(curve: Curve) -> tuple[Primitive, ...]:
    """Return a curve as lines and arcs: itself, or the chords of an ellipse or spline."""
    if isinstance(curve, Line | Circle | Arc):
        return () if _is_nothing(curve) else (curve,)
    ends = [(float(x), float(y)) for x, y in _places(curve)]
    return tuple(Line(a, b) for a, b in pairwise(ends) if a != b)


def _is_nothing(curve: Primitive) -> bool:
    return isinstance(curve, Arc) and curve.start == curve.end


def _places(curve: Ellipse | Spline) -> Floats:
    """Return places (n, 2) along an ellipse or spline between which it is measured as chords."""
    from ..geometry.arcs.chord_kernels import chords

    found, count = chords(np.ascontiguousarray(pieces_of(curve).control), _CHORD, _FINEST)
    places: Floats = found[:count]
    return places


def region_findings(contours: Sequence[Contour], outlines: Sequence[Contour], nesting: NestingResult) -> list[Finding]:
    """Return the findings that regions are not the even-odd area of contours without what outlines hold.

    Args:
        contours: closed, as they were drawn.
        outlines: of clamps.
        nesting: what came of them.
    """
    made = float(_outlines(nesting.regions).areas.sum())
    thin = float(np.abs(Outlines.of(nesting.thin).areas).sum())
    found = differing(even_odd(contours, outlines), made + thin, contours)
    found += _about_edges([*contours, *outlines], nesting.regions)
    if thin > tolerances.LEVEL:
        x, y = nesting.thin[0].primitives[0].start
        count = "1 area" if len(nesting.thin) == 1 else f"{len(nesting.thin)} areas"
        text = f"Left out: {count} thinner than 1 um, {thin:.4f} mm2 in all, at {at((x, y))} for one."
        found.append(
            Finding(FindingKind.LEFT_OUT, text, x, y, counts=False, entity_ids=nesting.thin[0].entity_ids, amount=thin)
        )
    return found


def grown_findings(lines: Sequence[Contour], distance: float, grown: Sequence[Contour]) -> list[Finding]:
    """Return the finding that outlines do not hold what lies within a distance of lines, mm, as polygons measure it."""
    if not lines:
        return []
    ways = [np.concatenate([sample(rows, _CHORD), rows[-1:, 2:4]]) for rows in map(contour_rows, lines)]
    around = shapely.union_all(shapely.buffer(list(map(shapely.LineString, ways)), distance, quad_segs=_QUARTER))
    made = even_odd(grown).area if grown else 0.0
    off = abs(float(around.area) - made)
    if off <= float(around.length) * (_CHORD + distance * (1 - math.cos(math.pi / 4 / _QUARTER))):
        return []
    x, y = lines[0].primitives[0].start
    text = (
        f"The slot along the line that begins at {at((x, y))} came out {off:.4f} mm2 off; do not use this program, "
        "draw what overlaps there once and compute again."
    )
    ids = tuple(dict.fromkeys(number for line in lines for number in line.entity_ids))
    return [Finding(FindingKind.AREA, text, x, y, entity_ids=ids, amount=off)]


def _about_edges(curves: Sequence[Contour], regions: Sequence[Region]) -> list[Finding]:
    """Return the finding that an edge of a region lies where nothing is drawn."""
    if not curves or not regions:
        return []
    rows = _outlines(regions).rows
    middles = points_at(rows, np.full(len(rows), 0.5))
    away = DistanceField.of(Outlines.of(curves).rows).nearest(middles)[0]
    worst = int(np.argmax(away))
    if away[worst] <= tolerances.LEVEL:
        return []
    x, y = middles[worst].tolist()
    text = (
        f"A wall at {at((x, y))} lies {away[worst]:.4f} mm off everything that is drawn; do not use this program, "
        "draw that place again."
    )
    return [Finding(FindingKind.AREA, text, x, y, amount=float(away[worst]))]


def _outlines(regions: Sequence[Region]) -> Outlines:
    return Outlines.of([contour for region in regions for contour in region.contours])


def floor_findings(areas: Sequence[Area], chord: float) -> list[Finding]:
    """Return the findings that polygons by which floors are measured are not the areas of the operations.

    Args:
        chord: by which arcs of the polygons may miss them, mm.
    """
    found = []
    for regions in {id(area.regions): area.regions for area in areas if area.regions}.values():
        walls = _outlines(regions)
        missing = float(walls.areas.sum() - shapely.area(region_shapes(regions, chord)).sum())
        if abs(missing) > walls.lengths.sum() * chord:
            x, y = regions[0].boundary.primitives[0].start
            text = (
                f"The floor from {at((x, y))} on is measured {abs(missing):.4f} mm2 too "
                f"{'small' if missing > 0 else 'large'}, so what is said to be left is not true; do not use this "
                "program."
            )
            found.append(Finding(FindingKind.AREA, text, x, y, amount=abs(missing)))
    return found
