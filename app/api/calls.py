"""The calls of the Python door: files or jobs in, frozen results out. No call writes a file; a result's `save` does."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeVar

from ..core.errors import InputError
from ..core.input_file import FileBytes, read_input
from ..core.progress import NO_PROGRESS, Progress
from ..formats.drawing import Drawing
from ..formats.readers import read_drawing
from ..formats.scene.toml import read_scene, sources_of
from ..formats.tools.materials import stock_material
from ..model.job import Job
from ..model.machine import Machine
from ..model.operation import Operation
from ..model.part import Part, Units
from ..model.read_options import AS_DRAWN, DrawingOptions
from ..model.tool import Tool
from ..toolpath.feeds.proposal import CutEngagement, FeedProposal, proposed_feeds
from ..usecases.advice import AdviceOptions, ToolAdvice, advice_for
from ..usecases.batch.lanes import ExecutorLane, ProcessLane
from ..usecases.batch.run import BatchRun
from ..usecases.batch.task import BatchKind, BatchResult, BatchTask
from ..usecases.better.improve import better as better_program
from ..usecases.better.result import BetterOptions
from ..usecases.cutting.cut import CutOptions
from ..usecases.cutting.cut import cut as cut_programs
from ..usecases.cutting.ready_setup import SetupRequest, setup_of
from ..usecases.cutting.report import cut_report
from ..usecases.cutting.setup_tools import ToolSource
from ..usecases.examine import ExamineOptions, examine
from ..usecases.inlay import InlayOptions, inlay_of
from ..usecases.inlay import inlay as inlay_drawing
from ..usecases.job.options import MakeOptions
from ..usecases.making import make as usecase
from ..usecases.scene.compute import compute
from ..usecases.scene_program.nc import write_scene_nc
from ..usecases.scene_program.report import surface_report
from ..usecases.smoothing.result import SmoothOptions
from ..usecases.smoothing.smooth import smooth as smooth_text
from .results import BetterText, CheckedProgram, CutMetal, MadeInlay, MadeProgram, MadeSurface, SmoothedText
from .words import speaks_python

FilePath = str | os.PathLike[str]
Given = TypeVar("Given")


def _path(file: FilePath) -> Path:
    """Return the path of a file that a script names.

    Raises:
        InputError: it names none.
    """
    if not isinstance(file, str | os.PathLike):
        raise InputError(f"A file is named by its path, not by a {type(file).__name__}; save it, and give the path.")
    return Path(file)


def _given(value: Given | None, kind: type[Given], name: str) -> Given:
    """Return what a script gives for an argument, or what stands for nothing.

    Raises:
        InputError: it is of another kind.
    """
    if value is not None and not isinstance(value, kind):
        raise InputError(f"{name} is a {type(value).__name__}; it must be hitofude.{kind.__name__}(...).")
    return kind() if value is None else value


def _ensure_job(job: Job) -> None:
    """Refuse a job whose parts are of another kind, which a script may take for one another.

    Raises:
        InputError: it is one.
    """
    if not isinstance(job.part, Part):
        raise InputError(
            f"The job's part is a {type(job.part).__name__}; it must be the part of a drawing: read(...).part."
        )
    for name, kind, values in (("tools", Tool, job.tools), ("operations", Operation, job.operations)):
        if not isinstance(values, Sequence) or not all(isinstance(each, kind) for each in values):
            raise InputError(f"The job's {name} must be a tuple of {name}, such as ({name[:-1]},).")


@speaks_python
def read(
    drawing: FilePath, units: Units | None = None, layers: tuple[str, ...] = (), how: DrawingOptions = AS_DRAWN
) -> Drawing:
    """Return a drawing as it is read: its curves in mm, and what there is to say about the file.

    Args:
        drawing: a .dxf, .svg, .draw or .hito file.
        units: of a drawing that names none. layers: to keep; empty = all. how: what else is said about reading it.

    Raises:
        InputError: it cannot be read, or something that is said has no effect on it.
    """
    path = _path(drawing)
    if units is not None and not isinstance(units, Units):
        raise InputError(f"units is {units!r}; it must be Units.MM or Units.INCH.")
    return read_drawing(path.name, read_input(path), units, layers, how)


@speaks_python
def make(what: FilePath | Job, options: MakeOptions | None = None, progress: Progress = NO_PROGRESS) -> MadeProgram:
    """Return the NC program of a drawing or a job, read back and proven.

    Args:
        what: a drawing or a picture, or a job with its part, tools and operations.
        options: every one that is given overrides what the default job, or `options.job`, says; of a job, which says
            everything itself, the machine alone counts.

    Raises:
        HitofudeError: it cannot be used, or nothing in it can be cut with these tools.
        Cancelled: by progress.
    """
    asked = _given(options, MakeOptions, "options")
    if isinstance(what, Job):
        _ensure_job(what)
        return MadeProgram(usecase.export(what, progress, machine=asked.machine))
    path = _path(what)
    return MadeProgram(usecase.make(path.name, read_input(path), asked, progress))


@speaks_python
def inlay(
    what: FilePath | Job,
    options: MakeOptions | None = None,
    wished: InlayOptions | None = None,
    progress: Progress = NO_PROGRESS,
) -> MadeInlay:
    """Return the programs of a V-carved pocket and of the plug that fits into it, and how they fit.

    Args:
        what: a drawing, or a job with its part.
        options: of a drawing, with a job of one operation, a V-carving with its flat tool.
        wished: glue, gap, and how far the plug stands out.

    Raises:
        HitofudeError: it cannot be used.
        Cancelled: by progress.
    """
    fitting, asked = _given(wished, InlayOptions, "wished"), _given(options, MakeOptions, "options")
    if isinstance(what, Job):
        _ensure_job(what)
        return MadeInlay(inlay_of(what, fitting, progress))
    path = _path(what)
    return MadeInlay(inlay_drawing(path.name, read_input(path), asked, fitting, progress))


@speaks_python
def tools(drawing: FilePath, options: AdviceOptions | None = None, progress: Progress = NO_PROGRESS) -> ToolAdvice:
    """Return which tools a drawing wants, and why: `advice.pocket`, `advice.contour`, what each reaches and leaves.

    Raises:
        HitofudeError: the drawing or a tool cannot be used, or nothing in it is closed.
        Cancelled: by progress.
    """
    path = _path(drawing)
    return advice_for(path.name, read_input(path), _given(options, AdviceOptions, "options"), progress)


@speaks_python
def feeds(
    tool: Tool, material: str, engagement: CutEngagement | None = None, machine: Machine | None = None
) -> FeedProposal:
    """Return speed and feeds of a tool in a material, each number with its reason.

    Args:
        material: its word, such as "aluminium". engagement: how much of the tool is in metal; without it a full slot.
        machine: that bounds them; None = a usual one.

    Raises:
        InputError: there is no such material.
    """
    return proposed_feeds(tool, stock_material(material), _given(engagement, CutEngagement, "engagement"), machine)


@speaks_python
def check(program: FilePath, options: ExamineOptions | None = None, progress: Progress = NO_PROGRESS) -> CheckedProgram:
    """Return what there is to know of an NC program, read as its control would.

    Raises:
        InputError: it cannot be read at all; what is wrong in it is among the problems.
        Cancelled: by progress.
    """
    path = _path(program)
    return CheckedProgram(examine(path.name, read_input(path), _given(options, ExamineOptions, "options"), progress))


@speaks_python
def cut(
    *programs: FilePath,
    against: FilePath | None = None,
    tools: Mapping[int, Tool] | None = None,
    request: SetupRequest | None = None,
    options: CutOptions | None = None,
    progress: Progress = NO_PROGRESS,
) -> CutMetal:
    """Return what NC programs, one after the other, leave of their stock.

    Args:
        programs: files, at least one.
        against: the part that is wanted: a drawing, a solid (.stl), or a scene (.toml).
        tools: by T number; those that are not here are as the programs tell.
        request: what else is said of stock, depth, origin; `against` and `tools` are put into it.
        options: how finely to look.

    Raises:
        HitofudeError: a file cannot be read, or a tool or the stock is not known.
        Cancelled: by progress.
    """
    paths, request = [_path(program) for program in programs], _given(request, SetupRequest, "request")
    if not paths:
        raise InputError("There is no program to cut; name one at least.")
    if against is not None:
        part = _path(against)
        request = replace(request, against=FileBytes(part.name, read_input(part)), beside=_reader_beside(part))
    if tools:
        request = replace(request, tools=(ToolSource("the script", dict(tools)), *request.tools))
    shares = [progress.part(0.2 * k / len(paths), 0.2 * (k + 1) / len(paths)) for k in range(len(paths))]
    examined = tuple(
        examine(path.name, read_input(path), ExamineOptions(), share) for path, share in zip(paths, shares, strict=True)
    )
    ready = setup_of(examined, request, progress.part(0.2, 0.25))
    done = cut_programs(ready.setup, _given(options, CutOptions, "options"), progress.part(0.25, 1.0))
    return CutMetal(cut_report(done, ready), done, paths[0].name)


@dataclass(frozen=True)
class BatchPart:
    """A part of a batch: a file, and with which options it is made, checked or smoothed."""

    path: FilePath
    options: MakeOptions | ExamineOptions | SmoothOptions


@speaks_python
def batch(
    parts: Sequence[BatchPart],
    jobs: int | None = None,
    executor: Executor | None = None,
    progress: Progress = NO_PROGRESS,
) -> tuple[BatchResult, ...]:
    """Return what became of each part, in their order; one that fails, or whose process is killed, harms none.

    Args:
        parts: the same file may be among them with several options, which makes a study.
        jobs: parts at a time; None = one a core.
        executor: where they are done, such as Dask's `Client.get_executor()`; None = in processes of this machine, so
            that a script has to stand under `if __name__ == "__main__":`.

    Raises:
        InputError: a file cannot be read.
        Cancelled: by progress.
    """
    tasks = [_task(number, part) for number, part in enumerate(parts)]
    count = max(1, min(jobs or os.cpu_count() or 1, len(tasks)))
    lanes = [ProcessLane() if executor is None else ExecutorLane(executor) for _ in range(count)]
    done: dict[int, BatchResult] = {}
    BatchRun(tasks, lanes, done.__setitem__).run(progress)
    return tuple(done[number] for number in range(len(tasks)))


def _task(number: int, part: BatchPart) -> BatchTask:
    if not isinstance(part, BatchPart):
        raise InputError(f"parts[{number}] is a {type(part).__name__}; it must be hitofude.BatchPart(path, options).")
    path, kind = _path(part.path), _KINDS.get(type(part.options))
    if kind is None:
        known = ", ".join(each.__name__ for each in _KINDS)
        raise InputError(
            f"parts[{number}] has a {type(part.options).__name__} for options; it must have one of {known}."
        )
    return BatchTask(path.name, read_input(path), kind, part.options, f"{number}/{path.stem}.ngc")


_KINDS = {MakeOptions: BatchKind.MAKE, ExamineOptions: BatchKind.CHECK, SmoothOptions: BatchKind.SMOOTH}
"""What is done with a part of a batch, by its options."""


@speaks_python
def smooth(program: FilePath, options: SmoothOptions | None = None, progress: Progress = NO_PROGRESS) -> SmoothedText:
    """Return an NC program with its short straight moves as fewer lines, arcs or splines, proven within a tolerance.

    Raises:
        HitofudeError: it cannot be read, or not be written for the control.
        Cancelled: by progress.
    """
    path = _path(program)
    return SmoothedText(smooth_text(path.name, read_input(path), _given(options, SmoothOptions, "options"), progress))


@speaks_python
def better(
    program: FilePath,
    options: BetterOptions | None = None,
    request: SetupRequest | None = None,
    progress: Progress = NO_PROGRESS,
) -> BetterText:
    """Return a better program in place of one that goes over surfaces in passes, cut again and compared.

    Args:
        request: tools and stock that the program does not tell of itself.

    Raises:
        HitofudeError: it cannot be read, is no such program, or the tolerance does not hold its facets.
        Cancelled: by progress.
    """
    path, asked = _path(program), _given(options, BetterOptions, "options")
    return BetterText(
        better_program(path.name, read_input(path), asked, _given(request, SetupRequest, "request"), progress)
    )


@speaks_python
def surface(scene: FilePath, progress: Progress = NO_PROGRESS) -> MadeSurface:
    """Return the tool paths over the surfaces of a scene, written and proven.

    Args:
        scene: a .toml file; files that it names lie beside it.

    Raises:
        HitofudeError: it cannot be read, computed or written.
        Cancelled: by progress.
    """
    path = _path(scene)
    sources = sources_of(_reader_beside(path))
    computed = compute(read_scene(path.name, read_input(path)), sources, progress.part(0.0, 0.6))
    written = write_scene_nc(computed, progress.part(0.6, 1.0))
    return MadeSurface(surface_report(computed, written), written)


def _reader_beside(path: Path) -> Callable[[str], bytes]:
    """Return what reads the files that one names, which lie beside it."""
    return lambda name: read_input(path.parent / name)
