"""Over the cut, above its bar: how it shall be recorded."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QPainter, QPaintEvent
from PySide6.QtWidgets import QFrame, QHBoxLayout, QPushButton, QWidget

from ...framework.boxes import v_box
from ...framework.fields import ChoiceField, NumberField, NumberSpec
from ...framework.figures import TIMES, counted
from ...framework.icons import IconButton
from ...framework.labels import muted
from ...framework.section import heading
from ...framework.themed import Themed
from .gif import MOST_PER_SECOND

LENGTH = NumberSpec(
    "Length",
    "s",
    0.1,
    600.0,
    1,
    False,
    "How long the recording runs; all of the cut is in it, but for dwells and changes of tool.",
)
RATE = NumberSpec("Pictures", "a second", 1.0, MOST_PER_SECOND, 0, False, "More run smoother and make a larger file.")
WIDTH = NumberSpec("Width", "px", 64.0, 4096.0, 0, False, "Of the pictures; their height follows from the view.")

_SHEET_PX = 300


class RecordFormat(Enum):
    """What is written."""

    GIF = "gif"
    PICTURES = "pictures"


class RecordedMotion(Enum):
    """What moves in a recording; the value is its name for people."""

    CUT = "The tool"
    TURNTABLE = "Turntable"


@dataclass(frozen=True, slots=True)
class RecordPlan:
    """How a cut is recorded.

    Attributes:
        seconds: how long it runs. per_second: pictures. width: of them, px.
        motion: the cut as it is made, or the whole of it, turned once round.
    """

    seconds: float = 10.0
    per_second: float = 20.0
    width: int = 800
    motion: RecordedMotion = RecordedMotion.CUT

    @property
    def count(self) -> int:
        """How many pictures there are: at least the first and the last one."""
        return max(round(self.seconds * self.per_second), 2)

    def size(self, view: tuple[int, int]) -> tuple[int, int]:
        """Return width and height of the pictures of a view of so many px."""
        return self.width, max(round(self.width * view[1] / view[0]), 1)


class RecordSheet(Themed, QFrame):
    """A sheet with a choice, three fields and two buttons.

    Signals:
        requested(RecordFormat): record so. closed(): rather not.
    """

    requested = Signal(object)
    closed = Signal()

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.plan = RecordPlan()
        self.length, self.rate, self.width_px = NumberField(LENGTH), NumberField(RATE), NumberField(WIDTH)
        self.motion = ChoiceField("Moving", [(each, each.value) for each in RecordedMotion])
        self.motion.show_value(RecordedMotion.CUT)
        self.motion.chosen.connect(lambda _: self._take())
        self.summary = muted()
        self.gif, self.pictures = QPushButton("Save GIF…"), QPushButton("Save pictures…")
        self._size = (4, 3)
        self._lay_out()
        for field in (self.length, self.rate, self.width_px):
            field.committed.connect(lambda _: self._take())
        self.gif.clicked.connect(lambda: self.requested.emit(RecordFormat.GIF))
        self.pictures.clicked.connect(lambda: self.requested.emit(RecordFormat.PICTURES))
        self.hide()

    def _lay_out(self) -> None:
        close = IconButton("cancel", "Close (Esc)", self)
        close.clicked.connect(self.closed)
        head, buttons = QHBoxLayout(), QHBoxLayout()
        head.addWidget(heading("Record"), 1)
        head.addWidget(close)
        for button in (self.gif, self.pictures):
            buttons.addWidget(button)
        buttons.addStretch(1)
        column = v_box(self, (16, 8, 12, 12), 4)
        column.addLayout(head)
        for widget in (self.motion, self.length, self.rate, self.width_px, self.summary):
            column.addWidget(widget)
        column.addSpacing(4)
        column.addLayout(buttons)
        self.setFixedWidth(_SHEET_PX)

    def open_for(self, size: tuple[int, int]) -> None:
        """Ask for a recording of a view of so many px."""
        self._size = size
        self.motion.show_value(self.plan.motion)
        self.length.show_value(self.plan.seconds)
        self.rate.show_value(self.plan.per_second)
        self.width_px.show_value(float(self.plan.width))
        self._take()
        self.adjustSize()
        self.show()
        self.raise_()
        self.gif.setFocus(Qt.FocusReason.PopupFocusReason)

    def _take(self) -> None:
        motion = RecordedMotion(self.motion.value)
        self.plan = RecordPlan(self.length.number, self.rate.number, round(self.width_px.number), motion)
        wide, high = self.plan.size(self._size)
        self.summary.setText(f"{counted(self.plan.count, 'picture')} of {wide} {TIMES} {high} px")

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 (Qt's name)
        """Paint the sheet."""
        painter = QPainter(self)
        painter.setPen(self._theme.hairline)
        painter.setBrush(self._theme.paper)
        painter.drawRoundedRect(self.rect().adjusted(0, 0, -1, -1), 6, 6)
