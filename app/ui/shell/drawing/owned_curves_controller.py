"""Shows on the drawing which curves the operation that is chosen in the panel has of its own."""

from __future__ import annotations

from PySide6.QtCore import QObject
from PySide6.QtGui import QPainterPath

from ....core.progress import Progress
from ....model.curve_selectors import Selector
from ....model.job import Job
from ...framework.worker import JobOutcome, Worker
from ...framework.workspace import Workspace
from ...panels.changes import SubjectKind
from ...panels.side_panel import SidePanel
from ...views.canvas.canvas import Canvas
from ...views.canvas.painting.curve_path import curve_path
from .contour_store import ContourStore, same_contours


def owned_curves(job: Job, index: int, contours: ContourStore, progress: Progress) -> QPainterPath:
    """Return the curves of the operation at an index, mm, without the circles that drills make, unless it drills.

    Args:
        job: its drawing and operations. index: of the operation. contours: of the drawing.
        progress: to be cancelled by.
    """
    from ....toolpath.drawn_contours import selected
    from ....toolpath.drill_holes import made_by_drills, without_drilled

    progress.step(0.0)
    operation, seen = job.operations[index], contours.of(job)
    found = selected(seen, operation.cut.curves)
    made = frozenset() if operation.HOLES else made_by_drills(job, seen)
    ids = {number for each in (*without_drilled(found.closed, made), *found.open) for number in each.entity_ids}
    progress.step(0.9)
    return curve_path(*(each.curve for each in job.part.entities if each.id in ids))


class OwnedCurvesController(QObject):
    """Follows the panel and the document; an operation that machines all curves of the job marks none."""

    def __init__(self, panel: SidePanel, canvas: Canvas, workspace: Workspace, contours: ContourStore) -> None:
        super().__init__(panel)
        self._panel, self._canvas, self._document = panel, canvas, workspace.document
        self._contours = contours
        self._asked: tuple[Job, int] | None = None
        self.worker = Worker(self)
        workspace.activity.ended.connect(self.worker.finish)
        self.worker.done.connect(self._on_done)
        self.worker.failed.connect(lambda _: self._show_none())
        panel.shown.connect(self._follow)
        self._document.subscribe(lambda _: self._follow())

    def _follow(self) -> None:
        """Find the curves of what is chosen, unless they are shown or on their way."""
        job, subject = self._document.job, self._panel.subject
        own: tuple[Selector, ...] = ()
        if subject.kind is SubjectKind.OPERATION and subject.key < len(job.operations):
            own = job.operations[subject.key].cut.curves
        if not own:
            self._asked = None
            self.worker.cancel()
            self._show_none()
            return
        asked = self._asked
        if asked is not None and asked[1] == subject.key and same_contours(asked[0], job):
            return
        self._asked = job, subject.key
        self.worker.start(
            lambda progress: owned_curves(job, subject.key, self._contours, progress), self._document.revision
        )

    def _on_done(self, answer: JobOutcome) -> None:
        assert isinstance(answer.value, QPainterPath)
        self._canvas.set_owned(answer.value)

    def _show_none(self) -> None:
        self._canvas.set_owned(QPainterPath())
