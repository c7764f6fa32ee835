"""Where a word stands beside what it speaks of, so that it covers no other word and as few curves as can be."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QPoint, QRect, QRectF, QSize

from ...views.canvas.view_transform import ViewTransform

_GAP_PX, _INSIDE_PX, _TRIED = 4, 10, 4


@dataclass
class WordPlaces:
    """Gives out places on a view, one after the other.

    Attributes:
        view: from mm to px. seen: what is seen of the view, px.
        curves: (4, n) x0, y0, x1, y1 in mm of what is better not covered, a row each: it is asked at every step of a
            zoom, and four rows take a thirtieth of the time of n boxes.
        taken: the places that were given out, and those of other words, px.
    """

    view: ViewTransform
    seen: QRect
    curves: NDArray[np.float64]
    taken: list[QRect] = field(default_factory=list)

    def take(self, box: QRectF, size: QSize, filled: bool) -> QRect | None:
        """Return where a word of a size stands, px, and keep that place; None where there is none.

        Args:
            box: of what it speaks of, mm. size: of the word, px. filled: whether the box's inside is meant.
        """
        free = [each for each in places(self._on_screen(box), size, filled) if self._is_free(each)]
        if not free:
            return None
        best = free[int(np.argmin(self._covered(free)))] if len(free) > 1 else free[0]
        self.taken.append(best)
        return best

    def _is_free(self, place: QRect) -> bool:
        return self.seen.contains(place) and not any(place.intersects(each) for each in self.taken)

    def _on_screen(self, box: QRectF) -> QRect:
        corners = self.view.to_screen((box.left(), box.bottom())), self.view.to_screen((box.right(), box.top()))
        return QRectF(*corners).toRect()

    def _covered(self, places: Sequence[QRect]) -> NDArray[np.int64]:
        """Return how many curves each place touches without lying within their boxes."""
        x0, y0, x1, y1 = self.curves
        left, low = np.array([self.view.to_world(QRectF(each).bottomLeft()) for each in places]).T[:, :, None]
        right, high = np.array([self.view.to_world(QRectF(each).topRight()) for each in places]).T[:, :, None]
        touched = (left <= x1) & (low <= y1) & (x0 <= right) & (y0 <= high)
        within = (x0 < left) & (y0 < low) & (right < x1) & (high < y1)
        return np.asarray((touched & ~within).sum(axis=1))


def places(area: QRect, size: QSize, filled: bool) -> list[QRect]:
    """Return where a word of a size may stand, px, the best first: as `place_at` says, above, at either side, lower."""
    first = place_at(area, size, filled)
    middle = area.center().y() - size.height() // 2
    above = QRect(QPoint(first.x(), area.top() - _GAP_PX - size.height()), size)
    right = QRect(QPoint(area.right() + 2 * _GAP_PX, middle), size)
    left = QRect(QPoint(area.left() - 2 * _GAP_PX - size.width(), middle), size)
    lower = [first.translated(0, k * (size.height() + _GAP_PX)) for k in range(1, _TRIED)]
    return [first, above, right, left, *lower]


def place_at(area: QRect, size: QSize, filled: bool) -> QRect:
    """Return where a word of a size stands, px: in the middle of an area that has room for it, or, where a line is
    followed, above its lower end; else below it.
    """
    room = area.width() > size.width() + 2 * _GAP_PX and area.height() > 3 * size.height()
    below, middle = area.bottom() + _GAP_PX, area.center().y() - size.height() // 2
    inside = middle if filled else area.bottom() - size.height() - _INSIDE_PX
    return QRect(QPoint(area.center().x() - size.width() // 2, inside if room else below), size)
