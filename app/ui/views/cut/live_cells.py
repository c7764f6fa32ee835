"""The cells of a cut that is played: what the view must take over to show another moment. No Qt; runs on a worker's
thread.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ....core.progress import NO_PROGRESS, Progress
from ....model.motion import MotionKind, Motions
from ....model.motion_part import place_on
from ....model.tool import Tool
from ....simulation.gpu.wedges_picture import MOVES, WedgesPicture, has_wedges, wedges_picture
from .cell_colours import CutColourBy, values_of
from .cell_patch import CellPatch, patch_of
from .cut_picture import CutPicture, Floats, Heights
from .relief import Bytes
from .rendering.tool_body import Place

if TYPE_CHECKING:
    from ....usecases.cutting.playback import Playback, PlayFrame
    from ....usecases.cutting.timeline import Timeline, TimelinePlace


_CHORDS = 8
"""Of a curve among the moves whose sweep is shown."""


@dataclass(frozen=True, eq=False)
class ChangedCells:
    """Cells that have changed, as the view's picture holds them.

    Attributes:
        rows, cols: which they are.
        move: (h, w) motion that cut each last; None = nobody knows. deviation: (h, w) mm against the part; None = there
            is none.
    """

    rows: slice
    cols: slice
    move: NDArray[np.int32] | None
    deviation: Heights | None

    def write_to(self, picture: CutPicture) -> None:
        """Make a live picture the same."""
        if picture.move is not None and self.move is not None:
            picture.move[self.rows, self.cols] = self.move
        if picture.deviation is not None and self.deviation is not None:
            picture.deviation[self.rows, self.cols] = self.deviation


@dataclass(frozen=True, eq=False)
class LiveFrame:
    """One moment, ready to be shown.

    Attributes:
        moment: which. cells, patch: what has changed; None = nothing. colour: what the patch's colours tell.
        tool, tip: what stands where, mm; None where nobody knows.
        wedges: facets of the sweep that led there; None = not asked for, or the tool has none.
    """

    moment: TimelinePlace
    cells: ChangedCells | None
    patch: CellPatch | None
    colour: CutColourBy
    tool: Tool | None
    tip: Place | None
    wedges: WedgesPicture | None = None


@dataclass(frozen=True, slots=True)
class FrameRequest:
    """What is wanted.

    Attributes:
        moment: to be shown. colour: what the colours shall tell. wedges: the facets too.
        all_cells: also those that have not changed, as the view may have others.
    """

    moment: TimelinePlace
    colour: CutColourBy
    wedges: bool = False
    all_cells: bool = False


def live_copy(picture: CutPicture) -> CutPicture:
    """Return a picture that nobody else relies on, so that its cells can be changed in place."""
    live = replace(
        picture,
        heights=picture.heights.copy(),
        move=None if picture.move is None else picture.move.copy(),
        deviation=None if picture.deviation is None else picture.deviation.copy(),
        values={colour: values.copy() for colour, values in picture.values.items()},
    )
    vars(live)["relief"] = picture.relief.copy()
    vars(live)["span"] = picture.span  # scales stay those of the whole cut
    return live


class LiveCells:
    """What a view that takes over every frame holds, on the worker's side.

    One thread at a time asks it.

    Attributes:
        playback: the cut that is played.
    """

    def __init__(self, playback: Playback, picture: CutPicture, tools: Mapping[int, Tool]) -> None:
        """Begin where all is done.

        Args:
            playback: of the picture's cut. picture: of the end. tools: by T number.
        """
        self.playback, self._end, self._tools = playback, picture, tools
        self._heights, self._move = picture.heights.copy(), None if picture.move is None else picture.move.copy()
        self._values: tuple[CutColourBy, Bytes] | None = None

    def frame(self, wish: FrameRequest, progress: Progress = NO_PROGRESS) -> LiveFrame:
        """Return what the view must take over.

        Raises:
            Cancelled: nobody wants it any more.
        """
        played = self.playback.frame(wish.moment, progress)
        rows, cols = (
            slice(at, at + size) for at, size in zip((played.row, played.col), played.heights.shape, strict=True)
        )
        self._heights[rows, cols] = played.heights
        if self._move is not None:
            self._move[rows, cols] = played.owner
        values, fresh = self._coloured(wish.colour, rows, cols)
        if fresh or wish.all_cells:
            rows, cols = slice(0, self._heights.shape[0]), slice(0, self._heights.shape[1])
        cells = patch = None
        if rows.stop > rows.start and cols.stop > cols.start:
            cells = self._cells(rows, cols)
            patch = patch_of(self._heights, values, self._end.pitch, (rows, cols))
        return self._with_tool(LiveFrame(wish.moment, cells, patch, wish.colour, None, None), played, wish.wedges)

    def _coloured(self, colour: CutColourBy, rows: slice, cols: slice) -> tuple[Bytes, bool]:
        """Return the places of all cells in the palette, and whether all were worked out anew."""
        known = self._values
        if known is None or known[0] is not colour:
            values = values_of(self._part(slice(None), slice(None)), colour, self._end.span)
            self._values = (colour, values.copy())
            return self._values[1], known is not None
        if rows.stop > rows.start and cols.stop > cols.start:
            known[1][rows, cols] = values_of(self._part(rows, cols), colour, self._end.span)
        return known[1], False

    def _part(self, rows: slice, cols: slice) -> CutPicture:
        """Return a rectangle of cells as a picture of its own."""
        end = self._end
        move = None if self._move is None else self._move[rows, cols]
        beyond = None if end.unreachable is None else end.unreachable[rows, cols]
        return replace(
            end,
            heights=self._heights[rows, cols],
            move=move,
            deviation=self._deviation(rows, cols),
            unreachable=beyond,
            paths=None,
            values={},
        )

    def _deviation(self, rows: slice, cols: slice) -> Heights | None:
        """Return how far cells are from the part: as far as at the end, and what is still to be taken."""
        end = self._end
        if end.deviation is None:
            return None
        return np.asarray(end.deviation[rows, cols] + (self._heights[rows, cols] - end.heights[rows, cols]))

    def _cells(self, rows: slice, cols: slice) -> ChangedCells:
        move = None if self._move is None else self._move[rows, cols].copy()
        return ChangedCells(rows, cols, move, self._deviation(rows, cols))

    def _with_tool(self, frame: LiveFrame, played: PlayFrame, wedges: bool) -> LiveFrame:
        timeline, moment = self.playback.timeline, frame.moment
        if not len(timeline) or played.tip is None:
            return frame
        row = timeline.current(moment)
        tool, (x, y, z) = self._tools.get(int(timeline.tool[row])), played.tip.tolist()
        facets = None
        if wedges and tool is not None and has_wedges(tool):
            tips = last_tips(timeline, row, played.tip)
            facets = wedges_picture(tips, tool) if len(tips) > 1 else None
        return replace(frame, tool=tool, tip=(x, y, z), wedges=facets)


def last_tips(timeline: Timeline, row: int, tip: Floats) -> Floats:
    """Return (k, 3) the places of the tip on the last moves at feed rate up to where it is, mm, k >= 1; curves by
    chords.
    """
    motions, own = timeline.own(row)
    parts, tool = [tip[None]], timeline.tool[row]
    for at in range(own, max(own - MOVES, -1), -1):
        if (
            motions.kind[at] == MotionKind.RAPID
            or timeline.tool[row - own + at] != tool
            or not np.all(np.isfinite(motions.start[at]))
        ):
            break
        parts.append(_done(motions, at, parts[-1][-1])[::-1])
    tips = np.concatenate(parts)
    moved = np.concatenate([[True], np.any(np.diff(tips, axis=0) != 0, axis=1)])
    ahead: Floats = tips[moved][::-1]
    return ahead


def _done(motions: Motions, row: int, until: Floats) -> Floats:
    """Return places of a motion from its start on, mm; of one that is bent up to a place of it."""
    if motions.kind[row] == MotionKind.LINE:
        return np.asarray(motions.start[row : row + 1], np.float64)
    places = np.array([place_on(motions, row, share) for share in np.linspace(0.0, 1.0, _CHORDS + 1)])
    done: Floats = places[: max(int(np.argmin(np.linalg.norm(places - until, axis=1))), 1)]
    return done
