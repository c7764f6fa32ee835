"""Smooth surfaces of the tip behind passes of any cutter, told apart by surface, and the passes lifted onto them.

What a cutter's tip does over a facet lies on a plane, whatever the cutter's shape: the facet moved by where it is
touched. So method D holds for the tip's places as it does for a ball's, and each smooth piece of a compound surface
becomes a smooth surface of the tip. Where passes go from one piece to the next, the place at which both are as high is
solved for, as the boundary points of a compound surface are.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.errors import InputError
from ...core.options import option
from ...core.progress import Progress
from ...fitting.point_surfaces.chord_bounds import chord_bounds
from ...fitting.point_surfaces.facet_corners import FacetCorners
from ...fitting.point_surfaces.height_spline import FittedHeights, HoldingPoints, fit_heights
from ...fitting.point_surfaces.surface_pieces import NO_PIECE, surface_pieces
from ...model.motion import Floats
from ...simulation.cutter import Cutter
from ...simulation.sweeps.probe import PathProbe
from .area import PassArea
from .result import SurfaceFigures
from .surface import FacetLimits, box_of
from .tracks import TrackedProgram, filled_places

Ints = NDArray[np.int64]

_MARGIN = 0.1
"""mm; a surface goes on so far beyond its points."""
_BLEND = 4.0
"""Times the pitch: at an end that stays where it is a pass comes down to it over such a way."""
_DEEPER = 1.5
"""Times what facets may be off: metal that is so much deeper was cut by another move."""
_SAME = 1e-9
"""mm; a place of the program is the one that was looked at."""
_SHARE = 4 * np.finfo(float).eps
"""Of a chord: so near a crossing is found."""
_MOST_PARTS = 64
"""Of a chord: one that needs more is no chord of a smooth surface."""


@dataclass(frozen=True, eq=False)
class SmoothedPieces:
    """The smooth surfaces of the tip behind a program's passes.

    Attributes:
        tracked: the passes. rows: places along them. piece: (n,) of each the surface that it is on, or NO_PIECE.
        cut_deeper: how many places others cut deeper. corners, fitted: of each surface.
        off: (n,) of each place on a surface how far that is from it, square to it, mm; 0 of others.
        facets: of all surfaces.
    """

    tracked: TrackedProgram
    rows: tuple[Floats, ...]
    piece: Ints
    cut_deeper: int
    corners: tuple[FacetCorners, ...]
    fitted: tuple[FittedHeights, ...]
    off: Floats
    facets: int

    @property
    def area(self) -> PassArea:
        """Where the passes are."""
        return self.tracked.area

    @property
    def farthest_mm(self) -> float:
        """How far a place of the program is from its surface at most, square to it, mm."""
        return float(np.abs(self.off).max(initial=0.0))

    @property
    def farthest_place(self) -> Floats:
        """Where that is, (3,) mm."""
        place: Floats = np.concatenate(self.rows)[int(np.argmax(np.abs(self.off)))]
        return place

    @property
    def kept_places(self) -> int:
        """How many places are on no surface and stay as they were."""
        return int(np.sum(self.piece == NO_PIECE))

    @property
    def figures(self) -> SurfaceFigures:
        """What they are, in figures."""
        return SurfaceFigures(
            passes=len(self.tracked.lines),
            places=len(self.piece),
            cut_deeper=self.cut_deeper,
            facets=self.facets,
            shape=tuple((len(corners.places), corners.kind.value) for corners in self.corners),
            spans=tuple(fitted.spans for fitted in self.fitted),
            left_out_mm=max((fitted.left_out_mm for fitted in self.fitted), default=0.0),
            kept=self.kept_places,
        )


@dataclass(frozen=True, eq=False)
class CutCourse:
    """What made passes, and what they left: the cutter, and heights of the program as it was cut."""

    cutter: Cutter
    heights: PathProbe


def smooth_pieces(
    name: str, tracked: TrackedProgram, course: CutCourse, limits: FacetLimits, progress: Progress
) -> SmoothedPieces:
    """Return the smooth surfaces behind passes: by the epsilon that leaves them nearest to the program's places.

    Args:
        name: of the file, for messages. tracked: the passes. course: what made them.
        limits: what may be a facet, and how far facets may be off.

    Raises:
        InputError: no part of the passes lies on facets. Cancelled: the job was asked to stop.
    """
    count, found = len(limits.epsilons), []
    for k, epsilon in enumerate(limits.epsilons):
        share = progress.part(k / count, (k + 1) / count)
        found.append(_fitted(tracked, epsilon, limits.off, share))
        found[-1] = _without_deeper(found[-1], course, _DEEPER * limits.off)
    useful = [each for each in found if np.mean(each.piece != NO_PIECE) > 0.5]
    if not useful:
        raise InputError(
            f"{name}: its passes lie on no facets that tell of a smooth surface; use another {option('epsilon')}, "
            "or smooth."
        )
    within = [each for each in useful if each.farthest_mm <= limits.off]
    return min(within or useful, key=lambda each: (each.kept_places if within else 0, each.farthest_mm))


def _fitted(tracked: TrackedProgram, epsilon: float, off: float, progress: Progress) -> SmoothedPieces:
    rows = tracked.rows
    points = np.concatenate(rows)
    parts = surface_pieces(rows, epsilon, progress.part(0.0, 0.3))
    fitted, count = [], max(len(parts.corners), 1)
    for k, corners in enumerate(parts.corners):
        own = points[parts.piece == k]
        holding, share = HoldingPoints(own), progress.part(0.3 + 0.7 * k / count, 0.3 + 0.7 * (k + 1) / count)
        fitted.append(fit_heights(corners.places, corners.weights, holding, box_of(own, _MARGIN), share))
    piece = _with_loose_places(rows, parts.piece, fitted, off)
    away = _square_off(points, piece, fitted)
    return SmoothedPieces(tracked, rows, piece, 0, parts.corners, tuple(fitted), away, parts.facets)


def _with_loose_places(rows: tuple[Floats, ...], piece: Ints, fitted: list[FittedHeights], off: float) -> Ints:
    """Return of each place its piece: those of none, as at an edge, have that of the next place before or behind them
    in their row whose surface they are nearer to, where that is no more than facets may be off.
    """
    points, made = np.concatenate(rows), piece.copy()
    begin = np.cumsum([0, *(len(row) for row in rows)])
    own = np.repeat(np.arange(len(rows)), np.diff(begin))
    at = np.arange(len(piece))
    known = piece != NO_PIECE
    before = np.maximum.accumulate(np.where(known, at, -1))
    behind = np.minimum.accumulate(np.where(known, at, len(piece))[::-1])[::-1]
    loose, nearest = np.flatnonzero(~known), np.full(len(piece), off)
    for other in (before, behind):
        there = loose[(other[loose] >= 0) & (other[loose] < len(piece))]
        there = there[own[other[there]] == own[there]]
        trial = np.full(len(piece), NO_PIECE)
        trial[there] = piece[other[there]]
        away = np.abs(_square_off(points, trial, fitted))
        for k, each in enumerate(fitted):
            away[(trial == k) & ~each.spline.holds(points[:, :2])] = np.inf
        better = (trial != NO_PIECE) & (away <= nearest)
        made[better], nearest[better] = trial[better], away[better]
    return made


def _square_off(points: Floats, piece: Ints, fitted: list[FittedHeights]) -> Floats:
    """Return how far surfaces are from places (n, 3) on them, square to them, mm, > 0 above; 0 of places on none."""
    off = np.zeros(len(points))
    for k, each in enumerate(fitted):
        on = np.flatnonzero(piece == k)
        if not len(on):
            continue
        slopes = each.spline.slopes(points[on, :2])
        off[on] = (each.spline.heights(points[on, :2]) - points[on, 2]) / np.sqrt(1 + (slopes**2).sum(axis=1))
    return off


def touched(cutter: Cutter, places: Floats, slopes: Floats) -> Floats:
    """Return where a cutter touches (n, 3) whose tip is at places (n, 3) of a surface of tips of slopes (n, 2), mm:
    the place of its flat and fillet whose tangent plane is the tip's; a cone's at the rim of its fillet.
    """
    steep = np.linalg.norm(slopes, axis=1)
    uphill = slopes / np.maximum(steep, 1e-12)[:, None]
    sine = np.minimum(steep / np.sqrt(1 + steep**2) * cutter.fillet, cutter.fillet_span)
    radius = np.where(steep > 1e-9, cutter.flat, 0.0) + sine
    rise = cutter.fillet - np.sqrt(np.maximum(cutter.fillet**2 - sine**2, 0.0))
    return np.column_stack([places[:, :2] + radius[:, None] * uphill, places[:, 2] + rise])


def _without_deeper(found: SmoothedPieces, course: CutCourse, within: float) -> SmoothedPieces:
    """Return surfaces whose places are only those that no other move cut deeper by more than so much, mm; others stay
    as they are.
    """
    points, piece = np.concatenate(found.rows), found.piece.copy()
    deeper = np.zeros(len(points), np.bool_)
    for k, each in enumerate(found.fitted):
        on = np.flatnonzero(piece == k)
        contact = touched(course.cutter, points[on], each.spline.slopes(points[on, :2]))
        left = course.heights.lowest(np.ascontiguousarray(contact[:, :2])).heights
        deeper[on] = contact[:, 2] - left > within
    piece[deeper] = NO_PIECE
    return replace(found, piece=piece, cut_deeper=int(deeper.sum()), off=np.where(deeper, 0.0, found.off))


@dataclass(frozen=True, eq=False)
class LiftedPolyline:
    """A part of a program on the smooth surfaces.

    Attributes:
        points: (m, 3) mm, its ends where they were.
        boundaries: (b, 3) places where the passes go from one surface to the next. apart: (b,) by how much the two
            surfaces differ in height there, mm.
        chord_mm: how far chords are from the surfaces at most, proven.
    """

    points: Floats
    boundaries: Floats
    apart: Floats
    chord_mm: float


class _Crossing(NamedTuple):
    """Where two surfaces are as high: the place (3,) of the program, their height, and by how much they are not, mm."""

    place: Floats
    height: float
    apart: float


class _CrossedPieces(NamedTuple):
    """Places (n, 3) and the piece of each, crossings among them; these on the surfaces, (b, 3), and apart, (b,), mm."""

    places: Floats
    piece: Ints
    boundaries: Floats
    apart: Floats


class PassLifter:
    """Lifts polylines of a program onto the smooth surfaces behind them."""

    def __init__(self, smoothed: SmoothedPieces, chord: float) -> None:
        from scipy.spatial import KDTree

        self._smoothed, self._chord = smoothed, chord
        self._pitch = smoothed.tracked.pitch
        self._tree = KDTree(np.concatenate(smoothed.rows))

    def lifted(self, points: Floats) -> LiftedPolyline:
        """Return a polyline (n, 3) of the program, lifted; its two ends stay, and it leaves them smoothly.

        Beside its ends a place lies between the old pass and the surface, and so do chords but for what they may be
        from the surface: between two places the old pass is straight.
        """
        places = filled_places(points, self._pitch)
        away, at = self._tree.query(places)
        piece = np.where(away <= _SAME, self._smoothed.piece[at], NO_PIECE)
        crossed = self._with_crossings(places, piece)
        own, labels = self._refined(crossed.places, crossed.piece)
        heights, known = self._heights(own, labels)
        along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(own[:, :2], axis=0), axis=1))])
        near = np.minimum(along, along[-1] - along) / max(min(_BLEND * self._pitch, along[-1] / 3), 1e-9)
        share = np.clip(near, 0.0, 1.0) ** 2 * (3 - 2 * np.clip(near, 0.0, 1.0))
        new = own.copy()
        new[known, 2] += (share * (heights - own[:, 2]))[known]
        once = np.append(True, np.any(np.abs(np.diff(own, axis=0)) > _SAME, axis=1))
        return LiftedPolyline(
            new[once],
            crossed.boundaries,
            crossed.apart,
            float(self._chord_bounds(own, labels).max(initial=0.0)),
        )

    def _heights(self, places: Floats, piece: Ints) -> tuple[Floats, NDArray[np.bool_]]:
        heights, known = np.zeros(len(places)), piece != NO_PIECE
        for k, each in enumerate(self._smoothed.fitted):
            on = np.flatnonzero(piece == k)
            if len(on):
                heights[on] = each.spline.heights(places[on, :2])
        return heights, known

    def _with_crossings(self, places: Floats, piece: Ints) -> _CrossedPieces:
        """Return places and pieces with those between where two surfaces are as high."""
        change = np.flatnonzero((piece[1:] != piece[:-1]) & (piece[1:] != NO_PIECE) & (piece[:-1] != NO_PIECE))
        found, rows = [], []
        for k in change.tolist():
            crossing = self._crossing(places[k], places[k + 1], (int(piece[k]), int(piece[k + 1])))
            if crossing is not None:
                found.append(crossing)
                rows.append(k + 1)
        if not found:
            return _CrossedPieces(places, piece, np.zeros((0, 3)), np.zeros(0))
        both = np.column_stack([piece[np.array(rows) - 1], piece[rows]]).ravel()  # each surface up to there
        twice = np.repeat(rows, 2)
        own = np.repeat([each.place for each in found], 2, axis=0)
        boundaries = np.array([(*each.place[:2], each.height) for each in found])
        apart = np.array([each.apart for each in found])
        return _CrossedPieces(np.insert(places, twice, own, axis=0), np.insert(piece, twice, both), boundaries, apart)

    def _crossing(self, a: Floats, b: Floats, pieces: tuple[int, int]) -> _Crossing | None:
        """Return where between two places both surfaces are as high; None where they are nowhere as high, or not both
        surfaces are there.
        """
        from scipy.optimize import brentq

        one, other = (self._smoothed.fitted[k].spline for k in pieces)

        def apart(share: float) -> float:
            place = (a + share * (b - a))[None, :2]
            return float(one.heights(place)[0] - other.heights(place)[0])

        if apart(0.0) * apart(1.0) >= 0:
            return None
        share = float(brentq(apart, 0.0, 1.0, xtol=_SHARE, rtol=_SHARE))
        place = a + share * (b - a)
        if not (one.holds(place[None])[0] and other.holds(place[None])[0]):
            return None
        return _Crossing(place, float(one.heights(place[None, :2])[0]), abs(apart(share)))

    def _refined(self, places: Floats, piece: Ints) -> tuple[Floats, Ints]:
        """Return places and pieces with so many between that chords keep to the surfaces."""
        inside = self._between(piece)
        far = self._chord_bounds(places, piece)
        parts = np.clip(np.ceil(np.sqrt(far / self._chord)), 1, _MOST_PARTS).astype(np.int64)
        chord = np.repeat(np.arange(len(parts)), parts)
        share = (np.arange(len(chord)) - np.repeat(np.cumsum(parts) - parts, parts)) / parts[chord]
        between = places[chord] + share[:, None] * (places[chord + 1] - places[chord])
        labels = np.where(share > 0, inside[chord], piece[chord])
        return np.concatenate([between, places[-1:]]), np.append(labels, piece[-1:])

    def _between(self, piece: Ints) -> Ints:
        """Return of each chord (n - 1,) the surface that it is over, NO_PIECE: of none, or of two."""
        return np.where(piece[1:] == piece[:-1], piece[1:], NO_PIECE)

    def _chord_bounds(self, places: Floats, piece: Ints) -> Floats:
        """Return of each chord of lifted places (n - 1,) how far it may be from the surface that it is over, along Z,
        mm; 0 of those over none, which are moved as their ends are.
        """
        inside, bounds = self._between(piece), np.zeros(len(places) - 1)
        for k, each in enumerate(self._smoothed.fitted):
            on = np.flatnonzero(inside == k)
            bounds[on] = chord_bounds(each.spline, places[on, :2], places[on + 1, :2])
        return bounds
