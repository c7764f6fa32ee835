"""What belongs together in a text: blocks, indents, remarks, names."""

import pytest

from app.ui.views.language.blocks import block_words, family, indent_after, names_in, switched_remarks

LINES = [
    "repeat 3 as k",
    "  if k > 1",
    "    circle k,0 1",
    "  else",
    "    line 0,0 1,1",
    "  end",
    "end",
    "slot 0,0 1,1 2  # end",
    'layer "end"',
]


def test_words_of_blocks_are_those_that_begin_a_statement() -> None:
    assert block_words("repeat 3 as k; circle k,0 1; end") == [(0, "repeat"), (29, "end")]
    assert block_words("line 0,0 1,1 # repeat") == [] == block_words('layer "repeat"') == block_words("set 4 end 1,1")


@pytest.mark.parametrize(("row", "column"), [(1, 2), (3, 4), (5, 5)])
def test_the_words_of_a_block_are_found_from_each_of_them(row: int, column: int) -> None:
    assert family(LINES, row, column) == ((1, 2, 2), (3, 2, 4), (5, 2, 3))


def test_a_block_without_end_and_a_place_at_no_word() -> None:
    assert family(LINES[:2], 0, 0) == ((0, 0, 6),)
    assert family(LINES, 2, 5) == () == family(LINES, 7, 20)
    assert family(LINES, 6, 0) == ((0, 0, 6), (6, 0, 3))


@pytest.mark.parametrize(
    ("line", "indent"),
    [
        ("repeat 3", "  "),
        ("  if a > b", "    "),
        ("  else", "    "),
        ("  end", "  "),
        ("circle 0,0 1", ""),
        ("repeat 3; circle 0,0 1; end", ""),
    ],
)
def test_the_next_line_is_indented_as_it_belongs(line: str, indent: str) -> None:
    assert indent_after(line) == indent


def test_remarks_are_put_and_taken_back() -> None:
    lines = ["  let a = 1", "", "    circle 0,0 a"]
    remarks = switched_remarks(lines)
    assert remarks == ["  # let a = 1", "", "  #   circle 0,0 a"]
    assert switched_remarks(remarks) == lines


def test_names_of_a_text() -> None:
    text = "let w = 3\ncircle 0,0 w as hole\ndefine bolt(place, size)\nrepeat 3 as k"
    assert list(names_in(text)) == [
        ("w", False),
        ("hole", False),
        ("bolt", True),
        ("place", False),
        ("size", False),
        ("k", False),
    ]
