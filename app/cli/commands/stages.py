"""`hitofude stages`: writes every numbered step of one of the five texts as a picture with its figures; of the text of
1986 what the workstation's display memory holds after it.
"""

from __future__ import annotations

import argparse
import json
import os
import re
from dataclasses import replace
from pathlib import Path

from ...core.atomic import write_together
from ...core.errors import InputError, ParameterError
from ...core.input_file import read_input
from ...core.progress import Progress
from ...core.resources import resource
from ...exhibits.films.effective import EffectiveFilmOptions
from ...exhibits.films.making import SAMPLES, FilmOptions, FilmSource, film_files, make_film, sample_of
from ...exhibits.films.program_input import program_input
from ...exhibits.films.proven import USUAL
from ...exhibits.films.step import TEXTS, PublishedText, TextFilm
from ...exhibits.stage_files import MOST_TURNS_PX, TURNS, StagesRun, run_stages, stage_files
from ...exhibits.stages import Variant
from ...fitting.point_curves.region_profile import RegionProfile, profile_of_formula, profile_of_table
from ...formats.job.toml import read_job, read_units
from ...formats.readers import offered_suffixes
from ...usecases.machining import MachiningOptions
from ...usecases.options import MakeOptions
from ..bitmap_options import add_bitmap_options, bitmap_options
from ..command import CliCommand, OptionParser
from ..files import check_outputs, shown_progress
from ..make_options import stepover
from ..output import finding_lines, tell
from ..reading_options import add_reading_options, reading
from ..signals import StopFlag, undisturbed
from ..values import join_tolerance, number, typed

_OWN = re.compile(rf"(?:{TURNS}/)?\d\d_\d{{3}}(?:_r\d+_t\d+)?\.(?:png|npy|txt)", re.IGNORECASE)
"""Names of the files that the stages are written to, seen from their folder."""

_FILM_OPTIONS = {"facet": "B", "epsilon": "D", "tolerance": "D", "region": "E"}
"""Options of films, and the text that each belongs to."""

_OF_BITMAP = ("job", "contour_tool", "pocket_tool", "stepover", "overlap", "stock_to_leave", "units", "join_tolerance")
"""Options of the text of 1986 alone."""

EPILOG = """\
DIR gets, for every step in the text's order, NN_STEP.png and NN_STEP.npy (uint8 codes, row 0 = top): all regions, as
the step leaves them after its last time. Where it has chain codes, NN_STEP.txt has those of every time, a line for
each contour line: "region R turn T start ROW COLUMN: directions 0 to 7." (region 0 = all). Of a step that is repeated,
for each region, peel and path, turns/NN_STEP_rR_tTTT.png is each time's plane, a point a pixel; its palette's indices
are the codes. Of the texts B to E it gets NN_STEP.svg and .png, NN_STEP.csv where a step has a table, and film.json
with what each step says, what is settled otherwise, and its figures, published ones beside. Codes: 0 empty, 1 contour
or area, 2 traced, 3 R, 4 I, 5 processed, 6 outermost frame, 7 path further in, 8 circle, 9 long line, 10 vertex,
11 short line, 12 arc, 13 free curve.
"""


def _run(arguments: argparse.Namespace, stopped: StopFlag) -> int:
    """Do the work and return the exit status: 0 clean, 1 with findings."""
    folder, text = _check_outputs(arguments), TEXTS[arguments.text]
    if text is not PublishedText.A:
        return _run_film(arguments, folder, text, shown_progress(arguments.quiet, stopped))
    if late := [name for name in ("epsilon", "tolerance", "region", "facet") if getattr(arguments, name) is not None]:
        raise InputError(f"--{late[0]} belongs to another text than A; give --text {_FILM_OPTIONS[late[0]]}")
    progress = shown_progress(arguments.quiet, stopped)
    if arguments.drawing is None:
        arguments.drawing = resource("samples", SAMPLES[text])
    requested = _make_options(arguments), Variant(arguments.variant)
    data = read_input(arguments.drawing)
    run = run_stages(arguments.drawing.name, data, requested, progress.part(0.0, 0.8))
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


def _source(arguments: argparse.Namespace, text: PublishedText) -> FilmSource | None:
    """Return the file that was named, or the text's sample; None where that is computed."""
    path: Path | None = arguments.drawing
    if path is None:
        return sample_of(text)
    return FilmSource(path.name, read_input(path), lambda name: read_input(path.parent / name))


def _run_film(arguments: argparse.Namespace, folder: Path, text: PublishedText, progress: Progress) -> int:
    """Write a film of one of the texts B to E, and return the exit status, 0."""
    if late := [name for name in _OF_BITMAP if getattr(arguments, name) is not None]:
        raise InputError(f"--{late[0].replace('_', '-')} belongs to --text A; leave it out")
    for name, letters in _FILM_OPTIONS.items():
        if getattr(arguments, name) is not None and text.value not in letters:
            raise InputError(f"--{name} belongs to --text {letters}; leave it out")
    usual = EffectiveFilmOptions()
    effective = EffectiveFilmOptions(arguments.epsilon or usual.epsilon, arguments.tolerance or usual.tolerance)
    options, source = FilmOptions(arguments.facet, effective, arguments.region), _source(arguments, text)
    cutting = None
    if text is PublishedText.B and source is not None:
        cutting = program_input(source.name, source.data, arguments.facet, progress.part(0.0, 0.1))
    film = make_film(text, source, options, progress.part(0.1, 0.8), cutting)
    texts = {folder / name: data for name, data in film_files(film, progress.part(0.8, 1.0)).items()}
    progress.step(1.0)
    if arguments.report is not None:
        texts[arguments.report] = texts[folder / "film.json"]
    with undisturbed():
        _make_folder(folder)
        write_together(texts)
    if not arguments.quiet:
        tell("\n".join(_film_lines(film, folder)))
    return 0


def _film_lines(film: TextFilm, folder: Path) -> list[str]:
    """Return a line a step: what it came to."""
    lines = [f"{folder}: {len(film.steps)} steps of text {film.text.value}, {film.text.number}, on {film.source}"]
    for step in film.steps:
        told = "; ".join(f"{figure.name} {figure.words}" for figure in step.figures)
        lines.append(f"  {step.number} {step.name}" + (f": {told}" if told else ""))
    return lines


def _profile(text: str) -> RegionProfile:
    try:
        return (
            profile_of_table(text.partition(":")[2])
            if text.startswith("table:")
            else profile_of_formula(text.removeprefix("f:"))
        )
    except ParameterError as error:
        raise argparse.ArgumentTypeError(f"is wrong: {error}") from error


def _add_options(parser: OptionParser) -> None:
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
    "",
    "the folder to write to",
    (
        "Write every numbered step of one of the five texts, on a file or on its sample; of that of 1986 the display "
        "memory after every step."
    ),
    EPILOG,
    _add_options,
    _run,
)
