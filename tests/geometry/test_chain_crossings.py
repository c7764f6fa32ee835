"""Where contours cross and touch: every pair of kinds, at ends and between, against places known in closed form."""

import math
from collections.abc import Sequence

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from app.geometry.chaining.chain import chain, crossings
from app.model.curves import Arc, Circle, Curve, Line, Point, Primitive
from app.model.finding import Finding
from app.model.part import Contour, Entity
from tests.examples import examples


def contour(*primitives: Primitive) -> Contour:
    return Contour(primitives, primitives[0].start == primitives[-1].end, entity_ids=(1,))


def polygon(points: Sequence[Point]) -> Contour:
    return contour(*(Line(a, b) for a, b in zip(points, [*points[1:], points[0]], strict=True)))


SQUARE = polygon([(0, 0), (10, 0), (10, 10), (0, 10)])


def only(contours: Sequence[Contour]) -> Finding:
    (found,) = crossings(contours)
    return found


def test_apart_or_inside_is_no_finding() -> None:
    assert crossings([SQUARE, contour(Circle((5, 5), 4)), contour(Circle((30, 5), 4))]) == []


def test_smooth_outline_does_not_meet_itself() -> None:
    slot = contour(
        Line((0, 0), (10, 0)), Arc((10, 0), (10, 4), (10, 2)), Line((10, 4), (0, 4)), Arc((0, 4), (0, 0), (0, 2))
    )
    assert crossings([slot]) == []


@pytest.mark.parametrize("lift", [3e-5, -3e-5])
def test_joints_that_are_smooth_but_for_rounding(lift: float) -> None:
    arc = Arc((10, lift), (10, 4 - lift), (10, 2))
    slot = contour(Line((0, 0), (10, lift)), arc, Line((10, 4 - lift), (0, 4)), Arc((0, 4), (0, 0), (0, 2)))
    assert crossings([slot]) == []
    tilted = contour(Line((0, 10 * lift), (10, 0)), Arc((10, 0), (10, 4), (10, 2)), Line((10, 4), (0, 10 * lift)))
    assert crossings([tilted]) == []


def test_lines_cross() -> None:
    found = only([SQUARE, polygon([(5, 5), (15, 5), (15, 15), (5, 15)])])
    assert found.counts and found.amount == 2
    assert "The contour on layer 0, 10 x 10 mm from (0.000, 0.000), and the contour" in found.text
    assert "and the contour on layer 0, 10 x 10 mm from (5.000, 5.000), cross at" in found.text
    assert "(10.000, 5.000)" in found.text and "(5.000, 10.000)" in found.text


def test_figure_eight_crosses_itself() -> None:
    found = only([polygon([(0, 0), (10, 10), (10, 0), (0, 10)])])
    assert found.counts and (found.x, found.y) == pytest.approx((5, 5)) and "crosses itself" in found.text


@pytest.mark.parametrize(
    ("circle", "places"), [(Circle((5, 0), 2), 2), (Circle((10, 10), 3), 2), (Circle((5, 5), 6), 8)]
)
def test_line_and_circle(circle: Circle, places: int) -> None:
    found = only([SQUARE, contour(circle)])
    assert found.counts and found.amount == places


def test_circles_cross_in_two_places() -> None:
    found = only([contour(Circle((0, 0), 5)), contour(Circle((6, 0), 5))])
    assert found.counts and found.amount == 2 and found.x == pytest.approx(3) and abs(found.y or 0) == pytest.approx(4)


@pytest.mark.parametrize("other", [Circle((5, -3), 3), Circle((5, 3), 3)], ids=["outside", "inside"])
def test_tangent_circle_touches(other: Circle) -> None:
    found = only([SQUARE, contour(other)])
    assert not found.counts and (found.x, found.y) == pytest.approx((5, 0), abs=1e-5)


def test_circle_that_dips_in_by_less_than_a_micrometre_touches() -> None:
    assert not only([SQUARE, contour(Circle((5, -3 + 5e-4), 3))]).counts
    assert only([SQUARE, contour(Circle((5, -3 + 0.01), 3))]).counts


def test_corner_on_an_edge_touches() -> None:
    assert not only([SQUARE, polygon([(10, 5), (20, 0), (20, 10)])]).counts


def test_crossing_through_corners_is_a_crossing() -> None:
    """Both pass through (10, 10), one from inside the other to outside."""
    found = crossings([SQUARE, polygon([(10, 10), (5, 5), (20, 2), (30, 30)])])
    assert any(f.counts for f in found)
    touching = polygon([(10, 10), (20, 12), (12, 20)])
    assert not only([SQUARE, touching]).counts


def test_end_of_an_open_contour_on_an_edge_touches() -> None:
    assert not only([SQUARE, contour(Line((10, 5), (20, 5)))]).counts
    assert only([SQUARE, contour(Line((9, 5), (20, 5)))]).counts


def test_arc_of_a_contour_may_meet_its_neighbour_again() -> None:
    arc = Arc((0, 0), (9, -3), (5, 0), False)
    found = only([contour(Line((10, 2), (0, 0)), arc)])
    assert found.counts


@settings(max_examples=examples(60), deadline=None)
@given(st.lists(st.tuples(st.integers(-20, 20), st.integers(-20, 20)), min_size=3, max_size=9, unique=True))
def test_agrees_with_another_library_on_polygons(points: list[tuple[int, int]]) -> None:
    """A ring that shapely calls simple has no finding, and one that is not has one."""
    ring = [(x + 0.37 * math.sin(3 * k), y + 0.41 * math.cos(5 * k)) for k, (x, y) in enumerate(points)]
    found = crossings([polygon(ring)])
    assert bool(found) == (not shapely.LinearRing(ring).is_simple)


def test_concentric_circles_are_no_burden() -> None:
    circles: list[Curve] = [Circle((0, 0), 1 + 0.1 * k) for k in range(300)]
    assert chain([Entity(k, c) for k, c in enumerate(circles, 1)]).findings == ()


def test_random_circles_agree_with_closed_form() -> None:
    rng = np.random.default_rng(4)
    circles = [Circle((float(x), float(y)), float(r)) for x, y, r in rng.uniform((0, 0, 1), (60, 60, 9), (40, 3))]
    expected = sum(
        abs(a.radius - b.radius) < math.dist(a.centre, b.centre) < a.radius + b.radius
        for k, a in enumerate(circles)
        for b in circles[:k]
    )
    found = crossings([contour(c) for c in circles])
    assert all(f.counts for f in found)
    total = len(found) if len(found) <= 20 else 20 + int(found[-1].amount or 0)
    assert total == expected
