"""Save, Save as, Save a copy: written in the background, whole or not at all, and never over another program's work
unasked.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

from PySide6.QtCore import Signal
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QFileDialog, QWidget

from ....core.progress import Progress
from ....drafting.document import DocumentChange
from ....formats.project.extras import ProjectExtras
from ....formats.project.files import ChangedElsewhere, Stamp, save_project
from ....formats.project.project import SUFFIX, Project, SavedView
from ...framework.controller import Controller
from ...framework.figures import counted, grouped
from ...framework.worker import JobOutcome, Worker
from ...framework.workspace import Workspace
from .drawing_attachments import DrawingAttachments

FILTER = "Hitofude projects (*.hito)"


@dataclass(frozen=True)
class _SaveRequest:
    """One saving.

    Attributes:
        path: of the file. known: the stamp that it must still have, or None.
        copy: the document stays that of its own file. then: what to do once all is saved.
    """

    path: Path
    known: Stamp | None = None
    copy: bool = False
    then: Callable[[], None] | None = None


@dataclass(frozen=True)
class _SaveResult:
    """What became of it: the file's stamp, or a sentence on why it was not touched."""

    request: _SaveRequest
    project: Project
    stamp: Stamp | None
    elsewhere: str = ""


class SaveController(Controller):
    """Saves the document.

    Signals:
        saved(path): the file is written.

    Attributes:
        known: the stamp of the document's file as it was read or written last; None where it has none.
        beside: what is saved beside the drawing.
        choose_file: asks the user for a path, given a title and a first choice; None = he changed his mind.
    """

    saved = Signal(Path)

    def __init__(self, over: QWidget, look: Callable[[], SavedView], backups: QAction, workspace: Workspace) -> None:
        """Make one.

        Args:
            over: the widget over which it asks. look: tells what is looked at now. backups: switches them.
            workspace: the document, and the user's settings.
        """
        super().__init__(over)
        self._over, self._look, self._workspace = over, look, workspace
        self._preferences, self._log, self._document = workspace.preferences, workspace.log, workspace.document
        self._worker = Worker(self, head_start_s=0.0)
        self._next: _SaveRequest | None = None
        self._generation = 0
        self.known: Stamp | None = None
        self.beside = DrawingAttachments(self)
        self.choose_file: Callable[[str, Path], Path | None] = self._choose
        self._worker.done.connect(self._on_done)
        self._worker.failed.connect(self._on_failed)
        workspace.activity.ended.connect(lambda: self._worker.finish(30.0))
        backups.setChecked(self._preferences.settings.backups)
        backups.toggled.connect(self._keep_backups)
        self._document.subscribe(self._on_change)

    def project(self) -> Project:
        """Return what a project file of the window holds now."""
        return Project(self._document.state, self._look(), self.beside.now)

    def save(self, then: Callable[[], None] | None = None) -> None:
        """Save to the document's own file, or ask for one where it has none; `then` is done once it is saved."""
        path = self._document.path
        if path is None or path.suffix.lower() != SUFFIX:
            self.save_as(then)
        else:
            self._start(_SaveRequest(path, self.known, then=then))

    def save_as(self, then: Callable[[], None] | None = None) -> None:
        """Ask for a file, and save to that from now on."""
        path = self.choose_file("Save as", self._first_choice(""))
        if path is not None:
            self._start_new(_SaveRequest(path, then=then))

    def save_copy(self) -> None:
        """Ask for a file and write the document there; it stays that of its own file."""
        path = self.choose_file("Save a copy", self._first_choice(" copy"))
        if path is not None:
            self._start_new(_SaveRequest(path, copy=True))

    def _start_new(self, request: _SaveRequest) -> None:
        """Save to a file that the user has named; one that would be none of ours gets our ending, and is not replaced
        unasked.
        """
        if request.path.suffix.lower() == SUFFIX:
            self._start(request)
            return
        request = replace(request, path=request.path.with_name(request.path.name + SUFFIX))
        if request.path.exists():
            self._ask(f"{request.path.name} is there already.", request)
        else:
            self._start(request)

    def _keep_backups(self, on: bool) -> None:
        self._preferences.keep(replace(self._preferences.settings, backups=on))

    def _first_choice(self, behind: str) -> Path:
        path = self._document.path
        own = path is not None and path.suffix.lower() == SUFFIX
        folder = path.parent if path is not None and own else self._preferences.last_folder
        return folder / f"{path.stem if path else self._document.part.name}{behind}{SUFFIX}"

    def _choose(self, title: str, first: Path) -> Path | None:
        dialog = QFileDialog(self._over, title, str(first), FILTER)
        dialog.setAcceptMode(QFileDialog.AcceptMode.AcceptSave)
        dialog.setDefaultSuffix(SUFFIX[1:])
        return Path(dialog.selectedFiles()[0]) if dialog.exec() else None

    def _start(self, request: _SaveRequest) -> None:
        if self._worker.busy:
            self._next = request
            return
        self._worker.start(
            partial(_save, request, self.project(), self._preferences.settings.backups), self._generation
        )

    def _on_change(self, change: DocumentChange) -> None:
        if change & DocumentChange.LOADED:
            self._generation += 1
            self.known = None
            self.beside.mark_saved(ProjectExtras())

    def _on_done(self, answer: JobOutcome) -> None:
        saved = answer.value
        assert isinstance(saved, _SaveResult)
        if saved.elsewhere:
            self._ask(f"{saved.elsewhere} Saving would replace what it wrote.", saved.request)
            return
        size = grouped(saved.stamp[1] / 1000, 1) if saved.stamp else ""
        if answer.revision == self._generation and not saved.request.copy:
            self.known = saved.stamp
            self._document.mark_saved(saved.request.path, saved.project.state)
            self.beside.mark_saved(saved.project.beside)
            self._preferences.add_recent(saved.request.path)
        self._log.note(
            f"save {saved.request.path.name}",
            f"{counted(len(saved.project.state.job.part.entities), 'curve')}, {size} kB.",
        )
        self.said.emit(f"{saved.request.path.name} is saved.")
        self.saved.emit(saved.request.path)
        following, self._next = self._next, None
        if following is not None:
            self._start(
                _SaveRequest(
                    following.path,
                    self.known if following.path == saved.request.path else following.known,
                    following.copy,
                    following.then,
                )
            )
        elif saved.request.then is not None:
            saved.request.then()

    def _ask(self, why: str, request: _SaveRequest) -> None:
        self._next = None
        self._workspace.notice.ask(
            why,
            [
                ("Replace it", lambda: self._start(replace(request, known=None))),
                ("Save as…", lambda: self.save_as(request.then)),
                ("Do not save", lambda: None),
            ],
            error=True,
            stays=True,
        )

    def _on_failed(self, answer: JobOutcome) -> None:
        self._next = None
        self.failed.emit(f"{answer.error} Nothing was saved; save elsewhere with File, Save as.")


def _save(request: _SaveRequest, project: Project, backup: bool, progress: Progress) -> _SaveResult:
    try:
        return _SaveResult(
            request, project, save_project(request.path, _named(project, request.path.stem), request.known, backup)
        )
    except ChangedElsewhere as sentence:
        return _SaveResult(request, project, None, str(sentence))


def _named(project: Project, name: str) -> Project:
    """Return a project whose part has this name."""
    return replace(project, state=project.state.named(name))
