"""Boundaries of hatches in a DXF: every sort of edge, and never twice what is drawn anyway."""

import math
from typing import Any

import pytest

from app.formats.drawing import Drawing
from app.geometry.chaining.chain import chain
from app.geometry.outlines import nest
from app.geometry.primitives import contour_rows, signed_area
from app.model.curves import Circle, Ellipse, Line, Spline
from tests.formats.test_dxf_text import new, read, telling

SQUARE = [(0, 0), (40, 0), (40, 30), (0, 30)]
HOLE = [(10, 10), (20, 10), (20, 20), (10, 20)]


def hatched(*paths: Any, **attributes: Any) -> Any:
    document = new()
    hatch = document.modelspace().add_hatch(dxfattribs=attributes)
    for path in paths:
        hatch.paths.add_polyline_path(path)
    return document


def edged() -> Any:
    document = new()
    return document, document.modelspace().add_hatch().paths.add_edge_path()


def area(drawing: Drawing) -> float:
    """What the regions of a drawing hold, mm2."""
    regions = nest(chain(drawing.part.entities).contours)
    return sum(signed_area(contour_rows(contour)) for region in regions for contour in region.contours)


def test_a_hatch_with_a_hole_is_two_outlines_and_said() -> None:
    drawing = read(hatched(SQUARE, HOLE, layer="fill"))
    assert area(drawing) == pytest.approx(40 * 30 - 100)
    assert {entity.layer for entity in drawing.part.entities} == {"fill"}
    found = telling(drawing, "hatch")
    assert (
        found.text == "2 boundaries of hatches are read as outlines to machine; leave them out with --skip-type HATCH."
    )
    assert not found.counts


@pytest.mark.parametrize("kind", ["SOLID", "TRACE"])
def test_a_solid_is_an_outline_and_said(kind: str) -> None:
    """Its last two corners stand in each other's place; seen from below it is mirrored."""
    document = new()
    corners = [(0, 0), (40, 0), (0, 30), (40, 30)]
    add = document.modelspace().add_solid if kind == "SOLID" else document.modelspace().add_trace
    add(corners, {"layer": "fill", "extrusion": (0, 0, -1)})
    add([(-60, 0), (-70, 0), (-60, 10), (-60, 10)])
    drawing = read(document)
    assert area(drawing) == pytest.approx(40 * 30 + 50)
    assert min(entity.curve.start[0] for entity in drawing.part.entities) == -70
    assert [entity.layer for entity in drawing.part.entities] == ["fill"] * 4 + ["0"] * 3
    found = telling(drawing, "hatch")
    assert found.text == (
        f"2 boundaries of hatches are read as outlines to machine; leave them out with --skip-type {kind}."
    )


def test_a_solid_that_fills_what_is_drawn_is_not_taken_twice() -> None:
    document = new()
    document.modelspace().add_lwpolyline([(0, 0), (40, 0), (40, 30), (0, 30)], close=True)
    document.modelspace().add_solid([(0, 0), (40, 0), (0, 30), (40, 30)])
    drawing = read(document)
    assert len(drawing.part.entities) == 4 and "not taken twice" in telling(drawing, "hatch").text


def test_bulges_are_arcs() -> None:
    drawing = read(hatched([(0, 0, 1), (10, 0, 1)]))
    assert area(drawing) == pytest.approx(25 * math.pi)


@pytest.mark.parametrize("ccw", [True, False])
def test_edges_of_lines_and_arcs(ccw: bool) -> None:
    """A half disc of radius 5: the arc from 0 to 180 degrees, drawn either way, and its diameter."""
    document, path = edged()
    path.add_line((-5, 0), (5, 0))
    path.add_arc((0, 0), 5, 0, 180, ccw)
    assert area(read(document)) == pytest.approx(12.5 * math.pi)


def test_whole_circles_and_ellipses_are_what_they_are() -> None:
    document, path = edged()
    path.add_arc((1, 2), 5, 0, 360)
    document.modelspace()[0].paths.add_edge_path().add_ellipse((50, 0), (0, 10), 0.5, 0, 360)
    circle, ellipse = (entity.curve for entity in read(document).part.entities)
    assert circle == Circle((1, 2), 5) and isinstance(ellipse, Ellipse)
    assert math.hypot(*ellipse.major) == pytest.approx(10) and ellipse.ratio == pytest.approx(0.5)


def test_a_quarter_of_an_ellipse_and_its_axes() -> None:
    document, path = edged()
    path.add_ellipse((0, 0), (10, 0), 0.5, 0, 90)
    path.add_line((0, 5), (0, 0))
    path.add_line((0, 0), (10, 0))
    assert area(read(document)) == pytest.approx(10 * 5 * math.pi / 4, abs=1e-2)


@pytest.mark.parametrize("by_parameter", [False, True])
@pytest.mark.parametrize("ccw", [False, True])
def test_a_piece_of_an_ellipse_meets_what_is_beside_it(by_parameter: bool, ccw: bool) -> None:
    """Both ways of telling its ends are in use; the chord of parameters 0 and 60 degrees is one of an area known."""
    (document, path), turn = edged(), math.radians(60)
    end = 5 * math.cos(turn), 2 * math.sin(turn)
    told = 60.0 if by_parameter else math.degrees(math.atan2(end[1], end[0]))
    path.add_ellipse((0, 0), (5, 0), 0.4, 0, told, ccw)
    path.add_line(end, (5, 0))
    drawing = read(document)
    assert all(contour.closed for contour in chain(drawing.part.entities).contours)
    assert abs(area(drawing)) == pytest.approx(5 * (turn - math.sin(turn)), abs=1e-2)


def test_splines_by_control_points_and_by_fit_points() -> None:
    """A parabola over a chord of 20, its control point 10 high, holds two thirds of 20 x 5."""
    document, path = edged()
    path.add_spline(control_points=[(0, 0), (10, 10), (20, 0)], knot_values=[0, 0, 0, 1, 1, 1], degree=2)
    path.add_line((20, 0), (0, 0))
    assert area(read(document)) == pytest.approx(200 / 3, abs=1e-2)
    document, path = edged()
    path.add_spline(fit_points=[(0, 0), (10, 5), (20, 0)], knot_values=[0])
    path.add_line((20, 0), (0, 0))
    first, _ = (entity.curve for entity in read(document).part.entities)
    assert isinstance(first, Spline) and (first.start, first.end) == (pytest.approx((0, 0)), pytest.approx((20, 0)))


def test_seen_from_below_it_is_mirrored() -> None:
    drawing = read(hatched([(1, 0), (5, 0), (5, 3)], extrusion=(0, 0, -1)))
    assert drawing.part.entities[0].curve == Line((-1, 0), (-5, 0))


def test_in_a_block_it_goes_with_every_copy() -> None:
    document = new()
    document.blocks.new("B").add_hatch().paths.add_polyline_path(HOLE)
    for x in (0, 100):
        document.modelspace().add_blockref("B", (x, 0), dxfattribs={"xscale": 2, "layer": "outer"})
    drawing = read(document)
    assert area(drawing) == pytest.approx(400) and {entity.layer for entity in drawing.part.entities} == {"outer"}


def outlined(*paths: Any, shift: float = 0.0, **attributes: Any) -> Any:
    document = hatched(*paths)
    for ring in (SQUARE, HOLE):
        moved = [(x + shift, y) for x, y in ring]
        document.modelspace().add_lwpolyline(moved, close=True, dxfattribs=attributes)
    return document


@pytest.mark.parametrize("shift", [0.0, 1e-6, 0.009])
def test_a_boundary_on_drawn_curves_erases_nothing_and_is_said(shift: float) -> None:
    """Also one that goes the other way, begins elsewhere, and is off by less than loose ends are joined over."""
    drawing = read(outlined([SQUARE[2], SQUARE[1], SQUARE[0], SQUARE[3]], HOLE, shift=shift))
    assert len(drawing.part.entities) == 8 and area(drawing) == pytest.approx(1100)
    assert telling(drawing, "hatch").text == (
        "2 boundaries of hatches are drawn as curves too, and not taken twice; leave them out with --skip-type HATCH."
    )


def test_a_boundary_beside_drawn_curves_is_an_outline() -> None:
    drawing = read(outlined([(30, 10), (35, 10), (35, 15)], HOLE))
    assert area(drawing) == pytest.approx(1100 - 12.5)
    assert (
        "2 boundaries of hatches are read as outlines to machine, but for 1 drawn as curves too"
        in telling(drawing, "hatch").text
    )
    assert len(read(outlined(SQUARE, shift=0.02)).part.entities) == 12


def test_a_boundary_of_stretches_of_several_curves_adds_nothing() -> None:
    document = hatched([(10, 10), (20, 10), (20, 20), (10, 20)])
    for k in (10, 20):
        document.modelspace().add_line((0, k), (30, k))
        document.modelspace().add_line((k, 0), (k, 30))
    assert len(read(document).part.entities) == 4


def test_a_boundary_on_curves_that_are_not_machined_is_read() -> None:
    document = outlined(SQUARE, layer="hidden")
    document.layers.add("hidden").off()
    assert len(read(document).part.entities) == 12
    assert len(read(outlined(SQUARE, layer="edge"), without_layers=("edge",)).part.entities) == 4


def test_as_near_in_inches_and_far_from_zero() -> None:
    document = hatched([(x + 4e6, y) for x, y in SQUARE])
    document.header["$INSUNITS"] = 1
    document.modelspace().add_lwpolyline([(x + 4e6, y) for x, y in SQUARE], close=True)
    assert len(read(document, to_zero=True).part.entities) == 4


def test_left_out_as_asked_and_boxes_round_texts_always() -> None:
    document = outlined([(30, 10), (35, 10), (35, 15)])
    drawing = read(document, without_types=("hatch",))
    assert len(drawing.part.entities) == 8 and dict(drawing.left_out) == {"HATCH (as asked)": 1}
    document = new()
    paths = document.modelspace().add_hatch().paths
    paths.add_polyline_path(SQUARE)
    paths.add_polyline_path(HOLE, flags=8)
    assert len(read(document).part.entities) == 4


def test_a_hatch_of_nothing_has_no_length() -> None:
    document = hatched([(1, 1), (1, 1)])
    document.modelspace().add_circle((0, 0), 1)
    assert "1 entity has no length" in telling(read(document), "no length").text
