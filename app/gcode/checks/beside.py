"""How far a path that a control makes from a contour leaves the moves that were meant: across them, not along.

What is rounded on the contour turns the tool's centre by the tool's radius: ends of motions move along the path, much
farther than the path moves sideways; and a control takes a gentle bend for none. So where two moves go on into one
another, what an end is off counts across them, and along them only by as much as the path bends away there.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...model.motion import Floats, MotionKind, Motions
from ...model.moves import MoveKind
from .lines import MotionOwners, ReferencePath

_GENTLE = 0.06
"""Radians; moves that turn less where they meet go on into one another. LinuxCNC takes 0.05 for no corner."""

_LEAST = 1e-9


def beside(
    motions: Motions, reference: ReferencePath, owned: MotionOwners, far: Floats, controlled: NDArray[np.bool_]
) -> Floats:
    """Return (n,) how far the written path may be from each move at most, mm.

    Args:
        far: (n,) as much, of ends and all along; stays for all moves but those of one motion under control.
        controlled: (n,) whether a control makes a move's path from the contour.
    """
    if not controlled.any():
        return far
    found, arc = far.copy(), reference.kind >= MoveKind.ARC_CW
    bend = np.where(arc, _radius(reference, np.arange(len(far))), 0.0) * reference.sweep**2 / 2
    gentle = arc & (np.abs(reference.sweep) <= _GENTLE)
    # a bend that is taken for none: the next motion goes on from here
    passed = controlled & gentle & (owned.count == 0)
    found[passed] = np.minimum(far, bend)[passed]
    own = np.flatnonzero(controlled & (owned.count == 1) & (far > 0) & (reference.kind != MoveKind.RAPID))
    rows = owned.rows[owned.first[own]]
    chord = gentle[own] & (motions.kind[rows] == MotionKind.LINE)
    alike = (motions.kind[rows] == reference.kind[own]) | chord
    own, rows, chord = own[alike], rows[alike], chord[alike]
    if not len(own):
        return found
    line = _off_line(motions, reference, rows, own)
    across = np.where(arc[own], np.where(chord, _off_arc(motions, reference, rows, own), 0.0), line)
    circle = arc[own] & ~chord
    across[circle] = _off_circle(motions, reference, rows[circle], own[circle])
    begin = _at_joint(reference, own - 1, motions.start[rows] - reference.start[own])
    end = _at_joint(reference, own, motions.end[rows] - reference.end[own])
    found[own] = np.minimum(far[own], across + np.maximum(begin, end))
    return found


def _off_arc(motions: Motions, reference: ReferencePath, rows: NDArray[np.intp], own: NDArray[np.intp]) -> Floats:
    """Return how far straight motions are from the circles of their moves at most, mm; height counts whole."""
    meant, found = _radius(reference, own), np.zeros(len(own))
    for place, level in ((motions.start[rows], reference.start[own]), (motions.end[rows], reference.end[own])):
        off = np.linalg.norm(place[:, :2] - reference.centre[own], axis=1) - meant
        found = np.maximum(found, np.hypot(off, place[:, 2] - level[:, 2]))
    size = np.linalg.norm(motions.end[rows] - motions.start[rows], axis=1)
    return np.asarray(found + size**2 / (8 * np.maximum(meant, _LEAST)))


def _off_line(motions: Motions, reference: ReferencePath, rows: NDArray[np.intp], own: NDArray[np.intp]) -> Floats:
    """Return how far both ends of motions are from the lines of their moves at most, mm."""
    way = reference.end[own] - reference.start[own]
    unit = way / np.maximum(np.linalg.norm(way, axis=1), _LEAST)[:, None]
    found = np.zeros(len(own))
    for place in (motions.start[rows], motions.end[rows]):
        off = place - reference.start[own]
        found = np.maximum(found, np.linalg.norm(off - unit * np.einsum("ni,ni->n", off, unit)[:, None], axis=1))
    return found


def _off_circle(motions: Motions, reference: ReferencePath, rows: NDArray[np.intp], own: NDArray[np.intp]) -> Floats:
    """Return how far the circles of motions are from those of their moves at most, mm; height counts whole."""
    apart = np.linalg.norm(motions.centre[rows, :2] - reference.centre[own], axis=1)
    meant = np.linalg.norm(reference.end[own, :2] - reference.centre[own], axis=1)
    found = np.zeros(len(own))
    for place, level in ((motions.start[rows], reference.start[own]), (motions.end[rows], reference.end[own])):
        radius = np.linalg.norm(place[:, :2] - motions.centre[rows, :2], axis=1)
        found = np.maximum(found, np.hypot(apart + np.abs(radius - meant), place[:, 2] - level[:, 2]))
    return np.nan_to_num(found)


def _at_joint(reference: ReferencePath, before: NDArray[np.intp], off: Floats) -> Floats:
    """Return how far a path may leave two moves where its end is off the joint between them, mm.

    Args:
        before: (m,) the move before the joint. off: (m, 3) mm.
    """
    after = np.minimum(before + 1, len(reference.kind) - 1)
    before = np.maximum(before, 0)
    turn = _arriving(reference, before, 1.0) - _arriving(reference, after, 0.0)
    turn = np.abs(turn - 2 * np.pi * np.rint(turn / (2 * np.pi)))
    size = np.linalg.norm(off, axis=1)
    bent = np.minimum(_radius(reference, before), _radius(reference, after))
    gone = size * np.sin(np.minimum(turn, _GENTLE)) + size**2 / (2 * bent)
    return np.asarray(np.where(turn <= _GENTLE, np.minimum(gone, size), size))


def _arriving(reference: ReferencePath, move: NDArray[np.intp], share: float) -> Floats:
    """Return the directions of moves at their start or end, radians."""
    way = reference.end[move] - reference.start[move]
    place = reference.end[move, :2] if share else reference.start[move, :2]
    out = place - reference.centre[move]
    round_ = np.arctan2(out[:, 1], out[:, 0]) + np.copysign(np.pi / 2, reference.sweep[move])
    return np.where(reference.kind[move] >= MoveKind.ARC_CW, round_, np.arctan2(way[:, 1], way[:, 0]))


def _radius(reference: ReferencePath, move: NDArray[np.intp]) -> Floats:
    """Return the radii of moves, mm; inf of straight ones."""
    radius = np.linalg.norm(reference.end[move, :2] - reference.centre[move], axis=1)
    return np.where(reference.kind[move] >= MoveKind.ARC_CW, np.maximum(radius, _LEAST), np.inf)
