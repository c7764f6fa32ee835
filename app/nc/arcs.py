"""Arcs under rounding: what G2 and G3 blocks to write so that the control's arc is the one that was meant.

A control knows an arc by its rounded start, its rounded end and a rounded centre. Rounding each by itself makes the
two radii differ, and turns an arc whose ends round to one point into a full circle or into nothing. So the centre is
solved again from the rounded ends, every written arc is measured against the meant one, and what does not fit is
split in halves, down to pieces so flat that a line is as good. Controls take arcs of less than about 1e-6 rad for
full circles; such an arc is flat in this sense for any radius below 1e8 mm.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from dataclasses import dataclass

Grid = tuple[int, int]
"""A point as counts of the last decimal of X and Y."""

SAMPLES = 8

FARTHEST_ROUNDED = math.sqrt(0.5)
"""How far a point may be from the nearest grid point, in steps of the last decimal."""

NEIGHBOURS = ((0, 0), (1, 0), (0, 1), (-1, 0), (0, -1), (1, 1), (-1, 1), (-1, -1), (1, -1))


@dataclass(frozen=True, slots=True)
class MeantArc:
    """An arc as the tool path has it, out units.

    Attributes:
        centre: as a complex number.
        start_radius, end_radius: distances of the ends from the centre; alike but for the path's own rounding.
        start_angle: radians.
        sweep: radians, counter-clockwise positive, not 0, at most a full turn.
    """

    centre: complex
    start_radius: float
    end_radius: float
    start_angle: float
    sweep: float

    def at(self, fraction: float) -> complex:
        """Return the point at a fraction in [0, 1] of the sweep."""
        radius = self.start_radius + (self.end_radius - self.start_radius) * fraction
        return self.centre + cmath.rect(radius, self.start_angle + self.sweep * fraction)


@dataclass(frozen=True, slots=True)
class ArcRules:
    """What a written arc must keep to.

    Attributes:
        decimals: of X and Y.
        centre_decimals: of I and J, not less.
        tolerance: largest distance between the written and the meant arc, point by point, out units.
        largest_sweep: radians, < 2 pi.
        smallest_radius, largest_radius: out units; the smallest is > 0.
        radius_mismatch: largest difference of the two radii, out units.
    """

    decimals: int
    centre_decimals: int
    tolerance: float
    largest_sweep: float
    smallest_radius: float
    largest_radius: float
    radius_mismatch: float


@dataclass(frozen=True, slots=True)
class Piece:
    """One block: an arc, or a line where `centre` is None.

    Attributes:
        end: counts of the last decimal.
        fraction: of the whole arc that is done at the end, in (0, 1].
        centre: from the block's start to the centre, counts of the last decimal of I and J.
    """

    end: Grid
    fraction: float
    centre: Grid | None = None


def written_pieces(arc: MeantArc, start: Grid, end: Grid, rules: ArcRules) -> list[Piece]:
    """Return the blocks that cut an arc between its rounded ends.

    Each block's path stays within `rules.tolerance` of its stretch of the meant arc, and is swept in step with it, so
    that neither can leave the other. An arc smaller than the last decimal gives no block at all.

    Args:
        arc: the meant arc.
        start, end: where the control is and has to be, the nearest grid points to the arc's ends.
        rules: tolerance and limits.
    """
    parts = math.ceil(abs(arc.sweep) / rules.largest_sweep)
    done: list[Piece] = []
    begun = 0.0
    for part in range(parts):
        fraction, stop = (1.0, end) if part == parts - 1 else _between(arc, (part / parts, (part + 2) / parts), rules)
        done += _stretch(arc, (begun, fraction), (start, stop), rules)
        begun, start = fraction, stop
    return done


def _between(arc: MeantArc, span: tuple[float, float], rules: ArcRules) -> tuple[float, Grid]:
    """Return the grid point nearest to the middle of a stretch, and how far along the arc it is by its own angle."""
    middle = (span[0] + span[1]) / 2
    point = _nearest(arc.at(middle), rules.decimals)
    from_centre = complex(*point) / 10**rules.decimals - arc.centre
    beyond = cmath.phase(from_centre / cmath.rect(1.0, arc.start_angle + arc.sweep * middle))
    fraction = middle + beyond / arc.sweep
    return fraction if span[0] < fraction < span[1] else middle, point


def _stretch(arc: MeantArc, span: tuple[float, float], ends: tuple[Grid, Grid], rules: ArcRules) -> Iterator[Piece]:
    """Yield the blocks of one stretch: a line where it is flat, one arc where that fits, else those of its halves."""
    step = 10.0**-rules.decimals
    if _sagitta(arc, span) < min(0.5 * step, rules.tolerance - FARTHEST_ROUNDED * step):
        if ends[0] != ends[1]:
            yield Piece(ends[1], span[1])
        return
    for centre in _centres(arc, ends, rules):
        if _fits(arc, span, (ends, centre), rules):
            yield Piece(ends[1], span[1], centre)
            return
    fraction, between = _between(arc, span, rules)
    yield from _stretch(arc, (span[0], fraction), (ends[0], between), rules)
    yield from _stretch(arc, (fraction, span[1]), (between, ends[1]), rules)


def _sagitta(arc: MeantArc, span: tuple[float, float]) -> float:
    """Return how far the stretch bulges from its chord."""
    half = abs(arc.sweep) * (span[1] - span[0]) / 2
    return max(arc.start_radius, arc.end_radius) * 2 * math.sin(half / 2) ** 2


def _centres(arc: MeantArc, ends: tuple[Grid, Grid], rules: ArcRules) -> Iterator[Grid]:
    """Yield I and J to try: the point equally far from both rounded ends and nearest to the meant centre, rounded; then its neighbours."""
    start, end = (complex(*point) / 10**rules.decimals for point in ends)
    chord = end - start
    if chord == 0:
        return
    middle, normal = (start + end) / 2, chord * 1j / abs(chord)
    along = ((arc.centre - middle) * normal.conjugate()).real
    i, j = _nearest(middle + along * normal - start, rules.centre_decimals)
    yield from ((i + right, j + up) for right, up in NEIGHBOURS)


def _fits(arc: MeantArc, span: tuple[float, float], block: tuple[tuple[Grid, Grid], Grid], rules: ArcRules) -> bool:
    """Tell whether the control's arc keeps to the rules."""
    ends, offset = block
    start, end = (complex(*point) / 10**rules.decimals for point in ends)
    centre = start + complex(*offset) / 10**rules.centre_decimals
    first, last = start - centre, end - centre
    least, most = sorted((abs(first), abs(last)))
    if least < rules.smallest_radius or most > rules.largest_radius or most - least > rules.radius_mismatch:
        return False
    turn = (cmath.phase(last) - cmath.phase(first)) % math.tau
    written = MeantArc(centre, abs(first), abs(last), cmath.phase(first), turn if arc.sweep > 0 else turn - math.tau)
    return written.sweep != 0 and _largest_distance(written, arc, span) <= rules.tolerance


def _largest_distance(written: MeantArc, arc: MeantArc, span: tuple[float, float]) -> float:
    """Return an upper bound of the distance between two arcs swept in step, the second over a stretch of it.

    The distance vector is sampled; between two samples it leaves their chord by at most h^2 / 8 times its second
    derivative. That is at most sweep^2 times the distance itself, which goes to the other side of the inequality, and what
    the difference of centres, of sweeps and of radii adds.
    """
    size = span[1] - span[0]
    gaps = [abs(written.at(k / SAMPLES) - arc.at(span[0] + size * k / SAMPLES)) for k in range(SAMPLES + 1)]
    sweep, shift = arc.sweep * size, abs(written.centre - arc.centre)
    radius = max(arc.start_radius, arc.end_radius)
    spiral = 2 * (abs(written.sweep * (written.end_radius - written.start_radius)) + abs(arc.sweep * (arc.end_radius - arc.start_radius)))
    bend = written.sweep**2 * shift + abs(written.sweep**2 - sweep**2) * radius + spiral
    return (max(gaps) + bend / (8 * SAMPLES**2)) / (1 - written.sweep**2 / (8 * SAMPLES**2))


def _nearest(point: complex, decimals: int) -> Grid:
    """Return the nearest grid point."""
    return (round(point.real * 10**decimals), round(point.imag * 10**decimals))
