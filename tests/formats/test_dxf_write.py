"""DXF out and in again, every version: the same coordinates, layers, colours; what R12 cannot hold is counted."""

import io
import math
from itertools import pairwise

import ezdxf
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.formats.dxf.dxf import read_dxf
from app.formats.dxf.write import DxfVersion, dxf_bytes
from app.geometry.chaining.chain import chain
from app.model.curves import Arc, Circle, Curve, Ellipse, Line
from app.model.finding import FindingKind
from app.model.part import Entity, Layer, Part, Units
from tests.examples import examples
from tests.formats.drawn_parts import apart, arcs, circles, clamped, colours, lines, parts, parts_of, splines, wholes

SAME = 1e-9
of_old = st.one_of(lines, arcs, circles)
exact = st.one_of(of_old, wholes, parts_of, splines((1, 2, 3, 5)), splines((2, 3), rational=True))
modern = pytest.mark.parametrize("version", [version for version in DxfVersion if version is not DxfVersion.R12])
every = pytest.mark.parametrize("version", DxfVersion)


def drawn(*curves: Curve) -> Part:
    return Part(tuple(Entity(k, curve) for k, curve in enumerate(curves, 1)))


def back(part: Part, version: DxfVersion = DxfVersion.R2010) -> Part:
    return read_dxf(dxf_bytes(part, version).data, "part.dxf").part


def farthest(part: Part, again: Part) -> float:
    pairs = zip(part.entities, again.entities, strict=True)
    return max(apart(a.curve, b.curve) for a, b in pairs)


@given(parts(exact), st.sampled_from([v for v in DxfVersion if v is not DxfVersion.R12]), st.sampled_from(Units))
@settings(max_examples=examples(100), deadline=None)
def test_out_and_in_again(part: Part, version: DxfVersion, units: Units) -> None:
    part = Part(part.entities, part.layers, units)
    written = dxf_bytes(part, version)
    drawing = read_dxf(written.data, "part.dxf")
    assert not written.converted and not written.renamed and drawing.units_named and not drawing.left_out
    assert drawing.part.units is units and farthest(part, drawing.part) <= SAME
    assert [e.layer for e in drawing.part.entities] == [e.layer for e in part.entities]
    again = {layer.name: layer for layer in drawing.part.layers}
    for layer in part.layers:
        assert (again[layer.name].visible, again[layer.name].locked) == (layer.visible, layer.locked)
        assert version is DxfVersion.R2000 or again[layer.name].colour == layer.colour


@given(parts(of_old))
@settings(max_examples=examples(60), deadline=None)
def test_r12_keeps_lines_arcs_and_circles(part: Part) -> None:
    written = dxf_bytes(part, DxfVersion.R12)
    drawing = read_dxf(written.data, "part.dxf")
    names = {**{layer.name: layer.name for layer in part.layers}, **dict(written.renamed)}
    assert not written.converted and farthest(part, drawing.part) <= SAME
    assert [e.layer for e in drawing.part.entities] == [names[e.layer] for e in part.entities]


@given(st.one_of(wholes, parts_of, splines((2, 3, 5), rational=True)))
@settings(max_examples=examples(25), deadline=None)
def test_r12_has_ellipses_and_splines_within_the_tolerance_and_counted(curve: Curve) -> None:
    written = dxf_bytes(drawn(curve, Line((0, 0), (1, 0))), DxfVersion.R12, 0.005)
    (converted,) = written.converted
    assert (converted.kind, converted.count) == (type(curve).__name__.lower(), 1) and converted.deviation <= 0.005
    *after, line = (e.curve for e in read_dxf(written.data).part.entities)
    assert all(isinstance(c, Line | Arc | Circle) for c in after) and line == Line((0, 0), (1, 0))
    assert all(a.end == b.start for a, b in pairwise(after))
    if not isinstance(after[0], Circle):
        assert max(math.dist(after[0].start, curve.start), math.dist(after[-1].end, curve.end)) < SAME


@every
def test_every_version_says_what_it_is_and_is_sound(version: DxfVersion) -> None:
    spline = clamped(3, [(0, 0), (1, 2), (3, 0), (4, 4), (5, 0)], (1, 2, 1, 1, 1), [0.5])
    flat = Arc((-500, 0), (500, 0), (0, 1e6))
    curves = (Line((0, 0), (1, 0)), Ellipse((0, 0), (5, 0), 0.5), spline, flat, Circle((1, 1), 2, False))
    text = dxf_bytes(drawn(*curves), version).data.decode("cp1252")
    assert version.value in text
    document = ezdxf.read(io.StringIO(text))  # type: ignore[attr-defined]
    assert document.dxfversion == version.value and not document.audit().errors


@every
def test_joints_still_join(version: DxfVersion) -> None:
    """Corners rounded by arcs, travelled clockwise: lines keep the ends of the arcs though DXF stores angles."""
    corners = [(0.1, 0.2), (97.3, 11.1), (80.7, 55.9), (3.3, 71.7)]
    ring: list[Curve] = []
    for k, (x, y) in enumerate(corners):
        nx, ny = corners[(k + 1) % 4]
        middle = ((x + nx) / 2, (y + ny) / 2)
        ring += [Line((x, y), middle), Arc(middle, (nx, ny), ((middle[0] + nx) / 2, (middle[1] + ny) / 2), k % 2 == 0)]
    (contour,) = chain(back(drawn(*ring), version).entities, join_tolerance=1e-6).contours
    assert contour.closed


def test_flat_arcs_keep_their_ends() -> None:
    """The centre of an arc as flat as this is so far away that angles from it are too coarse for its ends."""
    for radius in (1e3, 1e5, 1e7, 1e9):
        half = 500.0
        off = math.sqrt(radius**2 - half**2)
        arc = Arc((-half, 0.125), (half, 0.125), (0.0, 0.125 + off))
        for version in (DxfVersion.R12, DxfVersion.R2018):
            (again,) = back(drawn(arc), version).entities
            assert max(math.dist(again.curve.start, arc.start), math.dist(again.curve.end, arc.end)) < SAME


@modern
def test_units_are_in_the_header_and_coordinates_in_these(version: DxfVersion) -> None:
    part = Part((Entity(1, Line((0, 0), (25.4, 0))),), units=Units.INCH)
    document = ezdxf.read(io.StringIO(dxf_bytes(part, version).data.decode()))  # type: ignore[attr-defined]
    assert (document.header["$INSUNITS"], document.header["$MEASUREMENT"]) == (1, 0)
    assert document.modelspace()[0].dxf.end.x == pytest.approx(1.0)


def test_r12_is_in_mm_for_it_cannot_say_otherwise() -> None:
    part = Part((Entity(1, Line((0, 0), (25.4, 0))),), units=Units.INCH)
    drawing = read_dxf(dxf_bytes(part, DxfVersion.R12).data)
    assert drawing.part.entities[0].curve.end == (25.4, 0)
    assert [f.kind for f in drawing.findings] == [FindingKind.UNITS_ASSUMED]


@given(colours.filter(bool))
@settings(max_examples=examples(30), deadline=None)
def test_colours_of_old_are_the_nearest_of_the_index(colour: str) -> None:
    part = Part((Entity(1, Line((0, 0), (1, 0)), "a"),), (Layer("a", colour),))
    (found,) = [layer.colour for layer in back(part, DxfVersion.R2000).layers if layer.name == "a"]
    assert found and back(Part(part.entities, (Layer("a", found),)), DxfVersion.R12).layers[-1].colour == found


@every
def test_white_stays_white_and_ink_stays_ink(version: DxfVersion) -> None:
    layers = (Layer("0"), Layer("white", "#ffffff"), Layer("red", "#ff0000", False, True))
    part = Part(tuple(Entity(k, Line((0, k), (1, k)), layer.name) for k, layer in enumerate(layers, 1)), layers)
    assert back(part, version).layers == layers
    assert back(Part(part.entities, layers[::-1]), version).layers == layers[::-1]


def test_names_that_a_version_forbids_are_changed_and_listed() -> None:
    layers = tuple(map(Layer, ("a<b", "a>b", "A_B", "x y", "加工", "", "0 ", "n" * 300, "\U0001f600")))
    part = Part(tuple(Entity(k, Line((0, k), (1, k)), layer.name) for k, layer in enumerate(layers, 1)), layers)
    modern, old = (dxf_bytes(part, version) for version in (DxfVersion.R2018, DxfVersion.R12))
    assert (
        dict(modern.renamed)["a>b"] == "a_b_2"
        and "x y" not in dict(modern.renamed)
        and "加工" not in dict(modern.renamed)
    )
    assert (
        dict(old.renamed)["x y"] == "x_y"
        and "加工" not in dict(old.renamed)
        and len(dict(old.renamed)["n" * 300]) == 31
    )
    for written in (modern, old):
        again = read_dxf(written.data).part
        assert len({e.layer.casefold() for e in again.entities}) == len(layers)
        assert "加工" in {e.layer for e in again.entities}


def test_a_closed_spline_in_r12_is_closed() -> None:
    control = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0), (0.0, 0.0)]
    (contour,) = chain(back(drawn(clamped(3, control, (), [0.5])), DxfVersion.R12).entities).contours
    assert contour.closed


def test_an_empty_part_is_a_drawing_and_an_orphan_keeps_its_layer() -> None:
    assert b"EOF" in dxf_bytes(Part()).data
    assert back(Part((Entity(1, Line((0, 0), (1, 0)), "lost"),), ())).entities[0].layer == "lost"
