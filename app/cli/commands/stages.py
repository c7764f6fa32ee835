"""`hitofude stages`: writes what the workstation's display memory holds after every numbered step of the 1986 text."""

from __future__ import annotations

import argparse
import json
import os
import re
from dataclasses import replace
from pathlib import Path

from ...core.atomic import write_together
from ...core.errors import InputError
from ...exhibits.stage_files import MOST_TURNS_PX, TURNS, StagesRun, run_stages, stage_files
from ...exhibits.stages import Variant
from ...formats.job.toml import read_job, read_units
from ...formats.readers import offered_suffixes
from ...usecases.machining import MachiningOptions
from ...usecases.options import MakeOptions
from ..bitmap_options import add_bitmap_options, bitmap_options
from ..command import CliCommand, OptionParser
from ..files import check_outputs, read_input, shown_progress
from ..make_options import stepover
from ..output import finding_lines, tell
from ..reading_options import add_reading_options, reading
from ..signals import StopFlag, undisturbed
from ..values import join_tolerance, number, typed

_OWN = re.compile(rf"(?:{TURNS}/)?\d\d_\d{{3}}(?:_r\d+_t\d+)?\.(?:png|npy|txt)", re.IGNORECASE)
"""Names of the files that the stages are written to, seen from their folder."""

EPILOG = """\
DIR gets, for every step in the text's order, NN_STEP.png and NN_STEP.npy (uint8 codes, row 0 = top): all regions, as
the step leaves them after its last time. Where it has chain codes, NN_STEP.txt has those of every time, a line for
each contour line: "region R turn T start ROW COLUMN: directions 0 to 7." (region 0 = all). Of a step that is repeated,
for each region, peel and path, turns/NN_STEP_rR_tTTT.png is each time's plane, a point a pixel; its palette's indices
are the codes. Codes: 0 empty, 1 contour or area, 2 traced, 3 R, 4 I, 5 processed, 6 outermost frame, 7 path further
in, 8 circle, 9 long line, 10 vertex, 11 short line, 12 arc, 13 free curve.
"""


def _run(arguments: argparse.Namespace, stopped: StopFlag) -> int:
    """Do the work and return the exit status: 0 clean, 1 with findings."""
    folder = _check_outputs(arguments)
    progress = shown_progress(arguments.quiet, stopped)
    options = _make_options(arguments)
    data = read_input(arguments.drawing)
    run = run_stages(arguments.drawing.name, data, (options, Variant(arguments.variant)), progress.part(0.0, 0.8))
    texts = {folder / name: text for name, text in stage_files(run, progress.part(0.8, 1.0)).items()}
    if arguments.report is not None:
        texts[arguments.report] = (json.dumps(run.report(), indent=2, allow_nan=False) + "\n").encode()
    progress.step(1.0)
    with undisturbed():
        for each in sorted({path.parent for path in texts if path != arguments.report}):
            _make_folder(each)
        write_together(texts)
    if not arguments.quiet:
        tell("\n".join(_lines(run, folder)))
    return 1 if any(finding.counts for finding in run.findings) else 0


def _add_options(parser: OptionParser) -> None:
    parser.add_argument(
        "drawing",
        metavar="DRAWING",
        type=Path,
        help=f"the drawing or project, {' '.join(offered_suffixes())}, or a picture, .png .jpg .bmp",
    )
    parser.add_argument(
        "-o", "--output", metavar="DIR", type=Path, required=True, help="the folder; made where there is none"
    )
    parser.add_argument(
        "--variant",
        choices=[each.value for each in Variant],
        default=Variant.SETTLED.value,
        help="rules of the fill: those that are always right (default), or as published, with what they get wrong",
    )
    parser.add_argument("--report", metavar="R.json", type=Path, help="every step and what was measured, as JSON")
    parser.add_argument("--quiet", action="store_true", help="say nothing but errors")
    add_bitmap_options(parser.add_argument_group("bitmap and picture"), "rows and columns of the bitmap (default 400)")
    _job_options(parser.add_argument_group("tools and drawing"))


def _job_options(group: argparse._ArgumentGroup) -> None:
    group.add_argument("--job", metavar="J.toml", type=Path, help="tools and operations; options override it")
    group.add_argument(
        "--contour-tool", metavar="D", type=number("diameter"), help="diameter of the tool that follows the walls"
    )
    group.add_argument(
        "--pocket-tool", metavar="D", type=number("diameter"), help="diameter of the tool that clears the area"
    )
    group.add_argument("--stepover", metavar="MM|%", type=stepover, help="distance between paths")
    group.add_argument("--overlap", metavar="MM", type=number("overlap"), help="the same as diameter - stepover")
    group.add_argument(
        "--stock-to-leave",
        metavar="MM",
        type=number("stock to leave", least=0.0),
        help="metal left on walls (default 0)",
    )
    group.add_argument(
        "--units", metavar="mm|in", type=typed(read_units), help="units of a drawing that names none (default mm)"
    )
    group.add_argument("--layer", metavar="NAME", action="append", default=[], help="only this layer; may be repeated")
    add_reading_options(group)
    group.add_argument(
        "--join-tolerance", metavar="MM", type=join_tolerance, help="join loose ends nearer than this (default 0.01)"
    )


def _check_outputs(arguments: argparse.Namespace) -> Path:
    """Return the folder to write to, checked before any work is done."""
    folder: Path = arguments.output
    if folder.exists() and not folder.is_dir():
        raise InputError(f"--output {folder} is no folder; name one, or a new one")
    if not folder.exists() and not folder.parent.is_dir():
        raise InputError(f"--output {folder}: there is no folder {folder.parent}; make it first")
    inputs = [path for path in (arguments.drawing, arguments.job) if path is not None]
    if arguments.report is not None:
        check_outputs({"report": arguments.report}, inputs)
        inside = os.path.relpath(os.path.realpath(arguments.report), os.path.realpath(folder))
        if _OWN.fullmatch(Path(inside).as_posix()):
            raise InputError(
                f"--report {arguments.report} is the name of a stage's own file; give the report another name"
            )
    return folder


def _make_folder(folder: Path) -> None:
    try:
        folder.mkdir(exist_ok=True)
    except OSError as error:
        raise InputError(
            f"Cannot write {folder}: {error.strerror or error}; choose another folder or change its permissions"
        ) from error


def _make_options(arguments: argparse.Namespace) -> MakeOptions:
    left = {} if arguments.stock_to_leave is None else {"stock_to_leave": arguments.stock_to_leave}
    options = MakeOptions(
        contour_diameter=arguments.contour_tool,
        pocket_diameter=arguments.pocket_tool,
        stepover=arguments.stepover,
        overlap=arguments.overlap,
        machining=MachiningOptions(left),
        units=arguments.units,
        layers=tuple(arguments.layer),
        join_tolerance=arguments.join_tolerance,
        bitmap=bitmap_options(arguments),
        reading=reading(arguments),
    )
    if arguments.job is None:
        return options
    file = read_job(arguments.job.name, read_input(arguments.job))
    return replace(options, job=file.job, units=options.units or file.units)


def _lines(run: StagesRun, folder: Path) -> list[str]:
    """Return in a few lines what was made."""
    frame, given_up = run.ready.part.frame, run.made.given_up
    wrong = run.wrong_pixels
    lines = [
        f"{folder}: {len(run.last)} steps on {frame.cols} x {frame.rows} px of {frame.pitch:.4g} mm; paths along the "
        f"walls up to {given_up.most_mm:.3f} mm farther from them than asked ({given_up.mean_mm:.3f} mm in the mean)"
    ]
    if not run.all_turns:
        lines.append(
            f"  - {TURNS}/ is left out: the planes of all times would be more than {MOST_TURNS_PX / 1e9:.1f} billion "
            "pixels; a smaller bitmap has them"
        )
    if run.variant is Variant.PUBLISHED:
        lines.append(f"  - the fill as published is wrong in {wrong} pixels" + ("" if wrong else " here"))
    return lines + finding_lines(run.findings)


COMMAND = CliCommand(
    "stages",
    "drawing",
    "the drawing and the folder to write to",
    ("Draw a drawing or a picture on a bitmap as in 1986, and write the display memory after every numbered step."),
    EPILOG,
    _add_options,
    _run,
)
