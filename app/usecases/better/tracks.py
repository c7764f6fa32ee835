"""The passes of any program that goes over a surface in lines beside one another: straight, fanned, bent, spiral."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ...core.errors import InputError
from ...gcode.interpreter.program import NcProgram
from ...model.motion import Floats, MotionKind
from .area import PassArea

_FEWEST_POINTS, _FEWEST_TRACKS = 4, 4
"""Points of a pass, and passes: fewer tell of no surface."""
_STEEP = 0.02
"""A move that goes so little sideways for its length is a plunge or a lift, of no direction."""
_TURN = math.radians(50.0)
"""Seen from above: where a program turns by more from one move to the next, a pass ends."""
_SHORT = 0.1
"""Of the longest pass: what is shorter is a way between passes."""
_SHARE = 0.7
"""Of all that is fed sideways: so much of it has to be passes, or the program is another kind."""
_FILLED = 0.5
"""Of the pitch: places are no farther apart along a pass."""
_APART = 3.0
"""Times the usual distance from pass to pass: what is farther is no neighbour."""


@dataclass(frozen=True, eq=False)
class TrackedProgram:
    """A program's passes, in the order of driving.

    Attributes:
        lines: (n, 3) places of the tip of each, program coordinates, mm. pitch: from pass to pass, mm, the usual one.
        share: of all that is fed sideways that is passes.
    """

    lines: tuple[Floats, ...]
    pitch: float
    share: float

    @property
    def area(self) -> PassArea:
        """Where they are."""
        return PassArea(self.lines, self.pitch)

    @property
    def rows(self) -> tuple[Floats, ...]:
        """Places along each pass, no farther apart than half of the pitch."""
        return tuple(filled_places(line, self.pitch) for line in self.lines)


def filled_places(points: Floats, pitch: float) -> Floats:
    """Return points (n, 3) of a polyline, and places between those farther apart than half a pitch: a chord over a
    facet says as much of it as points within it do.
    """
    parts = np.linalg.norm(np.diff(points, axis=0), axis=1) / (_FILLED * pitch)
    counts = np.maximum(np.ceil(parts), 1).astype(np.int64)
    chord = np.repeat(np.arange(len(counts)), counts)
    share = (np.arange(len(chord)) - np.repeat(np.cumsum(counts) - counts, counts)) / counts[chord]
    between = points[chord] + share[:, None] * (points[chord + 1] - points[chord])
    return np.concatenate([between, points[-1:]])


def tracks_of(name: str, program: NcProgram) -> TrackedProgram:
    """Return the passes of a program.

    Args:
        name: of the file, for messages. program: as it was read, its motions anchored.

    Raises:
        InputError: it does not go over a surface in passes beside one another.
    """
    motions = program.motions
    ways = motions.end - motions.start
    sizes, over = np.linalg.norm(ways, axis=1), np.hypot(ways[:, 0], ways[:, 1])
    sideways = (motions.kind == MotionKind.LINE) & (over > _STEEP * sizes) & (sizes > 0)
    if not sideways.any():
        raise _other(name, "it has no straight feed moves over the plane")
    runs = [run for each in _chains(motions.start, motions.end, sideways) for run in _parted(each, ways)]
    lengths = np.array([float(sizes[first:stop].sum()) for first, stop in runs])
    passes = [
        (run, length)
        for run, length in zip(runs, lengths.tolist(), strict=True)
        if run[1] - run[0] >= _FEWEST_POINTS - 1 and length >= _SHORT * lengths.max()
    ]
    fed = (motions.kind != MotionKind.RAPID) & (over > _STEEP * sizes)
    share = sum(length for _, length in passes) / max(float(sizes[fed].sum()), 1e-9)
    if len(passes) < _FEWEST_TRACKS or share < _SHARE:
        raise _other(name, f"{len(passes)} passes are {share:.0%} of its feed moves")
    lines = tuple(np.vstack([motions.start[first : first + 1], motions.end[first:stop]]) for (first, stop), _ in passes)
    return TrackedProgram(lines, _pitch(name, lines), share)


def _chains(start: Floats, end: Floats, sideways: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Return first and stop of moves over the plane that go on from one another."""
    on = sideways[1:] & sideways[:-1] & np.all(start[1:] == end[:-1], axis=1)
    first = np.flatnonzero(sideways & ~np.append(False, on))
    stop = np.flatnonzero(sideways & ~np.append(on, False)) + 1
    return list(zip(first.tolist(), stop.tolist(), strict=True))


def _parted(chain: tuple[int, int], ways: Floats) -> list[tuple[int, int]]:
    """Return the parts of a chain of moves between sharp turns, none of more than one turn round."""
    first, stop = chain
    angle = np.arctan2(ways[first:stop, 1], ways[first:stop, 0])
    turn = (np.diff(angle) + math.pi) % math.tau - math.pi
    ends, turned = [first], 0.0
    for k, each in enumerate(turn.tolist()):
        turned += each
        if abs(each) > _TURN or abs(turned) > math.tau:
            ends.append(first + k + 1)
            turned = 0.0
    ends.append(stop)
    return list(pairwise(ends))


def _pitch(name: str, lines: Sequence[Floats]) -> float:
    """Return how far passes lie from those beside them, usually, seen from above."""
    import shapely

    flat = [shapely.LineString(line[:, :2]) for line in lines]
    near = []
    for k, line in enumerate(flat):
        others = [flat[j] for j in (k - 1, k + 1) if 0 <= j < len(flat)]
        middle = line.interpolate(0.5, normalized=True)
        near.append(min(shapely.distance(middle, other) for other in others))
    usual = float(np.median(near))
    if not usual > 0:
        raise _other(name, "its passes lie on one another")
    if np.mean(np.array(near) > _APART * usual) > 0.5:
        raise _other(name, "its passes do not lie beside one another in the order of driving")
    return usual


def _other(name: str, why: str) -> InputError:
    return InputError(
        f"{name}: {why}; a program that can be made better goes over a surface in passes beside one another. Use "
        "smooth, which takes any program."
    )
