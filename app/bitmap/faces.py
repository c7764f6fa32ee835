"""What a picture's ink encloses, and the places where its pixels alone cannot tell.

A picture has no vectors to count crossings of, so its faces (connected areas of paper) are told apart by how deep they
are nested in lines: one line in, area; two lines in, island. Where lines meet, run into one another or nearly close,
another reading is as good: such places are listed, not guessed away.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from app.bitmap.peel import distance_px
from app.bitmap.picture import Shows
from app.bitmap.walls import Mask

_THIN = 6.0
"""Pixels; ink that is nowhere thicker is lines."""

_SLENDER = 20
"""Times a line's width; what lines draw is longer."""

_MERGED = 1.5
"""Times the usual thickness of lines; where ink is thicker, two lines may have become one."""

_LONG = 4
"""Pixels; paper or ink of unusual width that is shorter than this is the shape of a corner."""

_GAP = 2
"""Pixels; gaps in lines, and between lines, up to this wide are told."""

_FACE = 9
"""Pixels; a smaller area of paper is no face worth a word."""


class Doubt(Enum):
    """Why a place can be read in two ways."""

    JUNCTION = "lines meet, so that more than two areas share a border"
    MERGED = "the line is twice as thick as elsewhere; two lines may have run into one"
    GAP = "a line ends short of another; closing it would part an area"
    NARROW = "two lines are less than two pixels apart"


@dataclass(frozen=True, slots=True)
class Ambiguity:
    """One such place: column and row of its middle, px (centre of a pixel = its number + 0.5)."""

    doubt: Doubt
    col: float
    row: float


def shows(ink: Mask, asked: Shows) -> Shows:
    """Return whether ink is lines or areas, where nobody said.

    Lines are thin everywhere, or most of their ink is narrower than a small part of the largest figure it makes and they
    enclose more paper than they cover: a bar is thin too, but encloses nothing.
    """
    if asked is not Shows.AUTO:
        return asked
    depth = distance_px(ink)
    if 2 * float(depth.max(initial=0.0)) <= _THIN:
        return Shows.LINES
    count = np.count_nonzero(ink)
    slender = 2 * np.count_nonzero(_opened(depth, max(_THIN, _largest(ink) / _SLENDER) / 2)) < count
    return Shows.LINES if slender and np.count_nonzero(inner_faces(ink)) > count else Shows.AREAS


def _largest(ink: Mask) -> int:
    """Return the longer side of the largest connected figure of ink, px."""
    import cv2

    stats = cv2.connectedComponentsWithStats(ink.astype(np.uint8), connectivity=8)[2]
    return int(stats[1:, [cv2.CC_STAT_WIDTH, cv2.CC_STAT_HEIGHT]].max(initial=0))


def _opened(depth: NDArray[np.float32], radius: float) -> Mask:
    """Return what an opening by a disc leaves of ink that is that deep, px."""
    rim = int(radius) + 1
    away = distance_px(np.pad(depth <= radius, rim, constant_values=True))[rim:-rim, rim:-rim]
    opened: Mask = (depth > 0) & (away < radius)
    return opened


def inner_faces(ink: Mask) -> Mask:
    """Return the paper that lines enclose: faces nested in an odd number of lines.

    A line that encloses several faces side by side counts as one line round each of them.
    """
    import cv2

    padded = np.pad(~ink, 1, constant_values=True)
    _, face = cv2.connectedComponents(padded.astype(np.uint8), connectivity=4)
    _, line = cv2.connectedComponents((~padded).astype(np.uint8), connectivity=8)
    depth = _depths(np.asarray(face, np.int32), np.asarray(line, np.int32))
    inside: Mask = (depth[face] % 2 == 1)[1:-1, 1:-1] & ~ink
    return inside


def _depths(face: NDArray[np.int32], line: NDArray[np.int32]) -> NDArray[np.int64]:
    """Return how many lines each face is nested in; the face at the picture's corner is outside of all."""
    pairs = np.concatenate([_touching(face, line), _touching(face.T, line.T)])
    pairs = np.unique(pairs, axis=0)
    depth = np.full(int(face.max()) + 1, -1, np.int64)
    depth[face[0, 0]] = 0
    reached = np.zeros(int(line.max()) + 1, np.bool_)
    front = np.array([face[0, 0]])
    while len(front):
        lines = np.unique(pairs[np.isin(pairs[:, 0], front), 1])
        lines = lines[~reached[lines]]
        reached[lines] = True
        level = depth[front[0]] + 1
        front = np.unique(pairs[np.isin(pairs[:, 1], lines), 0])
        front = front[depth[front] < 0]
        depth[front] = level
    return depth


def _touching(face: NDArray[np.int32], line: NDArray[np.int32]) -> NDArray[np.int32]:
    """Return (face, line) of all pixels side by side in a row, of which one is paper and one ink."""
    a = np.stack([face[:, :-1].ravel(), line[:, 1:].ravel()], 1)
    b = np.stack([face[:, 1:].ravel(), line[:, :-1].ravel()], 1)
    both = np.concatenate([a, b])
    return both[(both[:, 0] > 0) & (both[:, 1] > 0)]


def ambiguities(ink: Mask) -> tuple[Ambiguity, ...]:
    """Return the places where lines of ink can be read in two ways, in raster order for each kind of doubt."""
    return (*_junctions(ink), *_merged(ink), *_gaps(ink), *_narrow(ink))


def _middles(marked: Mask, doubt: Doubt) -> Iterator[Ambiguity]:
    """Yield one place for each connected spot of marked pixels."""
    import cv2

    count, _, _, centres = cv2.connectedComponentsWithStats(marked.astype(np.uint8), connectivity=8)
    for k in range(1, count):
        yield Ambiguity(doubt, float(centres[k, 0]) + 0.5, float(centres[k, 1]) + 0.5)


def _junctions(ink: Mask) -> Iterator[Ambiguity]:
    """Yield where three faces or more meet: every ink pixel is given to its nearest face."""
    import cv2

    padded = np.pad(~ink, 1, constant_values=True)
    count, face = cv2.connectedComponents(padded.astype(np.uint8), connectivity=4)
    if count < 4:
        return
    _, near = cv2.distanceTransformWithLabels((~padded).astype(np.uint8), cv2.DIST_L2, 5, labelType=cv2.DIST_LABEL_PIXEL)
    of_label = np.zeros(int(near.max()) + 1, np.int32)
    of_label[near[padded]] = face[padded]
    owner = of_label[near]
    four = np.sort(np.stack([owner[:-1, :-1], owner[:-1, 1:], owner[1:, :-1], owner[1:, 1:]]), axis=0)
    meet = (np.count_nonzero(np.diff(four, axis=0), axis=0) >= 2)[:-1, :-1]
    yield from _middles(np.asarray(cv2.dilate(meet.astype(np.uint8), np.ones((5, 5), np.uint8)) != 0), Doubt.JUNCTION)


def _merged(ink: Mask) -> Iterator[Ambiguity]:
    """Yield where ink is much thicker than its lines are in the mean."""
    import cv2

    if not ink.any():
        return
    depth = distance_px(ink)
    ridge = ink & (depth >= cv2.dilate(depth, np.ones((3, 3), np.uint8)))
    usual = 2 * float(np.median(depth[ridge])) - 1
    if usual <= 1:  # two lines of one pixel are two pixels wide, which distances between centres do not tell
        thick = cv2.morphologyEx(ink.astype(np.uint8), cv2.MORPH_OPEN, np.ones((2, 2), np.uint8)) != 0
    else:
        thick = ridge & (2 * depth - 1 >= max(_MERGED * usual, usual + 1.5))
    yield from _middles(_of_length(np.asarray(thick)), Doubt.MERGED)


def _of_length(spots: Mask) -> Mask:
    """Return the spots that are at least _LONG pixels long."""
    import cv2

    _, label, stats, _ = cv2.connectedComponentsWithStats(spots.astype(np.uint8), connectivity=8)
    long = np.maximum(stats[:, cv2.CC_STAT_WIDTH], stats[:, cv2.CC_STAT_HEIGHT]) >= _LONG
    long[0] = False
    return np.asarray(long[label], np.bool_)


def _gaps(ink: Mask) -> Iterator[Ambiguity]:
    """Yield where closing a gap would part a face in two."""
    import cv2

    kernel = np.ones((_GAP + 1, _GAP + 1), np.uint8)
    closed = cv2.morphologyEx(np.pad(ink, 4).astype(np.uint8), cv2.MORPH_CLOSE, kernel)[4:-4, 4:-4] != 0
    added = closed & ~ink
    _, before = cv2.connectedComponents((~ink).astype(np.uint8), connectivity=4)
    count, after, stats, _ = cv2.connectedComponentsWithStats((~closed).astype(np.uint8), connectivity=4)
    large = np.flatnonzero(stats[:, cv2.CC_STAT_AREA] >= _FACE)
    large = large[large > 0]
    first = np.zeros(count, np.int64)
    first[after.ravel()] = np.arange(after.size)
    old = before.ravel()[first[large]]
    parted = large[np.isin(old, [face for face in np.unique(old) if np.sum(old == face) > 1])]
    spots, spot = cv2.connectedComponents(added.astype(np.uint8), connectivity=8)
    beside: list[set[int]] = [set() for _ in range(spots)]
    grown = np.where(np.isin(after, parted), after, 0)
    for dr, dc in ((0, 1), (0, -1), (1, 0), (-1, 0)):
        other = np.roll(grown, (dr, dc), (0, 1))
        chosen = added & (other > 0)
        for own, face in {*zip(spot[chosen].tolist(), other[chosen].tolist(), strict=True)}:
            beside[own].add(face)
    telling = [k for k in range(1, spots) if len(beside[k]) > 1]
    yield from _middles(np.isin(spot, telling), Doubt.GAP)


def _narrow(ink: Mask) -> Iterator[Ambiguity]:
    """Yield where paper between lines is one pixel wide for longer than a line is thick."""
    paper = np.pad(~ink, 1, constant_values=True)
    wide = paper[:-1, :-1] & paper[:-1, 1:] & paper[1:, :-1] & paper[1:, 1:]
    held = wide[:-1, :-1] | wide[:-1, 1:] | wide[1:, :-1] | wide[1:, 1:]
    yield from _middles(_of_length(~ink & ~held), Doubt.NARROW)
