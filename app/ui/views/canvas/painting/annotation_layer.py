"""Paints points, construction lines and dimensions, and tells where they are; arrows and figures have one size on the
screen.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QPainter, QPolygonF

from .....drafting.commands.grips import note_grips
from .....geometry.dimension_lines import dimension_lines
from .....geometry.sample import Box
from .....model.curves import Curve, Line, Point
from .....model.notes import Dimension, Guide, Mark, Note
from .....model.part import Part
from ....framework.theme import Theme, text_font
from ..neighbour_snaps import distance_to
from ..snap import Snap, SnapKind
from ..view_transform import ViewTransform
from .curve_path import curve_path
from .pens import screen_pen

ARROW_PX = 9.0
_MARK_PX = 4.0
_DASH_DOT = (14.0, 4.0, 2.0, 4.0)


class AnnotationLayer:
    """The notes of one part that can be seen."""

    def __init__(self) -> None:
        """Begin without any."""
        self.notes: tuple[Note, ...] = ()
        self._guides: list[Line] = []
        self._places: list[Point] = []
        self._colours: dict[str, str] = {}

    def update(self, part: Part) -> None:
        """Take over another part."""
        hidden = {layer.name for layer in part.layers if not layer.visible}
        self.notes = tuple(note for note in part.notes if note.layer not in hidden)
        self._guides = [note.shape.line for note in self.notes if isinstance(note.shape, Guide)]
        self._places = [
            grip.at for note in self.notes for grip in note_grips(note.shape) if not isinstance(note.shape, Guide)
        ]
        self._colours = {layer.name: layer.colour for layer in part.layers}

    def paint(self, painter: QPainter, view: ViewTransform, area: QRectF, theme: Theme) -> None:
        """Paint what is seen in a rectangle of the screen; the painter works in screen px."""
        for note in self.notes:
            quiet = theme.ink if isinstance(note.shape, Mark) else theme.muted
            paint_note(painter, view, note, NoteLook(QColor(self._colours.get(note.layer) or quiet), 1.2), area)

    @property
    def box(self) -> Box | None:
        """The box of points and dimensions, mm; construction lines have no end and do not count."""
        if not self._places:
            return None
        xs, ys = zip(*self._places, strict=True)
        return min(xs), min(ys), max(xs), max(ys)

    def near_guides(self, at: Point, reach: float) -> list[Line]:
        """Return the construction lines that pass within reach of a point, mm."""
        return [line for line in self._guides if distance_to(line, at) <= reach]

    def near_points(self, at: Point, reach: float) -> list[Snap]:
        """Return the points of notes within reach of a point, mm."""
        return [Snap(p, SnapKind.NODE) for p in self._places if math.dist(p, at) <= reach]


def note_distance(note: Note, at: Point, reach: float) -> float:
    """Return how far a point is from what is painted of a note, mm; a figure counts as reached within some reaches of
    its place.
    """
    shape = note.shape
    if isinstance(shape, Mark):
        return math.dist(shape.at, at)
    if isinstance(shape, Guide):
        return distance_to(shape.line, at)
    made = dimension_lines(shape, reach)
    curves: tuple[Curve, ...] = (*made.lines, *made.arcs)
    to_figure = max(math.dist(shape.place, at) - 2 * reach, 0.0)
    return min([to_figure, *(distance_to(curve, at) for curve in curves)])


class NoteLook(NamedTuple):
    """How notes are painted: colour, and width of lines, px."""

    colour: QColor
    width: float


def paint_notes(painter: QPainter, view: ViewTransform, notes: Iterable[Note], look: NoteLook, area: QRectF) -> None:
    """Paint notes in one colour and width: those that are selected, lit, or about to come."""
    for note in notes:
        paint_note(painter, view, note, look, area)


def paint_note(painter: QPainter, view: ViewTransform, note: Note, look: NoteLook, area: QRectF) -> None:
    """Paint one note.

    Args:
        painter: works in screen px.
        area: what of the screen is seen.
    """
    painter.save()
    painter.setBrush(Qt.BrushStyle.NoBrush)
    if isinstance(note.shape, Mark):
        _paint_mark(painter, view.to_screen(note.shape.at), look)
    elif isinstance(note.shape, Guide):
        _paint_guide(painter, view, note.shape, look, area)
    else:
        _paint_dimension(painter, view, note.shape, look)
    painter.restore()


def _paint_mark(painter: QPainter, at: QPointF, look: NoteLook) -> None:
    painter.setPen(screen_pen(painter, *look))
    painter.drawLine(at + QPointF(-_MARK_PX, -_MARK_PX), at + QPointF(_MARK_PX, _MARK_PX))
    painter.drawLine(at + QPointF(-_MARK_PX, _MARK_PX), at + QPointF(_MARK_PX, -_MARK_PX))


def _paint_guide(painter: QPainter, view: ViewTransform, guide: Guide, look: NoteLook, area: QRectF) -> None:
    """Paint the piece that is seen; its dashes begin at the point it goes through, so that they stay while the view
    moves.
    """
    start, middle = view.to_screen(guide.through), area.center()
    way = QPointF(math.cos(guide.angle), -math.sin(guide.angle))
    along = QPointF.dotProduct(middle - start, way)
    half = math.hypot(area.width(), area.height()) / 2
    foot = start + way * along
    if math.hypot(foot.x() - middle.x(), foot.y() - middle.y()) > half:
        return
    colour, width = look
    pen = screen_pen(painter, colour, width, _DASH_DOT)
    period = sum(_DASH_DOT)
    first = math.floor((along - half) / period) * period
    painter.setPen(pen)
    painter.drawLine(start + way * first, start + way * (along + half))


def _paint_dimension(painter: QPainter, view: ViewTransform, dimension: Dimension, look: NoteLook) -> None:
    colour, width = look
    made = dimension_lines(dimension, ARROW_PX / view.scale)
    painter.save()
    painter.setTransform(view.transform(), True)
    painter.setPen(screen_pen(painter, colour, width))
    painter.drawPath(curve_path(*made.lines, *made.arcs))
    painter.restore()
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(colour)
    for head in made.heads:
        painter.drawPolygon(QPolygonF([view.to_screen(corner) for corner in head]))
    painter.setFont(text_font())
    painter.setPen(colour)
    painter.translate(view.to_screen(made.at))
    painter.rotate(-math.degrees(made.angle))
    painter.drawText(QPointF(-QFontMetricsF(painter.font()).horizontalAdvance(made.figure) / 2, -4.0), made.figure)
