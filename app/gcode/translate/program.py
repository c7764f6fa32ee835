"""A whole program in another control's words, and the proof that both controls do the same."""

from __future__ import annotations

import re
from collections.abc import Container, Iterator
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ...core.errors import InputError
from ...core.progress import NO_PROGRESS, Progress
from ...model.motion import MotionKind, Plane
from ...model.part import Units
from ..checks.state import foreign_start, read_from_start
from ..interpreter.block import SLASH, BlockStep
from ..interpreter.codes import ModalGroup
from ..interpreter.dialect import DIALECT_RULES
from ..interpreter.foreign_codes import is_macro
from ..interpreter.options import PATIENT, ReadOptions
from ..interpreter.program import NcProgram
from ..interpreter.reader import read_program, read_steps
from ..interpreter.text import ProgramBuffer, code_of
from ..posts import Post
from ..rework.compare import DifferenceKind, ProgramDifference, compare
from .moves import LeftAtR, MotionWriter, left_at_r
from .translatable import NO_SWITCH, SPLINES, TranslationSource, check_step
from .translated_text import TranslatedText

_STEPS = 2.0
"""So many steps of the last decimal may the written path be off: a place is half a step off along each axis, an arc all
of it.
"""

_LINES_A_STEP = 1000
"""Lines between two looks at whether to stop."""

_COLUMNS = ("start", "end", "centre", "kind", "plane", "turns", "feed", "line", "state")

_COMMENT = re.compile(r"\(([^()]*)\)|;(.*)$")

_O_WORD = re.compile(r"(?:/|n[0-9.]+)*o")

_COMPENSATION = frozenset({"G41", "G42", "G41.1", "G42.1"})

_END_OF_FILE = "\x1a"
"""What DOS programs put behind a text."""

_STALE = re.compile(
    r"hitofude for |hitofude: blend_mm|hitofude smooth:|proven on the path|the control may add|"
    r"(?:tolerance|largest bend|effective points)\b.*(?:proven|after|corrected)",
    re.IGNORECASE,
)
"""Comments of our own that were true of the program as it was."""


@dataclass(frozen=True, eq=False)
class TranslatedProgram:
    """A program in another control's words.

    Attributes:
        data: its text. program: as the other control reads it.
        off: how far its path may be from the first one's, mm: proven.
        rows: (n,) of each of its motions the one of the first program that it is, -1 where it is only a part of one.
    """

    data: bytes
    program: NcProgram
    off: float
    rows: NDArray[np.int64]


def translated(
    name: str, data: bytes, read: ReadOptions, post: Post, progress: Progress = NO_PROGRESS
) -> TranslatedProgram:
    """Return a program in the words of a post, proven by reading it back as that post's control would.

    Comments stay, as the control takes them. Blocks that a switch may leave out keep their slash, and both positions of
    the switch are proven. Loops, subroutines, jumps, expressions and cutter compensation are written
    as the motions that they make, and the head says so. Cycles that it has not, or that its own settings change, are
    moves; a length that its G43 takes up by moving stands with the next move along Z.

    Args:
        name: of the file, for messages.
        data: its bytes; it can be read to its end.
        read: how.
        post: whose control it is for.

    Raises:
        InputError: something has no counterpart there; named with its line and word.
        Cancelled: the job was asked to stop.
    """
    text = ProgramBuffer(data)
    source = TranslationSource(name, tuple(text.data.decode(text.encoding).split("\n")), read.dialect, post)
    optional = _optional(source)
    written = replace(read, block_delete=read.block_delete and not optional)
    program, steps = read_steps(data, written, progress.part(0.0, 0.3))
    if program.error is not None:
        raise InputError(f"{program.error.message(name)} Mend it there; check tells more.")
    made = _written(source, program, steps, optional, progress.part(0.3, 0.5))
    own = ReadOptions(post.dialect, block_delete=written.block_delete, limits=read.limits, units=read.units)
    back = _ReadBack(made, own, read_program(made, own, progress.part(0.5, 0.6)))
    done = _proven(source, left_at_r(program, steps), back, progress.part(0.6, 0.8 if optional else 1.0))
    if not optional:
        return done
    left_out, steps = read_steps(data, replace(read, block_delete=True), progress.part(0.8, 0.85))
    if left_out.error is not None:
        raise InputError(f"{left_out.error.message(name)} That is so where the blocks with a slash are left out.")
    own = replace(own, block_delete=True)
    back = _ReadBack(made, own, read_program(made, own, progress.part(0.85, 0.9)))
    other = _proven(source, left_at_r(left_out, steps), back, progress.part(0.9, 1.0))
    return other if read.block_delete else done


def _optional(source: TranslationSource) -> frozenset[int]:
    """Return the lines, 1-based, that a switch may leave out.

    Raises:
        InputError: the other control has no such switch, or there are several of them.
    """
    found: set[int] = set()
    for line, text in enumerate(source.lines, 1):
        slash = SLASH.match(code(text)) if "/" in text else None
        if slash is None:
            continue
        if source.post.dialect in NO_SWITCH:
            raise source.refusal(
                line, f"a block that may be left out (/) is always done by {source.post.title}, which has no switch"
            )
        if slash[0][-1:] not in ("/", "1"):
            raise source.refusal(
                line, f"a switch of its own for some blocks ({slash[0]}) is not written for {source.post.title}"
            )
        found.add(line)
    return frozenset(found)


def _written(
    source: TranslationSource,
    program: NcProgram,
    steps: tuple[BlockStep, ...],
    optional: frozenset[int],
    progress: Progress,
) -> bytes:
    """Return the text: every line of the first one in its order, or, where it jumps, every block in the order of
    doing; `optional` are the lines that may be left out.
    """
    jumps = _jumps(source, steps)
    units = program.states[0].units
    output = TranslatedText(source, units if units is Units.INCH else Units.MM, _number(source))
    output.comment(f"Hitofude for {source.post.title}, out of a program for {DIALECT_RULES[source.dialect].title}")
    never = uncalled(source, steps)
    for remark in _remarks(jumps, steps, never, left_at_r(program, steps).holes):
        output.comment(remark)
    writer = _Translator(source, output, MotionWriter(output, program), _passed(source, jumps, never))
    for k, step in enumerate(steps):
        if k % _LINES_A_STEP == 0:
            progress.step(k / len(steps), f"Writing for {source.post.title}")
        writer.pass_to(step.line)
        if k == 0:
            output.begin()
        output.choose(step.line in optional)
        writer.write(step)
    output.choose(False)
    writer.pass_rest(begun=bool(steps))
    output.end()
    return ("\n".join(output.lines) + "\n").encode("ascii", "replace")


class _Translator:
    """Writes block by block, and the comments of the lines that it comes to first."""

    def __init__(
        self, source: TranslationSource, output: TranslatedText, mover: MotionWriter, passed: Container[int]
    ) -> None:
        """Begin; `passed`: lines that need not be done."""
        self._source, self._output, self._mover, self._passed = source, output, mover, passed
        self._next = 1

    def pass_to(self, line: int) -> None:
        """Come to a line: write the comments up to it that were not written yet."""
        self._pass(line, ends=False)
        if line == self._next:
            self._comment(line)
            self._next = line + 1

    def write(self, step: BlockStep) -> None:
        """Write what a block does."""
        check_step(step, self._source)
        self._output.modes(step)
        self._mover.write(step)
        _stop(self._output, step)

    def pass_rest(self, begun: bool) -> None:
        """Write the comments behind the last block; `begun`: there was one."""
        if not begun:
            self._pass(len(self._source.lines), ends=True)
            self._output.begin()
        self._pass(len(self._source.lines) + 1, ends=True)

    def _pass(self, line: int, ends: bool) -> None:
        for k in range(self._next, line):
            self._comment(k)

            if k not in self._passed:
                _check_rest(self._source, k, ends)
        self._next = max(self._next, line)

    def _comment(self, line: int) -> None:
        for comment in _comments(self._source.lines[line - 1]):
            self._output.comment(comment)


def _jumps(source: TranslationSource, steps: tuple[BlockStep, ...]) -> bool:
    """Tell whether a program is done in another order than its lines stand in, or not all of it."""
    lines = [step.line for step in steps]
    if any(after <= before for before, after in pairwise(lines)):
        return True
    done = set(lines)
    return any(k not in done and _is_jump(source, k) for k in range(1, max(lines, default=0)))


def _is_jump(source: TranslationSource, line: int) -> bool:
    text = code(source.lines[line - 1])
    rules = DIALECT_RULES[source.dialect]
    return bool(text) and (
        (rules.ngc_flow and _O_WORD.match(text) is not None) or (rules.fanuc_flow and is_macro(text))
    )


def _passed(source: TranslationSource, jumps: bool, never: tuple[Subprogram, ...]) -> Container[int]:
    """Return the lines that need not be done: of a program that jumps any, else those of subprograms that nothing
    calls.
    """
    return range(len(source.lines) + 1) if jumps else frozenset(line for each in never for line in each.lines)


def _remarks(jumps: bool, steps: tuple[BlockStep, ...], never: tuple[Subprogram, ...], tapped: int) -> list[str]:
    """Return what the head has to say of how the program was written anew.

    Args:
        never: subprograms that nothing calls. tapped: how many tapped holes are left otherwise.
    """
    computed = any(
        step.parsed.settings or any(not isinstance(word.value, float) for word in step.parsed.words) for step in steps
    )
    curved = any(code in SPLINES for step in steps for code in step.block.codes.values())
    compensated = any(code in _COMPENSATION for step in steps for code in step.block.codes.values())
    return [
        *(["Loops, subroutines and jumps are written out as what they do"] if jumps else []),
        *(["Parameters and expressions are written as the numbers that they give"] if computed else []),
        *(["Splines are written as lines and arcs"] if curved else []),
        *(
            ["Cutter compensation is written out: the path is that of the tool's centre, so G40 throughout"]
            if compensated
            else []
        ),
        *(["Out of tapped holes the tool goes at feed to R and at rapid rate from there"] if tapped else []),
        *uncalled_remarks(never),
    ]


def _number(source: TranslationSource) -> int:
    """Return the program's number: the first program's own, else the post's."""
    for line in source.lines[:20]:
        found = NUMBER.match(code(line))
        if found and 0 < int(found[1]) < 10_000 and DIALECT_RULES[source.dialect].fanuc_flow:
            return int(found[1])
    return source.post.program.number


def _comments(line: str) -> list[str]:
    """Return the comments of a line, without those that are true no more."""
    found = ["".join(match.groups("")).strip() for match in _COMMENT.finditer(line)]
    return [text for text in found if text and not _STALE.match(text)]


def _check_rest(source: TranslationSource, line: int, ends: bool) -> None:
    """Refuse a line that was not done as a block, but where it is empty, the tape's mark or the program's number.

    Args:
        source: the program. line: 1-based.
        ends: whether the line stands behind the last one that was done.
    """
    text = code(source.lines[line - 1]).strip(_END_OF_FILE)
    title = source.post.title
    if (
        not text
        or text.startswith("%")
        or (NUMBER.match(text) and not ends and DIALECT_RULES[source.dialect].fanuc_flow)
    ):
        return
    if text.startswith("$"):
        raise source.refusal(line, f"a command of the control itself ($) has no counterpart on {title}")
    raise source.refusal(line, f"what stands behind the end is not read, so it cannot be written for {title}")


def _stop(output: TranslatedText, step: BlockStep) -> None:
    """Write what stops the program behind a block; its end is written by the post's own words."""
    code = step.block.codes.get(ModalGroup.STOP)
    if code in ("M0", "M1"):
        output.leave_cycle()
        output.emit(code)


@dataclass(frozen=True, eq=False)
class _ReadBack:
    """What was written, how it is read, and what the other control reads."""

    data: bytes
    read: ReadOptions
    program: NcProgram


def _proven(source: TranslationSource, left: LeftAtR, back: _ReadBack, progress: Progress) -> TranslatedProgram:
    """Return the new program if both controls do the same.

    Raises:
        InputError: they do not, or it cannot be read.
    """
    before, after = left.program, back.program
    title = source.post.title
    if after.error is not None:
        raise InputError(
            f"{source.name} cannot be written for {title}: as written, {after.error.message('line')} Keep the program "
            f"for {DIALECT_RULES[source.dialect].title}."
        )
    _check_modes(source, after, back.data, replace(back.read, limits=PATIENT))
    units = {before.states[k].units for k in np.unique(before.motions.state).tolist()} or {Units.MM}
    off = _STEPS * max(10.0 ** -source.post.digits(unit).X * unit.value for unit in units)
    (first, kept), (second, others) = _moving(before), _moving(after)
    found = compare(first, second, off, progress)
    wrong = [item for item in found.items if not _same(item, first, second)]
    if wrong:
        item = wrong[0]
        raise InputError(
            f"{source.name}:{item.a.first_line}: what is written for {title} is not the same there ({item.kind.value}: "
            f"{item.text}); keep the program for {DIALECT_RULES[source.dialect].title}."
        )
    rows = np.full(len(after.motions), -1, np.int64)
    for run in found.runs:
        rows[others[run.b : run.b + run.count]] = left.rows[kept[run.a : run.a + run.count]]
    return TranslatedProgram(back.data, after, off, rows)


def _check_modes(source: TranslationSource, after: NcProgram, made: bytes, read: ReadOptions) -> None:
    """Refuse a text that leaves units, plane, G90 or the like to what another job has left in force.

    Where the tool stands elsewhere an arc that begins at a place that the program has not told fits no more; there the
    look ends.

    Raises:
        InputError: it does; the post's first blocks are to blame.
    """
    again = read_from_start(made, read, foreign_start(after.states[0].units), NO_PROGRESS)
    here, there = (_modes_by_line(program) for program in (after, again))
    wrong = sorted(line for line, modes in here.items() if there.get(line, modes) != modes)
    if wrong or (here and not there):
        line = wrong[0] if wrong else min(here)
        raise InputError(
            f"{source.name} cannot be written for {source.post.title}: line {line} of what is written hangs on modes "
            "that another job may have left in force; let the post's program.start say them, as G17 {units} G90 G94 "
            "G40."
        )


def _modes_by_line(program: NcProgram) -> dict[int, tuple[object, ...]]:
    modes = [
        (each.units, each.plane, each.absolute, each.arc_absolute, each.feed_mode, each.work_offset)
        for each in program.states
    ]
    return {
        line: modes[state]
        for line, state in zip(program.motions.line.tolist(), program.motions.state.tolist(), strict=True)
    }


def _moving(program: NcProgram) -> tuple[NcProgram, NDArray[np.int64]]:
    """Return a program without the straight motions that go nowhere, which not every control makes, and the rows of the
    others.
    """
    motions = program.motions
    kept = np.flatnonzero(np.any(motions.start != motions.end, axis=1) | (motions.kind > MotionKind.LINE))
    behind = np.searchsorted(kept, np.arange(len(motions) + 1)).tolist()
    columns = {name: getattr(motions, name)[kept] for name in _COLUMNS}
    splines = {behind[row]: spline for row, spline in motions.splines.items()}
    events = tuple(replace(event, before=behind[event.before]) for event in program.events)
    homeward = tuple(behind[row] for row in program.homeward if behind[row + 1] > behind[row])
    return replace(
        program, motions=replace(motions, splines=splines, **columns), events=events, homeward=homeward
    ), kept


def _same(item: ProgramDifference, before: NcProgram, after: NcProgram) -> bool:
    """Tell whether a difference is none: blocks of one path, blending, or a length that no move along Z has met yet."""
    if item.kind in (DifferenceKind.SAME_PATH, DifferenceKind.PATH_MODE):
        return True
    if item.kind is not DifferenceKind.LENGTH_OFFSET:
        return False
    return all(not _along_z(program, span.first, span.stop) for program, span in ((before, item.a), (after, item.b)))


def _along_z(program: NcProgram, first: int, stop: int) -> bool:
    """Tell whether a motion of a span moves along Z to a place of the work; upright arcs and splines always do."""
    motions, homeward = program.motions, set(program.homeward)
    rows = [row for row in range(first, stop) if row not in homeward]
    level = (motions.plane == Plane.XY) & (motions.kind != MotionKind.SPLINE) | (motions.kind <= MotionKind.LINE)
    return any(motions.start[row, 2] != motions.end[row, 2] or not level[row] for row in rows)


# Subprograms that a text holds and nothing calls: they are no part of what the program does.


NUMBER = re.compile(r"(?:/|n[0-9.]+)*[o:]([0-9]+)$")
"""The number of a program or of a subprogram, alone in its line."""

_SUB = re.compile(r"(?:/|n[0-9.]+)*(o(?:[0-9]+|<[^>]*>))(sub|endsub)")

_NAMED = 5
"""So many subprograms are named; of more their count is told."""


@dataclass(frozen=True, slots=True)
class Subprogram:
    """A stretch of a text that a call would run.

    Attributes:
        name: as it is called: "O7", "o<corner>". lines: 1-based.
    """

    name: str
    lines: range


def uncalled(source: TranslationSource, steps: tuple[BlockStep, ...]) -> tuple[Subprogram, ...]:
    """Return the subprograms of which no line is done.

    Args:
        source: the text. steps: every block that is done.
    """
    rules = DIALECT_RULES[source.dialect]
    if not rules.fanuc_flow and not rules.ngc_flow:
        return ()
    done = {step.line for step in steps}
    heads = [(line, code(text)) for line, text in enumerate(source.lines, 1) if "o" in text.lower() or ":" in text]
    found = [*_numbered(source, heads), *(_named(heads) if rules.ngc_flow else ())]
    return tuple(each for each in found if done.isdisjoint(each.lines))


def _numbered(source: TranslationSource, heads: list[tuple[int, str]]) -> Iterator[Subprogram]:
    """Yield what stands between one number and the next, or the end; a number alone is a program's name."""
    numbers = [(line, match[1]) for line, text in heads if (match := NUMBER.match(text))]
    for k, (line, number) in enumerate(numbers):
        stop = numbers[k + 1][0] if k + 1 < len(numbers) else _end(source, line)
        inside = [code(text) for text in source.lines[line : stop - 1]]
        if any(each and not each.startswith("%") for each in inside):
            yield Subprogram(f"O{number}", range(line, stop))


def _end(source: TranslationSource, line: int) -> int:
    """Return the line behind the last M99 that follows a line, or behind the text."""
    last = [k for k in range(line, len(source.lines)) if "m99" in source.lines[k].lower().replace(" ", "")]
    return last[-1] + 2 if last else len(source.lines) + 1


def _named(heads: list[tuple[int, str]]) -> Iterator[Subprogram]:
    """Yield what stands between O… sub and its endsub."""
    begun: dict[str, int] = {}
    for line, text in heads:
        match = _SUB.match(text)
        if match and match[2] == "sub":
            begun[match[1]] = line
        elif match and match[1] in begun:
            yield Subprogram(match[1], range(begun.pop(match[1]), line + 1))


def uncalled_remarks(never: tuple[Subprogram, ...]) -> list[str]:
    """Return what to say of subprograms that nothing calls, as no or one sentence without its end."""
    if not never:
        return []
    names = [each.name for each in never]
    if len(names) == 1:
        return [f"{names[0]} is not called, so it is not written"]
    shown = f"{len(names)} subprograms" if len(names) > _NAMED else f"{', '.join(names[:-1])} and {names[-1]}"
    return [f"{shown} are not called, so they are not written"]


def code(line: str) -> str:
    """Return what a control obeys of a line; of one whose comment has no end the whole line."""
    return code_of(line, nested=True) if "(" not in line or ")" in line else line.lower()
