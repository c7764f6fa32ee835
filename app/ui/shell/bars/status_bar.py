"""The bottom line: where the mouse is, what it snaps to, how far the job is, and the verdict."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QFrame, QLabel, QProgressBar, QSizePolicy, QToolButton, QWidget

from ...framework.boxes import give_ground, h_box
from ...framework.catalogue import tr
from ...framework.icons import IconButton
from ...framework.labels import Elided, muted, set_role
from .badge import Badge

_STEP_PX, _BAR_PX = 180, 120
"""So much of what a running job tells is shown whole; the message gives way first."""
_NARROW_PX = 1150
"""A narrower window has less room for a running job."""


def _separator() -> QFrame:
    made = QFrame()
    made.setObjectName("hairline")
    made.setFixedSize(1, 16)
    return made


class StatusBar(QWidget):
    """Coordinates, toggles, message, progress with cancel, badge.

    Signals:
        cancelled(): the user leaves the running job.
    """

    cancelled = Signal()

    def __init__(self) -> None:
        super().__init__()
        give_ground(self, "statusBar")
        self.setFixedHeight(34)
        self.place_x, self.place_y = QLabel(), QLabel()
        self.snap, self.ortho, self.polar, self.grid = (
            self._toggle(text) for text in ("Snap", "Ortho", "Polar", "Grid")
        )
        self.unit, self._size, self._shown = muted("mm"), 1.0, (0.0, 0.0, "XY")
        self._step = 0.0
        self.message = Elided(role="muted")
        self.waiting = muted()
        self.message.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        self.bar, self.step = QProgressBar(), Elided(role="muted")  # a job may name a file of any length
        self.cancel = IconButton("cancel", "Cancel the job (Esc)")
        self.badge = Badge()
        self._lay_out()
        self.show_place(0.0, 0.0)
        self.show_progress(None)
        self.show_waiting("")
        self.cancel.clicked.connect(self.cancelled)

    def _toggle(self, text: str) -> QToolButton:
        button = QToolButton()
        button.setText(text)
        button.setCheckable(True)
        button.setProperty("role", "toggle")
        button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        return button

    def _lay_out(self) -> None:
        row = h_box(self, (16, 0, 8, 0), 8)
        for label in (self.place_x, self.place_y):
            label.setMinimumWidth(label.fontMetrics().horizontalAdvance("X -999.999"))
            row.addWidget(label)
        row.addWidget(self.unit)
        row.addSpacing(4)
        row.addWidget(_separator())
        for button in (self.snap, self.ortho, self.polar, self.grid):
            row.addWidget(button)
        row.addWidget(_separator())
        row.addSpacing(4)
        row.addWidget(self.message, 1)
        row.addWidget(self.waiting)
        self.bar.setFixedSize(_BAR_PX, 4)
        self.bar.setTextVisible(False)
        self.bar.setRange(0, 1000)
        for widget in (self.step, self.bar, self.cancel, self.badge):
            row.addWidget(widget)

    def show_place(self, x: float, y: float, axes: str = "XY") -> None:
        """Show where the mouse is, mm, to the right and up, along which axes."""
        self._shown = (x, y, axes)
        self.place_x.setText(f"{axes[0]} {self._figure(x)}")
        self.place_y.setText(f"{axes[1]} {self._figure(y)}")

    def show_grid(self, step: float) -> None:
        """Show the grid's step at this zoom, mm."""
        self._step = step
        self.grid.setText(f"Grid {self._figure(step)}")

    def set_unit(self, size: float, name: str) -> None:
        """Show lengths in a unit of so many mm; the finer figures of larger ones have a digit more."""
        self._size = size
        self.unit.setText(name)
        self.show_place(*self._shown)
        if self._step:
            self.show_grid(self._step)

    def _figure(self, value: float) -> str:
        return f"{value / self._size:.{3 if self._size == 1 else 4}f}"

    def show_message(self, text: str, error: bool = False) -> None:
        """Show one sentence; the whole of it is in the tool tip."""
        self.message.setText(text)
        self.message.setToolTip(text)
        role = "error" if error else "muted"
        if self.message.property("role") != role:
            set_role(self.message, role)

    def show_waiting(self, text: str) -> None:
        """Show what goes on in the background, which nobody needs to wait for, where no job tells of itself; "" =
        nothing.
        """
        self.waiting.setText(text)
        self.waiting.setVisible(bool(text) and self.step.isHidden())

    def show_progress(self, fraction: float | None, text: str = "") -> None:
        """Show how far the job is, in [0, 1]; None = no job."""
        for widget in (self.step, self.bar, self.cancel):
            widget.setVisible(fraction is not None)
        self.waiting.setVisible(fraction is None and bool(self.waiting.text()))
        self.bar.setValue(round(1000 * (fraction or 0.0)))
        self.step.setText(text)
        self.step.setToolTip(text)
        self._make_room()

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 (Qt's name)
        """Have what a running job tells give way in a narrow window."""
        super().resizeEvent(event)
        self._make_room()

    def _make_room(self) -> None:
        share = 1 if self.width() >= _NARROW_PX else 3
        self.bar.setFixedWidth(_BAR_PX // share)
        words = self.step.fontMetrics().horizontalAdvance(tr(self.step.text())) + 2
        self.step.setMinimumWidth(min(words, _STEP_PX // share))
