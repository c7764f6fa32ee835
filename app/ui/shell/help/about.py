"""Help: what this program is, and whose work is inside."""

from __future__ import annotations

from html import escape

from PySide6.QtWidgets import QMessageBox, QWidget

from .... import __version__
from ....core.licences import installed_licences
from ...framework.catalogue import tr

_ABOUT = (
    "From a line drawing to tool paths that can be trusted on a real machine.",
    "Five published methods: contour and pocket paths (JP H07-107645, 1986), the cut before cutting (JP 3571564, "
    "1999), compound surfaces (JP H06-61675), curves from approximate points (JP 4800873), curves with a proven error "
    "(JP 2014-242013).",
    "MIT licence.",
)
"""Paragraphs, looked up one by one: the box shows them as one text."""


def show_about(window: QWidget) -> None:
    """Tell name, version, method and licence, and on a button the licences of what is inside."""
    text = "".join(f"<p>{tr(paragraph)}</p>" for paragraph in _ABOUT)
    box = _shown(window, "About Hitofude", f"<h3>Hitofude {__version__}</h3>{text}")
    licences = box.addButton("Licences…", QMessageBox.ButtonRole.ActionRole)
    licences.clicked.connect(lambda: show_licences(window))
    box.open()


def show_licences(window: QWidget) -> None:
    """Tell every package that the program runs with here, and its licence; their texts unfold."""
    packages = installed_licences()
    rows = "".join(
        f"<tr><td>{escape(each.name)} {escape(each.version)}&nbsp;&nbsp;</td><td>{escape(each.licence)}</td></tr>"
        for each in packages
    )
    box = _shown(window, "Licences", f"<h3>{tr('What is inside')}</h3><table>{rows}</table>")
    texts = [f"{each.name}: {name}\n\n{text}" for each in packages for name, text in each.files.items()]
    box.setDetailedText("\n\n".join(texts))
    box.open()


def _shown(window: QWidget, title: str, text: str) -> QMessageBox:
    return QMessageBox(QMessageBox.Icon.NoIcon, title, text, QMessageBox.StandardButton.Close, window)
