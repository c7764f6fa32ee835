"""Where ways from a point stand square on ellipses and splines, or touch them: to 1e-9, and none is missed."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.drafting.curves.intersections import nearest_point, tangent_points
from app.drafting.curves.perpendiculars import perpendicular_feet, spline_tangents
from app.drafting.curves.shapes import spline_through
from app.drafting.document import Document
from app.geometry.sample import spline_points
from app.model.curves import Arc, Ellipse, Line, Point, Spline

POINT = st.tuples(st.floats(-60, 60), st.floats(-60, 60))
WAVE = spline_through([(0.0, 0.0), (10.0, 12.0), (25.0, -6.0), (40.0, 5.0)])
QUARTER = Spline(2, ((10.0, 0.0), (10.0, 10.0), (0.0, 10.0)), (0.0,) * 3 + (1.0,) * 3, (1.0, math.sqrt(0.5), 1.0))
"""A quarter of a circle of radius 10 about zero."""


def turns(curve: Spline, base: Point, square: bool) -> int:
    """How often the product of way and chord changes its sign over 4,000 chords."""
    points = spline_points(curve, np.linspace(curve.knots[0], curve.knots[-1], 4001))
    way, along = (points[1:] + points[:-1]) / 2 - base, np.diff(points, axis=0)
    product = (way * along).sum(axis=1) if square else way[:, 0] * along[:, 1] - way[:, 1] * along[:, 0]
    return int(np.count_nonzero(product[1:] * product[:-1] < 0))


@settings(deadline=None)
@given(POINT)
def test_of_a_quarter_circle_the_places_are_those_of_the_arc(base: Point) -> None:
    away, arc = math.hypot(*base), Arc((10, 0), (0, 10), (0, 0))
    touched = tangent_points(arc, base)
    if abs(away - 10) > 0.1 and all(min(p) > 0.01 for p in touched):
        found = spline_tangents(QUARTER, base)
        assert len(found) == len(touched) and np.allclose(sorted(found), sorted(touched), rtol=0, atol=1e-9)
    if away > 0.1 and base[0] * base[1] > 0.1:
        square = 10 / away * abs(base[0]), 10 / away * abs(base[1])
        assert perpendicular_feet(QUARTER, base) == [pytest.approx(square, abs=1e-9)]


@settings(deadline=None)
@given(POINT)
def test_no_place_of_a_spline_is_missed_and_each_lies_on_it(base: Point) -> None:
    for found, square in ((perpendicular_feet(WAVE, base), True), (spline_tangents(WAVE, base), False)):
        assert len(found) >= turns(WAVE, base, square)
        assert all(math.dist(nearest_point(WAVE, p), p) < 1e-7 for p in found)
    nearest = nearest_point(WAVE, base)
    if (
        nearest not in (WAVE.start, WAVE.end)
        and min(math.dist(nearest, WAVE.start), math.dist(nearest, WAVE.end)) > 1e-3
    ):
        assert min(math.dist(nearest, p) for p in perpendicular_feet(WAVE, base)) < 1e-6


@settings(deadline=None)
@given(POINT, st.floats(0, 6), st.floats(0.1, 1))
def test_ways_stand_square_on_an_ellipse(base: Point, turn: float, ratio: float) -> None:
    curve = Ellipse((3.0, -2.0), (20 * math.cos(turn), 20 * math.sin(turn)), ratio)
    found = perpendicular_feet(curve, base)
    assert len(found) >= 2, "the nearest and the farthest point"
    for x, y in found:
        dx, dy = x - 3, y + 2
        u, v = dx * math.cos(turn) + dy * math.sin(turn), dy * math.cos(turn) - dx * math.sin(turn)
        assert (u / 20) ** 2 + (v / 20 / ratio) ** 2 == pytest.approx(1, abs=1e-12)
        normal = complex(u, v / ratio**2) * complex(math.cos(turn), math.sin(turn))
        way = complex(x - base[0], y - base[1])
        assert abs((normal.conjugate() * way).imag) <= 2e-9 * abs(normal) * max(abs(way), 1)


def test_a_kink_is_no_place_to_touch() -> None:
    kinked = Spline(1, ((0.0, 0.0), (10.0, 0.0), (10.0, 10.0)), (0.0, 0.0, 1.0, 2.0, 2.0))
    assert perpendicular_feet(kinked, (12.0, -3.0)) == []
    assert np.allclose(perpendicular_feet(kinked, (4.0, 3.0)), [(4.0, 0.0), (10.0, 3.0)], rtol=0, atol=1e-12)


def test_words_know_the_tangents_of_splines() -> None:
    document = Document()
    document.run_script("spline 0,0 10,12 25,-6 40,5 as s\nline -20,8 tangent((-20,8), s, 10,12)")
    line = document.part.entities[1].curve
    assert isinstance(line, Line) and line.end in spline_tangents(WAVE, (-20.0, 8.0))
