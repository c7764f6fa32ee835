"""Connects the language's parts with the window: lines that take long, the page of the text, the manual."""

from __future__ import annotations

import re

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QKeyEvent

from ...shell.help_window import HelpWindow
from ...shell.main_window import MainWindow
from ...shell.running_lines import RunningLines
from ...shell.showing import Showing
from .control import TextControl

_MANUAL = "posts"


class LanguageWiring(QObject):
    """Lines, page and manual.

    Attributes:
        lines: carries out what is typed. control: the page of the text. help: the manual's window.
    """

    def __init__(self, window: MainWindow, showing: Showing) -> None:
        super().__init__(window)
        self._window = window
        self.lines, self.help = RunningLines(window.document, self), HelpWindow(window)
        self.help.set_theme(window.theme)
        self.control = TextControl(window, showing, self.lines, self.help)
        actions, status = window.actions_, window.status
        actions["help_language"].triggered.connect(lambda *_: self.help.show_page())
        actions["manual"].triggered.connect(lambda *_: self.help.show_page(_MANUAL))
        self.control.page.editor.left.connect(window.canvas.setFocus)
        self.lines.progress.connect(status.show_progress)
        self.lines.busy_changed.connect(self._on_busy)
        window.closed.connect(self.lines.cancel)
        window.closed.connect(self.help.close)
        window.command_line.edit.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 (Qt's name)
        """F1 in the command line explains the word at the cursor; with nothing typed it is the window's."""
        if isinstance(event, QKeyEvent) and event.key() == Qt.Key.Key_F1 and self._window.command_line.edit.text():
            if event.type() == QEvent.Type.ShortcutOverride:
                event.accept()
                return True
            if event.type() == QEvent.Type.KeyPress:
                edit = self._window.command_line.edit
                self._explain(edit.text(), edit.cursorPosition())
                return True
        return super().eventFilter(watched, event)

    def cancel(self) -> bool:
        """Leave the line on its way; return whether there was one."""
        busy = self.lines.busy
        self.lines.cancel()
        return busy

    def _on_busy(self, busy: bool) -> None:
        self._window.status.show_progress(0.0 if busy else None, "Drawing" if busy else "")
        self._window.actions_["cancel"].setEnabled(busy or self._window.worker.busy)

    def _explain(self, line: str, at: int) -> None:
        word = next((each for each in re.finditer(r"\w+", line) if each.start() <= at <= each.end()), None)
        if word is None:
            self.help.show_page()
        else:
            self.help.show_word(word[0], line[word.end() : word.end() + 1] == "(")
