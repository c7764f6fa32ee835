"""The options of `make`: their names, their help, how each value is read and what range it has."""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from ..core.errors import InputError
from ..core.input_file import read_input
from ..drafting.expressions.numbers import length
from ..formats.job.toml import ORIGIN_HELP, StatedOrigin, parse_origin, read_job, read_out_units, read_units
from ..formats.readers import offered_suffixes
from ..model.operation import LEAST_LENGTH, Direction, Order
from ..model.tool import LEAST_DIAMETER, LEAST_RATE
from ..usecases.job.options import LEAST_PER_CENT, MakeOptions, Stepover
from .command import MACHINE_HELP, TOOLS_HELP, OptionParser, join_tolerance, machine_named, number, typed
from .files import check_outputs, named_files, sheet_suffix
from .reading_options import add_reading_options, reading

if TYPE_CHECKING:
    from ..usecases.proposal.propose import ProposalOptions  # loaded where something is to be proposed

EPILOG = """\
D is a diameter: 6, 6mm, 0.25in, 1/4in. Lengths are mm unless a unit is written. With one tool given it does both jobs;
with none, the job's tools or 6 mm (pocket) and 3 mm (contour). Z 0 is the top of the stock, the depth goes down from
it.
"""


def stepover(text: str) -> Stepover:
    """Return a distance between rings, in mm or per cent of the diameter, for argparse."""
    percent = text.strip().endswith("%")
    try:
        requested = Stepover(float(text.strip()[:-1]) if percent else length(text), percent)
    except (InputError, ValueError) as error:
        raise argparse.ArgumentTypeError(
            f"is wrong: '{text}' is neither a length nor per cent; write one such as 1.5mm or 40%"
        ) from error
    least, unit = (LEAST_PER_CENT, "%") if percent else (LEAST_LENGTH, "mm")
    if not least <= requested.value <= (100 if percent else 1e5):
        raise argparse.ArgumentTypeError(
            f"is {requested.value:g} {unit}; it must be {least:g} {unit} or more and not more than "
            "the tool's diameter (100 %)"
        )
    return requested


def add_make_options(parser: OptionParser) -> None:
    """Add the options of `hitofude make`."""
    from .bitmap_options import add_bitmap_options
    from .machining_options import add_machining_options

    parser.add_argument(
        "drawing",
        metavar="DRAWING",
        type=Path,
        help=f"the drawing or project, {' '.join(offered_suffixes())}, or a picture, .png .jpg .bmp",
    )
    _file_options(parser.add_argument_group("files"))
    _proposal_options(parser.add_argument_group("proposed operations"))
    _tool_options(parser.add_argument_group("tools and cutting"))
    add_machining_options(
        parser.add_argument_group("how it is cut"), parser.add_argument_group("copies, tabs and clamps")
    )
    _drawing_options(parser.add_argument_group("drawing and origin"))
    add_bitmap_options(
        parser.add_argument_group("bitmap and picture"),
        "compute on N x N pixels, as in 1986, instead of exactly; a picture is always",
    )


def _file_options(group: argparse._ArgumentGroup) -> None:
    group.add_argument(
        "-o",
        "--output",
        metavar="OUT.ngc",
        type=Path,
        required=True,
        help="the NC program; written whole or not at all",
    )
    job = group.add_mutually_exclusive_group()
    job.add_argument(
        "--job", metavar="J.toml", type=Path, help="tools, operations, stock and origin; options override it"
    )
    job.add_argument(
        "--template",
        metavar="T.toml",
        type=Path,
        help="a job file with rules for layers, [[layer]]: each layer of this drawing that one takes gets an operation",
    )
    group.add_argument("--report", metavar="R.json", type=Path, help="everything that was measured, as JSON")
    group.add_argument("--image", metavar="OUT.svg|png", type=Path, help="a picture of part and paths")
    group.add_argument(
        "--sheet",
        metavar="OUT.pdf|html",
        type=Path,
        help="the sheet for the machine: picture, zero, stock, tools, operations, times, certificate",
    )
    group.add_argument(
        "--timings",
        action="store_true",
        help="tell how long each stage took, here and in the report; no stage goes on beside another then",
    )
    group.add_argument(
        "--post",
        metavar="NAME",
        help="the control that the program is for: linuxcnc (default), grbl, fanuc, haas, mach3, "
        "or one of your own; where it changes no tools there is a file for each, OUT_1_T1.ngc, OUT_2_T2.ngc, …",
    )
    group.add_argument("--machine", metavar="NAME|FILE", type=typed(machine_named), help=MACHINE_HELP)
    group.add_argument(
        "--out-units", metavar="mm|in", type=typed(read_out_units), help="units of the NC program (default mm)"
    )
    group.add_argument(
        "--exact-path", action="store_true", help="tell the control to stop at corners rather than blend (G61)"
    )
    group.add_argument("--quiet", action="store_true", help="say nothing but errors")


def _proposal_from(arguments: argparse.Namespace) -> ProposalOptions:
    from ..usecases.proposal.propose import ProposalOptions

    return ProposalOptions(thickness=arguments.thickness)


def _proposal_options(group: argparse._ArgumentGroup) -> None:
    group.add_argument(
        "--propose",
        action="store_true",
        help="operations from how the curves lie in one another: outlines are cut out, with tabs, what lies in them is "
        "a pocket, circles are holes, open lines are engraved; --depth is that of the pockets",
    )
    group.add_argument(
        "--tools",
        metavar="FILE",
        type=Path,
        help=f"tools to choose from: {TOOLS_HELP} (default: those of the job, else the mills and drills that come with "
        "the program)",
    )
    group.add_argument(
        "--thickness",
        metavar="MM",
        type=number("thickness", least=LEAST_LENGTH),
        help="of the stock, through which outlines and holes go (default: the job's, else 10)",
    )
    group.add_argument(
        "--write-job", metavar="J.toml", type=Path, help="the job as a job file: its tools, operations and their curves"
    )


def _tool_options(group: argparse._ArgumentGroup) -> None:
    _size_options(group)
    _rate_options(group)
    _order_options(group)


def _size_options(group: argparse._ArgumentGroup) -> None:
    """Add how wide tools are, how far apart their rings, and how high they go over the stock."""
    diameter = number("diameter", least=LEAST_DIAMETER)
    group.add_argument(
        "--contour-tool",
        metavar="D",
        type=diameter,
        help="diameter of the tool that follows the walls",
    )
    group.add_argument(
        "--pocket-tool",
        metavar="D",
        type=diameter,
        help="diameter of the tool that clears the area",
    )
    group.add_argument(
        "--stepover",
        metavar="MM|%",
        type=stepover,
        help="distance between rings, 1%% to 100%% of the diameter or from 0.001 mm; everything is cleared at any "
        "(default: the one with the shortest path)",
    )
    group.add_argument("--overlap", metavar="MM", type=number("overlap"), help="the same as diameter - stepover")
    group.add_argument(
        "--safe-z",
        metavar="MM",
        type=number("clearance height", least=LEAST_LENGTH),
        help="clearance height above the stock, 0.001 mm or more (default 5)",
    )


def _rate_options(group: argparse._ArgumentGroup) -> None:
    """Add speed and feeds, or for what they are proposed."""
    group.add_argument(
        "--feed",
        metavar="F",
        type=number("feed rate", least=LEAST_RATE, unit="mm/min"),
        help="feed rate, mm/min, 1 or more (default 600)",
    )
    group.add_argument(
        "--plunge",
        metavar="F",
        type=number("plunge rate", least=LEAST_RATE, unit="mm/min"),
        help="plunge rate, mm/min, 1 or more (default 200)",
    )
    group.add_argument(
        "--speed",
        metavar="S",
        type=number("spindle speed", unit="rpm"),
        help="spindle speed, rpm (default 12000, contour 18000)",
    )
    group.add_argument(
        "--material", metavar="NAME", help="what the stock is made of, such as aluminium (hitofude feeds --help)"
    )
    group.add_argument(
        "--feeds",
        choices=["tools", "proposed"],
        help="proposed: speed and feeds for the material, tools, engagement and machine; --speed, --feed and --plunge "
        "go before them (default: as the job says, else those of the tools)",
    )


def _order_options(group: argparse._ArgumentGroup) -> None:
    """Add how deep shapes are, which way walls are cut along, and which tool comes first."""
    group.add_argument(
        "--depths",
        choices=["operations", "drawing"],
        help="drawing: each shape as deep as the elevation or thickness of its curves says, or a text beside it, such "
        "as t=4; what tells no depth is as deep as its operation (default: as the job says, else operations)",
    )
    side = group.add_mutually_exclusive_group()
    side.add_argument(
        "--climb", action="store_const", dest="direction", const=Direction.CLIMB, help="metal right of travel (default)"
    )
    side.add_argument(
        "--conventional",
        action="store_const",
        dest="direction",
        const=Direction.CONVENTIONAL,
        help="metal left of travel",
    )
    group.add_argument(
        "--order",
        choices=[order.value for order in Order],
        help="which tool cuts first (default pocket-first; 1986 = contour first, as in the patent)",
    )


def _drawing_options(group: argparse._ArgumentGroup) -> None:
    group.add_argument(
        "--units",
        metavar="mm|in",
        type=typed(read_units),
        help="units of a drawing that names none, or none that can be meant (default mm)",
    )
    group.add_argument("--origin", metavar="WHERE", type=typed(parse_origin), help=ORIGIN_HELP)
    group.add_argument(
        "--layer", metavar="NAME", action="append", default=[], help="machine only this layer; may be repeated"
    )
    add_reading_options(group)
    group.add_argument(
        "--join-tolerance",
        metavar="MM",
        type=join_tolerance,
        help="join loose ends nearer than this, 0 to 10 mm (default 0.01)",
    )


def make_options(arguments: argparse.Namespace) -> MakeOptions:
    """Return what was asked for, but for the job file, which is yet to be read.

    Raises:
        HitofudeError: options of the bitmap that go neither with one another nor with the drawing, or an option without
            the one that it belongs to.
    """
    from .bitmap_options import requested_bitmap
    from .machining_options import machining

    bitmap = requested_bitmap(arguments)
    if not arguments.propose and (arguments.tools is not None or arguments.thickness is not None):
        option = "tools" if arguments.tools is not None else "thickness"
        raise InputError(f"--{option} has no effect without --propose; add that, or leave it away")
    if arguments.propose and bitmap is not None:
        raise InputError("--propose has no effect on pixels, where all is pockets; leave it away, or --bitmap")
    origin = arguments.origin or StatedOrigin()
    return MakeOptions(
        contour_diameter=arguments.contour_tool,
        pocket_diameter=arguments.pocket_tool,
        stepover=arguments.stepover,
        overlap=arguments.overlap,
        safe_z=arguments.safe_z,
        feed=arguments.feed,
        plunge=arguments.plunge,
        speed=arguments.speed,
        order=Order(arguments.order) if arguments.order else None,
        post=arguments.post,
        machine=arguments.machine,
        out_units=arguments.out_units,
        units=arguments.units,
        origin_xy=origin.xy,
        origin_z=origin.z,
        layers=tuple(arguments.layer),
        join_tolerance=arguments.join_tolerance,
        exact_path=arguments.exact_path,
        bitmap=bitmap,
        machining=machining(arguments, bitmap is not None),
        reading=reading(arguments),
        propose=_proposal_from(arguments) if arguments.propose else None,
        material=arguments.material,
        propose_feeds=arguments.feeds == "proposed",
        drawn_depths=arguments.depths == "drawing",
    )


def read_make_options(arguments: argparse.Namespace) -> MakeOptions:
    """Return what was asked for, its files read: the job, and tools to choose from.

    Raises:
        HitofudeError: an option cannot be used, or a file cannot be read.
    """
    options = _with_tools(_with_job(make_options(arguments), arguments.job or arguments.template), arguments.tools)
    if arguments.template is not None and not options.rules:
        raise InputError(f"--template {arguments.template} has no [[layer]], so it is a job file; name it with --job")
    options = replace(options, propose_feeds=False) if arguments.feeds == "tools" else options
    return replace(options, drawn_depths=False) if arguments.depths == "operations" else options


def _with_job(options: MakeOptions, path: Path | None) -> MakeOptions:
    """Return the options with the job file read, where there is one."""
    if path is None:
        return options

    file = read_job(path.name, read_input(path))
    return replace(
        options,
        job=file.job,
        units=options.units or file.units,
        propose_feeds=options.propose_feeds or file.proposes_feeds,
        drawn_depths=options.drawn_depths or file.drawn_depths,
        rules=file.rules,
    )


def _with_tools(options: MakeOptions, path: Path | None) -> MakeOptions:
    """Return the options with the tools that a proposal chooses from: of a library, else of the job file."""
    if options.propose is None or (path is None and options.job is None):
        return options
    from ..formats.tools.at_path import tools_at

    own = options.job.tools if options.job is not None else ()
    tools = own if path is None else tools_at(path).library.tools
    return replace(options, propose=replace(options.propose, tools=tuple(tools)))


def make_files(arguments: argparse.Namespace) -> dict[str, Path]:
    """Return the files to write by what they hold, checked before any work is done.

    Raises:
        InputError: one cannot be written, or is no picture.
    """
    outputs = named_files(arguments, "output", "report", "image", "sheet", "write_job")
    if "image" in outputs and outputs["image"].suffix.lower() not in (".svg", ".png"):
        raise InputError(f"--image {outputs['image']}: a picture is .svg or .png; change the name")
    if "sheet" in outputs:
        sheet_suffix("sheet", outputs["sheet"])
    check_outputs(outputs, [*named_files(arguments, "drawing", "job", "template", "tools").values()])
    return outputs
