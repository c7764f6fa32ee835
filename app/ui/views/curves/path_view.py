"""Both paths over one another: thin chords with their points, proven curves in colour, what stayed faint; corners and
comb.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from PySide6.QtCore import QLineF, QPointF, QRectF
from PySide6.QtGui import QColor, QPainter, QPen

from ....geometry.sample import Box, union
from ...framework.theme import Theme, mixed
from ..canvas.painting import overlay
from ..canvas.painting.grid import paint_origin
from ..canvas.painting.pens import FINE, screen_pen
from ..nc.motion_shapes import Floats, ViewSide
from ..nc.painting.motion_layer import MotionColourBy, MotionLayer, MotionPaint
from ..nc.painting.path_key import KeyRow
from ..nc.path_view import PathView
from .deviation_track import DeviationSample
from .model import CurveLayers, CurvesModel
from .painting.point_marks import PointsInSight, are_apart, key_rows, paint_points

_CURVE_PX, _CORNER_PX, _TOOTH_PX, _TALLEST_PX = 2.0, 3.5, 36.0, 90.0
_FAINT = 0.45


class CurvesPathView(PathView):
    """Shows a program, or what smoothing made of it.

    Attributes:
        curves: the smoothed program; None = only the program that there is.
        spot: the place that is marked, or None.
    """

    def __init__(self) -> None:
        super().__init__()
        self.curves: CurvesModel | None = None
        self.spot: DeviationSample | None = None
        self._layers: CurveLayers | None = None
        self._comb = False
        self.set_colour(MotionColourBy.MOTION)
        self.setAccessibleName("Path before and after")

    def show_program(self, picture: MotionLayer | None) -> None:
        """Show a program that is not smoothed, or nothing."""
        self.curves = self._layers = self.spot = None
        self.show_pictures(picture)

    def show_curves(self, curves: CurvesModel, side: ViewSide) -> None:
        """Show a smoothed program from a side whose layers are known."""
        if curves is not self.curves:
            self.spot = None
        self.curves, self._layers = curves, curves.layers[side]
        self.show_pictures(self._layers.curves)

    @property
    def moved(self) -> bool:
        """Whether the user looks at a place of his own choice, and not at the whole."""
        return self.picture is not None and self._fitted is None

    def show_comb(self, on: bool) -> None:
        """Show how much the curves bend, or not."""
        self._comb = on
        self.repaint_scene()

    def mark(self, spot: DeviationSample) -> None:
        """Mark a place and bring it to the middle."""
        self.spot = spot
        self.glide_to(self.view.centred(self._on_side(spot), self.area))
        self.update()

    def described(self, motion: int) -> str:
        """Return what there is to say about a motion, and why it stayed as it was."""
        why = self.curves.why(motion) if self.curves is not None else ""
        return f"{super().described(motion)}{f' · stays as it was: {why}' if why else ''}"

    def _paint_overlay(self, painter: QPainter) -> None:
        """Paint what follows the mouse, and the place that is marked."""
        super()._paint_overlay(painter)
        if self.spot is not None and self.picture is not None:
            painter.setClipRect(self.area)
            overlay.paint_place(painter, self.view.to_screen(self._on_side(self.spot)), self._how.theme.accent_text)
            painter.setClipping(False)

    def _on_side(self, spot: DeviationSample) -> tuple[float, float]:
        side = self.picture.side if self.picture is not None else ViewSide.XY
        return spot.place[side.value[0]], spot.place[side.value[1]]

    def _whole(self) -> Box:
        if self._layers is None:
            return super()._whole()
        boxes = [
            picture.box
            for picture in (self._layers.curves, self._layers.stayed, self._layers.before)
            if picture.box is not None
        ]
        return union(boxes) or super()._whole()

    def _portions(self, box: Box) -> Iterator[Callable[[QPainter], None]]:
        """Yield what stayed, then the chords, then the curves over them, then what is marked on these."""
        curves, seen = self.curves, self._layers
        if curves is None or seen is None:
            yield from super()._portions(box)
            return
        theme, side = self._how.theme, seen.curves.side
        yield from seen.stayed.portions(self.view, box, MotionPaint(theme.faint(_FAINT), MotionColourBy.MOTION))
        yield from seen.before.portions(self.view, box, MotionPaint(theme, MotionColourBy.MOTION, _before(theme), FINE))
        if self._comb:
            yield lambda painter: self._paint_comb(painter, curves, side)
        yield from seen.curves.portions(self.view, box, MotionPaint(theme, MotionColourBy.MOTION, width=_CURVE_PX))
        if self._points_seen(curves):
            yield lambda painter: paint_points(painter, curves.points, PointsInSight(side, box, self._on_screen), theme)
        yield lambda painter: self._paint_corners(painter, curves.corners, side, box)
        yield lambda painter: paint_origin(painter, self.view, theme)
        yield self._name_axes

    def _key(self) -> list[KeyRow]:
        theme = self._how.theme
        if self._layers is None or self.curves is None:
            return super()._key()
        rows = [KeyRow("Before", _before(theme))] if len(self.curves.changed) else []
        points = key_rows(self.curves.points, theme) if self._points_seen(self.curves) else []
        return rows + super()._key() + points + ([KeyRow("Curvature", theme.left)] if self._comb else [])

    def _points_seen(self, curves: CurvesModel) -> bool:
        return self._layers is not None and are_apart(curves.points, self._layers.curves.side, self.view.scale)

    def _within(self, points: Floats, side: ViewSide, box: Box) -> Floats:
        """Return (k, 2) those of some points that a box shows, on the screen, px."""
        seen = points[:, list(side.value)]
        near = np.all((seen >= box[:2]) & (seen <= box[2:]), axis=1)
        return self._on_screen(seen[near])

    def _on_screen(self, seen: Floats) -> Floats:
        return np.asarray(seen * (self.view.scale, -self.view.scale) + (self.view.ox, self.view.oy))

    def _paint_corners(self, painter: QPainter, corners: Floats, side: ViewSide, box: Box) -> None:
        """Paint a small diamond at each corner that is kept."""
        theme = self._how.theme
        painter.setPen(QPen(theme.ink, 1.2))
        painter.setBrush(theme.canvas)
        for x, y in self._within(corners, side, box).tolist():
            painter.drawPolygon(
                [QPointF(x + _CORNER_PX * a, y + _CORNER_PX * b) for a, b in ((1, 0), (0, 1), (-1, 0), (0, -1))]
            )

    def _paint_comb(self, painter: QPainter, curves: CurvesModel, side: ViewSide) -> None:
        """Paint the teeth, and a line along their tips."""
        comb, columns = curves.comb, list(side.value)
        foot = self._on_screen(comb.foot[:, columns])
        tooth = comb.tooth[:, columns] * (1, -1) * (_TOOTH_PX / comb.tall)
        size = np.linalg.norm(tooth, axis=1)[:, None]
        tip = foot + tooth * np.minimum(1.0, _TALLEST_PX / np.maximum(size, 1e-12))
        area = QRectF(self.area).adjusted(-_TALLEST_PX, -_TALLEST_PX, _TALLEST_PX, _TALLEST_PX)
        near = np.all((foot >= (area.left(), area.top())) & (foot <= (area.right(), area.bottom())), axis=1)
        colour = QColor(self._how.theme.left)
        colour.setAlphaF(0.55)
        painter.setPen(screen_pen(painter, colour, FINE))
        painter.drawLines([QLineF(*a, *b) for a, b in zip(foot[near].tolist(), tip[near].tolist(), strict=True)])
        along = near[1:] & near[:-1] & (comb.piece[1:] == comb.piece[:-1])
        painter.setPen(screen_pen(painter, self._how.theme.left, 1.0))
        painter.drawLines(
            [QLineF(*a, *b) for a, b in zip(tip[:-1][along].tolist(), tip[1:][along].tolist(), strict=True)]
        )


def _before(theme: Theme) -> QColor:
    """Return the colour of the chords."""
    return mixed(theme.canvas, theme.ink, 0.7)
