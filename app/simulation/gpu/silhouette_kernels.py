# mypy: allow-untyped-defs
"""Facets of what a cutter that is no ball sweeps along chains of moves: a polyhedron, and the quads that its silhouette
sweeps.

The cutter's lower side is rows of facets: the disc at its tip (row 0), bands between two rings each, and the upright
wall (the last row, never drawn). All rings have the same number of corners, at the same bearings. Of a convex body that
moves along u, facets whose normals point along u bound what it sweeps at the end, the others at the start; between them
lies the silhouette, whose edges sweep the quads that bound the rest. At a corner of the path only those facets are
drawn that bound at one of the two moves and not at the other: what the wedge is to a sphere.
"""

from __future__ import annotations

from ...core.jit import kernel
from .wedge_kernels import END, TUBE, WEDGE, dot, put, row_of, unseen

_ROOM = "float32[:, :, ::1], uint8[::1], int64"
_OUT = _ROOM + ", int64"
_VIEW = "UniTuple(float64, 5)"
_V = "UniTuple(float64, 3)"
_TABLE = "float64[:, ::1]"


@kernel(f"boolean(int64, int64, {_V}, {_TABLE}, {_TABLE})", counts=False)
def heads(row, sector, u, bands, bearings):
    """Return whether a facet's normal points along u, or across it.

    Args:
        row: 0 the disc, then the bands, then the wall.
        bands: of each its outward normal along the radius and along Z.
        bearings: (count, 2) cosine and sine of the middle of each sector.
    """
    if row == 0:
        return u[2] <= 0.0
    level = bearings[sector, 0] * u[0] + bearings[sector, 1] * u[1]
    if row > len(bands):
        return level >= 0.0
    return bands[row - 1, 0] * level + bands[row - 1, 1] * u[2] >= 0.0


@kernel(f"{_V}(int64, int64, {_V}, {_TABLE}, {_TABLE})", counts=False)
def corner_of(ring, k, tip, rings, table):
    """Return a corner of the polyhedron whose tip is at a place."""
    return tip[0] + rings[ring, 0] * table[k, 0], tip[1] + rings[ring, 0] * table[k, 1], tip[2] + rings[ring, 1]


@kernel(f"int64({_OUT}, {_V}, {_TABLE}, {_TABLE}, {_VIEW})", counts=False)
def disc(quads, kinds, at, kind, tip, rings, table, view):
    """Add the disc at the tip; return how many quads there are then."""
    if rings[0, 0] == 0.0:
        return at
    a, b = corner_of(0, 0, tip, rings, table), corner_of(0, 1, tip, rings, table)
    # a fan from corner 0, two triangles at a time: a ring has an even number of corners
    for k in range(2, len(table) - 1, 2):
        c, d = corner_of(0, k, tip, rings, table), corner_of(0, k + 1, tip, rings, table)
        at = put(quads, kinds, at, kind, (a, b, c, d), view)
        b = d
    return at


@kernel(f"int64({_OUT}, UniTuple(int64, 2), {_V}, {_TABLE}, {_TABLE}, {_VIEW})", counts=False)
def facet(quads, kinds, at, kind, place, tip, rings, table, view):
    """Add the facet of a band (row, sector); return how many quads there are then."""
    row, k = place
    after = k + 1 if k + 1 < len(table) else 0
    corners = (
        corner_of(row - 1, k, tip, rings, table),
        corner_of(row, k, tip, rings, table),
        corner_of(row, after, tip, rings, table),
        corner_of(row - 1, after, tip, rings, table),
    )
    return put(quads, kinds, at, kind, corners, view)


@kernel(f"int64({_OUT}, {_V}, {_V}, {_V}, {_V}, {_VIEW})", counts=False)
def swept(quads, kinds, at, kind, a, b, c, d, view):
    """Add the quad that an edge sweeps from a b to c d, whichever way it runs; return how many quads there are then."""
    # counter-clockwise as seen from above, which is the inside of what looks down
    if (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0.0:
        return put(quads, kinds, at, kind, (a, b, d, c), view)
    return put(quads, kinds, at, kind, (b, a, c, d), view)


@kernel(f"int64({_OUT}, int64, UniTuple({_V}, 3), {_TABLE}, {_TABLE}, {_TABLE}, {_TABLE}, {_VIEW})", counts=False)
def silhouette(quads, kinds, at, kind, row, axis, rings, bands, table, bearings, view):
    """Add what the silhouette's edges above a row, and between its sectors, sweep; return how many quads there are
    then.

    Args:
        axis: both places of the tip, and the move's direction.
    """
    start, end, u = axis
    count = len(table)
    for k in range(count):
        mine = heads(row, k, u, bands, bearings)
        # one of two neighbours bounds the end and the other the start: the edge between them is in the silhouette
        if heads(row + 1, k, u, bands, bearings) != mine and rings[row, 0] > 0.0:
            after = k + 1 if k + 1 < count else 0
            at = swept(
                quads,
                kinds,
                at,
                kind,
                corner_of(row, k, start, rings, table),
                corner_of(row, after, start, rings, table),
                corner_of(row, k, end, rings, table),
                corner_of(row, after, end, rings, table),
                view,
            )
        if row > 0 and heads(row, k - 1 if k else count - 1, u, bands, bearings) != mine:
            at = swept(
                quads,
                kinds,
                at,
                kind,
                corner_of(row - 1, k, start, rings, table),
                corner_of(row, k, start, rings, table),
                corner_of(row - 1, k, end, rings, table),
                corner_of(row, k, end, rings, table),
                view,
            )
    return at


@kernel(
    f"int64({_OUT}, int64, {_V}, UniTuple({_V}, 2), UniTuple(int64, 2), {_TABLE}, {_TABLE}, {_TABLE}, {_TABLE}, "
    f"{_VIEW})",
    counts=False,
)
def facets_at(quads, kinds, at, kind, row, tip, ways, ends, rings, bands, table, bearings, view):
    """Add the facets of a row that bound what is swept at a place; return how many quads there are then.

    Args:
        ways: the direction in which the tip comes and that in which it goes.
        ends: whether it comes, and whether it goes; without either what bounds the cutter there bounds what is swept.
    """
    comes, goes = ends
    if row == 0:
        behind = heads(0, 0, ways[0], bands, bearings) if comes else True
        ahead = heads(0, 0, ways[1], bands, bearings) if goes else False
        return disc(quads, kinds, at, kind, tip, rings, table, view) if behind != ahead else at
    for k in range(len(table)):
        behind = heads(row, k, ways[0], bands, bearings) if comes else True
        ahead = heads(row, k, ways[1], bands, bearings) if goes else False
        # a facet that bounds at both moves or at neither is inside what the tubes sweep
        if behind != ahead:
            at = facet(quads, kinds, at, kind, (row, k), tip, rings, table, view)
    return at


@kernel(
    f"int64({_ROOM}, UniTuple(int64, 2), {_TABLE}, {_TABLE}, {_TABLE}, uint8[::1], {_TABLE}, {_TABLE}, {_TABLE}, "
    f"{_TABLE}, boolean, {_VIEW})",
    counts=False,
)
def row_facets(quads, kinds, at, place, start, end, way, joins, rings, bands, table, bearings, wedges, view):
    """Add what a row of the polyhedron adds on a move (move, row); return how many quads there are then."""
    piece, row = place
    first, last, u = row_of(start, piece), row_of(end, piece), row_of(way, piece)
    # the last ring is the widest: what is farther off than that from the way is not in the picture
    if unseen(first, last, rings[len(rings) - 1, 0], view):
        return at
    goes, comes = dot(u, u) > 0.0, bool(joins[piece])
    if wedges or not comes:
        before = row_of(way, piece - 1) if comes else u
        kind = WEDGE if comes else END
        at = facets_at(
            quads,
            kinds,
            at,
            kind,
            row,
            first,
            (before, u),
            (int(comes), int(goes)),
            rings,
            bands,
            table,
            bearings,
            view,
        )
    if not goes:
        return at
    at = silhouette(quads, kinds, at, TUBE, row, (first, last, u), rings, bands, table, bearings, view)
    if piece + 1 < len(joins) and joins[piece + 1]:
        return at
    return facets_at(quads, kinds, at, END, row, last, (u, u), (1, 0), rings, bands, table, bearings, view)


@kernel(
    f"UniTuple(int64, 3)({_TABLE}, {_TABLE}, {_TABLE}, uint8[::1], {_TABLE}, {_TABLE}, {_TABLE}, {_TABLE}, boolean, "
    f"{_VIEW}, UniTuple(int64, 2), float32[:, :, ::1], uint8[::1])",
    counts=False,
)
def cutter_facets(start, end, way, joins, rings, bands, table, bearings, wedges, view, begin, quads, kinds):
    """Make facets until there is no room for more; return where to go on (move and row), and how many there are.

    Args:
        start, end: (n, 3) places of the tip.
        way, joins, wedges, view, begin: as for `ball_facets`.
        rings: (rows + 1, 2) radius and height over the tip of each ring; the first has radius 0 where there is no disc.
        bands: (rows, 2) outward normals, of any length, along the radius and Z.
        table, bearings: (count, 2) cosine and sine of the corners of a ring, and of the middles between them; an even
            number.
        quads, kinds: room for at least 4 times `count`.
    """
    room, at = len(quads) - 4 * len(table), 0
    piece, row = begin
    while piece < len(start):
        while row <= len(bands):
            if at > room:
                return piece, row, at
            at = row_facets(
                quads, kinds, at, (piece, row), start, end, way, joins, rings, bands, table, bearings, wedges, view
            )
            row += 1
        piece, row = piece + 1, 0
    return piece, row, at
