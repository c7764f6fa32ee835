"""How long a job will take, reckoned before it is computed."""

from __future__ import annotations

from collections.abc import Sequence

from ..core.effort import Reckoning
from ..core.wording import counted
from ..model.job import Job
from ..model.part import Region
from .effort import CONTOUR_S, ISLAND_S, workload_of
from .registry import method_of


def job_effort(job: Job, regions: Sequence[Region]) -> Reckoning:
    """Return what a job takes whose contours bound some regions."""
    extent = workload_of(regions)
    seconds = extent.regions * CONTOUR_S + extent.islands * ISLAND_S
    worst, most = "", 0.0
    for operation in job.operations:
        if operation.cut.enabled:
            tool = job.tool(operation.cut.tool)
            own = method_of(operation).effort(extent, operation, tool)
            seconds += own
            if own > most:
                worst, most = f"{operation.WORD} with {tool.diameter:g} mm", own
    contours = counted(extent.regions + extent.islands, "contour", thousands=",")
    about = f"{extent.area:,.0f} mm2 within {contours} of {extent.pieces:,} lines and arcs"
    about += f", {worst} for the most part" if most > seconds / 2 else ""
    remedy = "use a larger tool, leave out layers, or check the units" if most > seconds / 2 else "leave out layers"
    return Reckoning(seconds, about, remedy)
