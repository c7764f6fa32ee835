"""`hitofude inlay`: a V-carved pocket and the plug that fits into it, two programs from one drawing."""

from __future__ import annotations

import argparse
from pathlib import Path

from ...core.input_file import read_input
from ...formats.job.toml import read_job
from ...usecases.inlay import InlayOptions, inlay
from ...usecases.job.options import MakeOptions
from ..command import CliCommand, OptionParser, number
from ..files import check_outputs, named_files, shown_progress
from ..outcome import CommandOutcome
from ..output import finding_lines
from ..signals import StopFlag

EPILOG = """\
The job has one operation, a vcarve with its flat_tool: the pocket. OUT_pocket.ngc and OUT_plug.ngc have their zero at
the drawing's; the plug's drawing is mirrored, x to -x.
"""


def _run(arguments: argparse.Namespace, stopped: StopFlag) -> int:
    """Do the work and return the exit status: 0 clean and fitting, 1 with findings."""
    outputs = named_files(arguments, "report")
    pocket = arguments.output.with_name(f"{arguments.output.name}_pocket.ngc")
    check_outputs({"output": pocket, **outputs}, [arguments.drawing, arguments.job])
    progress = shown_progress(arguments.quiet, stopped)
    job = read_job(arguments.job.name, read_input(arguments.job))
    sizes = InlayOptions(arguments.glue, arguments.gap, arguments.saw)
    pair = inlay(arguments.drawing.name, read_input(arguments.drawing), MakeOptions(job=job.job), sizes, progress)
    files = pair.files(arguments.output)
    lines = []
    for word, made in (("_pocket", pair.pocket), ("_plug", pair.plug)):
        written = [path for path in files if word in path.name.removeprefix(arguments.output.stem)]
        lines += [made.report.summary(", ".join(map(str, written))), *finding_lines(made.findings)]
    lines += [pair.fit.summary(), *finding_lines(pair.findings)]
    files |= {path: pair.report() for path in outputs.values()}
    return CommandOutcome(files, lines, not pair.clean).delivered(arguments, progress)


def _add_options(parser: OptionParser) -> None:
    usual = InlayOptions()
    parser.add_argument("drawing", metavar="DRAWING", type=Path, help="closed contours, as seen on the finished face")
    parser.add_argument("-o", "--output", metavar="OUT", type=Path, required=True, help="what both programs begin with")
    parser.add_argument(
        "--job", metavar="J.toml", type=Path, required=True, help="tools, depth and stock of the pocket"
    )
    for name, value, words in (
        ("glue", usual.glue, "between the plug's face and the pocket's floor"),
        ("gap", usual.gap, "between the walls, sideways"),
        ("saw", usual.saw, "how far the plug stands out, to be sawn off"),
    ):
        parser.add_argument(
            f"--{name}", metavar="MM", type=number(name, least=0.0), default=value, help=f"{words} (default {value:g})"
        )
    parser.add_argument("--report", metavar="R.json", type=Path, help="everything that was measured, as JSON")
    parser.add_argument("--quiet", action="store_true", help="say nothing but errors")


COMMAND = CliCommand(
    "inlay",
    reads="drawing",
    needs="the drawing, the job file and what the programs are called",
    about="Turn a drawing into a V-carved pocket and the plug that fits into it, and prove that they fit.",
    epilog=EPILOG,
    add_options=_add_options,
    run=_run,
    examples=("hitofude inlay inlay.draw --job inlay.toml -o inlay",),
)
