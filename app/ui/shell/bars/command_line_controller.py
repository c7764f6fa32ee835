"""What the command line knows of the drawing and of the tool in hand: what Tab does, which words are offered."""

from __future__ import annotations

from PySide6.QtCore import QObject

from ....drafting.document import Document
from ...views.canvas.canvas import Canvas
from .command_completion import completions
from .command_line import CommandLine


class CommandLineController(QObject):
    """Keeps the command line in step with the document and the running tool."""

    def __init__(self, command_line: CommandLine, canvas: Canvas, document: Document) -> None:
        super().__init__(command_line)
        self._command_line, self._canvas = command_line, canvas
        command_line.completions = lambda line: completions(line, document)
        command_line.value_taken = self._take_value
        canvas.prompt_changed.connect(lambda _: self._show_options())
        canvas.tool_changed.connect(lambda _: command_line.forget())
        canvas.cancelled.connect(command_line.forget)

    def _show_options(self) -> None:
        tool = self._canvas.runner.tool
        self._command_line.set_options(tool.options if tool is not None else ())

    def _take_value(self, text: str) -> bool:
        """Have a number that Tab ends go into the first box at the pointer, and the keys into the next one."""
        canvas = self._canvas
        if not canvas.isVisible() or not canvas.entry.begins(text.strip()[:1]) or not canvas.take_value(text.strip()):
            return False
        canvas.setFocus()
        return True
