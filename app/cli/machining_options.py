"""The options of `make` that say how operations are done: sides, entries, leads, tabs, drilling, copies, clamps."""

from __future__ import annotations

import argparse
import math
import re
from collections.abc import Callable

from ..core.errors import HitofudeError, InputError
from ..drafting.expressions.errors import CommandError
from ..drafting.expressions.numbers import angle, length
from ..model.entry import MOST_OVERLAP, EntryKind, LeadKind
from ..model.job import Copies
from ..model.operation import LEAST_LENGTH, MOST_SPRING_PASSES, Side
from ..usecases.machining import Machining
from .parser import number

ON_PIXELS = ("entry", "ramp_angle", "floor_to_leave", "finish_depth", "copies")
"""What can be asked for on pixels too."""


def add_machining_options(group: argparse._ArgumentGroup, holding: argparse._ArgumentGroup) -> None:
    """Add the options to two groups: how it is cut, and how the part is held."""
    group.add_argument("--side", choices=[each.value for each in Side],
                       help="where the contour tool runs: inside the areas (default), outside, or on the lines; outside and on leave the "
                            "area alone unless a job file says otherwise")
    group.add_argument("--entry", choices=[each.value for each in EntryKind],
                       help="into the metal (default helix; what does not fit falls back to a ramp, then a plunge)")
    group.add_argument("--ramp-angle", metavar="DEG", type=_degrees, help="of helix and ramp, 0.06 to 45 degrees (default 3)")
    group.add_argument("--lead", choices=[each.value for each in LeadKind], help="to a wall and away from it (default arc)")
    group.add_argument("--lead-radius", metavar="MM", type=number("lead radius"),
                       help="of the arc, or length of the line (default half the tool's diameter)")
    group.add_argument("--lead-overlap", metavar="MM", type=_overlap,
                       help=f"how far a contour goes on over its beginning, 0 to {MOST_OVERLAP:g} mm (default 0.5)")
    group.add_argument("--outside-in", action="store_true", help="clear areas from the walls inwards (default: from inside outwards)")
    group.add_argument("--most-engaged", metavar="SHARE|%", type=_share,
                       help="of the diameter: where the cutter is engaged over more, the feed is slowed (default 100%%, never)")
    group.add_argument("--finish-depth", metavar="MM", type=number("finish depth", least=LEAST_LENGTH),
                       help="thickness of a last pass over the floor (default: none)")
    group.add_argument("--finish-width", metavar="MM", type=number("finish width", least=LEAST_LENGTH),
                       help="metal that the passes leave on walls for a finish pass (default: none)")
    group.add_argument("--spring-passes", metavar="N", type=_whole("spring passes", 1, MOST_SPRING_PASSES),
                       help="times the last contour pass is run again (default 0)")
    group.add_argument("--floor-to-leave", metavar="MM", type=number("floor to leave", least=0.0),
                       help="metal left on the floor (default 0)")
    group.add_argument("--dog-bones", action="store_true", help="cut on into inner corners, for a sharp counterpart to fit")
    group.add_argument("--drill", metavar="D", type=number("diameter"), action="append", default=[],
                       help="drill the circles of this diameter first, down to the depth; may be repeated")
    group.add_argument("--peck", metavar="MM", type=number("peck", least=LEAST_LENGTH),
                       help="depth of one stroke before a drill comes out of the hole (default: in one go)")
    group.add_argument("--through", metavar="MM", type=number("way through", least=0.0), help="how far a drill goes on below the depth")
    holding.add_argument("--tabs", metavar="N", type=_whole("tabs", 0, 100), help="bridges of metal that hold what is cut out, a contour")
    holding.add_argument("--tab-width", metavar="MM", type=number("tab width"), help="of the metal that stands (default 5)")
    holding.add_argument("--tab-height", metavar="MM", type=number("tab height"), help="above the floor (default 1)")
    holding.add_argument("--copies", metavar="CxR@DX,DY", type=_copies,
                         help="the part in a grid, such as 3x2@40,30: three along X 40 mm apart, two along Y 30 mm apart")
    holding.add_argument("--keep-out", metavar="NAME", action="append", default=[],
                         help="a layer of clamps: no tool comes over its closed outlines below their height; they stay where they are "
                              "drawn and are not copied with the part; may be repeated")
    holding.add_argument("--keep-out-height", metavar="MM", type=number("height", least=0.0),
                         help="of the clamps above the stock (default 0)")


def machining(arguments: argparse.Namespace, on_pixels: bool) -> Machining:
    """Return what was asked for.

    Args:
        on_pixels: paths are made from pixels, which take few of these options.

    Raises:
        InputError: an option does not go with pixels.
    """
    asked = Machining(
        side=Side(arguments.side) if arguments.side else None, lead=LeadKind(arguments.lead) if arguments.lead else None,
        lead_radius=arguments.lead_radius, lead_overlap=arguments.lead_overlap, tabs=arguments.tabs, tab_width=arguments.tab_width,
        tab_height=arguments.tab_height, dog_bones=arguments.dog_bones, finish_width=arguments.finish_width,
        spring_passes=arguments.spring_passes, outside_in=arguments.outside_in,
        entry=EntryKind(arguments.entry) if arguments.entry else None, ramp_angle=arguments.ramp_angle,
        finish_depth=arguments.finish_depth, floor_to_leave=arguments.floor_to_leave, most_engaged=arguments.most_engaged,
        drills=tuple(arguments.drill), peck=arguments.peck, through=arguments.through, copies=arguments.copies,
        keep_out=tuple(arguments.keep_out), keep_out_height=arguments.keep_out_height,
    )  # fmt: skip
    beyond = [name for name in asked.asked if on_pixels and name not in ON_PIXELS]
    if beyond:
        option = {"drills": "drill"}.get(beyond[0], beyond[0]).replace("_", "-")
        raise InputError(f"--{option} has no effect on pixels, where only pockets and the contours inside the walls are cut; "
                         "leave the option away, or compute a drawing exactly, without --bitmap")
    return asked


def _degrees(text: str) -> float:
    """Return an angle in radians, for argparse."""
    try:
        value = angle(text)
    except CommandError as error:
        raise argparse.ArgumentTypeError(f"is wrong: {error.reason}") from error
    if not 0.06 <= value <= 45:
        raise argparse.ArgumentTypeError(f"is {value:g} degrees; it must be 0.06 to 45 degrees")
    return math.radians(value)


def _share(text: str) -> float:
    """Return a share by a number up to 1 or per cent, for argparse."""
    match = re.fullmatch(r"\s*(\d{1,3}(?:\.\d{0,9})?|\.\d{1,9})\s*(%?)\s*", text)
    value = float(match[1]) / (100 if match[2] else 1) if match else math.nan
    if not 0.05 <= value <= 1:
        raise argparse.ArgumentTypeError(f"is '{text}'; write a share of the diameter from 5% to 100%, such as 40% or 0.4")
    return value


def _overlap(text: str) -> float:
    """Return a lead overlap in mm, for argparse."""
    value = number("lead overlap", least=0.0)(text)
    if value > MOST_OVERLAP:
        raise argparse.ArgumentTypeError(f"is {value:g} mm; the lead overlap must be 0 to {MOST_OVERLAP:g} mm")
    return value


def _whole(what: str, least: int, most: int) -> Callable[[str], int]:
    """Return a reader of whole numbers, for argparse."""

    def read(text: str) -> int:
        if not re.fullmatch(r"\s*\d{1,9}\s*", text) or not least <= int(text) <= most:
            raise argparse.ArgumentTypeError(f"is '{text}'; the {what} must be a whole number from {least} to {most}")
        return int(text)

    return read


def _copies(text: str) -> Copies:
    """Return a grid by a text such as 3x2@40,30 or 4x1@1in, for argparse."""
    match = re.fullmatch(r"\s*(\d{1,6})\s*x\s*(\d{1,6})\s*@([^,]+)(?:,([^,]+))?", text, re.IGNORECASE)
    if match is None:
        raise argparse.ArgumentTypeError(f"is '{text}'; write columns x rows @ distances, such as 3x2@40,30 (or 3x1@40)")
    columns, rows = int(match[1]), int(match[2])
    try:
        first, second = length(match[3]), length(match[4]) if match[4] else 0.0
        if columns == rows == 1:
            raise argparse.ArgumentTypeError(f"is '{text}', which is the part alone; leave the option away, or write more than 1x1")
        dx, dy = (0.0, first) if columns == 1 and match[4] is None else (first, second)
        for count, step, axis, what in ((columns, dx, "X", "column"), (rows, dy, "Y", "row")):
            if count == 1 and step:
                raise argparse.ArgumentTypeError(f"is '{text}', where {step:g} mm along {axis} have no effect on one {what}; "
                                                 f"write more {what}s, or one distance such as {columns}x{rows}@{dx + dy - step:g}")
        return Copies(columns, rows, dx, dy)
    except CommandError as error:
        raise argparse.ArgumentTypeError(f"is wrong: {error.reason}") from error
    except HitofudeError as error:
        raise argparse.ArgumentTypeError(f"is wrong: {error}") from error
