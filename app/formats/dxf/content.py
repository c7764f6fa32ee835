"""What a space or a block of a DXF draws, and what of it is not read, or not as it stands there."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from math import sqrt
from typing import NamedTuple

from ...geometry.affine import Affine
from ...model.curves import Curve, Point
from ..drawing import LeftOutSort
from ..drawing_account import LayeredCurve
from .hatch import Hatch
from .letters import TextCurves


@dataclass(frozen=True)
class HiddenInsert:
    """An inserted block that no CAD program shows, since the layer that it is inserted on is frozen.

    Attributes:
        layer: that is frozen. block: its name. at: its place, drawing units, None where it has none.
        curves: layers of the curves that are not drawn for it.
    """

    layer: str
    block: str
    at: Point | None
    curves: tuple[str, ...] = ()


@dataclass(frozen=True)
class NegativeRadius:
    """A circle or an arc with a radius below 0; lengths in drawing units."""

    at: Point
    radius: float
    layer: str


@dataclass(frozen=True)
class WidePolyline:
    """A polyline that is drawn as wide as told, whose middle line is read; lengths in drawing units.

    Attributes:
        at: where it begins. least, most: its widths.
    """

    at: Point
    least: float
    most: float
    layer: str

    def moved(self, place: Affine, outer: str) -> WidePolyline:
        """Return it under a map; what is on layer 0 goes to `outer`."""
        scale = sqrt(abs(place.xx * place.yy - place.xy * place.yx))
        layer = layer_within(self.layer, outer)
        return WidePolyline(place.point(self.at), self.least * scale, self.most * scale, layer)


@dataclass(frozen=True)
class BrokenLine:
    """A curve that is drawn in a line type with gaps; where it begins, in drawing units."""

    at: Point
    line_type: str
    layer: str


@dataclass(frozen=True)
class UnreadText:
    """A text of a sort that is not read, or a curve that cannot be drawn; its place in drawing units."""

    at: Point
    sort: LeftOutSort
    layer: str


class ClippedBlock(NamedTuple):
    """A block that is read whole although a clip hides a part of it: its name and place, drawing units, and the layers
    of what is hidden.
    """

    name: str
    at: Point
    layers: tuple[str, ...]

    def moved(self, place: Affine, outer: str) -> ClippedBlock:
        """Return it under a map; what is on layer 0 goes to `outer`."""
        return ClippedBlock(self.name, place.point(self.at), layers_within(self.layers, outer))


def layer_within(layer: str, outer: str) -> str:
    """Return the layer of a block's entity where the block is inserted on the layer `outer`: layer 0 is that one."""
    return outer if layer == "0" else layer


def layers_within(layers: Iterable[str], outer: str) -> tuple[str, ...]:
    """Return layers of a block as they are where it is inserted on the layer `outer`."""
    return tuple(layer_within(layer, outer) for layer in layers)


class LayeredPoint(NamedTuple):
    """A point and the name of its layer."""

    at: Point
    layer: str


@dataclass
class DxfContent:
    """What a space or a block draws.

    Attributes:
        curves: in the sheet's own coordinates, drawing units.
        points: its points, each on its layer. letterings: what its texts draw. hatches: boundaries of its hatches.
        left_out: entities that are no curves.
        without_length: places of entities that draw nothing, None where there is no place.
        upright: how many entities are seen edge-on from above, wholly or in part, by layer.
        hidden: blocks inserted on frozen layers.
        negative: circles and arcs that nobody knows how to draw.
        bands: polylines with a width. broken: curves with gaps.
        unread: texts that are left out for what they are, and curves that cannot be drawn.
        clipped: inserted blocks that are cut by a clip.
        heights: least and greatest Z seen, drawing units.
    """

    curves: list[LayeredCurve] = field(default_factory=list)
    points: list[LayeredPoint] = field(default_factory=list)
    letterings: list[TextCurves] = field(default_factory=list)
    hatches: list[Hatch] = field(default_factory=list)
    left_out: Counter[LeftOutSort] = field(default_factory=Counter)
    without_length: list[Point | None] = field(default_factory=list)
    upright: Counter[str] = field(default_factory=Counter)
    hidden: list[HiddenInsert] = field(default_factory=list)
    negative: list[NegativeRadius] = field(default_factory=list)
    bands: list[WidePolyline] = field(default_factory=list)
    broken: list[BrokenLine] = field(default_factory=list)
    unread: list[UnreadText] = field(default_factory=list)
    clipped: list[ClippedBlock] = field(default_factory=list)
    heights: tuple[float, float] = (0.0, 0.0)
    any_height: bool = False
    _more: int = 0

    @property
    def size(self) -> int:
        """How many curves there are, with those of texts and hatches."""
        return len(self.curves) + self._more

    @property
    def is_empty(self) -> bool:
        """True where nothing is drawn, and nothing is to be said of a place."""
        return not (
            self.size
            or self.points
            or self.letterings
            or self.without_length
            or self.upright
            or self.hidden
            or self.negative
            or self.unread
        )

    def more(self) -> Iterator[TextCurves | Hatch]:
        """Yield its texts and hatches."""
        yield from self.letterings
        yield from self.hatches

    def drawn(self) -> Iterator[Curve]:
        """Yield every curve, those of texts and hatches too."""
        yield from (each.curve for each in self.curves)
        for each in self.more():
            yield from each.drawn()

    def layers(self) -> Iterator[str]:
        """Yield the layer of every curve."""
        yield from (each.layer for each in self.curves)
        for each in self.more():
            yield from (each.layer for _ in range(each.size))

    def add(self, made: TextCurves | Hatch) -> None:
        """Note what a text or a hatch draws, if it does; one of which letters are missing alone counts as a curve."""
        if not made.size and not (isinstance(made, TextCurves) and made.lacking):
            return
        if isinstance(made, Hatch):
            self.hatches.append(made)
        else:
            self.letterings.append(made)
        self._more += max(made.size, 1)

    def see(self, heights: Iterable[float]) -> None:
        """Note some Z."""
        for z in heights:
            self.heights = (min(self.heights[0], z), max(self.heights[1], z)) if self.any_height else (z, z)
            self.any_height = True
