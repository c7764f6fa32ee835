"""Statements of the shape language carried out: commands, names, repetitions, choices, commands of the user's own."""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

from ...core.errors import InputError
from ...core.progress import NO_PROGRESS, Progress
from ...core.wording import counted
from ..commands.command import DraftingSession, Draw, Redo, Undo
from ..commands.select import SelectEntities
from ..expressions import syntax as s
from ..expressions.effort import Effort
from ..expressions.errors import CommandError
from ..expressions.evaluate import number_of, value_of
from ..expressions.units import LENGTH_UNITS
from ..expressions.values import Curves, Length, Value, wrong
from ..expressions.words import number_text, point_text
from .language import COMMANDS, read
from .read_notes import DrawNote

MOST_STATEMENTS = 200_000
"""A script carries out no more; one that would is a mistake, or a trap."""

MOST_CURVES = 100_000
"""A script draws no more."""

_DEEPEST_CALL = 40
"""Commands of the user's own within one another; more are one that calls itself."""
_COMPARISONS: Mapping[str, Callable[[float, float], bool]] = {
    "<": operator.lt,
    ">": operator.gt,
    "<=": operator.le,
    ">=": operator.ge,
    "==": operator.eq,
    "!=": operator.ne,
}


@dataclass(frozen=True, slots=True)
class Outcome:
    """What statements have come to.

    Attributes:
        name: for the Edit menu.
        reply: a short sentence for the log.
    """

    session: DraftingSession
    name: str
    reply: str


class Interpreter:
    """Carries out statements one after the other, and counts them.

    Attributes:
        done: statements carried out so far.
        fraction: how far the whole work is, in [0, 1], as whoever knows it says.
    """

    def __init__(self, progress: Progress = NO_PROGRESS) -> None:
        """Begin; `progress` is looked at for Cancel with every statement."""
        self._progress = progress
        self._depth, self._effort = 0, Effort()
        self.done, self.fraction = 0, 0.0

    def carry_out(self, statement: s.Statement, session: DraftingSession) -> Outcome:
        """Return what a statement makes of a session.

        Raises:
            CommandError: it cannot be read or carried out; it tells the place. Cancelled: the user asked to stop.
        """
        self._count(statement.place)
        try:
            return self._one(statement, session)
        except CommandError:
            raise
        except InputError as error:
            raise wrong(str(error), statement.place) from error

    def _count(self, place: s.TextSpan) -> None:
        self.done += 1
        if self.done > MOST_STATEMENTS:
            raise wrong(f"More than {MOST_STATEMENTS} statements are carried out; repeat fewer times.", place)
        self._progress.step(self.fraction, "Drawing")

    def _one(self, statement: s.Statement, session: DraftingSession) -> Outcome:
        match statement:
            case s.Command():
                return self._command(statement, session)
            case s.Assignment():
                self._effort.value(statement.place)
                value = value_of(statement.value, session.scope)
                named = _with_name(session, statement.name, value)
                return Outcome(named, f"Let {statement.name.text}", f"{statement.name.text} = {value_text(value)}.")
            case s.Repeat():
                return self._repeat(statement, session)
            case s.Conditional():
                return self._choose(statement, session)
            case s.UnitsBlock():
                return self._in_units(statement, session)
            case s.CommandDefinition():
                _check_name(statement.name)
                commands = {**session.commands, statement.name.text.lower(): statement}
                defined = replace(session, commands=commands)
                return Outcome(defined, f"Define {statement.name.text}", f"{statement.name.text} is a command now.")

    def _command(self, written: s.Command, session: DraftingSession) -> Outcome:
        own = session.commands.get(written.word.text.lower())
        if own is not None:
            return self._call(own, written, session)
        self._effort.command(written.place, written.word.text.lower())
        command = read(written, session, self._effort)
        if isinstance(command, Undo | Redo):
            raise wrong("Undo and redo stand in lines of their own, outside blocks.", written.place)
        after = command.carried_out(session)
        self._worked(written, session, after, isinstance(command, Draw | DrawNote))
        if isinstance(command, SelectEntities):
            return Outcome(after, "Select", f"{len(after.selection)} selected.")
        if (drawn := len(after.part.entities) + len(after.part.notes)) > MOST_CURVES:
            raise wrong(f"The drawing would have {drawn} curves; a text draws at most {MOST_CURVES}.", written.place)
        return Outcome(_labelled(written, session, after), command.name, command.reply)

    def _choose(self, statement: s.Conditional, session: DraftingSession) -> Outcome:
        while not (holds := self._holds(statement, session)) and len(statement.other) == 1:
            (further,) = statement.other
            if not isinstance(further, s.Conditional):
                break
            statement = further
        return Outcome(
            self._all(statement.body if holds else statement.other, session), "If", "Yes." if holds else "No."
        )

    def _holds(self, statement: s.Conditional, session: DraftingSession) -> bool:
        self._effort.value(statement.left.place)
        self._effort.value(statement.right.place)
        left, right = number_of(statement.left, session.scope), number_of(statement.right, session.scope)
        if isinstance(left, Length) or isinstance(right, Length):
            left, right = session.scope.length(left), session.scope.length(right)
        return _COMPARISONS[statement.comparison](left, right)

    def _worked(self, written: s.Command, before: DraftingSession, after: DraftingSession, draws: bool) -> None:
        """Count the curves that a command has added, changed or passed."""
        old, new = before.part.entities, after.part.entities
        if draws or len(new) > len(old):
            self._effort.added((e.curve for e in new[len(old) :]), len(old) + len(before.part.notes), written.place)
        else:
            self._effort.changed(
                0 if new is old else sum(a is not b for a, b in zip(old, new, strict=False)), len(old), written.place
            )

    def _call(self, own: s.CommandDefinition, written: s.Command, session: DraftingSession) -> Outcome:
        if len(written.arguments) != len(own.parameters):
            shown = " ".join(word.text for word in (own.name, *own.parameters))
            raise wrong(
                f"'{own.name.text}' takes {counted(len(own.parameters), 'value')}; write {shown}.", written.place
            )
        values = {p.text: value_of(a, session.scope) for p, a in zip(own.parameters, written.arguments, strict=True)}
        self._depth += 1
        if self._depth > _DEEPEST_CALL:
            raise wrong(f"'{own.name.text}' calls itself without end; let it stop with if.", written.place)
        self._effort.begin()
        self._effort.turn(written.place)
        inner = self._all(own.body, replace(session, names={**session.names, **values}))
        self._effort.end()
        self._depth -= 1
        after = replace(inner, names=session.names)
        drawn = len(after.part.entities) - len(session.part.entities)
        return Outcome(_labelled(written, session, after), own.name.text.capitalize(), f"{counted(drawn, 'curve')}.")

    def _repeat(self, written: s.Repeat, session: DraftingSession) -> Outcome:
        self._effort.value(written.times.place)
        times = number_of(written.times, session.scope)
        if times != int(times) or not 0 <= times <= MOST_STATEMENTS:
            raise wrong(
                f"This is {number_text(times)}; repeat wants a whole number from 0 to {MOST_STATEMENTS}.",
                written.times.place,
            )
        outside = session.names.get(written.index.text) if written.index else None
        self._effort.begin()
        for count in range(int(times)):
            self._count(written.place)  # a body may be empty
            self._effort.turn(written.place)
            if written.index:
                session = _with_name(session, written.index, float(count))
            session = self._all(written.body, session)
        self._effort.end()
        if written.index:
            names = {name: value for name, value in session.names.items() if name != written.index.text}
            session = replace(session, names=names if outside is None else {**names, written.index.text: outside})
        return Outcome(session, "Repeat", f"{counted(int(times), 'time')}.")

    def _in_units(self, written: s.UnitsBlock, session: DraftingSession) -> Outcome:
        inside = replace(session, plain=LENGTH_UNITS[written.unit.text])
        outcome = Outcome(inside, "Units", "Nothing to do.")
        for number, statement in enumerate(written.body):
            outcome = self.carry_out(statement, outcome.session)
            if number:
                outcome = replace(outcome, name=f"{number + 1} statements", reply=f"{number + 1} statements.")
        return replace(outcome, session=replace(outcome.session, plain=session.plain))

    def _all(self, statements: Sequence[s.Statement], session: DraftingSession) -> DraftingSession:
        for statement in statements:
            session = self.carry_out(statement, session).session
        return session


def value_text(value: Value) -> str:
    """Return a value as the language writes it."""
    if isinstance(value, Curves):
        return "curve " + " ".join(map(str, value.ids))
    return point_text(value) if isinstance(value, tuple) else number_text(value)


def _labelled(written: s.Command, before: DraftingSession, after: DraftingSession) -> DraftingSession:
    if written.label is None:
        return after
    return _with_name(after, written.label, Curves(tuple(sorted(after.part.ids() - before.part.ids()))))


def _with_name(session: DraftingSession, name: s.Name, value: Value) -> DraftingSession:
    _check_name(name)
    return replace(session, names={**session.names, name.text: value})


def _check_name(name: s.Name) -> None:
    word = name.text.lower()
    if word in COMMANDS or word in RESERVED:
        raise wrong(f"'{name.text}' is a word of the language; choose another name.", name.place)


RESERVED = frozenset(
    {
        "add",
        "after",
        "all",
        "and",
        "arc",
        "as",
        "before",
        "by",
        "ccw",
        "center",
        "centre",
        "close",
        "copy",
        "crossing",
        "cw",
        "define",
        "degree",
        "diameter",
        "else",
        "end",
        "font",
        "from",
        "if",
        "knots",
        "large",
        "let",
        "none",
        "on",
        "over",
        "pi",
        "polar",
        "radius",
        "remove",
        "repeat",
        "round",
        "side",
        "through",
        "times",
        "to",
        "units",
        "weights",
        "window",
        "within",
    }
)
"""Words that commands look for among their arguments."""
