"""The key of the stages: what each code's colour means at the step that is shown; the code under the mouse stands
out.
"""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QPointF, QRectF, QSizeF, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QPainter

from ....framework.catalogue import tr
from ....framework.theme import Theme, text_font

ROW_PX, SWATCH_PX, GAP_PX, PAD_PX, EDGE_PX = 22.0, 16.0, 10.0, 10.0, 12.0


@dataclass(frozen=True, slots=True)
class CodeRow:
    """One line of the key."""

    code: int
    letter: str
    words: str
    colour: QColor


def code_key_size(rows: tuple[CodeRow, ...]) -> QSizeF:
    """Return the size of a key, px; nothing for none."""
    if not rows:
        return QSizeF(0.0, 0.0)
    metrics = QFontMetricsF(text_font(semibold=True))
    wide = max(metrics.horizontalAdvance(tr(row.words)) for row in rows)
    return QSizeF(wide + SWATCH_PX + GAP_PX + 2 * PAD_PX, len(rows) * ROW_PX + PAD_PX)


def code_key_place(rows: tuple[CodeRow, ...], area: QRectF) -> QRectF:
    """Return where the key goes: the upper right corner of an area, px."""
    size = code_key_size(rows)
    return QRectF(area.right() - EDGE_PX - size.width(), area.top() + EDGE_PX, size.width(), size.height())


def paint_code_key(painter: QPainter, place: QRectF, rows: tuple[CodeRow, ...], lit: int | None, theme: Theme) -> None:
    """Paint the key at a place, px; `lit` is the code under the mouse."""
    if not rows:
        return
    ground = QColor(theme.paper)
    ground.setAlphaF(0.92)
    painter.fillRect(place, ground)
    for k, row in enumerate(rows):
        _paint_row(
            painter,
            QPointF(place.left() + PAD_PX, place.top() + PAD_PX / 2 + (k + 0.5) * ROW_PX),
            row,
            row.code == lit,
            theme,
        )


def _paint_row(painter: QPainter, at: QPointF, row: CodeRow, lit: bool, theme: Theme) -> None:
    """Paint one row from its middle left."""
    swatch = QRectF(at.x(), at.y() - SWATCH_PX / 2, SWATCH_PX, SWATCH_PX)
    painter.setPen(theme.hairline)
    painter.setBrush(row.colour)
    painter.drawRect(swatch)
    painter.setFont(text_font(semibold=True))
    painter.setPen(ink_on(row.colour))
    painter.drawText(swatch, Qt.AlignmentFlag.AlignCenter, row.letter)
    painter.setFont(text_font(semibold=lit))
    painter.setPen(theme.ink if lit else theme.muted)
    words = QRectF(at.x() + SWATCH_PX + GAP_PX, at.y() - ROW_PX / 2, 400, ROW_PX)
    painter.drawText(words, Qt.AlignmentFlag.AlignVCenter, tr(row.words))


def ink_on(ground: QColor, opacity: float = 0.9) -> QColor:
    """Return black or white, whichever stands out from a ground."""
    light = 0.299 * ground.redF() + 0.587 * ground.greenF() + 0.114 * ground.blueF() > 0.5
    made = QColor("#101317" if light else "#FFFFFF")
    made.setAlphaF(opacity)
    return made
