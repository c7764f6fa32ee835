"""Paints lines of NC text: the bar of their motion, number, words in colours, what is found, what is wrong."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from PySide6.QtCore import QPointF, QRect, QRectF, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QPainter, QPen, QPolygonF

from .....gcode.interpreter.program import ProgramProblem, Severity
from ....framework.theme import Theme, mono_font
from ..line_marks import CUT, PLUNGE, RAPID, LineMarks, kind_of
from ..program_text import ProgramText
from ..syntax import SyntaxPart, spans
from .motion_layer import MotionColourBy, motion_colour, tool_colour

LINE_PX = 20
MARKS_PX = 10
"""Width of the strip at the right that shows where in the program marks are."""

_LONG = 2_000
"""Of a longer line only what can be seen is taken apart."""

_BLANK = str.maketrans({chr(c): "\u00b7" for c in [*range(9), *range(11, 32), 127]} | {"\t": " "})


@dataclass(frozen=True)
class TextStyle:
    """Everything that decides how text is painted.

    Attributes:
        cursor, anchor: ends of the selection, rows; -1 = none.
        words: to be marked wherever they stand; found: rows that hold them.
    """

    text: ProgramText
    lines: LineMarks
    theme: Theme
    colour: MotionColourBy = MotionColourBy.TOOL
    cursor: int = -1
    anchor: int = -1
    words: str = ""
    found: tuple[int, ...] = ()

    def changed(self, **what: object) -> TextStyle:
        """Return the look with other values."""
        return replace(self, **what)  # type: ignore[arg-type]

    def gutter(self) -> int:
        """Return the width of bar and line number, px."""
        digits = max(3, len(str(len(self.text))))
        return 34 + round(QFontMetricsF(mono_font()).horizontalAdvance("0" * digits))


def paint_lines(painter: QPainter, area: QRect, shift: tuple[int, int], look: TextStyle) -> None:
    """Paint the lines in sight.

    Args:
        painter: of the viewport. area: the viewport's rectangle.
        shift: how far the text is scrolled to the left and up, px.
        look: what to paint, and how.
    """
    painter.fillRect(area, look.theme.canvas)
    painter.setFont(mono_font())
    gutter, letter = look.gutter(), painter.fontMetrics().horizontalAdvance("0")
    first = shift[1] // LINE_PX
    rows = range(first, min(len(look.text), (shift[1] + area.height()) // LINE_PX + 1))
    painter.setClipRect(gutter, 0, area.width() - gutter - MARKS_PX, area.height())
    for row in rows:
        line = _PaintedLine(
            painter,
            look,
            row,
            QRectF(gutter - shift[0], row * LINE_PX - shift[1], area.width() + shift[0], LINE_PX),
            letter,
        )
        line.paint(shift[0])
    painter.setClipping(False)
    for row in rows:
        _paint_gutter(painter, QRectF(0, row * LINE_PX - shift[1], gutter, LINE_PX), look, row)


def paint_marks(painter: QPainter, area: QRect, look: TextStyle) -> None:
    """Paint where in the whole program problems, differences, finds and the picked line are."""
    theme, left = look.theme, area.width() - MARKS_PX
    painter.fillRect(left, 0, MARKS_PX, area.height(), theme.paper)
    scale = area.height() / max(1, len(look.text))
    errors = [row for row, each in look.lines.problems.items() if _worst(each) is Severity.ERROR]
    warnings = [row for row, each in look.lines.problems.items() if _worst(each) is Severity.WARNING]
    layers = (
        (look.lines.differing, theme.parameter),
        (np.array(look.found), theme.accent),
        (np.array(warnings), theme.warning),
        (np.array(errors), theme.error),
    )
    for rows, colour in layers:
        for y in np.unique((rows * scale).astype(np.int64)).tolist():
            painter.fillRect(left + 2, min(y, area.height() - 3), MARKS_PX - 4, 3, colour)
    if look.cursor >= 0:
        painter.fillRect(left, min(int(look.cursor * scale), area.height() - 2), MARKS_PX, 2, theme.ink)


def _paint_gutter(painter: QPainter, place: QRectF, look: TextStyle, row: int) -> None:
    theme = look.theme
    if _selected(look, row):
        painter.fillRect(place, theme.chosen if row == look.cursor else theme.hover)
    bar = _bar_colour(look, row)
    if bar is not None:
        painter.fillRect(QRectF(12, place.top() + 3, 3, LINE_PX - 6), bar)
    worst = _worst(look.lines.problems.get(row, []))
    painter.setPen({Severity.ERROR: theme.error, Severity.WARNING: theme.warning, None: theme.muted}[worst])
    painter.drawText(
        place.adjusted(0, 0, -12, 0), Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignRight, str(row + 1)
    )


def _bar_colour(look: TextStyle, row: int) -> QColor | None:
    theme = look.theme
    codes = look.lines.by_tool if look.colour is MotionColourBy.TOOL else look.lines.by_motion
    code = int(codes[row]) if row < len(codes) else 0
    if code == 0:
        return None
    if code in (RAPID, PLUNGE):
        return theme.rapid if code == RAPID else theme.plunge
    return tool_colour(code - CUT, theme) if look.colour is MotionColourBy.TOOL else motion_colour(kind_of(code), theme)


def _selected(look: TextStyle, row: int) -> bool:
    return look.cursor >= 0 and min(look.cursor, look.anchor) <= row <= max(look.cursor, look.anchor)


def _worst(problems: list[ProgramProblem]) -> Severity | None:
    kinds = {problem.severity for problem in problems}
    return Severity.ERROR if Severity.ERROR in kinds else Severity.WARNING if kinds else None


@dataclass(frozen=True)
class _PaintedLine:
    """One line and where it goes; `place` begins where its first character is, `letter` is the width of one, px."""

    painter: QPainter
    look: TextStyle
    row: int
    place: QRectF
    letter: float

    def paint(self, scrolled: int) -> None:
        """Paint what can be seen of the line when it is scrolled so many px to the left."""
        look, row = self.look, self.row
        self._paint_ground()
        length = look.text.length(row)
        first = 0 if length <= _LONG else max(0, int(scrolled / self.letter) - 2)
        text = look.text.piece(
            row, first, _LONG if length <= _LONG else int(self.painter.device().width() / self.letter) + 4
        )
        self._mark_found(text, first)
        for begin, end, part in spans(text):
            self.painter.setPen(_part_colour(part, look.theme))
            self.painter.drawText(
                self._spot(text, begin, first), Qt.AlignmentFlag.AlignVCenter, text[begin:end].translate(_BLANK)
            )
        for problem in look.lines.problems.get(row, []):
            self._underline(problem, text, first)

    def _x(self, text: str, column: int, first: int) -> float:
        """Return where a character of the piece begins; letters of other widths count as wide as they are."""
        plain = text.isascii()
        return (
            self.place.left()
            + first * self.letter
            + (column * self.letter if plain else QFontMetricsF(self.painter.font()).horizontalAdvance(text[:column]))
        )

    def _spot(self, text: str, column: int, first: int) -> QRectF:
        return QRectF(self._x(text, column, first), self.place.top(), 1e6, LINE_PX)

    def _paint_ground(self) -> None:
        theme, width = self.look.theme, self.painter.device().width()
        ground = QRectF(0, self.place.top(), width, LINE_PX)
        rows = self.look.lines.differing
        at = int(np.searchsorted(rows, self.row))
        if at < len(rows) and rows[at] == self.row:
            tint = QColor(theme.parameter)
            tint.setAlphaF(0.16)
            self.painter.fillRect(ground, tint)
        if _selected(self.look, self.row):
            self.painter.fillRect(ground, theme.chosen if self.row == self.look.cursor else theme.hover)

    def _mark_found(self, text: str, first: int) -> None:
        words = self.look.words.lower()
        tint = QColor(self.look.theme.accent)
        tint.setAlphaF(0.38)
        at = text.lower().find(words) if words else -1
        while at >= 0:
            left, right = self._x(text, at, first), self._x(text, at + len(words), first)
            self.painter.fillRect(QRectF(left, self.place.top() + 2, right - left, LINE_PX - 4), tint)
            at = text.lower().find(words, at + len(words))

    def _underline(self, problem: ProgramProblem, text: str, first: int) -> None:
        """Draw a wave under the word that a problem is about, or under the whole line."""
        begin = max(problem.column - 1 - first, 0) if problem.column else 0
        end = begin + max(1, len(problem.word)) if problem.column else len(text)
        left, right = self._x(text, begin, first), self._x(text, min(end, max(len(text), begin + 1)), first)
        y = self.place.bottom() - 3
        steps = np.arange(left, max(right, left + self.letter) + 1, 2.0)
        wave = QPolygonF([QPointF(x, y + (1.0 if k % 2 else -1.0)) for k, x in enumerate(steps.tolist())])
        self.painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        self.painter.setPen(
            QPen(self.look.theme.error if problem.severity is Severity.ERROR else self.look.theme.warning, 1.4)
        )
        self.painter.drawPolyline(wave)
        self.painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)


def _part_colour(part: SyntaxPart, theme: Theme) -> QColor:
    return {
        SyntaxPart.COMMENT: theme.muted,
        SyntaxPart.LINE_NUMBER: theme.muted,
        SyntaxPart.COMMAND: theme.accent_text,
        SyntaxPart.SETTING: theme.warning,
        SyntaxPart.FLOW: theme.parameter,
        SyntaxPart.PLAIN: theme.ink,
    }[part]
