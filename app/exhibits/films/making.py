"""A film of any of the texts B to E, of a file or of the text's own sample, and the files that it is written to."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

from ...core.errors import InputError
from ...core.progress import NO_PROGRESS, Progress
from ...core.resources import resource
from ...fitting.point_curves.region_profile import RegionProfile
from ...formats.plot.page_png import page_png
from ...formats.plot.page_svg import page_svg
from ...formats.scene.toml import sources_of
from ...model.tool import Tool
from ...usecases.examine import ExamineOptions
from ...usecases.smoothing.source import SourceReading
from .compound import compound_film
from .dexels import CutFilmInput, dexel_film, sample_input
from .effective import EffectiveFilmOptions, effective_film
from .programs import points_of
from .proven import proven_film
from .step import FilmFigure, FilmStep, PublishedText, TextFilm

SAMPLES = {
    PublishedText.A: "fig2.dxf",
    PublishedText.C: "compound.toml",
    PublishedText.D: "facets.ngc",
    PublishedText.E: "points.ngc",
}
"""The file that a text is shown on unless another is named; B has the die of figure 11, which is computed."""
FILM = "film.json"
"""The file of all words and figures beside the pictures of a film's steps."""


@dataclass(frozen=True, eq=False)
class FilmSource:
    """A file that a film is made of.

    Attributes:
        name, data: of the file. beside: the bytes of a file that it names.
        reading: B, D, E: how a program is to be read.
        tools, stock: B: what else is known of it, by T number, and the corners of its box, mm.
    """

    name: str
    data: bytes
    beside: Callable[[str], bytes]
    reading: ExamineOptions = field(default_factory=ExamineOptions)
    tools: Mapping[int, Tool] = field(default_factory=dict)
    stock: tuple[float, float, float, float, float, float] | None = None


@dataclass(frozen=True)
class FilmOptions:
    """What may be asked for beside the file.

    Attributes:
        facet: B: size of the facets, mm; None: twice the distance of the dexels.
        effective: D: epsilon and tolerance.
        profile: E: the region's outline; None: the usual one.
    """

    facet: float | None = None
    effective: EffectiveFilmOptions = field(default_factory=EffectiveFilmOptions)
    profile: RegionProfile | None = None


def sample_of(text: PublishedText) -> FilmSource | None:
    """Return the file that a text is shown on unless another is named; None of B."""
    name = SAMPLES.get(text)
    if name is None:
        return None
    path = resource("samples", name)
    return FilmSource(name, path.read_bytes(), lambda other: (path.parent / other).read_bytes())


def make_film(
    text: PublishedText,
    source: FilmSource | None = None,
    options: FilmOptions = FilmOptions(),
    progress: Progress = NO_PROGRESS,
    cutting: CutFilmInput | None = None,
) -> TextFilm:
    """Return the steps of a text.

    Args:
        text: B to E; the steps of A are those of `exhibits.stages`.
        source: a scene (C) or an NC program (D, E); None: the text's sample.
        options: see there.
        cutting: B: what is cut; None: the die of figure 11.

    Raises:
        HitofudeError: the file cannot be used. Cancelled: the job was asked to stop.
    """
    if text is PublishedText.B:
        return dexel_film(cutting or sample_input(options.facet), progress)
    file = source or sample_of(text)
    if file is None or text is PublishedText.A:
        raise InputError("the steps of text A are stages on the bitmap; use `hitofude stages DRAWING`.")
    if text is PublishedText.C:
        return compound_film(file.name, file.data, sources_of(file.beside), progress)
    reading = SourceReading(file.reading.dialect, file.reading.units)
    points = points_of(file.name, file.data, reading, progress.part(0.0, 0.1))
    if text is PublishedText.D:
        effective = replace(options.effective, reading=reading)
        return effective_film(file.name, file.data, points, effective, progress.part(0.1, 1.0))
    return proven_film(file.name, points, options.profile, progress.part(0.1, 1.0))


def film_files(film: TextFilm, progress: Progress = NO_PROGRESS) -> dict[str, bytes]:
    """Return the files by name: of each step a picture as SVG and as PNG, its table as CSV where it has one, and all
    words and figures in film.json.
    """
    files: dict[str, bytes] = {}
    for number, step in enumerate(film.steps, 1):
        progress.step((number - 1) / len(film.steps), f"Drawing {step.number}")
        stem = stem_of(number, step)
        title = f"{film.text.number}, {step.number}: {step.name}"
        files[f"{stem}.svg"], files[f"{stem}.png"] = page_svg(step.page, title), page_png(step.page)
        if step.table:
            files[f"{stem}.csv"] = "\r\n".join([",".join(map(_cell, row)) for row in step.table] + [""]).encode()
    files[FILM] = (json.dumps(_plain(film), indent=1, allow_nan=False, ensure_ascii=False) + "\n").encode()
    return files


def stem_of(number: int, step: FilmStep) -> str:
    """Return the files' name without a suffix, so that they sort in the text's order."""
    return f"{number:02d}_{re.sub(r'[^A-Za-z0-9]+', '_', step.number).strip('_')}"


def _cell(text: str) -> str:
    return '"' + text.replace('"', '""') + '"' if re.search(r'[",\r\n]', text) else text


def _plain(film: TextFilm) -> dict[str, object]:
    return {
        "text": film.text.value,
        "title": film.text.title,
        "publication": film.text.number,
        "source": film.source,
        "steps": [
            {
                "number": step.number,
                "name": step.name,
                "says": step.says,
                "settled": step.settled,
                "files": stem_of(number, step),
                "figures": [_figure(each) for each in step.figures],
                "table": [list(row) for row in step.table],
            }
            for number, step in enumerate(film.steps, 1)
        ],
    }


def _figure(figure: FilmFigure) -> dict[str, object]:
    told: dict[str, object] = {"name": figure.name, "value": figure.value, "unit": figure.unit}
    return told | ({"published": figure.published} if figure.published != "" else {})
