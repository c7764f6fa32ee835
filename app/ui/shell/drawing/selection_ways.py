"""What the selected curves of a drawing cannot become, and why: found beside the window, for whoever offers it."""

from __future__ import annotations

from PySide6.QtCore import QObject, Signal

from ....core.progress import Progress
from ....drafting.document import DocumentChange
from ....model.job import Job
from ...framework.worker import Worker
from ...framework.workspace import Workspace
from .contour_store import ContourStore

_LOOKED_AT = DocumentChange.SELECTION | DocumentChange.PART | DocumentChange.JOB | DocumentChange.LOADED


def refused_for(job: Job, numbers: frozenset[int], contours: ContourStore, progress: Progress) -> dict[str, str]:
    """Return what curves of a job's drawing cannot become, and why, by the commands' names of the ways.

    Args:
        numbers: of the curves. contours: of the drawing.
    """
    from ....usecases.proposal.chosen_curves import refusals

    progress.step(0.0)
    seen = contours.of(job)
    progress.step(0.5)
    return {way.name.lower(): why for way, why in refusals(seen, numbers).items()}


class SelectionWays(QObject):
    """Follows the selection; until it is known what cannot be, everything can.

    Signals:
        changed(): other ways are refused.

    Attributes:
        refused: why a way is not to be had, by the command's name of it (`pocket`, …).
    """

    changed = Signal()

    def __init__(self, workspace: Workspace, contours: ContourStore, parent: QObject) -> None:
        super().__init__(parent)
        self._document, self._computation = workspace.document, workspace.computation
        self._contours = contours
        self.refused: dict[str, str] = {}
        self.worker = Worker(self)
        workspace.activity.ended.connect(self.worker.finish)
        self._document.subscribe(self._follow)

    def _follow(self, change: DocumentChange) -> None:
        if not change & _LOOKED_AT:
            return
        job, numbers = self._document.job, self._document.selection
        self._show({})
        if not numbers or self._computation.pixels_of(job.part) is not None:
            self.worker.cancel()
            return
        self.worker.start(
            lambda progress: refused_for(job, numbers, self._contours, progress), self._document.revision, self._show
        )

    def _show(self, refused: dict[str, str]) -> None:
        if refused != self.refused:
            self.refused = refused
            self.changed.emit()
