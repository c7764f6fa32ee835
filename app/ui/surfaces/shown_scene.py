"""A computed scene as lines to be painted: in space, and on one cutting plane. No Qt."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from app.atomic import read_whole
from app.errors import InputError
from app.progress import NO_PROGRESS, Progress

if TYPE_CHECKING:
    from app.workflow.surface import Computed, Family

Floats = NDArray[np.float64]


class Role(Enum):
    """What a line stands for."""

    SURFACE = "surface"
    PATH = "path"
    RAPID = "rapid"
    TIP = "tip"


@dataclass(frozen=True, eq=False, slots=True)
class Line:
    """One line.

    Attributes:
        role: what it stands for. points: (n, 3) mm, n >= 2. surface: number of the surface that it is on, -1 = of none.
    """

    role: Role
    points: Floats
    surface: int = -1


@dataclass(frozen=True, eq=False, slots=True)
class Picture:
    """Lines and marks.

    Attributes:
        lines: to be painted in this order. marks: (m, 3) boundary points, mm. labels: (m,) their names.
    """

    lines: tuple[Line, ...]
    marks: Floats
    labels: tuple[str, ...]

    @property
    def box(self) -> tuple[Floats, Floats]:
        """Lowest and highest x, y, z of all lines, mm."""
        places = np.concatenate([line.points for line in self.lines])
        return places.min(axis=0), places.max(axis=0)


@dataclass(frozen=True, eq=False, slots=True)
class ShownScene:
    """A scene that was computed, ready to be shown.

    Attributes:
        path: of its file. computed: what was made of it. space: all of it.
        colours: "#rrggbb" of each surface, by number; behind them that of the floor.
    """

    path: Path
    computed: Computed
    space: Picture
    colours: tuple[str, ...]

    @property
    def planes(self) -> tuple[tuple[Family, int], ...]:
        """Family and number of every cutting plane, in the order of cutting."""
        return tuple((family, k) for family in self.computed.families for k in range(len(family.planes.offsets)))

    def section(self, family: Family, plane: int) -> Picture:
        """Return what lies on a plane: x is mm along it, z the height, y 0."""
        from app.workflow.surface_plot import boundary_name

        def flat(points: Floats) -> Floats:
            along = (points[:, :2] - family.planes.origin) @ np.array(family.planes.along)
            return np.column_stack([along, np.zeros(len(points)), points[:, 2]])

        curves = [Line(Role.SURFACE, flat(curve.points), curve.owner) for curve in family.surface.curves if curve.plane == plane]
        tops = [Line(Role.PATH, flat(points), owner) for run in family.surface.runs if run.plane == plane
                for owner, points in _by_owner(run.owner, run.points)]  # fmt: skip
        tips = [Line(Role.TIP, flat(run.points)) for run in family.path.runs if run.plane == plane]
        found = family.surface.boundaries
        rows = np.flatnonzero((found.plane == plane) & (found.before >= 0) & (found.after >= 0))
        labels = tuple(boundary_name(int(found.before[k]), int(found.after[k])) for k in rows)
        return Picture((*curves, *tops, *tips), flat(found.place[rows]), labels)


def is_scene(path: Path) -> bool:
    """Return whether a file is a scene, as its tables say: jobs and machines are TOML too."""
    if path.suffix.lower() != ".toml":
        return False
    try:
        return any(line.strip() in (b"[[surface]]", b"[[passes]]") for line in read_whole(path).splitlines())
    except OSError:
        return False


def shown_scene(path: Path, data: bytes, progress: Progress = NO_PROGRESS) -> ShownScene:
    """Compute a scene's text and prepare what is shown of it.

    Args:
        path: of its file; files that it names are beside it. data: the text, UTF-8.

    Raises:
        HitofudeError: it cannot be read or computed. Cancelled: the job was asked to stop.
    """
    from app.files.scene_toml import sources_of
    from app.files.surface_plot import colour_of
    from app.workflow.surface import read_and_compute
    from app.workflow.surface_plot import Drawn, PlotScene, by_surface

    progress.step(0.0, f"Computing {path.name}")
    computed = read_and_compute(path.name, data, sources_of(lambda name: read_file(path.parent / name)), progress.part(0.0, 0.95))
    drawn = by_surface(computed, PlotScene(drawn=Drawn.BOTH))
    lines = [Line(Role.SURFACE if piece.fine else Role.PATH, piece.points, piece.surface) for piece in drawn.pieces]
    colours = tuple(kind.colour or colour_of(number) for number, kind in enumerate(drawn.surfaces))
    return ShownScene(path, computed, Picture((*lines, *_rapids(computed)), np.asarray(drawn.marks), tuple(drawn.labels)), colours)


def read_file(path: Path) -> bytes:
    """Return the bytes of a file.

    Raises:
        InputError: it cannot be read.
    """
    try:
        return read_whole(path)
    except OSError as error:
        raise InputError(f"Cannot read {path}: {error.strerror}. Choose another file.") from error


def _rapids(computed: Computed) -> Iterator[Line]:
    """Yield moves that are on no surface; where the tool stands before the first one nobody knows."""
    moves = computed.moves.moves
    for k in np.flatnonzero(computed.moves.surface < 0).tolist():
        chord = np.stack([moves.start[k], moves.end[k]])
        if np.isfinite(chord).all():
            yield Line(Role.RAPID, chord)


def _by_owner(owner: NDArray[np.int64], points: Floats) -> Iterator[tuple[int, Floats]]:
    """Yield each stretch of a run that is on one surface."""
    starts = [0, *(np.flatnonzero(np.diff(owner)) + 1).tolist(), len(owner)]
    for first, last in pairwise(starts):
        yield int(owner[first]), points[first : last + 1]
