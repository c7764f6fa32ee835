"""The running tool: clicks and typed words in, lines of the drawing language out. Knows no widget."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import replace

from ....core.errors import InputError
from ....core.tolerances import WELD
from ....drafting.document import Document
from ....drafting.expressions.errors import CommandError, reason_of
from ....drafting.expressions.evaluate import value_of
from ....drafting.expressions.grammar import read_value
from ....drafting.expressions.values import Curves
from ....drafting.language.language import command_word
from ....model.curves import Point
from .command_trials import CommandTrial, CommandTrials
from .drawing_tool import DrawingTool, InputKind, Pick, ToolContext, ToolPreview
from .modes import CanvasTool
from .prompt_tool import Answer, PromptTool
from .snapped_point import tidy
from .tool_table import TOOL_WORDS, TOOLS
from .typed_values import TypedValues

_SELECT_PROMPT = (
    "Select: click; twice takes all that joins it; drag a window, from right to left it takes what it crosses"
)


class ToolRunner:
    """Holds the running tool and carries out what it makes.

    Attributes:
        kind: which tool runs. tool: the tool itself, None for SELECT.
        cursor: where the tool aims, mm. under: the curve that a click would pick, or None.
        unit: what lengths are typed and shown in, mm.
        typed: the values that are held for the answer to the question.
        words: typed so far and not entered, where words are asked for.
    """

    def __init__(self, document: Document, say: Callable[[str], None]) -> None:
        """Begin with SELECT; `say` gets the sentence of every error."""
        self._document, self._say = document, say
        self.kind = CanvasTool.SELECT
        self.tool: DrawingTool | None = None
        self.cursor: Point = (0.0, 0.0)
        self.unit = 1.0
        self.under: Pick | None = None
        self._desk, self._trials = ToolContext(document, {}), CommandTrials(document)
        self._last = CanvasTool.LINE
        self.typed = TypedValues()
        self.words = ""

    @property
    def prompt(self) -> str:
        """What is expected next."""
        return self.tool.prompt if self.tool else _SELECT_PROMPT

    @property
    def busy(self) -> bool:
        """True while a shape has been begun."""
        return self.tool is not None and self.tool.busy

    @property
    def choosing(self) -> bool:
        """True while a tool asks for curves to be selected."""
        return self.tool is not None and self.tool.wants is InputKind.SELECTION

    @property
    def wants_words(self) -> bool:
        """True while words are asked for, which may hold blanks and every other sign."""
        return self.tool is not None and self.tool.wants is InputKind.WORDS

    @property
    def looking(self) -> bool:
        """True while what lies under the mouse is to be lit: it would be selected, or picked."""
        return self.tool is None or self.under is not None or self.tool.wants in (InputKind.SELECTION, InputKind.CURVE)

    @property
    def shows_change(self) -> bool:
        """True while the tool shows what would become of curves that are drawn."""
        return isinstance(self.tool, PromptTool) and bool(self.preview(self.cursor).trial.gone)

    @property
    def last(self) -> CanvasTool:
        """The tool that Enter begins again."""
        return self._last

    def set_unit(self, unit: float) -> None:
        """Count in another unit, of so many mm."""
        self.unit = unit
        if self.tool is not None:
            self.tool.unit = unit

    def start(self, kind: CanvasTool) -> None:
        """Begin a tool; an unfinished shape is given up. One that has nothing to ask does its work at once."""
        self.typed.release()
        self.kind, self.under = kind, None
        self.tool = TOOLS[kind]() if kind in TOOLS else None
        if self.tool is not None:
            self._last, self.tool.unit = kind, self.unit
            self._run(self.tool.begin(self._desk))

    def hold(self, tool: DrawingTool) -> None:
        """Take a tool in hand for one point, beside SELECT."""
        self.typed.release()
        self.kind, self.tool = CanvasTool.SELECT, tool
        tool.unit = self.unit

    def aim_at(self, point: Point, under: Pick | None = None) -> None:
        """See the mouse aim at a point, mm, and at a curve that can be picked there."""
        self.cursor, self.under = point, under
        if self.tool is not None:
            self.tool.follow(point)

    def click(self, point: Point) -> None:
        """Take a point, or the curve there, with the values that are held; a point that repeats the last is passed
        over.
        """
        tool = self.tool
        if tool is None:
            return
        answer, held = self.typed.answer(tool, point), not self.typed.free
        self.typed.release()
        if isinstance(answer, float):
            self._answer(tool, lambda: tool.typed(answer))
            return
        point = answer
        if (
            isinstance(tool, PromptTool)
            and tool.wants in (InputKind.CURVE, InputKind.EITHER)
            and (self.under or tool.wants is InputKind.CURVE)
        ):
            self._pick(tool)
            return
        if tool.wants is not InputKind.POINT or tool.base is None or math.dist(tool.base, point) >= WELD:
            if not held:
                self.aim_at(point)
            self._answer(tool, lambda: tool.add(point))

    def accept(self) -> None:
        """End the shape; without one end the tool; without a tool begin the last one again."""
        if self.tool is None:
            self.start(self._last)
        elif self.tool.goes_on:
            tool = self.tool
            self._answer(tool, tool.finish)
        else:
            self.start(CanvasTool.SELECT)

    def back(self) -> None:
        """Take the last point back."""
        self.typed.release()
        if self.tool is not None:
            self._run(self.tool.back())

    def after_undo(self) -> None:
        """Let the running tool go on from where an undone drawing ends."""
        if self.tool is not None and self._document.log and self._document.log[-1].command in ("undo", "u"):
            self.tool.after_undo(self._document.last_point)

    def cancel(self) -> bool:
        """Give up the shape, or else the tool; return whether there was either."""
        self.typed.release()
        if self.tool is None:
            return False
        if self.busy and isinstance(self.tool, PromptTool):
            self.tool.clear()
        else:
            self.start(self.kind if self.busy else CanvasTool.SELECT)
        return True

    def count_on(self, by: int) -> bool:
        """Change the count of the tool; return False where there is none."""
        return self.tool is not None and self.tool.count_on(by)

    def takes(self, text: str) -> bool:
        """Return whether a typed text is an option of the running tool, or the words that it asks for."""
        return self.wants_words or (self.tool is not None and text.strip().lower() in self.tool.options)

    def preview(self, point: Point) -> ToolPreview:
        """Return what a click at a point would make, with the values that are held."""
        tool = self.tool
        if tool is None:
            return ToolPreview()
        answer = self.typed.answer(tool, point)
        if not isinstance(tool, PromptTool):
            return tool.preview(answer if isinstance(answer, tuple) else point)
        shown = tool.helpers(answer if isinstance(answer, tuple) else point)
        line = tool.draft_of_words(self.words.strip()) if self.wants_words else tool.draft(answer, self.under)
        trial = self._trials.of(line) if line is not None else CommandTrial()
        made = trial.difference
        return replace(
            shown,
            trial=made,
            curves=() if made.added or made.gone or made.notes else tool.stand_in(answer),
            label="\n".join(filter(None, (shown.label, self._unanswered(tool), trial.reason.split(";")[0]))),
        )

    def _unanswered(self, tool: PromptTool) -> str:
        """Return what is asked for where nothing at the mouse tells: words of which none is typed."""
        return tool.ask.prompt if self.wants_words and not self.words.strip() else ""

    def read(self, text: str, is_length: bool) -> float | Point:
        """Return what a typed text stands for: a point, a length in mm, or another number.

        Raises:
            CommandError: it stands for nothing of that kind.
        """
        tool = self.tool
        last = (tool.base if tool is not None else None) or self._document.last_point
        scope = replace(self._document.session.scope, last=last, plain=self.unit)
        value = value_of(read_value(text), scope)
        if isinstance(value, Curves):
            raise CommandError(f"'{text}' is a curve; a point or a length is wanted.")
        return float(scope.length(value)) if is_length and not isinstance(value, tuple) else value

    def type_text(self, text: str) -> bool:
        """Take typed text: a word of the tool, a point, a distance, or a command word alone that begins a tool.

        Returns:
            False when the text is nothing for a tool, and may be a whole line of the drawing language.
        """
        text = text.strip()
        if not text:
            return False
        if self.tool is not None and self._word(text):
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

    def choose(self, word: str) -> None:
        """Take an option of the running tool, also while it asks for words, of which it could be one."""
        tool = self.tool
        if isinstance(tool, PromptTool):
            tool.choose(word)
        elif tool is not None:
            self._run(tool.word(word))

    def _is_named(self, text: str) -> bool:
        """Return whether a text begins with a name that stands for something."""
        word = re.match(r"\w+", text)
        return word is not None and word[0] in self._document.session.names

    def _word(self, word: str) -> bool:
        tool = self.tool
        if isinstance(tool, PromptTool):
            option, _, value = word.partition(" ")
            if value and tool.wants is not InputKind.WORDS and option.lower() in tool.numbers:
                tool.setting = option.lower()
                self._place(tool, value)
                return True
        before = self._answers(tool) if tool else []
        line = tool.word(word if tool.wants is InputKind.WORDS else word.lower()) if tool else None
        if line:
            self._run(line, before)
        return line is not None

    def _begin(self, command: str) -> bool:
        if command not in TOOL_WORDS:
            return False
        self.start(TOOL_WORDS[command])
        return True

    def _place(self, tool: DrawingTool, text: str) -> None:
        value = self.read(text, tool.takes_length)
        self.typed.release()
        if isinstance(value, tuple):
            self.click(tidy(value))
            return
        before = self._answers(tool)
        line = tool.typed(value)
        if line is not None:
            self._run(line, before)
            return
        point = tool.number(value, self.cursor)
        if point is None:
            raise CommandError(
                f"'{text}' is a distance without a direction; write x,y or @dx,dy, or point with the mouse first."
            )
        self.click(tidy(point))

    def _pick(self, tool: PromptTool) -> None:
        under = self.under
        if under is None:
            self._say("No curve is there; click on one.")
        else:
            self._answer(tool, lambda: tool.give(under))

    def _answer(self, tool: DrawingTool, act: Callable[[], str | None]) -> None:
        """Give a tool what it asked for, and carry out what comes of it."""
        before = self._answers(tool)
        try:
            self._run(act(), before)
        except InputError as error:
            tool.clear()
            self._say(reason_of(error))

    def _answers(self, tool: DrawingTool) -> list[Answer]:
        return list(tool.answers) if isinstance(tool, PromptTool) else []

    def _run(self, line: str | None, before: list[Answer] | None = None) -> None:
        """Carry out a line; a tool whose line is refused goes back to the answers before."""
        if not line:
            return
        tool = self.tool
        try:
            self._document.run(line)
        except InputError as error:
            self._say(reason_of(error))
            if isinstance(tool, PromptTool) and before is not None:
                tool.restore(before)
                return
        if isinstance(tool, PromptTool) and tool.once and self.tool is tool:
            self.start(CanvasTool.SELECT)
