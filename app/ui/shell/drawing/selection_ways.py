"""What the selected curves of a drawing cannot become, and why: found beside the window, for whoever offers it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from ....core.progress import Progress
from ....drafting.document import DocumentChange
from ....model.job import Copies, Job
from ...framework.worker import Worker
from ...framework.workspace import Workspace
from .owned_curves_controller import same_contours

if TYPE_CHECKING:
    from ....toolpath.drawn_contours import DrawnContours

_LOOKED_AT = DocumentChange.SELECTION | DocumentChange.PART | DocumentChange.JOB | DocumentChange.LOADED


@dataclass(frozen=True, eq=False)
class RefusedWays:
    """What some curves cannot become.

    Attributes:
        job, drawn: the job and its contours. why: by the commands' names of the ways.
    """

    job: Job
    drawn: DrawnContours
    why: dict[str, str]


def refused_for(job: Job, numbers: frozenset[int], known: RefusedWays | None, progress: Progress) -> RefusedWays:
    """Return what curves of a job's drawing cannot become.

    Args:
        numbers: of the curves. known: what was found before, whose contours still hold.
    """
    from ....toolpath.drawn_contours import drawn_contours  # chains contours: never on the window's thread
    from ....usecases.proposal.chosen_curves import refusals

    progress.step(0.0)
    drawn = known.drawn if known is not None else drawn_contours(replace(job, copies=Copies()))
    progress.step(0.5)
    return RefusedWays(job, drawn, {way.name.lower(): why for way, why in refusals(drawn, numbers).items()})


class SelectionWays(QObject):
    """Follows the selection; until it is known what cannot be, everything can.

    Signals:
        changed(): other ways are refused.

    Attributes:
        refused: why a way is not to be had, by the command's name of it (`pocket`, …).
    """

    changed = Signal()

    def __init__(self, workspace: Workspace, parent: QObject) -> None:
        super().__init__(parent)
        self._document, self._computation = workspace.document, workspace.computation
        self._known: RefusedWays | None = None
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
        known = self._known if self._known is not None and same_contours(self._known.job, job) else None
        self.worker.start(
            lambda progress: refused_for(job, numbers, known, progress), self._document.revision, self._take
        )

    def _take(self, found: RefusedWays) -> None:
        self._known = found
        self._show(found.why)

    def _show(self, refused: dict[str, str]) -> None:
        if refused != self.refused:
            self.refused = refused
            self.changed.emit()
