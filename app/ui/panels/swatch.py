"""The colour of a layer: a swatch, and the colours that a click on it offers."""

from __future__ import annotations

import re

from PySide6.QtCore import QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QFrame, QGridLayout, QLineEdit, QToolButton, QWidget

from ..framework.labels import restyle
from ..framework.theme import Theme
from ..framework.themed import Themed

HUES = {
    "": "ink",
    "#e69f00": "orange",
    "#56b4e9": "sky blue",
    "#009e73": "green",
    "#f0e442": "yellow",
    "#0072b2": "blue",
    "#d55e00": "vermilion",
    "#cc79a7": "purple",
    "#8a8f98": "grey",
}
"""Okabe and Ito's colours, which colour-blind eyes tell apart; "" is the theme's ink."""

HARD_TO_SEE = ("#f0e442",)
"""Of them what is too pale for a line on white: it can be chosen, but no new layer gets it."""

_COLUMNS = 5
_COLOUR = re.compile(r"#?([0-9a-fA-F]{6})")


class LayerColourButton(Themed, QToolButton):
    """Shows a colour; a click offers others.

    Signals:
        chosen(colour): "#rrggbb", or "" for ink.
    """

    chosen = Signal(str)

    def __init__(self, layer: str) -> None:
        super().__init__()
        self._layer, self.colour = layer, ""
        self.setFixedSize(24, 24)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.clicked.connect(self.offer)

    def show_colour(self, colour: str) -> None:
        """Show "#rrggbb", or the ink for ""."""
        self.colour = colour
        name = HUES.get(colour, colour)
        self.setToolTip(f"Colour: {name}")
        self.setAccessibleName(f"Colour of layer {self._layer}: {name}")
        self.update()

    def offer(self) -> None:
        """Show the colours below the swatch."""
        palette = ColourPalette(self.colour, self._theme, self)
        palette.chosen.connect(self.chosen)
        palette.move(self.mapToGlobal(self.rect().bottomLeft()))
        palette.show()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 (Qt's name)
        """Draw the colour on what the style draws for hover and focus."""
        super().paintEvent(event)
        painter = QPainter(self)
        paint_colour(painter, QRectF(6.5, 6.5, 11, 11), self.colour, self._theme)


def paint_colour(painter: QPainter, place: QRectF, colour: str, theme: Theme) -> None:
    """Draw a colour as a rounded square with an edge that sets it off the paper."""
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.setPen(QPen(theme.muted, 1))
    painter.setBrush(QColor(colour) if colour else theme.ink)
    painter.drawRoundedRect(place, 3, 3)


class ColourPalette(QFrame):
    """Colours to choose from, and a line for any other.

    Signals:
        chosen(colour): "#rrggbb", or "" for ink.
    """

    chosen = Signal(str)

    def __init__(self, colour: str, theme: Theme, parent: QWidget) -> None:
        super().__init__(parent, Qt.WindowType.Popup)
        self.setObjectName("findings")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.hues: dict[str, ColourButton] = {}
        grid = QGridLayout(self)
        grid.setContentsMargins(8, 8, 8, 8)
        grid.setSpacing(4)
        for at, (value, name) in enumerate(HUES.items()):
            hue = self.hues[value] = ColourButton(value, name, theme)
            hue.clicked.connect(lambda _=False, v=value: self._choose(v))
            grid.addWidget(hue, at // _COLUMNS, at % _COLUMNS)
        self.other = QLineEdit(colour)
        self.other.setPlaceholderText("#rrggbb")
        self.other.setMaxLength(7)
        self.other.setAccessibleName("Another colour, #rrggbb")
        self.other.returnPressed.connect(self._take_other)
        grid.addWidget(self.other, 2, 0, 1, _COLUMNS)
        self.hues.get(colour, self.hues[""]).setFocus()

    def _take_other(self) -> None:
        match = _COLOUR.fullmatch(self.other.text().strip())
        if match:
            self._choose(f"#{match[1].lower()}")
        else:
            self.other.setProperty("wrong", "true")
            self.other.setToolTip("A colour is # and six digits 0-9, a-f, such as #d55e00.")
            restyle(self.other)

    def _choose(self, colour: str) -> None:
        self.close()
        self.chosen.emit(colour)


class ColourButton(QToolButton):
    """One colour of the palette."""

    def __init__(self, colour: str, name: str, theme: Theme) -> None:
        super().__init__()
        self._colour, self._theme = colour, theme
        self.setToolTip(name.capitalize())
        self.setAccessibleName(name)
        self.setFixedSize(QSize(28, 28))

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 (Qt's name)
        """Draw the colour on what the style draws for hover and focus."""
        super().paintEvent(event)
        paint_colour(QPainter(self), QRectF(5.5, 5.5, 17, 17), self._colour, self._theme)
