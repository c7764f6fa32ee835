"""What a view is painted on: made when it is first needed, and made anew elsewhere when the screen's OpenGL fails."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QObject, Qt, Signal
from PySide6.QtWidgets import QWidget

from ....core.errors import HitofudeError
from ...framework.boxes import put_away
from .render_scheduler import RenderScheduler
from .surface import GlSurface, ImageSurface, Paint, made_surface

MOST = 2
"""Surfaces that may fail before the view gives up: the screen's own, and one apart from it."""


class SurfaceHost(QObject):
    """Gives a view its surface.

    Signals:
        said(sentence): another surface is used from now on; said once. given_up(sentence): there is none.

    Attributes:
        make: makes a surface of its parent, what paints, and whether it may be one with the screen's OpenGL.
        failure: why nothing can be shown here, or "".
    """

    said = Signal(str)
    given_up = Signal(str)

    def __init__(self, painting: RenderScheduler, widget: QWidget) -> None:
        super().__init__(widget)
        self._painting, self._widget = painting, widget
        self.make: Callable[[QWidget, Paint, bool], GlSurface | ImageSurface] = made_surface
        self._making, self._broken, self.failure = False, 0, ""

    def need(self) -> None:
        """Make the surface, once; where that cannot be, say why.

        A widget with OpenGL in it makes Qt show the whole window anew, which asks for the surface again meanwhile.
        """
        if self._painting.surface is not None or self.failure or self._making:
            return
        self._making = True
        try:
            surface = self.make(self._widget, self._painting.paint, not self._broken)
        except HitofudeError as error:
            self._give_up(str(error))
            return
        finally:
            self._making = False
        self._take(surface)

    def _take(self, surface: GlSurface | ImageSurface) -> None:
        self._painting.surface = surface
        surface.renewed.connect(self._painting.renew)
        surface.broken.connect(self._on_broken, Qt.ConnectionType.QueuedConnection)
        surface.setGeometry(self._widget.rect())
        surface.lower()
        surface.show()

    def _on_broken(self, fault: str) -> None:
        """Go on with a surface apart from the screen's, or say that the cut cannot be shown."""
        old = self._painting.surface
        if old is None:
            return
        self._painting.surface = None
        put_away(old)
        self._broken += 1
        if self._broken >= MOST:
            self._give_up(f"The graphics system fails ({fault}).")
            return
        self.said.emit(
            f"The screen's OpenGL failed ({fault}); the cut is painted apart from it from now on. Nothing is lost."
        )
        self.need()
        self._painting.renew()

    def _give_up(self, why: str) -> None:
        self.failure = f"The cut cannot be shown. {why}"
        self.given_up.emit(self.failure)
