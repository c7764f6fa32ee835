"""A rational B-spline in the words of a control that knows one.

LinuxCNC (G5.2 ... G5.3) has no knots, works in one plane, and takes the largest L for all; so a curve is written as
cubic Bézier pieces of four control points, which is the same curve. Fanuc (G6.2) has them, in the digits of an axis
word; knots that these cannot hold give way to those of the Bézier pieces, 0, 1, 2 ..., which draw the same curve.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...geometry.arcs.bezier import cut_at_knots, elevated
from ...model.motion import MotionKind, Nurbs
from ...model.part import Units
from ..posts import NurbsForm, Post
from .linuxcnc_biarcs import turns_all_along
from .template_fields import counts, numeral

Floats = NDArray[np.float64]

CUBIC = 3
"""The highest degree that controls take."""
LARGEST_WEIGHT = 9999.0
"""Of R: only the weights' ratios count, and R has few digits behind its point."""
WEIGHT_DIGITS = 9
"""Of P of G5.2."""
MOST_KNOTS = 99999
"""The largest knot that is written."""
_UNITS = tuple(2.0**-k for k in range(13))
"""Knots that are multiples of one of them are written as they are."""
_CRUMB = 12.0
"""Steps of the last decimal: the direction of a piece as short as that is nothing but rounding."""
_UNEVEN = 0.4
"""Where a piece is cut whose turn is none at one of LinuxCNC's steps: not in the middle, where the turn may be none
again.
"""


@dataclass(frozen=True, slots=True)
class _NurbsFormat:
    """Control points as words, one text a letter and point."""

    x: list[str]
    y: list[str]
    z: list[str]


def nurbs_blocks(curve: Nurbs, post: Post, units: Units) -> tuple[str, ...] | None:
    """Return the blocks that drive along a curve from its start, where the tool stands, at the feed in force.

    Every control point is rounded once, so the written curve is nowhere farther from the meant one than a point from
    its rounded one; knots stay exact, weights to 1 in 10 million.

    Args:
        curve: mm, from the program's zero.
        post: the control's words.
        units: of the program, MM or INCH.

    Returns:
        The blocks; behind them the next motion has to say its G word. None where the control cannot carry the curve: it
        knows no NURBS, not this degree, or only those in the plane.
    """
    if post.nurbs.form is NurbsForm.NONE or curve.degree > CUBIC:
        return None
    if post.nurbs.form is NurbsForm.KNOTS:
        return tuple(_with_knots(curve, post, units))
    z = counts(curve.points[:, 2] / units.value, post.digits(units).Z)
    return tuple(_pieces(curve, post, units)) if len(set(z)) == 1 else None


def _pieces(curve: Nurbs, post: Post, units: Units) -> list[str]:
    """Return cubic pieces of four control points; the first is where the tool stands, with its weight alone."""
    blocks: list[str] = []
    pieces = [part for whole in elevated(_bezier(curve), CUBIC) for part in _that_turn(whole, post, units)]
    at = _places(pieces[0], post, units)[0]
    for number, piece in enumerate(pieces, 1):
        end = _places(piece, post, units)[-1]
        if abs(end - at) <= _CRUMB * _step(post, units) and number < len(pieces):
            continue  # the next piece begins where the tool stands, a little farther back along the curve
        at = end
        weights = piece[:, 3] / piece[:, 3].max()
        spelled = _spelled(piece[:, :3] / piece[:, 3:], post, units)
        if not np.any(np.diff(_places(piece, post, units))):
            continue  # the control stands there
        if _straight(piece, post, units):
            blocks.append(f"{post.words.motion[MotionKind.LINE]} {spelled.x[-1]} {spelled.y[-1]}")
            continue
        p = [f"P{weight:.{WEIGHT_DIGITS}f}".rstrip("0").rstrip(".") for weight in weights]
        blocks.append(f"{post.nurbs.word} {p[0]} L{CUBIC + 1}")
        blocks += [f"{spelled.x[k]} {spelled.y[k]} {p[k]}" for k in range(1, CUBIC + 1)]
        blocks.append(post.nurbs.end)
    return blocks


def _straight(piece: Floats, post: Post, units: Units) -> bool:
    """Tell whether a cubic piece (4, 4) is no farther than a step of the last decimal from its chord, and runs along
    it.
    """
    z = _places(piece, post, units)
    way = z[-1] - z[0]
    if way == 0:
        return False
    share, off = (z - z[0]) / way, _step(post, units) / abs(way)
    return bool(np.all(np.abs(share.imag) <= off) and np.all(np.diff(share.real) >= 0))


def _that_turn(piece: Floats, post: Post, units: Units, depth: int = 3) -> list[Floats]:
    """Return a cubic piece in parts that LinuxCNC finds its arcs for: all their steps turn, or they are straight."""
    z = _places(piece, post, units)
    written = Nurbs(
        np.column_stack([z.real, z.imag, 0 * z.real]), piece[:, 3] / piece[:, 3].max(), np.repeat([0.0, 1.0], 4), CUBIC
    )
    if depth == 0 or _straight(piece, post, units) or turns_all_along(written):
        return [piece]
    return [part for half in _cut(piece, _UNEVEN) for part in _that_turn(half, post, units, depth - 1)]


def _cut(piece: Floats, at: float) -> tuple[Floats, Floats]:
    """Return both parts of a cubic piece that is cut at a parameter (de Casteljau)."""
    left, right = [piece[0]], [piece[-1]]
    while len(piece) > 1:
        piece = (1 - at) * piece[:-1] + at * piece[1:]
        left.append(piece[0])
        right.append(piece[-1])
    return np.array(left), np.array(right[::-1])


def _places(piece: Floats, post: Post, units: Units) -> NDArray[np.complex128]:
    """Return the control points as they are written, complex, mm."""
    step = _step(post, units)
    flat = np.rint(piece[:, :2] / piece[:, 3:] / step) * step
    return flat[:, 0] + 1j * flat[:, 1]


def _step(post: Post, units: Units) -> float:
    return 10.0 ** -post.digits(units).X * units.value


def _with_knots(curve: Nurbs, post: Post, units: Units) -> list[str]:
    """Return every control point with its knot, and its weight where they are not all alike; then the last knots."""
    decimals, zeros = post.digits(units).X, post.words.trailing_zeros
    homogeneous, knots = _homogeneous(curve), _whole(curve.knots, decimals)
    if knots is None:
        pieces = _bezier(curve)
        homogeneous = np.concatenate([pieces[0, :1], pieces[:, 1:].reshape(-1, 4)])
        inner = np.repeat(np.arange(1, len(pieces)), curve.degree)
        whole = np.array([0] * (curve.degree + 1) + inner.tolist() + [len(pieces)] * (curve.degree + 1))
        knots = whole * 10**decimals
    weights = homogeneous[:, 3] / homogeneous[:, 3].max()
    spelled = _spelled(homogeneous[:, :3] / homogeneous[:, 3:], post, units)
    r = [f" R{numeral(count, decimals, zeros)}" for count in counts(weights * LARGEST_WEIGHT, decimals)]
    if np.ptp(weights) == 0:
        r = [""] * len(weights)
    k = [f"K{numeral(knot, decimals, zeros)}" for knot in knots.tolist()]
    blocks = [" ".join(words) + weight for *words, weight in zip(k, spelled.x, spelled.y, spelled.z, r, strict=False)]
    return [f"{post.nurbs.word} P{curve.degree + 1} {blocks[0]}", *blocks[1:], *k[len(blocks) :]]


def _spelled(points: Floats, post: Post, units: Units) -> _NurbsFormat:
    """Return points (n, 3), mm, as words."""
    digits, zeros = post.digits(units), post.words.trailing_zeros
    columns = zip("XYZ", points.T / units.value, (digits.X, digits.Y, digits.Z), strict=True)
    return _NurbsFormat(
        *([letter + numeral(n, decimals, zeros) for n in counts(axis, decimals)] for letter, axis, decimals in columns)
    )


def _homogeneous(curve: Nurbs) -> Floats:
    """Return control points (k, 4): w x, w y, w z, w."""
    weights = curve.weights[:, None]
    return np.hstack([curve.points * weights, weights])


def _bezier(curve: Nurbs) -> Floats:
    """Return the Bézier pieces (n, degree + 1, 4), homogeneous."""
    return cut_at_knots(_homogeneous(curve), curve.knots, curve.degree)


def _whole(knots: Floats, decimals: int) -> NDArray[np.int64] | None:
    """Return the knots, in steps of the last decimal, that draw the same curve where there are such; None where there
    are not.
    """
    moved = knots - knots[0]
    steps = np.diff(moved)
    for unit in (np.min(steps[steps > 0]), *_UNITS):
        near = np.rint(moved / unit)
        if np.allclose(moved / unit, near, rtol=0, atol=1e-9):
            if near[-1] <= MOST_KNOTS:
                return np.asarray(near * 10**decimals, np.int64)
            if near[-1] <= MOST_KNOTS * 10**decimals:
                return np.asarray(near, np.int64)
    return None
