"""Keeps what the Cut view shows as a picture file."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QBuffer, QIODevice
from PySide6.QtWidgets import QFileDialog

from ....core.atomic import write_atomically
from ....core.errors import HitofudeError
from ...framework.controller import Controller
from ...framework.workspace import Workspace
from .view import CutView

_FILTER = "Pictures (*.png)"
_NO_CUT = "There is no cut to take a picture of; press F5, then open the Cut view."


class ImageController(Controller):
    """Asks where to, and writes."""

    def __init__(self, view: CutView, workspace: Workspace) -> None:
        super().__init__(view)
        self._view, self._preferences, self._log = view, workspace.preferences, workspace.log

    def choose(self) -> None:
        """Ask for a file and write the picture to it."""
        if self._view.render_scheduler.surface is None or not self._view.isVisible():
            self.failed.emit(_NO_CUT)
            return
        start = str(self._preferences.last_folder / "cut.png")
        name, _ = QFileDialog.getSaveFileName(self._view, "Save picture of the cut", start, _FILTER)
        if name:
            self.save(Path(name))

    def save(self, path: Path) -> None:
        """Write what is shown, legend included, as PNG: whole or not at all. A name without an ending gets ".png"."""
        path = path if path.suffix else path.with_suffix(".png")
        buffer = QBuffer()
        buffer.open(QIODevice.OpenModeFlag.WriteOnly)
        picture = self._view.grab()
        picture.save(buffer, "PNG")
        try:
            write_atomically(path, bytes(buffer.data().data()))
        except HitofudeError as error:
            self.failed.emit(str(error))
            return
        self._log.note(f"save {path.name}", f"{picture.width()} by {picture.height()} px written to {path}")
