"""A picture of a scene that comes about in slices, so that the window listens between them."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator

from PySide6.QtGui import QPainter, QPixmap

from ..view_transform import ViewTransform


class IncrementalPicture:
    """A picture in the making.

    Attributes:
        pixmap: what there is of it. view: how the drawing lies in it.
        ms: how long it was painted so far, ms.
    """

    def __init__(self, pixmap: QPixmap, view: ViewTransform, steps: Callable[[QPainter], Iterator[None]]) -> None:
        """Begin; nothing is painted yet.

        Args:
            steps: paints everything, and pauses wherever others may have their turn.
        """
        self.pixmap, self.view, self.ms = pixmap, view, 0.0
        self._painter = QPainter(pixmap)
        self._painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        self._steps = steps(self._painter)

    def go_on(self, most_ms: float) -> bool:
        """Paint for about so many ms more; return whether the picture is whole."""
        begun = time.perf_counter()
        whole = True
        for _ in self._steps:
            if (time.perf_counter() - begun) * 1000 >= most_ms:
                whole = False
                break
        self.ms += (time.perf_counter() - begun) * 1000
        if whole:
            self._painter.end()
        return whole

    def __del__(self) -> None:
        """Leave the pixmap before it goes."""
        self.drop()

    def drop(self) -> None:
        """Give the picture up."""
        close = getattr(self._steps, "close", None)
        if close is not None:
            close()
        if self._painter.isActive():
            self._painter.end()
