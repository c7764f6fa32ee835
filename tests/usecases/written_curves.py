"""What the words of a program drive along, evaluated without any of our reader, our curves or our judge.

G0 to G3 in all planes with I, J, K from the start, G5.2 as LinuxCNC 2.9 drives it (`biarc` of its emccanon.cc), G6.2;
G20, G21, G17 to G19. Absolute coordinates, no offsets: what else moves the tool is refused.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BSpline
from scipy.spatial import cKDTree

Floats = NDArray[np.float64]

_COMMENT = re.compile(r"\(.*?\)|;.*|%")
_WORD = re.compile(r"([A-Z])\s*([-+]?(?:\d+\.?\d*|\.\d+))")
_AXES = {17: (0, 1, 2), 18: (2, 0, 1), 19: (1, 2, 0)}
_MOVES = (0, 1, 2, 3)
_IDLE = {4, 40, 49, 54, 61, 64, 80, 90, 91.1, 94}
"""G words that move nothing here and change nothing that is read here."""


@dataclass(frozen=True)
class Move:
    """One motion.

    Attributes:
        line: number of its last line, 1-based.
        rapid: whether it is G0.
        start, end: (3,) mm.
        at: places (k, 3) for k shares in [0, 1] of it.
        joints: shares at which its parts meet.
    """

    line: int
    rapid: bool
    start: Floats
    end: Floats
    at: Callable[[Floats], Floats]
    joints: Floats

    @property
    def length(self) -> float:
        """Length, nearly, mm."""
        return long(self.at(np.linspace(0, 1, 32 * len(self.joints))))


def long(places: Floats) -> float:
    """Return the length of a polyline, mm."""
    return float(np.sqrt((np.diff(places, axis=0) ** 2).sum(axis=1)).sum())


def moves_of(text: str) -> list[Move]:
    """Return the motions of a program whose first ones tell all axes of where they go."""
    reader = _Reader()
    for number, line in enumerate(text.splitlines(), 1):
        reader.take(number, _WORD.findall(_COMMENT.sub("", line.upper())))
    assert not reader.spline, "the spline is open at the end of the text"
    return reader.moves


class _Reader:
    """What the words so far have said."""

    def __init__(self) -> None:
        self.moves: list[Move] = []
        self.spline: list[dict[str, float]] = []
        self._at, self._motion, self._unit, self._axes, self._first = (
            np.full(3, np.nan),
            0.0,
            1.0,
            _AXES[17],
            np.zeros(3),
        )

    def take(self, number: int, found: list[tuple[str, str]]) -> None:
        """Do one line."""
        codes = {float(value) for letter, value in found if letter == "G"}
        words = {letter: float(value) for letter, value in found if letter != "G"}
        for code in codes:
            if code in _AXES:
                self._axes = _AXES[int(code)]
            elif code in (20, 21):
                self._unit = 25.4 if code == 20 else 1.0
            elif code in _MOVES or code in (5.2, 5.3, 6.2):
                self._motion = code
            else:
                assert code in _IDLE, f"line {number}: G{code:g}"
        if self._motion in (5.2, 6.2):
            self.spline.append(words)
            self._closed(number, self._motion == 6.2)
        elif self._motion == 5.3 and self.spline:
            self._add(number, *_biarcs(*self._controls(self.spline)))
        elif words.keys() & set("XYZIJK") and 4 not in codes:
            end = self._said(words, self._at)
            if self._motion < 2:
                self._add(number, end, lambda t, a=self._at, b=end: a + t[:, None] * (b - a))
            else:
                self._add(number, end, self._arc(end, words))

    def _said(self, words: dict[str, float], before: Floats) -> Floats:
        """Return the place that words say; axes that they leave out stay."""
        said = np.array([words.get(axis, math.nan) * self._unit for axis in "XYZ"])
        return np.where(np.isnan(said), before, said)

    def _add(self, number: int, end: Floats, at: Callable[[Floats], Floats], joints: Floats | None = None) -> None:
        joints = np.array([0.0, 1.0]) if joints is None else joints
        self.moves.append(Move(number, self._motion == 0, self._at, end, at, joints))
        self._at, self.spline = end, []

    def _arc(self, end: Floats, words: dict[str, float]) -> Callable[[Floats], Floats]:
        u, v, w = self._axes
        a, b = (complex(place[u], place[v]) for place in (self._at, end))
        offset = [words.get(letter, 0.0) * self._unit for letter in "IJK"]
        centre, start = a + complex(offset[u], offset[v]), self._at
        side = 1 if self._motion == 3 else -1
        sweep = side * float(np.angle((b - centre) / (a - centre))) % math.tau
        sweep = side * (sweep if sweep > 1e-12 else math.tau)
        grow = abs(b - centre) / abs(a - centre) - 1

        def at(t: Floats) -> Floats:
            own = centre + (a - centre) * (1 + grow * t) * np.exp(1j * sweep * t)
            places = np.empty((len(t), 3))
            places[:, u], places[:, v], places[:, w] = own.real, own.imag, start[w] + t * (end[w] - start[w])
            return places

        return at

    def _controls(self, lines: list[dict[str, float]], weight: str = "P") -> tuple[Floats, Floats]:
        """Return control points (k, 3), the first where the tool stands, and weights."""
        points, weights = [self._at], [lines[0].get(weight, 1.0)]
        for words in lines[1:]:
            if words.keys() & set("XYZ"):
                points.append(self._said(words, points[-1]))
                weights.append(words.get(weight, 1.0))
        return np.array(points), np.array(weights)

    def _closed(self, number: int, knotted: bool) -> None:
        """End the spline of G6.2 as soon as it has all its knots."""
        if not knotted or "K" not in self.spline[0]:
            return
        points, weights = self._controls(self.spline, "R")
        order = int(self.spline[0]["P"])
        if len(self.spline) < len(points) + order:
            return
        knots = np.array([words["K"] for words in self.spline])
        at = _nurbs(points, weights, knots, order - 1)
        self._add(
            number,
            points[-1],
            lambda t: at(knots[0] + t * (knots[-1] - knots[0])),
            np.unique(knots - knots[0]) / np.ptp(knots),
        )
        self._motion = math.nan


def _nurbs(points: Floats, weights: Floats, knots: Floats, degree: int) -> Callable[[Floats], Floats]:
    above = BSpline(knots, points * weights[:, None], degree)
    below = BSpline(knots, weights, degree)
    return lambda t: above(t) / below(t)[:, None]


def _biarcs(points: Floats, weights: Floats) -> tuple[Floats, Callable[[Floats], Floats], Floats]:
    """Return the end of a G5.2 of four control points, where it leads, and its joints: two arcs for each 16th of it."""
    assert len(points) == 4
    knots = np.array([0.0] * 4 + [1.0] * 4)
    ends = np.linspace(0, 1, 17)
    place = _nurbs(points, weights, knots, 3)(ends)
    above, below = (BSpline(knots, part, 3).derivative()(ends) for part in (points * weights[:, None], weights))
    slope = above - place * below[:, None]
    p, t = place[:, 0] + 1j * place[:, 1], slope[:, 0] + 1j * slope[:, 1]
    t = t / np.where(t == 0, 1, np.abs(t))
    way = p[:-1] - p[1:]
    a = 2 * ((t[:-1] * t[1:].conj()).real - 1)
    b = 2 * (way * (t[:-1] + t[1:]).conj()).real
    c = np.abs(way) ** 2
    root = np.sqrt(b * b - 4 * a * c)
    assert np.all(root - b > 1e-3 * np.sqrt(c)), "a spline that turns back within a step"
    beta = 2 * c / (root - b)
    one, two = p[:-1] + beta * t[:-1], p[1:] - beta * t[1:]
    start = np.column_stack([p[:-1], (one + two) / 2]).ravel()
    end = np.append(start[1:], p[-1])
    along = np.column_stack([t[:-1], (two - one) / np.where(two == one, 1, np.abs(two - one))]).ravel()
    half = np.where(along == 0, 0, np.angle((end - start) / np.where(along == 0, 1, along)))

    def at(share: Floats) -> Floats:
        k = np.minimum((share * len(start)).astype(int), len(start) - 1)
        f, turn = share * len(start) - k, half[k]
        straight = np.abs(turn) < 1e-9
        size = np.where(straight, f, np.sin(f * turn) / np.where(straight, 1, np.sin(turn)))
        own = start[k] + (end[k] - start[k]) * size * np.exp(1j * (f - 1) * turn)
        return np.column_stack([own.real, own.imag, np.full(len(own), points[0, 2])])

    return points[-1], at, np.linspace(0, 1, len(start) + 1)


def along(moves: list[Move], count: int) -> Floats:
    """Return some `count` places of motions, in order, all joints among them."""
    assert all(np.array_equal(one.end, two.start) for one, two in pairwise(moves))
    sizes = np.array([move.length for move in moves])
    each = np.ceil(count * sizes / max(sizes.sum(), 1e-300)).astype(int)
    shares = [np.union1d(np.linspace(0, 1, n + 1), move.joints) for move, n in zip(moves, each, strict=True)]
    return np.concatenate([move.at(share)[k > 0 :] for k, (move, share) in enumerate(zip(moves, shares, strict=True))])


def spread(points: Floats, count: int) -> Floats:
    """Return some `count` places of a polyline, in order, its points among them."""
    sizes = np.sqrt((np.diff(points, axis=0) ** 2).sum(axis=1))
    each = np.maximum(np.ceil(count * sizes / sizes.sum()).astype(int), 1)
    chord = np.repeat(np.arange(len(each)), each)
    share = (np.arange(len(chord)) - np.repeat(np.cumsum(each) - each, each)) / each[chord]
    return np.vstack([points[chord] + share[:, None] * (points[chord + 1] - points[chord]), points[-1:]])


def off(places: Floats, line: Floats) -> Floats:
    """Return the distance of places (n, 3) from a polyline (m, 3) of many short chords: the chords at its nearest
    point, mm.

    It is never less than the true one, and more only where another chord is nearer whose ends are farther.
    """
    near = cKDTree(line, balanced_tree=False, compact_nodes=False).query(places)[1]
    return np.minimum(
        _apart(places, line, np.maximum(near - 1, 0)), _apart(places, line, np.minimum(near, len(line) - 2))
    )


def _apart(places: Floats, line: Floats, chord: NDArray[np.int64]) -> Floats:
    a = line[chord]
    way, to = line[chord + 1] - a, places - a
    share = np.clip((to * way).sum(axis=1) / np.maximum((way * way).sum(axis=1), 1e-300), 0, 1)
    apart: Floats = np.sqrt(((to - share[:, None] * way) ** 2).sum(axis=1))
    return apart


def in_order(one: Floats, two: Floats, limit: float) -> bool:
    """Tell whether two walkers can go along both rows of places, never back, and stay within a limit of one another."""
    columns = np.arange(len(two))
    reached = columns == 0
    reached[1:] = False
    for k, place in enumerate(one):
        free = ((two - place) ** 2).sum(axis=1) <= limit * limit
        seed = reached if k == 0 else reached | np.append(False, reached[:-1])
        last = np.maximum.accumulate(np.where(seed & free, columns, -1))
        wall = np.maximum.accumulate(np.where(free, -1, columns))
        reached = free & (last > wall)
        if not reached.any():
            return False
    return bool(reached[-1])
