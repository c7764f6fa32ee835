"""Connected nets of edges: whose contours they are of, what lies round them, and the contours that are made of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core import tolerances
from ...model.part import Contour
from ..distance import DistanceField
from ..primitives import Rows, boxes, lengths, reversed_rows, row_curve, signed_area
from .loops import loops_along, loops_in_pairs
from .node_order import NodeOrder, turn_of
from .nodes import PlanarEdges, RowPieces, edges_of
from .sides import FaceCounts, Faces, faces_of

Indices = NDArray[np.int64]
Flags = NDArray[np.bool_]

_SLIVER = tolerances.WELD / 4
"""mm; loops whose area is less than this times their length are what merging leaves of edges that nearly coincide."""


@dataclass(frozen=True, eq=False)
class PlanarGraph:
    """Pieces as edges, their order round the nodes, and the faces between them; several connected nets as a rule.

    Attributes:
        members: contours of each connected net, rising.
    """

    pieces: RowPieces
    edges: PlanarEdges
    turn: NodeOrder
    faces: Faces
    members: tuple[tuple[int, ...], ...]

    @staticmethod
    def of(pieces: RowPieces) -> PlanarGraph:
        """Return the net of some pieces, one or more."""
        edges = edges_of(pieces)
        turn = turn_of(edges)
        faces = faces_of(edges, turn)
        pairs = np.unique(np.stack([faces.net[edges.of], pieces.contour], 1), axis=0)
        stops = np.searchsorted(pairs[:, 0], np.arange(len(faces.outer)), side="right")[:-1]
        members = tuple(tuple(each.tolist()) for each in np.split(pairs[:, 1], stops))
        return PlanarGraph(pieces, edges, turn, faces, members)

    def loops(self, odd: Flags, counts: FaceCounts) -> list[list[list[int]]]:
        """Return for each connected net the loops of ends that bound its area; see `loops`.

        Args:
            odd: (n,) True for edges along which an odd number of contours runs.
        """
        inside = (counts.odd & (counts.held == 0))[self.faces.left]
        left, right = inside[::2], inside[1::2]
        wall = left & right & (self.faces.left[::2] != self.faces.left[1::2]) & ~odd
        whole = ~counts.torn[self.faces.net]
        kept = np.empty(2 * len(odd), np.bool_)
        kept[::2], kept[1::2] = (left & ~right | wall) & whole, (right & ~left | wall) & whole
        found = loops_along(self.edges, self.turn, kept)
        if not whole.all():
            found += loops_in_pairs(self.edges, self.turn, np.repeat(odd & ~whole, 2))
        loops: list[list[list[int]]] = [[] for _ in self.members]
        for loop in found:
            loops[int(self.faces.net[loop[0] // 2])].append(loop)
        return loops

    def contours(self, loops: Sequence[Sequence[int]], members: Sequence[Contour]) -> list[Contour]:
        """Return loops as contours that name all entities of some contours; slivers are left out."""
        ids = tuple(dict.fromkeys(number for contour in members for number in contour.entity_ids))
        deviation = max((contour.deviation for contour in members), default=0.0)
        made = []
        for loop in loops:
            rows = self._rows(np.array(loop))
            if abs(signed_area(rows)) > _SLIVER * float(lengths(rows).sum()):
                made.append(Contour(tuple(map(row_curve, rows)), True, members[0].layer, ids, deviation))
        return made

    def _rows(self, ends: Indices) -> Rows:
        """Return the rows along some ends."""
        rows = self.edges.rows[ends // 2].copy()
        back = ends % 2 == 1
        rows[back] = reversed_rows(rows[back])[::-1]
        return rows

    def held_by(self, rows: Sequence[Rows]) -> tuple[Indices, Indices]:
        """Return (net, contour), each (m,), of contours that go round nets of which they are no part.

        Args:
            rows: of each contour.
        """
        first = np.unique(self.faces.net, return_index=True)[1]
        points = self.edges.rows[first, :2]
        own = np.full(len(rows), -1)
        for number, members in enumerate(self.members):
            own[list(members)] = number
        nets, held = [], []
        for k, each in enumerate(rows):
            around = boxes(each)
            low, high = around[:, :2].min(axis=0), around[:, 2:].max(axis=0)
            near = np.flatnonzero(((points >= low) & (points <= high)).all(axis=1))
            near = near[near != own[k]]
            if len(near):
                nets.append(near[DistanceField.of(each).inside(points[near])])
                held.append(np.full(len(nets[-1]), k))
        none = [np.zeros(0, np.int64)]
        return np.concatenate(none + nets), np.concatenate(none + held)
