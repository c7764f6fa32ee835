"""Facets by themselves: where their corners lie, what they cover, and how many there are."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.model.motion import Floats, MotionKind
from app.simulation.cutter import Cutter
from app.simulation.gpu.polyhedron import circle_corners
from app.simulation.gpu.wedges import (
    ROOM,
    FacetKind,
    FacetSide,
    SweepFacets,
    Tessellation,
    facets_in,
    polygon_counts,
)
from app.simulation.sweeps.chains import Chains, chains_of
from tests.examples import examples
from tests.simulation.courses import CUTTERS, arc, course_of, joined, motions_of, polyline
from tests.simulation.test_sweep import walk

BOTH = Tessellation(0.25, side=FacetSide.BOTH)
BENT = np.array([[0.0, 0, 0], [4, 0, 1], [6, 3, 0]])


def from_path(points: Floats, places: Floats) -> Floats:
    """How far points are from a polyline."""
    way = np.diff(places, axis=0)
    square = np.maximum(np.einsum("ij,ij->i", way, way), 1e-30)
    share = np.clip(np.einsum("pij,ij->pi", points[:, None] - places[:-1], way) / square, 0, 1)
    return np.asarray(np.min(np.linalg.norm(places[:-1] + share[..., None] * way - points[:, None], axis=2), axis=1))


def normals(quads: Floats) -> Floats:
    """Inward unit normals (m, 3) of quads: square to their diagonals."""
    found = np.cross(quads[:, 2] - quads[:, 0], quads[:, 3] - quads[:, 1])
    return np.asarray(found / np.linalg.norm(found, axis=1)[:, None])


def areas(quads: Floats) -> Floats:
    return np.asarray(np.linalg.norm(np.cross(quads[:, 2] - quads[:, 0], quads[:, 3] - quads[:, 1]), axis=1) / 2)


def of_kind(found: SweepFacets, kind: FacetKind) -> Floats:
    return found.quads[found.kind == kind].astype(float)


def sweep_facets(points: Floats, radius: float, how: Tessellation) -> SweepFacets:
    """All facets of what a ball sweeps along one chain of places (n + 1, 3) of its centre."""
    places = np.asarray(points, float) - (0.0, 0.0, radius)
    chains = Chains.of(places[:-1], places[1:], np.arange(len(places) - 1) > 0)
    parts = [(part.quads.copy(), part.kind.copy()) for part, _ in facets_in(Cutter(radius, 0.0, radius), chains, how)]
    return SweepFacets(*(np.concatenate(each) for each in zip(*parts, strict=True)))


def test_corners_lie_on_the_surface() -> None:
    """Those of cylinders also where a neighbour's sphere or cylinder covers them."""
    found = sweep_facets(BENT, 2.0, BOTH)
    for kind in FacetKind:
        corners = of_kind(found, kind).reshape(-1, 3)
        assert from_path(corners, BENT).max() < 2 + 1e-6
    for kind in (FacetKind.WEDGE, FacetKind.END):
        assert from_path(of_kind(found, kind).reshape(-1, 3), BENT).min() > 2 - 1e-6


def test_a_wedge_has_the_area_of_its_angle_and_lies_between_the_end_planes() -> None:
    """Of a sphere of radius r a lune of the turn has 2 r² turn."""
    for turn in (0.001, 0.3, 1.5, 3.0):
        places = np.array([[-4.0, 0, 0], [0, 0, 0], [4 * math.cos(turn), 0, 4 * math.sin(turn)]])
        wedge = of_kind(sweep_facets(places, 2.0, Tessellation(0.05, side=FacetSide.BOTH)), FacetKind.WEDGE)
        assert areas(wedge).sum() == pytest.approx(8 * turn, rel=2e-3)
        assert wedge[..., 0].min() > -1e-6
        assert (wedge @ (places[2] / 4)).max() < 1e-6
        assert np.linalg.norm(wedge[:, 0] - wedge[:, 3], axis=1).max() <= 0.05 * (1 + 1e-6)
        assert np.linalg.norm(wedge[:, 0] - wedge[:, 1], axis=1).max() <= 0.05 * (1 + 1e-6)


def test_strips_of_a_cylinder_are_as_long_as_the_move_and_as_wide_as_a_facet() -> None:
    strips = of_kind(sweep_facets(BENT[:2], 2.0, BOTH), FacetKind.CYLINDER)
    assert len(strips) == circle_corners(2.0, 0.25) == 2 * math.ceil(math.pi * 2 / 0.25)
    sides = np.sort(np.linalg.norm(np.diff(strips[:, [0, 1, 2]], axis=1), axis=2), axis=1)
    assert sides[:, 1] == pytest.approx(np.full(len(strips), math.sqrt(17)), abs=1e-5)
    assert 0.23 < sides[:, 0].min() <= sides[:, 0].max() <= 0.25
    assert areas(strips).sum() == pytest.approx(4 * math.pi * math.sqrt(17), rel=1e-2)


def test_an_end_is_half_a_sphere_and_a_place_alone_a_lower_one() -> None:
    ends = of_kind(sweep_facets(BENT[:2], 2.0, BOTH), FacetKind.END)
    assert areas(ends).sum() == pytest.approx(2 * 2 * math.pi * 4, rel=1e-2)
    alone = sweep_facets(np.array([[1.0, 1, 1], [1, 1, 1], [1, 1, 1]]), 2.0, Tessellation(0.25))
    assert set(alone.kind.tolist()) == {FacetKind.END}
    assert areas(alone.quads.astype(float)).sum() == pytest.approx(8 * math.pi, rel=1e-2)
    assert alone.quads[..., 2].max() < 1 + 1e-6


@pytest.mark.parametrize("steps", [[(0, 0, -4)], [(0, 0, 4)], [(3, 0, 1), (-3, 0, -1)], [(0, 0, -3), (0, 0, 3)]])
def test_upright_moves_and_ways_back(steps: list[tuple[float, float, float]]) -> None:
    """A way back leaves half a sphere at its turning place."""
    places = np.cumsum([(0, 0, 0), *steps], axis=0, dtype=float)
    found = sweep_facets(places, 2.0, BOTH)
    kept = sweep_facets(places, 2.0, Tessellation(0.25))
    assert from_path(found.quads.reshape(-1, 3).astype(float), places).max() < 2 + 1e-5
    if len(steps) == 2:
        assert areas(of_kind(found, FacetKind.WEDGE)).sum() == pytest.approx(8 * math.pi, rel=1e-2)
    if not np.any(np.array(steps)[:, :2]):
        assert not np.any(kept.kind == FacetKind.CYLINDER)


def test_kept_facets_look_down_and_the_others_up() -> None:
    places = walk(4, 60, 1.0, 0.7)
    all_, down, up = (
        sweep_facets(places, 1.5, Tessellation(0.2, side=side))
        for side in (FacetSide.BOTH, FacetSide.DOWN, FacetSide.UP)
    )
    assert normals(down.quads.astype(float))[:, 2].min() > -0.05
    assert normals(up.quads.astype(float))[:, 2].max() < 0.05
    assert len(all_.quads) <= len(down.quads) + len(up.quads) <= 1.02 * len(all_.quads)


place = st.tuples(*[st.floats(-9, 9)] * 3)


@settings(max_examples=examples(60), deadline=None)
@given(
    st.lists(place, min_size=2, max_size=7),
    st.floats(0.2, 4.0),
    st.floats(0.05, 3.0),
    st.sampled_from([0.0, 0.02, 0.5]),
)
def test_no_corner_leaves_what_is_swept(
    places: list[tuple[float, float, float]], radius: float, facet: float, overlap: float
) -> None:
    corners = np.array([*places, places[-1]])
    quads = sweep_facets(corners, radius, Tessellation(facet, overlap=overlap)).quads
    assert len(quads)
    assert from_path(quads.reshape(-1, 3).astype(float), corners).max() <= radius + 1e-5


def test_parts_are_what_the_whole_is(monkeypatch: pytest.MonkeyPatch) -> None:
    places = walk(7, 200, 0.5, 0.5)
    chains = Chains.of(places[:-1], places[1:], np.arange(len(places) - 1) % 17 > 0)
    for cutter in (CUTTERS["ball"], CUTTERS["bull"]):
        whole = next(part.quads.copy() for part, _ in facets_in(cutter, chains, Tessellation(0.3)))
        monkeypatch.setattr("app.simulation.gpu.wedges.ROOM", 4 * circle_corners(3.0, 0.3))
        parts = [part.quads.copy() for part, _ in facets_in(cutter, chains, Tessellation(0.3))]
        monkeypatch.setattr("app.simulation.gpu.wedges.ROOM", ROOM)
        assert len(parts) > 10
        assert np.array_equal(np.concatenate(parts), whole)


def test_counts_of_the_published_table() -> None:
    """A zigzag of slight turns: each wedge is one strip, and half of everything looks down."""
    radius, facet = 3.0, 0.2
    places = np.array([[0.5 * k, 0.0, 0.01 * (k % 2)] for k in range(400)])
    counts = polygon_counts(course_of(polyline(places)), {1: Cutter(radius, 0.0, radius)}, facet)
    round_ = circle_corners(radius, facet)
    sphere = 4 * math.pi * radius**2 / facet**2
    assert counts.spheres == pytest.approx(400 * sphere + 399 * round_, rel=0.03)
    assert counts.spheres_down == pytest.approx(counts.spheres / 2, rel=0.02)
    ends = 2 * (round_ // 2) ** 2
    assert counts.wedges == 399 * round_ + 398 * (round_ // 2) + ends
    assert counts.drawn == pytest.approx(counts.wedges / 2, rel=0.03)
    assert counts.spheres / counts.drawn > 25


def test_counts_of_other_cutters_know_no_upper_side() -> None:
    counts = polygon_counts(course_of(polyline(walk(2, 30, 1.0, 0.3))), {1: CUTTERS["bull"]}, 0.3)
    assert counts.spheres == counts.spheres_down
    assert counts.wedges == counts.drawn
    assert counts.drawn < 0.7 * counts.spheres


def test_chains_break_at_rapids_tools_and_jumps() -> None:
    places = walk(5, 7, 1.0, 0.2)
    rapid = motions_of(places[-1:], places[-1:] + 1, MotionKind.RAPID)
    jump = polyline([places[-1] + 1, places[-1] + 2, places[-1] + 2])
    course = course_of(
        joined([polyline(places), rapid, jump, polyline([(0, 0, 0), (0, 0, 0)]), arc((3, 0, 0), (0, 3, 0), (0, 0, 0))])
    )
    ((cutter, chains),) = chains_of(course, {1: CUTTERS["v"]}, 0.01)
    assert cutter is CUTTERS["v"]
    assert np.flatnonzero(chains.joins == 0).tolist() == [0, 6, 7, 8]
    assert not chains.way[7].any()
    assert np.linalg.norm(chains.way[8:], axis=1) == pytest.approx(np.ones(len(chains) - 8))
    assert chains.corners == 7 + 2 + 1 + len(chains) - 8 + 1
    assert len(chains) - 8 == math.ceil(math.sqrt(3 * (math.pi / 2) ** 2 / (8 * 0.01)))
