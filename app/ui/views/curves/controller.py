"""Smooths the program that the NC view shows, in the background, and does with the answer what is asked."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from pathlib import Path

from PySide6.QtWidgets import QFileDialog

from ....core.atomic import write_atomically
from ....core.errors import HitofudeError
from ....core.progress import Progress
from ...framework.figures import counted
from ...framework.workspace import Workspace
from ..nc.controller import NcController
from ..nc.motion_shapes import ViewSide
from ..nc.painting.motion_layer import MotionLayer
from ..nc.program_reader import FILTER, ShownProgram
from .model import CurveLayers, CurvesModel, layers, smoothed
from .panel import CurvesPanel
from .program_controller import ProgramController
from .view import CurvesView, picture_of


class SmoothingController(ProgramController):
    """Follows the NC view: its program is the one that is smoothed."""

    def __init__(self, view: CurvesView, panel: CurvesPanel, nc: NcController, workspace: Workspace) -> None:
        super().__init__(view, panel, nc, workspace)
        self._view, self._panel, self._preferences = view, panel, workspace.preferences
        self._followed: ShownProgram | None = None
        self._filled, self._seen = False, False
        nc.changed.connect(self._follow)
        self._panel.smooth_requested.connect(self.smooth_or_cancel)
        self._panel.save_requested.connect(self.choose_place)
        self._panel.nc_requested.connect(self.open_in_nc)
        self._view.side_requested.connect(self._draw_side)
        self._view.spotted.connect(self.said)

    def smooth_or_cancel(self) -> None:
        """Smooth the program as the form says; while that is done, leave it."""
        from ....usecases.smoothing.result import SmoothOptions

        shown = self._program_unless_busy()
        if shown is None:
            return
        try:
            options = self._panel.options(SmoothOptions())
        except HitofudeError as error:
            self._panel.show_reason(str(error))
            return
        self._panel.show_reason("")
        self.reading.start(partial(smoothed, shown, options, self._view.side), self._on_smoothed)

    def choose_place(self) -> None:
        """Ask where the new text goes, and write it."""
        curves = self._view.curves
        if curves is None:
            return
        start = str(self._preferences.last_folder / curves.now.source.name)
        name, _ = QFileDialog.getSaveFileName(self._view, "Save smoothed program", start, FILTER)
        if name:
            self.save(Path(name))

    def save(self, path: Path) -> None:
        """Write the new text to a file: whole or not at all."""
        curves = self._view.curves
        if curves is None:
            return
        try:
            write_atomically(path, curves.done.data)
        except HitofudeError as error:
            self.failed.emit(str(error))
            return
        self._log.note(f"save {path.name}", f"{counted(len(curves.now.text), 'line')} written to {path}")
        self.said.emit(f"{path.name} is written.")

    def open_in_nc(self) -> None:
        """Show the new text in the NC view; it is in no file yet."""
        if self._view.curves is not None:
            self._nc.show_text(self._view.curves.now.source)

    def bring_and_smooth(self) -> None:
        """Have the view at the front and smooth, unless that is being done."""
        self.front_requested.emit()
        if not self.reading.worker.busy:
            self.smooth_or_cancel()

    def see(self, seen: bool) -> None:
        """Follow the NC view's program while the view is at the front."""
        self._seen = seen
        if seen:
            self._fill()
            self._follow()

    def _fill(self) -> None:
        """Fill the form, once; what it needs is not loaded before it is seen."""
        if not self._filled:
            from ....gcode.posts import post_titles
            from ....usecases.smoothing.result import SmoothOptions

            self._filled = True
            self._panel.show_options(SmoothOptions(), post_titles())

    def _follow(self) -> None:
        """Show the NC view's program when it is another one; curves of the one before are of no use any more."""
        shown = self._nc.shown
        if not self._seen or (shown is self._followed and shown is not None):
            return
        self.reading.worker.cancel()
        self._followed = shown
        self._panel.show_program(shown.source.name if shown is not None else "")
        self._panel.show_reason("")
        self._panel.show_result(None)
        self._view.show_program(shown)
        self.changed.emit()

    def _on_smoothed(self, curves: CurvesModel) -> None:
        if curves.was is not self._followed:
            return
        self._panel.show_result(curves.done)
        self._view.show_curves(curves)
        self._log.note(f"smooth {curves.was.source.name}", self._panel.title.text())
        self.changed.emit()

    def _draw_side(self, side: ViewSide) -> None:
        """Have the side prepared that is missing; a job on its way ends first, and what it shows asks again."""
        if self._followed is not None and not self.reading.worker.busy:
            self.reading.start(partial(_drawn, self._view.curves, self._followed, side), self._on_drawn)

    def _on_drawn(self, drawn: _DrawnSide) -> None:
        if drawn.curves is not None and isinstance(drawn.picture, CurveLayers):
            drawn.curves.layers[drawn.side] = drawn.picture
        elif isinstance(drawn.picture, MotionLayer):
            drawn.shown.pictures[drawn.side] = drawn.picture
        if drawn.curves is self._view.curves and drawn.shown is self._followed:
            self._view.set_side(self._view.side)


@dataclass(frozen=True, eq=False)
class _DrawnSide:
    """What is seen from a side: of the curves, or of the program where there are none."""

    curves: CurvesModel | None
    shown: ShownProgram
    side: ViewSide
    picture: CurveLayers | MotionLayer


def _drawn(curves: CurvesModel | None, shown: ShownProgram, side: ViewSide, progress: Progress) -> _DrawnSide:
    """Return what is seen from another side."""
    progress.step(0.0, "Preparing the picture")
    picture = picture_of(shown, side) if curves is None else layers(curves, side, progress)
    return _DrawnSide(curves, shown, side, picture)
