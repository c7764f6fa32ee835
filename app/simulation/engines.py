"""Which engine computes heights, and what happens when the graphics system cannot, or lies.

The engine of record runs on the processor. Graphics systems are tried on a small job before anything is believed of
them, and what they compute is compared with the engine of record wherever that has run as well.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from enum import Enum
from functools import cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..core.errors import HitofudeError
from ..core.progress import NO_PROGRESS, Progress
from ..model.motion import Floats
from .cutter import Cutter
from .field.workpiece import TOLERANCE, HeightDifference, Heights, Workpiece, height_difference, lowest_nearby
from .gpu.graphics import has_device, is_software, renderer_of, standalone_context
from .sweeps.course import Course
from .trial import CUTTERS, record, trial, tried

if TYPE_CHECKING:
    import moderngl

Cutters = Mapping[int, Cutter]
"""By T number."""


class CutStep(NamedTuple):
    """What is cut, along what, with what."""

    workpiece: Workpiece
    course: Course
    cutters: Cutters


Compute = Callable[["moderngl.Context", Workpiece, Course, Cutters, Progress], Heights]
"""Heights that a course leaves, on a graphics context that is current."""

EIGHT_BITS = 1.0 / 256.0
"""Cells; graphics systems round corners of facets to that."""


class Engine(Enum):
    """What computes heights.

    AUTO takes graphics hardware where there is some that passes its trial, else the processor.
    """

    AUTO = "auto"
    CPU = "cpu"
    GPU = "gpu"
    PATENT = "patent"


def quads(ctx: moderngl.Context, workpiece: Workpiece, course: Course, cutters: Cutters, progress: Progress) -> Heights:
    """Compute heights by a quad for each piece of the path; see `quad_heights`."""
    from .gpu.quads import quad_heights

    return quad_heights(ctx, workpiece, course, cutters, progress)


def published_in(facet: float | None) -> Compute:
    """Return what computes heights as it was published, by facets in the depth buffer, of a size, mm, or as usual; see
    `DepthBuffer`.
    """

    def compute(
        ctx: moderngl.Context, workpiece: Workpiece, course: Course, cutters: Cutters, progress: Progress
    ) -> Heights:
        from .gpu.depth_buffer import DepthBuffer, tessellation

        engine = DepthBuffer(ctx, tessellation(workpiece.grid, cutters.values(), facet))
        try:
            return engine.heights(workpiece, course, cutters, progress)
        finally:
            engine.release()

    return compute


published: Compute = published_in(None)


@dataclass(frozen=True)
class Graphics:
    """A graphics system.

    Attributes:
        present: returns whether there may be hardware, without asking OpenGL.
        opened: returns a context of its own, which is not current.
        quads, published: compute heights on it.
    """

    opened: Callable[[], moderngl.Context] = standalone_context
    quads: Compute = quads
    published: Compute = published
    present: Callable[[], bool] = has_device

    @contextmanager
    def current(self) -> Iterator[moderngl.Context]:
        """Yield a context that is current on this thread, for as long as the job takes.

        Raises:
            HitofudeError: there is no OpenGL.
        """
        context = self.opened()
        try:
            with context:
                yield context
        finally:
            context.release()


@dataclass(frozen=True, slots=True)
class EngineTrial:
    """How a graphics system has done the small job.

    Attributes:
        renderer: its name; empty where there is none.
        fault: what is wrong with it, the end of a sentence; empty if nothing is.
    """

    renderer: str
    fault: str


@cache
def trial_of(graphics: Graphics, engine: Engine) -> EngineTrial:
    """Return how a graphics system does the small job with an engine, GPU or PATENT; each is tried once."""
    renderer, compute = "", graphics.quads
    allowed: float | Floats = TOLERANCE
    if engine is Engine.PATENT:
        piece, course = trial()
        compute, allowed = (
            graphics.published,
            _allowed(record(), published_error(piece, course, CUTTERS), piece.grid.pitch),
        )
    try:
        with graphics.current() as context:
            renderer = renderer_of(context)
            found = tried(lambda *job: _computed(compute, context, CutStep(*job), NO_PROGRESS), allowed)
    except HitofudeError as error:
        return EngineTrial(renderer, str(error).rstrip("."))
    except Exception as error:  # whatever a driver comes up with
        return EngineTrial(renderer, f"{renderer or 'the graphics system'} fails ({_words(error)})")
    if found.agrees:
        return EngineTrial(renderer, "")
    return EngineTrial(
        renderer,
        f"{renderer} computes wrong heights, in a trial up to {found.largest:.3g} mm off in {found.cells} cells",
    )


@cache
def hardware(graphics: Graphics) -> bool:
    """Return whether a graphics system is hardware that can be believed; what is none need not be tried."""
    if not graphics.present():
        return False
    try:
        with graphics.current() as context:
            if is_software(renderer_of(context)):
                return False
    except Exception:  # whatever a driver comes up with: nobody has asked for it
        return False
    return not trial_of(graphics, Engine.GPU).fault


@dataclass(frozen=True, slots=True)
class EngineReport:
    """What has computed the heights of a cut.

    Attributes:
        engine: never AUTO.
        renderer: name of the graphics system; empty for the processor.
        difference: how far its heights are from those of the engine of record, where that has run as well.
        error: how far at most, square to the surface, they may be from exact, mm, beside rounding.
        fault: why the engine that was asked for has not computed them; empty: it has.
        facet: size of the facets of the published method, mm; 0 = it has not computed them.
    """

    engine: Engine
    renderer: str = ""
    difference: HeightDifference | None = None
    error: float = 0.0
    fault: str = ""
    facet: float = 0.0


class HeightEngine:
    """Computes heights for one job, program after program; what fails once is not tried again.

    Attributes:
        report: what has computed them so far.
    """

    def __init__(self, engine: Engine, graphics: Graphics, facet: float | None = None) -> None:
        """Prepare for an engine, not AUTO; the published one has facets of a size, mm, or as usual."""
        self._facet = facet
        chosen: dict[Engine, Compute] = {
            Engine.GPU: graphics.quads,
            Engine.PATENT: graphics.published if facet is None else published_in(facet),
        }
        self._graphics, self._compute = graphics, chosen.get(engine)
        self.report = EngineReport(engine)
        done = trial_of(graphics, engine) if self._compute is not None else EngineTrial("", "")
        if done.fault:
            self._fall_back(done.fault)
        elif done.renderer:
            self.report = EngineReport(engine, done.renderer)

    @property
    def requested(self) -> bool:
        """Whether heights beside those of the engine of record are to be computed."""
        return self._compute is not None

    def alone(self, step: CutStep, progress: Progress = NO_PROGRESS) -> Heights | None:
        """Return what a course leaves of a work piece; None: the engine of record must compute it.

        Raises:
            HitofudeError: it cannot be cut. Cancelled: the job was asked to stop.
        """
        if self._compute is None:
            return None
        with ExitStack() as stack:
            try:
                context = stack.enter_context(self._graphics.current())
            except Exception as error:  # whatever a driver comes up with
                self._fall_back(f"{self.report.renderer} cannot be had again ({_words(error)})")
                return None
            try:
                return _computed(self._compute, context, step, progress)
            except HitofudeError:
                raise
            except Exception as error:
                self._fall_back(f"{self.report.renderer} fails ({_words(error)})")
                return None

    def beside(self, record: Heights, step: CutStep, progress: Progress = NO_PROGRESS) -> Heights:
        """Return what a course leaves of a work piece, compared with the heights of the engine of record.

        Args:
            record: heights of the engine of record; they are returned where others fail or disagree.
            step: what is cut.
        """
        heights = self.alone(step, progress)
        if heights is None:
            return record
        patent = self.report.engine is Engine.PATENT
        error = published_error(*step, self._facet) if patent else 0.0
        found = height_difference(record, heights, _allowed(record, error, step.workpiece.grid.pitch))
        if not found.agrees:
            self._fall_back(
                f"{self.report.renderer} computes heights up to {found.largest:.3g} mm off, in {found.astray} cells by "
                "more than its stated error"
            )
            return record
        self.report = replace(
            self.report,
            difference=found.joined(self.report.difference),
            error=max(error, self.report.error),
            facet=published_facet(step.workpiece, step.cutters, self._facet) if patent else 0.0,
        )
        return heights

    def _fall_back(self, fault: str) -> None:
        self._compute, self.report = None, EngineReport(Engine.CPU, fault=fault)


def published_facet(workpiece: Workpiece, cutters: Cutters, facet: float | None = None) -> float:
    """Return how large the facets of the published method are, mm: as asked for, or as usual."""
    from .gpu.depth_buffer import tessellation

    return tessellation(workpiece.grid, cutters.values(), facet).facet


def published_error(workpiece: Workpiece, course: Course, cutters: Cutters, size: float | None = None) -> float:
    """Return how far the facets of the published method are at most from the surface, square to it, mm."""
    from .gpu.polyhedron import facet_error

    facet = published_facet(workpiece, cutters, size)
    used = [cutters[number] for number in np.unique(course.tool).tolist() if number in cutters]
    return max((facet_error(cutter, facet) for cutter in used), default=0.0)


def _allowed(record: Heights, error: float, pitch: float) -> float | Floats:
    """Return by how much heights may differ from those of the engine of record, mm; of facets that is more where it is
    steep.
    """
    if not error:
        return TOLERANCE
    low, high = lowest_nearby(record), -lowest_nearby(-record)
    steep = np.maximum(high - record, record - low) / pitch
    return np.asarray(TOLERANCE + 1.25 * error * np.hypot(1.0, steep) + EIGHT_BITS * pitch * steep)


def _computed(compute: Compute, context: moderngl.Context, step: CutStep, progress: Progress) -> Heights:
    """Compute heights; a graphics system that tells of an error has failed.

    Raises:
        RuntimeError: it does.
    """
    heights = compute(context, *step, progress)
    if (error := context.error) != "GL_NO_ERROR":
        raise RuntimeError(error)
    return heights


def _words(error: Exception) -> str:
    return " ".join(str(error).split())[:200] or type(error).__name__
