"""Dog-bones: at inner corners the cutter goes on into the corner, so that a sharp counterpart fits."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from ...core.progress import Progress
from ...geometry.distance import DistanceField
from ...geometry.primitives import CX, CY, TURN, Indices, R, Rows, boxes, lengths
from ...model.finding import Finding, FindingKind
from ...model.moves import DogBone
from ...toolpath.leads.contour_path import Floats, fractions_at, headings_at, keep_clear, line_row
from ...toolpath.machining_areas import MachiningArea
from .gaps import WallGap

LEAST_TURN = math.radians(20)
"""A ring that turns less at a corner needs no dog-bone."""

_LEAST = 0.01
"""mm; a shorter way into a corner is none."""

_SMOOTH = 0.15
"""Radians; rows of a wall that turn less where they meet are one wall."""


@dataclass(frozen=True)
class CornerRelief:
    """A way into a corner.

    Attributes:
        corner: where the path turns, mm.
        end: how far the cutter's centre goes into the corner, mm.
    """

    corner: tuple[float, float]
    end: tuple[float, float]


def corner_reliefs(
    found: Iterable[WallGap], area: MachiningArea, distance: float, progress: Progress
) -> tuple[tuple[CornerRelief, ...], list[tuple[float, float]]]:
    """Return the ways into all inner corners, and the corners where the cutter would cut into a third wall, which are
    left as they are.

    The centre goes from where the path turns straight towards the corner, or the middle of the arc in it, until it is
    as far from that as from the walls along the path: there the cutter's rim touches the corner, or leaves the stock to
    leave. Only the two walls of the corner may be nearer. Corners that a clamp makes have none.

    Args:
        distance: of the cutter's centre from the walls, mm.
    """
    made, refused = [], []
    walls = _Walls.of(area)
    for k, gap in enumerate(found):
        if k % 64 == 0:
            progress.step(0.0, "Dog-bones")
        if not gap.is_corner or gap.corner is None or gap.turn < LEAST_TURN:
            continue
        turn = np.array(gap.corner)
        apex = _farthest(gap.rows, turn)
        way = float(np.hypot(*(apex - turn)))
        if way - distance < _LEAST:
            continue
        end = apex + (turn - apex) * (distance / way)
        if walls.spares_others(line_row(turn, end), gap, distance):
            made.append(CornerRelief(gap.corner, (float(end[0]), float(end[1]))))
        else:
            refused.append(gap.corner)
    return tuple(made), refused


def _farthest(rows: Rows, place: Floats) -> Floats:
    """Return the point of a wall that is farthest from a place: a corner, or where an arc runs away from it most."""
    points = [rows[1:, :2]] if len(rows) > 1 else []
    arcs = rows[rows[:, TURN] != 0]
    if len(arcs):
        out = arcs[:, [CX, CY]] - place
        top = arcs[:, [CX, CY]] + out / np.maximum(np.hypot(*out.T), 1e-300)[:, None] * arcs[:, [R]]
        part = fractions_at(arcs, top)
        points.append(top[(part > 0) & (part < 1)])
    points.append(rows[:, :2])
    all_points = np.concatenate(points)
    return np.asarray(all_points[int(np.argmax(np.hypot(*(all_points - place).T)))])


@dataclass(frozen=True, eq=False)
class _Walls:
    """Everything that bounds an area, with the rows before and behind each row."""

    area: MachiningArea
    around: Floats
    previous: Indices
    following: Indices

    @staticmethod
    def of(area: MachiningArea) -> _Walls:
        previous = area.primitives.previous
        following = np.empty(len(previous), np.int64)
        following[previous] = np.arange(len(previous))
        return _Walls(area, boxes(area.distances.rows), previous, following)

    def spares_others(self, way: Rows, gap: WallGap, distance: float) -> bool:
        """Tell whether a way keeps clear of all rows but those of the two walls that meet in its corner."""
        low, high = np.minimum(way[:2], way[2:4]) - distance, np.maximum(way[:2], way[2:4]) + distance
        near = np.flatnonzero((self.around[:, :2] <= high).all(axis=1) & (self.around[:, 2:] >= low).all(axis=1))
        reach = 2 * distance + float(lengths(way[None])[0])
        own = [
            *gap.walls,
            *self._onward(gap.walls[0], self.previous, reach),
            *self._onward(gap.walls[-1], self.following, reach),
        ]
        others = np.setdiff1d(near, own)
        if not len(others):
            return True
        return bool(keep_clear(DistanceField.of(self.area.distances.rows[others]), way[None], np.array([distance]))[0])

    def _onward(self, row: int, step: Indices, reach: float) -> list[int]:
        """Return the rows that go on smoothly from one, up to a length."""
        rows, found, gone = self.area.distances.rows, [], 0.0
        while gone < reach:
            other = int(step[row])
            first, second = (row, other) if step is self.following else (other, row)
            ahead = headings_at(rows[[first]], np.ones(1))[0]
            onward = headings_at(rows[[second]], np.zeros(1))[0]
            if self.area.bare[other] or ahead @ onward < math.cos(_SMOOTH):
                break
            found.append(other)
            gone += float(lengths(rows[[other]])[0])
            row = other
        return found


def inserted(rows: Rows, where: Floats, ways: Sequence[CornerRelief]) -> tuple[Rows, Floats, Floats]:
    """Return (rows, how far along each is, 1 for those of dog-bones) of a path that goes into its corners and back.

    Args:
        rows, where: as of `ContourPath.span`.
        ways: into corners, at least one.
    """
    ends = {relief.corner: relief.end for relief in ways}
    made, along, marks = [], [], []
    for row, place in zip(rows, where.tolist(), strict=True):
        made.append(row)
        along.append(place)
        marks.append(0.0)
        corner = float(row[2]), float(row[3])
        if corner in ends:
            into = line_row(np.array(corner), np.array(ends[corner]))
            made += [into, line_row(into[2:4], into[:2])]
            along += [place, place]
            marks += [1.0, 1.0]
    return np.array(made), np.array(along), np.array(marks)


def recorded(ways: Iterable[CornerRelief], diameter: float) -> list[DogBone]:
    """Return the record of ways into corners."""
    return [DogBone(*relief.corner, *relief.end, diameter) for relief in ways]


def refused_relief_findings(refused: Sequence[tuple[float, float]]) -> list[Finding]:
    """Return one remark about corners that stay without."""
    if not refused:
        return []
    x, y = refused[0]
    text = (
        f"{len(refused)} corners have no dog-bone, because it would cut into another wall; the first is at ({x:.3f}, "
        f"{y:.3f})."
    )
    return [Finding(FindingKind.LEFT_OUT, text, x, y, counts=False, amount=float(len(refused)))]
