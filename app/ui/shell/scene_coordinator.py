"""What the Surfaces view has the window show: a scene's program, its cut, what is asked before the window closes."""

from __future__ import annotations

from functools import partial

from PySide6.QtCore import QObject

from ..framework.commands import on_trigger
from ..framework.view import View
from ..views.cut.controller import CutController
from ..views.nc.controller import NcController
from ..views.surfaces.controller import SAMPLES, SceneController, SceneProgram
from .display_controller import DisplayController
from .main_window import MainWindow


class SceneCoordinator(QObject):
    """Connects the scene's controller with the window and with the views that show its program."""

    def __init__(
        self,
        window: MainWindow,
        display: DisplayController,
        scenes: SceneController,
        nc: NcController,
        cuts: CutController,
    ) -> None:
        super().__init__(window)
        self._window, self._display, self._scenes, self._cuts = window, display, scenes, cuts
        actions = window.actions_
        on_trigger(actions, "scene_new", scenes.new)
        for name in SAMPLES:
            on_trigger(actions, f"scene_{name}", partial(scenes.open_sample, name))
        on_trigger(actions, "scene_nc", scenes.show_nc)
        on_trigger(actions, "scene_cut", scenes.show_cut)
        scenes.nc_requested.connect(nc.show_text)
        scenes.cut_requested.connect(self._show_cut)
        scenes.document.standing_changed.connect(display.show_titles)
        scenes.close_requested.connect(window.close)
        window.closing.connect(self._ask)
        view = window.views.surfaces
        view.hovered.connect(display.show_hovered)
        view.cursor_moved.connect(window.status.show_place)

    @property
    def at_front(self) -> bool:
        """Whether the scene is worked on rather than the drawing."""
        return self._display.view is View.SURFACES and self._window.scene.open

    def _ask(self) -> None:
        """Keep the window open while the scene's changes are asked about; those of the drawing come first."""
        self._window.may_close = self._window.may_close and self._scenes.may_close()

    def _show_cut(self, program: SceneProgram) -> None:
        """Show what a scene's program leaves of its stock, beside the scene's surfaces."""
        self._display.show_view(View.CUT)
        self._cuts.show_program(program.source, program.dialect, program.part)
