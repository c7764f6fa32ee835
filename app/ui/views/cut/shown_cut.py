"""A program that was cut, prepared for the Cut view: heights, colours, paths, what was assumed. No Qt widgets; runs on
a worker.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ....core.progress import NO_PROGRESS, Progress
from ....model.finding import Finding
from ....model.motion import MotionKind
from ....model.motion_part import place_on
from ..nc.program_text import ProgramText
from .cell_colours import CutColourBy, prepare
from .cut_picture import CutMoves, CutPaths, CutPicture, Floats
from .histogram import Histogram, histogram_of
from .relief import Bytes
from .user_setup import UserSetup

if TYPE_CHECKING:
    from ....gcode.interpreter.program import NcProgram
    from ....usecases.cutting.cut import CutProgram
    from ..nc.line_marks import LineMarks
    from ..nc.motion_shapes import MotionShapes

_STEP_RAD, _CHORD_MM = 0.1, 0.002
"""Turn of a straight piece of an arc's path, and how far it is from the arc: near by, wide arcs have no corners."""

_MOST_PIECES = 400_000
"""Of so many arcs that there would be more pieces, none is finer than by its turn."""

_DEFAULT_TOLERANCE = 0.01

_PIECES = 33
"""Points along a bent motion that is pointed out."""


@dataclass(frozen=True, eq=False)
class ProgramFile:
    """One file of a program: its name for people, its bytes."""

    name: str
    data: bytes


@dataclass(frozen=True, eq=False)
class ShownCut:
    """Everything that the Cut view shows of a program.

    Attributes:
        cut: the program, cut. picture: what is left, prepared for painting.
        names, texts: of its files, in the order of cutting. first: (files + 1,) where the motions of each file begin.
        marks: what the lines of each file move.
        given: with which tools and stock a program was cut that is not the job's; None = the job's own.
        assumed: what nobody has told, and was taken to be so.
        histogram: how much of the area is how far from the part; None = there is no part.
    """

    cut: CutProgram
    picture: CutPicture
    names: tuple[str, ...]
    texts: tuple[ProgramText, ...]
    first: tuple[int, ...]
    marks: tuple[LineMarks, ...]
    given: UserSetup | None = None
    assumed: tuple[Finding, ...] = ()
    histogram: Histogram | None = None

    def file_of(self, motion: int) -> int:
        """Return the index of the file of a motion."""
        return int(np.searchsorted(self.first, motion, side="right")) - 1

    def motion_at(self, file: int, row: int) -> int:
        """Return the last motion of a line (0-based) of a file, or of the lines above it; -1 = nothing moves yet."""
        assert self.picture.moves is not None
        lines = self.picture.moves.line[self.first[file] : self.first[file + 1]]
        own = np.flatnonzero(lines == row + 1)
        before = own if len(own) else np.flatnonzero(lines <= row)
        return self.first[file] + int(before[-1]) if len(before) else self.first[file] - 1

    def way_of(self, motion: int) -> Floats:
        """Return (n, 3) points along a motion, mm; none where it is not known where it begins."""
        motions, row = self.cut.setup.programs[self.file_of(motion)].motions, self.row_in_file(motion)
        count = 2 if motions.kind[row] in (MotionKind.RAPID, MotionKind.LINE) else _PIECES
        points = np.array([place_on(motions, row, share) for share in np.linspace(0.0, 1.0, count)])
        return points if bool(np.all(np.isfinite(points))) else points[:0]

    def row_in_file(self, motion: int) -> int:
        """Return the row of a motion among those of its own file."""
        return motion - self.first[self.file_of(motion)]

    def motion_of_line(self, line: int, place: tuple[float, float, float] | None) -> int:
        """Return the motion of an NC line that ends nearest to a place; -1 = there is none.

        Args:
            line: 1-based, in any of the files; 0 = none. place: mm; None = the first motion will do.
        """
        rows = (
            np.flatnonzero(self.picture.moves.line == line)
            if line and self.picture.moves is not None
            else np.zeros(0, np.int64)
        )
        if not len(rows) or place is None:
            return int(rows[0]) if len(rows) else -1
        ends = np.concatenate([program.motions.end for program in self.cut.setup.programs])[rows]
        return int(rows[np.argmin(np.hypot(ends[:, 0] - place[0], ends[:, 1] - place[1]))])


def shown_cut(
    cut: CutProgram, files: tuple[ProgramFile, ...], colour: CutColourBy, progress: Progress = NO_PROGRESS
) -> ShownCut:
    """Prepare a program that was cut; the job's, as long as nobody says otherwise.

    Args:
        cut: the program. files: of it, in the order of cutting.
        colour: what the colours tell at first.
        progress: of this part.

    Raises:
        Cancelled: the job was asked to stop.
    """
    from ....gcode.interpreter.notes_operation import contour_motions
    from ..nc.line_marks import line_marks
    from ..nc.motion_shapes import shape_motions, tool_inks
    from ..nc.program_text import program_text

    progress.step(0.0, "Preparing the cut")
    setup = cut.setup
    texts = tuple(program_text(file.data) for file in files)
    shapes = [
        shape_motions(program, contour_motions(file.data, program))
        for program, file in zip(setup.programs, files, strict=True)
    ]
    moves = CutMoves(setup.lines(), setup.numbers(), np.zeros(0, np.int32), tool_inks(*shapes))
    pieces = [_pieces(program, each) for program, each in zip(setup.programs, shapes, strict=True)]
    starts, ends = (np.concatenate([each[column] for each in pieces]) for column in (0, 1))
    looks = np.concatenate([each[2] for each in pieces])
    picture = picture_of(cut, moves, CutPaths(starts, ends, looks))
    progress.step(0.5, "Preparing the cut")
    prepare(picture, colour)
    counts = np.cumsum([0, *(len(program.motions) for program in setup.programs)])
    return ShownCut(
        cut,
        picture,
        tuple(file.name for file in files),
        texts,
        tuple(counts.tolist()),
        tuple(line_marks(len(text), each, files=shapes) for text, each in zip(texts, shapes, strict=True)),
        histogram=histogram_of(picture, cut.judgement) if cut.judgement is not None else None,
    )


def picture_of(cut: CutProgram, moves: CutMoves, paths: CutPaths | None = None) -> CutPicture:
    """Return what is left of the metal as a picture; nothing is prepared yet.

    Args:
        cut: the program, or a part of the stock. moves: what its motions are. paths: the way the tool went.
    """
    grid, judgement = cut.cut.before.grid, cut.judgement
    return CutPicture(
        np.ascontiguousarray(cut.cut.heights),
        grid.x0,
        grid.y0,
        grid.pitch,
        cut.floor,
        cut.top,
        cut.cut.owner,
        moves,
        judgement.deviation if judgement is not None else None,
        judgement.tolerance if judgement is not None else _DEFAULT_TOLERANCE,
        judgement.unreachable if judgement is not None else None,
        paths,
    )


def pieces_of_arcs(sweep: Floats, radius: Floats) -> NDArray[np.int64]:
    """Return in how many straight pieces arcs are drawn, each a power of two, so that few numbers differ.

    Args:
        sweep: (m,) radians, either way. radius: (m,) mm.
    """
    turn = np.clip(np.sqrt(8 * _CHORD_MM / np.maximum(radius, 1e-6)), _STEP_RAD / 16, _STEP_RAD)
    fine, coarse = (np.maximum(1.0, np.abs(sweep) / step) for step in (turn, _STEP_RAD))
    chosen = fine if fine.sum() <= _MOST_PIECES else coarse
    return 2 ** np.ceil(np.log2(chosen)).astype(np.int64)


def _pieces(program: NcProgram, shapes: MotionShapes) -> tuple[Floats, Floats, Bytes]:
    """Return start, end and look of straight pieces of the tool's way, in the order of going."""
    from ....model.motion_path import arc_paths

    motions, arcs = program.motions, arc_paths(program.motions)
    elsewhere = shapes.home.any(axis=1) | shapes.away.any(axis=1)
    straight = np.flatnonzero(~(elsewhere | np.isin(np.arange(len(motions)), arcs.rows)))
    order, begin, end = [straight], [motions.start[straight]], [motions.end[straight]]
    counts = pieces_of_arcs(arcs.sweep, np.maximum(arcs.start_radius, arcs.end_radius))
    for count in np.unique(counts).tolist():
        same = np.flatnonzero(counts == count)
        points = arcs.points(np.linspace(0.0, 1.0, count + 1))[same]
        order.append(np.repeat(arcs.rows[same], count))
        begin.append(points[:, :-1].reshape(-1, 3))
        end.append(points[:, 1:].reshape(-1, 3))
    rows = np.concatenate(order)
    sorting = np.argsort(rows, kind="stable")
    return np.concatenate(begin)[sorting], np.concatenate(end)[sorting], np.asarray(shapes.look)[rows[sorting]]
