# mypy: allow-untyped-defs
"""Tiles and pieces: which piece touches which tile, and one tile cut by all of its pieces, in their order."""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel
from .reach_kernels import SHORT, course_of, reach
from .run_kernels import LANES
from .sweep_kernels import STRIDE, TILE, cut_straight, sweep_arc, trace_straight
from .trace_kernels import NOTES

NOTHING, CUTS, ASKS = range(3)
"""What a piece does: nothing, it cuts, or it only tells where it would cut."""

_PLACES, _BEFORE = "Array(float64, 2, 'C', True)", "Array(float32, 2, 'C', True)"
_TABLES = "uint8[::1], int32[::1], int32[::1], float64[:, ::1], float64[:, ::1]"
_COURSE = "UniTuple(float64, 5)"
_BOX = "UniTuple(float64, 4)"


@kernel(f"{_BOX}(UniTuple(float64, 2), UniTuple(float64, 2), {_COURSE}, float64)")
def box_of(span, place, course, radius):
    """Return the box of the cells at which a straight piece is evaluated: low x, low y, high x, high y."""
    size, ux, uy, _, _ = course
    if size == 0.0:
        return place[0] - radius, place[1] - radius, place[0] + radius, place[1] + radius
    half, middle = 0.5 * (span[1] - span[0]), 0.5 * (span[0] + span[1])
    x, y = place[0] + ux * middle, place[1] + uy * middle
    wide, tall = abs(ux) * half + abs(uy) * radius, abs(uy) * half + abs(ux) * radius
    return x - wide, y - tall, x + wide, y + tall


@kernel("UniTuple(int64, 4)(UniTuple(float64, 4), UniTuple(float64, 3), UniTuple(int64, 2))")
def tiles_met(box, grid, extent):
    """Return the first and the last row and column of tiles that a box meets; the last before the first: none."""
    x0, y0, pitch = grid
    rows, cols = extent
    cell = 1.0 / pitch
    # a cell more at the low side: cells are met at their centres, and rounding may move one over an edge
    first_col, last_col = max((box[0] - x0) * cell - 1.0, 0.0), min((box[2] - x0) * cell, cols - 1.0)
    first_row, last_row = max((box[1] - y0) * cell - 1.0, 0.0), min((box[3] - y0) * cell, rows - 1.0)
    if first_col > last_col or first_row > last_row:
        return 0, -1, 0, -1
    return int(first_row) // TILE, int(last_row) // TILE, int(first_col) // TILE, int(last_col) // TILE


@kernel("boolean(UniTuple(float64, 4), UniTuple(float64, 2), float64, float64, boolean)")
def misses(way, centre, radius, half, curved):
    """Return whether a piece surely stays off a tile that its box meets.

    Args:
        way: x and y of a straight piece's start and end; or of an arc's centre, and its radius twice.
        centre: of the tile. radius: of the cutter. half: of the tile's side.
    """
    x, y = centre
    # half the tile's diagonal, rounded up: no cell of the tile is farther from its centre
    near = radius + half * 1.4143
    if curved:
        return abs(math.sqrt((x - way[0]) * (x - way[0]) + (y - way[1]) * (y - way[1])) - way[2]) > near
    dx, dy = way[2] - way[0], way[3] - way[1]
    size = math.sqrt(dx * dx + dy * dy)
    return size > SHORT and abs((x - way[0]) * dy - (y - way[1]) * dx) > near * size


@kernel("boolean(UniTuple(int64, 3), UniTuple(int64, 3), UniTuple(float64, 3), UniTuple(float64, 3))")
def goes_on(one, two, end, start):
    """Return whether a piece begins where another ends, both straight and cut with one cutter.

    Args:
        one, two: what they do, their cutters and arcs. end: of the first. start: of the second.
    """
    alike = one[0] == CUTS and two[0] == CUTS and one[1] == two[1] and one[2] < 0 and two[2] < 0
    return alike and end[0] == start[0] and end[1] == start[1] and end[2] == start[2]


_SORTING = f"{_PLACES}, {_PLACES}, {_TABLES}, UniTuple(float64, 3), UniTuple(int64, 2), int64, int64"


@kernel(f"void({_SORTING}, boolean, float64, float64[:, ::1], int16[:, ::1])", counts=False)
def survey(start, end, does, cutter, arc, shapes, arcs, grid, extent, first, last, reduced, top, spans, met):
    """Write where pieces must be evaluated.

    Args:
        start, end: of all n pieces.
        does: NOTHING, CUTS or ASKS. cutter: row of the cutter. arc: row of the arc, -1: it is straight.
        shapes: rows of cutters, as `reach_kernels` says.
        arcs: rows of arcs: centre, radius, box.
        grid: x and y of the lower left corner, pitch, mm. extent: rows and columns of cells.
        first, last: the pieces to do are first … last - 1.
        reduced: pieces that go on are evaluated without what the next one cuts as deep; what the one before has cut is
            always left out.
        top: no metal is higher.
        spans: (n, 2) from and to along straight pieces, mm (to < from: upright).
        met: (n, 5) first and last row and column of tiles that the box of those cells meets (the last before the first:
            none), and how many cells the box is taller than wide.
    """
    pitch, known, onward = grid[2], False, (0.0, 1.0, 0.0, 0.0, 1.0)
    window = (grid[0], grid[1], grid[0] + extent[1] * pitch, grid[1] + extent[0] * pitch)
    for i in range(first, last):
        c, a = cutter[i], arc[i]
        radius, span, here, there = (
            shapes[c, 0],
            (0.0, -1.0),
            (start[i, 0], start[i, 1], start[i, 2]),
            (end[i, 0], end[i, 1], end[i, 2]),
        )
        box = (
            min(here[0], there[0]) - radius,
            min(here[1], there[1]) - radius,
            max(here[0], there[0]) + radius,
            max(here[1], there[1]) + radius,
        )
        if a >= 0:
            box = (arcs[a, 3] - radius, arcs[a, 4] - radius, arcs[a, 5] + radius, arcs[a, 6] + radius)
        # a piece above all metal, or off the grid, need not be looked at
        over = does[i] == NOTHING or min(here[2], there[2]) + shapes[c, 5] >= top
        if over or box[0] > window[2] or box[1] > window[3] or box[2] < window[0] or box[3] < window[1]:
            known, met[i, 0], met[i, 1], met[i, 4] = False, 0, -1, 0
            continue
        # a portion may begin in the middle of a chain: then the piece before it is looked at once
        me, before = (int(does[i]), int(c), int(a)), known
        if not known and i > 0:
            k = i - 1
            he, last_way = (
                (int(does[k]), int(cutter[k]), int(arc[k])),
                (end[k, 0] - start[k, 0], end[k, 1] - start[k, 1], 0.0),
            )
            before = goes_on(he, me, (end[k, 0], end[k, 1], end[k, 2]), here) and course_of(last_way)[0] > 0.0
        course = onward if known else course_of((there[0] - here[0], there[1] - here[1], there[2] - here[2]))
        known = False
        if a < 0 and i + 1 < len(cutter):
            k = i + 1
            she, place = (int(does[k]), int(cutter[k]), int(arc[k])), (start[k, 0], start[k, 1], start[k, 2])
            if goes_on(me, she, there, place):
                onward = course_of((end[k, 0] - place[0], end[k, 1] - place[1], end[k, 2] - place[2]))
                # a way straight up or down has no direction; the corner's bound needs both
                known = course[0] > 0.0 and onward[0] > 0.0
        if a < 0 and course[0] > 0.0:
            shape = (radius, shapes[c, 1], shapes[c, 2], shapes[c, 3], shapes[c, 4], shapes[c, 5], shapes[c, 6])
            span = (
                reach(shape, course, onward, before, known and reduced)
                if does[i] == CUTS
                else (-radius, course[0] + radius)
            )
            box = box_of(span, (here[0], here[1]), course, radius)
        spans[i, 0], spans[i, 1] = span
        met[i, 0], met[i, 1], met[i, 2], met[i, 3] = tiles_met(box, grid, extent)
        met[i, 4] = int(max(min((box[3] - box[1] - box[2] + box[0]) / pitch, 32000.0), -32000.0))


@kernel(f"void({_SORTING}, int16[:, ::1], int64[::1], int64[::1])", counts=False)
def count(start, end, does, cutter, arc, shapes, arcs, grid, extent, first, last, met, counts, votes):
    """Count how many of the pieces first … last - 1 meet each tile, and how many cells their boxes are taller than
    wide.

    The rest of the arguments are `survey`'s; counts and votes are by tile. Votes are whole numbers, so that their sum
    does not depend on the order.
    """
    across, side = (extent[1] + TILE - 1) // TILE, TILE * grid[2]
    for i in range(first, last):
        r0, r1, c0, c1 = met[i, 0], met[i, 1], met[i, 2], met[i, 3]
        way, a = (start[i, 0], start[i, 1], end[i, 0], end[i, 1]), arc[i]
        if a >= 0:
            way = (arcs[a, 0], arcs[a, 1], arcs[a, 2], arcs[a, 2])
        for row in range(r0, r1 + 1):
            for col in range(c0, c1 + 1):
                centre = (grid[0] + (col + 0.5) * side, grid[1] + (row + 0.5) * side)
                if (r0 == r1 and c0 == c1) or not misses(way, centre, shapes[cutter[i], 0], 0.5 * side, a >= 0):
                    counts[row * across + col] += 1
                    votes[row * across + col] += met[i, 4]


@kernel(f"void({_SORTING}, int16[:, ::1], int64[::1], int32[::1])", counts=False)
def fill(start, end, does, cutter, arc, shapes, arcs, grid, extent, first, last, met, places, refs):
    """Write the pieces into the lists of the tiles that they meet; `places` are the next free ones, by tile. See
    `count`.
    """
    across, side = (extent[1] + TILE - 1) // TILE, TILE * grid[2]
    for i in range(first, last):
        r0, r1, c0, c1 = met[i, 0], met[i, 1], met[i, 2], met[i, 3]
        way, a = (start[i, 0], start[i, 1], end[i, 0], end[i, 1]), arc[i]
        if a >= 0:
            way = (arcs[a, 0], arcs[a, 1], arcs[a, 2], arcs[a, 2])
        for row in range(r0, r1 + 1):
            for col in range(c0, c1 + 1):
                centre = (grid[0] + (col + 0.5) * side, grid[1] + (row + 0.5) * side)
                if (r0 == r1 and c0 == c1) or not misses(way, centre, shapes[cutter[i], 0], 0.5 * side, a >= 0):
                    refs[places[row * across + col]] = i
                    places[row * across + col] += 1


@kernel(f"void({_BEFORE}, float32[::1], UniTuple(int64, 4), boolean)")
def load(heights, lines, box, turned):
    """Copy a tile of a grid into lines; what is beside it is far below."""
    row, col, rows, cols = box
    lines[:] = -math.inf
    for r in range(rows):
        for c in range(cols):
            lines[c * STRIDE + r if turned else r * STRIDE + c] = heights[row + r, col + c]


@kernel("void(float32[:, ::1], float32[::1], UniTuple(int64, 4), boolean, float32)")
def store(heights, lines, box, turned, floor):
    """Copy a tile's lines into a grid, nothing lower than the floor."""
    row, col, rows, cols = box
    for r in range(rows):
        for c in range(cols):
            z = lines[c * STRIDE + r if turned else r * STRIDE + c]
            heights[row + r, col + c] = z if z > floor else floor


@kernel("void(int32[:, ::1], int32[::1], UniTuple(int64, 4), boolean, boolean)")
def move_owners(owners, lines, box, turned, there):
    """Copy a tile of a grid's owners into lines (`there`), or back."""
    row, col, rows, cols = box
    for r in range(rows):
        for c in range(cols):
            at = c * STRIDE + r if turned else r * STRIDE + c
            if there:
                lines[at] = owners[row + r, col + c]
            else:
                owners[row + r, col + c] = lines[at]


@kernel(
    f"void({_PLACES}, {_PLACES}, {_TABLES}, float64[:, ::1], int32[::1], int32[::1], UniTuple(float64, 5), boolean, "
    "float32[::1], int32[::1], float32[::1], float32[::1], float64[::1], float64[:, ::1], UniTuple(float64, 2))",
    counts=False,
)
def cut_lines(
    start,
    end,
    does,
    cutter,
    arc,
    shapes,
    arcs,
    spans,
    motions,
    refs,
    frame,
    turned,
    heights,
    owners,
    swept,
    sums,
    notes,
    told,
    limits,
):
    """Cut the lines of a tile by its pieces, in their order; what the arguments are `survey` and `cut_tile` say."""
    notes[5], notes[6] = limits
    traced = len(owners) > 0
    for k in range(len(refs)):
        i = refs[k]
        c, a = cutter[i], arc[i]
        noted = traced or does[i] == ASKS
        shape = (shapes[c, 0], shapes[c, 1], shapes[c, 2], shapes[c, 3], shapes[c, 4], shapes[c, 5], shapes[c, 6])
        ends = (start[i, 0], start[i, 1], start[i, 2], end[i, 0], end[i, 1], end[i, 2])
        # lines run along Y where boxes are taller than wide: longer runs, fewer of them
        if turned:
            ends = (ends[1], ends[0], ends[2], ends[4], ends[3], ends[5])
        owner = -1 if does[i] == ASKS else motions[i]
        if a >= 0:
            circle = (arcs[a, 1], arcs[a, 0], arcs[a, 2], -1.0) if turned else (arcs[a, 0], arcs[a, 1], arcs[a, 2], 1.0)
            sweep_arc(heights, owners, swept, sums, notes, frame, shape, ends, circle, owner, noted)
        elif noted:
            trace_straight(heights, owners, swept, sums, notes, frame, shape, ends, (spans[i, 0], spans[i, 1]), owner)
        else:
            cut_straight(heights, frame, shape, ends, (spans[i, 0], spans[i, 1]))
        if noted and len(told) > 0:
            for j in range(5):
                told[k, j] = notes[j]
                notes[j] = 0.0


@kernel(
    f"void({_PLACES}, {_PLACES}, {_TABLES}, float64[:, ::1], int32[::1], int32[::1], UniTuple(float64, 3), "
    f"UniTuple(int64, 4), boolean, {_BEFORE}, float32[:, ::1], int32[:, ::1], float64[:, ::1], UniTuple(float64, 2))"
)
def cut_tile(
    start,
    end,
    does,
    cutter,
    arc,
    shapes,
    arcs,
    spans,
    motions,
    refs,
    grid,
    box,
    turned,
    before,
    after,
    owners,
    told,
    limits,
):
    """Cut one tile by its pieces, in their order.

    Args:
        start, end, does, cutter, arc, shapes, arcs, spans: as for `survey`.
        motions: the motion that each piece belongs to. refs: the pieces that meet the tile.
        grid: as for `count`.
        box: first row and column of the tile, its rows and columns.
        turned: whether its lines run along Y.
        before, after: heights of the whole grid. owners: motion that cut each cell last, -1 = none; no rows: not
            wanted.
        told: a row for each ref, or nothing: volume in mm of height, engaged cells, greatest depth, its cell
            as row * columns + column, and the height that is reached there.
        limits: floor, and the depth from which a piece that only asks is told of, mm.
    """
    x0, y0, pitch = grid
    row, col, rows, cols = box
    # cells are evaluated at their centres
    x, y = x0 + (col + 0.5) * pitch, y0 + (row + 0.5) * pitch
    frame = (y, x, pitch, float(rows), float(cols)) if turned else (x, y, pitch, float(cols), float(rows))
    heights = np.empty(TILE * STRIDE, np.float32)
    mine = np.full(TILE * STRIDE if len(owners) > 0 else 0, np.int32(-1))
    swept, sums, notes = np.full(STRIDE + LANES, np.float32(math.inf)), np.zeros(2 * LANES, np.float32), np.zeros(NOTES)
    load(before, heights, box, turned)
    if len(owners) > 0:
        move_owners(owners, mine, box, turned, True)
    cut_lines(
        start,
        end,
        does,
        cutter,
        arc,
        shapes,
        arcs,
        spans,
        motions,
        refs,
        frame,
        turned,
        heights,
        mine,
        swept,
        sums,
        notes,
        told,
        limits,
    )
    store(after, heights, box, turned, np.float32(limits[0]))
    if len(owners) > 0:
        move_owners(owners, mine, box, turned, False)
    for k in range(len(told)):
        # places are told in the tile's lines; the caller wants cells of the grid
        slow, fast = int(told[k, 3]) // STRIDE, int(told[k, 3]) % STRIDE
        told[k, 3] = (
            (row + fast) * before.shape[1] + col + slow if turned else (row + slow) * before.shape[1] + col + fast
        )
