"""What clips, masks and the edges of viewports leave of a shape: all of it, a part, or nothing."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from enum import Enum
from typing import Any, Generic, Protocol, TypeVar

import numpy as np
import shapely

from ...core import tolerances
from ...core.errors import HitofudeError
from ...geometry.affine import Affine, transformed
from ...geometry.sample import Box, sample
from ...model.curves import Curve
from ..drawing_account import MOST_CURVES
from .lengths import LengthBasis
from .numbers import ViewBox
from .painted import bounding, closed_by_line
from .shapes import SHAPES, measure, shape
from .style import SvgStyle
from .xml import Node

_ROUGH = 2e-4
"""Chords of a round clip keep within this share of its size."""
_DEEPEST = 20
"""Groups and copies within a clip."""
_MOST_SHAPES = 2000
"""Of a clip; one of more is not looked at."""
_WHITE = "#ffffff"
_SILENT = ("title", "desc", "metadata")
_TRIANGLE = 3
"""Points of a run that has an area, at least."""


class Seen(Enum):
    """How much of a shape can be seen."""

    WHOLE = "whole"
    PART = "part"
    NOTHING = "nothing"


class _ClipKind(Enum):
    """What of a shape counts: its form, how light it is, or that it is opaque."""

    FORM = "clipPath"
    LIGHT = "luminance"
    OPAQUE = "alpha"


class ClipState(Protocol):
    """What an element takes over from those round it, as far as a clip is concerned."""

    @property
    def to(self) -> Affine:
        """From its coordinates to the drawing's, mm."""

    @property
    def style(self) -> SvgStyle:
        """Its own."""

    @property
    def basis(self) -> LengthBasis:
        """What lengths are relative to."""


State = TypeVar("State", bound=ClipState)

Clip = Any
"""What a clip leaves to see: an area of the plane, mm, of the geometry library; None where that is not known."""


class UnknownClipError(Exception):
    """What a clip leaves cannot be told."""


def viewport_clip(place: ViewBox, to: Affine) -> Clip:
    """Return what a viewport, which hides all beyond its edges, leaves to see."""
    right, low = place.x + place.width, place.y + place.height
    corners = [(place.x, place.y), (right, place.y), (right, low), (place.x, low)]
    with np.errstate(all="ignore"):
        return shapely.Polygon([to.point(corner) for corner in corners])


def seen_of(curves: Sequence[Curve], filled: bool, clips: Iterable[Clip]) -> Seen:
    """Return how much of a shape some clips, one within the other, leave to see; a part where that is not known.

    Args:
        curves: of the shape, mm. filled: it is an area, which ends at its curves.
    """
    try:
        with np.errstate(all="ignore"):
            return _seen(curves, filled, clips)
    except (ValueError, shapely.errors.GEOSException):  # numbers beyond all measure
        return Seen.PART


def covers(curves: Sequence[Curve], page: Box, spare: float) -> bool:
    """Tell whether the area within a shape's outlines holds all of a page, but for so many mm beside its edges."""
    try:
        with np.errstate(all="ignore"):
            return bool(_filled(curves).buffer(spare, join_style="mitre").covers(shapely.box(*page)))
    except (ValueError, shapely.errors.GEOSException):  # numbers beyond all measure
        return False


def _seen(curves: Sequence[Curve], filled: bool, clips: Iterable[Clip]) -> Seen:
    area, told = None, Seen.WHOLE
    drawn = shapely.MultiLineString([sample(curve) for curve in curves])
    for clip in clips:
        if clip is None:
            told = Seen.PART
            continue
        area = clip if area is None else area.intersection(clip)
    if area is None:
        return told
    x0, y0, x1, y1 = area.bounds if not area.is_empty else (0.0, 0.0, 0.0, 0.0)
    wider = area.buffer(tolerances.JOIN + _ROUGH * max(x1 - x0, y1 - y0), join_style="mitre")
    if wider.covers(drawn) and not area.is_empty:
        return told
    shown = drawn if not filled else shapely.union_all([drawn, shapely.make_valid(_filled(curves))])
    return Seen.PART if shown.intersects(area) else Seen.NOTHING


def _filled(curves: Sequence[Curve]) -> Any:
    """Return the area within a shape's outlines, with holes of it: whether something of it is seen asks no more."""
    return shapely.union_all(list(map(shapely.make_valid, _rings(curves))))


def _rings(curves: Sequence[Curve]) -> Iterator[Any]:
    """Yield the polygons of curves that follow one another."""
    run: list[Any] = []
    for k, curve in enumerate(curves):
        run.append(sample(curve))
        if k + 1 == len(curves) or curves[k + 1].start != curve.end:
            points = np.concatenate(run)
            run = []
            if len(points) > _TRIANGLE:
                yield shapely.Polygon(points)


class ClipReader(Generic[State]):
    """Reads the clips and masks of one file."""

    def __init__(
        self, ids: Mapping[str, Node], inside: Callable[[Node, State], State], target: Callable[[Node], Node | None]
    ) -> None:
        """Make a reader.

        Args:
            ids: elements by their names. inside: returns the state inside an element. target: what a `use` copies.
        """
        self._ids, self._inside, self._target = ids, inside, target
        self._known: dict[tuple[str, Affine], Clip] = {}
        self._count = 0

    def clips(self, style: SvgStyle, state: State) -> tuple[Clip, ...]:
        """Return what the clip and the mask of an element leave to see, each by itself.

        Args:
            style: of the element. state: inside it, but with the style that its clips begin with.
        """
        return tuple(clip for written in style.clips for clip in self._read(written, state))

    def _read(self, written: str, state: State) -> tuple[Clip, ...]:
        """Return one clip; nothing where there is none of that name, since that hides nothing."""
        name = written.partition("#")[2].strip(" \"')") if written.startswith("url(") else ""
        if not name:
            return (None,)
        node = self._ids.get(name)
        if node is None:
            return ()
        key = (name, state.to)
        if key not in self._known:
            self._known[key] = self._area_or_none(node, state)
        return (self._known[key],)

    def _area_or_none(self, node: Node, state: State) -> Clip:
        self._count = 0
        try:
            return self._area(node, self._inside(node, state))
        except (UnknownClipError, HitofudeError, ValueError, ArithmeticError, shapely.errors.GEOSException):
            return None

    def _area(self, node: Node, state: State) -> Clip:
        """Return what a clipPath or a mask leaves to see: the sum of its shapes.

        Raises:
            UnknownClipError: it is a share of each shape, or of letters, pictures or shades of grey.
        """
        kind = _kind(node, state.style)
        made = shapely.union_all(list(self._parts(node.children, state, kind, 0)))
        if node.attributes.get("maskUnits") == "userSpaceOnUse":
            x, y, width, height = (measure(node, key, state.basis) for key in ("x", "y", "width", "height"))
            made = made.intersection(viewport_clip(ViewBox(x, y, width, height), state.to))
        return made

    def _parts(self, nodes: Iterable[Node], outer: State, kind: _ClipKind, depth: int) -> Iterator[Any]:
        for node in nodes:
            self._count += 1
            if depth > _DEEPEST or self._count > _MOST_SHAPES:
                raise UnknownClipError
            if node.tag in _SILENT:
                continue
            state = self._inside(node, outer)
            if not (state.style.shown and state.style.visible):
                continue
            if state.style.clips:
                raise UnknownClipError
            yield from self._part(node, state, kind, depth)

    def _part(self, node: Node, state: State, kind: _ClipKind, depth: int) -> Iterator[Any]:
        target = self._target(node) if node.tag == "use" else None
        if node.tag in SHAPES:
            yield _clip_shape(node, state, kind)
        elif target is not None and not {"x", "y"} & node.attributes.keys():
            yield from self._parts([target], state, kind, depth + 1)
        elif node.tag == "g" and kind is not _ClipKind.FORM:
            yield from self._parts(node.children, state, kind, depth + 1)
        else:
            raise UnknownClipError


def _kind(node: Node, style: SvgStyle) -> _ClipKind:
    masks = node.tag == "mask"
    units = node.attributes.get("maskContentUnits" if masks else "clipPathUnits", "")
    if not (masks or node.tag == "clipPath") or style.clips or units == "objectBoundingBox":
        raise UnknownClipError
    return _ClipKind.FORM if not masks else _ClipKind.OPAQUE if style.alpha_mask else _ClipKind.LIGHT


def _clip_shape(node: Node, state: ClipState, kind: _ClipKind) -> Any:
    """Return the area of one shape of a clip, mm."""
    style = state.style
    if kind is not _ClipKind.FORM and (style.outlined or style.faint or not style.colour_of_fill):
        raise UnknownClipError
    if kind is _ClipKind.LIGHT and style.colour_of_fill != _WHITE:
        raise UnknownClipError
    if style.geometry:
        node = Node(node.tag, {**node.attributes, **style.geometry}, node.line)
    drawn = shape(node, state.basis, MOST_CURVES)
    runs = [] if drawn is None else [closed_by_line(run) for run in drawn.runs]
    evenodd = style.clip_evenodd if kind is _ClipKind.FORM else style.evenodd
    area = shapely.Polygon()
    for run in runs if evenodd else bounding(runs):
        points = [sample(curve) for each in run if (curve := transformed(each, state.to)) is not None]
        if sum(map(len, points)) > _TRIANGLE:
            area = area.symmetric_difference(shapely.make_valid(shapely.Polygon(np.concatenate(points))))
    return area
