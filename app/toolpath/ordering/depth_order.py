"""In which order the strokes of an operation are cut."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import groupby

import numpy as np

from ...core.progress import NO_PROGRESS, Progress
from ...model.curves import Point
from ..build import Stroke
from .tour import in_short_order


def in_order(strokes: Sequence[Stroke], start: Point, progress: Progress = NO_PROGRESS) -> list[list[Stroke]]:
    """Return strokes in groups that stay together, those of lower rank first, otherwise with short travel between them.

    Args:
        start: where the tool is before, mm.

    Raises:
        Cancelled: by progress.
    """
    groups: list[list[Stroke]] = []
    for stroke in strokes:
        if not len(stroke.rows):
            continue
        if stroke.follows and groups:
            groups[-1].append(stroke)
        else:
            groups.append([stroke])
    ordered: list[list[Stroke]] = []
    for _, some in groupby(sorted(groups, key=_rank), _rank):
        members = list(some)
        whole = [_as_one(group) for group in members]
        place = {id(one): group for one, group in zip(whole, members, strict=True)}
        ordered.extend(
            place[id(one)] for one in in_short_order(whole, ordered[-1][-1].end if ordered else start, progress)
        )
    return ordered


def _rank(group: list[Stroke]) -> int:
    return group[0].rank


def _as_one(group: list[Stroke]) -> Stroke:
    """Return a stroke that begins where a group does and ends where it does, for the sake of its ends."""
    rows = np.array([[*group[0].start, *group[-1].end, 0.0, 0.0, 0.0, 0.0]])
    return replace(group[0], rows=rows, purpose=group[0].purpose[:1], least_z=None)
