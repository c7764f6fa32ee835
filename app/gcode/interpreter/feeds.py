"""What is fed at: G93 to G95 and F words, and in which units they are."""

from __future__ import annotations

import math

from ...model.part import Units
from .block import Block
from .block_fault import BlockFault
from .codes import ModalGroup
from .control import Control
from .dialect import Dialect
from .program import FeedMode


def _set_mode(control: Control, block: Block) -> None:
    code = block.codes[ModalGroup.FEED]
    mode = FeedMode(code)
    if mode is not control.modal.feed_mode or control.options.dialect is Dialect.LINUXCNC:
        control.change(feed_mode=mode)
        control.feed = math.nan


def set_feed(control: Control, block: Block) -> None:
    """Obey the feed mode and the F word of a block.

    Raises:
        Fault: the feed is less than 0.
    """
    if ModalGroup.FEED in block.codes:
        _set_mode(control, block)
    value = block.get("f")
    inverse = control.modal.feed_mode is FeedMode.INVERSE_TIME
    if value is None:
        control.feed = math.nan if inverse else control.feed
        return
    if value < 0:
        raise BlockFault(f"the feed rate is {value:g}; it must be greater than 0.", letter="f")
    control.feed = value * (1.0 if inverse else control.feed_unit(block)) or math.nan
    _warn_of_units(control, block, value)


def _warn_of_units(control: Control, block: Block, value: float) -> None:
    """Tell of an F that LinuxCNC takes in the units before those of its own block: 25 times as fast, or as slow, as it
    reads.
    """
    said = {"G20": Units.INCH, "G21": Units.MM}.get(block.codes.get(ModalGroup.UNITS, ""))
    if said is None or said is control.modal.units or control.options.dialect is not Dialect.LINUXCNC or not value:
        return
    if control.modal.feed_mode is not FeedMode.INVERSE_TIME:
        before, after = ("mm", "in") if said is Units.INCH else ("in", "mm")
        control.warn(
            f"F{value:g} stands in the block that changes the units, so LinuxCNC takes it as {value:g} {before}, not "
            f"{after}, a minute; write it in the next block.",
            "f",
        )
