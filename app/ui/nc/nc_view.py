"""The NC view: text at the left, its path at the right; a click on either shows the other."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QEvent, QPoint, Qt, Signal
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QSplitter, QVBoxLayout, QWidget

from app.nc.read.program import Problem
from app.ui.figures import counted
from app.ui.nc.find_bar import FindBar
from app.ui.nc.heads import Banner, PathHead, TextHead
from app.ui.nc.motion_picture import MotionPicture, PathColour
from app.ui.nc.motion_shapes import Side
from app.ui.nc.path_view import PathView
from app.ui.nc.problems_list import ProblemsList
from app.ui.nc.program_text import ProgramText, program_text
from app.ui.nc.reading import Shown
from app.ui.nc.state_strip import StateStrip
from app.ui.nc.state_words import state_items
from app.ui.nc.text_view import NcTextView

_PARTS = (440, 560)


def _column(*widgets: QWidget, stretch: QWidget) -> QWidget:
    made = QWidget()
    column = QVBoxLayout(made)
    column.setContentsMargins(0, 0, 0, 0)
    column.setSpacing(0)
    for widget in widgets:
        column.addWidget(widget, 1 if widget is stretch else 0)
    return made


class NcView(QWidget):
    """Shows one program; whoever owns it decides which.

    Signals:
        side_wanted(Side): the picture of this side is missing.

    Attributes:
        shown: the program with everything that was read from it; None while only its text is known.
        side: from where the path is seen.
    """

    side_wanted = Signal(Side)
    menu_asked = Signal(QPoint)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.shown: Shown | None = None
        self.side = Side.XY
        self.head, self.banner, self.finder, self.text = TextHead(), Banner(), FindBar(), NcTextView()
        self.problems, self.path_head, self.path, self.state = ProblemsList(), PathHead(), PathView(), StateStrip()
        self.splitter = QSplitter(Qt.Orientation.Horizontal)
        self.splitter.setHandleWidth(1)
        self.splitter.setChildrenCollapsible(False)
        self.splitter.addWidget(_column(self.head, self.banner, self.finder, self.text, self.problems, stretch=self.text))
        self.splitter.addWidget(_column(self.path_head, self.path, stretch=self.path))
        self.splitter.setSizes(list(_PARTS))
        self.splitter.setStretchFactor(0, 0)
        self.splitter.setStretchFactor(1, 1)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addWidget(self.splitter, 1)
        column.addWidget(self.state)
        self.setFocusProxy(self.text)
        self._connect()

    def _connect(self) -> None:
        self.text.rows_picked.connect(self._on_rows)
        self.text.menu_asked.connect(self.menu_asked)
        self.path.motion_picked.connect(self.pick_motion)
        self.problems.picked.connect(self.go_to_problem)
        self.head.find_asked.connect(self.begin_find)
        self.finder.reached.connect(self._on_found)
        self.finder.marked.connect(self.text.show_found)
        self.finder.closed.connect(self.text.setFocus)
        self.path_head.side_chosen.connect(self.set_side)
        self.path_head.colour_chosen.connect(self.set_colour)

    def show_text(self, name: str, text: ProgramText) -> None:
        """Show a text whose motions are not known yet."""
        self.shown = None
        self.head.show_program(name, counted(len(text), "line"))
        self.text.show_text(text)
        self.finder.set_text(text)
        self.problems.show_problems(())
        self.path.show_picture(None)
        self.state.show_items([])

    def show_program(self, shown: Shown) -> None:
        """Show a program that was read; of the same text, the picked line stays."""
        if shown.text.text != self.text.text.text:
            self.show_text(shown.source.name, shown.text)
        self.shown = shown
        self.head.show_program(shown.source.name, counted(len(shown.text), "line"))
        self.text.show_looks(shown.looks)
        self.problems.show_problems(shown.program.problems)
        self._show_side()
        self.path.fit_now()
        error = shown.program.error
        if error is not None:
            self.go_to_problem(error)
        elif self.text.current >= 0:
            self._on_rows(*self.text.selection)

    def clear(self) -> None:
        """Show nothing."""
        self.show_text("", program_text(b""))

    def add_picture(self, picture: MotionPicture) -> None:
        """Take the picture of a side that was missing."""
        if self.shown is not None and picture.shapes is self.shown.shapes:
            self.shown.pictures[picture.side] = picture
            if picture.side is self.side:
                self._show_side()
                self.path.fit_now()

    def set_side(self, side: Side) -> None:
        """Look at the path from above or from a side."""
        self.side = side
        self.path_head.side.show_value(side)
        if self.shown is None:
            return
        if side in self.shown.pictures:
            self._show_side()
            self.path.fit_now()
        else:
            self.side_wanted.emit(side)

    def set_colour(self, colour: PathColour) -> None:
        """Let colours tell the tool or the kind of motion."""
        self.path_head.colour.show_value(colour)
        self.path.set_colour(colour)
        self.text.set_colour(colour)

    def pick_motion(self, motion: int) -> None:
        """Mark the line of a motion, light the motion up and say what is in force."""
        if self.shown is None:
            return
        row = int(self.shown.program.motions.line[motion]) - 1
        self.text.pick(row, tell=False)
        self.path.light(np.array([motion]))
        self.state.show_items(state_items(self.shown.shapes, row, motion, self.shown.times))

    def go_to_problem(self, problem: Problem) -> None:
        """Go to the place of a problem."""
        self.text.pick(problem.line - 1)
        self.text.bring_into_sight(problem.line - 1, max(problem.column - 1, 0))

    def go_to_line(self, line: int) -> None:
        """Go to a line, 1-based."""
        self.text.pick(line - 1)

    def begin_find(self, words: str | None = None) -> None:
        """Open the find bar."""
        self.finder.begin(self.text.current, words)

    def find_next(self, back: bool = False) -> None:
        """Go to the next place of what was looked for, or ask what to look for."""
        if self.finder.edit.text():
            self.finder.step(back)
        else:
            self.begin_find()

    def event(self, event: QEvent) -> bool:
        """Keep F3 from the drawing: here it finds the next place."""
        if event.type() == QEvent.Type.ShortcutOverride and isinstance(event, QKeyEvent) and event.key() == Qt.Key.Key_F3:
            event.accept()
            return True
        return super().event(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802 (Qt's name)
        """F3 finds, F fits the path."""
        if event.key() == Qt.Key.Key_F3:
            self.find_next(back=bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier))
        elif event.key() == Qt.Key.Key_F and not event.modifiers():
            self.path.fit()
        elif event.key() == Qt.Key.Key_Escape and self.finder.isVisible():
            self.finder.close_bar()
        else:
            super().keyPressEvent(event)

    def _show_side(self) -> None:
        if self.shown is not None:
            self.path.show_picture(self.shown.pictures.get(self.side))
            if self.text.current >= 0:
                self.path.light(self.shown.shapes.of_rows(*self.text.selection))

    def _on_found(self, row: int, column: int) -> None:
        self.text.pick(row)
        self.text.bring_into_sight(row, column)

    def _on_rows(self, first: int, last: int) -> None:
        """Light up what picked lines move, and say what is in force at the last of them."""
        if self.shown is None:
            return
        self.path.light(self.shown.shapes.of_rows(first, last))
        self.path.bring_into_sight()
        self.state.show_items(state_items(self.shown.shapes, self.text.current, None, self.shown.times))

