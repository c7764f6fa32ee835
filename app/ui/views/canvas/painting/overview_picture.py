"""A coarse picture of all there is, shown where the last picture of a heavy scene does not reach."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QPainter, QPixmap

from .....geometry.sample import Box
from ..view_transform import ViewTransform, fitted
from .incremental_picture import IncrementalPicture

_SPAN_PX = 1024.0
_MARGIN_PX = 8.0


class OverviewPicture:
    """All of a scene on a transparent square of 1024 px; it comes about in slices.

    Attributes:
        whole: whether it can be shown.
    """

    def __init__(self) -> None:
        """Begin with none."""
        self.whole = False
        self._growing: IncrementalPicture | None = None

    def forget(self) -> None:
        """Show it no more: the scene has changed."""
        growing, self._growing, self.whole = self._growing, None, False
        if growing is not None:
            growing.drop()

    def go_on(self, box: Box, steps: Callable[[QPainter, ViewTransform], Iterator[None]], most_ms: float) -> None:
        """Paint what lies in a box in mm for about so many ms more; it is begun where nothing is there."""
        if self._growing is None:
            pixmap = QPixmap(int(_SPAN_PX), int(_SPAN_PX))
            pixmap.fill(Qt.GlobalColor.transparent)
            view = fitted(box, QRectF(0.0, 0.0, _SPAN_PX, _SPAN_PX), _MARGIN_PX)
            self._growing = IncrementalPicture(pixmap, view, lambda painter: steps(painter, view))
        self.whole = self.whole or self._growing.go_on(most_ms)

    def paint(self, painter: QPainter, view: ViewTransform) -> None:
        """Paint it where a view has it."""
        if self._growing is None or not self.whole:
            return
        own = self._growing.view
        grown = view.scale / own.scale
        place = QRectF(view.ox - grown * own.ox, view.oy - grown * own.oy, grown * _SPAN_PX, grown * _SPAN_PX)
        painter.drawPixmap(place, self._growing.pixmap, QRectF(0.0, 0.0, _SPAN_PX, _SPAN_PX))
