"""MTEXT of a DXF: lines, where they break, and what the codes in them say."""

import math
from pathlib import Path
from typing import Any

import pytest

from app.formats.drawing import Drawing
from tests.formats.block_font import boxes, fonts
from tests.formats.test_dxf_text import curves, near, new, read

__all__ = ["fonts"]

LINE = 35 / 3
"""From baseline to baseline of letters 7 high."""


def mtext(content: str, **attributes: Any) -> Any:
    document = new()
    document.modelspace().add_mtext(
        content, dxfattribs={"style": "BLOCK", "char_height": 7, "attachment_point": 7, **attributes}
    )
    return document


def letters(content: str, **attributes: Any) -> list[tuple[float, float, float, float]]:
    return boxes(curves(mtext(content, **attributes)))


def corners(content: str, **attributes: Any) -> list[tuple[float, float]]:
    """Return the lower left corner of each letter, without what is beside it in the font."""
    return [(x0 - (x1 - x0) / 4, y0) for x0, y0, x1, _ in letters(content, **attributes)]


@pytest.mark.parametrize("point", range(1, 10))
def test_two_lines_about_the_insertion_point(fonts: Path, point: int) -> None:
    """Its box is from the top of the first capitals to the last baseline, as wide as the widest line."""
    across, down = (point - 1) % 3, (point - 1) // 3
    x = -12 * across / 2
    first = -7 + (7 + LINE) * down / 2
    found = letters("HH\\PH", attachment_point=point, insert=(100, 200))
    short = 100 + x + 3 * across
    expected = [(101 + x, first), (107 + x, first), (short + 1, first - LINE)]
    assert near([box[:2] for box in found], [(a, 200 + b) for a, b in expected])


def test_lines_that_are_full_go_on_in_the_next(fonts: Path) -> None:
    """Two letters with a blank between them are 15 wide."""
    assert near(corners("H H H", width=15), [(0, LINE), (9, LINE), (0, 0)])
    assert near(corners("H H H", width=14.9), [(0, 2 * LINE), (0, LINE), (0, 0)])
    assert near(corners("HHH H", width=5), [(0, LINE), (6, LINE), (12, LINE), (0, 0)])
    assert near(corners("H\\~H H", width=15), [(0, LINE), (9, LINE), (0, 0)])


def test_spacing_and_empty_lines(fonts: Path) -> None:
    assert near(corners("H\\P\\PH", line_spacing_factor=0.5), [(0, LINE), (0, 0)])
    assert near(corners("H\n{\\H14;H}", line_spacing_style=2), [(0, LINE), (0, 0)])
    assert near(corners("H\n{\\H14;H}"), [(0, 2 * LINE), (0, 0)])


@pytest.mark.parametrize(
    ("content", "box"),
    [
        ("\\H2x;H", (2, 0, 10, 14)),
        ("\\H14;H", (2, 0, 10, 14)),
        ("\\W2;H", (2, 0, 10, 7)),
        ("{\\H2x;}H", (1, 0, 5, 7)),
        ("\\fBlock|b1|i0;H", (1, 0, 5, 7)),
        ("\\Fheavy.ttf;H", (1, 0, 5, 7)),
        ("\\pql;H", (1, 0, 5, 7)),
        ("\\pi1;H", (8, 0, 12, 7)),
        ("\\C1;H", (1, 0, 5, 7)),
        ("\\U+0048", (1, 0, 5, 7)),
        ("%%c", (0, 0, 7, 7)),
        ("\tH", (29, 0, 33, 7)),
        ("\\pt2;\tH", (15, 0, 19, 7)),
    ],
)
def test_codes(fonts: Path, content: str, box: tuple[float, ...]) -> None:
    assert near(letters(content), [box])


def test_letters_lean_and_stand_apart_as_told(fonts: Path) -> None:
    assert near(letters("\\Q45;H"), [(1, 0, 12, 7)])
    assert near(corners("\\T2;HH"), [(0, 0), (12, 0)])


def test_smaller_letters_stand_at_the_bottom_the_middle_or_the_top(fonts: Path) -> None:
    for code, y in (("0", 0.0), ("1", 1.75), ("2", 3.5)):
        assert near(corners(f"H{{\\H0.5x;\\A{code};H}}"), [(0, 0), (6, y)])


def test_fractions(fonts: Path) -> None:
    """Rows of 4.9 about the middle of the capitals, 1.4 apart; beside a stroke the upper one ends with the capitals."""
    limits = letters("\\SH^ H;")
    assert near(limits, [(0.7, 4.2, 3.5, 9.1), (0.7, -2.1, 3.5, 2.8)])
    assert near(letters("\\SH/H;"), [*limits, (0, 3.25, 4.2, 3.75)])
    drawing = read(mtext("\\SH#H;"))
    outlines = boxes([e.curve for e in drawing.part.entities if not e.lettering])
    assert outlines[0] == pytest.approx((0.7, 2.1, 3.5, 7.0)) and outlines[1][1] == 0


def test_lines_of_the_style(fonts: Path) -> None:
    document = mtext("\\LHH")
    document.styles.get("BLOCK").dxf.width = 2
    assert near(boxes(curves(document)), [(2, 0, 10, 7), (14, 0, 22, 7), (0, -1.65, 24, -1.15)])


ALONG = (math.cos(math.radians(17)), math.sin(math.radians(17)), 0)


@pytest.mark.parametrize("attributes", [{"rotation": 17}, {"text_direction": ALONG, "rotation": 80}])
def test_turned_by_an_angle_or_a_direction_which_comes_first(fonts: Path, attributes: dict[str, Any]) -> None:
    ends = [curve.start for curve in curves(mtext("H", insert=(3, 4), **attributes))]
    corner = complex(5, 7) * complex(math.cos(math.radians(17)), math.sin(math.radians(17))) + complex(3, 4)
    assert any(math.dist(end, (corner.real, corner.imag)) < 1e-9 for end in ends)


def test_from_below_it_is_mirrored(fonts: Path) -> None:
    assert near(letters("H", insert=(3, 4), text_direction=(1, 0, 0), extrusion=(0, 0, -1)), [(4, -3, 8, 4)])


def left_out(document: Any) -> Drawing:
    document.modelspace().add_circle((0, 0), 1)
    return read(document)


def test_columns_with_a_text_each_are_read_beside_one_another(fonts: Path) -> None:
    """As far apart as a column is wide and its gutter, along the text."""
    document = new()
    document.modelspace().add_mtext_static_columns(
        ["H", "H", "H"], 50, 5, 100, dxfattribs={"insert": (3, 4), "style": "BLOCK", "char_height": 7, "rotation": 90}
    )
    found = read(document)
    assert not found.left_out
    ys = sorted({round(min(each.curve.start[1], each.curve.end[1])) for each in found.part.entities})
    low, high = ys[0], ys[-1]
    assert high - low >= 110 and len(found.part.entities) % 3 == 0


def test_a_text_that_is_not_read_is_named_with_its_place(fonts: Path) -> None:
    document = new()
    block = document.blocks.new("B")
    block.add_mtext("H" * 10_001, dxfattribs={"insert": (1, 2)})
    for x in (100, 200):
        document.modelspace().add_blockref("B", (x, 50), dxfattribs={"layer": "L"})
    said = [(each.text, each.x, each.y) for each in left_out(document).findings if "not read" in each.text]
    long = "MTEXT (of more than 10000 letters)"
    assert (f"2 {long} are not read, the first at (101.000, 52.000) on layer L.", 101.0, 52.0) in said


def test_a_text_that_is_too_long_is_left_out_by_name(fonts: Path) -> None:
    drawing = left_out(mtext("H" * 10_001))
    assert dict(drawing.left_out) == {"MTEXT (of more than 10000 letters)": 1}
    (text,) = [each.text for each in drawing.findings if each.text.startswith("Left out")]
    assert text.endswith("letters).")


@pytest.mark.parametrize(
    "content",
    [
        "\\S",
        "\\S;",
        "\\H;H",
        "{{{H",
        "}}}H",
        "\\pi;H",
        "\\f;H",
        "\\",
        "\\H-2x;H",
        "\\pt;\tH",
        "\\W0;H",
        "\\T0;H",
        "\\Q90;H",
    ],
)
def test_codes_that_are_not_whole_do_no_harm(fonts: Path, content: str) -> None:
    assert not any("MTEXT" in what for what, _ in left_out(mtext(content)).left_out)
