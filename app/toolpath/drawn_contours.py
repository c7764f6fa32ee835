"""What of a drawing a job machines: contours of its layers, its copies, open lines, and the clamps that no tool may
touch.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import shapely
import shapely.affinity
from numpy.typing import NDArray

from ..core import tolerances
from ..core.errors import ParameterError
from ..geometry.chaining.chain import chain
from ..geometry.even_odd import even_odd
from ..geometry.overlay.overlay import without_crossings
from ..geometry.primitives import contour_rows, sample, signed_area
from ..geometry.region import holders, reversed_contour
from ..model.curve_selectors import CurveNumber, OnLayer, Selector, layer_names
from ..model.curves import Arc, Circle, Line, Point, Primitive
from ..model.finding import Finding, FindingKind
from ..model.job import Job
from ..model.notes import Mark, Note
from ..model.part import Contour, Region
from ..model.stock_box import extent
from .text_strokes import strokes_of
from .witness import chaining_findings

_CHORD = 1e-3
"""mm; arcs as chords within this, where it is asked what lies in what."""


@dataclass(frozen=True)
class DrawnContours:
    """The contours of a job, copies and all.

    Attributes:
        closed: contours of the wanted layers.
        open: lines that are not closed, and all strokes of letters.
        crossing: True where closed ones may cross, themselves or one another.
        clamps: what closed outlines of keep-out layers hold, one region an outline, without islands; they may overlap.
            Not copied.
        findings: about the drawing.
    """

    closed: tuple[Contour, ...] = ()
    open: tuple[Contour, ...] = ()
    crossing: bool = False
    clamps: tuple[Region, ...] = ()
    findings: tuple[Finding, ...] = ()

    @cached_property
    def holders(self) -> list[list[int]]:
        """Which closed contours lie round each closed one, by their indices."""
        return holders(self.closed)

    @cached_property
    def inner(self) -> frozenset[int]:
        """The identities of the closed contours that lie in another closed one."""
        return frozenset(id(each) for each, held in zip(self.closed, self.holders, strict=True) if held)


def layers_of(job: Job) -> frozenset[str]:
    """Return the names of the layers that a job machines.

    Raises:
        ParameterError: a layer of an operation, or a keep-out layer, is not in the drawing, or a layer is both.
    """
    known = {layer.name for layer in job.part.layers}
    visible = {layer.name for layer in job.part.layers if layer.visible}
    requested = {name for each in job.operations if each.cut.enabled for name in layer_names(each.cut.curves)}
    for name in (*job.keep_out_layers, *sorted(requested)):
        if name not in known:
            raise ParameterError(f"The drawing has no layer '{name}'; it has {', '.join(sorted(known)) or 'none'}.")
    for name in job.keep_out_layers:
        if name in requested or name in job.layer_names:
            raise ParameterError(f"Layer '{name}' is to be machined and to be kept off; take it out of one of the two.")
    return frozenset(((set(job.layer_names) or visible) | requested) - set(job.keep_out_layers))


def drawn_contours(job: Job) -> DrawnContours:
    """Return what a job machines of its drawing.

    Raises:
        ParameterError: it names a layer that the drawing does not have.
    """
    layers = layers_of(job)
    entities = [e for e in job.part.entities if e.layer in layers and not e.lettering]
    chaining = chain(entities, job.join_tolerance)
    strokes, about_strokes = strokes_of(
        [e for e in job.part.entities if e.layer in layers and e.lettering], job.join_tolerance
    )
    closed = [contour for contour in chaining.contours if contour.closed] + _point_holes(job, layers)
    lines = [contour for contour in chaining.contours if not contour.closed]
    doubts = chaining_findings(entities, chaining, job.join_tolerance)
    clamps, about = clamps_of(job)
    meet = _copies_meet(closed, job)
    crossing = bool(meet) or _crosses(chaining.findings)
    shifts = job.copies.shifts
    copies = _copied(closed, shifts)
    findings = (*chaining.findings, *doubts, *about, *meet, *_under_clamps(copies, clamps), *about_strokes)
    return DrawnContours(copies, _copied([*lines, *strokes], shifts), crossing, clamps, findings)


def _point_holes(job: Job, layers: frozenset[str]) -> list[Contour]:
    """Return a circle at each drawn point for every width of the tools of operations that take points, once a place."""
    points = [(note, note.shape.at) for note in job.part.notes if isinstance(note.shape, Mark) and note.layer in layers]
    taking = [each for each in job.operations if each.cut.enabled and each.takes_points]
    if not points or not taking:
        return []
    found: dict[tuple[Point, float], Contour] = {}
    for operation in taking:
        radius = job.tool(operation.cut.tool).radius
        for note, at in points:
            if _names(operation.cut.curves, note):
                found.setdefault((at, radius), Contour((Circle(at, radius),), True, note.layer, (note.id,)))
    return list(found.values())


def _names(curves: Sequence[Selector], note: Note) -> bool:
    """Tell whether selectors take a point in: by its number, by its layer, or because there are none."""
    return not curves or any(each in (CurveNumber(note.id), OnLayer(note.layer)) for each in curves)


def _crosses(findings: Sequence[Finding]) -> bool:
    return any(finding.kind is FindingKind.SELF_INTERSECTION for finding in findings)


def clamps_of(job: Job) -> tuple[tuple[Region, ...], list[Finding]]:
    """Return what the outlines of keep-out layers hold, and what is to say about them.

    An outline holds all that is in it: a bolt that is drawn inside of a clamp is no hole in it, and where two clamps
    lie over one another is no gap between them.
    """
    requested = set(job.keep_out_layers)
    if not requested:
        return (), []
    entities = [e for e in job.part.entities if e.layer in requested and not e.lettering]
    chaining = chain(entities, job.join_tolerance)
    closed = [contour for contour in chaining.contours if contour.closed]
    findings = [
        Finding(
            FindingKind.OPEN_CONTOUR,
            f"An outline of keep-out layer '{contour.layer}' is open at ({x:.3f}, {y:.3f}), "
            "so it keeps nothing out; close it.",
            x,
            y,
            entity_ids=contour.entity_ids,
        )
        for contour in chaining.contours
        if not contour.closed
        for x, y in [contour.primitives[-1].end]
    ]
    if not closed:
        findings.append(
            Finding(FindingKind.LEFT_OUT, f"Keep-out layers {', '.join(job.keep_out_layers)} have no closed outline.")
        )
    if _crosses(chaining.findings):
        plain = [without_crossings([contour]) for contour in closed]
        closed = [part for each in plain for part in each.contours]
        findings += [finding for each in plain for finding in each.findings]
    findings += chaining_findings(entities, chaining, job.join_tolerance)
    return outermost(closed), findings


def outermost(contours: Sequence[Contour]) -> tuple[Region, ...]:
    """Return what each contour holds, all of it, but for those of which another one holds all, exactly."""
    areas = np.array([abs(signed_area(contour_rows(each))) for each in contours])
    around = np.array([extent([each]) for each in contours]).reshape(-1, 4)

    def is_held(k: int) -> bool:
        wide = (around[:, :2] <= around[k, :2] + _CHORD).all(axis=1) & (around[:, 2:] >= around[k, 2:] - _CHORD).all(
            axis=1
        )
        larger = (areas > areas[k]) | ((areas == areas[k]) & (np.arange(len(areas)) < k))
        left = (even_odd([contours[k]], [contours[j]]) for j in np.flatnonzero(wide & larger).tolist())
        return any(each.area <= each.length * tolerances.WELD for each in left)

    kept = [each for k, each in enumerate(contours) if areas[k] > 0 and not is_held(k)]
    return tuple(
        Region(number, each if signed_area(contour_rows(each)) > 0 else reversed_contour(each))
        for number, each in enumerate(kept, 1)
    )


def boxes_near(contours: Sequence[Contour], others: Sequence[Contour]) -> list[int]:
    """Return which contours (indices, rising) have boxes that come within 1 um of the box of another."""
    if not contours or not others:
        return []
    mine, theirs = (shapely.box(*np.array([extent([each]) for each in some]).T) for some in (contours, others))
    found: list[int] = np.unique(shapely.STRtree(theirs).query(mine, predicate="dwithin", distance=_CHORD)[0]).tolist()
    return found


def filled(contours: Sequence[Contour]) -> NDArray[np.object_]:
    """Return what contours hold, as polygons (n,)."""
    rings = [sample(contour_rows(contour), _CHORD) for contour in contours]
    shapes = [shapely.make_valid(shapely.Polygon(ring)) if len(ring) > 2 else shapely.Polygon() for ring in rings]
    found = np.empty(len(shapes), dtype=object)
    found[:] = shapes
    return found


def _under_clamps(contours: Sequence[Contour], clamps: Sequence[Region]) -> list[Finding]:
    """Return what is not machined because clamps lie over it."""
    if not clamps or not contours:
        return []
    held = shapely.union_all(filled([clamp.boundary for clamp in clamps]))
    near = boxes_near(contours, [clamp.boundary for clamp in clamps])
    shapes = filled([contours[k] for k in near])
    shapely.prepare(held)
    inside = shapely.covers(held, shapes)
    whole = [contours[k] for k, under in zip(near, inside.tolist(), strict=True) if under]
    findings = []
    if whole:
        x, y = whole[0].primitives[0].start
        what = "The contour that begins" if len(whole) == 1 else f"{len(whole)} contours, of which the first begins"
        text = (
            f"{what} at ({x:.3f}, {y:.3f}) {'lies' if len(whole) == 1 else 'lie'} wholly under clamps, and nothing "
            "is machined there."
        )
        ids = tuple(dict.fromkeys(number for contour in whole for number in contour.entity_ids))
        findings.append(Finding(FindingKind.LEFT_OUT, text, x, y, entity_ids=ids, amount=float(len(whole))))
    partly = int(np.sum(~inside & shapely.intersects(held, shapely.boundary(shapes))))
    if partly:
        text = (
            f"Clamps lie over parts of {partly} {'contour' if partly == 1 else 'contours'}; what is under them is "
            "not machined."
        )
        findings.append(Finding(FindingKind.LEFT_OUT, text, counts=False, amount=float(partly)))
    return findings


def moved(primitive: Primitive, dx: float, dy: float) -> Primitive:
    """Return a line, arc or circle moved by (dx, dy), mm."""

    def at(point: Point) -> Point:
        return point[0] + dx, point[1] + dy

    if isinstance(primitive, Line):
        return Line(at(primitive.start), at(primitive.end))
    if isinstance(primitive, Circle):
        return Circle(at(primitive.centre), primitive.radius, primitive.ccw)
    return Arc(at(primitive.start), at(primitive.end), at(primitive.centre), primitive.ccw)


def _copied(contours: Sequence[Contour], shifts: Sequence[Point]) -> tuple[Contour, ...]:
    return tuple(
        contour
        if (dx, dy) == (0, 0)
        else replace(contour, primitives=tuple(moved(each, dx, dy) for each in contour.primitives))
        for dx, dy in shifts
        for contour in contours
    )


def _copies_meet(contours: Sequence[Contour], job: Job) -> list[Finding]:
    """Return the finding that lines of copies meet, if some do; copies that reach into one another without touching are
    none.
    """
    copies = job.copies
    box = extent(contours) if len(copies.shifts) > 1 else None
    if box is None:
        return []
    lines = shapely.union_all([shapely.boundary(shape) for shape in filled(contours)])
    shapely.prepare(lines)
    across, up = (
        min(count - 1, int(size / abs(step)) + 1) if count > 1 else 0
        for count, step, size in (
            (copies.columns, copies.dx, box[2] - box[0]),
            (copies.rows, copies.dy, box[3] - box[1]),
        )
    )
    for column, row in ((i, j) for j in range(up + 1) for i in range(-across if j else 1, across + 1)):
        dx, dy = column * copies.dx, row * copies.dy
        gap = float(shapely.distance(lines, shapely.affinity.translate(lines, dx, dy)))
        if gap < 2 * _CHORD:
            text = f"Copies that are {abs(dx):.3f} mm apart along X and {abs(dy):.3f} mm along Y meet; move them apart."
            return [Finding(FindingKind.OVERLAP, text, box[0] + max(dx, 0.0), box[1] + max(dy, 0.0), amount=gap)]
    return []
