"""How long a program runs on a machine: feeds, accelerations, corners, dwells and tool changes.

Model. Along each motion the speed rises and falls at the machine's acceleration and never exceeds what the feed, the
axes' rapid rates and, on curves, sqrt(acceleration x radius) allow. From one motion to the next the speed is bounded by
the corner: where the control may leave it by a distance d, by that of an arc tangent to both motions that passes the
corner at d; it is never less than what the change of velocity that the axes can make in one servo period carries on.
Short lines may stand for a curve: at a corner its radius is estimated from the turn and the straight ways on both
sides, and sqrt(acceleration x radius) bounds the speed there too, so that a circle of chords takes the time of the arc.
The control looks ahead over the whole program. It stops where feed and rapid motions meet, where G61.1 says so, and
where anything but motion is done. What real controls do besides (jerk limits, short look-ahead, planning of their own)
is not in it.

References: the corner's arc is the usual junction deviation, v^2 = a d s / (1 - s) with s the sine of half the corner's
inner angle.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...model.machine import Machine
from ...model.motion import Floats, MotionKind, Motions
from ...model.motion_path import ArcPaths, along_xyz, arc_paths, directions, lengths, spline_points
from ..interpreter.program import EventKind, ModalState, NcProgram

STILL = 1e-9
"""mm; shorter motions take no time and make no corner."""

TIME_METHOD = (
    "feeds and accelerations with look-ahead, corners blended as the program says, dwells and tool changes, on this "
    "machine: {}; no jerk, no stops by hand"
)
"""How times are come by, for reports; {} is the machine's title."""

JUMP = 1e-6
"""mm; a motion that begins farther from the end of the one before begins at rest."""


@dataclass(frozen=True, eq=False)
class Duration:
    """How long n motions take, s.

    Attributes:
        moving: (n,) each motion.
        waiting: (n + 1,) dwells and tool changes before each motion, and behind the last.
        tool: (n + 1,) T number in the spindle, for each of these.
        rapid: (n,) whether a motion is a rapid.
        feedless: how many motions the program gives no feed for; they are timed at the machine's largest.
        changes: how many tools are taken. changing: seconds of `waiting` for these; the rest are dwells.
    """

    moving: Floats
    waiting: Floats
    tool: NDArray[np.int32]
    rapid: NDArray[np.bool_]
    feedless: int = 0
    changes: int = 0
    changing: float = 0.0

    @property
    def total(self) -> float:
        """From the start of the program to its end."""
        return float(np.sum(self.moving) + np.sum(self.waiting))

    @property
    def ends(self) -> Floats:
        """(n,) when each motion ends, from the start of the program."""
        return np.cumsum(self.moving + self.waiting[:-1])

    @property
    def by_tool(self) -> dict[int, float]:
        """Seconds by T number, in the order of use; a tool's change counts to it."""
        whole = np.append(self.moving, 0.0) + self.waiting
        used = dict.fromkeys(self.tool.tolist())
        return {tool: seconds for tool in used if (seconds := float(np.sum(whole[self.tool == tool]))) > 0}

    @property
    def parts(self) -> dict[str, float]:
        """Seconds of feed motions, of rapids, and of dwells and tool changes."""
        return {
            "cut": float(np.sum(self.moving[~self.rapid])),
            "rapid": float(np.sum(self.moving[self.rapid])),
            "wait": float(np.sum(self.waiting)),
        }


def duration(program: NcProgram, machine: Machine) -> Duration:
    """Return how long a program takes on a machine.

    Args:
        program: as it was read; stops (M0, M1) take no time, as nobody knows how long the operator waits.
        machine: its rates and accelerations.
    """
    from .duration_kernels import corners, curves, run

    motions = program.motions
    waits = _waits(program, machine)
    feedless = (motions.kind != MotionKind.RAPID) & ~(motions.feed > 0)
    arcs = arc_paths(motions)
    length = lengths(motions, arcs)
    rows = np.flatnonzero(length > STILL)
    moving = np.zeros(len(motions))
    if len(rows):
        speed, acceleration = _limits(motions, machine, length, arcs)
        own = np.column_stack([column[rows] for column in (length, speed, acceleration)])
        ways = np.stack([np.take(vectors, rows, axis=0) for vectors in directions(motions, arcs)], axis=1)
        entry, seconds, limits = (
            np.empty(len(rows) + 1),
            np.empty(len(rows)),
            np.stack([_rapids(machine), _accelerations(machine)]),
        )
        corners(ways, own, _corners(program, machine, rows), limits, entry)
        curves(ways, own, limits, entry)
        run(own, entry, seconds)
        moving[rows] = seconds
    return Duration(
        moving,
        waits.waiting,
        waits.tool,
        motions.kind == MotionKind.RAPID,
        int(np.sum(feedless)),
        waits.changes,
        waits.changes * machine.tool_change,
    )


@dataclass(frozen=True, eq=False)
class _Waits:
    """Waiting before each motion, s, and the tool that it counts to; how many tools are taken."""

    waiting: Floats
    tool: NDArray[np.int32]
    changes: int


def _waits(program: NcProgram, machine: Machine) -> _Waits:
    count = len(program.motions)
    waiting, held, changes = np.zeros(count + 1), 0, 0
    of_state = np.array([state.tool for state in program.states], np.int32)
    for event in program.events:
        if event.kind is EventKind.DWELL:
            waiting[event.before] += event.value
        elif event.kind is EventKind.TOOL_CHANGE and int(event.value) != held:
            waiting[event.before] += machine.tool_change
            held, changes = int(event.value), changes + 1
    return _Waits(waiting, np.append(of_state[program.motions.state], held).astype(np.int32), changes)


def _rapids(machine: Machine) -> Floats:
    """Return (3,) the axes' greatest velocities, mm/s."""
    return np.array([axis.rapid for axis in machine.axes], float) / 60


def _accelerations(machine: Machine) -> Floats:
    return np.array([axis.acceleration for axis in machine.axes], float)


def _limits(motions: Motions, machine: Machine, length: Floats, arcs: ArcPaths) -> tuple[Floats, Floats]:
    """Return (n,) greatest speed, mm/s, and acceleration, mm/s2, along each motion."""
    rapids, accelerations = _rapids(machine), _accelerations(machine)
    shares = np.abs(motions.end - motions.start) / np.maximum(length, STILL)[:, None]
    shares[arcs.rows] = _arc_shares(arcs)
    for row in motions.splines:
        shares[row] = 1.0
    with np.errstate(divide="ignore"):
        speed = _least(rapids / shares)
        acceleration = _least(accelerations / shares)
    feed = np.where(motions.feed > 0, np.minimum(motions.feed, machine.largest_feed), machine.largest_feed) / 60
    speed = np.where(motions.kind == MotionKind.RAPID, speed, np.minimum(speed, feed))
    _round_curves(motions, arcs, accelerations, speed)
    return speed, acceleration


def _least(rows: Floats) -> Floats:
    """Return the least of each row of three."""
    return np.asarray(np.minimum(np.minimum(rows[:, 0], rows[:, 1]), rows[:, 2]))


def _arc_shares(arcs: ArcPaths) -> Floats:
    """Return (m, 3) the largest share of an arc's speed that each axis can have."""
    whole = np.maximum(arcs.lengths(), STILL)
    rise = np.abs(arcs.rise) / whole
    flat = np.sqrt(np.maximum(1 - rise**2, 0))
    return along_xyz(np.column_stack([flat, flat, rise]), arcs.axes)


def _round_curves(motions: Motions, arcs: ArcPaths, accelerations: Floats, speed: Floats) -> None:
    """Bound the speed on arcs and splines by the acceleration towards their centre."""
    inward = np.minimum(*(accelerations[arcs.axes[:, column]] for column in (0, 1)))
    radius = np.maximum(np.minimum(arcs.start_radius, arcs.end_radius), STILL)
    across = np.maximum(np.abs(arcs.sweep) * radius, STILL)
    flat = across / np.hypot(across, arcs.rise)
    speed[arcs.rows] = np.minimum(speed[arcs.rows], np.sqrt(inward * radius) / np.maximum(flat, STILL))
    for row, spline in motions.splines.items():
        steps = np.diff(spline_points(spline), axis=0)
        sizes = np.maximum(np.linalg.norm(steps, axis=1), STILL)
        turns = np.linalg.norm(np.diff(steps / sizes[:, None], axis=0), axis=1)
        bend = np.max(2 * turns / (sizes[:-1] + sizes[1:]), initial=STILL)
        speed[row] = min(speed[row], np.sqrt(np.min(accelerations) / bend))


def _corners(program: NcProgram, machine: Machine, rows: NDArray[np.intp]) -> Floats:
    """Return (k - 1,) how far the control leaves the path between each two of the motions that move, mm; < 0: it stops
    there.
    """
    tolerance = np.array([_corner(state, machine) for state in program.states])[program.motions.state[rows[:-1]]]
    return np.where(_stops(program, rows), -1.0, tolerance)


def _corner(state: ModalState, machine: Machine) -> float:
    """Return how far the control leaves a corner, mm; negative: it stops at every end."""
    if state.path == "G61.1":
        return -1.0
    if state.path == "G61":
        return 0.0
    return machine.corner if state.path_tolerance is None else state.path_tolerance


def _stops(program: NcProgram, rows: NDArray[np.intp]) -> NDArray[np.bool_]:
    """Tell between which of the motions that move the control stands still: events, spindle, coolant, rapid to feed,
    jumps.
    """
    motions, before, after = program.motions, rows[:-1], rows[1:]
    rapid = motions.kind == MotionKind.RAPID
    seen: dict[object, int] = {}
    doing = np.array(
        [seen.setdefault((s.tool, s.spindle, s.speed, s.flood, s.mist), len(seen)) for s in program.states]
    )[motions.state]
    events = np.zeros(len(motions) + 1, np.int64)
    np.add.at(events, [event.before for event in program.events], 1)
    done = np.cumsum(events)
    gap = motions.start[after] - motions.end[before]
    jump = np.einsum("ij,ij->i", gap, gap) > JUMP**2
    return np.asarray(
        (rapid[before] != rapid[after]) | (doing[before] != doing[after]) | (done[before] != done[after]) | jump
    )
