"""Where the control offsets the path, by the wear of the tool or by its radius: G41 or G42 before the straight way to a
wall, G40 before that away from it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.errors import GeometryError, ParameterError
from ...model.job import Job
from ...model.moves import MoveKind, Moves, Purpose
from ...model.operation import Direction
from ..posts import Post

_ALONG = (Purpose.CONTOUR, Purpose.TAB)

_LEVEL = 1e-9
"""mm; heights and places that differ by less are one."""


def compensated_stretches(moves: Moves, job: Job) -> tuple[CompensatedStretch, ...]:
    """Return where the control offsets a program's path.

    A path along a wall that has no straight lead at both its ends, or one that is no longer than what may stand in the
    register, is left as it is.
    """
    by_index = [each.wear for each in job.operations]
    if not any(by_index) or not len(moves):
        return ()
    wear = np.array(by_index)[np.maximum(moves.operation, 0)]
    radius = np.array([each.offset_by_control for each in job.operations])[np.maximum(moves.operation, 0)]
    scan, found, i = _Scan(moves, radius), [], 0
    for first in np.flatnonzero((wear > 0) & (moves.purpose == Purpose.LEAD)).tolist():
        if first < i:
            continue
        held = wear[first] + (job.tool(int(moves.tool[first])).radius if radius[first] else 0.0)
        stop = scan.stretch(first) if scan.length(first) > held else 0
        if stop:
            found.append(CompensatedStretch(first, stop))
            i = stop + 1
    return tuple(found)


def compensation_blocks(moves: Moves, job: Job, post: Post, stretches: Sequence[CompensatedStretch]) -> dict[int, str]:
    """Return the blocks that begin and end compensation, by the index of the move that follows.

    The spindle turns clockwise, so climb milling has the tool at the left.

    Raises:
        ParameterError: an operation asks for it, and the control has none, or one register would hold two things.
    """
    if not any(each.wear and np.any(moves.operation == k) for k, each in enumerate(job.operations)):
        return {}
    words = post.compensation
    if not (words.left and words.right and words.off):
        raise ParameterError(
            f"{post.title} cannot offset a path by the wear or the radius of a tool (G41, G42); set "
            'compensation = "computer", or '
            "choose another post."
        )
    _check_registers(job)
    found: dict[int, str] = {}
    for each in stretches:
        operation = job.operations[int(moves.operation[each.first])]
        side = words.left if operation.cut.direction is Direction.CLIMB else words.right
        found[each.first] = side.format(tool=int(moves.tool[each.first]))
        found[each.stop] = words.off
    return found


def _check_registers(job: Job) -> None:
    """Refuse a register that would have to hold the wear and the radius of a tool."""
    own = [each for each in job.operations if each.wear and each.cut.enabled]
    both = {each.cut.tool for each in own if each.offset_by_control} & {
        each.cut.tool for each in own if not each.offset_by_control
    }
    if both:
        raise ParameterError(
            f'T{min(both)} has contours with compensation = "wear" and with "control": one register D{min(both)} '
            "cannot hold its wear and its radius; choose one of them for all of its contours."
        )


class _Scan:
    """Looks for ways to a wall, along it and away from it."""

    def __init__(self, moves: Moves, radius: np.ndarray) -> None:
        """Look at moves; `radius`: (n,) whether the control offsets each by the tool's whole radius."""
        self._kind, self._purpose, self._radius = moves.kind.tolist(), moves.purpose.tolist(), radius.tolist()
        self._operation, self._end = moves.operation.tolist(), moves.end

    def length(self, i: int) -> float:
        """Return how long a way is in the plane, mm: its side along which the control comes to the wall."""
        return float(np.hypot(*(self._end[i, :2] - self._end[i - 1, :2]))) if i else 0.0

    def _is_lead(self, i: int) -> bool:
        return (
            0 < i < len(self._kind)
            and self._purpose[i] == Purpose.LEAD
            and bool(abs(self._end[i, 2] - self._end[i - 1, 2]) <= _LEVEL)
        )

    def _is_straight_lead(self, i: int) -> bool:
        return self._is_lead(i) and self._kind[i] == MoveKind.LINE

    def _is_upright(self, i: int) -> bool:
        return self._kind[i] == MoveKind.LINE and bool(
            np.all(np.abs(self._end[i, :2] - self._end[i - 1, :2]) <= _LEVEL)
        )

    def stretch(self, first: int) -> int:
        """Return the index of the way away from the wall that the way to it, move `first`, belongs to; 0 = it is none,
        or there is none.
        """
        if not self._is_straight_lead(first):
            return 0
        i, along, own = first + 1, False, self._operation[first]
        if self._radius[first]:
            if not self._is_lead(i) or self._kind[i] == MoveKind.LINE:
                return 0
            i += 1
        else:
            while i < len(self._kind) and self._is_straight_lead(i):  # where the feed changes on the way
                i += 1
        while i < len(self._kind) and self._operation[i] == own:
            if self._purpose[i] in _ALONG:
                along = True
            elif not (along and self._is_upright(i)):
                break
            i += 1
        if along and self._radius[first] and self._is_lead(i):
            i += 1
        return i if along and self._is_straight_lead(i) and self._operation[i] == own else 0


# What is written of a contour that the control offsets by the tool's whole radius: the contour itself.
#
# The moves hold the path of the tool's centre. Each line and arc of it is moved back to the wall by the radius. An arc
# round a sharp outer corner becomes the corner, where the control turns round by itself; at an inner corner, where the
# centre's path has cut off what it does not reach, both sides are lengthened until they meet in the corner again. The
# tool comes to the contour by a straight way that is tangent to the programmed arc before the wall, and leaves it so.


_POINT = 1e-5
"""mm; an arc of a smaller radius on the contour is a corner of it."""

_TOGETHER = 1e-6
"""mm; ends that are this near meet, as the centre's path goes on smoothly there."""

_AMPLIFIED = 5.0
"""Times the writing tolerance by which a corner of the path may be off that a control makes from two rounded sides."""

_NO_CORNER = 0.05
"""Radians; a control that turns less goes on without an arc (LinuxCNC)."""

_GENTLE = 0.06
"""Radians; of a bend that a control may take for none, or by which rounding turns a small arc."""


@dataclass(frozen=True)
class CompensatedStretch:
    """Moves under compensation.

    Attributes:
        first: index of the straight move to the wall. stop: index of that away from it, the first without.
    """

    first: int
    stop: int


@dataclass(frozen=True, eq=False)
class ProgrammedMoves:
    """Moves as they are written.

    Attributes:
        moves: whose places are those of the contour where the control offsets it.
        corners: (n,) whether a move is an arc of the tool round a corner, which no block is written for: the control
            makes it at the block that follows.
    """

    moves: Moves
    corners: NDArray[np.bool_]


def programmed_moves(moves: Moves, job: Job, stretches: Sequence[CompensatedStretch]) -> ProgrammedMoves:
    """Return the moves with the contour in place of the tool's centre, where the control offsets it.

    Args:
        moves: of the tool's centre, mm.
        job: whose operations and tools they are of.
        stretches: under compensation.

    Raises:
        GeometryError: the control cannot make the path from the contour: a place where the tool does not fit between
            the walls, or a tab on a corner.
    """
    corners = np.zeros(len(moves), bool)
    own = [each for each in stretches if job.operations[int(moves.operation[each.first])].offset_by_control]
    if not own:
        return ProgrammedMoves(moves, corners)
    turns = moves.sweeps()
    end, centre, kind = moves.end.copy(), moves.centre.copy(), moves.kind.copy()
    for stretch in own:
        operation = job.operations[int(moves.operation[stretch.first])]
        side = -1.0 if operation.cut.direction is Direction.CLIMB else 1.0
        sides = _sides(moves, stretch, side * job.tool(int(moves.tool[stretch.first])).radius)
        end[stretch.first, :2] = _xy(sides[0].start)
        for here, following in pairwise(sides):
            if here.corner and following.move > here.move + 1:
                raise _unfollowed(here.start, "a tab ends on a sharp corner, where the control turns round by itself")
            place = _meeting(here, following)
            following.start = place
            if following.corner:
                following.end = place
            end[here.move : following.move, :2] = _xy(place)
        end[sides[-1].move : stretch.stop, :2] = _xy(sides[-1].end)
        for each in sides:
            if each.corner:
                kind[each.move], centre[each.move] = MoveKind.LINE, np.nan
                corners[each.move] = abs(turns[each.move]) > _NO_CORNER
    return ProgrammedMoves(replace(moves, end=end, centre=centre, kind=kind), corners)


class AllowedDistances(NamedTuple):
    """How far a written path may be from each of n moves, mm: (n,) of the path, and of the ends of its motions."""

    path: NDArray[np.float64]
    ends: NDArray[np.float64]


def allowed_distances(moves: Moves, job: Job, tolerance: float) -> AllowedDistances:
    """Return how far the written path may be from each move.

    That is the writing tolerance. Where a control makes the path from the contour it is several times as much, as
    corners of the path are farther off than the sides are that meet in them, and by what the path is off where the
    control takes a gentle bend for none. Ends may be farther off along the path: there, and where a small outer arc of
    the contour that is turned by its rounding turns the tool's centre by the tool's radius.

    Args:
        moves: of the tool's centre, mm.
        tolerance: mm, for a path that is written itself.
    """
    own = np.array([each.offset_by_control for each in job.operations], bool)
    path, ends = np.full(len(moves), tolerance), np.full(len(moves), tolerance)
    if own.any():
        operation = np.maximum(moves.operation, 0)
        radius = np.array([job.tool(each.cut.tool).radius for each in job.operations])[operation]
        path[own[operation]] = (tolerance * _AMPLIFIED + radius * _GENTLE**2 / 2)[own[operation]]
        ends[own[operation]] = (tolerance * _AMPLIFIED + radius * _GENTLE)[own[operation]]
    return AllowedDistances(path, ends)


@dataclass(slots=True)
class _ContourSide:
    """A move, moved back to the contour, in the plane as complex numbers.

    Attributes:
        move: its index. start, end: on the contour. centre, radius: of an arc; None, 0 of a line.
        corner: it is a point.
    """

    move: int
    start: complex
    end: complex
    centre: complex | None = None
    radius: float = 0.0
    corner: bool = False


def _sides(moves: Moves, stretch: CompensatedStretch, aside: float) -> list[_ContourSide]:
    """Return the moves of a stretch between its straight ways, but those along Z alone.

    Args:
        aside: how far the contour lies to the left of the path, mm; negative = to the right.
    """
    made = []
    for k in range(stretch.first + 1, stretch.stop):
        start, end = complex(*moves.end[k - 1, :2]), complex(*moves.end[k, :2])
        if moves.kind[k] < MoveKind.ARC_CW:
            if start != end:
                shift = 1j * aside * (end - start) / abs(end - start)
                made.append(_ContourSide(k, start + shift, end + shift))
            continue
        centre, radius = complex(*moves.centre[k]), abs(end - complex(*moves.centre[k]))
        on_contour = radius - aside if moves.kind[k] == MoveKind.ARC_CCW else radius + aside
        if on_contour < -_POINT:
            raise _unfollowed(end, "an arc there is smaller than the tool's radius")
        if on_contour <= _POINT:
            made.append(_ContourSide(k, centre, centre, corner=True))
            continue
        made.append(
            _ContourSide(
                k,
                centre + (start - centre) * (on_contour / abs(start - centre)),
                centre + (end - centre) * (on_contour / radius),
                centre,
                on_contour,
            )
        )
    return made


def _meeting(one: _ContourSide, other: _ContourSide) -> complex:
    """Return where a side of the contour meets the next one.

    Raises:
        GeometryError: nowhere near where the path turns.
    """
    if abs(one.end - other.start) <= _TOGETHER:
        return one.end if one.corner else other.start if other.corner else (one.end + other.start) / 2
    found = [] if one.corner or other.corner else _crossings(one, other)
    if not found:
        raise _unfollowed(one.end, "the tool does not fit between the walls")
    middle = (one.end + other.start) / 2
    return min(found, key=lambda place: abs(place - middle))


def _crossings(one: _ContourSide, other: _ContourSide) -> list[complex]:
    """Return where the lines or circles of two sides cross."""
    if one.centre is None and other.centre is None:
        ahead, across = one.end - one.start, other.end - other.start
        area = (ahead.conjugate() * across).imag
        return [one.start + ahead * (((other.start - one.start).conjugate() * across).imag / area)] if area else []
    if one.centre is not None and other.centre is not None:
        apart = other.centre - one.centre
        if not apart:
            return []
        unit = apart / abs(apart)
        along = (abs(apart) ** 2 + one.radius**2 - other.radius**2) / (2 * abs(apart))
        return _on_both_sides(one.centre + along * unit, 1j * unit, one.radius**2 - along**2)
    line, arc = (one, other) if one.centre is None else (other, one)
    assert arc.centre is not None
    unit = (line.end - line.start) / abs(line.end - line.start)
    foot = line.start + unit * ((arc.centre - line.start) * unit.conjugate()).real
    return _on_both_sides(foot, unit, arc.radius**2 - abs(foot - arc.centre) ** 2)


def _on_both_sides(middle: complex, unit: complex, square: float) -> list[complex]:
    """Return the points at a distance, of which the square is given, before and behind a place."""
    half = np.sqrt(square) if square >= 0 else None
    return [] if half is None else [middle - unit * half, middle + unit * half]


def _xy(place: complex) -> tuple[float, float]:
    return place.real, place.imag


def _unfollowed(place: complex, why: str) -> GeometryError:
    return GeometryError(
        f"A control cannot make the tool's path from the contour at ({place.real:.3f}, {place.imag:.3f}) (drawing): "
        f'{why}; take a smaller tool, or compensation = "wear" or "computer".'
    )
