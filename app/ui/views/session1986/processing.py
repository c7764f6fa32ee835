"""What the data processing unit does between two questions: from a shape to its paths on 400 x 400 points. On a worker;
no Qt.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import dropwhile, takewhile
from typing import TYPE_CHECKING

import numpy as np

from ....core.errors import GeometryError
from ....core.progress import NO_PROGRESS, Progress
from ....core.resources import resource
from ....model.finding import Finding
from ....model.job import Job
from ....raster.frame import POINTS, BitmapFrame
from ....raster.steps import StepState
from ....usecases.pixels.options import MARGIN_PX, BitmapSize
from .answers import EnteredOffsets, job_of
from .screen import BOTTOM, TOP
from .stills import ScreenStill, still_of, stills_of

if TYPE_CHECKING:
    from ....raster.trace import PixelChain
    from ....usecases.pixels.part import BitmapPart
    from ....usecases.pixels.way import OperationPaths

_SAID = 3
"""Findings that are told in the dialogue."""


@dataclass(frozen=True)
class ScreenSize(BitmapSize):
    """400 x 400 points, of which a drawing takes up the rows that are not for the dialogue."""

    def frame(self, extent: tuple[float, float, float, float]) -> BitmapFrame:
        """Return a frame with the extent, x0, y0, x1, y1, mm, in the middle of the picture's rows."""
        x0, y0, x1, y1 = extent
        pitch = max((x1 - x0) / (POINTS - 2 * MARGIN_PX), (y1 - y0) / (BOTTOM - TOP - 2 * MARGIN_PX)) or 0.25
        below = POINTS - (TOP + BOTTOM) / 2
        return BitmapFrame(POINTS, POINTS, pitch, (x0 + x1) / 2 - POINTS / 2 * pitch, (y0 + y1) / 2 - below * pitch)


@dataclass(frozen=True, eq=False)
class EnteredShape:
    """A shape that was entered (step 110).

    Attributes:
        job: with its drawing. part: its points. still: what the display shows. notes: sentences about the drawing.
    """

    job: Job
    part: BitmapPart
    still: ScreenStill
    notes: tuple[str, ...] = ()

    @property
    def pitch(self) -> float:
        """Size of a point, mm."""
        return self.part.frame.pitch

    @property
    def widest(self) -> float:
        """Half of the shape's shorter side, mm: no tool that fits into it is larger."""
        rows, cols = np.nonzero(self.part.free)
        return min(int(np.ptp(rows)) + 1, int(np.ptp(cols)) + 1) * self.pitch / 2


@dataclass(frozen=True, eq=False)
class ShapeOutline:
    """Steps 120 and 130.

    Attributes:
        stills: of steps 120, 201-208 and 130.
    """

    stills: tuple[ScreenStill, ...]


@dataclass(frozen=True, eq=False)
class ShapePaths:
    """Step 140, smoothing, and the program.

    Attributes:
        job: with both tools. stills: of steps 141-148, 301-307, 140 and 401-407. listing: the NC program's lines.
        notes: sentences about the paths.
    """

    job: Job
    stills: tuple[ScreenStill, ...]
    listing: tuple[str, ...]
    notes: tuple[str, ...] = ()


def sample_job(before: Job, progress: Progress = NO_PROGRESS) -> Job:
    """Return a job with the drawing of figure 2 and the tools of another."""
    from ....formats.readers import read_drawing

    path = resource("samples", "fig2.dxf")
    progress.step(0.1, "Reading the sample")
    return replace(before, part=read_drawing(path.name, path.read_bytes(), None, ()).part, layer_names=())


def shape_of(job: Job, progress: Progress = NO_PROGRESS) -> EnteredShape:
    """Draw a job's drawing into the display memory.

    Raises:
        HitofudeError: nothing in it is closed.
    """
    from ....usecases.making.bitmap_job import drawn_job

    progress.step(0.2, "Drawing")
    drawn = drawn_job(job, ScreenSize())
    still = still_of(StepState(110, (drawn.part.drawn != 0).astype(np.uint8)))
    return EnteredShape(job, drawn.part, still, _notes(drawn.findings))


def outline_of(shape: EnteredShape, given: EnteredOffsets, progress: Progress = NO_PROGRESS) -> ShapeOutline:
    """Offset the contours by the contour tool's radius and fill what they bound.

    Raises:
        HitofudeError: the tool does not fit into the shape.
    """
    from ....exhibits.stages import stages
    from ....usecases.pixels.way import operation_paths

    job = job_of(shape.job, given)
    paths = operation_paths(job, 1, shape.part, progress.part(0.0, 0.8))
    if not paths.area.any():
        raise GeometryError(
            f"? Nothing is left of the shape with an offset of {given.contour:g} mm. Enter a smaller one."
        )
    seen = takewhile(lambda stage: stage.number != 140, stages(job, shape.part, [paths]))
    after = (stage for stage in seen if stage.number != 110)
    return ShapeOutline(tuple(stills_of(after, _chains(paths))))


def paths_of(shape: EnteredShape, given: EnteredOffsets, progress: Progress = NO_PROGRESS) -> ShapePaths:
    """Compute the pocket tool's paths, smooth all, and write the program.

    Raises:
        HitofudeError: the pocket tool does not fit into what is filled.
    """
    from ....exhibits.stages import stages
    from ....gcode.posts import load_post
    from ....usecases.making.written import write_and_check
    from ....usecases.pixels.way import compute_on_bitmap

    job = job_of(shape.job, given)
    made = compute_on_bitmap(job, shape.part, progress.part(0.0, 0.6))
    pocket, contour = (next(each for each in made.paths if each.index == index) for index in (0, 1))
    if not pocket.levels or not pocket.levels[0]:
        raise GeometryError(
            f"? Nothing is left of the area with an offset of {given.pocket:g} mm. Enter a smaller one."
        )
    progress.step(0.6, "Writing the program")
    files = write_and_check(made.program, job, load_post(job.post), None, progress.part(0.6, 0.9)).files
    own = dropwhile(lambda stage: stage.number != 301, stages(job, shape.part, made.paths))
    stills = tuple(stills_of(own, _chains(contour), [*_chains(contour), *_chains(pocket)]))
    again = tuple(still for still in stills if still.number == 140)
    listing = tuple(line for file in files for line in file.nc.text.splitlines())
    given_up = (
        f"The paths keep up to {made.given_up.most_mm:.3f} mm more from the walls than asked, for the points' sake."
    )
    return ShapePaths(job, (*stills, *again), listing, (*_notes(made.program.findings), given_up))


def _chains(paths: OperationPaths) -> Sequence[PixelChain]:
    """Return the outermost paths."""
    return [path.chain for path in paths.levels[0]]


def _notes(findings: Sequence[Finding]) -> tuple[str, ...]:
    """Return the sentences of what counts, and how much more there is."""
    found = [finding.text for finding in findings if finding.counts]
    more = (f"{len(found) - _SAID} more like it.",) if len(found) > _SAID else ()
    return (*found[:_SAID], *more)
