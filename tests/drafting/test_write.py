"""A drawing written in words is the same drawing when it is read."""

import math
from dataclasses import replace

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from app.core.errors import InputError
from app.drafting.curves.shapes import arc_of_radius
from app.drafting.document import Document
from app.drafting.language.write import draw_text
from app.model.curves import Arc, Circle, Curve, Ellipse, Line, Spline
from app.model.part import Entity, Layer, Part
from tests.part_shapes import fig2, layered_part

NUMBER = st.floats(-1000, 1000)
POINT = st.tuples(NUMBER, NUMBER)
SIZE = st.floats(0.01, 500)


def arc_about(centre: tuple[float, float], radius: float, first: float, sweep: float, ccw: bool) -> Arc:
    ends = [(centre[0] + radius * math.cos(t), centre[1] + radius * math.sin(t)) for t in (first, first + sweep)]
    return Arc(ends[0], ends[1], centre, ccw)


CURVE: st.SearchStrategy[Curve] = st.one_of(
    st.tuples(POINT, POINT).filter(lambda ends: math.dist(*ends) > 1e-3).map(lambda ends: Line(*ends)),
    st.builds(arc_about, POINT, SIZE, st.floats(0, 6), st.floats(0.1, 6), st.booleans()),
    st.builds(Circle, POINT, SIZE, st.booleans()),
    st.builds(
        Ellipse, POINT, st.tuples(SIZE, SIZE), st.floats(0.05, 1), st.floats(-7, 7), st.just(0.0), st.booleans()
    ).map(lambda e: replace(e, end_parameter=e.start_parameter + 2)),
    st.builds(Ellipse, POINT, st.tuples(SIZE, SIZE), st.floats(0.05, 1), ccw=st.booleans()),
    st.lists(POINT, min_size=4, max_size=4).map(lambda points: Spline(3, tuple(points), (0.0,) * 4 + (1.0,) * 4)),
    st.lists(POINT, min_size=3, max_size=3).map(
        lambda points: Spline(2, tuple(points), (0.0,) * 3 + (1.0,) * 3, (1.0, 0.5, 2.0))
    ),
)


def read_again(part: Part) -> Part:
    document = Document()
    document.run_script(draw_text(part).text)
    return document.part


def numbers(curve: Curve) -> list[float]:
    if isinstance(curve, Line):
        return [*curve.start, *curve.end]
    if isinstance(curve, Arc):
        return [*curve.start, *curve.end, *curve.centre]
    if isinstance(curve, Circle):
        return [*curve.centre, curve.radius]
    if isinstance(curve, Ellipse):
        return [*curve.centre, *curve.major, curve.ratio, curve.start_parameter, curve.end_parameter]
    return [*(c for p in curve.control_points for c in p), *curve.knots, *curve.weights]


@settings(deadline=None)
@given(st.lists(CURVE, min_size=1, max_size=6))
def test_every_curve_comes_back(curves: list[Curve]) -> None:
    part = Part().with_curves(curves, "0")
    again = read_again(part)
    assert [type(e.curve) for e in again.entities] == [type(c) for c in curves]
    for entity, curve in zip(again.entities, curves, strict=True):
        assert numbers(entity.curve) == pytest.approx(numbers(curve), rel=1e-12, abs=1e-9)
        assert getattr(entity.curve, "ccw", True) == getattr(curve, "ccw", True)
        if not isinstance(curve, Ellipse):
            assert entity.curve == curve


@settings(deadline=None)
@given(POINT, POINT, st.floats(0.5, 50, exclude_min=True), st.booleans(), st.booleans())
def test_what_is_drawn_by_a_radius_comes_back_to_the_last_digit(
    start: tuple[float, float], end: tuple[float, float], share: float, ccw: bool, large: bool
) -> None:
    assume(math.dist(start, end) > 1e-3)
    radius = share * math.dist(start, end)
    part = Part().with_curves([arc_of_radius(start, end, radius, ccw, large)], "0")
    assert read_again(part).entities == part.entities


def test_layers_come_back_with_their_looks_and_order() -> None:
    layers = (Layer("b"), Layer('a "quoted" name #1;', "#d55e00", visible=False), Layer("c", locked=True))
    entities = (Entity(1, Circle((0, 0), 1), "c"), Entity(2, Circle((0, 0), 2), "b"), Entity(3, Circle((0, 0), 3), "b"))
    again = read_again(Part(entities, layers))
    assert again.entities == entities
    assert [layer for layer in again.layers if layer.name != "0"] == [
        replace(layer, name=layer.name.replace('"', "'")) for layer in layers
    ]


def test_the_first_layer_comes_back_in_its_place() -> None:
    layers = (Layer("b"), Layer("a", "#d55e00"), Layer("0"), Layer("c"))
    part = Part((Entity(1, Circle((0, 0), 1), "0"), Entity(2, Circle((0, 0), 2), "b")), layers)
    assert read_again(part) == part


def test_the_sample_part_comes_back_exactly() -> None:
    part = layered_part({"0": fig2()})
    again = read_again(part)
    assert [e.curve for e in again.entities] == [e.curve for e in part.entities]


def test_curves_too_small_to_be_drawn_are_counted() -> None:
    written = draw_text(Part().with_curves([Line((0, 0), (0, 0)), Circle((1, 1), 0.0), Line((0, 0), (1, 0))], "0"))
    assert written.left_out == 2
    assert written.text.count("\n") == 3


def test_a_layer_that_is_not_there_has_no_looks() -> None:
    with pytest.raises(InputError, match="There is no layer holes; the drawing has 0"):
        Document().run("hide holes")
    with pytest.raises(InputError, match="is no colour"):
        Document().run("colour 0 red")
