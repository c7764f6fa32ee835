"""The running tool: clicks and typed words in, lines of the drawing language out. Knows no widget."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import replace

from app.edit.document import Document
from app.edit.errors import CommandError
from app.edit.evaluate import value_of
from app.edit.grammar import read_value
from app.edit.language import command_word
from app.edit.values import Curves
from app.errors import InputError
from app.model.curves import Point
from app.tolerances import WELD
from app.ui.canvas.drawing_tool import DrawingTool
from app.ui.canvas.modes import CanvasTool
from app.ui.canvas.tools import TOOL_WORDS, TOOLS

_SELECT_PROMPT = "Select: click, or drag a window; from right to left it takes what it crosses"


class ToolRunner:
    """Holds the running tool and carries out what it makes.

    Attributes:
        kind: which tool runs. tool: the tool itself, None for SELECT.
        cursor: where the tool aims, mm.
    """

    def __init__(self, document: Document, say: Callable[[str], None]) -> None:
        """Begin with SELECT; `say` gets the sentence of every error."""
        self._document, self._say = document, say
        self.kind = CanvasTool.SELECT
        self.tool: DrawingTool | None = None
        self.cursor: Point = (0.0, 0.0)
        self._last = CanvasTool.LINE

    @property
    def prompt(self) -> str:
        """What is expected next."""
        return self.tool.prompt if self.tool else _SELECT_PROMPT

    @property
    def busy(self) -> bool:
        """True while a shape has been begun."""
        return self.tool is not None and bool(self.tool.points)

    def start(self, kind: CanvasTool) -> None:
        """Begin a tool; an unfinished shape is given up."""
        self.kind = kind
        self.tool = TOOLS[kind]() if kind in TOOLS else None
        if self.tool is not None:
            self._last = kind

    def aim_at(self, point: Point) -> None:
        """See the mouse aim at a point, mm."""
        self.cursor = point
        if self.tool is not None:
            self.tool.follow(point)

    def click(self, point: Point) -> None:
        """Take a point; one that repeats the last is passed over."""
        if self.tool is None or (self.tool.base is not None and math.dist(self.tool.base, point) < WELD):
            return
        self.aim_at(point)
        try:
            self._run(self.tool.add(point))
        except InputError as error:
            self.tool.points = []
            self._say(str(error))

    def accept(self) -> None:
        """End the shape; without one end the tool; without a tool begin the last one again."""
        if self.tool is None:
            self.start(self._last)
        elif self.busy:
            self._run(self.tool.finish())
        else:
            self.start(CanvasTool.SELECT)

    def back(self) -> None:
        """Take the last point back."""
        if self.tool is not None:
            self._run(self.tool.back())

    def after_undo(self) -> None:
        """Let the running tool go on from where an undone drawing ends."""
        if self.tool is not None and self._document.log and self._document.log[-1].command in ("undo", "u"):
            self.tool.after_undo(self._document.last_point)

    def cancel(self) -> bool:
        """Give up the shape, or else the tool; return whether there was either."""
        if self.tool is None:
            return False
        self.start(self.kind if self.busy else CanvasTool.SELECT)
        return True

    def type_text(self, text: str) -> bool:
        """Take typed text: a word of the tool, a point, a distance, or a command word alone that begins a tool.

        Returns:
            False when the text is nothing for a tool, and may be a whole line of the drawing language.
        """
        text = text.strip()
        if not text:
            return False
        if self.tool is not None and self._word(text.lower()):
            return True
        command = command_word(text)
        if command is not None:
            return self._begin(command) if " " not in text else False
        if self.tool is None or ";" in text or (text[0].isalpha() and "," not in text and not self._is_named(text)):
            return False
        try:
            self._place(self.tool, text)
        except CommandError as error:
            self._say(error.reason)
        return True

    def _is_named(self, text: str) -> bool:
        """Return whether a text begins with a name that stands for something."""
        word = re.match(r"\w+", text)
        return word is not None and word[0] in self._document.session.names

    def _word(self, word: str) -> bool:
        line = self.tool.word(word) if self.tool else None
        if line:
            self._run(line)
        return line is not None

    def _begin(self, command: str) -> bool:
        if command not in TOOL_WORDS:
            return False
        self.start(TOOL_WORDS[command])
        return True

    def _place(self, tool: DrawingTool, text: str) -> None:
        scope = replace(self._document.session.scope, last=tool.base or self._document.last_point)
        value = value_of(read_value(text), scope)
        if isinstance(value, tuple):
            self.click(value)
            return
        if isinstance(value, Curves):
            raise CommandError(f"'{text}' is a curve; a point or a length is wanted.")
        point = tool.number(value, self.cursor)
        if point is None:
            raise CommandError(f"'{text}' is a distance without a direction; write x,y or @dx,dy, or point with the mouse first.")
        self.click(point)

    def _run(self, line: str | None) -> None:
        if not line:
            return
        try:
            self._document.run(line)
        except InputError as error:
            self._say(str(error))
