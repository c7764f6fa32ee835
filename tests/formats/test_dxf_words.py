"""Drawings as tolerant programs read them: words in any letters, blanks round words and names, sections that come
several times, blocks without an end mark, and whatever follows the end.
"""

from collections.abc import Callable
from typing import NamedTuple

import pytest

from app.formats.drawing import Drawing
from app.formats.dxf.dxf import read_dxf


class Tag(NamedTuple):
    """A group code and its value."""

    code: int
    value: object


Tags = list[Tag]


def section(name: str, *tags: Tag) -> Tags:
    """Return a section."""
    return [Tag(0, "SECTION"), Tag(2, name), *tags, Tag(0, "ENDSEC")]


def layer(name: str, flags: int, colour: int) -> Tags:
    """Return a table of one layer."""
    return [
        Tag(0, "TABLE"),
        Tag(2, "LAYER"),
        Tag(70, 1),
        Tag(0, "LAYER"),
        Tag(2, name),
        Tag(70, flags),
        Tag(62, colour),
        Tag(0, "ENDTAB"),
    ]


def block(name: str, *drawn: Tag) -> Tags:
    """Return a block."""
    return [
        Tag(0, "BLOCK"),
        Tag(8, "0"),
        Tag(2, name),
        Tag(70, 0),
        Tag(10, 0.0),
        Tag(20, 0.0),
        *drawn,
        Tag(0, "ENDBLK"),
    ]


def line(y: float, on: str) -> Tags:
    """Return a line of 5 mm."""
    return [Tag(0, "LINE"), Tag(8, on), Tag(10, 0.0), Tag(20, y), Tag(11, 5.0), Tag(21, y)]


def insert(name: str) -> Tags:
    """Return a block that is inserted."""
    return [Tag(0, "INSERT"), Tag(8, "0"), Tag(2, name), Tag(10, 20.0), Tag(20, 0.0)]


HEADER = section("HEADER", Tag(9, "$INSUNITS"), Tag(70, 4))
TABLES = section("TABLES", *layer("Frozen", 1, 1), *layer("Off", 0, -1))
INNER, OUTER = block("Inner", *line(1.0, "0")), block("Outer", *insert("Inner"), *line(2.0, "Off"))
DRAWN = (*line(7.0, "0"), *line(8.0, "Off"), *line(9.0, "Frozen"), *insert("Outer"))
WHOLE = [*HEADER, *TABLES, *section("BLOCKS", *INNER, *OUTER), *section("ENTITIES", *DRAWN), Tag(0, "EOF")]
WORDS = {"HEADER", "TABLES", "BLOCKS", "ENTITIES", "LAYER"}


def text(pairs: Tags, pair: Callable[[int, object], str] = "{0}\n{1}\n".format) -> bytes:
    """Return a file."""
    return "".join(pair(code, value) for code, value in pairs).encode()


def read(data: bytes) -> tuple[list[tuple[str, object]], list[object], list[str]]:
    """Return the curves, the layers, and the findings that count."""
    drawing: Drawing = read_dxf(data, "a.dxf")
    part = drawing.part
    curves: list[tuple[str, object]] = [(each.layer.casefold(), each.curve) for each in part.entities]
    layers: list[object] = [(each.name.casefold(), each.visible) for each in part.layers]
    return curves, sorted(layers, key=str), [each.text for each in drawing.findings if each.counts]


def small(code: int, value: object) -> str:
    """Return a pair in small letters."""
    return f"{code}\n{str(value).lower()}\n"


def small_words(code: int, value: object) -> str:
    """Return a pair with words of the format in small letters."""
    return f"{code}\n{str(value).lower() if code == 0 or value in WORDS else value}\n"


ALIKE = {
    "small letters": text(WHOLE, small),
    "small words": text(WHOLE, small_words),
    "blanks behind": text(WHOLE, "{0}  \n{1}  \n".format),
    "blanks before": text(WHOLE, "  {0}\n  {1}\n".format),
    "codes of three digits": text(WHOLE, "{0:03}\n{1}\n".format),
    "carriage returns": text(WHOLE, "{0}\r{1}\r".format),
    "carriage returns and one line feed": text(WHOLE, "{0}\r{1}\r".format) + b"\n",
    "tables apart": text(
        [
            *HEADER,
            *section("TABLES", *layer("Frozen", 1, 1)),
            *section("TABLES", *layer("Off", 0, -1)),
            *section("BLOCKS", *INNER, *OUTER),
            *section("ENTITIES", *DRAWN),
            Tag(0, "EOF"),
        ]
    ),
    "blocks apart": text(
        [
            *HEADER,
            *TABLES,
            *section("BLOCKS", *INNER),
            *section("BLOCKS", *OUTER),
            *section("ENTITIES", *DRAWN),
            Tag(0, "EOF"),
        ]
    ),
    "headers apart": text(
        [*HEADER, *section("HEADER", Tag(9, "$LIMMIN"), Tag(10, 0.0), Tag(20, 0.0)), *WHOLE[len(HEADER) :]]
    ),
    "blocks without an end": text([pair for pair in WHOLE if pair[1] != "ENDBLK"]),
    "zeros behind": text(WHOLE) + bytes(9000),
    "a text behind": text(WHOLE) + b"of another file\n" * 900,
}


@pytest.mark.parametrize("way", ALIKE)
def test_a_drawing_is_read_as_if_it_were_written_plainly(way: str) -> None:
    curves, layers, counted = read(text(WHOLE))
    assert len(curves) == 5 and not counted and ("off", False) in layers and ("frozen", False) in layers
    assert read(ALIKE[way]) == (curves, layers, [])


def test_what_stands_outside_of_all_sections_is_told() -> None:
    _, _, counted = read(text([*HEADER, *section("ENTITIES", *line(1.0, "0")), *line(2.0, "0"), Tag(0, "EOF")]))
    assert len(counted) == 1 and "damaged" in counted[0]


PAGES = {
    "ANSI_932": ("cp932", "外形ソ表ﾃｱ"),
    "DOS932": ("cp932", "外形"),
    "GB2312": ("gbk", "轮廓"),
    "BIG5": ("cp950", "輪廓"),
    "ANSI_1361": ("johab", "윤곽"),
    "DOS850": ("cp850", "schräge"),
    "dos866": ("cp866", "контур"),
    "ISO8859-2": ("iso8859-2", "žluť"),
    "ISO-8859-15": ("iso8859-15", "žœ€"),
    "MACINTOSH": ("mac-roman", "schräge"),
    "ANSI_1252": ("cp1252", "schräge"),
    "UTF-8": ("utf-8", "外形"),
}


@pytest.mark.parametrize("version", ["AC1009", "AC1015"])
@pytest.mark.parametrize("page", PAGES)
@pytest.mark.parametrize("damaged", [False, True])
def test_letters_are_those_of_the_code_page_that_is_named(page: str, version: str, damaged: bool) -> None:
    encoding, name = PAGES[page]
    head = section("HEADER", Tag(9, "$ACADVER"), Tag(1, version), Tag(9, "$DWGCODEPAGE"), Tag(3, page))
    drawn = section("ENTITIES", *line(1.0, name))
    curves, _, counted = read(text([*head, *drawn[: len(drawn) - damaged], Tag(0, "EOF")]).decode().encode(encoding))
    assert [layer for layer, _ in curves] == [name] and len(counted) == damaged


@pytest.mark.parametrize(
    ("version", "page", "encoding", "name"),
    [
        ("AC1009", "", "utf-8", "外形"),
        ("AC1015", "ANSI_1252", "utf-8", "schräge"),
        ("AC1015", "ANSI_932", "utf-8", "外形"),
        ("AC1032", "ANSI_932", "cp932", "外形"),
        ("AC1032", "", "cp1252", "schräge"),
        ("AC1015", "NONSENSE", "cp1252", "schräge"),
    ],
)
def test_letters_that_are_not_in_the_code_page_told_are_read_as_they_are(
    version: str, page: str, encoding: str, name: str
) -> None:
    told: Tags = [Tag(9, "$DWGCODEPAGE"), Tag(3, page)] if page else []
    head = section("HEADER", Tag(9, "$ACADVER"), Tag(1, version), *told)
    data = text([*head, *section("ENTITIES", *line(1.0, name)), Tag(0, "EOF")]).decode().encode(encoding)
    assert [layer for layer, _ in read(data)[0]] == [name]


@pytest.mark.parametrize(
    ("page", "encoding", "stray", "other"),
    [
        ("ANSI_1252", "cp1252", "schräge", "外形"),
        ("ANSI_932", "cp932", "表ソ", "外形"),
        ("", "cp1252", "é", "schräge"),
    ],
)
def test_a_line_that_is_not_in_utf8_leaves_the_others_as_they_are(
    page: str, encoding: str, stray: str, other: str
) -> None:
    told: Tags = [Tag(9, "$DWGCODEPAGE"), Tag(3, page)] if page else []
    head = section("HEADER", Tag(9, "$ACADVER"), Tag(1, "AC1032"), *told)
    data = text([*head, *section("ENTITIES", *line(1.0, "STRAY"), *line(2.0, other)), Tag(0, "EOF")])
    curves, _, _ = read(data.replace(b"STRAY", stray.encode(encoding)))
    assert [layer for layer, _ in curves] == [stray, other]


def test_letters_of_a_file_of_carriage_returns_are_those_of_its_encoding() -> None:
    head = section("HEADER", Tag(9, "$ACADVER"), Tag(1, "AC1032"))
    curves, _, _ = read(text([*head, *section("ENTITIES", *line(1.0, "Schräge")), Tag(0, "EOF")], "{0}\r{1}\r".format))
    assert [name for name, _ in curves] == ["schräge"]


STRAY = line(3.0, "0")
STRAYS = {
    "between blocks": section("BLOCKS", *INNER, *STRAY, *OUTER),
    "before the blocks": section("BLOCKS", *STRAY, *INNER, *OUTER),
    "behind the blocks": section("BLOCKS", *INNER, *OUTER, *STRAY),
    "among objects": [
        *section("BLOCKS", *INNER, *OUTER),
        *section("OBJECTS", Tag(0, "DICTIONARY"), Tag(5, "C"), *STRAY),
    ],
    "in the header": [*section("BLOCKS", *INNER, *OUTER), *section("HEADER", *STRAY)],
    "in a section that nobody knows": [*section("BLOCKS", *INNER, *OUTER), *section("ENTITES", *STRAY)],
}


@pytest.mark.parametrize("where", STRAYS)
def test_what_is_drawn_where_nobody_looks_is_told(where: str) -> None:
    curves, _, counted = read(text([*HEADER, *TABLES, *STRAYS[where], *section("ENTITIES", *DRAWN), Tag(0, "EOF")]))
    assert len(curves) == 5 and len(counted) == 1
    assert counted[0].startswith("1 entity stands outside of the drawing and its blocks (1 LINE) and is missing")


@pytest.mark.parametrize("last", [False, True])
def test_a_variable_without_a_value_says_nothing(last: bool) -> None:
    told: Tags = [Tag(9, "$INSUNITS"), Tag(70, 4)]
    empty: Tags = [Tag(9, "$LIMMIN")]
    head = section("HEADER", *(told + empty if last else empty + told))
    drawing = read_dxf(text([*head, *section("ENTITIES", *line(1.0, "0")), Tag(0, "EOF")]), "a.dxf")
    assert drawing.units_named and not drawing.findings


def test_an_end_mark_where_nothing_ends_is_nothing() -> None:
    _, _, counted = read(
        text([*HEADER, *section("ENTITIES", *line(1.0, "0"), Tag(0, "SEQEND"), Tag(8, "0")), Tag(0, "EOF")])
    )
    assert not counted


PLACE: Tags = [Tag(8, "0"), Tag(10, 1.0), Tag(20, 2.0)]
LACKING: dict[str, Tags] = {
    "LINE": PLACE,
    "CIRCLE": PLACE,
    "ARC": [*PLACE, Tag(40, 3.0), Tag(50, 30.0)],
    "ELLIPSE": [*PLACE, Tag(11, 5.0), Tag(21, 0.0)],
    "POINT": [Tag(8, "0")],
    "TEXT": [*PLACE, Tag(1, "A")],
    "MTEXT": [Tag(8, "0"), Tag(40, 2.5), Tag(1, "A")],
    "SOLID": [*PLACE, Tag(11, 5.0), Tag(21, 0.0)],
    "POLYLINE": [Tag(8, "0"), Tag(0, "VERTEX"), *PLACE, Tag(0, "VERTEX"), Tag(8, "0"), Tag(0, "SEQEND")],
}


@pytest.mark.parametrize("kind", LACKING)
def test_an_entity_that_lacks_a_number_is_missing_never_drawn_with_one_that_nobody_wrote(kind: str) -> None:
    data = text([*HEADER, *section("ENTITIES", *line(1.0, "0"), Tag(0, kind), *LACKING[kind]), Tag(0, "EOF")])
    drawing = read_dxf(data, "a.dxf")
    assert len(drawing.part.entities) == 1 and not drawing.part.notes
    assert dict(drawing.left_out) == {f"{kind} (damaged)": 1} and any(each.counts for each in drawing.findings)


CIRCLE: Tags = [Tag(0, "CIRCLE"), Tag(8, "0"), Tag(10, 9.0), Tag(20, 9.0), Tag(40, 2.0)]


@pytest.mark.parametrize("version", ["AC1009", "AC1015"])
@pytest.mark.parametrize("first", [CIRCLE, line(5.0, "0"), insert("Inner")])
def test_two_entities_that_have_become_one_are_missing(version: str, first: Tags) -> None:
    head = section("HEADER", Tag(9, "$ACADVER"), Tag(1, version))
    drawn = section("ENTITIES", *line(1.0, "0"), *first, *CIRCLE[1:])
    drawing = read_dxf(text([*head, *section("BLOCKS", *INNER), *drawn, Tag(0, "EOF")]), "a.dxf")
    assert len(drawing.part.entities) == 1 and dict(drawing.left_out) == {f"{first[0][1]} (damaged)": 1}
    assert [each.counts for each in drawing.findings if "cannot be read" in each.text] == [True]


def test_a_second_place_in_the_data_of_another_program_is_none_of_the_entity() -> None:
    more = [
        Tag(1001, "ACAD"),
        Tag(1010, 1.0),
        Tag(1020, 2.0),
        Tag(1030, 0.0),
        Tag(1011, 3.0),
        Tag(1021, 3.0),
        Tag(1031, 0.0),
    ]
    curves, _, counted = read(text([*section("ENTITIES", *line(1.0, "0"), *more), Tag(0, "EOF")]))
    assert len(curves) == 1 and not counted


MARKED = [Tag(0, "LWPOLYLINE"), Tag(5, "A1"), Tag(100, "AcDbEntity"), Tag(8, "0"), Tag(100, "AcDbPolyline")]
CORNERS = [Tag(90, 2), Tag(70, 0), Tag(10, 1.0), Tag(20, 2.0), Tag(10, 3.0), Tag(20, 4.0)]


@pytest.mark.parametrize("marks", [MARKED, [*MARKED, MARKED[-1]], [*MARKED[:3], MARKED[2], *MARKED[3:]]])
def test_marks_that_come_twice_lose_nothing(marks: Tags) -> None:
    head = section("HEADER", Tag(9, "$ACADVER"), Tag(1, "AC1015"))
    curves, _, counted = read(text([*head, *section("ENTITIES", *line(1.0, "0"), *marks, *CORNERS), Tag(0, "EOF")]))
    assert len(curves) == 2 and not counted


@pytest.mark.parametrize("kind", ["LWPOLYLINE", "SPLINE"])
def test_a_curve_without_any_point_is_missing(kind: str) -> None:
    drawing = read_dxf(text([*section("ENTITIES", *line(1.0, "0"), Tag(0, kind), Tag(8, "0")), Tag(0, "EOF")]), "a.dxf")
    assert dict(drawing.left_out) == {f"{kind} (damaged)": 1} and any(each.counts for each in drawing.findings)
