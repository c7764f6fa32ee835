"""LinuxCNC's M70 to M73: what is in force is kept, and comes back.

The program and each subroutine that is running keep one state of their own. The motion's G word, G92 and the tool are
no part of it.
"""

from __future__ import annotations

import math

from .block import Block
from .codes import ModalGroup
from .control import Control, SavedState
from .offsets import ZERO
from .program import BlockFault, FeedMode, ModalState
from .settings import before_motion

_KEPT = (
    "units",
    "plane",
    "absolute",
    "arc_absolute",
    "feed_mode",
    "path",
    "path_tolerance",
    "retract_to_r",
    "spindle",
    "speed",
    "constant_surface",
    "mist",
    "flood",
)
"""Fields of `ModalState` that come back as they were."""


def obey_state(control: Control, block: Block, before: ModalState, side: str) -> None:
    """Obey M70 to M73 of a block whose modes are set, before its motion.

    Args:
        control: the control.
        block: its words; behind M72 nothing of it is left to do.
        before: what was in force before the block; F, S and coolant are kept as the block itself says them.
        side: G word of cutter compensation before the block.

    Raises:
        BlockFault: M72 where nothing was kept.
    """
    code = block.codes.get(ModalGroup.STATE)
    if code in ("M70", "M73"):
        kept = {name: getattr(before, name) for name in _KEPT}
        now = control.modal
        kept |= {"speed": now.speed, "mist": now.mist, "flood": now.flood}
        length = before.length_offset != 0 or control.offsets.tool != ZERO
        control.saved[-1] = SavedState(kept, before.work_offset, control.feed, side, length, code == "M73")
    elif code == "M71":
        control.saved[-1] = None
    elif code == "M72":
        _restore_here(control, block)


def _restore_here(control: Control, block: Block) -> None:
    saved = control.saved[-1]
    if saved is None:
        raise BlockFault("M72 brings back what M70 or M73 has kept here, and nothing is kept.", letter="m")
    restore(control, saved)
    if block.has("xyzabcuvw@^ijkr"):
        control.warn("LinuxCNC makes no motion in a block with M72; write M72 alone in its line.", "m")
        for letter in "xyzabcuvw@^ijkr":
            block.values.pop(letter, None)


def restore(control: Control, saved: SavedState) -> None:
    """Bring back what was kept.

    Raises:
        BlockFault: cutter compensation cannot come back as it was.
    """
    if control.side != saved.side and control.side:
        control.end_compensation()
    control.change(**saved.modal)
    control.feed = math.nan if saved.modal["feed_mode"] is FeedMode.INVERSE_TIME else saved.feed
    codes: dict[ModalGroup, str] = {}
    if control.modal.work_offset != saved.work_offset:
        codes[ModalGroup.OFFSET] = saved.work_offset
    if (control.offsets.tool != ZERO) != saved.length:
        codes[ModalGroup.LENGTH] = "G43" if saved.length else "G49"
    if control.side != saved.side:
        codes[ModalGroup.RADIUS] = saved.side
    if codes:
        before_motion(control, Block(codes=codes))
