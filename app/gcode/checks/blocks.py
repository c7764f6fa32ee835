"""The blocks of a text that are no moves: those that the post says, in its order, and none of another kind.

What the reader passes over, and what it obeys without a motion (words for blending, coolant between tools, overrides),
is compared here as text: every block that does not only move is the next one that the post's own lines make for these
tools.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.wording import together
from ...model.job import Job
from ..interpreter.dialect import Dialect
from ..interpreter.program import BlockFault, ProgramProblem
from ..interpreter.text import code_of
from ..posts import Post
from ..writer.template_fields import Fields, program_fields, tool_fields
from ..writer.write import blend_mm

WORD = re.compile(r"([a-z])([-+]?(?:\d+\.?\d*|\.\d+))")
BLOCK = re.compile(r"(?:[a-z][-+]?(?:\d+\.?\d*|\.\d+))*")
HEAD = re.compile(r"%|o\d+")
LETTERS = frozenset("defghmpqrstxyz")
"""Letters of the words that the post's own blocks may have: none that turns or moves another axis, none that jumps."""
_FOLLOWED = """
G0 G1 G4 G15 G17 G20 G21 G28 G30 G40 G43 G49 G50 G53 G54 G54.1 G55 G56 G57 G58 G59 G59.1 G59.2 G59.3 G61 G61.1 G64 G69
G80 G90 G90.1
G91 G91.1 G94 G97 G98 G99 G187 M0 M1 M2 M3 M4 M5 M6 M7 M8 M9 M19 M30 M48"""
CODES = frozenset(_FOLLOWED.split())
"""Codes that they may have: what these set is followed, and none of it stays in the machine's tables."""
ENDS = frozenset({"M2", "M30"})


@dataclass(frozen=True)
class ExpectedBlock:
    """A block of the post: as it is spelled, and what the control obeys of it.

    Attributes:
        loose: its Z is the clearance height, which the motions tell.
    """

    text: str
    code: str
    loose: bool = False

    def is_as(self, code: str) -> bool:
        """Tell whether another block is this one, however its numbers are spelled."""
        if BLOCK.fullmatch(self.code) is None or BLOCK.fullmatch(code) is None:
            return self.code == code
        mine, other = (
            [word for word in _words(each) if not (self.loose and word.letter == "z")] for each in (self.code, code)
        )
        return mine == other and self.loose <= ("z" in code)


def blocks_of(post: Post, job: Job, tools: tuple[int, ...]) -> list[ExpectedBlock]:
    """Return every block of a program that is no move, in order.

    Args:
        post, job: what it is written from.
        tools: T numbers in the order of use, one for each change.
    """
    lines, fields = post.program, program_fields(job, post, blend_mm(job, post))
    filled: list[tuple[str, Fields]] = [(template, fields) for template in (*lines.top, *lines.start)]
    own = [
        fields | tool_fields(job, number, post, _next(tools, k)) | {"clearance": "0"} for k, number in enumerate(tools)
    ]
    for k, mine in enumerate(own):
        filled += [(template, own[k - 1]) for template in lines.leave] if k else []
        filled += [(template, fields) for template in lines.home] + [(template, mine) for template in lines.tool]
    filled += [(template, own[-1]) for template in lines.leave] + [
        (template, fields) for template in (*lines.home, *lines.end)
    ]
    spelled = [(template.format(**values).strip(), "{clearance" in template) for template, values in filled]
    blocks = [ExpectedBlock(text, _code(text, post), loose) for text, loose in spelled]
    return [block for block in blocks if block.code]


def _next(tools: tuple[int, ...], k: int) -> int:
    """Return the T number that follows the one at k; after the last one, the first."""
    return next((tool for tool in tools[k:] if tool != tools[k]), tools[0])


@dataclass(frozen=True)
class HoleBlocks:
    """Blocks that may stand among the moves of holes.

    Attributes:
        waits: that let the tool wait; the events tell where.
        starts: that stand before tapping cycles, each right before one. taps_by: G words of such cycles.
        offsets: that begin and end cutter compensation; where they do, reading with a wear in the registers tells.
    """

    waits: frozenset[str] = frozenset()
    starts: frozenset[str] = frozenset()
    taps_by: tuple[str, ...] = ()
    offsets: frozenset[str] = frozenset()

    @staticmethod
    def of(post: Post, job: Job) -> HoleBlocks:
        """Return those that the operations of a job may have."""
        drilling, waits, starts = post.drilling, set(), set()
        for each in job.operations:
            if each.dwell_s:
                waits.add(drilling.wait.format(dwell_s=f"{each.dwell_s:g}", dwell_ms=round(1000 * each.dwell_s)))
            if each.TAPS:
                tool = job.tool(each.cut.tool)
                starts.add(drilling.tap_start.format(tool=tool.number, speed=round(tool.spindle_speed)))
        worn = {each.cut.tool for each in job.operations if each.wear}
        words = post.compensation
        offsets = {template.format(tool=tool) for tool in worn for template in (words.left, words.right, words.off)}
        return HoleBlocks(
            frozenset(_code(text, post) for text in waits),
            frozenset(_code(text, post) for text in starts if text),
            tuple(word.lower() for word in (drilling.tap, drilling.tap_left) if word),
            frozenset(_code(text, post) for text in offsets if text),
        )

    def may_stand(self, code: str, following: str) -> bool:
        """Tell whether a block may stand where it does.

        Args:
            code, following: what the control obeys of it, and of the line behind it.
        """
        return code in self.waits or code in self.offsets or (code in self.starts and self.taps(following))

    def taps(self, code: str) -> bool:
        """Tell whether a block begins a tapping cycle."""
        return any(re.search(rf"{word}(?![\d.])", code) is not None for word in self.taps_by)


def block_problems(text: str, post: Post, blocks: list[ExpectedBlock], holes: HoleBlocks) -> Iterator[ProgramProblem]:
    """Yield the first block that is not the post's, and what the post's own blocks should not do.

    Args:
        text: of the whole file.
        post: it was written by.
        blocks: what it should have beside its moves.
        holes: what may stand among them.
    """
    yield from _started_taps(text, post, holes)
    plain, machine, i = _moves_alone(post), _Machine(), 0
    alike = [plain.fullmatch(block.code) is not None for block in blocks]
    lines, more, number = text.split("\n"), _lines_with_more(text, post), 0
    while (number := number + 1) <= len(lines):
        expected = i < len(blocks) and alike[i]
        if not expected:
            following = int(np.searchsorted(more, number))
            if following == len(more):
                break
            number = int(more[following])
        line = lines[number - 1]
        moves = plain.fullmatch(line) is not None
        if moves and not expected:
            continue
        code = _code(line, post)
        if i < len(blocks) and blocks[i].is_as(code):
            yield from (
                ProgramProblem(number, 0, line.strip(), fault) for fault in (*_unfit(code), *machine.obey(code))
            )
            i += 1
        elif holes.may_stand(code, _code(lines[number], post) if number < len(lines) else ""):
            continue
        elif code and not moves:
            there = f"the post writes {blocks[i].text}" if i < len(blocks) else "the post writes no more blocks"
            slash = ", and a block with a slash is done or left out as a switch stands" if code.startswith("/") else ""
            yield ProgramProblem(
                number, 0, line.strip(), f"this is none of the program's moves, and {there} here{slash}."
            )
            return
    if i < len(blocks):
        yield ProgramProblem(text.count("\n"), 0, "", f"the block {blocks[i].text} of the post is missing.")


def _started_taps(text: str, post: Post, holes: HoleBlocks) -> Iterator[ProgramProblem]:
    """Yield the first tapping cycle without the block that should stand before it."""
    lines = text.split("\n") if holes.starts else []
    for number, line in enumerate(lines, 1):
        if (
            any(word.upper() in line for word in holes.taps_by)
            and holes.taps(_code(line, post))
            and _code(lines[number - 2], post) not in holes.starts
        ):
            yield ProgramProblem(number, 0, "", "the block of the post that stands before tapping is missing.")
            return


def approach_problems(text: str, first: list[int]) -> Iterator[ProgramProblem]:
    """Yield the first moves of tools that trust in where X or Y is: a tool may be changed anywhere.

    Args:
        text: of the whole file.
        first: 1-based line of each tool's first move.
    """
    lines = text.split("\n")
    for number in first:
        missing = [letter for letter in "XY" if letter not in lines[number - 1].upper()]
        if missing:
            axes = together(missing)
            yield ProgramProblem(
                number,
                0,
                "",
                f"this tool's first move does not say {axes}, and where the tool was changed nobody knows.",
            )


def _moving_codes(post: Post) -> list[str]:
    """Return the numbers of the post's G words of motion and of drilling."""
    drilling = post.drilling
    words = " ".join(
        (
            *post.words.motion,
            drilling.drill,
            drilling.peck,
            drilling.chip_break,
            drilling.dwell,
            drilling.feed_out,
            drilling.tap,
            drilling.tap_left,
            drilling.to_initial,
            drilling.to_r,
            drilling.cancel,
        )
    )
    return sorted({f"{float(value):g}" for letter, value in WORD.findall(words.lower()) if letter == "g"})


def _lines_with_more(text: str, post: Post) -> NDArray[np.int64]:
    """Return the 1-based lines that may do more than move; all others surely do not."""
    from .check_kernels import lines_with_more  # compiled code: loaded where it is used

    data, codes = np.frombuffer(text.encode(errors="replace"), np.uint8), _moving_codes(post)
    lengths = np.array([len(code) for code in codes], np.int64)
    spans = np.column_stack([np.cumsum(lengths) - lengths, np.cumsum(lengths)])
    lines = np.empty(text.count("\n") + 1, np.int64)
    found = lines_with_more(data, np.frombuffer("".join(codes).encode(), np.uint8), spans, lines)
    return lines[:found]


def _moves_alone(post: Post) -> re.Pattern[str]:
    """Return what a line looks like that only moves, in the post's words of motion and of drilling."""
    codes = "|".join(re.escape(code) for code in _moving_codes(post))
    number, code = r"[-+]?(?:\d+\.?\d*|\.\d+)", rf"G0*(?:{codes})(?![\d.])"
    plain = rf"\s*(?:(?:[NXYZIJFRQ]{number}|{code})\s*)*"
    if not post.drilling.dwell:
        return re.compile(plain, re.IGNORECASE)
    waiting = rf"(?=.*{post.drilling.dwell}(?![\d.]))\s*(?:(?:[NXYZIJFRQP]{number}|{code})\s*)*"  # P is the wait's
    return re.compile(f"{plain}|{waiting}", re.IGNORECASE)


def _code(line: str, post: Post) -> str:
    """Return what the control obeys of a line, in lower case, without its number."""
    try:
        code = code_of(line, nested=post.dialect is not Dialect.LINUXCNC)
    except BlockFault:
        return line.lower()
    return re.sub(r"^n[0-9.]+", "", code)


class _Word(NamedTuple):
    """A word of a block: its letter and value, and whether it has a decimal point."""

    letter: str
    value: float
    point: bool


def _words(code: str) -> list[_Word]:
    """Return the words of a block."""
    return [_Word(letter, float(value), "." in value) for letter, value in WORD.findall(code)]


def _unfit(code: str) -> Iterator[str]:
    """Yield what a block of the post has that a written program must not have."""
    if HEAD.fullmatch(code):
        return
    if BLOCK.fullmatch(code) is None:
        yield "a written program has plain blocks of letters and numbers alone; take this one out of the post."
        return
    for letter, value, _ in _words(code):
        name = f"{letter.upper()}{value:g}"
        if letter not in LETTERS:
            yield f"{name} moves an axis that no path is checked for, or jumps; take it out of the post."
        elif letter in "gm" and name not in CODES:
            yield (
                f"{name} sets something that the path does not know or that stays in the machine; take it out of the "
                "post."
            )


class _Machine:
    """What turns and flows from block to block."""

    def __init__(self) -> None:
        self.turns = self.flows = False

    def obey(self, code: str) -> Iterator[str]:
        """Follow a block; yield what is left on where it must not be."""
        codes = {f"{letter.upper()}{value:g}" for letter, value, _ in _words(code)}
        if "M6" in codes and self.turns:
            yield "the spindle turns while the tool is changed; write M5 before."
        self.turns = bool(codes & {"M3", "M4"}) or (self.turns and not codes & {"M5", "M6", "M19"})
        self.flows = bool(codes & {"M7", "M8"}) or (self.flows and "M9" not in codes)
        if codes & ENDS and (self.turns or self.flows):
            what, word = ("spindle turns", "M5") if self.turns else ("coolant flows", "M9")
            yield f"the {what} at the end of the program; write {word} before."
