"""A path along a wall becomes a stroke: leads at its ends, its rows cut at tabs, dog-bones in its corners."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...geometry.primitives import Rows
from ...model.moves import Purpose
from ...toolpath.build import Stroke
from ...toolpath.leads.contour_path import ContourPath, ContourPaths, Floats
from ...toolpath.leads.lead import PathWithLeads
from ...toolpath.leads.tab import spans_of, under_tabs
from .dogbone import CornerRelief, inserted

_NONE = np.zeros(0)

_POINT = 0.01
"""mm; a shorter path is a plunge, which has neither tabs nor corners."""


@dataclass(frozen=True)
class StrokeExtras:
    """What a path along a wall goes over and into.

    Attributes:
        half: how far before and behind its middle a path goes over a tab, mm.
        top: height of tabs, mm.
        corner_reliefs: ways into corners.
    """

    half: float = 0.0
    top: float = 0.0
    corner_reliefs: Sequence[CornerRelief] = ()


def strokes_of(
    runs: Sequence[PathWithLeads], tabs: Sequence[Sequence[float]], extras: StrokeExtras
) -> tuple[Stroke, ...]:
    """Return the strokes of some paths.

    Args:
        tabs: their middles on each path, mm along it.
    """
    if not runs:
        return ()
    joined = ContourPaths.of([run.path for run in runs])
    spans = [spans_of(run.path, places, extras.half) if places else [] for run, places in zip(runs, tabs, strict=True)]
    start, stop = np.array([run.start for run in runs]), np.array([run.stop for run in runs])
    point = joined.lengths < _POINT
    start, stop = np.where(point, 0.0, start), np.where(point, 1.0, stop)
    breaks = [_breaks(run.path, own) if own else _NONE for run, own in zip(runs, spans, strict=True)]
    found, middle = joined.spans(start, stop, breaks)
    strokes = []
    for k, run in enumerate(runs):
        mine = slice(*found.first[k : k + 2].tolist())
        strokes.append(
            Stroke(run.path.rows, np.full(len(run.path.rows), Purpose.CONTOUR, np.uint8), run.path.region)
            if point[k]
            else _stroke(run, _CutRows(found.rows[mine], middle[mine]), spans[k], extras)
        )
    return tuple(strokes)


class _CutRows(NamedTuple):
    """Rows of a path, and how far along it the middle of each is, mm."""

    rows: Rows
    middle: Floats


def _stroke(run: PathWithLeads, cut: _CutRows, spans: Sequence[tuple[float, float]], extras: StrokeExtras) -> Stroke:
    """Return the stroke of a path.

    Args:
        cut: from beginning to end.
        spans: (from, to) of its tabs, mm.
    """
    rows, where, relief = inserted(*cut, extras.corner_reliefs)
    over = under_tabs(run.path, where, spans)
    purpose = np.where(relief, Purpose.DOG_BONE, np.where(over, Purpose.TAB, Purpose.CONTOUR))
    ends = [np.full(len(way), Purpose.LEAD) for way in (run.way_in, run.way_out)]
    least_z = None
    if over.any():
        free = [np.full(len(way), -np.inf) for way in (run.way_in, run.way_out)]
        least_z = np.concatenate([free[0], np.where(over, extras.top, -np.inf), free[1]])
    return Stroke(
        np.concatenate([run.way_in, rows, run.way_out]),
        np.concatenate([ends[0], purpose, ends[1]]).astype(np.uint8),
        run.path.region,
        least_z,
    )


def _breaks(path: ContourPath, spans: Sequence[tuple[float, float]]) -> Floats:
    ends = np.array([end for span in spans for end in span], dtype=np.float64)
    return ends % path.length if path.closed else ends
