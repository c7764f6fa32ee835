"""units in … end: lengths without a unit count in inches, counts, factors and angles do not."""

import pytest

from app.drafting.document import Document
from app.drafting.expressions.errors import CommandError


def drawn(text: str) -> object:
    document = Document()
    document.run_script(text)
    return [entity.curve for entity in document.part.entities]


@pytest.mark.parametrize(
    ("inside", "written_out"),
    [
        ("circle 1,2 0.5", "circle 1in,2in 0.5in"),
        ("circle 1,2 0.5mm", "circle 1in,2in 0.5"),
        ("circle 1,2 1/8", "circle 1in,2in 1/8in"),
        ("line 0,0 @2<30 @1,(1 + 5mm)", "line 0,0 @2in<30 @1in,(1in + 5mm)"),
        ("let w = 3\nrect 0,0 w,w/2 round 1/4", "rect 0,0 3in,1.5in round 1/4in"),
        ("let w = 50.8mm\nrect 0,0 w,w/2", "rect 0,0 2in,1in"),
        ("repeat 3 as k\ncircle 2*k,0 0.5\nend", "repeat 3 as k\ncircle 2in*k,0 0.5in\nend"),
        ("circle polar(0,0, 2, 30) 0.25", "circle polar(0,0, 2in, 30) 0.25in"),
        ("circle mid(0,0, 2,4) max(1, 2mm)", "circle mid(0,0, 2in,4in) 1in"),
        ("line 0,0 3,0 as a\ncircle 1,1 length(a)/2", "line 0,0 3in,0 as a\ncircle 1in,1in 1.5in"),
        ("polygon 6 0,0 1,0\nscale 0,0 2 1-6", "polygon 6 0,0 1in,0\nscale 0,0 2 1-6"),
        ("circle 3,0 0.25\narray polar 0,0 6 over 180 1", "circle 3in,0 0.25in\narray polar 0,0 6 over 180 1"),
        ("if 26mm > 1\ncircle 0,0 1\nend", "circle 0,0 1in"),
        ("units mm\ncircle 0,0 1\nend\ncircle 0,0 1", "circle 0,0 1\ncircle 0,0 1in"),
    ],
)
def test_lengths_count_in_the_unit_and_nothing_else_does(inside: str, written_out: str) -> None:
    assert drawn(f"units in\n{inside}\nend") == drawn(written_out)


def test_what_follows_the_block_counts_in_mm_again() -> None:
    assert drawn("units in; circle 1,1 1; end; circle 1,1 1") == drawn("circle 1in,1in 1in\ncircle 1,1 1")


def test_a_block_of_one_line_answers_and_is_undone_as_that_line() -> None:
    document = Document()
    assert document.run("units in; circle 0,0 2; end") == "Circle, radius 50.800 mm."
    assert document.undo_name == "Circle"
    assert document.run("units in; circle 0,0 2; circle 0,0 3; end") == "2 statements."
    assert document.session.plain == 1.0


def test_the_recorded_text_draws_the_same_again() -> None:
    document, again = Document(), Document()
    for line in (
        "units in; rect 0,0 4,2 1/8; end".replace(" 1/8", " round 1/8"),
        "circle 10,10 3",
        "units in; circle 2,1 0.5; end",
    ):
        document.run(line)
    again.run_script("\n".join(line.command for line in document.log))
    assert again.part == document.part


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        ("units inch; circle 0,0 1; end", "'inch' is no unit of length; use one of mm"),
        ("units deg; circle 0,0 1; end", "'deg' is no unit of length"),
        ("units in; circle 0,0 1", "ends within a block"),
        ("let units = 3", "units"),
    ],
)
def test_what_is_wrong_is_told(line: str, reason: str) -> None:
    with pytest.raises(CommandError, match=reason):
        Document().run(line)
