"""The sheets as they will come out: white paper on the table, seen whole; the wheel goes nearer."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF, QSizeF, Qt, Signal
from PySide6.QtGui import QColor, QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QPixmap, QResizeEvent, QWheelEvent
from PySide6.QtWidgets import QWidget

from ...framework.theme import LIGHT, Theme
from .sheet_painter import PlotSheet, paint

_EDGE_PX, _GAP_MM = 24.0, 8.0
_STEP, _NEAREST = 1.25, 40.0


class PlotPreview(QWidget):
    """Every sheet of a plot side by side.

    Signals:
        left(): Escape was pressed.
    """

    left = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setAccessibleName("Page preview")
        self.sheets: tuple[PlotSheet, ...] = ()
        self._columns = 1
        self._theme = LIGHT
        self._zoom, self._shift = 1.0, QPointF()
        self._grabbed: QPointF | None = None
        self._picture: QPixmap | None = None

    def show_sheets(self, sheets: tuple[PlotSheet, ...], columns: int) -> None:
        """Show other sheets; what is looked at stays where their number does."""
        if len(sheets) != len(self.sheets) or columns != self._columns:
            self.fit()
        self.sheets, self._columns = sheets, columns
        self._renew()

    def set_theme(self, theme: Theme) -> None:
        """Follow the theme; paper is white in all of them."""
        self._theme = theme
        self._renew()

    def fit(self) -> None:
        """Show all sheets."""
        self._zoom, self._shift = 1.0, QPointF()
        self._renew()

    def zoom_by(self, factor: float, at: QPointF | None = None) -> None:
        """Go nearer by a factor, about a place in px or the middle."""
        at = at or QPointF(self.width() / 2, self.height() / 2)
        zoom = min(max(self._zoom * factor, 1.0), _NEAREST)
        middle = QPointF(self.width() / 2, self.height() / 2)
        self._shift = at - middle - (at - middle - self._shift) * (zoom / self._zoom) if zoom > 1 else QPointF()
        self._zoom = zoom
        self._renew()

    def _renew(self) -> None:
        self._picture = None
        self.update()

    def _whole(self) -> QSizeF:
        page, rows = self.sheets[0].page, -(-len(self.sheets) // self._columns)
        return QSizeF(self._columns * (page.width + _GAP_MM) - _GAP_MM, rows * (page.height + _GAP_MM) - _GAP_MM)

    @property
    def px_per_mm(self) -> float:
        """How large a millimetre of paper is shown."""
        whole = self._whole()
        return self._zoom * min(
            (self.width() - 2 * _EDGE_PX) / whole.width(), (self.height() - 2 * _EDGE_PX) / whole.height()
        )

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 (Qt's name)
        """Paint the sheets once, and then their picture."""
        if self._picture is None:
            ratio = self.devicePixelRatioF()
            self._picture = QPixmap(self.size() * ratio)
            self._picture.setDevicePixelRatio(ratio)
            painter = QPainter(self._picture)
            painter.fillRect(self.rect(), self._theme.grid_major)
            if self.sheets and self.width() > 2 * _EDGE_PX and self.height() > 2 * _EDGE_PX:
                self._paint_sheets(painter)
            painter.end()
        QPainter(self).drawPixmap(0, 0, self._picture)

    def _paint_sheets(self, painter: QPainter) -> None:
        scale, whole, page = self.px_per_mm, self._whole(), self.sheets[0].page
        painter.translate(self.width() / 2 + self._shift.x(), self.height() / 2 + self._shift.y())
        painter.scale(scale, scale)
        painter.translate(-whole.width() / 2, -whole.height() / 2)
        for at, sheet in enumerate(self.sheets):
            painter.save()
            painter.translate(
                at % self._columns * (page.width + _GAP_MM), at // self._columns * (page.height + _GAP_MM)
            )
            painter.setClipRect(QRectF(0, 0, page.width, page.height))
            painter.fillRect(QRectF(0, 0, page.width, page.height), QColor("#FFFFFF"))
            paint(painter, sheet)
            painter.restore()

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 (Qt's name)
        """Paint anew."""
        self._renew()

    def wheelEvent(self, event: QWheelEvent) -> None:  # noqa: N802 (Qt's name)
        """Zoom at the mouse."""
        if self.sheets and event.angleDelta().y():
            self.zoom_by(_STEP if event.angleDelta().y() > 0 else 1 / _STEP, event.position())

    def mousePressEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Take hold of the paper."""
        self._grabbed = event.position() - self._shift

    def mouseMoveEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Draw the sheet along with the mouse, where it is larger than its frame."""
        if self._grabbed is not None and self._zoom > 1:
            self._shift = event.position() - self._grabbed
            self._renew()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Let go."""
        self._grabbed = None

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802 (Qt's name)
        """Escape leaves, F fits."""
        if event.key() == Qt.Key.Key_Escape:
            self.left.emit()
        elif event.key() == Qt.Key.Key_F:
            self.fit()
        else:
            super().keyPressEvent(event)
