"""What `tools` prints."""

from __future__ import annotations

import math

from ..core.wording import minutes_words
from ..toolpath.advice.advise import RegionAdvice
from ..usecases.advice import ToolAdvice
from .output import finding_lines

TOLD = 12
"""Regions that are printed; the report has all."""


def advice_lines(name: str, advised: ToolAdvice) -> list[str]:
    """Return what was found, for people."""
    advice = advised.advice
    regions = [f"  {_region_words(region)}" for region in advice.regions[:TOLD]]
    more = (
        [f"  - {len(advice.regions) - TOLD} more areas; --report R.json lists them all"]
        if len(advice.regions) > TOLD
        else []
    )
    tools = [
        f"  T{each.tool.number} {each.tool.label}: reaches {each.share:.2%}, leaves {each.left_mm2:.3f} mm2"
        + (
            ""
            if each.times is None
            else f"; about {minutes_words(each.times.total)} min with T{advice.contour.number} for the walls"
        )
        for each in advice.choices
        if each.share > 0
    ]
    pocket, contour = advice.pocket, advice.contour
    both = (
        f"T{contour.number} {contour.label} alone"
        if pocket is contour
        else (f"T{pocket.number} {pocket.label} to clear, T{contour.number} {contour.label} along the walls")
    )
    return [f"{name}: take {both}. {advice.why}", *regions, *more, *tools, *finding_lines(advised.findings)]


def _region_words(region: RegionAdvice) -> str:
    passage, disc, clearing = region.passage, region.disc, region.clearing
    radius = region.smallest_radius
    inner = (
        f"{region.corners} sharp inner corner{'' if region.corners == 1 else 's'}"
        if region.corners
        else "no inner corner"
        if math.isinf(radius)
        else f"smallest inner radius {radius:.3f} mm"
    )
    return (
        f"Area {region.number}, {region.area_mm2:.1f} mm2: narrowest passage {passage.size:.3f} mm at "
        f"({passage.x:.3f}, {passage.y:.3f}), largest disc {disc.size:.3f} mm, {inner}; "
        f"largest tool that clears {clearing.size:.3f} mm"
    )
