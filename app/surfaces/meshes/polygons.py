"""Flat faces with any number of corners as triangles: those that bend inwards, too."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


def triangulated(points: Floats, faces: Sequence[Ints]) -> Ints:
    """Return the corners (m, 3) of the triangles that cover faces, in the faces' own sense.

    Args:
        points: (n, 3). faces: numbers of each face's corners, at least three; of faces of one length (k, length).

    Convex faces are fans. Of others ears are cut, corner by corner: a fan would cover what lies outside of them.
    """
    found = [np.zeros((0, 3), np.int64)]
    for group in faces:
        around = points[group]
        bent = ~_convex(around)
        found.append(_fans(group[~bent]))
        found += [_ears(around[row], group[row]) for row in np.nonzero(bent)[0]]
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


def _ears(corners: Floats, numbers: Ints) -> Ints:
    """Return triangles of one face, by cutting ears.

    A face that crosses itself has no ears at some time: what is left then is a fan.

    References:
        Meisters, Polygons have ears, 1975.
    """
    flat, left, found = _projected(corners), list(range(len(numbers))), []
    while len(left) > 3:
        at = next((k for k in range(len(left)) if _is_ear(flat, left, k)), None)
        if at is None:
            break
        found.append([left[at - 1], left[at], left[(at + 1) % len(left)]])
        del left[at]
    found += [[left[0], left[k], left[k + 1]] for k in range(1, len(left) - 1)]
    return np.asarray(numbers[np.array(found)])


def _projected(corners: Floats) -> Floats:
    """Return corners (length, 2) seen along the axis that the face lies across most, counter-clockwise."""
    normal = _normals((corners - corners.mean(axis=0))[None])[0]
    along = int(np.argmax(np.abs(normal)))
    u, v = ((1, 2), (2, 0), (0, 1))[along]
    flat = corners[:, [u, v]]
    return flat if normal[along] > 0 else flat[:, ::-1]


def _is_ear(flat: Floats, left: list[int], at: int) -> bool:
    """Tell whether a corner turns outwards, and no other one lies in its triangle."""
    a, b, c = (flat[left[k % len(left)]] for k in (at - 1, at, at + 1))
    if _area(a, b, c) <= 0.0:
        return False
    others = flat[[k for k in left if not any((flat[k] == corner).all() for corner in (a, b, c))]]
    inside = (_area(a, b, others) >= 0.0) & (_area(b, c, others) >= 0.0) & (_area(c, a, others) >= 0.0)
    return not bool(np.any(inside))


def _area(a: Floats, b: Floats, c: Floats) -> Floats:
    """Return twice the area of triangles to places c (..., 2), > 0 counter-clockwise."""
    return np.asarray((b[0] - a[0]) * (c[..., 1] - a[1]) - (b[1] - a[1]) * (c[..., 0] - a[0]))
