"""Codes that move the tool: straight lines, arcs and helices, home, probing, threads, and the cycles and splines of
their own files.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ...geometry.arcs.nurbs import flattened
from ...model.motion import MotionKind, Nurbs, Plane
from ...model.part import Units
from .arc_kernels import centre_by_radius, radii
from .block import Block
from .codes import AXES, CYCLES, ROTARY, TAKES, WITHOUT_AXES, ModalGroup
from .control import ArcShape, AxisWord, Control
from .cycles import Cycle, CycleMove, Dwell, Spindle, Stop, cycle_steps, hole_planes, taps_astray, with_sticky
from .dialect import Dialect
from .expression import whole
from .foreign_codes import warn_of_rotary
from .offsets import Place, replaced, taken
from .polar import polar_step
from .program import BlockFault, EventKind, FeedMode
from .splines import OpenFanucNurbs, OpenNurbs, check_plane, cubic, first_offset, quadratic, second_offset

# Splines as the control obeys them: their words out of blocks, the finished curve as one motion.


LENGTH_MM = 0.01
"""How near the chords lie that measure a curve's length for a feed in inverse time."""


def move_along_curve(control: Control, block: Block) -> None:
    """Obey G5, G5.1, G5.2, G5.3 and G6.2.

    Raises:
        Fault: the control has no such word, or a word of the curve is missing or has no sense.
    """
    code, family = control.motion, control.rules.splines
    if family != ("G6.2" if code == "G6.2" else "G5"):
        raise BlockFault(f"{control.rules.title} draws no curve with {code}.", letter="g")
    if code in ("G5", "G5.1"):
        _one_block(control, block, code)
    elif code == "G5.2":
        _control_point(control, block)
    elif code == "G5.3":
        _close(control, block)
    else:
        _fanuc_point(control, block)


def drop_curve(control: Control) -> None:
    """Forget the points of a curve that another motion has interrupted."""
    if control.curve is not None:
        control.curve = None
        control.warn("a curve was begun and not finished; it is not driven.", "g")


def _one_block(control: Control, block: Block, code: str) -> None:
    check_plane(control.modal.plane)
    end = _end(control, block)
    if end[2] != control.program_place[2]:
        raise BlockFault(f"{code} stays in its plane; Z cannot change with it.", letter="z")
    i, j = control.length(block, "i"), control.length(block, "j")
    if code == "G5":
        first = first_offset(i, j, control.last_offset)
        second = second_offset(control.length(block, "p"), control.length(block, "q"))
        curve = cubic(control.program_place, end, first, second)
        control.last_offset = second
    else:
        if i is None and j is None:
            raise BlockFault("G5.1 needs its control point, I and J.", letter="g")
        curve = quadratic(control.program_place, end, (i or 0.0, j or 0.0))
    _drive(control, curve)


def _end(control: Control, block: Block) -> tuple[float, float, float]:
    """Return where the axis words lead, program coordinates."""
    control.note_known(block)
    place = control.program_place
    for axis, value in control.axis_words(block):
        place = replaced(place, axis, value if control.modal.absolute else place[axis] + value)
    return place


def _control_point(control: Control, block: Block) -> None:
    check_plane(control.modal.plane)
    if not isinstance(control.curve, OpenNurbs):
        control.curve = OpenNurbs(control.program_place)
    x, y = control.length(block, "x"), control.length(block, "y")
    if not control.modal.absolute:
        start = control.program_place
        x, y = None if x is None else start[0] + x, None if y is None else start[1] + y
    else:
        control.note_known(block)
    order = block.get("l")
    control.curve.add(x, y, block.get("p"), None if order is None else whole(order, "L of G5.2"))


def _close(control: Control, block: Block) -> None:
    if not isinstance(control.curve, OpenNurbs):
        raise BlockFault("G5.3 ends a curve, and none was begun with G5.2.", letter="g")
    curve, control.curve = control.curve.closed(), None
    control.motion = "G80"
    _drive(control, curve)


def _fanuc_point(control: Control, block: Block) -> None:
    if ModalGroup.MOTION in block.codes or not isinstance(control.curve, OpenFanucNurbs):
        drop_curve(control)
        order = block.get("p")
        control.curve = OpenFanucNurbs(control.program_place, None if order is None else whole(order, "P of G6.2"))
    point = control.curve.place if block.has(AXES) else None
    control.note_known(block)
    for axis, value in control.axis_words(block):
        assert point is not None
        point = replaced(point, axis, value if control.modal.absolute else point[axis] + value)
    control.curve.add(point, block.get("k"), block.get("r"))
    if control.curve.complete:
        curve, control.curve = control.curve.closed(), None
        _drive(control, curve)


def _drive(control: Control, curve: Nurbs) -> None:
    """Add a curve, given in program coordinates, as a motion."""
    points = np.array([control.offsets.to_table((x, y, z)) for x, y, z in curve.points.tolist()])
    points[0] = control.at
    curve = replace(curve, points=points)
    length = 0.0
    if control.modal.feed_mode is FeedMode.INVERSE_TIME:
        length = float(np.sum(np.linalg.norm(np.diff(flattened(curve, LENGTH_MM), axis=0), axis=1)))
    row = control.columns.count
    x, y, z = points[-1].tolist()
    control.move(MotionKind.SPLINE, (x, y, z), control.feed_along(length))
    control.splines[row] = curve


RADIUS_SLACK_MM = 0.00127
"""How much the R word of a half circle may be too small to reach the end, as LinuxCNC has it."""

LEAST_RADIUS_MM = 0.00127
"""Arcs of less are refused, as LinuxCNC does."""

RELATIVE_MISMATCH = 1e-3
"""The two radii of an arc may differ by so much of the larger one, whatever the control: LinuxCNC and grbl have it
so.
"""

GRBL_MISMATCH_MM = (0.005, 0.5)
"""mm between the radii of an arc: up to the first grbl takes it, beyond the second never, between them up to 0.1 %."""

LINUXCNC_MISMATCH = {Units.MM: 0.02 * math.sqrt(2.0), Units.INCH: 0.002 * math.sqrt(2.0)}
"""How far the two radii may be apart whatever their size, in units of the program; measured at its interpreter."""

LINUXCNC_MOST = 100.0
"""So many times that they may never be apart, be the arc as large as it may."""

_REFERENCES = (1, 2, 3, 4)
"""P of G30; 1 is Mach3's word for the second one, which other controls call 2."""

CURVES = ("G5.2", "G5.3", "G6.2")
"""They take several blocks for one curve."""

MOST_TURNS = 100_000
"""Of one arc; more are a slip of the keyboard."""


def move(control: Control, block: Block) -> None:
    """Obey the motion of a block: of its own G word, or of the one in force where the block has axis words.

    Raises:
        Fault: the motion cannot be done as it is written.
    """
    once = block.codes.get(ModalGroup.ONCE)
    code = block.codes.get(ModalGroup.MOTION)
    axes = block.has(AXES + ROTARY)
    if once in ("G28", "G30"):
        if code is not None and control.rules.fanuc_flow:
            control.motion = code
        elif code not in (None, "G80") and axes:
            raise BlockFault(f"{once} and {code} in one block both want its axis words; write them in two.", letter="g")
        _go_home(control, block, once)
        return
    if once is not None and once not in WITHOUT_AXES:
        return
    if code is not None:
        if code in CYCLES and control.motion in ("G0", "G1", "G2", "G3"):
            control.before_cycle = control.motion
        control.motion = code
    elif (
        not axes
        and not (control.motion in ("G2", "G3") and block.has("ijk"))
        and not (control.motion == "G6.2" and block.has("k"))
    ):
        return
    _check_once(control, once)
    if axes:
        warn_of_rotary(control, block)
    if control.motion not in CYCLES:
        control.cycle = None
    if control.motion not in CURVES:
        drop_curve(control)
    if control.side and control.motion in CYCLES:
        raise BlockFault("a canned cycle cannot be while cutter compensation is on; write G40 before.", letter="g")
    _MOTIONS[control.motion](control, block)


def _check_once(control: Control, once: str | None) -> None:
    if once == "G53" and control.motion not in ("G0", "G1"):
        raise BlockFault("G53 goes with G0 and G1 only.", letter="g")
    if once == "G53" and not control.modal.absolute:
        raise BlockFault("G53 goes with G90 only: the machine's zero is no increment.", letter="g")


def _go_home(control: Control, block: Block, code: str) -> None:
    """Go by way of the axis words to where the machine's reference point is; only along the axes that are named, if
    any.
    """
    drop_curve(control)
    named = [axis for axis, letter in enumerate(AXES) if letter in block.values]
    by_way = control.target(block)
    control.note_known(block, absolute=True)
    if by_way != control.at or not control.rules.fanuc_flow:
        control.move(MotionKind.RAPID, by_way)
    place = control.set_parameters.home(code, control.homes[_reference(control, block, code)])
    home = control.offsets.to_program(taken(place, control.offsets.tool))
    goal = control.program_place
    for axis in named or range(3):
        goal = replaced(goal, axis, home[axis])
    control.homeward.append(control.row)
    control.move(MotionKind.RAPID, control.offsets.to_table(goal))


def _reference(control: Control, block: Block, code: str) -> str:
    """Return the code whose place is meant; P tells the second, third or fourth, of which nothing but that is known."""
    number = block.values.get("p")
    if number is not None and control.options.dialect in (Dialect.LINUXCNC, Dialect.GRBL):
        raise BlockFault("no code in this block takes this word.", letter="p")
    if number is not None and (code != "G30" or whole(number, "P of G30") not in _REFERENCES):
        raise BlockFault(f"{code} has no reference point P{number:g}; write G30 with P2, P3 or P4.", letter="p")
    return code


def _target(control: Control, block: Block) -> Place:
    """Return where the axis words lead; under G53 they count from the machine's zero."""
    if block.codes.get(ModalGroup.ONCE) != "G53":
        control.note_known(block)
        return control.target(block)
    control.homeward.append(control.row)
    place = control.at
    for axis, value in control.axis_words(block):
        place = replaced(place, axis, value - control.offsets.tool[axis])
    return place


def _goes(control: Control, block: Block) -> bool:
    """Tell whether a G0 or G1 moves at all; without axis words LinuxCNC goes where it stands."""
    return block.has(AXES + ROTARY) or control.options.dialect is Dialect.LINUXCNC


def _rapid(control: Control, block: Block) -> None:
    if _goes(control, block):
        control.move(MotionKind.RAPID, _target(control, block))


def _line(control: Control, block: Block) -> None:
    if _goes(control, block):
        end = _target(control, block)
        control.move(MotionKind.LINE, end, control.feed_along(math.dist(control.at, end)))


def _no_motion(control: Control, block: Block) -> None:
    if control.rules.fanuc_flow:  # what was in force before the cycle is in force again
        control.motion = control.before_cycle if control.before_cycle in ("G0", "G1") else "G0"
        (_rapid if control.motion == "G0" else _line)(control, block)
        return
    if block.has(AXES + ROTARY):
        letter = next(letter for letter in AXES + ROTARY if letter in block.values)
        raise BlockFault("there are axis words, but no G code that uses them is in force.", letter=letter)


def _turns(control: Control, block: Block) -> int:
    """Return P of an arc.

    Raises:
        Fault: it is no whole number, or the control has no such word.
    """
    if control.options.dialect is Dialect.LINUXCNC:
        return whole(block.values.get("p", 1.0), "P of an arc")
    others = (TAKES.get(code, "") for group, code in block.codes.items() if group is not ModalGroup.MOTION)
    if "p" in block.values and not any("p" in letters for letters in others):
        raise BlockFault("P, the turns of an arc, is a word of LinuxCNC; write each turn as an arc.", letter="p")
    return 1


def _arc(control: Control, block: Block) -> None:
    code = control.motion
    if control.stray is not None:
        raise BlockFault("the move just after cutter compensation (G40) must be straight, not an arc.", letter="g")
    u, v, w = control.modal.plane.axes
    if not block.has(AXES + ROTARY + "ijkr"):
        raise BlockFault(f"{code} needs its end or its centre.", letter="g")
    if control.offsets.rotation != 0.0 and control.modal.plane is not Plane.XY:
        raise BlockFault(
            f"{code} in another plane than X Y is not followed while the work offset is turned (R of its table row).",
            letter="g",
        )
    if control.options.dialect is Dialect.GRBL and block.has("ijk"[u] + "ijk"[v]) and not block.has("r"):
        block.values.pop("ijk"[w], None)  # which grbl passes over
    _check_arc_words(block, "ijk"[w], code)
    end = _target(control, block)
    centre = _centre_by_r(control, block, end) if block.has("r") else _centre_by_ijk(control, block)
    turns = _turns(control, block)
    if not 1 <= turns <= MOST_TURNS:
        raise BlockFault(f"the arc has P{turns} turns; use 1 to {MOST_TURNS}.", letter="p")
    _check_radii(control, end, centre)
    start = control.at
    sweep = _sweep((start[u] - centre[u], start[v] - centre[v]), (end[u] - centre[u], end[v] - centre[v]), control.ccw)
    along = (sweep + math.tau * (turns - 1)) * math.hypot(start[u] - centre[u], start[v] - centre[v])
    feed = control.feed_along(math.hypot(along, end[w] - start[w]))
    control.move(MotionKind.ARC_CCW if control.ccw else MotionKind.ARC_CW, end, feed, ArcShape(centre, turns))


def _sweep(first: tuple[float, float], last: tuple[float, float], ccw: bool) -> float:
    """Return the angle of an arc, radians, in (0, 2 pi]."""
    turn = math.atan2(last[1], last[0]) - math.atan2(first[1], first[0])
    turn = (turn if ccw else -turn) % math.tau
    return turn if first != last and turn > 0 else math.tau


def _check_arc_words(block: Block, foreign: str, code: str) -> None:
    """Refuse words that contradict one another."""
    if block.has("r") and block.has("ijk"):
        raise BlockFault(f"{code} has both a radius and a centre; write one of them.", letter="r")
    if not block.has("rijk"):
        raise BlockFault(f"{code} needs a radius R or a centre I, J, K.", letter="g")
    if block.has(foreign):
        raise BlockFault(
            f"{foreign.upper()} is no coordinate of this plane's arcs; choose the plane, or leave it out.",
            letter=foreign,
        )


def _centre_by_r(control: Control, block: Block, end: Place) -> Place:
    u, v, w = control.modal.plane.axes
    start, radius = control.at, control.length(block, "r") or 0.0
    if (start[u], start[v]) == (end[u], end[v]):
        raise BlockFault("an arc with a radius R cannot end where it starts; write its centre.", letter="r")
    turn = 1.0 if control.ccw else -1.0
    a, b = centre_by_radius(start[u], start[v], end[u], end[v], radius, turn, RADIUS_SLACK_MM)
    if math.isnan(a):
        half = math.hypot(end[u] - start[u], end[v] - start[v]) / 2
        raise BlockFault(
            f"the radius {abs(radius):g} mm is too small to reach the end, which is {2 * half:.6g} mm away.", letter="r"
        )
    return _placed(AxisWord(u, a), AxisWord(v, b), AxisWord(w, start[w]))


def _centre_by_ijk(control: Control, block: Block) -> Place:
    u, v, w = control.modal.plane.axes
    words = [control.length(block, "ijk"[axis]) for axis in (u, v)]
    start = control.at
    if control.modal.arc_absolute:
        for axis, word in zip((u, v), words, strict=True):
            if word is None:
                raise BlockFault(f"with absolute centres (G90.1) an arc needs {'IJK'[axis]} too.", letter="g")
        if control.offsets.rotation == 0.0:
            shift = control.modal.shift
            return _placed(
                AxisWord(u, (words[0] or 0.0) + shift[u]),
                AxisWord(v, (words[1] or 0.0) + shift[v]),
                AxisWord(w, start[w]),
            )
        program = _placed(AxisWord(u, words[0] or 0.0), AxisWord(v, words[1] or 0.0), AxisWord(w, 0.0))
        return replaced(control.offsets.to_table(program), w, start[w])
    offset = _placed(AxisWord(u, words[0] or 0.0), AxisWord(v, words[1] or 0.0), AxisWord(w, 0.0))
    if control.offsets.rotation != 0.0:
        offset = _turned_only(control, offset)
    return _placed(AxisWord(u, start[u] + offset[u]), AxisWord(v, start[v] + offset[v]), AxisWord(w, start[w]))


def _turned_only(control: Control, vector: Place) -> Place:
    """Return a vector of the program in the table's directions."""
    c, s = math.cos(control.offsets.rotation), math.sin(control.offsets.rotation)
    return (vector[0] * c - vector[1] * s, vector[0] * s + vector[1] * c, vector[2])


def _placed(*coordinates: AxisWord) -> Place:
    place = [0.0, 0.0, 0.0]
    for axis, value in coordinates:
        place[axis] = value
    return (place[0], place[1], place[2])


def _check_radii(control: Control, end: Place, centre: Place) -> None:
    """Refuse an arc that does not end on its circle, as the control would."""
    u, v, _ = control.modal.plane.axes
    first, last = radii(control.at[u], control.at[v], end[u], end[v], centre[u], centre[v])
    if first < LEAST_RADIUS_MM or last < LEAST_RADIUS_MM:
        raise BlockFault(
            f"the arc has no radius (start {first:.4g} mm, end {last:.4g} mm from its centre).", letter="ijk"
        )
    some, most = _mismatch(control)
    off = abs(first - last)
    if (off > some and off > RELATIVE_MISMATCH * max(first, last)) or off > most:
        raise BlockFault(
            f"the arc does not end on its circle: its radius is {first:.4f} mm at the start and {last:.4f} mm at the "
            "end.",
            "ijk",
        )


def _mismatch(control: Control) -> tuple[float, float]:
    """Return by how much, mm, the two radii of an arc may differ at any size, and by how much at none.

    Fanuc, Haas and Mach3 leave it to a setting of the machine: they are taken to allow what LinuxCNC allows in mm, at
    any size.
    """
    dialect = control.options.dialect
    if dialect is Dialect.GRBL:
        return GRBL_MISMATCH_MM
    if dialect is not Dialect.LINUXCNC:
        return LINUXCNC_MISMATCH[Units.MM], math.inf
    some = LINUXCNC_MISMATCH[control.modal.units] * control.unit
    return some, LINUXCNC_MOST * some


_PROBES_THAT_MUST_TOUCH = ("G38.2", "G38.4")
_PROBED_AT, _PROBE_TOUCHED = 5061, 5070
"""Numbers of the parameters that hold X, and whether it touched."""


def _probe(control: Control, block: Block) -> None:
    """Take the way to a probe's goal as fed all along: where it will stop nobody knows."""
    if not block.has(AXES + ROTARY):
        raise BlockFault(f"{control.motion} needs axis words: where to look for the work.", letter="g")
    nowhere = block.has(AXES) and not block.has(ROTARY) and math.dist(control.at, control.target(block)) == 0.0
    if nowhere and control.motion in _PROBES_THAT_MUST_TOUCH:
        raise BlockFault(f"{control.motion} begins where it ends, so it can probe nothing.", letter="g")
    control.warn(f"{control.motion} stops where the probe touches; it is shown up to its end.", "g")
    control.probe_lines.add(control.line)
    if not nowhere:
        _line(control, block)
    if not control.rules.fanuc_flow:
        _note_probe(control)


def _note_probe(control: Control) -> None:
    """Set the parameters in which LinuxCNC tells where the probe stopped: at the end of its way, untouched."""
    for axis, place in enumerate(control.program_place):
        control.parameters.set(_PROBED_AT + axis, place / control.unit)
    control.parameters.set(_PROBE_TOUCHED, 0.0)


def _thread(control: Control, block: Block) -> None:
    """Feed in step with the spindle; G33.1 comes back the same way."""
    pitch = block.get("k")
    if pitch is None or pitch <= 0:
        raise BlockFault(
            f"{control.motion} needs the way of a revolution, K greater than 0.",
            letter="k" if pitch is not None else "g",
        )
    if control.modal.speed <= 0 or not control.modal.spindle:
        raise BlockFault(f"{control.motion} needs a turning spindle (S and M3 or M4 before).", letter="g")
    start, end, feed = control.at, _target(control, block), pitch * control.unit * control.modal.speed
    control.move(MotionKind.LINE, end, feed)
    if control.motion == "G33.1":
        control.move(MotionKind.LINE, start, feed)


def _cycle(control: Control, block: Block) -> None:
    if control.modal.feed_mode is FeedMode.INVERSE_TIME:
        raise BlockFault("a canned cycle cannot be fed in inverse time (G93).", letter="g")
    if control.motion == "G87" and control.rules.macro_b:
        raise BlockFault(
            "G87, a bore from behind or one that is left by hand, is not followed; write out the moves that it makes: "
            "the reader stops here.",
            letter="g",
        )
    bore(control, block)


_MOTIONS: dict[str, Callable[[Control, Block], None]] = {
    "G0": _rapid,
    "G1": _line,
    "G2": _arc,
    "G3": _arc,
    "G33": _thread,
    "G33.1": _thread,
    "G80": _no_motion,
    **dict.fromkeys(("G38.2", "G38.3", "G38.4", "G38.5"), _probe),
    **dict.fromkeys(CYCLES, _cycle),
    **dict.fromkeys(("G5", "G5.1", *CURVES), move_along_curve),
}


# Canned cycles as the control obeys them: their words out of a block, their steps into motions and events.


def bore(control: Control, block: Block) -> None:
    """Do the holes of a block of a canned cycle.

    Raises:
        Fault: a word is missing or has no sense, or the holes are more than the reader takes.
    """
    place = _program_place(control)
    if control.cycle is None:
        control.initial = place[control.modal.plane.axes[2]]
    cycle = with_sticky(_canned_cycle(control, block), control.cycle)
    control.cycle = replace(cycle, planes=hole_planes(cycle, control.initial)) if cycle.planes_stay else cycle
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


def _canned_cycle(control: Control, block: Block) -> Cycle:
    """Return the cycle as the block words it, in units of the program."""
    u, v, w = control.modal.plane.axes
    words = [_length(control, block, letter) for letter in "xyz"]
    repeats = block.get("l")
    if repeats is None and control.rules.repeats_by_k:
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
        fanuc=control.rules.fanuc_flow,
        lessens=control.options.dialect is Dialect.HAAS,
        planes_stay=control.rules.macro_b,
    )


def _length(control: Control, block: Block, letter: str) -> float | None:
    value = block.get(letter)
    return value * control.least if value is not None and letter in block.whole else value
