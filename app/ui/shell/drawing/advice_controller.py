"""Has the drawing looked at for what it asks of its tools, on a worker of its own, and puts the tools chosen into the
job.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject

from ....core.progress import Progress
from ....drafting.document import DocumentChange
from ....model.job import Job
from ....model.operation import Operation
from ....model.tool import Tool
from ....model.tool_kind import ToolKind
from ...framework.worker import JobOutcome, Worker
from ...framework.workspace import Workspace
from ...panels.changes import with_library_tool
from ...panels.side_panel import SidePanel

if TYPE_CHECKING:
    from ....toolpath.advice.advise import Advice
    from ....usecases.batch.task import BatchRow

LOOKING = "Looking at passages and corners…"


def advice_of(job: Job, progress: Progress) -> Advice:
    """Return what a job's drawing asks of its tools; the usual diameters run as the job's first flat tool does."""
    from ....operations.compute import regions_of
    from ....toolpath.advice.advise import CuttingPlan, advise, standard_tools

    progress.step(0.0, "Chain contours")
    like = next((tool for tool in job.tools if tool.kind is ToolKind.FLAT), None)
    tools = [replace(tool, name=tool.label) for tool in standard_tools()]  # their numbers are none of the job's
    if like is not None:
        tools = [replace(tool, feed_rate=like.feed_rate, plunge_rate=like.plunge_rate) for tool in tools]
    cut = job.operations[0].cut if job.operations else None
    plan = (
        CuttingPlan()
        if cut is None
        else CuttingPlan(cut.depth, cut.stepdown, safe_z=job.safe_z, retract_z=job.retract_z)
    )
    return advise(regions_of(job)[0], tools, plan, progress)


def with_tool_for(job: Job, tool: Tool, concerned: Callable[[Operation], bool]) -> Job:
    """Return the job with a tool for some operations: one of its own that is as wide, else a new one."""
    own = next((each for each in job.tools if each.kind is ToolKind.FLAT and each.diameter == tool.diameter), None)
    if own is None:
        like = next((job.tool(each.cut.tool) for each in job.operations if concerned(each)), tool)
        job, number = with_library_tool(
            job, replace(like, diameter=tool.diameter, name="", kind=ToolKind.FLAT, feeds=())
        )
    else:
        number = own.number
    operations = tuple(
        replace(each, cut=replace(each.cut, tool=number)) if concerned(each) else each for each in job.operations
    )
    used = {each.cut.tool for each in operations}
    before = {each.cut.tool for each in job.operations}
    return replace(
        job,
        operations=operations,
        tools=tuple(each for each in job.tools if each.number in used or each.number not in before),
    )


def clears(operation: Operation) -> bool:
    """Tell whether an operation takes the tool that clears."""
    return operation.COARSE


def follows(operation: Operation) -> bool:
    """Tell whether an operation takes the tool that follows walls and does the rest."""
    return not operation.COARSE and not operation.HOLES


def trials_of(job: Job, tools: Sequence[Tool], contour: Tool, progress: Progress) -> dict[Tool, BatchRow]:
    """Return what the program of a job is like with each of some tools in its pockets.

    Args:
        contour: for walls and rest, beside each.

    Raises:
        Cancelled: by progress.
    """
    from ....usecases.batch.tool_trials import ToolTrial, try_tools

    base = with_tool_for(job, contour, follows)
    rows = try_tools([ToolTrial(tool.label, with_tool_for(base, tool, clears)) for tool in tools], progress)
    return dict(zip(tools, rows, strict=True))


class AdviceController(QObject):
    """Opens and closes the sheet and keeps it up to date while it is open."""

    def __init__(self, panel: SidePanel, workspace: Workspace) -> None:
        super().__init__(panel)
        self._panel, self._document = panel, workspace.document
        self.worker = Worker(self)
        self._for: object = None
        self._contour: Tool | None = None
        sheet = self._panel.advice
        self.worker.done.connect(self._on_done)
        self.worker.failed.connect(self._on_failed)
        workspace.activity.follow(self.worker)
        self.worker.cancelled.connect(
            lambda _: self._panel.advice.show_advice(None, "Cancelled. Close the sheet and open it again.")
        )
        self._panel.advice_shown.connect(self._refresh)
        self.trials = Worker(self)
        self.trials.done.connect(self._on_trials)
        self.trials.failed.connect(lambda answer: workspace.notice.ask(answer.error or "", error=True))
        workspace.activity.follow(self.trials)
        sheet.trials_requested.connect(self._try)
        sheet.for_pocket.connect(lambda tool: self._use(tool, clears, "Tool for pockets"))
        sheet.for_contour.connect(lambda tool: self._use(tool, follows, "Tool for contours"))
        self._document.subscribe(self._on_change)

    def _on_change(self, change: DocumentChange) -> None:
        if change & DocumentChange.PART and not self._panel.advice.isHidden():
            self._refresh()

    def _refresh(self) -> None:
        job = self._document.job
        if self._for is job.part:
            return
        self._for = None
        self._panel.advice.show_advice(None, LOOKING)
        self.worker.start(lambda progress: (job.part, advice_of(job, progress)), self._document.revision)

    def _on_done(self, answer: JobOutcome) -> None:
        assert isinstance(answer.value, tuple)
        self._for, advice = answer.value
        self._contour = advice.contour
        self._panel.advice.show_advice(advice, "")

    def _try(self, tools: tuple[Tool, ...]) -> None:
        job, contour = self._document.job, self._contour
        if contour is not None and tools:
            self.trials.start(lambda progress: (job.part, trials_of(job, tools, contour, progress)), 0)

    def _on_trials(self, answer: JobOutcome) -> None:
        assert isinstance(answer.value, tuple)
        part, rows = answer.value
        if part is self._for:  # what is shown is still of that drawing
            self._panel.advice.show_trials(rows)

    def _on_failed(self, answer: JobOutcome) -> None:
        self._panel.advice.show_advice(None, answer.error or "")

    def _use(self, tool: Tool, concerned: Callable[[Operation], bool], name: str) -> None:
        self._panel.change(name, lambda job: with_tool_for(job, tool, concerned))
