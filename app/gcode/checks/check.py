"""Are the bytes that were written the moves that were meant: read back as the control would, and compared move by move.

Reader and writer share no code beyond the post's dialect, so that neither can hide what the other does wrong. Compared
are the path (ends, and arcs all along), the kind and the feed of every motion, and what is in force while it is done:
tool, length, spindle, coolant, work offset, blending. Motions that belong to no move may only lift the tool.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.errors import HitofudeError
from ...core.progress import NO_PROGRESS, Progress
from ...model.job import Job
from ...model.motion import Floats, MotionKind, Plane
from ...model.moves import MoveKind, Moves, Program
from ...model.stock_box import program_origin
from ..interpreter.options import ReadOptions, ToolOffset
from ..interpreter.program import Event, EventKind, NcProgram, ProgramProblem
from ..interpreter.reader import read_program
from ..interpreter.text import ProgramBuffer
from ..posts import Post, comes_with_program
from ..writer.compensation import allowed_distances
from ..writer.write import NcFile, writing_tolerance
from .blocks import HoleBlocks, approach_problems, block_problems, blocks_of
from .path import MotionOwners, ReferencePath, Rows, beside, distances, motion_owners
from .state import FRESH, ExpectedState, HolePauses, StartState, foreign_start, read_from_start, wrong_states

NOISE = 1e-9
"""mm; what moving a path to another zero and back may add."""

LEFT_SO = (
    "That is so on a machine that stands elsewhere, or has other modes in force, when the program begins: the program "
    "has to say itself what it needs."
)


@dataclass(frozen=True, eq=False)
class Check:
    """What reading a text back has shown.

    Attributes:
        largest_distance_mm: the written path is nowhere farther from the moves, nor the moves from it.
        tolerance_mm: how far it may be.
        problems: every way in which the text differs from the moves, the first line of each; none = it is what was
            meant.
        program: what the text was read as.
        post: by which it was written.
        move: (n,) index of the program's move that each motion was written for; lifts count to the move before them,
            the approach of a tool to its first move.
        by_control: whether the control makes some of the path from the contour.
    """

    largest_distance_mm: float
    tolerance_mm: float
    problems: tuple[ProgramProblem, ...]
    program: NcProgram
    post: Post
    move: Rows
    by_control: bool = False

    def require(self, name: str) -> None:
        """Refuse a text that differs.

        Args:
            name: of the program's file.

        Raises:
            HitofudeError: the first difference, with its line.
        """
        if self.problems:
            more = f" ({len(self.problems) - 1} more differences)" if len(self.problems) > 1 else ""
            mend = (
                "please report this with the drawing and the post"
                if comes_with_program(self.post)
                else f"{self.post.title} is a post of your own: mend its file, where a post that comes with the "
                "program shows how"
            )
            if self.by_control:
                mend = (
                    f"{self.post.title} does not make it of a contour with pieces so short, or bends so gentle: take "
                    'compensation = "wear" or "computer", or a post with more decimals'
                )
            raise HitofudeError(
                f"{self.problems[0].message(name)}{more} What was written cannot be proven to be the path that was "
                f"computed, so it is not kept; {mend}."
            )


@dataclass(frozen=True, eq=False)
class _FileCheck:
    """One file and what it should hold.

    Attributes:
        tolerance: mm. allowed: (n,) how far the path may be from each move, mm: as much, or more where the control
            makes it from the contour. ends: (n,) how far its end may be.
    """

    read: NcProgram
    moves: Moves
    reference: ReferencePath
    file: NcFile
    expected: ExpectedState
    safe_z: float
    tolerance: float
    allowed: Floats
    ends: Floats
    start_state: StartState = FRESH

    @property
    def begins(self) -> Rows:
        """Index of the first move of each tool."""
        return np.flatnonzero(np.append(True, self.moves.tool[1:] != self.moves.tool[:-1]))


@dataclass(frozen=True)
class CheckReference:
    """What files were written from."""

    program: Program
    job: Job
    post: Post


def check(data: bytes, file: NcFile, reference: CheckReference, progress: Progress = NO_PROGRESS) -> Check:
    """Return how a text differs from the moves that it was written for.

    Args:
        data: the very bytes of the file.
        file: which lines of them were written for which moves.
        reference: program, job and post that it was written from.

    Raises:
        Cancelled: the job was asked to stop.
    """
    program, job, post = reference.program, reference.job, reference.post
    options = ReadOptions(dialect=post.dialect, tool_table=_tool_table(job))
    read = read_program(data, options, progress.part(0.0, 0.5))
    stop = file.first + len(file.nc.lines)
    moves = program.moves.part(file.first, stop)
    origin = program_origin(job, program)
    step = writing_tolerance(job, post)
    allowed, ends = allowed_distances(moves, job, step)
    compared = _FileCheck(
        read=read,
        moves=moves,
        reference=ReferencePath.of(moves, origin),
        file=file,
        expected=ExpectedState.of(job, post),
        safe_z=job.travel_z - origin[2],
        tolerance=step,
        allowed=allowed,
        ends=ends,
    )
    mine, far, problems = _differences(compared)
    if not problems:
        problems = _elsewhere(compared, data, options, progress.part(0.5, 1.0))
    if read.error is None:
        problems += tuple(_text_problems(compared, ProgramBuffer(data), post))
    move = np.minimum(np.searchsorted(file.nc.lines, read.motions.line), len(moves) - 1)
    move[mine.rows] = mine.move
    return Check(
        float(np.max(far)), float(np.max(allowed)), problems, read, post, move + file.first, bool(np.any(ends > step))
    )


class _Differences(NamedTuple):
    """Which motions belong to which moves, how far each move is missed, mm, and every difference."""

    owners: MotionOwners
    missed: Floats
    problems: tuple[ProgramProblem, ...]


def _differences(compared: _FileCheck) -> _Differences:
    """Return how a program, as it was read, differs from the moves that it was written of."""
    read = compared.read
    mine = motion_owners(read.motions, compared.file.nc.lines, compared.begins, compared.reference, compared.ends)
    far = distances(read.motions, compared.reference, mine)
    far = beside(read.motions, compared.reference, mine, far, compared.ends > compared.tolerance)
    found = sorted(_problems(compared, mine, far), key=lambda problem: problem.line)
    return _Differences(mine, far, (*read.problems, *found))


def _elsewhere(
    compared: _FileCheck, data: bytes, options: ReadOptions, progress: Progress
) -> tuple[ProgramProblem, ...]:
    """Return the differences on a machine that was left as another job left it."""
    start_state = foreign_start(compared.expected.job.out_units)
    read = read_from_start(data, options, start_state, progress)
    elsewhere = replace(
        compared,
        read=read,
        tolerance=compared.tolerance + NOISE,
        allowed=compared.allowed + NOISE,
        ends=compared.ends + 2 * NOISE * (compared.ends > compared.tolerance) + NOISE,
        start_state=start_state,
    )
    return tuple(replace(problem, text=f"{problem.text} {LEFT_SO}") for problem in _differences(elsewhere).problems)


def _text_problems(compared: _FileCheck, text: ProgramBuffer, post: Post) -> Iterator[ProgramProblem]:
    """Yield what is wrong with the text beside its motions."""
    code = text.data.decode(text.encoding)
    tools = tuple(compared.moves.tool[compared.begins].tolist())
    job = compared.expected.job
    yield from block_problems(code, post, blocks_of(post, job, tools), HoleBlocks.of(post, job))
    if text.line_count >= compared.file.nc.lines[-1]:
        yield from approach_problems(code, compared.file.nc.lines[compared.begins].tolist())


def _tool_table(job: Job) -> dict[int, ToolOffset]:
    """Return a length for each tool, no two alike: so a tool whose length is not taken, or another's, shows in its
    path.
    """
    worn = {each.cut.tool for each in job.operations if each.wear}
    whole = {each.cut.tool for each in job.operations if each.offset_by_control}
    return {
        tool.number: ToolOffset(
            (0.0, 0.0, float(rank)),
            tool.diameter if tool.number in whole else 0.0,
            diameter_known=tool.number in worn,
        )
        for rank, tool in enumerate(job.tools, start=1)
    }


def _problems(compared: _FileCheck, mine: MotionOwners, far: np.ndarray) -> Iterator[ProgramProblem]:
    """Yield every difference."""
    motions = compared.read.motions
    if compared.read.error is not None:
        return
    if np.any(np.diff(motions.line) < 0):
        row = int(np.argmax(np.diff(motions.line) < 0)) + 1
        yield _problem(motions.line[row], "", "this line runs again behind a later one.")
        return
    yield from _path_problems(compared, far)
    yield from _kind_problems(compared, mine)
    yield from wrong_states(compared.read, compared.moves, mine, compared.expected)
    yield from _lift_problems(compared, mine)
    yield from _section_problems(compared, mine)
    if compared.expected.ends and sum(event.kind is EventKind.END for event in compared.read.events) != 1:
        yield _problem(compared.read.line_count, "", "the program has no end (M2, M30), or goes on behind it.")


def _path_problems(compared: _FileCheck, far: np.ndarray) -> Iterator[ProgramProblem]:
    """Yield what of the path is missing or elsewhere."""
    wrong = np.flatnonzero(~(far <= compared.allowed))
    if len(wrong):
        move = wrong[0]
        yield _problem(
            compared.file.nc.lines[move],
            "",
            f"the written path is {far[move]:.4f} mm from the move to X{compared.reference.end[move, 0]:.4f} "
            f"Y{compared.reference.end[move, 1]:.4f} Z{compared.reference.end[move, 2]:.4f}, and so in {len(wrong)} "
            f"moves; {compared.allowed[move]:g} mm are allowed.",
        )


def _kind_problems(compared: _FileCheck, mine: MotionOwners) -> Iterator[ProgramProblem]:
    """Yield motions of another kind than their moves, and those that are too many."""
    motions, moves = compared.read.motions, compared.moves
    kind, reference = motions.kind[mine.rows], moves.kind[mine.move]
    arc = reference >= MoveKind.ARC_CW
    wrong = (kind != reference) & ~(arc & (kind == MotionKind.LINE))
    wrong |= (kind >= MotionKind.ARC_CW) & (motions.plane[mine.rows] != Plane.XY)
    if wrong.any():
        k = int(np.argmax(wrong))
        names = ("G0", "G1", "G2", "G3", "a spline")
        yield _problem(
            motions.line[mine.rows[k]], "", f"this is {names[kind[k]]} where {names[reference[k]]} was meant."
        )
    many = (mine.count > 1) & (moves.kind < MoveKind.ARC_CW)
    if many.any():
        yield _problem(compared.file.nc.lines[np.argmax(many)], "", "there are more motions than were meant.")


def _lift_problems(compared: _FileCheck, mine: MotionOwners) -> Iterator[ProgramProblem]:
    """Yield motions that belong to no move and are no lifts; only the post's own home blocks go by the machine's
    coordinates.
    """
    motions = compared.read.motions
    free = np.ones(len(motions), bool)
    free[mine.rows] = False
    level = np.hypot(*(motions.end - motions.start)[:, :2].T) > NOISE
    machine = _machine(compared.read)
    stays = np.abs(motions.end[:, 2] - motions.start[:, 2]) <= NOISE
    up = np.where(machine, _at_home(compared), np.abs(motions.end[:, 2] - compared.safe_z) <= compared.tolerance)
    home = np.isin(motions.line, compared.file.nc.home_lines)
    wrong = np.where(free, (motions.kind != MotionKind.RAPID) | level | ~(stays & ~machine | up), False) | (
        machine & (~home | ~free)
    )
    wrong |= home & ~machine & ~stays
    if wrong.any():
        yield _problem(
            motions.line[np.argmax(wrong)],
            "",
            "this motion belongs to no move of the path and is no lift to clearance.",
        )
    yield from _home_problems(compared)


def _machine(read: NcProgram) -> NDArray[np.bool_]:
    """Tell of each motion whether it goes by the machine's own coordinates."""
    machine = np.zeros(len(read.motions), bool)
    machine[list(read.homeward)] = True
    return machine


def _at_home(compared: _FileCheck) -> NDArray[np.bool_]:
    """Tell of each motion whether the tool's tip ends where one of the post's home blocks sends it along Z."""
    start_state, motions = compared.start_state, compared.read.motions
    heights = [start_state.homes[code][2] for code in compared.expected.homes] + list(compared.expected.home_heights)
    lengths = _tool_table(compared.expected.job)
    tip = np.array(
        [
            lengths[state.length_offset].offset[2] if state.length_offset in lengths else 0.0
            for state in compared.read.states
        ]
    )
    place = motions.end[:, 2] + start_state.zero[2] + tip[motions.state]
    return (
        np.any([np.abs(place - height) <= NOISE for height in heights], axis=0)
        if heights
        else np.zeros(len(motions), bool)
    )


def _home_problems(compared: _FileCheck) -> Iterator[ProgramProblem]:
    """Yield the first place where the tool should go home and does not."""
    motions, lines = compared.read.motions, np.array(compared.file.nc.home_lines, int)
    there = motions.line[_machine(compared.read) & _at_home(compared)]
    blocks = np.cumsum(np.diff(lines, prepend=0) != 1)
    away = [
        int(lines[blocks == block][0])
        for block in np.unique(blocks)
        if not np.isin(lines[blocks == block], there).any()
    ]
    if away:
        yield _problem(away[0], "", "the tool does not go home here, as it should.")


def _section_problems(compared: _FileCheck, mine: MotionOwners) -> Iterator[ProgramProblem]:
    """Yield what is wrong between the tools: changes, dwells, stops, the approach."""
    begins, lines = compared.begins, compared.file.nc.lines
    missing = mine.count[begins] == 0
    if missing.any():
        yield _problem(lines[begins[np.argmax(missing)]], "", "the first motion of this tool is missing.")
        return
    first = mine.rows[mine.first[begins]]
    last = np.append(mine.last[begins[1:] - 1], len(compared.read.motions) - 1)
    x, y, z = compared.read.motions.known_from
    if not (x == y == first[0] >= z):
        yield _problem(
            lines[0], "", "the first tool does not go to clearance along Z alone, and then to a place in X and Y."
        )
    sections = _Sections(compared, first, last)
    yield from sections.problems(HolePauses(compared.moves, compared.expected.job, mine))


@dataclass(frozen=True, eq=False)
class _Sections:
    """The stretches between the motions of one tool and of the next.

    Attributes:
        first: (k,) row of each tool's first motion. last: (k,) of its last one.
    """

    compared: _FileCheck
    first: Rows
    last: Rows

    def problems(self, pauses: HolePauses) -> Iterator[ProgramProblem]:
        """Yield what is wrong; `pauses` are those that are meant."""
        expected, numbers = self.compared.expected, self.compared.moves.tool[self.compared.begins].tolist()
        changes: list[list[int]] = [[] for _ in numbers]
        dwell = [0.0] * len(numbers)
        for event in self.compared.read.events:
            section = int(np.searchsorted(self.first, event.before))
            between = section < len(numbers) and (section == 0 or event.before > self.last[section - 1])
            if event.kind is EventKind.END:
                continue
            if event.kind is EventKind.TOOL_CHANGE and between:
                changes[section].append(event.before)
            elif event.kind is EventKind.DWELL and between:
                dwell[section] += event.value
            elif not (self._may_stop(event) or pauses.takes(event)):
                yield _problem(event.line, "", f"there is a {event.kind.value} here that was not meant.")
        yield from pauses.missing(self.compared.file.nc.lines)
        for section, tool in enumerate(numbers):
            line = int(self.compared.file.nc.lines[self.compared.begins[section]])
            if expected.changes and len(changes[section]) != 1:
                yield _problem(
                    line, "", f"T{tool} is changed to {len(changes[section])} times before its first motion."
                )
            if expected.dwell_s is not None and abs(dwell[section] - expected.dwell_s) > 1e-3:
                yield _problem(
                    line, "", f"the spindle has {dwell[section]:g} s to reach its speed, not {expected.dwell_s:g}."
                )
            if not self._clear(section, max(changes[section], default=0)):
                yield _problem(line, "", f"T{tool} does not go to clearance height before it moves in X or Y.")
            if section and changes[section] and not self._left(section, min(changes[section])):
                yield _problem(line, "", f"the tool before T{tool} is not lifted to clearance before it is changed.")

    def _may_stop(self, event: Event) -> bool:
        """Tell whether an event is a stop, and the post's own blocks may stop."""
        return event.kind in (EventKind.STOP, EventKind.OPTIONAL_STOP) and self.compared.expected.stops

    def _clear(self, section: int, changed: int) -> bool:
        """Tell whether a tool goes to clearance by Z alone between its change and its first motion level."""
        motions, row = self.compared.read.motions, int(self.first[section])
        return row > changed and abs(motions.end[row - 1, 2] - self.compared.safe_z) <= self.compared.tolerance

    def _left(self, section: int, changed: int) -> bool:
        """Tell whether the tool before was lifted to clearance by its own moves or behind them, before it went home or
        was changed.
        """
        motions, home = self.compared.read.motions, _machine(self.compared.read)
        rows = np.arange(self.last[section - 1], changed)
        rows = rows[~home[rows]]
        return bool(len(rows)) and motions.end[rows[-1], 2] >= self.compared.safe_z - self.compared.tolerance


def _problem(line: int, word: str, text: str) -> ProgramProblem:
    return ProgramProblem(int(line), 0, word, text)
