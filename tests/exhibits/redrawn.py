"""Figures of the five texts, drawn anew by the program: what it computes on its own samples, and the machine of 1986 in
boxes. `python -m tests.exhibits.make_figures` writes them for the page of the texts.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from app.core.progress import NO_PROGRESS, Progress
from app.core.resources import resource
from app.exhibits.figure_eleven import FigureEleven, HeightMethod
from app.exhibits.films.making import SAMPLES, make_film
from app.exhibits.films.step import TEXTS, PublishedText
from app.exhibits.films.step_drawing import AREA, BLUE, GREEN, INK, StepDrawing
from app.exhibits.stage_files import StagesRun, run_stages
from app.exhibits.stage_picture import png
from app.exhibits.stages import Variant
from app.formats.plot.page import PlotPage
from app.formats.plot.page_png import page_png
from app.usecases.better.improve import better
from app.usecases.better.picture import stock_picture
from app.usecases.better.result import BetterOptions
from app.usecases.job.options import MakeOptions
from app.usecases.pixels.options import BitmapOptions, BitmapSize

FIGURES = (
    "metal",
    "a1",
    "a2a",
    "a2b",
    "a2c",
    "a5a",
    "a5b",
    "a5c",
    "a5d",
    "b11",
    "c1",
    "c2",
    "c3",
    "d5",
    "e4",
    "e7",
    "e8",
)
"""What light shows of all five texts together; then by text, number and part, in the order of the texts."""

_FINE, _COARSE = 400, 110
"""Pixels along the drawing of figure 2, and of figure 5, where each can be seen."""

_SHAPE, _OFFSETS, _TOOL_PATHS = 110, 120, 140
_FILL = (201, 203, 206, 208)

_FILM = {
    PublishedText.C: {"(a)": "c1", "(f)": "c2", "(h)": "c3"},
    PublishedText.D: {"S113": "d5"},
    PublishedText.E: {"figure 4, end": "e4", "figure 7": "e7", "figure 8": "e8"},
}
"""Steps of the films that are what a figure shows."""

_BOXES = (
    ("2 keyboard", 0.0, 30.0),
    ("1 data processing", 55.0, 30.0),
    ("4 storage", 110.0, 30.0),
    ("3 screen", 0.0, 0.0),
    ("6 screen control", 55.0, 0.0),
    ("5 video RAM", 110.0, 0.0),
)
_WIDE, _HIGH = 44.0, 14.0
_PRINTED = {"A": (16.83, 0.99), "B": (15.93, 1.65)}
"""s by software and by depth buffer."""


def redrawn(figure_eleven: FigureEleven, progress: Progress = NO_PROGRESS) -> dict[str, bytes]:
    """Return every figure as PNG, by its name out of `FIGURES`.

    Args:
        figure_eleven: as it was measured, on the programs A and B. progress: told of how much is done.

    Raises:
        Cancelled: the job was asked to stop.
    """
    found = {"a1": page_png(_apparatus()), "b11": page_png(_times(figure_eleven))}
    found |= dict(_of_the_bitmap(progress.part(0.0, 0.4)))
    found["metal"] = _metal()
    for k, (text, steps) in enumerate(_FILM.items()):
        share = progress.part(0.4 + 0.2 * k, 0.6 + 0.2 * k)
        for step in make_film(TEXTS[text.value], progress=share).steps:
            if step.number in steps:
                found[steps[step.number]] = page_png(step.page)
    return {name: found[name] for name in FIGURES}


def _of_the_bitmap(progress: Progress) -> Iterator[tuple[str, bytes]]:
    fine, coarse = _run(_FINE, progress.part(0.0, 0.7)), _run(_COARSE, progress.part(0.7, 1.0))
    for part, number in zip("abc", (_SHAPE, _OFFSETS, _TOOL_PATHS), strict=True):
        yield f"a2{part}", _stage(fine, number)
    for part, number in zip("abcd", _FILL, strict=True):
        yield f"a5{part}", _stage(coarse, number)


def _run(pixels: int, progress: Progress) -> StagesRun:
    name = SAMPLES[PublishedText.A]
    options = MakeOptions(bitmap=BitmapOptions(BitmapSize(pixels)))
    return run_stages(name, resource("samples", name).read_bytes(), (options, Variant.SETTLED), progress)


def _stage(run: StagesRun, number: int) -> bytes:
    return png(next(stage for stage in run.last if stage.number == number), run.dashes)


def _metal() -> bytes:
    """Return the metal of the sample of `better`, before and after."""
    name = "raster.ngc"
    done = better(name, resource("samples", name).read_bytes(), BetterOptions(cells=_FINE))
    return stock_picture(done.old_cut.cut.workpiece, done.new_cut.cut.workpiece, done.smoothed.area)


def _apparatus() -> PlotPage:
    """Return figure 1 of A: what the workstation of 1986 was made of."""
    sketch = StepDrawing()
    for words, x, y in _BOXES:
        corners = np.array([[x, y], [x + _WIDE, y], [x + _WIDE, y + _HIGH], [x, y + _HIGH]])
        sketch.area(corners, AREA)
        sketch.line(np.vstack([corners, corners[:1]]))
        sketch.word(words, (x + 2.0, y + _HIGH / 2), INK, (0.0, -1.0))
    ends = ((44, 37, 55, 37), (99, 37, 110, 37), (77, 30, 77, 14), (44, 7, 55, 7), (99, 7, 110, 7))
    for x0, y0, x1, y1 in ends:
        sketch.line(np.array([[x0, y0], [x1, y1]], np.float64), BLUE)
    return sketch.page()


def _times(figure: FigureEleven) -> PlotPage:
    """Return figure 11 of B: seconds as they were printed, and as they are here, on a scale of powers of ten."""
    sketch, y = StepDrawing(), 0.0
    for row in reversed(figure.rows):
        here = [(way.value, row.seconds[way], GREEN) for way in HeightMethod if way in row.seconds]
        software, buffer = _PRINTED[row.name]
        bars = [("printed, software", software, BLUE), ("printed, depth buffer", buffer, BLUE), *here]
        for words, seconds, colour in reversed(bars):
            long = 30.0 * (np.log10(max(seconds, 1e-3)) + 3.0)
            sketch.area(np.array([[0.0, y], [long, y], [long, y + 4.0], [0.0, y + 4.0]]), colour)
            sketch.word(f"{words} {seconds:.3g} s", (long, y), INK, (1.5, 0.6))
            y += 6.0
        sketch.word(f"{row.program.moves:,} moves, radius {row.program.radius:g} mm", (0.0, y), INK, (0.0, 0.5))
        y += 10.0
    return sketch.page((0.0, -2.0, 190.0, y))
