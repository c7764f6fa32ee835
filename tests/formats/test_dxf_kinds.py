"""Kinds of DXF entities that few drawings have: multiple lines, helices, what lies in other files or solids, line types
of centre lines, layers that are never plotted.
"""

from __future__ import annotations

import math

import pytest
from ezdxf.xclip import XClip

from app.formats.readers import read_drawing
from app.model.curves import Line, Spline
from tests.formats.test_dxf_foreign import new, plate, read, telling

LOST = "whose outlines are not in the file or cannot be read"
DAMAGED = "which cannot be read; repair"


def test_the_lines_of_a_multiple_line_are_read() -> None:
    """Two lines 1 apart round a corner, closed: the middle between them is a square of 20."""
    document = new()
    document.modelspace().add_mline([(0, 0), (20, 0), (20, 20), (0, 20)], close=True)
    drawing = read(document)
    corners = {(round(x, 9), round(y, 9)) for each in drawing.part.entities for x, y in [each.curve.start]}
    sizes = sorted({abs(x - 10) for x, _ in corners})
    assert len(drawing.part.entities) == 8 and all(isinstance(each.curve, Line) for each in drawing.part.entities)
    assert len(sizes) == 2 and sizes[1] - sizes[0] == pytest.approx(1) and not drawing.left_out


def test_a_helix_is_read_as_seen_from_above() -> None:
    document = new()
    document.modelspace().add_helix(3, 2, 2)
    (entity,) = read(document).part.entities
    assert isinstance(entity.curve, Spline)
    assert math.hypot(*entity.curve.start) == pytest.approx(3) == math.hypot(*entity.curve.end)


@pytest.mark.parametrize("nested", [False, True])
def test_an_external_drawing_is_missing_from_the_part(nested: bool) -> None:
    document = new()
    document.add_xref_def("other.dwg", "OTHER")
    space = document.modelspace()
    plate(space)
    if nested:
        document.blocks.new("B").add_blockref("OTHER", (0, 0))
        space.add_blockref("B", (1, 1), dxfattribs={"column_count": 2, "column_spacing": 9})
    else:
        space.add_blockref("OTHER", (5, 5))
    drawing = read(document)
    count = 1 + nested
    assert dict(drawing.left_out) == {"INSERT of an external drawing": count}
    found = telling(drawing, LOST)
    assert found.counts and found.amount == count


def test_a_drawing_that_is_laid_over_is_missing_from_the_part() -> None:
    document = new()
    document.add_xref_def("other.dwg", "OTHER")
    document.blocks.get("OTHER").block.dxf.flags = 8
    plate(document.modelspace())
    document.modelspace().add_blockref("OTHER", (5, 5))
    assert dict(read(document).left_out) == {"INSERT of an external drawing": 1}


@pytest.mark.parametrize("wrong", [("41", "0.0"), ("42", "0.0"), ("20", "nan")])
def test_a_block_that_has_no_place_or_size_is_missing_from_the_part(wrong: tuple[str, str]) -> None:
    line = ["0", "LINE", "8", "0", "10", "0", "20", "0", "11", "5", "21", "7"]
    insert = ["0", "INSERT", "8", "0", "2", "B", "10", "5", *wrong]
    blocks = ["0", "SECTION", "2", "BLOCKS", "0", "BLOCK", "8", "0", "2", "B", *line, "0", "ENDBLK", "0", "ENDSEC"]
    text = [*blocks, "0", "SECTION", "2", "ENTITIES", *line, *insert, "0", "ENDSEC", "0", "EOF", ""]
    drawing = read_drawing("x.dxf", "\n".join(text).encode())
    assert dict(drawing.left_out) == {"INSERT (damaged)": 1} and telling(drawing, DAMAGED).counts


def test_a_frame_without_its_curve_is_missing_from_the_part() -> None:
    document = new()
    plate(document.modelspace())
    frame = document.modelspace().add_polyline2d([(0, 0), (4, 8), (9, 0)], dxfattribs={"flags": 4})
    for vertex in frame.vertices:
        vertex.dxf.flags = 16
    drawing = read(document)
    assert dict(drawing.left_out) == {"POLYLINE (damaged)": 1} and telling(drawing, DAMAGED).counts


def test_a_missing_block_and_a_region_are_missing_from_the_part() -> None:
    document = new()
    plate(document.modelspace())
    document.modelspace().add_blockref("gone", (0, 0))
    document.modelspace().add_region().sat = ["700 1 1 0", "End-of-ACIS-data"]
    found = telling(read(document), LOST)
    assert found.counts and found.text.startswith("Missing from the part: 1 INSERT of a missing block, 1 REGION,")


@pytest.mark.parametrize("kind", ["3DFACE", "SHAPE", "LINES", "AECC_WALL"])
def test_what_nobody_here_has_heard_of_is_missing_from_the_part(kind: str) -> None:
    lines = ["0", kind, "8", "0", "10", "0", "20", "0", "11", "5", "21", "0"]
    line = ["0", "LINE", "8", "0", "10", "0", "20", "0", "11", "5", "21", "7"]
    data = "\n".join(["0", "SECTION", "2", "ENTITIES", *lines, *line, "0", "ENDSEC", "0", "EOF", ""]).encode()
    drawing = read_drawing("x.dxf", data)
    found = telling(drawing, LOST)
    assert len(drawing.part.entities) == 1 and found.counts and f"1 {kind}," in found.text


def test_meshes_are_missing_from_the_part_and_dimensions_are_not() -> None:
    document = new()
    plate(document.modelspace())
    document.modelspace().add_polyface().append_face([(0, 0, 0), (1, 0, 0), (1, 1, 0)])
    document.modelspace().add_linear_dim((0, 5), (0, 0), (10, 0)).render()
    drawing = read(document)
    assert "1 POLYLINE," in telling(drawing, LOST).text
    assert [each.text for each in drawing.findings if not each.counts] == ["Left out: 1 DIMENSION."]


def test_curves_in_line_types_of_centre_lines_are_told() -> None:
    document = new()
    for name in ("CENTER", "HIDDEN"):
        document.linetypes.add(name, [1.0, 0.5, -0.25, 0.25])
    space, block = document.modelspace(), document.blocks.new("B")
    plate(space, linetype="Continuous")
    block.add_circle((0, 0), 3, dxfattribs={"linetype": "CENTER"})
    space.add_blockref("B", (10, 10), dxfattribs={"layer": "HOLES"})
    space.add_line((0, 0), (9, 9), dxfattribs={"linetype": "HIDDEN", "layer": "HOLES"})
    found = telling(read(document), "line type")
    assert found.text.startswith(
        "2 curves on layer HOLES, the first at (13.000, 10.000), are drawn in line type CENTER and HIDDEN, as centre"
    )
    assert not found.counts and found.layer == "HOLES"
    assert not [each for each in read(document, without_layers=("HOLES",)).findings if "line type" in each.text]


def test_a_layer_of_centre_lines_and_one_that_is_never_plotted_are_told() -> None:
    document = new()
    document.linetypes.add("CENTER", [1.0, 0.5, -0.25, 0.25])
    document.layers.add("AXES", linetype="CENTER")
    document.layers.add("HELP").dxf.plot = 0
    document.layers.add("UNUSED").dxf.plot = 0
    for layer in ("0", "AXES", "HELP", "Defpoints"):
        plate(document.modelspace(), layer=layer)
    told = [each.text for each in read(document).findings]
    assert told == [
        "Layer Defpoints is never plotted, as layers of construction lines are; its 4 curves are read like any other. "
        "--skip-layer leaves it out.",
        "Layer AXES is drawn in line type CENTER, as centre lines and hidden edges are; its 4 curves are read like any "
        "other. --skip-layer leaves it out.",
        "Layer HELP is never plotted, as layers of construction lines are; its 4 curves are read like any other. "
        "--skip-layer leaves it out.",
    ]


@pytest.mark.parametrize(
    ("corners", "cut"),
    [([(-1, -1), (5, 11)], 2), ([(2, 2), (8, 2), (8, 8)], 2), ([(-1, -1), (41, 31)], 0), ([(0, 0), (40, 30)], 0)],
)
@pytest.mark.parametrize("nested", [False, True])
def test_a_block_of_which_a_clip_hides_something_is_told(
    corners: list[tuple[float, float]], cut: int, nested: bool
) -> None:
    document = new()
    block = document.blocks.new("B", base_point=(3, 3))
    plate(block)
    space = document.blocks.new("OUTER") if nested else document.modelspace()
    for x in (20, 40):
        XClip(space.add_blockref("B", (x, 5), dxfattribs={"rotation": 30})).set_block_clipping_path(corners)
    if nested:
        document.modelspace().add_blockref("OUTER", (0, 0))
    counted = [each for each in read(document).findings if each.counts]
    assert [each.amount for each in counted] == ([float(cut)] if cut else [])
    assert all("clipped" in each.text and (each.x, each.y) == pytest.approx((20.0, 5.0)) for each in counted)


@pytest.mark.parametrize(("layer", "told"), [("Off", False), ("0", False), ("On", True)])
def test_a_clip_is_told_where_it_hides_something_that_is_machined(layer: str, told: bool) -> None:
    document = new()
    document.layers.add("Off").off()
    block = document.blocks.new("B")
    plate(block, layer=layer)
    block.add_circle((3, 3), 1, dxfattribs={"layer": "On"})
    insert = document.modelspace().add_blockref("B", (0, 0), dxfattribs={"layer": "Off"})
    XClip(insert).set_block_clipping_path([(1, 1), (5, 5)])
    counted = [each.text for each in read(document).findings if each.counts]
    assert ["clipped" in text for text in counted] == [True] * told


def test_a_clip_that_is_switched_off_hides_nothing() -> None:
    document = new()
    plate(document.blocks.new("B"))
    clip = XClip(document.modelspace().add_blockref("B", (0, 0)))
    clip.set_block_clipping_path([(2, 2), (4, 4)])
    clip.disable_clipping()
    assert not [each for each in read(document).findings if each.counts]
