"""The options of `stages`, and what they ask for."""

from __future__ import annotations

import argparse
import os
import re
from dataclasses import replace
from pathlib import Path

from ..core.errors import InputError, ParameterError
from ..core.input_file import read_input
from ..exhibits.films.effective import EffectiveFilmOptions
from ..exhibits.films.making import FilmOptions, FilmSource, sample_of
from ..exhibits.films.proven import USUAL
from ..exhibits.films.step import PublishedText
from ..exhibits.stage_files import TURNS
from ..exhibits.stages import Variant
from ..fitting.point_curves.region_profile import RegionProfile, profile_of_formula, profile_of_table
from ..formats.job.toml import read_job, read_units
from ..formats.readers import offered_suffixes
from ..usecases.job.machining import MachiningOptions
from ..usecases.job.options import MakeOptions
from .bitmap_options import add_bitmap_options, bitmap_options
from .command import OptionParser, join_tolerance, number, typed
from .files import check_outputs
from .film_program import program_source
from .make_options import stepover
from .reading_options import add_reading_options, reading
from .setup_options import add_setup_options

_OWN = re.compile(rf"(?:{TURNS}/)?\d\d_\d{{3}}(?:_r\d+_t\d+)?\.(?:png|npy|txt)", re.IGNORECASE)
"""Names of the files that the stages are written to, seen from their folder."""

_FILM_OPTIONS = {"facet": "B", "tool": "B", "stock": "B", "epsilon": "D", "tolerance": "D", "region": "E"}
"""Options of films, and the text that each belongs to."""

_OF_BITMAP = ("job", "contour_tool", "pocket_tool", "stepover", "overlap", "stock_to_leave", "join_tolerance")
"""Options of the text of 1986 alone."""

EPILOG = """\
DIR gets, for every step in the text's order, NN_STEP.png and NN_STEP.npy (uint8 codes, row 0 = top): all regions, as
the step leaves them after its last time. Where it has chain codes, NN_STEP.txt has those of every time, a line for
each contour line: "region R turn T start ROW COLUMN: directions 0 to 7." (region 0 = all). Of a step that is repeated,
for each region, peel and path, turns/NN_STEP_rR_tTTT.png is each time's plane, a point a pixel; its palette's indices
are the codes. Of the texts B to E it gets NN_STEP.svg and .png, and NN_STEP.csv where a step has a table. Of all texts
film.json has what each step says and its figures, of B to E also what is settled otherwise, published ones beside; of A
what came of the published rules is in its sentence with --variant published. Codes: 0 empty, 1 contour
or area, 2 traced, 3 R, 4 I, 5 processed, 6 outermost frame, 7 path further in, 8 circle, 9 long line, 10 vertex,
11 short line, 12 arc, 13 free curve.
"""


def add_stages_options(parser: OptionParser) -> None:
    """Add the options of `hitofude stages`."""
    parser.add_argument(
        "drawing",
        metavar="FILE",
        type=Path,
        nargs="?",
        help=f"A: the drawing or project, {' '.join(offered_suffixes())}, or a picture, .png .jpg .bmp; B, D, E: an NC "
        "program; C: a scene, .toml (default: the text's own sample)",
    )
    parser.add_argument(
        "--text",
        choices=[each.value for each in PublishedText],
        default=PublishedText.A.value,
        help="which of the five texts: A paths from a line drawing (default), B the cut before cutting, C a compound "
        "surface, D a curve from approximate points, E a curve with a proven error",
    )
    films = parser.add_argument_group("texts B, D and E")
    films.add_argument(
        "--facet", metavar="D", type=number("facet"), help="B: size of the facets (default: twice the dexels' distance)"
    )
    add_setup_options(films, "B, of a program of your own: ")
    films.add_argument("--epsilon", metavar="E", type=number("epsilon"), help="D: of one facet's points (default 0.01)")
    films.add_argument(
        "--tolerance", metavar="T", type=number("tolerance"), help="D: to the facets, for the last step (default 0.2)"
    )
    films.add_argument(
        "--region", metavar="f:F(z)|table:Z=R,...", type=_profile, help=f"E: the region's outline (default f:{USUAL})"
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
        "--units",
        metavar="mm|in",
        type=typed(read_units),
        help="units of a drawing or program that names none (default mm)",
    )
    group.add_argument("--layer", metavar="NAME", action="append", default=[], help="only this layer; may be repeated")
    add_reading_options(group)
    group.add_argument(
        "--join-tolerance", metavar="MM", type=join_tolerance, help="join loose ends nearer than this (default 0.01)"
    )


def _profile(text: str) -> RegionProfile:
    try:
        return (
            profile_of_table(text.partition(":")[2])
            if text.startswith("table:")
            else profile_of_formula(text.removeprefix("f:"))
        )
    except ParameterError as error:
        raise argparse.ArgumentTypeError(f"is wrong: {error}") from error


def stages_folder(arguments: argparse.Namespace) -> Path:
    """Return the folder to write to, checked before any work is done.

    Raises:
        InputError: it cannot be, or a report has the name of a stage's own file.
    """
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


def stages_request(arguments: argparse.Namespace) -> MakeOptions:
    """Return how the drawing of the text of 1986 is machined, the job file read."""
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


def ensure_of_text(arguments: argparse.Namespace, text: PublishedText) -> None:
    """Refuse options that belong to another text.

    Raises:
        InputError: naming the first of them.
    """
    if text is PublishedText.A:
        if late := [name for name in _FILM_OPTIONS if getattr(arguments, name) is not None]:
            raise InputError(f"--{late[0]} belongs to another text than A; give --text {_FILM_OPTIONS[late[0]]}")
        return
    if late := [name for name in _OF_BITMAP if getattr(arguments, name) is not None]:
        raise InputError(f"--{late[0].replace('_', '-')} belongs to --text A; leave it out")
    for name, letters in _FILM_OPTIONS.items():
        if getattr(arguments, name) is not None and text.value not in letters:
            raise InputError(f"--{name} belongs to --text {letters}; leave it out")
    if text is PublishedText.C and arguments.units is not None:
        raise InputError("--units belongs to --text A, B, D or E; a scene is in mm, so leave it out")
    told = (arguments.tool, arguments.stock, arguments.units)
    if arguments.drawing is None and any(told):
        raise InputError("--tool, --stock and --units are those of a program of your own; name it, or leave them out")


def film_options(arguments: argparse.Namespace) -> FilmOptions:
    """Return how a film is made."""
    usual = EffectiveFilmOptions()
    effective = EffectiveFilmOptions(arguments.epsilon or usual.epsilon, arguments.tolerance or usual.tolerance)
    return FilmOptions(arguments.facet, effective, arguments.region)


def film_source(arguments: argparse.Namespace, text: PublishedText) -> FilmSource | None:
    """Return the file that was named, or the text's sample; None where that is computed."""
    path: Path | None = arguments.drawing
    if path is None:
        return sample_of(text)
    if text is PublishedText.C and path.suffix.lower() != ".toml":
        raise InputError(
            f"{path.name} is no scene; text C is shown on one, a .toml that names surfaces, tools and passes"
        )
    if text is PublishedText.C:
        return FilmSource(path.name, read_input(path), lambda name: read_input(path.parent / name))
    return program_source(path, arguments.units)
