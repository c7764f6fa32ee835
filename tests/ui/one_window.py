"""One window for the tests of a module: made new after a test that left something behind, used again after one that did
not.
"""

from __future__ import annotations

from PySide6.QtCore import QCoreApplication, QEvent
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from app.core.settings import Settings, ThemeChoice
from app.drafting.document import Document
from app.ui.framework.fade import FADE_MS
from app.ui.framework.view import View
from app.ui.shell.start import build
from app.ui.shell.wiring import Wiring
from app.ui.views.canvas.modes import CanvasTool
from app.ui.views.canvas.view import View as CanvasView
from tests.ui.traces import differences, traces

SIZE = (1280, 800)


class OneWindow:
    """Lends a window that is as new.

    Attributes:
        made: how many windows were made.
        left: what the last test that needed a new window after it had left behind, a line each.
    """

    def __init__(self) -> None:
        self.made = 0
        self.left: list[str] = []
        self._wiring: Wiring | None = None
        self._new: dict[str, object] = {}
        self._view = CanvasView()

    def lend(self, qtbot: QtBot) -> Wiring:
        """Return a window as it is when the program starts, shown and active."""
        if self._wiring is None:
            window, self._wiring = build()
            self.made += 1
            window.resize(*SIZE)
            _activate(qtbot, self._wiring)
            self._view = window.canvas.view
            reset(self._wiring, self._view)
            self._new = traces(self._wiring)
        else:
            _activate(qtbot, self._wiring)
        return self._wiring

    def take_back(self) -> None:
        """Make the window as new for the next test, or else let go of it."""
        wiring = self._wiring
        if wiring is None:
            return
        reset(wiring, self._view)
        self.left = differences(self._new, traces(wiring))
        if self.left:
            self.close()

    def close(self) -> None:
        """Let go of the window."""
        wiring, self._wiring = self._wiring, None
        if wiring is not None:
            end(wiring)


def _activate(qtbot: QtBot, wiring: Wiring) -> None:
    window = wiring.window_
    with qtbot.waitActive(window):
        window.show()
        window.activateWindow()
    window.canvas.setFocus()
    QApplication.processEvents()


def reset(wiring: Wiring, view: CanvasView) -> None:
    """Leave everything that was opened, drawn, chosen, typed and computed, and look at the canvas as before."""
    window, empty = wiring.window_, Document()
    window.worker.finish(20.0)
    _forget_changes(wiring)
    wiring.cancel()
    window.canvas.cancel()
    if wiring.nc.foreign:
        wiring.nc.back()
    wiring.cutting.back()
    window.document.load(empty.job)
    wiring.computation.forget()
    window.notice.ask("")
    window.notice.hide()
    window.command_line.edit.clear()
    window.canvas.set_tool(CanvasTool.SELECT)
    window.actions_["tool_select"].setChecked(True)
    for name, on in (("snap", True), ("ortho", False), ("grid", False), ("log", True)):
        window.actions_[name].setChecked(on)
    window.findings_list.hide()
    if window.preferences.settings.theme is not ThemeChoice.SYSTEM:
        window.set_theme_choice(ThemeChoice.SYSTEM)
    window.preferences.settings = Settings()
    window.status.show_place(0.0, 0.0)
    wiring.log.lines.clear()
    window.command_line.log.show_lines(wiring.log.lines)
    wiring.showing.show_view(View.DRAW)
    window.views.fade._run.setCurrentTime(FADE_MS)
    window.resize(*SIZE)
    window.status.show_message("Not computed")
    _settle()
    window.canvas.set_view(view)
    _forget_habits(wiring)


def _settle() -> None:
    """Let what is due happen, and what was thrown away go."""
    QApplication.processEvents()
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    QApplication.processEvents()


def _forget_habits(wiring: Wiring) -> None:
    """Let nobody remember what was typed and drawn last."""
    line, runner = wiring.window_.command_line, wiring.window_.canvas.runner
    line._typed.clear()
    line._at = 0
    runner._last, runner.cursor = CanvasTool.LINE, (0.0, 0.0)
    runner._desk.numbers.clear()
    wiring.language.lines._line = ""
    wiring.recovering._timer.stop()


def _forget_changes(wiring: Wiring) -> None:
    """Let nothing be asked about changes that are not saved."""
    wiring.document.load(wiring.document.job)
    wiring.language.control.text = ""
    wiring.window_.scene.document.setModified(False)


def end(wiring: Wiring) -> None:
    """Close a window as its user would, without being asked about changes."""
    window = wiring.window_
    window.worker.finish(20.0)
    _forget_changes(wiring)
    window.close()
    window.deleteLater()
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
