"""The moves of a course in chains, one cutter each: what goes on where the last move ended belongs together."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...model.motion import Floats, MotionKind
from ...model.motion_path import anchored
from ..cutter import Cutter
from .course import Course
from .pieces import PieceSplitter, SweepPieces

LEAST = 1e-9
"""A move that is shorter, mm, is none."""


@dataclass(frozen=True, eq=False)
class Chains:
    """Moves of one cutter, n of them.

    Attributes:
        start, end: (n, 3) mm.
        way: (n, 3) unit directions; 0 where the cutter only stands, in a chain by itself.
        joins: (n,) uint8 whether each goes on where the one before it ended.
    """

    start: Floats
    end: Floats
    way: Floats
    joins: NDArray[np.uint8]

    @staticmethod
    def of(start: Floats, end: Floats, joins: NDArray[np.bool_]) -> Chains:
        """Return chains; moves without a length are left out, but for one where a chain has no others.

        Args:
            start, end: (n, 3) mm.
            joins: (n,) whether each goes on from the one before it; the first does not.
        """
        way = end - start
        length = np.linalg.norm(way, axis=1)
        chain, moves = np.cumsum(~joins), length > LEAST
        stands = np.ones(len(joins) + 1, bool)
        stands[chain[moves]] = False
        kept = moves | (stands[chain] & (np.diff(chain, prepend=0) > 0))
        way[moves] /= length[moves, None]
        way[~moves] = 0.0
        goes_on = np.diff(chain[kept], prepend=0) == 0
        first, last, ways = (np.ascontiguousarray(column[kept]) for column in (start, end, way))
        return Chains(first, last, ways, goes_on.astype(np.uint8))

    def __len__(self) -> int:
        return len(self.joins)

    def moved(self, by: tuple[float, float, float]) -> Chains:
        """Return the same elsewhere."""
        return Chains(self.start + by, self.end + by, self.way, self.joins)

    @property
    def lowest(self) -> float:
        """The lowest Z, mm; infinite where there is none."""
        return float(min(self.start[:, 2].min(initial=math.inf), self.end[:, 2].min(initial=math.inf)))

    @property
    def corners(self) -> int:
        """How many places there are, the ends of chains included."""
        return len(self) + int(np.count_nonzero((self.joins == 0) & self.way.any(axis=1)))


def cutting(course: Course, cutters: Mapping[int, Cutter]) -> NDArray[np.bool_]:
    """Return (n,) which motions cut: all but rapids, and those that are left out.

    Raises:
        ParameterError: a tool that cuts is not among the cutters.
    """
    cuts = np.asarray(course.motions.kind != MotionKind.RAPID)
    cuts[list(course.left_out)] = False
    strange = np.flatnonzero(cuts & ~np.isin(course.tool, list(cutters)))
    if len(strange):
        raise course.strange_tool(int(strange[0]))
    return cuts


class CutterChains(NamedTuple):
    """A cutter, and where its tip goes."""

    cutter: Cutter
    chains: Chains


def chains_of(course: Course, cutters: Mapping[int, Cutter], chord: float) -> list[CutterChains]:
    """Return where the tips of a course's cutters go.

    Args:
        course: what is cut along; rapids do not cut.
        cutters: by T number.
        chord: how far at most chords are from curves, mm, > 0.

    Raises:
        ParameterError: a tool that cuts is not among the cutters.
    """
    cuts = cutting(course, cutters)
    motions = anchored(course.motions) if any(course.motions.known_from) else course.motions
    pieces = PieceSplitter(motions, arcs_stay=False, chord=chord).pieces(0, len(motions))
    tool, does = course.tool[pieces.motion], cuts[pieces.motion]
    numbers = np.unique(course.tool[cuts]).tolist()
    return [
        CutterChains(cutters[number], _chains(pieces, np.flatnonzero(does & (tool == number)), cutters[number].lift))
        for number in numbers
    ]


def _chains(pieces: SweepPieces, rows: NDArray[np.intp], lift: float) -> Chains:
    """Return the chains of some rows of pieces."""
    start, end = pieces.start[rows], pieces.end[rows]
    joins = np.zeros(len(rows), bool)
    joins[1:] = (np.diff(rows) == 1) & np.all(start[1:] == end[:-1], axis=1)
    return Chains.of(start + (0.0, 0.0, lift), end + (0.0, 0.0, lift), joins)
