"""A program of tool paths as NC text for one control."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.errors import ParameterError
from ...core.progress import NO_PROGRESS, Progress
from ...model.job import Job
from ...model.moves import MoveKind, Moves, Program, Purpose
from ...model.part import Units
from ...model.stock_box import stock_box, work_origin
from ..posts import Post
from .blocks import Blocks, CycleHole, CycleRules, holes_of, untapped, waits_of
from .compensation import allowed_distances, compensated_stretches, compensation_blocks, programmed_moves
from .header import HeaderContent, heading_lines, heading_notes, operation_words, tool_words
from .template_fields import Fields, program_fields, tool_fields
from .work_moves import ArcRules, MotionRows, WorkMoves, motion_rows, work_moves

MOVES_A_STEP = 8192
"""Moves between two looks at whether to stop."""

LARGEST_DEVIATION = 1e-3
"""No written arc leaves the meant one by more, mm, unless the last decimal itself is coarser."""


TAP_DECIMALS = 2
"""Decimals that F of a tap has beyond those of the post where it needs them. A hole of 100 mm at 50 mm/min is then off
by 1 um where F is told to 0.1 mm/min, and by 2.6 um where it is told to 0.01 in/min.
"""


@dataclass(frozen=True)
class NcText:
    """A written program.

    Attributes:
        text: ASCII, lines ended by a line feed.
        lines: (n,) 1-based line that brings the tool to the end of each move of the program; a move that is nothing
            after rounding has the line of the one before.
        home_lines: 1-based lines that send the tool to the machine's own home along Z (G28, G53), which no move means.
    """

    text: str
    lines: NDArray[np.int32]
    home_lines: tuple[int, ...] = ()


@dataclass(frozen=True)
class NcFile:
    """One of the files that a program is written to.

    Attributes:
        suffix: goes between the chosen name and its extension: "" for the only file, else such as "_1_T3".
        nc: its text; `nc.lines` are those of the moves from `first` on.
        first: index of the program's move that is the first of this file.
    """

    suffix: str
    nc: NcText
    first: int = 0

    def named(self, chosen: Path) -> Path:
        """Return the file's own path for the path that the user chose: "part.nc", or "part_1_T3.nc" where there are
        several.
        """
        return chosen.with_name(f"{chosen.stem}{self.suffix}{chosen.suffix}") if self.suffix else chosen


@dataclass(frozen=True)
class Remarks:
    """What a program says beside its motions.

    Attributes:
        head: comments for the operator at its head. notes: for programs that read it, below them.
        operation: returns what is said where an operation of some index begins.
        before: comments before a move, by its index.
    """

    head: tuple[str, ...]
    notes: tuple[str, ...]
    operation: Callable[[int], str]
    before: Mapping[int, tuple[str, ...]] = field(default_factory=dict)


def write_moves(
    moves: Moves, job: Job, post: Post, remarks: Remarks, progress: Progress = NO_PROGRESS
) -> tuple[NcFile, ...]:
    """Return any moves as the files that the control needs, see `write_files`; each has all the remarks of its moves.

    Args:
        moves: mm from the work origin; each tool begins with a rapid at a height that is clear of everything.
        job: whose tools, units and name are used.

    Raises:
        ParameterError: the control cannot promise an exact path, a tool is not in the job, or out units are neither mm
            nor inch.
        Cancelled: the job was asked to stop.
    """
    _check_words(job, post)
    files: list[NcFile] = []
    for _, first, stop, suffix in _by_file(moves, post):
        blocks = Blocks(post, job.out_units)
        offset = _Offset.of(moves.part(first, stop), job, post)
        part = work_moves(offset.moves, (0.0, 0.0, 0.0), job.out_units, post.digits(job.out_units))
        said = replace(remarks, before={i - first: words for i, words in remarks.before.items() if first <= i < stop})
        lines = _ProgramWriter(job, post, blocks, part, offset).write(
            said, progress.part(first / len(moves), stop / len(moves))
        )
        nc = NcText("\n".join(blocks.lines) + "\n", lines, tuple(blocks.home_lines))
        files.append(NcFile(suffix, nc, first))
    return tuple(files)


class _FileSpan(NamedTuple):
    """The moves of one file: its number from 1 on, first move, end, and what its name ends in."""

    number: int
    first: int
    stop: int
    suffix: str


def _by_file(moves: Moves, post: Post) -> Iterator[_FileSpan]:
    """Yield the moves of each file that the control needs."""
    tools = moves.tool
    starts = [0, *(np.flatnonzero(np.diff(tools)) + 1).tolist()] if post.file_per_tool else [0]
    for number, (first, stop) in enumerate(zip(starts, [*starts[1:], len(tools)], strict=True), start=1):
        yield _FileSpan(number, first, stop, f"_{number}_T{tools[first]}" if len(starts) > 1 else "")


def write_files(program: Program, job: Job, post: Post, progress: Progress = NO_PROGRESS) -> tuple[NcFile, ...]:
    """Return the program as the files that the control needs: one, or one a tool where it changes no tools.

    Files come in the order of cutting, a new one at every change of tool. Each is complete by itself, begins and ends
    at safe Z, and has the same work origin; together they hold every move once. The same program, job and post always
    give the same bytes.

    Positions are rounded once, to the nearest last decimal; the written path stays within `writing_tolerance` of the
    moves. Before each tool the spindle stops at safe Z; each begins at safe Z before it moves in X or Y.

    Args:
        program: moves in part coordinates, with the regions they cut.
        job: what they were computed from.
        post: the control's dialect.
        progress: asked for cancel now and then.

    Raises:
        ParameterError: the moves are none that a machine should make, a tool is not in the job, out units are neither
            mm nor inch, the control cannot promise an exact path, or there is no region to place the stock round.
        Cancelled: the job was asked to stop.
    """
    _check(program, job, post)
    count = len(program.moves)
    spans = list(_by_file(program.moves, post))
    files: list[NcFile] = []
    for number, first, stop, suffix in spans:
        share = progress.part(first / count, stop / count)
        nc = _written(replace(program, moves=program.moves.part(first, stop)), job, post, (number, len(spans)), share)
        files.append(NcFile(suffix, nc, first))
    return tuple(files)


def _check(program: Program, job: Job, post: Post) -> None:
    """Refuse what cannot be written."""
    _check_words(job, post)
    check_sequence(program.moves, job)


def _check_words(job: Job, post: Post) -> None:
    """Refuse units and paths that the control has no words for."""
    if job.out_units not in (Units.MM, Units.INCH):
        raise ParameterError(
            f"NC programs are in mm or inch, not in {job.out_units.name.lower()}; choose one of the two."
        )
    if job.exact_path and not post.blending.exact:
        raise ParameterError(f"{post.title} has no word for an exact path; switch exact path off.")


def _written(program: Program, job: Job, post: Post, file: tuple[int, int], progress: Progress) -> NcText:
    """Return the text of one file; `file` is its number and how many there are."""
    box = stock_box(job, program.regions, program.lines)
    offset = _Offset.of(program.moves, job, post)
    moves = work_moves(offset.moves, work_origin(job, box), job.out_units, post.digits(job.out_units))
    blocks = Blocks(post, job.out_units)
    heading = HeaderContent(
        program,
        job,
        post,
        box,
        blend_mm(job, post),
        float(np.max(allowed_distances(program.moves, job, writing_tolerance(job, post)).path, initial=0.0)),
        *file,
    )
    remarks = Remarks(
        tuple(heading_lines(heading)), tuple(heading_notes(heading)), lambda i: operation_words(job.operations[i], job)
    )
    lines = _ProgramWriter(job, post, blocks, moves, offset).write(remarks, progress)
    return NcText("\n".join(blocks.lines) + "\n", lines, tuple(blocks.home_lines))


def blend_mm(job: Job, post: Post) -> float:
    """Return how far the control may leave the written path, mm: 0 for an exact path, else what the blending block
    says.

    Where no block says it, it is what the post takes the control's own setting as.
    """
    if job.exact_path:
        return 0.0
    if "{blend}" not in post.blending.blend:
        return post.blending.tolerance_mm
    scale: int = 10 ** post.digits(job.out_units).X
    return math.floor(post.blending.tolerance_mm / job.out_units.value * scale + 1e-6) / scale * job.out_units.value


def writing_tolerance(job: Job, post: Post) -> float:
    """Return how far the written path may be from the program's moves, mm.

    Two steps of the last decimal, at most 1 um; where one step is more than that, one step.
    """
    step: float = job.out_units.value * 10.0 ** -post.digits(job.out_units).X
    return max(min(2 * step, LARGEST_DEVIATION), step)


def _left(job: Job) -> frozenset[int]:
    """Return which operations tap to the left, by index."""
    return frozenset(k for k, each in enumerate(job.operations) if each.TAPS and each.turns_left)


def _dwells(job: Job) -> dict[int, float]:
    """Return how long each operation waits at the bottom of its holes, s, by index; those that do not are left out."""
    return {k: seconds for k, each in enumerate(job.operations) if (seconds := each.dwell_s) > 0}


@dataclass(frozen=True, eq=False)
class _Offset:
    """What the control offsets of a program.

    Attributes:
        moves: as they are written. corners: (n,) which of them it makes by itself, at the block that follows.
        blocks: that begin and end it, by the index of the move that follows.
    """

    moves: Moves
    corners: NDArray[np.bool_]
    blocks: dict[int, str]

    @staticmethod
    def of(moves: Moves, job: Job, post: Post) -> _Offset:
        """Return what a control offsets of moves of the tool's centre.

        Raises:
            ParameterError: it cannot, or not so. GeometryError: the contour does not allow it.
        """
        stretches = compensated_stretches(moves, job)
        blocks = compensation_blocks(moves, job, post, stretches)
        written = programmed_moves(moves, job, stretches)
        return _Offset(written.moves, written.corners, blocks)


class _ProgramWriter:
    """One run over the moves."""

    def __init__(self, job: Job, post: Post, blocks: Blocks, moves: WorkMoves, offset: _Offset) -> None:
        self.job, self.post, self.blocks, self.moves = job, post, blocks, moves
        self.fields = program_fields(job, post, blend_mm(job, post))
        self.digits = digits = post.digits(job.out_units)
        unit = job.out_units.value
        self.z_scale = 10.0**digits.Z
        peck, chip = (
            round(gap / unit * self.z_scale) for gap in (post.drilling.peck_gap_mm, post.drilling.chip_gap_mm)
        )
        # a count by the cycle's heights and half a one by rounding, where as much may be off
        near = int(1.5 * unit / self.z_scale <= writing_tolerance(job, post))
        rules = CycleRules(
            words=post.drilling,
            scale=round(self.z_scale),
            peck_gap=peck,
            chip_gap=chip,
            near=near,
            dwells=_dwells(job),
            taps=self._taps(),
            left=_left(job),
            rates=self._tap_rates(offset.moves),
        )
        self.holes: dict[int, CycleHole] = holes_of(moves, rules)
        self.waits = waits_of(moves, rules, self.holes)
        self.offsets, self.corners = offset.blocks, np.flatnonzero(offset.corners)
        if untapped(moves, rules, self.holes):
            raise ParameterError(
                f"{post.title} has no cycle that taps: the spindle would not turn back; mill the thread, or take the "
                "tap operation out."
            )
        level = math.sqrt((writing_tolerance(job, post) / unit) ** 2 - (0.5 / self.z_scale) ** 2)  # Z is rounded too
        self.arc_rules = ArcRules.of(post, job.out_units, level)

    def _taps(self) -> dict[int, str]:
        """Return the block before the cycle of each operation that taps, by its index."""
        template = self.post.drilling.tap_start
        tools = ((k, self.job.tool(each.cut.tool)) for k, each in enumerate(self.job.operations) if each.TAPS)
        return {k: template.format(tool=tool.number, speed=round(tool.spindle_speed)) for k, tool in tools}

    def _tap_rates(self, moves: Moves) -> dict[int, str]:
        """Return F of each operation that taps where its decimals do not spell the feed exactly, by its index.

        The feed has to be the pitch by the speed: what it is off adds up along the hole.
        """
        rates: dict[int, str] = {}
        for k in self._taps():
            feeds = moves.feed[(moves.operation == k) & (moves.kind == MoveKind.LINE)]
            finer = f"{feeds[0] / self.job.out_units.value:.{self.digits.F + TAP_DECIMALS}f}" if len(feeds) else ""
            if finer[-TAP_DECIMALS:].strip("0"):
                rates[k] = finer.rstrip("0")
        return rates

    def write(self, remarks: Remarks, progress: Progress) -> NDArray[np.int32]:
        """Write everything; return the line of each move."""
        moves = self.moves
        self._blocks(self.post.program.top)
        for comment in remarks.head:
            self.blocks.comment(comment)
        for note in remarks.notes:
            self.blocks.note(note)
        self._blocks(self.post.program.start)
        lines, rows, stops = np.zeros(len(moves), np.int32), MotionRows.none(), self._stops(remarks)
        i = begun = ready = 0
        while i < len(moves):
            if i >= ready:
                progress.step(i / len(moves), "Writing NC")
                begun, ready = i, min(i + MOVES_A_STEP, len(moves))
                rows = motion_rows(moves, (begun, ready), self.arc_rules, self.z_scale)
            self._head(i, remarks)
            hole = self.holes.get(i)
            if hole is not None:
                self.blocks.hole(hole, [(moves.lists.kind[k], moves.lists.end[k]) for k in range(i, hole.stop)])
                lines[i : hole.stop] = self.blocks.motion_line
                i = hole.stop
                continue
            stop = min(int(stops[np.searchsorted(stops, i, side="right")]), ready)
            first = int(rows.stops[i - begun - 1]) if i > begun else 0
            done = self.blocks.motions(rows.rows, first, int(rows.stops[stop - begun - 1]))
            lines[i:stop] = done[rows.stops[i - begun : stop - begun] - 1 - first]
            i = stop
        for corner in self.corners[::-1].tolist():
            lines[corner] = lines[corner + 1]
        self._leave_tool(len(moves) - 1)
        self._home()
        self._blocks(self.post.program.end)
        return lines

    def _stops(self, remarks: Remarks) -> NDArray[np.int64]:
        """Return before which moves more than motions may have to be written, and the number of moves."""
        tool, operation = self.moves.tool, self.moves.operation
        changes = np.flatnonzero((tool[1:] != tool[:-1]) | (operation[1:] != operation[:-1])) + 1
        own = [len(self.moves), *self.holes, *self.waits, *self.offsets, *remarks.before]
        return np.unique(np.concatenate([changes, np.array(own, np.int64)]))

    def _head(self, i: int, remarks: Remarks) -> None:
        """Write what stands before move i: its tool, what its operation is, remarks."""
        moves = self.moves
        new_tool = i == 0 or moves.tool[i] != moves.tool[i - 1]
        if new_tool:
            self._change_tool(i)
        if i == 0 or moves.operation[i] != moves.operation[i - 1]:
            self.blocks.comment(remarks.operation(int(moves.operation[i])))
        if new_tool:
            self.blocks.rapid_z(int(moves.end[i, 2]))
        for comment in remarks.before.get(i, ()):
            self.blocks.comment(comment)
        self.blocks.block(self.waits.get(i, ""))
        self.blocks.block(self.offsets.get(i, ""))

    def _change_tool(self, i: int) -> None:
        """Leave the tool before, if there is one, and take the tool of move i."""
        if i:
            self._leave_tool(i - 1)
        self._home()
        self.blocks.forget()
        tool, z = self.job.tool(int(self.moves.tool[i])), int(self.moves.end[i, 2])
        self.blocks.comment(tool_words(tool, self.job.out_units))
        fields = self._tool_fields(i) | {"clearance": self.blocks.number(z, self.digits.Z)}
        for template in self.post.program.tool:
            text = template.format(**fields).strip()
            if "{clearance" in template:
                self.blocks.clearance(text, z)
            else:
                self.blocks.block(text)

    def _leave_tool(self, i: int) -> None:
        """Go to safe Z, where each tool began, after move i, the last of its tool; then stop spindle and coolant."""
        self.blocks.rapid_z(int(self.moves.end[0, 2]))
        for template in self.post.program.leave:
            self.blocks.block(template.format(**self._tool_fields(i)).strip())

    def _home(self) -> None:
        """Go to the machine's own home along Z, if the post wants it."""
        for template in self.post.program.home:
            self.blocks.home(template.format(**self.fields).strip())

    def _blocks(self, templates: tuple[str, ...]) -> None:
        """Write the post's blocks."""
        for template in templates:
            self.blocks.block(template.format(**self.fields).strip())

    def _tool_fields(self, i: int) -> Fields:
        """Return what the templates round the tool of move i may name."""
        return self.fields | tool_fields(self.job, int(self.moves.tool[i]), self.post, self._next_tool(i))

    def _next_tool(self, i: int) -> int:
        """Return the T number that follows that of move i; after the last one, the first."""
        tools = self.moves.tool
        others = tools[i:] != tools[i]
        return int(tools[i + np.argmax(others)] if others.any() else tools[0])


# Whether a sequence of moves may be sent to a machine at all: no rapid into work, every tool begins at clearance.


Mask = NDArray[np.bool_]

SAME = 1e-9
"""Coordinates that differ by less are alike, mm."""


def check_sequence(moves: Moves, job: Job) -> None:
    """Refuse moves that no machine should make.

    Every tool begins with a rapid at safe Z; rapids go either along Z or level, never down below retract Z but between
    the pecks of a hole, and never level below it; cutting moves have a feed rate; arcs have a radius and are exactly a
    full turn or clearly less, as noise can make a full turn of an arc of no length.

    Raises:
        ParameterError: naming the first move that breaks a rule, where it ends, and the rule.
    """
    if not len(moves):
        raise ParameterError("The program has no moves, so there is nothing to write; enable an operation and compute.")
    _refuse(
        moves,
        (moves.operation < 0) | (moves.operation >= len(job.operations)),
        "belongs to an operation that the job does not have any more; compute again",
    )
    first = np.append(True, moves.tool[1:] != moves.tool[:-1])
    rapid = moves.kind == MoveKind.RAPID
    arc = moves.kind >= MoveKind.ARC_CW
    numbers = np.isfinite(moves.end).all(axis=1) & (np.isfinite(moves.centre).all(axis=1) | ~arc)
    _refuse(moves, ~numbers, "has a coordinate that is no number")
    _refuse(
        moves,
        first & ~(rapid & (np.abs(moves.end[:, 2] - job.travel_z) < SAME)),
        f"is the first of T{{tool}} and must be a rapid at safe Z {job.travel_z:g}",
    )
    _check_rapids(moves, rapid & ~first, job)
    _refuse(moves, ~rapid & ~(moves.feed > 0), "cuts without a feed rate")
    _check_arcs(moves, arc)


def _check_rapids(moves: Moves, rapid: Mask, job: Job) -> None:
    """Refuse rapids that could meet metal; `rapid` leaves the first of each tool out."""
    low = job.retract_z - SAME
    delta = moves.end - moves.start
    level, along_z = np.hypot(delta[:, 0], delta[:, 1]) > SAME, np.abs(delta[:, 2]) > SAME
    _refuse(moves, rapid & level & along_z, "is a rapid that changes XY and Z at once; move level first, then along Z")
    _refuse(moves, rapid & level & (moves.end[:, 2] < low), f"is a rapid in XY below retract Z {job.retract_z:g}")
    down = (delta[:, 2] < -SAME) & ~_into_the_hole(moves)
    _refuse(moves, rapid & down & (moves.end[:, 2] < low), f"is a rapid down below retract Z {job.retract_z:g}")


def _into_the_hole(moves: Moves) -> Mask:
    """Return which moves go down between two pecks: where the move before the last one drilled, no deeper than it
    did.
    """
    before, after = moves.end[:-2], moves.end[2:]
    same = np.hypot(*(before - after)[:, :2].T) < SAME
    drilled = (moves.purpose[:-2] == Purpose.DRILL) & (moves.kind[:-2] == MoveKind.LINE)
    return np.concatenate([np.zeros(min(2, len(moves)), bool), same & drilled & (after[:, 2] > before[:, 2] - SAME)])


def _check_arcs(moves: Moves, arc: Mask) -> None:
    """Refuse arcs that are no arcs."""
    radius = np.hypot(*(moves.end[:, :2] - moves.centre).T)
    gap = np.hypot(*(moves.end - moves.start)[:, :2].T)
    _refuse(moves, arc & ~(radius > 0), "is an arc without a radius")
    _refuse(
        moves,
        arc & (gap > 0) & (gap < SAME) & (np.abs(moves.sweeps()) > np.pi),
        "is an arc whose ends nearly meet, so it may be nothing or a full circle; make the ends exactly alike or leave "
        "it out",
    )


def _refuse(moves: Moves, wrong: Mask, sentence: str) -> None:
    """Raise for the first move that is marked."""
    if wrong.any():
        i = int(np.argmax(wrong))
        x, y, z = moves.end[i]
        raise ParameterError(f"Move {i + 1} to X {x:g} Y {y:g} Z {z:g} {sentence.format(tool=moves.tool[i])}.")
