"""Walk a DXF space: curves of its entities and of all blocks inserted in it, nested, turned, mirrored, in rows and
columns.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from itertools import compress
from math import cos, isfinite, radians, sin
from typing import Any, NamedTuple

from ...core.errors import HitofudeError, InputError
from ...core.options import option
from ...geometry.affine import Affine, transformed
from ...model.curves import Curve, Point
from ..drawing import LeftOutReason, LeftOutSort
from ..drawing_account import LEVEL_ZERO, MOST_CURVES, CurveHeights, LayeredCurve
from .block_clips import hidden_layers
from .content import (
    BrokenLine,
    ClippedBlock,
    DxfContent,
    HiddenInsert,
    LayeredPoint,
    NegativeRadius,
    UnreadText,
    WidePolyline,
    layer_within,
    layers_within,
)
from .curves import (
    DamagedCurveError,
    NegativeRadiusError,
    NoLengthError,
    curves_of,
    drawn_heights,
    ensure_whole,
    heights_of,
    held_by,
    is_edge_on,
    is_lost,
    line_type_of,
    plane_of,
    seen_from_above,
    stands_upright,
    widths_of,
)
from .fonts import Fonts
from .hatch import Hatch, bounding_alone, hatch_of, solid_of
from .letters import LeftOutError, TextCurves
from .subclass_marks import DAMAGED

_TEXTS = ("TEXT", "MTEXT", "ATTRIB")
_FILLED = {"HATCH": hatch_of, "SOLID": solid_of, "TRACE": solid_of}
"""Areas that CAD programs show filled."""

DEEPEST = 64
"""Blocks nested deeper than this are refused."""

MOST_POINTS = 100_000
"""Points of a drawing; more of them come from blocks in blocks, and nobody drills them."""


def _sort_of(kind: str) -> LeftOutSort:
    """Return what an entity of a kind that is not read is left out as."""
    name = kind.removesuffix(DAMAGED)
    return LeftOutSort(name, None if name == kind else LeftOutReason.DAMAGED)


def _place_of(entity: Any) -> Point:
    """Return where a text is, seen from above."""
    at = entity.dxf.get("insert", (0.0, 0.0))
    return (float(at[0]), float(at[1]))


class _Lie(NamedTuple):
    """Where along Z an inserted block lies.

    Attributes:
        z: of its own zero, drawing units.
        x, y: how far it climbs along its own axes, drawing units per unit of the block; both 0 but where it is seen
            edge-on from above.
    """

    z: float = 0.0
    x: float = 0.0
    y: float = 0.0

    @property
    def is_edge_on(self) -> bool:
        """Whether it is seen edge-on from above."""
        return bool(self.x or self.y)

    def heights(self, curve: Curve) -> CurveHeights:
        """Return where along Z a curve of a block lies that is seen edge-on."""
        heights = [self.z + self.x * x + self.y * y for x, y in held_by(curve)]
        return CurveHeights(min(heights), max(heights))


_LEVEL = _Lie()


def _lie_of(insert: Any) -> _Lie:
    """Return where along Z the block of an insert lies."""
    if not is_edge_on(insert):
        return _Lie(float(insert.dxf.insert.z))
    matrix = insert.matrix44()
    origin, x, y = (float(matrix.transform(at).z) for at in ((0, 0, 0), (1, 0, 0), (0, 1, 0)))
    return _Lie(origin, x - origin, y - origin)


def _lay(inner: DxfContent, place: Affine, outer: str, content: DxfContent, lift: float) -> None:
    """Add the curves of a block that lies flat, so much higher, drawing units."""
    for curve, layer, heights in inner.curves:
        moved = transformed(curve, place)
        if moved is None:
            content.without_length.append(place.point(curve.start))
        else:
            lies = heights.lifted(lift) if lift else heights
            content.curves.append(LayeredCurve(moved, layer_within(layer, outer), lies))


def _stand(inner: DxfContent, place: Affine, outer: str, content: DxfContent, lie: _Lie) -> None:
    """Add the curves of a block that is seen edge-on from above, and count those of which nothing is seen."""
    for curve, layer, _ in inner.curves:
        moved, own = transformed(curve, place), layer_within(layer, outer)
        if moved is None or is_lost(curve, moved):
            content.upright[own] += 1
        else:
            lies = lie.heights(curve)
            content.see((lies.low, lies.high))
            content.curves.append(LayeredCurve(moved, own, lies))


class DxfWalker:
    """Reads spaces of one document; every block is read once."""

    def __init__(
        self, document: Any, name: str, requested: tuple[str, ...] = (), without: tuple[str, ...] = ()
    ) -> None:
        """Make a reader.

        Args:
            document: of the library. name: of the file, for messages.
            requested: layers that are machined even where they are frozen.
            without: types of entities to leave out, in any case.
        """
        self._name = name
        wanted = {layer.casefold() for layer in requested}
        self._frozen = {layer.dxf.name.casefold() for layer in document.layers if layer.is_frozen()} - wanted
        self._without = {kind.upper() for kind in without}
        self._fonts = Fonts(document.styles)
        self._blocks: dict[str, DxfContent] = {}
        self._open: list[str] = []
        self.types: set[str] = set()
        """Types of the entities that were met, also of those that were left out."""
        self._read: dict[str, None] = {}  # types of texts that are

    def content(self, entities: Iterable[Any]) -> DxfContent:
        """Return what some entities draw.

        Raises:
            InputError: blocks insert themselves, are nested too deep, or unfold to too many curves.
        """
        content = DxfContent()
        for entity in entities:
            kind = entity.dxftype()
            self.types.add(kind)
            try:
                self._one(entity, kind, content)
            except HitofudeError:
                raise
            except Exception:  # whatever an entity of a damaged file lacks: it is one that draws nothing
                content.left_out[LeftOutSort(kind, LeftOutReason.DAMAGED)] += 1
            self._bounded(content.size)
        return content

    def _one(self, entity: Any, kind: str, content: DxfContent) -> None:
        if entity.dxf.hasattr("invisible") and entity.dxf.invisible:
            content.left_out[LeftOutSort(kind, LeftOutReason.INVISIBLE)] += 1
        elif kind in self._without:
            content.left_out[LeftOutSort(kind, LeftOutReason.AS_ASKED)] += 1
        elif kind == "INSERT":
            self._insert(entity, content)
        elif kind == "POINT":
            x, y, _ = entity.dxf.get("location")  # the library has the origin for a place that is not told
            content.points.append(LayeredPoint((float(x), float(y)), entity.dxf.layer))
        elif kind == "ATTDEF" and self._open and entity.is_const and entity.is_invisible:
            content.left_out[LeftOutSort("ATTDEF", LeftOutReason.INVISIBLE)] += 1
        else:
            self._draw(entity, kind, content)

    def _draw(self, entity: Any, kind: str, content: DxfContent) -> None:
        try:
            ensure_whole(entity)
            made = self._letterings(entity, kind) if self._is_text(entity, kind) else _filled(entity, kind)
            curves = [] if made else curves_of(entity)
        except NoLengthError as nothing:
            if stands_upright(entity):
                content.upright[entity.dxf.layer] += 1
            else:
                content.without_length.append(nothing.args[0])
            return
        except DamagedCurveError as damaged:
            sort, at = LeftOutSort(kind, LeftOutReason.DAMAGED), damaged.args[0]
            content.left_out[sort] += 1
            if at is not None and all(map(isfinite, at)):
                content.unread.append(UnreadText(at, sort, entity.dxf.layer))
            return
        except LeftOutError as left:
            content.left_out[left.sort] += 1
            content.unread.append(UnreadText(_place_of(entity), left.sort, entity.dxf.layer))
            return
        except NegativeRadiusError as negative:
            at, radius = negative.args
            content.negative.append(NegativeRadius(at, radius, entity.dxf.layer))
            return
        if curves is None:
            content.left_out[_sort_of(kind)] += 1
            return
        if made and is_edge_on(entity):
            content.upright[entity.dxf.layer] += 1
            return
        seen = seen_from_above(entity, curves)
        if len(seen) < len(curves):
            content.upright[entity.dxf.layer] += 1
            curves = seen
        content.see(heights_of(entity))
        lies = drawn_heights(entity) if curves else LEVEL_ZERO
        widths = widths_of(entity)
        if widths and curves:
            content.bands.append(WidePolyline(curves[0].start, min(widths), max(widths), entity.dxf.layer))
        line_type = line_type_of(entity)
        if line_type and curves:
            content.broken.append(BrokenLine(curves[0].start, line_type, entity.dxf.layer))
        content.curves += [LayeredCurve(curve, entity.dxf.layer, lies) for curve in curves]
        for each in made:
            content.add(each)

    def _is_text(self, entity: Any, kind: str) -> bool:
        """Tell whether an entity shows letters, as a constant attribute does wherever its block is inserted."""
        return kind in _TEXTS or (kind == "ATTDEF" and bool(self._open) and bool(entity.is_const))

    def _letterings(self, entity: Any, kind: str) -> list[TextCurves]:
        """Return what a text draws; an MTEXT of several columns as many times as it has columns."""
        if kind != "MTEXT":
            return [self._lettering(entity, kind)]
        from .mtext import columns_of

        return [self._lettering(each, kind) for each in columns_of(entity)]

    def _lettering(self, entity: Any, kind: str) -> TextCurves:
        self._read[kind] = None
        from .mtext import mtext_lettering  # few drawings have texts
        from .text import text_lettering

        if kind == "MTEXT":
            return mtext_lettering(entity, self._fonts)
        if kind in ("ATTRIB", "ATTDEF") and entity.has_embedded_mtext_entity:
            return replace(mtext_lettering(entity.virtual_mtext_entity(), self._fonts), kind=kind)
        return text_lettering(entity, self._fonts)

    def _insert(self, insert: Any, content: DxfContent) -> None:
        """Add every copy of a block; what is on its layer 0 takes the layer of the insert."""
        block = insert.block()
        outside = block is not None and _is_outside(block)
        if block is None or outside:
            content.left_out[LeftOutSort(f"INSERT of {'an external drawing' if outside else 'a missing block'}")] += 1
            content.left_out[LeftOutSort("ATTRIB")] += len(insert.attribs)
            return
        inner = self._block(insert.dxf.name, insert)
        places = max(insert.dxf.row_count, 1) * max(insert.dxf.column_count, 1)
        self._bounded(content.size + inner.size * places, insert)
        self._bounded(places, insert)
        if self._is_hidden(insert):
            layers = layers_within(inner.layers(), insert.dxf.layer)
            content.hidden.append(
                HiddenInsert(insert.dxf.layer, insert.dxf.name, next(iter(_origins(insert)), None), layers * places)
            )
            return
        for sort, count in inner.left_out.items():
            content.left_out[sort] += count * places
        lie = _lie_of(insert)
        if inner.any_height and not lie.is_edge_on:
            content.see(z + lie.z for z in inner.heights)
        points = self._points(inner, places, content)
        if inner.is_empty and not points and not insert.attribs:
            return
        copies = _places(insert)
        if not copies:
            content.left_out[LeftOutSort("INSERT", LeftOutReason.DAMAGED)] += 1
            return
        content.points += [
            LayeredPoint(place.point(at), layer_within(layer, insert.dxf.layer))
            for place in copies
            for at, layer in points
        ]
        if clipped := hidden_layers(insert, zip(inner.drawn(), inner.layers(), strict=True)):
            clip = ClippedBlock(
                insert.dxf.name, _inserted_at(insert, copies[0]), layers_within(clipped, insert.dxf.layer)
            )
            content.clipped.append(clip)
        for place in copies:
            self._copy(inner, place, insert.dxf.layer, content, lie)
        self._attributes(insert, copies, content)

    def _points(self, inner: DxfContent, places: int, content: DxfContent) -> list[LayeredPoint]:
        """Return the points of a block that are put in so many places; too many are counted as left out."""
        if len(content.points) + len(inner.points) * places <= MOST_POINTS:
            return inner.points
        content.left_out[LeftOutSort("POINT")] += len(inner.points) * places
        return []

    def _attributes(self, insert: Any, copies: list[Affine], content: DxfContent) -> None:
        """Add the attributes of a block, which lie where the block is inserted first, with every copy of it."""
        own = self.content(attribute for attribute in insert.attribs if not attribute.is_invisible)
        own.left_out[LeftOutSort("ATTRIB", LeftOutReason.INVISIBLE)] += sum(
            bool(attribute.is_invisible) for attribute in insert.attribs
        )
        self._bounded(content.size + own.size * len(copies), insert)
        for place in copies:
            self._copy(own, Affine(x0=place.x0 - copies[0].x0, y0=place.y0 - copies[0].y0), insert.dxf.layer, content)
        content.left_out += Counter({sort: count * len(copies) for sort, count in own.left_out.items()})
        if own.any_height:
            content.see(own.heights)

    def _is_hidden(self, insert: Any) -> bool:
        """True on a frozen layer; in a block, layer 0 is that on which the block itself is inserted."""
        layer = insert.dxf.layer.casefold()
        return layer in self._frozen and not (self._open and layer == "0")

    def _copy(self, inner: DxfContent, place: Affine, outer: str, content: DxfContent, lie: _Lie = _LEVEL) -> None:
        """Add what a block draws in one place, on the layer `outer` where it names none."""
        for layer, count in inner.upright.items():
            content.upright[layer_within(layer, outer)] += count
        content.without_length += [None if p is None else place.point(p) for p in inner.without_length]
        content.hidden += [replace(each, at=each.at and place.point(each.at)) for each in inner.hidden]
        content.negative += [
            replace(each, at=place.point(each.at), layer=layer_within(each.layer, outer)) for each in inner.negative
        ]
        content.clipped += [each.moved(place, outer) for each in inner.clipped]
        content.bands += [each.moved(place, outer) for each in inner.bands if not lie.is_edge_on]
        content.unread += [
            replace(each, at=place.point(each.at), layer=layer_within(each.layer, outer)) for each in inner.unread
        ]
        content.broken += [
            replace(each, at=place.point(each.at), layer=layer_within(each.layer, outer)) for each in inner.broken
        ]
        if lie.is_edge_on:
            content.upright.update(layers_within((each.layer for each in inner.more()), outer))
            _stand(inner, place, outer, content, lie)
        else:
            for each in inner.more():
                content.add(each.moved(place, outer))
            _lay(inner, place, outer, content, lie.z)
        self._bounded(
            max(len(content.hidden), len(content.negative), len(content.unread), len(content.clipped), content.size)
        )

    def _block(self, name: str, insert: Any) -> DxfContent:
        key = name.casefold()
        if key in self._open:
            raise InputError(
                f"{self._name}: block {name} is inserted in itself; break the loop in the CAD program and save again."
            )
        if len(self._open) >= DEEPEST:
            raise InputError(
                f"{self._name}: blocks are nested deeper than {DEEPEST} levels at block {name}; explode some and save "
                "again."
            )
        if key not in self._blocks:
            self._open.append(key)
            self._blocks[key] = self.content(insert.block())
            self._open.pop()
        return self._blocks[key]

    def _bounded(self, count: int, insert: Any = None) -> None:
        if count > MOST_CURVES:
            texts = (
                f", or leave its texts out: {' '.join(option('skip-type', kind) for kind in self._read)}"
                if self._read
                else ""
            )
            if insert is None:
                raise InputError(
                    f"{self._name}: the drawing has more than {MOST_CURVES} curves; save it in parts, or thin it "
                    f"out{texts}."
                )
            raise InputError(
                f"{self._name}: the drawing unfolds to more than {MOST_CURVES} curves at block {insert.dxf.name}; "
                f"reduce the rows and columns of its inserted blocks{texts}."
            )


def _filled(entity: Any, kind: str) -> list[Hatch]:
    return [_FILLED[kind](entity)] if kind in _FILLED else []


def _is_outside(block: Any) -> bool:
    """Tell whether what a block draws lies in another file, attached or laid over."""
    return (block.block.is_xref or block.block.is_xref_overlay) and not len(block)


def _origins(insert: Any) -> list[Point]:
    return [_inserted_at(insert, place) for place in _places(insert)[:1]]


def _inserted_at(insert: Any, place: Affine) -> Point:
    """Return where the base point of a block comes to lie."""
    base = insert.block().block.dxf.base_point
    return place.point((float(base.x), float(base.y)))


def _places(insert: Any) -> list[Affine]:
    """Return the map from block to drawing for each row and column; none where a scale is 0 or a number is none."""
    matrix = insert.matrix44()
    origin, x, y = matrix.transform((0, 0, 0)), matrix.transform((1, 0, 0)), matrix.transform((0, 1, 0))
    numbers = (*origin, *x, *y)
    if not (all(map(isfinite, numbers)) and insert.dxf.xscale and insert.dxf.yscale):
        return []
    plane, angle = plane_of(insert, 0.0), radians(insert.dxf.rotation)
    places = []
    for row in range(max(insert.dxf.row_count, 1)):
        for column in range(max(insert.dxf.column_count, 1)):
            along, across = column * insert.dxf.column_spacing, row * insert.dxf.row_spacing
            dx, dy = plane.vector((along * cos(angle) - across * sin(angle), along * sin(angle) + across * cos(angle)))
            places.append(
                Affine(x.x - origin.x, y.x - origin.x, x.y - origin.y, y.y - origin.y, origin.x + dx, origin.y + dy)
            )
    return places


# All curves that a DXF's space draws: its own, boundaries of hatches that are not drawn anyway, and letters, strokes
# last.


@dataclass(frozen=True, slots=True)
class DrawnCurves:
    """Curves in the order in which they are numbered, so that a drawing without texts and hatches is numbered as it
    ever was.

    Attributes:
        curves: drawing units.
        strokes: so many of the last ones are strokes of letters.
        boundaries: of hatches on layers that are machined; `repeated` of them lie on drawn curves and are none of
            these. kinds: types of these hatches.
    """

    curves: tuple[LayeredCurve, ...]
    strokes: int
    boundaries: int
    repeated: int
    kinds: tuple[str, ...] = ()


def all_drawn(content: DxfContent, machined: Callable[[str], bool], size: float) -> DrawnCurves:
    """Return all curves of a sheet.

    Args:
        content: of the space. machined: tells whether a layer is. size: of the drawing's unit, mm.
    """
    shown = [each for each in content.hatches if machined(each.layer)]
    rings = [(ring, each.layer) for each in shown for ring in each.boundaries]
    new = _new([ring for ring, _ in rings], content, machined, size) if rings else []
    kept = [LayeredCurve(curve, layer) for ring, layer in compress(rings, new) for curve in ring]
    kept += [
        LayeredCurve(curve, each.layer)
        for each in content.hatches
        if not machined(each.layer)
        for curve in each.drawn()
    ]
    outlines = [LayeredCurve(curve, each.layer) for each in content.letterings for curve in each.outlines]
    strokes = [LayeredCurve(curve, each.layer) for each in content.letterings for curve in each.strokes]
    curves, kinds = (*content.curves, *kept, *outlines, *strokes), tuple(dict.fromkeys(each.kind for each in shown))
    return DrawnCurves(curves, len(strokes), len(rings), len(rings) - sum(new), kinds)


def _new(
    rings: list[tuple[Curve, ...]], content: DxfContent, machined: Callable[[str], bool], size: float
) -> list[bool]:
    return bounding_alone(rings, [each.curve for each in content.curves if machined(each.layer)], size)
