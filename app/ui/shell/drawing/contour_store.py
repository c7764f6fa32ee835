"""The contours of the drawing as the job machines it, chained once for all who look at them beside the window."""

from __future__ import annotations

from dataclasses import replace
from threading import Lock
from typing import TYPE_CHECKING

from ....model.job import Copies, Job

if TYPE_CHECKING:
    from ....toolpath.drawn_contours import DrawnContours


class ContourStore:
    """Keeps the contours that were asked for last; who asks for the same ones at a time waits for them."""

    def __init__(self) -> None:
        self._lock = Lock()
        self._kept: tuple[Job, DrawnContours] | None = None

    def of(self, job: Job) -> DrawnContours:
        """Return the contours of a job's drawing, without copies; chaining takes time: never on the window's thread."""
        from ....toolpath.drawn_contours import drawn_contours

        with self._lock:
            if self._kept is None or not same_contours(self._kept[0], job):
                self._kept = job, drawn_contours(replace(job, copies=Copies()))
            return self._kept[1]


def same_contours(one: Job, other: Job) -> bool:
    """Tell whether two jobs machine the same contours of the same drawing."""

    def layers(job: Job) -> object:
        return job.layer_names, job.keep_out_layers, [(each.cut.curves, each.cut.enabled) for each in job.operations]

    def drills(job: Job) -> object:
        tools = {tool.number: tool for tool in job.tools}
        return [(each, tools.get(each.cut.tool)) for each in job.operations if each.HOLES]

    return (
        drills(one) == drills(other)
        and one.part is other.part
        and one.join_tolerance == other.join_tolerance
        and layers(one) == layers(other)
    )
