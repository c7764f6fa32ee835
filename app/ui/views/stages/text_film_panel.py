"""Beside a film of the texts B to E: what the step says, what is settled otherwise, its figures, and its files."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QGridLayout, QLabel, QPushButton

from ...framework.boxes import empty
from ...framework.catalogue import tr
from ...framework.fields import ChoiceField
from ...framework.labels import muted
from ...framework.section import EDGE, hairline, heading
from ...framework.side_scroll import SideScroll
from .figure_eleven_form import FigureElevenForm

if TYPE_CHECKING:
    from ....exhibits.films.step import FilmStep, TextFilm

_MOST_ROWS = 41


class TextFilmPanel(SideScroll):
    """Words and figures of one step.

    Signals:
        own_chosen(own): make the film of one's own file, or of the text's sample. save_requested(): write all steps.

    Attributes:
        figures: label of each figure by its name.
    """

    own_chosen = Signal(bool)
    save_requested = Signal()

    def __init__(self) -> None:
        super().__init__((EDGE + 1, 12, EDGE, 12), 6)
        self.text, self.publication = heading(""), muted()
        self.source = ChoiceField("Shown on", [(False, "Sample"), (True, "Your own")])
        self.source.setToolTip("Your own: the program that NC shows; for text C the scene that Surfaces shows")
        self.source.show_value(False)
        self.title, self.says, self.settled, self.table = heading(""), QLabel(), muted(), muted()
        self.save = QPushButton("Save all steps…")
        self.save.setFixedHeight(32)
        self.figure_eleven = FigureElevenForm()
        self.figure_eleven.hide()
        self.figures: dict[str, QLabel] = {}
        self._grid = QGridLayout()
        self._lay_out()
        self.source.chosen.connect(lambda value: self.own_chosen.emit(bool(value)))
        self.save.clicked.connect(self.save_requested)
        self.show_step(None)

    def _lay_out(self) -> None:
        column = self.column
        for label in (self.text, self.publication, self.title, self.says, self.settled, self.table):
            label.setWordWrap(True)
            label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self.table.setTextFormat(Qt.TextFormat.RichText)
        self._grid.setHorizontalSpacing(12)
        self._grid.setVerticalSpacing(4)
        self._grid.setColumnStretch(0, 1)
        for widget in (self.text, self.publication, self.source, hairline(), self.title, self.says, self.settled):
            column.addWidget(widget)
        column.addSpacing(4)
        column.addLayout(self._grid)
        column.addWidget(self.table)
        column.addSpacing(6)
        column.addWidget(self.save)
        column.addWidget(self.figure_eleven)
        column.addStretch(1)

    def show_text(self, title: str, publication: str) -> None:
        """Tell of which text the film is."""
        self.text.setText(title)
        self.publication.setText(publication)
        self.figure_eleven.setVisible(title.startswith("B"))

    def show_film(self, film: TextFilm | None) -> None:
        """Offer to write a film, where there is one."""
        self.save.setEnabled(film is not None)

    def show_step(self, step: FilmStep | None) -> None:
        """Tell of another step, or of none."""
        self.title.setText(f"{step.number}  {step.name}" if step is not None else "")
        self.says.setText(step.says if step is not None else "")
        self.settled.setText(step.settled if step is not None else "")
        self.settled.setVisible(bool(step is not None and step.settled))
        empty(self._grid)
        self.figures = {}
        for row, figure in enumerate(step.figures if step is not None else ()):
            name, value = muted(figure.name), QLabel(figure.words)
            name.setWordWrap(True)
            value.setWordWrap(True)
            value.setAlignment(Qt.AlignmentFlag.AlignRight)
            value.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
            if figure.published_words:
                value.setText(f"{figure.words}\npublished: {figure.published_words}")
            self._grid.addWidget(name, row, 0)
            self._grid.addWidget(value, row, 1)
            self.figures[figure.name] = value
        rows = step.table[:_MOST_ROWS] if step is not None else ()
        self.table.setText(_table(rows))
        self.table.setVisible(bool(rows))


def _table(rows: tuple[tuple[str, ...], ...]) -> str:
    """Return a table as rich text, its first row as heads; the window translates no text with marks in it."""
    from html import escape

    if not rows:
        return ""
    head, *body = rows
    lines = ["<tr>" + "".join(f"<th align='left'>{escape(tr(cell))}&nbsp;</th>" for cell in head) + "</tr>"]
    lines += ["<tr>" + "".join(f"<td>{escape(tr(cell))}&nbsp;</td>" for cell in row) + "</tr>" for row in body]
    return "<table cellspacing='0' cellpadding='1'>" + "".join(lines) + "</table>"
