"""What a job puts round the drawing: the stock, dashed, copies of the part, faint, and keep-out areas, hatched."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QBrush, QColor, QFontMetricsF, QPainter, QPainterPath, QTransform

from .....core.errors import HitofudeError
from .....geometry.sample import Box
from .....model.job import Copies, Job
from .....model.part import Part
from .....model.stock_box import StockBox
from ....framework.catalogue import tr
from ....framework.figures import TIMES, grouped
from ....framework.theme import Theme, text_font
from ..view_transform import ViewTransform
from .curve_path import chain_path
from .part_layer import PartLayer
from .pens import screen_pen
from .stock_outline import paint_outline

MOST_DRAWN = 60
"""Copies that are drawn curve by curve; of more the boxes are."""

_FAINT, _FILL = 0.4, 0.16
_WIDTH = 1.25
_GAP_PX = 6.0


class SurroundingsLayer:
    """Stock, copies and clamps of a job, ready to paint.

    Attributes:
        stock: None = nothing is drawn that it could lie round.
    """

    def __init__(self) -> None:
        """Begin with none of them."""
        self.stock: StockBox | None = None
        self._copies = Copies()
        self._clamps = QPainterPath()
        self._part = Part()
        self._layers: tuple[str, ...] = ()

    def update(self, job: Job) -> bool:
        """Take over another job; return whether anything looks otherwise than before."""
        clamped = job.keep_out_layers != self._layers or (bool(self._layers) and job.part is not self._part)
        copied = job.copies != self._copies
        self._copies, self._part, self._layers = job.copies, job.part, job.keep_out_layers
        if clamped:
            self._make_clamps(job)
        return clamped or copied

    def _make_clamps(self, job: Job) -> None:
        """Read the keep-out areas from the drawing."""
        self._clamps = QPainterPath()
        self._clamps.setFillRule(Qt.FillRule.OddEvenFill)
        if not job.keep_out_layers:
            return
        from .....toolpath.drawn_contours import clamps_of  # reads contours: only where there are clamps

        try:
            regions = clamps_of(job)[0]
        except HitofudeError:  # a layer that the drawing does not have; computing says so
            return
        for contour in (contour for region in regions for contour in region.contours):
            chain_path(contour.primitives, self._clamps)

    @property
    def clamps(self) -> QPainterPath:
        """Outlines of the keep-out areas, mm."""
        return self._clamps

    def paint_stock(self, painter: QPainter, view: ViewTransform, area: QRectF, theme: Theme) -> None:
        """Paint the stock's outline and above it its size within a screen rectangle."""
        if self.stock is None:
            return
        painter.save()
        paint_outline(painter, _outline(self.stock, view), area, theme)
        painter.setFont(text_font())
        place = self.size_place(view)
        if not place.isEmpty():
            painter.drawText(QPointF(place.left(), place.bottom()), _size_of(self.stock))
        painter.restore()

    def size_place(self, view: ViewTransform) -> QRectF:
        """Return where the stock's size is written, px, from the letters' tops to their line; empty = nowhere."""
        if self.stock is None:
            return QRectF()
        outline, metrics = _outline(self.stock, view), QFontMetricsF(text_font())
        width, high = metrics.horizontalAdvance(_size_of(self.stock)), metrics.ascent()
        if width >= outline.width():
            return QRectF()
        return QRectF(outline.right() - width, outline.top() - _GAP_PX - high, width, high)

    def paint_clamps(self, painter: QPainter, view: ViewTransform, box: Box, theme: Theme) -> None:
        """Paint the keep-out areas when they come into a box in mm; the painter works in screen px."""
        if self._clamps.isEmpty() or not self._clamps.boundingRect().intersects(
            QRectF(box[0], box[1], box[2] - box[0], box[3] - box[1])
        ):
            return
        painter.save()
        painter.setTransform(view.transform(), True)
        ground = QColor(theme.warning)
        ground.setAlphaF(_FILL)
        hatch = QBrush(theme.warning, Qt.BrushStyle.FDiagPattern)
        hatch.setTransform(QTransform.fromScale(1 / view.scale, -1 / view.scale))
        painter.fillPath(self._clamps, ground)
        painter.fillPath(self._clamps, hatch)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(screen_pen(painter, theme.warning, _WIDTH))
        painter.drawPath(self._clamps)
        painter.restore()

    def paint_copies(self, painter: QPainter, view: ViewTransform, picture: PartLayer, box: Box, theme: Theme) -> None:
        """Paint the copies of the drawing that come into a box in mm; the painter works in screen px."""
        x0, y0, x1, y1 = box
        around = picture.lookup.box
        if around is None:
            return
        seen = [
            (dx, dy)
            for dx, dy in self._copies.shifts[1:]
            if around[0] + dx <= x1 and around[2] + dx >= x0 and around[1] + dy <= y1 and around[3] + dy >= y0
        ]
        painter.save()
        painter.setOpacity(painter.opacity() * _FAINT)
        for dx, dy in seen:
            moved = view.panned(dx * view.scale, -dy * view.scale)
            if len(seen) <= MOST_DRAWN:
                for _ in picture.curve_steps(
                    painter, moved, (x0 - dx, y0 - dy, x1 - dx, y1 - dy), theme, without=self._layers
                ):
                    pass
            else:
                painter.setPen(theme.ink)
                painter.drawRect(
                    QRectF(moved.to_screen((around[0], around[3])), moved.to_screen((around[2], around[1])))
                )
        painter.restore()


def _outline(stock: StockBox, view: ViewTransform) -> QRectF:
    """Return the stock's outline, px."""
    return QRectF(view.to_screen((stock.x0, stock.y1)), view.to_screen((stock.x1, stock.y0)))


def _size_of(stock: StockBox) -> str:
    """Return what is written above a stock."""
    return tr(f"stock {f' {TIMES} '.join(grouped(each, 3) for each in stock.size)}")
