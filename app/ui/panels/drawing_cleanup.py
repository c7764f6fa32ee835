"""Clean-up: what is wrong with the drawing within a tolerance, place by place, and the button that mends it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QLabel, QListWidget, QProgressBar, QPushButton, QWidget

from ...core.tolerances import JOIN
from ...model.curves import Point
from ..framework.boxes import h_box
from ..framework.fields import NumberField, NumberSpec
from ..framework.figures import counted, grouped
from ..framework.labels import muted, show_words
from ..framework.section import PanelSection

MOST = 200
"""Faults that are listed; the others are counted."""

_ROW_PX, _MOST_ROWS = 24, 6
TOLERANCE = NumberSpec(
    "Tolerance",
    "mm",
    1e-5,
    10.0,
    4,
    tip="Gaps up to this are closed; curves as near to one another are one, and shorter ones none.",
)


@dataclass(frozen=True, slots=True)
class ListedFault:
    """One fault as it is listed: its words, its place, and the curves that have it."""

    kind: str
    words: str
    place: Point
    ids: tuple[int, ...]


class CleanUpSection(PanelSection):
    """Asks for a tolerance, and shows what was found.

    Signals:
        looked(tolerance): the user wants to know what is wrong, mm. mended(): wants what was found put right.
        picked(fault): wants to see a place. cancelled(): wants no answer any more.
    """

    looked = Signal(float)
    mended = Signal()
    picked = Signal(object)
    cancelled = Signal()

    def __init__(self) -> None:
        super().__init__("Clean-up")
        self.remark = muted()
        self.head.addWidget(self.remark)
        self.head.addSpacing(4)
        self.tolerance = NumberField(TOLERANCE)
        self.tolerance.show_value(JOIN)
        self.look, self.mend = QPushButton("Look"), QPushButton("Mend")
        self.mend.setProperty("role", "primary")
        self.words, self.list, self.bar = QLabel(), QListWidget(), QProgressBar()
        self._faults: tuple[ListedFault, ...] = ()
        self._busy = False
        self._lay_out()
        self.look.clicked.connect(self._on_look)
        self.mend.clicked.connect(self.mended)
        self.list.itemClicked.connect(lambda item: self.picked.emit(self._faults[self.list.row(item)]))
        self.list.itemActivated.connect(lambda item: self.picked.emit(self._faults[self.list.row(item)]))
        self.tolerance.committed.connect(lambda _: self.clear())
        self.clear()

    def _lay_out(self) -> None:
        self.words.setWordWrap(True)
        self.list.setAccessibleName("Faults: Enter goes to the place")
        self.list.setProperty("role", "rows")
        self.list.setUniformItemSizes(True)
        self.list.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.bar.setFixedHeight(4)
        self.bar.setTextVisible(False)
        self.bar.setRange(0, 1000)
        self.add_indented(self.tolerance)
        self.add_indented(self.bar)
        self.add_indented(self.words)
        self.rows.addWidget(self.list)
        buttons = QWidget()
        row = h_box(buttons, (0, 4, 0, 0), 8)
        row.addWidget(self.look)
        row.addWidget(self.mend)
        row.addStretch(1)
        self.add_indented(buttons)

    def clear(self) -> None:
        """Show nothing: the drawing, or the tolerance, is another one since."""
        self._faults = ()
        self._show(False, "")

    def show_progress(self, fraction: float) -> None:
        """Show that the drawing is being looked at."""
        self._busy = True
        self.bar.setValue(int(fraction * 1000))
        self.bar.show()
        self.look.setText("Cancel")

    def show_faults(self, faults: Sequence[ListedFault], reply: str) -> None:
        """Show what was found, and what mending it comes to; without a reply there is nothing to mend."""
        self._faults = tuple(faults[:MOST])
        self.list.clear()
        self.list.addItems([fault.words for fault in self._faults])
        for row, fault in enumerate(self._faults):
            self.list.item(row).setToolTip(fault.words)
        self.list.setFixedHeight(min(len(self._faults), _MOST_ROWS) * _ROW_PX)
        kinds = ", ".join(counted(count, kind) for kind, count in Counter(fault.kind for fault in faults).items())
        found = f"{kinds}." if faults else f"No fault within {self.tolerance.number:g} mm."
        more = f" The first {MOST} are listed." if len(faults) > MOST else ""
        self._show(bool(faults), f"{found}{more}" + (f" Mending: {reply}" if reply else ""))
        self.mend.setEnabled(bool(reply))
        self.remark.setText(f"{grouped(len(faults), 0)} found" if faults else "")

    def show_refusal(self, reason: str) -> None:
        """Say why the drawing could not be looked at."""
        self._show(False, reason)

    def _show(self, found: bool, words: str) -> None:
        self._busy = False
        self.look.setText("Look")
        self.bar.hide()
        self.remark.setText("")
        show_words(self.words, words)
        self.list.setVisible(found)
        self.mend.setVisible(found)

    def _on_look(self) -> None:
        if self._busy:
            self.cancelled.emit()
        else:
            self.looked.emit(self.tolerance.number)

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802 (Qt's name)
        """Enter in the tolerance looks."""
        if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and self.tolerance.edit.hasFocus():
            self._on_look()
        else:
            super().keyPressEvent(event)
