"""Polar coordinates in LinuxCNC's words: @ is the distance from the program's zero, ^ the angle, degrees, from X
towards Y.
"""

from __future__ import annotations

import math

from ...model.motion import Plane
from .block import POLAR, Block
from .codes import ModalGroup
from .control import Control
from .cycles import CYCLE_WORDS, NO_ANGLE, PolarStep
from .program import BlockFault

RADIUS, ANGLE = "@", "^"
AT_ORIGIN_MM = 1e-9
"""mm; nearer to zero a place has no angle."""


def check_polar(control: Control, block: Block) -> None:
    """Refuse polar words where no motion takes them.

    Raises:
        Fault: they stand beside X or Y, or without a motion.
    """
    if not block.has(POLAR):
        return
    letter = RADIUS if block.has(RADIUS) else ANGLE
    if block.has("xy"):
        raise BlockFault("polar coordinates and X or Y in one block contradict one another.", letter=letter)
    once = block.codes.get(ModalGroup.ONCE)
    if once not in (None, "G4") or block.codes.get(ModalGroup.MOTION, control.motion) == "G80":
        raise BlockFault("polar coordinates go with a motion only.", letter=letter)


def turn_polar_into_axes(control: Control, block: Block) -> None:
    """Put X and Y in the place of the polar words of a block, after its units, offsets and distance mode are in force.

    Under G91 both count from where the tool is; a word that is missing stays as it is there. A canned cycle that is
    repeated turns and goes outwards again with each hole, so there it keeps the words.

    Raises:
        Fault: the angle is not known, or the plane is another than that of X and Y.
    """
    if not block.has(POLAR):
        return
    if control.modal.plane is not Plane.XY:
        raise BlockFault("polar coordinates go with G17 only.", letter=RADIUS if block.has(RADIUS) else ANGLE)
    x, y = _place(control, block)
    here = control.program_place
    unit = control.unit
    block.values["x"] = (x if control.modal.absolute else x - here[0]) / unit
    block.values["y"] = (y if control.modal.absolute else y - here[1]) / unit
    if control.modal.absolute or block.codes.get(ModalGroup.MOTION, control.motion) not in CYCLE_WORDS:
        for letter in POLAR:
            block.values.pop(letter, None)
    block.whole -= {RADIUS, ANGLE, "x", "y"}


def polar_step(block: Block) -> PolarStep | None:
    """Return the way from hole to hole of a cycle under G91; None where it is not told in polar words."""
    turned = block.get(ANGLE)
    return PolarStep(block.get(RADIUS) or 0.0, turned and math.radians(turned)) if block.has(POLAR) else None


def _place(control: Control, block: Block) -> tuple[float, float]:
    """Return where the polar words lead, program coordinates, mm."""
    x, y, _ = control.program_place
    radius, angle = math.hypot(x, y), math.atan2(y, x)
    said, turned = block.get(RADIUS), block.get(ANGLE)
    if turned is None and radius < AT_ORIGIN_MM:
        raise BlockFault(NO_ANGLE, letter=RADIUS)
    if radius < AT_ORIGIN_MM and not control.modal.absolute:
        raise BlockFault("at the zero there is no angle that G91 could go on from; write it under G90.", letter=ANGLE)
    rest = 0.0 if control.modal.absolute else 1.0
    radius = radius if said is None else rest * radius + said * control.unit
    angle = angle if turned is None else rest * angle + math.radians(turned)
    return radius * math.cos(angle), radius * math.sin(angle)
