"""The NC text beside the cut: the line that is being cut, and the way back from a line to the cut."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QWidget

from ...framework.boxes import h_box, v_box
from ...framework.figures import grouped
from ...framework.labels import Elided
from ...framework.section import EDGE, heading
from ..nc.text_view import NcTextView
from .shown_cut import ShownCut


class NcBeside(QWidget):
    """Shows the file of a cut program that holds the motion that is looked at.

    Signals:
        line_picked(file, row): the user chose a line, 0-based, of one of the files.

    Attributes:
        text: the lines. where: which of them is marked, and what it belongs to.
        motion: that is marked, of all files; -1 = none.
    """

    line_picked = Signal(int, int)

    def __init__(self) -> None:
        super().__init__()
        self.text, self.where = NcTextView(), Elided(role="muted")
        self.motion = -1
        self._shown: ShownCut | None = None
        self._file = 0
        head = h_box(margins=(EDGE, 0, EDGE, 0), spacing=12)
        head.addWidget(heading("NC"))
        head.addWidget(self.where, 1)
        column = v_box(self, (0, 4, 0, 0), 6)
        column.addLayout(head)
        column.addWidget(self.text, 1)
        self.text.rows_picked.connect(lambda first, last: self.line_picked.emit(self._file, last))

    def show_cut(self, shown: ShownCut | None) -> None:
        """Show the text of another program, from its beginning."""
        self._shown, self.motion = shown, -1
        self._file = 0
        if shown is None:
            self.text.clear()
        else:
            self._show_file(0)
        self._say("")

    def mark(self, motion: int, words: str = "") -> None:
        """Mark the line of a motion; -1 marks none.

        Args:
            motion: of all files. words: what it belongs to.
        """
        shown = self._shown
        if shown is None or shown.picture.moves is None or motion < 0:
            self.motion = -1
            self.text.pick_rows(-1, -1, tell=False)
            self._say("")
            return
        self.motion = motion
        if (file := shown.file_of(motion)) != self._file:
            self._show_file(file)
        row = int(shown.picture.moves.line[motion]) - 1
        if row != self.text.current:
            self.text.pick(row, tell=False)
        self._say(words, row)

    def _show_file(self, file: int) -> None:
        assert self._shown is not None
        self._file = file
        self.text.show_text(self._shown.texts[file])
        self.text.show_looks(self._shown.marks[file])

    def _say(self, words: str, row: int = -1) -> None:
        """Tell which line is marked, and of how many there are."""
        if self._shown is None:
            self.where.setText("")
            return
        count = grouped(len(self._shown.texts[self._file]), 0)
        several = f"{self._shown.names[self._file]} · " if len(self._shown.names) > 1 else ""
        place = f"line {row + 1} of {count}" if row >= 0 else f"{count} lines in all"
        self.where.setText(several + " · ".join(filter(None, (place, words))))
