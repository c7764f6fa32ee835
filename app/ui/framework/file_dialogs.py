"""The toolkit's file dialogs in the program's looks: its own arrows are black, and not to be seen by night."""

from __future__ import annotations

from PySide6.QtGui import QIcon
from PySide6.QtWidgets import QFileDialog, QToolButton

from .icons import icon
from .theme import Theme

_ICONS = {
    "backButton": "left",
    "forwardButton": "right",
    "toParentButton": "folder-up",
    "newFolderButton": "folder-new",
    "listModeButton": "list",
    "detailModeButton": "details",
}
"""Names of the toolkit's buttons, and the icon of each."""

_NOWHERE = ":/no-icon-themes"
"""An empty list of folders stands for the usual ones."""


def search_no_icon_themes() -> None:
    """Have the toolkit take its own pictures of files and folders, once for all, before it makes any dialog.

    It would look for two dozen icons in every folder of the desktop's themes when it makes the first one: 140,000
    files that are not there, 0.1 s in one piece.
    """
    QIcon.setThemeSearchPaths([_NOWHERE])


def dress_file_dialog(dialog: QFileDialog, theme: Theme) -> None:
    """Give the buttons of a file dialog icons in the theme's ink; a dialog of the system has none."""
    for name, drawing in _ICONS.items():
        button = dialog.findChild(QToolButton, name)
        if button is not None:
            button.setIcon(icon(drawing, theme))
