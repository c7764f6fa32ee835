"""Inserted blocks: nested, turned, mirrored, unequally scaled, in rows and columns, and bombs."""

import io
import math
import time
from typing import Any

import ezdxf
import numpy as np
import pytest

from app.core.errors import InputError
from app.formats.drawing import Drawing
from app.formats.dxf.dxf import read_dxf
from app.model.curves import Arc, Circle, Ellipse, Line


def new() -> Any:
    document = ezdxf.new("R2010")
    document.header["$INSUNITS"] = 4
    return document


def read(document: Any) -> Drawing:
    stream = io.StringIO()
    document.write(stream)
    return read_dxf(stream.getvalue().encode(), "blocks.dxf")


def with_block(draw: Any, **insert: Any) -> list[Any]:
    document = new()
    draw(document.blocks.new("B", base_point=(1, 0)))
    document.modelspace().add_blockref("B", (10, 20), dxfattribs=insert)
    return [entity.curve for entity in read(document).part.entities]


def shapes(block: Any) -> None:
    block.add_line((1, 0), (3, 0))
    block.add_arc((1, 0), 2, 0, 90)
    block.add_circle((1, 0), 5)


def test_moved_and_turned() -> None:
    line, arc, circle = with_block(shapes, rotation=90)
    assert isinstance(line, Line) and line.start == pytest.approx((10, 20)) and line.end == pytest.approx((10, 22))
    assert (
        isinstance(arc, Arc) and arc.ccw and arc.start == pytest.approx((10, 22)) and arc.end == pytest.approx((8, 20))
    )
    assert isinstance(circle, Circle) and circle.centre == pytest.approx((10, 20)) and circle.radius == pytest.approx(5)


def test_mirrored() -> None:
    line, arc, circle = with_block(shapes, xscale=-2, yscale=2)
    assert line.end == pytest.approx((6, 20))
    assert (
        isinstance(arc, Arc)
        and not arc.ccw
        and arc.start == pytest.approx((6, 20))
        and arc.end == pytest.approx((10, 24))
    )
    assert isinstance(circle, Circle) and circle.radius == pytest.approx(10)


def test_unequal_scales_make_ellipses() -> None:
    line, arc, circle = with_block(shapes, xscale=3, yscale=1, rotation=30)
    c, s = math.cos(math.radians(30)), math.sin(math.radians(30))
    assert line.end == pytest.approx((10 + 6 * c, 20 + 6 * s))
    assert isinstance(arc, Ellipse) and arc.ccw
    assert arc.start == pytest.approx(line.end) and arc.end == pytest.approx((10 - 2 * s, 20 + 2 * c))
    assert (
        isinstance(circle, Ellipse)
        and circle.ratio == pytest.approx(1 / 3)
        and math.hypot(*circle.major) == pytest.approx(15)
    )


def test_mirrored_unequal_scales_turn_the_direction() -> None:
    _, arc, _ = with_block(shapes, xscale=-3, yscale=1)
    assert isinstance(arc, Ellipse) and not arc.ccw
    assert arc.start == pytest.approx((4, 20)) and arc.end == pytest.approx((10, 22))


def test_inserted_from_below() -> None:
    document = new()
    document.blocks.new("B").add_arc((3, 0), 1, 0, 90)
    document.modelspace().add_blockref("B", (10, 20), dxfattribs={"extrusion": (0, 0, -1)})
    (arc,) = (e.curve for e in read(document).part.entities)
    assert (
        isinstance(arc, Arc)
        and not arc.ccw
        and arc.centre == pytest.approx((-13, 20))
        and arc.start == pytest.approx((-14, 20))
    )


FRONT = {"extrusion": (0, -1, 0)}
"""Of a block that is inserted as it is seen from the front."""


def upright(drawing: Drawing) -> list[tuple[str, bool]]:
    """Return what is said of what has no length, or stands upright, and whether it counts."""
    told = [each for each in drawing.findings if "no length" in each.text or "upright" in each.text]
    return [(each.text.split(" and ")[0], each.counts) for each in told]


def box(block: Any) -> None:
    corners = [(0, 0), (50, 0), (50, 30), (0, 30)]
    for start, end in zip(corners, corners[1:] + corners[:1], strict=True):
        block.add_line(start, end)


@pytest.mark.parametrize("turned", [0, 20])
@pytest.mark.parametrize(
    "draw",
    [
        lambda block: (box(block), block.add_circle((25, 15), 5)),
        lambda block: block.add_lwpolyline([(0, 0), (50, 0), (20, 30)], close=True),
        lambda block: (block.add_line((0, 0), (50, 0)), block.add_spline([(0, 0), (9, 30), (30, 40), (50, 0)])),
    ],
    ids=["box with a hole", "triangle", "line and spline"],
)
def test_a_front_view_that_is_an_upright_block_is_said(draw: Any, turned: float) -> None:
    document = new()
    draw(document.blocks.new("B"))
    document.modelspace().add_blockref("B", (10, 20), dxfattribs=FRONT | {"rotation": turned})
    assert upright(read(document)) == [("All of the drawing stands upright", True)]


def test_an_upright_block_beside_a_flat_part_is_told_once() -> None:
    document = new()
    block = document.blocks.new("B")
    box(block)
    block.add_circle((25, 15), 5)
    block.add_text("FRONT", height=3)
    document.modelspace().add_blockref("B", (10, 20), dxfattribs=FRONT)
    document.modelspace().add_circle((0, 0), 9)
    assert upright(read(document)) == [("4 entities stand upright", False)]


def test_a_level_line_of_an_upright_block_lies_as_high_as_it_is_drawn() -> None:
    document = new()
    document.blocks.new("B").add_line((0, 3), (50, 3))
    document.modelspace().add_blockref("B", (0, 0), dxfattribs=FRONT)
    document.modelspace().add_line((0, 9, 5), (50, 9, 5))
    drawing = read(document)
    assert not upright(drawing) and [each.depth for each in drawing.part.depths] == [pytest.approx(2)]


def test_upright_entities_are_counted_for_each_copy_and_not_as_without_length() -> None:
    document = new()
    block = document.blocks.new("B")
    block.add_line((5, 5, 0), (5, 5, -9))
    block.add_circle((0, 0), 5, dxfattribs=FRONT)
    outer = document.blocks.new("C")
    outer.add_circle((0, 0), 5)
    outer.add_blockref("B", (0, 0))
    for x in (0, 30, 60):
        document.modelspace().add_blockref("C", (x, 0))
    assert upright(read(document)) == [("6 entities stand upright", False)]


def test_rows_and_columns_follow_the_rotation_not_the_scale() -> None:
    document = new()
    document.blocks.new("B").add_circle((0, 0), 1)
    document.modelspace().add_blockref(
        "B",
        (100, 0),
        dxfattribs={
            "row_count": 2,
            "column_count": 3,
            "row_spacing": 10,
            "column_spacing": 5,
            "rotation": 90,
            "xscale": 2,
            "yscale": 2,
        },
    )
    circles = [e.curve for e in read(document).part.entities]
    assert sorted((round(c.centre[0]), round(c.centre[1])) for c in circles) == [
        (90, 0),
        (90, 5),
        (90, 10),
        (100, 0),
        (100, 5),
        (100, 10),
    ]
    assert all(isinstance(c, Circle) and c.radius == pytest.approx(2) for c in circles)


def test_nested_agrees_with_another_reader() -> None:
    """Three levels, unequal scales under turns and a mirror: end points as ezdxf's own exploding gives them."""
    document = new()
    document.blocks.new("inner").add_line((1, 2), (3, 5))
    document.blocks.new("middle", base_point=(2, 2)).add_blockref(
        "inner", (4, 1), dxfattribs={"xscale": 2, "yscale": -1, "rotation": 25}
    )
    document.blocks.new("outer").add_blockref("middle", (-3, 7), dxfattribs={"rotation": 60})
    insert = document.modelspace().add_blockref(
        "outer", (10, 20), dxfattribs={"xscale": -1.5, "yscale": 1.5, "rotation": -40}
    )
    (line,) = (e.curve for e in read(document).part.entities)
    (expected,) = (e for a in insert.virtual_entities() for b in a.virtual_entities() for e in b.virtual_entities())
    assert line.start == pytest.approx((expected.dxf.start.x, expected.dxf.start.y))
    assert line.end == pytest.approx((expected.dxf.end.x, expected.dxf.end.y))


def test_unequal_scales_over_a_turn_shear() -> None:
    """Such an insert cannot be exploded into other inserts, only into curves: a turned circle under x 3 stays
    upright.
    """
    document = new()
    document.blocks.new("inner").add_circle((2, 0), 1)
    document.blocks.new("outer").add_blockref("inner", (0, 0), dxfattribs={"rotation": 45, "xscale": 2})
    document.modelspace().add_blockref("outer", (0, 0), dxfattribs={"xscale": 3})
    (ellipse,) = (e.curve for e in read(document).part.entities)
    assert isinstance(ellipse, Ellipse)
    h = math.sqrt(0.5)
    matrix = np.diag([3, 1]) @ np.array([[h, -h], [h, h]]) @ np.diag([2, 1])
    assert ellipse.centre == pytest.approx(tuple(matrix @ (2, 0)))
    for t in (0.3, 1.9, 4.0):
        on_circle = np.linalg.solve(matrix, np.subtract(ellipse.at(t), ellipse.centre))
        assert math.hypot(*on_circle) == pytest.approx(1)


def test_layer_zero_of_a_block_is_the_layer_of_its_insert() -> None:
    document = new()
    block = document.blocks.new("B")
    block.add_line((0, 0), (1, 0))
    block.add_line((0, 1), (1, 1), dxfattribs={"layer": "own"})
    document.modelspace().add_blockref("B", (0, 0), dxfattribs={"layer": "outer"})
    assert [e.layer for e in read(document).part.entities] == ["outer", "own"]


def test_what_blocks_leave_out_is_counted_for_each_copy() -> None:
    document = new()
    block = document.blocks.new("B")
    block.add_line((0, 0), (1, 0))
    block.add_3dface([(0, 0), (1, 0), (1, 1)])
    for k in range(3):
        document.modelspace().add_blockref("B", (0, k)).add_attrib("TAG", "value").is_invisible = True
    assert dict(read(document).left_out) == {"3DFACE": 3, "ATTRIB (invisible)": 3}


def test_missing_block_is_named() -> None:
    document = new()
    document.modelspace().add_line((0, 0), (1, 0))
    document.modelspace().add_blockref("gone", (0, 0))
    assert dict(read(document).left_out) == {"INSERT of a missing block": 1}


def test_block_in_itself_is_refused() -> None:
    document = new()
    document.blocks.new("A").add_blockref("B", (0, 0))
    document.blocks.new("B").add_blockref("a", (0, 0))
    document.modelspace().add_blockref("A", (0, 0))
    with pytest.raises(InputError, match=r"blocks\.dxf: block a is inserted in itself"):
        read(document)


def test_huge_array_is_refused_at_once() -> None:
    document = new()
    document.blocks.new("B").add_line((0, 0), (1, 0))
    grid = {"row_count": 30000, "column_count": 30000, "row_spacing": 1, "column_spacing": 1}
    document.modelspace().add_blockref("B", (0, 0), dxfattribs=grid)
    started = time.process_time()
    with pytest.raises(InputError, match="more than 500000 curves at block B"):
        read(document)
    assert time.process_time() - started < 5


def test_too_many_letters_are_refused_with_the_way_to_leave_them_out() -> None:
    document = new()
    document.blocks.new("B").add_text("x")
    grid = {"row_count": 3000, "column_count": 3000, "row_spacing": 1, "column_spacing": 1}
    document.modelspace().add_blockref("B", (0, 0), dxfattribs=grid)
    with pytest.raises(InputError, match="its inserted blocks, or leave its texts out: --skip-type TEXT"):
        read(document)


@pytest.mark.exhaustive
def test_doubling_blocks_are_refused_within_bounds() -> None:
    document = new()
    document.blocks.new("B0").add_line((0, 0), (1, 0))
    for k in range(40):
        block = document.blocks.new(f"B{k + 1}")
        block.add_blockref(f"B{k}", (0, 0))
        block.add_blockref(f"B{k}", (0, 1))
    document.modelspace().add_blockref("B40", (0, 0))
    started = time.process_time()
    with pytest.raises(InputError, match="more than 500000 curves"):
        read(document)
    assert time.process_time() - started < 20


@pytest.mark.exhaustive
def test_empty_doubling_blocks_take_no_time() -> None:
    document = new()
    document.blocks.new("B0").add_point((0, 0))
    document.blocks.get("B0").add_text(" ")
    for k in range(60):
        block = document.blocks.new(f"B{k + 1}")
        block.add_blockref(f"B{k}", (0, 0))
        block.add_blockref(f"B{k}", (0, 1))
    document.modelspace().add_blockref("B60", (0, 0))
    document.modelspace().add_line((0, 0), (1, 0))
    drawing = read(document)
    assert dict(drawing.left_out)["POINT"] + len(drawing.part.notes) == 2**60


def test_nesting_has_a_limit() -> None:
    document = new()
    document.blocks.new("B0").add_line((0, 0), (1, 0))
    for k in range(200):
        document.blocks.new(f"B{k + 1}").add_blockref(f"B{k}", (0, 0))
    document.modelspace().add_blockref("B200", (0, 0))
    with pytest.raises(InputError, match="nested deeper than 64 levels"):
        read(document)


@pytest.mark.parametrize("again", ["B", "b"])
@pytest.mark.parametrize("version", ["AC1009", "AC1015"])
def test_a_block_that_is_defined_again_is_the_first_one_and_told(version: str, again: str) -> None:
    def block(name: str, radius: str) -> list[str]:
        circle = ["0", "CIRCLE", "8", "0", "10", "0", "20", "0", "40", radius]
        return ["0", "BLOCK", "8", "0", "2", name, "70", "0", "10", "0", "20", "0", *circle, "0", "ENDBLK", "8", "0"]

    head = ["0", "SECTION", "2", "HEADER", "9", "$ACADVER", "1", version, "9", "$INSUNITS", "70", "4", "0", "ENDSEC"]
    blocks = ["0", "SECTION", "2", "BLOCKS", *block("B", "5"), *block(again, "7"), *block("C", "1"), "0", "ENDSEC"]
    inserts = [tag for name in "BC" for tag in ("0", "INSERT", "8", "0", "2", name, "10", "0", "20", "0")]
    text = [*head, *blocks, "0", "SECTION", "2", "ENTITIES", *inserts, "0", "ENDSEC", "0", "EOF", ""]
    drawing = read_dxf("\n".join(text).encode(), "blocks.dxf")
    assert [entity.curve for entity in drawing.part.entities] == [Circle((0, 0), 5), Circle((0, 0), 1)]
    (found,) = drawing.findings
    assert found.counts and found.text.startswith(f"Block '{again}' is defined again")
