"""The sheet beside the pointer: the boxes of the running tool, and words about what the pointer does."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache, lru_cache

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QPainter, QPen, QPixmap

from ...framework.catalogue import tr
from ...framework.theme import Theme, text_font
from .value_entry import RowShown, ValueEntry

_GAP = 16.0
"""Between the pointer and the sheet, px."""

_CLEAR = 10.0
"""So far the sheet stays from the end of the rubber band, px."""

_EDGE = 4.0
"""Between the sheet and the edge of the canvas, px."""

_MARGIN, _ROW, _FIELD, _SPACE = 8.0, 26.0, 22.0, 8.0
_LEAST_FIELD, _MOST_FIELD = 74.0, 220.0
_MOST_WORDS = 280.0
_SHADOW = ((3.0, 10), (2.0, 16), (1.0, 22))
"""How far rings of a soft shadow reach, px, and how dark they are."""

_OPEN = "\u2013"
"""What stands in a box that nothing sets yet."""

_SHADE = 4.0
"""Room for the shadow round the sheet, px."""

HINT = "Tab: next value · Enter: done"
HINT_OF_ONE = "Enter: done"


@dataclass(frozen=True, slots=True)
class SheetLine:
    """A line under the boxes: what it says, whether it is an error or a doubt."""

    text: str
    wrong: bool = False
    doubtful: bool = False


@dataclass(frozen=True, slots=True)
class ValueSheet:
    """What stands on the sheet."""

    rows: tuple[RowShown, ...]
    words: tuple[SheetLine, ...]

    @staticmethod
    def of(entry: ValueEntry, words: Sequence[str]) -> ValueSheet:
        """Return what an entry shows, and words beside it."""
        rows = tuple(entry.shown())
        lines = [SheetLine(tr(line)) for text in words for line in text.split("\n") if line]
        if entry.wrong:
            lines = [SheetLine(tr(entry.wrong), wrong=True)]
        elif entry.doubt:
            lines = [SheetLine(tr(entry.doubt), doubtful=True)]
        elif entry.editing:
            lines.append(SheetLine(tr(HINT if len(rows) > 1 else HINT_OF_ONE)))
        return ValueSheet(rows, tuple(lines))


@dataclass(frozen=True, slots=True)
class SheetPlace:
    """Where the sheet goes.

    Attributes:
        mouse: screen position. away_from: the shape's last point on the screen, on whose far side the sheet lies, or
            None. end: the end of the rubber band, which it leaves free. area: where it must stay.
    """

    mouse: QPointF
    away_from: QPointF | None
    end: QPointF
    area: QRectF

    def sheet(self, width: float, height: float) -> QRectF:
        """Return the rectangle of a sheet of this size beside the mouse."""
        right = self.away_from is None or self.mouse.x() >= self.away_from.x() - 1
        below = self.away_from is None or self.mouse.y() >= self.away_from.y() - 1
        sides = [(right, below), (right, not below), (not right, below), (not right, not below)]
        sheets = [self._at(*side, width, height) for side in sides]
        return next((sheet for sheet in sheets if self._is_free(sheet)), sheets[0])

    def _at(self, right: bool, below: bool, width: float, height: float) -> QRectF:
        x = self.mouse.x() + (_GAP if right else -_GAP - width)
        y = self.mouse.y() + (_GAP if below else -_GAP - height)
        x = max(min(x, self.area.right() - _EDGE - width), self.area.left() + _EDGE)
        y = max(min(y, self.area.bottom() - _EDGE - height), self.area.top() + _EDGE)
        return QRectF(x, y, width, height)

    def _is_free(self, sheet: QRectF) -> bool:
        kept = sheet.adjusted(-_CLEAR, -_CLEAR, _CLEAR, _CLEAR)
        return not kept.contains(self.mouse) and not kept.contains(self.end)


def paint_values(painter: QPainter, sheet: ValueSheet, place: SheetPlace, theme: Theme) -> None:
    """Paint the boxes and words on a small sheet beside the mouse."""
    if sheet.rows or sheet.words:
        _Painting(painter, sheet, theme).paint(place)


class _Type:
    """The two fonts of the sheet, measured once: they are asked for at every move of the mouse."""

    def __init__(self) -> None:
        self.plain, self.strong = text_font(), text_font(semibold=True)
        self.of_plain, self.of_strong = QFontMetricsF(self.plain), QFontMetricsF(self.strong)


@cache
def _type() -> _Type:
    return _Type()


@lru_cache(16)
def _ground(size: tuple[int, int], ratio: float, paper: str, hairline: str) -> QPixmap:
    """Return an empty sheet with its soft shadow, px; smooth round corners take far longer to paint than to copy."""
    width, height = size
    margin = int(_SHADE)
    made = QPixmap(round((width + 2 * margin) * ratio), round((height + 2 * margin) * ratio))
    made.setDevicePixelRatio(ratio)
    made.fill(Qt.GlobalColor.transparent)
    painter = QPainter(made)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.setPen(Qt.PenStyle.NoPen)
    sheet = QRectF(margin, margin, width, height)
    for reach, dark in _SHADOW:
        painter.setBrush(QColor(0, 0, 0, dark))
        painter.drawRoundedRect(sheet.adjusted(1 - reach, 2 - reach, reach - 1, reach), 6 + reach, 6 + reach)
    painter.setPen(QPen(QColor(hairline), 1))
    painter.setBrush(QColor(paper))
    painter.drawRoundedRect(sheet.adjusted(0.5, 0.5, -0.5, -0.5), 6, 6)
    painter.end()
    return made


class _Painting:
    """One painting of a sheet."""

    def __init__(self, painter: QPainter, sheet: ValueSheet, theme: Theme) -> None:
        self._painter, self._sheet, self._theme = painter, sheet, theme
        self._type = _type()
        plain, strong = self._type.of_plain, self._type.of_strong
        rows = sheet.rows
        self._name = max((plain.horizontalAdvance(tr(row.name)) for row in rows), default=0.0)
        self._unit = max((plain.horizontalAdvance(row.unit) for row in rows), default=0.0)
        wide = max((max(f.horizontalAdvance(row.text) for f in (plain, strong)) for row in rows), default=0.0) + 16
        self._field = min(max(wide, _LEAST_FIELD), _MOST_FIELD)
        boxes = self._name + self._field + self._unit + 2 * _SPACE if rows else 0.0
        room = max(boxes, _MOST_WORDS)
        flags = int(Qt.AlignmentFlag.AlignLeft | Qt.TextFlag.TextWordWrap)
        self._lines = [
            (words, plain.boundingRect(QRectF(0, 0, room, 1000), flags, words.text)) for words in sheet.words
        ]
        self._width = max([boxes, *(rect.width() for _, rect in self._lines)]) + 2 * _MARGIN
        self._height = len(rows) * _ROW + sum(rect.height() + 2 for _, rect in self._lines) + _MARGIN
        self._height += 2 if rows and self._lines else 0
        self._width, self._height = math.ceil(self._width), math.ceil(self._height)

    def paint(self, place: SheetPlace) -> None:
        """Paint it where it belongs."""
        painter, theme = self._painter, self._theme
        sheet = QRectF(place.sheet(self._width, self._height).toRect())
        painter.save()
        ratio = painter.device().devicePixelRatioF()
        ground = _ground(sheet.toRect().size().toTuple(), ratio, theme.paper.name(), theme.hairline.name())
        painter.drawPixmap(sheet.topLeft() - QPointF(_SHADE, _SHADE), ground)
        y = sheet.top() + _MARGIN / 2
        for row in self._sheet.rows:
            self._paint_row(row, QRectF(sheet.left() + _MARGIN, y, sheet.width() - 2 * _MARGIN, _ROW))
            y += _ROW
        y += 2 if self._sheet.rows else 0
        painter.setFont(self._type.plain)
        for words, rect in self._lines:
            painter.setPen(theme.error if words.wrong else theme.warning if words.doubtful else theme.muted)
            painter.drawText(
                QRectF(sheet.left() + _MARGIN, y, self._width - 2 * _MARGIN + 1, rect.height()),
                int(Qt.AlignmentFlag.AlignLeft | Qt.TextFlag.TextWordWrap),
                words.text,
            )
            y += rect.height() + 2
        painter.restore()

    def _paint_row(self, row: RowShown, area: QRectF) -> None:
        painter, theme = self._painter, self._theme
        painter.setFont(self._type.plain)
        painter.setPen(theme.muted)
        middle = int(Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft)
        painter.drawText(area, middle, tr(row.name))
        # Fields stand in one column, units in one, however wide the words below make the sheet.
        left = area.left() + self._name + _SPACE
        field = QRectF(left, area.center().y() - _FIELD / 2, self._field, _FIELD)
        unit = QRectF(field.right() + _SPACE / 2, area.top(), self._unit, area.height())
        painter.drawText(unit, middle, row.unit)
        typed = row.caret is not None
        if typed:
            painter.setPen(QPen(theme.error if self._wrong else theme.accent, 1.5))
            painter.setBrush(theme.raised)
            painter.drawRoundedRect(field, 4, 4)
        elif row.held:
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(theme.chosen)
            painter.drawRoundedRect(field, 4, 4)
        self._paint_text(row, field.adjusted(8, 0, -8, 0))

    @property
    def _wrong(self) -> bool:
        return any(words.wrong for words in self._sheet.words)

    def _paint_text(self, row: RowShown, field: QRectF) -> None:
        painter, theme = self._painter, self._theme
        typed = row.caret is not None
        bold = row.held or bool(row.caret)
        font, metrics = (self._type.strong, self._type.of_strong) if bold else (self._type.plain, self._type.of_plain)
        painter.setFont(font)
        painter.setPen(
            theme.accent_text if row.held and not typed else theme.ink if not typed or row.caret else theme.muted
        )
        painter.save()
        painter.setClipRect(field.adjusted(-3, 0, 3, 0), Qt.ClipOperation.IntersectClip)
        painter.drawText(field, int(Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignRight), row.text or _OPEN)
        painter.restore()
        if row.caret is not None:
            behind = row.text[row.caret :] if row.caret else ""
            x = field.right() + 3 - metrics.horizontalAdvance(behind)
            painter.setPen(QPen(theme.ink, 1))
            painter.drawLine(QPointF(x, field.center().y() - 7), QPointF(x, field.center().y() + 7))
