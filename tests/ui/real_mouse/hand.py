"""A hand on the real mouse and keyboard of a (virtual) display: the X server's own events, as a person's would come."""

from __future__ import annotations

import queue
import subprocess
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from PySide6.QtCore import QObject, QPoint, QPointF, Qt, Signal
from PySide6.QtWidgets import QApplication, QFileDialog, QLineEdit, QToolButton, QWidget

from app.model.curves import Point
from app.ui.shell.window_controller import WindowController

T = TypeVar("T")
PATIENCE_S = 120.0
SETTLE_S = 0.12


class Hand(QObject):
    """Acts on a window from a thread of its own, while the window lives on the other.

    Attributes:
        clicks: made so far. typed: lines typed so far. values: numbers, points and names typed so far.
    """

    _asked = Signal(object)

    def __init__(self, wiring: WindowController) -> None:
        super().__init__()
        self.wiring, self.window = wiring, wiring.window_
        self.clicks, self.typed, self.values = 0, 0, 0
        self._answers: queue.Queue[Any] = queue.Queue()
        self._asked.connect(self._answer, Qt.ConnectionType.QueuedConnection)

    def play(self, act: Callable[[Hand], None]) -> BaseException | None:
        """Act on another thread until done; return what went wrong, or None."""
        wrong: list[BaseException] = []

        def work() -> None:
            try:
                act(self)
            except BaseException as fault:
                wrong.append(fault)
            finally:
                self.ask(lambda: QApplication.exit(0))  # quit would ask about the drawing that is in no file

        thread = threading.Thread(target=work, daemon=True)
        thread.start()
        QApplication.exec()
        thread.join(PATIENCE_S)
        return wrong[0] if wrong else None

    def ask(self, what: Callable[[], T]) -> T:
        """Return what a function finds on the window's own thread."""
        self._asked.emit(what)
        found, answer = self._answers.get(timeout=PATIENCE_S)
        if not found:
            raise answer
        return answer

    def _answer(self, what: Callable[[], Any]) -> None:
        try:
            self._answers.put((True, what()))
        except BaseException as fault:
            self._answers.put((False, fault))

    def wait_until(self, holds: Callable[[], bool], what: str) -> None:
        """Wait for something that the window does by itself."""
        end = time.monotonic() + PATIENCE_S
        while not self.ask(holds):
            if time.monotonic() > end:
                raise AssertionError(f"{what} did not come")
            time.sleep(0.05)

    def click(self, widget: QWidget) -> None:
        """Click the middle of a widget."""
        self._click_at(self.ask(lambda: widget.mapToGlobal(widget.rect().center())))

    def click_button(self, action: str) -> None:
        """Click the visible button of an action."""
        self.click(self.ask(lambda: self._button(action)))

    def hold_button(self, action: str) -> None:
        """Hold the visible button of an action until what lies behind it is open."""
        widget = self.ask(lambda: self._button(action))
        at = self.ask(lambda: widget.mapToGlobal(widget.rect().center()))
        self.clicks += 1
        _xdotool("mousemove", str(at.x()), str(at.y()), "mousedown", "1", "sleep", "1", "mouseup", "1")
        time.sleep(SETTLE_S)

    def click_place(self, place: Point) -> None:
        """Click a place of the drawing, mm."""
        self._click_at(self.ask(lambda: self._on_screen(place)))

    def drag(self, start: QPoint, end: QPoint) -> None:
        """Drag something from one place of the display to another; one click more."""
        self.clicks += 1
        _xdotool("mousemove", str(start.x()), str(start.y()), "mousedown", "1")
        time.sleep(SETTLE_S)
        for share in (0.1, 0.5, 0.9, 1.0):
            at = start + (end - start) * share
            _xdotool("mousemove", str(at.x()), str(at.y()))
            time.sleep(SETTLE_S)
        _xdotool("mouseup", "1")

    def type_line(self, text: str) -> None:
        """Type something and Enter."""
        self._type(text)
        self.press("Return")

    def type_values(self, *values: str) -> None:
        """Type values into the boxes at the pointer, one after the other, and Enter."""
        for value in values[:-1]:
            self._type(value)
            self.press("Tab")
        self.type_line(values[-1])

    def type_seen_line(self, text: str) -> None:
        """Type something, and Enter once the field that has the keys shows it: a busy one shows it late."""
        self.type_seen(text)
        self.press("Return")

    def type_seen(self, text: str) -> None:
        """Type something, and wait until the field that has the keys shows it."""
        self._type(text)
        self.wait_until(lambda: _shown_in_field() == text, "what was typed")

    def type_path(self, path: Path) -> None:
        """Type a path into the file dialog that opens, and Enter."""
        self.wait_until(dialog_has_the_keys, "the file dialog")
        self.type_seen(str(path))
        self.confirm(lambda: self.press("Return"))

    def confirm(self, act: Callable[[], None]) -> None:
        """Act so that the open file dialog ends. On a busy screen the toolkit's list takes the folder of what was typed
        for chosen: the dialog goes there first, keeps the name, and has to be told once more.
        """
        begun = self.ask(_folder_of_dialog)
        act()
        self.wait_until(lambda: _folder_of_dialog() != begun, "an answer of the file dialog")
        if self.ask(_folder_of_dialog) is not None:
            act()

    def _type(self, text: str) -> None:
        self.typed += 1
        self.values += max(1, sum(any(map(str.isdigit, word)) for word in text.split()))
        _xdotool("type", "--delay", "8", text)

    def press(self, keys: str) -> None:
        """Press a key, such as F5 or ctrl+e."""
        _xdotool("key", keys)
        time.sleep(SETTLE_S)

    def focus_window(self) -> None:
        """Give the window the keyboard, which a display without a window manager does not do by itself."""
        _xdotool("windowfocus", "--sync", str(self.ask(lambda: int(self.window.winId()))))

    def _click_at(self, at: QPoint) -> None:
        self.clicks += 1
        _xdotool("mousemove", str(at.x()), str(at.y()))
        time.sleep(SETTLE_S)
        _xdotool("click", "1")
        time.sleep(SETTLE_S)

    def _button(self, action: str) -> QToolButton:
        wanted = self.window.actions_[action]
        return next(b for b in self.window.findChildren(QToolButton) if b.defaultAction() is wanted and b.isVisible())

    def _on_screen(self, place: Point) -> QPoint:
        canvas = self.window.canvas
        at: QPointF = canvas.view.to_screen(place)
        return canvas.mapToGlobal(at.toPoint())


def dialog_has_the_keys() -> bool:
    """Tell whether what is typed goes to the name in an open dialog: on a busy screen that is a while after it is
    open.
    """
    dialog, focused = QApplication.activeModalWidget(), QApplication.focusWidget()
    return (
        isinstance(focused, QLineEdit)
        and dialog is not None
        and dialog.isActiveWindow()
        and dialog.isAncestorOf(focused)
    )


def _folder_of_dialog() -> str | None:
    """Return the folder that the open file dialog shows; None = none is open."""
    dialog = QApplication.activeModalWidget()
    return dialog.directory().path() if isinstance(dialog, QFileDialog) else None


def _shown_in_field() -> str:
    field = QApplication.focusWidget()
    return field.text() if isinstance(field, QLineEdit) else ""


def _xdotool(*words: str) -> None:
    subprocess.run(["xdotool", *words], check=True, timeout=PATIENCE_S)
