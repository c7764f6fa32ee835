"""What a cutter sweeps along chains of moves, in facets: the method that was published in 1999.

Of a ball: a cylinder a move, in strips of one facet's width and the length of the move, and at each corner the wedge of
the sphere between the end planes of its two cylinders, in strips from pole to pole, each divided evenly. At the ends of
a chain one plane cuts the sphere. All that stays hidden in the cylinders is left away: a point of the swept body's
boundary is as far from the path as the ball's radius, and nearest either to the inside of a move, and then on its
cylinder, or to a corner, and then before neither of its planes. Other cutters: see `silhouette_kernels`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import astuple, dataclass
from enum import Enum, IntEnum

import numpy as np
from numpy.typing import NDArray

from ..cutter import Cutter
from ..sweeps.chains import Chains, chains_of
from ..sweeps.course import Course
from .polyhedron import Polyhedron, circle_corners, circle_table, facet_error, is_ball

ROOM = 1 << 18
"""Facets that are made at a time: 12 MB; no strip, and no row of another cutter, has more."""

CHORD_SHARE = 0.25
"""Of the facets' error, how far chords may be from the curves that they stand for; to either side."""

LEAST_CHORD = 1e-7
"""mm; chords need not be nearer, where a deep zoom makes the facets' error next to nothing."""

EVERYWHERE = (-math.inf, -math.inf, math.inf, math.inf)


class FacetKind(IntEnum):
    """Where a facet lies; those that the silhouette of another cutter than a ball sweeps count as a cylinder's."""

    CYLINDER = 0
    WEDGE = 1
    END = 2


class FacetSide(Enum):
    """Which facets are kept: those that can be the lower side of what is swept, the others, or all."""

    DOWN = 1.0
    UP = -1.0
    BOTH = 0.0


@dataclass(frozen=True, slots=True)
class Tessellation:
    """How a sweep is put into facets.

    Attributes:
        facet: their size d, mm, > 0.
        wedges: False leaves the corners of chains open.
        side: which facets are kept. Cutters that are no balls have no upper side.
        overlap: how far the cylinder of a level move reaches over its ends, mm, >= 0, so that no crack is left where a
            drawing rounds places; it keeps within the spheres there, and so is slimmer by overlap² / 2r. Of steep moves
            up to 16 times that.
    """

    facet: float
    wedges: bool = True
    side: FacetSide = FacetSide.DOWN
    overlap: float = 0.0


@dataclass(frozen=True, eq=False)
class SweepFacets:
    """Facets of a sweep.

    Attributes:
        quads: (m, 4, 3) corners, mm, counter-clockwise as seen from inside; at a pole two of them are the same.
        kind: (m,) FacetKind.
    """

    quads: NDArray[np.float32]
    kind: NDArray[np.uint8]


@dataclass(frozen=True, slots=True)
class PolygonCounts:
    """How many polygons stand for a course.

    Attributes:
        spheres: whole cylinders and whole spheres; of other cutters all of the lower side, at every corner.
        spheres_down: of these those that look down.
        wedges: whole cylinders and wedges, half spheres at the ends of chains.
        drawn: of these those that look down.
    """

    spheres: int
    spheres_down: int
    wedges: int
    drawn: int


def facets_in(
    cutter: Cutter, chains: Chains, how: Tessellation, box: tuple[float, float, float, float] = EVERYWHERE
) -> Iterator[tuple[SweepFacets, float]]:
    """Yield the facets of a sweep in parts, each of which is gone when the next one comes, and the share of the moves
    that is done.

    Args:
        cutter: what is swept.
        chains: where its tip goes.
        how: in which facets.
        box: low x, low y, high x, high y of what is looked at, mm; facets that are off it are left out.

    Raises:
        ParameterError: the facets are of no size, or far too small for the cutter.
    """
    from .silhouette_kernels import cutter_facets
    from .wedge_kernels import ball_facets

    room = SweepFacets(np.empty((ROOM, 4, 3), np.float32), np.empty(ROOM, np.uint8))
    places = chains.moved((0.0, 0.0, cutter.radius)) if is_ball(cutter) else chains
    course, view, at = (places.start, places.end, places.way, places.joins), (*map(float, box), how.side.value), (0, 0)
    form = Polyhedron.of(cutter, how.facet)
    shape, parts = (
        (float(cutter.radius), float(how.facet), float(how.overlap)),
        (form.rings, form.bands, form.table, form.bearings),
    )
    while at[0] < len(chains):
        if is_ball(cutter):
            piece, part, filled = ball_facets(*course, shape, form.table, how.wedges, view, at, room.quads, room.kind)
        else:
            piece, part, filled = cutter_facets(*course, *parts, how.wedges, view, at, room.quads, room.kind)
        at = piece, part
        yield SweepFacets(room.quads[:filled], room.kind[:filled]), piece / len(chains)


def chord_of(course: Course, cutters: Mapping[int, Cutter], facet: float) -> float:
    """Return how far chords may be from curves where facets have a size, mm."""
    error = min(
        (facet_error(cutters[number], facet) for number in np.unique(course.tool).tolist() if number in cutters),
        default=facet,
    )
    return max(CHORD_SHARE * error, LEAST_CHORD)


def polygon_counts(course: Course, cutters: Mapping[int, Cutter], facet: float) -> PolygonCounts:
    """Return how many polygons stand for a course, with and without what the method leaves away.

    Args:
        course: what is cut along.
        cutters: by T number.
        facet: size of a facet, mm.

    Raises:
        ParameterError: a tool that cuts is not among the cutters, or the facets are of no size, or far too small.
    """
    total = np.zeros(4, np.int64)
    for part in chains_of(course, cutters, chord_of(course, cutters, facet)):
        total += astuple(chain_counts(*part, facet))
    return PolygonCounts(*total.tolist())


def chain_counts(cutter: Cutter, chains: Chains, facet: float) -> PolygonCounts:
    """Return how many polygons stand for chains of moves of one cutter; see `polygon_counts`."""
    whole, lower = _whole_counts(cutter, facet)
    kept = {side: np.zeros(len(FacetKind), np.int64) for side in (FacetSide.BOTH, FacetSide.DOWN)}
    for side, found in kept.items():
        for part, _ in facets_in(cutter, chains, Tessellation(facet, side=side)):
            found += np.bincount(part.kind, minlength=len(FacetKind))
    both, down = kept[FacetSide.BOTH], kept[FacetSide.DOWN]
    cylinders = FacetKind.CYLINDER
    return PolygonCounts(
        int(both[cylinders]) + chains.corners * whole,
        int(down[cylinders]) + chains.corners * lower,
        int(both.sum()),
        int(down.sum()),
    )


def _whole_counts(cutter: Cutter, facet: float) -> tuple[int, int]:
    """Return how many polygons a cutter has by itself, and how many of them look down.

    A whole sphere falls into bands of one facet's width between parallels, each divided evenly: fewer than strips from
    pole to pole.
    """
    if not is_ball(cutter):
        return (Polyhedron.of(cutter, facet).facets,) * 2
    count = circle_corners(cutter.radius, facet)
    tilts = circle_table(count, 0.5)[: count // 2, 1]
    whole = int(np.ceil(2 * math.pi * cutter.radius * tilts / facet - 1e-9).sum())
    return whole, whole // 2
