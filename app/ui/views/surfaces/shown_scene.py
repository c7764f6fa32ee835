"""A computed scene as what is painted: in space, and on one cutting plane. No Qt."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ....core.atomic import read_whole
from ....core.errors import Cancelled, HitofudeError, InputError
from ....core.progress import NO_PROGRESS, Progress
from ....usecases.scene.lines import LineRole, SceneLines, scene_lines

if TYPE_CHECKING:
    from ....model.scene import LineType, Scene
    from ....model.scene_curves import SceneFiles
    from ....usecases.scene.compute import ComputedFamily, ComputedScene

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class ScenePicture:
    """What is painted.

    Attributes:
        strands: lines, painted in this order. marks: (m, 3) boundary points, mm. labels: (m,) their names.
        triangles: (n, 3, 3) of surfaces, mm. owner: (n,) whose each is.
        lows: (k, 2) of a section the tip's places, mm along the plane and up, by the first. tool: (j, 2) outline of the
            tool that goes there, mm from its tip, from the axis outwards; none: no tool is shown.
        pitch: from pass to pass, about, mm; inf where there is only one.
    """

    strands: tuple[SceneLines, ...]
    marks: Floats
    labels: tuple[str, ...]
    triangles: Floats
    owner: Ints
    lows: Floats
    tool: Floats
    pitch: float = np.inf

    @cached_property
    def compound(self) -> bool:
        """Whether it is of several surfaces, which are told apart by colours; one alone is grey under its paths."""
        return len(self.owner) > 0 and bool(self.owner.min() < self.owner.max())

    @property
    def shows(self) -> bool:
        """Whether there is anything to see."""
        return bool(self.strands) or len(self.triangles) > 0

    @property
    def box(self) -> tuple[Floats, Floats]:
        """Lowest and highest x, y, z of what is seen but for moves in the air, mm."""
        places = (
            [each.points for each in self.strands if each.role not in (LineRole.RAPID, LineRole.PLUNGE)]
            or [each.points for each in self.strands]
            or ([] if len(self.triangles) else [np.zeros((1, 3))])
        )
        every = np.concatenate([*places, self.triangles.reshape(-1, 3)])
        return every.min(axis=0), every.max(axis=0)


@dataclass(frozen=True, eq=False, slots=True)
class ShownScene:
    """A scene that was computed, ready to be shown.

    Attributes:
        path: of its file. computed: what was made of it. space: all of it.
        colours: "#rrggbb" of each surface, by number; behind them that of the floor. lines: its line type, likewise.
    """

    path: Path
    computed: ComputedScene
    space: ScenePicture
    colours: tuple[str, ...]
    lines: tuple[LineType, ...]

    @property
    def planes(self) -> tuple[tuple[ComputedFamily, int], ...]:
        """Family and number of every cutting plane, in the order of cutting."""
        return tuple((family, k) for family in self.computed.families for k in range(len(family.planes.offsets)))

    def section(self, family: ComputedFamily, plane: int) -> ScenePicture:
        """Return what lies on a plane: x is mm along it, z the height, y 0."""
        from ....usecases.scene.picture import outline
        from ....usecases.scene.plot import boundary_name

        def flat(points: Floats) -> Floats:
            along = (points[:, :2] - family.planes.origin) @ np.array(family.planes.along)
            return np.column_stack([along, np.zeros(len(points)), points[:, 2]])

        shown = [surface.visible for surface in self.computed.scene.surfaces] + [True]
        curves = [
            scene_lines(LineRole.SURFACE, flat(curve.points), curve.owner)
            for curve in family.surface.curves
            if curve.plane == plane and shown[curve.owner]
        ]
        tops = [
            scene_lines(LineRole.PATH, flat(points), owner)
            for run in family.surface.runs
            if run.plane == plane
            for owner, points in _by_owner(run.owner, run.points)
        ]
        tips = [
            scene_lines(LineRole.TIP, flat(run.points), -1, family.tool.number)
            for run in family.path.runs
            if run.plane == plane
        ]
        found = family.surface.boundaries
        rows = np.flatnonzero((found.plane == plane) & (found.before >= 0) & (found.after >= 0))
        labels = tuple(boundary_name(int(found.before[k]), int(found.after[k])) for k in rows)
        lows = np.concatenate([each.points[:, ::2] for each in tips]) if tips else np.zeros((0, 2))
        return ScenePicture(
            (*curves, *tops, *tips),
            flat(found.place[rows]),
            labels,
            np.zeros((0, 3, 3)),
            np.zeros(0, np.int64),
            lows[np.argsort(lows[:, 0], kind="stable")],
            outline(family.tool),
        )


def is_scene(path: Path) -> bool:
    """Return whether a file is a scene, as its tables say: jobs and machines are TOML too."""
    if path.suffix.lower() != ".toml":
        return False
    try:
        return any(line.strip() in (b"[[surface]]", b"[[passes]]") for line in read_whole(path).splitlines())
    except OSError:
        return False


def shown_scene(path: Path, data: bytes, progress: Progress = NO_PROGRESS, passes: bool = True) -> ShownScene:
    """Compute a scene's text and prepare what is shown of it.

    Args:
        path: of its file; files that it names are beside it. data: the text, UTF-8.
        passes: False: the surfaces alone, which are soon there; those that cannot be made are left out, and are told of
            when the passes are computed.

    Raises:
        HitofudeError: it cannot be read or computed. Cancelled: the job was asked to stop.
    """
    from ....formats.plot.surface_plot import colour_of, line_of
    from ....formats.scene.toml import read_scene, sources_of
    from ....model.scene import LineType
    from ....usecases.scene.compute import compute
    from ....usecases.scene.picture import looked_at, move_lines
    from ....usecases.scene.plot import PlotScene, PlottedPart, by_surface

    progress.step(0.0, f"Computing {path.name}")
    scene = read_scene(path.name, data)
    sources = sources_of(lambda name: read_file(path.parent / name))
    if passes:
        computed = compute(scene, sources, progress.part(0.0, 0.9))
    else:
        computed = _surfaces_of(replace(scene, passes=()), sources, progress.part(0.0, 0.9))
    progress.step(0.9, "Preparing the picture")
    drawn = by_surface(computed, PlotScene(drawn=PlottedPart.SURFACE))
    colours = tuple(kind.colour or colour_of(number) for number, kind in enumerate(drawn.surfaces))
    lines = tuple(
        line_of(number) if kind.line is LineType.AUTO else kind.line for number, kind in enumerate(drawn.surfaces)
    )
    space = ScenePicture(
        tuple(move_lines(computed)),
        np.asarray(drawn.marks),
        tuple(drawn.labels),
        *looked_at(computed),
        np.zeros((0, 2)),
        np.zeros((0, 2)),
        _pitch(computed),
    )
    return ShownScene(path, computed, space, colours, lines)


def _surfaces_of(scene: Scene, sources: SceneFiles, progress: Progress) -> ComputedScene:
    """Return a scene without passes; surfaces that cannot be made are left out where others can.

    Raises:
        HitofudeError: none can be made. Cancelled: the job was asked to stop.
    """
    from ....surfaces.patches.build import build_surface
    from ....usecases.scene.compute import compute

    try:
        return compute(scene, sources, progress.part(0.0, 0.5))
    except Cancelled:
        raise
    except HitofudeError:
        made = []
        for surface in scene.surfaces:
            with suppress(HitofudeError):
                build_surface(surface, sources)
                made.append(surface)
        if not made or len(made) == len(scene.surfaces):
            raise
    return compute(replace(scene, surfaces=tuple(made)), sources, progress.part(0.5, 1.0))


def read_file(path: Path) -> bytes:
    """Return the bytes of a file.

    Raises:
        InputError: it cannot be read.
    """
    try:
        return read_whole(path)
    except OSError as error:
        raise InputError(f"Cannot read {path}: {error.strerror}. Choose another file.") from error


def _pitch(computed: ComputedScene) -> float:
    """Return how far apart the passes are that are nearest together, in the middle of their family, mm."""
    apart = [
        float(np.median(np.abs(np.diff(family.planes.offsets))))
        for family in computed.families
        if len(family.planes.offsets) > 1
    ]
    return min(apart, default=np.inf)


def _by_owner(owner: NDArray[np.int64], points: Floats) -> Iterator[tuple[int, Floats]]:
    """Yield each stretch of a run that is on one surface."""
    starts = [0, *(np.flatnonzero(np.diff(owner)) + 1).tolist(), len(owner)]
    for first, last in pairwise(starts):
        yield int(owner[first]), points[first : last + 1]
