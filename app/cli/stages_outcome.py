"""What `stages` makes and prints: the stages of the text of 1986, or the film of another text."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

from ..core.input_file import read_input
from ..core.progress import Progress
from ..core.resources import resource
from ..exhibits.films.making import FILM, SAMPLES, film_files, make_film
from ..exhibits.films.program_input import program_input
from ..exhibits.films.step import TEXTS, PublishedText, TextFilm
from ..exhibits.stage_files import MOST_TURNS_PX, TURNS, StagesRun, run_stages, stage_files
from ..exhibits.stages import Variant
from .outcome import CommandOutcome
from .output import finding_lines
from .setup_options import setup_request
from .stages_options import film_options, film_source, stages_request


def stages_outcome(arguments: argparse.Namespace, folder: Path, progress: Progress) -> CommandOutcome:
    """Make the stages of the text of 1986."""
    if arguments.drawing is None:
        arguments.drawing = resource("samples", SAMPLES[PublishedText.A])
    path: Path = arguments.drawing
    requested = stages_request(arguments), Variant(arguments.variant)
    run = run_stages(path.name, read_input(path), requested, progress.part(0.0, 0.8))
    files = {folder / name: data for name, data in stage_files(run, progress.part(0.8, 1.0)).items()}
    folders = sorted({each.parent for each in files})
    files[folder / FILM] = (json.dumps(run.report(), indent=2, allow_nan=False) + "\n").encode()
    if arguments.report is not None:
        files[arguments.report] = files[folder / FILM]
    counts = any(finding.counts for finding in run.findings)
    return CommandOutcome(files, stages_lines(run, folder), counts, folders)


def film_outcome(arguments: argparse.Namespace, folder: Path, progress: Progress) -> CommandOutcome:
    """Make the film of one of the texts B to E."""
    text, cutting = TEXTS[arguments.text], None
    source = film_source(arguments, text)
    if text is PublishedText.B and source is not None:
        part = progress.part(0.0, 0.1)
        cutting = program_input(source, arguments.facet, part, setup_request(arguments))
    film = make_film(text, source, film_options(arguments), progress.part(0.1, 0.8), cutting)
    files = {folder / name: data for name, data in film_files(film, progress.part(0.8, 1.0)).items()}
    if arguments.report is not None:
        files[arguments.report] = files[folder / FILM]
    return CommandOutcome(files, film_lines(film, folder), folders=[folder])


def film_lines(film: TextFilm, folder: Path) -> list[str]:
    """Return a line a step: what it came to."""
    lines = [f"{folder}: {len(film.steps)} steps of text {film.text.value}, {film.text.number}, on {film.source}"]
    for step in film.steps:
        told = "; ".join(f"{figure.name} {figure.words}" for figure in step.figures)
        lines.append(f"  {step.number} {step.name}" + (f": {told}" if told else ""))
    return lines


def stages_lines(run: StagesRun, folder: Path) -> list[str]:
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
