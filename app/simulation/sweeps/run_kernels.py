# mypy: allow-untyped-defs
"""The innermost loops: the height of a sweep over a run of cells, sixteen at a time, float32, without a branch.

A run is a row of cells; cell k has the place a along the move's horizontal direction as seen from the move's lower end,
b as seen from its upper end (both negative before it), and c across it. The move rises by s >= 0 a millimetre. At a
distance rho from the axis the cutter stands h(rho) over its tip, h convex, so the height over a cell,
z(tau) + h(hypot(c, a - tau)), is convex along the move. Its minimum is where a - tau = v(c, s); v is known in closed
form (by some steps of Newton's method for a fillet round a flat), and tau is clamped to the move's ends. There the
exact z of the end is taken. Cells that the cutter does not reach give NaN, infinity or are masked: they stay as they
are.

Cells behind the run's last one, up to the next sixteen, are cut as well; that is exact too, so it does no harm.
"""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel

LANES = 16
"""Cells that are computed at a time, float32: as many as the widest vector registers hold."""
_F = np.float32
_ZERO, _ONE, _STEP, _NEVER = _F(0.0), _F(1.0), _F(LANES), _F(math.inf)
"""In float32, since a number of Python would make all a run computes float64: nought, one, cells a step, and what is
higher than any metal.
"""
_LINE = "void(float32[::1], int64, int64, UniTuple(float32, 5), UniTuple(float32, {}))"


@kernel("float32(float32, float32, float32, UniTuple(float32, 6))")
def ball_height(a, b, c, move):
    """Return the height of a ball's sweep over a cell, NaN where it does not come.

    Free: z = z0 + s a - sqrt((1 + s²)(r² - c²)), where a sphere's end does not come first; there r² - c² - a² is under
    the root.

    Args:
        a, b, c: place of the cell.
        move: r², (s² / (1 + s²)), 1 + s², s, and the z of the ball's centre at both ends.
    """
    r2, lean2, stretch, s, low, high = move
    q2 = r2 - c * c
    ahead = q2 * lean2
    # touching place v = s sqrt((r² - c²) / (1 + s²)); compared by squares with their signs, so that no root is taken
    before, after = a * abs(a) < ahead, b * abs(b) > ahead
    root = q2 - a * a if before else (q2 - b * b if after else q2 * stretch)
    return (low if before else (high if after else low + s * a)) - np.sqrt(root)


@kernel(_LINE.format(6), counts=False)
def ball_run(line, first, blocks, where, move):
    """Lower a run under a ball.

    Args:
        where: a, b, c of the first cell, and how a (b alike) and c change from cell to cell, mm.
        move: as for `ball_height`.
    """
    a0, b0, c0, da, dc = where
    for _ in range(blocks):
        part = line[first : first + LANES]
        for k in range(LANES):
            x = _F(k)
            z = ball_height(a0 + da * x, b0 + da * x, c0 + dc * x, move)
            part[k] = z if z < part[k] else part[k]
        first += LANES
        a0, b0, c0 = a0 + _STEP * da, b0 + _STEP * da, c0 + _STEP * dc


@kernel(_LINE.format(3), counts=False)
def flat_run(line, first, blocks, where, move):
    """Lower a run under a flat end: over a cell it is lowest when its rear rim passes. move: r², s, z of the lower
    end.
    """
    a0, b0, c0, da, dc = where
    r2, s, low = move
    for _ in range(blocks):
        part = line[first : first + LANES]
        for k in range(LANES):
            x = _F(k)
            a, b, c = a0 + da * x, b0 + da * x, c0 + dc * x
            q = np.sqrt(r2 - c * c)
            # the flat is over the cell while a - q <= tau <= a + q; on a rise the first moment is the lowest
            late = a - q
            z = low + s * (late if late > _ZERO else _ZERO)
            z = z if min(a + q, q - b) >= _ZERO else _NEVER
            part[k] = z if z < part[k] else part[k]
        first += LANES
        a0, b0, c0 = a0 + _STEP * da, b0 + _STEP * da, c0 + _STEP * dc


@kernel("float32(float32, UniTuple(float32, 6))")
def profile(rho2, shape):
    """Return the cutter's height over its tip, infinite beyond its rim.

    Args:
        rho2: distance from the axis, squared.
        shape: rim², flat, fillet, its square, its span, slope of the cone (0 = none).
    """
    rim2, flat, fillet, fillet2, span, slope = shape
    beyond = np.sqrt(rho2) - flat
    beyond = beyond if beyond > _ZERO else _ZERO
    rounded = beyond if beyond < span else span
    under = fillet2 - rounded * rounded
    # flat, then the fillet's quarter circle up to its span, then the straight cone
    h = fillet - np.sqrt(under if under > _ZERO else _ZERO) + slope * (beyond - rounded)
    return h if rho2 <= rim2 else _NEVER


@kernel(_LINE.format(9), counts=False)
def level_run(line, first, blocks, where, move):
    """Lower a run under any cutter that goes level, or straight down. move: shape, s (as good as 0), z of both ends."""
    a0, b0, c0, da, dc = where
    shape, s, low, high = move[:6], move[6], move[7], move[8]
    for _ in range(blocks):
        part = line[first : first + LANES]
        for k in range(LANES):
            x = _F(k)
            a, b, c = a0 + da * x, b0 + da * x, c0 + dc * x
            # level: the profile alone decides, so tau = a, clamped to the move's ends
            v = a if a < _ZERO else (b if b > _ZERO else _ZERO)
            z = (low if a < _ZERO else (high if b > _ZERO else low + s * a)) + profile(c * c + v * v, shape)
            part[k] = z if z < part[k] else part[k]
        first += LANES
        a0, b0, c0 = a0 + _STEP * da, b0 + _STEP * da, c0 + _STEP * dc


@kernel(_LINE.format(13), counts=False)
def cone_run(line, first, blocks, where, move):
    """Lower a run under a cone with or without a flat tip.

    Where the cone rises more than the move it touches at v = s |c| / sqrt(m² - s²), but not within its flat; else at
    its rim.

    Args:
        where: as for the ball.
        move: shape, s, z of both ends, r², flat², s / sqrt(m² - s²), 1 where the move rises as the cone or more, else
            0.
    """
    a0, b0, c0, da, dc = where
    shape, s, low, high = move[:6], move[6], move[7], move[8]
    r2, flat2, lead, steep = move[9], move[10], move[11], move[12]
    for _ in range(blocks):
        part = line[first : first + LANES]
        for k in range(LANES):
            x = _F(k)
            a, b, c = a0 + da * x, b0 + da * x, c0 + dc * x
            c2 = c * c
            under, inner = r2 - c2, flat2 - c2
            q = np.sqrt(under if under > _ZERO else _ZERO)
            # from T cos(phi) = s with T = m all over the cone; inside the flat it touches nowhere but at the flat's rim
            v = max(max(np.sqrt(inner if inner > _ZERO else _ZERO), lead * abs(c)), steep * q)
            v = v if v < q else q
            before, after = a < v, b > v
            reach = a if before else (b if after else v)
            z = (low if before else (high if after else low + s * (a - v))) + profile(c2 + reach * reach, shape)
            part[k] = z if z < part[k] else part[k]
        first += LANES
        a0, b0, c0 = a0 + _STEP * da, b0 + _STEP * da, c0 + _STEP * dc


@kernel(_LINE.format(14), counts=False)
def taper_run(line, first, blocks, where, move):
    """Lower a run under a ball that goes over into a cone: it touches with the ball where that is within the ball's
    part.

    Args:
        where: as for the ball.
        move: as for the cone, but with (rim of the ball)² in place of flat², and s / sqrt(1 + s²) at the end.
    """
    a0, b0, c0, da, dc = where
    shape, s, low, high = move[:6], move[6], move[7], move[8]
    r2, ball_rim2, lead, steep, lean = move[9], move[10], move[11], move[12], move[13]
    for _ in range(blocks):
        part = line[first : first + LANES]
        for k in range(LANES):
            x = _F(k)
            a, b, c = a0 + da * x, b0 + da * x, c0 + dc * x
            c2 = c * c
            under, inner = r2 - c2, shape[3] - c2
            q = np.sqrt(under if under > _ZERO else _ZERO)
            ball = lean * np.sqrt(inner if inner > _ZERO else _ZERO)
            v = max(lead * abs(c), steep * q)
            v = v if v < q else q
            # the ball's own touching place counts where it lies on the ball's part; else the cone's does
            v = ball if c2 + ball * ball <= ball_rim2 else v
            before, after = a < v, b > v
            reach = a if before else (b if after else v)
            z = (low if before else (high if after else low + s * (a - v))) + profile(c2 + reach * reach, shape)
            part[k] = z if z < part[k] else part[k]
        first += LANES
        a0, b0, c0 = a0 + _STEP * da, b0 + _STEP * da, c0 + _STEP * dc


@kernel("float32(float32, float32, float32, float32)")
def _nearer(y, c, wide, deep):
    """Return the next guess of Newton's method for `bull_contact`."""
    u = _ONE + y * y
    cube = u * np.sqrt(u)
    return y + ((c - deep * y) * cube - wide * y * u) / (wide + deep * cube)


@kernel("UniTuple(float32, 2)(float64, float64, float64)")
def _tangent(y, wide, deep):
    """Return the tangent at y to what `bull_contact` solves, as y of it = first * c + second."""
    w = 1.0 / math.sqrt(1.0 + y * y)
    rise = wide * w * w * w + deep
    return _F(1.0 / rise), _F(y - (wide * w + deep) * y / rise)


@kernel("UniTuple(float32, 12)(float64, float64)")
def bull_guesses(wide, deep):
    """Return six straight lines that lie below what `bull_contact` solves: its tangents at 0, at infinity and
    between.
    """
    return (
        _tangent(0.0, wide, deep)
        + (_F(1.0 / deep), _F(-wide / deep))
        + _tangent(1.5, wide, deep)
        + _tangent(4.0, wide, deep)
        + _tangent(12.0, wide, deep)
        + _tangent(50.0, wide, deep)
    )


@kernel("float32(float32, float32, float32, UniTuple(float32, 12))")
def bull_contact(c, wide, deep, lines):
    """Return y of the place where a fillet round a flat touches.

    With the tilt of the surface, tan(tilt) cos(phi) = s and (flat + fillet sin(tilt)) sin(phi) = c, phi being the
    bearing of the place from the move's direction. For y = sqrt((sin(tilt) sqrt(1 + s²) / s)² - 1) this is flat sqrt(1
    + s²) y / sqrt(1 + y²) + fillet s y = c: concave and rising, so Newton's steps from below stay below and converge.
    After four steps z is less than 1e-10 (1 + s) of the radius too high, for fillets from a thousandth of the flat on
    (the error of z is the square of v's).

    Args:
        c: distance from the move's line, mm, >= 0.
        wide: flat * sqrt(1 + s²).
        deep: fillet * s, s > 0 being the rise of the move.
        lines: `bull_guesses`, all of them below the curve; the highest one is the first guess.
    """
    # c(y) is concave: its tangents, read as y of c, lie below the inverse, and the highest is the nearest guess
    y = max(max(lines[0] * c, lines[2] * c + lines[3]), max(lines[4] * c + lines[5], lines[6] * c + lines[7]))
    y = max(y, max(lines[8] * c + lines[9], lines[10] * c + lines[11]))
    y = _nearer(_nearer(y, c, wide, deep), c, wide, deep)
    return _nearer(_nearer(y, c, wide, deep), c, wide, deep)


@kernel(_LINE.format(12), counts=False)
def bull_run(line, first, blocks, where, move):
    """Lower a run under a bull-nose end on a slope. move: shape, s, z of both ends, r², flat * sqrt(1 + s²), fillet *
    s.
    """
    a0, b0, c0, da, dc = where
    shape, s, low, high = move[:6], move[6], move[7], move[8]
    r2, wide, deep = move[9], move[10], move[11]
    stretch, lines = _ONE + s * s, bull_guesses(wide, deep)
    for _ in range(blocks):
        part = line[first : first + LANES]
        for k in range(LANES):
            x = _F(k)
            a, b, c = a0 + da * x, b0 + da * x, c0 + dc * x
            y = bull_contact(abs(c), wide, deep, lines)
            c2, y2 = c * c, y * y
            under, left = r2 - c2, _ONE - s * s * y2
            q = np.sqrt(under if under > _ZERO else _ZERO)
            v = (shape[1] + deep * np.sqrt((_ONE + y2) / stretch)) * np.sqrt(
                (left if left > _ZERO else _ZERO) / (_ONE + y2)
            )
            v = v if v < q else q
            before, after = a < v, b > v
            reach = a if before else (b if after else v)
            z = (low if before else (high if after else low + s * (a - v))) + profile(c2 + reach * reach, shape)
            part[k] = z if z < part[k] else part[k]
        first += LANES
        a0, b0, c0 = a0 + _STEP * da, b0 + _STEP * da, c0 + _STEP * dc


@kernel("void(float32[::1], int64, int64, UniTuple(float32, 13), UniTuple(float32, 7), float32)", counts=False)
def arc_run(line, first, blocks, where, shape, bend):
    """Lower a run under any cutter that goes round a level arc of at most a quarter turn.

    Of a cell at the offset d from a place of the circle near by (unit vector n to it from the centre, radius A) the
    distance from the circle is w / (1 + sqrt(1 + w / A)) with w = 2 n·d + d²/A: exact, and of small numbers only,
    however large A is. Cells before the start or behind the end are as far as the nearer end.

    Args:
        where: of the first cell: a, b (along the tangents at start and end), 2 n·d, d along the run, start and end
            along the run; their change from cell to cell for a, b and 2 n·d; d, start and end across the run, squared;
            pitch.
        shape: as for `profile`, and the z of the tip.
        bend: 1 / A.
    """
    a0, b0, n0, d0, p0, e0, da, db, dn, d2, p2, e2, pitch = where
    form, low = shape[:6], shape[6]
    for _ in range(blocks):
        part = line[first : first + LANES]
        for k in range(LANES):
            x = _F(k)
            d, p, e = d0 + pitch * x, p0 + pitch * x, e0 + pitch * x
            w = n0 + dn * x + (d2 + d * d) * bend
            inner = _ONE + w * bend
            # |d + A n| - A without the difference of two large numbers
            gap = w / (_ONE + np.sqrt(inner if inner > _ZERO else _ZERO))
            inside = min(a0 + da * x, -(b0 + db * x)) >= _ZERO
            z = low + profile(gap * gap if inside else min(p2 + p * p, e2 + e * e), form)
            part[k] = z if z < part[k] else part[k]
        first += LANES
        a0, b0, n0 = a0 + _STEP * da, b0 + _STEP * db, n0 + _STEP * dn
        d0, p0, e0 = d0 + _STEP * pitch, p0 + _STEP * pitch, e0 + _STEP * pitch
