"""What stands between a view, its panel and what the program computes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from PySide6.QtCore import QObject, Signal

from ...model.finding import Finding
from .verdict import VerdictSummary


@dataclass(frozen=True, eq=False)
class OfferedMend:
    """A change of the job, or of what a view shows in its place, that mends a finding; it can be undone.

    Attributes:
        words: on the button. change: what becomes of it, in words. act: makes the change.
    """

    words: str
    change: str
    act: Callable[[], None]


@dataclass(frozen=True, eq=False)
class ShownDocument:
    """What a view shows that is not the drawing and its job: title, badge and findings are of this then.

    Attributes:
        name: in the title. modified: it has changes that are in no file.
        verdict: on the badge; None = it is being computed. findings: everything there is to say about it.
        look_at: shows the place of a finding; None = the findings are only listed.
        mends: tells what mends a finding; None = nothing does.
    """

    name: str
    modified: bool
    verdict: VerdictSummary | None
    findings: tuple[Finding, ...] = ()
    look_at: Callable[[Finding], None] | None = None
    mends: Callable[[Finding], Sequence[OfferedMend]] | None = None


class Controller(QObject):
    """Acts for a view; knows no window, and tells by its signals what a window has to show.

    Signals:
        failed(sentence): what went wrong. said(sentence): what was done, in a line.
        changed(): the view shows or lacks something else. front_requested(): the view shall come to the front.
    """

    failed = Signal(str)
    said = Signal(str)
    changed = Signal()
    front_requested = Signal()

    @property
    def shown_document(self) -> ShownDocument | None:
        """What the view shows in place of the drawing and its job; None = these."""
        return None

    def see(self, seen: bool) -> None:
        """Be told that the view came to the front, or no longer is there."""
