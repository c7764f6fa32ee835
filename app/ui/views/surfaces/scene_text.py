"""The text of a scene: numbers, colours, and what is wrong with it, in place."""

from __future__ import annotations

import re

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import (
    QColor,
    QFont,
    QSyntaxHighlighter,
    QTextCharFormat,
    QTextCursor,
)
from PySide6.QtWidgets import QTextEdit, QWidget

from ...framework.boxes import v_box
from ...framework.section import hairline
from ...framework.theme import LIGHT, Theme, mixed, mono_font
from ..language.numbered_editor import NumberedEditor
from ..language.page import TrialLabel
from .scene_document import SceneDocument

WIDTH = 460
_TOKEN = re.compile(
    r"(?P<remark>#.*)|(?P<table>^\s*\[.*?\]+)|(?P<text>\"[^\"]*\"?|'[^']*'?)|(?P<key>[A-Za-z_][\w.-]*(?=\s*=))"
    r"|(?P<number>[+-]?\d[\d_]*(?:\.\d+)?(?:[eE][+-]?\d+)?|\b(?:true|false)\b)"
)


class TomlHighlighter(QSyntaxHighlighter):
    """Colours TOML."""

    formats: dict[str, QTextCharFormat]

    def set_theme(self, theme: Theme) -> None:
        """Follow the theme."""
        inks = {
            "remark": theme.muted,
            "table": theme.accent_text,
            "text": mixed(theme.rest, theme.ink, 0.5),
            "key": theme.parameter,
            "number": theme.warning,
        }
        self.formats = {}
        for name, colour in inks.items():
            made = QTextCharFormat()
            made.setForeground(colour)
            made.setFontItalic(name == "remark")
            made.setFontWeight(QFont.Weight.DemiBold if name == "table" else QFont.Weight.Normal)
            self.formats[name] = made
        self.rehighlight()

    def highlightBlock(self, text: str) -> None:  # noqa: N802 (Qt's name)
        """Colour a line."""
        for token in _TOKEN.finditer(text):
            self.setFormat(token.start(), token.end() - token.start(), self.formats[str(token.lastgroup)])


class SceneEditor(NumberedEditor):
    """A text editor with line numbers and one line that is wrong."""

    def __init__(self, document: SceneDocument) -> None:
        super().__init__("Text of the scene")
        self.setDocument(document.document)
        self.document().setDefaultFont(mono_font())
        self.document().setDocumentMargin(8)
        self.wrong, self.highlighter = 0, TomlHighlighter(self.document())
        self.highlighter.set_theme(LIGHT)
        self.cursorPositionChanged.connect(self.gutter.update)
        self._lay_out()

    def set_theme(self, theme: Theme) -> None:
        """Follow the theme."""
        super().set_theme(theme)
        self.highlighter.set_theme(theme)
        self.show_wrong(self.wrong)

    def show_wrong(self, line: int) -> None:
        """Mark a line, 1-based; 0 = none is wrong."""
        self.wrong = self.gutter.wrong = line
        marks = []
        if line:
            mark = QTextEdit.ExtraSelection()
            colour = QColor(self._theme.error)
            colour.setAlphaF(0.14)
            mark.format.setBackground(colour)
            mark.format.setProperty(QTextCharFormat.Property.FullWidthSelection, True)
            mark.cursor = QTextCursor(self.document().findBlockByNumber(line - 1))
            marks.append(mark)
        self.setExtraSelections(marks)
        self.gutter.update()

    def go_to(self, line: int) -> None:
        """Put the cursor on a line, 1-based, and bring it into sight."""
        self.setTextCursor(QTextCursor(self.document().findBlockByNumber(max(line, 1) - 1)))
        self.centerCursor()
        self.setFocus()


class SceneText(QWidget):
    """Editor, and under it what the scene is, or what is wrong; a click on that goes there.

    Signals:
        left(): Esc.
    """

    left = Signal()

    def __init__(self, document: SceneDocument) -> None:
        super().__init__()
        self.setFixedWidth(WIDTH)
        self.editor, self.verdict = SceneEditor(document), TrialLabel()
        column = v_box(self, spacing=0)
        column.addWidget(self.editor, 1)
        column.addWidget(hairline())
        column.addWidget(self.verdict)
        self.setFocusProxy(self.editor)
        self.verdict.pressed.connect(lambda: self.editor.go_to(self.editor.wrong) if self.editor.wrong else None)

    def show_problem(self, line: int, sentence: str) -> None:
        """Mark a line, 1-based (0: none), and say what is wrong there."""
        self.editor.show_wrong(line)
        self.verdict.say(f"Line {line}: {sentence}" if line else sentence, error=True)

    def show_right(self, sentence: str) -> None:
        """Say what the text makes."""
        self.editor.show_wrong(0)
        self.verdict.say(sentence)

    def keyPressEvent(self, event: object) -> None:  # noqa: N802 (Qt's name)
        """Esc goes back to the picture."""
        if event.key() == Qt.Key.Key_Escape:  # type: ignore[attr-defined]
            self.left.emit()
        else:
            super().keyPressEvent(event)  # type: ignore[arg-type]
