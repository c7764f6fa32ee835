"""A path along a wall becomes a stroke: leads at its ends, its rows cut at tabs, dog-bones in its corners."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...model.moves import Purpose
from ...toolpath.build import Stroke
from ...toolpath.leads.contour_path import Path
from ...toolpath.leads.lead import Run
from ...toolpath.leads.tab import spans_of, under_tabs
from .dogbone import Bone, inserted

_POINT = 0.01
"""mm; a shorter path is a plunge, which has neither tabs nor corners."""


@dataclass(frozen=True)
class Extras:
    """What a path along a wall goes over and into.

    Attributes:
        half: how far before and behind its middle a path goes over a tab, mm.
        top: height of tabs, mm.
        bones: ways into corners.
    """

    half: float = 0.0
    top: float = 0.0
    bones: Sequence[Bone] = ()


def stroke_of(run: Run, tabs: Sequence[float], extras: Extras) -> Stroke:
    """Return the stroke of a path.

    Args:
        tabs: their middles, mm along the path.
    """
    path = run.path
    if path.length < _POINT:
        return Stroke(path.rows, np.full(len(path.rows), Purpose.CONTOUR, np.uint8), path.region)
    spans = spans_of(path, tabs, extras.half)
    rows, where = path.span(run.start, run.stop, _breaks(path, spans))
    rows, where, bone = inserted(rows, where, extras.bones)
    over = under_tabs(path, where, spans)
    purpose = np.where(bone, Purpose.DOG_BONE, np.where(over, Purpose.TAB, Purpose.CONTOUR))
    ends = [np.full(len(way), Purpose.LEAD) for way in (run.way_in, run.way_out)]
    least_z = None
    if over.any():
        free = [np.full(len(way), -np.inf) for way in (run.way_in, run.way_out)]
        least_z = np.concatenate([free[0], np.where(over, extras.top, -np.inf), free[1]])
    return Stroke(
        np.concatenate([run.way_in, rows, run.way_out]),
        np.concatenate([ends[0], purpose, ends[1]]).astype(np.uint8),
        path.region,
        least_z,
    )


def _breaks(path: Path, spans: Sequence[tuple[float, float]]) -> np.ndarray:
    ends = np.array([end for span in spans for end in span], dtype=np.float64)
    return ends % path.length if path.closed else ends
