"""Shows on the drawing which curves the operation that is chosen in the panel has of its own."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject
from PySide6.QtGui import QPainterPath

from ....core.progress import Progress
from ....model.curve_selectors import Selector
from ....model.job import Copies, Job
from ...framework.worker import JobOutcome, Worker
from ...framework.workspace import Workspace
from ...panels.changes import SubjectKind
from ...panels.side_panel import SidePanel
from ...views.canvas.canvas import Canvas
from ...views.canvas.painting.curve_path import curve_path

if TYPE_CHECKING:
    from ....toolpath.drawn_contours import DrawnContours


@dataclass(frozen=True, eq=False)
class OwnedCurves:
    """Curves of a drawing that an operation has of its own.

    Attributes:
        job: whose drawing it is. drawn: its contours, which chaining takes time to find. path: of the curves, mm.
    """

    job: Job
    drawn: DrawnContours
    path: QPainterPath


def same_contours(one: Job, other: Job) -> bool:
    """Tell whether two jobs machine the same contours of the same drawing."""

    def layers(job: Job) -> object:
        return job.layer_names, job.keep_out_layers, [(each.cut.curves, each.cut.enabled) for each in job.operations]

    def drills(job: Job) -> object:
        return [each for each in job.operations if each.HOLES]

    return (
        drills(one) == drills(other)
        and one.part is other.part
        and one.join_tolerance == other.join_tolerance
        and layers(one) == layers(other)
    )


def owned_curves(job: Job, index: int, known: OwnedCurves | None, progress: Progress) -> OwnedCurves:
    """Return the curves of the operation at an index, without the circles that drills make, unless it drills.

    Args:
        job: its drawing and operations. index: of the operation.
        known: what was found before, whose contours still hold.
        progress: to be cancelled by.
    """
    from ....toolpath.drawn_contours import (
        drawn_contours,  # chains contours: never on the window's thread
        selected,
    )
    from ....toolpath.drill_holes import circle_of, made_by_drills

    progress.step(0.0)
    job, operation = replace(job, copies=Copies()), job.operations[index]
    seen = known.drawn if known is not None else drawn_contours(job)
    found = selected(seen, operation.cut.curves)
    made = frozenset() if operation.HOLES else made_by_drills(job, seen)
    closed = [each for each in found.closed if not made or circle_of(each) not in made]
    ids = {number for each in (*closed, *found.open) for number in each.entity_ids}
    progress.step(0.9)
    return OwnedCurves(job, seen, curve_path(*(each.curve for each in job.part.entities if each.id in ids)))


class OwnedCurvesController(QObject):
    """Follows the panel and the document; an operation that machines all curves of the job marks none."""

    def __init__(self, panel: SidePanel, canvas: Canvas, workspace: Workspace) -> None:
        super().__init__(panel)
        self._panel, self._canvas, self._document = panel, canvas, workspace.document
        self._known: OwnedCurves | None = None
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
            self._asked, self._known = None, None
            self.worker.cancel()
            self._show_none()
            return
        asked = self._asked
        if asked is not None and asked[1] == subject.key and same_contours(asked[0], job):
            return
        self._asked = job, subject.key
        known = self._known if self._known is not None and same_contours(self._known.job, job) else None
        self.worker.start(lambda progress: owned_curves(job, subject.key, known, progress), self._document.revision)

    def _on_done(self, answer: JobOutcome) -> None:
        assert isinstance(answer.value, OwnedCurves)
        self._known = answer.value
        self._canvas.set_owned(answer.value.path)

    def _show_none(self) -> None:
        self._canvas.set_owned(QPainterPath())
