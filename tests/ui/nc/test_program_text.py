"""Lines cut out of a program's text, and what is found in them."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.gcode.interpreter.text import ProgramBuffer
from app.ui.views.nc.program_text import program_text
from app.ui.views.nc.syntax import SyntaxPart, spans


@given(st.text(alphabet="G1 Xx\n\r(é刃\u2028;", max_size=60))
def test_lines_are_those_that_the_reader_counts(words):
    data = words.encode()
    made, offset = program_text(data), 0
    read = ProgramBuffer(data)
    for row in range(len(made)):
        assert made.line(row) == read.line(offset)
        offset = read.line_end(offset) + 1
    assert len(made) == read.line_count


def test_latin_1_and_byte_order_marks_are_read():
    assert program_text("(Fräser)\nG0".encode("latin-1")).line(0) == "(Fräser)"
    assert program_text(b"\xef\xbb\xbfG0 X1\n").line(0) == "G0 X1"


def test_a_piece_of_a_very_long_line_ends_with_it():
    made = program_text(b"X" * 30 + b"\nY\n")
    assert made.piece(0, 28, 100) == "XX"
    assert (made.longest, made.length(1)) == (30, 1)


@pytest.mark.parametrize(
    ("position", "back", "row"), [(0, False, 0), (1, False, 2), (10, False, 0), (8, True, 0), (0, True, 2)]
)
def test_finding_goes_round_both_ways(position, back, row):
    made = program_text(b"G1 X\ng2\nG1 Y\n")
    assert made.row_at(made.find("g1", position, back)) == row


def test_finding_counts_whatever_the_case():
    made = program_text(b"G1 X\nG0\ng1\n")
    assert made.count("G1") == 2
    assert made.count("g1", before=6) == 1
    assert made.rows_with("g1").tolist() == [0, 2]
    assert made.find("g3", 0) is None


def parts(line):
    return [(line[first:last], part) for first, last, part in spans(line) if line[first:last].strip()]


def test_words_have_their_part():
    assert parts("N10 G1 X-1.5 F200 (feed) ; end") == [
        ("N10", SyntaxPart.LINE_NUMBER),
        ("G1", SyntaxPart.COMMAND),
        (" X-1.5 ", SyntaxPart.PLAIN),
        ("F200", SyntaxPart.SETTING),
        ("(feed)", SyntaxPart.COMMENT),
        ("; end", SyntaxPart.COMMENT),
    ]


@pytest.mark.parametrize("line", ["o<bore> sub", "#<_depth> = [1 + #5]", "WHILE [#1 LT 5] DO1", "IF [#2 EQ 0] GOTO 10"])
def test_flow_and_parameters_are_marked(line):
    assert parts(line)[0][1] is SyntaxPart.FLOW


@given(st.text(alphabet="gGmM012.#<>[]()o; nfst-\t", max_size=40))
def test_parts_cover_the_line(line):
    found = spans(line)
    assert "".join(line[first:last] for first, last, _ in found) == line


def test_percent_begins_a_comment_only_at_the_start():
    assert parts("%")[0][1] is SyntaxPart.COMMENT
