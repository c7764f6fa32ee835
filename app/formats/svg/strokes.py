"""What lies on and along outlines and is not read: their width, gaps, arrowheads; and what transforms turn about."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from typing import Protocol

from ...core import tolerances
from ...geometry.affine import Affine
from ...model.curves import Point
from .lengths import LengthBasis, length
from .numbers import UnreadableError, ViewBox
from .style import SvgStyle
from .xml import Node

_BROAD = 1.0
"""mm; an outline that is said to be wider is an area to whoever sees it, and no line."""
_ENDS = ("path", "line", "polyline", "polygon")
"""Elements that arrowheads are drawn on."""
_WORDS = {"left": "0%", "top": "0%", "center": "50%", "right": "100%", "bottom": "100%"}


class OutlineState(Protocol):
    """What an element takes over from those round it, as far as its outline goes."""

    @property
    def to(self) -> Affine:
        """From its coordinates to the drawing's, mm."""

    @property
    def style(self) -> SvgStyle:
        """Its own."""

    @property
    def basis(self) -> LengthBasis:
        """What lengths are relative to."""

    @property
    def layer(self) -> str:
        """Its name."""


@dataclass(frozen=True, slots=True)
class BroadOutline:
    """An outline that is as wide as an area: where it begins, its width, mm, and its layer."""

    at: Point
    width: float
    layer: str


@dataclass
class PaintedOutlines:
    """How many shapes have what is not read.

    Attributes:
        filtered: a blur, a shadow or the like.
        dashed: an outline with gaps. marked: arrowheads and the like. patterned: a pattern that fills them.
        unseen: an outline of width 0. broad: those of more than 1 mm.
    """

    filtered: int = 0
    dashed: int = 0
    marked: int = 0
    patterned: int = 0
    unseen: int = 0
    broad: list[BroadOutline] = field(default_factory=list)

    def note(self, node: Node, state: OutlineState, at: Point) -> None:
        """Note what of a shape that is read lies on its outline; `at` is where it begins."""
        style = state.style
        self.filtered += style.filtered
        self.marked += style.marked and node.tag in _ENDS
        if not style.outlined:
            return
        self.dashed += style.dashed
        width = _width(style, state)
        self.unseen += width == 0
        if style.scales and width > _BROAD + tolerances.WELD:
            self.broad.append(BroadOutline(at, width, state.layer or "0"))

    @property
    def layers(self) -> Iterable[str]:
        """Layers with broad outlines, each once."""
        return dict.fromkeys(each.layer for each in self.broad)


def _width(style: SvgStyle, state: OutlineState) -> float:
    """Return how wide an outline is, mm; nan where that is not said, or cannot be read."""
    if not style.width:
        return math.nan
    try:
        width = length(style.width).user(state.basis)
    except UnreadableError:
        return math.nan
    return width * math.sqrt(abs(state.to.xx * state.to.yy - state.to.xy * state.to.yx))


def origin(text: str, place: ViewBox, basis: LengthBasis) -> Point:
    """Return what a transform turns about, user units.

    Args:
        text: of transform-origin, "" = its corner. place: what it is in. basis: its other lengths are relative to.

    Raises:
        UnreadableError: it is none, or a share of a place whose size nobody knows.
    """
    words = text.lower().split()[:2] or ["0", "0"]
    if len(words) == 1:
        words.append("center")
    if words[0] in ("top", "bottom") or words[1] in ("left", "right"):
        words.reverse()
    across, up = (length(_WORDS.get(word, word)) for word in words)
    if (across.is_share or up.is_share) and not (place.width and place.height):
        raise UnreadableError(text)
    sized = replace(basis, viewport=(place.width, place.height))
    return place.x + across.user(sized, "x"), place.y + up.user(sized, "y")
