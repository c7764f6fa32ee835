"""The options of `better`, and what they ask for."""

from __future__ import annotations

import argparse
from pathlib import Path

from ..gcode.interpreter.dialect import Dialect
from ..gcode.posts import load_post, post_names
from ..usecases.better.result import BetterOptions
from ..usecases.examine import CONTROLS
from ..usecases.smoothing.result import OutputForm
from .check_options import add_program_units, program_units
from .command import OptionParser, number
from .setup_options import add_setup_options

EPILOG = """\
For programs of one tool that go over surfaces in passes beside one another, as CAM systems write them from a
polyhedron. The old program is cut; the facets that its passes lie on are told apart, and where they meet lies the
true shape; a smooth surface through these places is machined anew, its passes become curves with a proof, and the new
program is cut out of the same stock. Both cuts are compared cell by cell: nowhere may they differ by more than T, up or
down. The surface of straight passes of a ball can be kept as a scene; all other passes, of any cutter, bent, or over
several surfaces, are lifted onto the smooth surfaces where they are. Exit status 0: better, and within T; 1: with
findings; 2: bad input, or the tolerance does not hold the facets.
"""


def add_better_options(parser: OptionParser) -> None:
    """Add the options of `hitofude better`."""
    parser.add_argument("program", metavar="PROGRAM.ngc", type=Path, help="the NC program")
    parser.add_argument("-o", "--output", metavar="OUT.ngc", type=Path, required=True, help="the better program")
    parser.add_argument(
        "--tolerance",
        metavar="T",
        type=number("tolerance"),
        default=BetterOptions.tolerance,
        help="by how much the new cut may differ from the old one, up or down, square to the surface "
        f"(default {BetterOptions.tolerance:g} mm)",
    )
    parser.add_argument(
        "--epsilon",
        metavar="E",
        type=number("epsilon"),
        help="points so near to one plane are a facet; far less than facets are off the true shape (mm; default what "
        "suits of a fiftieth and a twentieth of T)",
    )
    parser.add_argument(
        "--pitch",
        metavar="P",
        type=number("pitch"),
        help="from pass to pass, of straight passes of a ball (mm; default as the old passes)",
    )
    parser.add_argument(
        "--as",
        dest="form",
        choices=[form.value for form in OutputForm],
        default=OutputForm.ARCS.value,
        help="what curves are written as (default arcs)",
    )
    add_setup_options(parser)
    parser.add_argument("--post", metavar="NAME", choices=post_names(), help="whose words the new program has")
    parser.add_argument("--dialect", choices=list(CONTROLS), help="the control's language (default: as the text looks)")
    add_program_units(parser)
    parser.add_argument("--scene", metavar="OUT.toml", type=Path, help="the smooth surface and its passes as a scene")
    parser.add_argument(
        "--image", metavar="OUT.png", type=Path, help="both cuts beside one another in a low light that shows facets"
    )
    parser.add_argument("--report", metavar="R.json", type=Path, help="everything that was found, as JSON")
    parser.add_argument("--quiet", action="store_true", help="say nothing but errors")


def better_options(arguments: argparse.Namespace) -> BetterOptions:
    """Return what was asked for."""
    if arguments.post:
        load_post(arguments.post)
    return BetterOptions(
        arguments.tolerance,
        arguments.epsilon,
        arguments.pitch,
        OutputForm(arguments.form),
        post=arguments.post,
        dialect=Dialect(arguments.dialect) if arguments.dialect else None,
        units=program_units(arguments),
    )
