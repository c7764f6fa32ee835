"""From a job to its films: the bitmap way of 1986, computed on a worker. No Qt."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from ....core.errors import ParameterError
from ....core.progress import NO_PROGRESS, Progress
from ....model.job import Job
from ....raster.frame import STAGES_BYTES
from ....usecases.pixels.options import BitmapSize
from .film import Film, film_of

if TYPE_CHECKING:
    from ....usecases.pixels.part import BitmapPart
    from ....usecases.pixels.way import BitmapProgram

MOST_PX = 2048 * 2048
"""Pixels of the largest bitmap that is shown stage by stage."""


@dataclass(frozen=True, eq=False)
class FilmRequest:
    """What is to be shown.

    Attributes:
        job: its tools and operations. size: of the bitmap, for drawings.
        pixels: what a picture shows, in the place of a drawing; None = the job's drawing.
        published: fill as the text has it, wrong pixels marked; else by the settled rule.
    """

    job: Job
    size: BitmapSize
    pixels: BitmapPart | None = None
    published: bool = False

    def same_paths(self, other: FilmRequest) -> bool:
        """Whether another wish has the same paths, and only its fill may be another."""
        return self.job.same_paths(other.job) and self.size == other.size and self.pixels is other.pixels


@dataclass(frozen=True, eq=False)
class FilmSet:
    """What was computed.

    Attributes:
        request: for which. job: whose paths are shown, that of the request unless its operations choose curves.
        part: the pixels. made: the paths. films: of each variant that was asked for, by `published`.
    """

    request: FilmRequest
    job: Job
    part: BitmapPart
    made: BitmapProgram
    films: dict[bool, Film]

    @property
    def film(self) -> Film:
        """The one that was wished for."""
        return self.films[self.request.published]


def film_set_of(request: FilmRequest, before: FilmSet | None = None, progress: Progress = NO_PROGRESS) -> FilmSet:
    """Compute the bitmap way of a job, and film its stages.

    Args:
        before: made earlier; what it has in common with the wish is not made again.

    Raises:
        HitofudeError: nothing is closed, the bitmap would be too large, or it is too coarse for a tool.
        Cancelled: by progress.
    """
    from ....exhibits.stages import Variant, stages
    from ....usecases.pixels.way import compute_on_bitmap  # imports the engines: never on the window's thread

    if before is not None and request.same_paths(before.request):
        if request.published in before.films:
            return replace(before, request=request)
        job, part, made, films = before.job, before.part, before.made, dict(before.films)
    else:
        progress.step(0.0, "Drawing the pixels")
        job = _shown_job(request.job)
        part, films = request.pixels or _drawn(job, request.size), {}
        _check(part, request.pixels is not None)
        made = compute_on_bitmap(job, part, progress.part(0.02, 0.6))
    variant = Variant.PUBLISHED if request.published else Variant.SETTLED
    films[request.published] = film_of(
        stages(job, part, made.paths, variant), _about(part, made), progress.part(0.6, 1.0)
    )
    return FilmSet(request, job, part, made, films)


def _shown_job(job: Job) -> Job:
    """Return the job, or, where operations choose curves, that by the rule of 1986, which knew no such choice."""
    from ....usecases.proposal.propose import as_in_1986

    choosing = any(operation.cut.curves for operation in job.operations if operation.cut.enabled)
    return as_in_1986(job).job if choosing else job


def _drawn(job: Job, size: BitmapSize) -> BitmapPart:
    from ....usecases.making.bitmap_job import drawn_job

    return drawn_job(job, size).part


def _check(part: BitmapPart, picture: bool) -> None:
    """Refuse a bitmap whose stages would not fit in memory.

    Raises:
        ParameterError: it has too many pixels.
    """
    frame = part.frame
    if frame.rows * frame.cols > MOST_PX:
        raise ParameterError(
            f"The bitmap has {frame.cols} x {frame.rows} px; up to {MOST_PX / 1e6:.1f} million are shown stage by "
            "stage, so use a larger pitch, or a smaller picture."
        )
    frame.ask_memory(STAGES_BYTES, picture)


def _about(part: BitmapPart, made: BitmapProgram) -> int:
    """Return about how many stages there will be, for the progress."""
    peels = max((int(paths.steps.first) for paths in made.paths), default=0)
    levels = max((len(paths.levels) for paths in made.paths), default=0)
    return 20 + len(part.regions) * (4 * peels + 8) + 3 * levels
