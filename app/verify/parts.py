"""What is to come out of the metal: a drawing milled to depths, or a solid. What a cut is judged against."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import Geometry as Shape

from ..core.progress import NO_PROGRESS, Progress
from ..geometry.distance import DistanceField
from ..geometry.primitives import pack
from ..model.curves import Circle
from ..model.finding import Finding, FindingKind
from ..model.job import Job
from ..model.moves import Area, DogBone, Moves, Program, Tab
from ..model.part import Contour, Region
from ..model.stock_box import StockBox, extent
from ..model.tool_kind import ToolKind
from ..simulation.field.solid import SolidStock
from ..simulation.field.target import MARGIN, TargetHeights, beside, inside
from ..simulation.field.workpiece import Grid
from ..toolpath.build import MovesBuilder
from ..toolpath.coverage.areas import grown, region_shapes, united
from ..toolpath.coverage.floor_target import CHORD, FloorTarget, dog_bone_shape, floor_targets
from .verdict import OperationBound, bounds_of, followed_walls

if TYPE_CHECKING:
    from .solid_depth import DepthInSolid


TOLERANCE = 0.01
"""mm; metal within this of the part is neither gouged nor left."""


@dataclass(frozen=True, eq=False)
class FlatPart:
    """Regions of a drawing, sunk into the metal.

    Attributes:
        job: whose operations say how deep, how much stock is left on walls, and which tools are there; its part is the
            drawing.
        regions: that are machined, part coordinates; their walls are upright, and Z 0 is the part's top.
        origin: the program's zero, mm, part coordinates: program = part - origin.
        wall_tolerance: within which a wall counts as met, mm: what path and writing may be off.
        tolerance: of heights, mm.
        allowance: so thick a skin may paths made from pixels leave along the walls, mm.
        areas, lines, clamps, tabs, dog_bones: as of a `Program`.
        floors: what is to be cleared, where it is known already.
    """

    job: Job
    regions: tuple[Region, ...]
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)
    wall_tolerance: float = 0.002
    tolerance: float = TOLERANCE
    allowance: float = 0.0
    areas: tuple[Area, ...] = ()
    lines: tuple[Contour, ...] = ()
    clamps: tuple[Region, ...] = ()
    tabs: tuple[Tab, ...] = ()
    dog_bones: tuple[DogBone, ...] = ()
    floors: tuple[FloorTarget, ...] | None = None

    @cached_property
    def targets(self) -> tuple[FloorTarget, ...]:
        """What is to be cleared, the shallowest floor first."""
        return floor_targets(self.program(MovesBuilder().moves()), self.job) if self.floors is None else self.floors

    def program(self, moves: Moves) -> Program:
        """Return moves as a program that makes this part."""
        return Program(
            moves,
            self.regions,
            allowance_mm=self.allowance,
            areas=self.areas,
            lines=self.lines,
            clamps=self.clamps,
            tabs=self.tabs,
            dog_bones=self.dog_bones,
        )


@dataclass(frozen=True, eq=False)
class SolidPart:
    """A solid, program coordinates.

    Attributes:
        solid: closed.
        leave: stock to be left on all of its surface, mm, >= 0.
        tolerance: within which its surface counts as met, mm.
        block: what it is cut from, program coordinates, where it is surfaces seen from above: these may go on beyond
            it.
        allowance: so much more metal may stay on its surface, square to it, mm: how far paths may lie above theirs. It
            is taken off what is told to be left, and says nothing of gouges.
    """

    solid: SolidStock
    leave: float = 0.0
    tolerance: float = TOLERANCE
    block: StockBox | None = None
    allowance: float = 0.0
    _depths: list[DepthInSolid] = field(default_factory=list, init=False, repr=False)

    def depths(self, progress: Progress = NO_PROGRESS) -> DepthInSolid:
        """Return what tells how deep places lie in it, asked of its bodies together; made when somebody asks first.

        Raises:
            Cancelled: by progress.
        """
        from .solid_depth import DepthInSolid  # compiled code: loaded where it is used

        if not self._depths:
            self._depths.append(DepthInSolid(self.solid, self.leave, progress))
        return self._depths[0]


Part = FlatPart | SolidPart


def part_box(part: Part) -> StockBox | None:
    """Return the box round a part, program coordinates: what of it is machined, for a drawing; None where that is
    nothing.
    """
    if isinstance(part, SolidPart):
        low, high = part.solid.triangles.min(axis=(0, 1)).tolist(), part.solid.triangles.max(axis=(0, 1)).tolist()
        return StockBox(*low, *high)
    box = extent((*(contour for region in part.regions for contour in region.contours), *part.lines))
    if box is None:
        return None
    (x, y, z), depth = (
        part.origin,
        max((each.cut.depth for each in part.job.operations if each.cut.enabled), default=0.0),
    )
    return StockBox(box[0] - x, box[1] - y, -depth - z, box[2] - x, box[3] - y, -z)


def beyond(part: Part, stock: StockBox) -> Iterator[Finding]:
    """Yield how far a part reaches beyond its stock, if it does; a drawing's top and the metal under it do not count.

    Args:
        stock: the box round all of it, program coordinates.
    """
    box = part_box(part)
    if box is None or (isinstance(part, SolidPart) and part.block is not None):
        return
    sides = {"-X": stock.x0 - box.x0, "+X": box.x1 - stock.x1, "-Y": stock.y0 - box.y0, "+Y": box.y1 - stock.y1}
    if isinstance(part, SolidPart):
        sides |= {"-Z": stock.z0 - box.z0, "+Z": box.z1 - stock.z1}
    side, far = max(sides.items(), key=lambda item: item[1])
    if far > part.tolerance:
        text = (
            f"The part reaches {far:.3f} mm beyond the stock towards {side}, and there nothing can be judged; check "
            "the stock, and where the part's zero lies (its origin and units)."
        )
        yield Finding(FindingKind.BEYOND_STOCK, text, amount=far)


SMALL = 0.15
"""Of what a program cuts, along X and along Y: a part that is smaller was hardly meant."""


def doubtful_size(part: Part, cut: StockBox | None) -> Iterator[Finding]:
    """Yield that a solid is far smaller than what is cut, as one in inches that is read in mm; nothing is judged there.

    Args:
        cut: the box round all feed motions, program coordinates; None where there are none.
    """
    if cut is None or not isinstance(part, SolidPart) or part.block is not None:
        return
    box = part_box(part)
    assert box is not None
    wide, long = box.x1 - box.x0, box.y1 - box.y0
    if wide < SMALL * (cut.x1 - cut.x0) and long < SMALL * (cut.y1 - cut.y0):
        text = (
            f"The part is {wide:.3f} x {long:.3f} mm, and the program cuts {cut.x1 - cut.x0:.3f} x "
            f"{cut.y1 - cut.y0:.3f} mm: nearly all of that lies beside the part and is not judged; check the part's "
            "units, and whether it is the one that the program is for."
        )
        yield Finding(FindingKind.SIZE, text)


# The heights that a drawing milled to depths asks for.


Mask = NDArray[np.bool_]

Floats = NDArray[np.float64]

_AT_A_TIME = 4096
"""Parts of a shape whose outlines are looked at together."""

NO_MOVES = MovesBuilder().moves()


@dataclass(frozen=True, eq=False)
class FlatTarget:
    """Wanted heights, and which cells some tool of the job reaches, (rows, cols)."""

    target: TargetHeights
    reach: Mask


def flat_target(part: FlatPart, grid: Grid) -> FlatTarget:
    """Return the heights of a part over a grid, program coordinates.

    Within the walls and their stock to leave metal is wanted down to the floor; it is gouged below the deepest
    operation that may be there. Elsewhere the part's top is wanted, and what stands on it is not spoken of.
    """
    found, cells = part.targets, _Cells(part, grid)
    top, shape = np.float32(-part.origin[2]), (grid.rows, grid.cols)
    goal, low = np.full(shape, top, np.float32), np.full(shape, top, np.float32)
    high, reach = np.full(shape, np.inf, np.float32), np.zeros(shape, bool)
    slack, pockets = part.wall_tolerance + CHORD, any(each.whole for each in found)
    for each in found:  # from the shallowest to the deepest, which has the last word
        floor = top - np.float32(each.depth)
        mine = cells.within(each.floor)
        goal[mine if each.whole or not pockets else cells.within(each.target)] = floor
        within = cells.within(each.reach, -slack)
        if each.out_of_reach is not None:
            within &= ~cells.within(each.out_of_reach, slack)
        high[within if each.target is each.reach else cells.within(each.target, -slack)] = floor
        high[cells.within(each.beyond, -slack)] = floor
        reach[mine] = False  # what a tool reaches that does not go as deep is no reach here
        reach |= within
    for bound in bounds_of(part.program(NO_MOVES), part.job):
        if bound.carves:
            _carve(part, bound, FlatTarget(TargetHeights(grid, goal, low, high), reach))
            continue
        # drilled holes may cross, and cells are told inside by crossings of all outlines together
        mine = cells.within(united(region_shapes(bound.area.regions, CHORD)), slack - bound.leave)
        low[mine] = np.minimum(low[mine], top - np.float32(bound.floor))
        for dog_bone in part.dog_bones:
            near = cells.within(dog_bone_shape(dog_bone), slack)
            low[near] = np.minimum(low[near], top - np.float32(bound.floor))
    return FlatTarget(TargetHeights(grid, np.pad(goal, MARGIN, mode="edge"), low, high), reach)


def _carve(part: FlatPart, bound: OperationBound, target: FlatTarget) -> None:
    """Put in the slanted walls that a cone makes: as high as the nearest wall is far, divided by the cone's slope.

    What is left is spoken of where a pointed cone gets to the drawn depth; a flat tip leaves corners, and the middle of
    what is wider than the cone belongs to other tools.
    """
    if balls := _balls(part, bound):
        _carve_round(part, bound, balls, target)
        return
    cones = [tool for tool in part.job.tools if tool.number in bound.tools and tool.kind is ToolKind.V]
    if not cones:
        return
    grid, top = target.target.grid, np.float32(-part.origin[2])
    x = np.asarray(grid.x0 + (np.arange(grid.cols) + 0.5) * grid.pitch + part.origin[0], float)
    y = np.asarray(grid.y0 + (np.arange(grid.rows) + 0.5) * grid.pitch + part.origin[1], float)
    over = max(-bound.leave, 0.0)
    far = (_in_cones(x, y, bound, over) if bound.holes else _in_walls(x, y, bound)) + over  # from the cone's rim
    steepest = max(tool.profile.cone for tool in cones)
    depth = np.clip(far * steepest, 0.0, bound.floor)
    surface = (top - depth).astype(np.float32)
    inside = far > 0
    slack = np.float32(CHORD * steepest)
    low, high, goal = target.target.low, target.target.high, target.target.around
    low[inside] = np.minimum(low, surface - slack)[inside]
    spoken = inside & np.isinf(high)
    goal[spoken] = surface[spoken]
    if all(tool.tip_diameter == 0 for tool in cones) and len(cones) == 1:
        sharp = spoken & (depth < bound.floor)
        high[sharp] = surface[sharp] + slack
        target.reach[sharp] = True


def _balls(part: FlatPart, bound: OperationBound) -> list[float]:
    """Return the radii of the balls that carve what a bound speaks of, mm."""
    tools = {part.job.operations[k].cut.tool for k in bound.operations}
    return [tool.radius for tool in part.job.tools if tool.number in tools and tool.kind is ToolKind.BALL]


def _carve_round(part: FlatPart, bound: OperationBound, balls: list[float], target: FlatTarget) -> None:
    """Put in the hollow edges that a ball makes which goes so deep, as far over the drawn lines as the bound says.

    Its axis comes to all places that are as far from the walls as its width at the surface less that; how far a cell
    is from these is how far from the axis the ball cuts it.
    """
    grid, top = target.target.grid, np.float32(-part.origin[2])
    x = np.asarray(grid.x0 + (np.arange(grid.cols) + 0.5) * grid.pitch + part.origin[0], float)
    y = np.asarray(grid.y0 + (np.arange(grid.rows) + 0.5) * grid.pitch + part.origin[1], float)
    radius, over = max(balls), max(-bound.leave, 0.0)
    above = radius - bound.floor
    wide = float(np.sqrt(radius**2 - above**2))
    far = _in_walls(x, y, bound) + over
    apart = _off_axes(x, y, bound, wide - over)

    def height(off: Floats) -> NDArray[np.float32]:
        return np.minimum(above - np.sqrt(np.maximum(radius**2 - off**2, 0.0)), 0.0).astype(np.float32) + top

    inside, slack = far > 0, 2 * CHORD
    low, high, goal = target.target.low, target.target.high, target.target.around
    low[inside] = np.minimum(low, height(np.maximum(apart - slack, 0.0)))[inside]
    spoken = inside & np.isinf(high) & (apart < wide)
    goal[spoken] = height(apart)[spoken]
    edge = spoken & (far < wide)
    high[edge] = height(np.minimum(apart + slack, radius))[edge]
    target.reach[edge] = True


def _off_axes(x: Floats, y: Floats, bound: OperationBound, off: float) -> Floats:
    """Return (rows, cols) how far places are from all that is so far from an area's walls, mm; 0 within it, inf where
    there is nothing.
    """
    shapes = shapely.get_parts(grown(united(region_shapes(bound.area.regions, CHORD)), -off, CHORD))
    rings = [np.asarray(shapely.get_coordinates(ring)) for ring in shapely.get_rings(shapes)]
    if not rings:
        return np.full((len(y), len(x)), np.inf)
    rows = np.zeros((sum(len(ring) - 1 for ring in rings), 8))
    rows[:, :4] = np.concatenate([np.hstack([ring[:-1], ring[1:]]) for ring in rings])
    field = DistanceField.of(rows)
    centres = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    far = np.where(field.inside(centres), 0.0, field.nearest(centres)[0])
    return np.asarray(far.reshape(len(y), len(x)))


def _in_walls(x: Floats, y: Floats, bound: OperationBound) -> Floats:
    """Return (rows, cols) how far inside the followed walls of an area places are, mm; < 0: so far outside."""
    centres = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    inner = DistanceField.of(pack(bound.area.regions).rows).inside(centres)
    far = DistanceField.of(followed_walls(bound.area).rows).nearest(centres)[0]
    return np.where(inner, far, -far).reshape(len(y), len(x))


def _in_cones(x: Floats, y: Floats, bound: OperationBound, over: float) -> Floats:
    """Return (rows, cols) how far inside a circle places are, mm, the one that holds most of them where circles cross;
    -inf where none is within `over`.
    """
    far = np.full((len(y), len(x)), -np.inf)
    for hole in (each for region in bound.area.regions for each in region.boundary.primitives):
        assert isinstance(hole, Circle)
        (middle, across), wide = hole.centre, hole.radius + over
        columns = slice(*np.searchsorted(x, (middle - wide, middle + wide)))
        rows = slice(*np.searchsorted(y, (across - wide, across + wide)))
        apart = np.hypot(x[columns] - middle, (y[rows] - across)[:, None])
        far[rows, columns] = np.maximum(far[rows, columns], hole.radius - apart)
    return far


@dataclass(frozen=True, eq=False)
class _Cells:
    """The cells of a grid, program coordinates, that lie in shapes of a part."""

    part: FlatPart
    grid: Grid

    def within(self, shape: Shape | NDArray[np.object_], by: float = 0.0) -> Mask:
        """Return (rows, cols) which cells' centres lie in a shape, or in several that do not overlap: in all that
        comes within `by` mm of it, or, where that is negative, in what of its parts is deeper inside.
        """
        parts = shapely.get_parts(shape)
        if abs(by) > self.grid.pitch:  # cells near edges would be too many
            parts, by = shapely.get_parts(grown(parts, by, CHORD)), 0.0
        held, near = np.zeros((2, self.grid.rows, self.grid.cols), bool)
        for first in range(0, len(parts), _AT_A_TIME):
            some = shapely.get_rings(parts[first : first + _AT_A_TIME])
            rings = [shapely.get_coordinates(ring)[:-1] - self.part.origin[:2] for ring in some]
            held ^= inside(self.grid, rings)
            if by:
                near |= beside(self.grid, rings, abs(by))
        return held | near if by > 0 else held & ~near
