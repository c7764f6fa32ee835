"""Icons: one SVG each in `resources/icons`, drawn in the colour that the theme asks for."""

from __future__ import annotations

from functools import cache

from PySide6.QtCore import QByteArray, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QIcon, QPainter, QPixmap
from PySide6.QtSvg import QSvgRenderer
from PySide6.QtWidgets import QLabel, QToolButton, QWidget

from ...core.resources import resource
from .theme import LIGHT, Theme

SIZE = 20
_SCALES = (1, 2, 3)


@cache
def _drawing(name: str) -> bytes:
    return resource("icons", f"{name}.svg").read_bytes()


def pixmap(name: str, colour: QColor, scale: int = 1) -> QPixmap:
    """Return an icon as a picture of 20 x 20 px times `scale`; each is drawn once, as a window shows some of them many
    times.
    """
    return _pixmap(name, colour.name(), scale)


@cache
def _pixmap(name: str, colour: str, scale: int) -> QPixmap:
    data = _drawing(name).replace(b"currentColor", colour.encode())
    picture = QPixmap(SIZE * scale, SIZE * scale)
    picture.fill(Qt.GlobalColor.transparent)
    painter = QPainter(picture)
    QSvgRenderer(QByteArray(data)).render(painter, QRectF(0, 0, SIZE * scale, SIZE * scale))
    painter.end()
    picture.setDevicePixelRatio(scale)
    return picture


def icon(name: str, theme: Theme, colour: QColor | None = None) -> QIcon:
    """Return an icon in ink (or another colour), green when it is checked, faint when it is disabled."""
    made = QIcon()
    for scale in _SCALES:
        made.addPixmap(pixmap(name, colour or theme.ink, scale), QIcon.Mode.Normal, QIcon.State.Off)
        made.addPixmap(pixmap(name, colour or theme.accent_text, scale), QIcon.Mode.Normal, QIcon.State.On)
        made.addPixmap(_faded(name, theme.muted.name(), scale), QIcon.Mode.Disabled, QIcon.State.Off)
    return made


@cache
def _faded(name: str, colour: str, scale: int) -> QPixmap:
    picture = _pixmap(name, colour, scale)
    out = QPixmap(picture.size())
    out.setDevicePixelRatio(picture.devicePixelRatio())
    out.fill(Qt.GlobalColor.transparent)
    painter = QPainter(out)
    painter.setOpacity(0.45)
    painter.drawPixmap(0, 0, picture)
    painter.end()
    return out


class IconLabel(QLabel):
    """An icon of 16 px that follows the theme and does nothing; `name` says which."""

    def __init__(self, name: str) -> None:
        super().__init__()
        self.name = name
        self.setFixedSize(16, 16)
        self.setScaledContents(True)

    def set_theme(self, theme: Theme) -> None:
        """Draw the icon in the theme's ink."""
        self.setPixmap(pixmap(self.name, theme.ink, 3))


class IconButton(QToolButton):
    """A flat button with an icon that follows the theme."""

    def __init__(self, name: str, tip: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._name, self._theme = name, LIGHT
        self.setToolTip(tip)
        self.setAccessibleName(tip)
        self.setAutoRaise(True)
        self.setIconSize(QSize(16, 16))
        self.setFixedSize(24, 24)
        self.setCursor(Qt.CursorShape.PointingHandCursor)

    def set_theme(self, theme: Theme) -> None:
        """Draw the icon in the theme's ink."""
        self._theme = theme
        self.setIcon(icon(self._name, theme))

    def show_icon(self, name: str, tip: str) -> None:
        """Take another icon."""
        self._name = name
        self.setToolTip(tip)
        self.setAccessibleName(tip)
        self.set_theme(self._theme)
