"""Help: what this program is."""

from __future__ import annotations

from PySide6.QtWidgets import QMessageBox, QWidget

from ... import __version__

_ABOUT = (
    f"<h3>Hitofude {__version__}</h3><p>From a line drawing to tool paths that can be trusted on a real machine.</p>"
    "<p>Five published methods: contour and pocket paths (JP H07-107645, 1986), the cut before cutting (JP 3571564, "
    "1999), compound surfaces (JP H06-61675), curves from approximate points (JP 4800873), curves with a proven error "
    "(JP 2014-242013).</p><p>MIT licence.</p>"
)


def show_about(window: QWidget) -> None:
    """Tell name, version, method and licence."""
    _show(window, "About Hitofude", _ABOUT)


def _show(window: QWidget, title: str, text: str) -> None:
    QMessageBox(QMessageBox.Icon.NoIcon, title, text, QMessageBox.StandardButton.Close, window).open()
