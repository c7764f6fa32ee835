"""The stock reaches as far as the part's arcs really do, plus its margin; the work origin sits on it."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.core.errors import ParameterError
from app.model.curves import Arc, Circle, Line
from app.model.job import Job, OriginXY, OriginZ, Stock
from app.model.part import Contour, Part, Region
from app.model.stock_box import extent, stock_box, work_origin

HALF_DISC = Region(1, Contour((Arc((10.0, 0.0), (-10.0, 0.0), (0.0, 0.0)), Line((-10.0, 0.0), (10.0, 0.0)))))


def test_extent_of_nothing() -> None:
    assert extent(()) is None


def test_an_arc_reaches_beyond_its_ends() -> None:
    assert extent([HALF_DISC.boundary]) == pytest.approx((-10, 0, 10, 10))


def test_the_same_arc_clockwise_reaches_the_other_way() -> None:
    assert extent([Contour((Arc((10.0, 0.0), (-10.0, 0.0), (0.0, 0.0), ccw=False),))]) == pytest.approx(
        (-10, -10, 10, 0)
    )


def test_a_circle() -> None:
    assert extent([Contour((Circle((3.0, 4.0), 2.0),))]) == (1, 2, 5, 6)


@given(st.floats(-3.1, 3.1), st.floats(0.01, 6.2), st.booleans())
def test_an_arc_is_in_its_extent_and_touches_it(angle: float, sweep: float, ccw: bool) -> None:
    turn = sweep if ccw else -sweep
    points = [(5 * math.cos(angle + turn * k / 2000), 5 * math.sin(angle + turn * k / 2000)) for k in range(2001)]
    box = extent([Contour((Arc(points[0], points[-1], (0.0, 0.0), ccw),))])
    xs, ys = zip(*points, strict=True)
    assert box == pytest.approx((min(xs), min(ys), max(xs), max(ys)), abs=1e-4)


@pytest.mark.parametrize(
    ("xy", "z", "origin"),
    [
        (OriginXY.DRAWING, OriginZ.TOP, (0, 0, 0)),
        (OriginXY.LOWER_LEFT, OriginZ.BOTTOM, (-12, -2, -8)),
        (OriginXY.CENTRE, OriginZ.TOP, (0, 5, 0)),
    ],
)
def test_stock_and_origin(xy: OriginXY, z: OriginZ, origin: tuple[float, float, float]) -> None:
    job = Job(Part(), stock=Stock(2.0, 8.0), origin_xy=xy, origin_z=z)
    box = stock_box(job, [HALF_DISC])
    assert box.size == pytest.approx((24, 14, 8))
    assert work_origin(job, box) == pytest.approx(origin)


def test_no_region_no_stock() -> None:
    with pytest.raises(ParameterError, match="no closed contour"):
        stock_box(Job(Part()), [])
