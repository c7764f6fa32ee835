"""Beside a program that is not the job's: what it is, as far as its text tells."""

from __future__ import annotations

from PySide6.QtWidgets import QWidget

from ....gcode.interpreter.dialect import DIALECT_RULES
from ....gcode.interpreter.program import ToolNote
from ...framework.boxes import h_box, put_away, v_box
from ...framework.figures import clock, grouped
from ...framework.labels import Elided, muted
from ...framework.section import EDGE, PanelSection, hairline
from ...framework.side_scroll import SideScroll
from .program_reader import ShownProgram

FACTS = ("Name", "Control", "Motions", "Length", "Time", "Cuts in X", "Cuts in Y", "Cuts in Z")
_NAME_PX, _ROW_PX = 84, 24


class ProgramPanel(SideScroll):
    """Control, size, time and tools of one program.

    Attributes:
        facts: what stands in each row of the first section, by the row's name. tools: the lines of the second.
    """

    def __init__(self) -> None:
        super().__init__((1, 4, 0, 8))
        self._of_program, self._of_tools = PanelSection("Program"), PanelSection("Tools")
        self.facts = {name: Elided() for name in FACTS}
        for name, value in self.facts.items():
            self._of_program.add_indented(_row(name, value))
        self.tools: list[str] = []
        self._tool_rows: list[QWidget] = []
        self._tool_column = v_box(margins=(EDGE, 0, EDGE, 0), spacing=0)
        self._of_tools.rows.addLayout(self._tool_column)
        column = self.column
        for each in (self._of_program, hairline(), self._of_tools):
            column.addWidget(each)
        column.addStretch(1)

    def show_program(self, shown: ShownProgram | None) -> None:
        """Show what is known of a program; None = it is still being read."""
        for name, text in _facts(shown).items():
            self.facts[name].setText(text)
        for row in self._tool_rows:
            put_away(row)
        notes = {note.number: note for note in shown.program.tools} if shown is not None else {}
        used = sorted(set(shown.shapes.tool.tolist())) if shown is not None else []
        self.tools = [_tool_words(notes.get(number)) for number in used]
        self._tool_rows = [
            _row(f"T{number}" if number else "No T", Elided(words))
            for number, words in zip(used, self.tools, strict=True)
        ]
        for row in self._tool_rows:
            self._tool_column.addWidget(row)


def _row(name: str, value: Elided) -> QWidget:
    label, row = muted(name), QWidget()
    label.setFixedWidth(_NAME_PX)
    row.setFixedHeight(_ROW_PX)
    line = h_box(row)
    line.addWidget(label)
    line.addWidget(value, 1)
    return row


def _facts(shown: ShownProgram | None) -> dict[str, str]:
    if shown is None:
        return dict.fromkeys(FACTS, "")
    guess = " (by its looks)" if shown.source.dialect is None else ""
    said = [
        shown.source.name,
        f"{DIALECT_RULES[shown.dialect].title}{guess}",
        grouped(len(shown.shapes), 0),
        f"{grouped(float(shown.shapes.length.sum()), 0)} mm",
        clock(shown.times.total),
    ]
    cuts = ~shown.times.rapid if len(shown.times.rapid) == len(shown.shapes) else slice(None)
    low, high = shown.shapes.low[cuts], shown.shapes.high[cuts]
    ends = zip(low.min(axis=0).tolist(), high.max(axis=0).tolist(), strict=True) if len(low) else ()
    extents = [f"{grouped(least)} … {grouped(most)} mm" for least, most in ends]
    return dict(zip(FACTS, [*said, *(extents or [""] * 3)], strict=True))


def _tool_words(note: ToolNote | None) -> str:
    """Return what the comments tell of a tool."""
    if note is None or not (note.kind or note.diameter):
        return "not described"
    return " ".join(filter(None, (note.kind, f"{note.diameter:g} mm" if note.diameter else "")))
