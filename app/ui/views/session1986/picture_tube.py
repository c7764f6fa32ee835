"""The picture tube: the terminal's points as phosphor, laid over the whole window; keys and the pointing device."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from PySide6.QtCore import QEvent, QObject, QPointF, QRect, QSize, Qt, QTimer, Signal
from PySide6.QtGui import (
    QColor,
    QFocusEvent,
    QHideEvent,
    QImage,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QShowEvent,
)
from PySide6.QtWidgets import QWidget

from ....core.settings import Phosphor
from ....raster.frame import POINTS
from .dialogue import SessionDialogue
from .questions import SessionQuestion
from .screen import PAGE_LINES, Place

BLINK_MS = 500
GLOW = 0.22
"""How strongly the light of a point spreads to its neighbours."""

_SURROUND, _BEZEL = QColor("#0A0B0C"), QColor("#131517")
_BEZEL_PX = 12
_ARROWS = {Qt.Key.Key_Up: (-1, 0), Qt.Key.Key_Down: (1, 0), Qt.Key.Key_Left: (0, -1), Qt.Key.Key_Right: (0, 1)}
_FAST = 10
_WITH_KEYS = Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.AltModifier
_WRITING = (Qt.KeyboardModifier.NoModifier, _WITH_KEYS)
"""With none of these keys characters are written, or with both, which some keyboards do for @."""


_COLOURS = {Phosphor.GREEN: ("#04120A", "#4DFF91"), Phosphor.AMBER: ("#140B02", "#FFB733")}
"""Colours of a dark and of a lit point."""


class PictureTube(QWidget):
    """Shows a session over everything else in the window, the same in every theme.

    Signals:
        left(): the operator leaves. phosphor_changed(Phosphor): another light was chosen.

    Attributes:
        phosphor: colour of the points.
    """

    left = Signal()
    phosphor_changed = Signal(Phosphor)

    def __init__(self, session: SessionDialogue, over: QWidget, phosphor: Phosphor = Phosphor.GREEN) -> None:
        super().__init__(over)
        self.session, self.phosphor, self._over = session, phosphor, over
        self.setObjectName("session1986")
        self.setAccessibleName("A 1986 session")
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)
        self.setMouseTracking(True)
        self._blink = QTimer(self, interval=BLINK_MS)
        self._blink.timeout.connect(self._turn_cursor)
        session.changed.connect(self.update)
        over.installEventFilter(self)
        self.hide()

    def screen_rect(self) -> QRect:
        """Return where the points are: a whole number of the widget's pixels each, as long as two or more fit."""
        room = min(self.width(), self.height())
        side = POINTS * (room // POINTS) if room >= 2 * POINTS else room
        return QRect((self.width() - side) // 2, (self.height() - side) // 2, side, side)

    def switch_phosphor(self) -> None:
        """Take the other tube."""
        self.phosphor = Phosphor.AMBER if self.phosphor is Phosphor.GREEN else Phosphor.GREEN
        self.phosphor_changed.emit(self.phosphor)
        self.update()

    def showEvent(self, event: QShowEvent) -> None:  # noqa: N802 (Qt's name)
        """Take the whole window and its keys."""
        super().showEvent(event)
        self.setGeometry(self._over.rect())
        self.raise_()
        self.setFocus()
        self._blink.start()

    def hideEvent(self, event: QHideEvent) -> None:  # noqa: N802 (Qt's name)
        """Rest."""
        super().hideEvent(event)
        self._blink.stop()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 (Qt's name)
        """Stay as large as the window."""
        if event.type() == QEvent.Type.Resize and self.isVisible():
            self.setGeometry(self._over.rect())
        return super().eventFilter(watched, event)

    def event(self, event: QEvent) -> bool:
        """Have the window's shortcuts rest while a session is on, except the one that ends the program."""
        if event.type() == QEvent.Type.ShortcutOverride and isinstance(event, QKeyEvent):
            quits = event.key() == Qt.Key.Key_Q and event.modifiers() & Qt.KeyboardModifier.ControlModifier
            event.setAccepted(not quits)
            return True
        return super().event(event)

    def focusOutEvent(self, event: QFocusEvent) -> None:  # noqa: N802 (Qt's name)
        """Take the keys back from what is underneath."""
        super().focusOutEvent(event)
        if self.isVisible() and event.reason() is Qt.FocusReason.OtherFocusReason:
            QTimer.singleShot(0, self, self.setFocus)

    def focusNextPrevChild(self, onwards: bool) -> bool:  # noqa: N802 (Qt's name)
        """Keep Tab: it puts the cross hair."""
        return False

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802 (Qt's name)
        """Everything is done by keys."""
        session, key = self.session, event.key()
        keys: dict[int, Callable[[], object]] = {
            Qt.Key.Key_Escape: self.left.emit,
            Qt.Key.Key_Return: session.enter,
            Qt.Key.Key_Enter: session.enter,
            Qt.Key.Key_Backspace: session.erase,
            Qt.Key.Key_Delete: lambda: session.erase(everything=True),
            Qt.Key.Key_Tab: session.put,
            Qt.Key.Key_F2: self.switch_phosphor,
            Qt.Key.Key_PageUp: lambda: self._scroll(PAGE_LINES // 2),
            Qt.Key.Key_PageDown: lambda: self._scroll(-PAGE_LINES // 2),
        }
        if key in keys:
            keys[key]()
        elif key == Qt.Key.Key_C and event.modifiers() & Qt.KeyboardModifier.ControlModifier:
            session.interrupt()
        elif key in _ARROWS:
            self._arrow(_ARROWS[Qt.Key(key)], bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier))
        elif session.ask in (SessionQuestion.PLAY, SessionQuestion.LIST) and key == Qt.Key.Key_Space:
            session.hold()
        elif event.text().isprintable() and event.modifiers() & _WITH_KEYS in _WRITING:
            session.type(event.text())

    def mouseMoveEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Move the cross hair."""
        self.session.point(self._place(event.position()))
        self.setCursor(Qt.CursorShape.BlankCursor if self.session.screen.hair else Qt.CursorShape.ArrowCursor)

    def mousePressEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Put the cross hair's place into the answer."""
        self.session.point(self._place(event.position()))
        self.session.put()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 (Qt's name)
        """Paint the points, crisp, with a faint glow."""
        painter = QPainter(self)
        painter.fillRect(self.rect(), _SURROUND)
        points, place = self._image(), self.screen_rect()
        painter.fillRect(place.adjusted(-_BEZEL_PX, -_BEZEL_PX, _BEZEL_PX, _BEZEL_PX), _BEZEL)
        if place.width() % POINTS:
            points = points.scaled(QSize(2 * POINTS, 2 * POINTS))
            painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
        painter.drawImage(place, points)
        if place.width() >= 2 * POINTS:
            self._paint_glow(painter, place, points)

    def _paint_glow(self, painter: QPainter, place: QRect, points: QImage) -> None:
        smooth = Qt.TransformationMode.SmoothTransformation
        spread = points.convertToFormat(QImage.Format.Format_RGB32).scaled(POINTS // 3, POINTS // 3, mode=smooth)
        painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
        painter.setCompositionMode(QPainter.CompositionMode.CompositionMode_Plus)
        painter.setOpacity(GLOW)
        painter.drawImage(place, spread)

    def _image(self) -> QImage:
        """Return the points as an image of two colours."""
        bits = np.ascontiguousarray(self.session.screen.bits(), dtype=np.uint8)
        image = QImage(bits.data, POINTS, POINTS, POINTS, QImage.Format.Format_Indexed8).copy()
        image.setColorTable([QColor(name).rgb() for name in _COLOURS[self.phosphor]])
        return image

    def _place(self, at: QPointF) -> Place:
        """Return the point under the pointing device."""
        rect = self.screen_rect()
        scale = rect.width() / POINTS
        return int((at.y() - rect.top()) // scale), int((at.x() - rect.left()) // scale)

    def _arrow(self, way: Place, fast: bool) -> None:
        """Move the cross hair; while steps are shown, go on or back; over a listing, scroll."""
        session, hair = self.session, self.session.screen.hair
        if hair is not None:
            far = _FAST if fast else 1
            session.point((hair[0] + way[0] * far, hair[1] + way[1] * far))
        elif session.ask is SessionQuestion.PLAY:
            session.step(way[1] or way[0])
        else:
            self._scroll(-way[0])

    def _scroll(self, lines: int) -> None:
        if self.session.ask is SessionQuestion.DONE:
            self.session.screen.scroll(lines)
            self.update()

    def _turn_cursor(self) -> None:
        self.session.screen.lit = not self.session.screen.lit
        if self.session.screen.prompt:
            self.update()
