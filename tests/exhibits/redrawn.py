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
from app.exhibits.films.step import TEXTS, PublishedText, TextFilm
from app.exhibits.films.step_drawing import AREA, BLUE, GREEN, INK, StepDrawing
from app.exhibits.stage_files import StagesRun, run_stages
from app.exhibits.stage_picture import png
from app.exhibits.stages import Variant
from app.formats.plot.page import PlotPage
from app.formats.plot.page_png import page_png
from app.raster.trace import STEPS
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
    "c4",
    "d5",
    "e4",
    "e7",
    "e8",
)
"""What light shows of all five texts together; then by text, number and part, in the order of the texts."""

_FINE, _COARSE = 400, 110
"""Pixels along the drawing of figure 2, and of figure 5, where each can be seen."""

_SHAPE, _OFFSETS, _TOOL_PATHS = 110, 120, 140
_CONTOUR_PIXELS, _FILLED = 201, 130

_FILM = {
    PublishedText.C: {"(h)": "c1", "(f)": "c3", "(b)": "c4"},
    PublishedText.D: {"S21": "d5"},
    PublishedText.E: {"figure 7": "e7", "figure 8": "e8"},
}
"""Steps of the films that are what a figure shows."""

_Box = tuple[str, float, float]
_Way = tuple[float, float, float, float]

_BOXES: tuple[_Box, ...] = (
    ("2 keyboard", 0.0, 30.0),
    ("1 data processing", 55.0, 30.0),
    ("4 storage", 110.0, 30.0),
    ("3 screen", 0.0, 0.0),
    ("6 screen control", 55.0, 0.0),
    ("5 video RAM", 110.0, 0.0),
)
_WIRES: tuple[_Way, ...] = ((44, 37, 55, 37), (99, 37, 110, 37), (77, 30, 77, 14), (44, 7, 55, 7), (99, 7, 110, 7))
_PROGRAMMER: tuple[_Box, ...] = (
    ("101 keyboard", 0.0, 60.0),
    ("102 processor", 55.0, 60.0),
    ("103 control program", 110.0, 60.0),
    ("104 RAM", 0.0, 30.0),
    ("105 curved surfaces", 55.0, 30.0),
    ("106 floppy disk", 110.0, 30.0),
    ("107 colour screen", 0.0, 0.0),
    ("108 XY plotter", 110.0, 0.0),
)
_BUS: tuple[_Way, ...] = (
    (44, 67, 55, 67),
    (99, 67, 110, 67),
    (77, 60, 77, 50),
    (22, 50, 132, 50),
    (22, 50, 22, 44),
    (77, 50, 77, 44),
    (132, 50, 132, 44),
    (49.5, 50, 49.5, 7),
    (44, 7, 49.5, 7),
    (104.5, 50, 104.5, 7),
    (104.5, 7, 110, 7),
)
"""Figure 2 of C: the automatic programming system, and what hangs on its bus."""
_FLOW: tuple[_Box, ...] = (
    ("curve of so many", 0.0, 90.0),
    ("each point near?", 0.0, 60.0),
    ("all within region?", 0.0, 30.0),
    ("the curve", 0.0, 0.0),
    ("add control points", 60.0, 60.0),
)
_COURSE: tuple[_Way, ...] = (
    (22, 90, 22, 74),
    (22, 60, 22, 44),
    (22, 30, 22, 14),
    (44, 67, 60, 67),
    (44, 37, 82, 37),
    (82, 37, 82, 60),
    (82, 74, 82, 97),
    (82, 97, 44, 97),
)
"""Figure 4 of E: how a piece of the curve is made."""
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
    found = {"a1": page_png(_boxes(_BOXES, _WIRES).page()), "b11": page_png(_times(figure_eleven))}
    found |= {"c2": page_png(_boxes(_PROGRAMMER, _BUS).page()), "a5c": page_png(_directions())}
    found |= dict(_of_the_bitmap(progress.part(0.0, 0.4)))
    found["metal"] = _metal()
    for k, (text, steps) in enumerate(_FILM.items()):
        share = progress.part(0.4 + 0.2 * k, 0.6 + 0.2 * k)
        film = make_film(TEXTS[text.value], progress=share)
        found |= {steps[step.number]: page_png(step.page) for step in film.steps if step.number in steps}
        if text is PublishedText.E:
            found["e4"] = page_png(_flow(film))
    return {name: found[name] for name in FIGURES}


def _of_the_bitmap(progress: Progress) -> Iterator[tuple[str, bytes]]:
    fine, coarse = _run(_FINE, progress.part(0.0, 0.7)), _run(_COARSE, progress.part(0.7, 1.0))
    for part, number in zip("abc", (_SHAPE, _OFFSETS, _TOOL_PATHS), strict=True):
        yield f"a2{part}", _stage(fine, number)
    yield "a5a", page_png(_outline(fine))
    yield "a5b", _stage(coarse, _CONTOUR_PIXELS)
    yield "a5d", _stage(coarse, _FILLED)


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


def _boxes(boxes: tuple[_Box, ...], ways: tuple[_Way, ...]) -> StepDrawing:
    """Return what a machine is made of, or does: words in boxes, and what connects them."""
    sketch = StepDrawing()
    for words, x, y in boxes:
        corners = np.array([[x, y], [x + _WIDE, y], [x + _WIDE, y + _HIGH], [x, y + _HIGH]])
        sketch.area(corners, AREA)
        sketch.line(np.vstack([corners, corners[:1]]))
        sketch.word(words, (x + 2.0, y + _HIGH / 2), INK, (0.0, -1.0))
    for x0, y0, x1, y1 in ways:
        sketch.line(np.array([[x0, y0], [x1, y1]], np.float64), BLUE)
    return sketch


def _outline(run: StagesRun) -> PlotPage:
    """Return figure 5 (a) of A: the offset contours as lines."""
    sketch = StepDrawing()
    for chain in run.dashes:
        rows, cols = chain.pixels().T
        sketch.line(np.column_stack([cols, -rows]).astype(np.float64))
    return sketch.page()


def _directions() -> PlotPage:
    """Return figure 5 (c) of A: the eight directions of a vector, as the chain codes have them."""
    sketch = StepDrawing()
    for number, (row, col) in enumerate(STEPS.tolist()):
        end = np.array([col, -row], np.float64)
        sketch.line(np.vstack([0.25 * end, end]), BLUE)
        sketch.dots(end[None], BLUE)
        sketch.word(str(number), 1.18 * end, INK, (-1.0, -1.2))
    sketch.dots(np.zeros((1, 2)), INK)
    return sketch.page((-1.4, -1.4, 1.4, 1.4))


def _flow(film: TextFilm) -> PlotPage:
    """Return figure 4 of E: how the curve is made, with what came of each round on the sample."""
    sketch = _boxes(_FLOW, _COURSE)
    for words, x, y in (("yes", 23.0, 51.0), ("yes", 23.0, 21.0), ("no", 47.0, 69.0), ("no", 47.0, 39.0)):
        sketch.word(words, (x, y), INK, (0.0, 0.0))
    rounds = [step for step in film.steps if step.number.startswith("figure 4, round")]
    for k, step in enumerate(rounds):
        told = {figure.name: figure.words for figure in step.figures}
        words = f"{k + 1}: {told['control points']} control points, {told['points too far']} far, {told['region']}"
        sketch.word(words, (115.0, 97.0 - 12.0 * k), INK, (0.0, 0.0))
    return sketch.page((0.0, -2.0, 200.0, 106.0))


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
