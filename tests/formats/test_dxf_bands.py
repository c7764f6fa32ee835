"""Polylines with a width, which CAD programs show as bands: the middle line is read, and that is said."""

import io
from typing import Any

import ezdxf
import pytest

from app.formats.readers import read_drawing
from app.model.finding import Finding


def said(document: Any, layers: tuple[str, ...] = ()) -> list[Finding]:
    text = io.StringIO()
    document.write(text)
    found = read_drawing("a.dxf", text.getvalue().encode(), None, layers).findings
    return [each for each in found if "drawn as" in each.text]


@pytest.mark.parametrize("version", ["R12", "R2010"])
def test_a_width_of_all_of_a_polyline(version: str) -> None:
    document = ezdxf.new(version, units=4)
    document.modelspace().add_polyline2d(
        [(1, 2), (9, 2)], dxfattribs={"default_start_width": 0.5, "default_end_width": 0.5, "layer": "A"}
    )
    if version != "R12":
        document.modelspace().add_lwpolyline([(0, 0), (5, 0)], dxfattribs={"const_width": 0.5, "layer": "A"})
    (found,) = said(document)
    what = "1 polyline on layer A is drawn as a band" if version == "R12" else "2 polylines on layer A are drawn as"
    assert found.text.startswith(what) and " 0.5 mm wide" in found.text
    assert "at (1.000, 2.000)" in found.text and not found.counts


def test_widths_that_change_along_it() -> None:
    document = ezdxf.new("R2010", units=4)
    document.modelspace().add_lwpolyline([(0, 0, 1, 3, 0), (50, 10, 0, 2, 0)], format="xyseb")
    polyline = document.modelspace().add_polyline2d([(0, 5), (10, 5)])
    polyline.vertices[0].dxf.end_width = 5
    (found,) = said(document)
    assert "2 polylines" in found.text and " 0 to 5 mm wide" in found.text


def test_a_width_grows_with_its_block_and_is_on_its_layer() -> None:
    document = ezdxf.new("R2010", units=1)
    document.blocks.new("B").add_lwpolyline([(1, 0), (5, 0)], dxfattribs={"const_width": 1})
    for x in (100, 200):
        document.modelspace().add_blockref("B", (x, 0), dxfattribs={"xscale": 3, "yscale": 3, "layer": "L"})
    (found,) = said(document)
    assert "2 polylines on layer L are drawn as bands 76.2 mm wide, the first at (2616.200, 0.000)" in found.text
    assert found.amount == 2


def test_nothing_is_said_of_lines_without_a_width_or_on_other_layers() -> None:
    document = ezdxf.new("R2010", units=4)
    space = document.modelspace()
    space.add_lwpolyline([(0, 0, 0.0, 0.0, 0.0), (5, 0, 0, 0, 0)], format="xyseb")
    space.add_polyline2d([(0, 0), (5, 0)])
    space.add_polyline3d([(0, 0, 0), (5, 0, 0)])
    space.add_line((0, 0), (5, 0))
    assert not said(document)
    space.add_lwpolyline([(0, 0), (5, 0)], dxfattribs={"const_width": 1, "layer": "WIDE"})
    assert said(document) and not said(document, ("0",))
