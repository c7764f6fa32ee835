"""Similarities: what they do to points they do to every point of every curve."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.core.errors import InputError
from app.drafting.curves.shapes import middle_of
from app.drafting.document import Document
from app.geometry.sample import bounds
from app.geometry.transform import Similarity, mirroring, scaling, shift, transformed, turn
from app.model.curves import Arc, Circle, Curve, Ellipse, Line, Spline

CURVES: tuple[Curve, ...] = (
    Line((1, 2), (5, -3)),
    Arc((5, 0), (0, 5), (0, 0)),
    Arc((5, 0), (0, 5), (0, 0), ccw=False),
    Circle((3, 4), 2),
    Circle((3, 4), 2, ccw=False),
    Ellipse((1, 1), (4, 1), 0.4),
    Ellipse((1, 1), (4, 1), 0.4, 0.3, 2.5),
    Ellipse((1, 1), (4, 1), 0.4, 0.3, 2.5, ccw=False),
    Spline(2, ((0, 0), (3, 5), (6, -1), (9, 2)), (0, 0, 0, 0.5, 1, 1, 1), (1, 2, 1, 1)),
)
COORDINATE = st.floats(-50, 50).map(lambda v: round(v, 3))
POINT = st.tuples(COORDINATE, COORDINATE)
SIMILARITY = st.one_of(
    POINT.map(shift),
    st.builds(turn, POINT, st.floats(-400, 400)),
    st.builds(scaling, POINT, st.floats(0.1, 10)),
    st.builds(
        lambda p, turned: mirroring(p, (p[0] + math.cos(turned), p[1] + math.sin(turned))), POINT, st.floats(0, 6)
    ),
)


@given(SIMILARITY, SIMILARITY, st.sampled_from(CURVES))
def test_every_point_of_a_curve_goes_where_points_go(first: Similarity, second: Similarity, curve: Curve) -> None:
    both = first.then(second)
    moved = transformed(curve, both)
    if isinstance(curve, Circle):  # a circle has no beginning
        assert isinstance(moved, Circle)
        meant = [(*second(first(curve.centre)), curve.radius * both.scale)]
        got = [(*moved.centre, moved.radius)]
        assert moved.ccw is (curve.ccw != both.mirrored)
    else:
        meant = [second(first(p)) for p in (curve.start, middle_of(curve), curve.end)]
        got = [moved.start, middle_of(moved), moved.end]
    assert np.array(got) == pytest.approx(np.array(meant), abs=1e-8)


def test_quarter_turns_are_exact() -> None:
    assert transformed(Line((3, 1), (7, 2)), turn((1, 1), 90)) == Line((1, 3), (0, 7))
    assert transformed(Line((3, 1), (7, 2)), turn((1, 1), -180)) == Line((-1, 1), (-5, 0))


def test_what_is_no_similarity_is_refused() -> None:
    with pytest.raises(InputError, match="greater than 0"):
        scaling((0, 0), 0)
    with pytest.raises(InputError, match="two different points"):
        mirroring((1, 1), (1, 1))


@pytest.mark.parametrize("drawn", ["rect 0,0 60,40", "circle 0,0 5", "ellipse 0,0 @10,0 5", "spline 0,0 1,1 2,0 3,1"])
def test_scaling_again_and_again_ends_in_a_refusal_and_not_in_no_number(drawn: str) -> None:
    document = Document()
    document.run(drawn)
    document.run("select all")
    with pytest.raises(InputError, match="a drawing reaches"):
        for _ in range(60):
            document.run("scale 0,0 1e6")
    assert all(math.isfinite(value) for entity in document.part.entities for value in bounds(entity.curve))
