"""How a program is to be read: the control's dialect, what the machine holds, and what is too much."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from ...model.part import Units
from .dialect import Dialect


@dataclass(frozen=True, slots=True)
class ReadLimits:
    """What a program may ask for before the reader stops with an error, so that no text can hang it.

    Attributes:
        looped_blocks: blocks that loops, subroutines and jumps repeat, and motions of holes that one block makes.
        motions: motions in all.
        line_length: characters of one line.
        nesting: brackets in brackets, and arguments of arguments.
        calls: subroutines in subroutines.
    """

    looped_blocks: int = 100_000
    motions: int = 5_000_000
    line_length: int = 10_000
    nesting: int = 40
    calls: int = 10


PATIENT = ReadLimits(looped_blocks=1_500_000)
"""For somebody who sees the progress and can cancel: programs that loop so long are rare, and real."""


@dataclass(frozen=True, slots=True)
class ToolOffset:
    """A row of the control's tool table.

    Attributes:
        offset: what G43 H takes off along X, Y, Z, mm.
        diameter: mm, 0 = not known, but where `diameter_known` says that it is.
    """

    offset: tuple[float, float, float] = (0.0, 0.0, 0.0)
    diameter: float = 0.0
    diameter_known: bool = False


@dataclass(frozen=True)
class ReadOptions:
    """Everything that decides how a text is read, beside the text.

    Attributes:
        dialect: the control's.
        tool_table: rows by number; where it is empty, every H number has a length of 0.
        start: where the controlled point is before the first motion, mm.
        block_delete: leave out blocks that begin with a slash, as the control does with its switch on.
        limits: what is too much.
        units: of a program that names none; None = mm, which is told.
    """

    dialect: Dialect = Dialect.LINUXCNC
    tool_table: Mapping[int, ToolOffset] = field(default_factory=dict)
    start: tuple[float, float, float] = (0.0, 0.0, 0.0)
    block_delete: bool = True
    limits: ReadLimits = ReadLimits()
    units: Units | None = None
