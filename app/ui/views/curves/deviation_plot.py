"""How far curve and moves are apart, along the stretches: with the tolerance and what is proven; a click picks a
place.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QObject, QPointF, Qt, Signal
from PySide6.QtGui import QColor, QMouseEvent
from PySide6.QtWidgets import QWidget

from ...framework.boxes import give_ground, h_box, v_box
from ...framework.catalogue import tr
from ...framework.labels import Elided
from ...framework.plots import dress_axes, quiet_plot
from ...framework.section import heading
from ...framework.theme import LIGHT, Theme
from .deviation_track import DeviationSample, DeviationTrack

if TYPE_CHECKING:
    from pyqtgraph import InfiniteLine, PlotWidget

HEIGHT = 190
_CLICK_PX = 4.0


class DeviationPlot(QWidget):
    """A sheet with the deviation over the length; nothing until there is a track.

    Signals:
        picked(DeviationSample): a place was clicked. hovered(sentence): what is under the mouse, or "".
    """

    picked = Signal(object)
    hovered = Signal(str)

    def __init__(self) -> None:
        super().__init__()
        give_ground(self, "ncBar")
        self._theme = LIGHT
        self._plot: PlotWidget | None = None
        self._cursor: InfiniteLine | None = None
        self._pressed: QPointF | None = None
        self.track: DeviationTrack | None = None
        self.spot: DeviationSample | None = None
        self._tolerance = 0.0
        self.figures = Elided(role="muted")
        head = h_box(spacing=12)
        head.addWidget(heading("Deviation"))
        head.addWidget(self.figures, 1)
        self._column = v_box(self, (12, 8, 12, 8), 4)
        self._column.addLayout(head)
        self.setFixedHeight(HEIGHT)
        self.hide()

    @property
    def plot(self) -> PlotWidget | None:
        """The plot; None until something was shown."""
        return self._plot

    def show_track(self, track: DeviationTrack | None, tolerance: float) -> None:
        """Show another track, or none.

        Args:
            track: the samples. tolerance: that was asked for, mm.
        """
        self.track, self.spot, self._tolerance = track, None, tolerance
        self.setVisible(track is not None and len(track.bounds) > 0)
        if track is None or not track.bounds:
            return
        if self._plot is None:
            self._plot = self._made_plot()
            self._column.addWidget(self._plot, 1)
        self._draw(self._plot, track)
        self._plot.setXRange(0.0, track.bounds[-1][1], padding=0.01)
        self._plot.setYRange(0.0, 1.12 * tolerance, padding=0.0)
        self._say()

    def show_spot(self, spot: DeviationSample | None) -> None:
        """Mark a place."""
        self.spot = spot
        if self._cursor is not None:
            self._cursor.setVisible(spot is not None)
            self._cursor.setValue(spot.along if spot is not None else 0.0)
        self._say()

    def set_theme(self, theme: Theme) -> None:
        """Follow the theme."""
        self._theme = theme
        if self._plot is not None and self.track is not None:
            self._draw(self._plot, self.track)

    def _say(self) -> None:
        spot = self.spot or (self.track.farthest() if self.track is not None else None)
        if spot is not None:
            self.figures.setText(f"{'' if self.spot is not None else 'Largest: '}{deviation_text(spot)}")

    def _made_plot(self) -> PlotWidget:
        plot = quiet_plot("Deviation along the path")
        plot.setMouseEnabled(x=True, y=False)
        plot.viewport().setMouseTracking(True)
        plot.viewport().installEventFilter(self)
        return plot

    def _draw(self, plot: PlotWidget, track: DeviationTrack) -> None:
        from pyqtgraph import InfiniteLine, mkPen

        theme = self._theme
        plot.clear()
        plot.setBackground(theme.paper)
        dress_axes(plot, theme)
        for name, words in (("bottom", "mm along the stretches"), ("left", "mm apart")):
            # mm whatever the height
            plot.getAxis(name).setLabel(tr(words), siPrefixEnableRanges=(), color=theme.muted.name())
        fill = QColor(theme.muted)
        fill.setAlphaF(0.16)
        drawn = plot.plot(
            track.along, track.off, connect="finite", fillLevel=0.0, brush=fill, pen=mkPen(theme.muted, width=1)
        )
        drawn.setDownsampling(auto=True, method="peak")
        drawn.setClipToView(True)
        ends, heights = (
            [x for low, high, _ in track.bounds for x in (low, high)],
            [y for *_, y in track.bounds for _ in range(2)],
        )
        plot.plot(ends, heights, connect="pairs", pen=mkPen(theme.accent_text, width=1.5))
        plot.addItem(InfiniteLine(self._tolerance, 0, pen=mkPen(theme.error, width=1, style=Qt.PenStyle.DashLine)))
        self._cursor = InfiniteLine(0.0, 90, pen=mkPen(theme.ink, width=1))
        plot.addItem(self._cursor)
        self.show_spot(self.spot)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 (Qt's name)
        """A click picks the nearest place; what is dragged is the plot's own."""
        if isinstance(event, QMouseEvent):
            if event.type() == QEvent.Type.MouseButtonPress:
                self._pressed = event.position() if event.button() is Qt.MouseButton.LeftButton else None
            elif event.type() == QEvent.Type.MouseMove:
                spot = self._at(event.position())
                self.hovered.emit(deviation_text(spot) if spot is not None else "")
            elif event.type() == QEvent.Type.MouseButtonRelease and self._pressed is not None:
                spot = (
                    self._at(event.position())
                    if (event.position() - self._pressed).manhattanLength() <= _CLICK_PX
                    else None
                )
                self._pressed = None
                if spot is not None:
                    self.picked.emit(spot)
        elif event.type() == QEvent.Type.Leave:
            self.hovered.emit("")
        return super().eventFilter(watched, event)

    def _at(self, position: QPointF) -> DeviationSample | None:
        """Return the sample under a place of the plot, px."""
        if self._plot is None or self.track is None:
            return None
        box = self._plot.getPlotItem().getViewBox()
        if not box.sceneBoundingRect().contains(position):
            return None
        return self.track.near(float(box.mapSceneToView(position).x()))


def deviation_text(spot: DeviationSample) -> str:
    """Return what there is to say about a place."""
    x, y, z = spot.place
    return f"{spot.off:.4f} mm apart · line {spot.line} · X {x:.3f} Y {y:.3f} Z {z:.3f} · at {spot.along:.2f} mm"
