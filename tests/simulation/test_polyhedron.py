"""Cutters in facets: corners on the profile, facets inside, and no farther inside than is said."""

import math

import numpy as np
import pytest

from app.core.errors import ParameterError
from app.simulation.cutter import Cutter
from app.simulation.gpu.polyhedron import FEWEST, MOST, Polyhedron, circle_corners, circle_table, facet_error, is_ball
from tests.simulation.courses import CUTTERS

OTHERS = [name for name in CUTTERS if name != "ball"]


def test_which_cutters_are_balls() -> None:
    assert [name for name, cutter in CUTTERS.items() if is_ball(cutter)] == ["ball"]


@pytest.mark.parametrize("facet", [0.07, 0.4, 5.0])
@pytest.mark.parametrize("name", OTHERS)
def test_rings_lie_on_the_profile(name: str, facet: float) -> None:
    cutter, form = CUTTERS[name], Polyhedron.of(CUTTERS[name], facet)
    inner = np.minimum(form.rings[:, 0], cutter.radius * (1 - 1e-15))
    assert cutter.heights(inner) == pytest.approx(form.rings[:, 1], abs=1e-6)
    assert form.rings[0, 0] == cutter.flat
    assert form.rings[-1, 0] == cutter.radius
    assert np.all(np.diff(form.rings[:, 1]) > 0)
    assert len(form.table) % 2 == 0


@pytest.mark.parametrize("facet", [0.07, 0.4, 5.0])
@pytest.mark.parametrize("name", OTHERS)
def test_middles_of_facets_are_no_farther_inside_than_is_said(name: str, facet: float) -> None:
    """As seen square to the facet: along its normal the surface comes before the stated distance, and not before 0."""
    cutter, form = CUTTERS[name], Polyhedron.of(CUTTERS[name], facet)
    half = math.cos(math.pi / len(form.table))
    error = facet_error(cutter, facet)
    for (rho, z), step, normal in zip(form.rings[:-1], np.diff(form.rings, axis=0), form.bands, strict=True):
        middle = np.array([(rho + step[0] / 2) * half, z + step[1] / 2])
        assert middle[1] >= cutter.heights(middle[:1])[0] - 1e-12
        out = middle + normal / np.hypot(*normal) * error * (1 + 1e-6)
        assert out[0] >= cutter.radius or out[1] <= cutter.heights(np.maximum(out[:1], 0.0))[0] + 1e-12


def test_the_error_of_a_ball_is_twice_the_sagitta_of_its_facets() -> None:
    assert facet_error(Cutter(3.0, 0.0, 3.0), 0.1) == pytest.approx(2 * 0.1**2 / (8 * 3.0), rel=0.03)


def test_circles_have_enough_corners_and_not_too_many() -> None:
    assert circle_corners(3.0, 100.0) == FEWEST
    assert circle_corners(1.0, 0.01) == 2 * math.ceil(math.pi / 0.01)
    with pytest.raises(ParameterError, match="larger than 0"):
        circle_corners(1.0, 0.0)
    with pytest.raises(ParameterError, match="larger than 0"):
        circle_corners(1.0, math.nan)
    with pytest.raises(ParameterError, match=f"too small for a cutter of radius 1 mm; use {2 * math.pi / MOST:.2g}"):
        circle_corners(1.0, 1e-9)


def test_poles_and_quarters_of_a_circle_are_exact() -> None:
    table = circle_table(16)
    assert table[[0, 4, 8, 12]].tolist() == [[1, 0], [0, 1], [-1, 0], [0, -1]]
