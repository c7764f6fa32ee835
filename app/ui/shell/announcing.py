"""What a job says before it is done, such as that it takes long: above the view, with the way to stop it."""

from __future__ import annotations

from PySide6.QtCore import QObject

from ..framework.workspace import Workspace


class Announcing(QObject):
    """Shows the remarks of running jobs until they end."""

    def __init__(self, workspace: Workspace, parent: QObject) -> None:
        super().__init__(parent)
        self._activity, self._notice, self._log = workspace.activity, workspace.notice, workspace.log
        self._said = ""
        self._activity.remarked.connect(self._say)
        self._activity.busy_changed.connect(self._on_busy)

    def _say(self, sentence: str) -> None:
        self._said = sentence
        self._log.note("compute", sentence)
        self._notice.ask(sentence, (("Cancel", self._cancel),))

    def _cancel(self) -> None:
        self._activity.cancel()

    def _on_busy(self, busy: bool) -> None:
        """Close the line when its job has ended, unless another one has taken its place."""
        if not busy and self._said:
            if self._notice.sentence == self._said:
                self._notice.hide()
            self._said = ""
