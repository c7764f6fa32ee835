"""Trimmed surfaces end where their outlines do: nothing beyond is touched, nothing within is lost."""

import math
from threading import Event

import numpy as np
import pytest
import shapely

from app.core.errors import Cancelled, GeometryError
from app.core.progress import Progress
from app.model.scene import KeptSide, Surface, Trim
from app.model.scene_shapes import BsplineShape, Shape
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.surfaces.cutter_contact.drop_cutter import drop
from app.surfaces.passes.path import Follower, FollowOptions, cutter_path
from app.surfaces.patches.build import build_surface
from app.surfaces.patches.facets import SurfaceFacets
from app.surfaces.patches.patch import Patches, patches_of
from app.surfaces.patches.tessellate import tessellate
from app.surfaces.patches.trim import AT_OUTLINES, trimmed_mesh, trimmed_patches
from tests.surfaces.scenes import along_x, ball, facets_of, plane
from tests.surfaces.surface_places import NO_FILES

BALL = Tool(1, 6.0, ToolKind.BALL)
RADIUS = 20.0


def trimmed(shape: Shape, *trims: Trim) -> Surface:
    return Surface("trimmed", shape, trims=trims)


def whole_ball() -> Patches:
    return patches_of([build_surface(Surface("ball", ball(0, 0, 0, RADIUS)), NO_FILES).splines])


def half_ball() -> SurfaceFacets:
    """Return the half of a ball that lies at x <= 0."""
    return facets_of(trimmed(ball(0, 0, 0, RADIUS), Trim(rectangle=(-100.0, -100.0, 0.0, 100.0))))


def over_half_ball(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Return the tip's height over it: on the ball, or round the half circle where it ends."""
    r = BALL.radius
    on_ball = np.sqrt(np.maximum((RADIUS + r) ** 2 - x**2 - y**2, 0)) - r
    out = RADIUS + np.sqrt(np.maximum(r**2 - x**2, 0))
    round_edge = np.sqrt(np.maximum(out**2 - y**2, 0)) - r
    touches_ball = x * RADIUS / (RADIUS + r) <= 0
    return np.where(touches_ball, on_ball, np.where(x < r, round_edge, -np.inf))


def area_seen(facets: SurfaceFacets) -> float:
    """Return the area of facets as seen from above, those that face down as well."""
    a, b, c = facets.triangles[:, :, :2].swapaxes(0, 1)
    first, second = b - a, c - a
    return float(np.abs(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]).sum() / 2)


@pytest.mark.exhaustive
def test_the_cutter_rolls_over_the_edge_of_half_a_ball() -> None:
    x, y = (grid.ravel() for grid in np.meshgrid(np.linspace(-15, 2.9, 60), np.linspace(-12, 12, 30)))
    found = drop(half_ball(), BALL, np.column_stack([x, y])).height
    assert np.abs(found - over_half_ball(x, y)).max() <= 2 * AT_OUTLINES
    assert drop(half_ball(), BALL, np.array([[BALL.radius + 1e-3, 0.0]])).height[0] == -math.inf


@pytest.mark.exhaustive
def test_a_path_over_half_a_ball_is_proven_and_ends_where_the_surface_does() -> None:
    follower = Follower(half_ball(), BALL, FollowOptions(0.0, 0.01, 1e-4))
    (run,) = cutter_path(follower, along_x(3.0)).runs
    points = run.points
    assert points[-1, 0] == 0.0  # its centre stays over the surface's box
    assert follower.proven(np.concatenate([points[:-1], points[1:]], axis=1)).all()
    upper = np.hypot(points[:, 0], points[:, 1]) < 17
    off = points[:, 2] - over_half_ball(points[:, 0], points[:, 1])
    assert off[upper].min() >= -1e-4 and off[upper].max() <= 0.01 * 22 / math.sqrt(22**2 - 17**2) + 2e-4


@pytest.mark.parametrize("radius", [2.0, 4.0, 9.0])
def test_a_cutter_dips_into_a_round_hole_as_far_as_its_rim_lets_it(radius: float) -> None:
    holed = trimmed(plane(-20, -20, 20, 20), Trim(circle=(1.0, 2.0, radius), keep=KeptSide.OUTSIDE))
    facets = facets_of(holed, plane(-20, -20, 20, 20, z=-2.5))
    x = np.linspace(-8, 8, 161)
    found = drop(facets, BALL, np.column_stack([x + 1.0, np.full_like(x, 2.0)])).height
    to_rim = np.maximum(radius - np.abs(x), 0.0)
    true = np.maximum(np.sqrt(np.maximum(BALL.radius**2 - np.minimum(to_rim, BALL.radius) ** 2, 0)) - BALL.radius, -2.5)
    assert np.abs(found - true).max() <= 1e-5  # the outline's chords are that near to the rim


def bumps(seed: int) -> BsplineShape:
    """Return a surface without any symmetry over about 40 x 40 mm."""
    random = np.random.default_rng(seed)
    u, v = np.meshgrid(np.linspace(0, 40, 7), np.linspace(0, 40, 7), indexing="ij")
    points = np.stack(
        [u + random.uniform(-1, 1, u.shape), v + random.uniform(-1, 1, u.shape), random.uniform(0, 12, u.shape)],
        axis=-1,
    )
    return BsplineShape(tuple(tuple((*map(float, place),) for place in row) for row in points.tolist()))


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("keep", list(KeptSide))
def test_cutters_over_what_is_left_of_a_bumpy_surface_against_dense_sampling(seed: int, keep: KeptSide) -> None:
    circle = Trim(circle=(18.0, 21.0, 11.0), keep=keep)
    facets = facets_of(trimmed(bumps(seed), circle))
    whole = facets_of(bumps(seed)).patches
    u, v = (grid.ravel() for grid in np.meshgrid(np.linspace(0, 1, 120), np.linspace(0, 1, 120)))
    samples = np.concatenate([whole.points(np.full(len(u), patch), u, v) for patch in range(len(whole))])
    out = (np.hypot(samples[:, 0] - 18.0, samples[:, 1] - 21.0) - 11.0) * (1 if keep is KeptSide.INSIDE else -1)
    where = np.random.default_rng(seed).uniform(5, 35, (60, 2))
    found = drop(facets, BALL, where).height
    for (x, y), height in zip(where.tolist(), found.tolist(), strict=True):
        square = BALL.radius**2 - (samples[:, 0] - x) ** 2 - (samples[:, 1] - y) ** 2
        # samples are less than 0.1 mm apart
        low, high = (
            (samples[near, 2] + np.sqrt(square[near])).max(initial=-np.inf) - BALL.radius
            for near in ((square > 0) & (out <= off) for off in (0.0, 0.1))
        )
        assert low - 1e-6 - AT_OUTLINES <= height <= high + 0.02


@pytest.mark.parametrize(
    "trim",
    [
        Trim(circle=(3.0, -2.0, 9.0)),
        Trim(outline=((-8.0, -8.0), (9.0, -3.0), (-2.0, 11.0))),
        Trim(circle=(0.0, 0.0, 7.0), keep=KeptSide.OUTSIDE),
    ],
    ids=["circle", "triangle", "hole"],
)
def test_what_is_left_covers_the_area_once(trim: Trim) -> None:
    """Seen from above a ball has two sides."""
    inside = math.pi * trim.circle[2] ** 2 if trim.circle else shapely.Polygon(trim.outline).area
    area = inside if trim.keep is KeptSide.INSIDE else math.pi * RADIUS**2 - inside
    facets = facets_of(trimmed(ball(0, 0, 0, RADIUS), trim))
    assert area_seen(facets) / 2 == pytest.approx(area, rel=1e-3)  # chords of facets as coarse as the scene allows


def test_far_from_the_outline_nothing_is_divided() -> None:
    patches = whole_ball()
    around = shapely.box(-50, -50, 50, 50)
    kept, cut = trimmed_patches(patches, {0: around})
    assert len(kept) == len(patches) and kept.whole.all() and not len(cut)
    off, cut = trimmed_patches(patches, {0: shapely.box(50, 50, 60, 60)})
    assert not len(off) and not len(cut)


def test_divided_patches_know_their_own_parameters() -> None:
    whole = whole_ball()
    kept, cut = trimmed_patches(whole, {0: shapely.box(-50, -50, 0.3, 50)})
    middle = np.full(len(kept), 0.5)
    places = kept.points(np.arange(len(kept)), middle, middle)
    u, v = (kept.spans[:, [0, 2]] + kept.spans[:, [1, 3]]).T / 2
    u0, u1, v0, v1 = (edge[:, None] for edge in whole.spans.T)
    patch = ((u0 <= u) & (u <= u1) & (v0 <= v) & (v <= v1)).argmax(axis=0)
    u0, u1, v0, v1 = whole.spans[patch].T
    np.testing.assert_allclose(places, whole.points(patch, (u - u0) / (u1 - u0), (v - v0) / (v1 - v0)), atol=1e-9)
    assert cut.error.max() <= AT_OUTLINES and not cut.patches.whole.any()


def test_an_upright_wall_of_a_mesh_is_cut_across() -> None:
    wall = np.array([[[0, 0, 0], [20, 0, 0], [20, 0, 10]], [[0, 0, 0], [20, 0, 10], [0, 0, 10]]], float)
    left = trimmed_mesh(SurfaceFacets.of_mesh(wall), shapely.box(-1, -1, 13, 1))
    size = (
        np.linalg.norm(
            np.cross(left.triangles[:, 1] - left.triangles[:, 0], left.triangles[:, 2] - left.triangles[:, 0]), axis=1
        )
        / 2
    )
    assert size.sum() == pytest.approx(130)
    assert left.triangles[:, :, 0].max() == pytest.approx(13) and not np.abs(left.triangles[:, :, 1]).any()
    assert len(trimmed_mesh(SurfaceFacets.of_mesh(wall), shapely.box(-1, 1, 30, 2))) == 0


def test_trims_that_leave_nothing_are_told_by_name() -> None:
    away = trimmed(plane(0, 0, 10, 10), Trim(circle=(50.0, 50.0, 3.0)))
    with pytest.raises(
        GeometryError, match=r"^Surface trimmed: its trims leave nothing of it; check their outlines\.$"
    ):
        facets_of(away, plane(0, 0, 9, 9))


def test_trimming_can_be_cancelled() -> None:
    patches = whole_ball()
    stop = Event()
    stop.set()
    with pytest.raises(Cancelled):
        trimmed_patches(patches, {0: shapely.box(-50, -50, 0.3, 50)}, Progress(cancelled=stop))


def test_triangles_of_whole_patches_are_those_of_the_untrimmed_surface() -> None:
    patches = whole_ball()
    kept, _ = trimmed_patches(patches, {0: shapely.box(-50, -50, 50, 50)})
    np.testing.assert_array_equal(tessellate(kept, 0.01).triangles, tessellate(patches, 0.01).triangles)
