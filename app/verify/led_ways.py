"""Where cutters that are led along some ways, each when its motion is about to begin, meet metal."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..core.progress import NO_PROGRESS, Progress
from ..simulation.cutter import Cutter
from ..simulation.field.workpiece import Workpiece
from ..simulation.sweeps.course import Course
from ..simulation.sweeps.trim import RapidHit, trim
from .closer import MOST, NARROW, Metal, Way
from .course import inserted, straight


@dataclass(frozen=True)
class Led:
    """What ways meet.

    Attributes:
        hits: of each way that meets metal, by its number, those of its legs.
        unseen: how many ways of narrow cutters could not be looked at closer.
    """

    hits: Mapping[int, tuple[RapidHit, ...]]
    unseen: int = 0


def hits_along(metal: Metal, before: Workpiece, ways: Sequence[Way], progress: Progress = NO_PROGRESS) -> Led:
    """Return where ways beside the last program of some meet metal, those of cutters narrower than a cell looked at
    closer.

    Args:
        before: the metal before that program.

    Raises:
        Cancelled: the job was asked to stop.
    """
    top, pitch = float(before.heights.max()), before.grid.pitch
    asked, cutters, owner = _with_ways(metal.courses[-1], metal.cutters, ways)
    found: dict[int, tuple[RapidHit, ...]] = {}
    for hit in trim(before, asked, cutters, progress=progress.part(0.0, 0.5)).rapids:
        if owner[hit.motion] >= 0:
            found[owner[hit.motion]] = (*found.get(owner[hit.motion], ()), hit)
    narrow = [k for k, way in enumerate(ways) if k not in found and way.cutter.radius < NARROW * pitch]
    for done, k in enumerate(narrow[:MOST]):
        progress.step(0.5 + 0.5 * done / len(narrow), "Looking at plunges")
        closer = metal.met(ways[k], top, pitch)
        if closer is not None:
            found[k] = (closer,)
    return Led(found, max(0, len(narrow) - MOST))


def _with_ways(
    course: Course, cutters: Mapping[int, Cutter], ways: Sequence[Way]
) -> tuple[Course, dict[int, Cutter], list[int]]:
    """Return a course that is asked along some ways too, all cutters, and to which way each motion belongs, -1: to
    none.
    """
    radii = sorted({way.cutter.radius for way in ways})
    first = int(max([*cutters, course.tool.max()])) + 1
    all_cutters = {**cutters, **{first + k: Cutter(radius, radius) for k, radius in enumerate(radii)}}
    parts = [way.course().motions for way in ways]
    sizes = [len(part) for part in parts]
    more = straight(np.concatenate([part.start for part in parts]), np.concatenate([part.end for part in parts]))
    tool = np.repeat([first + radii.index(way.cutter.radius) for way in ways], sizes).astype(np.int32)
    made, owner = inserted(course, np.repeat([way.row for way in ways], sizes), more, tool)
    way_of = np.append(np.repeat(np.arange(len(ways)), sizes), -1)
    return made, all_cutters, way_of[owner].tolist()
