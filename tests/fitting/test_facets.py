"""Facets of clouds: those of a known polyhedron are found, and the points at their borders are effective."""

import math
from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import NDArray

from app.core.errors import GeometryError, ParameterError
from app.fitting.point_curves.effective_points import PointState
from app.fitting.point_curves.facets import CloudFacets, facets_of_grid, facets_of_rows

Floats = NDArray[np.float64]
EPSILON = 1e-6
RADIUS, EACH, SIDES, ROWS = 20.0, 5, 12, 9


def prism() -> Floats:
    """A cylinder's polyhedron: flat sides of EACH steps between corners on the circle (columns), along its axis
    (rows).
    """
    turn = np.linspace(0, math.pi, SIDES + 1)
    corners = RADIUS * np.column_stack((np.cos(turn), np.sin(turn)))
    share = np.arange(EACH)[:, None, None] / EACH
    section = (corners[:-1] + share * np.diff(corners, axis=0)).transpose(1, 0, 2).reshape(-1, 2)
    section = np.concatenate((section, corners[-1:]))
    grid = np.empty((ROWS, len(section), 3))
    grid[..., :2], grid[..., 2] = section, np.arange(ROWS)[:, None] * 2.0
    return grid


def ensure_flat(found: CloudFacets, points: Floats) -> None:
    planes = found.planes[found.facet]
    away = np.einsum("ij,ij->i", points - planes[:, 3:], planes[:, :3])
    assert np.abs(away).max() <= EPSILON
    assert np.linalg.norm(found.planes[:, :3], axis=1) == pytest.approx(1)


def test_sides_of_a_prism_are_its_facets() -> None:
    grid = prism()
    found = facets_of_grid(grid, EPSILON)
    ensure_flat(found, grid.reshape(-1, 3))
    assert len(found.planes) == SIDES
    off = np.abs(np.hypot(grid[..., 0], grid[..., 1]) - RADIUS)
    inner = found.state.reshape(grid.shape[:2])[1:-1]
    assert (inner[off[1:-1] < 1e-9] == PointState.EFFECTIVE).all()
    middle = np.arange(2, EACH - 1)[:, None] + EACH * np.arange(SIDES)
    assert (inner[:, middle.ravel()] == PointState.INVALID).all()


def test_points_at_the_borders_of_a_torus_polyhedron_are_nearer_to_the_torus() -> None:
    """Its facets are flat trapezia; points that a grid puts within them lie off the torus, up to 0.25 mm."""
    big, small, across, along = 40.0, 15.0, 12, 20
    u, v = np.meshgrid(np.linspace(0, 2 * math.pi, across + 1), np.linspace(0, math.pi, along + 1))
    reach = big + small * np.cos(u)
    corners = np.stack((reach * np.cos(v), reach * np.sin(v), small * np.sin(u)), axis=-1)
    for axis in range(2):
        line = np.moveaxis(corners, axis, 0)
        share = np.linspace(0, 1, 9)[:-1, None, None]
        sides = [a + share * (b - a) for a, b in pairwise(line)]
        corners = np.moveaxis(np.concatenate([*sides, line[-1:]]), 0, axis)
    found = facets_of_grid(corners, EPSILON)
    ensure_flat(found, corners.reshape(-1, 3))
    assert len(found.planes) == across * along
    off = np.abs(np.hypot(np.hypot(*corners[..., :2].reshape(-1, 2).T) - big, corners[..., 2].ravel()) - small)
    effective = found.state == PointState.EFFECTIVE
    assert off[effective].mean() < 0.7 * off[~effective].mean()


def test_rows_of_any_length_give_the_same_sides() -> None:
    grid = prism()
    rows = [*grid[:-1], grid[-1, :-EACH]]
    found = facets_of_rows(rows, EPSILON)
    ensure_flat(found, np.concatenate(rows))
    assert len(found.planes) == SIDES


def test_a_plane_is_one_facet_and_its_rim_is_effective() -> None:
    x, y = np.meshgrid(np.arange(7.0), np.arange(5.0))
    grid = np.stack((x, y, 0.3 * x - 0.2 * y), axis=-1)
    found = facets_of_grid(grid, EPSILON)
    assert len(found.planes) == 1
    assert (found.state.reshape(5, 7)[1:-1, 1:-1] == PointState.INVALID).all()
    assert (found.state == PointState.EFFECTIVE).sum() == 35 - 15


def test_a_rough_cloud_has_flat_facets_all_the_same() -> None:
    grid = np.random.default_rng(4).normal(size=(20, 30, 3))
    found = facets_of_grid(grid, EPSILON)
    ensure_flat(found, grid.reshape(-1, 3))
    assert sorted(set(found.facet.tolist())) == list(range(len(found.planes)))


def test_what_is_no_cloud_is_refused() -> None:
    with pytest.raises(GeometryError, match="expected"):
        facets_of_grid(np.zeros((1, 5, 3)), EPSILON)
    with pytest.raises(GeometryError, match="finite"):
        facets_of_grid(np.full((3, 3, 3), np.nan), EPSILON)
    with pytest.raises(GeometryError, match="expected"):
        facets_of_rows([np.zeros((5, 3))], EPSILON)
    with pytest.raises(ParameterError, match="must be"):
        facets_of_grid(prism(), 0.0)
