"""G68 and G69, which turn a program about a point, and G16 and G15, under which X and Y are a distance and an angle: as
Fanuc, Haas and Mach3 have them, as far as these agree.
"""

from __future__ import annotations

import math

from .block import POLAR, Block
from .codes import ModalGroup
from .control import Control
from .dialect import Dialect
from .offsets import ZERO, Place, replaced
from .program import BlockFault

_ANGLE_OF_WHOLE = 1e-3
"""Degrees that an angle without a decimal point counts in where lengths without one count in thousandths."""

_ZERO_MOVES = frozenset({"G10", "G52", "G92", "G92.1", "G92.2", "G92.3"})
"""Codes that move zero, which no two controls do alike while the program is turned."""


def turn_program(control: Control, block: Block) -> None:
    """Obey G68 and G69; takes the words of the centre.

    Raises:
        BlockFault: the angle is missing, or the turn is one that controls take differently.
    """
    offsets = control.offsets
    if block.codes[ModalGroup.TURNING] == "G69":
        control.newly_turned = control.newly_turned or offsets.turn != 0.0
        offsets.turn, offsets.pivot = 0.0, ZERO
    else:
        _check_turn(control, block)
        offsets.pivot = _centre(control, block)
        offsets.turn = math.radians(_degrees(control, block, "r"))
        control.newly_turned = True
    for letter in "xyzabr":
        block.values.pop(letter, None)
    control.offsets_changed()


def _check_turn(control: Control, block: Block) -> None:
    block.need("r", "G68")
    if control.modal.plane.axes != (0, 1, 2):
        raise BlockFault("G68 is followed in the plane X Y (G17) only.", letter="g")
    if not control.modal.absolute:
        raise BlockFault("G68 under G91 means another turn on each control; write it under G90.", letter="g")
    if control.offsets.turn:
        raise BlockFault("G68 while the program is turned already; write G69 before.", letter="g")


def _centre(control: Control, block: Block) -> Place:
    """Return what the program is turned about, program coordinates, mm; the tool's place where no word says it."""
    centre = control.program_place
    for axis, letters in enumerate(("xa", "yb")):
        for letter in letters:
            said = control.length(block, letter)
            centre = centre if said is None else replaced(centre, axis, said)
    return replaced(centre, 2, 0.0)


def _degrees(control: Control, block: Block, letter: str) -> float:
    counts = _ANGLE_OF_WHOLE if letter in block.whole and control.rules.least_mm != 1.0 else 1.0
    return block.values[letter] * counts


def check_turned(control: Control, block: Block) -> None:
    """Refuse what controls take differently while the program is turned, and tell of a first move that they may.

    Raises:
        BlockFault: the block moves zero, or goes along X or Y to where the machine knows.
    """
    once = block.codes.get(ModalGroup.ONCE)
    if control.offsets.turn and (once in _ZERO_MOVES or ModalGroup.OFFSET in block.codes):
        code = once or block.codes[ModalGroup.OFFSET]
        raise BlockFault(f"{code} while the program is turned (G68); write G69 before.", letter="g")
    if control.offsets.turn and once in ("G28", "G30", "G53") and block.has("xy"):
        raise BlockFault(f"{once} along X or Y while the program is turned (G68); write G69 before.", letter="g")
    if control.newly_turned and block.has("xy") and ModalGroup.TURNING not in block.codes:
        control.newly_turned = False
        if not (control.modal.absolute and "x" in block.values and "y" in block.values):
            control.warn(
                "the first move behind G68 or G69 is known for sure only where it says X and Y under G90.", "g"
            )


def choose_polar(control: Control, block: Block) -> None:
    """Obey G15 and G16.

    Raises:
        BlockFault: the control has another G16, or none.
    """
    control.polar = block.codes[ModalGroup.POLAR] == "G16"
    control.spelling_changed()
    if control.polar and control.options.dialect is not Dialect.FANUC:
        raise BlockFault(
            f"polar coordinates (G16) of {control.rules.title} are not followed; write out the moves that it makes: "
            "the reader stops here.",
            letter="g",
        )


def spell_polar(control: Control, block: Block) -> None:
    """Put LinuxCNC's polar words in the place of X and Y under G16: both count from the program's zero.

    Raises:
        BlockFault: the radius is an increment, or an arc has a centre.
    """
    once = block.codes.get(ModalGroup.ONCE)
    if not control.polar or once not in (None, "G4", "G9") or not block.has("xy"):
        return
    if "x" in block.values and not control.modal.absolute:
        raise BlockFault("a radius under G16 and G91 begins where the tool is, which is not followed.", letter="x")
    if block.codes.get(ModalGroup.MOTION, control.motion) in ("G2", "G3") and block.has("ij"):
        raise BlockFault("an arc under G16 takes a radius R and no centre.", letter="ij")
    said = control.length(block, "x")
    if said is not None:
        block.values[POLAR[0]] = said / control.unit
    if "y" in block.values:
        block.values[POLAR[1]] = _degrees(control, block, "y")
    for letter in "xy":
        block.values.pop(letter, None)
