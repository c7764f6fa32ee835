"""The shape language in the window: lines that take long, the page of the text, the manual."""

from __future__ import annotations

import re

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QLineEdit

from ...framework.commands import Commands, on_trigger
from ...framework.workspace import Workspace
from ...views.language.command_runner import CommandRunner
from ...views.language.controller import TextController
from ...views.language.page import TextPage
from ..help.help_window import HelpWindow

_MANUAL = "manual"
_TEXTS = "texts"


class ShapeLanguageController(QObject):
    """Lines, page and manual.

    Attributes:
        lines: carries out what is typed. control: the page of the text. help: the manual's window.
    """

    def __init__(self, edit: QLineEdit, help_window: HelpWindow, workspace: Workspace, commands: Commands) -> None:
        """Make one; `edit` is where lines are typed."""
        super().__init__(edit)
        self._edit = edit
        self.lines, self.help = CommandRunner(workspace.document, self), help_window
        self.control = TextController(TextPage(), self.lines, workspace, commands)
        on_trigger(commands, "help_language", self.help.show_page)
        on_trigger(commands, "manual", lambda: self.help.show_page(_MANUAL))
        on_trigger(commands, "five_texts", lambda: self.help.show_page(_TEXTS))
        on_trigger(commands, "text", self.control.open)
        self.control.page.editor.help_requested.connect(self.help.show_word)
        workspace.activity.cancelled.connect(self.lines.cancel)
        workspace.activity.follow(self.lines.worker, "Drawing")
        workspace.activity.ended.connect(self.lines.cancel)
        workspace.activity.ended.connect(self.help.close)
        edit.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 (Qt's name)
        """F1 in the command line explains the word at the cursor; with nothing typed it is the window's."""
        if isinstance(event, QKeyEvent) and event.key() == Qt.Key.Key_F1 and self._edit.text():
            if event.type() == QEvent.Type.ShortcutOverride:
                event.accept()
                return True
            if event.type() == QEvent.Type.KeyPress:
                self._explain(self._edit.text(), self._edit.cursorPosition())
                return True
        return super().eventFilter(watched, event)

    def _explain(self, line: str, at: int) -> None:
        word = next((each for each in re.finditer(r"\w+", line) if each.start() <= at <= each.end()), None)
        if word is None:
            self.help.show_page()
        else:
            self.help.show_word(word[0], line[word.end() : word.end() + 1] == "(")
