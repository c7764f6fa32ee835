"""A program block by block, as the control has done each: for who writes the same program in other words."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from .block import Block, Parsed
from .parameters import Key
from .program import ModalState


@dataclass(frozen=True, eq=False)
class Step:
    """A block that was done.

    Attributes:
        line: 1-based. parsed: what stands there.
        block: its words with the values that they had.
        states: what was in force before and behind it.
        motion: the G word that bare axis words obey behind it.
        feed: behind it, mm/min, mm a revolution or 1/min, by the feed mode; NaN = not said.
        rows: the first motion that it made, and the one behind its last.
        asked: parameters whose values the machine tells, and the lines that read them, since the block before.
    """

    line: int
    parsed: Parsed
    block: Block
    states: tuple[ModalState, ModalState]
    motion: str
    feed: float
    rows: tuple[int, int]
    asked: tuple[tuple[Key, int], ...] = ()


Watch = Callable[[Step], None]
"""Told of each block when it is done."""
