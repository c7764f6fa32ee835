"""Typing at the pointer: which box the keys go to, what is wrong with its text, and what the text becomes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QApplication, QLineEdit

from ....core.errors import HitofudeError
from ....drafting.expressions.errors import CommandError
from ....model.curves import Point
from ...framework.figures import TIMES, grouped
from .drawing_tool import DrawingTool, length_label
from .prompt_tool import PromptTool
from .tool_runner import ToolRunner
from .typed_values import ORIGIN, ValueRow, rows_of
from .value_boxes import ValueKind

_BEGINS = frozenset("0123456789.+-(@")
"""What a value begins with; anything else is a word, which the command line takes."""

_IMPLAUSIBLE = 20.0
"""A length of so many times the drawing, or what is in view of it, is taken only when Enter is pressed again."""

_MANY = 500
"""A count above it, too."""


@dataclass(frozen=True, slots=True)
class RowShown:
    """One box as it is painted.

    Attributes:
        name: in English. text: what stands in it. unit: behind it.
        held: whether a value is held. caret: position of the caret in the text, None where it is not typed in.
    """

    name: str
    text: str
    unit: str = ""
    held: bool = False
    caret: int | None = None


class ValueEntry:
    """The keyboard's side of the boxes of the running tool.

    Attributes:
        row: the box that is typed in, None while none is. wrong: why its text is no value. doubt: what is unlikely
            about the values, which Enter takes nevertheless.
        pointer: where the mouse aims, mm; None while it is elsewhere.
    """

    def __init__(self, runner: ToolRunner, line: QLineEdit, size: Callable[[], float]) -> None:
        """Begin with nothing typed; `line` edits the text and is never shown, `size` is how large what is drawn or in
        view is, mm.
        """
        self._runner, self._line, self._size = runner, line, size
        self.row: ValueRow | None = None
        self.wrong = self.doubt = ""
        self.pointer: Point | None = None
        self._before: dict[str, float] = {}
        self._question: tuple[object, ...] = ()

    @property
    def rows(self) -> tuple[ValueRow, ...]:
        """The boxes of the question now."""
        return rows_of(self._runner.tool) if self._runner.tool is not None else ()

    @property
    def editing(self) -> bool:
        """True while keys go into a box."""
        return self.row is not None

    @property
    def at(self) -> Point:
        """Where the pointer aims, mm; while it is elsewhere, the point before."""
        tool = self._runner.tool
        return self.pointer or (tool.base if tool is not None else None) or ORIGIN

    def refresh(self) -> None:
        """End what was typed for a question that is no longer asked."""
        tool = self._runner.tool
        question = (id(tool), len(tool.points), tool.prompt) if tool is not None else ()
        if question[:2] != self._question[:2] or (self.row is not None and self.row not in self.rows):
            self._end()
            self._runner.typed.release()
        self._question = question

    def begins(self, text: str) -> bool:
        """Return whether a character begins a value for the question now."""
        return text in _BEGINS and bool(self.rows)

    def begin(self, text: str = "", last: bool = False) -> None:
        """Type into the first box, or the last one."""
        self._go_to(self.rows[-1 if last else 0])
        if text:
            self._line.insert(text)
            self._edited()

    def key(self, event: QKeyEvent) -> bool:
        """Take a key while a box is typed in; return whether it was for it."""
        if self.row is None:
            return False
        key, text = event.key(), self._line.text()
        if key in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self.take()
        elif key == Qt.Key.Key_Escape:
            self.give_up()
        elif key in (Qt.Key.Key_Up, Qt.Key.Key_Down):
            self.step(-1 if key == Qt.Key.Key_Up else 1)
        elif key == Qt.Key.Key_Backspace and not text:
            self._forget(self.row)
        elif key in (Qt.Key.Key_Shift, Qt.Key.Key_Control, Qt.Key.Key_Alt, Qt.Key.Key_Meta):
            return False
        else:
            QApplication.sendEvent(self._line, event)
            if self._line.text() != text:
                self._edited()
            return event.isAccepted() or bool(event.text())
        return True

    def step(self, by: int) -> None:
        """Keep the value of this box and go to the next one, or the one before."""
        if self.row is None or self.wrong:
            return
        self._keep_numbers()
        rows = self.rows
        at = rows.index(self.row) if self.row in rows else 0
        self._go_to(rows[(at + by) % len(rows)])

    def take(self) -> None:
        """Answer the question with what is held, and the pointer for the rest; go to a box that both leave open."""
        tool = self._runner.tool
        if tool is None or not self._settled():
            return
        typed = self._runner.typed
        if typed.free:
            self._end()
            return
        lacking = typed.open(tool, self.pointer)
        if lacking is not None:
            self._go_to(next(row for row in self.rows if not row.word and row.part == lacking))
            return
        self._end()
        self._runner.click(self.at)

    def settle(self) -> bool:
        """Make ready for a click, which sets what is not held; return False where something typed is wrong."""
        if not self._settled():
            return False
        self._end()
        return True

    def give_up(self) -> None:
        """Leave everything to the pointer again."""
        self._end()
        self._runner.typed.release()

    def shown(self) -> list[RowShown]:
        """Return the boxes as they are now; none where nothing is to be said."""
        tool = self._runner.tool
        if tool is None:
            return []
        boxes = tool.boxes
        quiet = getattr(boxes, "quiet", False) and not self.editing and self._runner.typed.free
        return [self._shown(tool, row) for row in self.rows if row.word or not quiet]

    def _shown(self, tool: DrawingTool, row: ValueRow) -> RowShown:
        unit, held = self._unit(row), self._is_held(row)
        if row == self.row and self._line.text():
            return RowShown(row.box.name, self._line.text(), unit, held, self._line.cursorPosition())
        value = self._runner.typed.shown(tool, row, self.at)
        text = "" if value is None else self._text(row, value)
        return RowShown(row.box.name, text, unit, held, 0 if row == self.row else None)

    def _is_held(self, row: ValueRow) -> bool:
        return row.word in self._before if row.word else row.part in self._runner.typed.held

    def _unit(self, row: ValueRow) -> str:
        inch = self._runner.unit != 1.0
        names = {ValueKind.LENGTH: "in" if inch else "mm", ValueKind.ANGLE: "\u00b0", ValueKind.FACTOR: TIMES}
        return names.get(row.box.quantity, "")

    def _text(self, row: ValueRow, value: float) -> str:
        match row.box.quantity:
            case ValueKind.LENGTH:
                return length_label(value, self._runner.unit).removesuffix(" in")
            case ValueKind.ANGLE:
                return f"{value:.2f}"
            case ValueKind.COUNT:
                return f"{value:.0f}"
            case ValueKind.FACTOR:
                return f"{value:.4f}"

    def _go_to(self, row: ValueRow) -> None:
        self.row, self.wrong, self.doubt = row, "", ""
        self._line.clear()

    def _edited(self) -> None:
        """Hold what the text stands for, as long as it stands for something."""
        tool, row = self._runner.tool, self.row
        if tool is None or row is None:
            return
        self.wrong = self.doubt = ""
        text = self._line.text().strip()
        if not text:
            self._forget(row)
            return
        try:
            value = self._runner.read(text, row.is_length)
        except CommandError as error:
            self.wrong = error.reason
        except HitofudeError as error:
            self.wrong = str(error)
        else:
            self.wrong = self._hold(tool, row, value)
        if self.wrong:
            self._forget(row)

    def _hold(self, tool: DrawingTool, row: ValueRow, value: float | Point) -> str:
        """Hold a value, or a whole point; return why not, or ""."""
        typed = self._runner.typed
        if isinstance(value, tuple):
            if tool.boxes is None:
                return f"{row.box.name} is one value, no point."
            typed.release()
            typed.point = value
            return ""
        reason = typed.refused(tool, row, value)
        if reason:
            return reason
        if isinstance(tool, PromptTool) and row.word:
            self._before.setdefault(row.word, tool.value(row.word))
            tool.set_value(row.word, value)
        else:
            typed.hold(tool, row.part, value)
        return ""

    def _forget(self, row: ValueRow) -> None:
        """Leave a box to the pointer again, or to what stood there."""
        if not row.word:
            self._runner.typed.release(row.part)
        elif row.word in self._before:
            self._set_back(row.word)

    def _set_back(self, word: str) -> None:
        value, tool = self._before.pop(word), self._runner.tool
        if isinstance(tool, PromptTool) and word in tool.numbers:
            tool.set_value(word, value)

    def _settled(self) -> bool:
        """Keep the numbers of the tool; return False where a text is no value, or an unlikely one was not yet seen."""
        if self.wrong:
            return False
        doubt = self._doubt()
        if doubt and doubt != self.doubt:
            self.doubt = doubt
            return False
        self._keep_numbers()
        return True

    def _keep_numbers(self) -> None:
        """Leave the numbers of the tool as they were typed."""
        tool = self._runner.tool
        if isinstance(tool, PromptTool) and tool.setting in self._before:
            tool.setting = ""
        self._before.clear()

    def _doubt(self) -> str:
        """Return what is unlikely about what is typed, or ""."""
        tool, point = self._runner.tool, self._runner.typed.point
        lengths = list(map(abs, point)) if point is not None else []
        for row in self.rows:
            value = self._runner.typed.held.get(row.part) if not row.word else None
            if row.word in self._before and isinstance(tool, PromptTool):
                value = tool.value(row.word)
            if value is not None and row.box.quantity is ValueKind.COUNT and value > _MANY:
                return f"{row.box.name} {grouped(value, 0)}? Enter again takes it."
            if value is not None and row.is_length:
                lengths.append(abs(value))
        largest = max(lengths, default=0.0)
        if largest <= _IMPLAUSIBLE * self._size():
            return ""
        unit = self._runner.unit
        return f"{grouped(largest / unit, 0)} {'mm' if unit == 1.0 else 'in'}? Enter again takes it."

    def _end(self) -> None:
        self.row, self.wrong, self.doubt = None, "", ""
        for word in tuple(self._before):
            self._set_back(word)
        self._line.clear()
