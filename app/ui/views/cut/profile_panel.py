"""Below the cut: the heights along the line that was drawn over it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import Signal
from PySide6.QtGui import QColor, QPainter, QPaintEvent
from PySide6.QtWidgets import QFrame, QWidget

from ...framework.boxes import h_box, v_box
from ...framework.icons import IconButton
from ...framework.labels import muted
from ...framework.plots import dress_axes, quiet_plot
from ...framework.section import heading
from ...framework.theme import LIGHT, Theme
from .height_profile import HeightProfile
from .overlay_text import number

if TYPE_CHECKING:
    from pyqtgraph import PlotWidget

HEIGHT = 196


class ProfilePanel(QFrame):
    """A sheet with the heights over the distance.

    Signals:
        closed(): the user has seen enough.
    """

    closed = Signal()

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self._theme = LIGHT
        self._profile: HeightProfile | None = None
        self._plot: PlotWidget | None = None
        self.figures = muted()
        close = IconButton("cancel", "Close the profile (Esc)", self)
        close.clicked.connect(self.closed)
        head = h_box(spacing=12)
        head.addWidget(heading("Profile"))
        head.addWidget(self.figures, 1)
        head.addWidget(close)
        self._column = v_box(self, (12, 8, 12, 8), 4)
        self._column.addLayout(head)
        self.hide()

    def show_profile(self, profile: HeightProfile) -> None:
        """Show the heights along another line."""
        self._profile = profile
        low, high = float(profile.heights.min()), float(profile.heights.max())
        self.figures.setText(f"{number(float(profile.borders[-1]))} mm long · Z {number(low)} to {number(high)}")
        if self._plot is None:
            self._plot = quiet_plot(background=None)
            self._column.addWidget(self._plot, 1)
        self._draw(self._plot, profile)
        self.show()

    @property
    def drawn(self) -> HeightProfile | None:
        """What is shown; None = nothing."""
        return self._profile if self.isVisible() else None

    def set_theme(self, theme: Theme) -> None:
        """Follow the theme."""
        self._theme = theme
        if self._plot is not None and self._profile is not None:
            self._draw(self._plot, self._profile)
        self.update()

    def _draw(self, plot: PlotWidget, profile: HeightProfile) -> None:
        from pyqtgraph import mkPen

        theme = self._theme
        plot.clear()
        dress_axes(plot, theme)
        for name, words in (("bottom", "mm along the line"), ("left", "Z mm")):
            axis = plot.getAxis(name)
            axis.enableAutoSIPrefix(False)
            axis.setLabel(words, color=theme.muted.name())
        fill = QColor(theme.muted)
        fill.setAlphaF(0.18)
        floor = float(profile.heights.min()) - 0.05 * max(float(profile.heights.max() - profile.heights.min()), 0.01)
        plot.plot(
            profile.borders,
            profile.heights,
            stepMode="center",
            fillLevel=floor,
            brush=fill,
            pen=mkPen(theme.accent_text, width=1.5),
        )
        plot.autoRange(padding=0.03)

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 (Qt's name)
        """Paint the sheet."""
        ground = QColor(self._theme.canvas)
        ground.setAlphaF(0.95)
        painter = QPainter(self)
        painter.fillRect(self.rect(), ground)
        painter.fillRect(0, 0, self.width(), 1, self._theme.hairline)
