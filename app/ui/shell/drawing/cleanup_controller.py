"""Clean-up: looks for faults on a thread, shows what mending would do, and does exactly that."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from PySide6.QtCore import QObject

from ....core.progress import Progress
from ....drafting.commands.command import DraftingSession
from ....drafting.commands.defects import Defect, DefectKind, find_defects
from ....drafting.difference import DrawingDifference, difference
from ....drafting.document import DocumentChange, evaluated
from ....drafting.expressions.words import number_text
from ....drafting.language.interpret import Outcome
from ...framework.worker import JobOutcome, Worker
from ...framework.workspace import Workspace
from ...panels.drawing_cleanup import CleanUpSection, ListedFault
from ...views.canvas.canvas import Canvas

_Found = tuple[list[ListedFault], Outcome, DrawingDifference]
_SIZES = {DefectKind.TINY: "long", DefectKind.DUPLICATE: "apart", DefectKind.OVERLAP: "long", DefectKind.GAP: "wide"}


class CleanUpController(QObject):
    """Answers the section of the drawing's page that is called so."""

    def __init__(self, section: CleanUpSection, canvas: Canvas, workspace: Workspace) -> None:
        super().__init__(section)
        self._section, self._canvas, self._document = section, canvas, workspace.document
        self.worker = Worker(self)
        self._line = ""
        self._found: tuple[str, Outcome, int] | None = None
        section.looked.connect(self._look)
        section.mended.connect(self._mend)
        section.picked.connect(self._go_to)
        section.cancelled.connect(self.give_up)
        self.worker.progress.connect(lambda fraction, _: section.show_progress(fraction))
        self.worker.done.connect(self._show)
        self.worker.failed.connect(lambda answer: section.show_refusal(answer.error or ""))
        self._document.subscribe(self._follow)
        workspace.activity.ended.connect(self.worker.finish)

    def _look(self, tolerance: float) -> None:
        self.give_up()
        self._line = f"heal {number_text(tolerance)}"
        self._section.show_progress(0.0)
        self.worker.start(_looking(self._document.session, tolerance, self._line), self._document.revision)

    def _show(self, answer: JobOutcome) -> None:
        if answer.revision != self._document.revision:
            self.give_up()
            return
        found: Any = answer.value
        listed, outcome, change = found
        self._found = (self._line, outcome, answer.revision)
        mends = bool(change.added or change.gone)
        self._section.show_faults(listed, outcome.reply if mends else "")
        self._canvas.show_trial(change)

    def _mend(self) -> None:
        """Carry out what was shown, if the drawing is still the same."""
        if self._found is not None and self._found[2] == self._document.revision:
            line, outcome, _ = self._found
            self._document.accept(line, outcome)

    def _go_to(self, fault: ListedFault) -> None:
        self._canvas.go_to(*fault.place, closely=True)
        self._document.select(fault.ids)

    def give_up(self) -> None:
        """Show nothing any more."""
        self.worker.cancel()
        if self._found is not None:
            self._canvas.show_trial(DrawingDifference())
        self._found = None
        self._section.clear()

    def _follow(self, change: DocumentChange) -> None:
        if change & (DocumentChange.PART | DocumentChange.LOADED):
            self.give_up()


def _looking(session: DraftingSession, tolerance: float, line: str) -> Callable[[Progress], _Found]:
    """Return the job that finds the faults of a drawing and what mending makes of it."""

    def look(progress: Progress) -> _Found:
        faults = find_defects(session.part, tolerance, progress)
        outcome = evaluated(line, session, progress)
        return [_listed(fault) for fault in faults], outcome, difference(session.part, outcome.session.part)

    return look


def _listed(fault: Defect) -> ListedFault:
    size = f"{fault.size:.4f} mm {_SIZES[fault.kind]}" if fault.size else "exact"
    words = (
        f"{fault.kind.value.capitalize()} at "
        f"{number_text(round(fault.place[0], 3))},{number_text(round(fault.place[1], 3))}: {size}"
    )
    return ListedFault(fault.kind.value, words, fault.place, fault.ids)
