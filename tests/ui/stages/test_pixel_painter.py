"""Pixels smaller than those of the screen: no line of them is passed over."""

import numpy as np
import pytest
from PySide6.QtCore import QRectF
from PySide6.QtGui import QColor, QImage, QPainter

from app.raster.frame import BitmapFrame
from app.ui.views.canvas.view_transform import ViewTransform
from app.ui.views.stages.painting.pixel_painter import PixelPaint, paint_pixels

SIDE = 200


@pytest.mark.parametrize("size", [0.917, 0.6, 0.35])
def test_each_line_of_pixels_is_seen(size: float) -> None:
    wide, white, black = round(SIDE * size), QColor("white").rgb(), QColor("black").rgb()
    view = ViewTransform(scale=size, ox=0.0, oy=wide)
    for row in range(10, 60):
        plane = np.zeros((SIDE, SIDE), np.uint8)
        plane[row] = 1
        image = QImage(wide, wide, QImage.Format.Format_RGB32)
        image.fill(white)
        painter = QPainter(image)
        pixels = PixelPaint(BitmapFrame(SIDE, SIDE, 1.0), plane, [white, black], ranks=np.arange(2, dtype=np.uint8))
        paint_pixels(painter, view, QRectF(0, 0, wide, wide), pixels)
        painter.end()
        assert any(image.pixel(wide // 2, y) == black for y in range(wide)), f"row {row} is not shown"
