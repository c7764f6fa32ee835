"""What the Cut view shows: heights of the metal, what is known of each cell, and the way the tool went."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from .relief import Bytes, relief

Heights = NDArray[np.float32]
Floats = NDArray[np.float64]
Numbered = tuple[NDArray[np.int32], NDArray[np.int64]]

TOUCHED = 1e-5
"""A cell lower than the top by more than this, mm, counts as cut where nobody says which move cut it."""

_SAME_PLACE_MM = 1e-3


@dataclass(frozen=True, eq=False)
class CutMoves:
    """What the numbers of cutting moves mean, n of them.

    Attributes:
        line: (n,) 1-based line of the NC program.
        tool: (n,) T number.
        surface: (n,) index of the surface or operation that the move belongs to; empty where nobody knows.
        inks: places in the theme's cycle of tools by T number, where they are others than the order of the tools.
    """

    line: NDArray[np.int32]
    tool: NDArray[np.int32]
    surface: NDArray[np.int32]
    inks: Mapping[int, int] = field(default_factory=dict)

    @cached_property
    def tools(self) -> Numbered:
        """The T numbers that there are, in the order of their first move, and the place of each move's among them."""
        numbers, first, places = np.unique(self.tool, return_index=True, return_inverse=True)
        order = np.argsort(first)
        return numbers[order], np.argsort(order)[places]

    def ink_of(self, tool: int) -> int:
        """Return a tool's place in the theme's cycle of tools."""
        known = self.tools[0].tolist()
        return self.inks.get(tool, known.index(tool) if tool in known else tool - 1)

    @cached_property
    def surfaces(self) -> Numbered:
        """The surfaces that there are, and the place of each move's among them."""
        return np.unique(self.surface, return_inverse=True)


@dataclass(frozen=True, eq=False)
class CutPaths:
    """Straight pieces of the tool's way, n of them, in the order of going.

    Attributes:
        start, end: (n, 3) mm.
        look: (n,) uint8 `app.ui.views.nc.motion_shapes.MotionLineStyle`.
    """

    start: Floats
    end: Floats
    look: NDArray[np.uint8]

    def __len__(self) -> int:
        return len(self.look)

    def length(self, look: int) -> float:
        """Return how long all pieces of a look are, seen from above, mm."""
        chosen = self.look == look
        return float(np.sum(np.hypot(*(self.end - self.start)[chosen, :2].T)))

    def ground_length(self, look: int) -> float:
        """Return the length of a look's pieces, mm, seen from above: pieces over each other, as in the steps down along
        a wall, count once.
        """
        chosen = self.look == look
        start, end = self.start[chosen, :2], self.end[chosen, :2]
        middle = np.round((start + end) / (2 * _SAME_PLACE_MM))
        _, first = np.unique(middle[:, 0] + 1j * middle[:, 1], return_index=True)
        return float(np.sum(np.hypot(*(end - start)[first].T)))


@dataclass(frozen=True, slots=True)
class ColourSpan:
    """What the scales of a cut's colours run over; a finer look at a part of it takes those of the whole.

    Attributes:
        lowest: of the heights that were cut, mm. worst: the largest deviation either way, mm. last: the greatest number
            of a move.
    """

    lowest: float
    worst: float
    last: int


@dataclass(frozen=True, eq=False)
class CutPicture:
    """Stock after cutting, one height a cell.

    Attributes:
        heights: (rows, columns) mm; row 0 has the lowest Y; samples stand at the cells' centres.
        x0, y0: lower left corner of the grid, mm. pitch: width of a cell, mm, > 0.
        floor: bottom of the stock, mm. top: its top before the first cut, mm.
        move: (rows, columns) index of the move that cut a cell last, -1 = none; None = nobody knows.
        moves: what these indices mean.
        deviation: (rows, columns) mm against the part, > 0 = metal left, < 0 = gouge; None = there is no part.
        tolerance: deviation within which the part is right, mm, > 0.
        unreachable: (rows, columns) bool, left metal that no tool of the job reaches.
        paths: the way the tool went.
        values: places in a palette by what colours tell (`app.ui.views.cut.cell_colours`), kept here once they are
            worked out.
    """

    heights: Heights
    x0: float
    y0: float
    pitch: float
    floor: float
    top: float
    move: NDArray[np.int32] | None = None
    moves: CutMoves | None = None
    deviation: Heights | None = None
    tolerance: float = 0.01
    unreachable: NDArray[np.bool_] | None = None
    paths: CutPaths | None = None
    values: dict[Enum, Bytes] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if self.heights.ndim != 2 or not self.heights.size or self.heights.dtype != np.float32:
            raise ValueError("heights are a float32 array of rows and columns")
        for channel in (self.move, self.deviation, self.unreachable):
            if channel is not None and channel.shape != self.heights.shape:
                raise ValueError("a channel of another size than the heights")

    @property
    def rows(self) -> int:
        """Cells along Y."""
        return int(self.heights.shape[0])

    @property
    def columns(self) -> int:
        """Cells along X."""
        return int(self.heights.shape[1])

    @property
    def low(self) -> Floats:
        """Lower left corner of the stock's box, mm."""
        return np.array([self.x0, self.y0, self.floor])

    @property
    def high(self) -> Floats:
        """Upper right corner of the stock's box, mm."""
        return np.array([self.x0 + self.columns * self.pitch, self.y0 + self.rows * self.pitch, self.top])

    @cached_property
    def relief(self) -> Bytes:
        """What the light needs, see `relief`; made when first asked for, which may be on another thread than the
        window's.
        """
        return relief(self.heights, self.pitch)

    @cached_property
    def lowest(self) -> float:
        """The lowest height, mm."""
        return float(self.heights.min())

    @cached_property
    def highest(self) -> float:
        """The greatest height, mm."""
        return float(self.heights.max())

    def forget_extent(self) -> None:
        """Find the lowest and the greatest height anew: heights were changed in place."""
        for name in ("lowest", "highest"):
            vars(self).pop(name, None)

    @cached_property
    def span(self) -> ColourSpan:
        """What the scales of its colours run over."""
        lowest = float(np.min(self.heights, where=~self.uncut(), initial=self.top))
        worst = float(np.nanmax(np.abs(self.deviation))) if self.deviation is not None else 0.0
        return ColourSpan(lowest, worst, max(int(self.move.max()), 1) if self.move is not None else 1)

    def uncut(self) -> NDArray[np.bool_]:
        """Return (rows, columns) which cells no move has cut."""
        return self.move < 0 if self.move is not None else self.heights >= np.float32(self.top - TOUCHED)

    def holds(self, x: float, y: float) -> bool:
        """Return whether a place, mm, lies on its cells, or at their rim."""
        return bool(np.all(self.low[:2] <= (x, y)) and np.all((x, y) <= self.high[:2]))

    def height_at(self, x: float, y: float) -> float:
        """Return the height of the cell that a place, mm, lies in; beside the stock that of the nearest one."""
        column, row = (
            int(np.clip((at - low) / self.pitch, 0, count - 1))
            for at, low, count in ((x, self.x0, self.columns), (y, self.y0, self.rows))
        )
        return float(self.heights[row, column])

    def move_at(self, row: int, column: int) -> int:
        """Return the move that cut a cell last; -1 = none, or nobody knows."""
        return int(self.move[row, column]) if self.move is not None else -1
