"""The manual beside the work: its pages, a search through all of them, and the usage of a word of the shape
language.
"""

from __future__ import annotations

from itertools import groupby

from PySide6.QtCore import QEvent, QObject, Qt, QUrl
from PySide6.QtGui import QDesktopServices, QKeyEvent, QTextCursor, QTextDocument
from PySide6.QtWidgets import QLineEdit, QListWidget, QListWidgetItem, QTextBrowser, QTextEdit, QWidget

from ....usecases.manual.pages import base_of, group_of
from ...framework.boxes import give_ground, h_box, v_box
from ...framework.catalogue import active_language
from ...framework.labels import muted, restyle
from ...framework.theme import LIGHT, Theme, mixed, text_font
from ...views.language.usage import usage_of
from .help_pages import HelpPage, pages, rendered

_SIZE = (884, 640)
_LIST_PX = 224
LANGUAGE = "language"
_PAGE = Qt.ItemDataRole.UserRole  # of a row in the list: the number of its page


class HelpWindow(QWidget):
    """A window of its own, so that it can stand beside the drawing; pages are laid out when they are first looked
    at.
    """

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent, Qt.WindowType.Window)
        give_ground(self, "root")
        self.setWindowTitle("Hitofude: manual")
        self.resize(*_SIZE)
        self.pages: tuple[HelpPage, ...] = ()
        self._code = ""
        self._theme, self._laid_out = LIGHT, dict[str, QTextDocument]()
        self.search, self.count, self.list, self.browser = QLineEdit(), muted(), QListWidget(), QTextBrowser()
        self.search.setPlaceholderText("Search the manual")
        self.search.setAccessibleName("Search the manual")
        self.search.setClearButtonEnabled(True)
        self.search.installEventFilter(self)
        self.list.installEventFilter(self)
        self.search.textEdited.connect(lambda _: self._on_typed())
        self.list.setAccessibleName("Pages")
        self.list.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.list.setTextElideMode(Qt.TextElideMode.ElideRight)
        self.list.currentRowChanged.connect(self._show_row)
        self.browser.setFrameShape(QTextBrowser.Shape.NoFrame)
        self.browser.setOpenLinks(False)
        self.browser.anchorClicked.connect(self._on_link)
        self._lay_out()
        self.count.hide()

    def set_theme(self, theme: Theme) -> None:
        """Follow the theme."""
        self._theme = theme
        self._laid_out.clear()
        self.browser.setStyleSheet(
            f"QTextBrowser {{ background: {theme.raised.name()}; color: {theme.ink.name()}; border: 0; }}"
        )
        self._show_row(self.list.currentRow())

    @property
    def page(self) -> str:
        """Name of the page in front; "" before the first."""
        shown = self._shown
        return self.pages[shown].name if shown >= 0 else ""

    @property
    def _shown(self) -> int:
        """Number of the page in front, from 0; -1 before the first."""
        item = self.list.currentItem()
        return int(item.data(_PAGE)) if item is not None else -1

    def show_page(self, name: str = LANGUAGE) -> None:
        """Open the window with a page."""
        if self._code != active_language():
            self._read(active_language())
        self._turn_to(next((number for number, page in enumerate(self.pages) if page.name == name), 0))
        self.show()
        self.raise_()
        self.activateWindow()

    def _read(self, code: str) -> None:
        """Take the pages of the language that the window speaks."""
        self.list.clear()  # first, as what its rows say are numbers of the pages that were
        self._code, self.pages = code, pages(code)
        self._laid_out.clear()
        numbered = enumerate(self.pages)
        for group, members in groupby(numbered, key=lambda each: group_of(each[1].name)):
            self.list.addItem(_heading(group.titles[code]))
            for number, page in members:
                item = QListWidgetItem(page.title, self.list)
                item.setData(_PAGE, number)

    def _turn_to(self, number: int) -> None:
        """Bring a page to the front, by its number from 0."""
        items = map(self.list.item, range(self.list.count()))
        self.list.setCurrentItem(next(item for item in items if item.data(_PAGE) == number))

    def show_word(self, word: str, function: bool = False) -> None:
        """Open the page of the shape language where a word is explained; what is no word of it is looked for.

        Args:
            word: as it stands in a text; "" = the page alone.
            function: a bracket follows it.
        """
        self.show_page()
        usage = usage_of(word, function)
        self.search.setText("")
        self.count.hide()
        self._mark("")
        if usage is not None:
            sought = f"{usage.word}(" if usage.form.startswith(f"{usage.word}(") else usage.form
            self._go_to_first(sought, usage.word)
        elif word:
            self.search.setText(word)
            self._on_typed()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 (Qt's name)
        """In the search Enter goes on, Shift+Enter back; in the list Home goes to the first page, which the heading
        above it would keep.
        """
        if event.type() != QEvent.Type.KeyPress or not isinstance(event, QKeyEvent):
            return super().eventFilter(watched, event)
        if watched is self.search and event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self.step(back=bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier))
            return True
        on_first_screen = self.list.currentRow() <= self.list.height() // max(self.list.sizeHintForRow(1), 1)
        to_first = event.key() == Qt.Key.Key_Home or (event.key() == Qt.Key.Key_PageUp and on_first_screen)
        if watched is self.list and to_first and self.pages:
            self._turn_to(0)
            return True
        return super().eventFilter(watched, event)

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802 (Qt's name)
        """Escape closes the window."""
        if event.key() == Qt.Key.Key_Escape:
            self.close()
        else:
            super().keyPressEvent(event)

    def step(self, back: bool = False) -> None:
        """Go to the next place of what is looked for; behind the last one, on to the next page that has it."""
        words = self.search.text()
        flags = QTextDocument.FindFlag.FindBackward if back else QTextDocument.FindFlag(0)
        if not words or self.browser.find(words, flags):
            return
        having = [number for number, page in enumerate(self.pages) if words.lower() in page.text.lower()]
        if not having:
            return
        here = self._shown
        later = [number for number in having if (number < here if back else number > here)]
        self._turn_to((later or having)[-1 if back else 0])
        self.browser.moveCursor(QTextCursor.MoveOperation.End if back else QTextCursor.MoveOperation.Start)
        self.browser.find(words, flags)
        self._mark(words)

    def _lay_out(self) -> None:
        side = v_box(margins=(12, 12, 12, 12), spacing=8)
        side.addWidget(self.search)
        side.addWidget(self.count)
        side.addWidget(self.list, 1)
        left = QWidget()
        left.setLayout(side)
        left.setFixedWidth(_LIST_PX + 24)
        row = h_box(self, spacing=0)
        row.addWidget(left)
        row.addWidget(self.browser, 1)

    def _show_row(self, row: int) -> None:
        if row < 0:
            return
        page = self.pages[self._shown]
        if page.name not in self._laid_out:
            self._laid_out[page.name] = rendered(page, self._theme)
            self._laid_out[page.name].setParent(self)
        self.browser.setDocument(self._laid_out[page.name])
        self.browser.moveCursor(QTextCursor.MoveOperation.Start)
        self.browser.verticalScrollBar().setValue(0)
        self._mark(self.search.text())

    def _on_typed(self) -> None:
        words = self.search.text()
        places = sum(page.text.lower().count(words.lower()) for page in self.pages) if words else 0
        self.count.setVisible(bool(words))
        self.count.setText(
            "" if not words else "Not found" if not places else f"{places} place{'s' * (places != 1)}; Enter goes on"
        )
        self.search.setProperty("wrong", "true" if words and not places else "false")
        restyle(self.search)
        self.browser.moveCursor(QTextCursor.MoveOperation.Start)
        self._mark(words)
        if words and not self.browser.find(words):
            self.step()

    def _go_to_first(self, sought: str, word: str) -> None:
        """Bring the row where a word is explained into sight, and mark it."""
        document = self.browser.document()
        found = document.find(sought, 0, QTextDocument.FindFlag.FindCaseSensitively)
        if found.isNull():
            found = document.find(word, 0, QTextDocument.FindFlag.FindWholeWords)
        if not found.isNull():
            self.browser.setTextCursor(found)
            self.browser.ensureCursorVisible()
            bar = self.browser.verticalScrollBar()
            bar.setValue(bar.value() + self.browser.cursorRect(found).top() - self.browser.viewport().height() // 3)

    def _mark(self, words: str) -> None:
        """Mark words wherever they stand in the page."""
        marks, document, at = list[QTextEdit.ExtraSelection](), self.browser.document(), 0
        while words and not (found := document.find(words, at)).isNull():
            mark = QTextEdit.ExtraSelection()
            mark.format.setBackground(mixed(self._theme.raised, self._theme.contour, 0.4))
            mark.cursor = found
            marks.append(mark)
            at = found.position()
        self.browser.setExtraSelections(marks)

    def _on_link(self, link: QUrl) -> None:
        name = base_of(link.path().rpartition("/")[2].removesuffix(".md"))
        if any(page.name == name for page in self.pages):
            self.show_page(name)
        elif link.scheme() in ("http", "https"):
            QDesktopServices.openUrl(link)


def _heading(words: str) -> QListWidgetItem:
    """Return a row of the list that names the pages below it; it cannot be chosen."""
    made = QListWidgetItem(words)
    made.setFlags(Qt.ItemFlag.NoItemFlags)
    made.setFont(text_font(semibold=True))
    return made
