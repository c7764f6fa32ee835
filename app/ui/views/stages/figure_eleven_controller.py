"""Has figure 11 measured in the background: on the die of 1999, or on the program that NC shows."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from ....core.progress import Progress
from ...framework.controller import Controller
from ...framework.worker import JobOutcome, Worker
from ...framework.workspace import Workspace
from .own_cut import own_cut
from .text_film_panel import TextFilmPanel
from .view import StagesView

if TYPE_CHECKING:
    from ....exhibits.figure_eleven import FigureEleven
    from ....exhibits.films.making import FilmSource

_DIE = "A"
"""Of the dies: the one with as many moves as the first that was printed."""


class FigureElevenController(Controller):
    """Measures what the film of text B is made of, its sample or one's own program.

    Attributes:
        worker: measures.
    """

    def __init__(
        self,
        view: StagesView,
        panel: TextFilmPanel,
        own: Callable[[str], FilmSource | None],
        workspace: Workspace,
    ) -> None:
        super().__init__(view)
        self._panel, self._form, self._own, self._log = panel, panel.figure_eleven, own, workspace.log
        self.worker = Worker(self)
        workspace.activity.follow(self.worker)
        self.worker.failed.connect(self._on_failed)
        self.worker.busy_changed.connect(self._form.show_busy)
        self._form.requested.connect(self.measure_or_cancel)

    def measure_or_cancel(self) -> None:
        """Measure; while that is done, leave it."""
        if self.worker.busy:
            self.worker.cancel()
            return
        wants_own = self._panel.source.value is True
        source = self._own("B") if wants_own else None
        self._form.show_figure(None)
        if wants_own and source is None:
            self._form.show_fault("No program is shown. Open one in NC, or measure the sample.")
            return
        cells = int(self._form.cells.value)  # type: ignore[call-overload]  # the choices are numbers of cells
        self.worker.start(partial(_measured, source, cells), 0, self._on_measured)

    def _on_measured(self, figure: FigureEleven) -> None:
        self._form.show_figure(figure)
        self._log.note("figure11", figure.text())

    def _on_failed(self, answer: JobOutcome) -> None:
        self._form.show_fault(answer.error or "")
        self.failed.emit(answer.error or "")


def _measured(source: FilmSource | None, cells: int, progress: Progress) -> FigureEleven:
    """Return the figure; on the worker's thread.

    Raises:
        HitofudeError: the program cannot be cut. Cancelled: the job was asked to stop.
    """
    from ....exhibits.figure_eleven import FigureOptions, figure_eleven

    own = () if source is None else (own_cut(source, progress.part(0.0, 0.1)),)
    options = FigureOptions(() if own else (_DIE,), cells, 1, own)
    return figure_eleven(options, progress.part(0.1, 1.0))
