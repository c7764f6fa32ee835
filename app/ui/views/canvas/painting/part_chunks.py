"""A drawing cut into chunks by entity number, so that one edit redoes one chunk and not ten thousand curves."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import groupby

import numpy as np
from numpy.typing import NDArray
from PySide6.QtGui import QPainterPath

from .....geometry.sample import Box, bounds
from .....model.curves import Arc, Curve, Ellipse
from .....model.part import Entity, Part
from ..snap import axis_ends
from .curve_path import curve_path

_BITS = 6

_FEW = 8
"""Changes of more chunks than these are not told one by one."""


@dataclass(frozen=True)
class EntityChunk:
    """Entities whose numbers differ in the last 6 bits only.

    Attributes:
        entities: the entities.
        paths: painter path in mm of each layer.
        boxes: (n, 4) x0, y0, x1, y1 of each entity, mm.
        box: of all of them.
        held: (n, 4) boxes that take in the points to snap to as well: centres may lie off the curve.
    """

    entities: tuple[Entity, ...]
    paths: dict[str, QPainterPath]
    boxes: NDArray[np.float64]
    box: Box
    held: NDArray[np.float64]


class PartChunks:
    """The chunks of the part that was given last, and what is looked up in all of them at once.

    Attributes:
        chunks: chunks of the entities that can be seen, in the order of drawing.
        entities, boxes: those entities and their (n, 4) boxes, mm, row for row.
        held: (n, 4) boxes of those entities with their points to snap to, mm.
    """

    def __init__(self) -> None:
        """Begin with an empty drawing."""
        self.chunks: list[EntityChunk] = []
        self.entities: tuple[Entity, ...] = ()
        self.boxes: NDArray[np.float64] = np.zeros((0, 4))
        self.held: NDArray[np.float64] = np.zeros((0, 4))
        self._cache: dict[int, EntityChunk] = {}

    def update(self, part: Part) -> list[Box] | None:
        """Take over another part; chunks whose entities are the same are kept.

        Returns:
            Boxes in mm of what comes, goes or changes; None when that is too much to be told.
        """
        hidden = {layer.name for layer in part.layers if not layer.visible}
        seen = [e for e in part.entities if e.layer not in hidden] if hidden else part.entities
        groups = {key: tuple(group) for key, group in _by_number(seen)}
        before, self._cache = self._cache, {key: self._chunk(key, group) for key, group in groups.items()}
        self.chunks = list(self._cache.values())
        self.entities = tuple(e for chunk in self.chunks for e in chunk.entities)
        self.boxes = np.concatenate([c.boxes for c in self.chunks]) if self.chunks else np.zeros((0, 4))
        self.held = np.concatenate([c.held for c in self.chunks]) if self.chunks else np.zeros((0, 4))
        changed = [key for key in before.keys() | self._cache.keys() if before.get(key) is not self._cache.get(key)]
        if len(changed) > _FEW:
            return None
        return [box for key in changed for box in _differing(before.get(key), self._cache.get(key))]

    @property
    def box(self) -> Box | None:
        """x0, y0, x1, y1 of everything that can be seen, mm, or None."""
        if not len(self.boxes):
            return None
        (x0, y0), (x1, y1) = self.boxes[:, :2].min(axis=0), self.boxes[:, 2:].max(axis=0)
        return (float(x0), float(y0), float(x1), float(y1))

    def _chunk(self, key: int, entities: tuple[Entity, ...]) -> EntityChunk:
        old = self._cache.get(key)
        return old if old is not None and old.entities == entities else _built(entities)


def _differing(a: EntityChunk | None, b: EntityChunk | None) -> list[Box]:
    """Return the boxes of the entities that only one of two chunks has."""
    of = [dict(zip(c.entities, c.boxes.tolist(), strict=True)) if c is not None else {} for c in (a, b)]
    return [
        (x0, y0, x1, y1)
        for own, other in (of, of[::-1])
        for entity, (x0, y0, x1, y1) in own.items()
        if entity not in other
    ]


def _by_number(entities: Iterable[Entity]) -> Iterable[tuple[int, Iterable[Entity]]]:
    return groupby(sorted(entities, key=lambda e: e.id), key=lambda e: e.id >> _BITS)


def _built(entities: tuple[Entity, ...]) -> EntityChunk:
    layers = dict.fromkeys(e.layer for e in entities)
    paths = {layer: curve_path(*(e.curve for e in entities if e.layer == layer)) for layer in layers}
    listed = [bounds(e.curve) for e in entities]
    boxes = np.array(listed)
    (x0, y0), (x1, y1) = boxes[:, :2].min(axis=0), boxes[:, 2:].max(axis=0)
    held = np.array([_held(e.curve, box) for e, box in zip(entities, listed, strict=True)])
    return EntityChunk(entities, paths, boxes, (float(x0), float(y0), float(x1), float(y1)), held)


def _held(curve: Curve, box: Box) -> Box:
    """Return the box of a curve and of its points to snap to."""
    if not isinstance(curve, Arc | Ellipse):
        return box
    points = [curve.centre] if isinstance(curve, Arc) else [curve.centre, *axis_ends(curve)]
    xs, ys = zip(box[:2], box[2:], *points, strict=True)
    return (min(xs), min(ys), max(xs), max(ys))
