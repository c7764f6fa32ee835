"""Drawings of a kind that grow: circles, a plate with holes, scattered islands, one long outline, a page of letters."""

from __future__ import annotations

import io
import math
from collections.abc import Callable
from itertools import pairwise

import ezdxf
import numpy as np
from ezdxf.document import Drawing
from ezdxf.layouts import Modelspace

GRID = 10.0
"""mm from one circle, island or letter to the next."""


def circles(space: Modelspace, count: int) -> None:
    """Circles of 8 mm on a grid."""
    side = math.isqrt(count)
    for k in range(side * side):
        space.add_circle((GRID * (k % side) + 5, GRID * (k // side) + 5), 4)


def plate(space: Modelspace, count: int) -> None:
    """The same as holes of a plate."""
    circles(space, count)
    _rectangle(space, GRID * math.isqrt(count), 10.0)


def islands(space: Modelspace, count: int) -> None:
    """Five-pointed outlines of any size and turn, scattered over a plate, none of which meet."""
    chance, side = np.random.default_rng(count), math.isqrt(count)
    for k in range(side * side):
        size = chance.uniform(1.0, 4.0)
        middle = GRID * np.array([k % side, k // side]) + 5 + chance.uniform(-1, 1, 2) * (4.4 - size)
        angle = chance.uniform(0, math.tau) + math.tau * np.arange(10) / 10
        radius = size * np.where(np.arange(10) % 2, 0.6, 1.0)
        points = middle + (radius * np.array([np.cos(angle), np.sin(angle)])).T
        space.add_lwpolyline(points.tolist(), close=True)
    _rectangle(space, GRID * side, 10.0)


def outline(space: Modelspace, count: int) -> None:
    """One outline of about so many straight pieces: a comb, so that what it holds grows as it does."""
    space.add_lwpolyline(_comb(count).tolist(), close=True)


def spline(space: Modelspace, count: int) -> None:
    """One closed spline of about so many control points, along the same comb."""
    points = _comb(count)
    space.add_spline().set_closed([(x, y, 0.0) for x, y in points.tolist()])


def letters(space: Modelspace, count: int) -> None:
    """A page of letters (o, D, l and T in turn), each as an outline font has it: lines and quadratic splines."""
    side = math.isqrt(count)
    for k in range(side * side):
        middle = GRID * np.array([k % side, k // side]) + 5
        if k % 4 < 2:
            for width, height, shift in ((3.0, 4.0, 0.0), (1.8, 2.9, 0.5 * (k % 4))):
                _bowl(space, middle + [shift, 0.0], np.array([width, height]), closed_by_stem=k % 4 == 1)
        else:
            corners = _STEM if k % 4 == 2 else _T
            _lines(space, np.array([*corners, corners[0]]) + middle)


_STEM = ((-0.6, -4.0), (0.6, -4.0), (0.6, 4.0), (-0.6, 4.0))

_T = ((-0.6, -4.0), (0.6, -4.0), (0.6, 3.0), (3.0, 3.0), (3.0, 4.0), (-3.0, 4.0), (-3.0, 3.0), (-0.6, 3.0))


def _bowl(space: Modelspace, middle: np.ndarray, size: np.ndarray, closed_by_stem: bool) -> None:
    """Draw an ellipse of quadratic splines, or its right half and the line from its upper to its lower end."""
    count = 4 if closed_by_stem else 8
    angles = -math.pi / 2 + math.pi / 4 * np.arange(count + 1)
    on = middle + size * np.column_stack([np.cos(angles), np.sin(angles)])
    between = angles[:-1] + math.pi / 8
    off = middle + size / math.cos(math.pi / 8) * np.column_stack([np.cos(between), np.sin(between)])
    for first, handle, last in zip(on[:-1], off, on[1:], strict=True):
        space.add_open_spline([(x, y, 0.0) for x, y in np.array([first, handle, last]).tolist()], degree=2)
    if closed_by_stem:
        _lines(space, on[[-1, 0]])


def _lines(space: Modelspace, points: np.ndarray) -> None:
    for start, end in pairwise(points.tolist()):
        space.add_line(start, end)


def _comb(count: int) -> np.ndarray:
    """Return points (n, 2), some 1 mm apart, round a comb whose fingers have wavy sides."""
    up, across = np.arange(0.0, 41.0), np.arange(1.0, 10.0)
    wave = np.sin(up / 2)
    left, right = np.column_stack([wave, up]), np.column_stack([10 + wave, up])[::-1]
    tip = np.column_stack([across + wave[-1], np.full(len(across), 40.0)])
    base = np.column_stack([10 + across, np.zeros(len(across))])
    finger = np.concatenate([left, tip, right, base])
    fingers = max(1, count // len(finger))
    points = np.concatenate([finger + np.array([20.0 * k, 0.0]) for k in range(fingers)])
    return np.concatenate([points, [[20.0 * fingers, -10.0], [0.0, -10.0]]])


def _rectangle(space: Modelspace, side: float, beyond: float) -> None:
    far = side + beyond
    space.add_lwpolyline([(-beyond, -beyond), (far, -beyond), (far, far), (-beyond, far)], close=True)


def drawing(draw: Callable[[Modelspace, int], None], count: int) -> bytes:
    """Return a DXF of a kind."""
    document: Drawing = ezdxf.new("R2000", units=4)
    draw(document.modelspace(), count)
    text = io.StringIO()
    document.write(text)
    return text.getvalue().encode()
