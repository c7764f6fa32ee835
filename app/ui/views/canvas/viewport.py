"""A widget on the drawing plane: zoom, pan, glide, and a picture of the scene that is painted only when it changes.

A scene that takes longer than a frame is first shown as its last picture, moved and scaled, beside it a coarse picture
of everything, and painted anew in slices between events.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial

from PySide6.QtCore import QEasingCurve, QPointF, QRectF, Qt, QTimer, QVariantAnimation, Signal
from PySide6.QtGui import (
    QHideEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPixmap,
    QRegion,
    QResizeEvent,
    QTransform,
    QWheelEvent,
)
from PySide6.QtWidgets import QWidget

from ....geometry.sample import Box, union
from .painting.grid import RULER
from .painting.incremental_picture import IncrementalPicture
from .painting.overview_picture import OverviewPicture
from .view_transform import ViewTransform, fitted

GLIDE_MS = 150
_SETTLE_MS = 90
"""After this rest a shifted scene is painted anew, so that dashes meet where the strips met."""

_REST_MS = 150
"""After this rest the coarse picture of everything is painted."""

_FRAME_MS, _SLICE_MS = 10.0, 6.0
"""A heavy scene that takes longer than the first is painted in slices of the second."""

_TOO_SMALL = 0.5
"""A picture that is shown smaller than this has lost its fine lines: the coarse one is shown in its stead."""

_PATCHES = 16
"""More places than these are not repainted one by one."""

_SMOOTH_PX = 4e6
"""A widget of more px of the screen shows a scaled picture without smoothing, which takes a quarter of the time."""

_NOTCH = 1.2
_SPARE = 0.45


@dataclass(frozen=True, eq=False)
class FarScene:
    """A coarse picture of everything, kept where painting takes so long that it is worth it.

    Attributes:
        box: the box in mm of everything; None where no coarse picture is needed.
        steps: paints everything coarsely, without its ground, as a view has it; at every pause others may have their
            turn.
    """

    box: Callable[[], Box | None]
    steps: Callable[[QPainter, ViewTransform], Iterator[None]]


@dataclass(frozen=True, eq=False)
class ViewportScene:
    """What a viewport shows, by the functions that paint it.

    Attributes:
        steps: paints what lies in a screen rectangle and stays while only the mouse moves; at every pause others may
            have their turn.
        margins: paints what stands round the drawing. overlay: what follows the mouse.
        ground: paints what a screen rectangle shows until the scene is painted there; None: the palette's base.
        heavy: tells whether so much is in view that painting it may take longer than a frame.
        far: a coarse picture of everything; None: none is ever needed.
        room: returns the part of the area that a box in mm is fitted into; None: all that nothing is laid over.
    """

    steps: Callable[[QPainter, QRectF], Iterator[None]]
    margins: Callable[[QPainter], None]
    overlay: Callable[[QPainter], None]
    ground: Callable[[QPainter, QRectF], None] | None = None
    heavy: Callable[[], bool] = lambda: False
    far: FarScene | None = None
    room: Callable[[Box], QRectF] | None = None


class Viewport(QWidget):
    """Shows a scene; what follows the mouse is painted over it and never repaints it.

    Attributes:
        scene_ms: how long the last painting of the scene took, ms.
        unit: size of the unit that rulers and raster count in, mm.
        covered_right: width at the right that something is laid over, px; what is fitted is fitted beside it.
    """

    view_changed = Signal()

    def __init__(self, scene: ViewportScene, parent: QWidget | None = None) -> None:
        """Show a scene, with 5 px per mm."""
        super().__init__(parent)
        self._shown = scene
        self.view = ViewTransform()
        self.scene_ms, self.unit = 0.0, 1.0
        self._scene: QPixmap | None = None
        self._scene_view, self._outdated = self.view, True
        self._growing: IncrementalPicture | None = None
        self._slices = QTimer(self, singleShot=True, interval=0)
        self._slices.timeout.connect(self._grow)
        self._far = OverviewPicture()
        self._far_rest = QTimer(self, singleShot=True)
        self._far_rest.timeout.connect(self._grow_far)
        self._pan_from: QPointF | None = None
        self._fitted: Box | None = None
        self.covered_right = 0.0
        self._settle = QTimer(self, singleShot=True, interval=_SETTLE_MS)
        self._settle.timeout.connect(self._paint_anew)
        self._glide = QVariantAnimation(self)
        self._glide.setDuration(GLIDE_MS)
        self._glide.setEasingCurve(QEasingCurve.Type.OutCubic)
        self._glide.setStartValue(0.0)
        self._glide.setEndValue(1.0)
        self._glide.valueChanged.connect(self._glide_on)
        self._way = (self.view, self.view)

    @property
    def area(self) -> QRectF:
        """The part of the widget that shows the drawing, beside the rulers."""
        return QRectF(RULER, RULER, max(self.width() - RULER, 1), max(self.height() - RULER, 1))

    @property
    def sharp(self) -> bool:
        """Whether the kept scene is what this view shows."""
        return self._scene is not None and not self._outdated and self._scene_view == self.view

    def set_view(self, view: ViewTransform) -> None:
        """Look at the drawing this way; a shift by whole px keeps what was painted."""
        self._fitted = None
        self._show(view)

    def set_unit(self, unit: float) -> None:
        """Count in another unit, of so many mm."""
        self.unit = unit
        self.repaint_scene()
        self.view_changed.emit()

    @property
    def moved(self) -> bool:
        """Whether something else is looked at than what was fitted."""
        return self._fitted is None

    def fit_to(self, box: Box) -> None:
        """Show a box in mm at once, and again when the size of the widget changes, until the view is moved."""
        self.set_view(fitted(box, self.free_area(box)))
        self._fitted = box

    def widen_fit(self, box: Box) -> None:
        """Fit another box in mm, too, where one is fitted and does not hold it; a view that was moved stays."""
        if self._fitted is not None and (whole := union([self._fitted, box])) != self._fitted:
            self.glide_to_box(whole or box)

    def cover_right(self, width: float) -> None:
        """Tell how wide what is laid over the right is now, px; what was fitted is fitted anew beside it."""
        if width != self.covered_right:
            self.covered_right = width
            if self._fitted is not None:
                self.glide_to_box(self._fitted)

    def free_area(self, box: Box) -> QRectF:
        """Return the part of the area that a box in mm is fitted into: nothing laid over it covers it, unless there is
        no room.
        """
        if self._shown.room is not None:
            return self._shown.room(box)
        covered = self.covered_right if self.covered_right < _SPARE * self.area.width() else 0.0
        return self.area.adjusted(0.0, 0.0, -covered, 0.0)

    def _show(self, view: ViewTransform) -> None:
        self.view = view
        if self._scroll() is not None:
            self._settle.start()
        self.update()
        self.view_changed.emit()

    def repaint_scene(self) -> None:
        """Paint the scene anew when the widget is next shown."""
        self._forget_far()
        self._paint_anew()

    def _paint_anew(self) -> None:
        self._outdated = True
        self._give_up()
        self.update()

    def repaint_places(self, boxes: Sequence[Box] | None, margin: float) -> None:
        """Paint anew what lies in some boxes in mm; everything where they are many or large or None.

        Args:
            margin: how far what is painted reaches beyond its box, px.
        """
        rects = (
            [self._screen_rect(box, margin) for box in boxes] if boxes is not None and len(boxes) <= _PATCHES else None
        )
        large = rects is None or 2 * sum(r.width() * r.height() for r in rects) > self.area.width() * self.area.height()
        if rects is None or large or not self.sharp or not self.devicePixelRatioF().is_integer():
            self.repaint_scene()
            return
        for rect in rects:
            self.paint_more(partial(self._paint_patch, rect))

    def _screen_rect(self, box: Box, margin: float) -> QRectF:
        """Return the whole px that a box in mm and a margin in px cover within the area."""
        a, b = self.view.to_screen((box[0], box[3])), self.view.to_screen((box[2], box[1]))
        left, top = math.floor(a.x() - margin), math.floor(a.y() - margin)
        return QRectF(left, top, math.ceil(b.x() + margin) - left, math.ceil(b.y() + margin) - top).intersected(
            self.area
        )

    def _paint_patch(self, rect: QRectF, painter: QPainter) -> None:
        if not rect.isEmpty():
            painter.setClipRect(rect)
            for _ in self._shown.steps(painter, rect):
                pass

    def zoom_by(self, factor: float, at: QPointF | None = None) -> None:
        """Zoom; the point under `at` (by default the middle) stays where it is."""
        self._glide.stop()
        self.set_view(self.view.zoomed(factor, at or self.area.center()))

    def glide_to(self, view: ViewTransform) -> None:
        """Go to another view in 150 ms; at once while the widget is hidden."""
        self._glide.stop()
        self._fitted = None
        if not self.isVisible():
            self._show(view)
            return
        self._way = (self.view, view)
        self._glide.start()

    def glide_to_box(self, box: Box) -> None:
        """Go to the view that shows a box in mm, as `fit_to` does."""
        self.glide_to(fitted(box, self.free_area(box)))
        self._fitted = box

    def paint_more(self, paint: Callable[[QPainter], None]) -> None:
        """Paint more into the kept scene; nothing where it is to be painted anew anyway."""
        if self._scene is None or not self.sharp:
            return
        self._forget_far()
        painter = QPainter(self._scene)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setClipRect(self.area)
        paint(painter)
        painter.end()
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 (Qt's name)
        """Show the kept scene, or the last one in its place until the new one is painted, and paint over it."""
        if not self.sharp:
            self._sharpen()
        painter = QPainter(self)
        if self._scene is not None and self.sharp:
            painter.drawPixmap(0, 0, self._scene)
        else:
            self._paint_moved(painter)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        self._shown.overlay(painter)
        painter.end()

    def hideEvent(self, event: QHideEvent) -> None:  # noqa: N802 (Qt's name)
        """Paint no more for nobody."""
        self._give_up()
        super().hideEvent(event)

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 (Qt's name)
        """Keep what was fitted fitted, or else the middle of the view in the middle."""
        old = event.oldSize()
        if self._fitted is not None:
            self._glide.stop()
            self.view = fitted(self._fitted, self.free_area(self._fitted))
        elif old.isValid():
            self.view = self.view.panned((self.width() - old.width()) / 2, (self.height() - old.height()) / 2)
        self._paint_anew()
        self.view_changed.emit()

    def wheelEvent(self, event: QWheelEvent) -> None:  # noqa: N802 (Qt's name)
        """Zoom at the mouse."""
        turn = event.angleDelta().y()
        if turn:
            self.zoom_by(_NOTCH ** (turn / 120), event.position())
        event.accept()

    def begin_pan(self, at: QPointF) -> None:
        """Hold the drawing at a screen position."""
        self._glide.stop()
        self._pan_from = at
        self.setCursor(Qt.CursorShape.ClosedHandCursor)

    def pan_to(self, event: QMouseEvent) -> bool:
        """Drag the held drawing along; return whether it is held."""
        if self._pan_from is None:
            return False
        step = event.position() - self._pan_from
        self._pan_from = event.position()
        self.set_view(self.view.panned(step.x(), step.y()))
        return True

    def end_pan(self) -> bool:
        """Let the drawing go; return whether it was held."""
        held = self._pan_from is not None
        self._pan_from = None
        return held

    def _scroll(self) -> QPointF | None:
        """Return by how many whole px the kept scene is to be shifted for the view, or None when that is not enough."""
        shift = QPointF(self.view.ox - self._scene_view.ox, self.view.oy - self._scene_view.oy)
        whole = QPointF(round(shift.x()), round(shift.y()))
        same = self.view.scale == self._scene_view.scale and (shift - whole).manhattanLength() < 1e-6
        kept = self._scene is not None and not self._outdated
        return whole if kept and same and self.devicePixelRatioF().is_integer() else None

    def _sharpen(self) -> None:
        """Begin to paint the scene for this view; a light one, or one that was quickly painted, is done at once."""
        if self._growing is not None and self._growing.view == self.view:
            return
        self._give_up()
        ratio = self.devicePixelRatioF()
        pixmap = QPixmap(round(self.width() * ratio), round(self.height() * ratio))
        pixmap.setDevicePixelRatio(ratio)
        self._growing = IncrementalPicture(pixmap, self.view, partial(self._whole_scene, self._scroll()))
        if self._scene is None or not self._shown.heavy():
            self._grow(math.inf)
        elif self.scene_ms <= _FRAME_MS:
            self._grow(_FRAME_MS)
        else:
            self._slices.start()

    def _grow(self, most_ms: float = _SLICE_MS) -> None:
        """Go on with the new picture; once it is whole it is the kept one."""
        growing = self._growing
        if growing is None:
            return
        if not growing.go_on(most_ms):
            self._slices.start()
            return
        self._scene, self._scene_view, self._outdated, self._growing = growing.pixmap, growing.view, False, None
        self.scene_ms = growing.ms
        if not self._far.whole:
            self._far_rest.start(_REST_MS)
        self.update()

    def _grow_far(self) -> None:
        """Go on with the coarse picture while nothing else is to be painted."""
        far = self._shown.far
        box = far.box() if far is not None else None
        if far is None or box is None or not self.sharp or not self.isVisible():
            return
        self._far.go_on(box, far.steps, _SLICE_MS)
        if not self._far.whole:
            self._far_rest.start(0)

    def _forget_far(self) -> None:
        self._far.forget()
        self._far_rest.start(_REST_MS)

    def _give_up(self) -> None:
        growing, self._growing = self._growing, None
        if growing is not None:
            growing.drop()

    def _whole_scene(self, scroll: QPointF | None, painter: QPainter) -> Iterator[None]:
        """Paint the scene with the kept one shifted where that is enough."""
        if self._scene is not None and scroll is not None:
            painter.drawPixmap(scroll, self._scene)
        for part in [self.area] if scroll is None else _uncovered(self.area, scroll):
            painter.setClipRect(part)
            yield from self._shown.steps(painter, part)
        painter.setClipping(False)
        self._shown.margins(painter)

    def _paint_moved(self, painter: QPainter) -> None:
        """Paint the kept scene where this view would have it, on bare ground, and sharp margins."""
        painter.setClipRect(self.area)
        if self._shown.ground is not None:
            self._shown.ground(painter, self.area)
        else:
            painter.fillRect(self.area, self.palette().base())
        ratio = self.devicePixelRatioF()
        smooth = self.width() * self.height() * ratio * ratio < _SMOOTH_PX
        painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform, smooth)
        if self._scene is not None:
            self._paint_kept(painter, self._scene)
        painter.setClipping(False)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        self._shown.margins(painter)

    def _paint_kept(self, painter: QPainter, scene: QPixmap) -> None:
        """Paint the kept scene where this view would have it, and everything coarsely beside it."""
        grown, old = self.view.scale / self._scene_view.scale, self._scene_view
        where = QTransform(grown, 0, 0, grown, self.view.ox - grown * old.ox, self.view.oy - grown * old.oy)
        size, fine = scene.deviceIndependentSize(), scene.devicePixelRatio()
        kept = QRectF(RULER, RULER, size.width() - RULER, size.height() - RULER)
        small = self._far.whole and grown < _TOO_SMALL
        beside = QRegion(self.area.toRect()) - (QRegion() if small else QRegion(where.mapRect(kept).toRect()))
        if not beside.isEmpty():
            painter.setClipRegion(beside)
            self._far.paint(painter, self.view)
            painter.setClipRect(self.area)
        if small:
            return
        painter.save()
        painter.setTransform(where, True)
        painter.drawPixmap(kept, scene, QRectF(kept.topLeft() * fine, kept.size() * fine))
        painter.restore()

    def _glide_on(self, share: float) -> None:
        self._show(self._way[0].towards(self._way[1], float(share), self.area))


def _uncovered(area: QRectF, scroll: QPointF) -> list[QRectF]:
    """Return the strips of an area that its own picture, shifted, does not cover."""
    strips = []
    kept = area.translated(scroll).intersected(area)
    if kept.isEmpty():
        return [area]
    if scroll.x():
        left = area.left() if scroll.x() > 0 else kept.right()
        strips.append(QRectF(left, area.top(), area.width() - kept.width(), area.height()))
    if scroll.y():
        top = area.top() if scroll.y() > 0 else kept.bottom()
        strips.append(QRectF(area.left(), top, area.width(), area.height() - kept.height()))
    return strips
