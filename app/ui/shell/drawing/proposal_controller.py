"""Replaces the job's operations by those that are proposed for the drawing, or adds some for what is selected; found on
a worker of its own.

A drawing that nobody has said anything about is proposed for before it is computed first; fig. 2 of the 1986 patent
keeps the rule of its text.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from ....core.errors import GeometryError
from ....core.progress import Progress
from ....drafting.document import DocumentChange
from ....model.curve_selectors import Selector
from ....model.job import Job
from ....model.operation import Operation, Order
from ....model.part import Part
from ...framework.commands import Commands, on_trigger
from ...framework.figures import TIMES, counted
from ...framework.worker import Answer
from ...framework.workspace import Workspace
from ...panels.changes import Subject, SubjectKind, operation_name, with_cut
from ...panels.side_panel import SidePanel
from ..files.open_controller import OpenedDrawing, is_sample
from .operations_controller import OperationsController

if TYPE_CHECKING:
    from ....usecases.proposal.chosen_curves import ChosenOperations
    from ....usecases.proposal.propose import Proposal

NOTHING_DRAWN = "Nothing is drawn yet; draw a closed curve or open a drawing first."
NOTHING_SELECTED = "Nothing is selected; click a line first."
WAYS = ("pocket", "outside", "inside", "on", "slot", "drill", "bore", "countersink", "chamfer", "engrave", "vcarve")
"""What a selection can become, as the commands name it: `machine_pocket`, …"""
A_PICTURE = "All of a picture's pixels is pockets; trace it first to have operations proposed."


def proposed_for(job: Job, nesting: bool, progress: Progress) -> Proposal:
    """Return the operations proposed for a job's drawing, by how its curves lie in one another or as in 1986."""
    from ....usecases.proposal.propose import as_in_1986, propose  # imports the engines: never on the window's thread

    return propose(job, progress=progress) if nesting else as_in_1986(job)


def first_proposal(job: Job, progress: Progress) -> Proposal | None:
    """Return what is proposed for a drawing that nobody has said anything about, before it is computed first.

    Returns:
        None where its operations stay as they are: it is fig. 2, or there is nothing to be proposed.
    """
    from ....usecases.proposal.propose import propose  # imports the engines: never on the window's thread
    from ....usecases.proposal.published import is_figure_2

    if is_figure_2(job.part):
        return None
    try:
        return propose(job, progress=progress)
    except GeometryError:
        return None


def selection_of(job: Job, numbers: frozenset[int], progress: Progress) -> tuple[Selector, ...]:
    """Return curves, by their numbers, as an operation has them: one of each contour that is selected."""
    from ....usecases.proposal.chosen_curves import numbers_of  # imports the engines: never on the window's thread

    progress.step(0.0, "Sorting contours")
    return numbers_of(job, numbers)


def chosen_for(job: Job, numbers: frozenset[int], way: str, progress: Progress) -> ChosenOperations:
    """Return the job with an operation for some curves, by their numbers; `way` is one of `WAYS`."""
    from ....usecases.proposal.chosen_curves import (  # imports the engines: never on the window's thread
        CurvePurpose,
        with_chosen,
    )

    return with_chosen(job, numbers, CurvePurpose[way.upper()], progress)


class ProposalController(OperationsController):
    """Asks for proposals and takes them, as one step each."""

    def __init__(self, panel: SidePanel, workspace: Workspace, commands: Commands) -> None:
        super().__init__(panel, workspace, "Looking at the drawing…")
        self._commands = commands
        self._begun_with: tuple[Operation, ...] | None = Job(Part()).operations
        self._then: Callable[[], None] | None = None
        workspace.document.subscribe(self._on_change)
        self.worker.failed.connect(lambda _: self._forget())
        self.worker.cancelled.connect(lambda _: self._forget())
        on_trigger(commands, "propose", lambda: self.propose(nesting=True))
        on_trigger(commands, "propose_1986", lambda: self.propose(nesting=False))
        for way in WAYS:
            on_trigger(commands, f"machine_{way}", partial(self.machine, way))
        panel.operation_form.selection.connect(self.use_selection)
        panel.operations.proposal.connect(commands["propose"].trigger)
        panel.operations.rule_of_1986.connect(commands["propose_1986"].trigger)

    def _on_change(self, change: DocumentChange) -> None:
        """Of another document, what a job begins with alone was said by nobody."""
        if change & DocumentChange.LOADED:
            self._begun_with = Job(Part()).operations
            self._forget()

    def _forget(self) -> None:
        self._then = None

    def know(self, opened: OpenedDrawing) -> None:
        """Know whether what was opened says what is to be machined: a project and a sample do, a drawing does not."""
        said = opened.project is not None or is_sample(opened.path)
        self._begun_with = None if said else self._document.job.operations

    def offer(self, name: str) -> None:
        """Say what becomes of a drawing that says nothing about machining, and offer the other way."""
        self._workspace.notice.ask(
            f"{name} says nothing about machining. F5 proposes operations for it and computes them.",
            [
                ("Propose operations", self._commands["propose"].trigger),
                ("Keep the operations there are", self._keep),
            ],
            of_job=True,
        )

    def _keep(self) -> None:
        self._begun_with = None

    @property
    def due(self) -> bool:
        """Whether nobody has said yet what is to be machined of the drawing, and nothing was computed."""
        job, computation = self._document.job, self._workspace.computation
        return (
            self._unsaid
            and bool(job.part.entities)
            and computation.made is None
            and computation.pixels_of(job.part) is None
        )

    @property
    def _unsaid(self) -> bool:
        """Whether the operations are those that a job begins with, which nobody chose."""
        return self._begun_with == self._document.job.operations

    def before(self, act: Callable[[], None]) -> None:
        """Do something with the job, such as computing it, after the operations that are being worked out, or that are
        proposed where that is due; of what is asked for meanwhile the last is done.
        """
        if self.worker.busy:
            self._then = act
        elif self.due:
            job, self._then = self._document.job, act
            self._work_out(lambda progress: first_proposal(job, progress), self._begin_with)
        else:
            act()

    def propose(self, nesting: bool) -> None:
        """Have operations proposed by how the curves lie in one another, or by the rule of 1986."""
        job = self._document.job
        if not job.part.entities:
            self.said.emit(NOTHING_DRAWN)
        elif nesting and self._workspace.computation.pixels_of(job.part) is not None:
            self.failed.emit(A_PICTURE)
        else:
            self._workspace.notice.dismiss()
            self._work_out(lambda progress: proposed_for(job, nesting, progress), self._take)

    def machine(self, way: str) -> None:
        """Have an operation added for the selected curves; `way` is one of `WAYS`. Those that nobody chose go."""
        unsaid = self._unsaid

        def find(job: Job, numbers: frozenset[int], progress: Progress) -> ChosenOperations:
            return chosen_for(replace(job, operations=()) if unsaid else job, numbers, way, progress)

        self._start_on_selection(find, self._add)

    def machine_instead(self, job: Job, numbers: frozenset[int], way: str) -> None:
        """Have curves, by their numbers, be machined another way than they were, as one step.

        Args:
            job: without what machined them. way: one of `WAYS`.
        """
        self._begun_with = None
        self._workspace.notice.dismiss()
        self._work_out(lambda progress: chosen_for(job, numbers, way, progress), self._add)

    def use_selection(self) -> None:
        """Have the selected curves be those of the operation that is shown."""
        index = self._panel.operation_form.index
        self._start_on_selection(
            lambda job, numbers, progress: selection_of(job, numbers, progress),
            lambda curves: self._give(index, curves),
        )

    def _start_on_selection(
        self, find: Callable[[Job, frozenset[int], Progress], Answer], take: Callable[[Answer], None]
    ) -> None:
        job, numbers = self._document.job, self._document.selection
        if not numbers:
            self.said.emit(NOTHING_SELECTED)
        elif self._workspace.computation.pixels_of(job.part) is not None:
            self.failed.emit(A_PICTURE)
        else:
            self._workspace.notice.dismiss()
            self._work_out(lambda progress: find(job, numbers, progress), take)

    def _work_out(self, function: Callable[[Progress], Answer], take: Callable[[Answer], None]) -> None:
        """Work operations out and take them, and go on with what was asked for meanwhile."""

        def take_and_go_on(made: Answer) -> None:
            take(made)
            then, self._then = self._then, None
            if then is not None:
                then()

        super()._work_out(function, take_and_go_on)

    def _miss(self) -> None:
        self._forget()
        super()._miss()

    def _begin_with(self, proposal: Proposal | None) -> None:
        """Take what is proposed first."""
        self._begun_with = None
        if proposal is not None:
            self._take(proposal)

    def _add(self, chosen: ChosenOperations) -> None:
        """Take over operations that were added, and offer to switch off what machines all curves besides."""
        self._panel.choose(Subject(SubjectKind.OPERATION, chosen.index))
        self._document.change_job(f"{operation_name(chosen.added[0].operation)} this", chosen.job)
        self._panel.choose(Subject(SubjectKind.OPERATION, chosen.index))
        for each in chosen.added:
            curves = ", ".join(curve.text for curve in each.operation.cut.curves)
            self._workspace.log.note(f"{operation_name(each.operation)} T{each.operation.cut.tool} {curves}", each.why)
        name = operation_name(chosen.added[0].operation)
        if chosen.others:
            verb = "machines" if chosen.others == 1 else "machine"
            self._workspace.notice.ask(
                f"{name} added. {counted(chosen.others, 'operation')} still {verb} all curves of the drawing.",
                [("Switch them off", self._switch_off_others), ("Compute", self._commands["compute"].trigger)],
            )
        self.said.emit(f"{name} added.")

    def _give(self, index: int, curves: tuple[Selector, ...]) -> None:
        """Give the operation at an index its curves."""
        self._panel.change(
            "Change curves", lambda job: with_cut(job, index, replace(job.operations[index].cut, curves=curves))
        )
        self.said.emit(f"{operation_name(self._document.job.operations[index])} has the selected curves.")

    def _switch_off_others(self) -> None:
        """Leave only operations that have curves of their own switched on."""

        def make(job: Job) -> Job:
            return replace(
                job,
                operations=tuple(
                    each if each.cut.curves else replace(each, cut=replace(each.cut, enabled=False))
                    for each in job.operations
                ),
            )

        self._panel.change("Switch operations off", make)

    def _take(self, proposal: Proposal) -> None:
        """Take a proposal."""
        from ....usecases.proposal.propose import ProposalRule

        self._begun_with = None
        nesting = proposal.rule is ProposalRule.NESTING
        # outlines free the parts, so they must stay last
        self._panel.subject = Subject(SubjectKind.OPERATION, 0)
        job = replace(proposal.job, order=Order.POCKET_FIRST) if nesting else proposal.job
        changed = job != self._document.job
        self._document.change_job("Propose operations" if nesting else "Operations as in 1986", job)
        for each in proposal.operations:
            self._workspace.log.note(f"propose {operation_name(each.operation)} T{each.operation.cut.tool}", each.why)
        for finding in proposal.findings:
            self._workspace.log.note("propose", finding.text, error=True)
        self._ask_on(proposal, nesting, changed)

    def _ask_on(self, proposal: Proposal, nesting: bool, changed: bool) -> None:
        """Say what there is now, and offer what comes next: to compute unless the work goes on with it anyhow, to undo
        only where something was changed.
        """
        many = Counter(operation_name(each.operation).lower() for each in proposal.operations)
        names = ", ".join(name if count == 1 else f"{count} {TIMES} {name}" for name, count in many.items())
        left = f" {counted(len(proposal.findings), 'gap')} to close: see the log." if proposal.findings else ""
        other = ("As in 1986", "propose_1986") if nesting else ("By the drawing", "propose")
        answers = [
            *([] if self._then is not None else [("Compute", "compute")]),
            other,
            *([("Undo", "undo")] if changed else []),
        ]
        self._workspace.notice.ask(
            f"Proposed: {names}.{left}", [(text, self._commands[name].trigger) for text, name in answers], of_job=True
        )
        self.said.emit(f"{counted(len(proposal.operations), 'operation')} proposed; the log says why.")
