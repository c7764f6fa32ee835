"""What holds at every point, also between the cells' centres: heights that bound what is left, from below and from
above.

A cutter that is half a cell's diagonal wider cuts a cell's centre at least as deep as the true one cuts any point of
the cell; one that is as much slimmer cuts it nowhere deeper. So each cell has a lower and an upper height, and whatever
the true metal is between them, it is no farther from the part than the longest way from a height to the part's surface.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from ..core.progress import NO_PROGRESS, Progress
from ..simulation.cutter import Cutter
from ..simulation.field.target import by_strips, frozen
from ..simulation.field.workpiece import Heights, Workpiece
from ..simulation.sweeps.course import Rapids, TrimOptions
from ..simulation.sweeps.pieces import helix_chord
from .judge import PartTarget
from .judgement import Certificate
from .parts import SolidPart
from .solid_depth import CutColumns

ROUNDING = 2e-5
"""mm that heights in float32 and chords of curves may be off."""

NOWHERE = 1e6
"""mm to which a cutter is lifted that is slimmer than a cell."""

PORTION, MOST_ASKED = 4096, 400_000
"""Cells that a solid is asked at together, and at most."""

Trimming = Callable[[Mapping[int, Cutter], TrimOptions, Progress], Heights]
"""Cuts all programs with other cutters, and gives the heights that are left."""


@dataclass(frozen=True, eq=False)
class HeightBounds:
    """Heights that bound what is left all over each cell of a work piece, (rows, cols) float32 mm.

    Attributes:
        low: nowhere in the cell is metal cut deeper, rapids counted as cuts.
        high: nowhere in it is more left, rapids counted as none.
    """

    low: Heights
    high: Heights


def bounded(
    before: Workpiece, cutters: Mapping[int, Cutter], trimming: Trimming, progress: Progress = NO_PROGRESS
) -> HeightBounds:
    """Return what bounds the heights that are left: two cuts more, which need to know nothing of a part.

    Raises:
        Cancelled: the job was asked to stop.
    """
    pitch = before.grid.pitch
    off = pitch / math.sqrt(2.0) + helix_chord(pitch)
    wide = {number: cutter.grown(off) for number, cutter in cutters.items()}
    slim = {number: cutter.shrunk(off) or replace(cutter, lift=NOWHERE) for number, cutter in cutters.items()}
    progress.step(0.0, "Looking between the cells")
    low = trimming(wide, TrimOptions(Rapids.CUT), progress.part(0.0, 0.5))
    return HeightBounds(low, trimming(slim, TrimOptions(Rapids.IGNORED), progress.part(0.5, 1.0)))


def certify(before: Workpiece, part: PartTarget, bounds: HeightBounds, progress: Progress = NO_PROGRESS) -> Certificate:
    """Return how far from the part any point can be that was cut or left.

    Rapids count as cuts for the one and as none for the other. Of metal left only what lies within reach is spoken of.
    The way out of the part is looked for on the cells round a place, and as far as these go; where a solid knows
    better, it is asked.

    Raises:
        Cancelled: the job was asked to stop.
    """
    from ..simulation.field.judge_kernels import farthest

    pitch = before.grid.pitch
    half = pitch / math.sqrt(2.0)
    target, stock = frozen(part.target.around), frozen(before.heights)
    spoken = frozen(np.where(part.reach, part.target.high, np.float32(np.inf)))

    def worst(heights: Heights, counts: Heights, sign: int) -> float:
        fixed, where = frozen(heights), (pitch, half)
        return (
            max(by_strips(len(stock), lambda a, b: float(farthest(fixed, target, counts, where, sign, a, b)), progress))
            + ROUNDING
        )

    gouge = worst(bounds.low, stock, 1)
    if part.solid is not None and gouge > pitch + 2 * half:
        gouge = min(gouge, _in_solid(part.solid, part, bounds.low, before, progress.part(0.5, 1.0)) + ROUNDING)
    return Certificate(gouge, worst(bounds.high, spoken, -1), pitch)


def _in_solid(part: SolidPart, target: PartTarget, low: Heights, before: Workpiece, progress: Progress) -> float:
    """Return how deep any point can be that was cut, mm: by the solid itself where the cells round it promise too much.

    No point of a cell's column is deeper than the deepest of its middle line and half the cell's diagonal. The cells
    that seem deepest are asked first, until no other can be deeper; where that takes too many, what they seem counts.
    """
    from ..simulation.field.judge_kernels import ways_out

    grid, half = before.grid, before.grid.pitch / math.sqrt(2.0)
    cut = np.flatnonzero(low < before.heights)
    seems = np.empty(len(cut))
    ways_out(frozen(target.target.around), frozen(low), cut, (grid.pitch, half), seems)
    order = np.argsort(-seems, kind="stable")
    cut, seems = cut[order], seems[order]
    rows, cols = np.divmod(cut, grid.cols)
    places = np.column_stack([grid.x0 + (cols + 0.5) * grid.pitch, grid.y0 + (rows + 0.5) * grid.pitch])
    columns = CutColumns(places, low.ravel()[cut].astype(np.float64), before.heights.ravel()[cut].astype(np.float64))
    depth_in, fine, worst = part.depths(progress), part.tolerance / 10, part.leave + half
    for first in range(0, len(cut), PORTION):
        if seems[first] <= worst or first >= MOST_ASKED:
            return max(worst, float(seems[first]) if first >= MOST_ASKED else 0.0)
        progress.step(1.0)
        requested = slice(first, first + PORTION)
        worst = max(worst, float(depth_in.of(columns.only(requested), worst - half, fine).max()) + half + fine)
    return worst
