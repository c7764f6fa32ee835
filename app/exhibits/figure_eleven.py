"""The published comparison, its figure 11, measured again: how long each way to compute heights takes, in one process,
side by side.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import ExitStack
from dataclasses import dataclass, replace
from enum import Enum
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from ..core.errors import Cancelled, HitofudeError
from ..core.progress import NO_PROGRESS, Progress
from ..core.wording import together
from ..simulation.cutter import Cutter
from ..simulation.engines import Graphics
from ..simulation.field.workpiece import Grid, HeightDifference, Heights, StockShape, Workpiece, height_difference
from ..simulation.gpu.depth_buffer import DepthBuffer, published
from ..simulation.gpu.graphics import is_software, renderer_of
from ..simulation.gpu.polyhedron import facet_error, is_ball
from ..simulation.gpu.quads import quad_heights
from ..simulation.gpu.wedges import PolygonCounts, polygon_counts
from ..simulation.sweeps.chains import Chains, chains_of
from ..simulation.sweeps.course import Course
from ..simulation.sweeps.sweeps import WORKERS
from ..simulation.sweeps.trim import trim
from ..usecases.cutting.cut import GRAPHICS
from .die_programs import PROGRAMS, SIZE, STOCK
from .films.dexels import CutFilmInput

if TYPE_CHECKING:
    import moderngl

PORTIONS = 16
"""Parts in which the plain way is done, so that it can be stopped."""

_CHORD = 1e-3
"""mm; how far chords of an own program's arcs may be from them the plain way."""
_NAME = 24
"""Letters of a name that the table has room for."""

PRINTED = (
    "As printed, 1024 x 1024 cells on a workstation of 195 MHz: 9,542 moves, radius 5 mm, 16.83 s by software, 0.99 s "
    "by depth buffer; 35,391 moves, radius 3 mm, 15.93 s and 1.65 s."
)


class HeightMethod(Enum):
    """A way to compute heights; the value is its key in reports."""

    PLAIN = "plain"
    PUBLISHED = "published"
    QUADS = "quads"
    RECORD = "record"


WAYS = {
    HeightMethod.PLAIN: "plain software: one thread, every cell of each move's box",
    HeightMethod.PUBLISHED: "as published: cylinders and wedges in facets of two cells, drawn into the depth buffer",
    HeightMethod.QUADS: "a quad a move, the exact height in each cell, the least stays",
    HeightMethod.RECORD: "the engine of record, on the processor",
}


@dataclass(frozen=True, slots=True)
class FigureOptions:
    """What is measured.

    Attributes:
        programs: names out of `PROGRAMS`. cells: along each side of the block. repeat: runs, of which the best one
            counts.
        own: NC programs beside them, as they are cut.
        facets: sizes d of facets that the published way is also tried with, mm.
    """

    programs: tuple[str, ...] = tuple(PROGRAMS)
    cells: int = 1024
    repeat: int = 3
    own: tuple[CutFilmInput, ...] = ()
    facets: tuple[float, ...] = ()


@dataclass(frozen=True, eq=False)
class MeasuredProgram:
    """What is cut in every way.

    Attributes:
        name: of it. moves: straight ones that cut. radius: of its widest cutter, mm. course, cutters: as it is cut.
        stock: the metal.
    """

    name: str
    moves: int
    radius: float
    course: Course
    cutters: Mapping[int, Cutter]
    stock: StockShape

    def piece(self, cells: int) -> Workpiece:
        """Return the metal on a grid with so many cells along its longer side."""
        return self.stock.over(Grid.over(self.stock.box, cells))

    @property
    def plain(self) -> Chains | None:
        """The moves of its one ball, which the plain way can cut; None where it has other cutters."""
        parts = chains_of(self.course, self.cutters, _CHORD)
        alone = len(parts) == 1 and is_ball(parts[0][0])
        return parts[0][1] if alone else None


@dataclass(frozen=True, slots=True)
class FacetTrial:
    """The published way with facets of one size.

    Attributes:
        facet: d, mm. pitches: the same in distances of the dexels. polygons: that are drawn. seconds: of the best run.
        apart: how far heights are from those of the engine of record, mm. error: stated, mm.
    """

    facet: float
    pitches: float
    polygons: int
    seconds: float
    apart: float
    error: float


@dataclass(frozen=True, eq=False)
class FigureRow:
    """A program.

    Attributes:
        program: which.
        seconds: of the best run, by way; ways that need OpenGL are missing where there is none.
        apart: how far heights are from those of the engine of record, by way.
        polygons: of the published way. error: how far its facets are at most from the surface, mm.
        pitch: of the dexels, mm. trials: of other sizes of facets.
    """

    program: MeasuredProgram
    seconds: dict[HeightMethod, float]
    apart: dict[HeightMethod, HeightDifference]
    polygons: PolygonCounts
    error: float
    pitch: float
    trials: tuple[FacetTrial, ...] = ()

    @property
    def name(self) -> str:
        """Of the program."""
        return self.program.name

    def ratio(self, slower: HeightMethod, faster: HeightMethod) -> float | None:
        """Return how many times as long one way takes as another; None where one is missing."""
        if slower not in self.seconds or faster not in self.seconds:
            return None
        return self.seconds[slower] / self.seconds[faster]


@dataclass(frozen=True, eq=False)
class FigureEleven:
    """The table.

    Attributes:
        options: what was asked for. rows: one a program.
        renderer: name of what draws; empty where there is no OpenGL. fault: why there is none, or what has failed.
    """

    options: FigureOptions
    rows: tuple[FigureRow, ...]
    renderer: str
    fault: str

    def report(self) -> dict[str, Any]:
        """Return everything as plain values, units in the names."""
        return {
            "cells": self.options.cells,
            "pitch_mm": SIZE / self.options.cells,
            "repeat": self.options.repeat,
            "threads": WORKERS,
            "renderer": self.renderer or None,
            "software": is_software(self.renderer) if self.renderer else None,
            "fault": self.fault or None,
            "ways": {way.value: text for way, text in WAYS.items()},
            "programs": [_plain(row) for row in self.rows],
            "printed": PRINTED,
        }

    def text(self) -> str:
        """Return the table for people."""
        return "\n".join(_lines(self))


def figure_eleven(
    options: FigureOptions = FigureOptions(), progress: Progress = NO_PROGRESS, graphics: Graphics = GRAPHICS
) -> FigureEleven:
    """Measure every way on every program that is asked for.

    Raises:
        HitofudeError: the cells do not fit into memory. Cancelled: the job was asked to stop.
    """
    rows, renderer, faults = [], "", list[str]()
    with ExitStack() as stack:
        context = None
        try:
            context = stack.enter_context(graphics.current())
            renderer = renderer_of(context)
        except HitofudeError as error:
            faults.append(str(error))
        programs = [*(_die(name) for name in options.programs), *(_own(given) for given in options.own)]
        for k, measured in enumerate(programs):
            share = progress.part(k / len(programs), (k + 1) / len(programs))
            rows.append(_row(measured, options, context, faults, share))
    progress.step(1.0)
    return FigureEleven(options, tuple(rows), renderer, " ".join(faults))


Run = Callable[[Progress], Heights]


def _die(name: str) -> MeasuredProgram:
    made = PROGRAMS[name]
    return MeasuredProgram(name, made.moves, made.radius, made.course(), made.cutters, STOCK)


def _own(given: CutFilmInput) -> MeasuredProgram:
    moves = sum(len(chains) for _, chains in chains_of(given.course, given.cutters, _CHORD))
    radius = max(float(cutter.radius) for cutter in given.cutters.values())
    return MeasuredProgram(given.name, moves, radius, given.course, given.cutters, given.stock)


def _row(
    program: MeasuredProgram,
    options: FigureOptions,
    context: moderngl.Context | None,
    faults: list[str],
    progress: Progress,
) -> FigureRow:
    name, piece = program.name, program.piece(options.cells)
    progress.step(0.0, f"Making program {name}")
    course, cutters = program.course, program.cutters
    with ExitStack() as stack:
        seconds, heights = {}, {}
        ways = _ways(program, piece, context, stack)
        for k, (way, run) in enumerate(ways.items()):
            share = 0.05 + 0.9 * k / len(ways), 0.05 + 0.9 * (k + 1) / len(ways)
            try:
                seconds[way], heights[way] = _best(run, options.repeat, progress.part(*share))
            except (HitofudeError, Cancelled):
                raise
            except Exception as trouble:  # whatever a driver comes up with; the other ways are worth telling
                if way not in (HeightMethod.QUADS, HeightMethod.PUBLISHED):
                    raise
                faults.append(
                    f"{way.value} fails on program {name}: "
                    f"{' '.join(str(trouble).split())[:200] or type(trouble).__name__}"
                )
    found: dict[HeightMethod, HeightDifference] = {
        way: height_difference(heights[HeightMethod.RECORD], other)
        for way, other in heights.items()
        if way is not HeightMethod.RECORD
    }
    facet, record = published(piece.grid).facet, heights[HeightMethod.RECORD]
    trials = tuple(_trials(program, piece, record, options, context))
    error = _error(program, facet)
    pitch = piece.grid.pitch
    return FigureRow(program, seconds, found, polygon_counts(course, cutters, facet), error, pitch, trials)


def _error(program: MeasuredProgram, facet: float) -> float:
    used = np.unique(program.course.tool).tolist()
    return max(
        (facet_error(program.cutters[number], facet) for number in used if number in program.cutters), default=0.0
    )


def _trials(
    program: MeasuredProgram,
    piece: Workpiece,
    record: Heights,
    options: FigureOptions,
    context: moderngl.Context | None,
) -> Iterator[FacetTrial]:
    """Yield the published way with every size of facets that is asked for; nothing without OpenGL."""
    if context is None:
        return
    usual = published(piece.grid)
    for facet in options.facets:
        engine = DepthBuffer(context, replace(usual, facet=facet))
        try:
            run = partial(engine.heights, piece, program.course, program.cutters)
            seconds, heights = _best(run, options.repeat, NO_PROGRESS)
        finally:
            engine.release()
        counts = polygon_counts(program.course, program.cutters, facet)
        apart = height_difference(record, heights).largest
        yield FacetTrial(facet, facet / piece.grid.pitch, counts.drawn, seconds, apart, _error(program, facet))


def _ways(
    program: MeasuredProgram, piece: Workpiece, context: moderngl.Context | None, stack: ExitStack
) -> dict[HeightMethod, Run]:
    """Return what computes heights, by way; the stack gives back what they hold."""
    course, cutters = program.course, program.cutters
    ways: dict[HeightMethod, Run] = {
        HeightMethod.RECORD: lambda reported: trim(piece, course, cutters, progress=reported).heights
    }
    chains = program.plain
    if chains is not None:
        ways[HeightMethod.PLAIN] = lambda reported: plain_cut(piece, chains, program.radius, reported)
    if context is None:
        return ways
    engine = DepthBuffer(context, published(piece.grid))
    stack.callback(engine.release)
    return ways | {
        HeightMethod.QUADS: lambda reported: quad_heights(context, piece, course, cutters, reported),
        HeightMethod.PUBLISHED: lambda reported: engine.heights(piece, course, cutters, reported),
    }


def _best(run: Run, repeat: int, progress: Progress) -> tuple[float, Heights]:
    """Return the seconds of the best run, after one to warm up, and what it has computed."""
    best, heights = np.inf, None
    for k in range(repeat + 1):
        part = progress.part(k / (repeat + 1), (k + 1) / (repeat + 1))
        begun = time.perf_counter()
        heights = run(part)
        best = min(best, time.perf_counter() - begun) if k else best
    assert heights is not None
    return float(best), heights


def plain_cut(piece: Workpiece, chains: Chains, radius: float, progress: Progress = NO_PROGRESS) -> Heights:
    """Return what a ball leaves of a work piece, the plain way.

    Raises:
        Cancelled: the job was asked to stop.
    """
    from ..simulation.sweeps.plain_kernels import plain_trim

    heights, grid = piece.heights.astype(np.float64), piece.grid
    start, end = (np.ascontiguousarray(places - [grid.x0, grid.y0, 0.0]) for places in (chains.start, chains.end))
    bounds = np.linspace(0, len(start), PORTIONS + 1).astype(int).tolist()
    for k in range(PORTIONS):
        part = slice(bounds[k], bounds[k + 1])
        plain_trim(heights, start[part].copy(), end[part].copy(), radius, grid.pitch)
        progress.step((k + 1) / PORTIONS, "Cutting the plain way")
    return np.maximum(heights, piece.floor).astype(np.float32)


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _plain(row: FigureRow) -> dict[str, Any]:
    """Return a row as plain values."""
    ratios = {f"{slower.value}_by_{faster.value}": row.ratio(slower, faster) for slower, faster in _RATIOS}
    return {
        "program": row.name,
        "moves": row.program.moves,
        "radius_mm": row.program.radius,
        "seconds": {way.value: row.seconds.get(way) for way in HeightMethod},
        "ratios": ratios,
        "apart_from_record_mm": {way.value: _finite(found.largest) for way, found in row.apart.items()},
        "published_error_mm": row.error,
        "polygons": {
            "spheres": row.polygons.spheres,
            "spheres_culled": row.polygons.spheres_down,
            "wedges": row.polygons.wedges,
            "wedges_culled": row.polygons.drawn,
        },
        "pitch_mm": row.pitch,
        "facets": [
            {
                "facet_mm": each.facet,
                "pitches": each.pitches,
                "polygons": each.polygons,
                "seconds": each.seconds,
                "apart_from_record_mm": each.apart,
                "error_mm": each.error,
            }
            for each in row.trials
        ],
    }


_RATIOS = (
    (HeightMethod.PLAIN, HeightMethod.PUBLISHED),
    (HeightMethod.PLAIN, HeightMethod.RECORD),
    (HeightMethod.PUBLISHED, HeightMethod.QUADS),
    (HeightMethod.PUBLISHED, HeightMethod.RECORD),
)


def why_slower(figure: FigureEleven) -> Iterator[str]:
    """Yield a sentence for each program on which the published way is slower than another one, with the reason."""
    for row in figure.rows:
        took = row.seconds.get(HeightMethod.PUBLISHED)
        if took is None:
            yield f"On {row.name} the published way was not measured: {figure.fault or 'nothing draws here'}"
            continue
        ways = (HeightMethod.PLAIN, HeightMethod.RECORD)
        faster = [way for way in ways if row.seconds.get(way, math.inf) < took]
        if not faster:
            continue
        drawn, cells = row.polygons.drawn, row.program.piece(figure.options.cells).grid
        a_move = drawn / max(row.program.moves, 1)
        than = together(f"{took / row.seconds[way]:.1f} times the {way.value} way" for way in faster)
        why = (
            f"they are drawn by the processor, {figure.renderer}, which is what that way was to leave free"
            if is_software(figure.renderer)
            else f"{figure.renderer} has to draw more of them than there is to gain"
        )
        yield (
            f"On {row.name} the published way takes {than}: {drawn:,} facets of two cells, {a_move:.0f} a move, "
            f"{drawn / took / 1e6:.1f} million a second, for {cells.rows * cells.cols:,} cells; {why}."
        )


def _lines(figure: FigureEleven) -> Iterator[str]:
    """Yield the lines of the table."""
    yield _heading(figure)
    yield from _times(figure.rows)
    yield from _polygons(figure.rows)
    yield "How far heights are at most from those of the engine of record (cells on walls may fall to either side):"
    for row in figure.rows:
        yield f"{row.name:2}" + ", ".join(f"{way.value} {found.largest:.2g} mm" for way, found in row.apart.items())
    for row in figure.rows:
        yield from (_trial_line(row.name, each) for each in row.trials)
    yield from (f"{way.value}: {text}" for way, text in WAYS.items())
    yield from why_slower(figure)
    if figure.fault:
        yield figure.fault
    yield PRINTED


def _heading(figure: FigureEleven) -> str:
    options, renderer = figure.options, figure.renderer
    drawn = (
        f"drawn by {renderer} ({'software' if is_software(renderer) else 'hardware'})" if renderer else "nothing drawn"
    )
    return (
        f"Figure 11: {options.cells} x {options.cells} cells of {SIZE / options.cells:.4g} mm, best of "
        f"{options.repeat}, {WORKERS} threads; {drawn}"
    )


def _times(rows: Iterable[FigureRow]) -> Iterator[str]:
    """Yield what each way takes, and how many times what another one does."""
    columns = [f"{way.value:>12}" for way in HeightMethod] + [
        f"{slower.value + '/' + faster.value:>18}" for slower, faster in _RATIOS
    ]
    yield f"{'':2}{'moves':>8}{'radius':>8}" + "".join(columns)
    for row in rows:
        times = "".join(f"{row.seconds[way]:>10.3f} s" if way in row.seconds else f"{'-':>12}" for way in HeightMethod)
        ratios = "".join(
            f"{ratio:>17.1f}x" if (ratio := row.ratio(*pair)) is not None else f"{'-':>18}" for pair in _RATIOS
        )
        yield f"{row.name[:_NAME]:2}{row.program.moves:>8,}{row.program.radius:>5g} mm{times}{ratios}"


def _polygons(rows: Iterable[FigureRow]) -> Iterator[str]:
    yield "Polygons of the published way, and how far its facets are at most inside the surface:"
    yield f"{'':2}{'whole spheres':>15}{'half left away':>16}{'wedges':>14}{'half left away':>16}{'error':>13}"
    for row in rows:
        counts = row.polygons
        yield (
            f"{row.name:2}{counts.spheres:>15,}{counts.spheres_down:>16,}{counts.wedges:>14,}{counts.drawn:>16,}"
            f"{row.error:>10.5f} mm"
        )


def _trial_line(name: str, trial: FacetTrial) -> str:
    return (
        f"{name[:_NAME]:2} facets of {trial.facet:g} mm ({trial.pitches:.3g} w): {trial.polygons:,} polygons, "
        f"{trial.seconds:.3f} s, {trial.apart:.2g} mm from the engine of record, stated {trial.error:.2g} mm"
    )
