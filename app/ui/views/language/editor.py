"""The editor of the shape language: numbers, colours, indents, offers, what belongs together, what is wrong."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from PySide6.QtCore import QEvent, QRect, Qt, Signal
from PySide6.QtGui import (
    QColor,
    QFontMetricsF,
    QKeyEvent,
    QResizeEvent,
    QTextBlock,
    QTextCharFormat,
    QTextCursor,
    QTextFormat,
)
from PySide6.QtWidgets import QTextEdit

from ...framework.theme import Theme, mixed, mono_font
from . import blocks
from .blocks import KnownName
from .completion import CompletionItem, CompletionList, offers, word_before
from .gutter import blocks_in_sight
from .highlight import ShapeHighlighter
from .numbered_editor import NumberedEditor

_OFFERED_AFTER = 2
_MOST_MATCHED = 20_000  # lines; looking for what belongs together in more would be felt
_HINT = (
    "Draw in words, one command a line:\n\nrect 0,0 60,40 round 5\ncircle 30,20 8\n\nCtrl+Space offers words, F1 "
    "explains them."
)

Names = Callable[[], Iterable[KnownName]]


class ShapeEditor(NumberedEditor):
    """A text in the shape language.

    Signals:
        run_requested(): Ctrl+Enter. help_requested(word, function): F1 on a word; a bracket follows it.
            find_requested(): Ctrl+F.
        left(): Esc.

    Attributes:
        names: (name, whether it is a command) of what the drawing has named already.
    """

    run_requested = Signal()
    help_requested = Signal(str, bool)
    find_requested = Signal()
    left = Signal()

    def __init__(self) -> None:
        super().__init__("Text in the shape language")
        self.highlighter, self.list = ShapeHighlighter(self.document()), CompletionList(self)
        self.setObjectName("shapeEditor")
        self.setPlaceholderText(_HINT)
        self.setTabStopDistance(2 * QFontMetricsF(mono_font()).horizontalAdvance(" "))
        self.document().setDocumentMargin(8)
        self._wrong, self._found = (0, 0), ""
        self.names: Names = tuple
        self.list.taken.connect(self._take_offer)
        self.textChanged.connect(self._show_marks)
        self.cursorPositionChanged.connect(self._show_marks)
        self._lay_out()

    def set_theme(self, theme: Theme) -> None:
        """Follow the theme."""
        super().set_theme(theme)
        self.highlighter.set_theme(theme)
        self._show_marks()

    def replace_text(self, text: str) -> None:
        """Put another text in the place of all there is; Ctrl+Z brings that back."""
        cursor = QTextCursor(self.document())
        cursor.select(QTextCursor.SelectionType.Document)
        cursor.insertText(text)
        self.moveCursor(QTextCursor.MoveOperation.Start)

    def show_wrong(self, line: int, column: int) -> None:
        """Underline what stands at a place, 1-based; line 0 = nothing is wrong."""
        self._wrong = (line, column)
        self.gutter.wrong = line
        self.gutter.update()
        self._show_marks()

    def show_found(self, words: str) -> None:
        """Mark words wherever they stand in sight; "" = none."""
        self._found = words.lower()
        self._show_marks()

    def go_to(self, line: int, column: int = 1) -> None:
        """Put the cursor at a place, 1-based, and bring it into sight."""
        block = self.document().findBlockByNumber(max(line, 1) - 1)
        cursor = QTextCursor(block if block.isValid() else self.document().lastBlock())
        cursor.setPosition(cursor.block().position() + min(max(column, 1) - 1, cursor.block().length() - 1))
        self.setTextCursor(cursor)
        self.centerCursor()

    def switch_remarks(self) -> None:
        """Make remarks of the lines that are taken, or of remarks lines."""
        cursor = self.textCursor()
        first, last = (self.document().findBlock(at) for at in (cursor.selectionStart(), cursor.selectionEnd()))
        lines = self._lines(first, last)
        cursor.setPosition(first.position())
        cursor.setPosition(last.position() + last.length() - 1, QTextCursor.MoveMode.KeepAnchor)
        start = cursor.selectionStart()
        cursor.insertText("\n".join(blocks.switched_remarks(lines)))
        if len(lines) > 1:
            end = cursor.position()
            cursor.setPosition(start)
            cursor.setPosition(end, QTextCursor.MoveMode.KeepAnchor)
            self.setTextCursor(cursor)

    def event(self, event: QEvent) -> bool:
        """Keep the editor's keys from the window's shortcuts."""
        if (
            event.type() == QEvent.Type.ShortcutOverride
            and isinstance(event, QKeyEvent)
            and self._act_of(event) is not None
        ):
            event.accept()
            return True
        return super().event(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802 (Qt's name)
        """Offers first, then the editor's own keys, then plain typing."""
        if self.list.isVisible() and self._answer_offer(event):
            return
        act = self._act_of(event)
        if act is not None:
            act()
            return
        super().keyPressEvent(event)
        self._after_typing(event.text())

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 (Qt's name)
        """Give the numbers their place."""
        super().resizeEvent(event)
        if event.size().width() != event.oldSize().width():
            self.list.hide()

    def focusOutEvent(self, event: object) -> None:  # noqa: N802 (Qt's name)
        """Offer nothing while somebody else has the keyboard."""
        self.list.hide()
        super().focusOutEvent(event)  # type: ignore[arg-type]

    def _act_of(self, event: QKeyEvent) -> Callable[[], object] | None:
        control = event.modifiers() & ~Qt.KeyboardModifier.KeypadModifier == Qt.KeyboardModifier.ControlModifier
        plain = not event.modifiers() & ~Qt.KeyboardModifier.KeypadModifier
        enter = event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter)
        if control and enter:
            return self.run_requested.emit
        if plain and enter:
            return self._new_line
        if event.key() == Qt.Key.Key_Escape and plain:
            return self.left.emit  # Tab indents here, so this is the way out
        if event.key() == Qt.Key.Key_Tab and plain:
            return lambda: self._indent(1)
        if event.key() == Qt.Key.Key_Backtab:
            return lambda: self._indent(-1)
        acts = {
            Qt.Key.Key_Space: lambda: self.offer(asked=True),
            Qt.Key.Key_Slash: self.switch_remarks,
            Qt.Key.Key_F: self.find_requested.emit,
        }
        if control and event.key() in acts:
            return acts[Qt.Key(event.key())]
        return self._ask_help if event.key() == Qt.Key.Key_F1 and plain else None

    def _lay_out(self) -> None:
        super()._lay_out()
        self._see()

    def _follow(self, area: QRect, scrolled: int) -> None:
        super()._follow(area, scrolled)
        self._see()

    def _see(self) -> None:
        first = self.firstVisibleBlock().blockNumber()
        self.highlighter.see(
            max(first - 2, 0), first + self.viewport().height() // max(self.fontMetrics().height(), 1) + 2
        )

    def _lines(self, first: QTextBlock, last: QTextBlock) -> list[str]:
        found, block = [first.text()], first
        while block != last:
            block = block.next()
            found.append(block.text())
        return found

    def _new_line(self) -> None:
        """Begin a line, indented as it belongs."""
        cursor = self.textCursor()
        cursor.insertText("\n" + blocks.indent_after(cursor.block().text()[: cursor.positionInBlock()]))
        self.setTextCursor(cursor)
        self.ensureCursorVisible()

    def _indent(self, way: int) -> None:
        cursor = self.textCursor()
        if not cursor.hasSelection() and way > 0:
            cursor.insertText(blocks.INDENT)
            return
        first, last = (self.document().findBlock(at) for at in (cursor.selectionStart(), cursor.selectionEnd()))
        cursor.beginEditBlock()
        block = first
        while True:
            at = QTextCursor(block)
            if way > 0 and block.text().strip():
                at.insertText(blocks.INDENT)
            elif way < 0:
                spare = min(len(block.text()) - len(block.text().lstrip(" ")), len(blocks.INDENT))
                at.movePosition(QTextCursor.MoveOperation.Right, QTextCursor.MoveMode.KeepAnchor, spare)
                at.removeSelectedText()
            if block == last:
                break
            block = block.next()
        cursor.endEditBlock()

    def _after_typing(self, text: str) -> None:
        """Put else and end where their block stands, and offer words."""
        if not text.isprintable() or not text:
            self.list.hide()
            return
        line = self.textCursor().block().text()
        if line.strip() in ("end", "else") and text in "de":
            self._align_closing(line)
        if len(word_before(line[: self.textCursor().positionInBlock()])) >= _OFFERED_AFTER:
            self.offer()
        else:
            self.list.hide()

    def _align_closing(self, line: str) -> None:
        block = self.textCursor().block()
        rows = self._lines(self.document().findBlockByNumber(max(block.blockNumber() - _MOST_MATCHED, 0)), block)
        column = len(line) - len(line.lstrip())
        found = blocks.family(rows, len(rows) - 1, column)
        if not found or found[0][0] == len(rows) - 1:
            return
        opening = rows[found[0][0]]
        at = QTextCursor(block)
        at.movePosition(QTextCursor.MoveOperation.Right, QTextCursor.MoveMode.KeepAnchor, column)
        at.insertText(opening[: len(opening) - len(opening.lstrip())])

    def offer(self, asked: bool = False) -> None:
        """Show what the word at the cursor could become; `asked`: also where nothing was typed of it."""
        cursor = self.textCursor()
        line = cursor.block().text()[: cursor.positionInBlock()]
        begun = word_before(line)
        named = [*blocks.names_in(self.toPlainText()), *self.names()] if begun or asked else []
        found = (
            [each for each in offers(line, named) if asked or each.word.lower() != begun.lower()]
            if begun or asked
            else []
        )
        if not found:
            self.list.hide()
            return
        cursor.setPosition(cursor.position() - len(begun))
        word = self.cursorRect(cursor).translated(self.viewport().pos())
        self.list.show_offers(found, word, self.rect())

    def _answer_offer(self, event: QKeyEvent) -> bool:
        key = event.key()
        if key in (Qt.Key.Key_Up, Qt.Key.Key_Down):
            self.list.step(-1 if key == Qt.Key.Key_Up else 1)
        elif key == Qt.Key.Key_Escape:
            self.list.hide()
        elif (
            key in (Qt.Key.Key_Return, Qt.Key.Key_Enter, Qt.Key.Key_Tab) and not event.modifiers() and self.list.current
        ):
            self._take_offer(self.list.current)
        else:
            return False
        return True

    def _take_offer(self, offer: CompletionItem) -> None:
        cursor = self.textCursor()
        line = cursor.block().text()[: cursor.positionInBlock()]
        cursor.movePosition(QTextCursor.MoveOperation.Left, QTextCursor.MoveMode.KeepAnchor, len(word_before(line)))
        cursor.insertText(offer.word + (offer.behind if offer.word not in ("end", "else") else ""))
        self.setTextCursor(cursor)
        self.list.hide()
        if offer.word in ("end", "else"):
            self._align_closing(cursor.block().text())

    def _ask_help(self) -> None:
        cursor = self.textCursor()
        cursor.select(QTextCursor.SelectionType.WordUnderCursor)
        following = cursor.block().text()[cursor.selectionEnd() - cursor.block().position() :][:1]
        self.help_requested.emit(cursor.selectedText(), following == "(")

    def _show_marks(self) -> None:
        """Show the line of the cursor, what belongs to the word at it, what was found, and what is wrong."""
        theme, cursor = self._theme, self.textCursor()
        line = QTextEdit.ExtraSelection()
        line.format.setBackground(mixed(theme.raised, theme.hover, 0.6))
        line.format.setProperty(QTextFormat.Property.FullWidthSelection, True)
        line.cursor = QTextCursor(cursor)
        line.cursor.clearSelection()
        marks = [] if self.document().isEmpty() else [line]  # it would hide the hint
        for row, start, length in self._family(cursor):
            marks.append(self._mark(self.document().findBlockByNumber(row), start, length, theme.chosen))
        if self._found:
            for block, _, _ in blocks_in_sight(self):
                at, text = -1, block.text().lower()
                while (at := text.find(self._found, at + 1)) >= 0:
                    marks.append(self._mark(block, at, len(self._found), mixed(theme.raised, theme.contour, 0.4)))
        self.setExtraSelections([*marks, *self._wrong_mark()])

    def _family(self, cursor: QTextCursor) -> tuple[blocks.Place, ...]:
        at = cursor.positionInBlock()
        if not any(s <= at <= s + len(word) for s, word in blocks.block_words(cursor.block().text())):
            return ()
        if self.blockCount() > _MOST_MATCHED:
            return ()
        return blocks.family(self.toPlainText().split("\n"), cursor.blockNumber(), at)

    def _mark(self, block: QTextBlock, start: int, length: int, colour: QColor) -> QTextEdit.ExtraSelection:
        made = QTextEdit.ExtraSelection()
        made.format.setBackground(colour)
        made.cursor = QTextCursor(block)
        made.cursor.setPosition(block.position() + start)
        end = min(start + length, block.length() - 1)
        made.cursor.setPosition(block.position() + end, QTextCursor.MoveMode.KeepAnchor)
        return made

    def _wrong_mark(self) -> list[QTextEdit.ExtraSelection]:
        line, column = self._wrong
        block = self.document().findBlockByNumber(line - 1)
        if line < 1 or not block.isValid():
            return []
        text, at = block.text(), max(column, 1) - 1
        end = at
        while end < len(text) and not text[end].isspace() and text[end] not in ",;#":
            end += 1
        if end == at:
            at, end = (max(len(text) - 1, 0), len(text)) if at >= len(text) else (at, at + 1)
        made = self._mark(block, at, end - at, self._theme.raised)
        made.format = QTextCharFormat()
        made.format.setUnderlineStyle(QTextCharFormat.UnderlineStyle.WaveUnderline)
        made.format.setUnderlineColor(self._theme.error)
        return [made]
