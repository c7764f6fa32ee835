"""Canned cycles as the control obeys them: their words out of a block, their steps into motions and events."""

from __future__ import annotations

from .block import Block
from .control import Control
from .cycles import Cycle, CycleMove, Dwell, Spindle, Stop, cycle_steps, taps_astray, with_sticky
from .expression import whole
from .offsets import Place
from .polar import polar_step
from .program import EventKind


def bore(control: Control, block: Block) -> None:
    """Do the holes of a block of a canned cycle.

    Raises:
        Fault: a word is missing or has no sense, or the holes are more than the reader takes.
    """
    place = _program_place(control)
    if control.cycle is None:
        control.initial = place[control.modal.plane.axes[2]]
    cycle = with_sticky(_cycle(control, block), control.cycle)
    control.cycle = cycle
    control.note_known(block)
    if taps_astray(cycle):
        control.warn(
            f"LinuxCNC (2.9) feeds {cycle.code} along the wrong axes in G18 and G19; it is shown as it would move.", "g"
        )
    for step in cycle_steps(cycle, place, control.initial):
        if isinstance(step, CycleMove):
            control.unroll()
            _move(control, step)
        elif isinstance(step, Dwell):
            control.event(EventKind.DWELL, step.seconds)
        elif isinstance(step, Spindle):
            control.change(spindle=step.turning)
        elif isinstance(step, Stop):
            control.event(EventKind.STOP)


def _program_place(control: Control) -> Place:
    """Return where the point is, in units of the program, without the noise of its way through the offsets: R may be
    just there.
    """
    x, y, z = (round(coordinate / control.unit, 9) for coordinate in control.program_place)
    return (x, y, z)


def _move(control: Control, step: CycleMove) -> None:
    """Do a step; where the control goes astray it believes that it stands where it was meant to."""
    end = _table(control, step.target)
    feed = control.feed_along(1.0) if step.kind else 0.0
    control.move(step.kind, end, feed)
    if step.meant is not step.target:
        control.at = _table(control, step.meant)


def _table(control: Control, target: Place) -> Place:
    unit = control.unit
    return control.offsets.to_table((target[0] * unit, target[1] * unit, target[2] * unit))


def _cycle(control: Control, block: Block) -> Cycle:
    """Return the cycle as the block words it, in units of the program."""
    u, v, w = control.modal.plane.axes
    words = [_length(control, block, letter) for letter in "xyz"]
    repeats = block.get("l")
    fanuc = control.rules.fanuc_flow
    if repeats is None and fanuc and control.motion != "G87":
        repeats = block.get("k")
    dwell = block.get("p")
    if dwell is not None:
        dwell *= control.rules.dwell_unit_s if "p" in block.whole else control.rules.dwell_unit_with_point_s
    return Cycle(
        code=control.motion,
        plane=control.modal.plane,
        hole=(words[u], words[v]),
        polar=polar_step(block),
        depth=words[w],
        r=_length(control, block, "r"),
        repeats=1 if repeats is None else whole(repeats, "the number of repeats"),
        dwell=dwell,
        peck=_length(control, block, "q"),
        shift=(_length(control, block, "i"), _length(control, block, "j"), _length(control, block, "k")),
        absolute=control.modal.absolute,
        retract_to_r=control.modal.retract_to_r,
        spindle=control.modal.spindle,
        unit_mm=control.unit,
        fanuc=fanuc,
    )


def _length(control: Control, block: Block, letter: str) -> float | None:
    value = block.get(letter)
    return value * control.least if value is not None and letter in block.whole else value
