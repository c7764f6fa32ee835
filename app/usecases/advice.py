"""Which tools a drawing wants: read, regions found, asked."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field, replace
from typing import Any

from ..core.errors import GeometryError
from ..core.progress import NO_PROGRESS, Progress
from ..model.finding import Finding
from ..model.job import Job
from ..model.part import Units
from ..model.read_options import AS_DRAWN, DrawingOptions
from ..model.reading import ReadingOptions
from ..model.tool import Tool
from ..operations.compute import regions_of
from ..toolpath.advice.advise import Advice, CuttingPlan, RegionAdvice, ToolChoice, advise, standard_tools
from .job.options import with_layers_spelled
from .job.plausible import read_plausible

Json = dict[str, Any]


@dataclass(frozen=True)
class AdviceOptions:
    """What was asked.

    Attributes:
        tools: to choose from; none = end mills of the usual diameters.
        plan: depth and passes, for the estimates of time.
        units: of a drawing that names none. layers: to machine; empty = all visible ones.
        join_tolerance: mm; None = the default job's.
        reading: what else is said about reading the drawing.
    """

    tools: tuple[Tool, ...] = ()
    plan: CuttingPlan = field(default_factory=CuttingPlan)
    units: Units | None = None
    layers: tuple[str, ...] = ()
    join_tolerance: float | None = None
    reading: DrawingOptions = AS_DRAWN


@dataclass(frozen=True)
class ToolAdvice:
    """What a drawing wants, and what there is to say about it."""

    advice: Advice
    findings: tuple[Finding, ...]

    def report(self) -> Json:
        """Return it as plain values: lengths in mm, areas in mm2, times in s, angles in radians."""
        advice = self.advice
        return {
            "pocket_tool": advice.pocket.number,
            "contour_tool": advice.contour.number,
            "why": advice.why,
            "time_s": advice.times.total,
            "time_parts_s": asdict(advice.times),
            "regions": [_region(region) for region in advice.regions],
            "tools": [_choice(choice) for choice in advice.choices],
        }


def advice_for(name: str, data: bytes, options: AdviceOptions, progress: Progress = NO_PROGRESS) -> ToolAdvice:
    """Return which tools the bytes of a drawing want.

    Args:
        name: file name of the drawing; its suffix tells the format.

    Raises:
        HitofudeError: the drawing or a tool cannot be used, or nothing in it is closed.
        Cancelled: the job was asked to stop.
    """
    progress.step(0.0, f"Reading {name}")
    diameters = [tool.diameter for tool in options.tools or standard_tools()]
    drawing = read_plausible(
        name, data, ReadingOptions(options.units, options.layers, options.reading), lambda _: diameters
    )
    job = Job(drawing.part, layer_names=options.layers)
    if options.join_tolerance is not None:
        job = replace(job, join_tolerance=options.join_tolerance)
    regions, findings = regions_of(with_layers_spelled(job))
    if not regions:
        said = " ".join(finding.text for finding in findings[:3])
        raise GeometryError(
            f"{name}: there is no closed contour to choose tools for; draw one, or choose other layers. {said}".rstrip()
        )
    advice = advise(regions, options.tools, options.plan, progress.part(0.1, 1.0))
    return ToolAdvice(advice, (*findings, *drawing.findings))


def _region(region: RegionAdvice) -> Json:
    def spot(place: Any) -> Json | None:
        return None if place is None else asdict(place)

    return {
        "number": region.number,
        "area_mm2": region.area_mm2,
        "narrowest_passage": spot(region.passage),
        "largest_disc": spot(region.disc),
        "largest_tool_that_clears": spot(region.clearing),
        "sharp_corners": region.corners,
        "smallest_inner_radius": spot(region.inner_radius),
    }


def _choice(choice: ToolChoice) -> Json:
    return {
        "number": choice.tool.number,
        "diameter_mm": choice.tool.diameter,
        "share": choice.share,
        "areas": choice.parts,
        "left_mm2": choice.left_mm2,
        "left_disc_mm": choice.left_disc,
        "time_s": None if choice.times is None else choice.times.total,
    }
