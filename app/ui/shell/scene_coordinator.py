"""What the Surfaces view has the window show: a scene's program, its cut, what is asked before the window closes."""

from __future__ import annotations

from functools import partial

from PySide6.QtCore import QObject

from ..framework.commands import on_trigger
from ..framework.view import View
from ..views.cut.controller import CutController
from ..views.nc.controller import NcController
from ..views.nc.program_reader import ProgramSource
from ..views.surfaces.controller import SAMPLES, SceneController, SceneProgram
from .display_controller import DisplayController
from .main_window import MainWindow

_PROGRAM_VIEWS = (View.CUT, View.NC)


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
        self._window, self._display, self._scenes = window, display, scenes
        self._nc, self._cuts = nc, cuts
        self._given: dict[View, bytes | None] = {}
        display.on_scene = lambda: self.at_front
        display.view_changed.connect(self._go_on)
        scenes.changed.connect(lambda: self._go_on(display.view))
        actions = window.actions_
        on_trigger(actions, "scene_new", scenes.new)
        for name in SAMPLES:
            on_trigger(actions, f"scene_{name}", partial(scenes.open_sample, name))
        on_trigger(actions, "scene_nc", scenes.show_nc)
        on_trigger(actions, "scene_cut", scenes.show_cut)
        scenes.work.began.connect(self._begin)
        scenes.nc_requested.connect(self._show_nc)
        scenes.cut_requested.connect(self._show_cut)
        scenes.document.standing_changed.connect(display.show_titles)
        scenes.close_requested.connect(window.close)
        window.closing.connect(self._ask)
        view = window.views.surfaces
        view.hovered.connect(display.show_hovered)
        view.cursor_moved.connect(window.status.show_place)

    @property
    def at_front(self) -> bool:
        """Whether the scene is worked on rather than the drawing: it, or its program where nothing is drawn."""
        view, scene = self._display.view, self._window.scene
        if not scene.open or view is View.SURFACES:
            return scene.open
        return view in _PROGRAM_VIEWS and self._alone(view) and self._shows_nothing_else(view)

    def _alone(self, view: View) -> bool:
        """Whether a scene is all that a view can show: nothing is drawn, and no program of a file is looked at there;
        one in the other view takes nothing from this one.
        """
        return self._window.scene.open and not self._window.document.part.entities and not self._opened(view)

    def _opened(self, view: View) -> bool:
        """Whether a view shows a program of a file."""
        if view is View.CUT:
            return self._cuts.source is not None and not self._cuts.of_scene
        return self._nc.foreign and self._nc.source is not None and self._nc.source.path is not None

    def _shows_nothing_else(self, view: View) -> bool:
        """Whether a view shows no program but one that the scene gave it: one that was made of that stays."""
        shown = self._shown(view)
        return shown is None or shown.data == self._given.get(view)

    def _shown(self, view: View) -> ProgramSource | None:
        return self._cuts.source if view is View.CUT else self._nc.source

    def _begin(self) -> None:
        """Of another scene nothing was closed yet."""
        self._given = {view: data for view, data in self._given.items() if self._shown(view) is not None}

    def _go_on(self, view: View) -> None:
        """Show the scene's program, as it is now, where nothing else is to be shown; once, for it can be closed."""
        if view not in _PROGRAM_VIEWS or not self._alone(view) or not self._shows_nothing_else(view):
            return
        program = self._scenes.program()
        if program is not None and program.source.data != self._given.get(view):
            (self._scenes.show_cut if view is View.CUT else self._scenes.show_nc)()

    def _show_nc(self, source: ProgramSource) -> None:
        self._given[View.NC] = source.data
        self._nc.show_text(source)

    def _ask(self) -> None:
        """Keep the window open while the scene's changes are asked about; those of the drawing come first."""
        self._window.may_close = self._window.may_close and self._scenes.may_close()

    def _show_cut(self, program: SceneProgram) -> None:
        """Show what a scene's program leaves of its stock, beside the scene's surfaces."""
        self._given[View.CUT] = program.source.data
        if self._display.view is not View.CUT:
            self._display.show_view(View.CUT)
        self._cuts.show_program(program.source, program.dialect, program.part)
