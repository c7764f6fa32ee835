"""Small pictures for a table of parts: outlines and paths seen from above, a few kilobytes each, coloured by the page
that they stand in.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...geometry.primitives import Rows, boxes, contour_rows, samples
from ...model.motion import MotionKind, Motions
from ...model.motion_path import motion_rows, spline_points
from ...model.moves import MoveKind, Program
from ...toolpath.coverage.areas import move_rows

WIDTH, HEIGHT = 160, 110
"""Pixels of a whole picture."""

MARGIN = 4
"""Pixels round what is drawn."""
MOST_POINTS = 4_000
"""Of a picture; where there would be more it is drawn more coarsely."""

_FINEST = 4.0
"""Steps of the raster of points a pixel, at the finest."""


@dataclass(frozen=True)
class ThumbnailLine:
    """Lines of one look.

    Attributes:
        look: class that the page colours it by.
        rows: (n, 8), mm; where one does not begin at the end of the one before, the pen is lifted.
    """

    look: str
    rows: Rows


def part_picture(program: Program) -> str:
    """Return the small picture of a made program: what was drawn, and the paths."""
    moves = program.moves
    contours = [contour_rows(contour) for region in program.regions for contour in region.contours]
    outline = _joined([*contours, *map(contour_rows, program.lines)])
    cuts = move_rows(moves)[(moves.kind != MoveKind.RAPID) & np.any(moves.start[:, :2] != moves.end[:, :2], axis=1)]
    return thumbnail((ThumbnailLine("path", cuts), ThumbnailLine("part", outline)))


def motions_picture(motions: Motions) -> str:
    """Return the small picture of a program that was read: where it cuts."""
    rows, kind = motion_rows(motions), motions.kind
    shown = (kind != MotionKind.RAPID) & (kind != MotionKind.SPLINE) & np.all(np.isfinite(rows), axis=1)
    splines = [_chords(spline_points(spline)[:, :2]) for spline in motions.splines.values()]
    return thumbnail((ThumbnailLine("path", _joined([rows[shown], *splines])),))


def _chords(points: NDArray[np.float64]) -> Rows:
    return np.column_stack([points[:-1], points[1:], np.zeros((len(points) - 1, 4))])


def _joined(rows: Sequence[Rows]) -> Rows:
    return np.concatenate([np.zeros((0, 8)), *rows])


def thumbnail(lines: Sequence[ThumbnailLine]) -> str:
    """Return lines as SVG text without colours; "" where there is nothing to see."""
    lines = [each for each in lines if len(each.rows)]
    if not lines:
        return ""
    box = np.concatenate([boxes(each.rows) for each in lines])
    low, high = box[:, :2].min(axis=0), box[:, 2:].max(axis=0)
    size = np.maximum(high - low, 1e-9)
    scale = float(min((WIDTH - 2 * MARGIN) / size[0], (HEIGHT - 2 * MARGIN) / size[1]))
    shift = np.array([WIDTH, HEIGHT]) / 2 - np.array([1.0, -1.0]) * scale * (low + high) / 2
    chains = [(each.look, *_pixels(each.rows, scale, shift)) for each in lines]
    finest, count = _FINEST, MOST_POINTS + 1
    while count > MOST_POINTS:
        drawn = [(look, list(_strokes(points, lifted, finest))) for look, points, lifted in chains]
        count = sum(len(stroke) for _, strokes in drawn for stroke in strokes)
        finest /= 2
    body = "".join(f'<path class="{look}" d="{_data(strokes)}"/>' for look, strokes in drawn if strokes)
    return f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" height="{HEIGHT}">{body}</svg>'


def _pixels(rows: Rows, scale: float, shift: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Return points (n, 2) in pixels, y down, and at which of them the pen comes down anew."""
    index, points = samples(rows, 0.25 / scale)
    starts = np.flatnonzero(np.append(True, np.any(np.abs(rows[1:, :2] - rows[:-1, 2:4]) * scale > 0.05, axis=1)))
    pieces = np.split(np.arange(len(rows)), starts[1:])
    ends = np.array([piece[-1] for piece in pieces])
    after = np.searchsorted(index, ends, side="right")
    points = np.insert(points, after, rows[ends, 2:4], axis=0)  # samples leave the end of a row to the next one
    begins = np.searchsorted(index, starts) + np.arange(len(starts))
    lifted = np.zeros(len(points), bool)
    lifted[begins] = True
    return points * scale * np.array([1.0, -1.0]) + shift, lifted


def _strokes(points: NDArray[np.float64], lifted: NDArray[np.bool_], finest: float) -> Iterator[NDArray[np.float64]]:
    """Yield connected points on a raster of `finest` steps a pixel, none twice in a row."""
    raster = np.round(points * finest) / finest
    kept = lifted | np.append(True, np.any(raster[1:] != raster[:-1], axis=1))
    for stroke in np.split(raster[kept], np.flatnonzero(lifted[kept])[1:]):
        if len(stroke) > 1:
            yield stroke


def _data(strokes: Sequence[NDArray[np.float64]]) -> str:
    return "".join("M" + " ".join(f"{x:g},{y:g}" for x, y in stroke.tolist()) for stroke in strokes)
