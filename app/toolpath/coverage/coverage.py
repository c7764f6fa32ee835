"""What is left on the floor: measured from the moves themselves, not from what made them.

Three areas are told apart on every floor: cleared; left although a tool of the job could cut it
(must be 0); out of reach of every tool of the job (`floor_target.py`). Of paths made from pixels, the skin that they
leave along the walls so as to be nowhere too near is a fourth: what no tool reaches that keeps their allowance from the
walls, next to floor that is cleared; a passage with no path in it is no skin. The swept area is the union of all
cutting moves at full depth, each as wide as its tool. Method: polygons (shapely), arcs as chords within CHORD, wherever
exact distances do not prove the floor cleared; strips thinner than STRIP are numeric and not counted.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import islice, pairwise

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import Geometry as Shape

from ...core.pool import pool
from ...core.progress import NO_PROGRESS, Progress
from ...geometry.near_points import near
from ...geometry.primitives import CX, TURN, R, Rows
from ...model.finding import Finding, FindingKind
from ...model.job import Job
from ...model.moves import MoveKind, Moves, Program
from .areas import Fields, common, flattened, grown, lines, move_rows, opened, reached, united, without
from .floor_target import CHORD, FloorTarget, floor_targets
from .proven import SingleFloor, one_floor, settled, uncertain

STRIP = 0.01
"""mm; what is narrower than this is no material but the chords' own error."""

_THICK = 1.5
"""Allowances; metal in which a disc of this radius fits is no skin, not even in a corner."""

_TIP = 4.0
"""Allowances by which the skin in the tip of a sharp corner may reach beyond the floor that is cleared."""

_DEPTH = 1e-6
"""mm by which a computed move may miss the floor and still count as on it."""


_BACK = -0.9
"""Cosine of a turn; a sharper one counts as going back."""

_MANY = 4
"""Contours from which it is worth while to ask first what clear moves cover."""

_ASKED = 16
"""Points on the rim of a piece towards which it is asked whether a cutter's centre can be near."""

_TEXT = "Measuring what is left"

_TILES = 256
"""Boxes that are held against moves in one go."""

_TOGETHER = 16
"""Parts of so many boxes that are given to the cores at once."""

_RUN = 64
"""Moves that are widened in one go; longer runs cross themselves too often for the library."""


@dataclass(frozen=True)
class UncutPlace:
    """One connected piece of floor that is left.

    Attributes:
        x, y: centre of the largest disc in it, mm.
        area_mm2: its area.
        disc_mm: diameter of the largest disc that fits into it, mm.
        reachable: True when some tool of the job could cut it.
        outline: (n, 2) its outer boundary, mm.
        holes: (m, 2) each, what lies within the boundary and is not left, mm.
    """

    x: float
    y: float
    area_mm2: float
    disc_mm: float
    reachable: bool
    outline: NDArray[np.float64] = field(repr=False)
    holes: tuple[NDArray[np.float64], ...] = field(default=(), repr=False)


@dataclass(frozen=True)
class Coverage:
    """What is left on the floor.

    Attributes:
        reachable_left_mm2: left although some tool of the job could cut it; 0 when all is well.
        unreachable_mm2: out of reach of every tool of the job.
        largest_disc_mm: diameter of the largest disc that would fit where no tool reaches, mm; 0 = nowhere.
        places: every piece, the largest disc first.
        area_mm2: all floors.
        floor_mm: depth of the deepest floor, mm.
        targets: what was to be cleared, floor by floor.
        given_up: the skin that paths made from pixels left along the walls on purpose, the largest disc first; not
            among the places.
        given_up_mm: how thick it may be, mm; 0 for exact paths.
        on_pixels: the paths were made from pixels.
    """

    reachable_left_mm2: float = 0.0
    unreachable_mm2: float = 0.0
    largest_disc_mm: float = 0.0
    places: tuple[UncutPlace, ...] = ()
    area_mm2: float = 0.0
    floor_mm: float = 0.0
    given_up: tuple[UncutPlace, ...] = ()
    given_up_mm: float = 0.0
    targets: tuple[FloorTarget, ...] = field(default=(), repr=False)
    on_pixels: bool = False

    @property
    def given_up_mm2(self) -> float:
        """Area of what was given up at the walls."""
        return sum(place.area_mm2 for place in self.given_up)


def measure_beside_clear(
    program: Program, job: Job, clear: NDArray[np.bool_], progress: Progress = NO_PROGRESS
) -> Coverage:
    """Measure what the moves of a program leave on the floor, with polygons only round what clear moves do not cover.

    Args:
        program, job, progress: as of `measure`.
        clear: (n,) which moves are proven to keep off the walls of their operation's area.

    Raises:
        Cancelled: the job was asked to stop.
    """
    known = _settled(program, job, clear, _DEPTH, progress.part(0.0, 0.4))
    if known is None:
        return measure(program, job, progress)
    rest = measure(program, job, progress.part(0.4, 1.0), found=() if known.open is None else (known.open,))
    return replace(rest, area_mm2=float(known.all.floor.area), floor_mm=known.all.depth, targets=(known.all,))


def measure(
    program: Program,
    job: Job,
    progress: Progress = NO_PROGRESS,
    miss: float = _DEPTH,
    found: tuple[FloorTarget, ...] | None = None,
) -> Coverage:
    """Measure what the moves of a program leave on the floor.

    Args:
        program: moves and the regions they machine.
        job: tools and operations that the moves belong to.
        progress: looked at before every few boxes and every piece.
        miss: by which a move may miss the floor and still counts as on it, mm; more than nothing for moves that were
            read back.
        found: what is to be cleared, where the caller knows it.

    Raises:
        Cancelled: the job was asked to stop.
    """
    progress.step(0.0, _TEXT)
    found = floor_targets(program, job) if found is None else found
    inner = floor_targets(program, job, program.allowance_mm) if program.allowance_mm else found
    fields = Fields()
    left: list[UncutPlace] = []
    corners: list[UncutPlace] = []
    skins: list[UncutPlace] = []
    for k, (each, deeper) in enumerate(zip(found, inner, strict=True)):
        share = progress.part(k / len(found), (k + 1) / len(found))
        target = each.target if each.out_of_reach is None else without(each.target, each.out_of_reach)
        metal = _left(target, _paths(program.moves, job, each.depth - miss), share.part(0.0, 0.6))
        if program.allowance_mm:
            skin = _skin(metal, each, deeper.reach, program.allowance_mm)
            metal = _solid(without(metal, skin))
            skins += _places(skin, reachable=True, progress=share.part(0.6, 0.75))
        places = _places(metal, reachable=True, progress=share.part(0.75, 0.9))
        for place, within in zip(places, pool().map(partial(_is_reached, each, fields), places), strict=True):
            share.step(0.9, _TEXT)
            (left if within else corners).append(place if within else replace(place, reachable=False))
        corners += _places(_solid(each.beyond), reachable=False, progress=share.part(0.9, 1.0))
    for some in (left, corners, skins):
        some.sort(key=lambda place: -place.disc_mm)
    return Coverage(
        reachable_left_mm2=sum(place.area_mm2 for place in left),
        unreachable_mm2=sum(place.area_mm2 for place in corners),
        largest_disc_mm=max((place.disc_mm for place in corners), default=0.0),
        places=(*left, *corners),
        area_mm2=sum(float(each.floor.area) for each in found),
        floor_mm=max((each.depth for each in found), default=0.0),
        given_up=tuple(skins),
        given_up_mm=program.allowance_mm,
        targets=found,
        on_pixels=program.given_up_mm is not None,
    )


def _is_reached(target: FloorTarget, fields: Fields, place: UncutPlace) -> bool:
    """Return whether a piece of metal is within reach of some cutter."""
    return not target.cutters or reached(_inner(place), target.cutters, fields, place.disc_mm)


def _skin(left: Shape, areas: FloorTarget, inner: Shape, off: float) -> Shape:
    """Return what of the metal left is but a skin along walls that paths follow.

    Args:
        inner: what some tool reaches that keeps `off` mm farther from the walls than asked.
    """
    beyond = _solid(without(left, inner))
    thick = united(shapely.buffer(shapely.buffer(shapely.get_parts(left), -_THICK * off), (_THICK + 1) * off))
    cleared = united(shapely.buffer(shapely.get_parts(without(areas.reach, left)), _TIP * off))
    return _solid(common(without(beyond, thick), cleared))


def _settled(
    program: Program, job: Job, clear: NDArray[np.bool_], miss: float, progress: Progress
) -> SingleFloor | None:
    """Return the floor of a job that has but one, with what of it told apart that moves which keep off the walls do not
    cover.
    """
    area = one_floor(program, job)
    if area is None or sum(len(region.contours) for region in area.regions) < _MANY:
        return None
    depth = max(each.cut.floor for each in job.operations if each.cut.enabled)
    paths = _paths(program.moves, job, depth - miss, clear)
    return settled(program, job, [(path.rows, path.radius) for path in paths], progress)


def _paths(moves: Moves, job: Job, depth: float, of: NDArray[np.bool_] | None = None) -> list[_CuttingPath]:
    """Return the path of each tool's moves, or of some of them (n,), that cut as deep as so many mm, or deeper."""
    deep = np.maximum(moves.start[:, 2], moves.end[:, 2]) <= -depth
    pointed = [tool.number for tool in job.tools if tool.kind.drills or tool.kind.threads]  # no level floor
    pointed += [each.cut.tool for each in job.operations if each.CARVES]
    chosen = deep & (moves.kind != MoveKind.RAPID) & ~np.isin(moves.tool, pointed) & (True if of is None else of)
    numbers = [int(number) for number in np.unique(moves.tool[chosen])]
    return [
        _CuttingPath.of(np.flatnonzero(chosen & (moves.tool == number)), moves, job.tool(number).radius)
        for number in numbers
    ]


def _left(target: Shape, paths: list[_CuttingPath], progress: Progress) -> Shape:
    """Return what of a wanted area is not cut by paths as deep as its floor, or deeper."""
    tiles = uncertain(target, [(path.rows, path.radius) for path in paths], progress.part(0.0, 0.5))
    left, done = list[Shape](), 0
    parts = _UndecidedBoxes(target, tiles, shapely.bounds(tiles), paths).parts()
    while some := list(islice(parts, _TOGETHER)):  # a few on all cores, so that it can be stopped between them
        progress.step(0.5 + done / max(len(tiles), 1) / 2, _TEXT)  # no box is in doubt where no move cuts
        left += pool().map(_UndecidedBoxes.left, some)
        done += sum(len(part.tiles) for part in some)
    return _solid(united(left))


@dataclass(frozen=True, eq=False)
class _CuttingPath:
    """Cutting moves of one tool.

    Attributes:
        chosen: (n,) their indices. rows: (n, 8) of their centre. boxes: (n, 4) that hold these.
        radius: of the tool, mm.
    """

    chosen: NDArray[np.int64]
    rows: Rows
    boxes: NDArray[np.float64]
    radius: float

    @staticmethod
    def of(chosen: NDArray[np.int64], moves: Moves, radius: float) -> _CuttingPath:
        """Return the path of some moves."""
        rows = move_rows(moves, chosen)
        arc = (rows[:, TURN] != 0)[:, None]
        size = rows[:, R, None]
        low = np.where(arc, rows[:, CX:R] - size, np.minimum(rows[:, :2], rows[:, 2:4]))
        high = np.where(arc, rows[:, CX:R] + size, np.maximum(rows[:, :2], rows[:, 2:4]))
        return _CuttingPath(chosen, rows, np.hstack([low, high]), radius)

    def near(self, box: NDArray[np.float64]) -> _CuttingPath:
        """Return the moves that may cut in a box (4,)."""
        reach = self.radius + STRIP
        some = np.all((self.boxes[:, :2] <= box[2:] + reach) & (self.boxes[:, 2:] >= box[:2] - reach), axis=1)
        return _CuttingPath(self.chosen[some], self.rows[some], self.boxes[some], self.radius)

    def swept_near(self, tree: shapely.STRtree) -> Shape:
        """Return the area that is covered by those moves that come near some boxes."""
        rough = self.radius / 20  # who is near is asked with few chords, and with as much more reach
        moves = np.unique(near(tree, lines(self.rows, rough), self.radius + rough + STRIP)[0])
        runs = _runs(self.rows[moves], self.chosen[moves])
        parts = [part for points in runs for part in _between_reversals(points)]
        return united([shape for points in parts for shape in _widened(points, self.radius)])


@dataclass(frozen=True, eq=False)
class _UndecidedBoxes:
    """Boxes of a wanted area that may not be cut all over.

    It is decided in parts of a few boxes, with what is near them: the library takes more than twice the time for twice
    as much.

    Attributes:
        target: what of the area is near the boxes.
        tiles: (n,) boxes that do not overlap. boxes: (n, 4) the same.
        paths: moves that are near.
    """

    target: Shape
    tiles: NDArray[np.object_]
    boxes: NDArray[np.float64]
    paths: list[_CuttingPath]

    def parts(self) -> Iterator[_UndecidedBoxes]:
        """Yield it in parts of few boxes each."""
        if len(self.tiles) <= _TILES:
            yield self
            return
        wide = self.boxes[:, 2:].max(axis=0) - self.boxes[:, :2].min(axis=0)
        axis = int(wide[1] > wide[0])
        order = np.argsort(self.boxes[:, axis] + self.boxes[:, axis + 2], kind="stable")
        for half in (order[: len(order) // 2], order[len(order) // 2 :]):
            box = np.concatenate([self.boxes[half, :2].min(axis=0), self.boxes[half, 2:].max(axis=0)])
            target = common(self.target, shapely.box(*box))
            yield from _UndecidedBoxes(
                target, self.tiles[half], self.boxes[half], [path.near(box) for path in self.paths]
            ).parts()

    def left(self) -> Shape:
        """Return what of the wanted area no move has cut in the boxes."""
        left = common(self.target, shapely.union_all(self.tiles))
        tree = shapely.STRtree(self.tiles)
        for path in self.paths:
            left = without(left, path.swept_near(tree))
        return left


def _between_reversals(points: NDArray[np.float64]) -> list[NDArray[np.float64]]:
    """Return the parts of a path between places where it goes back the way it came: there the library rounds off no
    end.
    """
    moved = np.any(np.diff(points, axis=0) != 0, axis=1)
    if not moved.any():
        return [points]
    points = points[np.concatenate([[True], moved])]
    way = np.diff(points, axis=0)
    size = np.hypot(way[:, 0], way[:, 1])
    back = np.einsum("ij,ij->i", way[1:], way[:-1]) < _BACK * size[1:] * size[:-1]
    cuts = [0, *(np.flatnonzero(back) + 1).tolist(), len(points) - 1]
    return [points[a : b + 1] for a, b in pairwise(cuts)]


def _widened(points: NDArray[np.float64], radius: float) -> list[Shape]:
    """Return what a cutter covers along a path, in one or more shapes.

    The library can lose holes of a path that crosses itself; then the area is more than length times width, and the
    path is widened in halves.
    """
    shape = grown(shapely.linestrings(points), radius, CHORD)
    length = float(np.hypot(*np.diff(points, axis=0).T).sum())
    if shape.area <= (2 * radius * length + np.pi * radius**2) * (1 + 1e-9) or len(points) < 3:
        return [shape]
    middle = len(points) // 2
    return _widened(points[: middle + 1], radius) + _widened(points[middle:], radius)


def _runs(rows: Rows, chosen: NDArray[np.int64]) -> list[NDArray[np.float64]]:
    """Return the points of each run of moves that follow one another, but not too many in one."""
    if not len(chosen):
        return []
    owner, points = flattened(rows, CHORD)
    place = np.arange(len(chosen))
    run = np.cumsum(np.concatenate([[False], np.diff(chosen) != 1]) | (place % _RUN == 0))[owner]
    return np.split(points, np.flatnonzero(np.diff(run)) + 1)


def _solid(shape: Shape) -> Shape:
    """Return the shape without strips thinner than STRIP (an opening)."""
    return united(opened(shapely.get_parts(shape), STRIP / 2))


def _places(shape: Shape, reachable: bool, progress: Progress) -> tuple[UncutPlace, ...]:
    """Return the pieces of a shape, the largest disc first."""
    places = []
    pieces = [piece for piece in shapely.get_parts(shape) if piece.geom_type == "Polygon" and piece.area >= STRIP**2]
    for k, (piece, circle) in enumerate(zip(pieces, pool().map(_largest_circle, pieces), strict=True)):
        progress.step(k / len(pieces), _TEXT)
        centre, rim = (np.array(point) for point in circle.coords)
        disc = 2 * float(np.hypot(*(rim - centre)))
        outline, *holes = (shapely.get_coordinates(ring)[:-1] for ring in shapely.get_rings(piece))
        places.append(
            UncutPlace(float(centre[0]), float(centre[1]), piece.area, disc, reachable, outline, tuple(holes))
        )
    return tuple(sorted(places, key=lambda place: -place.disc_mm))


def _largest_circle(piece: Shape) -> Shape:
    """Return the line from the middle of the largest circle in a piece to its rim."""
    return shapely.maximum_inscribed_circle(piece, tolerance=CHORD)


def _inner(place: UncutPlace) -> NDArray[np.float64]:
    """Return points (n, 2) all over a piece, the middle of its largest disc first."""
    middle = np.array([[place.x, place.y]])
    rim = place.outline[np.unique(np.linspace(0, len(place.outline) - 1, _ASKED).astype(int))]
    points = np.concatenate([middle, *(middle + part * (rim - middle) for part in (0.45, 0.9))])
    shape = shapely.Polygon(place.outline, place.holes)
    inside: NDArray[np.float64] = points[np.asarray(shapely.intersects(shape, shapely.points(points)))]
    return inside


def coverage_findings(coverage: Coverage) -> tuple[Finding, ...]:
    """Return what there is to say: material left within reach counts, corners out of reach are a remark."""
    findings = []
    for reachable, area in ((True, coverage.reachable_left_mm2), (False, coverage.unreachable_mm2)):
        places = [place for place in coverage.places if place.reachable is reachable]
        if not places:
            continue
        worst, count = places[0], len(places)
        spots = "1 place" if count == 1 else f"{count} places"
        if reachable:
            pixels = coverage.on_pixels or coverage.given_up_mm
            remedy = (
                "use a smaller pocket tool or a larger bitmap"
                if pixels
                else "add rest machining, or use a smaller tool"
            )
            text = (
                f"{area:.3f} mm2 of material within reach is left in {spots}, the worst {worst.disc_mm:.3f} mm wide "
                f"at ({worst.x:.3f}, {worst.y:.3f}); {remedy}."
            )
        else:
            text = (
                f"{area:.3f} mm2 in {spots} is out of reach of every tool; a disc of {worst.disc_mm:.3f} mm "
                f"would fit at ({worst.x:.3f}, {worst.y:.3f}); a smaller contour tool reaches farther."
            )
        kind = FindingKind.LEFT_REACHABLE if reachable else FindingKind.LEFT_UNREACHABLE
        findings.append(Finding(kind, text, worst.x, worst.y, counts=reachable, amount=area))
    return (*findings, *skin_findings(coverage))


def skin_findings(coverage: Coverage) -> tuple[Finding, ...]:
    """Return the remark on the skin that paths made from pixels leave along the walls."""
    if not coverage.given_up:
        return ()
    worst, area = coverage.given_up[0], coverage.given_up_mm2
    text = (
        f"{area:.3f} mm2 of material is left along the walls, a skin up to about {coverage.given_up_mm:.3f} mm thick "
        f"that paths made from pixels leave so as not to cut into them; a disc of {worst.disc_mm:.3f} mm would fit at "
        f"({worst.x:.3f}, {worst.y:.3f}); a larger bitmap leaves less."
    )
    return (Finding(FindingKind.SKIN, text, worst.x, worst.y, counts=False, amount=area),)
