"""The manual beside the work: its pages, a search through all of them, and the usage of a word of the shape
language.
"""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, Qt, QUrl
from PySide6.QtGui import QDesktopServices, QKeyEvent, QTextCursor, QTextDocument
from PySide6.QtWidgets import QLineEdit, QListWidget, QTextBrowser, QTextEdit, QWidget

from ....usecases.manual.pages import base_of
from ...framework.boxes import give_ground, h_box, v_box
from ...framework.catalogue import active_language
from ...framework.labels import muted, restyle
from ...framework.theme import LIGHT, Theme, mixed
from ...views.language.usage import usage_of
from .help_pages import HelpPage, pages, rendered

_SIZE = (884, 640)
_LIST_PX = 224
LANGUAGE = "language"


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
        if self.pages:
            self._show_row(self.list.currentRow())

    @property
    def page(self) -> str:
        """Name of the page in front; "" before the first."""
        row = self.list.currentRow()
        return self.pages[row].name if row >= 0 else ""

    def show_page(self, name: str = LANGUAGE) -> None:
        """Open the window with a page."""
        if self._code != active_language():
            self._read(active_language())
        self.list.setCurrentRow(next((row for row, page in enumerate(self.pages) if page.name == name), 0))
        self.show()
        self.raise_()
        self.activateWindow()

    def _read(self, code: str) -> None:
        """Take the pages of the language that the window speaks."""
        self._code, self.pages = code, pages(code)
        self._laid_out.clear()
        self.list.clear()
        self.list.addItems([page.title for page in self.pages])

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
        """Enter goes on, Shift+Enter back."""
        if (
            event.type() == QEvent.Type.KeyPress
            and isinstance(event, QKeyEvent)
            and (event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter))
        ):
            self.step(back=bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier))
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
        rows = [row for row, page in enumerate(self.pages) if words.lower() in page.text.lower()]
        if not rows:
            return
        here = self.list.currentRow()
        later = [row for row in rows if (row < here if back else row > here)]
        self.list.setCurrentRow((later or rows)[-1 if back else 0])
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
        page = self.pages[row]
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
