"""The options of `smooth`, and what they ask for."""

from __future__ import annotations

import argparse
import math
from pathlib import Path

from ..core.errors import InputError, ParameterError
from ..fitting.line_arcs.arc_fit import BEND
from ..fitting.point_curves.region_profile import RegionProfile, profile_of_formula, profile_of_table
from ..gcode.interpreter.dialect import Dialect
from ..gcode.posts import Post, load_post
from ..usecases.smoothing.result import OutputForm, SmoothOptions
from .check_options import add_program_units, program_units
from .command import OptionParser, number, typed
from .effective_options import add_effective_options, effective_method

_PROFILES = {"f": profile_of_formula, "table": profile_of_table}
"""Readers of a region's outline, by the word before the colon."""

EPILOG = """\
What is written is read back and proven: nowhere are curve and moves farther apart than T, both ways and in order.
Corners, feeds, spindle, tools and comments stay in place. Exit status 0: done; 1: a stretch could not be proven and
stayed as it was; 2: bad input.
"""


def add_smooth_options(parser: OptionParser) -> None:
    """Add the options of `hitofude smooth`."""
    parser.add_argument("program", metavar="PROGRAM.ngc", type=Path, help="the NC program")
    parser.add_argument("-o", "--output", metavar="OUT.ngc", type=Path, required=True, help="the smoothed program")
    _curve_options(parser)
    _bend_options(parser)
    _control_options(parser)
    add_effective_options(parser)
    parser.add_argument("--report", metavar="R.json", type=Path, help="the certificate and every stretch, as JSON")
    parser.add_argument("--quiet", action="store_true", help="say nothing but errors")


def _curve_options(parser: OptionParser) -> None:
    """Add how near curves are to the moves, and what they are."""
    parser.add_argument(
        "--tolerance",
        metavar="T",
        type=number("tolerance"),
        help="how far curve and moves may be apart, both ways (default 0.01 mm)",
    )
    parser.add_argument(
        "--as",
        dest="form",
        choices=[form.value for form in OutputForm],
        default=OutputForm.ARCS.value,
        help="what is written (default arcs); nurbs: splines where they take fewer blocks, arcs elsewhere",
    )
    parser.add_argument(
        "--insist",
        action="store_true",
        help="with --as nurbs: splines all along, however many blocks they take, continuous in curvature between "
        "corners",
    )
    parser.add_argument(
        "--region",
        metavar="cylinder|barrel:MID|f:F(z)|table:Z=R,...",
        type=_region,
        default=None,
        help="the tube's shape: T wide all along (default cylinder); MID wide half way between two points; or of any "
        "outline r = f(z), mm, z = 0 at one point and 1 at the next, by a formula (f:0.01+0.02*sin(pi*z)) or by places "
        "(table:0=0.01,0.5=0.03,1=0.01), which then tells the tolerance",
    )
    parser.add_argument(
        "--degree",
        type=int,
        choices=[3, 5],
        default=3,
        help="of splines (default 3); 5, which no control knows, goes out as cubics near it",
    )


def _bend_options(parser: OptionParser) -> None:
    """Add which bends are corners, and which ones curves may have."""
    parser.add_argument(
        "--corner",
        metavar="ANGLE",
        type=_angle,
        default=math.radians(30),
        help="bends above it are kept, degrees (default 30)",
    )
    parser.add_argument(
        "--bend",
        metavar="DEG",
        type=_angle,
        default=BEND,
        help="by how much neighbouring lines and arcs may bend, or as the moves do there; more only where that saves "
        "blocks (default 0.5)",
    )


def _control_options(parser: OptionParser) -> None:
    """Add which control the program is for, and which one the new program, and what units it has."""
    parser.add_argument(
        "--post",
        metavar="NAME",
        type=typed(load_post),
        help="the control that all of it is written for, and read back as (default: the program's own)",
    )
    parser.add_argument(
        "--dialect",
        choices=[dialect.value for dialect in Dialect],
        help="the control that the program is for (default: as the text looks)",
    )
    add_program_units(parser)


def _region(text: str) -> float | RegionProfile | None:
    if text == "cylinder":
        return None
    kind, _, told = text.partition(":")
    if kind not in ("barrel", *_PROFILES) or not told:
        raise argparse.ArgumentTypeError(
            f"is wrong: '{text}' is no region; write cylinder, barrel:0.05 with the radius in the middle, "
            "f:0.01+0.02*sin(pi*z), or table:0=0.01,0.5=0.03,1=0.01"
        )
    if kind == "barrel":
        return number("radius in the middle")(told)
    try:
        return _PROFILES[kind](told)
    except ParameterError as error:
        raise argparse.ArgumentTypeError(f"is wrong: {error}") from error


def _angle(text: str) -> float:
    value = number("angle", unit="degrees")(text)
    if value > 180:
        raise argparse.ArgumentTypeError(f"is {value:g} degrees; the angle must not be more than 180 degrees")
    return math.radians(value)


def smooth_options(arguments: argparse.Namespace) -> SmoothOptions:
    """Return what was asked for.

    Raises:
        InputError: options that do not go with one another.
    """
    post: Post | None = arguments.post
    dialect = Dialect(arguments.dialect) if arguments.dialect else None
    effective = effective_method(arguments)
    region = arguments.region
    profile = region if isinstance(region, RegionProfile) else None
    if profile is not None and arguments.tolerance is not None:
        raise InputError("--tolerance is told by the region's outline, its radius at the points; leave it out")
    if arguments.insist and arguments.form != OutputForm.NURBS.value:
        raise InputError(
            f"--insist belongs to --as nurbs, not to --as {arguments.form}; give that too, or leave it out"
        )
    return SmoothOptions(
        _tolerance(arguments.tolerance, profile),
        OutputForm(arguments.form),
        region if profile is None else None,
        arguments.degree,
        arguments.corner,
        post,
        dialect,
        effective,
        arguments.bend,
        arguments.insist,
        profile,
        program_units(arguments),
    )


def _tolerance(given: float | None, profile: RegionProfile | None) -> float:
    if profile is not None:
        return profile.radius
    return SmoothOptions.tolerance if given is None else given
