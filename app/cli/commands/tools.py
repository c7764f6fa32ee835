"""`hitofude tools`: which tools a drawing wants: narrowest passage, smallest inner radius, the largest tool that still
clears.
"""

from __future__ import annotations

import argparse
import json
import math
from pathlib import Path

from ...core.atomic import write_together
from ...formats.job.toml import read_units
from ...formats.readers import offered_suffixes
from ...formats.tools.files import read_tools
from ...model.operation import LEAST_LENGTH
from ...toolpath.advice.advise import RegionAdvice
from ...toolpath.advice.time import CuttingPlan
from ...usecases.advice import AdviceOptions, ToolAdvice, advice_for
from ..command import CliCommand, OptionParser
from ..files import check_outputs, read_input, shown_progress
from ..output import finding_lines, tell
from ..reading_options import add_reading_options, reading
from ..signals import StopFlag, undisturbed
from ..values import join_tolerance, number, typed

TOLD = 12
"""Regions that are printed; the report has all."""

EPILOG = """\
Prints for each area the narrowest passage, the largest disc, the smallest inner radius and the largest tool that
leaves nothing but sharp inner corners; then what each tool reaches and leaves, and which two to take. Times are
estimates with each tool's feeds. Exit status 0: done; 1: with findings about the drawing; 2: something cannot be used.
"""


def _run(arguments: argparse.Namespace, stopped: StopFlag) -> int:
    """Do the work and return the exit status: 0 clean, 1 with findings."""
    if arguments.report is not None:
        check_outputs(
            {"report": arguments.report}, [path for path in (arguments.drawing, arguments.tools) if path is not None]
        )
    options = _options(arguments)
    progress = shown_progress(arguments.quiet, stopped)
    advised = advice_for(arguments.drawing.name, read_input(arguments.drawing), options, progress)
    progress.step(1.0)
    if arguments.report is not None:
        with undisturbed():
            write_together(
                {arguments.report: (json.dumps(advised.report(), indent=2, allow_nan=False) + "\n").encode()}
            )
    if not arguments.quiet:
        tell("\n".join(_lines(arguments.drawing.name, advised)))
    return 1 if any(finding.counts for finding in advised.findings) else 0


def _add_options(parser: OptionParser) -> None:
    parser.add_argument(
        "drawing", metavar="DRAWING", type=Path, help=f"the drawing or project, {' '.join(offered_suffixes())}"
    )
    parser.add_argument(
        "--tools",
        metavar="FILE",
        type=Path,
        help="tools to choose from, .toml, .csv or .tbl (default: end mills from 1 to 25 mm as they are sold)",
    )
    parser.add_argument(
        "--depth", metavar="Z", type=number("depth", least=LEAST_LENGTH), default=2.0, help="of the floor (default 2)"
    )
    parser.add_argument(
        "--stepdown",
        metavar="MM",
        type=number("stepdown", least=LEAST_LENGTH),
        default=2.0,
        help="of one pass (default 2)",
    )
    parser.add_argument(
        "--units", metavar="mm|in", type=typed(read_units), help="units of a drawing that names none (default mm)"
    )
    parser.add_argument("--layer", metavar="NAME", action="append", default=[], help="only this layer; may be repeated")
    add_reading_options(parser)
    parser.add_argument(
        "--join-tolerance", metavar="MM", type=join_tolerance, help="join loose ends nearer than this (default 0.01)"
    )
    parser.add_argument("--report", metavar="R.json", type=Path, help="everything that was found, as JSON")
    parser.add_argument("--quiet", action="store_true", help="say nothing but errors")


def _options(arguments: argparse.Namespace) -> AdviceOptions:
    tools = () if arguments.tools is None else read_tools(arguments.tools.name, read_input(arguments.tools))[0].tools
    plan = CuttingPlan(depth=arguments.depth, stepdown=min(arguments.stepdown, arguments.depth))
    return AdviceOptions(
        tuple(tools), plan, arguments.units, tuple(arguments.layer), arguments.join_tolerance, reading(arguments)
    )


def _lines(name: str, advised: ToolAdvice) -> list[str]:
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
            else f"; about {_clock(each.times.total)} min with T{advice.contour.number} for the walls"
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


def _clock(seconds: float) -> str:
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes}:{rest:02d}"


COMMAND = CliCommand(
    "tools",
    "drawing",
    "the drawing",
    "Tell which tools a drawing wants.",
    EPILOG,
    _add_options,
    _run,
)
