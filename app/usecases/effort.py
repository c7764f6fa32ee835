"""How long cuts, scenes and jobs on pixels will take, reckoned from counts before they are begun.

Seconds a piece are measured: cuts of 80,000 to 800,000 motions in 1,024 to 4,096 cells, scenes of 1,500 to 120,000
moves, bitmaps of 512 to 4,096 pixels a side with paths of 19,000 to 280,000.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..core.effort import Reckoning
from ..core.wording import counted
from ..gcode.interpreter.program import NcProgram
from ..model.motion_path import lengths
from ..model.tool import Tool

if TYPE_CHECKING:  # a cut needs nothing of them
    from ..surfaces.passes.facet_crossings import FacetCrossings
    from .bitmap_part import BitmapPart

_CELL_S, _MOTION_S = 4e-9, 1e-6
"""A cell that a cutter passes over; a motion by itself."""
_JUDGED = 3.0
"""So many cuts are made where a part is proven: as it is, with a wider and with a slimmer cutter."""
_FLOOR_S = 1.5e-5
"""A piece of path as long as its tool is wide, of which coverage of a drawing's floors is asked."""
_CROSSING_S = 1.1e-4
"""A facet that a plane of passes crosses: contact, path, compound surface, text and proof."""
_PIXEL_S = 5e-8
"""A pixel of a bitmap that an operation shrinks and traces."""
_CHAIN_S = 2e-5
"""A pixel along a path that is smoothed, and proven to keep clear: straight walls take a third of it, waves twice."""
_ON_PIXELS_S = 0.07
"""A contour whose paths on pixels are linked, written, read back, and measured as to what they leave."""


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


def scene_effort(families: Iterable[FacetCrossings]) -> Reckoning:
    """Return what a scene's passes take."""
    crossings, planes = 0.0, 0
    for family in families:
        crossings, planes = crossings + family.crossings, planes + family.planes
    return Reckoning(
        crossings * _CROSSING_S,
        f"{planes:,} passes over {crossings:,.0f} facets",
        "use a larger pitch or scallop height, coarser surfaces, or check the model's units",
    )


def bitmap_effort(part: BitmapPart, chains_mm: Sequence[float]) -> Reckoning:
    """Return what a job on pixels takes.

    Args:
        part: the pixels. chains_mm: how long the paths of each operation are, about, in one pass.
    """
    pitch, contours = part.frame.pitch, sum(len(region.contours) for region in part.regions)
    along = sum(chains_mm) / pitch
    seconds = part.free.size * len(chains_mm) * _PIXEL_S + along * _CHAIN_S + contours * _ON_PIXELS_S
    many, outlines = contours * _ON_PIXELS_S > seconds / 2, counted(contours, "contour", thousands=",")
    return Reckoning(
        seconds,
        f"{along:,.0f} pixels of paths in {outlines} on {part.frame.cols:,} x {part.frame.rows:,} pixels",
        "leave out layers" if many else "use a smaller bitmap, a larger pitch, or a larger tool",
    )
