"""Opening drawings in the background; tells what has to be asked before one can be read."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from ....core.atomic import read_whole
from ....core.errors import InputError
from ....core.progress import Progress
from ....core.resources import resource
from ....drafting.document import Document
from ....geometry.sample import Box, bounds, union
from ....model.job import Job
from ....model.part import Part
from ....model.reading import AS_THE_FILE_SAYS, DrawingSource, ReadingOptions
from ...framework.worker import JobOutcome, Worker

if TYPE_CHECKING:
    from ....formats.drawing import Drawing
    from ....formats.project.files import Stamp
    from ....formats.project.project import Project
    from ....formats.reading_question import ReadingQuestion


@dataclass(frozen=True)
class OpenedDrawing:
    """A drawing that was read.

    Attributes:
        path: the file. drawing: what it holds. job: the job to work on, with the tools that were there before.
        extent: x0, y0, x1, y1, mm; None where nothing is drawn.
        source: the drawing, and how it was read; None of what can be read in one way alone.
        project: what a project file holds beside its job; None for a drawing. stamp: of that file.
    """

    path: Path
    drawing: Drawing
    job: Job
    extent: Box | None = None
    source: DrawingSource | None = None
    project: Project | None = None
    stamp: Stamp | None = None

    @property
    def size(self) -> tuple[float, float]:
        """Width and height, mm; 0 where nothing is drawn."""
        return (0.0, 0.0) if self.extent is None else size_of(self.extent)


@dataclass(frozen=True)
class UndecidedDrawing:
    """A drawing that was not read, for somebody has to say how."""

    path: Path
    question: ReadingQuestion


def extent_of(part: Part, without: tuple[str, ...] = ()) -> Box | None:
    """Return x0, y0, x1, y1 of what is drawn but on some layers, mm; None when nothing is."""
    return union([bounds(entity.curve) for entity in part.entities if entity.layer not in without])


def size_of(box: Box) -> tuple[float, float]:
    """Return width and height of a box."""
    return (box[2] - box[0], box[3] - box[1])


SAMPLE_PROGRAMS = ("facets", "points", "raster", "valley")
"""NC programs that come with the program: text D, text E, and both over surfaces."""


def sample_path() -> Path:
    """Return the drawing that a first start shows."""
    return resource("samples", "fig2.dxf")


def is_sample(path: Path) -> bool:
    """Return whether a file comes with the program."""
    return path.parent == sample_path().parent


def read_drawing_file(
    path: Path, reading: ReadingOptions, before: Job, progress: Progress
) -> OpenedDrawing | UndecidedDrawing:
    """Return a drawing, with the job to work on.

    Args:
        path: of the file. reading: how it is read.
        before: the job that goes on with this drawing.

    Raises:
        HitofudeError: it cannot be used. Cancelled: `progress` says so.
    """
    from ....formats.readers import format_of
    from ....formats.reading_question import UndecidedError
    from ....usecases.job.options import MakeOptions
    from ....usecases.job.plausible import diameters_used, read_plausible
    from ....usecases.making.make import job_from_drawing  # imports the DXF reader: never on the window's thread

    progress.step(0.05, f"Reading {path.name}")
    try:
        data = read_whole(path)
    except OSError as error:
        raise InputError(f"Cannot read {path}: {error.strerror}. Choose another file.") from error
    try:
        drawing = read_plausible(path.name, data, reading, lambda _: diameters_used(before))
    except UndecidedError as error:
        if error.question is None:
            raise
        return UndecidedDrawing(path, error.question)
    progress.step(0.9, f"Reading {path.name}")
    drawing = replace(drawing, part=_shown(drawing.part, reading.layers))
    job = job_from_drawing(drawing, MakeOptions(job=before))
    source = DrawingSource(str(path.absolute()), reading) if format_of(path.name).foreign else None
    return OpenedDrawing(path, drawing, job, extent_of(job.part), source)


def _shown(part: Part, layers: tuple[str, ...]) -> Part:
    """Return a part with layers shown that were asked for by name."""
    wanted = {layer.casefold() for layer in layers}
    return replace(
        part,
        layers=tuple(replace(each, visible=each.visible or each.name.casefold() in wanted) for each in part.layers),
    )


def _read(path: Path, reading: ReadingOptions, before: Job, progress: Progress) -> OpenedDrawing | UndecidedDrawing:
    from ....formats.project import SUFFIXES

    if path.suffix.lower() in SUFFIXES:
        progress.step(0.05, f"Reading {path.name}")
        return _read_project(path)
    return read_drawing_file(path, reading, before, progress)


def _read_project(path: Path) -> OpenedDrawing:
    from ....formats.drawing import Drawing
    from ....formats.project.files import load_project

    project, stamp = load_project(path)
    project = replace(project, state=project.state.named(path.stem))
    job = project.state.job
    part = job.part
    return OpenedDrawing(path, Drawing(part), job, extent_of(part, job.keep_out_layers), None, project, stamp)


class OpenController(QObject):
    """Reads a drawing and loads it into the document.

    Signals:
        read(OpenedDrawing): the document will hold it next. opened(OpenedDrawing): the document holds it now.
            failed(sentence).
        asked(UndecidedDrawing): it is not opened before somebody has said how it is to be read.
        opening_changed(name): this file is being read now, or none, "".
    """

    read = Signal(OpenedDrawing)
    opened = Signal(OpenedDrawing)
    asked = Signal(UndecidedDrawing)
    failed = Signal(str)
    opening_changed = Signal(str)

    def __init__(self, document: Document, worker: Worker) -> None:
        super().__init__()
        self._document, self._worker = document, worker
        self._job_id: int | None = None
        self._name = ""
        self._then: Callable[[], None] | None = None
        worker.done.connect(self._on_done)
        worker.failed.connect(self._on_failed)
        worker.busy_changed.connect(lambda _: self.opening_changed.emit(self.opening))

    @property
    def opening(self) -> str:
        """Name of the file that is being read; "" = none is."""
        return self._name if self._job_id is not None and self._job_id == self._worker.job_id else ""

    def open(self, path: Path, reading: ReadingOptions = AS_THE_FILE_SAYS, before: Job | None = None) -> None:
        """Read a drawing; the document changes only when it has been read whole.

        Args:
            path: a drawing or a project.
            reading: how a drawing is read.
            before: the job that goes on with a drawing; None = the document's.
        """
        before, self._then = before or self._document.job, None
        self._name = path.name
        self._job_id = self._worker.start(
            lambda progress: _read(path, reading, before, progress), self._document.revision
        )
        self.opening_changed.emit(self.opening)

    def once_open(self, action: Callable[[], None]) -> None:
        """Do something with the drawing that is being read as soon as it is open, or else at once."""
        if self.opening:
            self._then = action
        else:
            action()

    def _on_done(self, answer: JobOutcome) -> None:
        if answer.job_id != self._job_id:
            return
        if isinstance(answer.value, UndecidedDrawing):
            self.asked.emit(answer.value)
        elif isinstance(answer.value, OpenedDrawing):
            self._take(answer, answer.value)

    def _take(self, answer: JobOutcome, opened: OpenedDrawing) -> None:
        if answer.revision != self._document.revision and self._document.modified:
            self.failed.emit(
                f"The drawing was changed while {opened.path.name} was being read, so it was kept. Open the file again."
            )
            return
        self.read.emit(opened)
        if opened.project is not None:
            self._document.load_state(opened.project.state, opened.path)
        else:
            self._document.load(opened.job, opened.path, opened.source)
        self.opened.emit(opened)
        then, self._then = self._then, None
        if then is not None:
            then()

    def _on_failed(self, answer: JobOutcome) -> None:
        if answer.job_id == self._job_id:
            self.failed.emit(answer.error or "")
