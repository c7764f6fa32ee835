"""Makes a better program of the one that the NC view shows, in the background, and shows that in its place."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from ....core.errors import HitofudeError
from ....core.progress import Progress
from ...framework.workspace import Workspace
from ..nc.controller import NcController
from ..nc.program_reader import ProgramSource, ShownProgram
from .panel import CurvesPanel
from .program_controller import ProgramController
from .view import CurvesView

if TYPE_CHECKING:
    from ....usecases.better.result import BetterOptions, BetterProgram


class BetterController(ProgramController):
    """Follows the NC view: its program is the one that is made better."""

    def __init__(self, view: CurvesView, panel: CurvesPanel, nc: NcController, workspace: Workspace) -> None:
        super().__init__(view, panel.better, nc, workspace)
        self._panel, self._better = panel, panel.better
        self._better.requested.connect(self.make_or_cancel)

    def make_or_cancel(self) -> None:
        """Make a better program; while that is done, leave it."""
        from ....usecases.better.result import BetterOptions
        from ....usecases.smoothing.result import OutputForm

        shown = self._program_unless_busy()
        if shown is None:
            return
        self._better.show_reason("")
        self._better.show_outcome(None)
        post = self._panel.post.value
        try:
            options = BetterOptions(
                self._better.within.number,
                form=OutputForm(self._panel.form.value),
                post=None if post is None else str(post),
                dialect=shown.dialect,
            )
        except HitofudeError as error:
            self._better.show_reason(str(error))
            return
        self.reading.start(partial(_made, shown, options), partial(self._on_made, shown))

    def _on_made(self, shown: ShownProgram, done: BetterProgram) -> None:
        from ....usecases.better.report import findings, lines

        found = [each for each in findings(done) if each.counts]
        self._better.show_outcome(done)
        self._better.show_reason(found[0].text if found else "")
        self._log.note(f"better {shown.source.name}", " ".join(line.strip() for line in lines(done)))
        name = Path(shown.source.name)
        dialect = done.curves.dialects[1]
        self._nc.show_text(ProgramSource(f"{name.stem}-better{name.suffix}", done.data, dialect=dialect))


def _made(shown: ShownProgram, options: BetterOptions, progress: Progress) -> BetterProgram:
    """Return the better program.

    Raises:
        HitofudeError: it cannot be made; a sentence. Cancelled: the job was asked to stop.
    """
    from ....usecases.better.improve import better

    return better(shown.source.name, shown.source.named_units(), options, progress=progress)
