"""A tool path as columns: one row a move, in the order of cutting."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import IntEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .finding import Finding
from .part import Contour, Region

Floats = NDArray[np.float64]


class MoveKind(IntEnum):
    """How the control moves: the G word."""

    RAPID = 0
    LINE = 1
    ARC_CW = 2
    ARC_CCW = 3


class Purpose(IntEnum):
    """What a move is for; decides its colour and its line style."""

    RAPID = 0
    PLUNGE = 1
    CONTOUR = 2
    POCKET = 3
    LINK = 4
    LEAD = 5
    DRILL = 6
    TAB = 7
    DOG_BONE = 8


@dataclass(frozen=True)
class Moves:
    """A sequence of n moves; the first one is a rapid from wherever the tool was.

    Arcs lie in the XY plane; one whose Z changes is a helix.

    Attributes:
        end: (n, 3) end point of each move, mm, part coordinates.
        centre: (n, 2) centre of arcs, mm; NaN for others.
        kind: (n,) uint8 MoveKind.
        purpose: (n,) uint8 Purpose.
        operation: (n,) int16 index into the job's operations.
        tool: (n,) int16 T number.
        region: (n,) int32 region number, 0 = none (between regions).
        feed: (n,) feed rate, mm/min; 0 for rapids.
        line: (n,) int32 line of the NC text that holds the move, 1-based; 0 = not written yet.
    """

    end: Floats
    centre: Floats
    kind: NDArray[np.uint8]
    purpose: NDArray[np.uint8]
    operation: NDArray[np.int16]
    tool: NDArray[np.int16]
    region: NDArray[np.int32]
    feed: Floats
    line: NDArray[np.int32]

    def __len__(self) -> int:
        return len(self.kind)

    def __post_init__(self) -> None:
        for column in self.columns().values():
            if len(column) != len(self.kind):
                raise ValueError("columns of different length")
            column.setflags(write=False)

    def columns(self) -> dict[str, NDArray[np.generic]]:
        """Return every column by name."""
        return {name: getattr(self, name) for name in self.__dataclass_fields__}

    def part(self, first: int, stop: int) -> Moves:
        """Return the moves from `first` up to `stop`, which is left out."""
        columns: dict[str, Any] = {name: column[first:stop] for name, column in self.columns().items()}
        return Moves(**columns)

    @property
    def start(self) -> Floats:
        """(n, 3) start point of each move; the first starts where it ends."""
        return np.concatenate([self.end[:1], self.end[:-1]])

    def sweeps(self) -> Floats:
        """(n,) signed angle of each arc, radians, counter-clockwise positive; 0 for other moves.

        An arc that ends where it starts is a full turn.
        """
        found, arcs = np.zeros(len(self)), np.flatnonzero(self.kind >= MoveKind.ARC_CW)
        start, end, centre = self.start[arcs, :2], self.end[arcs, :2], self.centre[arcs]
        a, b = start - centre, end - centre
        turn = (np.arctan2(b[:, 1], b[:, 0]) - np.arctan2(a[:, 1], a[:, 0])) % (2 * np.pi)
        same = np.all(start == end, axis=1)
        turn = np.where(same, 2 * np.pi, turn)
        back = np.where(same, -2 * np.pi, turn - 2 * np.pi)
        found[arcs] = np.where(self.kind[arcs] == MoveKind.ARC_CCW, turn, back)
        return found

    def lengths(self) -> Floats:
        """(n,) length of each move, mm (helices along the helix)."""
        delta = self.end - self.start
        arcs = self.kind >= MoveKind.ARC_CW
        radius = np.hypot(*(self.end[:, :2] - self.centre).T)
        flat = np.where(
            arcs, np.nan_to_num(radius) * np.abs(np.nan_to_num(self.sweeps())), np.hypot(delta[:, 0], delta[:, 1])
        )
        return np.hypot(flat, delta[:, 2])


@dataclass(frozen=True)
class Area:
    """Where the cutter of one operation may be.

    Attributes:
        regions: the cutter stays within them with all its width and the stock to leave; none = it makes no moves.
        lines: where its centre stays on lines: these, open and closed; the regions then are what keeps it off clamps.
        whole: True: the operation is to clear all of its regions; False: what its path covers.
        bare: outlines that are kept off but not followed: clamps, and the frame round an area outside.
        air: outlines of what of the regions lies beyond the stock's edges, where nothing stands that is to be cleared.
    """

    regions: tuple[Region, ...] = ()
    lines: tuple[Contour, ...] = ()
    whole: bool = False
    bare: tuple[Contour, ...] = ()
    air: tuple[Contour, ...] = ()


@dataclass(frozen=True, slots=True)
class Tab:
    """A bridge of metal that was left standing.

    Attributes:
        x, y: its middle on the tool centre's path, mm.
        width: of the metal along the path, mm.
        top: height of its top, mm, < 0.
        diameter: of the cutter that went over it, mm.
        holds_part: whether a part hangs on it; what a tab within a contour holds is waste.
    """

    x: float
    y: float
    width: float
    top: float
    diameter: float
    holds_part: bool = True


@dataclass(frozen=True, slots=True)
class DogBone:
    """A way of the cutter's centre into a corner, beyond where its width keeps off the walls: from (x0, y0) to (x1,
    y1), mm.

    Attributes:
        diameter: of the cutter, mm.
    """

    x0: float
    y0: float
    x1: float
    y1: float
    diameter: float


@dataclass(frozen=True)
class Program:
    """The answer of a computation: every move of a job, and what there is to say about it.

    Attributes:
        moves: in the order of cutting.
        regions: the areas that were machined, by region number.
        findings: drawing and path findings, worst first.
        areas: of each operation of the job, by its index; none = the regions are those of all.
        lines: open lines that are followed.
        clamps: that no tool comes over below their height.
        tabs, dog_bones: where metal was left standing, and where walls were cut into, on purpose.
        strokes: pocket strokes (connected pocket paths without a lift), summed over depth passes.
        stepovers: distance between the rings of pockets, mm, by index of the operation; of those that have rings.
        polyline_rings: rings that had to fall back to a fine polyline.
        bitmap_area_mm2, exact_area_mm2: area of A' by the bitmap fill and by the exact offset (independent check).
        pitch_mm: size of that bitmap's pixels; 0 when nothing was filled.
        given_up_mm: of paths made from pixels: how much farther from the walls than asked they are at most; None of
            exact ones.
        allowance_mm: so thick a skin may paths made from pixels leave along the walls that they follow; 0 for exact
            ones.
    """

    moves: Moves
    regions: tuple[Region, ...] = ()
    findings: tuple[Finding, ...] = ()
    strokes: int = 0
    polyline_rings: int = 0
    bitmap_area_mm2: float = 0.0
    exact_area_mm2: float = 0.0
    pitch_mm: float = 0.0
    given_up_mm: float | None = None
    allowance_mm: float = 0.0
    areas: tuple[Area, ...] = ()
    lines: tuple[Contour, ...] = ()
    clamps: tuple[Region, ...] = ()
    tabs: tuple[Tab, ...] = ()
    dog_bones: tuple[DogBone, ...] = ()
    stepovers: Mapping[int, float] = field(default_factory=dict)
