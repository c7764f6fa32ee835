"""DXF in: every kind of entity, units, layers, and what is left out."""

import io
import math
from collections.abc import Callable
from typing import Any

import ezdxf
import pytest

from app.core.errors import InputError
from app.formats.drawing import Drawing
from app.formats.dxf.dxf import read_dxf
from app.formats.readers import read_drawing
from app.model.curves import Arc, Circle, Curve, Ellipse, Line, Spline
from app.model.finding import FindingKind
from app.model.notes import Mark
from app.model.part import Units

Draw = Callable[[Any], object]


def bytes_of(document: Any) -> bytes:
    stream = io.StringIO()
    document.write(stream)
    return stream.getvalue().encode(document.output_encoding, "surrogateescape")


def drawn(draw: Draw, version: str = "R2010", units: int | None = 4) -> bytes:
    document = ezdxf.new(version)
    if units is not None:
        document.header["$INSUNITS"] = units
    draw(document.modelspace())
    return bytes_of(document)


def read(draw: Draw, **header: Any) -> Drawing:
    return read_dxf(drawn(draw, **header), "part.dxf")


def curves(draw: Draw, **header: Any) -> list[Curve]:
    return [entity.curve for entity in read(draw, **header).part.entities]


def test_line_circle_and_arc() -> None:
    def draw(space: Any) -> None:
        space.add_line((1, 2), (3, 4))
        space.add_circle((5, 6), 7)
        space.add_arc((0, 0), 10, 350, 80)

    line, circle, arc = curves(draw)
    assert line == Line((1, 2), (3, 4)) and circle == Circle((5, 6), 7)
    assert isinstance(arc, Arc) and arc.ccw and arc.centre == (0, 0) and arc.sweep == pytest.approx(math.pi / 2)
    assert arc.start == pytest.approx((10 * math.cos(math.radians(350)), 10 * math.sin(math.radians(350))))


def test_arc_of_a_full_turn_is_a_circle() -> None:
    assert curves(lambda space: space.add_arc((0, 0), 10, 30, 390)) == [Circle((0, 0), 10)]


def test_an_arc_whose_ends_all_but_meet_is_no_point() -> None:
    (arc,) = curves(lambda space: space.add_arc((0, 0), 1, 30, 389.99996))
    assert (
        isinstance(arc, Arc) and arc.sweep == pytest.approx(math.tau, abs=1e-6) and math.dist(arc.start, arc.end) < 1e-6
    )


@pytest.mark.parametrize("version", ["R12", "R2000", "R2018"])
def test_polyline_with_bulges(version: str) -> None:
    points = [(0, 0, 0), (10, 0, 1), (10, 4, 0), (0, 4, -0.5)]

    def draw(space: Any) -> None:
        add = space.add_polyline2d if version == "R12" else space.add_lwpolyline
        add(points, format="xyb", close=True)

    a, b, c, d = curves(draw, version=version)
    assert a == Line((0, 0), (10, 0)) and c == Line((10, 4), (0, 4))
    assert isinstance(b, Arc) and b.ccw and b.centre == pytest.approx((10, 2)) and b.radius == pytest.approx(2)
    assert isinstance(d, Arc) and not d.ccw and d.sweep == pytest.approx(-4 * math.atan(0.5))
    assert (d.start, d.end) == ((0, 4), (0, 0))


def test_repeated_vertices_are_passed_over() -> None:
    points = [(0, 0), (0, 0), (5, 0), (5, 0), (5, 5)]
    assert curves(lambda space: space.add_lwpolyline(points)) == [Line((0, 0), (5, 0)), Line((5, 0), (5, 5))]


def test_ellipse_and_part_of_one() -> None:
    def draw(space: Any) -> None:
        space.add_ellipse((1, 2), (10, 0), 0.5)
        space.add_ellipse((0, 0), (0, 10), 0.3, 0.5, 2.0)
        space.add_ellipse((0, 0), (0, 10), 0.3, 2.0, 0.5)

    full, part, rest = curves(draw)
    assert isinstance(full, Ellipse) and full.centre == (1, 2) and full.ratio == pytest.approx(0.5)
    assert full.end_parameter - full.start_parameter == pytest.approx(math.tau)
    assert isinstance(part, Ellipse) and isinstance(rest, Ellipse)
    assert part.start == pytest.approx((-3 * math.sin(0.5), 10 * math.cos(0.5)))
    assert part.end == pytest.approx(rest.start) and rest.end == pytest.approx(part.start)


def test_splines_of_every_sort() -> None:
    points = [(0, 0), (10, 20), (30, -10), (40, 10), (60, 0)]

    def draw(space: Any) -> None:
        space.add_open_spline([(*p, 0) for p in points])
        space.add_rational_spline([(*p, 0) for p in points], [1, 2, 1, 0.5, 1])
        space.add_spline(points)
        space.add_spline().set_closed([(*p, 0) for p in points])

    plain, rational, fitted, closed = curves(draw)
    assert all(isinstance(c, Spline) for c in (plain, rational, fitted, closed))
    assert isinstance(plain, Spline) and plain.control_points == tuple(points) and plain.weights == ()
    assert isinstance(rational, Spline) and rational.weights == pytest.approx((1, 2, 1, 0.5, 1))
    assert fitted.start == pytest.approx((0, 0)) and fitted.end == pytest.approx((60, 0))
    assert closed.start == pytest.approx(closed.end)


def test_unclamped_spline_keeps_its_shape() -> None:
    """Its ends lie where de Boor's rule puts them, not on the outer control points."""
    from scipy.interpolate import BSpline

    points = [(0, 0), (10, 20), (30, -10), (40, 10), (60, 0), (70, 30)]
    knots = [0, 1, 2, 3, 4.5, 5, 7, 8, 9, 10]

    def draw(space: Any) -> None:
        spline = space.add_spline()
        spline.dxf.degree = 3
        spline.control_points = [(*p, 0) for p in points]
        spline.knots = knots

    (curve,) = curves(draw)
    assert isinstance(curve, Spline)
    mine = BSpline(curve.knots, curve.control_points, 3)
    theirs = BSpline(knots, points, 3)
    for share in (0.0, 0.1, 0.37, 0.8, 1.0):
        at = curve.knots[0] + share * (curve.knots[-1] - curve.knots[0])
        assert mine(at) == pytest.approx(theirs(3 + share * (7 - 3)), abs=1e-9)
    assert curve.start == pytest.approx(tuple(theirs(3.0)))


def test_view_from_below_mirrors() -> None:
    """Extrusion (0, 0, -1): x runs the other way, arcs turn the other way in space."""
    below = {"extrusion": (0, 0, -1)}

    def draw(space: Any) -> None:
        space.add_circle((5, 6), 2, dxfattribs=below)
        space.add_arc((5, 0), 2, 0, 90, dxfattribs=below)
        space.add_lwpolyline([(0, 0), (3, 0)], dxfattribs=below)
        space.add_line((1, 1), (2, 1), dxfattribs=below)

    circle, arc, side, line = curves(draw)
    assert isinstance(circle, Circle) and circle.centre == pytest.approx((-5, 6)) and circle.radius == pytest.approx(2)
    assert (
        isinstance(arc, Arc)
        and not arc.ccw
        and arc.start == pytest.approx((-7, 0))
        and arc.end == pytest.approx((-5, 2))
    )
    assert side == Line((0, 0), (-3, 0)) and line == Line((1, 1), (2, 1))


def test_tilted_circle_is_seen_as_an_ellipse() -> None:
    drawing = read(lambda space: space.add_circle((0, 0), 10, dxfattribs={"extrusion": (0, math.sin(1), math.cos(1))}))
    (ellipse,) = (entity.curve for entity in drawing.part.entities)
    assert isinstance(ellipse, Ellipse) and ellipse.ratio == pytest.approx(math.cos(1))
    assert math.hypot(*ellipse.major) == pytest.approx(10) and abs(ellipse.major[1]) < 1e-9


FRONT = (0, -1, 0)
"""Normal of the plane in which a part is drawn as it is seen from the front."""


def outline(*corners: tuple[float, float, float]) -> Draw:
    def draw(space: Any) -> None:
        for start, end in zip(corners, [*corners[1:], corners[0]], strict=True):
            space.add_line(start, end)

    return draw


@pytest.mark.parametrize(
    "draw",
    [
        outline((0, 0, 0), (40, 0, 0), (40, 0, 30), (0, 0, 30)),
        outline((0, 0, 0), (0, 40, 0), (0, 20, 30)),
        lambda space: (
            outline((0, 0, 0), (40, 0, 0), (20, 0, 30))(space),
            space.add_circle((20, 9, 0), 5, dxfattribs={"extrusion": FRONT}),
        ),
        lambda space: space.add_lwpolyline(
            [(0, 0), (40, 0), (40, 30), (0, 30)], close=True, dxfattribs={"extrusion": FRONT}
        ),
        lambda space: space.add_lwpolyline([(0, 0), (40, 0), (9, 30)], close=True, dxfattribs={"extrusion": FRONT}),
        lambda space: space.add_polyline2d([(0, 0), (40, 0), (9, 30)], close=True, dxfattribs={"extrusion": FRONT}),
    ],
    ids=["front", "side, no line along Z", "front with a hole", "polyline", "leaning polyline", "heavy polyline"],
)
def test_a_part_that_is_drawn_upright_is_no_part_from_above_and_said(draw: Draw) -> None:
    (found,) = [each for each in read(draw).findings if "upright" in each.text]
    assert found.counts and "All of the drawing stands upright" in found.text and "XY plane" in found.text


def test_an_upright_drawing_of_which_nothing_is_seen_is_refused_with_what_to_do() -> None:
    with pytest.raises(InputError, match="the drawing stands upright, and nothing of it is seen from above; lay it"):
        read(lambda space: space.add_circle((0, 0), 5, dxfattribs={"extrusion": FRONT}))


def test_upright_lines_of_a_flat_part_are_told_and_count_for_nothing() -> None:
    drawing = read(
        lambda space: (
            outline((0, 0, 0), (40, 0, 0), (40, 30, 0), (0, 30, 0))(space),
            space.add_line((0, 0, 0), (0, 0, -5)),
            space.add_line((3, 3, 0), (3, 3, 0)),
        )
    )
    (found,) = [each for each in drawing.findings if "upright" in each.text]
    assert found.text.startswith("1 entity stands upright and cannot be seen from above") and not found.counts


def at_depths(*lines: tuple[tuple[float, float, float], tuple[float, float, float]], also: Draw | None = None) -> Draw:
    def draw(space: Any) -> None:
        for start, end in lines:
            space.add_line(start, end)
        if also is not None:
            also(space)

    return draw


@pytest.mark.parametrize(
    "draw",
    [
        at_depths(((0, 0, -2), (50, 0, -2)), ((60, 0, -5), (100, 0, -5))),
        at_depths(((0, 0, 0), (20, 0, 0)), ((20, 0, 0), (30, 0, -5)), ((30, 0, -5), (60, 0, -5))),
        lambda space: (
            outline((0, 0, 0), (40, 0, 0), (40, 0, 30), (0, 0, 30))(space),
            [setattr(each.dxf, "layer", "FRONT") for each in space],
            space.doc.layers.add("FRONT").off(),
            space.add_line((0, 50, 0), (40, 50, 0)),
            space.add_line((50, 50, 0), (90, 50, 0)),
        ),
        lambda space: space.add_lwpolyline([(0, 3), (40, 3)], dxfattribs={"extrusion": FRONT, "elevation": 5}),
    ],
    ids=["two depths", "a ramp between depths", "front view on a layer that is off", "level line in an upright plane"],
)
def test_level_cuts_on_one_line_are_a_sound_drawing(draw: Draw) -> None:
    assert not [each for each in read(draw).findings if "upright" in each.text or each.counts]


def test_a_few_upright_lines_on_one_line_with_flat_ones_count_for_nothing() -> None:
    flat = [((x, 0, 0), (x + 5, 0, 0)) for x in (0, 10, 20)]
    (found,) = [each for each in read(at_depths(*flat, ((0, 0, 0), (0, 0, -5)))).findings if "upright" in each.text]
    assert found.text.startswith("1 entity stands upright") and not found.counts


@pytest.mark.parametrize(
    "stand",
    [
        lambda space: space.add_circle((5, 5), 3, dxfattribs={"extrusion": FRONT}),
        lambda space: space.add_line((5, 5, 0), (5, 5, -9)),
        lambda space: space.add_line((5, 5, 0), (5, 5 + 1e-12, -9)),
        lambda space: space.add_polyline3d([(5, 5, 0), (5, 5, -9)]),
        lambda space: space.add_spline([(5, 5, 0), (5, 5, -4), (5, 5, -9)]),
        lambda space: space.add_text("HI", height=3, dxfattribs={"extrusion": FRONT}),
        lambda space: space.add_solid([(0, 0), (5, 0), (0, 5)], dxfattribs={"extrusion": FRONT}),
    ],
    ids=["circle", "line", "nearly", "polyline", "spline", "text", "area"],
)
def test_what_stands_upright_is_told_once_and_not_as_without_length(stand: Draw) -> None:
    drawing = read(lambda space: (space.add_circle((50, 50), 9), stand(space)))
    told = [each.text for each in drawing.findings if "Z runs from" not in each.text]
    assert len(drawing.part.entities) == 1 and len(told) == 1 and told[0].startswith("1 entity stands upright")


def test_height_of_an_upright_polyline_is_that_of_its_points() -> None:
    level = {"extrusion": FRONT, "elevation": 5}
    drawing = read(
        lambda space: (
            space.add_line((0, 0), (9, 0)),
            space.add_lwpolyline([(0, -3), (40, -3)], dxfattribs=level),
        )
    )
    (depth,) = drawing.part.depths
    assert depth.depth == pytest.approx(3) and depth.words == "Z -3 mm"


def test_a_single_line_that_leans_is_a_line() -> None:
    drawing = read(lambda space: space.add_line((0, 0, 0), (10, 0, 5)))
    assert not [each for each in drawing.findings if "upright" in each.text]


def test_height_is_projected_and_said() -> None:
    drawing = read(lambda space: (space.add_line((0, 0, 0), (10, 0, 5)), space.add_line((10, 0, 5), (10, 10, 5))))
    assert drawing.part.entities[0].curve == Line((0, 0), (10, 0))
    (found,) = drawing.findings
    assert "Z runs from 0 to 5 mm" in found.text and not found.counts


@pytest.mark.parametrize(
    ("code", "size", "units"),
    [
        (1, 25.4, Units.INCH),
        (2, 304.8, Units.FOOT),
        (4, 1, Units.MM),
        (5, 10, Units.CM),
        (6, 1000, Units.M),
        (9, 0.0254, Units.INCH),
        (13, 1e-3, Units.MICRON),
        (24, 5280 * 1200 / 3937 * 1000, Units.FOOT),
    ],
)
def test_units_of_the_header(code: int, size: float, units: Units) -> None:
    drawing = read(lambda space: space.add_line((0, 0), (0.1, 0)), units=code)
    assert drawing.units_named and drawing.part.units is units and not drawing.findings
    assert drawing.part.entities[0].curve.end == pytest.approx((0.1 * size, 0))


def test_no_units_are_mm_and_said() -> None:
    drawing = read(lambda space: space.add_line((0, 0), (100, 0)), units=0)
    assert not drawing.units_named and drawing.part.units is Units.MM
    (found,) = drawing.findings
    assert "names no units" in found.text and "--units in" in found.text and not found.counts


def test_given_units_are_for_drawings_that_name_none() -> None:
    without = read_dxf(drawn(lambda space: space.add_line((0, 0), (1, 0)), units=0), "a.dxf", Units.INCH)
    assert without.part.entities[0].curve.end == (25.4, 0) and without.part.units is Units.INCH and not without.findings
    named = read_dxf(drawn(lambda space: space.add_line((0, 0), (1, 0)), units=4), "a.dxf", Units.INCH)
    assert named.part.entities[0].curve.end == (1, 0)
    assert "names its own units, mm" in named.findings[0].text


def layered(space: Any) -> None:
    layers = space.doc.layers
    layers.add("HOLES", color=1)
    layers.add("Hidden", color=3).off()
    layers.add("Frozen", true_color=0x102030).freeze()
    for k, name in enumerate(("holes", "Hidden", "Frozen", "nowhere")):
        space.add_line((0, k), (9, k), dxfattribs={"layer": name})


def test_layers_with_colours_and_visibility() -> None:
    part = read(layered).part
    by_name = {layer.name: layer for layer in part.layers}
    assert by_name["HOLES"].colour == "#ff0000" and by_name["0"].colour == "" and by_name["Frozen"].colour == "#102030"
    assert [by_name[n].visible for n in ("HOLES", "Hidden", "Frozen", "nowhere")] == [True, False, False, True]
    assert [entity.layer for entity in part.entities] == ["HOLES", "Hidden", "Frozen", "nowhere"]
    assert [entity.id for entity in part.entities] == [1, 2, 3, 4]


def test_chosen_layers() -> None:
    data = drawn(layered)
    assert [e.layer for e in read_dxf(data, "a.dxf", None, ("Holes", "nowhere")).part.entities] == ["HOLES", "nowhere"]
    with pytest.raises(InputError, match=r"a\.dxf: there is no layer wood; the drawing has 0, "):
        read_dxf(data, "a.dxf", None, ("wood",))


def test_what_is_left_out_is_counted() -> None:
    def draw(space: Any) -> None:
        space.add_line((0, 0), (1, 0))
        space.add_point((0, 0))
        space.add_point((1, 0))
        space.add_3dface([(0, 0), (1, 0), (1, 1)])
        space.add_line((0, 0), (1, 0), dxfattribs={"invisible": 1})
        space.doc.paperspace().add_line((0, 0), (1, 1))

    drawing = read(draw)
    expected = {"3DFACE": 1, "LINE (invisible)": 1, "paper space entity": 1}
    assert dict(drawing.left_out) == expected
    missing, found = drawing.findings
    assert missing.kind is FindingKind.LEFT_OUT and missing.counts and "1 3DFACE" in missing.text
    assert found.kind is FindingKind.LEFT_OUT and not found.counts and "1 LINE (invisible)" in found.text
    assert [(note.id, note.shape) for note in drawing.part.notes] == [(2, Mark((0.0, 0.0))), (3, Mark((1.0, 0.0)))]


def test_points_of_blocks_are_where_they_are_inserted_numbered_behind_the_curves() -> None:
    def draw(space: Any) -> None:
        space.doc.header["$INSUNITS"] = 1
        space.doc.layers.add("holes")
        block = space.doc.blocks.new("B")
        block.add_point((1, 2))
        block.add_point((3, 0), dxfattribs={"layer": "HOLES"})
        space.add_blockref("B", (10, 0), dxfattribs={"xscale": -1, "layer": "holes"})
        space.add_line((0, 0), (1, 0))
        space.add_point((1e9, 0))

    drawing = read(draw)
    inch = 25.4
    assert [note.shape.at for note in drawing.part.notes] == [
        pytest.approx((9 * inch, 2 * inch)),
        pytest.approx((7 * inch, 0.0)),
    ]
    assert [(note.id, note.layer) for note in drawing.part.notes] == [(2, "holes"), (3, "holes")]
    assert drawing.part.next_id() == 4 and dict(drawing.left_out)["POINT"] == 1


def test_entities_without_length_are_counted_and_located() -> None:
    def draw(space: Any) -> None:
        space.add_line((0, 0), (1, 0))
        space.add_line((7, 8), (7, 8))
        space.add_circle((3, 4), 0)
        space.add_lwpolyline([(1, 1), (1, 1)])

    drawing = read(draw)
    assert len(drawing.part.entities) == 1
    (found,) = drawing.findings
    assert (
        found.kind is FindingKind.TINY_ENTITY
        and found.amount == 3
        and "3 entities have no length" in found.text
        and found.x is not None
    )


def test_drawing_without_curves_is_refused_with_what_it_has() -> None:
    with pytest.raises(InputError, match=r"part\.dxf: the drawing has no lines.*left out: 1 3DFACE"):
        read(lambda space: space.add_3dface([(0, 0), (1, 0), (1, 1)]))


def test_a_drawing_of_points_alone_is_read_for_drills() -> None:
    part = read(lambda space: space.add_point((1, 2))).part
    assert not part.entities and [note.shape for note in part.notes] == [Mark((1.0, 2.0))]


def test_other_kinds_of_files_are_refused_with_what_can_be_read() -> None:
    with pytest.raises(InputError, match=r"part\.svgx: drawings of type \.svgx cannot be read; supported: .*\.dxf"):
        read_drawing("folder/part.svgx", b"")


def test_suffix_in_capitals() -> None:
    drawing = read_drawing("some/Where.DXF", drawn(lambda space: space.add_line((0, 0), (1, 0))))
    assert drawing.part.name == "Where"


def with_layers_off(*names: str) -> bytes:
    document = ezdxf.new()
    document.layers.add("OFF").off()
    document.layers.add("FRZ").freeze()
    space = document.modelspace()
    space.add_circle((0, 0), 50)
    for name in names:
        space.add_circle((10, 10), 9, dxfattribs={"layer": name})
    return bytes_of(document)


def test_curves_on_layers_that_are_off_or_frozen_are_named() -> None:
    found = [f for f in read_dxf(with_layers_off("OFF", "FRZ")).findings if "switched off" in f.text]
    assert [f.text for f in found] == [
        "Layers OFF, FRZ are switched off or frozen; 2 curves on them are not machined. Say --layer OFF to machine one."
    ]
    assert found[0].kind is FindingKind.LEFT_OUT and not found[0].counts and found[0].amount == 2
    (one,) = [f.text for f in read_dxf(with_layers_off("FRZ")).findings if "switched off" in f.text]
    assert one == "Layer FRZ is switched off or frozen; 1 curve on it is not machined. Say --layer FRZ to machine it."


def test_layers_that_were_asked_for_or_are_empty_are_not_named() -> None:
    asked = read_dxf(with_layers_off("OFF", "FRZ"), layers=("OFF",))
    assert not [f for f in (*asked.findings, *read_dxf(with_layers_off()).findings) if "switched off" in f.text]


@pytest.mark.parametrize("bulge", [1e-9, 2e-9, 1e-8, -1e-7, 3e-6])
def test_bulge_too_flat_to_see_is_a_line(bulge: float) -> None:
    points = [(0, 0, bulge), (60, 0, 0), (60, 40, 0), (0, 40, 0)]
    drawing = read(lambda space: space.add_lwpolyline(points, format="xyb", close=True))
    assert drawing.part.entities[0].curve == Line((0, 0), (60, 0)) and len(drawing.part.entities) == 4
    assert not drawing.findings


def test_flat_arc_is_a_line_and_one_that_is_not_stays() -> None:
    def draw(space: Any) -> None:
        space.add_arc((0, -2e6), 2e6, 90 - 5e-4, 90)
        space.add_arc((0, -2e6), 2e6, 90 - 2e-3, 90)

    flat, arc = curves(draw)
    assert isinstance(flat, Line) and isinstance(arc, Arc) and arc.radius == pytest.approx(2e6)
