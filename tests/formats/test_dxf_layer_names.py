"""DXF in: layers that are named as an editor writes them, L_x0020_1 for "L 1", are those layers for every remark."""

import io
from typing import Any

import ezdxf
import pytest

from app.formats.drawing import Drawing
from app.formats.readers import read_drawing
from app.model.curves import Circle
from app.model.read_options import DrawingOptions

NAMES = ["L_x0020_1", "l_x0020_1", "L 1"]


def of_two_layers() -> bytes:
    """Return a drawing with a circle, a text, a hatch and a band on the layer "L 1", and a circle on another."""
    document = ezdxf.new("R2010")
    document.header["$INSUNITS"] = 4
    space, own = document.modelspace(), {"layer": document.layers.add("L 1").dxf.name}
    space.add_circle((50, 60), 10, dxfattribs=own)
    space.add_text("HELLO \U0001f600", height=5, dxfattribs=own | {"insert": (80, 60)})
    space.add_hatch(dxfattribs=own).paths.add_polyline_path([(100, 90), (120, 90), (110, 99)], is_closed=True)
    space.add_lwpolyline([(50, 80), (60, 80)], dxfattribs=own | {"const_width": 2})
    space.add_circle((0, 0), 5, dxfattribs={"layer": "OTHER"})
    return _bytes(document)


def _bytes(document: Any) -> bytes:
    stream = io.StringIO()
    document.write(stream)
    return stream.getvalue().encode()


def read(data: bytes, layers: tuple[str, ...] = (), **how: Any) -> Drawing:
    return read_drawing("lay.dxf", data, None, layers, DrawingOptions(**how))


@pytest.mark.parametrize("name", NAMES[:2])
def test_remarks_on_a_layer_are_those_of_its_name(name: str) -> None:
    data = of_two_layers()
    expected = [each.text for each in read(data, ("L 1",)).findings]
    assert [each.text for each in read(data, (name,)).findings] == expected
    for words in ("No font here has", "boundary of a hatch", "drawn as a band"):
        assert any(words in text for text in expected)


@pytest.mark.parametrize("name", NAMES)
def test_the_layer_that_is_named_is_what_is_moved_to_zero(name: str) -> None:
    circle = read(of_two_layers(), (name,), to_zero=True).part.entities[0].curve
    assert isinstance(circle, Circle) and circle.centre == pytest.approx((10, 10))


@pytest.mark.parametrize("name", NAMES)
def test_remarks_on_a_layer_that_is_left_out_are_left_out(name: str) -> None:
    drawing = read(of_two_layers(), without_layers=(name,), to_zero=True)
    assert [each.curve for each in drawing.part.entities] == [Circle((5, 5), 5)]
    assert [each.text[:21] for each in drawing.findings] == ["The drawing was moved"]


@pytest.mark.parametrize("name", NAMES)
def test_a_frozen_layer_that_is_named_shows_its_blocks(name: str) -> None:
    document = ezdxf.new("R2010")
    document.header["$INSUNITS"] = 4
    document.layers.add("L 1").freeze()
    document.blocks.new("B").add_circle((0, 0), 5)
    document.modelspace().add_blockref("B", (0, 0), dxfattribs={"layer": "L 1"})
    assert len(read(_bytes(document), (name,)).part.entities) == 1


@pytest.mark.parametrize("layer", ["L 1", "L_x0020_1"])
def test_a_layer_that_no_table_has_is_found_by_its_name(layer: str) -> None:
    document = ezdxf.new("R2010")
    document.header["$INSUNITS"] = 4
    document.modelspace().add_circle((50, 60), 10, dxfattribs={"layer": layer})
    (entity,) = read(_bytes(document), ("l_x0020_1",), to_zero=True).part.entities
    assert isinstance(entity.curve, Circle) and entity.curve.centre == pytest.approx((10, 10))
