"""Paints a program: contour dashed, pocket solid, links thinner, rapids dotted, plunges as small rings."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import Qt
from PySide6.QtGui import QColor, QPainter, QPainterPath, QPen

from .....geometry.sample import Box, union
from .....model.moves import Program, Purpose
from .....model.operation import Operation
from ....framework.samples import PathLineKind, sample_of, sample_pen
from ....framework.theme import Theme
from ..modes import PathColourBy, PathLayers
from ..view_transform import ViewTransform
from .curve_path import chain_path
from .engagement_colours import colours
from .move_shapes import shape_moves
from .pens import FINE, screen_pen
from .program_chunks import MoveStyle, chunks, plunges, rapids, rapids_path
from .remainder_layer import RemainderLayer

if TYPE_CHECKING:
    from .....toolpath.coverage.coverage import UncutPlace
    from .engagement_runs import EngagementRuns

CUT_WIDTH, LINK_WIDTH, RAPID_WIDTH, TAB_WIDTH = 1.6, 1.0, 1.0, 5.0
CONTOUR_DASHES, RAPID_DOTS = (6.0, 3.6), (1.2, 2.6)
_LAYER_OF = {
    Purpose.RAPID: PathLayers.RAPID,
    Purpose.PLUNGE: PathLayers.PLUNGE,
    Purpose.CONTOUR: PathLayers.CONTOUR,
    Purpose.POCKET: PathLayers.POCKET,
    Purpose.LINK: PathLayers.LINK,
    Purpose.LEAD: PathLayers.LEAD,
    Purpose.DRILL: PathLayers.PLUNGE,
    Purpose.TAB: PathLayers.TAB,
    Purpose.DOG_BONE: PathLayers.CONTOUR,
}
_LAYER_OF_KIND = {
    PathLineKind.POCKET: PathLayers.POCKET,
    PathLineKind.REST: PathLayers.REST,
    PathLineKind.CONTOUR: PathLayers.CONTOUR,
    PathLineKind.PLUNGE: PathLayers.PLUNGE,
}
_CUTTING = (Purpose.POCKET, Purpose.CONTOUR, Purpose.DOG_BONE)
_THIN = (Purpose.LINK, Purpose.LEAD, Purpose.PLUNGE)
_MANY_PLUNGES, _RING_PX = 300, 10.0
_ORDER = (Purpose.LINK, Purpose.PLUNGE, Purpose.POCKET, Purpose.LEAD, Purpose.CONTOUR, Purpose.DOG_BONE, Purpose.TAB)


@dataclass(frozen=True, slots=True)
class PathDisplay:
    """How paths are shown.

    Attributes:
        stale: whether the job has outgrown them.
        fine: with pens of one px, because so many of them are in view.
    """

    theme: Theme
    layers: PathLayers = PathLayers.ALL
    colour_by: PathColourBy = PathColourBy.TOOL
    stale: bool = False
    fine: bool = False


def shown_purposes(layers: PathLayers) -> frozenset[Purpose]:
    """Return the purposes of the moves that are visible."""
    return frozenset(purpose for purpose, layer in _LAYER_OF.items() if layer in layers)


class ProgramLayer:
    """One program and what it leaves on the floor, ready to paint.

    Attributes:
        shapes: its moves, for picking.
        left, unreachable: what a tool could have cut and did not; what no tool reaches.
    """

    def __init__(
        self,
        program: Program,
        places: tuple[UncutPlace, ...] = (),
        engaged: EngagementRuns | None = None,
        operations: tuple[Operation, ...] = (),
    ) -> None:
        """Build every path once, in mm.

        Args:
            program: what is painted.
            places: what it leaves on the floor.
            engaged: its moves by engagement, where that was measured.
            operations: of its job, by the moves' index; without them a path's kind is told by its purpose alone.
        """
        self.measured = engaged is not None
        self.left = RemainderLayer([place for place in places if place.reachable])
        self.unreachable = RemainderLayer([place for place in places if not place.reachable])
        self.shapes = shape_moves(program.moves)
        painted = self.shapes if engaged is None else shape_moves(engaged.moves, engaged.step)
        self._chunks = sorted(chunks(painted), key=lambda c: _ORDER.index(c.style.purpose))
        self._boxes = np.array([c.box for c in self._chunks]).reshape(-1, 4)
        self._sizes = np.array([c.path.elementCount() for c in self._chunks], dtype=np.int64)
        self._rapids, self._plunges = rapids(self.shapes), plunges(self.shapes)
        self._operations = operations
        self._layers = np.array([self._layer(c.style).value for c in self._chunks], dtype=np.int64)
        self._regions: dict[int, QPainterPath] = {}
        for region in program.regions:
            path = QPainterPath()
            path.setFillRule(Qt.FillRule.OddEvenFill)
            for contour in region.contours:
                chain_path(contour.primitives, path)
            self._regions[region.number] = path

    @property
    def remainders(self) -> dict[PathLineKind, bool]:
        """Which of what a program may leave there is: tabs, metal within reach, metal out of it."""
        return {
            PathLineKind.TAB: bool(np.any(self._layers & PathLayers.TAB.value)),
            PathLineKind.LEFT: bool(self.left),
            PathLineKind.UNREACHABLE: bool(self.unreachable),
        }

    @property
    def box(self) -> Box | None:
        """x0, y0, x1, y1 of all cutting paths, mm, or None."""
        return union([chunk.box for chunk in self._chunks])

    def count(self, box: Box, layers: PathLayers) -> int:
        """Return how many elements of paths come into a box in mm."""
        return int(self._sizes[self._seen(box, layers)].sum())

    def _seen(self, box: Box, layers: PathLayers) -> NDArray[np.int64]:
        boxes = self._boxes
        near = (boxes[:, 0] <= box[2]) & (boxes[:, 2] >= box[0]) & (boxes[:, 1] <= box[3]) & (boxes[:, 3] >= box[1])
        return np.flatnonzero(near & (self._layers & layers.value != 0))

    def steps(self, painter: QPainter, view: ViewTransform, box: Box, look: PathDisplay) -> Iterator[None]:
        """Paint what lies in a box in mm, with a pause after every few paths; the painter works in screen px."""
        painter.save()
        try:
            painter.setTransform(view.transform(), True)
            self._paint_places(painter, view, box, look)
            yield
            painter.setBrush(Qt.BrushStyle.NoBrush)
            if PathLayers.RAPID in look.layers:
                painter.setPen(screen_pen(painter, look.theme.rapid, RAPID_WIDTH, RAPID_DOTS))
                painter.drawPath(rapids_path(self._rapids, box))
                yield
            for chunk in (self._chunks[k] for k in self._seen(box, look.layers)):
                pen = self._pen(painter, chunk.style, look, look.fine)
                if chunk.begins_at:
                    pen.setDashOffset(
                        chunk.begins_at * view.scale * painter.device().devicePixelRatioF() / pen.widthF()
                    )
                painter.setPen(pen)
                painter.drawPath(chunk.path)
                yield
        finally:
            painter.restore()
        if PathLayers.PLUNGE in look.layers:
            paint_plunges(painter, view, self._plunges, box, (look.theme.plunge, look.theme.canvas))

    def _paint_places(self, painter: QPainter, view: ViewTransform, box: Box, look: PathDisplay) -> None:
        """Paint regions, and what is left of them."""
        if PathLayers.REGION in look.layers:
            self._paint_regions(painter, look)
        if PathLayers.UNREACHABLE in look.layers:
            self.unreachable.paint(painter, view, box, look.theme.unreachable)
        if PathLayers.LEFT in look.layers:
            self.left.paint(painter, view, box, look.theme.left)

    def _layer(self, style: MoveStyle) -> PathLayers:
        """Return the layer that a path is shown on: of what cuts, that of its operation's row in the legend."""
        return _LAYER_OF_KIND[self._kind(style)] if style.purpose in _CUTTING else _LAYER_OF[style.purpose]

    def _kind(self, style: MoveStyle) -> PathLineKind:
        """Return the line that legend and list have for a path: that of its operation."""
        if 0 <= style.operation < len(self._operations):
            return sample_of(self._operations[style.operation])
        return PathLineKind.CONTOUR if style.purpose is Purpose.CONTOUR else PathLineKind.POCKET

    def _pen(self, painter: QPainter, style: MoveStyle, look: PathDisplay, fine: bool) -> QPen:
        width = LINK_WIDTH if style.purpose in _THIN else TAB_WIDTH if style.purpose is Purpose.TAB else CUT_WIDTH
        dashes = CONTOUR_DASHES if style.purpose is Purpose.CONTOUR else ()
        fine = fine and style.purpose is not Purpose.TAB  # tabs are few, and told from the path by their width
        return screen_pen(painter, self._colour(style, look), FINE if fine else width, dashes)

    def _colour(self, style: MoveStyle, look: PathDisplay) -> QColor:
        theme = look.theme
        if style.purpose is Purpose.PLUNGE:
            return theme.plunge
        if look.colour_by is PathColourBy.ENGAGEMENT and self.measured:
            return colours(theme)[style.step]
        if look.colour_by is PathColourBy.REGION and style.region > 0:
            colour = QColor(theme.regions[(style.region - 1) % len(theme.regions)])
        else:
            colour = sample_pen(self._kind(style), theme).color()
        if style.purpose is Purpose.LINK:
            colour.setAlphaF(0.75)
        return colour

    def _paint_regions(self, painter: QPainter, look: PathDisplay) -> None:
        painter.setPen(Qt.PenStyle.NoPen)
        for number, path in self._regions.items():
            colour = QColor(look.theme.region_fill)
            if look.colour_by is PathColourBy.REGION:
                colour = QColor(look.theme.regions[(number - 1) % len(look.theme.regions)])
                colour.setAlphaF(0.10)
            painter.fillPath(path, colour)


def paint_plunges(
    painter: QPainter, view: ViewTransform, places: NDArray[np.float64], box: Box, colours: tuple[QColor, QColor]
) -> None:
    """Paint a ring where a tool plunges; many of them are dots, and of rings that would cover one another one is
    painted.

    Args:
        painter: works in screen px.
        view: from mm to px.
        places: (n, 2) mm.
        box: what is seen, mm.
        colours: of the ring, of the ground in it.
    """
    near = places[np.all((places >= box[:2]) & (places <= box[2:]), axis=1)]
    seen = [view.to_screen((x, y)) for x, y in near.tolist()]
    apart = {(round(at.x() / _RING_PX), round(at.y() / _RING_PX)): at for at in seen}
    if len(apart) < _MANY_PLUNGES:
        rings = QPainterPath()
        for at in apart.values():
            rings.addEllipse(at, 4.4, 4.4)
        painter.setPen(QPen(colours[0], 1.4))
        painter.setBrush(colours[1])
        painter.drawPath(rings)
    painter.setPen(QPen(colours[0], 3.0, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap))
    painter.drawPoints(list(apart.values()) if len(apart) < _MANY_PLUNGES else seen)
