"""What mouse and keys do to the cut: turn, shift, zoom, probe, draw a line, pick."""

from __future__ import annotations

from enum import Enum

import numpy as np
from PySide6.QtCore import QObject, QPointF, Qt, Signal
from PySide6.QtGui import QKeyEvent, QMouseEvent
from PySide6.QtWidgets import QWidget

from .camera import StandardView
from .cell_picking import PickedCell
from .model import CutModel, middle
from .surface import pixel_size

KEYS = {
    Qt.Key.Key_1: StandardView.TOP,
    Qt.Key.Key_2: StandardView.FRONT,
    Qt.Key.Key_3: StandardView.RIGHT,
    Qt.Key.Key_4: StandardView.ISOMETRIC,
}
_ARROWS = {Qt.Key.Key_Left: (-1, 0), Qt.Key.Key_Right: (1, 0), Qt.Key.Key_Up: (0, 1), Qt.Key.Key_Down: (0, -1)}
_CLICK_PX, _TURN, _STEP = 4.0, 0.008, np.radians(15.0)


class DragKind(Enum):
    """What a held mouse button does."""

    NONE = 0
    ORBIT = 1
    PAN = 2
    PROFILE = 3


class CutInput(QObject):
    """Follows what the user does to a view.

    Signals:
        looked(Camera): from where the cut is to be seen at once. glided(Camera): by and by.
        pointed(place): the mouse is there, px. held(place): the cut is being moved there.
        drew(ends): a line over the metal, its two ends, mm. clicked(): the cell under the mouse.
    """

    looked = Signal(object)
    glided = Signal(object)
    pointed = Signal(QPointF)
    held = Signal(QPointF)
    drew = Signal(object)
    clicked = Signal()

    def __init__(self, model: CutModel, widget: QWidget) -> None:
        super().__init__(widget)
        self._model, self._widget, self._drag = model, widget, DragKind.NONE
        self._pressed, self._last, self._pivot = QPointF(), QPointF(), np.zeros(3)

    def probe(self, at: QPointF) -> PickedCell | None:
        """Return the cell that is seen at a place of the widget, px; None beside the metal."""
        place = at * self._widget.devicePixelRatioF()
        return self._model.probe(place.x(), place.y(), pixel_size(self._widget))

    def press(self, event: QMouseEvent) -> None:
        """Hold the stock: the left button turns it round the place under the mouse, the middle one shifts it.

        With Ctrl the left button draws a line over the metal instead.
        """
        self._pressed = self._last = event.position()
        pans = event.button() is not Qt.MouseButton.LeftButton or event.modifiers() & Qt.KeyboardModifier.ShiftModifier
        self._drag = DragKind.PAN if pans else DragKind.ORBIT
        hit = self.probe(event.position())
        if hit is not None and not pans and event.modifiers() & Qt.KeyboardModifier.ControlModifier:
            self._drag = DragKind.PROFILE
        if hit is not None:
            self._pivot = np.array(hit.place)
        elif self._model.picture is not None:
            self._pivot = middle(self._model.picture)

    def move(self, event: QMouseEvent) -> None:
        """Turn or shift what is held; else tell what is under the mouse."""
        camera, at = self._model.camera, event.position()
        step, self._last = at - self._last, at
        if self._drag is DragKind.NONE:
            self.pointed.emit(at)
        elif (at - self._pressed).manhattanLength() >= _CLICK_PX or self._model.hit is None:
            self.held.emit(at)
            if self._drag is DragKind.PROFILE:
                self._draw_line(self.probe(at))
            elif self._drag is DragKind.ORBIT:
                self.looked.emit(camera.orbited(-step.x() * _TURN, step.y() * _TURN, self._pivot))
            else:
                ratio = self._widget.devicePixelRatioF()
                self.looked.emit(camera.panned(step.x() * ratio, step.y() * ratio))

    def release(self, event: QMouseEvent) -> None:
        """Let go; a click picks the cell."""
        clicked = self._drag is DragKind.ORBIT and (event.position() - self._pressed).manhattanLength() < _CLICK_PX
        self._drag = DragKind.NONE
        self.pointed.emit(event.position())
        if clicked:
            self.clicked.emit()

    def turn(self, event: QKeyEvent) -> bool:
        """Turn by an arrow; return whether it was one."""
        key, picture = Qt.Key(event.key()), self._model.picture
        if key not in _ARROWS or picture is None:
            return False
        yaw, pitch = _ARROWS[key]
        self.glided.emit(self._model.camera.orbited(yaw * _STEP, pitch * _STEP, middle(picture)))
        return True

    def _draw_line(self, hit: PickedCell | None) -> None:
        """Draw a line from where the metal was pressed."""
        x, y, z = (float(value) for value in self._pivot)
        if hit is not None and (x, y) != hit.place[:2]:
            self.drew.emit(((x, y, z), hit.place))
