"""What those share who work out other operations for the drawing: on a worker of their own, taken as one step."""

from __future__ import annotations

from PySide6.QtCore import QObject, Signal

from ..framework.worker import JobOutcome, Worker
from ..framework.workspace import Workspace
from ..panels.side_panel import SidePanel


class OperationsController(QObject):
    """Works operations out and takes them, where the drawing is still the one that they were worked out for.

    Signals:
        failed(sentence): what went wrong. said(sentence): what was done.
    """

    failed = Signal(str)
    said = Signal(str)

    def __init__(self, panel: SidePanel, workspace: Workspace, doing: str) -> None:
        """Have the status bar say what is being done."""
        super().__init__(panel)
        self._panel, self._workspace, self._document = panel, workspace, workspace.document
        self.worker = Worker(self)
        workspace.activity.follow(self.worker, doing)
        self.worker.done.connect(self._on_done)
        self.worker.failed.connect(lambda answer: self.failed.emit(answer.error or ""))

    def _on_done(self, answer: JobOutcome) -> None:
        if answer.revision != self._document.revision:
            self.said.emit("The drawing was changed meanwhile; ask for the operations again.")
            return
        self._take_over(answer.value)

    def _take_over(self, made: object) -> None:
        """Change the job by what was worked out."""
        raise NotImplementedError
