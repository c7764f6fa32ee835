"""What the NC view has made in the background: a frame, a restart, a comparison. Runs on the worker's thread."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from ....core.progress import Progress
from .motion_shapes import ViewSide
from .painting.motion_layer import MotionLayer
from .places import ComparedProgram, drawn_apart
from .program_reader import ProgramSource, ShownProgram, read_shown

if TYPE_CHECKING:
    from ....usecases.making.make import MakeResult


@dataclass(frozen=True, eq=False)
class ProjectedProgram:
    """A program seen from another side, and what it and the one that it is compared with do alone."""

    shown: ShownProgram
    picture: MotionLayer
    both: ComparedProgram | None
    alone: tuple[MotionLayer, MotionLayer] | None

    def keep(self) -> None:
        """Hand the pictures to what they are of; on the window's thread."""
        self.shown.pictures[self.picture.side] = self.picture
        if self.both is not None and self.alone is not None:
            self.both.pictures[self.picture.side] = self.alone


def framed(made: MakeResult, name: str, side: ViewSide, progress: Progress) -> ShownProgram:
    """Return the program that goes round a job's cuts, read.

    Raises:
        HitofudeError: nothing is cut.
        Cancelled: the job was asked to stop.
    """
    from ....gcode.posts import load_post

    return read_shown(
        ProgramSource(name, made.frame().encode(), dialect=load_post(made.job.post).dialect), side, progress
    )


def restarted(shown: ShownProgram, line: int, side: ViewSide, progress: Progress) -> ShownProgram:
    """Return the program that leads in to a line (1-based) of another and goes on from there, read.

    Raises:
        InputError: it cannot be safe from there.
        Cancelled: the job was asked to stop.
    """
    from ....gcode.rework.restart import RestartOptions, restart

    data = restart(
        shown.source.bytes(), line, RestartOptions(shown.source.options(shown.dialect)), progress.part(0.0, 0.5)
    )
    name = Path(shown.source.name)
    source = ProgramSource(
        f"{name.stem}-from-{line}{name.suffix}",
        data,
        dialect=shown.dialect,
        tools=shown.source.tools,
        units=shown.source.units,
    )
    return read_shown(source, side, progress.part(0.5, 1.0))


class ComparedWith(NamedTuple):
    """The program that was shown, and a second one held against it."""

    shown: ShownProgram
    other: ComparedProgram


def compared(shown: ShownProgram, other: ProgramSource, side: ViewSide, progress: Progress) -> ComparedWith:
    """Return the shown program as it was, and a second one held against it.

    Raises:
        InputError: the second one's file cannot be read.
        Cancelled: the job was asked to stop.
    """
    from ....gcode.rework.compare import compare

    second = read_shown(other, side, progress.part(0.0, 0.5))
    progress.step(0.5, "Comparing")
    differences = compare(shown.program, second.program, progress=progress.part(0.5, 0.9))
    return ComparedWith(
        shown, ComparedProgram(second, differences, {side: drawn_apart(shown, second, differences, side)})
    )


def projected(
    shown: ShownProgram, both: ComparedProgram | None, side: ViewSide, progress: Progress
) -> ProjectedProgram:
    """Return the pictures of another side.

    Raises:
        Cancelled: the job was asked to stop.
    """
    progress.step(0.0, "Preparing the picture")
    picture = MotionLayer(shown.shapes, side)
    progress.step(0.5, "Preparing the picture")
    return ProjectedProgram(
        shown, picture, both, drawn_apart(shown, both.other, both.differences, side) if both is not None else None
    )
