"""One program as text: its head, find, the lines, and what is wrong with them."""

from __future__ import annotations

from dataclasses import replace

from PySide6.QtCore import QPoint, Signal
from PySide6.QtWidgets import QWidget

from ....gcode.interpreter.program import ProgramProblem
from ...framework.boxes import v_box
from ...framework.figures import counted
from .find_bar import FindBar
from .heads import Banner, TextHead
from .line_marks import Ints, line_marks
from .places import in_order, problem_places
from .places_panel import PlacesPanel
from .program_reader import ShownProgram
from .program_text import ProgramText
from .text_view import NcTextView


class TextPane(QWidget):
    """Head, banner, find bar, text, problems.

    Signals:
        rows_picked(first, last): lines, 0-based, both included. menu_requested(point): on the screen.

    Attributes:
        shown: what was read of the text; None while only the text is known.
    """

    rows_picked = Signal(int, int)
    menu_requested = Signal(QPoint)

    def __init__(self, closable: bool = False) -> None:
        super().__init__()
        self.shown: ShownProgram | None = None
        self.head, self.banner, self.finder, self.text = TextHead(closable), Banner(), FindBar(), NcTextView()
        self.panel = PlacesPanel("problem", "F4")
        self.problems: tuple[ProgramProblem, ...] = ()
        column = v_box(self, spacing=0)
        for widget in (self.head, self.banner, self.finder, self.text, self.panel):
            column.addWidget(widget, 1 if widget is self.text else 0)
        self.setFocusProxy(self.text)
        self.text.rows_picked.connect(self.rows_picked)
        self.text.menu_requested.connect(self.menu_requested)
        self.panel.picked.connect(lambda index: self.go_to_problem(self.problems[index]))
        self.head.find_requested.connect(self.begin_find)
        self.finder.reached.connect(self._on_found)
        self.finder.marked.connect(self.text.show_found)
        self.finder.closed.connect(self.text.setFocus)

    def show_text(self, name: str, text: ProgramText) -> None:
        """Show a text that nothing is known of yet."""
        self.shown = None
        self.head.show_program(name, counted(len(text), "NC line") if name else "")
        self.text.show_text(text)
        self.finder.set_text(text)
        self.finder.close_quietly()
        self._show_problems(())

    def show_program(self, shown: ShownProgram) -> None:
        """Show a program that was read; of the same text, the picked line stays."""
        if shown.text.text != self.text.text.text:
            self.show_text(shown.source.name, shown.text)
        self.shown = shown
        self.head.show_program(shown.source.name, counted(len(shown.text), "NC line"))
        self.text.show_looks(shown.looks)
        self._show_problems(shown.program.problems)

    def mark_differing(self, rows: Ints) -> None:
        """Mark the rows (k,) that another program has not alike; none = no other program."""
        looks = self.shown.looks if self.shown is not None else line_marks(len(self.text.text))
        self.text.show_looks(replace(looks, differing=rows))

    def go_to_problem(self, problem: ProgramProblem) -> None:
        """Go to the place of a problem."""
        self.text.pick(problem.line - 1)
        self.text.bring_into_sight(problem.line - 1, max(problem.column - 1, 0))

    def go_to_rows(self, first: int, last: int, tell: bool = True) -> None:
        """Mark lines (0-based, both included) and bring the first into sight."""
        self.text.pick_rows(last, first, tell)
        self.text.bring_into_sight(first)

    def begin_find(self, words: str | None = None) -> None:
        """Open the find bar."""
        self.finder.begin(self.text.current, words)

    def find_next(self, back: bool = False) -> None:
        """Go to the next place of what was looked for, or ask what to look for."""
        if self.finder.edit.text():
            self.finder.step(back)
        else:
            self.begin_find()

    def _show_problems(self, problems: tuple[ProgramProblem, ...]) -> None:
        self.problems = in_order(problems)
        self.panel.show_places(*problem_places(self.problems))

    def _on_found(self, row: int, column: int) -> None:
        self.text.pick(row)
        self.text.bring_into_sight(row, column)
