"""DXF of small exporters: no version, no header, no subclass marks, or marks in a file that calls itself R12."""

import io
import re
from collections.abc import Callable
from typing import Any

import ezdxf
import pytest

from app.formats.drawing import Drawing
from app.formats.readers import read_drawing
from app.model.curves import Line


def hatched(space: Any) -> None:
    hatch = space.add_hatch()
    hatch.paths.add_polyline_path([(0, 0), (8, 0, 1), (8, 8)], is_closed=True)


KINDS: dict[str, Callable[[Any], Any]] = {
    "LWPOLYLINE": lambda space: space.add_lwpolyline([(0, 0), (9, 0, 0.5), (9, 9)], format="xyb", close=True),
    "SPLINE": lambda space: space.add_open_spline([(0, 0), (1, 5), (6, 7), (9, 0)]),
    "ELLIPSE": lambda space: space.add_ellipse((1, 2), (5, 1), 0.5),
    "MTEXT": lambda space: space.add_mtext("AB\\PC", dxfattribs={"char_height": 5, "insert": (3, 4)}),
    "TEXT": lambda space: space.add_text("AB", height=5, dxfattribs={"insert": (3, 4)}),
    "HATCH": hatched,
}


def whole(kind: str) -> str:
    """Return a drawing with a line and one entity of a kind, both on a layer of their own."""
    document = ezdxf.new("R2000", units=4)
    space = document.modelspace()
    space.add_line((-9, -9), (-5, -9))
    KINDS[kind](space)
    for entity in space:
        entity.dxf.layer = "cut"
    stream = io.StringIO()
    document.write(stream)
    return stream.getvalue()


def entities_alone(text: str) -> str:
    found = re.search(r"  0\nSECTION\n  2\nENTITIES\n.*?  0\nENDSEC\n", text, re.DOTALL)
    assert found is not None
    return found[0] + "  0\nEOF\n"


def without_marks(text: str) -> str:
    return re.sub(r"(?m)^100\nAcDb.*\n", "", text)


def without_own_marks(text: str) -> str:
    return re.sub(r"(?m)^100\nAcDb(?!Entity\n).*\n", "", text)


def without_first_marks(text: str) -> str:
    return re.sub(r"(?m)^100\nAcDbEntity\n", "", text)


def of_r12(text: str) -> str:
    return text.replace("\nAC1015\n", "\nAC1009\n")


def seen(drawing: Drawing) -> list[Any]:
    return [(entity.layer, entity.curve) for entity in drawing.part.entities]


def read(text: str) -> Drawing:
    return read_drawing("x.dxf", text.encode())


WAYS: dict[str, Callable[[str], str]] = {
    "entities alone": entities_alone,
    "entities without marks": lambda text: without_marks(entities_alone(text)),
    "no marks": without_marks,
    "no marks of the kind": without_own_marks,
    "no marks of all kinds": without_first_marks,
    "R12 with marks": of_r12,
    "R12 without marks": lambda text: of_r12(without_marks(text)),
}


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("kind", KINDS)
def test_entities_are_read_with_marks_and_without(kind: str, way: str) -> None:
    text = whole(kind)
    assert seen(read(WAYS[way](text))) == seen(read(text))


def test_owners_groups_and_extended_data_stay_where_they_are() -> None:
    entity = (
        "LWPOLYLINE\n102\n{ACAD_REACTORS\n330\n1F\n102\n}\n8\ncut\n62\n1\n90\n3\n70\n1\n"
        "10\n0\n20\n0\n10\n9\n20\n0\n10\n9\n20\n9\n1001\nPROGRAM\n1070\n8\n"
    )
    drawing = read(f"0\nSECTION\n2\nENTITIES\n0\n{entity}0\nENDSEC\n0\nEOF\n")
    assert seen(drawing) == [
        ("cut", Line((0, 0), (9, 0))),
        ("cut", Line((9, 0), (9, 9))),
        ("cut", Line((9, 9), (0, 0))),
    ]
    assert not any("damaged" in each.text for each in drawing.findings)


@pytest.mark.parametrize("handle", ["0", "", "-1", "XYZ"])
@pytest.mark.parametrize("version", ["AC1009", "AC1015"])
def test_handles_that_are_none_are_made_anew(version: str, handle: str) -> None:
    lines = "".join(f"0\nLINE\n5\n{handle}\n8\n0\n10\n0\n20\n{y}\n11\n9\n21\n{y}\n" for y in (0, 1))
    header = f"0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\n{version}\n0\nENDSEC\n"
    drawing = read(f"{header}0\nSECTION\n2\nENTITIES\n{lines}0\nENDSEC\n0\nEOF\n")
    assert [curve for _, curve in seen(drawing)] == [Line((0, 0), (9, 0)), Line((0, 1), (9, 1))]
    assert not any("damaged" in each.text for each in drawing.findings)


LINE = "0\nSECTION\n2\nENTITIES\n0\nLINE\n8\nNüt\n10\n0\n20\n0\n11\n9\n21\n0\n0\nENDSEC\n0\nEOF\n"


@pytest.mark.parametrize("version", ["AC1009", "AC1024"])
@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16"])
def test_a_mark_of_the_order_of_bytes_is_no_letter(encoding: str, version: str) -> None:
    text = f"0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\n{version}\n9\n$INSUNITS\n70\n5\n0\nENDSEC\n{LINE}"
    assert seen(read_drawing("x.dxf", text.encode(encoding))) == [("Nüt", Line((0, 0), (90, 0)))]


@pytest.mark.parametrize("after", ["", "0\nLINE\n8\n0\n10\n0\n20\n5\n11\n9\n21\n5\n"])
def test_a_polyline_without_its_end_mark_ends_where_something_else_begins(after: str) -> None:
    vertices = "".join(f"0\nVERTEX\n8\n0\n10\n{x}\n20\n0\n" for x in (0, 4))
    drawing = read(f"0\nSECTION\n2\nENTITIES\n0\nPOLYLINE\n8\n0\n66\n1\n70\n0\n{vertices}{after}0\nENDSEC\n0\nEOF\n")
    curves = [curve for _, curve in seen(drawing)]
    assert curves == [Line((0, 0), (4, 0)), Line((0, 5), (9, 5))][: len(curves)] and len(curves) == 1 + bool(after)


@pytest.mark.parametrize("attribute", ["", "0\nATTRIB\n8\n0\n10\n1\n20\n1\n40\n2\n1\n \n2\nT\n"])
def test_a_block_whose_attributes_do_not_end_is_inserted(attribute: str) -> None:
    block = "0\nBLOCK\n8\n0\n2\nB\n70\n0\n10\n0\n20\n0\n0\nLINE\n8\n0\n10\n0\n20\n0\n11\n9\n21\n0\n0\nENDBLK\n"
    insert = f"0\nINSERT\n8\n0\n66\n1\n2\nB\n10\n0\n20\n2\n{attribute}"
    both = LINE.replace("0\nLINE", f"{insert}0\nLINE")
    drawing = read(f"0\nSECTION\n2\nBLOCKS\n{block}0\nENDSEC\n{both}")
    assert {curve for _, curve in seen(drawing)} == {Line((0, 0), (9, 0)), Line((0, 2), (9, 2))}


@pytest.mark.parametrize("marks", ["", "100\nAcDbEntity\n"])
@pytest.mark.parametrize("kind", ["MESH", "HELIX", "REGION"])
def test_what_cannot_be_read_is_missing_and_the_rest_is_read(kind: str, marks: str) -> None:
    document = ezdxf.new("R2000", units=4)
    document.modelspace().add_line((0, 0), (9, 0))
    stream = io.StringIO()
    document.write(stream)
    owner = document.modelspace().layout_key
    broken = f"  0\n{kind}\n  5\nFFF\n330\n{owner}\n{marks}  8\n0\n 10\n1\n 20\n2\n 40\n3\n"
    drawing = read(stream.getvalue().replace("  0\nLINE\n", f"{broken}  0\nLINE\n"))
    assert [curve for _, curve in seen(drawing)] == [Line((0, 0), (9, 0))]
    assert any(each.counts and f"1 {kind} (damaged)" in each.text for each in drawing.findings)


def test_what_nobody_has_heard_of_is_missing_also_where_its_name_ends_with_a_bracket() -> None:
    thing = "0\nTHING(2)\n5\nFFF\n100\nAcDbEntity\n8\n0\n10\n1\n20\n2\n"
    drawing = read(LINE.replace("0\nLINE", f"{thing}0\nLINE"))
    assert any(each.counts and "1 THING(2)" in each.text for each in drawing.findings)


def test_two_polylines_that_have_become_one_are_missing_and_told() -> None:
    one = "0\nLWPOLYLINE\n100\nAcDbEntity\n8\n0\n100\nAcDbPolyline\n90\n2\n70\n0\n10\n{}\n20\n0\n10\n{}\n20\n9\n"
    both = one.format(0, 9) + one.format(20, 29).removeprefix("0\nLWPOLYLINE\n")
    drawing = read(LINE.replace("0\nLINE", f"{both}0\nLINE"))
    assert [curve for _, curve in seen(drawing)] == [Line((0, 0), (9, 0))]
    assert dict(drawing.left_out) == {"LWPOLYLINE (damaged)": 1}
