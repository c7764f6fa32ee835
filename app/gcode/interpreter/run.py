"""The reader's loop: line by line through a program, plain ones by the compiled lane, until it ends or cannot go on."""

from __future__ import annotations

import codecs
import re
from collections.abc import Iterator

from ...core.errors import MOST_QUOTED, shortened
from ...core.options import option
from ...core.progress import Progress
from ...model.part import Units
from .block import SLASH, Block, BlockStep, Grammar, ParsedLine, Watch, block_of, parse
from .codes import CYCLES, TAKES, ModalGroup
from .control import Control
from .cycles import PECKS
from .dialect import Dialect
from .fast_lane import FastLane
from .flow import MOST_KEPT, Flow
from .foreign_codes import (
    adapt,
    call_macro,
    call_or_return,
    is_leader,
    is_macro,
    obey_macro,
    stop_at_alarm,
    warn_behind_percent,
    warn_of_numbers,
    warn_of_uncalled,
)
from .linuxcnc_blocks import check_linuxcnc_block, check_linuxcnc_line, check_one_taker
from .moves import move
from .notes import notes
from .options import ReadOptions
from .own_header import register_diameters, registers_hold_wear
from .places import Cursor, JumpTargets
from .polar import check_polar, turn_polar_into_axes
from .program import BlockFault, EventKind, NcProgram, ProgramProblem, Severity
from .saved_state import obey_state, restore
from .scaled_program import spell_scaled, turn_sides_over
from .settings import before_motion, set_once
from .text import ProgramBuffer, code_of, column_of
from .turned_program import check_turned, spell_polar

LINES_A_STEP = 20_000
"""Lines between two looks at whether the job was cancelled."""

PLAIN_LINES_A_BLOCK = 16
"""Repeated plain lines that count as one repeated block: they take the lane less time than that."""

LEADER = 4096
"""Bytes before the per cent sign that may be something else."""

_NOT_QUICK = re.compile(rb"[oO%/:]|#[ \t]*<")

_NOT_QUICK_IN_MACRO_B = re.compile(rb"[oO%/:#]")
"""What a line begins with that the compiled lane does not do: of parameters it knows numbers, and where expressions
stand in brackets.
"""

_LEADER = re.compile(rb"[ \t\n\v\f\0]*%")

_CLOSED = re.compile(rb"^[ \t]*%[ \t]*$", re.MULTILINE)

_PERCENT = re.compile(rb"^[ \t]*%", re.MULTILINE)

_O_WORD = re.compile(r"/?(?:n[0-9.]+)?[o:]")

_PROGRAM_NUMBER = re.compile(r"^(/?(?:n[0-9.]+)?)[o:]")

_NO_BLOCK = re.compile(r"o?<[^<>]{1,32}>|/?(?:n[0-9]+)?(?:popen|pclos|[bd]prnt\[.*\])")
"""Lines of macro B that change nothing: the name that newer Fanuc controls begin a program with in the place of its
number, and what is printed.
"""

_COMPUTED = re.compile(r"[#\[]")
"""What the lane computes for controls with O words alone."""

_ENDS = ("M2", "M30")


class InterpreterRun:
    """One reading of a program.

    Attributes:
        stopped: whether the reading ended at the line of `stop_at`. inside: ... within a subroutine or a loop.
    """

    def __init__(self, data: bytes, options: ReadOptions, progress: Progress, watch: Watch | None = None) -> None:
        """Stand before the first line; with a watch every block is done by itself, and told to it."""
        self._file, self._text, self._options, self._progress = data, ProgramBuffer(data), options, progress
        self._control = Control(options)
        self._control.registers_hold_wear = registers_hold_wear(data)
        self._control.register_diameters = register_diameters(data)
        self._rules = self._control.rules
        self._grammar = Grammar.of(self._rules)
        self._not_quick = _NOT_QUICK_IN_MACRO_B if self._rules.fanuc_flow else _NOT_QUICK
        self._flow = Flow(JumpTargets(self._text), self._control)
        self._longest = min(options.limits.line_length, self._rules.longest_line - self._text.dropped)
        self._quick = FastLane(self._control, self._text.data, min(self._longest, self._rules.longest_code))
        self._kept: dict[int, ParsedLine | str] = {}
        self._problems: list[ProgramProblem] = []
        self._furthest, self._told, self._again = -1, 0, False
        self._stop = len(self._text.data) + 1
        self._watch, self._opened = watch, False
        self.stopped = self.inside = False

    @property
    def control(self) -> Control:
        """The control as it stands; after `read`, where the reading ended."""
        return self._control

    def stop_at(self, line: int) -> None:
        """Let the reading end where it comes to a line, before it does what stands there.

        Args:
            line: 1-based, not beyond the last one.
        """
        self._stop = 0
        for _ in range(line - 1):
            self._stop = self._text.line_end(self._stop) + 1

    def read(self) -> NcProgram:
        """Read all that can be read.

        Raises:
            Cancelled: the job was asked to stop.
        """
        try:
            self._read_blocks()
        except BlockFault as fault:
            self._problems.append(self._located(fault, Severity.ERROR))
        except RecursionError:
            self._problems.append(
                self._located(BlockFault("the block is too long or too deep to be read."), Severity.ERROR)
            )
        if self._control.compensation is not None:
            self._control.compensation.spill(self._control.columns)
        self._warn_of_start()
        self._warn_of_tools()
        return self._program()

    def _read_blocks(self) -> None:
        """Obey the blocks to the end of the program, or to where it is to stop.

        Raises:
            BlockFault: a block that nobody can obey.
        """
        self._skip_leader()
        warn_of_bytes(self._control, self._file)
        warn_of_numbers(self._control, self._text.data)
        self._warn_of_percent()
        while self._flow.next.offset < len(self._text.data):
            if not self._step():
                break
        else:
            self._miss_end()
        if self._rules.fanuc_flow and not self.stopped:
            warn_of_uncalled(self._control, self._flow)
        if self._control.compensation is not None and not self.stopped:
            self._control.compensation.flush(self._control.columns)

    def _program(self) -> NcProgram:
        """Return what was read."""
        control = self._control
        noted = notes(self._text.data, self._options.units or Units.MM)
        motions = control.columns.motions(control.splines, control.known_from())
        # a block that fails has named its way, and not gone it
        homeward = tuple(row for row in control.homeward if row < len(motions))
        return NcProgram(
            motions,
            control.states,
            tuple(control.events),
            homeward,
            (*self._warnings(), *self._problems),
            noted.tools,
            noted.stock,
            self._text.line_count,
            noted.header,
            self._rules.rapids_bend,
            frozenset(control.probe_lines),
        )

    def _warnings(self) -> Iterator[ProgramProblem]:
        """Yield what the control told on the way and, where the reading ended, the language that this may be."""
        for text, (letter, line) in self._control.warnings.items():
            yield ProgramProblem(line, 0, letter.upper(), text, Severity.WARNING)
        if self._problems:
            from .foreign_languages import foreign_language  # patterns of what few files are

            foreign = foreign_language(self._text.data)
            if foreign is not None:
                yield foreign

    def _warn_of_percent(self) -> None:
        """Tell of a per cent sign where grbl would come to it."""
        found = _PERCENT.search(self._text.data) if self._options.dialect is Dialect.GRBL else None
        if found is not None:
            self._control.line = self._text.data.count(b"\n", 0, found.start()) + 1
            self._control.warn("grbl 1.1 refuses a per cent sign; take it out, if the sender does not.", "%")

    def _miss_end(self) -> None:
        """Tell that the text has no end, if the control wants one."""
        if self._options.dialect is Dialect.LINUXCNC and self._text.line_count:
            self._control.line = self._text.line_count
            self._control.warn("the program has no end; LinuxCNC wants M2, M30 or % behind it.")

    def _warn_of_start(self) -> None:
        """Tell that the program moves from where it has not said that the tool is."""
        control = self._control
        axes = control.taken_for_known()
        if axes:
            control.line = int(control.columns.line[min(row for row in control.known[3:] if row >= 0)])
            control.warn(
                "the tool moves in G91 before the program has said where it is; it is taken to begin at "
                f"{' '.join(f'{letter}0' for letter in axes)} of the work offsets' table.",
                "g",
            )

    def _warn_of_tools(self) -> None:
        """Tell of tools that LinuxCNC does not change to, for they are in no row of its table."""
        control = self._control
        if self._options.dialect is not Dialect.LINUXCNC or not control.tool_table:
            return
        changes = (event for event in control.events if event.kind is EventKind.TOOL_CHANGE and event.value)
        for event in changes:
            if int(event.value) not in control.tool_table:
                control.line = event.line
                control.warn(f"tool {event.value:g} is not in the tool table, and LinuxCNC stops there.", "t")

    def _skip_leader(self) -> None:
        """Begin behind the per cent sign of a program that has one; Fanuc's and Haas' readers skip what stands before
        it.
        """
        data = self._text.data
        found = _LEADER.match(data) or (_PERCENT.search(data, 0, LEADER) if self._rules.fanuc_flow else None)
        if found is not None and is_leader(data[: found.start()]):
            offset = self._text.line_end(found.end()) + 1
            self._flow.next = Cursor(offset, data.count(b"\n", 0, offset) + 1)
            closed = _CLOSED.search(data, offset)
            self._flow.places.end_at(closed.start() if closed else len(data), self._rules.fanuc_flow)
            self._opened = True

    def _step(self) -> bool:
        """Do plain lines, or one line of any kind; False at the end of the program."""
        flow = self._flow
        if flow.next.offset == self._stop:
            self.stopped, self.inside = True, flow.nested
            return False
        self._count()
        if self._watch is None and self._quick_lines():
            return True
        flow.here, self._control.line = flow.next, flow.next.line
        flow.next = Cursor(self._text.line_end(flow.here.offset) + 1, flow.here.line + 1)
        return self._obey(flow.here)

    def _count(self) -> None:
        """Count what is read again; look up now and then."""
        at = self._flow.next
        self._again = at.offset <= self._furthest
        if self._again:
            self._control.unroll()
        else:
            self._furthest = at.offset
        self._told += 1
        if self._told >= LINES_A_STEP:
            self._told = 0
            self._progress.step(at.offset / len(self._text.data), "Reading NC")

    def _quick_lines(self) -> bool:
        """Let the compiled lane do what it can; False where that is nothing."""
        flow, begin = self._flow, self._flow.next
        begun = self._not_quick.match(self._text.data, begin.offset)
        if begun is not None or self._never_quick(begin) or not self._quick.ready:
            return False
        behind = self._quick.run(begin, self._stop)
        if behind.line == begin.line:
            return False
        flow.here, flow.next = begin, behind
        self._told += behind.line - begin.line - 1
        if begin.offset < self._furthest:
            self._control.unroll((behind.line - begin.line) // PLAIN_LINES_A_BLOCK)
        return True

    def _never_quick(self, at: Cursor) -> bool:
        """Tell whether a line that was done before is of a kind that the lane leaves alone, whatever is in force."""
        line = self._kept.get(at.offset)
        if line is None:
            return False
        return isinstance(line, str) or (self._rules.fanuc_flow and _COMPUTED.search(line.code) is not None)

    def _obey(self, at: Cursor) -> bool:
        """Do a line of any kind; False at the end of the program."""
        line = self._kept.get(at.offset)
        if line is None:
            line = self._understood(at)
            if (self._flow.nested or self._again) and len(self._kept) < MOST_KEPT:
                self._kept[at.offset] = line
        if isinstance(line, ParsedLine):
            return self._done(line)
        if not line or line.startswith("%"):
            if line:
                self._check_percent(at)
                warn_behind_percent(self._control, self._text.data[self._text.line_end(at.offset) :])
            return not line
        behind = self._flow.next.offset
        rest = self._jump(line)
        self._bring_back()
        self._check_passed(behind)
        return rest is None or self._done(rest)

    def _check_passed(self, behind: int) -> None:
        """Refuse a line between a jump's own, which ends at an offset, and where it goes on, if the control cannot even
        pass over it.
        """
        flow = self._flow
        if behind < flow.next.offset and self._longest < self._options.limits.line_length:
            found = flow.places.too_long(behind, flow.next.offset, self._longest)
            if found is not None:
                flow.here = found
                raise BlockFault(f"the line is longer than {self._longest} characters.")

    def _done(self, parsed: ParsedLine) -> bool:
        """Do a line's block; False at the end of the program."""
        if self._rules.macro_b:
            stop_at_alarm(parsed)
        control, block = self._control, block_of(parsed, self._control.parameters)
        if self._watch is None:
            return self._execute(block)
        line, before, row, said = control.line, control.modal, control.row, block.copy()
        goes_on = self._execute(block)
        asked, control.requested = tuple(control.requested.items()), {}
        self._watch(
            BlockStep(
                line=line,
                parsed=parsed,
                block=said,
                states=(before, control.modal),
                motion=control.motion,
                feed=control.feed,
                rows=(row, control.row),
                requested=asked,
            )
        )
        return goes_on

    def _check_percent(self, at: Cursor) -> None:
        """Refuse a per cent sign that ends nothing, as LinuxCNC does."""
        alone = self._text.line(at.offset).strip() == "%"
        if self._options.dialect is Dialect.LINUXCNC and not (self._opened and alone):
            raise BlockFault(
                "a per cent sign ends a program that begins with one, alone in its line; take it out.",
                column=-1,
                word="%",
            )

    def _understood(self, at: Cursor) -> ParsedLine | str:
        """Return a line in words, or its code: "" where there is nothing to do, or what begins with % or is a jump."""
        if self._text.line_end(at.offset) - at.offset > self._longest:
            raise BlockFault(f"the line is longer than {self._longest} characters.")
        code = code_of(self._text.line(at.offset), nested=self._options.dialect is not Dialect.LINUXCNC)
        if SLASH.match(code) is not None and self._leaves_out(code):
            return ""
        if len(code) > self._rules.longest_code:
            self._control.warn(
                f"{self._rules.title} 1.1 takes lines of up to {self._rules.longest_code} characters beside blanks and "
                "comments, and refuses longer ones, which some of its kin take."
            )
        if code.startswith("$") and self._options.dialect is Dialect.GRBL:
            self._control.warn("commands of the control itself ($) are passed over.")
            return ""
        if not code or (self._rules.macro_b and _NO_BLOCK.fullmatch(code)):
            return ""
        if code.startswith("%") or _O_WORD.match(code) is not None or (self._rules.fanuc_flow and is_macro(code)):
            return code
        parsed = self._parse(code)
        if self._options.dialect is Dialect.LINUXCNC:
            check_linuxcnc_line(parsed)
        if self._options.dialect is Dialect.GRBL and ("#" in code or "[" in code):
            self._control.warn("grbl 1.1 computes no values: it refuses # and brackets, which some of its kin take.")
        return parsed

    def _leaves_out(self, code: str) -> bool:
        """Tell whether a block that begins with a slash, behind its number maybe, is left out."""
        dialect = self._options.dialect
        if dialect is Dialect.LINUXCNC and not code.startswith("/"):
            raise BlockFault("LinuxCNC takes a slash at the beginning of a line only.", letter="/")
        if dialect is Dialect.LINUXCNC and not self._options.block_delete and code[1:2].isdigit():
            raise BlockFault("LinuxCNC numbers no slashes; write / alone.", letter="/")
        if dialect is Dialect.GRBL:
            self._control.warn("grbl leaves nothing out: it does the blocks that begin with a slash.", "/")
            return False
        if not self._options.block_delete:
            return False
        self._control.warn("blocks that begin with a slash are left out.", "/")
        return True

    def _parse(self, code: str, begin: int = 0) -> ParsedLine:
        return parse(code, self._options.limits.nesting, self._grammar, begin)

    def _jump(self, code: str) -> ParsedLine | None:
        """Obey a line that is a jump; return what is left of it to obey, with its place in the line."""
        if self._rules.fanuc_flow and is_macro(code):
            begin = obey_macro(self._flow, self._control, code)
            return self._parse(code, begin) if begin < len(code) else None
        if self._rules.ngc_flow:
            self._flow.obey(code)
        elif not self._rules.fanuc_flow:
            raise BlockFault(f"{self._rules.title} knows no O words.", column=-1)
        else:
            if self._control.row:
                self._control.warn("the program runs on into the next one, for no M30 or M99 stands before its number.")
            code = _PROGRAM_NUMBER.sub(r"\1n", code, count=1)  # a number, and so as long that columns stay
            return self._parse(code)
        return None

    def _execute(self, block: Block) -> bool:
        """Do a block; False at the end of the program."""
        control = self._control
        if self._rules.fanuc_flow:
            adapt(control, block)
        self._check_codes(block)
        check_polar(control, block)
        if block.codes.get(ModalGroup.ONCE) == "G65":
            call_macro(self._flow, control, block)
            return True
        before, side = control.modal, control.side
        turn_sides_over(control, block)
        before_motion(control, block)
        if ModalGroup.STATE in block.codes:
            obey_state(control, block, before, side)
        if self._rules.fanuc_flow:
            check_turned(control, block)
            spell_scaled(control, block)
            spell_polar(control, block)
        set_once(control, block)
        turn_polar_into_axes(control, block)
        move(control, block)
        stop = block.codes.get(ModalGroup.STOP)
        if stop in _ENDS:
            control.event(EventKind.END)
            return False
        if stop is not None:
            control.event(EventKind.OPTIONAL_STOP if stop == "M1" else EventKind.STOP)
        if not call_or_return(self._flow, control, block):
            control.warn("M99 begins the program again, for ever; it is read once.", "m")
            control.event(EventKind.END)
            return False
        self._bring_back()
        return True

    def _bring_back(self) -> None:
        """Bring back what a subroutine that has ended kept by M73."""
        if self._control.returning is not None:
            saved, self._control.returning = self._control.returning, None
            restore(self._control, saved)

    def _check_codes(self, block: Block) -> None:
        """Refuse, or pass over, what the control does not know."""
        title, strict = self._rules.title, self._options.dialect in (Dialect.LINUXCNC, Dialect.GRBL)
        for code in [*block.codes.values(), *block.coolant]:
            if code in self._rules.missing:
                raise BlockFault(f"{title} does not know {code}; {_of_another()}", letter=code[0].lower())
        for code in block.unknown:
            own = code[0] == "M" and 100 <= float(code[1:]) < 200
            if (code[0] == "G" or strict) and not (own and self._options.dialect is Dialect.LINUXCNC):
                raise BlockFault(f"{code} is not known; {_of_another()}", letter=code[0].lower())
            self._control.warn(f"{code} is the machine builder's own; what it does is not followed.", code[0].lower())
        unused = (
            "" if block.unknown or any(code in block.codes.values() for code in ("M98", "G65")) else self._unused(block)
        )
        if self._options.dialect is Dialect.LINUXCNC:
            check_linuxcnc_block(self._control, block)
        elif strict:
            check_one_taker(block)
        if unused and strict:
            raise BlockFault("no code in this block takes this word.", letter=unused)
        if unused:
            self._control.warn(f"{unused.upper()} stands in a block where no code takes it; it is passed over.", unused)

    def _unused(self, block: Block) -> str:
        """Return a letter that neither the block's codes nor the motion in force takes, or ""."""
        letter, motion = block.unused(), block.codes.get(ModalGroup.MOTION, self._control.motion)
        lessens = self._options.dialect is Dialect.HAAS and motion in PECKS and letter in ("i", "j", "k", "p")
        repeats = letter == "k" and self._rules.repeats_by_k and motion in CYCLES
        return "" if lessens or repeats or (letter and letter in TAKES.get(motion, "")) else letter

    def _located(self, fault: BlockFault, severity: Severity) -> ProgramProblem:
        """Return a fault with its place in the text."""
        at = self._flow.here
        line = self._text.line(at.offset)[: self._options.limits.line_length]
        column, word = fault.column, fault.word
        if fault.letter and not column:
            column, word = self._word(line, fault.letter.lower(), fault.text)
        elif column < 0:
            column = column_of(line, -1 - column)
        return ProgramProblem(
            at.line, min(max(column, 0), len(line) + 1), word[:MOST_QUOTED], shortened(fault.text), severity
        )

    def _word(self, line: str, letters: str, text: str) -> tuple[int, str]:
        """Return column and spelling of the word that a fault is about: the one that its text names, else the first."""
        try:
            words = self._parse(code_of(line, nested=True).removeprefix("/")).words
        except BlockFault:
            return 0, ""
        mine = [word for word in words if word.letter in letters]
        named = [
            word for word in mine if isinstance(word.value, float) and f"{word.letter.upper()}{word.value:g}" in text
        ]
        if not mine:
            return 0, ""
        word = (named or mine)[0]
        begin, end = column_of(line, word.begin), column_of(line, word.end - 1)
        return begin, line[begin - 1 : end]


# Bytes that a control takes otherwise than a reader of texts does: marks of encodings, carriage returns alone, NUL.


_UTF16 = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)

_SAVE = "save it as plain text, ASCII or UTF-8 without a mark, with line feeds."

_OF_LINUXCNC: tuple[tuple[bytes, re.Pattern[bytes], str], ...] = (
    (
        b"\r",
        re.compile(rb"\r(?!\r*(?:\n|\Z))"),
        "a carriage return alone ends no line for LinuxCNC, which obeys what stands on both sides of it as one line",
    ),
    (
        b"\0",
        re.compile(rb"\0(?![ \t\r\0]*(?:\n|\Z))"),
        "LinuxCNC reads a line as far as its first NUL byte, and leaves out what stands behind it",
    ),
    (b"\v\f", re.compile(rb"[\v\f]"), "LinuxCNC refuses form feeds and vertical tabs"),
)


def warn_of_bytes(control: Control, file: bytes) -> None:
    """Tell what in a file's bytes the control refuses, or obeys otherwise than it is read here.

    Args:
        file: as it lies on the disk.
    """
    for at, what in _odd(file, control.options.dialect):
        before = file[:at].replace(b"\r\n", b"\n").replace(b"\r", b"\n")
        control.line = before.count(b"\n") + 1
        control.warn(f"{what}; {_SAVE}")


def _of_another() -> str:
    """Return what to do with a code that the control does not know."""
    return f"take it out, or say {option('dialect')} where the program is for another control."


def _odd(file: bytes, dialect: Dialect) -> Iterator[tuple[int, str]]:
    if file in (*_UTF16, codecs.BOM_UTF8):  # a mark and no line that it could be told of
        return
    if file.startswith(_UTF16):
        yield 0, "the file is written in UTF-16, two bytes a letter, which controls do not read"
        return
    if file.startswith(codecs.BOM_UTF8) and dialect in (Dialect.LINUXCNC, Dialect.GRBL):
        yield 0, "the file begins with a byte order mark, which the control refuses"
    if dialect is Dialect.LINUXCNC:
        # single bytes are looked for far more quickly, and hardly any file holds one of these
        there = ((pattern, what) for signs, pattern, what in _OF_LINUXCNC if any(sign in file for sign in signs))
        found = ((pattern.search(file), what) for pattern, what in there)
        yield from ((match.start(), what) for match, what in found if match)
