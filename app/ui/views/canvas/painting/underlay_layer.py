"""A picture to trace, read with care and painted on the paper."""

from __future__ import annotations

import math
import os
from pathlib import Path

from PySide6.QtCore import QByteArray, QRectF, Qt
from PySide6.QtGui import QImage, QImageReader, QPainter

from .....core.errors import InputError
from .....model.underlay import Underlay
from ..view_transform import ViewTransform

MOST_PX = 64_000_000
SUFFIXES = (".png", ".jpg", ".jpeg")
_SMALL_PX = 1024
_FORMATS = (QByteArray(b"png"), QByteArray(b"jpeg"), QByteArray(b"jpg"))


def read_picture(path: Path) -> QImage:
    """Return the pixels of a PNG or JPEG file; its size is looked at before anything is decoded.

    Raises:
        InputError: it cannot be read, is of another kind, damaged, or larger than 64 million pixels.
    """
    if not os.path.isfile(path):
        raise InputError(f"{path.name} is not there.")
    reader = QImageReader(str(path))
    reader.setAutoTransform(True)
    reader.setDecideFormatFromContent(True)
    if not reader.canRead() or reader.format() not in _FORMATS:
        raise InputError(f"{path.name} is no picture that can be read; choose a PNG or JPEG file.")
    size = reader.size()
    if size.width() * size.height() > MOST_PX:
        raise InputError(
            f"{path.name} has {size.width()} x {size.height()} px; up to 64 million px can be traced. Scale it down."
        )
    image = reader.read()
    if image.isNull():
        raise InputError(f"{path.name} is damaged: {reader.errorString()}.")
    return image.convertToFormat(QImage.Format.Format_ARGB32_Premultiplied)


class UnderlayLayer:
    """One picture and where it lies.

    Attributes:
        place: where; can be replaced.
        size: columns and rows, px.
    """

    def __init__(self, image: QImage, place: Underlay) -> None:
        """Prepare coarser copies, each half as wide, so that a large picture is quickly painted small."""
        self.place, self.size = place, (image.width(), image.height())
        self._levels = [image]
        while max(self._levels[-1].width(), self._levels[-1].height()) > _SMALL_PX:
            last = self._levels[-1]
            half = last.scaled(
                (last.width() + 1) // 2,
                (last.height() + 1) // 2,
                Qt.AspectRatioMode.IgnoreAspectRatio,
                Qt.TransformationMode.SmoothTransformation,
            )
            self._levels.append(half)

    def paint(self, painter: QPainter, view: ViewTransform) -> None:
        """Paint it; the painter works in screen px."""
        place = self.place
        painter.save()
        painter.setTransform(view.transform(), True)
        painter.translate(*place.origin)
        painter.rotate(math.degrees(place.angle))
        painter.scale(place.mm_per_px, -place.mm_per_px)
        painter.setOpacity(painter.opacity() * place.opacity)
        px = place.mm_per_px * view.scale * painter.device().devicePixelRatioF()
        level = min(max(math.floor(-math.log2(px)), 0), len(self._levels) - 1)
        painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform, px < 4)
        painter.drawImage(QRectF(0, -self.size[1], *self.size), self._levels[level])
        painter.restore()
