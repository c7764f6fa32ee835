"""What a scene's program leaves of the metal that its own tools reach, from the cut of the text that was written.

The ridges between passes are what the pitch asks for: on slopes they are told as ridges, with their place. Metal that
stands higher than that, beside walls between two planes, on sides that passes miss, at a foot where the overrun ends,
is left, and counts.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.progress import NO_PROGRESS, Progress
from ...core.wording import in_plane
from ...model.finding import Finding, FindingKind
from ...simulation.field.workpiece import Grid, Workpiece
from ...verify.judgement import places_of
from ...verify.parts import TOLERANCE
from .corner_reach import CornerReach, CornerTool, TipHeights, corner_reach
from .reach import FamilyReach, Floats, Heights, SurfaceGrid, TipGrid, slopes, tip_heights
from .ridges import MOST, ridges

Mask = NDArray[np.bool_]

BENT = 2.0
"""So many times the ridges of a plane are still ridges: in a hollow of twice the cutter's radius they are as high."""

STEEP = 1.0
"""mm per mm from which on a place is part of a side: its ridges may be as high as those of the steepest place near
it.
"""

STEEPEST = 10.0
"""mm per mm; on steeper places the cells say no less."""

SIDE = 2.0
"""mm per mm: of the sides of corners that are looked at closely."""

MOST_PLACES = 4_000
"""Places in corners that are looked at closely, those first where cells see most metal; of others cells alone tell."""

CELLS_WIDE = 2
"""Cells that a place is wide at least: how far a wall between cells may seem to be from where it is."""


@dataclass(frozen=True, slots=True)
class FamilyRequest:
    """What one family of passes is to do.

    Attributes:
        requested: where its tool may go.
        angle: of its planes to X, radians. spacing: of neighbouring ones at most, mm.
        ridge: height that is asked for, mm; None: what the spacing leaves.
        chord: how far its path may lie above the surfaces, mm.
        overrun: whether it is kept from going on beside the surfaces as far as it touches them.
        tips: its cutter over the surfaces, for a closer look at corners; None: cells alone tell.
    """

    requested: FamilyReach
    angle: float
    spacing: float
    ridge: float | None
    chord: float
    overrun: bool = False
    tips: TipHeights | None = None

    @property
    def most(self) -> float:
        """How high ridges may stand at all, square to what is cut, mm."""
        return max(MOST * self.requested.cutter.radius, BENT * _level(self))


@dataclass(frozen=True, slots=True)
class Ridge:
    """The highest ridge between passes: how high, square to the surface, mm; where; and what the passes leave on a
    level floor.
    """

    height_mm: float
    x: float
    y: float
    slope_deg: float
    level_mm: float


@dataclass(frozen=True, slots=True)
class SceneLeft:
    """What a program leaves within reach of its tools; places in the coordinates of the grid.

    Attributes:
        area_mm2, places: of the metal left, seen from above. worst_mm: how high it stands, straight up.
        wide_mm: diameter of the largest disc in the worst place. x, y: where that is.
        ridge: None where there is no metal on the surfaces.
        within_mm: what stands less high than that, square to a level surface, is not told. cell_mm: what is narrower
            than two is not.
        at_rim: the worst place is within a tool's radius of where surfaces end. cut_short: and passes are kept from
            going on there.
    """

    area_mm2: float
    places: int
    worst_mm: float
    wide_mm: float
    x: float
    y: float
    ridge: Ridge | None
    within_mm: float
    cell_mm: float
    at_rim: bool = False
    cut_short: bool = False


def left_of(
    workpiece: Workpiece,
    triangles: Floats,
    error: float,
    requested: Sequence[FamilyRequest],
    progress: Progress = NO_PROGRESS,
) -> SceneLeft:
    """Return what is left of a part's metal.

    Args:
        workpiece: after the cut. triangles: (n, 3, 3) of the surfaces, mm. error: how far they may be off these.
        requested: of each family of passes, at least one.

    Raises:
        Cancelled: the job was asked to stop.
    """
    grid = workpiece.grid
    sheet = SurfaceGrid.of(triangles, grid)
    on = np.isfinite(sheet.heights)
    families = _reached(triangles, grid, requested, progress.part(0.0, 0.6))
    low = np.minimum.reduce([each.low for each in families], initial=np.float32(np.inf))
    over = np.where(on & np.isfinite(low), workpiece.heights - np.where(np.isfinite(low), low, 0.0), 0.0).astype(
        np.float32
    )
    with np.errstate(invalid="ignore"):
        seen = _Standing(over, _wide(over > _allowed(sheet, error, families, low)))
        corners = on & (low > _lowest_cut(sheet, requested)) & ~seen.mask
    limits = [_CornerLimit.of(each, error) for each in families if each.requested.tips is not None]
    seen = _closer(workpiece, seen, corners, limits, progress.part(0.6, 1.0))
    over, mask = seen.over, seen.mask
    found, count = places_of(mask, over, grid)
    ridge = _ridge(sheet, over, mask, low, requested)
    within = min((_level(each) * BENT + each.chord for each in requested), default=0.0) + TOLERANCE + error
    if not found:
        return SceneLeft(
            area_mm2=0.0,
            places=0,
            worst_mm=0.0,
            wide_mm=0.0,
            x=0.0,
            y=0.0,
            ridge=ridge,
            within_mm=within,
            cell_mm=grid.pitch,
        )
    row, col = found[0].cell
    x, y = grid.place(row * grid.cols + col)
    area = float(np.count_nonzero(mask)) * grid.pitch**2
    rim = _at_rim(on, row, col, math.ceil(max(each.requested.cutter.radius for each in requested) / grid.pitch))
    short = rim and any(each.overrun for each in requested)
    return SceneLeft(
        area_mm2=area,
        places=count,
        worst_mm=found[0].worst,
        wide_mm=found[0].disc_mm,
        x=x,
        y=y,
        ridge=ridge,
        within_mm=within,
        cell_mm=grid.pitch,
        at_rim=rim,
        cut_short=short,
    )


@dataclass(frozen=True, eq=False)
class _ReachedFamily:
    """A family of passes by cells: how low its tool's tip comes, and how low it cuts from there."""

    requested: FamilyRequest
    tips: TipGrid
    low: Heights


def _reached(
    triangles: Floats, grid: Grid, requested: Sequence[FamilyRequest], progress: Progress
) -> list[_ReachedFamily]:
    found = []
    for number, each in enumerate(requested):
        share = progress.part(number / len(requested), (number + 1) / len(requested))
        share.step(0.0, "Looking for what is left")
        tips = tip_heights(triangles, grid, each.requested, share)
        found.append(_ReachedFamily(each, tips, tips.reached(each.requested.cutter, grid, share)))
    return found


def _allowed(area: SurfaceGrid, error: float, families: Sequence[_ReachedFamily], low: Heights) -> Floats:
    """Return how much higher than within reach metal may stand, mm straight up."""
    grid = area.grid
    allowed = np.full(low.shape, np.inf)
    own = slopes(area.heights, grid.pitch)
    for family in families:
        each = family.requested
        highest = np.minimum(BENT * _ridges(each, _across(own, each), grid), each.most)
        allowed = np.minimum(allowed, _upright(area, family.low, each, highest + each.chord + TOLERANCE + error))
    return allowed


@dataclass(frozen=True, eq=False)
class _Standing:
    """How high metal stands over what is within reach, (rows, cols) mm straight up, and where it is left."""

    over: Heights
    mask: Mask


@dataclass(frozen=True, eq=False)
class _CornerLimit:
    """How high metal may stand in corners over what one family's tool reaches.

    Attributes:
        family: which has `tips`. square: the height, square to what is cut, mm.
    """

    family: _ReachedFamily
    square: float

    @staticmethod
    def of(family: _ReachedFamily, error: float) -> _CornerLimit:
        """Return it for surfaces that may be off by an error, mm.

        Where no height of ridges was asked for they may be twice as high as elsewhere: they lie where a slope ends and
        what is cut is level.
        """
        each = family.requested
        highest = BENT * (each.most if each.ridge is None else each.ridge)
        return _CornerLimit(family, highest + each.chord + TOLERANCE + error)

    def reach(self, places: Floats, metal: Heights, progress: Progress) -> CornerReach:
        """Return what is within reach at places (n, 2), mm, where the metal is so high."""
        family = self.family.requested
        assert family.tips is not None

        def doubtful(reach: CornerReach, step: float) -> Mask:
            """Return where metal does not stand too high yet, but within a step up a side as steep as corners have."""
            over, most = metal - reach.low, self.upright(reach)
            return np.asarray((over <= most) & (over + SIDE * step > most))

        return corner_reach(CornerTool(family.requested, family.tips, self.family.tips), places, doubtful, progress)

    def upright(self, reach: CornerReach) -> Floats:
        """Return the height straight up, mm."""
        return np.asarray(self.square * np.hypot(1.0, reach.rise))


def _closer(
    workpiece: Workpiece, seen: _Standing, corners: Mask, limits: Sequence[_CornerLimit], progress: Progress
) -> _Standing:
    """Return what is seen after a closer look at corners.

    Args:
        seen: by cells. corners: (rows, cols) cells that are none of what is left, and where a tool touches two sides.

    Raises:
        Cancelled: the job was asked to stop.
    """
    grid = workpiece.grid
    # cells may tell what is within reach too high, too: as much as a side rises within one
    least = min((each.square for each in limits), default=np.inf) - grid.pitch
    cells = np.flatnonzero(corners & (seen.over > least))
    if not len(cells):
        return seen
    worst = cells[np.argsort(-seen.over.ravel()[cells], kind="stable")[:MOST_PLACES]]
    own = np.unravel_index(worst, corners.shape)
    places = np.column_stack([grid.xs()[own[1]], grid.ys()[own[0]]])
    metal, lowest, highest = workpiece.heights[own], np.full(len(places), np.inf), np.full(len(places), np.inf)
    for number, limit in enumerate(limits):
        share = progress.part(number / len(limits), (number + 1) / len(limits))
        reach = limit.reach(places, metal, share)
        lowest, highest = np.minimum(lowest, reach.low), np.minimum(highest, limit.upright(reach))
    closer = _Standing(seen.over.copy(), seen.mask.copy())
    closer.over[own] = metal - lowest
    closer.mask[own] = closer.over[own] > highest
    return closer


def _ridges(requested: FamilyRequest, across: Floats, grid: Grid) -> Floats:
    """Return how high ridges may stand at each cell, square to the surface: on sides as high as at the steepest place
    near.
    """
    import cv2

    if requested.ridge is not None:
        return np.full(across.shape, requested.ridge)
    cells = 2 * math.ceil(min(requested.spacing / 2, requested.requested.cutter.radius) / grid.pitch) + 1
    side = np.where(across >= STEEP, across, 0.0).astype(np.float32)
    near = cv2.dilate(side, np.ones((cells, cells), np.uint8))
    return ridges(requested.requested.cutter, requested.spacing, np.where(across >= STEEP, near, across))


def _upright(area: SurfaceGrid, low: Heights, requested: FamilyRequest, square: Floats) -> Floats:
    """Return what heights square to what is within reach are straight up, and beside them how much too low that may be
    told, mm.

    On bent surfaces cells make it little too low. In corners, where a wall is known to a cell, it is as low as a cell
    farther from it.
    """
    import cv2

    pitch, radius = area.grid.pitch, requested.requested.cutter.radius
    known = np.where(np.isfinite(low), low, 0.0).astype(np.float32)
    with np.errstate(invalid="ignore"):
        corner = low > area.heights + requested.requested.leave + TOLERANCE
    rise = np.where(
        corner, np.hypot(*np.gradient(known.astype(np.float64), pitch)), np.hypot(*slopes(area.heights, pitch))
    )
    nearer = cv2.dilate(known, np.ones((3, 3), np.uint8)) - known
    bent = pitch**2 / (4 * radius) * np.hypot(1.0, np.minimum(rise, STEEPEST)) ** 3
    return np.asarray(square * np.hypot(1.0, rise) + bent + np.where(corner, nearer, 0.0))


def _across(own: tuple[Floats, Floats], requested: FamilyRequest) -> Floats:
    """Return how steep places are across passes."""
    return np.asarray(np.abs(own[1] * math.cos(requested.angle) - own[0] * math.sin(requested.angle)))


def _wide(mask: Mask) -> Mask:
    """Return the places of a mask that are wide enough, whole."""
    import cv2

    square = np.ones((CELLS_WIDE, CELLS_WIDE), np.uint8)
    opened = cv2.morphologyEx(
        mask.astype(np.uint8), cv2.MORPH_OPEN, square, borderType=cv2.BORDER_CONSTANT, borderValue=0
    )
    count, labels = cv2.connectedComponents(mask.astype(np.uint8), connectivity=8)
    kept = np.zeros(count, np.bool_)
    kept[labels[opened.astype(bool)]] = True
    kept[0] = False
    return np.asarray(kept[labels])


def _level(requested: FamilyRequest) -> float:
    """Return how high ridges are on a level floor, mm."""
    return (
        requested.ridge
        if requested.ridge is not None
        else float(ridges(requested.requested.cutter, requested.spacing, np.zeros(1))[0])
    )


def _ridge(
    area: SurfaceGrid, over: Heights, mask: Mask, low: Heights, requested: Sequence[FamilyRequest]
) -> Ridge | None:
    """Return the highest ridge on the surfaces: of what is not left, and where the tools come down to them."""
    rise = np.hypot(*slopes(area.heights, area.grid.pitch))
    with np.errstate(invalid="ignore"):
        here = ~mask & np.isfinite(area.heights) & (low <= _lowest_cut(area, requested))
    if not here.any():
        return None
    square = np.where(here, over / np.hypot(1.0, rise), -np.inf)
    cell = int(np.argmax(square))
    row, col = divmod(cell, area.grid.cols)
    x, y = area.grid.place(cell)
    level = min(_level(each) for each in requested)
    return Ridge(max(float(square[row, col]), 0.0), x, y, math.degrees(math.atan(float(rise[row, col]))), level)


def _lowest_cut(area: SurfaceGrid, requested: Sequence[FamilyRequest]) -> Floats:
    """Return how low a tool that touches the surfaces in one place cuts there at most, mm, by cells."""
    leave = min(each.requested.leave for each in requested)
    rise = np.hypot(*slopes(area.heights, area.grid.pitch))
    return np.asarray(area.heights + leave * np.hypot(1.0, rise) + TOLERANCE)


def _at_rim(on: Mask, row: int, col: int, reach: int) -> bool:
    """Return whether there is no surface at some cell that is no more than so many cells away."""
    framed = np.pad(on, reach, constant_values=False)
    return not bool(framed[row : row + 2 * reach + 1, col : col + 2 * reach + 1].all())


def left_findings(left: SceneLeft, origin: Floats, angles: Sequence[float]) -> Iterator[Finding]:
    """Yield what there is to say of it, in the scene's coordinates.

    Args:
        origin: of the grid's coordinates in them. angles: of the families' planes, degrees.
    """
    x, y = left.x + float(origin[0]), left.y + float(origin[1])
    if left.places:
        count = "1 place" if left.places == 1 else f"{left.places} places"
        text = (
            f"{left.area_mm2:.3f} mm2 of metal that the same tool reaches is left in {count}, the worst "
            f"{left.worst_mm:.3f} mm high and {left.wide_mm:.3f} mm wide at {in_plane(x, y)}; "
            f"{_remedy(left, angles)}."
        )
        yield Finding(FindingKind.LEFT_REACHABLE, text, x, y, amount=left.area_mm2)
    ridge = left.ridge
    if ridge is not None and ridge.height_mm > BENT * ridge.level_mm + left.within_mm:
        text = (
            f"The ridges between passes are up to {ridge.height_mm:.3f} mm high, square to the surface, at "
            f"({ridge.x + origin[0]:.3f}, {ridge.y + origin[1]:.3f}), where it slopes by {ridge.slope_deg:.0f} "
            f"degrees; on a level floor they are {ridge.level_mm:.3f} mm; a smaller pitch, or passes across them, "
            "leaves less."
        )
        yield Finding(
            FindingKind.RIDGE,
            text,
            ridge.x + float(origin[0]),
            ridge.y + float(origin[1]),
            counts=False,
            amount=ridge.height_mm,
        )


def _remedy(left: SceneLeft, angles: Sequence[float]) -> str:
    if left.cut_short:
        return "let the passes go on beside the surfaces: leave overrun out, or make it the tool's radius"
    free = next(
        (
            turn
            for turn in (90.0, 45.0, 135.0)
            if all(abs((angle + turn - other) % 180.0) > 10.0 for angle in angles[:1] for other in angles)
        ),
        None,
    )
    across = f"add passes at angle_deg = {(angles[0] + free) % 180.0:g}, or " if free is not None else ""
    beyond = ", or let the surfaces go on there by the tool's radius" if left.at_rim else ""
    return f"{across}give the passes a smaller pitch{beyond}"
