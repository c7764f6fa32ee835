"""A program block by block, as the control has done each: for who writes the same program in other words."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from .block import Block, ParsedLine
from .parameters import Key
from .program import ModalState


@dataclass(frozen=True, eq=False)
class BlockStep:
    """A block that was done.

    Attributes:
        line: 1-based. parsed: what stands there.
        block: its words with the values that they had.
        states: what was in force before and behind it.
        motion: the G word that bare axis words obey behind it.
        feed: behind it, mm/min, mm a revolution or 1/min, by the feed mode; NaN = not said.
        rows: the first motion that it made, and the one behind its last.
        requested: parameters whose values the machine tells, and the lines that read them, since the block before.
    """

    line: int
    parsed: ParsedLine
    block: Block
    states: tuple[ModalState, ModalState]
    motion: str
    feed: float
    rows: tuple[int, int]
    requested: tuple[tuple[Key, int], ...] = ()


Watch = Callable[[BlockStep], None]
"""Told of each block when it is done."""
