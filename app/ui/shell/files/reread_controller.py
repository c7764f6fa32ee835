"""Reading the document's drawing again, in another way or as its file is now: one step that can be undone."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from ....core.atomic import read_whole
from ....core.errors import InputError
from ....core.progress import Progress
from ....drafting.document import DocumentChange
from ....model.finding import Finding
from ....model.part import Part
from ....model.reading import DrawingSource, ReadingOptions
from ...framework.figures import counted, grouped
from ...framework.worker import JobOutcome, Worker
from ...framework.workspace import Workspace
from ...panels.reading_section import ReadingSection
from ..bars.question_card import QuestionCard
from .open_controller import OpenedDrawing, UndecidedDrawing, read_drawing_file

if TYPE_CHECKING:
    from ....formats.reading_question import FileContents


@dataclass(frozen=True)
class _RereadDrawing:
    """A drawing as it was read, and what reading it had to say."""

    part: Part
    findings: tuple[Finding, ...]


@dataclass(frozen=True)
class _SourceContents:
    """What the file of a source holds."""

    path: str
    contents: FileContents


class RereadController(QObject):
    """Answers the section "Reading" of the drawing's page.

    Signals:
        failed(sentence): the drawing cannot be read so; it stays as it is. taken(): it was read in another way.
        possible(bool): whether there is something to read again.
    """

    failed = Signal(str)
    taken = Signal()
    possible = Signal(bool)

    def __init__(self, section: ReadingSection, card: QuestionCard, worker: Worker, workspace: Workspace) -> None:
        """Make one; `worker` is the one that opens drawings, so that either takes the other's place."""
        super().__init__(section)
        self._section, self._card, self._worker = section, card, worker
        self._workspace, self._log, self._document = workspace, workspace.log, workspace.document
        self._known: dict[DrawingSource, _RereadDrawing] = {}
        self._job_id: int | None = None
        self._looking = Worker(self, head_start_s=0.0)
        self._section.wanted.connect(self.ask)
        self._section.again.connect(self._ask_again)
        self._section.looked.connect(self._look)
        self._looking.done.connect(self._on_looked)
        self._looking.failed.connect(lambda answer: self._section.show_contents(None, answer.error or ""))
        worker.done.connect(self._on_done)
        worker.failed.connect(self._on_failed)
        worker.cancelled.connect(self._on_cancelled)
        workspace.activity.ended.connect(self._looking.finish)
        self._document.subscribe(self._on_change)
        self.possible.emit(False)

    def know(self, opened: OpenedDrawing) -> None:
        """Take over what opening the document has told of its drawing."""
        if opened.source is not None:
            self._looking.cancel()
            self._remember(opened.source, opened)

    def _remember(self, source: DrawingSource, opened: OpenedDrawing) -> None:
        self._known[source] = _RereadDrawing(opened.job.part, opened.drawing.findings)
        self._section.show_contents(opened.drawing.contents)

    def ask(self, reading: ReadingOptions) -> None:
        """Read the drawing in another way, after asking where that would replace what was drawn in it."""
        source = self._document.state.source
        if source is None:
            return
        known = self._known.get(source)
        if known is not None and known.part is self._document.part:
            self.read(reading)
            return
        name = Path(source.path).name
        self._workspace.notice.ask(
            f"Reading {name} again replaces what was drawn in it since; Undo brings it back.",
            [("Read again", lambda: self.read(reading)), ("Keep drawing", self._section.refresh)],
            stays=True,
        )

    def read(self, reading: ReadingOptions) -> None:
        """Read the drawing in another way."""
        source = self._document.state.source
        if source is None:
            return
        path, before = Path(source.path), self._document.job
        self._job_id = self._worker.start(
            lambda progress: read_drawing_file(path, reading, before, progress), self._document.revision
        )

    def _ask_again(self) -> None:
        source = self._document.state.source
        if source is not None:
            self.ask(source.reading)

    def _on_done(self, answer: JobOutcome) -> None:
        if answer.job_id != self._job_id:
            return
        self._job_id, value = None, answer.value
        if isinstance(value, UndecidedDrawing):
            self._card.ask(value.path.name, value.question, self.ask, waits=False)
            self._section.refresh()
        elif answer.revision != self._document.revision:
            self._fail("The drawing was changed while its file was being read, so it was kept. Choose it again.")
        elif isinstance(value, OpenedDrawing):
            self._take(value)

    def _take(self, opened: OpenedDrawing) -> None:
        source = opened.source
        assert source is not None
        part = replace(opened.job.part, name=self._document.part.name)  # a project names its part
        opened = replace(opened, job=replace(opened.job, part=part))
        self._remember(source, opened)
        self._document.read_again(f"Read {opened.path.name}", opened.job, source)
        size = opened.size
        words = f"{counted(len(opened.job.part.entities), 'curve')}, {grouped(size[0])} by {grouped(size[1])} mm."
        self._log.note(f"read {opened.path.name}", words)
        self.taken.emit()

    def _on_failed(self, answer: JobOutcome) -> None:
        if answer.job_id == self._job_id:
            self._job_id = None
            self._fail(answer.error or "")

    def _on_cancelled(self, job_id: int) -> None:
        if job_id == self._job_id:
            self._job_id = None
            self._section.refresh()

    def _fail(self, sentence: str) -> None:
        self._section.refresh()
        self.failed.emit(sentence)

    def _look(self) -> None:
        """Find out what the file of a project's drawing holds."""
        source = self._document.state.source
        if source is not None and not self._looking.busy:
            self._looking.start(lambda progress: _looked_at(source, progress), 0)

    def _on_looked(self, answer: JobOutcome) -> None:
        looked = answer.value
        assert isinstance(looked, _SourceContents)
        source = self._document.state.source
        if source is not None and source.path == looked.path:
            self._section.show_contents(looked.contents)

    def _on_change(self, change: DocumentChange) -> None:
        source = self._document.state.source
        if change & DocumentChange.LOADED:
            self._known = {}
            self._looking.cancel()
            self._section.show_contents(None)
        elif change & DocumentChange.PART and source is not None:
            self._section.refresh()
            if source in self._known:
                self._workspace.computation.know_drawing(self._known[source].findings)
        self.possible.emit(source is not None)


def _looked_at(source: DrawingSource, progress: Progress) -> _SourceContents:
    """Return what a drawing's file holds.

    Raises:
        InputError: it cannot be read any more.
    """
    from ....formats.readers import read_drawing  # imports the DXF reader: never on the window's thread

    path, reading = Path(source.path), source.reading
    try:
        data = read_whole(path)
    except OSError as error:
        raise InputError(
            f"{path.name} is no longer in {path.parent}: put it back there, or open it where it is."
        ) from error
    return _SourceContents(
        source.path, read_drawing(path.name, data, reading.units, reading.layers, reading.how).contents
    )
