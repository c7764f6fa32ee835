"""The compound surface and its boundary points as one table of comma-separated values (RFC 4180), every number to the
last bit.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...surfaces.sections.compound import NO_SURFACE, BoundaryKind, BoundaryPoints, CompoundSurface, SectionRun
from .compute import ComputedScene

COLUMNS = (
    "kind",
    "tool",
    "pass",
    "run",
    "point",
    "surface",
    "name",
    "x",
    "y",
    "z",
    "u",
    "v",
    "to_surface",
    "to_name",
    "end_x",
    "end_y",
    "end_z",
    "to_u",
    "to_v",
)
"""A point's own first; those from `to_surface` on are the other side of a boundary point, and empty elsewhere."""

_NONE = ",,,,,,,"


def scene_points_csv(computed: ComputedScene) -> bytes:
    """Return the compound surfaces of all families of passes, one after another under one header."""
    return points_csv((ToolSurface(each.surface, each.tool.number) for each in computed.families), computed.names)


class ToolSurface(NamedTuple):
    """A compound surface, and the T number of its tool; None = of no tool."""

    surface: CompoundSurface
    tool: int | None = None


def points_csv(surfaces: Iterable[ToolSurface], names: Sequence[str]) -> bytes:
    """Return compound surfaces as a table: a row a point in the order of generation, then a row a boundary point.

    Args:
        names: of the surfaces that they are made of, by number.

    Passes, runs, points and surfaces count from 1. A point's surface is that of the chord behind it, the last one's
    that before it.
    """
    rows = (row for each in surfaces for row in _rows(each, names))
    return "\r\n".join([",".join(COLUMNS), *rows, ""]).encode()


def _rows(made: ToolSurface, names: Sequence[str]) -> Iterator[str]:
    compound, known = made.surface, [_quoted(name) for name in names]
    head = "" if made.tool is None else str(made.tool)
    parameters = _Parameters(compound)
    before: dict[int, int] = {}
    for run in compound.runs:
        before[run.plane] = before.get(run.plane, 0) + 1
        yield from _points(run, f"point,{head},{run.plane + 1},{before[run.plane]}", known, parameters)
    yield from _boundaries(compound.boundaries, head, known)


def _points(run: SectionRun, head: str, names: Sequence[str], parameters: _Parameters) -> Iterator[str]:
    owner = np.append(run.owner, run.owner[-1])
    at = parameters.of(run, owner)
    for number, (surface, (x, y, z), (u, v)) in enumerate(zip(owner.tolist(), run.points.tolist(), at, strict=True), 1):
        yield f"{head},{number},{surface + 1},{names[surface]},{x!r},{y!r},{z!r},{u},{v}{_NONE}"


def _boundaries(found: BoundaryPoints, head: str, names: Sequence[str]) -> Iterator[str]:
    columns = (
        found.plane,
        found.before,
        found.after,
        found.kind,
        found.place,
        found.end,
        found.before_at,
        found.after_at,
    )
    rows = zip(*(column.tolist() for column in columns), strict=True)
    for number, (plane, i, j, kind, (x, y, z), (ex, ey, ez), (ui, vi), (uj, vj)) in enumerate(rows, 1):
        one, other = (("", "") if k == NO_SURFACE else (str(k + 1), names[k]) for k in (i, j))
        name = BoundaryKind(kind).name.lower()
        yield (
            f"{name},{head},{plane + 1},,{number},{one[0]},{one[1]},{x!r},{y!r},{z!r},{_known(ui)},{_known(vi)},"
            f"{other[0]},"
            f"{other[1]},{ex!r},{ey!r},{ez!r},{_known(uj)},{_known(vj)}"
        )


class _Parameters:
    """u, v of a compound surface's points: those of the surfaces' own section curves at the same places."""

    def __init__(self, compound: CompoundSurface) -> None:
        self._by_curve: dict[tuple[int, int], dict[tuple[float, ...], tuple[str, str]]] = {}
        for curve in compound.curves:
            places = self._by_curve.setdefault((curve.plane, curve.owner), {})
            for point, (u, v) in zip(curve.points.tolist(), curve.parameters.tolist(), strict=True):
                places[tuple(point)] = (_known(u), _known(v))
        marks = compound.boundaries
        for owners, places_of, at in (
            (marks.before, marks.place, marks.before_at),
            (marks.after, marks.end, marks.after_at),
        ):
            for plane, owner, point, (u, v) in zip(
                *(each.tolist() for each in (marks.plane, owners, places_of, at)), strict=True
            ):
                self._by_curve.setdefault((plane, owner), {}).setdefault(tuple(point), (_known(u), _known(v)))

    def of(self, run: SectionRun, owner: NDArray[np.int64]) -> list[tuple[str, str]]:
        """Return u and v of a run's points as texts, empty where they are not known."""
        nothing: dict[tuple[float, ...], tuple[str, str]] = {}
        return [
            self._by_curve.get((run.plane, surface), nothing).get(tuple(point), ("", ""))
            for surface, point in zip(owner.tolist(), run.points.tolist(), strict=True)
        ]


def _known(value: float) -> str:
    return "" if math.isnan(value) else repr(value)


def _quoted(name: str) -> str:
    """Return a name as one field."""
    return '"' + name.replace('"', '""') + '"' if any(letter in name for letter in ',"\r\n') else name
