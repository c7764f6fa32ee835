"""Colours the paths by engagement when that is asked for: measured on a worker of its own, once for each result."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject

from ....core.progress import Progress
from ...framework.worker import JobOutcome, Worker
from ...framework.workspace import Workspace
from ...views.canvas.canvas import Canvas
from ...views.canvas.legend import Legend
from ...views.canvas.modes import PathColourBy
from ...views.canvas.painting.program_layer import ProgramLayer

if TYPE_CHECKING:
    from ....usecases.making.make import MakeResult


def engagement_layer(made: MakeResult, progress: Progress) -> ProgramLayer:
    """Return the moves of a result prepared for painting, stretch by stretch of engagement."""
    from ....toolpath.engagement.engagement import sample_engagement
    from ...views.canvas.painting.engagement_runs import engagement_runs

    seen = sample_engagement(made.program, made.job, progress)
    runs = engagement_runs(made.program.moves, seen)
    return ProgramLayer(made.program, made.coverage.places, runs, made.job.operations)


class EngagementController(QObject):
    """Follows the legend's choice and the computation."""

    def __init__(self, canvas: Canvas, legend: Legend, workspace: Workspace) -> None:
        super().__init__(canvas)
        self._canvas, self._computation = canvas, workspace.computation
        self.worker = Worker(self)
        self._for: MakeResult | None = None
        legend.colour_chosen.connect(lambda _: self._follow())
        self._computation.changed.connect(self._follow)
        self.worker.done.connect(self._on_done)
        workspace.activity.follow(self.worker)

    def _follow(self) -> None:
        """Measure what is shown, where it is to be coloured so and was not measured yet."""
        made = self._computation.made
        if self._canvas.colour_by is not PathColourBy.ENGAGEMENT or made is None or made is self._for:
            return
        self._for = made
        self.worker.start(lambda progress: (made, engagement_layer(made, progress)), 0)

    def _on_done(self, answer: JobOutcome) -> None:
        assert isinstance(answer.value, tuple)
        made, picture = answer.value
        if made is self._computation.made:
            self._canvas.set_program(picture)
