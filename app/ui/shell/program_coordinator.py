"""One program in two views: its text in NC, what it leaves of the metal in Cut; a place in one shows its place in the
other.
"""

from __future__ import annotations

from PySide6.QtCore import QObject

from ..framework.view import View
from ..panels.changes import Subject, SubjectKind
from ..views.cut.controller import CutController
from ..views.nc.controller import NcController
from ..views.nc.program_reader import ShownProgram
from .display_controller import DisplayController
from .main_window import MainWindow


class ProgramCoordinator(QObject):
    """Connects the NC, Curves and Cut views with one another and with the window."""

    def __init__(self, window: MainWindow, display: DisplayController, nc: NcController, cuts: CutController) -> None:
        super().__init__(window)
        self._window, self._display, self._nc, self._cuts = window, display, nc, cuts
        views, status, hovered = window.views, window.status, display.show_hovered
        for path in (views.nc.path, views.curves.path):
            path.hovered.connect(hovered)
        views.curves.deviation.hovered.connect(hovered)
        views.nc.path.cursor_moved.connect(lambda x, y: status.show_place(x, y, views.nc.side.name))
        views.curves.path.cursor_moved.connect(lambda x, y: status.show_place(x, y, views.curves.side.name))
        views.cut.hovered.connect(hovered)
        views.cut.cursor_moved.connect(status.show_place)
        nc.export_requested.connect(window.actions_["export"].trigger)
        nc.compute_requested.connect(window.actions_["compute"].trigger)
        nc.cut_requested.connect(self._show_cut)
        cuts.operation_picked.connect(lambda index: window.panel.choose(Subject(SubjectKind.OPERATION, index)))
        window.cut_panel.line_requested.connect(self._show_line)

    def show_own(self) -> None:
        """Show the job's own program again, where that of a file stands in its place."""
        self._cuts.back()
        if self._nc.foreign and self._nc.source is not None and self._nc.source.path is not None:
            self._nc.back()

    def show_worst(self) -> None:
        """Show the worst place of the job's cut where it is; what has none there is listed."""
        self._cuts.back()
        worst = next(
            (entry for entry in self._window.cut_panel.entries if entry.counts and entry.place is not None), None
        )
        if worst is None:
            self._display.open_findings()
            return
        self._display.show_view(View.CUT)
        self._window.cut_panel.choose(worst)

    def _show_cut(self, shown: ShownProgram | None) -> None:
        """Show the cut of another program, or the job's own."""
        self._display.show_view(View.CUT)
        if shown is None:
            self._cuts.back()
        else:
            self._cuts.show_program(shown.source, shown.dialect)

    def _show_line(self, motion: int) -> None:
        """Show the line of a motion of the cut program, if that is the one which the NC view shows, or can."""
        cut, nc = self._cuts.cut, self._nc
        if cut is None or motion < 0:
            return
        name = cut.names[cut.file_of(motion)]
        if cut.given is None and nc.foreign:
            nc.back()
        if cut.given is None or (nc.source is not None and nc.source.name == name):
            self._display.show_view(View.NC)
            nc.pick_motion(cut.file_of(motion), cut.row_in_file(motion))
