"""B-spline surfaces, and the rational Bézier patches that they are made of: all that engines need to know of a
surface.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from math import comb

import numpy as np
from numpy.typing import NDArray

from ...core.errors import GeometryError
from ...geometry.arcs.bezier import cut_at_knots, elevated

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

HIGHEST_DEGREE = 9
"""Degree along either parameter, at most."""


@dataclass(frozen=True, eq=False)
class BsplineSurface:
    """A rational tensor-product B-spline surface, clamped at its four sides.

    Attributes:
        points: (nu, nv, 3) control points, mm.
        weights: (nu, nv) > 0.
        knots_u, knots_v: (nu + degree_u + 1,) and (nv + degree_v + 1,), not decreasing.
        degree_u, degree_v: 1 to HIGHEST_DEGREE, less than nu and nv.
    """

    points: Floats
    weights: Floats
    knots_u: Floats
    knots_v: Floats
    degree_u: int
    degree_v: int

    def __post_init__(self) -> None:
        if not (np.isfinite(self.points).all() and np.isfinite(self.weights).all()):
            raise GeometryError("a surface has control points that are not finite.")
        if not (self.weights > 0).all():
            raise GeometryError("a surface has a weight of 0 or less; weights must be greater than 0.")
        ways = (
            ("u", self.knots_u, self.degree_u, self.points.shape[0]),
            ("v", self.knots_v, self.degree_v, self.points.shape[1]),
        )
        for name, knots, degree, count in ways:
            if not 1 <= degree <= HIGHEST_DEGREE:
                raise GeometryError(f"a surface of degree {degree} along {name}; use 1 to {HIGHEST_DEGREE}.")
            if degree >= count or len(knots) != count + degree + 1:
                raise GeometryError(
                    f"a surface of degree {degree} with {count} control points and {len(knots)} knots along {name}; "
                    "there must be more points than the degree, and as many knots as both and one."
                )
            if not np.isfinite(knots).all() or (np.diff(knots) < 0).any() or not knots[degree] < knots[count]:
                raise GeometryError(
                    f"the knots along {name} fall, or leave no room; they must rise from the first to the last."
                )


@dataclass(frozen=True, eq=False)
class Patches:
    """n rational Bézier patches of one or more surfaces, all of the same degrees.

    Attributes:
        control: (n, p + 1, q + 1, 4) control points w x, w y, w z, w.
        owner: (n,) number of the surface that each is of.
        spans: (n, 4) u0, u1, v0, v1 of each in its surface's own parameters, which go from 0 to 1.
        whole: (n,) whether none of it is trimmed off; what is left of others are triangles, and kernels do not ask
            them.
    """

    control: Floats
    owner: Ints
    spans: Floats
    whole: NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.owner)

    @property
    def degrees(self) -> tuple[int, int]:
        """Along u and v."""
        return self.control.shape[1] - 1, self.control.shape[2] - 1

    def only(self, rows: Ints | NDArray[np.bool_]) -> Patches:
        """Return some of them."""
        return Patches(self.control[rows], self.owner[rows], self.spans[rows], self.whole[rows])

    def points(self, patch: Ints, u: Floats, v: Floats) -> Floats:
        """Return places (m, 3) of patches (m,) at their own parameters (m,), from 0 to 1 in each patch."""
        p, q = self.degrees
        low, high = bernstein(u, p), bernstein(v, q)
        made = np.einsum("mi,mj,mijc->mc", low, high, self.control[patch])
        places: Floats = made[:, :3] / made[:, 3:]
        return places

    def of_surface(self, patch: Ints, parameters: Floats) -> Floats:
        """Return a surface's parameters (m, 2) for those (m, 2) of its patches (m,)."""
        low, high = self.spans[patch][:, [0, 2]], self.spans[patch][:, [1, 3]]
        found: Floats = low + (high - low) * parameters
        return found


def patches_of(surfaces: Sequence[Sequence[BsplineSurface]]) -> Patches:
    """Return the patches of surfaces, each of which is one or more B-spline surfaces."""
    parts = [(number, surface) for number, group in enumerate(surfaces) for surface in group]
    p = max((surface.degree_u for _, surface in parts), default=1)
    q = max((surface.degree_v for _, surface in parts), default=1)
    control, owner, spans = [np.zeros((0, p + 1, q + 1, 4))], [np.zeros(0, np.int64)], [np.zeros((0, 4))]
    for number, surface in parts:
        pieces, edges = _pieces(surface)
        raised = elevated(elevated(pieces, p).swapaxes(1, 2), q).swapaxes(1, 2)
        control.append(raised)
        owner.append(np.full(len(raised), number))
        spans.append(edges)
    whole = np.ones(sum(map(len, owner)), np.bool_)
    return Patches(np.ascontiguousarray(np.concatenate(control)), np.concatenate(owner), np.concatenate(spans), whole)


def joined_patches(parts: Sequence[Patches]) -> Patches:
    """Return one set of patches or more, of the same degrees, as one."""
    return Patches(*(np.concatenate([getattr(part, field.name) for part in parts]) for field in fields(Patches)))


def _pieces(surface: BsplineSurface) -> tuple[Floats, Floats]:
    """Return patches (n, pu + 1, pv + 1, 4) of a surface, and the parameters (n, 4) between which they lie."""
    nu, nv = surface.weights.shape
    pu, pv = surface.degree_u, surface.degree_v
    homogeneous = np.concatenate([surface.points * surface.weights[..., None], surface.weights[..., None]], axis=2)
    along = cut_at_knots(homogeneous.reshape(nu, -1), surface.knots_u, pu)
    count = len(along)
    turned = along.reshape(count, pu + 1, nv, 4).transpose(2, 0, 1, 3).reshape(nv, -1)
    both = cut_at_knots(turned, surface.knots_v, pv)
    pieces = both.reshape(len(both), pv + 1, count, pu + 1, 4).transpose(2, 0, 3, 1, 4)
    u, v = _edges(surface.knots_u, pu, nu), _edges(surface.knots_v, pv, nv)
    spans = np.array([(*a, *b) for a in u for b in v])
    return pieces.reshape(-1, pu + 1, pv + 1, 4), spans


def _edges(knots: Floats, degree: int, count: int) -> Floats:
    """Return the spans (k, 2) between knots, as parts of the whole; empty ones are left out, as `cut_at_knots` does."""
    inner = knots[degree : count + 1]
    kept = np.flatnonzero(np.diff(inner) > 1e-12 * (knots[-1] - knots[0]))
    share = (inner - inner[0]) / (inner[-1] - inner[0])
    return np.column_stack([share[kept], share[kept + 1]])


def bernstein(t: Floats, degree: int) -> Floats:
    """Return the Bernstein polynomials (m, degree + 1) at places (m,)."""
    i = np.arange(degree + 1)
    found: Floats = np.array([comb(degree, k) for k in i]) * t[:, None] ** i * (1 - t[:, None]) ** (degree - i)
    return found
