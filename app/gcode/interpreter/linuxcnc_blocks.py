"""What LinuxCNC refuses of a block whose words are all known: words that are missing or out of range, and codes that do
not go together.

Measured at its own interpreter (rs274 2.9), which the tests ask again.
"""

from __future__ import annotations

from collections.abc import Callable

from .block import Block, ParsedLine
from .codes import AXES, CYCLES, ROTARY, ModalGroup
from .control import Control
from .program import BlockFault

_WANT_AXES = frozenset({"G10", "G28", "G30", "G52", "G92"})
"""Codes done once that leave no axis word to a motion."""

_FULL_TURN = 360.0
"""Degrees."""


def check_linuxcnc_block(control: Control, block: Block) -> None:
    """Refuse a block that LinuxCNC refuses.

    Raises:
        BlockFault: it does, and why.
    """
    check_one_taker(block)
    _check_groups(block)
    _check_motion_words(control, block)
    for code in block.codes.values():
        check = _CHECKS.get(code)
        if check is not None:
            check(block, code)


def check_one_taker(block: Block) -> None:
    """Refuse a motion beside a code that takes the axis words for itself, whether there are any or not.

    Raises:
        BlockFault: there is one.
    """
    once, motion = block.codes.get(ModalGroup.ONCE), block.codes.get(ModalGroup.MOTION)
    if once in _WANT_AXES and motion not in (None, "G80"):
        raise BlockFault(f"{once} and {motion} in one block both want its axis words; write them in two.", letter="g")


def check_linuxcnc_line(parsed: ParsedLine) -> None:
    """Refuse a line whose number stands behind other words.

    Raises:
        BlockFault: it does.
    """
    late = next((word for word in parsed.words[1:] if word.letter == "n"), None)
    if late is not None:
        raise BlockFault("LinuxCNC takes the number N at the beginning of a line only.", column=-1 - late.begin)


def _check_groups(block: Block) -> None:
    if len(block.coolant) > 1:
        raise BlockFault("LinuxCNC takes one of M7, M8 and M9 in a block; write them in two.", letter="m")
    spindle, state = block.codes.get(ModalGroup.SPINDLE), block.codes.get(ModalGroup.STATE)
    if spindle is not None and state is not None:
        raise BlockFault(f"LinuxCNC takes {spindle} and {state} not in one block; write them in two.", letter="m")


def _check_motion_words(control: Control, block: Block) -> None:
    """Refuse words that only a motion takes, where the block makes none."""
    motion = block.codes.get(ModalGroup.MOTION)
    if block.codes.get(ModalGroup.ONCE) == "G53" and motion is None and not block.has(AXES + ROTARY):
        raise BlockFault("G53 goes with G0 and G1 only.", letter="g")
    moves = block.codes.get(ModalGroup.ONCE) in (None, "G53")
    if motion is None and moves and control.motion == "G5" and block.has("pq") and block.has(AXES):
        raise BlockFault("LinuxCNC wants G5 again in each block of its curve with P and Q.", letter="pq")
    if motion is None and control.motion in CYCLES and not block.has(AXES + ROTARY + "@^"):
        letter = next((letter for letter in "rlqk" if letter in block.values), "")
        if letter and not _taken_by_others(block):
            raise BlockFault("no code in this block takes this word.", letter=letter)


def _taken_by_others(block: Block) -> bool:
    """Tell whether a code of the block, which moves nothing, may take words of a cycle."""
    return any(code[0] == "M" or group is ModalGroup.ONCE for group, code in block.codes.items())


def _need_port(block: Block, code: str) -> None:
    if not block.has("p"):
        raise BlockFault(f"{code} needs a word P, the number of the output.", letter="m")


def _need_analog_port(block: Block, code: str) -> None:
    if not block.values.get("e", -1.0) >= 0:
        raise BlockFault(f"{code} needs a word E, the number of the output, 0 or more.", letter="m")


def _wait_for_input(block: Block, code: str) -> None:
    if block.has("p") == block.has("e"):
        raise BlockFault(f"{code} needs one of P and E, the number of the input.", letter="m")
    if block.values.get("l", 0.0) and not block.values.get("q", 0.0) > 0:
        raise BlockFault(f"{code} with L needs Q, how many seconds to wait at most.", letter="l")


def _orient(block: Block, code: str) -> None:
    if not 0 <= block.values.get("r", 0.0) <= _FULL_TURN:
        raise BlockFault(f"{code} turns the spindle to R0 to R360.", letter="r")
    if block.values.get("p", 0.0) not in (0.0, 1.0, 2.0):
        raise BlockFault(f"{code} has no way P{block.values['p']:g}; use P0, P1 or P2.", letter="p")


def _set_tool(block: Block, code: str) -> None:
    if block.values.get("q", 0.0) < 0:
        raise BlockFault(f"the tool number is {block.values['q']:g}; it must be 0 or more.", letter="q")


def _add_length(block: Block, code: str) -> None:
    if not block.has("h") or block.has(AXES):
        raise BlockFault(f"{code} needs a word H, and no axis words beside it.", letter="g")


def _need_speed(block: Block, code: str) -> None:
    if not block.has("s"):
        raise BlockFault(f"{code} needs a word S.", letter="g")


def _need_control_point(block: Block, code: str) -> None:
    if not (block.has("i") and block.has("j")):
        raise BlockFault(f"{code} needs its control point, I and J.", letter="g")


_CHECKS: dict[str, Callable[[Block, str], None]] = {
    **dict.fromkeys(("M62", "M63", "M64", "M65"), _need_port),
    **dict.fromkeys(("M67", "M68"), _need_analog_port),
    "M66": _wait_for_input,
    "M19": _orient,
    "M61": _set_tool,
    "G43.2": _add_length,
    "G96": _need_speed,
    "G5.1": _need_control_point,
}
