"""What the page of the text does: tries what is typed, runs it, fills it from the drawing, and keeps it for each
drawing.
"""

from __future__ import annotations

from functools import partial
from pathlib import Path

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QFileDialog

from ....core.atomic import read_whole, write_atomically
from ....core.errors import InputError
from ....core.resources import resource
from ....drafting.difference import DrawingDifference
from ....drafting.document import DocumentChange
from ....drafting.language.write import draw_text
from ...framework.commands import Commands
from ...framework.controller import Controller
from ...framework.figures import counted
from ...framework.workspace import Workspace
from .blocks import KnownName
from .command_runner import CommandRunner
from .completion import names_of
from .page import TextPage
from .trial_runner import TextProblem, TextTrial, TrialRunner

FILTER = "Shape language (*.draw);;All files (*)"
_MOST_BYTES = 20_000_000


class TextController(Controller):
    """Connects the page of the text with the document.

    Signals:
        tried(Difference): what the text would change, to be shown over the drawing.

    Attributes:
        page: the widgets.
    """

    tried = Signal(DrawingDifference)

    def __init__(self, page: TextPage, lines: CommandRunner, workspace: Workspace, commands: Commands) -> None:
        super().__init__(page)
        self._document, self._lines, self._commands = workspace.document, lines, commands
        self._preferences = workspace.preferences
        self.page, self.trial_runner = page, TrialRunner(self)
        self._seen = False
        self._kept: dict[Path | None, tuple[str, bool]] = {}
        self._path = self._document.path
        self._done = ""
        self._running = ""
        self._fill_menu()
        self.page.editor.names = self._names
        self.page.edited.connect(self._ask)
        self.page.way_chosen.connect(self._ask)
        self.page.run_requested.connect(self.run)
        self.trial_runner.answered.connect(self._show)
        self.trial_runner.progress.connect(
            lambda fraction, _: self.page.verdict.say(f"Trying … {100 * fraction:.0f} %")
        )
        lines.ran.connect(self._on_ran)
        workspace.activity.ended.connect(self.trial_runner.leave)
        self._document.subscribe(self._follow)

    @property
    def text(self) -> str:
        """What stands in the editor, for whoever keeps it."""
        return self.page.text

    @text.setter
    def text(self, text: str) -> None:
        self.page.text = text

    @property
    def is_drawn(self) -> bool:
        """Whether the drawing is what the text draws."""
        return self.page.text == self._done

    def open(self) -> None:
        """Bring the page to the front, with the cursor in it."""
        self.front_requested.emit()
        self.page.editor.setFocus()

    def run(self) -> None:
        """Add what the text draws, or let the drawing become it; undone as one step."""
        text = self.page.text
        if not text.strip():
            self.page.verdict.say("There is nothing to run; type a line such as  circle 30,20 8.")
        elif self.page.problem is not None:
            self.page.go_to_problem()
        elif not self._lines.busy:
            self._running = text
            self.trial_runner.leave()
            self.tried.emit(DrawingDifference())
            self._lines.run(f"clear\n{text}" if self.page.replaces else text)

    def fill_from_drawing(self) -> None:
        """Write what is drawn, curve by curve."""
        written = draw_text(self._document.part)
        self._fill(written.text)
        if written.left_out:
            self.page.verdict.say(
                f"{counted(written.left_out, 'curve')} shorter than what the program welds are left out."
            )

    def fill_from_log(self) -> None:
        """Write the lines that drew what is drawn."""
        try:
            self._fill(self._document.recorded.text())
        except InputError as error:
            self.page.verdict.say(str(error))

    def open_file(self, path: Path) -> None:
        """Write what a file holds; Ctrl+Z in the editor brings back what stood there."""
        try:
            data = read_whole(path)
            if len(data) > _MOST_BYTES:
                raise InputError(f"{path.name} has {len(data)} bytes; at most {_MOST_BYTES} are read.")
            self._fill(data.decode("utf-8-sig"), drawn=False)
        except UnicodeDecodeError:
            self.page.verdict.say(f"{path.name} is no text in UTF-8; save it as plain text.", error=True)
        except OSError as error:
            self.page.verdict.say(f"{path.name} cannot be read: {error.strerror}.", error=True)
        except InputError as error:
            self.page.verdict.say(str(error), error=True)

    def save_file(self, path: Path) -> None:
        """Write the text to a file."""
        try:
            write_atomically(path, self.page.text.encode())
        except InputError as error:
            self.page.verdict.say(str(error), error=True)
        else:
            self.page.verdict.say(f"{path.name} is written.")

    def _fill_menu(self) -> None:
        menu = self.page.menu
        menu.addAction("From the &drawing", self.fill_from_drawing)
        menu.addAction("From the &log", self.fill_from_log)
        menu.addSeparator()
        menu.addAction("&Open…", self._choose_file)
        menu.addAction("&Save as…", self._choose_place)
        menu.addSeparator()
        samples = menu.addMenu("S&amples")
        for path in sorted(resource("samples").glob("*.draw")):
            samples.addAction(path.stem.replace("-", " ").capitalize(), partial(self.open_file, path))
        menu.addSeparator()
        menu.addAction("&Remark, or not\tCtrl+/", self.page.editor.switch_remarks)
        menu.addAction(self._commands["help_language"])

    def _choose_file(self) -> None:
        name, _ = QFileDialog.getOpenFileName(self.page, "Open text", self._preferences.settings.last_folder, FILTER)
        if name:
            self.open_file(Path(name))

    def _choose_place(self) -> None:
        stem = self._document.path.stem if self._document.path else self._document.part.name
        start = str(self._preferences.last_folder / f"{stem}.draw")
        name, _ = QFileDialog.getSaveFileName(self.page, "Save text", start, FILTER)
        if name:
            self.save_file(Path(name))

    def _fill(self, text: str, drawn: bool = True) -> None:
        """Put a text in the editor that replaces the drawing; `drawn`: it is what is drawn already."""
        self.page.text = text
        self._done = text if drawn else ""
        self.page.set_replaces(True)
        self.page.editor.setFocus()

    def _names(self) -> list[KnownName]:
        return names_of(self._document.session)

    @property
    def _in_front(self) -> bool:
        return self.page.isVisible() and self._seen

    def see(self, seen: bool) -> None:
        """Try the text while what it draws can be seen."""
        self._seen = seen
        self._ask()

    def _ask(self) -> None:
        """Try the text soon, where that is seen and not drawn already; what was shown before stays until then."""
        text = self.page.text
        self.page.show_problem(None)
        if not self._in_front or not text.strip() or text == self._done:
            self.tried.emit(DrawingDifference())
            self.trial_runner.leave()
            self.page.verdict.say("This is drawn." if text == self._done and text.strip() else "")
            return
        self.trial_runner.ask(text, self._document.session, self.page.replaces)

    def _show(self, answer: TextProblem | TextTrial) -> None:
        if isinstance(answer, TextProblem):
            self.page.show_problem(answer)
            return
        self.tried.emit(answer.change)
        come, go = len(answer.change.added), len(answer.change.gone)
        words = [f"{counted(come, 'curve')} would come"] * bool(come) + [f"{counted(go, 'curve')} would go"] * bool(go)
        self.page.verdict.say(f"{', '.join(words)}; Ctrl+Enter draws." if words else "Nothing would change.")

    def _on_ran(self, line: str, well: bool) -> None:
        if self._running and line.endswith(self._running):
            self._done = self._running if well else self._done
            self._running = ""
            self._ask()

    def _follow(self, change: DocumentChange) -> None:
        if DocumentChange.LOADED in change:
            self._kept.pop(self._path, None)
            if self.page.text or self.page.replaces:
                self._kept[self._path] = (self.page.text, self.page.replaces)
            if self._document.path != self._path:
                text, replaces = self._kept.get(self._document.path, ("", False))
                self._done = ""
                self.page.text = text
                self.page.set_replaces(replaces)
        self._path = self._document.path
        if DocumentChange.PART in change and not self._running:
            self._done = ""
            self.tried.emit(DrawingDifference())
            self._ask()
