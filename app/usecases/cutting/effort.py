"""How long cuts will take, reckoned from counts before they are begun.

Seconds a piece are measured, on cuts of 80,000 to 800,000 motions in 1,024 to 4,096 cells.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ...core.effort import Reckoning
from ...gcode.interpreter.program import NcProgram
from ...model.motion_path import lengths
from ...model.tool import Tool

_CELL_S, _MOTION_S = 4e-9, 1e-6
"""A cell that a cutter passes over; a motion by itself."""
_JUDGED = 3.0
"""So many cuts are made where a part is proven: as it is, with a wider and with a slimmer cutter."""
_FLOOR_S = 1.5e-5
"""A piece of path as long as its tool is wide, of which coverage of a drawing's floors is asked."""


def cut_effort(
    programs: Sequence[NcProgram], tools: Mapping[int, Tool], pitch: float, drawn: bool, judged: bool
) -> Reckoning:
    """Return what cutting programs takes.

    Args:
        tools: by T number. pitch: of the cells, mm.
        drawn: whether the part is a drawing's. judged: whether there is a part at all.
    """
    cells = pieces = count = 0.0
    for program in programs:
        numbers = np.array([state.tool for state in program.states], np.int64)[program.motions.state]
        length = np.nan_to_num(lengths(program.motions))
        for number in np.unique(numbers).tolist():
            if (tool := tools.get(number)) is not None:
                way = float(length[numbers == number].sum())
                cells += way * tool.diameter / pitch**2
                pieces += way / tool.diameter
        count += len(program.motions)
    seconds = (cells * _CELL_S + count * _MOTION_S) * (_JUDGED if judged else 1.0)
    floors = pieces * _FLOOR_S if drawn else 0.0
    fewer = "choose fewer cells (--grid) or a part of the stock (--window)"
    return Reckoning(
        seconds + floors,
        f"{count:,.0f} motions in cells of {pitch:.3g} mm",
        "leave out what it is compared with (--against)" if floors > seconds else fewer,
    )
