"""A button that mends a finding, what it changes, and a look at it before it is taken."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from PySide6.QtWidgets import QPushButton, QWidget

from ...framework.boxes import h_box
from ...framework.labels import Elided

if TYPE_CHECKING:
    from ....usecases.mending import Mend

_FROM_TO = re.compile(r"[\d.]+ \u2192 [\d.]+ mm")


class MendRow(QWidget):
    """Words on the button, and beside it from what to what; the tool tip says that it can be taken back.

    Attributes:
        button: changes the job. look: shows the cut as it would be then.
    """

    def __init__(self, mend: Mend) -> None:
        super().__init__()
        self.button, self.look = QPushButton(mend.words), QPushButton("Preview")
        self.look.setProperty("role", "link")
        self.look.setToolTip("Cut it so, and look, before anything is changed")
        self.look.setAccessibleName(f"Preview: {mend.words}")
        change = Elided(mend.change, "muted", _shorter(mend.change))
        tip = f"{mend.words}: {mend.change}. The paths are computed again; Ctrl+Z takes it back."
        for widget in (self.button, change):
            widget.setToolTip(tip)
        self.button.setAccessibleName(f"{mend.words}: {mend.change}")
        row = h_box(self, spacing=8)
        row.addWidget(self.button)
        row.addWidget(change, 1)
        row.addWidget(self.look)


def _shorter(change: str) -> tuple[str, ...]:
    """Return what is said where there is no room for all of it: from how much to how much, else nothing."""
    figures = _FROM_TO.search(change)
    return (*((figures.group(),) if figures else ()), "")


class TrialRow(QWidget):
    """The cut as a mend would make it is shown: take it, or go back.

    Attributes:
        take: changes the job so. back: shows the job's own cut.
    """

    def __init__(self, mend: Mend) -> None:
        super().__init__()
        self.take, self.back = QPushButton(f"Take: {mend.words}"), QPushButton("Back")
        self.take.setProperty("role", "primary")
        self.take.setToolTip(f"{mend.words}: {mend.change}. Ctrl+Z takes it back.")
        row = h_box(self, spacing=8)
        row.addWidget(self.take)
        row.addWidget(self.back)
        row.addStretch(1)
