"""Sheet: the paper that goes to the machine with the program of the job, as PDF or HTML."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QFileDialog, QWidget

from ....core.atomic import write_atomically
from ....core.progress import Progress
from ....drafting.language.write import draw_text
from ....formats.sheet import SUFFIXES
from ....gcode.posts import load_post
from ...framework.catalogue import active_language
from ...framework.computation import ComputationState
from ...framework.controller import Controller
from ...framework.worker import JobOutcome, Worker
from ...framework.workspace import Workspace

if TYPE_CHECKING:
    from ....usecases.making.make import MakeResult

FILTERS = {"PDF for A4 (*.pdf)": "pdf", "HTML (*.html)": "html"}


@dataclass(frozen=True)
class _WrittenSheet:
    path: Path
    verdict: str


class SheetExportController(Controller):
    """Computes first when the paths are out of date, asks for a file, and writes the sheet.

    Signals:
        written(path).

    Attributes:
        choose_file: asks the user for a path, given a first choice; None = he changed his mind.
    """

    written = Signal(Path)

    def __init__(self, over: QWidget, workspace: Workspace) -> None:
        """Make one; `over` is the widget over which it asks."""
        super().__init__(over)
        self._over, self._workspace = over, workspace
        self._worker = Worker(self)
        self._waiting = False
        self.choose_file: Callable[[Path], Path | None] = self._choose
        self._worker.done.connect(self._on_done)
        self._worker.failed.connect(lambda answer: self.failed.emit(f"{answer.error} Nothing was written."))
        workspace.computation.finished.connect(self._on_finished)
        workspace.computation.failed.connect(lambda _: setattr(self, "_waiting", False))
        workspace.activity.ended.connect(lambda: self._worker.finish(10.0))

    def start(self) -> None:
        """Write the sheet of the job as it is now."""
        computation = self._workspace.computation
        if computation.state is ComputationState.CURRENT:
            self._ask()
            return
        self._waiting = True
        if computation.state is not ComputationState.RUNNING:
            computation.start()

    def _on_finished(self) -> None:
        waiting, self._waiting = self._waiting, False
        if waiting:
            self._ask()

    def _ask(self) -> None:
        made, document = self._workspace.computation.made, self._workspace.document
        if made is None or not len(made.program.moves):
            self.failed.emit("There is no path for a sheet: the drawing has no closed contour that the tools fit into.")
            return
        folder = self._workspace.preferences.last_folder
        stem = document.path.stem if document.path else document.part.name or "sheet"
        path = self.choose_file(folder / f"{stem}.pdf")
        if path is not None:
            self._worker.start(partial(_write, made, path, active_language()), document.revision)

    def _choose(self, first: Path) -> Path | None:
        dialog = QFileDialog(self._over, "Sheet for the machine", str(first), ";;".join(FILTERS))
        dialog.setAcceptMode(QFileDialog.AcceptMode.AcceptSave)
        dialog.setDefaultSuffix("pdf")
        dialog.filterSelected.connect(lambda name: dialog.setDefaultSuffix(FILTERS[name]))
        return Path(dialog.selectedFiles()[0]) if dialog.exec() else None

    def _on_done(self, answer: JobOutcome) -> None:
        done = answer.value
        assert isinstance(done, _WrittenSheet)
        self._workspace.log.note(f"sheet {done.path.name}", f"written to {done.path.parent}. {done.verdict}.")
        self.said.emit(f"{done.path.name} is written.")
        self.written.emit(done.path)


def _write(made: MakeResult, path: Path, language: str, progress: Progress) -> _WrittenSheet:
    from ....formats.sheet.write import sheet_bytes  # these import the engines: never while the window comes up
    from ....usecases.sheet.made import made_sheet

    progress.step(0.0, "Writing the sheet")
    program = path.with_suffix(load_post(made.job.post).extension)
    sources = {"Drawing as .draw writes it": draw_text(made.job.part).text.encode()}
    sheet = made_sheet(made, program, sources)
    suffix = path.suffix.lower() if path.suffix.lower() in SUFFIXES else ".pdf"
    write_atomically(path, sheet_bytes(sheet, suffix, language))
    return _WrittenSheet(path, sheet.verdict)
