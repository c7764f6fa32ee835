"""Opens scenes: computed in the background, then shown in the Surfaces view."""

from __future__ import annotations

from functools import partial
from pathlib import Path

from PySide6.QtCore import QObject, Signal

from app.ui.log import Log
from app.ui.main_window import MainWindow
from app.ui.nc.reading import Reading
from app.ui.showing import Showing
from app.ui.surfaces.shown_scene import ShownScene, read_shown_scene
from app.ui.views import View


class SceneOpening(QObject):
    """Computes one scene at a time; the drawing and what is known of it stay as they are.

    Signals:
        failed(sentence).
    """

    failed = Signal(str)

    def __init__(self, window: MainWindow, showing: Showing, log: Log) -> None:
        super().__init__(window)
        self._window, self._showing, self._log = window, showing, log
        self.reading = Reading(self)
        self.reading.failed.connect(self.failed)
        self.reading.progress.connect(window.status.show_progress)
        self.reading.busy_changed.connect(self._on_busy)
        window.status.cancelled.connect(self.reading.worker.cancel)
        window.actions_["cancel"].triggered.connect(lambda *_: self.reading.worker.cancel())
        window.closed.connect(self.reading.worker.finish)

    def open(self, path: Path) -> None:
        """Compute a scene and show it; the one before stays until then."""
        self._showing.show_view(View.SURFACES)
        self.reading.start(partial(read_shown_scene, path), self._on_computed)

    def again(self) -> None:
        """Read and compute the scene that is shown once more."""
        shown = self._window.views.surfaces.shown
        if shown is not None:
            self.open(shown.path)

    def _on_computed(self, shown: ShownScene) -> None:
        window = self._window
        window.settings = window.settings.with_recent_file(shown.path)
        window.views.surfaces.show_scene(shown)
        self._log.note(f"open {shown.path.name}", window.views.surfaces.summary)
        self._showing.show_view(View.SURFACES)

    def _on_busy(self, busy: bool) -> None:
        self._window.views.surfaces.computing = busy
        self._showing.show_missing()
        self._window.actions_["cancel"].setEnabled(busy or self._window.worker.busy)
        if busy or not self._window.worker.busy:
            self._window.status.show_progress(0.0 if busy else None)
