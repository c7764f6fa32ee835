"""Sections and the topmost of them, against closed forms: crossings, edges, jumps, contacts; nothing else changes
them.
"""

import math

import numpy as np
import pytest

from app.model.scene import Surface
from app.model.scene_shapes import ConeShape
from app.surfaces.patches.facets import joined
from app.surfaces.sections.compound import BoundaryKind, BoundaryPoints, CompoundSurface, CuttingPlanes
from app.surfaces.sections.section import compound_surface
from tests.surfaces.scenes import along_x, ball, facets_of, half_cylinder, plane, turned

TOLERANCE = 0.01


def kinds(marks: BoundaryPoints) -> list[str]:
    return [BoundaryKind(kind).name for kind in marks.kind.tolist()]


def pairs(marks: BoundaryPoints) -> list[tuple[int, int]]:
    return list(zip(marks.before.tolist(), marks.after.tolist(), strict=True))


def heights(compound: CompoundSurface, number: int, at: np.ndarray) -> np.ndarray:
    """Return the heights of one plane's runs at places along X."""
    points = np.concatenate([run.points for run in compound.runs if run.plane == number])
    return np.interp(at, points[:, 0], points[:, 2])


def test_spheres_on_a_plane_are_met_on_circles() -> None:
    facets = facets_of(plane(0, -10, 60, 10), ball(15, 0, 3, 5), ball(40, 0, -2, 8))
    planes = along_x(*np.linspace(-9, 9, 37).tolist())
    marks = compound_surface(facets, planes, TOLERANCE).boundaries
    rims = {1: (15.0, 4.0), 2: (40.0, math.sqrt(60.0))}
    for n, (before, after) in enumerate(pairs(marks)):
        x, radius = rims[max(before, after)]
        assert math.hypot(marks.place[n, 0] - x, marks.place[n, 1]) == pytest.approx(radius, abs=1e-9) or radius == 4.0
    crossing = [n for n in range(len(marks)) if max(pairs(marks)[n]) == 2]
    inside = [y for y in planes.offsets if abs(y) < math.sqrt(60.0)]
    assert len(crossing) == 2 * len(inside)
    assert np.abs(marks.place[crossing] - marks.end[crossing]).max() <= 1e-9
    assert {kinds(marks)[n] for n in crossing} == {"CROSSING"}


def test_a_sphere_that_overhangs_is_left_by_a_jump() -> None:
    marks = compound_surface(
        facets_of(plane(0, -10, 30, 10), ball(15, 0, 3, 5)), along_x(0.0, 3.0), TOLERANCE
    ).boundaries
    assert kinds(marks) == ["JUMP"] * 4
    assert np.sort(marks.place[:, 0]) == pytest.approx([10, 11, 19, 20], abs=1e-9)
    assert np.minimum(marks.place[:, 2], marks.end[:, 2]) == pytest.approx(0.0, abs=1e-9)
    assert np.maximum(marks.place[:, 2], marks.end[:, 2]) == pytest.approx(3.0, abs=1e-9)


def test_the_topmost_is_the_maximum_and_within_the_tolerance() -> None:
    facets = facets_of(
        plane(0, -10, 60, 10), ball(15, 0, -1, 6), ball(24, 2, -3, 9), half_cylinder((30, -10, -1), (45, 10, -1), 4)
    )
    compound = compound_surface(facets, along_x(1.0), TOLERANCE)
    x = np.linspace(0.5, 59.5, 4001)

    def dome(cx: float, cy: float, cz: float, radius: float) -> np.ndarray:
        square = radius**2 - (x - cx) ** 2 - (1.0 - cy) ** 2
        return np.where(square > 0, cz + np.sqrt(np.maximum(square, 0)), -np.inf)

    side = np.abs((x - 30) * 20 - (1.0 + 10) * 15) / 25  # from the cylinder's axis, seen from above
    tube = np.where(side < 4, -1 + np.sqrt(np.maximum(16 - side**2, 0)), -np.inf)
    true = np.maximum.reduce([np.zeros_like(x), dome(15, 0, -1, 6), dome(24, 2, -3, 9), tube])
    off = heights(compound, 0, x) - true
    steep = np.abs(np.gradient(true, x)) > 3
    assert np.abs(off[~steep]).max() <= 1.5 * TOLERANCE
    assert len(compound.runs[0].points) < 200


def test_one_that_ends_at_the_height_of_another_is_an_edge() -> None:
    marks = compound_surface(
        facets_of(plane(0, 0, 10, 10), plane(10, 0, 20, 10, rise=7)), along_x(5.0), TOLERANCE
    ).boundaries
    assert kinds(marks) == ["EDGE"] and pairs(marks) == [(0, 1)]
    assert marks.place[0] == pytest.approx([10, 5, 0], abs=1e-9)


def test_one_that_ends_above_another_is_a_jump_to_it() -> None:
    marks = compound_surface(
        facets_of(plane(0, 0, 10, 10, z=5), plane(0, 0, 20, 10)), along_x(5.0), TOLERANCE
    ).boundaries
    assert kinds(marks) == ["JUMP"] and pairs(marks) == [(0, 1)]
    assert (marks.place[0, 2], marks.end[0, 2]) == pytest.approx((5.0, 0.0), abs=1e-12)


def test_surfaces_that_lie_on_each_other_touch_along_a_stretch() -> None:
    marks = compound_surface(facets_of(plane(0, 0, 10, 10), plane(5, 0, 15, 10)), along_x(5.0), TOLERANCE).boundaries
    assert kinds(marks) == ["TANGENT"] and pairs(marks) == [(0, 1)]
    assert (marks.place[0, 0], marks.end[0, 0]) == pytest.approx((5.0, 10.0), abs=1e-9)


def test_a_cylinder_that_touches_a_plane_along_a_line_is_left_where_it_ends() -> None:
    facets = facets_of(plane(0, -10, 10, 10, z=4), half_cylinder((5, 0, 0), (20, 0, 0), 4))
    marks = compound_surface(facets, along_x(0.0), TOLERANCE).boundaries
    assert kinds(marks) == ["TANGENT"] and pairs(marks) == [(0, 1)]
    assert (marks.place[0, 0], marks.end[0, 0]) == pytest.approx((5.0, 10.0), abs=1e-6)
    assert marks.place[0, 2] == pytest.approx(4.0, abs=1e-9)


def test_parameters_of_a_boundary_point_give_its_place() -> None:
    marks = compound_surface(
        facets_of(plane(0, 0, 20, 10), plane(0, 0, 20, 10, z=-3, rise=10)), along_x(2.0), TOLERANCE
    ).boundaries
    assert pairs(marks) == [(0, 1)] and marks.place[0] == pytest.approx([6, 2, 0], abs=1e-9)
    for at in (marks.before_at[0], marks.after_at[0]):
        assert at == pytest.approx([0.3, 0.2], abs=1e-9)


def test_a_spike_narrower_than_any_sampling_is_found() -> None:
    spike = ConeShape((7.03, 3.0, 0.0), (7.03, 3.0, 6.0), 0.004, 0.0)
    compound = compound_surface(facets_of(plane(0, 0, 20, 10), spike), along_x(3.0), TOLERANCE)
    points = np.concatenate([run.points for run in compound.runs])
    assert points[:, 2].max() == pytest.approx(6.0, abs=1e-9)
    assert points[np.argmax(points[:, 2]), 0] == pytest.approx(7.03, abs=1e-9)
    assert len(compound.boundaries) == 2


def scene() -> list[Surface]:
    return [Surface("a", plane(0, -10, 60, 10)), Surface("b", ball(15, 0, -1, 6)), Surface("c", ball(24, 2, -3, 9))]


def test_what_lies_far_below_changes_nothing() -> None:
    planes = along_x(-4.0, 0.0, 3.3)
    below = plane(-5, -20, 90, 20, z=-400.0, rise=30)
    one, both = (
        compound_surface(facets_of(*each, tolerance=0.01), planes, TOLERANCE) for each in (scene(), [*scene(), below])
    )
    seen = [run.points for run in both.runs if run.points[:, 2].max() > -100]
    assert [run.points.tolist() for run in one.runs] == [points.tolist() for points in seen]
    assert np.array_equal(one.boundaries.place, both.boundaries.place[both.boundaries.kind != BoundaryKind.JUMP])


def test_turning_the_scene_and_the_planes_turns_what_is_found() -> None:
    angle = 37.0
    plain = facets_of(*scene())
    about = facets_of(*(Surface(each.name, each.shape, rotate_deg=(0.0, 0.0, angle)) for each in scene()))
    one = compound_surface(plain, along_x(-4.0, 0.0, 3.3), TOLERANCE)
    other = compound_surface(about, CuttingPlanes((0.0, 0.0), math.radians(angle), (-4.0, 0.0, 3.3)), TOLERANCE)
    assert kinds(one.boundaries) == kinds(other.boundaries) and pairs(one.boundaries) == pairs(other.boundaries)
    assert np.abs(turned(one.boundaries.place, angle) - other.boundaries.place).max() <= 1e-9


def test_the_order_of_facets_changes_nothing() -> None:
    facets = facets_of(*scene())
    order = np.random.default_rng(7).permutation(len(facets))
    mixed = joined([facets.only(order[:1000]), facets.only(order[1000:])])
    one, other = (compound_surface(each, along_x(0.0, 2.0), TOLERANCE).boundaries for each in (facets, mixed))
    assert one.place == pytest.approx(other.place, abs=1e-12) and kinds(one) == kinds(other)


@pytest.mark.parametrize("tolerance", [0.05, 0.001])
def test_the_curve_of_each_surface_is_on_it_and_as_near_as_asked(tolerance: float) -> None:
    curves = compound_surface(facets_of(ball(0, 0, 0, 10)), along_x(6.0), tolerance).curves
    points = np.concatenate([curve.points for curve in curves])
    assert np.linalg.norm(points, axis=1) == pytest.approx(10.0, abs=1e-9)
    for curve in curves:
        middle = (curve.points[1:] + curve.points[:-1]) / 2
        assert (8.0 - np.hypot(middle[:, 0], middle[:, 2])).max() <= tolerance
