"""What the NC view shows: the job's program, or another that was opened; reads it in the background."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QFileDialog

from ....core.atomic import write_atomically
from ....core.errors import HitofudeError
from ....gcode.interpreter.dialect import Dialect
from ....gcode.interpreter.options import ToolOffset
from ....gcode.interpreter.program import Severity
from ....model.finding import Finding, FindingKind
from ....model.job import Job
from ....model.part import Units
from ...framework.computation import ComputationState
from ...framework.controller import Controller, ShownDocument
from ...framework.figures import clock, counted
from ...framework.verdict import VerdictLevel, VerdictSummary
from ...framework.workspace import Workspace
from .jobs import ComparedWith, ProjectedProgram, compared, framed, projected, restarted
from .motion_shapes import ViewSide
from .places import difference_places
from .program_reader import FILTER, ProgramReader, ProgramSource, ShownProgram
from .program_text import program_text
from .view import NcView

if TYPE_CHECKING:
    from ....usecases.making.make import MakeResult

MOST_TOOLS = 9999
"""The highest T number of a tool."""


def tool_table(job: Job) -> dict[int, ToolOffset]:
    """Return a job's tools as the tool table that other programs are read with; of tools that it has not nothing is
    known, as without a table.
    """
    known = {tool.number: ToolOffset(diameter=tool.diameter) for tool in job.tools}
    return dict.fromkeys(range(1, MOST_TOOLS + 1), ToolOffset()) | known


class NcController(Controller):
    """Decides what the NC view shows; the drawing and its job are never touched from here.

    Signals:
        changed(): another program, or none, is shown. cut_requested(ShownProgram | None): the cut of another program
            than the job's shall be shown; None = the job's. export_requested(): of the job. compute_requested(): the
            job.
    """

    cut_requested = Signal(object)
    export_requested = Signal()
    compute_requested = Signal()

    def __init__(self, view: NcView, workspace: Workspace) -> None:
        super().__init__(view)
        self._view, self._workspace, self._log = view, workspace, workspace.log
        self._document, self._computation = workspace.document, workspace.computation
        self._preferences = workspace.preferences
        self._seen = False
        self._own: tuple[ProgramSource, ...] = ()
        self._own_at = 0
        self._foreign: ProgramSource | None = None
        self._made: object = None
        self._picked: int | None = None
        self.reading = ProgramReader(self)
        self.reading.failed.connect(self.failed)
        workspace.activity.follow(self.reading.worker)
        self._computation.changed.connect(self._follow)
        self._view.side_requested.connect(self._draw_side)
        self._view.comparison_closed.connect(self.stop_comparing)
        self._view.pane.head.dialect_chosen.connect(self._read_as)
        self._view.pane.banner.pressed.connect(self._on_banner)
        self._view.pane.head.file_chosen.connect(self._show_file)

    @property
    def source(self) -> ProgramSource | None:
        """What is shown, or is about to be."""
        return self._foreign or (self._own[self._own_at] if self._own else None)

    @property
    def shown(self) -> ShownProgram | None:
        """The program that is shown, once it is read."""
        return self._view.shown

    def see(self, seen: bool) -> None:
        """Remember whether the view is at the front."""
        self._seen = seen

    def bring(self) -> None:
        """Have the view at the front, if it is not."""
        if not self._seen:
            self.front_requested.emit()

    @property
    def foreign(self) -> bool:
        """Whether another program than the job's is shown."""
        return self._foreign is not None

    @property
    def shown_document(self) -> ShownDocument | None:
        """Another program than the job's, and what reading it has shown; None = the job's."""
        source, shown = self._foreign, self._view.shown
        if source is None or shown is None:
            return None
        error = shown.program.error
        if error is None:
            tip = "It was read, and nothing else is known of it; Show cut cuts it out of a stock."
            verdict = VerdictSummary(VerdictLevel.NONE, f"No error in the text · {clock(shown.times.total)}", tip)
            return ShownDocument(source.name, source.path is None, verdict)
        verdict = VerdictSummary(VerdictLevel.BAD, f"Error in line {error.line}", error.text)
        finding = Finding(FindingKind.PROGRAM, f"Line {error.line}: {error.text}", line=error.line)
        return ShownDocument(source.name, source.path is None, verdict, (finding,), self._look_at)

    def _look_at(self, finding: Finding) -> None:
        """Go to the line of an error."""
        self.front_requested.emit()
        self._view.pane.go_to_rows(finding.line - 1, finding.line - 1)

    def open(self, path: Path) -> None:
        """Show the program of a file; until it is read, what was there stays."""
        self._read(ProgramSource(path.name, path=path), remember=True)

    def choose(self) -> None:
        """Ask for a program and open it."""
        name, _ = QFileDialog.getOpenFileName(
            self._view, "Open NC program", self._preferences.settings.last_folder, FILTER
        )
        if name:
            self.open(Path(name))

    def show_text(self, source: ProgramSource) -> None:
        """Show a program that is in no file yet."""
        self._read(source)

    def restart_here(self) -> None:
        """Make a program that leads in to the picked line and goes on from there, and show it."""
        shown, row = self._view.shown, self._view.pane.text.selection[0]
        if shown is None or row < 0:
            self.said.emit("Pick the line to start from first.")
        else:
            self.reading.start(partial(restarted, shown, row + 1, self._view.side), partial(self._on_foreign, False))

    def show_cut(self) -> None:
        """Have what the shown program leaves of its stock shown."""
        if self._foreign is not None and self._view.shown is not None:
            self.cut_requested.emit(self._view.shown)
        else:
            self.cut_requested.emit(None)

    def show_frame(self) -> None:
        """Show the program that goes round the job's cuts at clearance height."""
        made = self._computation.made
        if made is None or not made.files:
            self.said.emit("There is no program to go round yet; compute the paths first.")
        else:
            whole = self._own_name(made)
            name = f"{whole.stem}_frame{whole.suffix}"
            self.reading.start(partial(framed, made, name, self._view.side), partial(self._on_foreign, False))

    def choose_to_compare(self) -> None:
        """Ask for a second program and compare it with the one that is shown."""
        name, _ = QFileDialog.getOpenFileName(
            self._view, "Compare with", self._preferences.settings.last_folder, FILTER
        )
        if name:
            self.compare(Path(name))

    def compare(self, path: Path) -> None:
        """Compare the shown program with that of a file, which is shown beside it."""
        shown, side = self._view.shown, self._view.side
        if shown is not None:
            self.reading.start(
                partial(
                    compared, shown, ProgramSource(path.name, path=path, tools=tool_table(self._document.job)), side
                ),
                self._on_compared,
            )

    def stop_comparing(self) -> None:
        """Take the second program away."""
        self._view.show_comparison(None)
        self.changed.emit()

    def _on_compared(self, answer: ComparedWith) -> None:
        shown, both = answer
        if shown is not self._view.shown:
            return
        title = difference_places(both.differences).title
        self._log.note(f"compare {both.other.source.name}", title)
        self._view.other.head.show_dialect(both.other.guessed, both.other.source.dialect, free=False)
        self.front_requested.emit()
        self._view.show_comparison(both)
        self.changed.emit()

    def back(self) -> None:
        """Show the job's program again."""
        if self._foreign is not None:
            self._foreign = None
            self._show_own()

    def save_as(self) -> None:
        """Write the shown text to a file; the job's program is exported, with its findings."""
        if self._foreign is None:
            self.export_requested.emit()
            return
        start = str(self._preferences.last_folder / self._foreign.name)
        name, _ = QFileDialog.getSaveFileName(self._view, "Save NC program", start, FILTER)
        if name:
            self.save(Path(name))

    def save(self, path: Path) -> None:
        """Write the shown program, byte for byte, to a file: whole or not at all."""
        shown = self._view.shown
        if shown is None or shown.source.data is None:
            return
        try:
            write_atomically(path, shown.source.data)
        except HitofudeError as error:
            self.failed.emit(str(error))
            return
        self._log.note(f"save {path.name}", f"{counted(len(shown.text), 'line')} written to {path}")
        self.said.emit(f"{path.name} is written.")

    def _read(self, source: ProgramSource, remember: bool = False) -> None:
        self.reading.read(
            replace(source, tools=tool_table(self._document.job)), self._view.side, partial(self._on_foreign, remember)
        )

    def _on_foreign(self, remember: bool, shown: ShownProgram) -> None:
        source = shown.source
        again = self._foreign is not None and self._foreign.path == source.path and self._foreign.name == source.name
        self._foreign = source
        if remember and source.path is not None:
            self._preferences.add_recent(source.path)
        self._view.show_program(shown)
        self._show_heads(shown.guessed)
        if not again:
            self._workspace.notice.turn_over()
            self._log.note(f"open {source.name}", _sentence(shown), error=shown.program.error is not None)
            self.front_requested.emit()
            self._view.setFocus()
            if shown.unnamed and source.units is None and source.path is not None:
                self._ask_for_units(source.name)
        self.changed.emit()

    def _ask_for_units(self, name: str) -> None:
        """Say in which units a program that names none was read, and offer the others."""
        from ....formats.reading_question import UNIT_WORDS

        keep, other = UNIT_WORDS[Units.MM], UNIT_WORDS[Units.INCH]
        self._workspace.notice.ask(
            f"{name} names no units (G20, G21); it was read in {keep}.",
            [
                (f"Keep {keep}", lambda: None),
                (f"Read in {other}", self._read_in_inch),
            ],
        )
        self._workspace.notice.show_with(self._view)

    def _read_in_inch(self) -> None:
        if self._foreign is not None:
            self._read(replace(self._foreign, units=Units.INCH))

    def _read_as(self, dialect: Dialect | None) -> None:
        if self._foreign is not None:
            self._read(replace(self._foreign, dialect=dialect))

    def _follow(self) -> None:
        """Show the job's program when it was computed anew, unless another one is looked at."""
        made = self._computation.made
        if made is not self._made:
            self._made = made
            self._own, self._own_at = self._own_sources(), 0
            if self._foreign is None:
                self._show_own()
        self._show_heads()

    def _own_sources(self) -> tuple[ProgramSource, ...]:
        from ....gcode.posts import load_post

        made = self._computation.made
        if made is None:
            return ()
        post, whole = load_post(made.job.post), self._own_name(made)
        return tuple(
            ProgramSource(file.named(whole).name, file.nc.text.encode(), dialect=post.dialect) for file in made.files
        )

    def _own_name(self, made: MakeResult) -> Path:
        from ....gcode.posts import load_post

        path = self._document.path
        return Path(f"{path.stem if path else made.job.part.name}{load_post(made.job.post).extension}")

    def _show_file(self, index: int) -> None:
        self._own_at = index
        self._show_own()

    def pick_motion(self, file: int, motion: int) -> None:
        """Mark the line of a motion, once its program is read.

        Args:
            file: of the job's files; 0 for another program. motion: its row in that file.
        """
        self._picked = motion
        if self._foreign is None and self._own_at != file:
            self._show_file(file)
        elif self._view.shown is not None:
            self._pick()

    def _pick(self) -> None:
        motion, self._picked = self._picked, None
        if motion is not None:
            self._view.pick_motion(motion)
            self._view.path.bring_into_sight()

    def _show_own(self) -> None:
        source = self.source
        self._view.show_text(
            source.name if source is not None else "", program_text(source.bytes() if source is not None else b"")
        )
        self._show_heads()
        if source is not None:
            self.reading.read(source, self._view.side, self._on_own)
        self.changed.emit()

    def _on_own(self, shown: ShownProgram) -> None:
        if self._foreign is None:
            self._view.show_program(shown)
            self.changed.emit()
            self._pick()  # last: whoever follows may look elsewhere

    def _show_heads(self, guessed: Dialect | None = None) -> None:
        """Say what is shown: another program, or one that the job has outgrown."""
        source, banner = self.source, self._view.pane.banner
        dialect = source.dialect if source is not None else None
        if guessed is not None or not self.foreign:
            self._view.pane.head.show_dialect(guessed or dialect or Dialect.LINUXCNC, dialect, self.foreign)
        self._view.foreign = self.foreign
        self._view.beside.show_program(self._view.shown if self.foreign else None)
        self._view.pane.head.show_files([] if self.foreign else [own.name for own in self._own], self._own_at)
        if self._foreign is not None:
            where = "Not the job's program." if self._foreign.path else "In no file yet; Ctrl+Alt+S saves it."
            banner.say(where, "Back to the job's program" if self._own else "Close it")
        elif self._computation.outdated and self._computation.state is not ComputationState.RUNNING:
            if self._computation.possible:
                banner.say("The job has changed since.", "Compute  F5")
            else:
                banner.say("Nothing is drawn any more.", "")
        else:
            banner.hide()

    def _on_banner(self) -> None:
        if self.foreign:
            self.back()
        else:
            self.compute_requested.emit()

    def _draw_side(self, side: ViewSide) -> None:
        """Have the side painted that is missing; a job on its way ends first, and what it shows asks again."""
        shown = self._view.shown
        if shown is not None and not self.reading.worker.busy:
            self.reading.start(partial(projected, shown, self._view.compared, side), self._on_drawn)

    def _on_drawn(self, pictures: ProjectedProgram) -> None:
        pictures.keep()
        self._view.set_side(self._view.side)


def _sentence(shown: ShownProgram) -> str:
    """Return what there is to say about a program that was opened."""
    problems = shown.program.problems
    errors = sum(problem.severity is Severity.ERROR for problem in problems)
    words = [counted(len(shown.text), "line"), counted(len(shown.shapes), "motion")]
    words += [counted(errors, "error")] if errors else []
    words += [counted(len(problems) - errors, "warning")] if len(problems) > errors else []
    return (
        f"{', '.join(words)}. {shown.program.error.message(shown.source.name) if shown.program.error else ''}".strip()
    )
