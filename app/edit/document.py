"""The open document: job, selection, history and log, and the one door through which they change."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from enum import Flag, auto
from pathlib import Path

from app.edit.command import Session
from app.edit.errors import CommandError
from app.edit.grammar import read_script
from app.edit.history import History, State
from app.edit.interpret import Interpreter, Outcome
from app.edit.language import command_word
from app.edit.syntax import Command, Statement
from app.errors import InputError
from app.model.job import Job
from app.model.part import Part
from app.progress import NO_PROGRESS, Progress


class Change(Flag):
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


Listener = Callable[[Change], None]


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
        self._history = History(_first_state(job or Job(Part())))
        self._saved = self._history.state.job
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
        """True when the job differs from what was loaded or saved."""
        return self.job is not self._saved

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
    def session(self) -> Session:
        """What the next line may refer to."""
        state = self._history.state
        return Session(state.job.part, state.last, state.layer, self.selection, state.names, state.commands)

    def run(self, line: str) -> str:
        """Carry out a line of the shape language, or a block of lines, and return the reply; both go to the log.

        What it changes is undone together.

        Raises:
            InputError: the line cannot be read or carried out; nothing has changed.
        """
        line = line.strip()
        try:
            statements = read_script(line)
            if not statements:
                raise CommandError("The line ends too early; a command such as line, arc, circle or rect is expected.")
            reply, change = self._carry_out(statements, Interpreter())
        except InputError as error:
            self.log.append(LogLine(line, str(error), error=True))
            self._tell(Change.LOG)
            raise
        self.log.append(LogLine(line, reply))
        self._tell(change | Change.LOG)
        return reply

    def tried(self, text: str, progress: Progress = NO_PROGRESS) -> Session:
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
                reply, change = self._carry_out((statement,), interpreter)
                place = statement.place
                self.log.append(LogLine(text[place.start:place.end], reply))
                self._tell(change | Change.LOG)
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
        part_changed = job.part is not self.part
        self._history.change(name, replace(self._history.state, job=job), merge)
        self._tell(self._after(part_changed) | Change.JOB)

    def load(self, job: Job, path: Path | None = None) -> None:
        """Begin a new document with this job; history, log and selection start afresh."""
        self._history = History(_first_state(job))
        self._saved, self.path = job, path
        self.selection, self.log = frozenset(), []
        self.revision += 1
        self._tell(Change.ALL)

    def mark_saved(self, path: Path) -> None:
        """Remember that the job as it is now lies in this file."""
        self._saved, self.path = self.job, path
        self._tell(Change.HISTORY)

    def undo(self) -> None:
        """Take the last change back; logged as the line `undo`."""
        self.run("undo")

    def redo(self) -> None:
        """Do again what was taken back; logged as the line `redo`."""
        self.run("redo")

    def select(self, ids: Iterable[int]) -> None:
        """Select these entities; ids that the part does not have are passed over. Not logged."""
        chosen = frozenset(ids) & {e.id for e in self.part.entities}
        if chosen != self.selection:
            self.selection = chosen
            self._tell(Change.SELECTION)

    def _carry_out(self, statements: tuple[Statement, ...], interpreter: Interpreter) -> tuple[str, Change]:
        if len(statements) == 1 and (step := _step_word(statements[0])):
            return self._step(back=step == "undo")
        before = self.session
        outcome = Outcome(before, "", "")
        for statement in statements:
            outcome = interpreter.carry_out(statement, outcome.session)
        after = outcome.session
        name = outcome.name if len(statements) == 1 else f"{len(statements)} statements"
        if after == replace(before, selection=after.selection):
            self.selection = after.selection
            return outcome.reply, Change.SELECTION
        part_changed = after.part is not before.part
        job = replace(self.job, part=after.part) if part_changed else self.job
        self._history.change(name, State(job, after.layer, after.last, after.names, after.commands))
        selected, self.selection = self.selection, after.selection
        change = self._after(part_changed)
        return outcome.reply, change | (Change.SELECTION if selected != self.selection else Change(0))

    def _step(self, back: bool) -> tuple[str, Change]:
        before = self.job
        name = self._history.undo() if back else self._history.redo()
        if name is None:
            return ("Nothing to undo." if back else "Nothing to redo."), Change.HISTORY
        change = self._after(part_changed=self.part is not before.part)
        return f"{name} {'undone' if back else 'done again'}.", change | Change.JOB

    def _after(self, part_changed: bool) -> Change:
        """Bring revision and selection in step with a new state; return what changed."""
        self.revision += 1
        if not part_changed:
            return Change.HISTORY
        kept = self.selection & {e.id for e in self.part.entities}
        change = Change.PART | Change.HISTORY | (Change.SELECTION if kept != self.selection else Change(0))
        self.selection = kept
        return change

    def _tell(self, change: Change) -> None:
        for listener in tuple(self._listeners):
            listener(change)


def tried(text: str, session: Session, progress: Progress = NO_PROGRESS) -> Session:
    """Return what a text of the shape language makes of a session; `Document.tried` on a thread of one's own.

    Raises:
        InputError: the text cannot be read or carried out, or undoes. Cancelled: `progress` says so.
    """
    interpreter = Interpreter(progress)
    statements = read_script(text)
    for number, statement in enumerate(statements):
        interpreter.fraction = number / len(statements)
        session = interpreter.carry_out(statement, session).session
    return session


def _step_word(statement: Statement) -> str:
    """Return undo or redo when a statement is that, else ""."""
    word = command_word(statement.word.text) if isinstance(statement, Command) and not statement.arguments else None
    return word if word in ("undo", "redo") else ""


def _first_state(job: Job) -> State:
    return State(job, layer=job.part.layers[0].name if job.part.layers else "0")
