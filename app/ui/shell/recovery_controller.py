"""Never losing work: what is in no file yet is kept beside, and what a crash has left is offered at the next start."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from PySide6.QtCore import QObject, QTimer, Signal

from ...core.errors import InputError
from ...core.progress import Progress
from ...drafting.document import DocumentChange
from ...formats.project.project import Project
from ...formats.project.recovery import EditedFile, RecoveredWork, RecoveryFile, recoveries
from ..framework.worker import JobOutcome, Worker
from ..framework.workspace import Workspace
from .bars.question_card import QuestionCard
from .file_controller import FileController

WAIT_S = 8.0
"""After the first change that is in no file, s; writing takes a moment more, and 20 s are the promise."""

_AGAIN_S = 1.0


class RecoveryController(QObject):
    """Keeps the document's recovery file, and brings back what others have left.

    Signals:
        kept(): the recovery file holds the document as it was, or has gone because the document lies in a file of the
        user's.
    """

    kept = Signal()

    def __init__(self, files: FileController, card: QuestionCard, workspace: Workspace) -> None:
        super().__init__(files)
        self._files, self._card, self._workspace = files, card, workspace
        self._log, self._document = workspace.log, workspace.document
        self._worker = Worker(self, head_start_s=0.0)
        self._file: RecoveryFile | None = None
        self._told = False
        self._left: list[RecoveredWork] = []
        self._taken: list[RecoveredWork] = []
        self._timer = QTimer(self, singleShot=True, interval=round(WAIT_S * 1000))
        self._timer.timeout.connect(self.keep)
        self._worker.failed.connect(self._on_failed)
        workspace.activity.ended.connect(self._close)
        self._document.subscribe(self._on_change)
        files.save_controller.beside.changed.connect(self._wait)

    def keep(self) -> None:
        """Write the document as it is now into the recovery file, in the background; take the file away where it is
        saved.
        """
        if self._worker.busy:
            self._timer.start(round(_AGAIN_S * 1000))
            return
        project = (
            self._files.save_controller.project()
            if self._document.modified or self._files.save_controller.beside.unsaved
            else None
        )
        if project is None and self._file is None:
            return
        edited = EditedFile(self._document.path, self._files.save_controller.known)
        self._worker.start(partial(self._write, project, edited), self._document.revision, self._on_kept)

    def offer(self) -> None:
        """Ask what is to become of what other windows have left, if they have."""
        if self._workspace.notice.isVisible() or self._card.isVisible():
            return  # another question waits for its answer; the next start asks
        self._left = list(recoveries())
        self._offer_next()

    def _offer_next(self) -> None:
        if not self._left:
            return
        found = self._left.pop(0)
        name = path.name if (path := found.edited().path) else "a new drawing"
        more = f" ({len(self._left)} more)" if self._left else ""
        self._workspace.notice.ask(
            f"The program ended before {name} was saved; its state of {_clock(found.when)} is kept.{more}",
            [
                ("Recover", lambda: self._files.leave("Recover?", lambda: self._load(found))),
                ("Discard", lambda: self._decide(found.discard)),
                ("Later", lambda: self._decide(found.leave)),
            ],
            stays=True,
        )
        self._workspace.notice.come_back()

    def _decide(self, act: Callable[[], object]) -> None:
        act()
        self._offer_next()

    def _load(self, found: RecoveredWork) -> None:
        self._worker.start(lambda progress: _loaded(found), self._document.revision, self._on_loaded)

    def _write(self, project: Project | None, edited: EditedFile, progress: Progress) -> None:
        if self._file is None:
            self._file = RecoveryFile()
        if project is None:
            self._file.forget()
        else:
            self._file.keep(project, edited)

    def _on_change(self, change: DocumentChange) -> None:
        if change & (DocumentChange.PART | DocumentChange.JOB | DocumentChange.HISTORY):
            self._wait()

    def _wait(self) -> None:
        if not self._timer.isActive():
            self._timer.start(round(WAIT_S * 1000))

    def _on_kept(self, _: None) -> None:
        for found in self._taken:
            found.discard()
        self._taken = []
        self.kept.emit()

    def _on_loaded(self, loaded: _LoadedWork) -> None:
        found, project = loaded.found, loaded.project
        if project is None:
            aside = found.set_aside()
            self._log.note("recover", f"{loaded.reason} It stays as {aside}.", error=True)
            self._workspace.notice.ask(
                f"The kept state is damaged and cannot be recovered. It stays as {aside}.", error=True
            )
            return
        edited = found.edited()
        self._document.load_state(project.state, edited.path, saved=False)
        self._files.save_controller.known = edited.stamp
        self._workspace.computation.forget()
        self._files.bring(project)
        self._taken.append(found)
        self._log.note(
            "recover", f"{len(project.state.job.part.entities)} curves of {_clock(found.when)}; save to keep them."
        )
        for other in self._left:
            other.leave()
        self._left = []
        self.keep()

    def _on_failed(self, answer: JobOutcome) -> None:
        if not self._told:
            self._told = True
            self._log.note("recovery", f"{answer.error} Save now and then.", error=True)

    def _close(self) -> None:
        self._timer.stop()
        self._worker.finish(10.0)
        for found in (*self._left, *self._taken):
            found.leave()
        if self._file is not None:
            self._file.close()


@dataclass(frozen=True, eq=False)
class _LoadedWork:
    """What was found, and the project in it; None where it cannot be read, for a reason."""

    found: RecoveredWork
    project: Project | None
    reason: str = ""


def _loaded(found: RecoveredWork) -> _LoadedWork:
    try:
        return _LoadedWork(found, found.load())
    except InputError as error:
        return _LoadedWork(found, None, str(error))


def _clock(when: float) -> str:
    """Return a time of today as 14:32, of another day with its date."""
    then, today = time.localtime(when), time.localtime()
    return time.strftime("%H:%M" if then[:3] == today[:3] else "%Y-%m-%d %H:%M", then)
