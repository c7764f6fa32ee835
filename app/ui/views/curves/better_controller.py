"""Makes a better program of the one that the NC view shows, in the background, and shows that in its place."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from ....core.errors import HitofudeError
from ....core.progress import Progress
from ...framework.controller import Controller, ShownDocument
from ...framework.workspace import Workspace
from ..nc.controller import NcController
from ..nc.program_reader import ProgramReader, ProgramSource, ShownProgram
from .panel import CurvesPanel
from .view import CurvesView

if TYPE_CHECKING:
    from ....usecases.better.improve import BetterOptions, BetterProgram


class BetterController(Controller):
    """Follows the NC view: its program is the one that is made better."""

    def __init__(self, view: CurvesView, panel: CurvesPanel, nc: NcController, workspace: Workspace) -> None:
        super().__init__(view)
        self._form, self._nc, self._log = panel.better, nc, workspace.log
        self._panel = panel
        self.reading = ProgramReader(self)
        self.reading.failed.connect(self._on_failed)
        self.reading.worker.busy_changed.connect(self._form.show_busy)
        workspace.activity.follow(self.reading.worker)
        self._form.requested.connect(self.make_or_cancel)

    @property
    def shown_document(self) -> ShownDocument | None:
        """The NC view's program, where it is not the job's."""
        return self._nc.shown_document

    def make_or_cancel(self) -> None:
        """Make a better program; while that is done, leave it."""
        from ....usecases.better.improve import BetterOptions
        from ....usecases.smooth import OutputForm

        if self.reading.worker.busy:
            self.reading.worker.cancel()
            return
        shown = self._nc.shown
        if shown is None:
            return
        self._form.show_reason("")
        self._form.show_outcome(None)
        post = self._panel.post.value
        try:
            options = BetterOptions(
                self._form.within.number,
                form=OutputForm(self._panel.form.value),
                post=None if post is None else str(post),
                dialect=shown.dialect,
            )
        except HitofudeError as error:
            self._form.show_reason(str(error))
            return
        self.reading.start(partial(_made, shown, options), partial(self._on_made, shown))

    def _on_made(self, shown: ShownProgram, done: BetterProgram) -> None:
        from ....usecases.better.report import findings, lines

        found = [each for each in findings(done) if each.counts]
        self._form.show_outcome(done)
        self._form.show_reason(found[0].text if found else "")
        self._log.note(f"better {shown.source.name}", " ".join(line.strip() for line in lines(done)))
        name = Path(shown.source.name)
        dialect = done.curves.dialects[1]
        self._nc.show_text(ProgramSource(f"{name.stem}-better{name.suffix}", done.data, dialect=dialect))

    def _on_failed(self, sentence: str) -> None:
        self._form.show_reason(sentence)
        self.failed.emit(sentence)


def _made(shown: ShownProgram, options: BetterOptions, progress: Progress) -> BetterProgram:
    """Return the better program.

    Raises:
        HitofudeError: it cannot be made; a sentence. Cancelled: the job was asked to stop.
    """
    from ....usecases.better.improve import better

    return better(shown.source.name, shown.source.bytes(), options, progress=progress)
