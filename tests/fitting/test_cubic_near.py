"""Cubics near a spline of degree 5: as near as stated, as smooth as cubics can be, no more spans than that takes."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import BSpline

from app.core.errors import InputError
from app.fitting.point_curves.proven_curve import cubic_near
from app.model.motion import Nurbs
from tests.examples import examples


def quintic(seed: int, spans: int, size: float = 20.0) -> Nurbs:
    rng = np.random.default_rng(seed)
    knots = np.concatenate([np.zeros(6), np.sort(rng.random(spans - 1)) * 0.9 + 0.05, np.ones(6)])
    return Nurbs(rng.normal(0, size, (spans + 5, 3)), np.ones(spans + 5), knots, 5)


@settings(max_examples=examples(40), deadline=None)
@given(seed=st.integers(0, 10**6), spans=st.integers(1, 8), near=st.floats(1e-4, 1.0))
def test_ten_thousand_places_lie_as_near_as_is_stated(seed: int, spans: int, near: float) -> None:
    meant = quintic(seed, spans)
    found = cubic_near(meant, near)
    t = np.linspace(0, 1, 10_001)
    cubic, given_ = BSpline(found.knots, found.points, 3), BSpline(meant.knots, meant.points, 5)
    assert np.linalg.norm(cubic(t) - given_(t), axis=1).max() <= near + 1e-9
    assert found.degree == 3
    assert np.array_equal(found.points[[0, -1]], meant.points[[0, -1]])
    inner = found.knots[4:-4]
    assert len(np.unique(inner)) == len(inner), "every inner knot is single: smooth of the second order"
    for end in (0.0, 1.0):
        assert np.allclose(cubic(end, 1), given_(end, 1), rtol=1e-6, atol=1e-6 * np.abs(given_(end, 1)).max())


def test_twice_the_spans_are_sixteen_times_as_near() -> None:
    """The error of cubics goes with the fourth power of a span: so no more are taken than it takes."""
    spans = [len(np.unique(cubic_near(quintic(7, 3), near).knots)) - 1 for near in (1e-1, 1e-3, 1e-5)]
    assert spans[1] <= 4.5 * spans[0]
    assert spans[2] <= 4.5 * spans[1]


def test_nearer_than_rounding_is_told() -> None:
    with pytest.raises(InputError, match="degree 3"):
        cubic_near(quintic(1, 2), 1e-18)
