"""What all operations cut whose tools cut no thread: on the written text, as read back."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ....model.job import Job
from ....model.motion import Floats
from ....simulation.cutter import Cutter, cutter_of, sure_spacing
from ....simulation.sweeps.course import Course
from ....simulation.sweeps.probe import PROVING_HELIX_CHORD, PathProbe
from ..written import WrittenMotions


@dataclass(frozen=True, eq=False)
class WrittenPlainCuts:
    """Motions of a program to be asked at single points; they are looked at when somebody asks first."""

    job: Job
    motions: WrittenMotions

    @cached_property
    def _cutters(self) -> dict[int, Cutter]:
        used = {each.cut.tool for each in self.job.operations if each.cut.enabled}
        tools = [tool for tool in self.job.tools if tool.number in used and not tool.kind.threads]
        return {tool.number: cutter_of(tool) for tool in tools}

    @cached_property
    def _path(self) -> PathProbe:
        tools = np.array([each.cut.tool for each in self.job.operations], np.int32)
        files = zip(self.motions.files, self.motions.operations, strict=True)
        return PathProbe.of([Course(each, tools[own]) for each, own in files], self._cutters, PROVING_HELIX_CHORD)

    def lowest(self, points: Floats) -> Floats:
        """Return the lowest heights (m,) that are cut at points (m, 2), mm, part coordinates; infinite where nothing
        is.
        """
        x, y, z = self.motions.origin
        found: Floats = self._path.lowest(points - (x, y)).heights + z
        return found

    def spacing(self, depth: float) -> float:
        """Return how far apart points may be, mm, for none of the cutters to pass unseen between two of them whose tip
        is so many mm below what is asked for.
        """
        return sure_spacing(self._cutters.values(), depth)
