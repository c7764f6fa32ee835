# mypy: allow-untyped-defs
"""Compiled: proof for many chords of a cutter's way at once.

A way of chords is halved into groups down to single chords; a group is a straight line from its first place to its
last, and how far its places are off that. Where a cutter pared by what is allowed, grown by how far group and facet are
off, keeps away from the facet all along the group's line, all chords of the group are proven against all that the facet
stands for. Where it does not, the one that is farther off is divided: the group into its halves, or the facet into its
quarters. So what is far away is dismissed for many chords in one step, and neighbouring chords share the quarters that
they come near.
"""

from __future__ import annotations

import math

from ...core.jit import kernel
from ..cutter_contact.contact_kernels import CONE, DISC, RADIUS, thicken
from ..cutter_contact.drop_kernels import bound
from ..cutter_contact.facet_tree_kernels import (
    ANY,
    BOXES,
    BULGE,
    CHORDS,
    CONTROL,
    DESK,
    ERROR,
    GROUP,
    GROUPS,
    LAST,
    LEAF,
    NODES,
    OFF,
    OWNER,
    PATCH,
    PLACES,
    RISE,
    SHAPES,
    TREE,
    TRIANGLES,
    WHICH,
    WIDENED,
    WORK,
    lay,
    new_desk,
)
from ..patches.patch_kernels import copy_row, quarter
from .chord_kernels import APART, apart, by_middle

_R, _MANY = "float64[::1]", "float64[:, ::1]"
_OFF, _FIRST, _STOP = 6, 7, 8
"""Columns of groups behind the ends of their line (6): how far places are off it, and the chords first to stop - 1."""
_NARROW = 0.5
"""Of the radius of its inner circle: what would widen a triangle by more makes another one of it."""
_NOTHING = 1e-300
"""Keeps a share of it defined where a facet is exact."""
_PART = 0.25
"""Of the cutter's radius: longer chords are proven in parts."""
_OFTEN, _SELDOM = 64, 4
"""So often is a single chord divided, and the line of a group."""
_FINEST = 1e-5
"""mm; facets as near to the surface are taken for it. The same whatever is allowed, so that what is proven is proven
where more is.
"""
_MOST, _MOST_EACH = 200_000, 2_000
"""Facets that are looked at for one chord alone, and for each of many; then what is left of them counts as not
proven.
"""


@kernel(f"float64({_MANY}, int64, {_R})", counts=False)
def _off_line(places, n, line):
    """Return how far a place is from a group's line."""
    dx, dy, dz = line[3] - line[0], line[4] - line[1], line[5] - line[2]
    x, y, z = places[n, 0] - line[0], places[n, 1] - line[1], places[n, 2] - line[2]
    square = dx * dx + dy * dy + dz * dz
    t = min(max((x * dx + y * dy + z * dz) / square, 0.0), 1.0) if square > 0.0 else 0.0
    x, y, z = x - t * dx, y - t * dy, z - t * dz
    return math.sqrt(x * x + y * y + z * z)


@kernel(f"void({DESK}, int64)", counts=False)
def _group(desk, count):
    """Put so many chords between PLACES into groups: all in row 1, the halves of row k in rows 2 k and 2 k + 1."""
    places, groups = desk[PLACES], desk[GROUPS]
    groups[1, _FIRST], groups[1, _STOP] = 0.0, count
    rows = 2
    while rows < 2 * count:
        rows *= 2
    for k in range(1, rows):
        if k > 1:
            first, stop = groups[k // 2, _FIRST], groups[k // 2, _STOP]
            half = first + math.floor(0.5 * (stop - first))
            groups[k, _FIRST], groups[k, _STOP] = (first, half) if k % 2 == 0 else (half, stop)
            if stop - first < 2.0:  # that is a single chord, or none
                groups[k, _STOP] = groups[k, _FIRST]
        first, stop = int(groups[k, _FIRST]), int(groups[k, _STOP])
        for c in range(3):
            groups[k, c], groups[k, 3 + c] = places[first, c], places[stop, c]
        groups[k, _OFF] = 0.0
        for n in range(first + 1, stop):
            groups[k, _OFF] = max(groups[k, _OFF], _off_line(places, n, groups[k]))


@kernel(f"UniTuple(float64, 3)({_R})", counts=False)
def _normal(t):
    """Return the way that a triangle (9 or more,) faces, of length 1; 0 of one without an area."""
    ux, uy, uz, vx, vy, vz = t[3] - t[0], t[4] - t[1], t[5] - t[2], t[6] - t[0], t[7] - t[1], t[8] - t[2]
    x, y, z = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    size = math.sqrt(x * x + y * y + z * z)
    return (x / size, y / size, z / size) if size > 0.0 else (0.0, 0.0, 0.0)


@kernel(f"void({_R}, float64, float64, float64, float64, float64)", counts=False)
def _widen(row, x, y, z, below, above):
    """Set WIDENED and RISE of a row: the triangle amid what it stands for, and as much wider as that may be off within
    its plane.

    Args:
        below, above: how far it may be off that way along (x, y, z), which the whole facet faces, of OFF.
    """
    off = row[OFF]
    for k in range(9):
        row[WIDENED + k] = row[k]
    row[RISE] = off
    ax, ay, az, bx, by, bz = (
        row[3] - row[0],
        row[4] - row[1],
        row[5] - row[2],
        row[6] - row[3],
        row[7] - row[4],
        row[8] - row[5],
    )
    east, north, up = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
    twice = math.sqrt(east * east + north * north + up * up)
    a, b = math.sqrt(ax * ax + ay * ay + az * az), math.sqrt(bx * bx + by * by + bz * bz)
    cx, cy, cz = -ax - bx, -ay - by, -az - bz
    c = math.sqrt(cx * cx + cy * cy + cz * cz)
    if off * (a + b + c) >= _NARROW * twice:  # so narrow that it would become as much wider as it is
        return
    across_x, across_y, across_z = north * z - up * y, up * x - east * z, east * y - north * x
    turned = math.sqrt(across_x * across_x + across_y * across_y + across_z * across_z) / twice
    share = off / twice
    row[RISE] = min((0.5 * (below + above) + turned) * off, off)
    if row[RISE] < off:
        out = 0.5 * (above - below) * share
        for k in range(0, 9, 3):
            row[WIDENED + k] += out * east
            row[WIDENED + k + 1] += out * north
            row[WIDENED + k + 2] += out * up
    row[WIDENED] -= share * (ax * c - cx * a)
    row[WIDENED + 1] -= share * (ay * c - cy * a)
    row[WIDENED + 2] -= share * (az * c - cz * a)
    row[WIDENED + 3] -= share * (bx * a - ax * b)
    row[WIDENED + 4] -= share * (by * a - ay * b)
    row[WIDENED + 5] -= share * (bz * a - az * b)
    row[WIDENED + 6] -= share * (cx * b - bx * c)
    row[WIDENED + 7] -= share * (cy * b - by * c)
    row[WIDENED + 8] -= share * (cz * b - bz * c)


@kernel(f"Tuple((int64, int64))({TREE}, int64, {_R}, float64, float64, int64, int64, int64, {DESK})", counts=False)
def _facet_clear(tree, n, shape, allowed, fine, failing, looked, most, desk):
    """Return the first chord that is not proven against one facet, `failing` where that is not earlier, and how many
    were looked at.

    Args:
        fine: facets as near to the surface are taken for it, mm. most: so many are looked at.
    """
    work, groups, radius = desk[WORK], desk[GROUPS], shape[RADIUS]
    if shape[DISC] == 0.0 and shape[CONE] == 0.0:  # most are far away, which for a ball is soon told
        away = radius + tree[ERROR][n] + groups[1, _OFF] - allowed
        if by_middle(tree[TRIANGLES][n], groups[1], radius, away) == APART:
            return failing, looked + 1
    lay(tree, n, work)
    normal_x, normal_y, normal_z = _normal(work[1])
    work[1, GROUP], whole = 1.0, max(tree[ERROR][n], _NOTHING)
    below, above = tree[BULGE][n, 0] / whole, tree[BULGE][n, 1] / whole
    _widen(work[1], normal_x, normal_y, normal_z, below, above)
    waiting = 2
    while waiting > 1:
        waiting -= 1
        node, off, near = int(work[waiting, GROUP]), work[waiting, OFF], work[waiting, RISE]
        first, stop = int(groups[node, _FIRST]), int(groups[node, _STOP])
        looked += 1
        if first >= failing or stop == first:
            continue
        single, span = stop - first == 1, groups[node, _OFF]
        times = _OFTEN if single else _SELDOM
        if apart(work[waiting, WIDENED:RISE], near + span, shape, groups[node, :_OFF], allowed, times, desk):
            continue
        if single and off <= fine:  # a rounded skin is slimmer at sharp corners than a wider triangle
            if not apart(work[waiting, :9], off + span, shape, groups[node, :_OFF], allowed, times, desk):
                failing = first
            continue
        if looked > most or waiting + 4 > LAST:
            failing = first
            continue
        if not single and (span >= near or near <= fine):
            copy_row(work, waiting, waiting + 1)
            work[waiting, GROUP], work[waiting + 1, GROUP] = 2 * node + 1, 2 * node  # the earlier first
            waiting += 2
            continue
        copy_row(work, waiting, LAST)
        quarter(tree[CONTROL], tree[PATCH][n], work, LAST, waiting)
        for k in range(waiting, waiting + 4):
            work[k, OFF], work[k, GROUP] = 0.25 * off, node
            _widen(work[k], normal_x, normal_y, normal_z, below, above)
        waiting += 4
    return failing, looked


@kernel(f"int64({TREE}, {_R}, int64, int64, float64, {DESK})", counts=False)
def way_clear(tree, shape, count, mine, allowed, desk):
    """Return the first of the chords between PLACES that is not proven to go nowhere deeper into surfaces than allowed.

    Args:
        count: chords, at most CHORDS; what is returned if all are proven.
        mine: owner of the facets that this is allowed for; into others no chord may go at all. ANY: allowed for all.
        allowed: mm, > 0.
    """
    boxes, nodes, wide = tree[BOXES], desk[NODES], desk[SHAPES][0]
    _group(desk, count)
    whole = desk[GROUPS][1]
    x, y, z = 0.5 * (whole[0] + whole[3]), 0.5 * (whole[1] + whole[4]), 0.5 * (whole[2] + whole[5])
    dx, dy, dz = whole[3] - whole[0], whole[4] - whole[1], whole[5] - whole[2]
    skin = 0.5 * math.sqrt(dx * dx + dy * dy + dz * dz) + whole[_OFF] - (allowed if mine == ANY else 0.0)
    inner, depth, looked, failing = len(boxes) // 2, 1, 0, count
    most = _MOST if count == 1 else _MOST_EACH * count
    thicken(shape, skin, wide)
    nodes[0] = 0
    while depth > 0 and failing > 0:
        depth -= 1
        node = nodes[depth]
        if node < inner:
            for child in (2 * node + 1, 2 * node + 2):
                if bound(boxes, child, x, y, wide, z - skin) > -math.inf:
                    nodes[depth] = child
                    depth += 1
            continue
        start = (node - inner) * tree[LEAF]
        for n in range(start, min(start + tree[LEAF], len(tree[TRIANGLES]))):
            own = allowed if mine == ANY or tree[OWNER][n] == mine else 0.0
            fine = _FINEST if tree[PATCH][n] >= 0 else math.inf
            failing, looked = _facet_clear(tree, n, shape, own, fine, failing, looked, most, desk)
    return failing


@kernel(f"UniTuple(int64, 3)({_MANY}, int64, int64, int64, {_R}, int64, {DESK})", counts=False)
def _gather(chords, k, part, stop, shape, most, desk):
    """Put chord k from one of its parts on, and what follows without a gap, on PLACES, and the chord of each part on
    WHICH.

    Return how many parts there are, `most` or less, and the chord and part after them.
    """
    places, whose, count = desk[PLACES], desk[WHICH], 0
    while True:
        dx, dy, dz = chords[k, 3] - chords[k, 0], chords[k, 4] - chords[k, 1], chords[k, 5] - chords[k, 2]
        times = 1 + int(math.sqrt(dx * dx + dy * dy + dz * dz) / (_PART * shape[RADIUS]))
        while part < times and count < most:
            for c in range(3):
                step = (chords[k, 3 + c] - chords[k, c]) / times
                places[count, c] = chords[k, c] + part * step
                places[count + 1, c] = chords[k, 3 + c] if part == times - 1 else chords[k, c] + (part + 1) * step
            whose[count] = k
            part, count = part + 1, count + 1
        if part < times:
            return count, k, part
        k, part = k + 1, 0
        if count == most or k == stop:
            return count, k, part
        for c in range(3):
            if chords[k, c] != chords[k - 1, 3 + c]:
                return count, k, part


@kernel(f"void({TREE}, {_R}, {_MANY}, int64, int64, float64, boolean[::1])")
def clear_all(tree, shape, chords, first, stop, allowed, found):
    """Set which of chords first to stop - 1 (m, 6) go nowhere deeper into surfaces than allowed, for all that can be
    proven.
    """
    desk = new_desk()
    k, part, group = first, 0, CHORDS
    for n in range(first, stop):
        found[n] = True
    while k < stop:
        count, after, rest = _gather(chords, k, part, stop, shape, group, desk)
        failing = way_clear(tree, shape, count, ANY, allowed, desk)
        if failing == count:
            k, part, group = after, rest, min(2 * group, CHORDS)
        elif count > 1:  # together with others it may have taken too long
            part = part if desk[WHICH][failing] == k else 0
            k, group = desk[WHICH][failing], 1
            while failing > 0 and desk[WHICH][failing - 1] == k:
                part, failing = part + 1, failing - 1
        else:
            found[k] = False
            k, part = k + 1, 0
