"""What has to be in force while the moves are cut: tool, length, spindle, coolant, feed, work offset, blending."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from ...core.progress import Progress
from ...model.job import Job
from ...model.motion import Plane
from ...model.moves import MoveKind, Moves, Purpose
from ...model.part import Units
from ..interpreter.compensation import Compensation
from ..interpreter.control import Control
from ..interpreter.dialect import Dialect
from ..interpreter.offsets import OFFSETS, ZERO, Place, taken
from ..interpreter.options import ReadOptions
from ..interpreter.program import Event, EventKind, FeedMode, ModalState, NcProgram, ProgramProblem
from ..posts import Coolant, Post
from ..writer.write import TAP_DECIMALS, blend_mm
from .path import MotionOwners

WORK_OFFSET = re.compile(r"G54\.1 P\d+|G5[4-9](?:\.\d)?")

STOP = re.compile(r"\bM0?[01]\b")

BLEND = re.compile("G64.*{blend}")

HOME_HEIGHT = re.compile(r"G53\b.*Z(-?[0-9.]+)")

END = re.compile(r"\bM0?(?:2|30)\b")


@dataclass(frozen=True)
class ExpectedState:
    """What a post and a job promise.

    Attributes:
        job: its tools and their speeds.
        changes: there is a tool change before each tool. lengths: its length is taken by G43.
        flood, mist: coolant while moves are done.
        work_offset: in force.
        exact: G61. blend_mm: how far G64 P and Q may let the control leave the path; None = no word says it.
        dwell_s: what the spindle has to reach its speed; None = the post lets the control wait.
        stops: the post's own blocks stop the program. ends: they end it.
        homes: codes by which the post's own blocks go home. home_heights: where G53 sends them along Z, mm, machine
            coordinates.
        feed_step: of the last decimal of F, mm/min.
    """

    job: Job
    changes: bool
    lengths: bool
    flood: bool
    mist: bool
    work_offset: str
    exact: bool
    blend_mm: float | None
    dwell_s: float | None
    stops: bool
    ends: bool
    homes: tuple[str, ...]
    home_heights: tuple[float, ...]
    feed_step: float

    @staticmethod
    def of(job: Job, post: Post) -> ExpectedState:
        """Return what the text of a job should have in force by this post."""
        lines = post.program
        offsets = WORK_OFFSET.findall(" ".join((*lines.start, *lines.tool)))
        blocks = (*lines.top, *lines.start, *lines.tool, *lines.leave, *lines.home, *lines.end)
        return ExpectedState(
            job=job,
            changes=not post.file_per_tool,
            lengths=any("G43" in line for line in lines.tool),
            flood=post.coolant.use is Coolant.FLOOD and any("{coolant_on}" in line for line in lines.tool),
            mist=post.coolant.use is Coolant.MIST and any("{coolant_on}" in line for line in lines.tool),
            work_offset=offsets[-1] if offsets else "G54",
            exact=job.exact_path,
            blend_mm=None if job.exact_path or not BLEND.match(post.blending.blend) else blend_mm(job, post),
            dwell_s=post.spindle.dwell_s if any("{dwell" in line for line in lines.tool) else None,
            stops=any(STOP.search(line) for line in blocks),
            ends=any(END.search(line) for line in blocks),
            homes=tuple(code for code in ("G28", "G30") if code in " ".join(lines.home)),
            home_heights=tuple(float(z) * job.out_units.value for z in HOME_HEIGHT.findall("\n".join(lines.home))),
            feed_step=job.out_units.value * 10.0 ** -post.digits(job.out_units).F,
        )


def wrong_states(
    read: NcProgram, moves: Moves, owned: MotionOwners, expected: ExpectedState
) -> Iterator[ProgramProblem]:
    """Yield what is in force and should not be, each with the first line where it is so.

    Args:
        read: the text as it was read.
        moves: what it was written for.
        owned: which motions belong to which moves.
        expected: what the post promises.
    """
    line, state = read.motions.line[owned.rows], read.motions.state[owned.rows]
    tool = moves.tool[owned.move]
    back = backing_out(moves, expected.job)[owned.move]
    pairs, first = np.unique(np.column_stack([state, tool, back]), axis=0, return_index=True)
    reported: set[str] = set()
    for k in np.argsort(first):
        for text in _state_faults(read.states[pairs[k, 0]], int(pairs[k, 1]), expected, bool(pairs[k, 2])):
            if text not in reported:
                reported.add(text)
                yield ProgramProblem(int(line[first[k]]), 0, "", text)
    yield from _feed_faults(read, moves, owned, expected)


def _state_faults(state: ModalState, number: int, expected: ExpectedState, back: bool) -> Iterator[str]:
    """Yield what is wrong while a tool does its moves; `back`: while a tap comes out of its hole."""
    tool = expected.job.tool(number)
    if expected.changes and state.tool != number:
        yield f"T{state.tool} is in the spindle where T{number} was meant."
    if expected.lengths and state.length_offset != number:
        yield f"the tool length is H{state.length_offset} where H{number} was meant."
    if not expected.lengths and state.length_offset:
        yield f"the tool length H{state.length_offset} of an earlier program is in force; G49 ends it."
    left = expected.job.turns_left(number) is not back
    if state.spindle != (-1 if left else 1) or state.constant_surface:
        way, word = ("counter-clockwise", "M4") if left else ("clockwise", "M3")
        yield f"the spindle does not turn {way}{', so that the tap comes out' if back else f' ({word})'}."
    if state.speed != round(tool.spindle_speed):
        yield f"the spindle speed is S{state.speed:g} where S{tool.spindle_speed:.0f} was meant."
    if (state.flood, state.mist) != (expected.flood, expected.mist):
        yield "the coolant is not what was meant."
    if state.work_offset != expected.work_offset or any(state.shift) or state.rotation:
        yield (
            f"the work offset is {state.work_offset}, shifted by {state.shift}, where plain {expected.work_offset} "
            "was meant."
        )
    if state.feed_mode is not FeedMode.PER_MINUTE:
        yield f"feeds are by {state.feed_mode.value}, not per minute (G94)."
    if expected.exact and not state.path.startswith("G61"):
        yield f"the control may leave the path ({state.path}), and an exact path was meant."
    if expected.blend_mm is not None and _blends(state) > expected.blend_mm + 1e-9:
        yield (
            f"the control may leave the path by {_blends(state):g} mm ({state.path}); {expected.blend_mm:g} mm were "
            "meant."
        )


def _blends(state: ModalState) -> float:
    """Return how far the control may leave the path, mm: P and Q of G64, as far as it pleases without them."""
    if state.path.startswith("G61"):
        return 0.0
    words = [float(word[1:]) * state.units.value for word in state.path.split()[1:]]
    return float("inf") if state.path_tolerance is None else max([*words, state.path_tolerance])


def _feed_faults(
    read: NcProgram, moves: Moves, owned: MotionOwners, expected: ExpectedState
) -> Iterator[ProgramProblem]:
    """Yield a motion whose feed is not its move's, to half a step of F's last decimal, at least one step; of taps the
    step of the decimals that they have beyond it.
    """
    feed, reference = read.motions.feed[owned.rows], moves.feed[owned.move]
    cuts = moves.kind[owned.move] != MoveKind.RAPID
    taps = [k for k, each in enumerate(expected.job.operations) if each.TAPS]
    step = expected.feed_step * np.where(np.isin(moves.operation[owned.move], taps), 10.0**-TAP_DECIMALS, 1.0)
    wrong: NDArray[np.bool_] = cuts & ~(np.abs(feed - np.maximum(reference, step)) <= step / 2 + 1e-9 * reference)
    if wrong.any():
        k = int(np.argmax(wrong))
        yield ProgramProblem(
            int(read.motions.line[owned.rows[k]]),
            0,
            "F",
            f"the feed is {feed[k]:g} mm/min where {reference[k]:g} was meant, and so in {int(np.sum(wrong))} motions.",
        )


# Where the tool is to wait in holes, and where the spindle is to turn back: from the moves and the job alone.


Mask = NDArray[np.bool_]

_SAME = 1e-6

_SECOND = 1e-3
"""s by which a wait may be longer or shorter."""


def backing_out(moves: Moves, job: Job) -> Mask:
    """Return (n,) which moves lead a tap out of its hole, so that the spindle must turn the other way."""
    taps = [k for k, each in enumerate(job.operations) if each.TAPS]
    up = moves.end[:, 2] > moves.start[:, 2] + _SAME
    back: Mask = np.isin(moves.operation, taps) & (moves.kind == MoveKind.LINE) & up
    return back


def _bottoms(moves: Moves, job: Job) -> dict[int, float]:
    """Return how long the tool waits behind moves that end at the bottoms of holes, s, by their index."""
    seconds = {k: each.dwell_s for k, each in enumerate(job.operations) if each.dwell_s > 0}
    drilling = (moves.kind == MoveKind.LINE) & (moves.purpose == Purpose.DRILL)
    lines = np.flatnonzero(drilling & np.isin(moves.operation, list(seconds)))
    if not len(lines):
        return {}
    place, height = moves.end[lines, :2], moves.end[lines, 2]
    elsewhere = np.hypot(*np.diff(place, axis=0).T) > _SAME
    hole = np.cumsum(np.append(True, elsewhere | (np.diff(moves.operation[lines]) != 0)))
    deepest_first = np.lexsort((height, hole))
    lowest = lines[deepest_first[np.unique(hole[deepest_first], return_index=True)[1]]]
    return {k: seconds[int(moves.operation[k])] for k in lowest.tolist()}


class HolePauses:
    """The waits that the holes of a program are to have, ticked off as they are met."""

    def __init__(self, moves: Moves, job: Job, owned: MotionOwners) -> None:
        """Find them."""
        self._missing = _bottoms(moves, job)
        self._behind = {int(owned.last[k]) + 1: k for k in self._missing}
        tapped = np.flatnonzero(backing_out(moves, job)) - 1
        self._turning = {int(owned.last[k]) + 1 for k in tapped.tolist()}

    def takes(self, event: Event) -> bool:
        """Tell whether an event is such a wait; a tapping cycle stands still for no time before it turns back."""
        if event.kind is not EventKind.DWELL:
            return False
        if event.before in self._turning and event.value <= _SECOND:
            return True
        move = self._behind.get(event.before)
        if move is None or abs(self._missing.get(move, -1.0) - event.value) > _SECOND:
            return False
        del self._missing[move]
        return True

    def missing(self, lines: Sequence[int] | NDArray[np.int32]) -> Iterator[ProgramProblem]:
        """Yield a wait that has not been met."""
        for move, seconds in self._missing.items():
            text = f"the tool does not wait for {seconds:g} s at the bottom of the hole, as it should."
            yield ProgramProblem(int(lines[move]), 0, "", text)
            return


# A text read again on a machine that was left as another job left it: other zeros, other homes, other modes in force.
#
# A control that is switched on stands where nothing is wrong by chance: at its zero, in millimetres, at G90. What a
# program does not say itself comes out right there, and shows here.


CUTTER_RADIUS = 7.5
"""mm, of the G41 that was left on."""


@dataclass(frozen=True)
class StartState:
    """How a machine stands when a program begins.

    Attributes:
        zero: of the work, mm, machine coordinates. start: of the tool's tip from there.
        homes: of G28 and G30, mm, machine coordinates.
        units: in force; a fresh control has mm.
    """

    zero: Place = ZERO
    start: Place = ZERO
    homes: Mapping[str, Place] = field(default_factory=lambda: {"G28": ZERO, "G30": ZERO})
    units: Units = Units.MM


FRESH = StartState()


def foreign_start(written_in: Units) -> StartState:
    """Return another place, above the work as a machine stands, with the units in force that the program is not written
    in.
    """
    return StartState(
        (-421.5, -263.25, -387.125),
        (137.25, 91.5, 63.75),
        {"G28": (-11.5, -23.25, -3.5), "G30": (-211.5, -131.25, -7.25)},
        Units.MM if written_in is Units.INCH else Units.INCH,
    )


def read_from_start(data: bytes, options: ReadOptions, start_state: StartState, progress: Progress) -> NcProgram:
    """Return what a control does with a program that finds the machine so; coordinates are from the work's zero.

    Args:
        data: the file's bytes.
        options: of the control; the length of one of its tools is in force at first.
        start_state: where everything is.
        progress: told of how much is read.

    Raises:
        Cancelled: the job was asked to stop.
    """
    from ..interpreter.run import InterpreterRun  # compiled code: loaded where it is used

    run = InterpreterRun(
        data, replace(options, start=tuple(np.add(start_state.start, start_state.zero).tolist())), progress
    )
    _leave_behind(run.control, options, start_state)
    return _from_zero(run.read(), start_state.zero)


def _leave_behind(control: Control, options: ReadOptions, start_state: StartState) -> None:
    """Put everything in force that another job may have left so and this one should say."""
    control.homes = dict(start_state.homes)
    offsets = control.offsets
    offsets.common, offsets.name = start_state.zero, "G55"
    offsets.work = {name: (10.5 * rank, 20.25 * rank, 5.125 * rank) for rank, name in enumerate(OFFSETS[1:], start=1)}
    control.selected, control.motion = max(options.tool_table, default=0) + 1, "G1"
    control.change(
        units=start_state.units,
        plane=Plane.ZX,
        absolute=False,
        arc_absolute=options.dialect in WITH_ARC_DISTANCE,
        feed_mode=FeedMode.INVERSE_TIME,
        tool=control.selected,
        speed=777.0,
        spindle=-1,
        length_offset=control.selected - 1,
    )
    if options.dialect is not Dialect.GRBL:
        control.compensation = Compensation(CUTTER_RADIUS, Plane.ZX, control.at)
    control.offsets_changed()


WITH_ARC_DISTANCE = frozenset({Dialect.LINUXCNC, Dialect.GRBL, Dialect.MACH3})
"""They know G90.1; the others' I and J always count from the start of the arc."""


def _from_zero(program: NcProgram, zero: Place) -> NcProgram:
    """Return a program with the work's zero at 0."""
    motions = program.motions
    shift = np.array(zero)
    moved = replace(motions, start=motions.start - shift, end=motions.end - shift, centre=motions.centre - shift)
    return replace(
        program, motions=moved, states=tuple(replace(state, shift=taken(state.shift, zero)) for state in program.states)
    )
