"""Patches into facets that are proven to be as near to them as asked, fine where they curve and coarse where they are
flat.

A surface whose second derivatives are no longer than M_uu, M_uv and M_vv is nowhere farther from a triangle with its
corners on it, a by b in parameters, than (a² M_uu + 2 a b M_uv + b² M_vv) / 8 (Filip, Magedson, Markot 1986). The
derivatives are bounded by the differences of control points, whose hull holds them; of rational patches by the quotient
rule on such bounds. Most of them usually lies within the surface, where parameters run faster or slower; so the same is
asked of the heights over each triangle alone: that bounds how far the surface bulges from it.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.errors import GeometryError
from ...core.progress import NO_PROGRESS, Progress
from .facets import SurfaceFacets
from .patch import Patches, bernstein

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_GRID = 8
"""Most facets along a side of a sub-patch; one that wants more is halved, and bounded anew, more closely."""
MOST_FACETS = 8_000_000
"""Facets of all surfaces, at most; more fill the memory."""
_AT_ONCE = 100_000
"""Facets whose bulge is asked at once."""


def tessellate(patches: Patches, tolerance: float, progress: Progress = NO_PROGRESS) -> SurfaceFacets:
    """Return facets no farther from their patches than a tolerance, mm, > 0.

    Raises:
        GeometryError: there would be more than MOST_FACETS of them.
        Cancelled: the job was asked to stop.
    """
    control, number, box, counts = _divided(patches, tolerance, progress)
    made: list[_FacetRows] = []
    bounds = second_derivatives(control)
    for nu, nv in np.unique(counts, axis=0).tolist():
        rows = np.flatnonzero((counts == (nu, nv)).all(axis=1))
        progress.step(0.5, "Making facets")
        triangles, corners = _grid(control[rows], box[rows], (nu, nv))
        uu, uv, vv = bounds[rows].T
        error = (uu / nu**2 + 2 * uv / (nu * nv) + vv / nv**2) / 8
        each = 2 * nu * nv
        bulge = [
            _bulges(control[part], triangles.reshape(len(rows), nu, nv, 2, 3, 3)[at], (nu, nv))
            for at, part in _batches(rows, each)
        ]
        bulges = np.minimum(np.concatenate(bulge), np.repeat(error, each)[:, None])
        made.append(_FacetRows(triangles, np.repeat(number[rows], each), corners, np.repeat(error, each), bulges))
    triangles, patch, corners, error, bulges = (np.concatenate(column) for column in zip(*made, strict=True))
    return SurfaceFacets(triangles, patches.owner[patch], patch, corners, error, bulges, patches)


def facets_alone(patches: Patches) -> SurfaceFacets:
    """Return two facets for each patch, and how far the surface is off them, seen as a whole: parameters may be
    elsewhere.

    It is off as far as it bulges from them, or as its sides leave them: no farther than their control points.
    """
    control = patches.control
    uu, uv, vv = second_derivatives(control).T
    triangles, corners = _grid(control, np.tile([0.0, 0.0, 1.0, 1.0], (len(patches), 1)), (1, 1))
    most = [
        _bulges(control[part], triangles.reshape(-1, 1, 1, 2, 3, 3)[at], (1, 1))
        for at, part in _batches(np.arange(len(patches)), 2)
    ]
    bulge = np.concatenate([np.zeros((0, 2)), *most]).reshape(-1, 4).max(axis=1)
    places = control[..., :3] / control[..., 3:]
    sides = [_from_chord(places[:, k]) for k in (0, -1)] + [_from_chord(places[:, :, k]) for k in (0, -1)]
    error = np.repeat(np.minimum(np.maximum.reduce([bulge, *sides]), (uu + 2 * uv + vv) / 8), 2)
    patch = np.repeat(np.arange(len(patches)), 2)
    return SurfaceFacets(
        triangles, patches.owner[patch], patch, corners, error, np.repeat(error[:, None], 2, axis=1), patches
    )


def _from_chord(places: Floats) -> Floats:
    """Return how far places (n, k, 3) are from the lines through the first and the last of them (n,)."""
    chord, away = places[:, -1:] - places[:, :1], places - places[:, :1]
    square = np.maximum((chord**2).sum(axis=-1, keepdims=True), 1e-300)
    return np.asarray(
        np.linalg.norm(away - (away * chord).sum(axis=-1, keepdims=True) / square * chord, axis=-1).max(axis=1)
    )


class _FacetRows(NamedTuple):
    """Some facets, n of them: as the columns of `SurfaceFacets`, and the number of each one's patch."""

    triangles: Floats
    patch: Ints
    corners: Floats
    error: Floats
    bulges: Floats


class _SubPatches(NamedTuple):
    """Parts of patches, n of them.

    Attributes:
        control: their control points. patch: (n,) of which each is a part. box: (n, 4) u0, v0, u1, v1 there.
        counts: (n, 2) how many facets each wants along u and v.
    """

    control: Floats
    patch: Ints
    box: Floats
    counts: Ints


def _divided(patches: Patches, tolerance: float, progress: Progress) -> _SubPatches:
    """Return patches in parts that want no more facets than a grid has."""
    control, number = patches.control, np.arange(len(patches))
    box = np.tile([0.0, 0.0, 1.0, 1.0], (len(patches), 1))
    done: list[_SubPatches] = []
    total = 0
    while len(control):
        progress.step(0.0, "Making facets")
        counts = _counts(second_derivatives(control), tolerance)
        fine = (counts <= _GRID).all(axis=1)
        done.append(_SubPatches(control[fine], number[fine], box[fine], counts[fine]))
        total += 2 * int(np.minimum(counts, _GRID).prod(axis=1).sum())
        if total > MOST_FACETS:
            raise GeometryError(
                f"facets {tolerance:g} mm near the surfaces would be more than {MOST_FACETS:,}; allow a larger "
                "tolerance."
            )
        control, number, box, counts = control[~fine], number[~fine], box[~fine], counts[~fine]
        for axis in (0, 1):
            wanting = counts[:, axis] > _GRID
            first, second = halves(control[wanting], axis)
            below, above = box[wanting].copy(), box[wanting].copy()
            below[:, 2 + axis] = above[:, axis] = (box[wanting, axis] + box[wanting, 2 + axis]) / 2
            control = np.concatenate([control[~wanting], first, second])
            number = np.concatenate([number[~wanting], number[wanting], number[wanting]])
            box = np.concatenate([box[~wanting], below, above])
            counts = np.concatenate([counts[~wanting], counts[wanting], counts[wanting]])
    return _SubPatches(*(np.concatenate(column) for column in zip(*done, strict=True)))


def _counts(bounds: Floats, tolerance: float) -> Ints:
    """Return how many facets along u and v (n, 2) keep within a tolerance, as few as may be."""
    uu, uv, vv = np.maximum(bounds, 1e-30).T
    uu, vv = uu + 0.1 * uv, vv + 0.1 * uv
    each = 8 * tolerance / (2 + 2 * uv / np.sqrt(uu * vv))
    requested = np.maximum(np.sqrt(np.column_stack([uu / each, vv / each])), 1.0)
    return np.asarray(np.ceil(np.minimum(requested, 1e6) * (1 - 1e-9)), np.int64)


def second_derivatives(control: Floats, signed: bool = False) -> Floats:
    """Return bounds (n, 3) of the lengths of S_uu, S_uv and S_vv over whole patches (n, p + 1, q + 1, k + 1) in k
    dimensions.

    Args:
        signed: of patches in one dimension, bounds (n, 3, 2): what they, and their opposites, are nowhere more than, if
            that is >= 0.
    """
    p, q = control.shape[1] - 1, control.shape[2] - 1
    weight = control[..., -1]
    least = weight.min(axis=(1, 2))
    corners = control[:, [0, 0, -1, -1], [0, -1, 0, -1]]
    centre = (corners[..., :-1] / corners[..., -1:]).mean(axis=1)
    about = control[..., :-1] - weight[..., None] * centre[:, None, None]

    def turned(array: Floats, u: int, v: int) -> Floats:
        """Return the differences of control points, so many times along u and v, as derivatives (n, ...)."""
        for axis, degree, times in ((1, p, u), (2, q, v)):
            if times > degree:
                return np.zeros((len(array), 1, 1, *array.shape[3:]))
            for k in range(times):
                array = np.diff(array, axis=axis) * (degree - k)
        return array

    def most(array: Floats, u: int, v: int) -> Floats:
        """Return how long the longest of them are (n,)."""
        found = turned(array, u, v)
        return np.asarray((np.linalg.norm(found, axis=-1) if found.ndim == 4 else np.abs(found)).max(axis=(1, 2)))

    def outer(u: int, v: int) -> Floats:
        """Return the same of the places (n, 1), or how far they go both ways (n, 2)."""
        if not signed:
            return most(about, u, v)[:, None]
        found = turned(about, u, v)
        return np.asarray(np.maximum(np.concatenate([found, -found], axis=-1).max(axis=(1, 2)), 0.0))

    far = most(about / weight[..., None], 0, 0)
    w_u, w_v = most(weight, 1, 0), most(weight, 0, 1)
    s_u, s_v = (most(about, 1, 0) + w_u * far) / least, (most(about, 0, 1) + w_v * far) / least
    uu = outer(2, 0) + (most(weight, 2, 0) * far + 2 * w_u * s_u)[:, None]
    uv = outer(1, 1) + (most(weight, 1, 1) * far + w_u * s_v + w_v * s_u)[:, None]
    vv = outer(0, 2) + (most(weight, 0, 2) * far + 2 * w_v * s_v)[:, None]
    found = np.stack([uu, uv, vv], axis=1) / least[:, None, None]
    return found if signed else np.asarray(found[..., 0])


def halves(control: Floats, axis: int) -> tuple[Floats, Floats]:
    """Return the halves of patches along u or v (de Casteljau)."""
    points = np.moveaxis(control, axis + 1, 0)
    first, second = [points[0]], [points[-1]]
    while len(points) > 1:
        points = (points[:-1] + points[1:]) / 2
        first.append(points[0])
        second.append(points[-1])
    return np.moveaxis(np.array(first), 0, axis + 1), np.moveaxis(np.array(second[::-1]), 0, axis + 1)


def _grid(control: Floats, box: Floats, counts: tuple[int, int]) -> tuple[Floats, Floats]:
    """Return the triangles (k, 3, 3) of sub-patches, so many along u and v, and the parameters (k, 3, 2) of their
    corners.
    """
    nu, nv = counts
    u, v = np.arange(nu + 1) / nu, np.arange(nv + 1) / nv
    made = np.einsum(
        "ai,bj,nijc->nabc", bernstein(u, control.shape[1] - 1), bernstein(v, control.shape[2] - 1), control
    )
    places = made[..., :3] / made[..., 3:]
    across = box[:, None, 0] + (box[:, 2] - box[:, 0])[:, None] * u
    along = box[:, None, 1] + (box[:, 3] - box[:, 1])[:, None] * v
    shape = (len(control), nu + 1, nv + 1)
    whole = np.concatenate(
        [
            places,
            np.stack([np.broadcast_to(across[:, :, None], shape), np.broadcast_to(along[:, None], shape)], axis=3),
        ],
        axis=3,
    )
    a, b, c, d = whole[:, :-1, :-1], whole[:, 1:, :-1], whole[:, 1:, 1:], whole[:, :-1, 1:]
    both = np.stack([np.stack([a, b, c], axis=3), np.stack([a, c, d], axis=3)], axis=3).reshape(-1, 3, 5)
    return np.ascontiguousarray(both[..., :3]), np.ascontiguousarray(both[..., 3:])


def _batches(rows: Ints, each: int) -> Iterator[tuple[slice, Ints]]:
    """Yield sub-patches by so many that their facets fit into memory: where they stand, and their numbers."""
    many = max(1, _AT_ONCE // each)
    for first in range(0, len(rows), many):
        yield slice(first, first + many), rows[first : first + many]


def _bulges(control: Floats, triangles: Floats, counts: tuple[int, int]) -> Floats:
    """Return how far sub-patches reach below and above their triangles (n, nu, nv, 2, 3, 3), square to each (m, 2); inf
    without an area.
    """
    within = [_within(count, degree - 1) for count, degree in zip(counts, control.shape[1:3], strict=True)]
    net = np.einsum("aki,blj,nijc->nabklc", within[0], within[1], control, optimize=True)
    normal = np.cross(triangles[..., 1, :] - triangles[..., 0, :], triangles[..., 2, :] - triangles[..., 0, :])
    size = np.linalg.norm(normal, axis=-1)
    normal /= np.maximum(size, 1e-300)[..., None]
    about = net[..., :3] - net[..., 3:] * triangles[:, :, :, 0, None, None, 0]
    height = np.einsum("nabklc,nabtc->nabtkl", about, normal, optimize=True)
    weight = np.broadcast_to(net[:, :, :, None, ..., 3], height.shape)
    bends = second_derivatives(np.stack([height, weight], axis=-1).reshape(-1, *control.shape[1:3], 2), signed=True)
    uu, uv, vv = np.moveaxis(bends, 1, 0)
    found = (np.maximum(uu, 0.0) + 2 * uv.max(axis=-1, keepdims=True) + np.maximum(vv, 0.0)) / 8
    return np.asarray(np.where(size.ravel()[:, None] > 0.0, found, np.inf))


def _within(count: int, degree: int) -> Floats:
    """Return what makes control points (degree + 1) those of each of so many equal parts (count, degree + 1, degree +
    1).
    """
    nodes = np.arange(degree + 1) / max(degree, 1)
    back = np.linalg.inv(bernstein(nodes, degree))
    return np.stack([back @ bernstein((k + nodes) / count, degree) for k in range(count)])
