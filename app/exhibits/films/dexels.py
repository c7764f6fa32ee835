"""Text B step by step: dexels, cylinders and wedges in facets, the depth buffer, and the top closed with triangles."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from ...core.errors import InputError
from ...core.progress import NO_PROGRESS, Progress
from ...model.motion import Floats
from ...simulation.cutter import Cutter
from ...simulation.field.workpiece import Grid, StockShape
from ...simulation.gpu.polyhedron import facet_error, held_cutter, is_ball
from ...simulation.gpu.wedges import (
    EVERYWHERE,
    FacetKind,
    PolygonCounts,
    SweepFacets,
    Tessellation,
    chain_counts,
    chord_of,
    facets_in,
)
from ...simulation.sweeps.chains import Chains, chains_of, cutting
from ...simulation.sweeps.course import Course
from ...simulation.sweeps.trim import trim
from ..die_programs import STOCK, DieProgram
from .depth_raster import drawn
from .step import FilmFigure, FilmStep, PublishedText, TextFilm
from .step_drawing import AMBER, AREA, BLUE, BOLD, FAINT, FINE, GREEN, INK, LINE, RED, StepDrawing, seen

SAMPLE = DieProgram(1200, 5.0, 31)
"""A zigzag over the die of figure 11, coarse enough to be followed."""

CELLS = 96
"""Along the longer side of the grids that a film looks at."""

FACET_PITCHES = (0.5, 1.0, 2.0, 4.0, 8.0)
"""Sizes d of facets that are compared, in distances w of the dexels; the text found 2 to be enough."""

_ZOOM = 6.0
"""The part that is looked at is so many times narrower than the stock."""

_MOVES = 3
"""Moves whose sweep is shown by itself."""

_COARSE = 0.05
"""Of the tool's radius, how far chords of an arc may be from it where a few of them are shown: finer ones, as heights
want them, would be specks.
"""

_CELL = np.array([[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]])
"""Corners of a cell, in widths of a cell from its middle."""
_MOST_FACETS = 400_000
"""That are drawn; more would take minutes and be smaller than pixels."""
_PRINTED = (("9,542 moves, r = 5 mm", "16.83 s", "0.99 s"), ("35,391 moves, r = 3 mm", "15.93 s", "1.65 s"))


@dataclass(frozen=True, eq=False)
class CutFilmInput:
    """What is cut.

    Attributes:
        name: of the program. course: along which. cutters: by T number. stock: the metal.
        facet: size d of the facets, mm; None: twice the distance w of the dexels.
    """

    name: str
    course: Course
    cutters: Mapping[int, Cutter]
    stock: StockShape
    facet: float | None = None


def sample_input(facet: float | None = None) -> CutFilmInput:
    """Return the die that films are made of unless a program is given."""
    return CutFilmInput("the die of figure 11", SAMPLE.course(), SAMPLE.cutters, STOCK, facet)


def dexel_film(given: CutFilmInput, progress: Progress = NO_PROGRESS) -> TextFilm:
    """Return text B's steps on a program.

    Raises:
        InputError: nothing is cut in it, or far too many facets would have to be drawn.
        Cancelled: the job was asked to stop.
    """
    work = _DexelSteps(given, progress)
    return TextFilm(PublishedText.B, given.name, tuple(step() for step in work.all))


def zoomed(grid: Grid, by: float, place: tuple[float, float]) -> Grid:
    """Return the grid of as many cells over a part of another one, so many times narrower, about a place as far as
    there is room (S101).
    """
    x0, y0, x1, y1 = grid.box
    half = (x1 - x0) / by / 2, (y1 - y0) / by / 2
    x = min(max(place[0], x0 + half[0]), x1 - half[0])
    y = min(max(place[1], y0 + half[1]), y1 - half[1])
    return Grid.over((x - half[0], y - half[1], x + half[0], y + half[1]), max(grid.rows, grid.cols))


_SURE = 1e-5
"""mm, times 1 + the slope; what heights of facets and of closed forms are rounded by is less."""

_COMPARED = (
    "d / w",
    "facets",
    "off the closed form, straight up, mm",
    "stated, square to it, mm",
    "by the bound of each cell, mm",
    "cells outside",
)


@dataclass(frozen=True, slots=True)
class FacetsApart:
    """Where heights by facets lie between two closed forms: of the cutter, and of a slimmer one that the facets hold.

    Attributes:
        largest: how far they are above the first at most, mm, where no wall is. allowed: how far the second is there.
        outside: cells that lie below the first or above the second. walls: cells in which both are farther apart than
            cells are.
    """

    largest: float
    allowed: float
    outside: int
    walls: int

    @staticmethod
    def of(heights: Floats, exact: Floats, most: Floats, pitch: float) -> FacetsApart:
        """Return it for heights (rows, cols) mm; pitch: of the cells, mm."""
        down, across = np.gradient(exact, pitch)
        sure = _SURE * (1.0 + np.hypot(down, across))
        outside = (heights < exact - sure) | (heights > most + sure)
        plain = most - exact <= pitch
        return FacetsApart(
            float((heights - exact)[plain].max(initial=0.0)),
            float((most - exact)[plain].max(initial=0.0)),
            int(np.count_nonzero(outside)),
            int(np.count_nonzero(~plain)),
        )


@dataclass(frozen=True, slots=True)
class ComparedSize:
    """Facets of one size beside the closed form: that size in distances of the dexels (d / w), how many there are, how
    heights lie, and the error that is stated for them, mm, square to the surface.
    """

    times: float
    count: int
    apart: FacetsApart
    stated: float


class _DexelSteps:
    """One program on two grids: over all of its stock, and over a part."""

    def __init__(self, given: CutFilmInput, progress: Progress) -> None:
        self.given = given
        self.whole = given.stock.over(Grid.over(given.stock.box, CELLS))
        pitch = self.whole.grid.pitch / _ZOOM
        self.chord = chord_of(given.course, given.cutters, min(FACET_PITCHES[0] * pitch, given.facet or pitch))
        chains = chains_of(given.course, given.cutters, self.chord)
        if not any(len(pair.chains) for pair in chains):
            raise InputError(f"{given.name}: nothing is cut; a film of this text needs a program that cuts.")
        most = max(range(len(chains)), key=lambda k: (is_ball(chains[k].cutter), len(chains[k].chains)))
        self.cutter, self.chains = replace(chains[most].cutter, lift=0.0), chains[most].chains
        self.few = chains_of(given.course, given.cutters, _COARSE * self.cutter.radius)[most].chains
        self.at = self._bent()
        self.grid = zoomed(self.whole.grid, _ZOOM, (float(self.tips[-1, 0]), float(self.tips[-1, 1])))
        self.part = given.stock.over(self.grid)
        self.facet = given.facet or 2 * self.grid.pitch
        progress.step(0.1, "Counting facets")
        self.counts = {times: self._counted(times * self.grid.pitch) for times in FACET_PITCHES}
        progress.step(0.3, "Making facets")
        self.facets = self._facets(self.facet)
        self.depth = drawn(self.facets.quads.astype(np.float64), self.grid, progress.part(0.3, 0.7))
        progress.step(0.7, "Cutting in closed form")
        self.exact = self._closed_form(self.cutter)
        self.cut = np.minimum(self.part.heights, np.maximum(self.depth, self.part.floor))
        self.apart = self._apart(self.cut, self.facet)
        self.by_facet = self._compared(progress.part(0.75, 1.0))

    def _bent(self) -> int:
        """Return the number of the move in the middle of the sharpest bend inside a chain."""
        way, joins = self.few.way, self.few.joins.astype(bool)
        turn = np.where(joins[1:], 1.0 - np.einsum("ij,ij->i", way[:-1], way[1:]), -1.0)
        x0, y0, x1, y1 = self.given.stock.box
        place = self.few.end[:-1]
        room = 1.2 * self.cutter.radius
        inside = (place[:, 0] > x0 + room) & (place[:, 0] < x1 - room) & (place[:, 1] > y0 + room)
        turn = np.where(inside & (place[:, 1] < y1 - room), turn, turn - 2.0)
        return int(np.argmax(turn)) if len(turn) else 0

    @property
    def ball(self) -> bool:
        """Whether the tool is the text's own."""
        return is_ball(self.cutter)

    @property
    def tips(self) -> Floats:
        """Places of the tip along the few moves that are shown."""
        first = max(self.at - (_MOVES - 2), 0)
        stop = first + 1
        while stop < min(first + _MOVES, len(self.few)) and self.few.joins[stop]:
            stop += 1
        return np.vstack([self.few.start[first : first + 1], self.few.end[first:stop]])

    @property
    def all(self) -> tuple[Callable[[], FilmStep], ...]:
        """The steps in their order."""
        return (
            self.entered,
            self.zoom,
            self.dexels,
            self.sweep,
            self.wedges,
            self.tessellated,
            self.draw,
            self.read,
            self.trimmed,
            self.closed,
            self.shaded,
        )

    def _near(self) -> Chains:
        """Return the moves that can reach the part that is looked at."""
        x0, y0, x1, y1 = self.grid.box
        r = self.cutter.radius
        low, high = (np.minimum(self.chains.start, self.chains.end), np.maximum(self.chains.start, self.chains.end))
        keep = (low[:, 0] <= x1 + r) & (high[:, 0] >= x0 - r) & (low[:, 1] <= y1 + r) & (high[:, 1] >= y0 - r)
        joins = self.chains.joins.astype(bool) & np.concatenate([[False], keep[:-1]])
        return Chains(
            self.chains.start[keep], self.chains.end[keep], self.chains.way[keep], joins[keep].astype(np.uint8)
        )

    def _facets(self, size: float) -> SweepFacets:
        """Return the facets of one size over the part that is looked at."""
        found = _collected(self.cutter, self._near(), size, self.grid.box)
        if len(found.kind) > _MOST_FACETS:
            raise InputError(
                f"{len(found.kind):,} facets of {size:g} mm lie over the part that is looked at; use larger ones, or "
                "fewer moves."
            )
        return found

    def _counted(self, size: float) -> PolygonCounts:
        return chain_counts(self.cutter, self._near(), size)

    def _closed_form(self, cutter: Cutter) -> Floats:
        """Return what a cutter leaves of the part along the moves that the facets are made along, in closed form."""
        heights = trim(self.part, _course_of(self._near()), {1: cutter}).heights
        return np.asarray(heights, np.float64)

    def _apart(self, heights: Floats, size: float) -> FacetsApart:
        """Return how heights by facets of a size lie between the closed forms that hold them."""
        held = held_cutter(self.cutter, size)
        most = self._closed_form(held) if held is not None else np.asarray(self.part.heights, np.float64)
        return FacetsApart.of(heights, self.exact, most, self.grid.pitch)

    def _compared(self, progress: Progress) -> tuple[ComparedSize, ...]:
        """Return how heights by facets of several sizes lie beside exact ones; of too many facets nothing."""
        rows = []
        for number, times in enumerate(FACET_PITCHES):
            progress.step(number / len(FACET_PITCHES), "Comparing sizes of facets")
            size = times * self.grid.pitch
            if self.counts[times].drawn > _MOST_FACETS // 4:
                continue
            facets = self._facets(size)
            heights = np.minimum(
                self.part.heights, np.maximum(drawn(facets.quads.astype(np.float64), self.grid), self.part.floor)
            )
            stated = facet_error(self.cutter, size)
            rows.append(ComparedSize(times, len(facets.kind), self._apart(heights, size), stated))
        return tuple(rows)

    def entered(self) -> FilmStep:
        """Return S100."""
        sketch = StepDrawing()
        x0, y0, x1, y1 = self.given.stock.box
        sketch.area(np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]]))
        for part in _runs(self.chains):
            sketch.line(part, BLUE, FINE)
        return FilmStep(
            "S100",
            "Enter metal, cutter, path",
            "The solid before machining, the ball end mill and its path are entered, the Z axis along the tool's.",
            "Stock may be a box, a solid, or heights that were left; the tool of any kind. Of several tools a ball is "
            "shown, that with the most moves.",
            sketch.page(),
            (
                FilmFigure("moves", int(np.count_nonzero(cutting(self.given.course, self.given.cutters)))),
                FilmFigure("radius", float(self.cutter.radius), "mm"),
                FilmFigure("stock along X", x1 - x0, "mm"),
                FilmFigure("along Y", y1 - y0, "mm"),
            ),
        )

    def zoom(self) -> FilmStep:
        """Return S101."""
        sketch = StepDrawing()
        x0, y0, x1, y1 = self.given.stock.box
        sketch.line(np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1], [x0, y0]]), FAINT, LINE)
        a, b, c, d = self.grid.box
        sketch.area(np.array([[a, b], [c, b], [c, d], [a, d]]))
        sketch.line(np.array([[a, b], [c, b], [c, d], [a, d], [a, b]]), BLUE, BOLD)
        return FilmStep(
            "S101",
            "Enlarge a part",
            "To look closer, the solid within the view volume is the new solid: the same number of "
            "dexels makes w smaller, and detail grows.",
            "Here the upright box round what is seen of the stock.",
            sketch.page(),
            (
                FilmFigure("w over all of it", self.whole.grid.pitch, "mm"),
                FilmFigure("w here", self.grid.pitch, "mm"),
            ),
        )

    def _row(self) -> int:
        """Return the row of cells that sections show: that through the bend."""
        return int(np.argmin(np.abs(self.grid.ys() - self.tips[1, 1])))

    def _columns(self, heights: Floats, colour: str = AREA) -> StepDrawing:
        """Return a row of dexels from the side."""
        sketch, w = StepDrawing(), self.grid.pitch
        row = heights[self._row()]
        low = max(self.part.floor, float(self.exact[self._row()].min()) - 12 * w)
        for x, top in zip(self.grid.xs().tolist(), row.tolist(), strict=True):
            if top > low:
                sketch.area(np.array([[x - w / 2, low], [x + w / 2, low], [x + w / 2, top], [x - w / 2, top]]), colour)
                sketch.line(np.array([[x - w / 2, low], [x - w / 2, top], [x + w / 2, top]]), FAINT, FINE / 2)
        return sketch

    def dexels(self) -> FilmStep:
        """Return S102."""
        return FilmStep(
            "S102",
            "Dexels",
            "Over a grid of spacing w, parallel to X and Y, a line along Z through each cell's centre meets "
            "the solid in a segment: a column as thick as the cell.",
            f"Where a line meets it more than once the top is kept and the cells are counted: {self.part.hidden} here.",
            self._columns(np.asarray(self.part.heights, np.float64)).page(),
            (
                FilmFigure("dexels", self.grid.rows * self.grid.cols, "", "about 1,000 x 1,000"),
                FilmFigure("spacing w", self.grid.pitch, "mm"),
            ),
        )

    def sweep(self) -> FilmStep:
        """Return S103."""
        sketch, r = StepDrawing(), float(self.cutter.radius)
        centres = self.tips + [0, 0, r]
        for a, b in zip(centres[:-1, :2], centres[1:, :2], strict=True):
            way = (b - a) / max(float(np.linalg.norm(b - a)), 1e-300)
            side = r * np.array([-way[1], way[0]])
            sketch.line(np.vstack([a + side, b + side]), BLUE, FINE)
            sketch.line(np.vstack([a - side, b - side]), BLUE, FINE)
        for centre in centres:
            sketch.ring(centre, r, AMBER, FINE)
        sketch.line(centres, INK, BOLD)
        sketch.dots(centres, INK, 0.9)
        return FilmStep(
            "S103",
            "What the ball sweeps",
            "Cutting is trimming the dexels' tops by what the ball sweeps: a cylinder for each "
            "straight move and a sphere at each corner between.",
            "Seen from above: a few moves about a bend."
            if self.ball
            else "Seen from above: a few moves about a bend. The tool is no ball, and what its silhouette sweeps is in "
            "the cylinder's place.",
            sketch.page(),
            (
                FilmFigure("cylinders", len(self.chains)),
                FilmFigure("spheres", self.chains.corners),
            ),
        )

    def _shown_facets(self, size: float) -> SweepFacets:
        start, end = self.tips[:-1], self.tips[1:]
        return _collected(self.cutter, Chains.of(start, end, np.arange(len(start)) > 0), size, EVERYWHERE)

    def _net(self, facets: SweepFacets, only: FacetKind | None = None) -> StepDrawing:
        sketch = StepDrawing()
        colours = {FacetKind.CYLINDER: BLUE, FacetKind.WEDGE: RED, FacetKind.END: AMBER}
        for quad, kind in zip(facets.quads, facets.kind.tolist(), strict=True):
            if only is None or kind == only:
                sketch.line(seen(quad[[0, 1, 2, 3, 0]].astype(np.float64)), colours[FacetKind(kind)], FINE / 2)
        return sketch

    def wedges(self) -> FilmStep:
        """Return S104."""
        counts = self.counts[2.0]
        return FilmStep(
            "S104",
            "Wedges",
            "Most of a sphere lies inside the cylinders beside it; two planes through its centre, at the "
            "ends of these, leave a wedge, very slim where the path bends little.",
            f"Over the part that is looked at whole spheres would be {counts.spheres:,} polygons, wedges are "
            f"{counts.wedges:,}. Wedges are red, half spheres at the ends of the path yellow."
            if self.ball
            else "The tool is no ball: of its facets at a corner only those are drawn that bound at one of both moves "
            f"and not at the other. Whole tools would be {counts.spheres:,} polygons, these are {counts.wedges:,}.",
            self._net(self._shown_facets(self.cutter.radius / 8)).page(),
            (
                FilmFigure("polygons with whole spheres", counts.spheres),
                FilmFigure("of these spheres' polygons look down", counts.spheres_down),
                FilmFigure("polygons with wedges", counts.wedges),
                FilmFigure("of these that look down", counts.drawn),
            ),
        )

    def tessellated(self) -> FilmStep:
        """Return S105."""
        rows = [_COMPARED]
        rows += [
            (
                *(f"{each.times:g}", f"{each.count:,}", f"{each.apart.largest:.6f}", f"{each.stated:.6f}"),
                *(f"{each.apart.allowed:.6f}", f"{each.apart.outside}"),
            )
            for each in self.by_facet
        ]
        counts = self.counts[2.0]
        return FilmStep(
            "S105",
            "Into facets of size d",
            "Cylinders become strips of rectangles, wedges strips of quads, of size d; those that look up cannot be "
            "the lower side and are left out. d may be larger than w: at d = 2 w no difference is seen, and several d "
            "> w can be tried.",
            "The table tries them: each cell is held against the closed form of the tool, and of one that the facets "
            "hold; between both it must lie, and how far these are apart there is what it may be off. Beside walls, "
            "where that is more than w, only whether it lies between.",
            self._net(self._shown_facets(max(self.facet, self.cutter.radius / 12))).page(),
            (
                FilmFigure("d", self.facet, "mm", f"2 w = {2 * self.grid.pitch:.4g}"),
                FilmFigure("polygons, all", counts.wedges),
                FilmFigure("that look down", counts.drawn),
            ),
            tuple(rows),
        )

    def draw(self) -> FilmStep:
        """Return S106."""
        seen_cells = np.isfinite(self.depth)
        return FilmStep(
            "S106",
            "Draw them",
            "The grid is taken for the frame buffer: the facets are drawn by parallel projection from "
            "below, and the depth buffer keeps the lowest.",
            "Drawn in plain arrays here, so that the film is the same everywhere; `cut --engine patent` has the "
            "graphics hardware draw them.",
            self._depths().page(),
            (
                FilmFigure("facets drawn", len(self.facets.kind)),
                FilmFigure("cells drawn over", int(seen_cells.sum())),
            ),
            (("published", "software", "depth buffer"), *_PRINTED),
        )

    def read(self) -> FilmStep:
        """Return S107."""
        known = self.depth[np.isfinite(self.depth)]
        sketch = StepDrawing()
        row = self.depth[self._row()]
        keep = np.isfinite(row)
        for a, b in np.flatnonzero(np.diff(np.concatenate([[0], keep, [0]]))).reshape(-1, 2).tolist():
            sketch.line(np.column_stack([self.grid.xs()[a:b], row[a:b]]), RED, LINE)
        return FilmStep(
            "S107",
            "Read the depths back",
            "When all is drawn, each cell's depth is the lowest height of what swept over it.",
            "",
            sketch.page(),
            (
                FilmFigure("lowest", float(known.min()) if len(known) else 0.0, "mm"),
                FilmFigure("highest", float(known.max()) if len(known) else 0.0, "mm"),
            ),
        )

    def trimmed(self) -> FilmStep:
        """Return S108."""
        sketch = self._columns(self.cut)
        exact = np.column_stack([self.grid.xs(), self.exact[self._row()]])
        sketch.line(exact, GREEN, LINE)
        taken = float((self.part.heights - self.cut).sum()) * self.grid.pitch**2
        error, apart = facet_error(self.cutter, self.facet), self.apart
        return FilmStep(
            "S108",
            "Trim the dexels",
            "Every dexel that is higher than its depth is trimmed to it.",
            "The heights of record are a closed form in each cell (green); facets of size d lie inside what is swept, "
            f"so metal is left by up to {error:.2g} mm square to the surface, more straight up where it is steep. In "
            f"every cell that is bounded by the closed form of a tool that the facets hold: {apart.outside} cells lie "
            f"outside, {apart.walls} beside walls may fall to either side.",
            sketch.page(),
            (
                FilmFigure("volume taken off here", taken, "mm³"),
                FilmFigure("facets off the closed form, straight up", apart.largest, "mm"),
                FilmFigure("by the bound of each cell, at most", apart.allowed, "mm"),
                FilmFigure("stated, square to the surface", error, "mm"),
                FilmFigure("cells outside of their bounds", apart.outside),
            ),
        )

    def closed(self) -> FilmStep:
        """Return S109."""
        sketch = StepDrawing()
        half = 10
        row, col = self._row(), int(np.argmin(np.abs(self.grid.xs() - self.tips[1, 0])))
        rows = slice(max(row - half, 0), row + half)
        cols = slice(max(col - half, 0), col + half)
        z = self.cut[rows, cols]
        x, y = np.meshgrid(self.grid.xs()[cols], self.grid.ys()[rows])
        net = seen(np.stack([x, y, z], axis=-1))
        for i in range(len(net)):
            sketch.line(net[i], BLUE, FINE)
        for j in range(net.shape[1]):
            sketch.line(net[:, j], BLUE, FINE)
        for i in range(len(net) - 1):
            for j in range(net.shape[1] - 1):
                sketch.line(np.stack([net[i, j], net[i + 1, j + 1]]), FAINT, FINE / 2)
        count = 2 * (self.grid.rows - 1) * (self.grid.cols - 1)
        return FilmStep(
            "S109",
            "Close the tops",
            "Small triangles laid over the dexels' tops bridge the steps between them.",
            "",
            sketch.page(),
            (FilmFigure("triangles", count),),
        )

    def _depths(self) -> StepDrawing:
        """Return what the depth buffer holds: the lower a cell's facet, the darker; what nothing was drawn over stays
        white.
        """
        known = self.depth[np.isfinite(self.depth)]
        low, high = (float(known.min()), float(known.max())) if len(known) else (0.0, 0.0)
        share = (self.depth - low) / max(high - low, 1e-12)
        return self._cells(np.clip(30 + 200 * np.where(np.isfinite(share), share, 0.0), 30, 230), self.depth)

    def _shades(self, heights: Floats) -> StepDrawing:
        """Return cells from above, lit from the north-west; cells without a height are left white."""
        w = self.grid.pitch
        dy, dx = np.gradient(np.where(np.isfinite(heights), heights, 0.0), w)
        light = (1.0 + 0.6 * dx - 0.6 * dy) / np.sqrt(1 + dx**2 + dy**2) / 1.36
        return self._cells(np.clip(60 + 170 * light, 30, 245), heights)

    def _cells(self, grey: Floats, heights: Floats) -> StepDrawing:
        """Return cells from above in tones of grey, 0 to 255; those without a height are left white."""
        sketch, w, tones = StepDrawing(), self.grid.pitch, grey.astype(int)
        xs, ys = self.grid.xs(), self.grid.ys()
        for i, y in enumerate(ys.tolist()):
            for j, x in enumerate(xs.tolist()):
                if np.isfinite(heights[i, j]):
                    tone = f"{tones[i, j]:02x}" * 3
                    sketch.area(np.array([x, y]) + w * _CELL, f"#{tone}")
        return sketch

    def shaded(self) -> FilmStep:
        """Return S110."""
        return FilmStep(
            "S110",
            "Show it",
            "The triangles are drawn shaded, hidden ones removed.",
            "The Cut view shows the field as it plays; `figure11` measures what each way takes on this machine.",
            self._shades(self.cut).page(),
            (FilmFigure("cells", self.grid.rows * self.grid.cols),),
            (("published", "software", "depth buffer"), *_PRINTED),
        )


def _collected(cutter: Cutter, chains: Chains, size: float, box: tuple[float, float, float, float]) -> SweepFacets:
    """Return all facets of one size of what a cutter sweeps, over a box."""
    parts = [(part.quads.copy(), part.kind.copy()) for part, _ in facets_in(cutter, chains, Tessellation(size), box)]
    none = np.zeros((0, 4, 3), np.float32)
    return SweepFacets(
        np.concatenate([none, *(quads for quads, _ in parts)]),
        np.concatenate([np.zeros(0, np.uint8), *(kind for _, kind in parts)]),
    )


def _course_of(chains: Chains) -> Course:
    """Return moves as a course of tool 1, each from its own start to its own end."""
    from ...fitting.fitted import lines_between

    lines = replace(lines_between(np.zeros((len(chains) + 1, 3))), start=chains.start, end=chains.end)
    return Course(lines, np.ones(len(chains), np.int32))


def _runs(chains: Chains) -> list[Floats]:
    """Return the places of each chain of moves, (n, 2) mm."""
    begins = [*np.flatnonzero(chains.joins == 0).tolist(), len(chains)]
    return [np.vstack([chains.start[a : a + 1], chains.end[a:b]])[:, :2] for a, b in pairwise(begins)]
