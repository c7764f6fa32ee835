"""Canned cycles G73, G74, G81 to G89: what one block of a hole cycle makes the control do, step by step.

Behaviour: LinuxCNC's G code reference, chapter on canned cycles, and what its interpreter (2.9.0~pre1) prints for
programs of every kind, redundant motions among them.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

from ...model.motion import MotionKind, Plane
from .program import BlockFault

Point = tuple[float, float, float]

CYCLE_WORDS: dict[str, str] = {
    "G73": "RLQ",
    "G74": "RP",
    "G81": "RL",
    "G82": "RLP",
    "G83": "RLQ",
    "G84": "RLP",
    "G85": "RL",
    "G86": "RLP",
    "G87": "RLIJK",
    "G88": "RLP",
    "G89": "RLP",
}
"""The cycles, and the words beside X, Y, Z that LinuxCNC takes with each."""

CHIP_CLEARANCE_MM = 0.254
"""How far G73 lifts, and how far above the chips G83 returns, mm; on Fanuc and Haas a parameter of the machine."""

SAME_HEIGHT = 1e-9
"""mm; what rounding may part of two heights that are one: no move is made between them."""
MOST_PECKS = 100_000
"""Pecks of one hole; more are a slip of the pen, or meant to hang the reader."""

NO_ANGLE = "at the zero the angle (^) must be said."

_NO_SHIFT = (None, None, None)

PECKS = frozenset({"G73", "G83"})
"""The cycles that go down a peck at a time."""

_NEEDS_DWELL = {"G82", "G86", "G88", "G89"}
_TAPS = {"G84": 1, "G74": -1}
_TURNING = {"G86", "G87", "G88"}
_WAYS = {1: "clockwise (M3)", -1: "counter-clockwise (M4)"}


class PolarStep(NamedTuple):
    """From hole to hole, seen from the program's zero.

    Attributes:
        outwards: in units of the program.
        turn: radians; None: not said, so the zero itself has no next hole.
    """

    outwards: float
    turn: float | None


@dataclass(frozen=True, slots=True)
class Cycle:
    """One block of a canned cycle, as it is written; lengths in one unit throughout, program coordinates.

    Attributes:
        code: a key of `CYCLE_WORDS`.
        plane: of the holes; the cycle drills along its normal.
        hole: words of the plane's first and second axis. depth: word of the normal. r: R word. None = not in the block.
        polar: in the place of `hole`, words @ and ^ under G91.
        repeats: L.
        dwell: P, s. peck: Q. shift: I, J, K of G87, and of pecks that lessen.
        absolute: G90 rather than G91. retract_to_r: G99 rather than G98.
        spindle: -1, 0, 1 as it turns before the block.
        unit_mm: mm per unit of the lengths: 1 where they are mm, 25.4 where they are inches. LinuxCNC keeps the numbers
            that stay, and the initial height, as they were written, also over G20 and G21.
        fanuc: words stay from one code to the next; a dwell need not be said; 0 repeats bore nothing, as on Fanuc and
            Haas.
        lessens: I, J and K of G73 and G83 are the first peck, by how much each one is less, and the least, and P is a
            dwell at the bottom, as on Haas.
        planes_stay: R and depth stay as the heights that they meant, also where G91 follows G90, as on Fanuc and Haas;
            else as the numbers that were written. planes: those heights, of the blocks before; None = not said yet.
    """

    code: str
    plane: Plane
    hole: tuple[float | None, float | None] = (None, None)
    depth: float | None = None
    r: float | None = None
    repeats: int = 1
    dwell: float | None = None
    peck: float | None = None
    shift: tuple[float | None, float | None, float | None] = (None, None, None)
    absolute: bool = True
    retract_to_r: bool = False
    spindle: int = 0
    unit_mm: float = 1.0
    fanuc: bool = False
    lessens: bool = False
    planes_stay: bool = False
    planes: tuple[float, float] | None = None
    polar: PolarStep | None = None


class CycleMove(NamedTuple):
    """A straight motion.

    Attributes:
        kind: RAPID or LINE.
        target: where the control sends the axes.
        meant: where it takes itself to be afterwards; differs from `target` where `taps_astray`, and at the end of G88,
            out of which the operator takes the tool by hand.
    """

    kind: MotionKind
    target: Point
    meant: Point


class Dwell(NamedTuple):
    """A wait, s."""

    seconds: float


class Spindle(NamedTuple):
    """The spindle stops (0), or turns clockwise (1) or counter-clockwise (-1)."""

    turning: int


class Stop(NamedTuple):
    """The program waits for the operator."""


Step = CycleMove | Dwell | Spindle | Stop


def with_sticky(cycle: Cycle, before: Cycle | None) -> Cycle:
    """Return the cycle with the words that stay from the block before: depth, R, P, Q, I, J, K.

    LinuxCNC keeps them while the same G word is in force, and takes an unsaid P of G74 and G84 from any cycle before.
    Axes of the plane and L never stay.

    Args:
        before: the cycle before, itself filled; None where another motion or G80 came in between.
    """
    if before is None:
        return cycle
    kept = _dwell_kept(cycle, before)
    if before.code != cycle.code and not cycle.fanuc:
        return replace(cycle, dwell=kept)
    if cycle.planes_stay:
        cycle, before = replace(cycle, planes=before.planes), replace(before, depth=None, r=None)
    if cycle.lessens and (cycle.peck is not None or cycle.shift != _NO_SHIFT):  # the other way to say it ends
        before = replace(before, peck=None, shift=_NO_SHIFT)
    shift = tuple(_said(mine, theirs) for mine, theirs in zip(cycle.shift, before.shift, strict=True))
    return replace(
        cycle,
        depth=_said(cycle.depth, before.depth),
        r=_said(cycle.r, before.r),
        dwell=kept,
        peck=_said(cycle.peck, before.peck),
        shift=(shift[0], shift[1], shift[2]),
    )


def _dwell_kept(cycle: Cycle, before: Cycle) -> float | None:
    """Return P; a cycle that has none of its own carries that of the one before to a tapping cycle after it."""
    stays = cycle.fanuc or before.code == cycle.code or cycle.code not in _NEEDS_DWELL
    return _said(cycle.dwell, before.dwell) if stays else cycle.dwell


def _said(mine: float | None, theirs: float | None) -> float | None:
    return theirs if mine is None else mine


def taps_astray(cycle: Cycle) -> bool:
    """Tell whether LinuxCNC takes the axes of another plane for the feeds of this cycle.

    Its interpreter (2.9.0~pre1) does that for G74 and G84: in G18 it feeds with the axes of G19, and the other way
    round.
    """
    return cycle.code in _TAPS and cycle.plane is not Plane.XY and not cycle.fanuc


def cycle_steps(cycle: Cycle, position: Point, initial: float) -> Iterator[Step]:
    """Return the steps of a cycle, one by one.

    Args:
        cycle: with its sticky words filled in.
        position: where the control is.
        initial: coordinate along the plane's normal when the run of cycles began: R of G91 counts from it, and G98
            returns to it. LinuxCNC keeps it until another motion or G80, also over a change of the plane.

    Raises:
        Fault: a word is missing or has no sense, or the spindle does not turn as the cycle needs it.
    """
    _check_words(cycle)
    _check_spindle(cycle)
    r, depth = hole_planes(cycle, initial)
    if r < depth:
        raise BlockFault(
            f"R at {r:g} lies below the bottom of the hole at {_normal(cycle)} {depth:g}; a cycle bores from R "
            "downwards.",
            "R",
        )
    if cycle.code in PECKS and r - depth > MOST_PECKS * _peck_sizes(cycle).least:
        raise BlockFault(f"more than {MOST_PECKS:,} pecks for one hole; Q is too small.", "Q")
    return _steps(cycle, position, initial, (r, depth))


def hole_planes(cycle: Cycle, initial: float) -> tuple[float, float]:
    """Return the heights of R and of the bottom.

    Args:
        cycle: with its sticky words filled in.
        initial: as of `cycle_steps`.

    Raises:
        Fault: one of them was never said.
    """
    level, bottom = cycle.planes or (None, None)
    r, depth = cycle.r, cycle.depth
    level = _known(level if r is None else r if cycle.absolute else initial + r, "R")
    bottom = bottom if depth is None else depth if cycle.absolute else level + depth
    return level, _known(bottom, _normal(cycle))


def _normal(cycle: Cycle) -> str:
    return "XYZ"[cycle.plane.axes[2]]


def _known(value: float | None, letter: str) -> float:
    """Return the value of a word that the cycle cannot do without."""
    if value is None:
        raise BlockFault(f"the cycle has no {letter} word, and none stays from the block before.", letter)
    return value


def _check_words(cycle: Cycle) -> None:
    """Refuse a cycle whose words are missing or out of range."""
    if cycle.repeats < 0 or (cycle.repeats == 0 and not cycle.fanuc):
        raise BlockFault(f"a cycle cannot be repeated {cycle.repeats} times; L counts from 1.", "L")
    if cycle.code in _NEEDS_DWELL and not cycle.fanuc:
        _known(cycle.dwell, "P")
    if cycle.dwell is not None and cycle.dwell < 0:
        raise BlockFault("a dwell cannot be negative.", "P")
    if cycle.code in PECKS:
        sizes = _peck_sizes(cycle)
        if min(sizes.first, sizes.least) <= 0 or sizes.less < 0:
            raise BlockFault("the depth of a peck must be above 0.", "Q")
    if cycle.code == "G87":
        for letter, value in zip("IJK", cycle.shift, strict=True):
            _known(value, letter)


class _PeckSizes(NamedTuple):
    """How deep pecks are: the first one, by how much each one is less, and the least one."""

    first: float
    less: float
    least: float


def _peck_sizes(cycle: Cycle) -> _PeckSizes:
    """Return how deep the pecks of a cycle are.

    Raises:
        Fault: it has no Q, or I, J and K that lessen them are not all there, or stand beside Q.
    """
    if not cycle.lessens or cycle.shift == _NO_SHIFT:
        peck = _known(cycle.peck, "Q")
        return _PeckSizes(peck, 0.0, peck)
    if cycle.peck is not None or None in cycle.shift:
        raise BlockFault(
            f"{cycle.code} with some of Q, I, J and K is not followed; write Q alone, or I, J and K without Q.", "Q"
        )
    first, less, least = (_known(value, letter) for value, letter in zip(cycle.shift, "IJK", strict=True))
    return _PeckSizes(first, less, least)


def _check_spindle(cycle: Cycle) -> None:
    """Refuse a cycle that needs another spindle; Fanuc's tapping cycles start it themselves."""
    needed = _TAPS.get(cycle.code, 0)
    if needed and cycle.spindle != needed and not cycle.fanuc:
        raise BlockFault(f"{cycle.code} needs the spindle turning {_WAYS[needed]}, and it {_turns(cycle)}.")
    if cycle.code in _TURNING and not cycle.spindle:
        raise BlockFault(f"{cycle.code} needs a turning spindle (M3 or M4), and it stands.")


def _turns(cycle: Cycle) -> str:
    return f"turns {_WAYS[cycle.spindle]}" if cycle.spindle else "stands"


class _Hole:
    """One hole: heights along the normal and the place in the plane."""

    def __init__(self, cycle: Cycle, heights: tuple[float, float, float], first: float, second: float) -> None:
        self.cycle, self.first, self.second = cycle, first, second
        self.r, self.bottom, self.clear = heights

    def move(self, kind: MotionKind, height: float, shift: tuple[float, float] = (0.0, 0.0)) -> CycleMove:
        """Return the motion to a height over the hole, or beside it by `shift` in the plane."""
        meant = _point(self.cycle.plane, self.first + shift[0], self.second + shift[1], height)
        return CycleMove(kind, meant, meant)

    def rapid(self, height: float) -> CycleMove:
        return self.move(MotionKind.RAPID, height)

    def feed(self, height: float) -> CycleMove:
        return self.move(MotionKind.LINE, height)

    def tap(self, height: float) -> CycleMove:
        """Return a feed of a tapping cycle."""
        if not taps_astray(self.cycle):
            return self.feed(height)
        other = Plane.YZ if self.cycle.plane is Plane.ZX else Plane.ZX
        return self.feed(height)._replace(target=_point(other, self.first, self.second, height))


def _point(plane: Plane, first: float, second: float, normal: float) -> Point:
    point = [0.0, 0.0, 0.0]
    for axis, value in zip(plane.axes, (first, second, normal), strict=True):
        point[axis] = value
    return point[0], point[1], point[2]


def _steps(cycle: Cycle, position: Point, initial: float, heights: tuple[float, float]) -> Iterator[Step]:
    """Yield the way to each hole and what is done there.

    An initial height below R counts as R: the tool goes there first, even when it already is there; on Fanuc and Haas
    it rises over the hole only. A tool that is not above R rises on its way to the hole, at a slant, to the height that
    it will retract to; on Fanuc, Haas and Mach3 it goes level.
    """
    r, bottom = heights
    first, second, height = (position[axis] for axis in cycle.plane.axes)
    if initial < r and cycle.repeats:
        initial = r
        if not cycle.planes_stay:
            height = r
            yield _Hole(cycle, (r, bottom, r), first, second).rapid(r)
    clear = r if cycle.retract_to_r else initial
    for _ in range(cycle.repeats):
        first, second = _next_place(cycle, first, second)
        hole = _Hole(cycle, (r, bottom, clear), first, second)
        height = clear if height <= r + SAME_HEIGHT and not cycle.fanuc else height
        yield hole.rapid(height)
        if abs(height - r) > SAME_HEIGHT:
            yield hole.rapid(r)
        yield from _BORING[cycle.code](hole)
        height = clear


def _next_place(cycle: Cycle, first: float, second: float) -> tuple[float, float]:
    """Return where the hole behind one is."""
    if cycle.polar is not None:
        radius, angle = math.hypot(first, second), math.atan2(second, first)
        if cycle.polar.turn is None and radius < SAME_HEIGHT:
            raise BlockFault(NO_ANGLE, "@")
        radius, angle = radius + cycle.polar.outwards, angle + (cycle.polar.turn or 0.0)
        return radius * math.cos(angle), radius * math.sin(angle)
    return _moved(cycle.hole[0], first, cycle.absolute), _moved(cycle.hole[1], second, cycle.absolute)


def _moved(word: float | None, at: float, absolute: bool) -> float:
    if word is None:
        return at
    return word if absolute else at + word


def _drill(hole: _Hole) -> Iterator[Step]:
    """G81, G82."""
    yield hole.feed(hole.bottom)
    if hole.cycle.code == "G82":
        yield Dwell(hole.cycle.dwell or 0.0)
    yield hole.rapid(hole.clear)


def _pecks(hole: _Hole) -> Iterator[float]:
    """Yield the depths short of the bottom that are fed to; added up as the control adds them up."""
    step, less, least = _peck_sizes(hole.cycle)
    depth = hole.r - step
    while depth > hole.bottom:
        yield depth
        step = max(step - less, least)
        depth -= step


def _above_chips(hole: _Hole, depth: float) -> float:
    """Return the height a little above a peck's end; LinuxCNC goes there even where that is above R."""
    height = depth + CHIP_CLEARANCE_MM / hole.cycle.unit_mm
    return min(height, hole.r) if hole.cycle.fanuc else height


def _deep_drill(hole: _Hole) -> Iterator[Step]:
    """G83: out to R after each peck, and back to a little above where it ended."""
    for depth in _pecks(hole):
        yield hole.feed(depth)
        yield hole.rapid(hole.r)
        yield hole.rapid(_above_chips(hole, depth))
    yield from _last_peck(hole)


def _break_chips(hole: _Hole) -> Iterator[Step]:
    """G73: up a little after each peck."""
    for depth in _pecks(hole):
        yield hole.feed(depth)
        yield hole.rapid(_above_chips(hole, depth))
    yield from _last_peck(hole)


def _last_peck(hole: _Hole) -> Iterator[Step]:
    """To the bottom and out of the hole; on Haas with the dwell of P between."""
    yield hole.feed(hole.bottom)
    if hole.cycle.lessens and hole.cycle.dwell:
        yield Dwell(hole.cycle.dwell)
    yield hole.rapid(hole.clear)


def _tap(hole: _Hole) -> Iterator[Step]:
    """G84, G74: in, and the other way round out at feed, on LinuxCNC to the clearance, on Fanuc and Haas to R."""
    turning, fanuc = _TAPS[hole.cycle.code], hole.cycle.fanuc
    if fanuc and hole.cycle.spindle != turning:
        yield Spindle(turning)
    yield hole.tap(hole.bottom)
    yield Spindle(0)
    yield Spindle(-turning)
    yield Dwell(hole.cycle.dwell or 0.0)
    yield hole.tap(hole.r if fanuc else hole.clear)
    yield Spindle(0)
    yield Spindle(turning)
    if fanuc:
        yield hole.rapid(hole.clear)


def _bore_out_at_feed(hole: _Hole) -> Iterator[Step]:
    """G85: at feed to R."""
    yield hole.feed(hole.bottom)
    yield hole.feed(hole.r)
    yield hole.rapid(hole.clear)


def _bore_stop_out(hole: _Hole) -> Iterator[Step]:
    """G86: out with a standing spindle."""
    yield hole.feed(hole.bottom)
    yield Dwell(hole.cycle.dwell or 0.0)
    yield Spindle(0)
    yield hole.rapid(hole.clear)
    yield Spindle(hole.cycle.spindle)


def _back_bore(hole: _Hole) -> Iterator[Step]:
    """G87: beside the axis down with a standing spindle, up at feed to the middle, and out the same way."""
    shift = [hole.cycle.shift[axis] or 0.0 for axis in hole.cycle.plane.axes]
    beside, turning = (shift[0], shift[1]), hole.cycle.spindle
    yield hole.move(MotionKind.RAPID, hole.r, beside)
    yield Spindle(0)
    yield hole.move(MotionKind.RAPID, hole.bottom, beside)
    yield hole.rapid(hole.bottom)
    yield Spindle(turning)
    yield hole.feed(shift[2] if hole.cycle.absolute else hole.bottom + shift[2])
    yield hole.feed(hole.bottom)
    yield Spindle(0)
    yield hole.move(MotionKind.RAPID, hole.bottom, beside)
    yield hole.move(MotionKind.RAPID, hole.clear, beside)
    yield hole.rapid(hole.clear)
    yield Spindle(turning)


def _bore_by_hand_out(hole: _Hole) -> Iterator[Step]:
    """G88: the operator takes the tool out; the control takes it to be there."""
    yield hole.feed(hole.bottom)._replace(meant=hole.rapid(hole.clear).meant)
    yield Dwell(hole.cycle.dwell or 0.0)
    yield Spindle(0)
    yield Stop()
    yield Spindle(hole.cycle.spindle)


def _bore_dwell_out(hole: _Hole) -> Iterator[Step]:
    """G89: at feed on LinuxCNC all the way to the clearance, on Fanuc and Haas to R."""
    yield hole.feed(hole.bottom)
    yield Dwell(hole.cycle.dwell or 0.0)
    yield hole.feed(hole.r if hole.cycle.fanuc else hole.clear)
    if hole.cycle.fanuc:
        yield hole.rapid(hole.clear)


_BORING: dict[str, Callable[[_Hole], Iterator[Step]]] = {
    "G73": _break_chips,
    "G74": _tap,
    "G81": _drill,
    "G82": _drill,
    "G83": _deep_drill,
    "G84": _tap,
    "G85": _bore_out_at_feed,
    "G86": _bore_stop_out,
    "G87": _back_bore,
    "G88": _bore_by_hand_out,
    "G89": _bore_dwell_out,
}
