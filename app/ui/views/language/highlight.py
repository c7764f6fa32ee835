"""Colours of a text in the shape language. Only lines that have been in sight are coloured, so that 100,000 cost
nothing.
"""

from __future__ import annotations

import re
from enum import Enum

from PySide6.QtGui import QColor, QFont, QSyntaxHighlighter, QTextCharFormat, QTextDocument

from ....drafting.expressions.functions import FUNCTIONS
from ....drafting.expressions.units import ALL_UNITS
from ....drafting.language.interpret import RESERVED
from ....drafting.language.language import ALIASES, COMMANDS
from ...framework.theme import LIGHT, Theme, mixed

_COLOURED = 1
BLOCKS = frozenset({"let", "repeat", "if", "define", "units", "else", "end", "as"})
_COMMANDS = frozenset(COMMANDS) | frozenset(ALIASES)
_UNITS = "|".join(sorted((re.escape(unit) for unit in ALL_UNITS if unit.isalpha()), key=len, reverse=True))
_TOKEN = re.compile(
    r"(?P<remark>#.*)|(?P<text>\"[^\"]*\"?)"
    r"|(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+(?!\w))?(?P<unit>(?:" + _UNITS + r")(?!\w)|[\"°])?)"
    r"|(?P<word>[^\W\d]\w*)|(?P<end>;)"
)


class SyntaxKind(Enum):
    """What a piece of the text is."""

    COMMAND = "command"
    BLOCK = "word of a block"
    OPTION = "word of a command"
    FUNCTION = "function"
    NUMBER = "number"
    TEXT = "text in quotes"
    REMARK = "remark"


def pieces(line: str) -> list[tuple[int, int, SyntaxKind]]:
    """Return (start, length, ink) of what is coloured in a line."""
    found, first = list[tuple[int, int, SyntaxKind]](), True
    for token in _TOKEN.finditer(line):
        kind, start, length = token.lastgroup, token.start(), token.end() - token.start()
        if kind == "end":
            first = True
            continue
        ink = (
            _word_ink(token["word"].lower(), first, line[token.end() : token.end() + 1])
            if token["word"]
            else {"remark": SyntaxKind.REMARK, "text": SyntaxKind.TEXT}.get(kind or "", SyntaxKind.NUMBER)
        )
        first = False
        if ink is not None:
            found.append((start, length, ink))
    return found


def _word_ink(word: str, first: bool, following: str) -> SyntaxKind | None:
    if following == "(" and word in FUNCTIONS:
        return SyntaxKind.FUNCTION
    if word in BLOCKS:
        return SyntaxKind.BLOCK
    if first:
        return SyntaxKind.COMMAND if word in _COMMANDS else None
    if word == "pi":
        return SyntaxKind.NUMBER
    return SyntaxKind.OPTION if word in RESERVED else None


def syntax_colours(theme: Theme) -> dict[SyntaxKind, QColor]:
    """Return the colour of each ink; all have a contrast of 4.5 on the theme's raised ground."""
    return {
        SyntaxKind.COMMAND: theme.accent_text,
        SyntaxKind.BLOCK: theme.parameter,
        SyntaxKind.OPTION: mixed(theme.accent_text, theme.ink, 0.35),
        SyntaxKind.FUNCTION: mixed(theme.left, theme.ink, 0.3),
        SyntaxKind.NUMBER: theme.warning,
        SyntaxKind.TEXT: mixed(theme.rest, theme.ink, 0.5),
        SyntaxKind.REMARK: theme.muted,
    }


class ShapeHighlighter(QSyntaxHighlighter):
    """Colours the lines that its editor has in sight."""

    def __init__(self, document: QTextDocument) -> None:
        super().__init__(document)
        self._first, self._last = 0, 200
        self._formats: dict[SyntaxKind, QTextCharFormat] = {}
        self.set_theme(LIGHT)

    def set_theme(self, theme: Theme) -> None:
        """Follow the theme."""
        for ink, colour in syntax_colours(theme).items():
            made = QTextCharFormat()
            made.setForeground(colour)
            if ink in (SyntaxKind.COMMAND, SyntaxKind.BLOCK):
                made.setFontWeight(QFont.Weight.DemiBold)
            made.setFontItalic(ink is SyntaxKind.REMARK)
            self._formats[ink] = made
        self.rehighlight()

    def see(self, first: int, last: int) -> None:
        """Colour the lines from `first` to `last`, 0-based, both included, unless they are."""
        self._first, self._last = first, last
        block = self.document().findBlockByNumber(first)
        while block.isValid() and block.blockNumber() <= last:
            if block.userState() != _COLOURED:
                self.rehighlightBlock(block)
            block = block.next()

    def highlightBlock(self, text: str) -> None:  # noqa: N802 (Qt's name)
        """Colour a line, if it is in sight."""
        if not self._first <= self.currentBlock().blockNumber() <= self._last:
            self.setCurrentBlockState(-1)
            return
        self.setCurrentBlockState(_COLOURED)
        for start, length, ink in pieces(text):
            self.setFormat(start, length, self._formats[ink])
