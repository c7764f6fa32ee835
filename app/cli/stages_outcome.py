"""What `stages` makes: the stages of the text of 1986, or the film of another text."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

from ..core.input_file import read_input
from ..core.progress import Progress
from ..core.resources import resource
from ..exhibits.films.making import FILM, SAMPLES, film_files, make_film
from ..exhibits.films.program_input import program_input
from ..exhibits.films.step import TEXTS, PublishedText
from ..exhibits.stage_files import run_stages, stage_files
from ..exhibits.stages import Variant
from .outcome import CommandOutcome
from .setup_options import setup_request
from .stages_lines import film_lines, stages_lines
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
