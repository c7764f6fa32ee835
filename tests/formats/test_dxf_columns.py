"""Texts of a DXF that is written anew: one MTEXT in columns, and letters below one another; every letter's box."""

from pathlib import Path
from typing import Any

import pytest

from tests.formats.block_font import boxes, fonts
from tests.formats.test_dxf_text import curves, near, new, read

__all__ = ["fonts"]

LINE = 35 / 3
"""From baseline to baseline of letters 7 high."""
DOWN = 1.5 * 7
"""From letter to letter of a line that runs down."""
LOOK = {"style": "BLOCK", "char_height": 7, "attachment_point": 1}


def columned(kind: str, content: Any, *sizes: Any, version: str = "R2018", **attributes: Any) -> Any:
    document = new(version)
    add = getattr(document.modelspace(), f"add_mtext_{kind}_columns")
    add(content, *sizes, dxfattribs=LOOK | attributes)
    return document


def corners(document: Any) -> list[tuple[float, float]]:
    """Return the lower left corner of each letter, without what is beside it in the font."""
    return [(x0 - (x1 - x0) / 4, y0) for x0, y0, x1, _ in boxes(curves(document))]


@pytest.mark.parametrize("version", ["R2000", "R2018"])
def test_columns_whose_ends_the_text_tells_stand_beside_one_another(fonts: Path, version: str) -> None:
    """Also where the text of a column is longer than it is high: it goes on in the last one only."""
    document = columned("static", ["H", "HH\\PH", "H"], 50, 5, 100, version=version, insert=(3, 4))
    expected = [(3, -3), (58, -3), (64, -3), (58, -3 - LINE), (113, -3)]
    assert near(corners(document), expected)


@pytest.mark.parametrize(
    ("height", "lines"),
    [(7.0, 1), (7 + LINE, 2), (7 + LINE - 0.01, 1), (7 + 2 * LINE, 3), (3.0, 1)],
)
def test_columns_that_are_full_go_on_in_the_next_as_far_as_there_is_text(
    fonts: Path, height: float, lines: int
) -> None:
    """A line is in a column whose height its baseline is within, at least one in each."""
    document = columned("dynamic_auto_height", "H H H H H", 8, 2, height, 2)
    expected = [(10 * (k // lines), -7 - LINE * (k % lines)) for k in range(5)]
    assert near(corners(document), expected)


def test_as_many_columns_as_told_the_last_without_an_end(fonts: Path) -> None:
    document = columned("dynamic_manual_height", "H H H H H", 8, 2, [7 + LINE, 7, 7])
    assert near(corners(document), [(0, -7), (0, -7 - LINE), (10, -7), (20, -7), (20, -7 - LINE)])
    document = columned("static", ["H\\PH\\PH", "H\\PH"], 8, 2, 7)
    assert near(corners(document), [(0, -7), (10, -7), (10, -7 - LINE), (20, -7), (20, -7 - LINE)])


def test_columns_that_go_on_to_the_left(fonts: Path) -> None:
    document = columned("static", ["H", "H"], 50, 5, 100)
    (entity,) = document.modelspace()
    entity._columns.reversed_column_flow = True
    assert near(corners(document), [(55, -7), (0, -7)])


@pytest.mark.parametrize("point", range(1, 10))
def test_columns_about_the_insertion_point(fonts: Path, point: int) -> None:
    """All columns are one box, as high as a column may be; letters lie in a column as the point says."""
    across, down = (point - 1) % 3, (point - 1) // 3
    document = columned("static", ["H", "H"], 50, 5, 100, insert=(200, 300), attachment_point=point)
    left, top = 200 - 105 * across / 2 + (50 - 6) * across / 2, 300 + 100 * down / 2
    assert near(corners(document), [(left, top - 7), (left + 55, top - 7)])


def test_a_break_of_columns_in_a_text_of_one_is_a_new_line(fonts: Path) -> None:
    document = new("R2018")
    document.modelspace().add_mtext("H\\NH", dxfattribs=LOOK)
    assert near(corners(document), [(0, -7), (0, -7 - LINE)])


def vertical(words: str, height: float = 7, **attributes: Any) -> Any:
    document = new()
    document.styles.add("DOWN", font="block.ttf").dxf.flags = 4
    document.modelspace().add_text(words, height=height, dxfattribs={"style": "DOWN", **attributes})
    return document


def test_letters_of_a_vertical_style_stand_upright_below_one_another(fonts: Path) -> None:
    """Each in the middle of the line, which is drawn downwards: turned by 270 degrees."""
    found = boxes(curves(vertical("HpH", insert=(10, 20), rotation=270)))
    assert near(
        found, [(8, 13, 12, 20), (8.5, 20 - DOWN - 9, 11.5, 20 - DOWN - 2), (8, 13 - 2 * DOWN, 12, 20 - 2 * DOWN)]
    )


def test_a_vertical_line_is_turned_as_told(fonts: Path) -> None:
    """Turned by 0 degrees it runs to the right, the heads of its letters to the left."""
    found = boxes(curves(vertical("H H", insert=(10, 20))))
    assert near(found, [(10, 18, 17, 22), (10 + 2 * DOWN, 18, 17 + 2 * DOWN, 22)])


@pytest.mark.parametrize(("halign", "up"), [(0, 0.0), (1, (DOWN + 7) / 2), (2, DOWN + 7), (4, (DOWN + 7) / 2)])
def test_a_vertical_line_begins_has_its_middle_or_ends_at_its_point(fonts: Path, halign: int, up: float) -> None:
    document = vertical("HH", rotation=270, halign=halign, insert=(1, 1), align_point=(10, 20))
    at = (10, 20) if halign else (1, 1)
    expected = [(at[0] - 2, at[1] + up - 7 - DOWN * k, at[0] + 2, at[1] + up - DOWN * k) for k in range(2)]
    assert near(boxes(curves(document)), expected)


@pytest.mark.parametrize("flow", [3, 5])
def test_lines_of_an_mtext_that_run_down_stand_to_the_right_of_one_another(fonts: Path, flow: int) -> None:
    """By its own direction, or by its style's; the width of its lines is none of theirs."""
    document = vertical("")
    document.modelspace().add_mtext(
        "HH H\\PH", dxfattribs=LOOK | {"style": "DOWN", "flow_direction": flow, "insert": (3, 4), "width": 1}
    )
    expected = [(4, -3), (4, -3 - DOWN), (4, -3 - 3 * DOWN), (4 + LINE, -3)]
    assert near([box[:2] for box in boxes(curves(document))], expected)


def test_a_vertical_style_says_nothing_where_the_mtext_has_a_direction(fonts: Path) -> None:
    document = vertical("")
    document.modelspace().add_mtext("HH", dxfattribs=LOOK | {"style": "DOWN", "flow_direction": 1})
    assert near(corners(document), [(0, -7), (6, -7)])


@pytest.mark.parametrize("point", range(1, 10))
def test_lines_that_run_down_about_the_insertion_point(fonts: Path, point: int) -> None:
    across, down = (point - 1) % 3, (point - 1) // 3
    document = new()
    document.modelspace().add_mtext("HH\\PH", dxfattribs=LOOK | {"flow_direction": 3, "attachment_point": point})
    left, top = 1 - (6 + LINE) * across / 2, (7 + DOWN) * down / 2
    expected = [(left, top - 7), (left, top - 7 - DOWN), (left + LINE, top - 7)]
    assert near([box[:2] for box in boxes(curves(document))], expected)


def test_a_fraction_of_a_line_that_runs_down_stays_whole(fonts: Path) -> None:
    document = new()
    document.modelspace().add_mtext("\\SH^ H;H", dxfattribs=LOOK | {"flow_direction": 3})
    over, under, below = boxes(curves(document))
    assert near([(over[0], over[1] - under[1])], [(under[0], 6.3)]) and below[1] == pytest.approx(-7 - DOWN)


def said_of(document: Any) -> list[str]:
    return [each.text for each in read(document).findings if "runs downwards in columns" in each.text]


def test_lines_that_run_down_stand_in_columns_beside_one_another(fonts: Path) -> None:
    """From the left edge of the column; where the text says that a new one begins."""
    document = columned("static", ["H", "HH\\PH", "H"], 50, 5, 100, flow_direction=3, insert=(3, 4))
    found = corners(document)
    assert near(found, [(3, -3), (58, -3), (58, -3 - DOWN), (58 + LINE, -3), (113, -3)])
    (said,) = said_of(document)
    assert "The text at (3.000, 4.000) on layer 0 runs downwards" in said


def test_lines_that_run_down_end_with_their_column_and_columns_with_their_width(fonts: Path) -> None:
    document = columned("dynamic_auto_height", "HHHHHHH", 20, 2, 7 + DOWN, 2, flow_direction=3)
    expected = [(22 * (k // 4) + LINE * (k % 4 // 2), -7 - DOWN * (k % 2)) for k in range(7)]
    assert near(corners(document), expected)


def test_the_last_column_of_lines_that_run_down_has_no_end(fonts: Path) -> None:
    document = columned("dynamic_manual_height", "HHHHHH", 5, 2, [7 + DOWN, 7], flow_direction=3)
    last = [(7, -7 - DOWN * k) for k in range(4)]
    assert near(corners(document), [(0, -7), (0, -7 - DOWN), *last])


@pytest.mark.parametrize("point", range(1, 10))
def test_columns_of_lines_that_run_down_about_the_insertion_point(fonts: Path, point: int) -> None:
    across, down = (point - 1) % 3, (point - 1) // 3
    document = columned("static", ["H", "H"], 50, 5, 100, flow_direction=3, attachment_point=point)
    left, top = -105 * across / 2, 100 * down / 2
    assert near(corners(document), [(left, top - 7), (left + 55, top - 7)])


@pytest.mark.parametrize(
    ("document", "called", "remedy"),
    [
        (
            vertical("HH", halign=3, align_point=(0, 9)),
            "TEXT (vertical, to fill a length)",
            "let letters run to the right",
        ),
    ],
)
def test_what_cannot_be_set_is_left_out_with_what_to_do(fonts: Path, document: Any, called: str, remedy: str) -> None:
    document.modelspace().add_circle((0, 0), 5)
    found = read(document)
    assert dict(found.left_out) == {called: 1}
    (said,) = [each.text for each in found.findings if each.text.startswith("Left out")]
    assert f"To machine them, {remedy}, or turn them into curves" in said
