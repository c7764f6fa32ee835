"""Closed splines of a DXF that are given by fit points alone."""

import numpy as np
import pytest

from app.formats.readers import read_drawing
from app.geometry.sample import sample
from app.model.curves import Spline


def spline(points: list[tuple[float, float]], flags: int) -> Spline:
    fit = "".join(f"11\n{x!r}\n21\n{y!r}\n31\n0\n" for x, y in points)
    entity = f"0\nSPLINE\n8\n0\n70\n{flags}\n71\n3\n74\n{len(points)}\n{fit}"
    text = f"0\nSECTION\n2\nENTITIES\n{entity}0\nENDSEC\n0\nEOF\n"
    (found,) = read_drawing("x.dxf", text.encode()).part.entities
    assert isinstance(found.curve, Spline)
    return found.curve


ROUND = [(20 * float(np.cos(angle)), 20 * float(np.sin(angle))) for angle in np.arange(12) * np.pi / 6]


@pytest.mark.parametrize("points", [ROUND, [*ROUND, ROUND[0]]])
def test_a_closed_one_goes_on_smoothly_where_it_began(points: list[tuple[float, float]]) -> None:
    found = spline(points, 1 + 8)
    assert found.start == found.end
    radii = np.hypot(*np.array(sample(found)).T)
    assert np.abs(radii - 20).max() < 0.01  # as round where it begins as elsewhere
    before, at, after = np.array([found.control_points[k] for k in (-2, 0, 1)])
    (ax, ay), (bx, by) = at - before, after - at
    assert abs(ax * by - ay * bx) < 1e-9


def test_one_that_is_not_closed_ends_at_its_last_point() -> None:
    found = spline(ROUND, 8)
    assert np.allclose(found.end, ROUND[-1])
