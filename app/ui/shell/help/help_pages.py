"""The manual's pages as documents in the window's type and colours."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QUrl
from PySide6.QtGui import (
    QBrush,
    QFont,
    QImage,
    QTextBlock,
    QTextCharFormat,
    QTextCursor,
    QTextDocument,
    QTextFormat,
    QTextFrame,
    QTextFrameFormat,
    QTextLength,
    QTextTable,
)

from ....core.resources import resource
from ....usecases.manual.pages import LANGUAGES, base_of, shown_in
from ...framework.theme import HEADING_PX, TEXT_PX, Theme, mono_font, text_font

_MARGIN_PX, _CELL_PX, _PICTURE_PX, _WINDOW_PX = 24, 5, 320, 580
_OF_THE_WINDOW = "pictures/"
_PROPORTIONAL = 1  # QTextBlockFormat.LineHeightTypes
_HEADINGS_PX = {1: 20, 2: HEADING_PX, 3: TEXT_PX}


@dataclass(frozen=True, slots=True)
class HelpPage:
    """One page: its name in every language, its heading, its text in Markdown."""

    name: str
    title: str
    text: str


def pages(code: str = "en") -> tuple[HelpPage, ...]:
    """Return the pages of the manual in a language by its code, in English where it has none, those for users first."""
    language = next(each for each in LANGUAGES if each.code == code)
    texts = {path.stem: path.read_text(encoding="utf-8") for path in resource("docs").glob("*.md")}
    shown = [(base_of(name), texts[name]) for name in shown_in(language, texts)]
    return tuple(HelpPage(name, text.partition("\n")[0].lstrip("# ").replace("`", ""), text) for name, text in shown)


def rendered(page: HelpPage, theme: Theme) -> QTextDocument:
    """Return a page as a document: headings, tables with hairlines, words of the language in fixed pitch."""
    made = QTextDocument()
    made.setDefaultFont(text_font())
    made.setDocumentMargin(_MARGIN_PX)
    made.setBaseUrl(QUrl.fromLocalFile(f"{resource('docs')}/"))
    made.setMarkdown(page.text, QTextDocument.MarkdownFeature.MarkdownDialectGitHub)
    _set_type(made, theme)
    _fit_pictures(made)
    for frame in made.rootFrame().childFrames():
        if isinstance(frame, QTextTable):
            _rule(frame, theme)
    return made


def _fit_pictures(document: QTextDocument) -> None:
    """Make pictures no wider than a page is."""
    cursor, block = QTextCursor(document), document.begin()
    while block.isValid():
        piece = block.begin()
        while not piece.atEnd():
            fragment = piece.fragment()
            form = fragment.charFormat().toImageFormat()
            if fragment.isValid() and form.isValid():
                size = QImage(document.baseUrl().resolved(QUrl(form.name())).toLocalFile()).size()
                widest = _WINDOW_PX if form.name().startswith(_OF_THE_WINDOW) else _PICTURE_PX
                form.setWidth(min(size.width(), widest))
                form.setHeight(min(size.width(), widest) * size.height() / max(size.width(), 1))
                cursor.setPosition(fragment.position())
                cursor.setPosition(fragment.position() + fragment.length(), QTextCursor.MoveMode.KeepAnchor)
                cursor.setCharFormat(form)
            piece += 1
        block = block.next()


def _set_type(document: QTextDocument, theme: Theme) -> None:
    """Give every piece its size and colour."""
    block = document.begin()
    while block.isValid():
        form = block.blockFormat()
        level, code = (
            form.headingLevel(),
            form.hasProperty(QTextFormat.Property.BlockCodeLanguage) or form.nonBreakableLines(),
        )
        _set_block(block)
        pieces, at = [], block.begin()
        while not at.atEnd():
            pieces.append((at.fragment().position(), at.fragment().length(), at.fragment().charFormat()))
            at += 1
        for start, length, was in pieces:
            _set_format(document, (start, length), _format(was, level, code, theme))
        block = block.next()


def _set_block(block: QTextBlock) -> None:
    """Give a paragraph its place: headings apart from what is before, programs indented."""
    form = block.blockFormat()
    if form.headingLevel():
        form.setTopMargin(24 if form.headingLevel() > 1 else 0)
        form.setBottomMargin(8)
    elif form.hasProperty(QTextFormat.Property.BlockCodeLanguage) or form.nonBreakableLines():
        form.setLeftMargin(16)
        form.setNonBreakableLines(False)
        form.setLineHeight(125, _PROPORTIONAL)
    elif QTextCursor(block).currentTable() is None:
        form.setLineHeight(135, _PROPORTIONAL)
        form.setTopMargin(8)
        form.setBottomMargin(8)
    QTextCursor(block).setBlockFormat(form)


def _format(was: QTextCharFormat, level: int, code: bool, theme: Theme) -> QTextCharFormat:
    made, fixed, mono = QTextCharFormat(was), was.fontFixedPitch() or code, mono_font()
    bold, italic = was.fontWeight() > QFont.Weight.Normal, was.fontItalic()
    made.clearProperty(QTextFormat.Property.FontSizeAdjustment)
    made.setFont(mono if fixed else text_font(_HEADINGS_PX.get(level, TEXT_PX), semibold=bool(level)))
    if not fixed and bold:
        made.setFontWeight(QFont.Weight.DemiBold)
    made.setFontItalic(italic)
    made.setForeground(theme.accent_text if (fixed and not code) or was.isAnchor() else theme.ink)
    return made


def _set_format(document: QTextDocument, place: tuple[int, int], form: QTextCharFormat) -> None:
    cursor = QTextCursor(document)
    cursor.setPosition(place[0])
    cursor.setPosition(place[0] + place[1], QTextCursor.MoveMode.KeepAnchor)
    cursor.setCharFormat(form)


def _rule(table: QTextFrame, theme: Theme) -> None:
    """Give a table hairlines and room."""
    assert isinstance(table, QTextTable)
    form = table.format()
    form.setCellPadding(_CELL_PX)
    form.setCellSpacing(0)
    form.setBorder(1)
    form.setBorderCollapse(True)
    form.setBorderBrush(QBrush(theme.hairline))
    form.setBorderStyle(QTextFrameFormat.BorderStyle.BorderStyle_Solid)
    form.setWidth(QTextLength(QTextLength.Type.PercentageLength, 100))
    table.setFormat(form)
