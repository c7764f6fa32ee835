"""The page of the drawing's text: where it goes, the editor, find, and what is wrong or would be drawn."""

from __future__ import annotations

from PySide6.QtCore import Qt, QTimer, Signal
from PySide6.QtGui import QMouseEvent
from PySide6.QtWidgets import QButtonGroup, QLabel, QMenu, QPushButton, QToolButton, QWidget

from ...framework.boxes import h_box, v_box
from ...framework.dropping import drop
from ...framework.icons import IconButton
from ...framework.labels import restyle
from ...framework.section import hairline
from ..nc.find_bar import FindBar
from ..nc.program_text import program_text
from .editor import ShapeEditor
from .trial_runner import TextProblem

WIDTH = 420
_FIND_REST_MS = 150
_MOST_LETTERS = 105
_VERDICT_PX = 52
_ADD_TIP = "What the text draws is added to the drawing"
_REPLACE_TIP = "The drawing becomes what the text draws"


class TrialLabel(QLabel):
    """Two lines under the editor: what would be drawn, or what is wrong; a click on that goes there.

    Signals:
        pressed().
    """

    pressed = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.setWordWrap(True)
        self.setContentsMargins(12, 0, 12, 0)
        self.setFixedHeight(_VERDICT_PX)
        self.say("")

    def say(self, text: str, error: bool = False) -> None:
        """Show a sentence; of a long one the beginning, and all of it in the tool tip."""
        self.setText(text if len(text) <= _MOST_LETTERS else text[:_MOST_LETTERS].rpartition(" ")[0] + " …")
        self.setToolTip(text if len(text) > _MOST_LETTERS else "")
        self.setProperty("role", "error" if error else "muted")
        self.setCursor(Qt.CursorShape.PointingHandCursor if error else Qt.CursorShape.ArrowCursor)
        restyle(self)

    def mousePressEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Go to what is wrong."""
        self.pressed.emit()


class TextPage(QWidget):
    """The text of one drawing.

    Signals:
        edited(): the text is another. way_chosen(): add, or replace. run_requested().

    Attributes:
        menu: what else can be done; whoever does it fills it.
        problem: what is wrong with the text; None = nothing that is known.
    """

    edited = Signal()
    way_chosen = Signal()
    run_requested = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.setFixedWidth(WIDTH)
        self.editor, self.finder, self.verdict, self.menu = ShapeEditor(), FindBar(), TrialLabel(), QMenu(self)
        self.add_, self.replace = self._way("Add", _ADD_TIP), self._way("Replace", _REPLACE_TIP)
        self.add_.setChecked(True)
        self.run_button = QPushButton("Run")
        self.run_button.setProperty("role", "primary")
        self.run_button.setToolTip("Draw it (Ctrl+Enter)")
        self.run_button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.find_button, self.more = (
            IconButton("find", "Find (Ctrl+F)"),
            IconButton("more", "Text from the drawing, files, samples"),
        )
        self.problem: TextProblem | None = None
        self._told = ""
        self._finding = QTimer(self)
        self._finding.setSingleShot(True)
        self._finding.setInterval(_FIND_REST_MS)
        self._lay_out()
        self._connect()
        self.setFocusProxy(self.editor)

    @property
    def text(self) -> str:
        """What stands in the editor."""
        return self.editor.toPlainText()

    @text.setter
    def text(self, text: str) -> None:
        if text != self.text:
            self.editor.replace_text(text)

    @property
    def replaces(self) -> bool:
        """Whether the drawing becomes what the text draws; else that is added to it."""
        return self.replace.isChecked()

    def set_replaces(self, replaces: bool) -> None:
        """Choose whether the text replaces the drawing."""
        (self.replace if replaces else self.add_).setChecked(True)
        self.way_chosen.emit()

    def show_problem(self, problem: TextProblem | None) -> None:
        """Underline what is wrong and say it; None: nothing is known to be wrong."""
        self.problem = problem
        self.editor.show_wrong(*((problem.line, problem.column) if problem is not None else (0, 0)))
        if problem is not None:
            self.verdict.say(f"Line {problem.line}, column {problem.column}: {problem.reason}", error=True)

    def go_to_problem(self) -> None:
        """Put the cursor where something is wrong."""
        if self.problem is not None:
            self.editor.go_to(self.problem.line, self.problem.column)
            self.editor.setFocus()

    def begin_find(self) -> None:
        """Open the find bar; words that are taken are looked for."""
        self._give_text()
        taken = self.editor.textCursor().selectedText()
        self.finder.begin(self.editor.textCursor().blockNumber(), taken if taken and "\u2029" not in taken else None)

    def _way(self, text: str, tip: str) -> QToolButton:
        made = QToolButton()
        made.setText(text)
        made.setToolTip(tip)
        made.setAccessibleName(f"{text}: {tip}")
        made.setCheckable(True)
        made.setProperty("role", "choice")
        made.clicked.connect(self.way_chosen)
        return made

    def _lay_out(self) -> None:
        ways = QButtonGroup(self)
        head = h_box(margins=(12, 6, 8, 6), spacing=10)
        for button in (self.add_, self.replace):
            ways.addButton(button)
            head.addWidget(button)
        head.addStretch(1)
        head.addWidget(self.find_button)
        head.addWidget(self.more)
        head.addWidget(self.run_button)
        column = v_box(self, spacing=0)
        column.addLayout(head)
        column.addWidget(hairline())
        column.addWidget(self.finder)
        column.addWidget(self.editor, 1)
        column.addWidget(hairline())
        column.addWidget(self.verdict)

    def _connect(self) -> None:
        editor, finder = self.editor, self.finder
        editor.textChanged.connect(self._on_text)
        editor.run_requested.connect(self.run_requested)
        editor.find_requested.connect(self.begin_find)
        self.run_button.clicked.connect(self.run_requested)
        self.find_button.clicked.connect(self.begin_find)
        self.more.clicked.connect(lambda: drop(self.menu, self.more))
        self.verdict.pressed.connect(self.go_to_problem)
        finder.reached.connect(self._on_found)
        finder.marked.connect(lambda words, rows: editor.show_found(words))
        finder.closed.connect(editor.setFocus)
        self._finding.timeout.connect(self._give_text)

    def _on_text(self) -> None:
        if self.text == self._told:  # other colours are no other text
            return
        self._told = self.text
        if self.finder.isVisible():
            self._finding.start()
        self.edited.emit()

    def _give_text(self) -> None:
        self.finder.set_text(program_text((self.text + "\n").encode()))

    def _on_found(self, row: int, column: int) -> None:
        self.editor.go_to(row + 1, column + 1)
