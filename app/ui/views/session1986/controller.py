"""Opens a session over the window, and hands what was made in it to the modern views."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QWidget

from ....core.settings import Phosphor
from ....model.job import Job
from ...framework.controller import Controller
from ...framework.workspace import Workspace

if TYPE_CHECKING:
    from .dialogue import SessionDialogue
    from .picture_tube import PictureTube


class SessionController(Controller):
    """One session at a time; left in the middle, it is there again when it is opened the next time.

    Nothing of it is loaded before it is opened.

    Signals:
        left(): the session is left. taken(): what was made in it is the document's job.

    Attributes:
        session: the one that was begun last; None before the first. tube: what shows it.
    """

    left = Signal()
    taken = Signal()

    def __init__(self, over: QWidget, workspace: Workspace) -> None:
        """Make one; the session covers the whole of the widget `over`."""
        super().__init__(over)
        self._over, self._workspace = over, workspace
        self.session: SessionDialogue | None = None
        self.tube: PictureTube | None = None

    def open(self) -> None:
        """Show the session, from where it was left."""
        from .dialogue import SessionDialogue
        from .picture_tube import PictureTube
        from .questions import SessionQuestion

        if self.tube is None:
            self.session = SessionDialogue(lambda: self._workspace.document.job, self)
            self.tube = PictureTube(self.session, self._over, self._workspace.preferences.settings.phosphor)
            self.tube.left.connect(self.leave)
            self.tube.phosphor_changed.connect(self._keep_phosphor)
            self.session.handed.connect(self._take)
            self._workspace.activity.ended.connect(self.session.finish)
        elif self.session is not None and self.session.ask is SessionQuestion.SHAPE:
            self.session.begin()
        self.tube.show()

    def leave(self) -> None:
        """Show the window again; what is computed is broken off, every answer is kept."""
        if self.session is not None and self.tube is not None:
            self.session.rest()
            self.tube.hide()
            self.left.emit()

    def _keep_phosphor(self, phosphor: Phosphor) -> None:
        """Have the next session begin with this light."""
        preferences = self._workspace.preferences
        preferences.keep(replace(preferences.settings, phosphor=phosphor))

    def _take(self, job: Job) -> None:
        """Make the session's job the document's, by a change that can be undone, and compute it exactly."""
        document = self._workspace.document
        other = job.part is not document.part
        self.leave()
        document.change_job("1986 session", job)
        if other:
            self._workspace.computation.forget()
        tools = ", ".join(
            f"T{job.tool(each.cut.tool).number} {job.tool(each.cut.tool).label}" for each in job.operations
        )
        self._workspace.log.note("1986 session", f"{tools}; undo takes it back.")
        self.taken.emit()
        self._workspace.computation.start()
