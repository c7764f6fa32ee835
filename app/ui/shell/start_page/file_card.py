"""A file as a picture with its name: one press opens it."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QPointF, QRectF, QSize, QSizeF, Qt
from PySide6.QtGui import QEnterEvent, QImage, QPainter, QPainterPath, QPaintEvent, QPen
from PySide6.QtWidgets import QAbstractButton

from ...framework.catalogue import tr
from ...framework.theme import text_font
from ...framework.themed import Themed

HEIGHT, WORDS_PX, LEAST_WIDTH = 176, 48, 150
_RADIUS, _PAD_PX, _KIND_PX = 6, 12, 22


class FileCard(Themed, QAbstractButton):
    """Shows what a file holds.

    Attributes:
        path: of the file. words: under its name.
    """

    def __init__(self, path: Path, title: str, words: str) -> None:
        super().__init__()
        self.path, self.words = path, words
        self._picture, self._blank = QImage(), False
        self.setText(title)
        self.setAccessibleName(f"{title}, {words}")
        self.setToolTip(str(path))
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.setMinimumSize(LEAST_WIDTH, HEIGHT)
        self.setFixedHeight(HEIGHT)

    @property
    def picture_size(self) -> QSize:
        """How large its picture is, px of the screen."""
        ratio = self.devicePixelRatioF()
        return QSize(round((self.width() - 2) * ratio), round((HEIGHT - WORDS_PX - 2) * ratio))

    def show_picture(self, picture: QImage) -> None:
        """Show what the file holds; without a picture, of what kind it is."""
        self._picture, self._blank = picture, picture.isNull()
        self.update()

    def sizeHint(self) -> QSize:  # noqa: N802 (Qt's name)
        """As wide as four of them side by side usually are."""
        return QSize(232, HEIGHT)

    def enterEvent(self, event: QEnterEvent) -> None:  # noqa: N802 (Qt's name)
        """Stand out under the mouse."""
        self.update()
        super().enterEvent(event)

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 (Qt's name)
        """Paint the picture, a line, the name and what there is to say."""
        theme, painter = self._theme, QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
        whole = QRectF(self.rect()).adjusted(0.5, 0.5, -0.5, -0.5)
        outline = QPainterPath()
        outline.addRoundedRect(whole, _RADIUS, _RADIUS)
        painter.fillPath(outline, theme.hover if self.underMouse() else theme.raised)
        top = QRectF(1, 1, self.width() - 2, HEIGHT - WORDS_PX - 2)
        painter.save()
        painter.setClipPath(outline)
        painter.fillRect(top, theme.canvas)
        if not self._picture.isNull():
            size = QSizeF(self._picture.size()).scaled(top.size(), Qt.AspectRatioMode.KeepAspectRatio)
            place = QRectF(QPointF(), size)
            place.moveCenter(top.center())
            painter.drawImage(place, self._picture)
        elif self._blank:
            painter.setFont(text_font(_KIND_PX, semibold=True))
            painter.setPen(theme.hairline)
            painter.drawText(top, Qt.AlignmentFlag.AlignCenter, self.path.suffix.lstrip(".").upper())
        painter.restore()
        painter.setPen(QPen(theme.hairline, 1))
        painter.drawLine(top.bottomLeft(), top.bottomRight())
        painter.setPen(QPen(theme.accent_text if self.hasFocus() or self.underMouse() else theme.hairline, 1))
        painter.drawPath(outline)
        rows = ((self.text(), text_font(semibold=True), theme.ink), (tr(self.words), text_font(), theme.muted))
        for row, (text, font, colour) in enumerate(rows):
            painter.setFont(font)
            painter.setPen(colour)
            place = QRectF(_PAD_PX, top.bottom() + 6 + 19 * row, self.width() - 2 * _PAD_PX, 18)
            elided = painter.fontMetrics().elidedText(text, Qt.TextElideMode.ElideMiddle, int(place.width()))
            painter.drawText(place, Qt.AlignmentFlag.AlignVCenter, elided)
