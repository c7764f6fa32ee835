"""The options of `surface`, and what they ask for."""

from __future__ import annotations

import argparse
from pathlib import Path

from ..core.errors import InputError
from ..formats.plot.surface_plot import VIEWS, PlotColouring
from ..usecases.better.result import BetterOptions
from ..usecases.scene.plot import FORMATS, PlotScene, PlottedPart
from ..usecases.scene_program.smooth import CurvesOverSurfaces
from ..usecases.smoothing.result import OutputForm
from .command import OptionParser, number
from .files import check_outputs, named_files

EPILOG = """\
The scene tells surfaces, stock, tools and families of passes; resources/docs/scene.md explains every key. On each
cutting plane the topmost of all surfaces is followed; where the path passes from one to another, the boundary point is
solved for. Every move of the written program is read back and proven to go nowhere deeper into a surface than 0.0001
mm; it is cut out of the stock, and what the same tools reach and leave is told with its place. Files that the scene
names are looked for beside it. Exit status 0: done and proven; 1: with findings, or a move could not be proven; 2: bad
input; 130: cancelled.
"""


def add_surface_options(parser: OptionParser) -> None:
    """Add the options of `hitofude surface`."""
    parser.add_argument("scene", metavar="SCENE.toml", type=Path, help="surfaces, stock, tools and passes")
    parser.add_argument(
        "-o", "--output", metavar="OUT.ngc", type=Path, help="the NC program; one a tool where the control changes none"
    )
    _plot_options(parser)
    _table_options(parser)
    _curve_options(parser)
    parser.add_argument("--quiet", action="store_true", help="say nothing but errors")


def _plot_options(parser: OptionParser) -> None:
    """Add the plot, and what is seen on it."""
    parser.add_argument(
        "--plot",
        metavar="OUT.svg|pdf|hpgl",
        type=Path,
        help="the paths drawn in the order of generation, by surface; also .plt and .png",
    )
    parser.add_argument(
        "--view", choices=list(VIEWS), default="isometric", help="from where the plot is seen (default isometric)"
    )
    parser.add_argument(
        "--look",
        choices=[look.value for look in PlotColouring],
        default=PlotColouring.COLOURS.value,
        help="what tells parts of the plot apart: colours of surfaces (default), line types of surfaces, or tools",
    )
    parser.add_argument(
        "--draw",
        choices=[drawn.value for drawn in PlottedPart],
        default=PlottedPart.PATHS.value,
        help="what is plotted: the cutters' paths (default), the compound surface, or both",
    )


def _table_options(parser: OptionParser) -> None:
    """Add what is told as numbers."""
    parser.add_argument(
        "--points", metavar="OUT.csv", type=Path, help="the compound surface and its boundary points as a table"
    )
    parser.add_argument(
        "--report", metavar="R.json", type=Path, help="everything that was computed and proven, as JSON"
    )
    parser.add_argument(
        "--loop",
        metavar="T",
        type=number("loop"),
        help="with --report: the program is cut, smoothed within T mm and cut again, all told in the report",
    )


def _curve_options(parser: OptionParser) -> None:
    """Add what the program's curves are."""
    group = parser.add_argument_group("curves", "the program as arcs or splines that go into no surface")
    group.add_argument(
        "--smooth",
        metavar="T",
        type=number("smooth"),
        help="one tolerance a surface for facets, chords, curves and digits, all of it on the open side (mm)",
    )
    group.add_argument(
        "--as",
        dest="form",
        choices=[form.value for form in OutputForm],
        help="with --smooth or --facets: what curves are written as (default arcs)",
    )
    group.add_argument(
        "--facets",
        metavar="T",
        type=number("facets"),
        help="surfaces are polyhedra: passes go by the places where facets meet, told across neighbouring passes, and "
        "their cut is within T of that of the facets, up or down (mm; a ball, parallel planes)",
    )


def surface_files(arguments: argparse.Namespace) -> dict[str, Path]:
    """Return the files to write by their option, checked before any work is done.

    Raises:
        InputError: there is none, one cannot be written, or an option lacks the one that it goes with.
    """
    outputs = named_files(arguments, "output", "plot", "points", "report")
    if not outputs:
        raise InputError(
            "surface has nothing to write; add -o OUT.ngc, --plot OUT.svg, --points OUT.csv or --report R.json"
        )
    if "plot" in outputs and outputs["plot"].suffix.lower() not in FORMATS:
        raise InputError(f"--plot {outputs['plot']}: a plot is one of {', '.join(FORMATS)}; change the name")
    if arguments.loop is not None and "report" not in outputs:
        raise InputError("--loop tells what it finds in the report; add --report R.json")
    ways = [name for name in ("loop", "smooth", "facets") if getattr(arguments, name) is not None]
    if len(ways) > 1:
        raise InputError(f"--{ways[0]} and --{ways[1]} make another program each; give one of them")
    if arguments.form is not None and not {"smooth", "facets"} & set(ways):
        raise InputError("--as belongs to --smooth T or --facets T; give one of these too")
    check_outputs(outputs, [arguments.scene])
    return outputs


def curves_over(arguments: argparse.Namespace) -> CurvesOverSurfaces | None:
    """Return how the program is to become curves; None: it is not."""
    if arguments.smooth is None:
        return None
    return CurvesOverSurfaces(arguments.smooth, _form(arguments))


def facets_of(arguments: argparse.Namespace) -> BetterOptions | None:
    """Return how the program is to go by its surfaces' facets; None: it does not."""
    return None if arguments.facets is None else BetterOptions(arguments.facets, form=_form(arguments))


def _form(arguments: argparse.Namespace) -> OutputForm:
    return OutputForm(arguments.form or OutputForm.ARCS.value)


def plot_scene(arguments: argparse.Namespace) -> PlotScene:
    """Return how the scene is to be plotted."""
    return PlotScene(VIEWS[arguments.view], PlotColouring(arguments.look), PlottedPart(arguments.draw))
