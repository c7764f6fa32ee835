"""Below the curves: one button that makes a better program of passes over a surface, and what it came to."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QPushButton, QWidget

from ...framework.boxes import v_box
from ...framework.fields import NumberField, NumberSpec, reason_label
from ...framework.figures import grouped
from ...framework.labels import muted, show_words
from ...framework.section import hairline, heading

if TYPE_CHECKING:
    from ....usecases.better.result import BetterProgram

_WITHIN = 0.05


class BetterForm(QWidget):
    """By how much the new cut may differ from the old one, the button, and the outcome.

    Signals:
        requested(): make it, or leave it while it is made.
    """

    requested = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.within = NumberField(
            NumberSpec(
                "Cut within",
                low=0.002,
                high=5.0,
                decimals=4,
                tip="By how much the new cut may differ from the old one, up or down",
            )
        )
        self.within.show_value(_WITHIN)
        self.button = QPushButton("Make better")
        self.button.setToolTip("Passes over a surface: facets smoothed, machined anew, cut again and compared")
        self.button.setFixedHeight(32)
        self.button.setEnabled(False)
        self.reason, self.outcome = reason_label(), muted()
        self.outcome.setWordWrap(True)
        column = v_box(self, (0, 6, 0, 0), 4)
        parts: tuple[QWidget, ...] = (
            hairline(),
            heading("Better program"),
            self.within,
            self.button,
            self.reason,
            self.outcome,
        )
        for part in parts:
            column.addWidget(part)
        self.show_reason("")
        self.show_outcome(None)
        self.button.clicked.connect(self.requested)
        self.within.edit.returnPressed.connect(self.button.setFocus)

    def show_program(self, there: bool) -> None:
        """Offer the button where there is a program."""
        self.button.setEnabled(there)

    def show_busy(self, busy: bool) -> None:
        """Offer to leave what is being done."""
        self.button.setText("Cancel" if busy else "Make better")

    def show_reason(self, sentence: str) -> None:
        """Say why it could not be done, "" = nothing is wrong."""
        show_words(self.reason, sentence)

    def show_outcome(self, done: BetterProgram | None) -> None:
        """Show what the new program takes beside the old one; None: nothing."""
        self.outcome.setVisible(done is not None)
        self.outcome.setText("" if done is None else "\n".join(outcome_lines(done)))


def outcome_lines(done: BetterProgram) -> tuple[str, ...]:
    """Return what came of it, a line a figure."""
    old, new, arrow = done.old, done.new, " → "
    return (
        f"Blocks {grouped(old.blocks, 0)}{arrow}{grouped(new.blocks, 0)}",
        f"Length {grouped(old.length_mm, 1)}{arrow}{grouped(new.length_mm, 1)} mm",
        f"Largest bend {math.degrees(old.bend):.2f}°{arrow}{math.degrees(new.bend):.2f}°",
        f"Time {grouped(old.time_s, 1)}{arrow}{grouped(new.time_s, 1)} s",
        f"Cut again: {done.comparison.left.amount_mm:.4f} mm above, {done.comparison.deeper.amount_mm:.4f} mm below",
    )
