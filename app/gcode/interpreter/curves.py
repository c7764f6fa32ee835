"""Splines as the control obeys them: their words out of blocks, the finished curve as one motion."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...geometry.arcs.nurbs import flattened
from ...model.motion import MotionKind, Nurbs
from .block import Block
from .block_fault import BlockFault
from .codes import AXES, ModalGroup
from .control import Control
from .expression import whole
from .offsets import replaced
from .program import FeedMode
from .splines import OpenFanucNurbs, OpenNurbs, check_plane, cubic, first_offset, quadratic, second_offset

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
