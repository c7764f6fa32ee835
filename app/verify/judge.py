"""A cut against the part: which cells are gouged or left, how large each place is, and what holds between the cells.

For a drawing milled to depths, gouges and areas left are measured on the motions themselves, exactly; the cells confirm
them, and a gouge that only the cells show counts too. For a solid, and where a tool's end is not flat, the cells
decide.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.progress import NO_PROGRESS, Progress
from ..simulation.cutter import Cutter
from ..simulation.field.target import MARGIN, TargetHeights, by_strips, frozen, solid_target
from ..simulation.field.workpiece import Grid, Heights, StockShape, Workpiece
from ..simulation.sweeps.course import Rapids, TrimOptions
from ..simulation.sweeps.pieces import helix_chord
from ..simulation.sweeps.probe import reach_of, reachable
from ..simulation.sweeps.trim import CutResult
from ..toolpath.coverage.coverage import UncutPlace
from .exact import ExactDeviations
from .judgement import BANDS, Band, CellPlace, Certificate, Judgement, Spot, SpotKind, places_of
from .parts import FlatPart, Part, SolidPart, flat_target
from .verdict import Gouge
from .wall_probe import Probe, WallProbe

Mask = NDArray[np.bool_]

APART = 1.0
"""mm between gouges that are told one by one."""

MOST_GOUGES = 100
"""Gouges that are told one by one, at most."""

STEEPEST = 10.0
"""mm up per mm sideways; steeper places count as that steep."""


@dataclass(frozen=True, eq=False)
class PartTarget:
    """The part over the grid of a cut.

    Attributes:
        target: heights.
        reach: (rows, cols) where some tool that cuts gets down to the part; of a solid, of what is left.
        solid: the part, if it is one closed surface, and so can be asked how deep places lie in it.
        standing: (rows, cols) how high metal stands over what some tool surely gets down to, mm, where no tool gets
            down to the part; None: nothing is known of that.
    """

    target: TargetHeights
    reach: Mask
    solid: SolidPart | None = None
    standing: Heights | None = None

    def out_of_reach(self, left: Mask, tolerance: float) -> Mask:
        """Return where what is left stands no higher than the tools leave it at best."""
        beyond = left & ~self.reach
        return beyond if self.standing is None else beyond & ~(self.standing > tolerance)


def part_target(
    part: Part, cut: CutResult, stock: StockShape, cutters: tuple[Cutter, ...], progress: Progress = NO_PROGRESS
) -> PartTarget:
    """Return the part over the grid of a cut; metal that was not there is not gouged.

    Args:
        stock: all of it, where the grid may be a window.
        cutters: that may cut.

    Raises:
        ParameterError: the grid does not fit into memory.
        Cancelled: the job was asked to stop.
    """
    grid = cut.before.grid
    if isinstance(part, FlatPart):
        flat = flat_target(part, grid)
        return PartTarget(_where_metal_was(flat.target, cut), flat.reach)
    solid = part if part.block is None else None
    exact = solid_target(part.solid, grid, part.leave, progress)
    allowance = _upright(exact, part.allowance)
    target = replace(exact, high=exact.high + allowance)
    left = target.deviation(cut.heights) > part.tolerance
    if not (left.any() and cutters):
        return PartTarget(_where_metal_was(target, cut), ~left, solid)
    lowest = reach_of(part.solid, part.leave, stock.box, cutters, progress)
    *heights, over_part = lowest.over(grid)
    sure, possible = (height <= target.high + np.float32(part.tolerance) for height in heights)
    wide = max(3, math.ceil(3 * lowest.grid.pitch / grid.pitch))
    reach = ~left | reachable(left, sure, possible, over_part <= part.tolerance, wide)
    return PartTarget(_where_metal_was(target, cut), reach, solid, cut.heights - heights[0] - allowance)


def _where_metal_was(target: TargetHeights, cut: CutResult) -> TargetHeights:
    """Return a target that is no higher than the metal was: what was not there is not gouged."""
    return replace(target, low=np.minimum(target.low, cut.before.heights))


def _upright(target: TargetHeights, allowance: float) -> NDArray[np.float32]:
    """Return what an allowance square to a part's surface is straight up, at each cell; at walls it is as for a slope
    of 10.
    """
    own = slice(MARGIN, -MARGIN)
    if not allowance:
        return np.zeros_like(target.high)
    with np.errstate(invalid="ignore"):  # beside the part there is no height
        slopes = np.gradient(target.around, target.grid.pitch)
    north, east = (np.nan_to_num(slope, nan=STEEPEST, posinf=STEEPEST, neginf=STEEPEST) for slope in slopes)
    rise = np.hypot(north, east)
    return np.asarray(allowance * np.hypot(1.0, np.minimum(rise[own, own], STEEPEST)), np.float32)


@dataclass(frozen=True, eq=False)
class JudgementInput:
    """What a judgement is made of: the cut, the part over it, what closed forms say, the lines of the motions.

    Attributes:
        lowest: of a solid, gives the height that is cut down to at any places, and by whom.
        probe: who asks walls.
    """

    part: Part
    cut: CutResult
    part_target: PartTarget
    exact: ExactDeviations | None
    lines: NDArray[np.int32]
    lowest: Probe | None = None
    probe: WallProbe | None = None

    @property
    def grid(self) -> Grid:
        """Of the cut."""
        return self.cut.before.grid

    def line_at(self, row: int, col: int) -> tuple[int, int]:
        """Return line and row of the motion that cut a cell last; 0 and -1 where none did or nobody noted it."""
        owner = -1 if self.cut.owner is None else int(self.cut.owner[row, col])
        return (int(self.lines[owner]), owner) if owner >= 0 else (0, -1)

    def to_program(self, x: float, y: float) -> tuple[float, float]:
        """Return a place of the part in program coordinates."""
        origin = self.part.origin if isinstance(self.part, FlatPart) else (0.0, 0.0)
        return x - origin[0], y - origin[1]


def judge(judging: JudgementInput, certificate: Certificate | None, progress: Progress = NO_PROGRESS) -> Judgement:
    """Return what is said of a cut.

    Raises:
        Cancelled: by progress.
    """
    part, tolerance = judging.part, judging.part.tolerance
    deviation = judging.part_target.target.deviation(judging.cut.heights)
    left = deviation > tolerance
    unreachable = judging.part_target.out_of_reach(left, tolerance)
    gouges, gouged = _gouges(judging, deviation, progress)
    gouge = _worst(judging, gouges, gouged)
    masks = {SpotKind.LEFT: left & ~unreachable, SpotKind.UNREACHABLE: unreachable}
    coverage = judging.exact.coverage if judging.exact is not None else None
    if coverage is not None:
        reachable_mm2, unreachable_mm2 = coverage.reachable_left_mm2, coverage.unreachable_mm2
        left_spots = [_measured(judging, place) for place in coverage.places]
        counts = {kind: sum(spot.kind is kind for spot in left_spots) for kind in masks}
    else:
        cell = judging.grid.pitch**2
        reachable_mm2, unreachable_mm2 = (float(np.count_nonzero(mask)) * cell for mask in masks.values())
        heights = {SpotKind.LEFT: _over_reach(judging.part_target, deviation), SpotKind.UNREACHABLE: deviation}
        found = {kind: places_of(mask, heights[kind], judging.grid) for kind, mask in masks.items()}
        left_spots = [_left(judging, place, kind) for kind, (places, _) in found.items() for place in places]
        counts = {kind: count for kind, (_, count) in found.items()}
    discs = (spot.disc_mm for spot in left_spots if spot.kind is SpotKind.UNREACHABLE)
    return Judgement(
        deviation=deviation,
        unreachable=unreachable,
        gouge=gouge,
        reachable_mm2=reachable_mm2,
        unreachable_mm2=unreachable_mm2,
        largest_disc_mm=max(discs, default=0.0),
        spots=(*gouges, *left_spots),
        counts=counts | {SpotKind.GOUGE: gouged},
        bands=tuple(_bands(judging, deviation)),
        certificate=certificate,
        exact=isinstance(part, FlatPart),
        tolerance=tolerance,
        skin_mm2=coverage.given_up_mm2 if coverage is not None else 0.0,
    )


class _FoundGouges(NamedTuple):
    """Gouges, the deepest first, and how many there are."""

    spots: tuple[Spot, ...]
    number: int


def _gouges(judging: JudgementInput, deviation: NDArray[np.float32], progress: Progress) -> _FoundGouges:
    """Return the gouges: by closed forms, or where these know of none, those that the
    cells show.
    """
    part = judging.part
    exact = tuple(_exact_gouges(judging))
    if exact:
        return _FoundGouges(exact, len(exact))
    gouged = np.asarray(deviation < -part.tolerance)
    places, count = places_of(gouged, -deviation, judging.grid)
    if isinstance(part, SolidPart) and judging.lowest is not None:
        from .solid_gouges import SolidGouges  # a drawing needs none of it

        cut, around = judging.cut, judging.part_target.target.around
        depths = partial(part.depths, progress)
        measure = SolidGouges(part, judging.lowest, cut.before, cut.heights, gouged, around, judging.lines, depths)
        spots = measure.spots(places, judging.probe)
        return _FoundGouges(tuple(spots), len(spots) + count - len(places))
    spots = [spot for spot in (_gouge_of_cells(judging, place) for place in places) if spot.depth_mm > part.tolerance]
    spots.sort(key=lambda spot: -spot.depth_mm)
    return _FoundGouges(tuple(spots), len(spots) + count - len(places))


def _exact_gouges(judging: JudgementInput) -> Iterator[Spot]:
    """Yield the gouging motions, the deepest first, but for those near a deeper one."""
    part = judging.part
    if judging.exact is None or not isinstance(part, FlatPart):
        return
    depths, origin = judging.exact.depths, np.array(part.origin)
    reported: list[tuple[float, float]] = []
    for k in np.argsort(-depths.depth, kind="stable")[: np.count_nonzero(depths.depth > part.wall_tolerance)].tolist():
        x, y, z = (depths.places[k] - origin).tolist()
        if len(reported) < MOST_GOUGES and all(np.hypot(x - other[0], y - other[1]) > APART for other in reported):
            reported.append((x, y))
            motion = int(depths.move[k])
            yield Spot(
                kind=SpotKind.GOUGE,
                x=x,
                y=y,
                z=z,
                depth_mm=float(depths.depth[k]),
                area_mm2=0.0,
                disc_mm=0.0,
                line=int(judging.lines[motion]),
                motion=motion,
            )


def _gouge_of_cells(judging: JudgementInput, place: CellPlace) -> Spot:
    """Return a gouge as the cells show it; its depth is the way out of the part, not straight up."""
    from ..simulation.field.judge_kernels import ways_out

    target, grid, depths = judging.part_target.target, judging.grid, np.zeros(len(place.cells))
    ways_out(frozen(target.around), frozen(judging.cut.heights), place.cells, (grid.pitch, 0.0), depths)
    worst = int(np.argmax(depths))
    row, col = divmod(int(place.cells[worst]), grid.cols)
    x, y = grid.place(int(place.cells[worst]))
    line, motion = judging.line_at(row, col)
    z, depth = float(judging.cut.heights[row, col]), float(depths[worst])
    return Spot(SpotKind.GOUGE, x, y, z, depth, place.area_mm2, place.disc_mm, line, motion)


def _worst(judging: JudgementInput, spots: tuple[Spot, ...], gouged: int) -> Gouge:
    """Return the deepest gouge, of so many; where there is none, how little the path keeps from one."""
    part, worst = judging.part, spots[0] if spots else None
    if judging.exact is None or not isinstance(part, FlatPart):
        return Gouge(worst.depth_mm, worst.x, worst.y, worst.z, worst.motion, gouged) if worst else Gouge()
    depths = judging.exact.depths
    if worst:
        count = max(gouged, int(np.sum(depths.depth > part.wall_tolerance)))
        return Gouge(worst.depth_mm, worst.x, worst.y, worst.z, worst.motion, count)
    if not len(depths.depth) or depths.depth.max() <= 0:
        return Gouge()
    k = int(np.argmax(depths.depth))
    x, y, z = (depths.places[k] - np.array(part.origin)).tolist()
    return Gouge(float(depths.depth[k]), x, y, z, int(depths.move[k]), 0)


def _over_reach(target: PartTarget, deviation: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return how high metal stands over the part, and where no tool gets down to that over what tools leave at best."""
    return deviation if target.standing is None else np.where(target.reach, deviation, target.standing)


def _left(judging: JudgementInput, place: CellPlace, kind: SpotKind) -> Spot:
    """Return a place of metal left."""
    row, col = place.cell
    x, y = judging.grid.place(row * judging.grid.cols + col)
    line, motion = judging.line_at(row, col)
    return Spot(
        kind, x, y, float(judging.cut.heights[row, col]), place.worst, place.area_mm2, place.disc_mm, line, motion
    )


def _measured(judging: JudgementInput, place: UncutPlace) -> Spot:
    """Return a piece of floor that is left; how high it stands, and who cut there last, the cells tell."""
    grid, (x, y) = judging.grid, judging.to_program(place.x, place.y)
    row, col = int((y - grid.y0) / grid.pitch), int((x - grid.x0) / grid.pitch)
    kind = SpotKind.LEFT if place.reachable else SpotKind.UNREACHABLE
    if not (0 <= row < grid.rows and 0 <= col < grid.cols):
        return Spot(kind, x, y, 0.0, 0.0, place.area_mm2, place.disc_mm)
    around = (slice(max(row - 1, 0), row + 2), slice(max(col - 1, 0), col + 2))
    over = float(np.max(judging.cut.heights[around] - judging.part_target.target.heights[around], initial=0.0))
    target = float(judging.part_target.target.heights[around].min())
    # narrower than the cells: as high as the stock was
    if over <= judging.part.tolerance and place.disc_mm < 3 * grid.pitch:
        over = max(float(judging.cut.before.heights[around].max()) - target, 0.0)
    return Spot(kind, x, y, target + over, over, place.area_mm2, place.disc_mm, *judging.line_at(row, col))


def _bands(judging: JudgementInput, deviation: NDArray[np.float32]) -> Iterator[Band]:
    """Yield the area of each band of deviation, where the part says something."""
    tolerance = judging.part.tolerance
    edges = sorted({-np.inf, np.inf, -tolerance, tolerance, *(edge for edge in BANDS if abs(edge) > tolerance)})
    reported = deviation[np.isfinite(judging.part_target.target.high) | (deviation < 0)]
    counts, _ = np.histogram(reported, np.array(edges))
    for low, high, count in zip(edges[:-1], edges[1:], counts.tolist(), strict=True):
        yield Band(float(low), float(high), count * judging.grid.pitch**2)


# What holds at every point, also between the cells' centres: heights that bound what is left, from below and from
# above.
#
# A cutter that is half a cell's diagonal wider cuts a cell's centre at least as deep as the true one cuts any point of
# the cell; one that is as much slimmer cuts it nowhere deeper. So each cell has a lower and an upper height, and
# whatever the true metal is between them, it is no farther from the part than the longest way from a height to the
# part's surface.


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
    from .solid_depth import CutColumns  # a drawing needs none of it

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
