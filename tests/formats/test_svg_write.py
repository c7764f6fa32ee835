"""SVG out and in again: the same coordinates, layers, colours; what SVG cannot hold is within the tolerance and
counted.
"""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.formats.svg.svg import read_svg
from app.formats.svg.write import svg_bytes
from app.geometry.arcs.bezier import pieces_of
from app.model.curves import Arc, Circle, Curve, Ellipse, Line, Spline
from app.model.part import Entity, Layer, Part
from tests.examples import examples
from tests.formats.drawn_parts import apart, arc, arcs, circles, clamped, lines, parts, parts_of, splines, wholes
from tests.primitive_distance import distances

SAME = 1e-9
exact = st.one_of(lines, arcs, circles, wholes, parts_of, splines((2, 3)))


def back(part: Part) -> Part:
    return read_svg(svg_bytes(part).data, "part.svg").part


def drawn(*curves: Curve) -> Part:
    return Part(tuple(Entity(k, curve) for k, curve in enumerate(curves, 1)))


@given(parts(exact))
@settings(max_examples=examples(300), deadline=None)
def test_out_and_in_again(part: Part) -> None:
    written = svg_bytes(part)
    again = read_svg(written.data, "part.svg").part
    assert not written.converted
    assert again.layers == part.layers
    for layer in part.layers:
        before = [e.curve for e in part.entities if e.layer == layer.name]
        after = [e.curve for e in again.entities if e.layer == layer.name]
        assert len(before) == len(after)
        assert max((apart(a, b) for a, b in zip(before, after, strict=True)), default=0.0) <= SAME


@given(splines((2, 3), rational=True) | splines((4, 5)))
@settings(max_examples=examples(30), deadline=None)
def test_what_svg_cannot_hold_is_within_the_tolerance_and_counted(spline: Spline) -> None:
    written = svg_bytes(drawn(spline, spline), 0.005)
    (converted,) = written.converted
    assert (converted.kind, converted.count) == ("spline", 2) and 0 < converted.deviation <= 0.005
    after = [e.curve for e in read_svg(written.data).part.entities]
    assert all(isinstance(curve, Line | Arc) for curve in after) and len(after) % 2 == 0
    assert after[0].start == pytest.approx(spline.start, abs=SAME) and after[-1].end == pytest.approx(
        spline.end, abs=SAME
    )
    assert max(distances_of(spline, after)) <= 0.005


def distances_of(spline: Spline, chain: list[Curve]) -> list[float]:
    points, _ = pieces_of(spline).at(np.linspace(0, len(pieces_of(spline)), 200))
    return [float(d) for d in distances(points, chain)]  # type: ignore[arg-type]


def test_degree_one_is_lines() -> None:
    zigzag = Spline(1, ((0, 0), (1, 1), (2, 0)), (0, 0, 1, 2, 2), (1, 3, 1))
    written = svg_bytes(drawn(zigzag))
    assert [e.curve for e in read_svg(written.data).part.entities] == [Line((0, 0), (1, 1)), Line((1, 1), (2, 0))]
    assert not written.converted


def test_coordinates_come_back_to_the_last_digit() -> None:
    curves = [
        Line((-1 / 3, 2 / 3), (-100.1, -7e-5)),
        Circle((-50.3, -1 / 7), 0.1),
        Line((1e5, 2e-9), (0.1 + 0.2, 1e-7 / 3)),
    ]
    assert [e.curve for e in back(drawn(*curves)).entities] == curves


def test_every_direction_of_a_circle_comes_back() -> None:
    first, second = (e.curve for e in back(drawn(Circle((1, 2), 3, True), Circle((10, -2), 3, False))).entities)
    assert first == Circle((1, 2), 3) and isinstance(second, Circle)
    assert not second.ccw and apart(second, Circle((10, -2), 3)) < SAME


def test_curves_that_follow_one_another_are_one_closed_path() -> None:
    slot = [Line((0, 0), (10, 0)), Arc((10, 0), (10, 4), (10, 2)), Line((10, 4), (0, 4)), Arc((0, 4), (0, 0), (0, 2))]
    written = svg_bytes(drawn(*slot)).data
    assert written.count(b"<path") == 1 and written.count(b"Z") == 1
    assert all(
        apart(e.curve, drawn_one) < SAME for e, drawn_one in zip(read_svg(written).part.entities, slot, strict=True)
    )


def test_neighbours_that_would_become_one_stay_two() -> None:
    bezier = [clamped(3, [(x, 0), (x + 1, 2), (x + 2, -2), (x + 3, 0)]) for x in (0.0, 3.0)]
    halves = [Arc((0, 0), (2, 0), (1, 0)), Arc((2, 0), (0, 0), (1, 0))]
    whole = Ellipse((20, 0), (5, 0), 0.5, 0.0, 1.0)
    quarters = [whole, Ellipse((20, 0), (5, 0), 0.5, 1.0, 2.0)]
    for curves in (bezier, halves, quarters):
        assert len(back(drawn(*curves)).entities) == 2


def test_layers_are_inkscapes_and_any_name_holds() -> None:
    layers = (Layer('<a & "b">', "#ff8000"), Layer("加工 1", "", False), Layer("b\x07d", "#000001", True, True))
    part = Part(tuple(Entity(k, Line((0, k), (1, k)), layer.name) for k, layer in enumerate(layers, 1)), layers)
    text = svg_bytes(part).data.decode()
    assert text.count('inkscape:groupmode="layer"') == 3 and "display:none" in text
    again = read_svg(text.encode()).part
    assert again.layers[:2] == layers[:2] and again.layers[2] == Layer("b_d", "#000001", True, True)
    assert [e.curve for e in again.entities] == [e.curve for e in part.entities]


def test_the_page_holds_the_part_at_true_size() -> None:
    text = svg_bytes(drawn(Circle((-20, -30), 5), Arc((0, 0), (10, 0), (5, 0), False))).data.decode()
    assert 'width="37mm" height="42mm" viewBox="-26 -6 37 42"' in text


def test_an_empty_part_is_a_page_and_an_orphan_keeps_its_layer() -> None:
    assert b"<svg" in svg_bytes(Part()).data
    orphan = Part((Entity(1, Line((0, 0), (1, 0)), "lost"),), ())
    assert back(orphan).entities[0].layer == "lost"


@pytest.mark.parametrize("ratio", [1e-2, 1e-3, 1e-5, 1e-7])
@pytest.mark.parametrize("ccw", [True, False])
def test_flat_ellipses_are_as_exact_as_round_ones(ratio: float, ccw: bool) -> None:
    for first, last in ((0.3, 1.0), (-2.0, 2.5), (0.0, math.tau)):
        curve = Ellipse((-700.1, 300.3), (-3000.0, 1700.0), ratio, first, last, ccw)
        (again,) = (e.curve for e in back(drawn(curve)).entities)
        assert isinstance(again, Ellipse) and apart(curve, again) < SAME
        assert again.ccw is ccw or last == math.tau


@pytest.mark.parametrize("radius", [1.0, 1000.0])
def test_an_arc_that_is_nearly_a_circle_keeps_its_centre(radius: float) -> None:
    curve = arc((512.3, -733.1), radius, 0.7, math.tau - 1e-4)
    (again,) = (e.curve for e in back(drawn(curve)).entities)
    assert apart(curve, again) < SAME


def test_a_half_turn_keeps_its_centre() -> None:
    """From a radius and two ends the centre of a half circle comes back to 8 digits only; so it is drawn in two
    parts.
    """
    half = Arc((-7.1, 3.3), (12.7, 3.3), (2.8, 3.3))
    (again,) = (e.curve for e in back(drawn(half)).entities)
    assert isinstance(again, Arc) and math.dist(again.centre, half.centre) < 1e-12
