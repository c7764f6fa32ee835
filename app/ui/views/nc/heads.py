"""The bars over text and path: what is shown and how it was read; from where it is seen and what colours tell."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QComboBox, QHBoxLayout, QPushButton, QSizePolicy, QWidget

from ....gcode.interpreter.dialect import DIALECT_RULES, Dialect
from ...framework.boxes import give_ground, h_box
from ...framework.fields import ChoiceField
from ...framework.icons import IconButton
from ...framework.labels import Elided, muted
from .motion_shapes import ViewSide
from .painting.motion_layer import MotionColourBy

BAR_PX = 36
_ROOM_PX = 420
_GAP_PX, _BUTTON_PX = 8, 44
_LEAST_CHOICE_PX, _LEAST_PX = 72, 360


def bar(widget: QWidget, spacing: int = 8) -> QHBoxLayout:
    """Make a widget a bar over what is below it; return its row."""
    give_ground(widget, "ncBar")
    widget.setFixedHeight(BAR_PX)
    return h_box(widget, (12, 0, 8, 0), spacing)


class TextHead(QWidget):
    """Name of the program, its dialect, find.

    Signals:
        dialect_chosen(Dialect or None): how to read it; None = as it looks. file_chosen(index): of a program in several
            files. find_requested(). closed(): take this program away.
    """

    dialect_chosen = Signal(object)
    file_chosen = Signal(int)
    find_requested = Signal()
    closed = Signal()

    def __init__(self, closable: bool = False) -> None:
        super().__init__()
        self.name, self.detail = Elided(), muted()
        self.files, self.dialect = QComboBox(), QComboBox()
        self.files.setAccessibleName("File of the program")
        self.files.setToolTip("This control takes one file for each tool")
        self.files.setFixedHeight(24)
        self.files.activated.connect(self.file_chosen)
        self.files.hide()
        self.dialect.setAccessibleName("Control that the program is for")
        self.dialect.setToolTip("How the program is read")
        self.dialect.setFixedHeight(24)
        self.dialect.setSizePolicy(QSizePolicy.Policy.Maximum, QSizePolicy.Policy.Fixed)
        self.dialect.setMinimumWidth(_LEAST_CHOICE_PX)
        self.dialect.activated.connect(lambda at: self.dialect_chosen.emit(self.dialect.itemData(at)))
        self._offer("as it looks")
        self._buttons = _BUTTON_PX * (2 if closable else 1)
        row = bar(self)
        row.addWidget(self.name, 1)
        row.addWidget(self.files, 1)
        row.addWidget(self.detail)
        row.addWidget(self.dialect)
        find = IconButton("find", "Find (Ctrl+F)")
        find.clicked.connect(self.find_requested)
        row.addWidget(find)
        if closable:
            close = IconButton("cancel", "Close this program")
            close.clicked.connect(self.closed)
            row.addWidget(close)

    def show_program(self, name: str, detail: str) -> None:
        """Name the program."""
        self.name.setText(name)
        self.name.setToolTip(f"{name}, {detail}" if detail else name)
        self.detail.setText(detail)
        self._make_room()

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 (Qt's name)
        """Leave out how long it is where its name needs the room."""
        super().resizeEvent(event)
        self._make_room()

    def _make_room(self) -> None:
        shown = [each for each in (self.files, self.dialect) if not each.isHidden()]
        beside = sum(each.sizeHint().width() + _GAP_PX for each in (self.detail, *shown))
        name = self.name.sizeHint().width() if not self.name.isHidden() else 0
        self.detail.setVisible(bool(self.detail.text()) and name + beside + self._buttons <= self.width())
        self.name.setMinimumWidth(min(name, max(0, self.width() - self._buttons - _LEAST_CHOICE_PX - 2 * _GAP_PX)))

    def show_files(self, names: list[str], current: int) -> None:
        """Offer the files of a program that has several; one alone is only named."""
        self.files.clear()
        self.files.addItems(names)
        self.files.setCurrentIndex(current)
        self.files.setVisible(len(names) > 1)
        self.name.setVisible(len(names) < 2)

    def show_dialect(self, guessed: Dialect, chosen: Dialect | None, free: bool) -> None:
        """Show how the program is read.

        Args:
            guessed: what it looks like.
            chosen: what the user said; None = nothing.
            free: the user may say otherwise.
        """
        self._offer(DIALECT_RULES[guessed].title)
        self.dialect.setCurrentIndex(self.dialect.findData(chosen))
        self.dialect.setVisible(free)
        self._make_room()

    def _offer(self, guessed: str) -> None:
        self.dialect.clear()
        self.dialect.addItem(f"Auto: {guessed}", None)
        for dialect, habits in DIALECT_RULES.items():
            self.dialect.addItem(habits.title, dialect)


class Banner(QWidget):
    """One sentence about the program that is shown, and what to do about it.

    Signals:
        pressed(): do it.
    """

    pressed = Signal()

    def __init__(self) -> None:
        super().__init__()
        row = bar(self)
        self.sentence, self.button = Elided(role="muted"), QPushButton()
        self.button.setProperty("role", "link")
        self.button.setCursor(Qt.CursorShape.PointingHandCursor)
        self.button.clicked.connect(self.pressed)
        row.addWidget(self.sentence)
        row.addWidget(self.button, 1)
        self.hide()

    def say(self, sentence: str, button: str) -> None:
        """Show a sentence and the button behind it, "" = none."""
        self.sentence.setText(sentence)
        self.button.setText(button)
        self.button.setVisible(bool(button))
        self.show()
        self._make_room()

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 (Qt's name)
        """Leave the sentence out where there is room for the button alone, which says as much."""
        super().resizeEvent(event)
        self._make_room()

    def _make_room(self) -> None:
        needed = self.sentence.sizeHint().width() + self.button.sizeHint().width() + 3 * _GAP_PX
        self.sentence.setVisible(self.button.isHidden() or needed <= self.width())
        self.button.setToolTip(self.sentence.text())


class PathHead(QWidget):
    """Sides and colours of the path.

    Signals:
        side_chosen(ViewSide). colour_chosen(MotionColourBy). fit_requested(): show everything. cut_requested(): show
        what the program leaves.
    """

    fit_requested = Signal()
    cut_requested = Signal()
    side_chosen = Signal(ViewSide)
    colour_chosen = Signal(MotionColourBy)

    def __init__(self) -> None:
        super().__init__()
        self.side = ChoiceField("", [(side, side.name) for side in ViewSide])
        self.colour = ChoiceField("", [(MotionColourBy.TOOL, "Tool"), (MotionColourBy.MOTION, "Motion")])
        self.side.show_value(ViewSide.XY)
        self.colour.show_value(MotionColourBy.TOOL)
        self.side.chosen.connect(self.side_chosen)
        self.colour.chosen.connect(self.colour_chosen)
        for field, what in ((self.side, "Seen from"), (self.colour, "Colour by")):
            for button in field.buttons.values():
                button.setToolTip(f"{what} {button.text()}")
                button.setAccessibleName(f"{what} {button.text()}")
        row = bar(self, 4)
        row.addWidget(self.side)
        row.addStretch(1)
        self.key = muted("Colour by")
        row.addWidget(self.key)
        row.addWidget(self.colour)
        self.fit = IconButton("fit", "Fit (F)")
        self.fit.clicked.connect(self.fit_requested)
        self.cut = QPushButton("Show the cut")
        self.cut.setProperty("role", "link")
        self.cut.setCursor(Qt.CursorShape.PointingHandCursor)
        self.cut.setToolTip("Cut this program out of its stock and show what is left (Ctrl+K)")
        self.cut.clicked.connect(self.cut_requested)
        row.addSpacing(4)
        row.addWidget(self.fit)
        row.addSpacing(4)
        row.addWidget(self.cut)

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 (Qt's name)
        """Leave out what explains itself where there is no room for it."""
        super().resizeEvent(event)
        self.key.setVisible(event.size().width() >= _ROOM_PX)
        self.colour.setVisible(event.size().width() >= _LEAST_PX)
