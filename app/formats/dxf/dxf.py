"""DXF in: curves in mm, layers, units, and an account of everything that is left out."""

from __future__ import annotations

import math
import re
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import PurePath
from typing import Any

from ...core import tolerances
from ...core.options import option
from ...geometry.affine import Affine, scaled
from ...geometry.chaining.pieces import FARTHEST
from ...model.drawn_depths import DepthSource, DrawnDepth, depth_words
from ...model.finding import Finding, FindingKind
from ...model.layer_names import spelled, typed_name
from ...model.notes import Mark, Note
from ...model.part import Entity, Layer, Part, Units
from ...model.read_options import AS_DRAWN, DrawingOptions
from ...model.reading import ReadingOptions
from ..drawing import Drawing, LeftOutSort, left_out_kinds
from ..drawing_account import (
    PAPER,
    CurveHeights,
    LayeredCurve,
    UsableCurves,
    all_left_out,
    listed,
    moving,
    on_layers,
    other_units,
    placement_findings,
    remark,
    size_of,
    strays_or_none,
    switched_off,
    usable_curves,
    without_length,
)
from ..reading_question import (
    FileContents,
    ReadingQuestion,
    UndecidedError,
    far_question,
    frozen_question,
    layouts_question,
    units_question,
)
from .blocks import DrawnCurves, DxfWalker, all_drawn
from .code_pages import with_told_letters
from .content import DxfContent
from .findings import (
    about_unread,
    band_findings,
    broken_line_findings,
    clip_findings,
    comma_findings,
    hatch_findings,
    hidden_insert_findings,
    layer_findings,
    negative_radius_findings,
    repeated_findings,
    stray_findings,
    text_findings,
    upright_findings,
)
from .letters import TextCurves
from .load import LoadedDocument, layout_named, load, paper

_NAMED_UNITS: dict[int, tuple[float, Units]] = {
    1: (25.4, Units.INCH),
    2: (304.8, Units.FOOT),
    3: (1609344.0, Units.FOOT),
    4: (1.0, Units.MM),
    5: (10.0, Units.CM),
    6: (1000.0, Units.M),
    7: (1e6, Units.M),
    8: (25.4e-6, Units.INCH),
    9: (25.4e-3, Units.INCH),
    10: (914.4, Units.FOOT),
    11: (1e-7, Units.MICRON),
    12: (1e-6, Units.MICRON),
    13: (1e-3, Units.MICRON),
    14: (100.0, Units.CM),
    15: (1e4, Units.M),
    16: (1e5, Units.M),
    21: (1200 / 3937 * 1000, Units.FOOT),
    22: (100 / 3937 * 1000, Units.INCH),
    23: (3600 / 3937 * 1000, Units.FOOT),
    24: (5280 * 1200 / 3937 * 1000, Units.FOOT),
}
"""$INSUNITS codes: size in mm, and the nearest unit to show the drawing in."""
_NAMES_UNITS = re.compile(rb"\$INSUNITS", re.IGNORECASE)


def read_dxf(
    data: bytes,
    name: str = "drawing.dxf",
    units: Units | None = None,
    layers: tuple[str, ...] = (),
    how: DrawingOptions = AS_DRAWN,
) -> Drawing:
    """Return the curves of a DXF's model space, or of one layout, in mm, and what was left out.

    Curves of inserted blocks are put in place, but for those inserted on frozen layers, which no CAD program shows.
    Texts are the outlines of their letters, or strokes where their font is not here; boundaries of hatches are
    outlines, unless they lie on curves that are drawn anyway. Points become notes, numbered behind the curves.
    Dimensions, solids and paper space are counted, not read. Units come from $INSUNITS alone ($MEASUREMENT only chooses
    hatch patterns); a drawing that names none is in `units`, or in mm.

    Args:
        data: the whole file, ASCII or binary DXF, R12 or later.
        name: for messages and titles.
        units: of a drawing that names none; one that does keeps its own, unless `how` overrules it.
        layers: names of layers (in any case) whose curves are kept; empty = all.
        how: which layout is read, types that are left out, and whether everything is moved to zero.

    Raises:
        InputError: the file is no usable DXF, has no curves, or has not one of the layers or the layout.
    """
    data = with_told_letters(data)
    loaded = load(data, name)
    document, reading = loaded.document, ReadingOptions(units, layers, how)
    unit = _unit(document, data, units, how.overrule)
    requested, without = (_in_table(document, names) for names in (layers, how.without_layers))
    walker = DxfWalker(document, name, requested, how.without_types)
    content = walker.content(layout_named(document, how.layout, name))
    machined = _machined(document, requested, without)
    dxf = _DrawnDxf(document, content, all_drawn(content, machined, unit.size), unit, machined)
    found, papers = dxf.usable(how.to_zero), paper(document)
    others = Counter() if how.layout else papers
    if not found.entities and not any(machined(each.layer) for each in content.points):
        raise UndecidedError(
            f"{name}: {_nothing(content, found, others)}", _asked(content, found, others, reading, unit)
        )
    whole = _part(dxf, found, name)
    part = on_layers(whole, layers, name)
    unread = {PAPER: others.total(), LeftOutSort("POINT"): len(content.points) - len(whole.notes)}
    left_out = +(content.left_out + Counter(unread))
    findings = (
        *_unit_findings(units, unit),
        *_file_findings(loaded),
        *placement_findings(found),
        *_content_findings(dxf, found),
        *layer_findings(document, Counter(each.layer for each in part.entities if machined(each.layer))),
        *switched_off(part, layers),
        *all_left_out(left_out),
    )
    names = tuple(layer.name for layer in whole.layers)
    contents = FileContents(names, tuple(papers.items()), tuple(sorted(walker.types)), unit.own)
    question = strays_or_none(found, reading, dxf.usable) or (
        None if unit.named or units else units_question(unit.shown, size_of(part), reading)
    )
    return Drawing(part, findings, left_out_kinds(left_out + found.missing), unit.named, contents, question)


@dataclass(frozen=True, eq=False)
class _DrawnDxf:
    """What a document has on its model space, or on one layout.

    Attributes:
        document: of the library.
        content: its curves, letters, points and what is none of them. drawn: all that is curves; both in drawing units.
        unit: of the drawing. machined: tells whether a layer is.
    """

    document: Any
    content: DxfContent
    drawn: DrawnCurves
    unit: _Unit
    machined: Callable[[str], bool]

    @property
    def to_mm(self) -> Affine:
        """The scaling from drawing units."""
        return scaled(self.unit.size)

    def usable(self, to_zero: bool) -> UsableCurves:
        """Return the curves that can be used, in mm, on layers as the table spells them.

        Args:
            to_zero: they are moved so that what is machined begins at zero.
        """
        return usable_curves(
            _spelled(self.document, self.drawn.curves),
            self.to_mm if self.unit.size != 1.0 else None,
            self.machined if to_zero else None,
            self.drawn.strokes,
        )


def _part(dxf: _DrawnDxf, found: UsableCurves, name: str) -> Part:
    """Return curves and points of a drawing as a part, with the depths that it tells."""
    content, unit = dxf.content, dxf.unit
    used = {each.layer for each in found.entities} or {each.layer for each in content.points}
    bare = Part(name=PurePath(name).stem, units=unit.shown, layers=_layers(dxf.document, used))
    part = bare.with_entities(found.entities)
    marks = _marks(content, unit.size, found, part.layers)
    depths = depths_of(DepthReading(content.letterings, dxf.drawn, found, unit.size))
    return replace(part, notes=marks, used_id=len(found.entities) + len(marks), depths=depths)


def _file_findings(loaded: LoadedDocument) -> Iterator[Finding]:
    """Yield what is wrong with the file itself."""
    yield from comma_findings(loaded.commas)
    yield from _damage(loaded.repaired)
    yield from repeated_findings(loaded.repeated)
    yield from stray_findings(loaded.strays)


def _content_findings(dxf: _DrawnDxf, found: UsableCurves) -> Iterator[Finding]:
    """Yield what is not read of the content, or not as it stands there; of layers that are machined."""
    content, machined, size = dxf.content, dxf.machined, dxf.unit.size
    yield from negative_radius_findings(content, size)
    yield from about_unread(content, size)
    nothing = [None if place is None else dxf.to_mm.point(place) for place in content.without_length]
    yield from without_length(nothing + found.nothing)
    yield from _heights(content, size)
    yield from hidden_insert_findings(content, size)
    yield from clip_findings([each for each in content.clipped if any(map(machined, each.layers))], size)
    yield from text_findings([each for each in content.letterings if machined(each.layer)], size)
    yield from hatch_findings(dxf.drawn)
    yield from band_findings([each for each in content.bands if machined(each.layer)], size)
    yield from broken_line_findings([each for each in content.broken if machined(each.layer)], size)
    yield from _upright(dxf, found)


def _upright(dxf: _DrawnDxf, found: UsableCurves) -> Iterator[Finding]:
    """Yield what is seen edge-on from above, of layers that are machined."""
    count = sum(number for layer, number in dxf.content.upright.items() if dxf.machined(layer))
    low, high = dxf.content.heights
    least = tolerances.CURVE / dxf.unit.size
    if count or high - low > least:
        sources = zip(found.entities, found.sources, strict=True)
        shown = [(each.curve, dxf.drawn.curves[row].heights) for each, row in sources if dxf.machined(each.layer)]
        climbs = any(heights.high - heights.low > least for _, heights in shown)
        yield from upright_findings(count, [curve for curve, _ in shown], climbs)


def _asked(
    content: DxfContent, found: UsableCurves, others: Counter[str], reading: ReadingOptions, unit: _Unit
) -> ReadingQuestion | None:
    """Return what to ask about a drawing that has nothing to machine, in the order of `_nothing`."""
    if found.far and found.moved is None:
        return far_question(found.far[0][0], reading, unit.shown)
    if content.hidden:
        layers = dict.fromkeys(layer for each in content.hidden for layer in (each.layer, *each.curves))
        count = sum(len(each.curves) for each in content.hidden)
        return frozen_question(tuple(layers), count, reading) if count else None
    return layouts_question(others, reading) if others else None


@dataclass(frozen=True)
class _Unit:
    """The drawing's unit: its size in mm, the unit to show, whether the file names it, and whether another one was said
    to hold.
    """

    size: float
    shown: Units
    named: bool
    overruled: Units | None = None

    @property
    def own(self) -> Units | None:
        """What the file names, nearest to it; None = nothing."""
        return self.overruled or (self.shown if self.named else None)


def _unit(document: Any, data: bytes, given: Units | None, overrule: bool) -> _Unit:
    """Return the drawing's unit.

    The library gives a file without a header one of its own, in metres; so the word must stand in the file itself.
    """
    code = document.header.get("$INSUNITS", 0) if _NAMES_UNITS.search(data) else 0
    if code in _NAMED_UNITS:
        size, shown = _NAMED_UNITS[code]
        if not overrule or given is None or given is shown:
            return _Unit(size, shown, named=True)
        return _Unit(given.value, given, named=True, overruled=shown)
    unit = given or Units.MM
    return _Unit(unit.value, unit, named=False)


def _in_table(document: Any, names: tuple[str, ...]) -> tuple[str, ...]:
    """Return the names of layers as the document has them; one that its table lacks, as it stands and as it was
    typed, for an entity may lie on it all the same.
    """
    found = spelled(names, [layer.dxf.name for layer in document.layers])
    return tuple(
        each for name, layer in found.items() for each in ((name, typed_name(name)) if layer is None else (layer,))
    )


def _machined(document: Any, layers: tuple[str, ...], without: tuple[str, ...]) -> Callable[[str], bool]:
    """Return what tells whether a layer is machined, and so counts for where the drawing lies."""
    requested, gone = ({layer.casefold() for layer in names} for names in (layers, without))
    hidden = {layer.dxf.name.casefold() for layer in document.layers if layer.is_off() or layer.is_frozen()}
    return lambda layer: (
        layer.casefold() not in gone
        and (layer.casefold() in requested if requested else layer.casefold() not in hidden)
    )


def _nothing(content: DxfContent, found: UsableCurves, others: Counter[str]) -> str:
    """Return why a drawing has nothing to machine, and what to do."""
    left_out = (
        content.left_out + found.missing + Counter({PAPER: others.total(), LeftOutSort("POINT"): len(content.points)})
    )
    said = listed(+left_out, "; left out: ")
    if found.far and found.moved is None:
        return (
            f"all of the drawing lies beyond 1 km, at ({found.far[0].place[0]:.3f}, {found.far[0].place[1]:.3f}) mm; "
            f"{moving()}{said}."
        )
    if content.hidden:
        hidden = " ".join(each.text for each in hidden_insert_findings(content, 1.0))
        return f"the drawing has no curves that are shown. {hidden}"
    if others:
        layout = others.most_common(1)[0][0]
        asked = option("layout", f'"{layout}"')
        return (
            f"model space has no lines, arcs or curves to machine, but layout {layout} has something: say "
            f"{asked}{said}."
        )
    if content.upright.total():
        return (
            f"the drawing stands upright, and nothing of it is seen from above{said}; lay it into the XY plane in the "
            "CAD program and save it again."
        )
    return f"the drawing has no lines, arcs or curves to machine{said}."


def _spelled(document: Any, curves: Iterable[LayeredCurve]) -> list[LayeredCurve]:
    """Return curves with layers as the table spells them; DXF tells no difference between capitals and small
    letters.
    """
    spelling = {layer.dxf.name.casefold(): layer.dxf.name for layer in document.layers}
    return [each._replace(layer=spelling.get(each.layer.casefold(), each.layer)) for each in curves]


def _marks(content: DxfContent, size: float, found: UsableCurves, layers: tuple[Layer, ...]) -> tuple[Note, ...]:
    """Return the points that lie within reach and on known layers, in mm, moved as the curves are, numbered behind
    them.
    """
    spelling = {layer.name.casefold(): layer.name for layer in layers}
    dx, dy = found.moved or (0.0, 0.0)
    places = [((x * size + dx, y * size + dy), layer.casefold()) for (x, y), layer in content.points]
    kept = [(at, layer) for at, layer in places if max(map(abs, at)) <= FARTHEST and layer in spelling]
    first = len(found.entities) + 1
    return tuple(Note(number, Mark(at), spelling[layer]) for number, (at, layer) in enumerate(kept, first))


def _layers(document: Any, used: set[str]) -> tuple[Layer, ...]:
    """Return the layers; the one for points of dimensions, which the library adds to every file, only where it is
    used.
    """
    found = [
        Layer(layer.dxf.name, _colour(layer), not (layer.is_off() or layer.is_frozen()), layer.is_locked())
        for layer in document.layers
        if layer.dxf.name in used or layer.dxf.name.casefold() != "defpoints"
    ]
    return tuple(found) or (Layer(),)


def _colour(layer: Any) -> str:
    """Return "#rrggbb", or "" for colour 7, which is black or white as the ground demands."""
    from ezdxf.colors import aci2rgb

    if layer.rgb is not None:
        return "#{:02x}{:02x}{:02x}".format(*layer.rgb)
    index = abs(layer.dxf.color)
    return "" if index == 7 or not 1 <= index <= 255 else "#{:02x}{:02x}{:02x}".format(*aci2rgb(index))


def _unit_findings(given: Units | None, unit: _Unit) -> Iterable[Finding]:
    word = unit.shown.name.lower()
    if unit.overruled is not None:
        text = f"The drawing names its own units, {unit.overruled.name.lower()}; it is read in {word}, as asked."
        yield Finding(FindingKind.UNITS_ASSUMED, text, counts=False)
    elif not unit.named and given is None:
        text = (
            f"The drawing names no units; {word} is assumed. If it is in inches, say {option('units', 'in')}, or "
            "choose them on opening."
        )
        yield Finding(FindingKind.UNITS_ASSUMED, text, counts=False)
    elif unit.named:
        yield from other_units(given, unit.shown)


def _damage(repaired: int) -> Iterable[Finding]:
    if repaired:
        were = "1 fault was" if repaired == 1 else f"{repaired} faults were"
        text = f"The DXF is damaged; {were} repaired on reading. Compare it with the original."
        yield Finding(FindingKind.LEFT_OUT, text, amount=float(repaired))


def _heights(content: DxfContent, factor: float) -> Iterable[Finding]:
    low, high = (z * factor for z in content.heights)
    if high - low > tolerances.CURVE:
        yield remark(
            f"The drawing is not flat, its Z runs from {low:g} to {high:g} mm; it is read as seen from above.",
            high - low,
        )


# Depths that a DXF tells: by where along Z its curves lie, by how far these are drawn out, and by its texts.


@dataclass(frozen=True, slots=True)
class DepthReading:
    """What depths are read from.

    Attributes:
        letterings: texts of the sheet. drawn: its curves, in the order in which they were numbered.
        found: what of them can be machined. unit: size of the drawing's unit, mm.
    """

    letterings: Sequence[TextCurves]
    drawn: DrawnCurves
    found: UsableCurves
    unit: float


def depths_of(reading: DepthReading) -> tuple[DrawnDepth, ...]:
    """Return every depth that a drawing tells.

    Depths by elevation count from the highest curve, or from Z 0 where that is higher. What is drawn out from Z 0 is as
    deep as it is thick, up or down; else it reaches from the top to its lower end.
    """
    return (*_of_curves(reading), *_of_texts(reading))


def _of_curves(reading: DepthReading) -> Iterator[DrawnDepth]:
    """Yield a depth for all curves that lie alike."""
    curves = reading.drawn.curves
    alike: defaultdict[CurveHeights, list[Entity]] = defaultdict(list)
    for entity, index in zip(reading.found.entities, reading.found.sources, strict=True):
        alike[_rounded(curves[index].heights, reading.unit)].append(entity)
    top = max([0.0, *(heights.high for heights in alike)])
    for heights, entities in alike.items():
        depth, source = _depth(heights, top), DepthSource.THICKNESS if heights.thickness else DepthSource.ELEVATION
        if depth is None or depth > tolerances.CURVE:
            numbers = tuple(each.id for each in entities)
            yield DrawnDepth(source, depth, _words(heights), entities[0].curve.start, numbers)


def _rounded(heights: CurveHeights, unit: float) -> CurveHeights:
    return CurveHeights(*(round(z * unit, 6) + 0.0 if math.isfinite(z) else 0.0 for z in heights))


def _depth(heights: CurveHeights, top: float) -> float | None:
    """Return how deep curves are drawn, mm; None where they lean."""
    if heights.high - heights.low > tolerances.CURVE:
        return None
    if heights.thickness and heights.low == 0:
        return abs(heights.thickness)
    return top - heights.low - min(heights.thickness, 0.0)


def _words(heights: CurveHeights) -> str:
    if heights.high - heights.low > tolerances.CURVE:
        return f"Z {heights.low:g} to {heights.high:g} mm"
    return f"Z {heights.low:g} mm" + (f", thickness {heights.thickness:g} mm" if heights.thickness else "")


def _of_texts(reading: DepthReading) -> Iterator[DrawnDepth]:
    """Yield the depths that texts tell; the curves of letters come behind all others, outlines before strokes."""
    unit, number = reading.unit, {source: k + 1 for k, source in enumerate(reading.found.sources)}
    shift = reading.found.moved or (0.0, 0.0)
    outline = len(reading.drawn.curves) - sum(each.size for each in reading.letterings)
    stroke = len(reading.drawn.curves) - reading.drawn.strokes
    for each in reading.letterings:
        rows = (
            *range(outline, outline + len(each.outlines)),
            *range(stroke, stroke + len(each.strokes)),
        )
        outline, stroke = outline + len(each.outlines), stroke + len(each.strokes)
        told = depth_words(each.words, unit)
        if told is not None:
            at = each.at[0] * unit + shift[0], each.at[1] * unit + shift[1]
            yield DrawnDepth(
                DepthSource.TEXT, told.depth, each.words.strip(), at, _numbers(rows, number), each.height * unit
            )


def _numbers(rows: Sequence[int], number: Mapping[int, int]) -> tuple[int, ...]:
    return tuple(number[row] for row in rows if row in number)
