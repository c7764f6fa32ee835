"""Where the program goes on: subroutines, loops and conditions of RS274/NGC (O words), and the frames that they run
in.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import NamedTuple

from ...core.wording import either
from .control import Control
from .endless_loops import never_ends
from .expression import Key, Value, ValueReader, evaluated, whole
from .labels import Labels
from .places import KEYWORDS, Cursor, JumpTargets, Statement, label_of
from .program import BlockFault

MOST_KEPT = 10_000
"""Lines of loops and subroutines that are kept as they were understood."""

_NUMBERED = re.compile(r"/?(?:n[0-9.]+)?")

_LABEL = re.compile(r"<[^<>]{1,200}>|[0-9]{1,9}")

_KEYWORD = re.compile("|".join(sorted(KEYWORDS, key=len, reverse=True)))

_ENDS = {"while": "endwhile", "repeat": "endrepeat", "do": "while"}


@dataclass(slots=True)
class Loop:
    """A loop that is running.

    Attributes:
        begin: its first statement.
        left: passes that are left, of a repeat.
    """

    begin: Statement
    left: int = 0


@dataclass(slots=True)
class CallFrame:
    """A subroutine that is running, or the program itself.

    Attributes:
        label: "" = the program.
        begin: its first line. back: where the caller goes on.
        left: calls that are left, of M98 with L.
        own_parameters: it began with parameters of its own.
        called: by an O word with call, so that endsub or return ends it; else by M98 or its like, and M99 does.
        loops: by label. ends: of Fanuc's loops, the line with WHILE by the offset of the line with END.
    """

    label: str = ""
    begin: Cursor = field(default_factory=lambda: Cursor(0, 1))
    back: Cursor = field(default_factory=lambda: Cursor(0, 1))
    left: int = 0
    own_parameters: bool = False
    called: bool = False
    loops: dict[str, Loop] = field(default_factory=dict)
    ends: dict[int, Cursor] = field(default_factory=dict)


class Subroutine(NamedTuple):
    """A subroutine's label, and its first line."""

    label: str
    begin: Cursor


class _ReadValue(NamedTuple):
    """A value, and where in its line it ends."""

    value: Value
    end: int


class _ReadStatement(NamedTuple):
    """A statement, and where in its line it ends."""

    statement: Statement
    end: int


class Flow:
    """Follows jumps.

    Attributes:
        next: the line that comes next.
        here: the line that is running.
        frames: the program, and the subroutines within one another.
    """

    def __init__(self, places: JumpTargets, control: Control) -> None:
        """Begin at the first line."""
        self.places, self._control = places, control
        self.next = self.here = Cursor(0, 1)
        self.frames = [CallFrame()]
        self._labels = Labels()
        self._seen: dict[int, tuple[object, ...]] = {}
        self._statements: dict[int, _ReadStatement] = {}
        self._conditions: dict[str, Value] = {}
        self._may_end: set[int] = set()
        self._first_values: dict[int, _ReadValue] = {}

    @property
    def nested(self) -> bool:
        """Whether a subroutine or a loop is running."""
        return len(self.frames) > 1 or bool(self.frames[0].loops)

    def first_value(self, values: ValueReader) -> Value:
        """Return the first value that is read of the line that is running: parsed once, however often the line is done.

        Args:
            values: stands before it, and then behind it.

        Raises:
            Fault: there is none, or it is wrong.
        """
        known = self._first_values.get(self.here.offset)
        if known is not None:
            value, values.at = known
            return value
        value = values.value()
        if len(self._first_values) < MOST_KEPT:
            self._first_values[self.here.offset] = _ReadValue(value, values.at)
        return value

    def check_end(self, begin: Cursor, condition: Cursor) -> None:
        """Refuse another pass of a loop that surely never ends; its last line is running.

        Args:
            begin: its first line. condition: the line with its condition, which held when it was looked at last.

        Raises:
            Fault: it never ends.
        """
        if self.here.offset in self._may_end:
            return
        nested = self._control.rules.fanuc_flow
        try:
            endless = never_ends(
                self.places.code(condition, nested), self.places.codes_between(begin, self.here, nested)
            )
        except BlockFault:  # a comment without end, where the program may never come to
            endless = False
        if endless:
            raise BlockFault(
                "this goes on for ever: nothing in the loop changes whether it repeats, and nothing leaves it."
            )
        self._may_end.add(self.here.offset)

    def jump(self, to: Cursor) -> None:
        """Go on at a line.

        Raises:
            Fault: the jump goes back, and nothing has changed since it went there before: that never ends.
        """
        if to.offset <= self.here.offset:
            control = self._control
            counters = [[frame.left, *(loop.left for loop in frame.loops.values())] for frame in self.frames]
            now = (control.parameters.changes, control.at, control.modal, control.motion, repr(control.feed), counters)
            if self._seen.get(to.offset) == now:
                raise BlockFault("this goes on for ever: nothing changes from one pass to the next.")
            self._seen[to.offset] = now
        self.next = to

    def call(self, called: Subroutine, arguments: dict[Key, float] | None, count: int) -> None:
        """Begin a subroutine.

        Args:
            called: where it begins.
            arguments: its own parameters; None = it shares the caller's.
            count: how often, >= 1.
        """
        label, begin = called
        deepest = min(self._control.options.limits.calls, self._control.rules.calls)
        if len(self.frames) > deepest:
            raise BlockFault(f"subroutines call one another more than {deepest} deep.")
        self.frames.append(CallFrame(label, begin, self.next, count - 1, arguments is not None))
        self._control.saved.append(None)
        if arguments is not None:
            self._control.parameters.enter(arguments)
        self.next = begin

    def leave(self) -> bool:
        """End a subroutine, or begin its next call; False where none is running."""
        frame = self.frames[-1]
        if len(self.frames) == 1:
            return False
        self._end_state()
        if frame.left > 0:
            frame.left -= 1
            frame.loops.clear()
            self.next = frame.begin
            return True
        if frame.own_parameters:
            self._control.parameters.leave()
        self.next = self.frames.pop().back
        self._control.saved.pop()
        return True

    def _end_state(self) -> None:
        """Note what M73 lets come back where a subroutine ends."""
        kept = self._control.saved[-1]
        self._control.saved[-1] = None
        self._control.returning = kept if kept is not None and kept.returns else None

    def obey(self, code: str) -> None:
        """Obey a line with an O word.

        Args:
            code: as `text.code_of` gives it.

        Raises:
            Fault: it is not one, or what belongs to it is missing.
        """
        values = ValueReader(code, self._control.options.limits.nesting)
        known = self._statements.get(self.here.offset)
        if known is not None:
            statement, values.at = known
        else:
            begun = _NUMBERED.match(code)
            values.at = (begun.end() if begun else 0) + 1
            is_written = _LABEL.match(code, values.at) is not None
            label = self._label(values)
            keyword = _KEYWORD.match(code, values.at)
            if keyword is None:
                if values.at < len(code):
                    raise BlockFault(
                        "behind an O word stands sub, call, if, while, do, repeat or one of their partners.",
                        column=-1 - values.at,
                    )
                return
            values.at, statement = keyword.end(), Statement(self.here, label, keyword[0])
            if is_written and len(self._statements) < MOST_KEPT:
                self._statements[self.here.offset] = _ReadStatement(statement, values.at)
        _ACTS[statement.keyword](self, statement, values)

    def _label(self, values: ValueReader) -> str:
        written = _LABEL.match(values.code, values.at)
        if written is not None:
            values.at = written.end()
            return label_of(written[0])
        return str(whole(evaluated(values.value(), self._control.parameters), "the number of an O word"))

    def _condition(self, values: ValueReader) -> float:
        """Return what a condition or a count is."""
        if values.code[values.at : values.at + 1] != "[":
            raise BlockFault("expected [ with a condition.", column=-1 - values.at)
        written = values.code[values.at :]
        value = self._conditions.get(written)
        if value is None:
            value = values.value()
            if values.at < len(values.code):
                raise BlockFault("expected nothing more behind the condition.", column=-1 - values.at)
            if len(self._conditions) < MOST_KEPT:
                self._conditions[written] = value
        return evaluated(value, self._control.parameters)

    def _partner(self, statement: Statement, *keywords: str) -> Statement:
        """Return the statement further down that belongs to one."""
        found = self.places.next_of(statement.label, keywords, statement.at.offset)
        if found is None:
            raise BlockFault(f"O{statement.label} {statement.keyword} has no {either(keywords)} with the same number.")
        return found

    def _sub(self, statement: Statement, values: ValueReader) -> None:
        """Pass over a subroutine that nobody calls here."""
        end = self._partner(statement, "endsub")
        self._labels.meet_subroutine(statement, self.places.subroutine_between(statement.at.offset, end.at.offset))
        self.next = self.places.after(end.at)

    def _endsub(self, statement: Statement, values: ValueReader) -> None:
        frame = self.frames[-1]
        if len(self.frames) == 1:
            raise BlockFault(f"O{statement.label} {statement.keyword} ends a subroutine that is not running.")
        if not frame.called:
            raise BlockFault(f"O{frame.label} is called by M98, so M99 must end it, not {statement.keyword}.")
        control = self._control
        has_value = values.at < len(values.code)
        value = self._condition(values) if has_value else 0.0
        self.leave()
        control.parameters.set("_value", value)
        control.parameters.set("_value_returned", float(has_value))

    def _call(self, statement: Statement, values: ValueReader) -> None:
        parameters = self._control.parameters
        given: list[float] = []
        while values.at < len(values.code):
            if values.code[values.at] != "[" or len(given) == 30:
                raise BlockFault("expected up to 30 arguments in brackets.", column=-1 - values.at)
            given.append(evaluated(values.value(), parameters))
        found = self.places.subroutine(statement.label)
        if found is None:
            raise BlockFault(
                f"there is no subroutine O{statement.label} in this file; a file of its own beside the program is not "
                "read, so put it into this one."
            )
        if found.keyword != "sub":
            raise BlockFault(
                f"O{statement.label} is a subroutine of M98, for it has no sub; call it with M98 P{statement.label}."
            )
        found = self._labels.call_subroutine(found)
        arguments: dict[Key, float] = {
            number: (given[number - 1] if number <= len(given) else 0.0) for number in range(1, 31)
        }
        self.call(Subroutine(statement.label, self.places.after(found.at)), arguments, 1)
        self.frames[-1].called = True

    def _if(self, statement: Statement, values: ValueReader) -> None:
        self._labels.define(statement, self.frames[-1].label)
        branch, holds = statement, self._condition(values) != 0
        while not holds:
            branch = self._partner(branch, "elseif", "else", "endif")
            if branch.keyword != "elseif":
                break
            holds = self._condition_at(branch) != 0
        if branch is not statement:
            self.next = self.places.after(branch.at)

    def _condition_at(self, statement: Statement) -> float:
        """Return the condition of a statement on another line."""
        self.here, self._control.line = statement.at, statement.at.line
        code = self.places.code(statement.at, self._control.rules.fanuc_flow)
        values = ValueReader(code, self._control.options.limits.nesting)
        keyword = re.compile(statement.keyword).search(code)
        values.at = keyword.end() if keyword else len(code)
        return self._condition(values)

    def _else(self, statement: Statement, values: ValueReader) -> None:
        """Come to the end of a branch that was taken."""
        self._labels.need_if(statement, self.frames[-1].label)
        self.next = self.places.after(self._partner(statement, "endif").at)

    def _endif(self, statement: Statement, values: ValueReader) -> None:
        """Go on."""
        self._labels.need_if(statement, self.frames[-1].label)

    def _do(self, statement: Statement, values: ValueReader) -> None:
        self._labels.begin_do(statement, self.frames[-1].label)
        self.frames[-1].loops[statement.label] = Loop(statement)

    def _while(self, statement: Statement, values: ValueReader) -> None:
        loops = self.frames[-1].loops
        open_loop = loops.get(statement.label)
        holds = self._condition(values) != 0
        if open_loop is not None and open_loop.begin.keyword == "do":
            self._labels.end_do(open_loop.begin, self.frames[-1].label, statement.at.line)
            if holds:
                self.check_end(open_loop.begin.at, statement.at)
                self.jump(self.places.after(open_loop.begin.at))
            else:
                del loops[statement.label]
            return
        self._labels.define(statement, self.frames[-1].label)
        if holds:
            loops[statement.label] = Loop(statement)
        else:
            loops.pop(statement.label, None)
            self._pass_over(statement, "endwhile")

    def _repeat(self, statement: Statement, values: ValueReader) -> None:
        self._labels.define(statement, self.frames[-1].label)
        count = self._condition(values)
        if count >= 0.5:
            self.frames[-1].loops[statement.label] = Loop(statement, round(count) - 1)
        else:
            self._pass_over(statement, "endrepeat")

    def _pass_over(self, statement: Statement, keyword: str) -> None:
        """Go on behind a loop that is not done at all."""
        end = self._partner(statement, keyword, "else", "elseif")
        if end.keyword != keyword:
            self.here = end.at
            self._labels.need_if(end, self.frames[-1].label)
        self.next = self.places.after(end.at)

    def _end_loop(self, statement: Statement, values: ValueReader) -> None:
        """Come to endwhile or endrepeat."""
        loop = self._open(statement)
        if _ENDS[loop.begin.keyword] != statement.keyword:
            raise BlockFault(f"O{statement.label} {statement.keyword} ends no loop that is running.")
        if loop.begin.keyword == "while":
            self.check_end(loop.begin.at, loop.begin.at)
        self._next_pass(loop)

    def _next_pass(self, loop: Loop) -> None:
        """Begin the next pass of a loop, or end it."""
        if loop.begin.keyword == "while":
            self.jump(loop.begin.at)
        elif loop.left > 0:
            loop.left -= 1
            self.jump(self.places.after(loop.begin.at))
        else:
            self._end(loop)

    def _end(self, loop: Loop) -> None:
        del self.frames[-1].loops[loop.begin.label]
        self.next = self.places.after(self._partner(loop.begin, _ENDS[loop.begin.keyword]).at)

    def _break(self, statement: Statement, values: ValueReader) -> None:
        self._end(self._open(statement))

    def _continue(self, statement: Statement, values: ValueReader) -> None:
        loop = self._open(statement)
        if loop.begin.keyword == "do":
            self.next = self._partner(loop.begin, "while").at
        else:
            self._next_pass(loop)

    def _open(self, statement: Statement) -> Loop:
        loop = self.frames[-1].loops.get(statement.label)
        if loop is None:
            raise BlockFault(f"O{statement.label} {statement.keyword} belongs to no loop that is running.")
        return loop


_ACTS = {
    "sub": Flow._sub,
    "endsub": Flow._endsub,
    "return": Flow._endsub,
    "call": Flow._call,
    "if": Flow._if,
    "elseif": Flow._else,
    "else": Flow._else,
    "endif": Flow._endif,
    "do": Flow._do,
    "while": Flow._while,
    "endwhile": Flow._end_loop,
    "repeat": Flow._repeat,
    "endrepeat": Flow._end_loop,
    "break": Flow._break,
    "continue": Flow._continue,
}
