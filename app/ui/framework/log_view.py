"""The log above the command line: commands at the left, replies in a column beside them; lines can be copied and put
back.
"""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

from PySide6.QtCore import QAbstractListModel, QModelIndex, QPersistentModelIndex, QPoint, QSize, Qt, Signal
from PySide6.QtGui import QContextMenuEvent, QFontMetrics, QGuiApplication, QKeyEvent, QKeySequence, QPainter
from PySide6.QtWidgets import (
    QAbstractItemView,
    QFrame,
    QListView,
    QMenu,
    QStyle,
    QStyledItemDelegate,
    QStyleOptionViewItem,
)

from ...drafting.document import LogLine
from .catalogue import tr
from .theme import LIGHT, Theme, mono_font, text_font
from .typed_text import is_typed

SHOWN_LINES = 3
LINE_PX = 20
_EDGE_PX = 16
_REPLY_PX, _COMMAND_SHARE = 264, 0.4
"""Where replies begin, for commands that leave room for that; of a row, what a longer command may take."""

_Index = QModelIndex | QPersistentModelIndex


class LogView(QListView):
    """A log, the newest line at the bottom; it scrolls, and as many lines are seen as there is room for.

    Signals:
        recalled(command): a line is wanted in the command line again.

    Attributes:
        lines: those that are shown, oldest first.
    """

    recalled = Signal(str)

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("logArea")
        self.setAccessibleName("Log: Enter puts a line back into the command line, Ctrl+C copies")
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setFixedHeight(SHOWN_LINES * LINE_PX + 12)
        self.setUniformItemSizes(True)
        self.setSelectionMode(QAbstractItemView.SelectionMode.ExtendedSelection)
        self.setVerticalScrollMode(QAbstractItemView.ScrollMode.ScrollPerItem)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setFocusPolicy(Qt.FocusPolicy.ClickFocus)
        self.setViewportMargins(0, 5, 0, 6)
        self._model, self._painter = _LogModel(self), _LinePainter(self)
        self.setModel(self._model)
        self.setItemDelegate(self._painter)
        self.activated.connect(self._recall)

    @property
    def lines(self) -> Sequence[LogLine]:
        """What is shown, oldest first."""
        return self._model.lines

    def set_theme(self, theme: Theme) -> None:
        """Follow the theme."""
        self._painter.theme = theme
        self.viewport().update()

    def show_lines(self, lines: Sequence[LogLine]) -> None:
        """Show a log that has grown, or another one."""
        self._model.show_lines(lines)
        self.scrollToBottom()

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802 (Qt's name)
        """Ctrl+C copies the chosen commands, a line each; Enter puts the current one back; text is not for the log."""
        if event.matches(QKeySequence.StandardKey.Copy):
            self.copy()
        elif event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self._recall(self.currentIndex())
        elif is_typed(event):
            event.ignore()  # a list would look for a line that begins so; it is the command line's
        else:
            super().keyPressEvent(event)

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:  # noqa: N802 (Qt's name)
        """Offer to copy, with the replies too, and to put a line back."""
        self.menu(self.indexAt(self.viewport().mapFromGlobal(event.globalPos()))).popup(event.globalPos())

    def menu(self, index: QModelIndex) -> QMenu:
        """Return what can be done with the chosen lines."""
        menu, chosen = QMenu(self), bool(self.selectedIndexes())
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        for words, possible, act in (
            ("&Copy", chosen, self.copy),
            ("Copy with &replies", chosen, self.copy_with_replies),
            ("&Put into the command line", index.isValid(), lambda: self._recall(index)),
            ("Select &all", True, self.selectAll),
        ):
            action = menu.addAction(words)
            action.setEnabled(possible)
            action.triggered.connect(lambda _=False, do=act: do())
        return menu

    def copy(self) -> None:
        """Copy the chosen commands: a text of the shape language."""
        QGuiApplication.clipboard().setText("\n".join(line.command for line in self._chosen()))

    def copy_with_replies(self) -> None:
        """Copy the chosen lines with what was answered."""
        QGuiApplication.clipboard().setText("\n".join(f"{line.command}    {tr(line.reply)}" for line in self._chosen()))

    def _chosen(self) -> list[LogLine]:
        return [self.lines[row] for row in sorted(index.row() for index in self.selectedIndexes())]

    def _recall(self, index: QModelIndex) -> None:
        if index.isValid():
            self.recalled.emit(self.lines[index.row()].command)


class _LogModel(QAbstractListModel):
    """Lines that are only ever added to, or all others."""

    def __init__(self, parent: LogView) -> None:
        super().__init__(parent)
        self.lines: Sequence[LogLine] = ()
        self._count = 0

    def show_lines(self, lines: Sequence[LogLine]) -> None:
        """Take over what was added to the lines, or other lines."""
        if lines is self.lines and len(lines) > self._count:
            self.beginInsertRows(QModelIndex(), self._count, len(lines) - 1)
            self._count = len(lines)
            self.endInsertRows()
        else:
            self.beginResetModel()
            self.lines, self._count = lines, len(lines)
            self.endResetModel()

    def rowCount(self, parent: _Index = QModelIndex()) -> int:  # noqa: N802, B008 (Qt's name and default)
        return 0 if parent.isValid() else self._count

    def data(self, index: _Index, role: int = Qt.ItemDataRole.DisplayRole) -> object:
        line = self.lines[index.row()]
        if role == Qt.ItemDataRole.UserRole:
            return line
        if role == Qt.ItemDataRole.DisplayRole:
            return f"{line.command}: {tr(line.reply)}"
        return _tip(line) if role == Qt.ItemDataRole.ToolTipRole else None


def _one_line(line: LogLine) -> str:
    return " ; ".join(line.command.splitlines())


def _tip(line: LogLine) -> str:
    """Return a line and its reply as a tip; as rich text, which is wrapped where it would leave the screen."""
    return f"<p>{escape(line.command)}</p><p>{escape(tr(line.reply))}</p>"


class _LinePainter(QStyledItemDelegate):
    """Paints a command and its reply, each as far as there is room: the replies in a column, but right behind a command
    that is longer.
    """

    theme: Theme = LIGHT

    def sizeHint(self, option: QStyleOptionViewItem, index: _Index) -> QSize:  # noqa: N802 (Qt's name)
        return QSize(100, LINE_PX)

    def paint(self, painter: QPainter, option: QStyleOptionViewItem, index: _Index) -> None:
        line, area, theme = index.data(Qt.ItemDataRole.UserRole), option.rect, self.theme
        if option.state & QStyle.StateFlag.State_Selected:
            painter.fillRect(area, theme.chosen)
        middle, command = self.reply_at(line, area.width()), _one_line(line)
        painter.setFont(mono_font())
        painter.setPen(theme.ink)
        self._text(painter, area.topLeft() + QPoint(_EDGE_PX, 0), middle - 2 * _EDGE_PX, command)
        painter.setFont(text_font())
        painter.setPen(theme.error if line.error else theme.muted)
        self._text(painter, area.topLeft() + QPoint(middle, 0), area.width() - middle - _EDGE_PX, tr(line.reply))

    def reply_at(self, line: LogLine, width: int) -> int:
        """Return where the reply begins in a row so many px wide."""
        behind = 3 * _EDGE_PX + QFontMetrics(mono_font()).horizontalAdvance(_one_line(line))
        return min(max(_REPLY_PX, behind), int(width * _COMMAND_SHARE))

    def _text(self, painter: QPainter, place: QPoint, width: int, text: str) -> None:
        short = QFontMetrics(painter.font()).elidedText(text, Qt.TextElideMode.ElideRight, width)
        painter.drawText(place.x(), place.y(), width, LINE_PX, Qt.AlignmentFlag.AlignVCenter, short)
