"""Paths of cutters over surfaces against closed forms: never too deep anywhere along a chord, never needlessly high."""

import io
import math
from pathlib import Path

import numpy as np
import pytest
import shapely
import trimesh

from app.core.progress import Progress
from app.model.scene_curves import SectionCurve
from app.model.scene_shapes import SweptShape, TorusShape
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.surfaces.cutter_contact.drop_cutter import drop
from app.surfaces.passes import thin_kernels
from app.surfaces.passes.path import ALLOWED, Follower, FollowOptions, cutter_path
from app.surfaces.passes.point_kernels import BOUNDARY, NEW, X, Y, Z
from app.surfaces.passes.simplification import PathSimplification, simplified
from app.surfaces.patches.facets import SurfaceFacets
from app.surfaces.sections.compound import BoundaryKind, CompoundSurface, CuttingPlanes
from app.surfaces.sections.planes import even_planes
from tests.surfaces.scenes import along_x, ball, facets_of, plane
from tests.surfaces.solids import bossed_block

TORUS = Path(__file__).parents[1] / "data" / "meshes" / "torus.stl"
BALL = Tool(1, 4.0, ToolKind.BALL)
GOUGE = 1e-4


def chords(compound: CompoundSurface) -> np.ndarray:
    return np.concatenate([np.concatenate([run.points[:-1], run.points[1:]], axis=1) for run in compound.runs])


def nearest(ways: np.ndarray, centre: tuple[float, float, float]) -> np.ndarray:
    """Return how near segments (m, 6) come to a place."""
    start, way = ways[:, :3] - centre, ways[:, 3:] - ways[:, :3]
    share = np.clip(-np.sum(start * way, axis=1) / np.sum(way * way, axis=1), 0, 1)
    return np.linalg.norm(start + share[:, None] * way, axis=1)


def centres(ways: np.ndarray, radius: float) -> np.ndarray:
    """Return the ways of a ball's centre."""
    return ways + np.array([0, 0, radius, 0, 0, radius])


def farthest(ways: np.ndarray, true: shapely.LineString) -> float:
    """Return how far ways (m, 4) in a plane get from the true path, but for those that stand upright."""
    flat = ways[np.abs(ways[:, 2] - ways[:, 0]) > 1e-3]
    places = np.concatenate([flat[:, :2] + share * (flat[:, 2:] - flat[:, :2]) for share in np.linspace(0, 1, 9)])
    shapely.prepare(true)
    return float(shapely.distance(true, shapely.points(places)).max())


SPHERES = ((15.0, 0.0, 1.0, 6.0), (24.0, 2.0, -3.0, 9.0))


def spheres() -> SurfaceFacets:
    return facets_of(plane(0, -10, 60, 10), *(ball(*each) for each in SPHERES))


def ball_height(x: np.ndarray, y: float, radius: float, leave: float = 0.0) -> np.ndarray:
    """Return the tip's height over the spheres and the plane."""
    heights = [np.full_like(x, leave)]
    for cx, cy, cz, r in SPHERES:
        square = (r + radius + leave) ** 2 - (x - cx) ** 2 - (y - cy) ** 2
        heights.append(np.where(square > 0, cz - radius + np.sqrt(np.maximum(square, 0)), -np.inf))
    return np.maximum.reduce(heights)


@pytest.mark.parametrize(("leave", "tolerance", "grid"), [(0.0, 0.01, 0.0), (0.3, 0.002, 0.0), (0.0, 0.05, 1e-3)])
def test_a_ball_over_spheres_goes_in_nowhere_and_is_not_needlessly_high(
    leave: float, tolerance: float, grid: float
) -> None:
    follower = Follower(spheres(), BALL, FollowOptions(leave, tolerance, grid))
    path = cutter_path(follower, along_x(-4.0, 0.0, 1.7, 7.0))
    ways = chords(path)
    for *centre, radius in SPHERES:
        off = nearest(centres(ways, BALL.radius), (centre[0], centre[1], centre[2])) - radius - BALL.radius - leave
        assert off.min() >= -GOUGE
    assert ways[:, [2, 5]].min() >= leave - GOUGE
    for y in path.planes.offsets:
        mine = ways[np.abs(ways[:, 1] - y) < 1e-3]
        for share in (0.0, 0.3, 0.5):
            at = mine[:, :3] + share * (mine[:, 3:] - mine[:, :3])
            high = at[:, 2] - ball_height(at[:, 0], y, BALL.radius, leave)
            slope = np.abs(mine[:, 5] - mine[:, 2]) / np.maximum(np.abs(mine[:, 3] - mine[:, 0]), 1e-12)
            assert (high - (1 + slope) * grid)[slope < 20].max() <= tolerance * np.sqrt(1 + slope.max() ** 2) + 1e-6
        x = np.linspace(-4, 63, 20_001)
        true = shapely.LineString(np.column_stack([x, ball_height(x, y, BALL.radius, leave)]))
        assert farthest(mine[:, [0, 2, 3, 5]], true) <= tolerance + grid + GOUGE
    if grid:
        assert np.abs(ways / grid - np.round(ways / grid)).max() < 1e-6


def test_boundary_points_touch_both() -> None:
    path = cutter_path(Follower(spheres(), BALL), along_x(-4.0, 0.0, 1.7))
    marks = path.boundaries
    assert set(marks.kind.tolist()) == {int(BoundaryKind.CROSSING)}
    bodies = dict(enumerate(SPHERES, 1))
    for n in range(len(marks)):
        x, y, z = marks.place[n].tolist()
        for number in (int(marks.before[n]), int(marks.after[n])):
            cx, cy, cz, r = bodies.get(number, (x, y, -1e9, 0.0))
            gap = z if number == 0 else math.dist((x, y, z + BALL.radius), (cx, cy, cz)) - r - BALL.radius
            assert abs(gap) <= 1e-8
    assert len(marks) == 9  # plane, first, second, plane on each: at each of three planes


@pytest.mark.parametrize(
    "tool", [Tool(1, 4.0), Tool(1, 4.0, ToolKind.BULL, corner_radius=0.5), BALL], ids=["flat", "bull", "ball"]
)
def test_points_over_a_sphere_in_closed_form(tool: Tool) -> None:
    corner = {ToolKind.FLAT: 0.0, ToolKind.BULL: 0.5, ToolKind.BALL: 2.0}[tool.kind]
    follower = Follower(facets_of(ball(0, 0, 0, 10)), tool, FollowOptions(0.0, 0.02))
    (followed,) = [rows[:, X : Z + 1] for rows in (follower.along(along_x(3.0), 0, (-9.0, 9.0)),)]
    points = np.concatenate([run.points for run in cutter_path(follower, along_x(3.0)).runs])

    def true(at: np.ndarray) -> np.ndarray:
        out = np.maximum(np.hypot(at[:, 0], at[:, 1]) - (tool.radius - corner), 0.0)
        return np.sqrt(np.maximum((10 + corner) ** 2 - out**2, 0)) - corner

    inside = np.hypot(followed[:, 0], followed[:, 1]) < 9.4
    assert followed[inside, 2] == pytest.approx(true(followed)[inside], abs=1e-6)
    near = points[np.hypot(points[:, 0], points[:, 1]) < 8]
    # no chord that is kept is lower than the way that was followed, which goes under it by less than GOUGE
    for share in (
        0.0,
        0.25,
        0.5,
    ):
        at = near[:-1] + share * np.diff(near, axis=0)
        assert (at[:, 2] - true(at)).min() >= -2e-4
    assert len(points) < len(followed) / 8


def torus_height(x: np.ndarray, y: np.ndarray, radius: float) -> np.ndarray:
    square = (0.5 + radius) ** 2 - (np.hypot(x, y) - 1.0) ** 2
    return np.where(square > 0, np.sqrt(np.maximum(square, 0)) - radius, -np.inf)


def test_a_ball_over_a_torus_goes_along_the_offset_torus() -> None:
    tool = Tool(1, 0.5, ToolKind.BALL)
    facets = facets_of(TorusShape((0.0, 0.0, 0.0), 1.0, 0.5))
    path = cutter_path(Follower(facets, tool, FollowOptions(0.0, 0.005)), along_x(*np.linspace(-1.6, 1.6, 17).tolist()))
    points = np.concatenate([run.points for run in path.runs])
    high = points[:, 2] - torus_height(points[:, 0], points[:, 1], 0.25)
    well = np.abs(np.hypot(points[:, 0], points[:, 1]) - 1.0) < 0.6  # as steep as 4 in 3
    assert high[well].min() >= -1e-6 and high[well].max() <= 0.005 * 5 / 3


def test_a_ball_over_the_triangles_of_a_torus_is_as_near_as_they_are() -> None:
    mesh = trimesh.load_mesh(io.BytesIO(TORUS.read_bytes()), file_type="stl")
    facets, tool = SurfaceFacets.of_mesh(np.array(mesh.triangles)), Tool(1, 0.5, ToolKind.BALL)
    x, y = (grid.ravel() for grid in np.meshgrid(np.linspace(-1.4, 1.4, 60), np.linspace(-1.4, 1.4, 60)))
    true, well = torus_height(x, y, 0.25), np.abs(np.hypot(x, y) - 1.0) < 0.6
    found = drop(facets, tool, np.column_stack([x, y])).height
    assert np.abs(found - true)[well].max() <= 3e-3  # its corners lie on the torus, its faces do not


def test_a_way_that_was_lowered_is_not_proven() -> None:
    follower = Follower(spheres(), BALL, FollowOptions(0.0, 0.01))
    ways = chords(cutter_path(follower, along_x(0.0)))
    assert follower.proven(ways).all()
    deep = 0.001
    down = ways - np.array([0, 0, deep, 0, 0, deep])
    assert not follower.proven(down)[ways[:, [2, 5]].max(axis=1) < 5].any()
    assert follower.proven(ways + np.array([0, 0, deep, 0, 0, deep])).all()
    across = np.array([[5.0, 0.0, 0.0, 40.0, 0.0, 0.0]])
    assert not follower.proven(across).any() and follower.proven(across + np.array([0, 0, 9, 0, 0, 9])).all()


def test_paths_stay_where_they_may_be_and_say_where_there_is_nothing() -> None:
    area = shapely.union(shapely.box(2, -20, 10, 20), shapely.box(30, -20, 41.5, 20))
    path = cutter_path(Follower(spheres(), BALL), along_x(0.0, 4.0), area)
    ends = sorted((run.plane, run.points[0, 0], run.points[-1, 0]) for run in path.runs)
    assert [number for number, *_ in ends] == [0, 0, 1, 1]
    assert np.array(ends)[:, 1:] == pytest.approx(np.array([[2, 10], [30, 41.5]] * 2), abs=1e-9)


def test_where_surfaces_end_the_cutter_rolls_over_the_edge_and_jumps_down() -> None:
    facets = facets_of(plane(0, -5, 10, 5, z=6), plane(0, -5, 30, 5))
    path = cutter_path(Follower(facets, BALL), along_x(0.0))
    points = np.concatenate([run.points for run in path.runs])
    rolling = points[(points[:, 0] > 10) & (points[:, 0] < 11.9)]
    off = np.hypot(rolling[:, 0] - 10, rolling[:, 2] + BALL.radius - 6) - BALL.radius
    assert off.min() >= -1e-6 and off.max() <= FollowOptions().tolerance
    assert path.boundaries.kind.tolist() == [BoundaryKind.JUMP]
    assert path.boundaries.place[0, 0] == pytest.approx(12.0, abs=1e-3)
    ways = chords(path)
    low = np.minimum(ways[:, 2], ways[:, 5])
    assert (low[np.minimum(ways[:, 0], ways[:, 3]) < 11.9] > 3.9).all()


def test_where_surfaces_coincide_the_path_stays_on_the_one_it_came_on() -> None:
    path = cutter_path(Follower(facets_of(plane(0, 0, 10, 10), plane(5, 0, 15, 10)), BALL), along_x(5.0))
    (run,) = path.runs
    changes = np.flatnonzero(np.diff(run.owner))
    assert len(changes) == 1 and run.points[changes[0] + 1, 0] == pytest.approx(10.0, abs=0.01)


@pytest.mark.parametrize(
    "tool",
    [Tool(1, 6.0), Tool(1, 6.0, ToolKind.BULL, corner_radius=0.5), Tool(1, 6.0, ToolKind.BALL)],
    ids=["flat", "bull", "ball"],
)
def test_a_spike_beside_a_way_is_met_wherever_it_stands_along_it(tool: Tool) -> None:
    """The cutter's side goes into it by less than a chord of the places that are looked at is off its rim."""
    ways = np.array([[float(k), 0.0, 0.0, k + 1.0, 0.0, 0.0] for k in range(8)])
    for x in np.linspace(0.3, 7.7, 41).tolist():
        for beside, clear in ((2.997, False), (3.001, True)):
            spike = np.array([[[x, beside, 4.0], [x + 1e-4, beside + 1.0, 4.0], [x - 1e-4, beside + 1.0, 4.0]]])
            for chord in (ways, np.array([[0.0, 0.0, 0.0, 8.0, 0.0, 0.0]])):
                assert Follower(SurfaceFacets.of_mesh(spike), tool).proven(chord).all() == clear


def test_planes_that_meet_nothing_have_no_runs() -> None:
    path = cutter_path(Follower(facets_of(ball(0, 0, 0, 5)), BALL), along_x(-30.0, 0.0, 30.0))
    assert [run.plane for run in path.runs] == [1]


def test_a_flat_over_a_smooth_sheet_needs_few_points_and_its_way_is_proven() -> None:
    """Its rim leaves the middle between two places that it touches by a hair."""
    profile, guide = (
        ((0.0, 0.0, 0.0), (0.0, 10.0, 5.5), (0.0, 20.0, 0.0)),
        ((0.0, 5.0, 0.0), (20.0, 8.0, 1.83), (40.0, 12.0, 1.0)),
    )
    sheet = SweptShape(SectionCurve(profile), SectionCurve(guide))
    follower = Follower(facets_of(sheet), Tool(1, 6.0), FollowOptions(0.0, 0.05, 1e-4))
    path = cutter_path(
        follower, even_planes((0.0, 0.0), math.radians(158.3), 5.4, follower.facets.triangles[:, :, :2].reshape(-1, 2))
    )
    assert sum(len(run.points) for run in path.runs) < 4_000
    assert follower.proven(chords(path)).all()


def test_what_is_allowed_is_less_than_what_is_promised() -> None:
    assert ALLOWED < GOUGE


def test_a_pass_through_the_pole_of_a_sphere_is_as_short_and_as_well_proven_as_any_other() -> None:
    """There facets are slivers with two corners in one place, and what they face is rounding."""
    follower = Follower(facets_of(ball(0, 0, -15, 30)), BALL, FollowOptions(0.0, 0.01, 1e-4))
    through, beside = (cutter_path(follower, along_x(y)).runs[0].points for y in (0.0, 2.0))
    assert len(through) < 2 * len(beside)
    assert follower.proven(np.concatenate([through[:-1], through[1:]], axis=1)).all()
    true = np.sqrt(np.maximum((30 + BALL.radius) ** 2 - through[:, 0] ** 2, 0)) - 15 - BALL.radius
    inside = np.abs(through[:, 0]) < 25
    assert (through[inside, 2] - true[inside]).min() >= -GOUGE


@pytest.mark.parametrize("tolerance", [0.005, 0.01, 0.05])
def test_round_a_convex_bend_chords_are_as_long_as_the_tolerance_allows(tolerance: float) -> None:
    """Between circles of r and r + h a chord that touches the inner one is sqrt(8 h r) long."""
    radius = 30 + BALL.radius
    run = (
        cutter_path(Follower(facets_of(ball(0, 0, 0, 30)), BALL, FollowOptions(0.0, tolerance)), along_x(0.0))
        .runs[0]
        .points
    )
    inside = run[np.abs(run[:, 0]) < 20]
    long = np.hypot(*np.diff(inside[:, [0, 2]], axis=0).T)
    assert 0.75 * math.sqrt(8 * tolerance * radius) < np.median(long) <= math.sqrt(8 * tolerance * radius) * 1.001


def test_a_flat_is_one_chord_and_a_roof_two() -> None:
    assert [
        len(run.points) for run in cutter_path(Follower(facets_of(plane(0, 0, 80, 10)), BALL), along_x(2.0, 5.0)).runs
    ] == [2, 2]
    roof = facets_of(plane(0, 0, 40, 10, rise=20.0), plane(40, 0, 80, 10, z=20.0, rise=-20.0))
    (run,) = cutter_path(Follower(roof, BALL, FollowOptions(0.0, 0.01)), along_x(5.0)).runs
    turn = 2 * math.atan(0.5)  # round the ridge the ball rolls by so much
    assert len(run.points) <= 4 + 2 * math.ceil(turn / (2 * math.acos(BALL.radius / (BALL.radius + 0.008))))


@pytest.mark.parametrize("angle", [30.0, 60.0, 80.0])
def test_the_tolerance_is_kept_in_concave_corners(angle: float) -> None:
    """A groove whose flanks are one mesh: its bottom is no boundary of surfaces, and the path bends there at one
    place.
    """
    rise = 20 * math.tan(math.radians(angle))
    corners = np.array([[x, y, z] for x, z in ((-20, rise), (0, 0), (20, rise)) for y in (-10, 10)], float)
    groove = SurfaceFacets.of_mesh(corners[[[0, 2, 3], [0, 3, 1], [2, 4, 5], [2, 5, 3]]])
    for tolerance in (0.002, 0.01, 0.05):
        follower = Follower(groove, BALL, FollowOptions(0.0, tolerance))
        planes = CuttingPlanes((0.0, 0.0), math.radians(20.0), (0.0, 1.3))
        for run in cutter_path(follower, planes).runs:
            along = (run.points[:, :2] - planes.place(run.plane, 0.0)) @ planes.along
            low = BALL.radius / math.cos(math.radians(angle)) - BALL.radius  # of the tip where it touches both flanks
            steep = math.tan(math.radians(angle)) * math.cos(planes.angle)
            end = 30.0 * steep + low
            bend = math.tan(planes.angle) * planes.offsets[run.plane]  # where the plane meets the bottom, along it
            true = shapely.LineString([(bend - 30, end), (bend, low), (bend + 30, end)])
            at = bend + np.linspace(-10, 10, 40_001)
            places = shapely.points(np.column_stack([at, np.interp(at, along, run.points[:, 2])]))
            assert shapely.distance(true, places).max() <= tolerance
            assert np.sum(np.abs(along - bend) < 15) < 5


def test_points_that_cannot_be_left_out_come_back() -> None:
    """Where nothing is proven but what was, the way is what it was, or raised above it."""
    facets = spheres()
    for grid in (0.0, 1e-3):
        follower = Follower(facets, BALL, FollowOptions(0.0, 0.01, grid))
        rows = follower.along(along_x(1.0), 0, (0.0, 60.0))
        asked: list[int] = []

        def refused(ways: np.ndarray, _: Progress, asked: list[int] = asked) -> np.ndarray:
            asked.append(len(ways))
            return np.zeros(len(ways), np.bool_)

        (same,) = simplified([rows], PathSimplification((1.0, 0.0), 0.008, grid, facets.owner, refused))
        assert len(same) == len(rows) and asked[0] > 10 and len(asked) == (5 if grid else 1)
        assert np.array_equal(same[:, [X, Y]], rows[:, [X, Y]]) and (same[:, Z] >= rows[:, Z]).all()


def test_thinned_paths_are_nowhere_lower_than_what_was_followed() -> None:
    follower = Follower(spheres(), BALL, FollowOptions(0.0, 0.02, 1e-3))
    rows = follower.along(along_x(1.0), 0, (0.0, 60.0))
    (few,) = follower.thinned([rows], (1.0, 0.0))
    assert len(few) < len(rows) / 5
    high = np.interp(rows[:, X], few[:, X], few[:, Z]) - rows[:, Z]
    assert high.min() >= -1e-9
    marks = few[few[:, NEW] == BOUNDARY]
    assert len(marks) == 3 and {tuple(row) for row in marks.tolist()} <= {tuple(row) for row in rows.tolist()}


@pytest.mark.parametrize("seed", range(5))
def test_points_have_no_more_room_than_as_near_as_the_path_is(seed: int) -> None:
    # a steep stretch shorter than the tolerance gave the height that a long one gives: half as much again was left
    rng = np.random.default_rng(seed)
    rises = rng.choice([0.0, 0.3, 3.0, 10.0, -3.0, -10.0], 60)
    along = rng.choice([1e-3, 5e-3, 0.1], 60)
    path = np.zeros((61, thin_kernels.COLUMNS))
    path[1:, thin_kernels.T], path[1:, thin_kernels.Z] = np.cumsum(along), np.cumsum(rises * along)
    path[[0, -1], thin_kernels.FIXED] = path[0, thin_kernels.BEGINS] = 1.0
    most = 0.009
    thin_kernels.give_room(path, most)
    room, places = path[1:-1, thin_kernels.ROOM], path[:, [thin_kernels.T, thin_kernels.Z]]
    raised = shapely.points(places[1:-1] + np.column_stack([np.zeros(59), room]))
    assert shapely.distance(shapely.LineString(places), raised).max() <= most + 1e-12
    assert room.min() >= most  # and no less than on the level


def test_a_boundary_point_nearer_to_a_place_than_points_may_be_is_told_where_it_is() -> None:
    """On the plane at Y 26 the path comes by halving to within a grid step of where both spheres are touched."""
    spheres = facets_of(plane(0, 0, 100, 60), ball(38, 30, 0, 20), ball(64, 30, 0, 14))
    x = 38 + ((20 + 3) ** 2 - (14 + 3) ** 2 + 26**2) / (2 * 26)  # of the plane on which both offset spheres meet
    for tolerance in (0.01, 0.0097, 0.005):
        follower = Follower(spheres, Tool(1, 6.0, ToolKind.BALL), FollowOptions(0.0, tolerance, 1e-4))
        marks = cutter_path(follower, along_x(*np.arange(20.0, 41.0).tolist())).boundaries
        both = (marks.before + marks.after == 3) & (marks.before * marks.after == 2)
        assert marks.plane[both].tolist() == list(range(21)) and marks.place[both, 0] == pytest.approx(x, abs=1e-6)


def beside_the_boss(degrees: float, away: float, tool: Tool, moved: float = 0.0) -> tuple[Follower, np.ndarray]:
    """The path (n, 3) of a tool's tip so far from a boss's long side, along it."""
    triangles = bossed_block(degrees).astype(np.float32).astype(float) + [moved, moved, 0.0]  # as STL files store it
    follower = Follower(SurfaceFacets.of_mesh(triangles, 0), tool, FollowOptions(0.0, 0.01, 1e-4))
    cos, sin = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    ends = [(moved + x * cos - y * sin, moved + x * sin + y * cos) for x, y in ((-19.0, 7 + away), (19.0, 7 + away))]
    found = follower.between(ends[0], ends[1])
    assert found is not None
    return follower, found


@pytest.mark.parametrize("tool", [Tool(1, 6.0, ToolKind.BALL), Tool(1, 6.0), Tool(1, 6.0, ToolKind.BULL, 1.0)])
@pytest.mark.parametrize(("degrees", "moved"), [(0.0, 0.0), (90.0, 0.0), (0.0, 100.1), (180.0, 12.7)])
def test_a_wall_that_is_just_touched_along_a_pass_is_passed_by(tool: Tool, degrees: float, moved: float) -> None:
    """A ball's rim meets the wall's upper edge there and nothing else: the floor lets it down all the way."""
    follower, found = beside_the_boss(degrees, tool.radius, tool, moved)
    assert found[:, 2].tolist() == pytest.approx([-10.0] * len(found), abs=1.1e-4)
    assert follower.proven(np.hstack([found[:-1], found[1:]])).all()


@pytest.mark.parametrize("degrees", [17.0, 45.0, 123.4])
@pytest.mark.parametrize("off", [-2e-4, -6e-5, -1e-5, 0.0, 1e-5, 6e-5, 2e-4])
def test_rounded_places_beside_a_wall_make_no_swings(degrees: float, off: float) -> None:
    """Whether a place is on this side of the wall's reach or on that hangs on its last decimal: it went up and down
    thousands of times.
    """
    tool = Tool(1, 6.0, ToolKind.BALL)
    follower, found = beside_the_boss(degrees, tool.radius + off, tool)
    swings = float(np.abs(np.diff(found[:, 2])).sum())
    assert swings < 2 * 7.1 + 0.1 and len(found) < 100
    assert follower.proven(np.hstack([found[:-1], found[1:]])).all()


def _proven_length_and_points(triangles: np.ndarray, scale: float, kind: ToolKind) -> tuple[float, int]:
    """Return the length and the points of passes, all of whose chords are proven, over a mesh that many times as large
    as the one given, by a tool, a pitch and a tolerance as many times as large; the length is told for the one given.
    """
    follower = Follower(
        SurfaceFacets.of_mesh(triangles * scale, 0),
        Tool(1, 4.0 * scale, kind),
        FollowOptions(0.0, 0.01 * scale, 1e-3),
    )
    path = cutter_path(follower, along_x(*(scale * np.arange(-16.0, 17.0, 2.0)).tolist()))
    ways = chords(path)
    assert follower.proven(ways).all()
    length = float(np.linalg.norm(ways[:, 3:] - ways[:, :3], axis=1).sum())
    return length / scale, sum(len(run.points) for run in path.runs)


@pytest.mark.parametrize("kind", [ToolKind.BALL, ToolKind.FLAT], ids=["ball", "flat"])
def test_upright_walls_are_passed_alike_in_millimetres_and_in_inches(kind: ToolKind) -> None:
    # written with 3 digits a steep way has places beside its line, and what files round is half a gouge at 500 mm
    mesh = bossed_block(20.0)
    length, points = _proven_length_and_points(mesh, 1.0, kind)
    longer, more = _proven_length_and_points(mesh, 25.4, kind)
    assert longer == pytest.approx(length, rel=0.005)
    assert more < 1.2 * points < 3000
