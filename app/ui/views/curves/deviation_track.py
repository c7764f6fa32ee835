"""The deviation of a smoothed program, stretch after stretch. No Qt."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ....fitting.point_curves.deviation import deviation
from ..nc.motion_shapes import Floats, Ints

if TYPE_CHECKING:
    from ....usecases.smoothing.result import SmoothedProgram, SmoothedStretch


@dataclass(frozen=True)
class DeviationSample:
    """One sample: where it is, mm; how far curve and moves are apart there, mm; the line of the old text that it
    answers to.
    """

    along: float
    off: float
    place: tuple[float, float, float]
    line: int


@dataclass(frozen=True, eq=False)
class DeviationTrack:
    """k samples along all stretches that changed; between two stretches lies one that is not a number.

    Attributes:
        along: (k,) mm along these stretches. off: (k,) mm. place: (k, 3) mm. line: (k,) of the old text, 1-based.
        bounds: of each such stretch where it begins and ends, and the bound that is proven for it, mm.
    """

    along: Floats
    off: Floats
    place: Floats
    line: Ints
    bounds: tuple[tuple[float, float, float], ...]

    def near(self, along: float) -> DeviationSample | None:
        """Return the sample nearest to a place along the stretches; None where there is none."""
        known = np.flatnonzero(np.isfinite(self.off))
        return self._spot(known, np.abs(self.along[known] - along)) if len(known) else None

    def farthest(self) -> DeviationSample | None:
        """Return where curve and moves are farthest apart."""
        known = np.flatnonzero(np.isfinite(self.off))
        return self._spot(known, -self.off[known]) if len(known) else None

    def _spot(self, known: Ints, cost: Floats) -> DeviationSample:
        k = known[int(np.argmin(cost))]
        x, y, z = self.place[k].tolist()
        return DeviationSample(float(self.along[k]), float(self.off[k]), (x, y, z), int(self.line[k]))


def track_of(done: SmoothedProgram) -> DeviationTrack:
    """Return the deviation of a smoothed program along its stretches."""
    parts: list[tuple[Floats, Floats, Floats, Ints]] = []
    bounds: list[tuple[float, float, float]] = []
    at = 0.0
    for piece in done.pieces:
        if piece.curve is None or piece.judgement is None or piece.judgement.feet is None:
            continue
        found = deviation(piece.curve, piece.points, piece.judgement.feet)
        lines = done.before.motions.line[_rows(piece)].astype(np.int64)
        parts.append((at + found.along, found.off, found.place, lines[found.chord]))
        parts.append((parts[-1][0][-1:], np.array([np.nan]), found.place[-1:], lines[-1:]))
        end = float(parts[-1][0][0])
        bounds.append((at, end, piece.judgement.bound))
        at = end
    if not parts:
        return DeviationTrack(np.zeros(0), np.zeros(0), np.zeros((0, 3)), np.zeros(0, np.int64), ())
    along, off, place, line = (np.concatenate(column) for column in zip(*parts, strict=True))
    return DeviationTrack(along, off, place, line, tuple(bounds))


def _rows(piece: SmoothedStretch) -> Ints:
    """Return the motion of the old program that each chord of a stretch is."""
    moved = np.any(np.diff(piece.stretch.points, axis=0) != 0, axis=1)
    return piece.stretch.first + np.flatnonzero(moved)


def pieces_of_lines(done: SmoothedProgram, lines: Ints, notes: int) -> Ints:
    """Return which stretch each of some lines of the new text is of, -1 = none.

    Args:
        done: the smoothed program.
        lines: (k,) 1-based.
        notes: lines that the certificate takes before them.
    """
    shift, first, last = notes, [], []
    for piece in done.pieces:
        stretch = piece.stretch
        span = stretch.last_line - stretch.first_line + 1
        now = span if piece.judgement is None else piece.blocks[1]
        first.append(stretch.first_line + shift)
        last.append(stretch.first_line + shift + now - 1)
        shift += now - span
    if not first:
        return np.full(len(lines), -1)
    at = np.searchsorted(np.array(first), lines, side="right") - 1
    return np.where((at >= 0) & (lines <= np.array(last)[at]), at, -1)
