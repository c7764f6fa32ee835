# mypy: allow-untyped-defs
"""One piece of a path over one tile: which runs of cells it can lower, and the numbers that the runs need.

A tile's heights lie in lines of cells, either rows or columns of the grid: whichever gives the longer runs. "Fast" is
the axis along the lines, "slow" the one across. Places are float64 until the first cell of a run, relative to the piece
there; within the run float32.

Numbers go from kernel to kernel in tuples, and few arrays do: counting who holds an array would take longer than a run.
"""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel
from .reach_kernels import SLACK
from .run_kernels import LANES, arc_run, ball_run, bull_run, cone_run, flat_run, level_run, taper_run
from .trace_kernels import PENDING, ball_trace, gather, settle

TILE = 256
"""Cells along a tile's side."""

STRIDE = TILE + 2 * LANES
"""Floats from line to line of a tile: runs end up to 15 cells behind their last cell."""

BALL, FLAT_END, CONE, TAPER, BULL = range(5)
"""Kinds of a run, by what of the cutter is over its cells."""
_LEVEL = 5
"""Kind of a run, behind those of cutters: any of them on a level move."""

LOWEST_RISE = 1e-9
"""A move that rises less on a cutter's radius, mm, touches where a level one does."""

_F = np.float32
_ZERO, _FAR = _F(0.0), 1e18
"""Nought in float32; mm that are farther than any grid is wide."""
_SHAPE, _FRAME, _PLACE = "UniTuple(float64, 7)", "UniTuple(float64, 5)", "UniTuple(float64, 6)"
_PLAN = "UniTuple(float64, 17)"
_ARC = "UniTuple(float64, 4)"
_TRACED = f"float32[::1], int32[::1], float32[::1], float32[::1], float64[::1], {_FRAME}, {_SHAPE}, {_PLACE}"


@kernel(f"Tuple((int64, UniTuple(float32, 14)))({_SHAPE}, float64, float64, float64)")
def run_numbers(shape, s, low, high):
    """Return which runs sweep a straight move, and the numbers that they need.

    Args:
        shape: of the cutter.
        s: rise of the move, >= 0. low, high: z of its ends, mm.
    """
    radius, flat, fillet, span, slope, lift, which = shape
    # the move's length is sqrt(1 + s^2) times its horizontal one
    kind, stretch, none = int(which), 1.0 + s * s, _ZERO
    z0, z1, rise, r2 = _F(low + lift), _F(high + lift), _F(s), _F(radius * radius)
    if kind == BALL:
        numbers = (r2, _F(s * s / stretch), _F(stretch), rise, _F(low + lift + radius), _F(high + lift + radius))
        return kind, numbers + (none, none, none, none, none, none, none, none)
    if kind == FLAT_END:
        return kind, (r2, rise, z0, none, none, none, none, none, none, none, none, none, none, none)
    form = (
        _F(radius * radius * (1.0 + 4e-7)),
        _F(flat),
        _F(fillet),
        _F(fillet * fillet),
        _F(span),
        _F(slope),
        rise,
        z0,
        z1,
        r2,
    )
    # the closed forms divide by the rise
    if s * radius < LOWEST_RISE:
        return _LEVEL, form + (none, none, none, none)
    if kind == BULL:
        return kind, form + (_F(flat * math.sqrt(stretch)), _F(fillet * s), none, none)
    inner = flat if kind == CONE else span
    # the flank touches where its slope along the move equals the rise; a move steeper than the flank touches at the rim
    ahead = s / math.sqrt(slope * slope - s * s) if s < slope else 0.0
    steep = 0.0 if s < slope else 1.0
    return kind, form + (_F(inner * inner), _F(ahead), _F(steep), _F(s / math.sqrt(stretch)))


@kernel("void(int64, float32[::1], int64, int64, UniTuple(float32, 5), UniTuple(float32, 14))", counts=False)
def straight_run(runs, line, first, blocks, where, m):
    """Lower a run under a straight move; `run_numbers` has said which runs."""
    if runs == BALL:
        ball_run(line, first, blocks, where, m[:6])
    elif runs == FLAT_END:
        flat_run(line, first, blocks, where, m[:3])
    elif runs == _LEVEL:
        level_run(line, first, blocks, where, m[:9])
    elif runs == CONE:
        cone_run(line, first, blocks, where, m[:13])
    elif runs == TAPER:
        taper_run(line, first, blocks, where, m)
    else:
        bull_run(line, first, blocks, where, m[:12])


@kernel(f"{_PLAN}({_FRAME}, {_SHAPE}, {_PLACE}, UniTuple(float64, 2))")
def plan_straight(frame, shape, ends, span):
    """Return what the lines of a tile need to know of a straight piece.

    That is: first and last line; of the two bands of cells, beside the piece and between its ends, the middle in line
    0, how it moves from line to line, and half the width; direction along fast and slow, length, rise, start (lower
    end) along fast and slow, z of both ends.

    Args:
        frame: fast and slow place of the tile's first cell, pitch, mm; cells along fast and slow.
        shape: of the cutter.
        ends: fast, slow, z of start and end, mm.
        span: from where to where along the piece, mm from its start; the second less than the first: it is upright.
    """
    fast0, slow0, pitch, _, lines = frame
    pf, ps, pz, qf, qs, qz = ends
    low, high = span
    # upwards, so that one closed form serves: what a move sweeps does not depend on its sense
    if pz > qz:
        pf, ps, pz, qf, qs, qz = qf, qs, qz, pf, ps, pz
    length, uf, us, s = math.sqrt((qf - pf) * (qf - pf) + (qs - ps) * (qs - ps)), 1.0, 0.0, 0.0
    if high < low:
        length, qz, low, high = 0.0, pz, -shape[0], shape[0]
    else:
        uf, us, s = (qf - pf) / length, (qs - ps) / length, (qz - pz) / length
        if ends[2] > ends[5]:
            low, high = length - high, length - low
    cell = 1.0 / pitch
    radius, middle, half = shape[0] * cell, 0.5 * (low + high), 0.5 * (high - low) * cell
    aside, centre = abs(uf) * radius + abs(us) * half, (ps + us * middle - slow0) * cell
    first, last = max(math.ceil(centre - aside - SLACK), 0.0), min(math.floor(centre + aside + SLACK), lines - 1.0)
    # a piece along the lines, or across them, bounds one of the two bands nowhere
    across, along = (1.0 / us if abs(us) > 1e-9 else 0.0), (1.0 / uf if abs(uf) > 1e-9 else 0.0)
    # from line to line the middle of the band beside the piece moves by uf / us, that of the band of its ends by -us /
    # uf
    side_step, end_step = uf * across, -us * along
    side = (pf - fast0) * cell + (slow0 - ps) * cell * side_step
    end = (pf - fast0 + middle * along) * cell + (slow0 - ps) * cell * end_step
    return (
        first,
        last,
        side,
        side_step,
        radius * abs(across) if across != 0.0 else _FAR,
        end,
        end_step,
        half * abs(along) if along != 0.0 else _FAR,
        uf,
        us,
        length,
        s,
        pf,
        ps,
        pz,
        qz,
        pitch,
    )


@kernel(f"UniTuple(float64, 2)({_FRAME}, {_PLAN}, float64)")
def cells_in_line(frame, plan, line):
    """Return the first and the last cell of a line that a straight piece may lower; the last before the first: none."""
    side, end = plan[2] + line * plan[3], plan[5] + line * plan[6]
    first = math.ceil(max(max(side - plan[4], end - plan[7]) - SLACK, 0.0))
    return first, math.floor(min(min(side + plan[4], end + plan[7]) + SLACK, frame[3] - 1.0))


@kernel(f"UniTuple(float32, 5)({_FRAME}, {_PLAN}, float64, float64)")
def place_in_run(frame, plan, line, first):
    """Return where the first cell of a run lies from a straight piece, and how that changes from cell to cell."""
    uf, us, pitch = plan[8], plan[9], plan[16]
    x, y = frame[0] + first * pitch - plan[12], frame[1] + line * pitch - plan[13]
    a = uf * x + us * y
    return _F(a), _F(a - plan[10]), _F(uf * y - us * x), _F(uf * pitch), _F(-us * pitch)


@kernel(f"void(float32[::1], {_FRAME}, {_SHAPE}, {_PLACE}, UniTuple(float64, 2))", counts=False)
def cut_straight(heights, frame, shape, ends, span):
    """Lower a tile's heights under a straight piece; what the arguments are `plan_straight` says."""
    plan = plan_straight(frame, shape, ends, span)
    runs, numbers = run_numbers(shape, plan[11], plan[14], plan[15])
    for line in range(int(plan[0]), int(plan[1]) + 1):
        first, last = cells_in_line(frame, plan, float(line))
        if last >= first:
            where = place_in_run(frame, plan, float(line), first)
            at, blocks = line * STRIDE + int(first), (int(last - first) + LANES) // LANES
            if runs == BALL:  # nothing else runs as often
                ball_run(heights, at, blocks, where, numbers[:6])
            else:
                straight_run(runs, heights, at, blocks, where, numbers)


@kernel(f"void({_TRACED}, UniTuple(float64, 2), int64)", counts=False)
def trace_straight(heights, owners, swept, sums, notes, frame, shape, ends, span, owner):
    """Do what `cut_straight` does, and note what it took; the rest of the arguments are `settle`'s."""
    plan = plan_straight(frame, shape, ends, span)
    runs, numbers = run_numbers(shape, plan[11], plan[14], plan[15])
    pending = 0
    for line in range(int(plan[0]), int(plan[1]) + 1):
        first, last = cells_in_line(frame, plan, float(line))
        if last < first:
            continue
        where = place_in_run(frame, plan, float(line), first)
        at, blocks = line * STRIDE + int(first), (int(last - first) + LANES) // LANES
        if runs == BALL and owner >= 0:
            ball_trace(heights, owners, sums, at, blocks, where, numbers[:6], _F(notes[5]), np.int32(owner))
        else:
            straight_run(runs, swept, 0, blocks, where, numbers)
            settle(heights, owners, swept, sums, notes, at, blocks, owner)
        pending += blocks
        if pending >= PENDING:
            gather(sums, notes)
            pending = 0
    gather(sums, notes)


@kernel(f"UniTuple(float64, 6)({_FRAME}, {_SHAPE}, {_PLACE}, {_ARC})")
def plan_arc(frame, shape, ends, circle):
    """Return first and last cell and line of a tile that an arc may lower, and the direction of their middle from its
    centre.

    Args:
        frame, shape: as for `plan_straight`.
        ends: fast, slow, z of start and end of a level arc of at most a quarter turn, counter-clockwise in the grid.
        circle: fast and slow of its centre, its radius, and 1 where fast is X, -1 where it is Y.
    """
    fast0, slow0, pitch, cells, lines = frame
    pf, ps, _, qf, qs, _ = ends
    cf, cs, size, sense = circle
    left, below, right, above = min(pf, qf), min(ps, qs), max(pf, qf), max(ps, qs)
    # the box of an arc is that of its ends, and of the circle's outermost points that lie on it
    for quarter in range(4):
        ux, uy = (
            (1.0, 0.0) if quarter == 0 else (0.0, 1.0) if quarter == 1 else (-1.0, 0.0) if quarter == 2 else (0.0, -1.0)
        )
        ahead, behind = ((pf - cf) * uy - (ps - cs) * ux) * sense, (ux * (qs - cs) - uy * (qf - cf)) * sense
        if ahead >= 0.0 and behind >= 0.0:
            left, right = min(left, cf + size * ux), max(right, cf + size * ux)
            below, above = min(below, cs + size * uy), max(above, cs + size * uy)
    radius = shape[0]
    c0, c1 = (
        max(math.ceil((left - radius - fast0) / pitch - SLACK), 0.0),
        min((right + radius - fast0) / pitch + SLACK, cells - 1.0),
    )
    l0, l1 = (
        max(math.ceil((below - radius - slow0) / pitch - SLACK), 0.0),
        min((above + radius - slow0) / pitch + SLACK, lines - 1.0),
    )
    mf, ms = fast0 + 0.5 * (c0 + c1) * pitch - cf, slow0 + 0.5 * (l0 + l1) * pitch - cs
    middle = math.sqrt(mf * mf + ms * ms)
    return (
        c0,
        math.floor(c1),
        l0,
        math.floor(l1),
        mf / middle if middle > 0.0 else 1.0,
        ms / middle if middle > 0.0 else 0.0,
    )


@kernel(f"UniTuple(float64, 4)({_FRAME}, {_SHAPE}, {_ARC}, {_PLACE}, float64)")
def cells_round_arc(frame, shape, circle, plan, line):
    """Return first and last cell of the two runs of a line that lie in an arc's ring; the last before the first:
    none.
    """
    fast0, slow0, pitch, _, _ = frame
    cf, cs, size, _ = circle
    y = slow0 + line * pitch - cs
    outer, inner, middle = size + shape[0], size - shape[0], (cf - fast0) / pitch
    half2, hole2 = outer * outer - y * y, inner * inner - y * y
    if half2 < 0.0:
        return 0.0, -1.0, 0.0, -1.0
    half = math.sqrt(half2) / pitch + SLACK
    first, last = math.ceil(max(middle - half, plan[0])), math.floor(min(middle + half, plan[1]))
    hole = math.sqrt(hole2) / pitch - SLACK if hole2 > 0.0 and inner > 0.0 else 0.0
    if hole < LANES:
        return first, last, 0.0, -1.0
    return first, min(math.floor(middle - hole), last), max(math.ceil(middle + hole), first), last


@kernel(f"UniTuple(float32, 13)({_FRAME}, {_PLACE}, {_ARC}, {_PLACE}, float64, float64)")
def place_by_arc(frame, ends, circle, plan, line, first):
    """Return what `arc_run` must know of where the first cell of a run lies."""
    pf, ps, _, qf, qs, _ = ends
    cf, cs, size, sense = circle
    pitch, nf, ns = frame[2], plan[4], plan[5]
    x, y = frame[0] + first * pitch, frame[1] + line * pitch
    df, ds, turn = x - cf - size * nf, y - cs - size * ns, sense / size
    t0f, t0s, t1f, t1s = -(ps - cs) * turn, (pf - cf) * turn, -(qs - cs) * turn, (qf - cf) * turn
    return (
        _F((x - pf) * t0f + (y - ps) * t0s),
        _F((x - qf) * t1f + (y - qs) * t1s),
        _F(2.0 * (nf * df + ns * ds)),
        _F(df),
        _F(x - pf),
        _F(x - qf),
        _F(t0f * pitch),
        _F(t1f * pitch),
        _F(2.0 * nf * pitch),
        _F(ds * ds),
        _F((y - ps) * (y - ps)),
        _F((y - qs) * (y - qs)),
        _F(pitch),
    )


@kernel(f"void({_TRACED}, {_ARC}, int64, boolean)", counts=False)
def sweep_arc(heights, owners, swept, sums, notes, frame, shape, ends, circle, owner, traced):
    """Lower a tile's heights under a level arc, traced or not; what the arguments are `plan_arc` and `settle` say."""
    plan = plan_arc(frame, shape, ends, circle)
    radius, flat, fillet, span, slope, lift, _ = shape
    form = (
        _F(radius * radius * (1.0 + 4e-7)),
        _F(flat),
        _F(fillet),
        _F(fillet * fillet),
        _F(span),
        _F(slope),
        _F(ends[2] + lift),
    )
    bend = _F(1.0 / circle[2])
    for line in range(int(plan[2]), int(plan[3]) + 1):
        runs = cells_round_arc(frame, shape, circle, plan, float(line))
        for part in range(2):
            first, last = (runs[0], runs[1]) if part == 0 else (runs[2], runs[3])
            if last < first:
                continue
            where = place_by_arc(frame, ends, circle, plan, float(line), first)
            at, blocks = line * STRIDE + int(first), (int(last - first) + LANES) // LANES
            if traced:
                arc_run(swept, 0, blocks, where, form, bend)
                settle(heights, owners, swept, sums, notes, at, blocks, owner)
                gather(sums, notes)
            else:
                arc_run(heights, at, blocks, where, form, bend)
