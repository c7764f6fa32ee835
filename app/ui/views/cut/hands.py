"""What mouse and keys do to the cut: turn, shift, zoom, probe, draw a line, pick."""

from __future__ import annotations

from enum import Enum
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QKeyEvent, QMouseEvent

from .camera import StandardView
from .picking import Hit

if TYPE_CHECKING:
    from .cut_view import CutView

KEYS = {
    Qt.Key.Key_1: StandardView.TOP,
    Qt.Key.Key_2: StandardView.FRONT,
    Qt.Key.Key_3: StandardView.RIGHT,
    Qt.Key.Key_4: StandardView.ISOMETRIC,
}
_ARROWS = {Qt.Key.Key_Left: (-1, 0), Qt.Key.Key_Right: (1, 0), Qt.Key.Key_Up: (0, 1), Qt.Key.Key_Down: (0, -1)}
_CLICK_PX, _TURN, _STEP = 4.0, 0.008, np.radians(15.0)


class Drag(Enum):
    """What a held mouse button does."""

    NONE = 0
    ORBIT = 1
    PAN = 2
    PROFILE = 3


class Hands:
    """Follows what the user does to a view."""

    def __init__(self, view: CutView) -> None:
        self._view, self._drag = view, Drag.NONE
        self._pressed, self._last, self._pivot = QPointF(), QPointF(), np.zeros(3)

    def press(self, event: QMouseEvent) -> None:
        """Hold the stock: the left button turns it round the place under the mouse, the middle one shifts it.

        With Ctrl the left button draws a line over the metal instead.
        """
        view = self._view
        self._pressed = self._last = event.position()
        pans = event.button() is not Qt.MouseButton.LeftButton or event.modifiers() & Qt.KeyboardModifier.ShiftModifier
        self._drag = Drag.PAN if pans else Drag.ORBIT
        hit = view.probe(event.position())
        if hit is not None and not pans and event.modifiers() & Qt.KeyboardModifier.ControlModifier:
            self._drag = Drag.PROFILE
        if hit is not None:
            self._pivot = np.array(hit.place)
        elif view.picture is not None:
            self._pivot = (view.picture.low + view.picture.high) / 2

    def move(self, event: QMouseEvent) -> None:
        """Turn or shift what is held; else tell what is under the mouse."""
        view = self._view
        step, self._last = event.position() - self._last, event.position()
        if self._drag is Drag.NONE:
            view.hover(event.position())
        elif (event.position() - self._pressed).manhattanLength() >= _CLICK_PX or not view.overlay.probe:
            view.show_hit(None, event.position())
            if self._drag is Drag.PROFILE:
                self._draw_line(view.probe(event.position()))
            elif self._drag is Drag.ORBIT:
                view.look_now(view.camera.orbited(-step.x() * _TURN, step.y() * _TURN, self._pivot))
            else:
                ratio = view.devicePixelRatioF()
                view.look_now(view.camera.panned(step.x() * ratio, step.y() * ratio))

    def release(self, event: QMouseEvent) -> None:
        """Let go; a click picks the cell."""
        view = self._view
        clicked = self._drag is Drag.ORBIT and (event.position() - self._pressed).manhattanLength() < _CLICK_PX
        self._drag = Drag.NONE
        view.hover(event.position())
        if clicked and view.hit is not None:
            view.cell_picked.emit(*view.hit.place, view.hit.move)

    def key(self, event: QKeyEvent) -> bool:
        """F fits, 1 to 4 are the standard views, arrows turn, Escape ends the profile and unpins; return whether it was
        one of these.
        """
        view, key = self._view, Qt.Key(event.key())
        if event.modifiers() & ~Qt.KeyboardModifier.KeypadModifier:
            return False
        if key == Qt.Key.Key_Escape and view.overlay.line is not None:
            view.show_line(None)
        elif key == Qt.Key.Key_Escape and view.overlay.pin is not None:
            view.overlay.show_pin(None)
        elif key == Qt.Key.Key_F:
            view.fit()
        elif key in KEYS:
            view.stand(KEYS[key])
        elif key in _ARROWS and view.picture is not None:
            yaw, pitch = _ARROWS[key]
            view.glide_to(view.camera.orbited(yaw * _STEP, pitch * _STEP, (view.picture.low + view.picture.high) / 2))
        else:
            return False
        return True

    def _draw_line(self, hit: Hit | None) -> None:
        """Draw a line from where the metal was pressed."""
        x, y, z = (float(value) for value in self._pivot)
        if hit is not None and (x, y) != hit.place[:2]:
            self._view.show_line(((x, y, z), hit.place))
