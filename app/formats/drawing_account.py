"""What every reader of drawings does with its curves: to mm, numbered, chosen by layer, and an account of the rest."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ..core import tolerances
from ..core.errors import InputError
from ..core.options import option
from ..core.wording import in_plane
from ..geometry.affine import Affine, transformed
from ..geometry.chaining.pieces import FARTHEST, straightened, within_reach
from ..geometry.sample import bounds, bounds_of_all
from ..model.curves import Arc, Circle, Curve, Ellipse, Line, Point, Spline
from ..model.finding import Finding, FindingKind
from ..model.layer_names import known_layers, spelled
from ..model.notes import Mark
from ..model.part import Entity, Part, Units
from ..model.reading import ReadingOptions
from .drawing import LeftOutCounts, LeftOutReason, LeftOutSort, left_out_kinds
from .reading_question import ReadingQuestion, Size, strays_question

MOST_CURVES = 500_000
"""A drawing that unfolds to more curves than this is refused before it fills the memory."""

BEYOND = LeftOutSort("curve beyond 1 km or without a place")
_GONE = {True: "is missing from the part", False: "are missing from the part"}
PAPER = LeftOutSort("paper space entity")
_SAYING = """
    ATTDEF ATTRIB ACAD_TABLE ARC_DIMENSION DIMENSION LARGE_RADIAL_DIMENSION LEADER MLEADER MULTILEADER TOLERANCE RTEXT
    POINT RAY XLINE IMAGE WIPEOUT OLEFRAME OLE2FRAME PDFUNDERLAY DWFUNDERLAY DGNUNDERLAY VIEWPORT LIGHT SUN CAMERA
    SECTIONOBJECT GEOPOSITIONMARKER POSITIONMARKER image foreignObject video audio iframe canvas animate
    animateTransform animateMotion set script
"""
_NO_SHAPES = frozenset([*_SAYING.split(), PAPER.kind])
"""What says or shows something of the drawing, and is no part of it. All else has outlines for whoever sees it, also
what nobody here has heard of.
"""
_COUNTABLE = 1e10
"""mm; beyond, neighbouring doubles are further apart than WELD, so that no shape is left to be moved."""


class CurveHeights(NamedTuple):
    """Where along Z a curve is drawn, drawing units.

    Attributes:
        low, high: of its points. thickness: how far it is drawn out from there, upwards.
    """

    low: float
    high: float
    thickness: float = 0.0

    def lifted(self, z: float) -> CurveHeights:
        """Return it in a block that is inserted at this height."""
        return CurveHeights(self.low + z, self.high + z, self.thickness)


LEVEL_ZERO = CurveHeights(0.0, 0.0)


class LayeredCurve(NamedTuple):
    """A curve as it was read, the name of its layer, and where along Z it lies."""

    curve: Curve
    layer: str
    heights: CurveHeights = LEVEL_ZERO


class FarCurve(NamedTuple):
    """Where a curve begins that lies beyond 1 km, mm, and the name of its layer."""

    place: Point
    layer: str


@dataclass(frozen=True)
class UsableCurves:
    """What of some curves can be machined.

    Attributes:
        entities: those that have a length and a place, mm, numbered from 1.
        nothing: places of curves without length, None where there is no place.
        far: curves that lie beyond 1 km. placeless: how many have no place at all.
        moved: how far everything was moved, mm; None = not.
        sources: the index of each entity among the curves that were read.
    """

    entities: tuple[Entity, ...]
    nothing: list[Point | None]
    far: list[FarCurve]
    placeless: int = 0
    moved: Point | None = None
    sources: tuple[int, ...] = ()

    @property
    def missing(self) -> Counter[LeftOutSort]:
        """Curves that are lost."""
        return +Counter({BEYOND: len(self.far) + self.placeless})


def usable_curves(
    curves: Iterable[LayeredCurve],
    to_mm: Affine | None,
    anchors: Callable[[str], bool] | None = None,
    strokes: int = 0,
) -> UsableCurves:
    """Return all curves that have a length, in mm.

    Args:
        to_mm: from the curves' units; None: they are in mm.
        anchors: tells whether a layer counts for where the drawing lies, which is then moved to zero; None: it stays.
        strokes: so many of the last ones are strokes of letters.
    """
    placed = [(transformed(curve, to_mm) if to_mm is not None else curve, layer) for curve, layer, _ in curves]
    moved = (
        None if anchors is None else _shift([curve for curve, layer in placed if curve is not None and anchors(layer)])
    )
    shift = None if moved is None else Affine(x0=moved[0], y0=moved[1])
    found = UsableCurves((), [], [], 0, moved)
    entities: list[Entity] = []
    sources: list[int] = []
    lost = 0
    for left, (curve, layer) in zip(range(len(placed), 0, -1), placed, strict=True):
        drawn = (
            None if curve is None else straightened(transformed(curve, shift) or curve if shift is not None else curve)
        )
        if drawn is None or (within_reach(drawn) and not has_length(drawn)):
            found.nothing.append(None if drawn is None else drawn.start)
        elif within_reach(drawn):
            entities.append(Entity(len(entities) + 1, drawn, layer, left <= strokes))
            sources.append(len(placed) - left)
        elif all(map(math.isfinite, (*drawn.start, *drawn.end))):
            found.far.append(FarCurve(drawn.start, layer))
        else:
            lost += 1
    return replace(found, entities=tuple(entities), placeless=lost, sources=tuple(sources))


def strays_or_none(
    found: UsableCurves, reading: ReadingOptions, placed: Callable[[bool], UsableCurves]
) -> ReadingQuestion | None:
    """Return what to ask where some curves lie beyond 1 km that would not when the drawing is moved to zero.

    Args:
        reading: by which they were found. placed: returns what there is when it is moved to zero, or not.
    """
    if not found.far or found.moved is not None or placed(True).missing:
        return None
    return strays_question(len(found.far), reading)


def size_of(part: Part, layers: tuple[str, ...] = ()) -> Size:
    """Return width and height of what is machined of a part, mm: what is on some layers, or else on all that are
    shown.
    """
    requested = known_layers(layers, [layer.name for layer in part.layers]) or {
        layer.name.casefold() for layer in part.layers if layer.visible
    }
    box = bounds_of_all(entity.curve for entity in part.entities if entity.layer.casefold() in requested)
    return (0.0, 0.0) if box is None else (box[2] - box[0], box[3] - box[1])


def _shift(curves: list[Curve]) -> Point | None:
    """Return how far to move curves for their lower left corner to lie in zero, mm; None where none has a place.

    What lies more than 1 km from the middle one of all is a stray and counts for nothing.
    """
    boxes = [box for curve in curves if has_place(curve) for box in [bounds(curve)]]
    if not boxes:
        return None
    x, y = np.median([((box[0] + box[2]) / 2, (box[1] + box[3]) / 2) for box in boxes], axis=0)
    near = [box for box in boxes if abs(box[0] - x) <= FARTHEST and abs(box[1] - y) <= FARTHEST]
    return (-min(box[0] for box in near), -min(box[1] for box in near)) if near else None


def has_place(curve: Curve) -> bool:
    """Return False for a curve with a coordinate that is no number, or so large that none beside it can be told from
    it.
    """
    return all(abs(v) < _COUNTABLE for v in _numbers(curve))


def _numbers(curve: Curve) -> Iterator[float]:
    if isinstance(curve, Circle | Arc | Ellipse):
        yield from curve.centre
    if isinstance(curve, Circle):
        yield curve.radius
    elif isinstance(curve, Ellipse):
        yield from curve.major
    for point in curve.control_points if isinstance(curve, Spline) else (curve.start, curve.end):
        yield from point


def placement_findings(found: UsableCurves) -> Iterator[Finding]:
    """Say that the drawing was moved, and what of it is lost because it lies nowhere or too far away."""
    if found.moved is not None:
        x, y = found.moved
        yield remark(
            f"The drawing was moved by {in_plane(x, y)} mm, so that its lower left corner is zero.",
            math.hypot(x, y),
        )
    if found.far:
        (x, y), layer = found.far[0]
        what = "1 curve lies" if len(found.far) == 1 else f"{len(found.far)} curves lie"
        where = (
            f"at {in_plane(x, y)} on layer {layer}"
            if len(found.far) == 1
            else f"the first at {in_plane(x, y)} on layer {layer}"
        )
        todo = moving() if found.moved is None else "delete what lies so far away, or check the units"
        yield Finding(
            FindingKind.LEFT_OUT,
            f"{what} beyond 1 km, {where}, and {_GONE[len(found.far) == 1]}; {todo}.",
            amount=float(len(found.far)),
        )
    if found.placeless:
        what = "1 curve has" if found.placeless == 1 else f"{found.placeless} curves have"
        yield Finding(
            FindingKind.LEFT_OUT,
            f"{what} a coordinate that is no number and {_GONE[found.placeless == 1]}; draw it again.",
            amount=float(found.placeless),
        )


def has_length(curve: Curve) -> bool:
    """Return True for a curve that is longer than WELD."""
    if isinstance(curve, Line):
        return math.dist(curve.start, curve.end) >= tolerances.WELD
    if isinstance(curve, Arc):  # one that is nearly a circle has its ends close together
        return curve.start != curve.end and abs(curve.sweep) * curve.radius >= tolerances.WELD
    if isinstance(curve, Circle):
        return curve.radius >= tolerances.WELD
    if isinstance(curve, Ellipse):
        return math.hypot(*curve.major) * (curve.end_parameter - curve.start_parameter) >= tolerances.WELD
    points = np.array(curve.control_points)
    return bool(np.hypot(*(points - points[0]).T).max() >= tolerances.WELD)


def on_layers(part: Part, layers: tuple[str, ...], name: str) -> Part:
    """Return the part with only the curves on some layers, named in any case; empty = all.

    Raises:
        InputError: there is no such layer, or nothing on it.
    """
    if not layers:
        return part
    known = [layer.name for layer in part.layers]
    found = spelled(layers, known)
    missing = [layer for layer, there in found.items() if there is None]
    if missing:
        raise InputError(f"{name}: there is no layer {missing[0]}; the drawing has {', '.join(known)}.")
    requested = {there.casefold() for there in found.values() if there is not None}
    kept = tuple(entity for entity in part.entities if entity.layer.casefold() in requested)
    notes = tuple(note for note in part.notes if note.layer.casefold() in requested)
    if not kept and not any(isinstance(each.shape, Mark) for each in notes):
        raise InputError(f"{name}: layer {', '.join(layers)} has no lines, arcs or curves; choose another.")
    return Part(kept, part.layers, part.units, part.name, notes=notes, depths=part.depths)


def remark(text: str, amount: float | None = None) -> Finding:
    """Return a finding on what was left out that counts for nothing."""
    return Finding(FindingKind.LEFT_OUT, text, counts=False, amount=amount)


def other_units(given: Units | None, shown: Units) -> Iterator[Finding]:
    """Say that the units given are not those that the drawing names."""
    if given is not None and given is not shown:
        yield remark(
            f"The drawing names its own units, {shown.name.lower()}; the units given, {given.name.lower()}, are not "
            "used."
        )


def moving() -> str:
    """Return how a drawing comes nearer to zero."""
    return (
        f"move the drawing to zero in the CAD program, or say {option('to-zero')} (in the window: File, Reading "
        "options) and it is done on reading"
    )


def without_length(places: list[Point | None]) -> Iterator[Finding]:
    """Count what has no length, and say where the first is."""
    if places:
        known = [p for p in places if p is not None and all(map(math.isfinite, p))]
        x, y = known[0] if known else (None, None)
        where = f", the first at {in_plane(known[0][0], known[0][1])}" if known else ""
        what = "1 entity has" if len(places) == 1 else f"{len(places)} entities have"
        yield Finding(
            FindingKind.TINY_ENTITY,
            f"{what} no length{where}; left out.",
            x,
            y,
            counts=False,
            amount=float(len(places)),
        )


def switched_off(part: Part, requested: tuple[str, ...]) -> Iterator[Finding]:
    """Name the layers that have curves but are not shown, unless layers were asked for by name."""
    hidden = {layer.name for layer in part.layers if not layer.visible}
    curves = Counter(entity.layer for entity in part.entities if entity.layer in hidden)
    if requested or not curves:
        return
    count = curves.total()
    who = f"Layers {', '.join(curves)} are" if len(curves) > 1 else f"Layer {next(iter(curves))} is"
    what = f"{count} curves on {'them' if len(curves) > 1 else 'it'} are" if count > 1 else "1 curve on it is"
    advice = f"Say {option('layer', next(iter(curves)))} to machine {'one' if len(curves) > 1 else 'it'}."
    yield remark(f"{who} switched off or frozen; {what} not machined. {advice}", float(count))


def all_left_out(left_out: Counter[LeftOutSort]) -> Iterator[Finding]:
    """Count what is no curve, by type, and what cannot be drawn or is elsewhere, which is missing from the part."""
    absent = Counter({sort: count for sort, count in left_out.items() if _is_shape(sort)})
    if absent:
        text = (
            f"{listed(absent, 'Missing from the part: ')}, whose outlines are not in the file or cannot be read; bind "
            "or explode what this is in the CAD program, or draw round it, and save again."
        )
        yield Finding(FindingKind.LEFT_OUT, text, amount=float(absent.total()))
    left_out = left_out - absent
    damaged = Counter({sort: count for sort, count in left_out.items() if sort.reason is LeftOutReason.DAMAGED})
    if damaged:
        text = f"{listed(damaged, 'Missing from the part: ')}, which cannot be read; repair or draw what this is again."
        yield Finding(FindingKind.LEFT_OUT, text, amount=float(damaged.total()))
    if left_out - damaged:
        yield remark(
            f"{listed(left_out - damaged, 'Left out: ')}.{_remedy(left_out)}", float((left_out - damaged).total())
        )


def _is_shape(sort: LeftOutSort) -> bool:
    """Tell whether what is left out is a part of the drawing: not what is left out for a reason of its own."""
    return sort.reason is None and sort.kind not in _NO_SHAPES


def _remedy(left_out: LeftOutCounts) -> str:
    """Return what to do about texts that are not read as they stand, or nothing."""
    if not any(sort.reason is LeftOutReason.FILLS_LENGTH for sort in left_out):
        return ""
    return " To machine them, let letters run to the right, or turn them into curves, where they were drawn."


def listed(left_out: LeftOutCounts, before: str) -> str:
    """Return "before 2 TEXT, 1 IMAGE", or nothing."""
    return before + ", ".join(f"{count} {kind}" for kind, count in left_out_kinds(left_out)) if left_out else ""
