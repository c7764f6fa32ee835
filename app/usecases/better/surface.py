"""From passes to a scene: what the tool touched, the facets it came from, the smooth surface through their corners."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import shapely

from ...core.errors import InputError
from ...core.progress import Progress
from ...fitting.point_surfaces.facet_corners import FacetCorners, ShapePlace, facet_corners
from ...fitting.point_surfaces.height_spline import (
    RIM,
    Box,
    FittedHeights,
    HeightSpline,
    HoldingPoints,
    fit_heights,
    have_places_round,
    rough_heights,
)
from ...model.motion import Floats
from ...model.scene import Boundary, Passes, Scene, SceneStock, Strategy, Surface
from ...model.scene_curves import SectionCurve
from ...model.scene_shapes import LoftShape
from ...model.stock_box import StockBox
from ...model.tool import Tool
from ...simulation.sweeps.probe import PathProbe
from .area import PassArea
from .raster import RasterProgram
from .result import SurfaceFigures

_MARGIN = 0.1
"""mm; the surface goes on so far beyond where the ball touches it on its outermost passes, so that none ends at its
edge.
"""
_SECTIONS = 3
"""Sections a span of the surface of heights: what a loft makes of them is off by a hundred-thousandth of the sag of
one.
"""
_MOST_SECTIONS = 160
"""Sections along either way of a surface, at most."""
_ENOUGH, _FEWEST, _ROUNDS = 4000, 64, 12
"""Points that say roughly where a surface is, and times that those above it are taken out."""
_HOPELESS = 3.0
"""Times what facets may be off."""
_CENTRES = 1e-4
"""mm; two places along one line nearer than that are one."""


@dataclass(frozen=True, eq=False)
class SurvivingPasses:
    """Passes without the points whose metal was cut deeper by others.

    Attributes:
        raster: they. left_out: how many points were. steepest: slope of their surface, about.
    """

    raster: RasterProgram
    left_out: int
    steepest: float


@dataclass(frozen=True, eq=False)
class SmoothedSurface:
    """The smooth surface behind a program's passes.

    Attributes:
        passes: of the program, without what was cut deeper later. box: that the surface is over.
        corners: what it goes by. fitted: heights of the tip over u, v.
        off: (n,) of each point how far the surface is from it, square to it, mm, > 0 above it.
    """

    passes: SurvivingPasses
    box: Box
    corners: FacetCorners
    fitted: FittedHeights
    off: Floats

    @property
    def raster(self) -> RasterProgram:
        """The passes that the surface is by."""
        return self.passes.raster

    @property
    def farthest_mm(self) -> float:
        """How far a point of the program is from the surface at most, square to it, mm."""
        return float(np.abs(self.off).max())

    @property
    def farthest_place(self) -> Floats:
        """Where that is, (3,) mm, program coordinates."""
        at = int(np.argmax(np.abs(self.off)))
        place: Floats = self.raster.frame.outwards(self.raster.points[at : at + 1])[0]
        return place

    @property
    def area(self) -> PassArea:
        """Where the passes are."""
        raster = self.raster
        return PassArea([raster.frame.outwards(row) for row in raster.rows], raster.pitch)

    @property
    def figures(self) -> SurfaceFigures:
        """What it is, in figures."""
        corners = self.corners
        return SurfaceFigures(
            len(self.raster.rows),
            corners.points,
            self.passes.left_out,
            corners.facets,
            ((len(corners.places), corners.kind.value),),
            (self.fitted.spans,),
            self.fitted.left_out_mm,
        )


def surviving(raster: RasterProgram, radius: float, heights: PathProbe, within: float) -> SurvivingPasses:
    """Return passes without the points whose metal was cut deeper by other moves.

    Args:
        raster: the passes of a ball of a radius, mm. heights: of the program as it was cut, at any point.
        within: what counts as deeper, mm.
    """
    rough, points = _lowest(raster, within), raster.points
    touched = contact(rough, points[:, :2], radius)
    touched[:, 2] += points[:, 2] - rough.heights(points[:, :2])
    left = heights.lowest(np.ascontiguousarray(raster.frame.outwards(touched)[:, :2])).heights
    kept = touched[:, 2] - left <= within
    rows, at = [], 0
    for row in raster.rows:
        own = row[kept[at : at + len(row)]]
        at += len(row)
        if len(own) > 1:
            rows.append(np.ascontiguousarray(own))
    if not rows:
        raise InputError("All of the passes' metal is cut deeper by other moves; nothing of their surface is left.")
    steepest = float(np.hypot(*rough.slopes(points[kept, :2]).T).max())
    return SurvivingPasses(replace(raster, rows=tuple(rows)), int(np.sum(~kept)), steepest)


def _lowest(raster: RasterProgram, within: float) -> HeightSpline:
    """Return a surface by the lowest of all points: good enough to say where the ball touches. Points above it are of
    passes that others went under, and are taken out until none is.
    """
    points = raster.points
    thin = points[:: max(1, len(points) // _ENOUGH)]
    for _ in range(_ROUNDS):
        rough = rough_heights(thin, box_of(points, _MARGIN))
        above = thin[:, 2] - rough.heights(thin[:, :2]) > within
        if not above.any() or np.sum(~above) < _FEWEST:
            break
        thin = thin[~above]
    return rough


@dataclass(frozen=True)
class FacetLimits:
    """What may be one facet, and how far facets may be from the surface behind them.

    Attributes:
        epsilons: points so near to one plane, mm: that one is taken which finds corners, else edges, else points, and
            of these the one whose places foretell one another best.
        off: mm.
    """

    epsilons: tuple[float, ...]
    off: float


def smooth_surface(passes: SurvivingPasses, radius: float, limits: FacetLimits, progress: Progress) -> SmoothedSurface:
    """Return the smooth surface through the corners of the facets that passes of a ball of a radius, mm, lie on.

    Raises:
        HitofudeError: there are too few points. Cancelled: the job was asked to stop.
    """
    box, count = box_of(passes.raster.points, _MARGIN + radius * min(passes.steepest, 1.0)), len(limits.epsilons)
    found = [
        _held(passes, facet_corners(passes.raster.rows, e), box, limits.off, progress.part(k / count, (k + 1) / count))
        for k, e in enumerate(limits.epsilons)
    ]
    within = [each for each in found if each.farthest_mm <= limits.off]
    if within:
        return min(within, key=lambda each: (list(ShapePlace).index(each.corners.kind), each.fitted.left_out_mm))
    return min(found, key=lambda each: each.farthest_mm)


def _held(passes: SurvivingPasses, corners: FacetCorners, box: Box, off: float, progress: Progress) -> SmoothedSurface:
    """Return the surface by corners. At the rim, where no facets meet, points hold it: as lightly as they may for it to
    be no farther from any point than it may. Where one is far off that has corners round it, no weight at the rim mends
    it.
    """
    points = passes.raster.points
    for rim in (RIM, 10 * RIM, 100 * RIM):
        fitted = fit_heights(corners.places, corners.weights, HoldingPoints(points, rim), box, progress)
        found = SmoothedSurface(passes, box, corners, fitted, _square_off(fitted, points))
        farthest = points[int(np.argmax(np.abs(found.off)))][None]
        hopeless = found.farthest_mm > _HOPELESS * off and have_places_round(corners.places, farthest)[0]
        if found.farthest_mm <= off or hopeless:
            break
    return found


def _square_off(fitted: FittedHeights, points: Floats) -> Floats:
    """Return how far a surface is from points (n, 3), square to it, mm, > 0 above them."""
    slopes = fitted.spline.slopes(points[:, :2])
    off: Floats = (fitted.spline.heights(points[:, :2]) - points[:, 2]) / np.sqrt(1 + (slopes**2).sum(axis=1))
    return off


def box_of(points: Floats, margin: float) -> Box:
    """Return the box round points (n, 3) and so much more, mm."""
    low, high = points[:, :2].min(axis=0) - margin, points[:, :2].max(axis=0) + margin
    return Box(float(low[0]), float(high[0]), float(low[1]), float(high[1]))


def contact(spline: HeightSpline, places: Floats, radius: float) -> Floats:
    """Return where a ball touches (n, 3) whose tip is over places (n, 2) of a surface of tips, mm: as far from its
    centre as its radius, against the surface's upward normal.
    """
    slopes = spline.slopes(places)
    size = np.sqrt(1 + (slopes**2).sum(axis=1))
    heights = spline.heights(places)
    return np.column_stack([places + radius * slopes / size[:, None], heights + radius - radius / size])


def surface_shape(smoothed: SmoothedSurface, radius: float) -> LoftShape:
    """Return what a ball touches on its way over a surface of tips as a loft: a section along each of many lines.

    Raises:
        InputError: the surface is bent more than the ball, so that no surface can be what it touches.
    """
    box, fitted = smoothed.box, smoothed.fitted
    counts = [min(_SECTIONS * spans + 1, _MOST_SECTIONS) for spans in fitted.spans]
    along = np.linspace(box.u0, box.u1, max(counts[0], 13))
    across = np.linspace(box.v0, box.v1, max(counts[1], 13))
    sections = []
    for v in across.tolist():
        places = np.column_stack([along, np.full(len(along), v)])
        touched = contact(fitted.spline, places, radius)
        if np.any(np.diff(touched[:, 0]) <= 0):
            x, y, _ = smoothed.raster.frame.outwards(touched[:1])[0].tolist()
            raise InputError(
                f"The passes near X{x:.3f} Y{y:.3f} bend upwards more than a ball of radius {radius:g} mm does, which "
                "is no way over a surface that it touches; check the tool's diameter."
            )
        points = smoothed.raster.frame.outwards(touched).round(6)
        sections.append(SectionCurve(points=tuple((x, y, z) for x, y, z in points.tolist())))
    return LoftShape(tuple(sections))


@dataclass(frozen=True)
class NewPasses:
    """How new passes are made.

    Attributes:
        pitch: from plane to plane, mm. chord: how far they may be above the true path, mm.
        post: in whose words they are written.
    """

    pitch: float
    chord: float
    post: str


def scene_of(name: str, smoothed: SmoothedSurface, tool: Tool, stock: StockBox, how: NewPasses) -> Scene:
    """Return a scene with a surface and passes over it where the old ones were.

    Args:
        name: of the scene. tool: a ball. stock: the block, program coordinates.
    """
    raster = smoothed.raster
    first = raster.frame.outwards(raster.rows[0][:1])[0]
    passes = Passes(
        tool.number,
        name="better",
        angle_deg=math.degrees(raster.frame.angle),
        through=(float(first[0]), float(first[1])),
        pitch=how.pitch,
        strategy=Strategy.ZIGZAG if raster.zigzag else Strategy.ONE_WAY,
        chord_tolerance=how.chord,
        boundary=_boundaries(raster),
        overrun=0.0,
    )
    box = (stock.x0, stock.y0, stock.z0, stock.x1, stock.y1, stock.z1)
    surface = Surface("smooth", surface_shape(smoothed, tool.radius))
    return Scene(name, (surface,), SceneStock(box), (tool,), (passes,), post=how.post)


def usual_pitch(raster: RasterProgram) -> float:
    """Return the distance of planes that meet the first and the last pass and are no farther apart than the passes
    usually are.
    """
    places = np.array([row[:, 1].mean() for row in raster.rows])
    wide = float(np.ptp(places))
    return wide / max(1, round(wide / raster.pitch))


def _boundaries(raster: RasterProgram) -> tuple[Boundary, ...]:
    """Return where the old passes were: a strip for each of them, half way to the next."""
    parts = [
        shapely.box(float(row[0, 0]), v - raster.pitch / 2, float(row[-1, 0]), v + raster.pitch / 2)
        for row in raster.rows
        for v in (float(row[:, 1].mean()),)
    ]
    area = shapely.union_all(parts, grid_size=_CENTRES / 10).simplify(_CENTRES / 10)
    whole = list(getattr(area, "geoms", [area]))
    if any(each.interiors for each in whole):
        whole = parts
    return tuple(Boundary(outline=_outline(raster, each)) for each in whole)


def _outline(raster: RasterProgram, area: shapely.Polygon) -> tuple[tuple[float, float], ...]:
    ring = np.array(area.exterior.coords)[:-1]
    turned = raster.frame.outwards(np.column_stack([ring, np.zeros(len(ring))]))
    return tuple((x, y) for x, y, _ in turned.tolist())
