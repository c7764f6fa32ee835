"""Inlays: a V-carved pocket and the plug that fits into it upside down, from one drawing and one tool.

The pocket's wall lies z tan a within the drawn line at the depth z; a is half the cutter's angle. Upside down, its
face at the depth t = depth - glue, the plug has to have the same wall: as deep below its face as y it is (t - y) tan a
within the line, and beyond t outside of it. That is a chamfer round the outside of the mirrored drawing, t tan a wide
on the top, whose tip goes as far on below the line as the plug is to stand out to be sawn off. A flat mill takes the
rest down to that depth. So corners fit as sharp as they are drawn: where the pocket's cone comes up into a corner, the
plug's goes round it.
"""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.errors import ParameterError
from ..core.progress import NO_PROGRESS, Progress
from ..gcode.posts import load_post
from ..geometry.distance import DistanceField
from ..geometry.outlines import polygon_contour
from ..geometry.primitives import contour_rows
from ..geometry.sample import Box
from ..geometry.transform import Similarity, transformed
from ..model.chamfer_operation import ChamferOperation
from ..model.curve_selectors import OnLayer
from ..model.finding import Finding, FindingKind
from ..model.job import Copies, Job, OriginXY, OriginZ
from ..model.operation import CutParameters, Operation, PocketOperation, Side
from ..model.part import Contour, Entity, Part
from ..model.stock_box import extent
from ..model.tool import Tool
from ..operations.vcarve.paths import RIDGE, flat_tool_of
from ..simulation.field.workpiece import Grid
from ..toolpath.drawn_contours import drawn_contours, selected
from .cutting.cut import CutOptions, CutProgram, cut
from .job.options import MakeOptions
from .job.plausible import read_for
from .making.make import MakeResult, export, job_from_drawing

SIDEWAYS = 0.005
"""mm beside a wall; by so much plug and pocket may overlap before it counts: wood gives way."""

_LEAST_OUT = 0.01
"""mm; what stands out by less cannot be sawn off."""

_PLUG, _BLOCK = "plug", "block"
"""Layers of the plug's drawing: its contours, and the block that it is made of."""

_CELLS = 768
"""Across the window in which pocket and plug are held against one another."""
_MIRROR = Similarity(-1 + 0j, 0j, mirrored=True)
"""x to -x."""


@dataclass(frozen=True)
class InlayOptions:
    """How plug and pocket fit.

    Attributes:
        glue: between the plug's face and the pocket's floor, mm, >= 0.
        gap: between the walls, sideways, mm, >= 0: at least half as wide as the cutter's flat tip.
        saw: how far the plug stands out of the pocket, mm, > 0.
    """

    glue: float = 0.3
    gap: float = 0.0
    saw: float = 1.0


@dataclass(frozen=True)
class InlayJobs:
    """The jobs of pocket and plug; the plug's drawing is mirrored, x to -x. `contours`: what the pocket is bounded by,
    which need not be all that is drawn; `face`: pocket's depth at which the plug's face comes to lie, mm; `rate`: mm
    sideways per mm of depth along the walls.
    """

    pocket: Job
    plug: Job
    contours: tuple[Contour, ...]
    face: float
    rate: float


@dataclass(frozen=True)
class InlayFit:
    """How plug and pocket fit, their programs read back and cut, one laid into the other, mm of height.

    Attributes:
        overlap: the most that both stand in one place, on islands of the pocket and round it, too; 0 = nowhere.
        walls: the most that is between them along the walls, without the gap that was asked for.
        floor: between the plug's face and the pocket's floor at least; None where there is no flat floor.
        bound: what overlaps at most along the walls, between the cells too: what is proven to be left on both.
        cell: side of the cells, mm.
    """

    overlap: float
    walls: float
    floor: float | None
    bound: float
    cell: float

    def summary(self) -> str:
        """Return it in a line."""
        floor = "" if self.floor is None else f", {self.floor:.4f} mm above the floor"
        return (
            f"plug in pocket: {self.overlap:.4f} mm overlap, {max(self.walls, 0.0):.4f} mm more than asked between the "
            f"walls{floor}; along the walls between the cells, too, at most {self.bound:.4f} mm overlap"
        )


@dataclass(frozen=True, eq=False)
class InlayPair:
    """A pocket, its plug, and how they fit."""

    pocket: MakeResult
    plug: MakeResult
    fit: InlayFit
    findings: tuple[Finding, ...]

    @property
    def clean(self) -> bool:
        """True where neither program has a finding that counts, and they fit."""
        return self.pocket.clean and self.plug.clean and not self.findings

    def files(self, base: Path) -> dict[Path, bytes]:
        """Return both programs by their files: the name of `base` with _pocket and _plug behind it."""
        files: dict[Path, bytes] = {}
        for word, made in (("pocket", self.pocket), ("plug", self.plug)):
            named = base.with_name(f"{base.stem}_{word}{load_post(made.job.post).extension}")
            files |= {file.named(named): file.nc.text.encode("ascii") for file in made.files}
        return files

    def values(self) -> dict[str, Any]:
        """Return everything that was measured."""
        fit = self.fit
        return {
            "fit": {
                "overlap_mm": fit.overlap,
                "between_walls_mm": fit.walls,
                "above_floor_mm": fit.floor,
                "walls_overlap_at_most_mm": fit.bound,
                "cell_mm": fit.cell,
                "method": "both programs, read back, cut on cells that lie upon one another, exactly at their centres; "
                "the bound is of what the proofs of both carvings leave",
            },
            "findings": [each.text for each in self.findings],
            "pocket": self.pocket.report.data,
            "plug": self.plug.report.data,
        }

    def report(self) -> bytes:
        """Return the same as JSON text."""
        return (json.dumps(self.values(), indent=2) + "\n").encode()


def inlay(
    name: str, data: bytes, options: MakeOptions, sizes: InlayOptions, progress: Progress = NO_PROGRESS
) -> InlayPair:
    """Return pocket and plug for the bytes of a drawing, and how they fit.

    Args:
        options: with a job that has one operation, a V-carving with its flat tool.

    Raises:
        HitofudeError: the drawing, the job or an option cannot be used.
        Cancelled: the job was asked to stop.
    """
    drawing = read_for(name, data, options)
    return inlay_of(job_from_drawing(drawing, options), sizes, progress, drawing.findings)


def inlay_of(
    job: Job,
    sizes: InlayOptions,
    progress: Progress = NO_PROGRESS,
    drawing_findings: tuple[Finding, ...] = (),
) -> InlayPair:
    """Return the pocket of a job and its plug, and how they fit; args and errors as `inlay`."""
    jobs = inlay_jobs(job, sizes)
    pocket = export(jobs.pocket, progress.part(0.0, 0.4), drawing_findings)
    plug = export(jobs.plug, progress.part(0.4, 0.8))
    fit = fit_of(pocket, plug, jobs, sizes, progress.part(0.8, 1.0))
    return InlayPair(pocket, plug, fit, tuple(_fit_findings(fit, jobs, sizes)))


def inlay_jobs(job: Job, sizes: InlayOptions) -> InlayJobs:
    """Return the jobs of pocket and plug.

    Args:
        job: of the pocket.

    Raises:
        ParameterError: it is no single V-carving with a flat tool, or what is asked does not go with it.
    """
    operation = _carving(job)
    tool, flat = job.cutter(operation), flat_tool_of(job, operation)
    assert flat is not None  # it was asked for
    rate, face = math.tan(tool.tip_angle / 2), operation.cut.depth - sizes.glue
    _check_sizes(sizes, operation.cut.depth, tool, rate)
    chosen = selected(drawn_contours(job), operation.cut.curves).closed
    box = extent(chosen)
    if box is None:
        raise ParameterError(f"{job.part.name}: there is no closed contour to inlay; draw one, or choose other curves.")
    depth = face + sizes.saw
    block = _block_round(box, tool.tip_diameter + 2 * depth * rate + 2 * flat.diameter)
    contours = [_mirrored(each) for each in chosen]
    around = PocketOperation(
        CutParameters(flat.number, depth, operation.cut.stepdown, stock_to_leave=sizes.saw * rate), open_edges=True
    )
    walls = ChamferOperation(
        CutParameters(tool.number, curves=(OnLayer(_PLUG),)),
        Side.OUTSIDE,
        face * rate + sizes.gap,
        sizes.saw - sizes.gap / rate,
    )
    pocket = replace(job, origin_xy=OriginXY.DRAWING, origin_z=OriginZ.TOP)
    plug = replace(
        pocket,
        part=_part([*((each, _PLUG) for each in contours), (block, _BLOCK)], f"{job.part.name} plug"),
        operations=(around, walls),
        stock=replace(job.stock, margin=0.0),
        copies=Copies(),
        layer_names=(),
        keep_out_layers=(),
        keep_out_height=0.0,
    )
    return InlayJobs(pocket, plug, tuple(chosen), face, rate)


def _check_sizes(sizes: InlayOptions, depth: float, tool: Tool, rate: float) -> None:
    """Refuse sizes that do not go with a pocket and its tool.

    Args:
        depth: of the pocket, mm. rate: mm of the cutter's radius a mm of its height.

    Raises:
        ParameterError: one does not.
    """
    if not 0 <= sizes.glue < depth:
        raise ParameterError(
            f"The glue is {sizes.glue:g} mm deep and the pocket {depth:g} mm; it must be 0 or more, and less than the "
            "pocket."
        )
    if sizes.gap < tool.tip_diameter / 2:
        raise ParameterError(
            f"The gap is {sizes.gap:g} mm, and the tip of T{tool.number} {tool.label} is {tool.tip_diameter:g} mm "
            f"wide, so that the plug would not go into narrow places; give it a gap of {tool.tip_diameter / 2:g} mm or "
            "more, or take a pointed cutter."
        )
    if sizes.saw - sizes.gap / rate < _LEAST_OUT:
        raise ParameterError(
            f"The plug is to stand out by {sizes.saw:g} mm, and with that gap it sinks in by {sizes.gap / rate:.3f} "
            "mm; let it stand out more."
        )


def _block_round(box: Box, room: float) -> Contour:
    """Return the block that a plug is made of, round the mirrored extent of the contours, mm."""
    x0, y0, x1, y1 = -box[2] - room, box[1] - room, -box[0] + room, box[3] + room
    return polygon_contour([(x0, y0), (x1, y0), (x1, y1), (x0, y1)])


def _carving(job: Job) -> Operation:
    enabled = [each for each in job.operations if each.cut.enabled]
    operation = enabled[0] if len(enabled) == 1 else None
    if operation is None or flat_tool_of(job, operation) is None:
        raise ParameterError(
            "An inlay is made of a job with one operation, a vcarve with its flat_tool; it makes the plug of that by "
            "itself."
        )
    return operation


def _mirrored(contour: Contour) -> Contour:
    return replace(contour, primitives=tuple(transformed(each, _MIRROR) for each in contour.primitives))  # type: ignore[misc]


def _part(contours: list[tuple[Contour, str]], name: str) -> Part:
    curves = [(curve, layer) for contour, layer in contours for curve in contour.primitives]
    entities = tuple(Entity(number, curve, layer) for number, (curve, layer) in enumerate(curves, 1))
    return replace(Part(layers=()).with_entities(entities), name=name)


def fit_of(
    pocket: MakeResult, plug: MakeResult, jobs: InlayJobs, sizes: InlayOptions, progress: Progress = NO_PROGRESS
) -> InlayFit:
    """Lay a plug into its pocket, both as their programs were read back and cut, and return how they fit.

    Raises:
        ParameterError: one of them was not cut.
        Cancelled: by progress.
    """
    box = extent(jobs.contours)
    if box is None or pocket.cut is None or plug.cut is None:
        raise ParameterError("Pocket or plug has no path, so there is nothing to fit.")
    x0, y0, x1, y1 = _in_whole_cells(box)
    below = _cells(pocket.cut, (x0, y0, x1, y1), progress.part(0.0, 0.5))
    above = _cells(plug.cut, (-x1, y0, -x0, y1), progress.part(0.5, 1.0))
    rows, cols = below.cut.heights.shape
    grid = below.cut.before.grid
    between = -jobs.face - above.cut.heights[:, ::-1].astype(np.float64) - below.cut.heights.astype(np.float64)
    x, y = grid.x0 + (np.arange(cols) + 0.5) * grid.pitch, grid.y0 + (np.arange(rows) + 0.5) * grid.pitch
    points = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    inset = _inset(jobs.contours, points).reshape(rows, cols)
    walls = (inset > 0) & (inset < jobs.face * jobs.rate)
    floor = inset > (jobs.face + sizes.glue) * jobs.rate + grid.pitch
    off = between[walls] - sizes.gap / jobs.rate if walls.any() else np.zeros(1)
    return InlayFit(
        max(0.0, -float(between.min())),
        float(off.max()),
        float(between[floor].min()) if floor.any() else None,
        max(0.0, _left(pocket) + _left(plug) - sizes.gap / jobs.rate),
        grid.pitch,
    )


def _in_whole_cells(box: Box) -> Box:
    """Return a box, x0, y0, x1, y1, made larger by as much as its cells are, so that those of its mirror image lie upon
    them, too.
    """
    grid = Grid.over(box, _CELLS)
    return grid.x0, grid.y0, grid.x0 + grid.cols * grid.pitch, grid.y0 + grid.rows * grid.pitch


def _cells(made: CutProgram, window: Box, progress: Progress) -> CutProgram:
    return cut(made.setup, CutOptions(_CELLS, window, trace=False, judge=False), progress)


def _inset(contours: Sequence[Contour], points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return how far points (n, 2) lie within contours, mm; negative outside of them."""
    field = DistanceField.of(np.concatenate([contour_rows(each) for each in contours]))
    return np.where(field.inside(points), 1.0, -1.0) * field.nearest(points)[0]


def _left(made: MakeResult) -> float:
    """Return what is proven to be left at most above the walls that were carved, mm of height."""
    carved = [each["carved"] for each in made.report.data["operations"] if each.get("carved")]
    return float(sum(each["left_mm"] + each["between_places_mm"] for each in carved))


def _fit_findings(fit: InlayFit, jobs: InlayJobs, sizes: InlayOptions) -> list[Finding]:
    """Return what counts of a fit."""
    most, found = SIDEWAYS / jobs.rate, []
    if fit.overlap > most:
        text = (
            f"Plug and pocket overlap by {fit.overlap:.4f} mm of height, so the plug does not go in; where the flat "
            "tool leaves corners of a floor standing, or narrow places round the plug, a smaller one helps, else give "
            "them more gap."
        )
        found.append(Finding(FindingKind.TOLERANCE, text, amount=fit.overlap))
    if fit.walls > most:
        text = f"Along the walls {fit.walls:.4f} mm of height more are open than asked for; the inlay is loose."
        found.append(Finding(FindingKind.TOLERANCE, text, amount=fit.walls))
    if fit.floor is not None and fit.floor < sizes.glue - most - 1.5 * RIDGE:  # of ridges that cross in corners
        text = f"Between plug and floor are {fit.floor:.4f} mm, and the glue was to have {sizes.glue:g} mm."
        found.append(Finding(FindingKind.TOLERANCE, text, amount=sizes.glue - fit.floor))
    return found
