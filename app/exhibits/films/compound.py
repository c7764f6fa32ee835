"""Text C step by step: surfaces, cutting planes, section curves, the topmost points and where they change surfaces."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

import numpy as np

from ...core.errors import InputError
from ...core.progress import NO_PROGRESS, Progress
from ...formats.plot.surface_plot import colour_of
from ...formats.scene.toml import read_scene
from ...gcode.interpreter.program import NcProgram
from ...model.motion import Floats
from ...model.motion_path import anchored
from ...model.scene import LineType
from ...model.scene_curves import SceneFiles
from ...surfaces.patches.patch import BsplineSurface
from ...surfaces.sections.compound import NO_SURFACE, BoundaryKind, PlaneSection
from ...usecases.scene.compute import ComputedFamily, ComputedScene, compute
from ...usecases.scene_program.nc import WrittenScene, write_scene_nc
from .step import FilmFigure, FilmStep, PublishedText, TextFilm
from .step_drawing import BLUE, BOLD, CHAIN, DOTTED, FAINT, FINE, INK, LINE, RED, StepDrawing, seen

_LINES = {LineType.SOLID: (), LineType.DOTTED: DOTTED, LineType.CHAIN: CHAIN}
_NET = 9
"""Lines of the net that a surface is drawn as, each way."""
_TRIANGLES = 400
"""Of a mesh, that are drawn of it."""


def compound_film(name: str, data: bytes, sources: SceneFiles, progress: Progress = NO_PROGRESS) -> TextFilm:
    """Return text C's steps on a scene.

    Args:
        name, data: of the scene's file. sources: reads the files that it names.

    Raises:
        HitofudeError: the scene cannot be computed, or has no passes. Cancelled: the job was asked to stop.
    """
    computed = compute(read_scene(name, data), sources, progress.part(0.0, 0.6))
    if not computed.families:
        raise InputError(f"{name} has no passes that are switched on; a film needs some.")
    written = write_scene_nc(computed, progress.part(0.6, 1.0))
    work = _CompoundSteps(computed, written)
    return TextFilm(PublishedText.C, name, tuple(step() for step in work.all))


class _CompoundSteps:
    """One scene, its first family of passes, and one of its planes: that with the most boundary points."""

    def __init__(self, computed: ComputedScene, written: WrittenScene) -> None:
        self.computed, self.written = computed, written
        self.family: ComputedFamily = computed.families[0]
        self.surface = self.family.surface
        found = self.surface.boundaries
        between = (found.before != NO_SURFACE) & (found.after != NO_SURFACE)
        counts = np.bincount(found.plane[between], minlength=len(self.surface.planes.offsets))
        most = np.flatnonzero(counts == counts.max())
        self.plane = int(most[len(most) // 2])
        self.between = np.flatnonzero(between)

    @property
    def all(self) -> tuple[Callable[[], FilmStep], ...]:
        """The steps in their order."""
        return (
            self.entered,
            self.planes,
            self.first,
            self.line,
            self.sections,
            self.topmost,
            self.generated,
            self.drawn,
            self.checked,
        )

    def _colour(self, number: int) -> str:
        surfaces = self.computed.scene.surfaces
        given = surfaces[number].colour if 0 <= number < len(surfaces) else ""
        return given or (colour_of(number) if number >= 0 else FAINT)

    def _dash(self, number: int) -> tuple[float, ...]:
        surfaces = self.computed.scene.surfaces
        kind = surfaces[number].line if 0 <= number < len(surfaces) else LineType.SOLID
        usual = (LineType.SOLID, LineType.DOTTED, LineType.CHAIN)[max(number, 0) % 3]
        return _LINES[usual if kind is LineType.AUTO else kind]

    def _net_lines(self) -> Iterator[tuple[int, Floats]]:
        """Yield the surfaces as nets of lines (n, 3), each with its surface's number."""
        for number, built in enumerate(self.computed.built):
            for spline in built.splines:
                for line in _net(spline):
                    yield number, line
            if built.triangles is not None:
                for corners in built.triangles[:: max(1, len(built.triangles) // _TRIANGLES)]:
                    yield number, corners[[0, 1, 2, 0]]

    def _nets(self) -> StepDrawing:
        """Return the surfaces as nets of lines, seen from the side and above."""
        sketch = StepDrawing()
        for number, line in self._net_lines():
            sketch.line(seen(line), self._colour(number), FINE)
        return sketch

    def entered(self) -> FilmStep:
        """Return (a): the surfaces are entered."""
        table = (
            ("surface", "shape", "off what was entered, mm"),
            *(
                (
                    each.surface.name,
                    type(each.surface.shape).__name__.removesuffix("Shape").lower(),
                    f"{each.deviation:.3g}",
                )
                for each in self.computed.built
            ),
        )
        return FilmStep(
            "(a)",
            "Enter the surfaces",
            "Data that tell the surfaces 12a, 12b, 12c are entered and stored.",
            "Section curves of a drawing, or any other form of the scene file.",
            self._nets().page(),
            (FilmFigure("surfaces", len(self.computed.built)),),
            table,
        )

    def _seen_from_above(self) -> StepDrawing:
        """Return the surfaces and the stock in the XY plane, in which the lines of the planes lie."""
        sketch = StepDrawing()
        for number, line in self._net_lines():
            sketch.line(line, self._colour(number), FINE)
        stock = self.computed.stock
        corners = np.array([[stock.x0, stock.y0], [stock.x1, stock.y0], [stock.x1, stock.y1], [stock.x0, stock.y1]])
        sketch.line(np.vstack([corners, corners[:1]]), FAINT, LINE)
        return sketch

    def _plane_line(self, plane: int) -> Floats:
        """Return both ends of a plane's line on the XY plane: as far as its sections go."""
        planes = self.surface.planes
        own = np.concatenate([np.zeros((0, 3)), *(run.points for run in self.surface.runs if run.plane == plane)])
        if not len(own):
            return np.zeros((0, 2))
        along = (own[:, :2] - planes.origin) @ np.array(planes.along)
        return np.array([planes.place(plane, float(along.min())), planes.place(plane, float(along.max()))])

    def _add_line(self, sketch: StepDrawing, plane: int, look: tuple[str, float]) -> None:
        """Draw the line of a plane in a colour and width, and its name at its end."""
        ends = self._plane_line(plane)
        sketch.line(ends, *look)
        if len(ends):
            sketch.word(f"CL{plane + 1}", ends[-1], look[0])

    def planes(self) -> FilmStep:
        """Return (b): one line and a rule give the planes."""
        sketch = self._seen_from_above()
        planes = self.surface.planes
        for k in range(1, len(planes.offsets)):
            sketch.line(self._plane_line(k), INK, FINE)
        self._add_line(sketch, 0, (BLUE, BOLD))
        steps = np.diff(planes.offsets)
        even = float(steps[0]) if len(steps) else 0.0
        return FilmStep(
            "(b)",
            "One line and a rule",
            "A line on the XY plane and a rule are entered, from which follow the lines in which the cutting planes, "
            "upright on it, meet that plane: in the example parallel ones, a distance d apart.",
            "The distance may also follow a height of the ridges between passes; planes may also fan out from a place, "
            "or stand square on a guide.",
            sketch.page(),
            (
                FilmFigure("planes", len(planes.offsets)),
                FilmFigure("distance d", even, "mm"),
                FilmFigure("angle to the X axis", math.degrees(planes.angle), "degrees"),
            ),
        )

    def first(self) -> FilmStep:
        """Return (c): i is 1."""
        sketch = self._seen_from_above()
        self._add_line(sketch, 0, (BLUE, BOLD))
        return FilmStep("(c)", "Begin with the first", "i becomes 1.", "", sketch.page(), (FilmFigure("i", 1),))

    def line(self) -> FilmStep:
        """Return (d): the line CLi of the plane shown."""
        sketch = self._seen_from_above()
        if self.plane:
            self._add_line(sketch, 0, (INK, LINE))
        self._add_line(sketch, self.plane, (BLUE, BOLD))
        offset = self.surface.planes.offsets[self.plane] - self.surface.planes.offsets[0]
        return FilmStep(
            "(d)",
            "The line CLi",
            "From the first line and the distance d the line CLi follows.",
            "",
            sketch.page(),
            (FilmFigure("i", self.plane + 1), FilmFigure("from the first line", float(offset), "mm")),
        )

    def _flat(self, points: Floats) -> Floats:
        """Return places of a plane as along it and up, (n, 2) mm."""
        planes = self.surface.planes
        return np.column_stack([(points[:, :2] - planes.origin) @ np.array(planes.along), points[:, 2]])

    def _curves(self) -> list[PlaneSection]:
        return [curve for curve in self.surface.curves if curve.plane == self.plane]

    def sections(self) -> FilmStep:
        """Return (e): every surface's section curve."""
        sketch = StepDrawing()
        rows = [("surface", "points")]
        for curve in self._curves():
            sketch.line(self._flat(curve.points), self._colour(curve.owner), LINE)
            sketch.dots(self._flat(curve.points), self._colour(curve.owner), 0.5)
            rows.append((self.computed.names[curve.owner], str(len(curve.points))))
        return FilmStep(
            "(e)",
            "Cut the surfaces",
            "The plane of CLi cuts every surface; each section curve is found as a sequence of points.",
            "Points lie as densely as the chord tolerance asks.",
            sketch.page(),
            (FilmFigure("section curves", len(rows) - 1),),
            tuple(rows),
        )

    def topmost(self) -> FilmStep:
        """Return (f): the topmost points, and where they pass from surface to surface."""
        sketch, found = self._topmost_runs(), self.surface.boundaries
        gaps = {k: self._gap(k) for k in self.between.tolist()}
        here = [k for k in gaps if found.plane[k] == self.plane]
        rows: list[tuple[str, ...]] = [("boundary point", "kind", "x", "y", "z", "apart in z, mm")]
        rows += [self._boundary_row(k, gaps[k]) for k in here]
        for k in here:
            place = self._flat(found.place[k][None])
            sketch.dots(place, RED, 1.1)
            sketch.word(self._boundary_name(k), place[0], RED)
        apart = [gap for gap in gaps.values() if gap is not None]
        worst = max(apart, default=0.0)
        return FilmStep(
            "(f)",
            "Keep the topmost",
            "The topmost points of all section curves are the compound surface's; where they pass "
            "from surface i to surface j, the boundary point CRij is kept.",
            "A boundary point is solved for, not picked from the sequences: where one surface crosses another, both "
            f"are as high there. Put back into the surfaces' own formulas the heights of all {len(apart)} such points "
            f"are up to {worst:.1e} mm apart. Covered sections are drawn lightly.",
            sketch.page(),
            (
                FilmFigure("boundary points here", len(rows) - 1),
                FilmFigure("largest distance in z, all planes", worst, "mm"),
            ),
            tuple(rows),
        )

    def _topmost_runs(self) -> StepDrawing:
        """Return the picture of the section curves, and over them of what is kept of each."""
        sketch = StepDrawing()
        for curve in self._curves():
            sketch.line(self._flat(curve.points), FAINT, FINE)
        for run in self.surface.runs:
            if run.plane == self.plane:
                flat = self._flat(run.points)
                for k, owner in enumerate(run.owner.tolist()):
                    sketch.line(flat[k : k + 2], self._colour(owner), BOLD)
        return sketch

    def _boundary_name(self, k: int) -> str:
        found = self.surface.boundaries
        return f"CR{found.before[k] + 1}{found.after[k] + 1}"

    def _boundary_row(self, k: int, gap: float | None) -> tuple[str, ...]:
        """Return what the table says of a boundary point; `gap`: between both heights there, mm."""
        found = self.surface.boundaries
        kind, place = BoundaryKind(int(found.kind[k])).name.lower(), (f"{x:.4f}" for x in found.place[k])
        return (self._boundary_name(k), kind, *place, "-" if gap is None else f"{gap:.2g}")

    def _gap(self, k: int) -> float | None:
        """Return how far apart in Z two surfaces are at a crossing, by a formula of our own; None where it has none."""
        found = self.surface.boundaries
        if BoundaryKind(int(found.kind[k])) is not BoundaryKind.CROSSING:
            return None
        places = []
        for owner, at in ((found.before[k], found.before_at[k]), (found.after[k], found.after_at[k])):
            splines = self.computed.built[int(owner)].splines if 0 <= owner < len(self.computed.built) else ()
            if len(splines) != 1 or not np.isfinite(at).all():
                return None
            places.append(evaluated(splines[0], float(at[0]), float(at[1])))
        return float(abs(places[0][2] - places[1][2]))

    def _all_runs(self, told_apart: bool) -> StepDrawing:
        sketch = StepDrawing()
        for run in self.surface.runs:
            flat, edges = seen(run.points), np.flatnonzero(np.diff(run.owner)) + 1
            for part in np.split(np.arange(len(run.owner)), edges):
                owner = int(run.owner[part[0]])
                line = flat[part[0] : part[-1] + 2]
                sketch.line(
                    line, self._colour(owner) if told_apart else INK, LINE, self._dash(owner) if told_apart else ()
                )
        return sketch

    def generated(self) -> FilmStep:
        """Return (g): plane after plane, the compound surface is made."""
        points = sum(len(run.points) for run in self.surface.runs)
        sketch = self._all_runs(False)
        sketch.dots(seen(self.surface.boundaries.place[self.between]), RED, 0.6)
        return FilmStep(
            "(g)",
            "The next plane",
            "i goes on by one, until the compound surface is there as points; it is stored and put out.",
            "`surface --points OUT.csv` writes it with surface numbers and boundary points.",
            sketch.page(),
            (
                FilmFigure("planes", len(self.surface.planes.offsets)),
                FilmFigure("points", points),
                FilmFigure("boundary points", len(self.between)),
            ),
        )

    def drawn(self) -> FilmStep:
        """Return (h): the path, each surface's part in its own line."""
        rows = [("surface", "colour", "line")]
        for number, surface in enumerate(self.computed.scene.surfaces):
            dash = next(kind for kind, pattern in _LINES.items() if pattern == self._dash(number))
            rows.append((surface.name, self._colour(number), dash.value))
        return FilmStep(
            "(h)",
            "Draw it, told apart",
            "The path follows the points in the order of generation, on the screen or on an XY plotter; between "
            "boundary points each surface's part has its own colour, or a solid, dotted or chain line.",
            "A ball's path is the same construction on the offset surfaces, so it gouges no neighbour.",
            self._all_runs(True).page(),
            (FilmFigure("surfaces told apart", len(rows) - 1),),
            tuple(rows),
        )

    def checked(self) -> FilmStep:
        """Return (i): look, correct, make NC data."""
        sketch = StepDrawing()
        blocks = 0
        for program in self.written.programs:
            for line in _cut_lines(program):
                sketch.line(seen(line), BLUE, FINE)
        for file in self.written.files:
            blocks += file.nc.text.count("\n")
        found = len(self.computed.findings)
        return FilmStep(
            "(i)",
            "Look, correct, make NC data",
            "The picture tells whether something has to be corrected; then the NC data are made.",
            "What is written is read back and proven to go nowhere deeper into a surface than 0.0001 mm.",
            sketch.page(),
            (
                FilmFigure("lines of NC text", blocks),
                FilmFigure("moves that are not proven", len(self.written.unproven)),
                FilmFigure("findings", found),
            ),
        )


def _cut_lines(program: NcProgram) -> list[Floats]:
    """Return the runs of a program's feed moves."""
    motions = anchored(program.motions)
    cut = motions.kind > 0
    edges = np.flatnonzero(np.diff(np.concatenate([[False], cut, [False]]).astype(np.int8))).reshape(-1, 2)
    lines = [np.vstack([motions.start[a : a + 1], motions.end[a:b]]) for a, b in edges.tolist()]
    return [line[np.isfinite(line).all(axis=1)] for line in lines]


def evaluated(surface: BsplineSurface, u: float, v: float) -> Floats:
    """Return the place of a rational B-spline surface at parameters from 0 to 1, by the basis functions' own sum."""
    from scipy.interpolate import BSpline

    parts = []
    for knots, degree, share in ((surface.knots_u, surface.degree_u, u), (surface.knots_v, surface.degree_v, v)):
        at = knots[degree] + share * (knots[-degree - 1] - knots[degree])
        parts.append(BSpline.design_matrix(np.array([at]), knots, degree).toarray()[0])
    weight = parts[0] @ surface.weights @ parts[1]
    place: Floats = np.einsum("i,j,ij,ijk->k", *parts, surface.weights, surface.points) / weight
    return place


def _net(surface: BsplineSurface) -> list[Floats]:
    """Return lines of equal parameters of a surface."""
    at = np.linspace(0.0, 1.0, _NET)
    fine = np.linspace(0.0, 1.0, 25)
    lines = [np.array([evaluated(surface, float(u), float(v)) for v in fine]) for u in at]
    return lines + [np.array([evaluated(surface, float(u), float(v)) for u in fine]) for v in at]
