"""Smoothing of a traced contour line as the text of 1986 has it (401-407), beside the settled one: for the class, never
for a cut.

It finds circles by formula II, lines by the five-step average, both sums SA and SB and a histogram with one peak,
vertices by the sharpest stable average, arcs from eight points, and lays a spline through the rest. Where the text
names no limit one is named here.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ...core.errors import GeometryError
from .smoothed_path import Floats, PieceKind

AVERAGED = 5
"""Unit vectors of an average."""

_C_SPREAD = 0.2
"""Formula II holds where C changes by no more than this share: the text says "constant"."""
_SA, _SB = 0.75, 0.35
"""Pixels, a pixel of the interval: a line or circle is one where both sums are no more; the text names no limit."""
_TURN = math.radians(25.0)
"""Averages that turn by more begin another line."""
_SHARP = math.radians(35.0)
"""From such an angle on a vertex is looked for; the text says "sharp to some degree"."""
_LEAST_LINE, _LEAST_ARC = 6, 12
"""Pixels."""
_KNOTS = 4
"""Every so manieth pixel is a knot of a spline."""


@dataclass(frozen=True, eq=False)
class PublishedPiece:
    """A piece of a contour line.

    Attributes:
        first, last: its pixels by number; `last` may be beyond the end of the line and goes on from its beginning.
        kind: what it was found to be.
        places: (k, 2) places along it, px: two of a line, many of the others.
        sa, sb: both sums a pixel, px; 0 of a spline.
        off: how far its own pixels are from it, px, the farthest.
    """

    first: int
    last: int
    kind: PieceKind
    places: Floats
    sa: float
    sb: float
    off: float


@dataclass(frozen=True, eq=False)
class PublishedSmoothing:
    """A whole line.

    Attributes:
        pieces: in order.
        vertices: pixels by number at which averages turn the sharpest (404).
        spread: by what share C of formula II changes along the line.
    """

    pieces: tuple[PublishedPiece, ...]
    vertices: tuple[int, ...]
    spread: float

    def counted(self, kind: PieceKind) -> int:
        """Return how many pieces are of a kind."""
        return sum(piece.kind is kind for piece in self.pieces)

    @property
    def off(self) -> float:
        """How far a pixel is from its piece, px, the farthest."""
        return max((piece.off for piece in self.pieces), default=0.0)


def published_smoothing(pixels: Floats, long_line: float) -> PublishedSmoothing:
    """Return a closed line of pixels as circles, lines, arcs and splines by the text's own rules.

    Args:
        pixels: (n, 2) centres, px, in order round the line, none twice in a row, n >= 8.
        long_line: ten tool diameters, px.

    Raises:
        GeometryError: the line has fewer than eight pixels.
    """
    if len(pixels) < _LEAST_ARC // 2 + 2:
        raise GeometryError(f"a contour line of {len(pixels)} pixels; smoothing needs eight or more.")
    work = _Line(np.asarray(pixels, np.float64))
    spread = work.formula_two()
    whole = work.circle(0, len(pixels))
    if spread <= _C_SPREAD and whole is not None:
        return PublishedSmoothing((whole,), (), spread)
    long = [piece for piece in work.lines(work.straight()) if work.length(piece) >= long_line]
    vertices = work.vertices(long)
    pieces: list[PublishedPiece] = []
    for first, last in work.gaps(long):
        pieces += work.filled(first, last, vertices)
    kept = sorted((*long, *pieces), key=lambda piece: piece.first)
    return PublishedSmoothing(tuple(kept), tuple(vertices), spread)


def average_angles(pixels: Floats) -> tuple[Floats, Floats]:
    """Return for each pixel of a closed line the angle between the averages of five vectors into it and out of it by
    formula I' (its arccos, 0 to pi), and the same angle with its sign, to the left above 0.
    """
    steps = np.roll(pixels, -1, axis=0) - pixels
    into = sum(np.roll(steps, k, axis=0) for k in range(1, AVERAGED + 1))
    out = sum(np.roll(steps, -k, axis=0) for k in range(AVERAGED))
    assert isinstance(into, np.ndarray) and isinstance(out, np.ndarray)
    dot = np.einsum("ij,ij->i", into, out)
    cross = into[:, 0] * out[:, 1] - into[:, 1] * out[:, 0]
    size = np.linalg.norm(into, axis=1) * np.linalg.norm(out, axis=1)
    arccos = np.arccos(np.clip(np.divide(dot, size, out=np.ones_like(dot), where=size > 0), -1.0, 1.0))
    return arccos, np.arctan2(cross, dot)


class _Line:
    """One closed line of pixels."""

    def __init__(self, pixels: Floats) -> None:
        self._pixels, self._count = pixels, len(pixels)
        self._steps = np.roll(pixels, -1, axis=0) - pixels
        self._codes = np.rint(np.degrees(np.arctan2(self._steps[:, 1], self._steps[:, 0])) / 45).astype(int) % 8

    def part(self, first: int, last: int) -> Floats:
        """Return the pixels from one to another, both included."""
        return self._pixels[np.arange(first, last + 1) % self._count]

    def length(self, piece: PublishedPiece) -> float:
        """Return how long a line is, px."""
        return math.dist(piece.places[0], piece.places[-1])

    def formula_two(self) -> float:
        """Return by what share C = (x² + y²) / y changes, x along the line's first average and the first pixel the
        origin (401).
        """
        way = self._steps[:AVERAGED].sum(axis=0)
        way = way / max(float(np.linalg.norm(way)), 1e-300)
        own = self._pixels - self._pixels[0]
        x, y = own @ way, own @ np.array([-way[1], way[0]])
        far = np.abs(y) > 2.0  # near the origin both are next to nothing
        if not far.any():
            return math.inf
        c = (x[far] ** 2 + y[far] ** 2) / y[far]
        return float(np.std(c) / max(abs(float(np.mean(c))), 1e-300))

    def circle(self, first: int, last: int) -> PublishedPiece | None:
        """Return the circle by the mean of the centres of triples, where both sums let it be one (III to V)."""
        part = self.part(first, last)
        eight = part[np.linspace(0, len(part) - 1, 9).astype(int)]
        centres = [_centre(*eight[[k, k + 3, k + 5]]) for k in range(4)]
        known = [centre for centre in centres if centre is not None]
        if not known:
            return None
        centre = np.mean(known, axis=0)
        radii = np.linalg.norm(part - centre, axis=1)
        radius = float(np.mean(radii))
        off = radii - radius
        sa, sb = float(np.mean(np.abs(off))), float(abs(np.mean(off)))
        if sa > _SA or sb > _SB or radius > 10 * self._count:
            return None
        angle = np.unwrap(np.arctan2(part[:, 1] - centre[1], part[:, 0] - centre[0]))
        seen = np.linspace(angle[0], angle[-1], max(16, len(part) // 2))
        places = centre + radius * np.column_stack([np.cos(seen), np.sin(seen)])
        kind = PieceKind.CIRCLE if last - first >= self._count else PieceKind.ARC
        return PublishedPiece(first, last, kind, places, sa, sb, float(np.abs(off).max()))

    def straight(self) -> list[tuple[int, int]]:
        """Return intervals in which the five-step average keeps its direction: lines for the time being (403)."""
        mean = sum(np.roll(self._steps, -k, axis=0) for k in range(AVERAGED))
        assert isinstance(mean, np.ndarray)
        angle = np.arctan2(mean[:, 1], mean[:, 0])
        found: list[tuple[int, int]] = []
        first = 0
        for k in range(1, self._count + 1):
            turned = (angle[k % self._count] - angle[first] + math.pi) % (2 * math.pi) - math.pi
            if abs(turned) > _TURN or k == self._count:
                if k - first >= _LEAST_LINE:
                    found.append((first, k - 1))
                first = k
        return found

    def lines(self, intervals: list[tuple[int, int]], kind: PieceKind = PieceKind.LONG_LINE) -> list[PublishedPiece]:
        """Return the intervals that both sums and the histogram find to be lines."""
        found: list[PublishedPiece] = []
        for first, last in intervals:  # an average takes in steps beyond a corner: so many are tried without
            tried = (self.line(first + k, last - k, kind) for k in range(AVERAGED) if last - first - 2 * k >= 2)
            found += [piece for piece in tried if piece is not None][:1]
        return found

    def line(self, first: int, last: int, kind: PieceKind) -> PublishedPiece | None:
        """Return the line a x + b y + c = 0 along the mean vector of an interval, where it is one (IV to VI)."""
        part = self.part(first, last)
        way = part[-1] - part[0]
        size = float(np.linalg.norm(way))
        if size == 0.0 or not self.one_peak(first, last):
            return None
        way = way / size
        middle = part.mean(axis=0)
        off = (part - middle) @ np.array([-way[1], way[0]])
        sa, sb = float(np.mean(np.abs(off))), float(abs(np.mean(off)))
        if sa > _SA or sb > _SB:
            return None
        along = (part - middle) @ way
        places = middle + np.array([along.min(), along.max()])[:, None] * way
        return PublishedPiece(first, last, kind, places, sa, sb, float(np.abs(off).max()))

    def one_peak(self, first: int, last: int) -> bool:
        """Tell whether the histogram of an interval's directions has one peak: neighbouring directions are one."""
        seen = np.bincount(self._codes[np.arange(first, last) % self._count], minlength=8)
        peaks = [k for k in range(8) if seen[k] > 0 and seen[k] >= seen[k - 1] and seen[k] > seen[(k + 1) % 8]]
        return len(peaks) == 1

    def vertices(self, long: list[PublishedPiece]) -> list[int]:
        """Return the pixels at which two averages turn the sharpest, tried from five starts, outside of long lines
        (404).
        """
        taken = np.zeros(self._count, bool)
        for piece in long:
            taken[np.arange(piece.first, piece.last + 1) % self._count] = True
        sharpest = np.zeros(self._count)
        for start in range(-AVERAGED // 2, AVERAGED // 2 + 1):
            angle, _ = average_angles(np.roll(self._pixels, start, axis=0))
            sharpest = np.maximum(sharpest, np.roll(angle, -start))
        found: list[int] = []
        for k in np.flatnonzero((sharpest > _SHARP) & ~taken).tolist():
            around = sharpest[np.arange(k - AVERAGED, k + AVERAGED + 1) % self._count]
            if sharpest[k] >= around.max() and not any((k - other) % self._count < AVERAGED for other in found):
                found.append(k)
        return found

    def gaps(self, long: list[PublishedPiece]) -> list[tuple[int, int]]:
        """Return the intervals between long lines, the whole line where there are none."""
        if not long:
            return [(0, self._count)]
        ends = [(piece.first, piece.last) for piece in long]
        after = [*ends[1:], (ends[0][0] + self._count, 0)]
        return [(last, first) for (_, last), (first, _) in zip(ends, after, strict=True) if first - last > 1]

    def filled(self, first: int, last: int, vertices: list[int]) -> Iterator[PublishedPiece]:
        """Yield short lines from vertex to vertex, arcs, and a spline for what is neither (405-407)."""
        inner = sorted(k + turn for k in vertices for turn in (0, self._count) if first < k + turn < last)
        edges = [first, *inner, last]
        for a, b in pairwise(edges):
            piece = self.line(a, b, PieceKind.SHORT_LINE) if b - a >= 2 else None
            if piece is None and b - a >= _LEAST_ARC:
                piece = self.circle(a, b)
            yield piece if piece is not None else self.spline(a, b)

    def spline(self, first: int, last: int) -> PublishedPiece:
        """Return a cubic spline by every fourth pixel of an interval, its ends among them."""
        from scipy.interpolate import CubicSpline

        part = self.part(first, last)
        at = np.unique(np.concatenate([np.arange(0, len(part), _KNOTS), [len(part) - 1]]))
        if len(at) < 2:
            return PublishedPiece(first, last, PieceKind.SPLINE, part, 0.0, 0.0, 0.0)
        curve = CubicSpline(at, part[at])
        off = np.linalg.norm(curve(np.arange(len(part))) - part, axis=1)
        places = curve(np.linspace(0, len(part) - 1, 4 * len(part)))
        return PublishedPiece(first, last, PieceKind.SPLINE, places, 0.0, 0.0, float(off.max()))


def _centre(a: Floats, b: Floats, c: Floats) -> Floats | None:
    """Return the centre of the circle through three places; None where they are in a line."""
    (x0, y0), (x1, y1), (x2, y2) = a, b, c
    twice = 2 * ((x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0))
    if abs(twice) < 1e-9:
        return None
    p, q = (x1 - x0) ** 2 + (y1 - y0) ** 2, (x2 - x0) ** 2 + (y2 - y0) ** 2
    return np.array([x0 + ((y2 - y0) * p - (y1 - y0) * q) / twice, y0 + ((x1 - x0) * q - (x2 - x0) * p) / twice])
