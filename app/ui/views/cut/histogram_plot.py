"""The histogram of the deviation: bars in the colours that the metal has, the tolerance marked, areas in mm²."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import Qt, QTimer
from PySide6.QtGui import QBrush, QColor, QShowEvent
from PySide6.QtWidgets import QWidget

from ...framework.boxes import v_box
from ...framework.figures import grouped
from ...framework.labels import muted
from ...framework.plots import dress_axes, quiet_plot
from ...framework.theme import LIGHT, Theme
from .cell_colours import STEPS, ColourKey
from .histogram import Histogram

if TYPE_CHECKING:
    from pyqtgraph import PlotWidget

HEIGHT = 184
_LEAST_MM2 = 1e-3


class HistogramPlot(QWidget):
    """Areas over the scale of the deviation; they differ by powers of ten, and so does the height of the bars."""

    def __init__(self) -> None:
        super().__init__()
        self._theme = LIGHT
        self._plot: PlotWidget | None = None
        self.shown: Histogram | None = None
        self._key: ColourKey | None = None
        self._drawn = True
        self.sums = muted()
        self.sums.setTextFormat(Qt.TextFormat.RichText)
        self.sums.setWordWrap(True)
        self._column = v_box(self, spacing=4)
        self._column.addWidget(self.sums)
        self.setFixedHeight(HEIGHT)

    def show_histogram(self, histogram: Histogram, key: ColourKey) -> None:
        """Show other areas: the plot once it is seen, since making it holds the window up.

        Args:
            histogram: the areas. key: of the deviation's colours.
        """
        self.shown, self._key = histogram, key
        self.sums.setText(self._sums(histogram))
        if self.isVisible():
            self._draw_now()
        else:
            self._drawn = False

    def showEvent(self, event: QShowEvent) -> None:  # noqa: N802 (Qt's name)
        """Draw what was told meanwhile, after what is around it."""
        super().showEvent(event)
        if not self._drawn:
            QTimer.singleShot(0, self, self._draw_now)

    def _draw_now(self) -> None:
        if self.shown is None or self._key is None:
            return
        self._drawn = True
        if self._plot is None:
            self._plot = self._made_plot()
            self._column.addWidget(self._plot, 1)
        self._draw(self._plot, self.shown, self._key)

    def set_theme(self, theme: Theme) -> None:
        """Follow the theme; the colours of the bars come with the next key."""
        self._theme = theme
        if self.shown is not None:
            self.sums.setText(self._sums(self.shown))
        if self._plot is not None:
            self._draw_now()

    def _made_plot(self) -> PlotWidget:
        plot = quiet_plot("Histogram of the deviation")
        plot.setMouseEnabled(x=False, y=False)
        return plot

    def _draw(self, plot: PlotWidget, histogram: Histogram, key: ColourKey) -> None:
        from pyqtgraph import BarGraphItem, LinearRegionItem, mkPen

        plot.clear()
        self._dress(plot, key)
        logs = np.log10(np.maximum(histogram.areas, _LEAST_MM2) / _LEAST_MM2)
        middles = (histogram.borders[:-1] + histogram.borders[1:]) / 2
        inks = [QColor(*key.palette[min(int(at * STEPS), STEPS - 1), :3].tolist()) for at in middles]
        band = LinearRegionItem(
            _band_of(histogram), movable=False, brush=QBrush(self._theme.hover), pen=mkPen(self._theme.hairline)
        )
        band.setZValue(-10)
        plot.addItem(band)
        plot.addItem(
            BarGraphItem(
                x0=histogram.borders[:-1], x1=histogram.borders[1:], height=logs, brushes=inks, pen=mkPen(None)
            )
        )
        plot.setXRange(0.0, 1.0, padding=0.12)
        plot.setYRange(0.0, max(float(logs.max()), 1.0), padding=0.04)

    def _dress(self, plot: PlotWidget, key: ColourKey) -> None:
        plot.setBackground(self._theme.paper)
        dress_axes(plot, self._theme)
        bottom, left = plot.getAxis("bottom"), plot.getAxis("left")
        for axis in (bottom, left):
            axis.setStyle(tickLength=3)
        bottom.setTicks([[(tick.at, tick.text) for tick in key.ticks[::2]]])
        left.setTicks([[(power + 3, f"{10.0**power:g}") for power in range(-3, 7, 2)]])
        left.setLabel("mm²", color=self._theme.muted.name())

    def _sums(self, histogram: Histogram) -> str:
        theme = self._theme
        deep = theme.error if histogram.gouge >= 5e-3 else theme.muted  # red once the figure shows it
        parts = [
            (deep, histogram.gouge, "too deep"),
            (theme.muted, histogram.right, f"within ± {histogram.tolerance:.3f}"),
            (theme.left, histogram.left, "left"),
        ]
        parts += [(theme.muted, histogram.beyond, "out of reach")] if histogram.beyond else []
        return (
            " · ".join(
                f"<span style='color:{ink.name()}'>{grouped(area, 2 if area < 100 else 0)} {words}</span>"
                for ink, area, words in parts
            )
            + " mm²"
        )


def _band_of(histogram: Histogram) -> tuple[float, float]:
    """Return the bar of what is within tolerance: the widest one round the middle."""
    k = int(np.searchsorted(histogram.borders, 0.5)) - 1
    return float(histogram.borders[k]), float(histogram.borders[k + 1])
