"""Paints the drawing and what of it is selected, and finds the entity under the mouse."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPainterPath, QPen

from .....geometry.sample import Box, union
from .....model.curves import Curve, Line, Point
from .....model.notes import Note
from .....model.part import Entity, Part
from ....framework.theme import Theme
from ..neighbour_snaps import distance_to
from ..snap import Snap, snaps_of
from ..view_transform import ViewTransform
from .annotation_layer import AnnotationLayer, NoteLook, note_distance, paint_notes
from .curve_path import MANY, curve_path
from .part_chunks import EntityChunk, PartChunks
from .pens import FINE, screen_pen

PART_WIDTH, SELECTED_WIDTH, SELECTED_NOTE_WIDTH = 1.25, 2.6, 1.8
_BATCH = 64


class LayerPath(NamedTuple):
    """Curves of a layer, mm."""

    layer: str
    path: QPainterPath


class _NearThing(NamedTuple):
    """What is near a point: how far, mm, and of equals which comes first."""

    distance: float
    order: int
    thing: Entity | Note


class PartLayer:
    """One part, ready to paint.

    Attributes:
        lookup: its chunks and boxes.
        notes: its points, construction lines and dimensions.
        fine: whether curves are painted with pens of one px; that is decided for all that is in view.
    """

    def __init__(self) -> None:
        """Begin with an empty drawing."""
        self.lookup, self.notes = PartChunks(), AnnotationLayer()
        self.fine = False
        self._colours: dict[str, str] = {}
        self._locked: frozenset[str] = frozenset()
        self._selected: list[QPainterPath] = []
        self._selected_boxes: list[Box] = []
        self._selected_notes: tuple[Note, ...] = ()

    def update(self, part: Part) -> list[Box] | None:
        """Take over another part; return the boxes in mm of what looks otherwise than before, None for everything."""
        changed = self.lookup.update(part)
        colours, notes = {layer.name: layer.colour for layer in part.layers}, self.notes.notes
        self.notes.update(part)
        same, self._colours = colours == self._colours and notes == self.notes.notes, colours
        self._locked = frozenset(layer.name for layer in part.layers if layer.locked)
        return changed if same else None

    def select(self, ids: frozenset[int]) -> list[Box] | None:
        """Take over another selection; return the boxes in mm of what is or was selected, None for everything."""
        rows = [row for row, entity in enumerate(self.lookup.entities) if entity.id in ids] if ids else []
        chosen = [self.lookup.entities[row] for row in rows]
        self._selected = [
            curve_path(*(e.curve for e in chosen[at : at + _BATCH])) for at in range(0, len(chosen), _BATCH)
        ]
        before, self._selected_boxes = self._selected_boxes, [_box(row) for row in self.lookup.boxes[rows].tolist()]
        noted, self._selected_notes = self._selected_notes, tuple(note for note in self.notes.notes if note.id in ids)
        return None if noted or self._selected_notes else before + self._selected_boxes

    @property
    def box(self) -> Box | None:
        """The box of all that is seen of curves and notes, mm."""
        return union([box for box in (self.lookup.box, self.notes.box) if box is not None])

    def count(self, box: Box) -> int:
        """Return how many elements of paths come into a box in mm."""
        return sum(path.elementCount() for chunk in self._seen(box) for path in chunk.paths.values())

    def steps(self, painter: QPainter, view: ViewTransform, box: Box, theme: Theme) -> Iterator[None]:
        """Paint what lies in a box in mm, and what is selected, with pauses; the painter works in screen px."""
        yield from self.curve_steps(painter, view, box, theme)
        area = QRectF(view.to_screen((box[0], box[3])), view.to_screen((box[2], box[1])))
        self.notes.paint(painter, view, area, theme)
        yield from self.selected_steps(painter, view, theme.selection, area)

    def selected_steps(self, painter: QPainter, view: ViewTransform, colour: QColor, area: QRectF) -> Iterator[None]:
        """Paint what is selected in a rectangle of the screen, with pauses; the painter works in screen px."""
        paint_notes(painter, view, self._selected_notes, NoteLook(colour, SELECTED_NOTE_WIDTH), area)
        painter.save()
        try:
            painter.setTransform(view.transform(), True)
            painter.setBrush(Qt.BrushStyle.NoBrush)
            fine = sum(path.elementCount() for path in self._selected) > MANY
            painter.setPen(_round_pen(painter, colour, FINE if fine else SELECTED_WIDTH))
            for path in self._selected:
                painter.drawPath(path)
                yield
        finally:
            painter.restore()

    def curve_steps(
        self, painter: QPainter, view: ViewTransform, box: Box, theme: Theme, *, without: tuple[str, ...] = ()
    ) -> Iterator[None]:
        """Paint what lies in a box in mm, but for some layers, with pauses; the painter works in screen px."""
        paths = [
            LayerPath(layer, path)
            for chunk in self._seen(box)
            for layer, path in chunk.paths.items()
            if layer not in without
        ]
        yield from self._path_steps(painter, view, paths, NoteLook(theme.ink, FINE if self.fine else PART_WIDTH))

    def coarse_steps(self, painter: QPainter, view: ViewTransform, theme: Theme) -> Iterator[None]:
        """Paint all curves with the finest pens, with pauses; the painter works in screen px."""
        paths = [LayerPath(*layered) for chunk in self.lookup.chunks for layered in chunk.paths.items()]
        yield from self._path_steps(painter, view, paths, NoteLook(theme.ink, FINE))

    def _path_steps(
        self, painter: QPainter, view: ViewTransform, paths: list[LayerPath], look: NoteLook
    ) -> Iterator[None]:
        painter.save()
        try:
            painter.setTransform(view.transform(), True)
            painter.setBrush(Qt.BrushStyle.NoBrush)
            for layer, path in paths:
                painter.setPen(_round_pen(painter, QColor(self._colours.get(layer) or look.colour), look.width))
                painter.drawPath(path)
                yield
        finally:
            painter.restore()

    def _seen(self, box: Box) -> list[EntityChunk]:
        return [
            c
            for c in self.lookup.chunks
            if c.box[0] <= box[2] and c.box[2] >= box[0] and c.box[1] <= box[3] and c.box[3] >= box[1]
        ]

    def nearest(self, at: Point, reach: float) -> Entity | Note | None:
        """Return what is nearest to a point within `reach` mm, not on a locked layer, or None."""
        return next(iter(self.candidates(at, reach)), None)

    def candidates(self, at: Point, reach: float) -> list[Entity | Note]:
        """Return everything within `reach` mm of a point that is not on a locked layer, nearest first, of equals the
        latest drawn.
        """
        found: list[_NearThing] = []
        for entity in self._near(at, reach):
            if entity.layer not in self._locked and (distance := distance_to(entity.curve, at)) <= reach:
                found.append(_NearThing(distance, -entity.id, entity))
        for note in self.notes.notes:
            if note.layer not in self._locked and (distance := note_distance(note, at, reach)) <= reach:
                found.append(_NearThing(distance, -note.id, note))
        return [each.thing for each in sorted(found, key=lambda each: (each.distance, each.order))]

    def near_curves(self, at: Point, reach: float) -> list[Curve]:
        """Return the curves within `reach` mm of a point, nearest first."""
        found = [(distance_to(e.curve, at), e.id, e.curve) for e in self._near(at, reach)]
        return [curve for distance, _, curve in sorted(found, key=lambda row: row[:2]) if distance <= reach]

    def near_guides(self, at: Point, reach: float) -> list[Line]:
        """Return the construction lines within `reach` mm of a point."""
        return self.notes.near_guides(at, reach)

    def near_points(self, at: Point, reach: float) -> list[Snap]:
        """Return the points to snap to within `reach` mm of a point that curves and notes have by themselves."""
        found = (snap for entity in self._reached(self.lookup.held, at, reach) for snap in snaps_of(entity.curve))
        within = [s for s in found if abs(s.point[0] - at[0]) <= reach and abs(s.point[1] - at[1]) <= reach]
        return [*within, *self.notes.near_points(at, reach)]

    def _near(self, at: Point, reach: float) -> list[Entity]:
        """Return the entities whose boxes reach near a point."""
        return self._reached(self.lookup.boxes, at, reach)

    def _reached(self, boxes: NDArray[np.float64], at: Point, reach: float) -> list[Entity]:
        near = (
            (boxes[:, 0] <= at[0] + reach)
            & (boxes[:, 2] >= at[0] - reach)
            & (boxes[:, 1] <= at[1] + reach)
            & (boxes[:, 3] >= at[1] - reach)
        )
        return [self.lookup.entities[row] for row in np.flatnonzero(near)]


def _box(row: list[float]) -> Box:
    x0, y0, x1, y1 = row
    return (x0, y0, x1, y1)


def _round_pen(painter: QPainter, colour: QColor, width: float) -> QPen:
    pen = screen_pen(painter, colour, width)
    pen.setCapStyle(Qt.PenCapStyle.RoundCap)
    pen.setJoinStyle(Qt.PenJoinStyle.RoundJoin)
    return pen
