"""Opens a session over the window, and hands what was made in it to the modern views."""

from __future__ import annotations

from dataclasses import replace

from PySide6.QtCore import QObject

from ....core.settings import Phosphor
from ....model.job import Job
from ...framework.log import Log
from ...shell.main_window import MainWindow
from ...shell.memory import remember
from ...shell.showing import Showing
from ...shell.views import View
from .questions import Ask
from .session import Session
from .tube import Tube


class SessionOpening(QObject):
    """One session at a time; left in the middle, it is there again when it is opened the next time.

    Attributes:
        session: the one that was begun last; None before the first. tube: what shows it.
    """

    def __init__(self, window: MainWindow, showing: Showing, log: Log) -> None:
        super().__init__(window)
        self._window, self._showing, self._log = window, showing, log
        self.session: Session | None = None
        self.tube: Tube | None = None

    def open(self) -> None:
        """Show the session, from where it was left."""
        if self.tube is None:
            self.session = Session(lambda: self._window.document.job, self)
            self.tube = Tube(self.session, self._window, self._window.settings.phosphor)
            self.tube.left.connect(self.leave)
            self.tube.phosphor_changed.connect(self._keep_phosphor)
            self.session.handed.connect(self._take)
            self._window.closed.connect(self.session.finish)
        elif self.session is not None and self.session.ask is Ask.SHAPE:
            self.session.begin()
        self.tube.show()

    def leave(self) -> None:
        """Show the window again; what is computed is broken off, every answer is kept."""
        if self.session is not None and self.tube is not None:
            self.session.rest()
            self.tube.hide()
            self._window.views.take_focus()

    def _keep_phosphor(self, phosphor: Phosphor) -> None:
        """Have the next session begin with this light."""
        self._window.settings = replace(self._window.settings, phosphor=phosphor)
        remember(self._window)

    def _take(self, job: Job) -> None:
        """Make the session's job the document's, by a change that can be undone, and compute it exactly."""
        other = job.part is not self._window.document.part
        self.leave()
        self._window.document.change_job("1986 session", job)
        if other:
            self._window.computation.forget()
        tools = ", ".join(
            f"T{job.tool(each.cut.tool).number} {job.tool(each.cut.tool).label}" for each in job.operations
        )
        self._log.note("1986 session", f"{tools}; undo takes it back.")
        self._showing.show_view(View.PATHS)
        self._window.canvas.fit()
        self._window.computation.start()
