"""Where an element's own transform brings it, and the box that it may turn about: the page, or what it draws."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace

from ...geometry.affine import IDENTITY, Affine, transformed
from ...geometry.sample import bounds_of_all
from ...model.curves import Curve
from ..drawing_account import MOST_CURVES
from .lengths import LengthBasis
from .numbers import UnreadableError, ViewBox
from .shapes import SHAPES, measure, shape
from .strokes import origin
from .style import SvgStyle
from .transforms import UnplacedError, transform
from .xml import DEEPEST, Node

_OF_PAGE = ("", "view-box")
_WITH_OUTLINES = ("stroke-box", "border-box")
_GROUPS = ("g", "a")
_UNKNOWN = ("image", "foreignObject", "video", "audio", "iframe", "canvas", "text", "flowRoot", "svg", "switch")
"""Elements that take up room, and nobody here knows how much."""
_MOST_ASKED = 200_000
"""Elements, and curves of theirs that are moved, for all boxes: those of groups within groups ask for the same ones."""
_NAN = (math.nan, math.nan)


class TransformReader:
    """Reads the transforms of one file."""

    def __init__(self, style: Callable[[Node, SvgStyle], SvgStyle], target: Callable[[Node], Node | None]) -> None:
        """Make a reader.

        Args:
            style: returns that of an element inside one of another style. target: what a `use` copies.
        """
        self._style, self._target = style, target
        self._left = _MOST_ASKED

    def transform(self, node: Node, style: SvgStyle, basis: LengthBasis) -> Affine:
        """Return where an element's own transform brings it; its style's lengths are relative to `basis`.

        Raises:
            UnplacedError: that cannot be told.
        """
        return self._about(style, basis, lambda: list(self._drawn(node, style, style.box, basis, 0)))

    def _about(self, style: SvgStyle, basis: LengthBasis, drawn: Callable[[], list[Curve]]) -> Affine:
        """Return where a style's transform brings an element, which is asked for what it draws where that matters."""
        try:
            of_page = style.box in _OF_PAGE
            place = ViewBox(0.0, 0.0, *(basis.viewport if of_page else _NAN))
            made = _made(style, basis, place)
            moves_alone = replace(made, x0=0.0, y0=0.0) == IDENTITY  # wherever it would turn
            if not of_page and not (moves_alone and math.isfinite(made.x0) and math.isfinite(made.y0)):
                place = _box(drawn(), style.box)
                made = _made(style, basis, place)
            if moves_alone:
                return made
            x, y = origin(style.origin, place, basis)
        except (ValueError, ArithmeticError):
            raise UnplacedError(" about ".join(filter(None, (style.transform, style.origin)))) from None
        return Affine(x0=x, y0=y).after(made).after(Affine(x0=-x, y0=-y)) if x or y else made

    def _drawn(self, node: Node, style: SvgStyle, box: str, basis: LengthBasis, depth: int) -> Iterator[Curve]:
        """Yield what an element draws, in its own coordinates.

        Raises:
            UnreadableError: that cannot be told, or its outline's width would count, or it takes too long.
        """
        self._left -= 1
        if depth > DEEPEST or self._left < 0 or not style.shown or node.tag in _UNKNOWN:
            raise UnreadableError(box)
        sized = replace(node, attributes={**node.attributes, **style.geometry}) if style.geometry else node
        if node.tag in SHAPES:
            read = shape(sized, basis, MOST_CURVES)
            if read is None or not any(read.runs) or (box in _WITH_OUTLINES and style.outlined):
                raise UnreadableError(box)
            yield from (curve for run in read.runs for curve in run)
        elif node.tag in _GROUPS:
            for child in node.children:
                if not child.attributes.get("requiredExtensions"):
                    yield from self._placed(child, style, box, basis, depth + 1)
        elif node.tag == "use":
            target = self._target(node)
            if target is None or target.tag == "symbol":
                raise UnreadableError(box)
            moved = Affine(x0=measure(sized, "x", basis), y0=measure(sized, "y", basis))
            yield from _through(self._placed(target, style, box, basis, depth + 1), moved)

    def _placed(self, node: Node, outer: SvgStyle, box: str, basis: LengthBasis, depth: int) -> Iterator[Curve]:
        """Yield what an element draws, in the coordinates of the one round it, whose style is `outer`.

        Raises:
            UnreadableError: that cannot be told, or it is turned: some viewers take the box round its turned box then.
        """
        style = self._style(node, outer)
        inner = list(self._drawn(node, style, box, replace(basis, em=style.em), depth))
        if not style.transform:
            yield from inner
            return
        to = self._about(style, basis, lambda: inner)
        if (to.xy or to.yx) and (to.xx or to.yy):
            raise UnreadableError(box)
        self._left -= len(inner)
        yield from _through(inner, to)


def _made(style: SvgStyle, basis: LengthBasis, place: ViewBox) -> Affine:
    return transform(style.transform, replace(basis, viewport=(place.width, place.height)))


def _through(curves: Iterator[Curve] | list[Curve], to: Affine) -> Iterator[Curve]:
    return (moved for curve in curves if (moved := transformed(curve, to)) is not None)


def _box(curves: list[Curve], named: str) -> ViewBox:
    box = bounds_of_all(curves)
    if box is None or not all(map(math.isfinite, box)):
        raise UnreadableError(named)
    return ViewBox(box[0], box[1], box[2] - box[0], box[3] - box[1])
