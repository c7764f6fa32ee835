"""The mouse and the keys of a picture that is looked at: dragging pans, what is not dragged is a click, keys zoom."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QKeyEvent, QMouseEvent, QPainter

from ...framework.theme import Theme
from .painting.grid import paint_ruler_marks
from .viewport import Viewport

_CLICK_PX, _STEP = 4.0, 1.5


@dataclass(frozen=True, eq=False)
class LookingAnswers:
    """What a picture does for the mouse and the keys.

    Attributes:
        hover: looks at what lies under a screen position while nothing is dragged.
        click: picks what lies there.
        fit: shows everything.
        fit_keys: that ask for it.
    """

    hover: Callable[[QPointF], None]
    click: Callable[[QPointF], None]
    fit: Callable[[], None]
    fit_keys: tuple[Qt.Key, ...] = (Qt.Key.Key_F, Qt.Key.Key_Home)


class LookingHand:
    """Holds a viewport's picture, or picks in it.

    Attributes:
        mouse: where it is, px; None outside.
    """

    def __init__(self, viewport: Viewport, answers: LookingAnswers) -> None:
        self._viewport, self._answers = viewport, answers
        self.mouse: QPointF | None = None
        self._pressed: QPointF | None = None
        viewport.setMouseTracking(True)
        viewport.setFocusPolicy(Qt.FocusPolicy.StrongFocus)

    def press(self, event: QMouseEvent) -> None:
        """Hold the picture; what is not dragged is a click."""
        if event.button() is Qt.MouseButton.LeftButton:
            self._pressed = event.position()
        elif event.button() is Qt.MouseButton.MiddleButton:
            self._pressed = None
            self._viewport.begin_pan(event.position())

    def move(self, event: QMouseEvent) -> None:
        """Drag the picture, or look at what lies under the mouse."""
        self.mouse = event.position()
        if self._pressed is not None and (event.position() - self._pressed).manhattanLength() > _CLICK_PX:
            self._viewport.begin_pan(self._pressed)
            self._pressed = None
        if not self._viewport.pan_to(event):
            self._answers.hover(event.position())
        self._viewport.update()

    def release(self, event: QMouseEvent) -> None:
        """Let the picture go, or pick."""
        if self._viewport.end_pan():
            self._viewport.unsetCursor()
        elif self._pressed is not None:
            self._pressed = None
            self._answers.click(event.position())

    def leave(self) -> None:
        """Forget the mouse."""
        self.mouse = None
        self._viewport.update()

    def key(self, event: QKeyEvent) -> bool:
        """Fit, or zoom by + and -; return whether the key asks for one of these."""
        keys: dict[int, Callable[[], None]] = {
            **dict.fromkeys(self._answers.fit_keys, self._answers.fit),
            Qt.Key.Key_Plus: lambda: self._viewport.zoom_by(_STEP),
            Qt.Key.Key_Minus: lambda: self._viewport.zoom_by(1 / _STEP),
        }
        act = keys.get(event.key())
        if act is None or event.modifiers() & Qt.KeyboardModifier.ControlModifier:
            return False
        act()
        return True

    def paint_marks(self, painter: QPainter, theme: Theme) -> None:
        """Mark on the rulers where the mouse is."""
        if self.mouse is not None and self._viewport.area.contains(self.mouse):
            paint_ruler_marks(painter, self.mouse, theme)
