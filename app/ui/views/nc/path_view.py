"""The path of a program, seen from above or from a side: zoom, pan, pick a motion, light motions up."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterable, Iterator

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QEvent, QPointF, QRectF, QTimer, Signal
from PySide6.QtGui import QColor, QKeyEvent, QMouseEvent, QPainter, QPainterPath, QPen

from ....geometry.sample import Box, union
from ....model.curves import Point
from ...framework.theme import LIGHT, Theme, text_font
from ..canvas.looking import LookingAnswers, LookingHand
from ..canvas.painting import overlay
from ..canvas.painting.grid import paint_origin, paint_paper, paint_rulers
from ..canvas.painting.stock_outline import paint_outline
from ..canvas.view_transform import ViewTransform, fitted
from ..canvas.viewport import Viewport, ViewportScene
from .line_marks import Ints
from .motion_hover import describe_motion, nearest_motion
from .motion_shapes import ViewSide
from .painting.motion_layer import MotionColourBy, MotionLayer, MotionPaint, stock_outline
from .painting.path_key import KeyCorner, KeyRow, beside_key, cuts_within, key_place, key_size, paint_key

_PICK_PX, _BLEED_PX, _EDGE_PX = 6.0, 8.0, 16.0
_AT_ONCE_S = 0.012
"""So long a picture is painted that is shown for the first time before the window listens again."""

_ALONE_PX = 2.2
"""Width of what only one of two programs does."""

_NONE: Ints = np.zeros(0, np.int64)
_FRAME = (0.0, 0.0, 100.0, 100.0)


class PathView(Viewport):
    """Shows motions and tells which one is picked.

    Signals:
        motion_picked(index): a motion was clicked. other_picked(index): one of the other program, where the first has
        none. hovered(sentence): what is under the mouse, or "". cursor_moved(right, up): the place under the mouse, mm.
    """

    motion_picked = Signal(int)
    other_picked = Signal(int)
    hovered = Signal(str)
    cursor_moved = Signal(float, float)

    def __init__(self) -> None:
        scene = ViewportScene(self._scene_steps, self._paint_margins, self._paint_overlay, room=self._room)
        super().__init__(scene)
        self._how = MotionPaint(LIGHT)
        self.picture: MotionLayer | None = None
        self.other: MotionLayer | None = None
        self._alone: MotionLayer | None = None
        self.corner = KeyCorner.TOP_RIGHT
        self._fresh = False
        self._rest: Iterator[Callable[[QPainter], None]] = iter(())
        self._later = QTimer(self, singleShot=True, interval=0)
        self._later.timeout.connect(self._paint_on)
        self._lit, self._lit_other, self._under = QPainterPath(), QPainterPath(), QPainterPath()
        self._band, self._band_other = _NONE, _NONE
        self._hover: int | None = None
        self._ends_at: Point | None = None
        self._hand = LookingHand(self, LookingAnswers(self._look, self._pick, self.fit))
        self.setMinimumSize(200, 150)
        self.setAccessibleName("Path of the NC program")

    @property
    def lit(self) -> Ints:
        """The motions that are lit up."""
        return self._band

    def set_theme(self, theme: Theme) -> None:
        """Paint with another theme."""
        self._how = MotionPaint(theme, self._how.colour)
        self.repaint_scene()

    def set_colour(self, colour: MotionColourBy) -> None:
        """Colour by tool or by kind of motion."""
        self._how = MotionPaint(self._how.theme, colour)
        self.corner = self._free_corner(self.view) or self.corner
        self.repaint_scene()

    def show_pictures(
        self, picture: MotionLayer | None = None, alone: tuple[MotionLayer, MotionLayer] | None = None
    ) -> None:
        """Show a program's motions; what was lit up is not any more.

        Args:
            picture: of the program; None = nothing.
            alone: where it is compared, what only this program does, and what only the other one does.
        """
        self.picture = picture
        self._alone, self.other = alone or (None, None)
        self._hover, self._under, self._fresh = None, QPainterPath(), True
        self.light(_NONE)
        problem = picture.shapes.program.error if picture is not None else None
        ended = picture is not None and problem is not None and len(picture.shapes)
        self._ends_at = self._seen(picture.shapes.program.motions.end[-1]) if picture is not None and ended else None
        self.repaint_scene()

    def fit(self) -> None:
        """Show everything."""
        self.glide_to_box(self._whole())

    def fit_now(self) -> None:
        """Show everything at once, and again when the size changes."""
        self.fit_to(self._whole())

    def light(self, motions: Ints, of_other: Ints = _NONE) -> None:
        """Light up some motions, by number, and some of the other program."""
        self._band, self._band_other = motions, of_other
        self._lit, self._lit_other = (
            picture.shapes.path(rows, picture.side) if picture is not None else QPainterPath()
            for picture, rows in ((self.picture, motions), (self.other, of_other))
        )
        self.update()

    def bring_into_sight(self) -> None:
        """Move the picture so that what is lit up is seen, no farther than needed."""
        both = ((self.picture, self._band), (self.other, self._band_other))
        box = _union(picture.box_of(rows) for picture, rows in both if picture is not None and len(rows))
        if box is None:
            return
        x0, y0, x1, y1 = self.view.world_box(self.area.adjusted(_EDGE_PX, _EDGE_PX, -_EDGE_PX, -_EDGE_PX))
        if box[2] - box[0] > x1 - x0 or box[3] - box[1] > y1 - y0:
            if not (box[0] < x1 and box[2] > x0 and box[1] < y1 and box[3] > y0):
                self.glide_to(fitted(box, self.area))
        elif not (x0 <= box[0] and box[2] <= x1 and y0 <= box[1] and box[3] <= y1):
            self.glide_to(self.view.centred(((box[0] + box[2]) / 2, (box[1] + box[3]) / 2), self.area))

    def _scene_steps(self, painter: QPainter, area: QRectF) -> Iterator[None]:
        """Paint raster and motions within a screen rectangle."""
        theme = self._how.theme
        box = self.view.world_box(area.adjusted(-_BLEED_PX, -_BLEED_PX, _BLEED_PX, _BLEED_PX))
        paint_paper(painter, self.view, area, theme, self.unit)
        if self.picture is not None:
            outline = stock_outline(self.view, self.picture.shapes.program.stock, self.picture.side)
            if outline is not None:
                paint_outline(painter, outline, area, theme)
        self._rest = self._portions(box)
        self._paint_portions(painter, _AT_ONCE_S if self._fresh else math.inf)
        self._fresh = False
        return iter(())

    def _portions(self, box: Box) -> Iterator[Callable[[QPainter], None]]:
        """Yield what is to be painted of the paths, then zero and axes over them."""
        theme = self._how.theme
        if self.picture is not None:
            yield from self.picture.portions(self.view, box, self._how)
        for alone, hue in ((self._alone, theme.parameter), (self.other, theme.left)):
            if alone is not None:
                yield from alone.portions(self.view, box, MotionPaint(theme, self._how.colour, hue, _ALONE_PX))
        yield lambda painter: paint_origin(painter, self.view, theme)
        yield self._name_axes

    def _paint_portions(self, painter: QPainter, seconds: float) -> None:
        """Paint for a while; if there is more, go on with it when the window has listened."""
        end = time.perf_counter() + seconds
        for paint_portion in self._rest:
            paint_portion(painter)
            if time.perf_counter() > end:
                self._later.start()
                return

    def _paint_on(self) -> None:
        """Go on with painting a picture that is shown for the first time."""
        self.paint_more(lambda painter: self._paint_portions(painter, _AT_ONCE_S))

    def _paint_margins(self, painter: QPainter) -> None:
        """Paint the rulers."""
        paint_rulers(painter, self.view, self.size(), self._how.theme, self.unit)

    def _paint_overlay(self, painter: QPainter) -> None:
        """Paint what is lit up, what is under the mouse, and where reading ended."""
        painter.setClipRect(self.area)
        theme = self._how.theme
        accent = (theme.accent, theme.accent_text)
        if not self._lit.isEmpty():
            overlay.paint_highlight(painter, self.view, self._lit, accent)
            self._paint_end(painter, theme)
        if not self._lit_other.isEmpty():
            overlay.paint_highlight(painter, self.view, self._lit_other, (theme.left, theme.left))
        if not self._under.isEmpty():
            overlay.paint_highlight(painter, self.view, self._under, accent, 1.5)
        if self._ends_at is not None:
            overlay.paint_place(painter, self.view.to_screen(self._ends_at), theme.error)
        key = self._key()
        paint_key(painter, key_place(key_size(key), self.area, self.corner), key, theme)
        painter.setClipping(False)
        self._hand.paint_marks(painter, theme)

    def mousePressEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Hold the picture; what is not dragged is a click."""
        self._hand.press(event)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Drag the picture, or look at what lies under the mouse."""
        self._hand.move(event)
        self.cursor_moved.emit(*self.view.to_world(event.position()))

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Let the picture go, or pick."""
        self._hand.release(event)

    def leaveEvent(self, event: QEvent) -> None:  # noqa: N802 (Qt's name)
        """Forget the mouse."""
        self._hand.leave()
        self._show_hover(None)

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802 (Qt's name)
        """F and Home fit, + and - zoom."""
        if not self._hand.key(event):
            super().keyPressEvent(event)

    def _pick(self, position: QPointF) -> None:
        """Say which motion was clicked."""
        picked, other = (self._at(position, picture) for picture in (self.picture, self.other))
        if picked is not None:
            self.motion_picked.emit(picked)
        elif other is not None:
            self.other_picked.emit(other)

    def _whole(self) -> Box:
        return _union(picture.box for picture in (self.picture, self.other) if picture is not None) or _FRAME

    def _seen(self, point: NDArray[np.float64]) -> Point:
        side = self.picture.side if self.picture is not None else ViewSide.XY
        return (float(point[side.value[0]]), float(point[side.value[1]]))

    def _room(self, box: Box) -> QRectF:
        """Return the part of the area that a box in mm is fitted into, the key in a corner of it or beside it."""
        corner = self._free_corner(fitted(box, self.area))
        self.corner = corner or KeyCorner.TOP_RIGHT
        rooms = beside_key(key_size(self._key()), self.area)
        return self.area if corner is not None else max(rooms, key=lambda room: fitted(box, room).scale)

    def _free_corner(self, view: ViewTransform) -> KeyCorner | None:
        """Return a corner where the key would lie on nothing that is cut, if there is one."""
        size = key_size(self._key())
        programs = [picture for picture in (self.picture, self.other) if picture is not None]
        for corner in KeyCorner:
            box = view.world_box(key_place(size, self.area, corner))
            if not any(cuts_within(picture.shapes, picture.side, box) for picture in programs):
                return corner
        return None

    def _key(self) -> list[KeyRow]:
        """Return what the colours mean."""
        if self.picture is None:
            return []
        theme = self._how.theme
        both = (("Only in the first", self._alone, theme.parameter), ("Only in the second", self.other, theme.left))
        return self.picture.key(self._how) + [
            KeyRow(words, hue) for words, alone, hue in both if alone is not None and alone.some
        ]

    def _paint_end(self, painter: QPainter, theme: Theme) -> None:
        """Paint where the last of the lit motions ends: this is where the tool is."""
        if self.picture is not None and len(self.picture.shapes.seen(self.picture.side, self._band[-1:])):
            painter.setPen(QPen(theme.accent_text, 1.8))
            painter.setBrush(theme.canvas)
            painter.drawEllipse(
                self.view.to_screen(self._seen(self.picture.shapes.program.motions.end[self._band[-1]])), 4.5, 4.5
            )

    def _name_axes(self, painter: QPainter) -> None:
        """Write the names of the two axes at the arrows of the zero."""
        names = "XYZ"
        side = self.picture.side if self.picture is not None else ViewSide.XY
        zero = self.view.to_screen((0.0, 0.0))
        painter.setFont(text_font())
        painter.setPen(QColor(self._how.theme.muted))
        painter.drawText(QPointF(zero.x() + 41, zero.y() + 4), names[side.value[0]])
        painter.drawText(QPointF(zero.x() - 3.5, zero.y() - 41), names[side.value[1]])

    def _at(self, position: QPointF, picture: MotionLayer | None) -> int | None:
        if picture is None or not len(picture.shapes) or not self.area.contains(position):
            return None
        return nearest_motion(picture.shapes, picture.side, self.view.to_world(position), _PICK_PX / self.view.scale)

    def _look(self, position: QPointF) -> None:
        self._show_hover(self._at(position, self.picture))

    def _show_hover(self, motion: int | None) -> None:
        if motion == self._hover or self.picture is None:
            return
        self._hover = motion
        shapes = self.picture.shapes
        self._under = shapes.path(np.array([motion]), self.picture.side) if motion is not None else QPainterPath()
        self.hovered.emit(self.described(motion) if motion is not None else "")
        self.update()

    def described(self, motion: int) -> str:
        """Return what there is to say about a motion under the mouse."""
        return describe_motion(self.picture.shapes, motion) if self.picture is not None else ""


def _union(boxes: Iterable[Box | None]) -> Box | None:
    return union([box for box in boxes if box is not None])
