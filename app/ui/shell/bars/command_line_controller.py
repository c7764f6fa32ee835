"""What the command line knows of the drawing and of the tool in hand: what Tab does, which words are offered."""

from __future__ import annotations

from PySide6.QtCore import QObject

from ....core.progress import Progress
from ...framework.worker import Worker
from ...framework.workspace import Workspace
from ...views.canvas.canvas import Canvas
from ...views.canvas.form_tools import FONT, TextTool
from ...views.canvas.prompt_tool import Prompt, PromptTool
from ...views.language.completion import CompletionItem
from .command_completion import completions
from .command_line import CommandLine


def fonts(progress: Progress) -> tuple[str, ...]:
    """Return the names of the fonts of this machine, of which there may be thousands."""
    from ....geometry.typeface import installed_names  # reads fonts: never on the window's thread

    progress.step(0.0, "Reading fonts")
    return installed_names()


class CommandLineController(QObject):
    """Keeps the command line in step with the document and the running tool."""

    def __init__(self, command_line: CommandLine, canvas: Canvas, workspace: Workspace) -> None:
        super().__init__(command_line)
        self._command_line, self._canvas = command_line, canvas
        self._document = workspace.document
        self._asked: Prompt | None = None
        self._fonts: tuple[str, ...] | None = None
        self.worker = Worker(self)
        workspace.activity.ended.connect(self.worker.finish)
        command_line.completions = self._completions
        command_line.value_taken = self._take_value
        command_line.chosen.connect(self._choose)
        command_line.edit.textChanged.connect(canvas.see_words)
        canvas.prompt_changed.connect(lambda _: self._show_options())
        canvas.tool_changed.connect(lambda _: command_line.forget())
        canvas.cancelled.connect(command_line.forget)

    def _show_options(self) -> None:
        tool = self._canvas.runner.tool
        on = tool.on if isinstance(tool, PromptTool) else ()
        self._command_line.set_options(tool.options if tool is not None else (), on)
        before, self._asked = self._asked, tool.ask if isinstance(tool, PromptTool) else None
        if isinstance(tool, TextTool) and "font" in tool.on and self._fonts is None and not self.worker.busy:
            self.worker.start(fonts, 0, self._take_fonts)
        if self._asked is FONT and before is not FONT:
            self._offer_fonts()

    def _take_fonts(self, names: tuple[str, ...]) -> None:
        self._fonts = names
        self._offer_fonts()

    def _offer_fonts(self) -> None:
        if self._asked is FONT and self._fonts and not self._command_line.edit.text():
            self._command_line.offer()

    def _choose(self, word: str) -> None:
        """Take an option of the tool; words that are being typed go on, a number is typed at the pointer."""
        self._canvas.choose(word)
        if not (self._canvas.runner.wants_words and self._command_line.edit.hasFocus()):
            self._canvas.setFocus()

    def _completions(self, line: str) -> tuple[str, list[CompletionItem]]:
        """Return what a line could go on with: fonts where the tool asks for one, nothing where it asks for words."""
        tool = self._canvas.runner.tool
        if not self._canvas.runner.wants_words or not isinstance(tool, PromptTool):
            return completions(line, self._document)
        begun = line.strip()
        names = (self._fonts or ()) if tool.ask is FONT else ()
        return begun, [CompletionItem(name, "font") for name in names if begun.casefold() in name.casefold()]

    def _take_value(self, text: str) -> bool:
        """Have a number that Tab ends go into the first box at the pointer, and the keys into the next one."""
        canvas = self._canvas
        if not canvas.isVisible() or not canvas.entry.begins(text.strip()[:1]) or not canvas.take_value(text.strip()):
            return False
        canvas.setFocus()
        return True
