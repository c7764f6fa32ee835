"""What is wrong with the program, under its text; a row jumps to its place. Nothing wrong, nothing to see."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QLabel, QListWidget, QListWidgetItem, QVBoxLayout, QWidget

from app.nc.read.program import Problem, Severity
from app.ui.figures import counted
from app.ui.theme import LIGHT, Theme

_MOST, _SEEN, _ROW_PX = 500, 5, 24


class ProblemsList(QWidget):
    """Errors and warnings in the order of the text.

    Signals:
        picked(problem): the user wants to see its place.
    """

    picked = Signal(Problem)

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("ncProblems")
        self.setAttribute(Qt.WidgetAttribute.WA_StyledBackground)
        self.title, self.list = QLabel(), QListWidget()
        self.list.setAccessibleName("Problems of the program")
        self.list.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.list.setTextElideMode(Qt.TextElideMode.ElideRight)
        self.list.setUniformItemSizes(True)
        self.list.itemActivated.connect(self._pick)
        self.list.itemClicked.connect(self._pick)
        self.problems: tuple[Problem, ...] = ()
        self._theme: Theme = LIGHT
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 8, 0, 8)
        column.setSpacing(4)
        self.title.setContentsMargins(12, 0, 12, 0)
        column.addWidget(self.title)
        column.addWidget(self.list)
        self.hide()

    def set_theme(self, theme: Theme) -> None:
        """Follow the theme."""
        self._theme = theme
        self._fill()

    def show_problems(self, problems: Sequence[Problem]) -> None:
        """List problems; hide when there are none."""
        self.problems = tuple(sorted(problems, key=lambda problem: (problem.line, problem.column)))
        errors = sum(problem.severity is Severity.ERROR for problem in problems)
        warnings = len(problems) - errors
        words = [counted(errors, "error") if errors else "", counted(warnings, "warning") if warnings else ""]
        self.title.setText(", ".join(filter(None, words)))
        self._fill()
        self.setVisible(bool(problems))

    def step(self, way: int) -> None:
        """Go to the problem `way` rows farther down, round at the ends."""
        if self.problems:
            now = self.list.currentRow()
            row = (now + way) % min(len(self.problems), _MOST) if now >= 0 else 0 if way > 0 else len(self.problems) - 1
            self.list.setCurrentRow(row)
            self._pick(self.list.item(row))

    def _fill(self) -> None:
        self.list.clear()
        for problem in self.problems[:_MOST]:
            place = f"{problem.line}:{problem.column}" if problem.column else f"{problem.line}"
            item = QListWidgetItem(f"{place}   {problem.word + ': ' if problem.word else ''}{problem.text}")
            item.setToolTip(problem.text)
            item.setForeground(QColor(self._theme.error if problem.severity is Severity.ERROR else self._theme.warning))
            self.list.addItem(item)
        self.list.setFixedHeight(_ROW_PX * min(max(len(self.problems), 1), _SEEN) + 2)

    def _pick(self, item: QListWidgetItem) -> None:
        self.picked.emit(self.problems[self.list.row(item)])
