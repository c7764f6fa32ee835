"""Has the stages of the job computed when they are to be seen, and shows them."""

from __future__ import annotations

from enum import Enum

from ....drafting.document import DocumentChange
from ....usecases.pixels.options import BitmapSize
from ...framework.controller import Controller
from ...framework.missing import NOTHING, MissingHint, failed_hint
from ...framework.worker import JobOutcome, Worker
from ...framework.workspace import Workspace
from .film_set import FilmRequest, FilmSet, film_set_of
from .panel import FillRules, StagesPanel
from .view import StagesView


class StagesState(Enum):
    """What is known of the stages of the job as it is now; the value is what the status bar says."""

    NONE = "No stages yet"
    RUNNING = "Computing the stages"
    CURRENT = "Stages up to date"
    FAILED = "The stages could not be computed"


class StagesController(Controller):
    """Follows the document while the view is at the front.

    Its own worker, so that it never holds up computing.

    Attributes:
        reel: what is shown; None = nothing. error: why the last run failed, or "".
    """

    def __init__(self, view: StagesView, panel: StagesPanel, workspace: Workspace) -> None:
        super().__init__(view)
        self._document, self._computation = workspace.document, workspace.computation
        self._view, self._panel = view, panel
        self.worker = Worker(self)
        self.reel: FilmSet | None = None
        self.error, self._may_retry = "", False
        self._size, self._published, self._seen = BitmapSize(), False, False
        self._asked: FilmRequest | None = None
        workspace.activity.follow(self.worker)
        self._connect()

    def _connect(self) -> None:
        worker = self.worker
        worker.failed.connect(self._on_failed)
        worker.cancelled.connect(lambda _: self._on_cancelled())
        worker.busy_changed.connect(lambda _: self.changed.emit())
        self._view.shown.connect(lambda: self._panel.show_still(self._view.still))
        self._view.chain_picked.connect(self._panel.chains.choose)
        self._panel.chain_picked.connect(self._view.light_chain)
        self._panel.rules_chosen.connect(self._choose_rules)
        self._panel.size_chosen.connect(self._choose_size)
        self._document.subscribe(self._on_change)

    @property
    def state(self) -> StagesState:
        """Where the stages stand."""
        if self.worker.busy:
            return StagesState.RUNNING
        if self.error:
            return StagesState.FAILED
        return StagesState.CURRENT if self.reel is not None else StagesState.NONE

    @property
    def missing(self) -> MissingHint:
        """What there is to say in the place of the stages."""
        if self.state is StagesState.RUNNING:
            return MissingHint("The stages are being computed.", "Cancel  Shift+F5", "cancel")
        if self.error:
            return failed_hint(self.error, self._may_retry, "stages_again")
        return (
            NOTHING
            if self.reel is not None
            else MissingHint("The stages are not computed yet.", "Compute the stages", "stages_again")
        )

    def see(self, seen: bool) -> None:
        """The view is at the front, or no longer: then nothing more is computed."""
        self._seen = seen
        if seen:
            self._follow()
        else:
            self._view.player.pause()

    def again(self) -> None:
        """Compute the stages, also where that failed or was cancelled."""
        self._asked = None
        self._follow()

    def _wish(self) -> FilmRequest:
        job = self._document.job
        return FilmRequest(job, self._size, self._computation.pixels_of(job.part), self._published)

    def _follow(self) -> None:
        """Compute what is to be seen, unless it is there, on its way, or was asked for and failed."""
        request = self._wish()
        if (
            not self._seen
            or not self._document.part.entities
            or (self._asked is not None and _alike(request, self._asked))
        ):
            return
        self._asked, self.error, before = request, "", self.reel
        self.worker.start(lambda progress: film_set_of(request, before, progress), self._document.revision, self._show)
        self.changed.emit()

    def _choose_rules(self, rules: FillRules) -> None:
        self._published = rules is FillRules.PUBLISHED
        self._follow()

    def _choose_size(self, size: BitmapSize) -> None:
        self._size = size
        self._follow()

    def _on_change(self, change: DocumentChange) -> None:
        if not change & (DocumentChange.PART | DocumentChange.JOB):
            return
        if change & DocumentChange.LOADED or not self._document.part.entities:
            self.worker.cancel()
            self.error, self._asked = "", None
            self._show(None)
        self._follow()

    def _show(self, reel: FilmSet | None) -> None:
        self.reel = reel
        if reel is not None:
            self._panel.show_reel(reel)
        self._view.show_film(*((reel.film, reel.part.frame) if reel is not None else (None, None)))
        self.changed.emit()

    def _on_failed(self, answer: JobOutcome) -> None:
        """Show no stages but the reason, in their place: those of another job or size would mislead."""
        self.error, self._may_retry = answer.error or "", answer.again
        self._show(None)

    def _on_cancelled(self) -> None:
        """Show no stages rather than those of an earlier job."""
        if not self.worker.busy and self.reel is not None and not _alike(self.reel.request, self._wish()):
            self._show(None)
        self.changed.emit()


def _alike(a: FilmRequest, b: FilmRequest) -> bool:
    return a.same_paths(b) and a.published == b.published
