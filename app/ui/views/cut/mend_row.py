"""A button that mends a finding, and what it changes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtWidgets import QHBoxLayout, QPushButton, QWidget

from ...framework.labels import Elided

if TYPE_CHECKING:
    from ....usecases.mending import Mend


class MendRow(QWidget):
    """Words on the button, and beside it from what to what; the tool tip says that it can be taken back.

    Attributes:
        button: changes the job.
    """

    def __init__(self, mend: Mend) -> None:
        super().__init__()
        self.button = QPushButton(mend.words)
        change = Elided(mend.change, "muted")
        tip = f"{mend.words}: {mend.change}. The paths are computed again; Ctrl+Z takes it back."
        for widget in (self.button, change):
            widget.setToolTip(tip)
        self.button.setAccessibleName(f"{mend.words}: {mend.change}")
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(8)
        row.addWidget(self.button)
        row.addWidget(change, 1)
