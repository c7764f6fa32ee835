# mypy: allow-untyped-defs
"""Compiled: joints of lines and arcs in a plane, moved until the path is tangent and within a limit of a polyline.

The polyline is xy, (n,) complex places; `along` (n,) their distances along it, `ahead` (n,) the unit direction at each.
A path of m pieces has joints 0 to m, each told by its distance along the polyline and how far left of it it lies, and
of each piece half its sweep, radians: positive to the left, 0 a line.
"""

from __future__ import annotations

import cmath
import math

import numpy as np

from ...core.jit import kernel
from ..band_kernels import factor

_R, _Z, _BANDS, _FRAMES = "float64[::1]", "complex128[::1]", "float64[:, ::1]", "complex128[:, ::1]"
_SAMPLES = 32
"""Points of a stretch that are held against its limit, about."""
_EACH = 8
"""A piece is held to so many samples at least, to all if there are no more than twice as many; a chord has so many."""
_BAND = 8
"""Variables that meet in one bend are so near one another."""
_STEPS = 80
"""Newton's steps at most; `off` tells what is not within the limit by then."""
_FIRM, _FIRST, _LIGHT = 1.0, 0.1, 1e-6
"""What the walls weigh beside the bends: while the path is beyond the limit, from then on, and in the end."""
_HARD = math.radians(2.0)
"""A bend of so much weighs 1."""
_WIDEST = 2.0
"""Half of the widest sweep, radians."""
_ROOM = 1.05
"""The walls of what is beyond the limit stand so much farther out."""
_SHORTEST = 2.0
"""No piece becomes shorter than so many limits, or half of what it was: what is short is nothing when it is rounded."""
_LEAST = 1e-5
"""Of a step, is tried."""
_DONE = 1e-3
"""A step that promises so much for each variable, times the walls' weight, is the last with that weight."""


@kernel("float64(complex128, complex128, float64, complex128)", counts=False)
def _apart(a, b, half, p):
    """Return how far a point lies left of the circle that a piece from a to b is of."""
    c, w = b - a, p - a
    size = abs(c)
    tangent = c / size * cmath.exp(-1j * half)
    bent = 2.0 * math.sin(half) / size
    # F = y - k (x² + y²) / 2 is 0 on the circle of curvature k that leaves a along x; a place lies 2 F / (1 + sqrt(1
    # - 2 k F)) to its left. That needs no centre, so that a line, k = 0, is no case of its own.
    left = (w * tangent.conjugate()).imag - 0.5 * bent * (w.real * w.real + w.imag * w.imag)
    return 2.0 * left / (1.0 + math.sqrt(max(1.0 - 2.0 * bent * left, 1e-9)))


@kernel(f"float64({_Z}, {_R}, int64)", counts=False)
def _bend(z, half, j):
    """Return by how much the path turns at joint j, radians."""
    # The piece before arrives in its chord's direction + half its sweep, the next one leaves in its chord's - half.
    turn = cmath.phase((z[j + 1] - z[j]) / (z[j] - z[j - 1])) - half[j] - half[j - 1]
    return turn - 2.0 * math.pi * round(turn / (2.0 * math.pi))


@kernel("float64(float64, float64)", counts=False)
def _ease(share, swell):
    """Return what a distance from a place of a chord counts for, where the region is wider between points than at
    them.
    """
    # The squared limit is a parabola along the chord: once at the points, 1 + swell times in the middle.
    return 1.0 / math.sqrt(1.0 + 4.0 * swell * share * (1.0 - share))


@kernel(f"complex128({_Z}, int64)", counts=False)
def _sample(xy, s):
    """Return sample s of a polyline: its points and, between them, places that part its chords evenly."""
    k, share = s // _EACH, (s % _EACH) / _EACH
    return xy[k] if share == 0.0 else xy[k] + share * (xy[k + 1] - xy[k])


@kernel(f"float64({_Z}, complex128, complex128, float64, int64, float64)", counts=False)
def _off(xy, a, b, half, s, swell):
    """Return how far sample s lies left of the circle that a piece from a to b is of, as it counts."""
    return _apart(a, b, half, _sample(xy, s)) * _ease((s % _EACH) / _EACH, swell)


@kernel("UniTuple(int64, 3)(float64, float64, float64)", counts=False)
def _samples(low, high, swell):
    """Return first, stop and step of the samples between two feet: of many those at points, where these have less
    room.
    """
    first, stop = math.floor(_EACH * low) + 1, math.ceil(_EACH * high)
    step = max(1, (stop - first) // _SAMPLES)
    if swell > 0.0 and step > 1:
        first, step = _EACH * (math.floor(low) + 1), _EACH * max(1, step // _EACH)
    return first, stop, step


@kernel(f"void({_Z}, {_R}, {_Z}, {_R}, {_R}, int64, int64, {_R}, {_Z})", counts=False)
def place(xy, along, ahead, s, left, first, stop, feet, z):
    """Write the feet, in chords of the polyline, and the places of joints first to stop - 1."""
    for j in range(first, stop):
        k = min(max(int(np.searchsorted(along, s[j], side="right")) - 1, 0), len(xy) - 2)
        share = (s[j] - along[k]) / (along[k + 1] - along[k])
        # Directions turn evenly along a chord: a joint that slides past a point does not jump.
        way = ahead[k] + share * (ahead[k + 1] - ahead[k])
        feet[j] = k + share
        z[j] = xy[k] + share * (xy[k + 1] - xy[k]) + left[j] * 1j * way / abs(way)


@kernel(f"float64({_Z}, complex128, complex128, float64, float64, float64, float64)", counts=False)
def _farthest(xy, a, b, half, low, high, swell):
    """Return how far the polyline between two feet is from the circle that a piece is of: at its points, and where a
    chord is parallel.
    """
    c = b - a
    tangent, bent = c / abs(c) * cmath.exp(-1j * half), 2.0 * math.sin(half) / abs(c)
    worst = 0.0
    for k in range(int(low), min(math.ceil(high), len(xy) - 1)):
        first, last = max(low - k, 0.0), min(high - k, 1.0)
        d, w = xy[k + 1] - xy[k], xy[k] - a
        flat = bent * (d.real * d.real + d.imag * d.imag)
        rise = (d * tangent.conjugate()).imag - bent * (w.conjugate() * d).real
        # F of `_apart` changes along the chord by rise - share * flat: where that is 0 the chord is parallel to the
        # circle.
        if first * flat < rise < last * flat or last * flat < rise < first * flat:
            share = rise / flat
            worst = max(worst, abs(_apart(a, b, half, xy[k] + share * d)) * _ease(share, swell))
        if last == 1.0:
            worst = max(worst, abs(_apart(a, b, half, xy[k + 1])))
    return worst


@kernel(f"void({_Z}, {_Z}, {_R}, {_R}, {_R}, int64, int64, boolean, float64, {_R})", counts=False)
def measure(xy, z, feet, left, half, first, stop, whole, swell, off):
    """Write how far each of pieces first to stop - 1 is from its samples, or from the whole polyline, or its joints
    from it, at most.
    """
    for k in range(first, stop):
        off[k] = max(abs(left[k]) * _ease(feet[k] % 1.0, swell), abs(left[k + 1]) * _ease(feet[k + 1] % 1.0, swell))
        if whole:
            off[k] = max(off[k], _farthest(xy, z[k], z[k + 1], half[k], feet[k], feet[k + 1], swell))
            continue
        low, high, step = _samples(feet[k], feet[k + 1], swell)
        for s in range(low, high, step):
            off[k] = max(off[k], abs(_off(xy, z[k], z[k + 1], half[k], s, swell)))


@kernel(f"float64({_Z}, {_Z}, {_R}, {_R}, {_R}, int64, int64, {_R}, {_R}, float64, float64)", counts=False)
def _merit(xy, z, feet, left, half, first, stop, limits, sizes, weight, swell):
    """Return what is to be least: squared bends, and walls at the limits; inf beyond these."""
    walls, count = 0.0, len(half)
    for k in range(first, stop):
        size = abs(z[k + 1] - z[k])
        if feet[k + 1] <= feet[k] or abs(half[k]) >= _WIDEST or size <= sizes[k]:
            return np.inf
        # Logarithms are infinite at the walls, so a step that makes the merit less never goes through one.
        walls -= math.log(size - sizes[k])
        low, high, step = _samples(feet[k], feet[k + 1], swell)
        for s in range(low, high, step):
            room = 1.0 - (_off(xy, z[k], z[k + 1], half[k], s, swell) / limits[k]) ** 2
            if not room > 0.0:
                return np.inf
            walls -= math.log(room)
    for j in range(first + 1, stop):
        room = 1.0 - (left[j] * _ease(feet[j] % 1.0, swell) / min(limits[j - 1], limits[j])) ** 2
        if not room > 0.0:
            return np.inf
        walls -= math.log(room)
    turns = 0.0
    for j in range(max(first, 1), min(stop, count - 1) + 1):
        turns += (_bend(z, half, j) / _HARD) ** 2
    return turns + weight * walls


@kernel(f"void({_BANDS}, {_R}, int64, {_R}, float64, float64)", counts=False)
def _add(band, slope, at, part, value, second):
    """Add a function of the variables from `at` on: its slopes `part`, times `value` to the slope, and times `second`
    as squares.
    """
    for i in range(max(0, -at), min(len(part), len(slope) - at)):
        slope[at + i] += value * part[i]
        for j in range(max(0, -at), i + 1):
            band[at + i, i - j] += second * part[i] * part[j]


@kernel(f"void(complex128, complex128, float64, complex128, {_Z})", counts=False)
def _slopes(a, b, half, p, found):
    """Write how `_apart` changes: by the real part of found[0] da + found[1] dhalf + found[2] db."""
    c, w = b - a, p - a
    size = abs(c)
    unit = c / size
    start = unit * cmath.exp(-1j * half)
    bent = 2.0 * math.sin(half) / size
    on, left = (w * start.conjugate()).real, (w * start.conjugate()).imag
    straight = abs(half) < 1e-4
    share = on / size if straight else math.atan2(bent * on, 1.0 - bent * left) / (2.0 * half)
    share = min(max(share, -0.5), 1.5)
    whole = 2.0 * share - 1.0
    turned = cmath.exp(1j * half * whole)
    # The arc's nearest place is a + c at; `grows` is the slope of `at` in half. Only what moves that place square to
    # the arc counts: its share changes, too, but along the arc.
    if straight:
        at, grows = complex(share, 0.0), complex(0.0, share * (share - 1.0))
    else:
        sine = math.sin(half)
        at = (turned - cmath.exp(-1j * half)) / (2j * sine)
        grows = (whole * turned + cmath.exp(-1j * half)) / (2.0 * sine) - at * math.cos(half) / sine
    away = -(1j * unit * turned).conjugate()
    found[0], found[1], found[2] = away * (1.0 - at), away * c * grows, away * at


@kernel(f"void({_Z}, {_R}, {_Z}, {_R}, {_R}, int64, int64, {_FRAMES})", counts=False)
def _frames(xy, along, ahead, feet, left, first, stop, frames):
    """Write how joints first to stop - 1 move with their distance along and with their distance from the polyline."""
    for j in range(first, stop):
        k = min(int(feet[j]), len(xy) - 2)
        size = along[k + 1] - along[k]
        grows = ahead[k + 1] - ahead[k]
        way = ahead[k] + (feet[j] - k) * grows
        length = abs(way)
        way /= length
        # Beside the polyline a joint is carried round as the direction turns: faster outside of the bend, slower
        # within.
        turns = (way.conjugate() * grows).imag / (length * size)
        frames[j, 0] = (xy[k + 1] - xy[k]) / size - left[j] * turns * way
        frames[j, 1] = 1j * way


@kernel(f"void({_Z}, {_Z}, {_R}, {_R}, {_FRAMES}, int64, int64, {_R}, {_R}, float64, float64, {_BANDS}, {_R})")
def _walls(xy, z, feet, half, frames, first, stop, limits, sizes, weight, swell, band, slope):
    """Add the walls: of piece first + i its half at 3 i, of joint first + i its distances at 3 i - 2 and 3 i - 1."""
    part, found = np.empty(5), np.empty(3, np.complex128)
    for k in range(first, stop):
        at = 3 * (k - first) - 2
        low, high, step = _samples(feet[k], feet[k + 1], swell)
        for s in range(low, high, step):
            p = _sample(xy, s)
            square = (limits[k] / _ease((s % _EACH) / _EACH, swell)) ** 2
            d = _apart(z[k], z[k + 1], half[k], p)
            room = 1.0 - d * d / square
            # Slope and curvature of the wall -log(1 - d² / square) in d. How d itself curves is left out (Gauss and
            # Newton), which keeps the matrix positive.
            pull = 2.0 * d / (square * room)
            _slopes(z[k], z[k + 1], half[k], p, found)
            part[0], part[1] = (found[0] * frames[k, 0]).real, (found[0] * frames[k, 1]).real
            part[2] = found[1].real
            part[3], part[4] = (found[2] * frames[k + 1, 0]).real, (found[2] * frames[k + 1, 1]).real
            _add(band, slope, at, part, weight * pull, weight * (2.0 / (square * room) + pull * pull))
        c = z[k + 1] - z[k]
        size = abs(c) - sizes[k]
        unit = (c / abs(c)).conjugate()
        part[0], part[1], part[2] = -(unit * frames[k, 0]).real, -(unit * frames[k, 1]).real, 0.0
        part[3], part[4] = (unit * frames[k + 1, 0]).real, (unit * frames[k + 1, 1]).real
        _add(band, slope, at, part, -weight / size, weight / (size * size))


@kernel(f"void({_R}, {_R}, int64, int64, {_R}, float64, float64, {_BANDS}, {_R})", counts=False)
def _rails(feet, left, first, stop, limits, weight, swell, band, slope):
    """Add the walls of the joints."""
    for j in range(first + 1, stop):
        square = (min(limits[j - 1], limits[j]) / _ease(feet[j] % 1.0, swell)) ** 2
        room = 1.0 - left[j] * left[j] / square
        pull = 2.0 * left[j] / (square * room)
        at = 3 * (j - first) - 1
        slope[at] += weight * pull
        band[at, 0] += weight * (2.0 / (square * room) + pull * pull)


@kernel(f"void({_Z}, {_R}, {_FRAMES}, int64, int64, {_BANDS}, {_R})")
def _turns(z, half, frames, first, stop, band, slope):
    """Add the squared bends."""
    part = np.empty(8)
    for j in range(max(first, 1), min(stop, len(half) - 1) + 1):
        before, behind = -1j / (z[j] - z[j - 1]), -1j / (z[j + 1] - z[j])  # d arg c = Re(-i dc / c)
        for n in range(2):
            part[n] = (before * frames[j - 1, n]).real
            part[3 + n] = -((before + behind) * frames[j, n]).real
            part[6 + n] = (behind * frames[j + 1, n]).real
        part[2] = part[5] = -1.0
        turn = _bend(z, half, j) / _HARD
        _add(band, slope, 3 * (j - first) - 5, part, 2.0 * turn / _HARD, 2.0 / _HARD**2)


@kernel(f"boolean({_BANDS}, {_R})", counts=False)
def _solved(band, right):
    """Solve a symmetric positive system, given by its lower band, in place."""
    count, p = len(band), band.shape[1] - 1
    if not factor(band):
        return False
    for i in range(count):
        for j in range(max(0, i - p), i):
            right[i] -= band[i, i - j] * right[j]
        right[i] /= band[i, 0]
    for i in range(count - 1, -1, -1):
        for j in range(i + 1, min(count, i + p + 1)):
            right[i] -= band[j, j - i] * right[j]
        right[i] /= band[i, 0]
    return True


@kernel(f"void({_BANDS}, {_R}, boolean[::1], int64)", counts=False)
def _hold(band, slope, bent, first):
    """Keep lines straight, and make the system's numbers firm."""
    for i in range(len(slope)):
        # Where a joint may slide at nearly no cost the matrix is nearly singular: this keeps it positive.
        band[i, 0] += 1e-9 + 1e-12 * band[i, 0]
        if i % 3 == 0 and not bent[first + i // 3]:
            slope[i] = 0.0
            band[i, :] = 0.0
            band[i, 0] = 1.0
            for j in range(i + 1, min(len(slope), i + _BAND)):
                band[j, j - i] = 0.0


@kernel(f"UniTuple(boolean, 2)({_R}, int64, int64, float64, {_R})", counts=False)
def _limits(off, first, stop, limit, limits):
    """Set the walls of what is beyond the limit farther out, never farther than before; tell whether any is, and comes
    nearer.
    """
    beyond, nearer = False, False
    for k in range(first, stop):
        if off[k] < limit:
            limits[k] = limit
            continue
        wall = _ROOM * off[k]
        nearer |= wall < 0.995 * limits[k]
        limits[k] = wall if off[k] >= limits[k] else min(limits[k], wall)
        beyond = True
    return beyond, nearer


@kernel(
    f"float64({_Z}, {_Z}, {_R}, {_R}, {_FRAMES}, {_R}, boolean[::1], int64, int64, {_R}, {_R}, float64, float64, "
    f"{_BANDS}, {_R})"
)
def _way_down(xy, z, feet, left, frames, half, bent, first, stop, limits, sizes, weight, swell, band, way):
    """Write Newton's step, to be taken off; return by how much the merit falls along it at first, -1 if there is
    none.
    """
    slope = np.zeros(len(way))
    band[:] = 0.0
    _walls(xy, z, feet, half, frames, first, stop, limits, sizes, weight, swell, band, slope)
    _rails(feet, left, first, stop, limits, weight, swell, band, slope)
    _turns(z, half, frames, first, stop, band, slope)
    _hold(band, slope, bent, first)
    way[:] = slope
    if not _solved(band, way):
        return -1.0
    falls = 0.0
    for i in range(len(slope)):
        falls += slope[i] * way[i]
    return falls


@kernel(f"void({_R}, {_R}, {_R}, int64, int64, {_R}, float64, {_R}, {_R}, {_R})", counts=False)
def _stepped(s, left, half, first, stop, way, share, s_new, left_new, half_new):
    """Write where a share of a step leads."""
    for k in range(first, stop):
        i = 3 * (k - first)
        half_new[k] = half[k] - share * way[i]
        if i > 0:
            s_new[k], left_new[k] = s[k] - share * way[i - 2], left[k] - share * way[i - 1]


@kernel(f"float64({_Z}, {_R}, {_Z}, {_R}, {_R}, {_R}, boolean[::1], int64, int64, float64, float64, {_R})")
def tune(xy, along, ahead, s, left, half, bent, first, stop, limit, swell, off):
    """Move joints first + 1 to stop - 1 and bend pieces first to stop - 1, in place, so that the path turns as little
    as it can there.

    Newton's method on squared bends and a logarithmic wall at the limit. A piece that is beyond it has its wall farther
    out until it comes nearer.

    Args:
        s: (m + 1,) of each joint, its distance along the polyline, mm. left: (m + 1,) its distance left of it, mm.
        half: (m,) of each piece. bent: (m,) whether it may be an arc.
        limit: how far path and polyline may be apart at the points, mm.
        swell: the squared limit half way between two points exceeds that at them by so many times that.
        off: (m,) out: how far they are, of pieces first to stop.

    Returns:
        The largest bend that is left at joints first to stop, radians.
    """
    count, near, end = len(half), max(first - 1, 0), min(stop + 2, len(s))
    feet, z, frames = np.zeros(count + 1), np.zeros(count + 1, np.complex128), np.zeros((count + 1, 2), np.complex128)
    place(xy, along, ahead, s, left, near, end, feet, z)
    limits, sizes = np.empty(count), np.empty(count)
    for k in range(first, stop):
        sizes[k], limits[k] = min(_SHORTEST * limit, 0.5 * abs(z[k + 1] - z[k])), np.inf
    inner, band, way = (
        slice(first + 1, stop),
        np.empty((3 * (stop - first) - 2, _BAND)),
        np.empty(3 * (stop - first) - 2),
    )
    s_new, left_new, half_new, feet_new, z_new = s.copy(), left.copy(), half.copy(), feet.copy(), z.copy()
    weight, beyond = _FIRST, False
    for _ in range(_STEPS):
        measure(xy, z, feet, left, half, first, stop, False, swell, off)
        was = beyond
        beyond, nearer = _limits(off, first, stop, limit, limits)
        weight = _FIRM if beyond else _FIRST if was else weight
        _frames(xy, along, ahead, feet, left, near, end, frames)
        falls = _way_down(xy, z, feet, left, frames, half, bent, first, stop, limits, sizes, weight, swell, band, way)
        here, share = _merit(xy, z, feet, left, half, first, stop, limits, sizes, weight, swell), 1.0
        # Armijo's rule: of a step is taken what yields a part of the fall that its beginning promises, else half of
        # it.
        while share > _LEAST and falls > 0.0:
            _stepped(s, left, half, first, stop, way, share, s_new, left_new, half_new)
            place(xy, along, ahead, s_new, left_new, first + 1, stop, feet_new, z_new)
            if (
                _merit(xy, z_new, feet_new, left_new, half_new, first, stop, limits, sizes, weight, swell)
                <= here - 1e-4 * share * falls
            ):
                half[first:stop], s[inner], left[inner] = half_new[first:stop], s_new[inner], left_new[inner]
                feet[inner], z[inner] = feet_new[inner], z_new[inner]
                break
            share *= 0.5
        if share <= _LEAST or falls < _DONE * len(way) * weight:
            if weight <= _LIGHT or (beyond and not nearer):
                break
            # With less weight the walls may be come nearer to; begun where the last weight ended, each takes few
            # steps.
            weight *= 1.0 if beyond else 0.1
    measure(xy, z, feet, left, half, first, stop, True, swell, off)
    most = 0.0
    for j in range(max(first, 1), min(stop, count - 1) + 1):
        most = max(most, abs(_bend(z, half, j)))
    return most


@kernel(f"void({_Z}, {_R}, {_R})")
def bends(z, half, found):
    """Write by how much the path turns at each joint, radians: (m + 1,), 0 at the ends."""
    found[:] = 0.0
    for j in range(1, len(half)):
        found[j] = abs(_bend(z, half, j))
