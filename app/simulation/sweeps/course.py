"""What is cut along: motions, and the tool of each."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from ...core.errors import ParameterError
from ...core.tolerances import LEVEL
from ...model.motion import Motions

Ints = NDArray[np.int32]


class Rapids(Enum):
    """What rapid motions do."""

    IGNORED = "ignored"
    ASKED = "asked"
    CUT = "cut"


@dataclass(frozen=True, slots=True)
class TrimOptions:
    """What to note beside the heights.

    Attributes:
        rapids: ASKED: they cut nothing, and metal that they meet is told.
        touch: a rapid that goes no deeper into metal than this is told as none, mm; also how much slimmer than its
            cutter it is taken.
        stop: motions from this row on are not done; None = all are.
        trace: note the motion that cut each cell last, and each motion's volume and engaged cells. Every motion is then
            evaluated in all cells that the one before it in its chain has not swept as deep, which takes three times as
            long.
    """

    rapids: Rapids = Rapids.ASKED
    touch: float = LEVEL
    trace: bool = False
    stop: int | None = None

    @property
    def heights_alone(self) -> bool:
        """Whether nothing but the heights at the end is asked of motions, so that one which another outdoes may be left
        out.
        """
        return not self.trace and self.stop is None


@dataclass(frozen=True, eq=False)
class Course:
    """What is cut along.

    Attributes:
        motions: n motions; where they are not known to begin (`Motions.known_from`) they are anchored.
        tool: (n,) T number of each.
        left_out: rows that neither cut nor are asked, such as those to a place of the machine.
    """

    motions: Motions
    tool: Ints
    left_out: tuple[int, ...] = ()

    @staticmethod
    def of(motions: Motions, tools: tuple[int, ...], left_out: tuple[int, ...] = ()) -> Course:
        """Return the course of a program; `tools` has the T number of each of its states."""
        return Course(motions, np.array(tools, np.int32)[motions.state], left_out)

    def strange_tool(self, row: int) -> ParameterError:
        """Return the error that nobody has said what the tool of a motion is, by its row."""
        number = int(self.tool[row])
        return ParameterError(
            f"T{number} cuts from line {int(self.motions.line[row])} on, but nobody has said what it is; "
            f"give its shape, such as {number}=flat:6."
        )
