"""TEXT and attributes of a DXF: letters at their place, height, width, angle, in the font that is named or the
engraving face.
"""

import io
import math
from pathlib import Path
from typing import Any

import ezdxf
import pytest
from ezdxf.enums import TextEntityAlignment as Align
from hypothesis import given, settings
from hypothesis import strategies as st

from app.formats.drawing import Drawing
from app.formats.readers import read_drawing
from app.geometry import typeface
from app.geometry.affine import Affine
from app.geometry.stroke_font import engraving
from app.model.curves import Circle, Curve
from app.model.finding import Finding, FindingKind
from app.model.part import Entity
from app.model.read_options import DrawingOptions
from tests.examples import examples
from tests.formats.block_font import boxes, fonts, forget_fonts, save

__all__ = ["fonts"]


def new(version: str = "R2010") -> Any:
    document = ezdxf.new(version)
    document.header["$INSUNITS"] = 4
    document.styles.add("BLOCK", font="block.ttf")
    document.styles.add("STROKES", font="romans.shx")
    return document


def read(document: Any, layers: tuple[str, ...] = (), **how: Any) -> Drawing:
    stream = io.StringIO()
    document.write(stream)
    return read_drawing(
        "x.dxf", stream.getvalue().encode(document.output_encoding), None, layers, DrawingOptions(**how)
    )


def text(words: str, style: str = "BLOCK", **attributes: Any) -> Any:
    document = new()
    document.modelspace().add_text(words, height=7, dxfattribs={"style": style, **attributes})
    return document


def curves(document: Any, **how: Any) -> list[Curve]:
    return [entity.curve for entity in read(document, **how).part.entities]


def telling(drawing: Drawing, word: str) -> Finding:
    (found,) = [each for each in drawing.findings if word in each.text]
    return found


def near(found: list[tuple[float, ...]], expected: list[tuple[float, ...]]) -> bool:
    return [pytest.approx(box, abs=1e-9) for box in expected] == found


def test_letters_stand_at_the_insertion_point_at_the_height_of_their_capitals(fonts: Path) -> None:
    found = boxes(curves(text("HpH", insert=(10, 20))))
    assert near(found, [(11, 20, 15, 27), (17, 18, 20, 25), (22, 20, 26, 27)])


@pytest.mark.parametrize(
    ("align", "x", "y"),
    [
        (Align.LEFT, 0, 0),
        (Align.CENTER, -6, 0),
        (Align.RIGHT, -12, 0),
        (Align.MIDDLE, -6, -2.5),
        (Align.TOP_LEFT, 0, -7),
        (Align.TOP_CENTER, -6, -7),
        (Align.TOP_RIGHT, -12, -7),
        (Align.MIDDLE_LEFT, 0, -3.5),
        (Align.MIDDLE_CENTER, -6, -3.5),
        (Align.MIDDLE_RIGHT, -12, -3.5),
        (Align.BOTTOM_LEFT, 0, 2),
        (Align.BOTTOM_CENTER, -6, 2),
        (Align.BOTTOM_RIGHT, -12, 2),
    ],
)
def test_alignments(fonts: Path, align: Align, x: float, y: float) -> None:
    """Two letters are 12 wide, 7 high, and small ones reach 2 below the baseline."""
    document = text("HH")
    (entity,) = document.modelspace()
    entity.set_placement((100, 50), None, align)
    assert near(boxes(curves(document))[:1], [(101 + x, 50 + y, 105 + x, 57 + y)])


@pytest.mark.parametrize(("align", "width", "height"), [(Align.FIT, 2, 1), (Align.ALIGNED, 2, 2)])
def test_a_text_between_two_points_is_wider_or_larger_altogether(
    fonts: Path, align: Align, width: float, height: float
) -> None:
    document = text("HH")
    (entity,) = document.modelspace()
    entity.set_placement((0, 0), (0, 24), align)
    first, _ = boxes(curves(document))
    assert first == pytest.approx((-7 * height, width, 0, 5 * width))


@pytest.mark.parametrize("degrees", [0, 90, 17, -132.5])
@pytest.mark.parametrize("flags", [0, 2, 4, 6])
def test_turned_leaning_wide_and_mirrored(fonts: Path, degrees: float, flags: int) -> None:
    """The corner (5, 7) of the letter, twice as wide, leaning by 20 degrees, mirrored about the point, then turned
    about it.
    """
    document = text("H", insert=(30, 40), rotation=degrees, oblique=20, width=2, text_generation_flag=flags)
    x, y = 10 + 7 * math.tan(math.radians(20)), 7.0
    turn = complex(math.cos(math.radians(degrees)), math.sin(math.radians(degrees)))
    corner = complex(-x if flags & 2 else x, -y if flags & 4 else y) * turn
    ends = [curve.start for curve in curves(document)]
    assert any(math.dist(end, (30 + corner.real, 40 + corner.imag)) < 1e-9 for end in ends)


def test_from_below_x_runs_the_other_way(fonts: Path) -> None:
    assert near(boxes(curves(text("H", insert=(10, 20), extrusion=(0, 0, -1)))), [(-15, 20, -11, 27)])


@settings(max_examples=examples(60), deadline=None)
@given(
    st.lists(st.floats(-3, 3).filter(lambda v: abs(v) > 0.05), min_size=2, max_size=2),
    st.lists(st.floats(-180, 180), min_size=2, max_size=2),
    st.lists(st.floats(-500, 500), min_size=4, max_size=4),
    st.floats(-40, 40),
    st.floats(0.2, 4),
)
def test_letters_of_a_block_go_where_its_maps_take_them(
    scales: list[float],
    turns: list[float],
    places: list[float],
    lean: float,
    wide: float,
) -> None:
    """Each corner of a letter under the text's own map, then under that of the insert, against products of matrices."""
    document = new()
    attributes = {"style": "STROKES", "insert": places[:2], "rotation": turns[0], "oblique": lean, "width": wide}
    document.blocks.new("B").add_text("L", height=7, dxfattribs=attributes)
    insert = {"xscale": scales[0], "yscale": scales[1], "rotation": turns[1]}
    document.modelspace().add_blockref("B", places[2:], dxfattribs=insert)
    inner = _turn(turns[0], *places[:2]).after(Affine(wide, math.tan(math.radians(lean)), 0, 1))
    to = (
        _turn(turns[1], *places[2:])
        .after(Affine(scales[0], 0, 0, scales[1]))
        .after(inner)
        .after(Affine(0.5, 0, 0, 0.5))
    )
    expected = [to.point(p) for curve in engraving().glyphs["L"].curves for p in (curve.start, curve.end)]
    found = [p for curve in curves(document) for p in (curve.start, curve.end)]
    assert len(found) == len(expected)
    assert all(math.dist(a, b) < 1e-8 for a, b in zip(found, expected, strict=True))


def _turn(degrees: float, x: float, y: float) -> Affine:
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return Affine(c, -s, s, c, x, y)


@pytest.mark.parametrize(
    ("words", "letters"),
    [
        ("%%u%%uH", "H"),
        ("%%c", "Ø"),
        ("%%P", "±"),
        ("%%216", "Ø"),
        ("%%129", "Ø"),
        ("\\U+00D8", "Ø"),
        ("%%uH%%u", "H"),
        ("^IH", " H"),
        ("%%072", "H"),
    ],
)
def test_codes_are_the_letters_that_they_mean(fonts: Path, words: str, letters: str) -> None:
    plain, coded = boxes(curves(text(letters))), boxes(curves(text(words)))
    assert coded[: len(plain)] == plain and len(coded) == len(plain) + words.endswith("%%u")


def test_lines_along_the_words(fonts: Path) -> None:
    """Under and over two of three letters, half a unit thick."""
    found = boxes(curves(text("%%uHH%%u%%oH")))
    assert near([box for box in found if box[3] - box[1] < 1], [(0, -1.65, 12, -1.15), (12, 8.15, 18, 8.65)])


def test_the_font_that_is_named_is_found_by_file_family_and_style(fonts: Path) -> None:
    document = new()
    document.styles.add("FAMILY", font="").set_extended_font_data("Block", bold=True)
    document.styles.add("FOLDER", font="C:\\Windows\\Fonts\\Heavy.TTF")
    for style in ("BLOCK", "FAMILY", "FOLDER"):
        document.modelspace().add_text("H", height=7, dxfattribs={"style": style})
    drawing = read(document)
    said = "3 texts are read as curves to machine: 2 in heavy, 1 in block; leave them out with --skip-type TEXT."
    assert telling(drawing, "texts").text == said
    assert not any(entity.lettering for entity in drawing.part.entities)


def test_no_file_that_a_drawing_names_is_ever_opened(fonts: Path, tmp_path: Path) -> None:
    save(tmp_path / "mine.ttf")
    document = new()
    document.styles.add("MINE", font=str(tmp_path / "mine.ttf"))
    document.modelspace().add_text("H", height=7, dxfattribs={"style": "MINE"})
    assert "in the engraving face" in telling(read(document), "text").text


def test_a_font_that_is_not_here_or_broken_is_the_engraving_face_in_strokes_and_said(fonts: Path) -> None:
    (fonts / "broken.ttf").write_bytes(b"no font")
    forget_fonts()
    document = text("HE", style="STROKES")
    document.styles.add("BROKEN", font="broken.ttf")
    document.modelspace().add_text("H", height=14, dxfattribs={"style": "BROKEN"})
    drawing = read(document)
    assert all(entity.lettering for entity in drawing.part.entities)
    assert [entity.curve for entity in drawing.part.entities[-3:]] == list(engraving().glyphs["H"].curves)
    found = telling(drawing, "texts")
    assert found.text == (
        "2 texts are read as curves to machine: 1 in the engraving face, for font romans.shx is not installed here, "
        "1 in the engraving face, for font broken.ttf is not installed here; leave them out with --skip-type TEXT."
    )
    assert not found.counts


def test_a_letter_that_a_font_lacks_is_of_the_engraving_face_and_one_that_nobody_has_is_a_finding(fonts: Path) -> None:
    drawing = read(text("HA日", insert=(3, 4), layer="words"))
    outlines, strokes = ([e.curve for e in drawing.part.entities if e.lettering is wanted] for wanted in (False, True))
    assert near(boxes(outlines), [(4, 4, 8, 11)])
    assert min(curve.start[0] for curve in strokes) == pytest.approx(9) and len(strokes) == len(
        engraving().glyphs["A"].curves
    )
    found = telling(drawing, "No font here")
    assert found.text == (
        "No font here has 日, missing from the text at (3.000, 4.000) on layer words; "
        "install the drawing's font, or leave them out with --skip-type TEXT."
    )
    assert found.counts and found.kind is FindingKind.LEFT_OUT


def test_texts_are_left_out_as_asked_and_say_nothing_where_nothing_is_machined(fonts: Path) -> None:
    document = text("H日", layer="notes")
    document.modelspace().add_circle((0, 0), 5)
    drawing = read(document, without_types=("text",))
    assert len(drawing.part.entities) == 1 and dict(drawing.left_out) == {"TEXT (as asked)": 1}
    document.layers.add("notes").off()
    assert [f.text for f in read(document).findings if "text" in f.text or "font" in f.text] == []
    assert len(read(document, ("notes",)).findings) == 2


def test_a_text_that_is_too_long_is_left_out_by_name(fonts: Path) -> None:
    document = text("H" * 10_001)
    document.modelspace().add_circle((0, 0), 5)
    assert dict(read(document).left_out) == {"TEXT (of more than 10000 letters)": 1}


def test_a_text_without_letters_is_nothing(fonts: Path) -> None:
    document = text("  ")
    document.modelspace().add_circle((0, 0), 5)
    drawing = read(document)
    assert len(drawing.part.entities) == 1 and not drawing.findings and not drawing.left_out


@pytest.mark.parametrize(("flags", "shown"), [(2, True), (3, False), (0, False)])
def test_a_constant_attribute_is_a_text_of_its_block(fonts: Path, flags: int, shown: bool) -> None:
    document = new()
    block = document.blocks.new("B")
    block.add_circle((0, 0), 1)
    block.add_attdef("TAG", (2, 0), "H", height=7, dxfattribs={"style": "BLOCK", "flags": flags})
    document.modelspace().add_blockref("B", (10, 20))
    circle, *letters = curves(document)
    assert circle == Circle((10, 20), 1)
    assert near(boxes(letters), [(13, 20, 17, 27)] if shown else [])


def with_attributes(**insert: Any) -> Any:
    document = new("R2018")
    document.blocks.new("B").add_circle((0, 0), 1)
    made = document.modelspace().add_blockref("B", (50, 60), dxfattribs={"layer": "outer", **insert})
    made.add_attrib("A", "H", (10, 20), dxfattribs={"style": "BLOCK", "height": 7})
    return document


def lettered(drawing: Drawing) -> list[Entity]:
    return [entity for entity in drawing.part.entities if not isinstance(entity.curve, Circle)]


def test_attributes_lie_where_they_say_on_the_layer_of_the_insert(fonts: Path) -> None:
    drawing = read(with_attributes())
    assert near(boxes([e.curve for e in lettered(drawing)]), [(11, 20, 15, 27)]) and {
        e.layer for e in lettered(drawing)
    } == {"outer"}
    assert "--skip-type ATTRIB" in telling(drawing, "text").text
    assert dict(read(with_attributes(), without_types=("ATTRIB",)).left_out) == {"ATTRIB (as asked)": 1}


def test_attributes_come_with_every_copy_and_not_on_a_frozen_layer(fonts: Path) -> None:
    document = with_attributes(column_count=3, column_spacing=100)
    found = boxes([e.curve for e in lettered(read(document))])
    assert near(found, [(11 + dx, 20, 15 + dx, 27) for dx in (0, 100, 200)])
    document.layers.add("outer").freeze()
    document.modelspace().add_circle((0, 0), 3)
    assert len(read(document).part.entities) == 1


def test_attributes_that_are_not_shown_or_of_several_lines(fonts: Path) -> None:
    document = with_attributes()
    (insert,) = document.modelspace()
    insert.attribs[0].is_invisible = True
    mtext = document.modelspace().add_mtext("H\\PH", dxfattribs={"style": "BLOCK", "char_height": 7, "insert": (0, 0)})
    insert.add_attrib("M", "", (0, 0)).embed_mtext(mtext)
    document.modelspace().delete_entity(mtext)
    drawing = read(document)
    assert dict(drawing.left_out) == {"ATTRIB (invisible)": 1}
    assert near(boxes([e.curve for e in lettered(drawing)]), [(1, -7, 5, 0), (1, -7 - 35 / 3, 5, -35 / 3)])


def test_looking_for_a_font_by_its_file_opens_none(fonts: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(typeface, "TTFont", None)
    assert typeface.installed("BLOCK.TTF") == fonts / "block.ttf" and typeface.installed("txt.shx") is None
