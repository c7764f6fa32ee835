"""Opening drawings in the background; asks for units when a drawing names none."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from app.atomic import read_whole
from app.edit.document import Document
from app.edit.sample import bounds, union
from app.errors import InputError
from app.model.job import Job
from app.model.part import Part, Units
from app.progress import Progress
from app.resources import resource
from app.ui.worker import Answer, Worker

if TYPE_CHECKING:
    from app.files.drawing import Drawing
    from app.files.project import Project
    from app.files.project_files import Stamp


@dataclass(frozen=True)
class Opened:
    """A drawing that was read.

    Attributes:
        path: the file. drawing: what it holds. job: the job to work on, with the tools that were there before.
        units: what the user said its units are; None when he was not asked.
        size: width and height, mm.
        project: what a project file holds beside its job; None for a drawing. stamp: of that file.
    """

    path: Path
    drawing: Drawing
    job: Job
    units: Units | None = None
    size: tuple[float, float] | None = None
    project: Project | None = None
    stamp: Stamp | None = None


def size_of(part: Part, without: tuple[str, ...] = ()) -> tuple[float, float] | None:
    """Return width and height of what is drawn but on some layers, mm; None when nothing is."""
    box = union([bounds(entity.curve) for entity in part.entities if entity.layer not in without])
    return None if box is None else (box[2] - box[0], box[3] - box[1])


def sample_path() -> Path:
    """Return the drawing that a first start shows."""
    return resource("samples", "fig2.dxf")


def _read(path: Path, units: Units | None, before: Job, progress: Progress) -> Opened:
    from app.files.drawing import PROJECTS, read_drawing  # imports the DXF reader: never on the window's thread
    from app.workflow.make import job_from_drawing
    from app.workflow.options import MakeOptions

    progress.step(0.05, f"Reading {path.name}")
    if path.suffix.lower() in PROJECTS:
        return _read_project(path)
    try:
        data = read_whole(path)
    except OSError as error:
        raise InputError(f"Cannot read {path}: {error.strerror}. Choose another file.") from error
    drawing = read_drawing(path.name, data, units, ())
    progress.step(0.9, f"Reading {path.name}")
    job = job_from_drawing(drawing, MakeOptions(job=before, units=units))
    return Opened(path, drawing, job, units, size_of(job.part))


def _read_project(path: Path) -> Opened:
    from app.files.drawing import Drawing
    from app.files.project_files import load_project

    project, stamp = load_project(path)
    project = replace(project, state=project.state.named(path.stem))
    job = project.state.job
    part = job.part
    return Opened(path, Drawing(part), job, None, size_of(part, job.keep_out_layers), project, stamp)


class Opening(QObject):
    """Reads a drawing and loads it into the document.

    Signals:
        read(Opened): the document will hold it next. opened(Opened): the document holds it now. failed(sentence).
    """

    read = Signal(Opened)
    opened = Signal(Opened)
    failed = Signal(str)

    def __init__(self, document: Document, worker: Worker) -> None:
        super().__init__()
        self._document, self._worker = document, worker
        self._job_id: int | None = None
        worker.done.connect(self._on_done)
        worker.failed.connect(self._on_failed)

    def open(self, path: Path, units: Units | None = None) -> None:
        """Read a drawing; the document changes only when it has been read whole.

        Args:
            path: a drawing or a project.
            units: of a drawing that names none; None = not asked yet.
        """
        before = self._document.job
        self._job_id = self._worker.start(lambda progress: _read(path, units, before, progress), self._document.revision)

    def _on_done(self, answer: Answer) -> None:
        if answer.job_id != self._job_id or not isinstance(answer.value, Opened):
            return
        if answer.revision != self._document.revision and self._document.modified:
            self.failed.emit(f"The drawing was changed while {answer.value.path.name} was being read, so it was kept. Open the file again.")
            return
        self.read.emit(answer.value)
        if answer.value.project is not None:
            self._document.load_state(answer.value.project.state, answer.value.path)
        else:
            self._document.load(answer.value.job, answer.value.path)
        self.opened.emit(answer.value)

    def _on_failed(self, answer: Answer) -> None:
        if answer.job_id == self._job_id:
            self.failed.emit(answer.error or "")
