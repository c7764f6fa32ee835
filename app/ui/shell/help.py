"""Help: what this program is."""

from __future__ import annotations

from PySide6.QtWidgets import QMessageBox, QWidget

from ... import __version__

_ABOUT = (
    f"<h3>Hitofude {__version__}</h3><p>From a line drawing to tool paths that can be trusted on a real machine.</p>"
    "<p>Contour and pocket paths after JP H07-107645 (1986), with exact lines and arcs.</p><p>MIT licence.</p>"
)


def show_about(window: QWidget) -> None:
    """Tell name, version, method and licence."""
    _show(window, "About Hitofude", _ABOUT)


def _show(window: QWidget, title: str, text: str) -> None:
    QMessageBox(QMessageBox.Icon.NoIcon, title, text, QMessageBox.StandardButton.Close, window).open()
