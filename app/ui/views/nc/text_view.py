"""The text of an NC program: line numbers, colours, marks. Only the lines in sight are cut out and painted."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QPoint, Qt, Signal
from PySide6.QtGui import (
    QContextMenuEvent,
    QFontMetricsF,
    QGuiApplication,
    QHelpEvent,
    QKeyEvent,
    QKeySequence,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QResizeEvent,
)
from PySide6.QtWidgets import QAbstractScrollArea, QToolTip

from ....gcode.interpreter.program import ProgramProblem
from ...framework.theme import LIGHT, Theme, mono_font
from .line_marks import LineMarks, line_marks
from .painting.motion_layer import MotionColourBy
from .painting.text_painter import LINE_PX, MARKS_PX, TextStyle, paint_lines, paint_marks
from .program_text import ProgramText, program_text

_NO_TEXT = program_text(b"")
_SPARE_ROWS = 2


class NcTextView(QAbstractScrollArea):
    """Read-only NC text.

    Signals:
        rows_picked(first, last): the user chose lines (0-based, both included). menu_requested(point): right click, on
        the screen.
    """

    rows_picked = Signal(int, int)
    menu_requested = Signal(QPoint)

    def __init__(self) -> None:
        super().__init__()
        self._look = TextStyle(_NO_TEXT, line_marks(0), LIGHT)
        self.setFrameShape(QAbstractScrollArea.Shape.NoFrame)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setAccessibleName("NC program")
        self.setMinimumWidth(160)
        self.viewport().setCursor(Qt.CursorShape.IBeamCursor)
        self._letter = QFontMetricsF(mono_font()).horizontalAdvance("0")

    @property
    def text(self) -> ProgramText:
        """What is shown."""
        return self._look.text

    @property
    def current(self) -> int:
        """The row (0-based) that was picked last; -1 = none."""
        return self._look.cursor

    @property
    def selection(self) -> tuple[int, int]:
        """First and last picked row (0-based); (-1, -1) when none is."""
        return (min(self._look.anchor, self._look.cursor), max(self._look.anchor, self._look.cursor))

    @property
    def rows_in_sight(self) -> int:
        """How many whole lines fit."""
        return max(1, self.viewport().height() // LINE_PX)

    def set_theme(self, theme: Theme) -> None:
        """Follow the theme."""
        self._change(theme=theme)

    def show_text(self, text: ProgramText) -> None:
        """Show another program from its beginning."""
        self._change(text=text, lines=line_marks(len(text)), cursor=-1, anchor=-1, found=())
        self._set_ranges()
        self.verticalScrollBar().setValue(0)
        self.horizontalScrollBar().setValue(0)

    def clear(self) -> None:
        """Show nothing."""
        self.show_text(_NO_TEXT)

    def show_looks(self, lines: LineMarks) -> None:
        """Show what the lines move and what is wrong with them."""
        self._change(lines=lines)

    def set_colour(self, colour: MotionColourBy) -> None:
        """Let the bars beside the lines tell the tool or the kind of motion."""
        self._change(colour=colour)

    def show_found(self, words: str, rows: tuple[int, ...]) -> None:
        """Mark words wherever they stand; `rows` hold them."""
        self._change(words=words, found=rows)

    def pick(self, row: int, extend: bool = False, tell: bool = True) -> None:
        """Mark a line (0-based) and bring it into sight.

        Args:
            row: brought into the text when it lies beyond its ends.
            extend: keep the other end of the selection.
            tell: emit `rows_picked`.
        """
        if not len(self.text):
            return
        row = min(max(row, 0), len(self.text) - 1)
        self._change(cursor=row, anchor=self._look.anchor if extend and self._look.anchor >= 0 else row)
        self.bring_into_sight(row)
        if tell:
            self.rows_picked.emit(*self.selection)

    def pick_rows(self, anchor: int, cursor: int, tell: bool = True) -> None:
        """Mark lines from one (0-based) to another, where the cursor is; `tell`: emit `rows_picked`."""
        self._change(anchor=anchor, cursor=cursor)
        if tell:
            self.rows_picked.emit(*self.selection)

    def bring_into_sight(self, row: int, column: int = 0, centred: bool = False) -> None:
        """Scroll until a line, and a column of it, can be seen; a far line comes to the middle."""
        bar, top, height = self.verticalScrollBar(), row * LINE_PX, self.viewport().height()
        far = top < bar.value() - height or top > bar.value() + 2 * height
        if far or centred:
            bar.setValue(top - height // 2 + LINE_PX)
        elif top < bar.value() + LINE_PX:
            bar.setValue(top - LINE_PX)
        elif top > bar.value() + height - _SPARE_ROWS * LINE_PX:
            bar.setValue(top - height + _SPARE_ROWS * LINE_PX)
        across, x, room = (
            self.horizontalScrollBar(),
            round(column * self._letter),
            self.viewport().width() - self._look.gutter() - 60,
        )
        if not across.value() <= x <= across.value() + room:
            across.setValue(x - room // 2 if column else 0)

    def selected_text(self) -> str:
        """Return the picked lines; all of them when none is picked."""
        first, last = self.selection
        return self.text.rows(first, last) + "\n" if first >= 0 else self.text.text

    def problems_at(self, row: int) -> list[ProgramProblem]:
        """Return what is wrong with a line."""
        return self._look.lines.problems.get(row, [])

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 (Qt's name)
        """Keep the scroll ranges in step, and the picked line in sight."""
        super().resizeEvent(event)
        top, height = self.current * LINE_PX - self.verticalScrollBar().value(), event.oldSize().height()
        self._set_ranges()
        if self.current >= 0 and -LINE_PX < top < max(height, 0):
            self.bring_into_sight(self.current)

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 (Qt's name)
        """Draw the lines in sight."""
        painter = QPainter(self.viewport())
        shift = (self.horizontalScrollBar().value(), self.verticalScrollBar().value())
        paint_lines(painter, self.viewport().rect(), shift, self._look)
        paint_marks(painter, self.viewport().rect(), self._look)
        painter.end()

    def mousePressEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Pick the line under the mouse; with Shift all lines up to it. Beside the scroll bar: go to that place of the
        program.
        """
        at = event.position()
        if event.button() is Qt.MouseButton.LeftButton and at.x() >= self.viewport().width() - MARKS_PX:
            self.pick(int(at.y() / self.viewport().height() * len(self.text)))
        elif event.button() is Qt.MouseButton.LeftButton:
            self.pick(self._row_at(at.y()), bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier))

    def mouseMoveEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Pick the lines that the mouse is dragged over."""
        row = self._row_at(event.position().y())
        if event.buttons() & Qt.MouseButton.LeftButton and row != self.current and self.current >= 0:
            self.pick(row, extend=True)

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:  # noqa: N802 (Qt's name)
        """Pick the line under the mouse, unless it is picked, and ask for a menu."""
        if event.reason() is QContextMenuEvent.Reason.Mouse:
            row = self._row_at(event.pos().y())
            if not self.selection[0] <= row <= self.selection[1]:
                self.pick(row)
        self.menu_requested.emit(event.globalPos())

    def viewportEvent(self, event: QEvent) -> bool:  # noqa: N802 (Qt's name)
        """Tell what is wrong with the line under the mouse."""
        if isinstance(event, QHelpEvent) and event.type() == QEvent.Type.ToolTip:
            problems = self.problems_at(self._row_at(event.pos().y()))
            QToolTip.showText(event.globalPos(), "\n".join(problem.text for problem in problems), self)
            return True
        return super().viewportEvent(event)

    def event(self, event: QEvent) -> bool:
        """Keep Ctrl+A and Ctrl+C from the drawing."""
        if (
            event.type() == QEvent.Type.ShortcutOverride
            and isinstance(event, QKeyEvent)
            and (event.matches(QKeySequence.StandardKey.SelectAll) or event.matches(QKeySequence.StandardKey.Copy))
        ):
            event.accept()
            return True
        return super().event(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802 (Qt's name)
        """Walk through the lines, with Shift pick them; Home and End go along the line, with Ctrl to the program's
        ends.
        """
        page = max(1, self.rows_in_sight - 1)
        steps = {Qt.Key.Key_Up: -1, Qt.Key.Key_Down: 1, Qt.Key.Key_PageUp: -page, Qt.Key.Key_PageDown: page}
        control = bool(event.modifiers() & Qt.KeyboardModifier.ControlModifier)
        extend = bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier)
        key = event.key()
        if event.matches(QKeySequence.StandardKey.Copy):
            QGuiApplication.clipboard().setText(self.selected_text())
        elif event.matches(QKeySequence.StandardKey.SelectAll):
            self.pick_rows(0, len(self.text) - 1)
        elif key in steps:
            self.pick(
                max(self.current, 0) + steps[Qt.Key(key)] if self.current >= 0 or key == Qt.Key.Key_PageDown else 0,
                extend,
            )
        elif key in (Qt.Key.Key_Home, Qt.Key.Key_End) and control:
            self.pick(0 if key == Qt.Key.Key_Home else len(self.text) - 1, extend)
        elif key in (Qt.Key.Key_Home, Qt.Key.Key_End) and self.current >= 0:
            length = self.text.length(self.current)
            self.bring_into_sight(self.current, length if key == Qt.Key.Key_End else 0)
        elif key in (Qt.Key.Key_Left, Qt.Key.Key_Right):
            bar = self.horizontalScrollBar()
            bar.setValue(bar.value() + round(8 * self._letter) * (1 if key == Qt.Key.Key_Right else -1))
        else:
            super().keyPressEvent(event)

    def _row_at(self, y: float) -> int:
        return int((y + self.verticalScrollBar().value()) // LINE_PX)

    def _change(self, **what: object) -> None:
        self._look = self._look.changed(**what)
        self.viewport().update()

    def _set_ranges(self) -> None:
        view, down, across = self.viewport(), self.verticalScrollBar(), self.horizontalScrollBar()
        down.setRange(0, max(0, (len(self.text) + 1) * LINE_PX - view.height()))
        down.setPageStep(max(LINE_PX, view.height() - LINE_PX))
        down.setSingleStep(LINE_PX)
        room = view.width() - self._look.gutter() - MARKS_PX
        across.setRange(0, max(0, round((self.text.longest + 1) * self._letter) - room))
        across.setPageStep(max(1, room))
        across.setSingleStep(round(8 * self._letter))
