"""Which side of a surface of triangles is out: patches that are wound against their neighbours, and solids that are
inside out.

The corners of a triangle go counter-clockwise round its outward normal. Files do not always keep to that, and whoever
asks a normal which side the metal is on believes them. So neighbours are made to agree across every edge that two
triangles share, which settles each connected patch but for one sign; that comes from the volume that it encloses, and
from how deep it is nested: what is wholly within one shell is a hollow, whichever way its file winds it, and what is
within a hollow is metal again.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .edges import AT_ONCE, MeshEdges, doubled_areas, numbered, numbered_rows
from .sew import sew_mesh

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
"""Of edges, of which there are many."""

_WITHIN = 0.75
"""Of a turn: a place that a surface winds round by more is in it; one on it has a half."""

_ASKED = 64
"""Triangles of a shell whose corners are asked whether they are in another one; bodies that go through one another are
each metal.
"""

_NOTHING = 1e-9
"""Of the extent cubed: a surface that encloses no more is folded flat."""


_BEFORE = 1e-6
"""Of a triangle's extent: how far before it it is asked whether there is metal."""

_EVEN = 1e-6
"""Of its extent that a patch may be off its plane: what rounding in files does."""


@dataclass(frozen=True, eq=False)
class OrientedMesh:
    """A surface, right side out.

    Attributes:
        triangles: (k, 3, 3) mm; counter-clockwise seen from outside, unless there is a fault. Those without an area,
            pairs of them at the same place, and sides that bodies touch in are left out; some may be in parts where
            others have a corner on their edge.
        turned: (n,) which of those that were given had to be turned over.
        fault: why that cannot be done, as the end of a sentence; "" = it is done.
        place: x, y, z of the fault, mm, where it has one.
        shells: of how many closed surfaces it consists.
    """

    triangles: Floats
    turned: NDArray[np.bool_]
    fault: str = ""
    place: tuple[float, float, float] | None = None
    shells: int = 1


def orient_outwards(triangles: Floats) -> OrientedMesh:
    """Return a closed surface with every triangle wound counter-clockwise seen from outside.

    Args:
        triangles: (n, 3, 3) mm, n > 0.
    """
    corners, turned = triangles + 0.0, np.zeros(len(triangles), np.bool_)
    number = numbered(triangles.reshape(-1, 3))
    rows = np.flatnonzero(_counting(number))
    solid = corners[rows] if len(rows) < len(corners) else corners
    if not len(solid):
        return OrientedMesh(corners, turned, "its triangles enclose nothing")
    edges = MeshEdges.between(number.reshape(-1, 3)[rows].ravel())
    del number
    loose = edges.open_uses()
    if len(loose) and (mended := sew_mesh(solid)) is not None:
        some = _counting(numbered(mended.triangles.reshape(-1, 3)))
        solid, rows = mended.triangles[some], rows[mended.origin[some]]
        if not len(solid):
            return OrientedMesh(corners, turned, "its triangles enclose nothing")
        edges, loose = MeshEdges.of(solid), loose[:0]
    if len(loose):
        return OrientedMesh(
            corners, turned, f"{len(loose)} of its edges belong to one triangle only", _middle(solid, int(loose[0]))
        )
    patch, against, fault = _agreed(edges, len(solid))
    touching = _touching(solid, edges, patch)
    if touching.any():
        solid, rows = solid[~touching], rows[~touching]
        if not len(solid):
            return OrientedMesh(corners, turned, "its triangles enclose nothing")
        edges = MeshEdges.of(solid)
        patch, against, fault = _agreed(edges, len(solid))
    if fault >= 0:
        return OrientedMesh(corners, turned, "it has one side only, like a twisted strip", _middle(solid, fault))
    over, shells, fault = _outward(solid, edges, patch, against)
    if fault >= 0:
        return OrientedMesh(corners, turned, "its triangles do not agree on an inside", _middle(solid, fault))
    wound = _turned_over(solid, over)
    fault = _less_than_nothing(wound, edges, patch)
    if fault >= 0:
        return OrientedMesh(corners, turned, "its triangles do not agree on an inside", _middle(solid, fault))
    turned[rows[over]] = True
    return OrientedMesh(wound, turned, shells=shells)


def _less_than_nothing(wound: Floats, edges: MeshEdges, patch: Ints) -> int:
    """Return a use of a patch that has less than no metal before it, as where a body that touches another is inside
    out; -1: none has.

    Bodies that share edges alone are turned together, so that one of them may be turned wrongly, and edges do not tell.
    The largest patches that share edges are asked.
    """
    meeting = np.unique(patch[np.flatnonzero(edges.count[edges.edge] > 2) // 3])
    normal = np.cross(wound[:, 1] - wound[:, 0], wound[:, 2] - wound[:, 0])
    size = np.linalg.norm(normal, axis=1)
    area = np.bincount(patch, size, len(patch))
    for name in meeting[np.argsort(-area[meeting], kind="stable")[:_ASKED]].tolist():
        mine = np.flatnonzero(patch == name)
        k = int(mine[np.argmax(size[mine])])
        before = wound[k].mean(axis=0) + _BEFORE * normal[k] / np.sqrt(size[k])
        if winding_number(wound, before) < -0.5:
            return 3 * k
    return -1


def _counting(number: Ints) -> NDArray[np.bool_]:
    """Return which triangles are part of a surface: those with an area, but for pairs at the same place, as where
    bodies touch.

    Args:
        number: (3 n,) of their corners.
    """
    sides = np.sort(number.reshape(-1, 3), axis=1)
    flat = (sides[:, 0] == sides[:, 1]) | (sides[:, 1] == sides[:, 2])
    alike = numbered_rows(sides)
    many = np.bincount(alike)
    last = np.zeros(len(many), np.int64)
    last[alike] = np.arange(len(alike))  # the last one that is written stays
    return np.asarray(~flat & (last[alike] == np.arange(len(alike))) & (many[alike] % 2 == 1))


def _touching(triangles: Floats, edges: MeshEdges, patch: Ints) -> NDArray[np.bool_]:
    """Return which triangles lie in sides that two bodies share: flat patches in pairs that end at the same edges, as
    others do.

    So it does not matter in which triangles each body has the side that they touch in. A flat patch is what its border
    encloses, and two of them at the same place have metal, or none, on both sides.
    """
    found = np.zeros(len(triangles), np.bool_)
    uses = np.flatnonzero(edges.count[edges.edge] > 2)
    if not len(uses):
        return found
    pairs = np.unique(np.column_stack([patch[uses // 3], edges.edge[uses]]), axis=0)
    names, first = np.unique(pairs[:, 0], return_index=True)
    order = np.argsort(patch, kind="stable")
    begin, end = (np.searchsorted(patch[order], names, side) for side in ("left", "right"))
    borders: dict[bytes, list[Ints]] = {}
    for border, a, b in zip(np.split(pairs[:, 1], first[1:]), begin.tolist(), end.tolist(), strict=True):
        mine = order[a:b]
        inner = np.isin(edges.edge[(3 * mine[:, None] + np.arange(3)).ravel()], border)
        if int(inner.sum()) == len(border) and _is_flat(triangles[mine]) and _closes(edges, mine):
            borders.setdefault(border.tobytes(), []).append(mine)
    for alike in borders.values():
        for mine in alike[: len(alike) // 2 * 2]:
            found[mine] = True
    return found


def _is_flat(triangles: Floats) -> bool:
    """Return whether triangles that hang together lie in one plane."""
    normal = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    size = np.linalg.norm(normal, axis=1)
    main = normal[int(np.argmax(size))] / max(float(size.max()), 1e-300)
    places = triangles.reshape(-1, 3) - triangles[0, 0]
    return bool(np.all(np.abs(places @ main) <= _EVEN * max(float(np.abs(places).max()), 1e-300)))


def _closes(edges: MeshEdges, mine: Ints) -> bool:
    """Return whether a patch ends nowhere but at edges of more than two triangles."""
    _, own = np.unique(edges.edge[(3 * mine[:, None] + np.arange(3)).ravel()], return_counts=True)
    each = np.unique(edges.edge[(3 * mine[:, None] + np.arange(3)).ravel()])
    return bool(np.all((own == 2) | (edges.count[each] > 2)))


def _middle(triangles: Floats, use: int) -> tuple[float, float, float]:
    """Return the middle of an edge by one of its uses."""
    face, k = divmod(use, 3)
    x, y, z = (triangles[face, k] + triangles[face, (k + 1) % 3]) / 2
    return float(x), float(y), float(z)


def _agreed(edges: MeshEdges, faces: int) -> tuple[Ints, NDArray[np.bool_], int]:
    """Return the patch of each triangle, whether it is wound against the first one of it, and a use at which that
    fails, or -1.

    Patches hang together by edges of two triangles. From each triangle a walk goes on in all directions at once.
    """
    order = np.argsort(edges.edge, kind="stable")
    pairs = order[edges.count[edges.edge[order]] == 2].reshape(-1, 2)
    one, other = pairs.T // 3
    alike = edges.forward[pairs[:, 0]] == edges.forward[pairs[:, 1]]
    ends, begins, unlike = np.concatenate([one, other]), np.concatenate([other, one]), np.concatenate([alike, alike])
    by = np.argsort(begins, kind="stable")
    ends, unlike, first = ends[by], unlike[by], np.searchsorted(begins[by], np.arange(faces + 1))
    patch, against = np.full(faces, -1, np.int64), np.zeros(faces, np.bool_)
    for seed in range(faces):
        if patch[seed] >= 0:
            continue
        patch[seed], front = seed, np.array([seed])
        while len(front):
            many = first[front + 1] - first[front]
            links = np.repeat(first[front] - np.cumsum(many) + many, many) + np.arange(int(many.sum()))
            to, turn = ends[links], against[np.repeat(front, many)] ^ unlike[links]
            new = patch[to] < 0
            to, turn = to[new], turn[new]
            patch[to], against[to] = seed, turn
            front = np.unique(to)
    wrong = np.flatnonzero((against[one] ^ against[other]) != alike)
    return patch, against, int(pairs[wrong[0], 0]) if len(wrong) else -1


def _outward(
    triangles: Floats, edges: MeshEdges, patch: Ints, against: NDArray[np.bool_]
) -> tuple[NDArray[np.bool_], int, int]:
    """Return which triangles are to be turned over, how many shells there are, and a use at which patches do not go
    together, or -1.

    Patches that meet at edges of four triangles and more keep the turn to one another that most of their area has in
    the file.
    """
    area = doubled_areas(triangles)
    size = np.bincount(patch, area, len(patch))
    turned = against ^ (np.bincount(patch, area * against, len(patch)) > size / 2)[patch]
    forward = edges.forward ^ np.repeat(turned, 3)
    balance = np.bincount(edges.edge, np.where(forward, 1, -1))
    wrong = np.flatnonzero(balance[edges.edge])
    if len(wrong):
        return turned, 0, int(wrong[0])
    shell = _shells(edges, patch, forward)
    turned, fault = _turned_shells(triangles, turned, shell)
    return turned, len(np.unique(shell)), fault


def _turned_shells(triangles: Floats, turned: NDArray[np.bool_], shell: Ints) -> tuple[NDArray[np.bool_], int]:
    """Return which triangles are to be turned over when whole shells are, too, and a use of a surface that encloses
    nothing, or -1.
    """
    order = np.argsort(shell, kind="stable")
    _, first = np.unique(shell[order], return_index=True)
    rows = np.split(order, first[1:])
    wound = _turned_over(triangles, turned)
    volume = np.add.reduceat(_volumes(wound)[order], first)
    low, high = (
        np.minimum.reduceat(wound.min(axis=1)[order], first),
        np.maximum.reduceat(wound.max(axis=1)[order], first),
    )
    hollow = np.abs(volume) <= _NOTHING * np.max(high - low, axis=1) ** 3
    if hollow.all():
        return turned, int(3 * order[0])
    turned, shapes = turned.copy(), [wound[each] for each in rows] if len(rows) > 1 else [wound]
    for k in np.flatnonzero(~hollow).tolist():
        around = np.all((low <= low[k]) & (high >= high[k]), axis=1) & ~hollow
        around[k] = False
        depth = sum(_holds(shapes[n], shapes[k]) for n in np.flatnonzero(around).tolist())
        if (volume[k] < 0) == (depth % 2 == 0):
            turned[rows[k]] ^= True
    return turned, -1


def _turned_over(triangles: Floats, turned: NDArray[np.bool_]) -> Floats:
    """Return triangles, some of them turned over."""
    return np.where(turned[:, None, None], triangles[:, ::-1], triangles) if turned.any() else triangles


def _volumes(triangles: Floats) -> Floats:
    """Return the volume (n,) between each triangle and the middle of all corners, mm3, by part of them."""
    middle, volume = triangles.reshape(-1, 3).mean(axis=0), np.empty(len(triangles))
    for first in range(0, len(triangles), AT_ONCE):
        own = triangles[first : first + AT_ONCE] - middle
        volume[first : first + AT_ONCE] = np.einsum("ij,ij->i", own[:, 0], np.cross(own[:, 1], own[:, 2])) / 6.0
    return volume


def _shells(edges: MeshEdges, patch: Ints, forward: NDArray[np.bool_]) -> Ints:
    """Return a number by triangle for what is closed: a patch, or several that only close together, at edges of four
    and more.
    """
    uses = np.flatnonzero(edges.count[edges.edge] != 2)  # an edge of two triangles is closed within its patch
    keys, at = np.unique(edges.edge[uses].astype(np.int64) * len(patch) + patch[uses // 3], return_inverse=True)
    loose = np.bincount(at.ravel(), np.where(forward[uses], 1, -1), len(keys)) != 0
    shell = np.arange(len(patch))
    edge, number = np.divmod(keys[loose], len(patch))
    while len(edge):
        least = np.full(len(edges.count), len(patch), np.int64)
        np.minimum.at(least, edge, shell[number])
        better = shell.copy()
        np.minimum.at(better, number, least[edge])
        if np.array_equal(better, shell):
            break
        shell = better
    return shell[patch]


def _holds(outer: Floats, inner: Floats) -> bool:
    """Return whether a closed surface holds all of another one: its largest triangle's middle, and corners of triangles
    all over it.
    """
    size = doubled_areas(inner)
    spread = inner[:: max(1, len(inner) // _ASKED)].reshape(-1, 3)
    places = [inner[int(np.argmax(size))].mean(axis=0), *spread]
    return all(abs(winding_number(outer, place)) > _WITHIN for place in places)


def winding_number(triangles: Floats, place: Floats) -> float:
    """Return how often a surface goes round a place: the solid angle that its triangles are seen in, in whole turns.

    1 in a solid that is wound right side out, 0 outside, -1 in one that is inside out; of a surface that is open, in
    between.

    References:
        Tangent of half the solid angle of a triangle by its corners' vectors (Van Oosterom and Strackee, 1983).
    """
    a, b, c = np.moveaxis(triangles - place, 1, 0)
    x, y, z = (np.linalg.norm(each, axis=1) for each in (a, b, c))
    dot = np.einsum("ij,ij->i", a, b), np.einsum("ij,ij->i", b, c), np.einsum("ij,ij->i", c, a)
    volume = np.einsum("ij,ij->i", a, np.cross(b, c))
    return float(np.sum(np.arctan2(volume, x * y * z + dot[0] * z + dot[1] * x + dot[2] * y))) / (2 * math.pi)
