"""What the command line knows of the drawing and of the tool in hand: what Tab completes, which words are offered."""

from __future__ import annotations

from PySide6.QtCore import QObject

from .completing import completions
from .main_window import MainWindow


class Entering(QObject):
    """Keeps the command line in step with the document and the running tool."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        window.command_line.completions = lambda line: completions(line, window.document)
        window.canvas.prompt_changed.connect(lambda _: self._show_options())

    def _show_options(self) -> None:
        tool = self._window.canvas.runner.tool
        self._window.command_line.set_options(tool.options if tool is not None else ())
