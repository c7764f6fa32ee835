"""A cutter's lower side in facets: how a circle is divided, and a polyhedron whose corners lie on the cutter.

Every corner is on the true surface and every cutter is convex, so facets lie inside: metal is left, never gouged.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from ...core.errors import ParameterError
from ...model.motion import Floats
from ..cutter import Cutter

FEWEST, LEAST_BANDS = 16, 4
"""Corners of a circle, and bands of a rounding, at least, however large the facets."""

MOST = 30_000
"""Corners of a circle at most."""


def is_ball(cutter: Cutter) -> bool:
    """Return whether a cutter's lower side is a half sphere."""
    return cutter.flat == 0.0 and cutter.fillet == cutter.radius and math.isinf(cutter.slope)


def circle_corners(radius: float, facet: float) -> int:
    """Return in how many parts a circle is divided: an even number, each no longer than a facet.

    Args:
        radius: mm, > 0. facet: mm.

    Raises:
        ParameterError: the facets are of no size, or far too small for the circle.
    """
    if not facet > 0:
        raise ParameterError(f"Facets of {facet:g} mm are none; they must be larger than 0.")
    count = 2 * max(FEWEST // 2, math.ceil(min(math.pi * radius / facet, 1e9) - 1e-9))
    if count > MOST:
        raise ParameterError(
            f"Facets of {facet:g} mm are too small for a cutter of radius {radius:g} mm; "
            f"use {2 * math.pi * radius / MOST:.2g} mm or more."
        )
    return count


def least_facet(radius: float) -> float:
    """Return the smallest size of facets that a circle of a radius, mm, can be divided in, mm."""
    return 2 * math.pi * radius / MOST * (1 + 1e-9)


def circle_table(count: int, shift: float = 0.0) -> Floats:
    """Return (count, 2) cosine and sine of the corners of a circle, turned by a share of the step between them."""
    angles = (np.arange(count) + shift) * (2 * math.pi / count)
    table = np.column_stack([np.cos(angles), np.sin(angles)])
    table[np.abs(table) < 1e-15] = 0.0
    return table


def facet_error(cutter: Cutter, facet: float) -> float:
    """Return how far at most, square to the surface, facets lie inside what the cutter sweeps, mm; overlaps not
    counted.

    On cylinders and slim wedges it is the sagitta d² / 8r; on spheres, where both sides of a facet are as long, twice
    that; on a fillet the sagittas of its bands and of its rings add up.
    """
    lean = 1.0 - math.cos(math.pi / circle_corners(cutter.radius, facet))
    if is_ball(cutter):
        return 2.0 * cutter.radius * lean
    bands, angle = _fillet_bands(cutter, facet)
    return cutter.radius * lean + (cutter.fillet * (1.0 - math.cos(angle / bands / 2.0)) if bands else 0.0)


def held_cutter(cutter: Cutter, facet: float) -> Cutter | None:
    """Return a cutter in closed form that lies in the facets of another one, so that what these leave of a work piece
    is in every cell at least what the other leaves, and at most what this one does.

    A convex body whose facets are nowhere farther inside than e holds all that is e or more within its surface: a
    rounded cutter is slimmer by e all round, its fillet about the same circle, its tip e higher. Without a fillet only
    circles are divided: all radii are smaller by the same share, heights as they are.

    Args:
        cutter: led by its tip. facet: size of the facets, mm.

    Returns:
        The slimmer cutter, led by the other's tip; None where nothing of that form is left.
    """
    if cutter.fillet == 0.0:
        share = math.cos(math.pi / circle_corners(cutter.radius, facet))
        return replace(cutter, radius=share * cutter.radius, flat=share * cutter.flat, slope=cutter.slope / share)
    error = facet_error(cutter, facet)
    radius, fillet = cutter.radius - error, cutter.fillet - error
    if fillet <= 0.0:
        return None
    if math.isinf(cutter.slope):
        return replace(cutter, radius=cutter.flat + fillet, fillet=fillet, lift=cutter.lift + error)
    span = cutter.fillet_span * fillet / cutter.fillet
    if cutter.flat + span > radius:
        return None
    return replace(cutter, radius=radius, fillet=fillet, lift=cutter.lift + error)


def _fillet_bands(cutter: Cutter, facet: float) -> tuple[int, float]:
    """Return into how many bands a cutter's fillet falls, and its angle."""
    if cutter.fillet == 0.0:
        return 0, 0.0
    angle = math.asin(min(cutter.fillet_span / cutter.fillet, 1.0))
    return max(LEAST_BANDS, math.ceil(min(cutter.fillet * angle / facet, MOST) - 1e-9)), angle


@dataclass(frozen=True, eq=False)
class Polyhedron:
    """The lower side of a cutter that is no ball, tip at 0, as `silhouette_kernels` takes it.

    The disc and the cone are not divided along the radius, as they are straight there: only round it.

    Attributes:
        rings: (rows + 1, 2) radius and height of each ring, mm; the first has radius 0 where there is no disc.
        bands: (rows, 2) outward normals of the facets between two rings, along the radius and Z.
        table, bearings: (count, 2) cosine and sine of a ring's corners, and of the middles between them.
    """

    rings: Floats
    bands: Floats
    table: Floats
    bearings: Floats

    @staticmethod
    def of(cutter: Cutter, facet: float) -> Polyhedron:
        """Return a cutter in facets.

        Raises:
            ParameterError: the facets are of no size, or far too small.
        """
        count = circle_corners(cutter.radius, facet)
        bands, angle = _fillet_bands(cutter, facet)
        tilts = angle * np.arange(bands + 1) / max(bands, 1)
        rings = np.column_stack([cutter.flat + cutter.fillet * np.sin(tilts), cutter.fillet * (1.0 - np.cos(tilts))])
        if not math.isinf(cutter.slope) and cutter.radius > cutter.rim_of_fillet:
            rings = np.vstack([rings, [cutter.radius, rings[-1, 1] + cutter.slope * (cutter.radius - rings[-1, 0])]])
        rings[-1, 0] = cutter.radius
        step = np.diff(rings, axis=0)
        normals = np.column_stack([step[:, 1], -step[:, 0] * math.cos(math.pi / count)])
        return Polyhedron(rings, np.ascontiguousarray(normals), circle_table(count), circle_table(count, 0.5))

    @property
    def facets(self) -> int:
        """How many quads there are: those of the disc, and of the bands."""
        return len(self.bands) * len(self.table) + (len(self.table) // 2 - 1 if self.rings[0, 0] > 0 else 0)
