"""Facets of rational surfaces: every place of the surface is as near to its facet as it says."""

import numpy as np
import pytest

from app.model.scene_shapes import BicubicShape, ConeShape, Shape, TorusShape
from app.surfaces.patches.patch import Patches
from tests.surfaces.scenes import ball, facets_of

WAVE = BicubicShape(tuple(tuple((10.0 * i, 10.0 * j, (7.0 * i * j) % 5 - 2.0) for j in range(4)) for i in range(4)))


def places(patches: Patches, patch: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Return places by de Casteljau's rule, in numpy."""
    rows = patches.control[patch]
    while rows.shape[1] > 1:
        rows = rows[:, :-1] * (1 - at[:, 0])[:, None, None, None] + rows[:, 1:] * at[:, 0][:, None, None, None]
    rows = rows[:, 0]
    while rows.shape[1] > 1:
        rows = rows[:, :-1] * (1 - at[:, 1])[:, None, None] + rows[:, 1:] * at[:, 1][:, None, None]
    return rows[:, 0, :3] / rows[:, 0, 3:]


SHAPES = {
    "sphere": ball(1, 2, 3, 10),
    "torus": TorusShape((0.0, 0.0, 0.0), 8.0, 3.0),
    "wave": WAVE,
    "cone": ConeShape((0.0, 0.0, 0.0), (0.0, 5.0, 9.0), 4.0, 0.0),
}


@pytest.mark.parametrize("shape", SHAPES.values(), ids=SHAPES)
@pytest.mark.parametrize("tolerance", [0.1, 0.004])
def test_no_place_is_farther_off_than_the_error_says(shape: Shape, tolerance: float) -> None:
    facets = facets_of(shape, tolerance=tolerance)
    assert facets.error.max() <= tolerance
    share = np.random.default_rng(3).dirichlet([1, 1, 1], len(facets))
    at = np.einsum("nk,nkc->nc", share, facets.corners)
    surface, flat = places(facets.patches, facets.patch, at), np.einsum("nk,nkc->nc", share, facets.triangles)
    off = np.linalg.norm(surface - flat, axis=1)
    assert (off <= facets.error + 1e-12).all()
    assert off.max() >= 0.02 * tolerance  # and no facet is far finer than it was asked to be


def test_corners_lie_on_the_surface_and_halving_the_tolerance_doubles_the_facets() -> None:
    coarse, fine = (facets_of(ball(0, 0, 0, 10), tolerance=each) for each in (0.02, 0.005))
    assert np.linalg.norm(fine.triangles.reshape(-1, 3), axis=1) == pytest.approx(10.0, abs=1e-9)
    assert 2.0 < len(fine) / len(coarse) < 8.0


def test_facets_stand_for_all_of_a_patch_that_ends_in_a_point() -> None:
    facets = facets_of(ConeShape((0.0, 0.0, -5.0), (0.0, 0.0, 7.0), 5.0, 0.0))
    first, second = (facets.corners[:, k] - facets.corners[:, 0] for k in (1, 2))
    share = np.abs(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]) / 2
    np.testing.assert_allclose(np.bincount(facets.patch, share), 1.0)
