"""What those share who work out other operations for the drawing: on a worker of their own, taken as one step."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QObject, Signal

from ....core.progress import Progress
from ...framework.worker import Answer, Worker
from ...framework.workspace import Workspace
from ...panels.side_panel import SidePanel


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
        self.worker.failed.connect(lambda answer: self.failed.emit(answer.error or ""))

    def _work_out(self, function: Callable[[Progress], Answer], take: Callable[[Answer], None]) -> None:
        """Run a function beside the window, and take what it returns unless the drawing was changed meanwhile."""
        revision = self._document.revision

        def take_if_current(made: Answer) -> None:
            if revision == self._document.revision:
                take(made)
            else:
                self._miss()

        self.worker.start(function, revision, take_if_current)

    def _miss(self) -> None:
        """Say that operations came too late."""
        self.said.emit("The drawing was changed meanwhile; ask for the operations again.")
