"""What a word that is being typed could become, and the list that offers it."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass

from PySide6.QtCore import QModelIndex, QPersistentModelIndex, QPoint, QRect, QSize, Qt, Signal
from PySide6.QtGui import QFontMetrics, QPainter
from PySide6.QtWidgets import QListWidget, QListWidgetItem, QStyle, QStyledItemDelegate, QStyleOptionViewItem, QWidget

from ....drafting.commands.command import DraftingSession
from ...framework.theme import LIGHT, Theme, mixed, mono_font, text_font
from .blocks import KnownName
from .usage import WordKind, usage_of, usages

_ROW_PX, _MOST_ROWS = 24, 8
_LEAST_PX, _WIDEST_PX = 280, 380
_STATEMENT = re.compile(r"(?:^|;)\s*(?:([^\W\d]\w*)(?=[\s(]))?[^;]*$")
_WORD_BEFORE = re.compile(r"[^\W\d]\w*$")


@dataclass(frozen=True, slots=True)
class CompletionItem:
    """A word that can be put, and how it is used."""

    word: str
    form: str
    behind: str = ""


def word_before(line: str) -> str:
    """Return the word that a line, cut at the cursor, ends with; "" = none, or it stands in a remark or in quotes."""
    if "#" in re.sub(r"\"[^\"]*\"", "", line) or line.count('"') % 2:
        return ""
    found = _WORD_BEFORE.search(line)
    return found[0] if found and not line[: found.start()].endswith((".", "_")) else ""


def names_of(session: DraftingSession) -> list[KnownName]:
    """Return the names that a session knows."""
    return [*map(KnownName, session.names), *(KnownName(name, True) for name in session.commands)]


def offers(line: str, names: Iterable[KnownName]) -> list[CompletionItem]:
    """Return what the word at the end of a line, cut at the cursor, could become, best first.

    Args:
        line: as typed so far.
        names: (name, whether it is a command) of what the text and the drawing name.
    """
    begun = word_before(line).lower()
    before = line[: len(line) - len(begun)]
    statement = _STATEMENT.search(before)
    command = statement[1] if statement else None
    found = list[CompletionItem]()
    if not command:
        found += [
            CompletionItem(usage.word, usage.form, " ")
            for key, usage in usages().items()
            if usage.kind is not WordKind.FUNCTION
        ]
        found += [CompletionItem(name, "your command", " ") for name, runs in names if runs]
    else:
        usage = usage_of(command)
        found += [CompletionItem(word, usage.form) for word in usage.options] if usage is not None else []
        found += [CompletionItem("as", "as NAME", " ")]
        found += [CompletionItem(name, "your name") for name, runs in names if not runs]
        found += [
            CompletionItem(each.word, each.form, "(") for each in usages().values() if each.kind is WordKind.FUNCTION
        ]
    unique = {offer.word: offer for offer in reversed(found)}
    fitting = (offer for offer in unique.values() if offer.word.lower().startswith(begun))
    return sorted(fitting, key=lambda offer: (found.index(offer) if command else 0, offer.word))


class CompletionList(QListWidget):
    """The offers, under the word; the editor keeps the keyboard.

    Signals:
        taken(CompletionItem): it was clicked.
    """

    taken = Signal(CompletionItem)

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setObjectName("offers")
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setUniformItemSizes(True)
        self._painter = _CompletionDelegate(self)
        self.setItemDelegate(self._painter)
        self.itemClicked.connect(lambda item: self.taken.emit(item.data(Qt.ItemDataRole.UserRole)))
        self.hide()

    def set_theme(self, theme: Theme) -> None:
        """Follow the theme."""
        self._painter.theme = theme
        edge = mixed(theme.paper, theme.ink, 0.24).name()
        self.setStyleSheet(
            f"QListWidget#offers {{ background: {theme.raised.name()}; border: 1px solid {edge}; padding: 4px; }}"
        )

    @property
    def current(self) -> CompletionItem | None:
        """The offer that Enter takes."""
        item = self.currentItem()
        offer = item.data(Qt.ItemDataRole.UserRole) if item is not None else None
        return offer if isinstance(offer, CompletionItem) else None

    def show_offers(self, found: list[CompletionItem], word: QRect, room: QRect) -> None:
        """Show offers below a word, or above it where there is more room; all in the parent's coordinates."""
        self.clear()
        for offer in found:
            item = QListWidgetItem(offer.word)
            item.setData(Qt.ItemDataRole.UserRole, offer)
            self.addItem(item)
        self.setCurrentRow(0)
        height = min(len(found), _MOST_ROWS) * _ROW_PX + 10
        width = min(max(room.right() - word.left() - 8, _LEAST_PX), _WIDEST_PX)
        below = word.bottom() + 4 + height <= room.bottom() or word.top() - room.top() < height
        top = word.bottom() + 4 if below else word.top() - 4 - height
        self.setGeometry(QRect(QPoint(min(word.left(), room.right() - width - 8), top), QSize(width, height)))
        self.show()
        self.raise_()

    def step(self, way: int) -> None:
        """Go to the next offer, or the one before; round at the ends."""
        self.setCurrentRow((self.currentRow() + way) % self.count())


class _CompletionDelegate(QStyledItemDelegate):
    """The word, and quietly how it is used."""

    theme: Theme = LIGHT

    def sizeHint(self, option: QStyleOptionViewItem, index: QModelIndex | QPersistentModelIndex) -> QSize:  # noqa: N802 (Qt's name)
        return QSize(100, _ROW_PX)

    def paint(
        self, painter: QPainter, option: QStyleOptionViewItem, index: QModelIndex | QPersistentModelIndex
    ) -> None:
        offer, area = index.data(Qt.ItemDataRole.UserRole), option.rect
        if option.state & QStyle.StateFlag.State_Selected:
            painter.fillRect(area, self.theme.chosen)
        painter.setFont(mono_font())
        painter.setPen(self.theme.ink)
        width = QFontMetrics(mono_font()).horizontalAdvance(offer.word)
        painter.drawText(area.adjusted(8, 0, 0, 0), Qt.AlignmentFlag.AlignVCenter, offer.word)
        left = max(8 + width + 16, 112)
        painter.setFont(text_font())
        painter.setPen(self.theme.muted)
        form = QFontMetrics(text_font()).elidedText(offer.form, Qt.TextElideMode.ElideRight, area.width() - left - 8)
        painter.drawText(area.adjusted(left, 0, -8, 0), Qt.AlignmentFlag.AlignVCenter, form)
