"""A scene from its text to tool paths over its surfaces: the compound surface, the cutters' paths, all told apart by
surface.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely
from numpy.typing import NDArray

from ...core.effort import Reckoning, announce
from ...core.errors import GeometryError, ParameterError
from ...core.progress import NO_PROGRESS, Progress
from ...gcode.posts import load_post
from ...geometry.buffer import buffered
from ...model.finding import Finding
from ...model.job import Job, OriginXY, OriginZ
from ...model.part import Part
from ...model.scene import Boundary, CentreLimit, Passes, Scene
from ...model.scene_curves import SceneFiles
from ...model.stock_box import StockBox
from ...model.tool import Tool
from ...operations.parallel.surface_moves import PassFamily, SurfaceMoves, surface_moves
from ...surfaces.cutter_contact.scene_facets import SceneFacets, region_area, scene_facets
from ...surfaces.passes.facet_crossings import FacetCrossings, facet_crossings
from ...surfaces.passes.path import Follower, FollowOptions, Overrun, cutter_path
from ...surfaces.passes.scallop import corner_radius, scallop_planes, stepover_for_scallop
from ...surfaces.patches.build import BuiltSurface, build, regions_of
from ...surfaces.patches.facets import SurfaceFacets, joined
from ...surfaces.sections.compound import CompoundSurface, CuttingPlanes
from ...surfaces.sections.planes import even_planes, widened
from ...surfaces.sections.section import compound_surface
from .findings import floor_findings, moves_findings, scene_findings
from .plane_rules import expanded

FLOOR = "floor"
"""Name of what a tool is on where it stays at the lowest height that it may have."""


@dataclass(frozen=True, eq=False)
class ComputedFamily:
    """One family of passes, computed.

    Attributes:
        passes: as the scene has it. tool: with the feeds and the speed that the passes ask for.
        surface: the compound surface on its planes. path: of the cutter.
        follower: that made the path, for proofs; it numbers surfaces in an order of its own.
        area: where the cutter's centre may be; None: anywhere.
    """

    passes: Passes
    tool: Tool
    surface: CompoundSurface
    path: CompoundSurface
    follower: Follower
    area: shapely.Geometry | None = None

    @property
    def planes(self) -> CuttingPlanes:
        """Its cutting planes."""
        return self.path.planes

    def numbered(self, numbers: NDArray[np.int64]) -> ComputedFamily:
        """Return it with other numbers of surfaces: `numbers[k]` for k."""
        return replace(self, surface=self.surface.numbered(numbers), path=self.path.numbered(numbers))


@dataclass(frozen=True, eq=False)
class ComputedScene:
    """A scene, computed.

    Attributes:
        scene: what was computed. built: its surfaces, made. facets: of those that are machined.
        families: of the passes that are switched on, in the order of cutting.
        moves: of all of them; `moves.surface` counts the scene's surfaces.
        stock: the block. origin: the work origin in the scene's coordinates, mm: NC = scene - origin.
        grid: of the coordinates that are written, mm.
        findings: what is wrong with the surfaces, their place, and where the tools go.
    """

    scene: Scene
    built: tuple[BuiltSurface, ...]
    facets: SceneFacets
    families: tuple[ComputedFamily, ...]
    moves: SurfaceMoves
    stock: StockBox
    origin: tuple[float, float, float]
    grid: float
    findings: tuple[Finding, ...] = ()

    @property
    def names(self) -> tuple[str, ...]:
        """Of the surfaces, by number; behind them that of the floor."""
        return (*(surface.name for surface in self.scene.surfaces), FLOOR)


def compute(scene: Scene, sources: SceneFiles, progress: Progress = NO_PROGRESS) -> ComputedScene:
    """Compute all passes of a scene that are switched on.

    Raises:
        HitofudeError: a surface cannot be made, or passes cannot be computed. Cancelled: the job was asked to stop.
    """
    context = _resolved(scene, sources, progress.part(0.0, 0.15))
    requested = [single for passes in scene.passes if passes.enabled for single in expanded(passes)]
    plans = [_plan(context, passes) for passes in requested]
    tools = [plan.tool for plan in plans]
    progress.step(0.15, "Looking for holes")
    found = tuple(scene_findings(context.built, context.facets.facets, context.stock, tools))
    announce(scene_effort(facet_crossings(context.facets.facets, plan.planes) for plan in plans), progress)
    families = [
        _family(context, plan, progress.part(0.15 + 0.75 * k / len(plans), 0.15 + 0.75 * (k + 1) / len(plans)))
        for k, plan in enumerate(plans)
    ]
    progress.step(0.9, "Joining passes")
    top = max(context.stock.z1, float(context.facets.facets.triangles[:, :, 2].max()))
    moves = surface_moves([_milling(family) for family in families], top + scene.safe_z, top + scene.retract_z)
    return ComputedScene(
        scene,
        context.built,
        context.as_listed(),
        tuple(families),
        moves,
        context.stock,
        context.origin,
        context.grid,
        (
            *found,
            *moves_findings(moves, context.stock, tools),
            *floor_findings(moves, [each.passes for each in families]),
        ),
    )


@dataclass(frozen=True, eq=False)
class _SceneContext:
    """What all passes of a scene are computed with, resolved once.

    Attributes:
        built: its surfaces, made.
        order: of these, by name: what surfaces coincide is told by names, not by the order of the scene.
        facets: of the surfaces in this order.
        stock, origin, grid: as a ComputedScene has them.
        sources: reads the files that the scene names.
    """

    scene: Scene
    built: tuple[BuiltSurface, ...]
    order: tuple[int, ...]
    facets: SceneFacets
    stock: StockBox
    origin: tuple[float, float, float]
    grid: float
    sources: SceneFiles

    @property
    def numbers(self) -> NDArray[np.int64]:
        """Number in the scene of each surface in the order of the facets; behind them that of the floor."""
        return np.array([*self.order, len(self.built)])

    def as_listed(self) -> SceneFacets:
        """Return the facets, their surfaces numbered as in the scene."""
        facets, numbers = self.facets, self.numbers
        trimmed, uncut = (replace(each, owner=numbers[each.owner]) for each in (facets.facets, facets.uncut))
        return SceneFacets(trimmed, uncut, {self.order[number]: area for number, area in facets.areas.items()})


def _resolved(scene: Scene, sources: SceneFiles, progress: Progress) -> _SceneContext:
    """Make the surfaces of a scene, and find stock, origin and the grid of what is written."""
    built = build(scene, sources, progress.part(0.0, 1 / 3))
    order = tuple(sorted(range(len(built)), key=lambda k: built[k].surface.name))
    facets = scene_facets([built[k] for k in order], progress=progress.part(1 / 3, 1.0))
    stock = stock_of(scene, facets.facets)
    digits = load_post(scene.post).digits(scene.out_units)
    grid = scene.out_units.value * 10.0 ** -min(digits.X, digits.Y, digits.Z)
    x, y, z = (round(value / grid) * grid for value in origin_of(scene, stock))
    return _SceneContext(scene, built, order, facets, stock, (x, y, z), grid, sources)


def stock_of(scene: Scene, facets: SurfaceFacets) -> StockBox:
    """Return the block: as the scene gives it, or the surfaces' extent and the margin round it."""
    if scene.stock.box:
        return StockBox(*scene.stock.box)
    low, high, margin = facets.triangles.min(axis=(0, 1)), facets.triangles.max(axis=(0, 1)), scene.stock.margin
    return StockBox(*(low - margin).tolist(), *(high + margin).tolist())


def origin_of(scene: Scene, stock: StockBox) -> tuple[float, float, float]:
    """Return the work origin in the scene's coordinates, mm."""
    x, y = {
        OriginXY.DRAWING: (0.0, 0.0),
        OriginXY.LOWER_LEFT: (stock.x0, stock.y0),
        OriginXY.CENTRE: ((stock.x0 + stock.x1) / 2, (stock.y0 + stock.y1) / 2),
    }[scene.origin_xy]
    z = 0.0 if scene.origin_z is None else (stock.z1 if scene.origin_z is OriginZ.TOP else stock.z0)
    return x, y, z


@dataclass(frozen=True, eq=False)
class _PlannedPasses:
    """A family of passes before it is computed: with what tool, on which planes, how far beside the surfaces."""

    passes: Passes
    tool: Tool
    overrun: Overrun
    planes: CuttingPlanes


def _plan(context: _SceneContext, passes: Passes) -> _PlannedPasses:
    tool = _tool(context.scene, passes)
    facets = context.facets.facets
    overrun = _overrun(passes, tool, context.stock, facets.triangles[:, :, :2].reshape(-1, 2))
    return _PlannedPasses(passes, tool, overrun, _planes(facets, passes, tool, overrun.far))


def _family(context: _SceneContext, plan: _PlannedPasses, progress: Progress) -> ComputedFamily:
    """Compute one family of passes."""
    passes, tool, facets = plan.passes, plan.tool, context.facets
    below = facets.facets
    if passes.floor is not None:
        below = _with_floor(below, passes.floor, len(context.built), plan.overrun.far + tool.radius)
    follower = Follower(below, tool, FollowOptions(passes.stock_to_leave, passes.chord_tolerance, context.grid))
    area = _area(passes.boundary, tool, context.sources)
    path = cutter_path(follower, plan.planes, area, progress.part(0.0, 0.7), plan.overrun)
    if not path.runs:
        name = passes.name or f"with T{tool.number}"
        raise GeometryError(f"passes {name} touch no surface; check their boundary and the surfaces' trims.")
    surface = compound_surface(facets.uncut, path.planes, passes.chord_tolerance, facets.areas, progress.part(0.7, 1.0))
    return ComputedFamily(passes, tool, surface, path, follower, area).numbered(context.numbers)


def _planes(facets: SurfaceFacets, passes: Passes, tool: Tool, far: float) -> CuttingPlanes:
    """Return the planes of passes, those within `far` mm beside the surfaces among them."""
    places = facets.triangles[:, :, :2].reshape(-1, 2)
    if passes.pitch is not None:
        planes = even_planes(passes.origin, passes.angle, passes.pitch, places)
    else:
        planes = scallop_planes(facets, tool, passes.scallop or 0.0, passes.origin, passes.angle)
    return widened(planes, places, far, _step(passes, tool)) if far > 0 else planes


def _overrun(passes: Passes, tool: Tool, stock: StockBox, places: NDArray[np.float64]) -> Overrun:
    """Return how far passes leave the surfaces' box: as far as the tool still touches one, and metal is in its way."""
    far = tool.radius if passes.overrun is None else passes.overrun
    box = stock.x0 - tool.radius, stock.y0 - tool.radius, stock.x1 + tool.radius, stock.y1 + tool.radius
    return Overrun(far, places, box, stock.z0)


def _step(passes: Passes, tool: Tool) -> float:
    """Return how far apart passes are beside the surfaces, mm."""
    if passes.pitch is not None:
        return passes.pitch
    return stepover_for_scallop(corner_radius(tool), passes.scallop or 0.0)


def _tool(scene: Scene, passes: Passes) -> Tool:
    """Return the passes' tool with their feeds and speed."""
    tool = scene.tool(passes.tool)
    own = {
        name: value
        for name in ("feed_rate", "plunge_rate", "spindle_speed")
        if (value := getattr(passes, name)) is not None
    }
    return replace(tool, **own)


def _with_floor(facets: SurfaceFacets, floor: float, number: int, far: float) -> SurfaceFacets:
    """Return facets with a level one below everything, as wide as a tool comes on planes of any direction.

    Args:
        far: beside the surfaces, mm, its radius among it.
    """
    if not math.isfinite(floor):
        raise ParameterError("The floor is no number; give a height in mm.")
    places = facets.triangles[:, :, :2]
    low, high = places.min(axis=(0, 1)), places.max(axis=(0, 1))
    # a rectangle round the box, turned by any angle, and `far` more at each of its sides: so far its corners may be
    reach = math.sqrt(2) * (math.dist(low, high) / 2 + far)
    (x0, y0), (x1, y1) = ((low + high) / 2 - reach).tolist(), ((low + high) / 2 + reach).tolist()
    a, b, c, d = ([x, y, floor] for x, y in ((x0, y0), (x1, y0), (x1, y1), (x0, y1)))
    return joined([facets, SurfaceFacets.of_mesh(np.array([[a, b, c], [a, c, d]]), number)])


def _area(boundaries: Sequence[Boundary], tool: Tool, sources: SceneFiles) -> shapely.Geometry | None:
    """Return where the cutter's centre may be."""
    if not boundaries:
        return None
    parts = []
    for boundary in boundaries:
        area = region_area(regions_of(boundary, sources))
        parts.append(buffered(area, -tool.radius, 64) if boundary.centre is CentreLimit.INSIDE else area)
    return shapely.union_all(parts)


def _milling(family: ComputedFamily) -> PassFamily:
    passes, offsets = family.passes, family.planes.offsets
    widest = max(np.diff(offsets).max() if len(offsets) > 1 else 0.0, 0.0)
    gap = passes.link_gap if passes.link_gap is not None else max(1.5 * float(widest), family.tool.diameter)
    return PassFamily(family.path, family.follower, family.tool, passes.strategy, gap)


def job_of(scene: Scene, tools: Mapping[int, Tool] | None = None) -> Job:
    """Return a job with a scene's name, tools and way of writing, and without a drawing."""
    return Job(
        Part(name=scene.name),
        tools=tuple((tools or {}).get(tool.number, tool) for tool in scene.tools),
        operations=(),
        safe_z=scene.safe_z,
        retract_z=scene.retract_z,
        post=scene.post,
        out_units=scene.out_units,
        exact_path=scene.exact_path,
    )


_CROSSING_S = 1.1e-4
"""A facet that a plane of passes crosses: contact, path, compound surface, text and proof; measured on scenes of 1,500
to 120,000 moves.
"""


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
