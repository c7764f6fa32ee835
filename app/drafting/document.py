"""The open document: job, selection, history and log, and the one door through which they change."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from enum import Flag, auto
from pathlib import Path
from typing import NamedTuple

from ..core.errors import InputError
from ..core.progress import NO_PROGRESS, Progress
from ..core.wording import counted
from ..model.job import Job
from ..model.part import Part
from ..model.reading import DrawingSource
from .commands.command import DraftingSession
from .commands.layers import with_layer_renamed
from .expressions.errors import CommandError
from .expressions.grammar import read_script
from .expressions.syntax import Command, Quantity, Statement
from .expressions.values import Curves, wrong
from .history import ChangeNames, HistoryState, UndoHistory
from .language.interpret import Interpreter, Outcome
from .language.language import command_word
from .recorded_lines import RecordedLine


class DocumentChange(Flag):
    """What listeners should look at again; LOADED says that it is another document."""

    PART = auto()
    JOB = auto()
    SELECTION = auto()
    LOG = auto()
    HISTORY = auto()
    LOADED = auto()
    ALL = PART | JOB | SELECTION | LOG | HISTORY | LOADED


@dataclass(frozen=True, slots=True)
class LogLine:
    """One line of the drawing language and the answer to it.

    Attributes:
        error: True when it was refused; `reply` then says why.
    """

    command: str
    reply: str
    error: bool = False


Listener = Callable[[DocumentChange], None]


class _Done(NamedTuple):
    """What was done: a sentence for the log, and what has changed."""

    reply: str
    change: DocumentChange


class Document:
    """A job being edited.

    Attributes:
        revision: grows with every change of the job, also by undo.
        selection: ids of the selected entities, all of them in the part.
        log: every line that was run, oldest first.
        path: where it was loaded from or saved to.
    """

    def __init__(self, job: Job | None = None) -> None:
        """Open a job, or an empty drawing."""
        self._history = UndoHistory(_first_state(job or Job(Part())))
        self._saved: HistoryState | None = self._history.state
        self._listeners: list[Listener] = []
        self.revision = 0
        self.selection: frozenset[int] = frozenset()
        self.log: list[LogLine] = []
        self.path: Path | None = None

    @property
    def job(self) -> Job:
        """The job as it is now."""
        return self._history.state.job

    @property
    def part(self) -> Part:
        """The drawing as it is now."""
        return self.job.part

    @property
    def layer(self) -> str:
        """Name of the layer that new curves go to."""
        return self._history.state.layer

    @property
    def last_point(self) -> tuple[float, float]:
        """The point that relative coordinates of the next line start from, mm."""
        return self._history.state.last

    @property
    def modified(self) -> bool:
        """True when the job, or a name in its drawing, differs from what was loaded or saved."""
        return self._history.state is not self._saved

    @property
    def state(self) -> HistoryState:
        """Everything that a project file holds of the document."""
        return self._history.state

    @property
    def history_names(self) -> ChangeNames:
        """Names of all changes."""
        return self._history.names

    @property
    def undo_name(self) -> str | None:
        """Name of the change that undo takes back, or None."""
        return self._history.undo_name

    @property
    def redo_name(self) -> str | None:
        """Name of the change that redo does again, or None."""
        return self._history.redo_name

    def subscribe(self, listener: Listener) -> Callable[[], None]:
        """Call `listener(change)` after every change; the returned function ends that."""
        self._listeners.append(listener)
        return lambda: self._listeners.remove(listener) if listener in self._listeners else None

    @property
    def session(self) -> DraftingSession:
        """What the next line may refer to."""
        state = self._history.state
        return DraftingSession(state.job.part, state.last, state.layer, self.selection, state.names, state.commands)

    @property
    def recorded(self) -> RecordedLine:
        """The lines that drew the part as it is now."""
        return self._history.state.recorded

    def run(self, line: str, progress: Progress = NO_PROGRESS) -> str:
        """Carry out a line of the shape language, or a block of lines, and return the reply; both go to the log.

        What it changes is undone together.

        Raises:
            InputError: the line cannot be read or carried out; nothing has changed.
            Cancelled: `progress` says so; nothing has changed, and nothing is logged.
        """
        line = line.strip()
        try:
            statements = _statements(line)
            reply, change = (
                self._step(*step)
                if (step := _step_of(statements))
                else self._take(_evaluated(statements, self.session, Interpreter(progress)), line)
            )
        except InputError as error:
            self.refuse(line, str(error))
            raise
        self.log.append(LogLine(line, reply))
        self._tell(change | DocumentChange.LOG)
        return reply

    def accept(self, line: str, outcome: Outcome) -> str:
        """Let the drawing become what `evaluated` has made of this document's session; logged and undone as `run` does.

        The caller has seen to it that the revision is still the one of that session.
        """
        reply, change = self._take(outcome, line.strip())
        self.log.append(LogLine(line.strip(), reply))
        self._tell(change | DocumentChange.LOG)
        return reply

    def refuse(self, line: str, reason: str) -> None:
        """Log that a line could not be carried out, and why."""
        self.log.append(LogLine(line, reason, error=True))
        self._tell(DocumentChange.LOG)

    def tried(self, text: str, progress: Progress = NO_PROGRESS) -> DraftingSession:
        """Return what a text of the shape language would make of the drawing; nothing changes, nothing is logged.

        Raises:
            InputError: the text cannot be read or carried out, or undoes. Cancelled: `progress` says so.
        """
        return tried(text, self.session, progress)

    def run_script(self, text: str, name: str = "script", progress: Progress = NO_PROGRESS) -> None:
        """Carry out a whole text of the shape language, statement by statement, each undone by itself.

        Raises:
            InputError: names the file, the line and the column of what failed; nothing has been carried out where the
                text cannot be read, else what stands before it has.
        """
        interpreter = Interpreter(progress)
        try:
            statements = read_script(text)
            for number, statement in enumerate(statements):
                interpreter.fraction = number / len(statements)
                line = text[statement.place.start : statement.place.end]
                step = _step_of((statement,))
                reply, change = (
                    self._step(*step) if step else self._take(_evaluated((statement,), self.session, interpreter), line)
                )
                self.log.append(LogLine(line, reply))
                self._tell(change | DocumentChange.LOG)
        except CommandError as error:
            raise InputError(f"{name}:{error.line}: column {error.column}: {error.reason}") from error

    def change_job(self, name: str, job: Job, merge: bool = False) -> None:
        """Replace the job: tools, operations, stock, …

        Args:
            name: shown in the Edit menu, such as "Tool diameter".
            merge: one of many edits of one field, undone together with those of the same name before it.
        """
        if job == self.job:
            return
        part_changed, state = job.part is not self.part, self._history.state
        recorded = RecordedLine(job.part) if part_changed else state.recorded
        self._history.change(name, replace(state, job=job, recorded=recorded), merge)
        self._tell(self._after(part_changed) | DocumentChange.JOB)

    def read_again(self, name: str, job: Job, source: DrawingSource) -> None:
        """Replace the drawing by what its file holds when it is read in another way; undone as one step.

        What the shape language has named stays, but for curves, whose numbers are others now.

        Args:
            name: shown in the Edit menu.
            job: with the drawing that was read.
            source: its file, and how it was read.
        """
        state, part = self._history.state, job.part
        names = {key: value for key, value in state.names.items() if not isinstance(value, Curves)}
        layer = state.layer if any(each.name == state.layer for each in part.layers) else part.layers[0].name
        self.selection = frozenset()
        self._history.change(
            name, replace(state, job=job, layer=layer, names=names, recorded=RecordedLine(part), source=source)
        )
        self._tell(self._after(part_changed=True) | DocumentChange.JOB | DocumentChange.SELECTION)

    def load(self, job: Job, path: Path | None = None, source: DrawingSource | None = None) -> None:
        """Begin a new document with this job; history, log and selection start afresh.

        Args:
            path: where it was loaded from. source: the drawing that its part was read from.
        """
        self.load_state(replace(_first_state(job), source=source), path)

    def load_state(self, state: HistoryState, path: Path | None = None, saved: bool = True) -> None:
        """Begin a new document as `load` does, with the names and commands of its drawing.

        Args:
            state: what the document holds.
            path: where it was loaded from.
            saved: False: what it holds lies in no file that the user knows.
        """
        state = replace(state, recorded=RecordedLine(state.job.part))
        self._history = UndoHistory(state)
        self._saved, self.path = state if saved else None, path
        self.selection, self.log = frozenset(), []
        self.revision += 1
        self._tell(DocumentChange.ALL)

    def mark_saved(self, path: Path, state: HistoryState | None = None) -> None:
        """Remember that a state, by default that of now, lies in this file; the part is named after it."""
        self._saved, self.path = state or self._history.state, path
        if self.part.name == path.stem:
            self._tell(DocumentChange.HISTORY)
            return
        self._saved = self._history.rename(path.stem, self._saved)
        self._tell(DocumentChange.HISTORY | DocumentChange.JOB)

    def undo(self) -> None:
        """Take the last change back; logged as the line `undo`."""
        self.run("undo")

    def redo(self) -> None:
        """Do again what was taken back; logged as the line `redo`."""
        self.run("redo")

    def go_to(self, done: int) -> None:
        """Undo or redo until so many of the changes of `history_names` are done; logged as one line, such as `undo
        3`.
        """
        names, now = self._history.names
        steps = min(max(done, 0), len(names)) - now
        if steps:
            self.run(f"{'redo' if steps > 0 else 'undo'} {abs(steps)}")

    def select(self, ids: Iterable[int]) -> None:
        """Select these entities; ids that the part does not have are passed over. Not logged."""
        chosen = frozenset(ids) & self.part.ids()
        if chosen != self.selection:
            self.selection = chosen
            self._tell(DocumentChange.SELECTION)

    def _take(self, outcome: Outcome, line: str) -> _Done:
        before, after, state = self.session, outcome.session, self._history.state
        if after == replace(before, selection=after.selection):
            self.selection = after.selection
            return _Done(outcome.reply, DocumentChange.SELECTION)
        part_changed = after.part is not before.part
        job = replace(self.job, part=after.part) if part_changed else self.job
        for old, new in after.renamed:
            job = with_layer_renamed(job, old, new)
        recorded = state.recorded.then(line, before.selection, after.selection)
        self._history.change(
            outcome.name,
            replace(
                state,
                job=job,
                layer=after.layer,
                last=after.last,
                names=after.names,
                commands=after.commands,
                recorded=recorded,
            ),
        )
        selected, self.selection = self.selection, after.selection
        change = self._after(part_changed)
        reselected = DocumentChange.SELECTION if selected != self.selection else DocumentChange(0)
        return _Done(outcome.reply, change | reselected)

    def _step(self, back: bool, times: int) -> _Done:
        before = self.job
        names: list[str] = []
        while len(names) < times and (name := self._history.undo() if back else self._history.redo()) is not None:
            names.append(name)
        if not names:
            return _Done("Nothing to undo." if back else "Nothing to redo.", DocumentChange.HISTORY)
        change = self._after(part_changed=self.part is not before.part)
        what = names[0] if len(names) == 1 else f"{len(names)} steps"
        return _Done(f"{what} {'undone' if back else 'done again'}.", change | DocumentChange.JOB)

    def _after(self, part_changed: bool) -> DocumentChange:
        """Bring revision and selection in step with a new state; return what changed."""
        self.revision += 1
        if not part_changed:
            return DocumentChange.HISTORY
        kept = self.selection & self.part.ids() if self.selection else self.selection
        change = (
            DocumentChange.PART
            | DocumentChange.HISTORY
            | (DocumentChange.SELECTION if kept != self.selection else DocumentChange(0))
        )
        self.selection = kept
        return change

    def _tell(self, change: DocumentChange) -> None:
        for listener in tuple(self._listeners):
            listener(change)


def evaluated(text: str, session: DraftingSession, progress: Progress = NO_PROGRESS) -> Outcome:
    """Return what a text of the shape language makes of a session, on whatever thread; `Document.accept` takes it.

    Raises:
        InputError: the text cannot be read or carried out, or undoes. Cancelled: `progress` says so.
    """
    return _evaluated(_statements(text.strip()), session, Interpreter(progress))


def tried(text: str, session: DraftingSession, progress: Progress = NO_PROGRESS) -> DraftingSession:
    """Return what a text of the shape language makes of a session; a text without a statement makes nothing of it.

    Raises:
        InputError: the text cannot be read or carried out, or undoes. Cancelled: `progress` says so.
    """
    return _evaluated(read_script(text), session, Interpreter(progress)).session


def drawn(text: str, name: str = "script", progress: Progress = NO_PROGRESS) -> Part:
    """Return the drawing that a text makes of an empty one; as `run_script`, but without a history that nobody will go
    back in.

    Raises:
        InputError: names the file, the line and the column of what failed. Cancelled: `progress` says so.
    """
    document = Document()
    try:
        statements = read_script(text)
        if not any(_step_of((statement,)) for statement in statements):
            return _evaluated(statements, document.session, Interpreter(progress)).session.part
    except CommandError as error:
        raise InputError(f"{name}:{error.line}: column {error.column}: {error.reason}") from error
    document.run_script(text, name, progress)
    return document.part


def _statements(line: str) -> tuple[Statement, ...]:
    statements = read_script(line)
    if not statements:
        raise CommandError("The line ends too early; a command such as line, arc, circle or rect is expected.")
    return statements


def _evaluated(statements: tuple[Statement, ...], session: DraftingSession, interpreter: Interpreter) -> Outcome:
    outcome, alone = Outcome(session, "", ""), len(statements) == 1
    for number, statement in enumerate(statements):
        interpreter.fraction = interpreter.fraction if alone else number / len(statements)
        outcome = interpreter.carry_out(statement, outcome.session)
    if alone:
        return outcome
    words, curves = f"{len(statements)} statements", len(outcome.session.part.entities)
    return replace(outcome, name=words, reply=f"{words}; the drawing has {counted(curves, 'curve')}.")


class _HistorySteps(NamedTuple):
    """Whether to go back in the history, and how many steps."""

    back: bool
    times: int


def _step_of(statements: tuple[Statement, ...]) -> _HistorySteps | None:
    """Return what undo or redo asks for, where it is the only statement; else None."""
    if len(statements) != 1 or not isinstance(statement := statements[0], Command):
        return None
    word = command_word(statement.word.text)
    if word not in ("undo", "redo"):
        return None
    match statement.arguments:
        case ():
            return _HistorySteps(word == "undo", 1)
        case (Quantity(value=value, unit=""),) if value == int(value) and value >= 1:
            return _HistorySteps(word == "undo", int(value))
    raise wrong(f"Write {word}, or {word} 3 for three steps.", statement.place)


def _first_state(job: Job) -> HistoryState:
    return HistoryState(job, layer=job.part.layers[0].name if job.part.layers else "0", recorded=RecordedLine(job.part))
