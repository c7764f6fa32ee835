"""What the two ways to work on the program that the NC view shows have in common."""

from __future__ import annotations

from typing import Protocol

from ...framework.controller import Controller, ShownDocument
from ...framework.workspace import Workspace
from ..nc.controller import NcController
from ..nc.program_reader import ProgramReader, ShownProgram
from .view import CurvesView


class ProgramForm(Protocol):
    """Where the work is asked for."""

    def show_busy(self, busy: bool) -> None:
        """Offer to cancel, while it is being done."""

    def show_reason(self, sentence: str) -> None:
        """Show why it cannot be done; "" = it can."""


class ProgramController(Controller):
    """Works on the NC view's program in the background, one job at a time.

    Attributes:
        reading: the worker of its jobs.
    """

    def __init__(self, view: CurvesView, form: ProgramForm, nc: NcController, workspace: Workspace) -> None:
        super().__init__(view)
        self._form, self._nc, self._log = form, nc, workspace.log
        self.reading = ProgramReader(self)
        self.reading.failed.connect(self._on_failed)
        self.reading.worker.busy_changed.connect(form.show_busy)
        workspace.activity.follow(self.reading.worker)

    @property
    def shown_document(self) -> ShownDocument | None:
        """The NC view's program, where it is not the job's."""
        return self._nc.shown_document

    def _program_unless_busy(self) -> ShownProgram | None:
        """Return the program to work on; while it is worked on, leave that and return None."""
        if self.reading.worker.busy:
            self.reading.worker.cancel()
            return None
        return self._nc.shown

    def _on_failed(self, sentence: str) -> None:
        self._form.show_reason(sentence)
        self.failed.emit(sentence)
