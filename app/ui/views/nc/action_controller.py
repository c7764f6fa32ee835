"""What the keys, the menu and the mouse do in the NC view."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QObject, QPoint
from PySide6.QtWidgets import QMenu

from ...framework.commands import Commands, on_trigger
from ...framework.computation import Computation
from .controller import NcController
from .motion_shapes import ViewSide
from .view import NcView

_CONTEXT = ("nc_cut", "nc_restart", "", "nc_find", "nc_line", "", "nc_compare", "nc_save", "nc_back")
_SIDES = {"nc_xy": ViewSide.XY, "nc_xz": ViewSide.XZ, "nc_yz": ViewSide.YZ}


class NcActionController(QObject):
    """Connects the NC menu and the NC view."""

    def __init__(self, view: NcView, control: NcController, computation: Computation, commands: Commands) -> None:
        super().__init__(view)
        self._view, self._control, self._computation, self._commands = view, control, computation, commands
        self._on("nc_open", control.choose)
        self._on("nc_back", control.back)
        self._on("nc_save", control.save_as)
        self._in_view("nc_find", lambda: view.active.begin_find())
        self._in_view("nc_line", lambda: view.active.begin_find(":"))
        self._in_view("nc_find_next", lambda: view.active.find_next())
        self._in_view("nc_find_before", lambda: view.active.find_next(back=True))
        self._in_view("nc_problem", lambda: view.active.panel.step(1))
        self._in_view("nc_problem_before", lambda: view.active.panel.step(-1))
        self._on("nc_frame", control.show_frame)
        self._on("nc_cut", control.show_cut)
        view.path_head.cut_requested.connect(commands["nc_cut"].trigger)
        self._in_view("nc_restart", control.restart_here)
        self._on("nc_compare", control.choose_to_compare)
        self._on("nc_compare_end", control.stop_comparing)
        self._in_view("nc_difference", partial(view.differences.step, 1))
        self._in_view("nc_difference_before", partial(view.differences.step, -1))
        for name, side in _SIDES.items():
            self._in_view(name, partial(view.set_side, side))
        view.menu_requested.connect(self._open_menu)
        control.changed.connect(self._refresh)
        computation.changed.connect(self._offer_frame)
        self._refresh()

    def _on(self, name: str, act: Callable[[], object]) -> None:
        on_trigger(self._commands, name, act)

    def _in_view(self, name: str, act: Callable[[], object]) -> None:
        """Do something in the NC view, which comes to the front."""

        def bring_and_act() -> None:
            self._control.bring()
            act()

        self._on(name, bring_and_act)

    def _offer_frame(self) -> None:
        made = self._computation.made
        self._commands["nc_frame"].setEnabled(made is not None and bool(made.files))

    def _refresh(self) -> None:
        self._offer_frame()
        actions, control = self._commands, self._control
        actions["nc_back"].setEnabled(control.foreign)
        for name in ("nc_save", "nc_find", "nc_find_next", "nc_find_before", "nc_line"):
            actions[name].setEnabled(control.source is not None)
        comparing = self._view.compared is not None
        for name in ("nc_difference", "nc_difference_before", "nc_compare_end"):
            actions[name].setEnabled(comparing)
        for name in ("nc_compare", "nc_restart", "nc_cut"):
            actions[name].setEnabled(self._view.shown is not None)
        self._view.path_head.cut.setEnabled(self._view.shown is not None)
        for name in ("nc_problem", "nc_problem_before"):
            actions[name].setEnabled(bool(self._view.pane.problems or (comparing and self._view.other.problems)))

    def _open_menu(self, at: QPoint) -> None:
        menu = QMenu(self._view)
        for name in _CONTEXT:
            if name:
                menu.addAction(self._commands[name])
            else:
                menu.addSeparator()
        menu.popup(at)
