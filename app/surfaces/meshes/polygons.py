"""Flat faces with any number of corners as triangles: those that bend inwards, too."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import shapely
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_SAME = 1e-9
"""Of a face's area, by which its triangles may differ from it."""


def triangulated(points: Floats, faces: Sequence[Ints]) -> Ints:
    """Return the corners (m, 3) of the triangles that cover faces, in the faces' own sense.

    Args:
        points: (n, 3). faces: numbers of each face's corners, at least three; of faces of one length (k, length).

    Convex faces are fans; of others a fan would cover what lies outside of them.
    """
    found = [np.zeros((0, 3), np.int64)]
    for group in faces:
        around = points[group]
        bent = np.asarray(np.isfinite(around).all(axis=(1, 2)))  # places that are none are looked for by who asked
        bent[bent] = ~_convex(around[bent])
        found.append(_fans(group[~bent]))
        found += [_covering(around[row], group[row]) for row in np.nonzero(bent)[0]]
    return np.concatenate(found)


def _fans(faces: Ints) -> Ints:
    """Return triangles from the first corner of each face (k, length)."""
    inner = range(1, faces.shape[1] - 1)
    return np.stack([faces[:, [0, at, at + 1]] for at in inner], axis=1).reshape(-1, 3)


def _normals(around: Floats) -> Floats:
    """Return the normals (k, 3) of faces (k, length, 3), by Newell's sum."""
    return np.asarray(np.cross(around, np.roll(around, -1, axis=1)).sum(axis=1))


def _turns(around: Floats) -> Floats:
    """Return how much each corner (k, length) turns, as an area: less than 0 = inwards."""
    middle = around - around.mean(axis=1, keepdims=True)
    ahead, back = np.roll(middle, -1, axis=1) - middle, middle - np.roll(middle, 1, axis=1)
    return np.asarray(np.einsum("kij,kj->ki", np.cross(back, ahead), _normals(middle)))


def _convex(around: Floats) -> NDArray[np.bool_]:
    """Return which faces (k, length, 3) turn one way at all corners."""
    if around.shape[1] == 3:
        return np.ones(len(around), np.bool_)
    return np.asarray((_turns(around) >= 0.0).all(axis=1))


def _covering(corners: Floats, numbers: Ints) -> Ints:
    """Return triangles of one face that cover what lies within it: also of one that goes along a line to a hole, round
    it, and back. A face that crosses itself has no inside: it is a fan.
    """
    flat = _projected(corners)
    face = shapely.Polygon(flat)
    parts = shapely.get_parts(face if face.is_valid else shapely.make_valid(face))
    areas = parts[shapely.get_type_id(parts) == shapely.GeometryType.POLYGON]
    places = shapely.get_coordinates(shapely.constrained_delaunay_triangles(areas)).reshape(-1, 4, 2)[:, :3]
    known = {place: at for at, place in enumerate(map(tuple, flat.tolist()))}
    found = np.array([known.get(place, -1) for each in places.tolist() for place in map(tuple, each)], np.int64)
    covered, own = _twice_areas(places), _twice_areas(flat[_fans(np.arange(len(flat))[None])])
    # the areas of a fan's triangles, with their signs, sum up to the face's, whatever its form
    if (found < 0).any() or abs(np.abs(covered).sum() - own.sum()) > _SAME * np.abs(own).sum():
        return _fans(numbers[None])
    triangles = found.reshape(-1, 3)
    triangles[covered < 0.0] = triangles[covered < 0.0][:, ::-1]
    return np.asarray(numbers[triangles])


def _twice_areas(triangles: Floats) -> Floats:
    """Return twice the areas of triangles (n, 3, 2), > 0 counter-clockwise."""
    (ax, ay), (bx, by) = ((triangles[:, k] - triangles[:, 0]).T for k in (1, 2))
    return np.asarray(ax * by - ay * bx)


def _projected(corners: Floats) -> Floats:
    """Return corners (length, 2) seen along the axis that the face lies across most, counter-clockwise."""
    normal = _normals((corners - corners.mean(axis=0))[None])[0]
    along = int(np.argmax(np.abs(normal)))
    u, v = ((1, 2), (2, 0), (0, 1))[along]
    flat = corners[:, [u, v]]
    return flat if normal[along] > 0 else flat[:, ::-1]
