"""What has to be in force while the moves are cut: tool, length, spindle, coolant, feed, work offset, blending."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...model.job import Job
from ...model.moves import MoveKind, Moves
from ..interpreter.program import FeedMode, ModalState, NcProgram, ProgramProblem
from ..posts.post import Coolant, Post
from ..writer.write import blend_mm
from .hole_pauses import backing_out
from .lines import MotionOwners

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
    """Yield a motion whose feed is not its move's, to half a step of F's last decimal, at least one step."""
    feed, reference = read.motions.feed[owned.rows], moves.feed[owned.move]
    cuts = moves.kind[owned.move] != MoveKind.RAPID
    step = expected.feed_step
    wrong: NDArray[np.bool_] = cuts & ~(np.abs(feed - np.maximum(reference, step)) <= step / 2 + 1e-9 * reference)
    if wrong.any():
        k = int(np.argmax(wrong))
        yield ProgramProblem(
            int(read.motions.line[owned.rows[k]]),
            0,
            "F",
            f"the feed is {feed[k]:g} mm/min where {reference[k]:g} was meant, and so in {int(np.sum(wrong))} motions.",
        )
