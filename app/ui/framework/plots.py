"""What plots have in common: the library's own menus left out, and axes in the theme's inks."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from PySide6.QtCore import Qt

from .theme import Theme, text_font

if TYPE_CHECKING:
    from pyqtgraph import PlotWidget


def quiet_plot(name: str = "", **options: Any) -> PlotWidget:
    """Return a plot without menus and buttons that leaves the keyboard alone.

    Args:
        name: for whoever has it read aloud. options: of pyqtgraph's widget.
    """
    from pyqtgraph import PlotWidget  # heavy; a window is mostly used without

    plot = PlotWidget(**options)
    plot.setMenuEnabled(False)
    plot.hideButtons()
    plot.setFocusPolicy(Qt.FocusPolicy.NoFocus)
    plot.setAccessibleName(name)
    return plot


def dress_axes(plot: PlotWidget, theme: Theme) -> None:
    """Draw the lower and the left axis in the inks of a theme."""
    from pyqtgraph import mkPen

    for name in ("bottom", "left"):
        axis = plot.getAxis(name)
        axis.setPen(mkPen(theme.hairline))
        axis.setTextPen(mkPen(theme.muted))
        axis.setStyle(tickFont=text_font())
