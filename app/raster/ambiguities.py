"""The places of a line drawing where its pixels alone cannot tell what is meant.

Where lines nearly close, end, meet or run into one another, another reading is as good: such places are listed, not
guessed away.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from .border import borders_of
from .trace import PixelChain
from .walls import Mask

_MERGED = 1.6
"""Times the usual thickness of a figure's lines; where ink is thicker, two lines may have become one."""

_LONG = 4
"""Pixels; paper of unusual width that is shorter than this is the shape of a corner; ink is by two thicknesses
longer.
"""

_GAP = 2
"""Pixels; gaps in lines, and between lines, up to this wide are told."""

_FACE = 9
"""Pixels; a smaller area of paper is no face worth a word."""

_HOLE = 12
"""Pixels round a hole in ink; one that is no longer than this is no face either."""

Place = tuple[float, float]
"""Column and row, px; the centre of a pixel is its number + 0.5."""


class AmbiguityKind(Enum):
    """Why a place can be read in two ways."""

    GAP = "a line ends short of another; closing it would part an area"
    OPEN = "a line that encloses nothing ends"
    JUNCTION = "lines meet, so that more than two areas share a border"
    MERGED = "the line is twice as thick as elsewhere; two lines may have run into one"
    NARROW = "two lines are less than two pixels apart"


@dataclass(frozen=True, slots=True)
class Ambiguity:
    """One such place.

    Attributes:
        col, row: a pixel's middle, px: of ink, or of the gap that it is about. others: of an open line the other ends.
    """

    kind: AmbiguityKind
    col: float
    row: float
    others: tuple[Place, ...] = ()

    @property
    def counts(self) -> bool:
        """What is machined is likely not what was drawn."""
        return self.kind in (AmbiguityKind.GAP, AmbiguityKind.OPEN)

    @property
    def where(self) -> str:
        """The pixel in words."""
        return pixel_words((self.col, self.row))


def pixel_words(place: Place) -> str:
    """Return which pixel a place lies in, counted from 0 at the left and at the top, as every sentence counts."""
    return f"column {math.floor(place[0])}, row {math.floor(place[1])}"


def ambiguities(ink: Mask) -> tuple[Ambiguity, ...]:
    """Return the places where lines of ink can be read in two ways, in raster order for each kind of doubt; what counts
    comes first.
    """
    gaps = tuple(_gaps(ink))
    return (*gaps, *_open(ink, gaps), *_junctions(ink), *_merged(ink), *_narrow(ink))


def _middles(marked: Mask, ambiguity: AmbiguityKind) -> Iterator[Ambiguity]:
    """Yield one place for each connected spot of marked pixels: that of its pixels that is nearest to its middle."""
    import cv2

    count, label, _, centres = cv2.connectedComponentsWithStats(marked.astype(np.uint8), connectivity=8)
    if count < 2:
        return
    pixels = np.argwhere(marked)
    own = label[tuple(pixels.T)]
    away = np.sum((pixels[:, ::-1] - centres[own]) ** 2, axis=1)
    order = np.lexsort((away, own))
    for row, col in pixels[order[np.unique(own[order], return_index=True)[1]]].tolist():
        yield Ambiguity(ambiguity, col + 0.5, row + 0.5)


def _junctions(ink: Mask) -> Iterator[Ambiguity]:
    """Yield where three faces or more meet: every ink pixel is given to its nearest face."""
    import cv2

    padded = np.pad(~ink, 1, constant_values=True)
    count, face = cv2.connectedComponents(padded.astype(np.uint8), connectivity=4)
    if count < 4:
        return
    _, near = cv2.distanceTransformWithLabels(
        (~padded).astype(np.uint8), cv2.DIST_L2, 5, labelType=cv2.DIST_LABEL_PIXEL
    )
    of_label = np.zeros(int(near.max()) + 1, np.int32)
    of_label[near[padded]] = face[padded]
    owner = of_label[near]
    four = np.sort(np.stack([owner[:-1, :-1], owner[:-1, 1:], owner[1:, :-1], owner[1:, 1:]]), axis=0)
    meet = (np.count_nonzero(np.diff(four, axis=0), axis=0) >= 2)[:-1, :-1]
    yield from _middles(
        ink & (cv2.dilate(meet.astype(np.uint8), np.ones((5, 5), np.uint8)) != 0), AmbiguityKind.JUNCTION
    )


def _merged(ink: Mask) -> Iterator[Ambiguity]:
    """Yield where ink is much thicker than the lines of the same figure are for most of their length."""
    import cv2

    figure = np.asarray(cv2.connectedComponents(ink.astype(np.uint8), connectivity=8)[1], np.int32)
    thickness = thickness_px(ink)
    usual = usual_thickness(thickness, figure)
    thick = ink & (thickness >= np.maximum(_MERGED * usual, usual + 1)[figure])
    yield from _middles(_of_length(thick, np.maximum((_LONG + 2 * usual)[figure], 2 * thickness)), AmbiguityKind.MERGED)


def _of_length(spots: Mask, least: NDArray[np.float64]) -> Mask:
    """Return the spots that are at least so many pixels long.

    Args:
        least: (rows, cols), px; the largest of a spot counts.
    """
    import cv2

    count, label, stats, _ = cv2.connectedComponentsWithStats(spots.astype(np.uint8), connectivity=8)
    need = np.zeros(count)
    np.maximum.at(need, np.asarray(label[spots], np.int64), least[spots])
    return np.asarray((np.maximum(stats[:, cv2.CC_STAT_WIDTH], stats[:, cv2.CC_STAT_HEIGHT]) >= need)[label] & spots)


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
    yield from _middles(np.isin(spot, telling), AmbiguityKind.GAP)


def _narrow(ink: Mask) -> Iterator[Ambiguity]:
    """Yield where paper between lines is one pixel wide for longer than a line is thick."""
    paper = np.pad(~ink, 1, constant_values=True)
    wide = paper[:-1, :-1] & paper[:-1, 1:] & paper[1:, :-1] & paper[1:, 1:]
    held = wide[:-1, :-1] | wide[:-1, 1:] | wide[1:, :-1] | wide[1:, 1:]
    yield from _middles(_of_length(~ink & ~held, np.full(ink.shape, float(_LONG))), AmbiguityKind.NARROW)


def _open(ink: Mask, gaps: tuple[Ambiguity, ...]) -> Iterator[Ambiguity]:
    """Yield each line that encloses nothing, at one of its ends, unless all of them lie at gaps that are told."""
    reported = np.array([(gap.col, gap.row) for gap in gaps]).reshape(-1, 2)
    for chain, thickness in _strands(ink):
        ends = _ends(chain, thickness)
        near = [np.any(np.hypot(*(reported - end).T) <= _GAP + 2 + thickness) for end in ends]
        if ends and not all(near):
            yield Ambiguity(AmbiguityKind.OPEN, *ends[0], ends[1:])


def _strands(ink: Mask) -> Iterator[tuple[PixelChain, float]]:
    """Yield outline and mean thickness, px, of each connected figure of ink that encloses no face."""
    import cv2

    _, figure, stats, _ = cv2.connectedComponentsWithStats(ink.astype(np.uint8), connectivity=8)
    outlines: dict[int, list[PixelChain]] = {}
    for border in borders_of(ink):
        outlines.setdefault(int(figure[border.chain.start]), []).append(border.chain)
    for own, chains in outlines.items():
        *holes, chain = sorted(chains, key=lambda each: len(each.directions))
        if all(len(hole.directions) <= _HOLE for hole in holes):
            yield chain, max(2 * float(stats[own, cv2.CC_STAT_AREA]) / max(len(chain.directions), 1), 1.0)


def _ends(chain: PixelChain, thickness: float) -> tuple[Place, ...]:
    """Return the ends of a strand: where its outline, two thicknesses on, has come back to where it was two before.

    A spot that is hardly longer than thick has none.
    """
    pixels, reach = chain.pixels()[:-1], max(math.ceil(2 * thickness), 3)
    if len(pixels) < 4 * reach:
        return ()
    back = np.hypot(*(np.roll(pixels, reach, axis=0) - np.roll(pixels, -reach, axis=0)).T) <= 1.25 * thickness + 0.5
    if back.all() or not back.any():
        return ()
    turn = int(np.flatnonzero(~back)[0])
    at = np.flatnonzero(np.roll(back, -turn)) + turn
    runs = np.split(at, np.flatnonzero(np.diff(at) != 1) + 1)
    return tuple(
        (float(col) + 0.5, float(row) + 0.5) for row, col in (pixels[run[len(run) // 2] % len(pixels)] for run in runs)
    )


Thickness = NDArray[np.float32]
"""Of ink at each pixel, px."""


def thickness_px(ink: Mask) -> Thickness:
    """Return how thick ink is at each of its pixels, px; 0 on paper.

    It is the shortest way through the ink along rows, columns or diagonals, from the pixel or one of its neighbours: of
    a stair one step is thick and the next is not. A line of n pixels has n, and at most half of it more where it runs
    aslant; where lines cross, the corners between them keep the diagonals short.
    """
    import cv2

    padded = np.pad(ink, ((1, 2), (1, 1)))
    flat, cols = padded.ravel(), padded.shape[1]
    ways = ((1, 1.0), (cols, 1.0), (cols + 1, np.sqrt(2)), (cols - 1, np.sqrt(2)))
    thickness = np.full(flat.shape, np.inf, np.float32)
    for step, length in ways:
        np.minimum(thickness, _runs(flat, step) * np.float32(length), out=thickness)
    thickness[~flat] = np.inf
    least = cv2.erode(thickness.reshape(padded.shape), np.ones((3, 3), np.uint8))[1:-2, 1:-1]
    return np.where(ink, least, np.float32(0))


def _runs(flat: Mask, step: int) -> NDArray[np.int32]:
    """Return for each pixel how many pixels of ink follow one another through it, each `step` further on in the raster;
    0 on paper.
    """
    rows = -(-len(flat) // step) + 1
    lined = np.zeros(rows * step, np.bool_)
    lined[: len(flat)] = flat
    down = np.ascontiguousarray(lined.reshape(rows, step).T).ravel()
    at = np.flatnonzero(down)
    first = np.flatnonzero(np.diff(at, prepend=-2) != 1)
    counts = np.diff(np.append(first, len(at)))
    lengths = np.zeros(down.shape, np.int32)
    lengths[at] = np.repeat(counts, counts)
    return np.ascontiguousarray(lengths.reshape(step, rows).T).ravel()[: len(flat)]


def usual_thickness(thickness: Thickness, figure: NDArray[np.int32]) -> NDArray[np.float64]:
    """Return how thick each figure's lines are for half of their length at most, px, by the figure's number; 0 for
    number 0.

    Args:
        thickness: (rows, cols) of ink. figure: (rows, cols) number of the connected figure that ink belongs to, 0 =
            paper.
    """
    usual = np.zeros(int(figure.max(initial=0)) + 1)
    inked = figure > 0
    own, thick = figure[inked], thickness[inked].astype(np.float64)
    order = np.lexsort((thick, own))
    own, thick = own[order], thick[order]
    length = np.cumsum(1 / thick)
    numbers, first = np.unique(own, return_index=True)
    if len(numbers):
        ends = length[np.append(first[1:], len(own)) - 1]
        begins = np.append(0.0, ends[:-1])
        usual[numbers] = thick[np.searchsorted(length, (begins + ends) / 2 - 1e-9)]
    return usual
