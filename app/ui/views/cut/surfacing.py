"""What a view is painted on: made when it is first needed, and made anew elsewhere when the screen's OpenGL fails."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Qt, Signal

from ....core.errors import HitofudeError
from .surface import GlSurface, ImageSurface, made_surface

if TYPE_CHECKING:
    from .cut_view import CutView

MOST = 2
"""Surfaces that may fail before the view gives up: the screen's own, and one apart from it."""


class Surfacing(QObject):
    """Gives a view its surface.

    Signals:
        said(sentence): another surface is used from now on; said once.
    """

    said = Signal(str)

    def __init__(self, view: CutView) -> None:
        super().__init__(view)
        self._view, self._making, self._broken = view, False, 0

    def need(self) -> None:
        """Make the surface, once; where that cannot be, say why.

        A widget with OpenGL in it makes Qt show the whole window anew, which asks for the surface again meanwhile.
        """
        view = self._view
        if view.surface is not None or view.failure or self._making:
            return
        self._making = True
        try:
            surface = made_surface(view, view.painting.paint, own=not self._broken)
        except HitofudeError as error:
            self._give_up(str(error))
            return
        finally:
            self._making = False
        self._take(surface)

    def _take(self, surface: GlSurface | ImageSurface) -> None:
        view = self._view
        view.surface = surface
        surface.renewed.connect(view.painting.renew)
        surface.broken.connect(self._on_broken, Qt.ConnectionType.QueuedConnection)
        surface.setGeometry(view.rect())
        surface.lower()
        surface.show()

    def _on_broken(self, fault: str) -> None:
        """Go on with a surface apart from the screen's, or say that the cut cannot be shown."""
        view, old = self._view, self._view.surface
        if old is None:
            return
        view.surface = None
        old.hide()
        old.deleteLater()
        self._broken += 1
        if self._broken >= MOST:
            self._give_up(f"The graphics system fails ({fault}).")
            return
        self.said.emit(
            f"The screen's OpenGL failed ({fault}); the cut is painted apart from it from now on. Nothing is lost."
        )
        self.need()
        view.painting.renew()

    def _give_up(self, why: str) -> None:
        view = self._view
        view.failure = f"The cut cannot be shown. {why}"
        view.sentence.setText(view.failure)
        view.overlay.hide()
        view.legend.hide()
