"""What is in force at a line of a program, in short words. No Qt."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ....gcode.interpreter.program import ModalState
from ....gcode.timing.duration import Duration
from ....model.part import Units
from ...framework.figures import THIN_SPACE, clock, grouped
from .motion_shapes import MotionShapes

_WORDS = ("G0", "G1", "G2", "G3", "Spline")
_PLANES = ("G17", "G18", "G19")


@dataclass(frozen=True, slots=True)
class StateItem:
    """One thing to know: a short name, perhaps "", and its value."""

    name: str
    value: str


def state_items(
    shapes: MotionShapes, row: int, motion: int | None = None, times: Duration | None = None
) -> list[StateItem]:
    """Return what is in force once the line at `row` (0-based) is done, what matters most first.

    A line without a motion has the place of the motion before it and the words of the one that comes next.

    Args:
        shapes: the program's motions.
        row: the line that was picked.
        motion: of the line's motions the one that is meant; None = its last.
        times: when each motion ends.
    """
    own = shapes.of_rows(row, row)
    done = motion if motion is not None else shapes.before_row(row)
    if not len(shapes):
        return []
    later = np.searchsorted(shapes.lines, row + 2)
    coming = int(shapes.by_line[min(int(later), len(shapes) - 1)])
    state = shapes.program.states[int(shapes.program.motions.state[done if len(own) and done is not None else coming])]
    items = _tool_items(state)
    if len(own) and done is not None:
        items += _motion_items(shapes, done)
    if done is not None:
        items += _place_items(shapes, done)
        if times is not None:
            items.append(StateItem("Time", clock(float(times.ends[done]))))
    return items + _modal_items(state)


def _tool_items(state: ModalState) -> list[StateItem]:
    sense = {1: "M3", -1: "M4", 0: "M5"}[state.spindle]
    unit = "m/min" if state.constant_surface else "rpm"
    items = [StateItem("", f"T{state.tool}" if state.tool else "No tool")]
    items.append(StateItem(sense, f"{grouped(state.speed, 0)} {unit}" if state.spindle else "off"))
    coolant = " ".join(word for word, on in (("flood", state.flood), ("mist", state.mist)) if on)
    return [*items, StateItem("", coolant)] if coolant else items


def _place_items(shapes: MotionShapes, motion: int) -> list[StateItem]:
    """Return where a motion ends; of an axis that is at the machine's own home only the machine knows where that is."""
    ends = zip("XYZ", shapes.program.motions.end[motion].tolist(), shapes.home[motion].tolist(), strict=True)
    return [StateItem(name, "home" if home else f"{value + 0.0:.3f}") for name, value, home in ends]


def _motion_items(shapes: MotionShapes, motion: int) -> list[StateItem]:
    motions = shapes.program.motions
    kind, feed = int(motions.kind[motion]), float(motions.feed[motion])
    items = [StateItem("", _WORDS[kind])]
    if kind:
        items.append(StateItem("F", "not told" if np.isnan(feed) else f"{grouped(feed, 0 if feed >= 10 else 2)}"))
    if motion in shapes.program.homeward:
        return [*items, StateItem("", "to the machine's home")]
    return [*items, StateItem("Length", f"{grouped(float(shapes.length[motion]))} mm")]


def _modal_items(state: ModalState) -> list[StateItem]:
    words = [
        _PLANES[int(state.plane)],
        "G20" if state.units is Units.INCH else "G21",
        "G90" if state.absolute else "G91",
        state.feed_mode.value,
        state.work_offset,
    ]
    words.append(f"G43{THIN_SPACE}H{state.length_offset}" if state.length_offset else "G49")
    words.append(state.path)
    if any(state.shift):
        words.append("shifted " + ", ".join(f"{value:.3f}" for value in state.shift))
    return [StateItem("", word) for word in words]
