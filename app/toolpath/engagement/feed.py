"""The feed follows the engagement: where more of the cutter is engaged than its operation allows, the move is cut and
slowed there.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.progress import NO_PROGRESS, Progress
from ...geometry.primitives import points_at
from ...model.job import Job
from ...model.moves import MoveKind, Moves, Program
from ...model.tool import LEAST_RATE
from ..coverage.areas import move_rows
from .engagement import EngagementSamples, sample_engagement, spans
from .places import BLOCK, Floats, Indices

LEAST_FEED = 0.3
"""Part of the tool's feed; the cutter would rub if it were slowed more."""

_STEPS = 20
"""Of the tool's feed, so that the feed does not change all the time."""

_GAIN = 0.05
"""Part of a piece's time that cutting it must save, and no less than a radius takes at full feed."""

_SLACK = 1e-6
"""Rounding, of a share: what comes to a whole number of steps but for that is one."""


def followed(program: Program, job: Job, progress: Progress = NO_PROGRESS) -> Program:
    """Return the program with its feed slowed where more of the cutter is engaged than the operation allows.

    There the feed is the tool's times allowed / engaged, in steps of 5 % rounded down, so that no more metal is cut in
    a time than at the limit; never below LEAST_FEED of the tool's feed nor below LEAST_RATE, and never faster than it
    was. What is over the limit by less than the measure may be off (`Engagement.bounds`) is not slowed. A move that is
    over it in part is cut in pieces of half a radius or more where that saves time; the path stays the same, and
    following it once more changes nothing.

    Raises:
        ParameterError: the job has no such tool.
        Cancelled: by progress.
    """
    moves = program.moves
    limits = np.array([operation.engagement_limit for operation in job.operations] or [1.0])[moves.operation]
    if not np.any((limits < 1) & (moves.kind != MoveKind.RAPID)):
        return program
    seen = sample_engagement(program, job, progress.part(0.0, 0.9))
    going, low, high, blocks = _blocks(seen)
    if not len(going):
        return program
    count = high - low
    owner = np.repeat(going, count)
    block = np.arange(len(owner)) + np.repeat(low - (np.cumsum(count) - count), count)
    allowed = _allowed(_Parts(owner, blocks.share[block], limits[owner]), moves, seen, job)
    offsets = np.cumsum(count) - count
    feed = moves.feed.copy()
    feed[going] = np.minimum.reduceat(allowed, offsets)
    least = BLOCK * np.array([seen.radii.get(int(number), 0.0) for number in moves.tool])
    mixed = np.flatnonzero(
        (np.maximum.reduceat(allowed, offsets) > feed[going])
        & (seen.end[going] - seen.begin[going] >= 2 * least[going] * (1 - _SLACK))
    )
    cuts: dict[int, list[tuple[float, float]]] = {}
    for k in mixed.tolist():
        progress.step(0.9 + 0.1 * k / len(going), "Slowing the feed")
        move = int(going[k])
        bounds = np.concatenate([[seen.begin[move]], blocks.first[low[k] + 1 : high[k]], [seen.end[move]]])
        saves = 2 * float(least[move]) / job.tool(int(moves.tool[move])).feed_rate
        pieces = _pieces(bounds, allowed[offsets[k] : offsets[k] + count[k]], float(least[move]), saves)
        cuts[move] = [((at - bounds[0]) / (bounds[-1] - bounds[0]), rate) for at, rate in pieces]
    return replace(program, moves=_divided(replace(moves, feed=feed), cuts))


@dataclass(frozen=True, eq=False)
class _Blocks:
    """Blocks of path: positions between which each lies, and the largest share in it."""

    first: Floats
    last: Floats
    share: Floats


class _BlocksOfMoves(NamedTuple):
    """Moves that go anywhere, the first block of each, and the one behind its last; all blocks."""

    moves: Indices
    first: Indices
    behind: Indices
    blocks: _Blocks


def _blocks(seen: EngagementSamples) -> _BlocksOfMoves:
    """Return the blocks of path along moves."""
    going = np.flatnonzero(seen.end > seen.begin)
    if not len(going):
        return _BlocksOfMoves(going, going, going, _Blocks(seen.first, seen.last, seen.share))
    heads = np.flatnonzero(np.diff(seen.block, prepend=-1))
    tails = np.append(heads[1:], len(seen.block)) - 1
    blocks = _Blocks(seen.first[heads], seen.last[tails], np.maximum.reduceat(seen.share, heads))
    low, high = spans(seen.begin[going], seen.end[going], blocks.first, blocks.last)
    return _BlocksOfMoves(going, low, high, blocks)


class _Parts(NamedTuple):
    """Parts of moves: the move of each, the share of the tool that is engaged in it, and that may be."""

    owner: Indices
    engaged: Floats
    limit: Floats


def _allowed(parts: _Parts, moves: Moves, seen: EngagementSamples, job: Job) -> Floats:
    """Return the feed of parts of moves, mm/min."""
    owner, engaged, limit = parts
    numbers, place = np.unique(moves.tool[owner], return_inverse=True)
    requested = np.array([job.tool(int(number)).feed_rate for number in numbers])[place]
    bound = np.array([seen.bound(int(number)) for number in numbers])[place]
    part = np.floor(limit / np.maximum(engaged, limit) * _STEPS + _SLACK) / _STEPS
    over = (limit < 1) & (engaged > limit + bound)
    rate = np.maximum(np.maximum(part, LEAST_FEED) * requested, LEAST_RATE)
    return np.where(over, np.minimum(moves.feed[owner], rate), moves.feed[owner])


def _pieces(bounds: Floats, feeds: Floats, least: float, least_gain: float) -> list[tuple[float, float]]:
    """Return the pieces into which a move is cut: (where each ends, its feed).

    The stretch that gains most from a faster feed is cut out, and so on within what is left of the move and within the
    stretch. Whether and where a piece is cut depends on nothing but itself, so its pieces are not cut again.

    Args:
        bounds: (k + 1,) begin of the move, where its feed may change, its end, mm.
        feeds: (k,) between them, mm/min.
        least: length of a piece, mm.
        least_gain: time that a cut must save, min.
    """
    slowest = float(feeds.min())
    gain, first, last = max(
        ((bounds[last] - bounds[first]) * (1 / slowest - 1 / feed), first, last)
        for feed in np.unique(feeds).tolist()
        for first, last in _stretches(bounds, feeds >= feed, least)
    )
    if gain <= max(_GAIN * (bounds[-1] - bounds[0]) / slowest, least_gain):
        return [(float(bounds[-1]), slowest)]
    parts = [(k, n) for k, n in ((0, first), (first, last), (last, len(feeds))) if n > k]
    return [piece for k, n in parts for piece in _pieces(bounds[k : n + 1], feeds[k:n], least, least_gain)]


def _stretches(bounds: Floats, fast: NDArray[np.bool_], least: float) -> list[tuple[int, int]]:
    """Return the runs first … last - 1 of blocks that are fast, none of them shorter than `least`, nor what is left
    beside them.
    """
    edges = np.flatnonzero(np.diff(fast, prepend=False, append=False))
    least, found = least * (1 - _SLACK), []
    low, high = (
        np.searchsorted(bounds, bounds[0] + least),
        np.searchsorted(bounds, bounds[-1] - least, side="right") - 1,
    )
    for first, last in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True):
        first, last = max(first, int(low)) if first else 0, min(last, int(high)) if last < len(fast) else last
        if last > first and bounds[last] - bounds[first] >= least:
            found.append((first, last))
    return found


def _divided(moves: Moves, cuts: dict[int, list[tuple[float, float]]]) -> Moves:
    """Return moves with some of them in pieces, each (fraction of the move where it ends, its feed)."""
    count = np.ones(len(moves), np.int64)
    for move, pieces in cuts.items():
        count[move] = len(pieces)
    owner = np.repeat(np.arange(len(moves)), count)
    columns: dict[str, Any] = {name: column[owner] for name, column in moves.columns().items()}
    start, fraction = np.cumsum(count) - count, np.ones(len(owner))
    for move, pieces in cuts.items():
        rows = slice(start[move], start[move] + len(pieces))
        fraction[rows], columns["feed"][rows] = np.array(pieces).T
    inner = np.flatnonzero(fraction < 1)
    columns["end"][inner] = _points(moves, owner[inner], fraction[inner])
    return Moves(**columns)


def _points(moves: Moves, index: Indices, fraction: Floats) -> NDArray[np.float64]:
    """Return the points (n, 3) at fractions of moves."""
    start, end = moves.start[index, 2], moves.end[index, 2]
    return np.column_stack([points_at(move_rows(moves, index), fraction), start + (end - start) * fraction])
