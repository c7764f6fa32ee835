"""One line, one action: what each command makes, and what a wrong line is told."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.core.errors import InputError
from app.drafting.commands.command import Delete, DraftingSession, Draw, Transform
from app.drafting.document import Document
from app.drafting.expressions.errors import CommandError
from app.drafting.expressions.grammar import read_script
from app.drafting.expressions.syntax import Command as Written
from app.drafting.expressions.words import ids_text
from app.drafting.language.language import Command, command_word, read
from app.geometry.transform import shift
from app.model.curves import Arc, Circle, Line


def parse(line: str, session: DraftingSession | None = None) -> Command:
    (written,) = read_script(line)
    assert isinstance(written, Written)
    return read(written, session or DraftingSession())


def drawn(line: str, session: DraftingSession | None = None) -> tuple[object, ...]:
    command = parse(line, session)
    assert isinstance(command, Draw)
    return tuple(e.curve for e in command.carried_out(DraftingSession()).part.entities)


def test_line_joins_its_points_and_closes() -> None:
    assert drawn("line 0,0 10,0 10,5 close") == (Line((0, 0), (10, 0)), Line((10, 0), (10, 5)), Line((10, 5), (0, 0)))


def test_relative_and_polar_points_start_from_the_point_before() -> None:
    a, b, c = drawn("li 10,10 @5,0 @2<90 @-1in,0")
    assert a == Line((10, 10), (15, 10))
    assert b.end == pytest.approx((15, 12))
    assert c.end == pytest.approx((15 - 25.4, 12))


def test_a_line_that_begins_relative_starts_from_the_last_point_drawn() -> None:
    assert drawn("line @1,2 @3,0", DraftingSession(last=(10, 10))) == (Line((11, 12), (14, 12)),)


def test_arc_about_a_centre_turns_left_unless_told() -> None:
    (left,) = drawn("arc 10,0 0,10 centre 0,0")
    (right,) = drawn("ar 10,0 0,10 center 0,0 cw")
    assert left == Arc((10, 0), (0, 10), (0, 0), ccw=True)
    assert right.sweep == pytest.approx(-1.5 * math.pi)


def test_the_centre_of_a_slightly_uneven_arc_moves_and_the_ends_stay() -> None:
    (arc,) = drawn("arc 10,0 0,10.0004 centre 0,0")
    assert arc.start == (10, 0)
    assert arc.end == (0, 10.0004)
    assert math.dist(arc.start, arc.centre) == pytest.approx(math.dist(arc.end, arc.centre), abs=1e-12)
    assert math.hypot(*arc.centre) < 1e-3


@pytest.mark.parametrize(("via", "ccw"), [("5,5", False), ("5,-5", True)])
def test_arc_by_three_points_passes_the_middle_one(via: str, ccw: bool) -> None:
    (arc,) = drawn(f"arc 0,0 {via} 10,0")
    assert arc.ccw is ccw
    assert arc.centre == pytest.approx((5, 0))
    assert arc.radius == pytest.approx(5)
    assert abs(arc.sweep) == pytest.approx(math.pi)


def test_circle_and_rectangle() -> None:
    assert drawn("circle 3,4 1/4in") == (Circle((3, 4), 6.35),)
    assert drawn("re 10,20 0,0") == drawn("line 0,0 10,0 10,20 0,20 close")


def test_polyline_mixes_lines_and_arcs_and_joins_exactly() -> None:
    curves = drawn("pl 0,0 10,0 arc 15,5 10,10 0,10 close")
    assert [type(c).__name__ for c in curves] == ["Line", "Arc", "Line", "Line"]
    assert all(a.end == b.start for a, b in zip(curves, (*curves[1:], curves[0]), strict=True))
    assert curves[1].ccw


def test_a_polyline_that_ends_where_it_began_closes_by_itself() -> None:
    assert len(drawn("polyline 0,0 5,0 5,5 0,0 close")) == 3


@pytest.mark.parametrize(
    ("line", "column", "says"),
    [
        ("lime 0,0 1,1", 1, "'lime' is no command"),
        ("line 0,0", 9, "point"),
        ("line 0,0 x", 10, "no value"),
        ("circle 0,0 5 7", 14, "not expected"),
        ("line 1,2 3,4z", 13, "no unit"),
        ("rect 0,0 5", 10, "a point such as"),
        ("arc 0,0 5,5", 12, "end of the arc"),
        ("move 5,5", 6, "@dx,dy"),
        ("select", 7, "all, none"),
        ("delete 3 x", 10, "not expected"),
        ("line 0,0 @5<zz", 13, "no value"),
        ("polyline 1,1", 13, "two points"),
        ('layer ""', 9, "empty"),
    ],
)
def test_a_wrong_line_names_the_column_and_what_is_expected(line: str, column: int, says: str) -> None:
    with pytest.raises(CommandError) as caught:
        parse(line)
    assert (caught.value.column, says in caught.value.reason) == (column, True), caught.value


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("line 1,1 1,1", "same as point 1"),
        ("line 0,0 5,0 close", "three points"),
        ("circle 0,0 0", "greater than 0"),
        ("circle 0,0 -2", "greater"),
        ("rect 0,0 5,0", "0.000 mm"),
        ("arc 0,0 5,0 10,0", "straight line"),
        ("arc 0,0 0,0 centre 5,5", "circle x,y r"),
        ("arc 0,0 9,0 centre 4,0", "4.000 mm from the centre and the end 5.000"),
        ("delete", "Nothing is selected"),
        ("move @1,1", "Nothing is selected"),
    ],
)
def test_a_shape_that_is_none_is_refused_with_its_measures(line: str, says: str) -> None:
    with pytest.raises(InputError, match=says):
        parse(line)


def test_delete_and_move_mean_the_selection_unless_numbers_follow() -> None:
    session = DraftingSession(selection=frozenset({4, 7}))
    assert parse("delete", session) == Delete(frozenset({4, 7}))
    assert parse("delete 1 3-5", session) == Delete(frozenset({1, 3, 4, 5}))
    assert parse("mo @1in,0", session) == Transform(frozenset({4, 7}), (shift((25.4, 0.0)),), "Move")


@pytest.mark.parametrize("text", ["5-3", "1-999999999", "-1", "99999999999"])
def test_a_range_that_is_none_is_refused(text: str) -> None:
    with pytest.raises(CommandError, match="entity number"):
        parse(f"delete {text}")


@given(st.sets(st.integers(1, 60)))
def test_written_numbers_read_back(ids: set[int]) -> None:
    if ids:
        assert parse(f"delete {ids_text(ids)}") == Delete(frozenset(ids))


@pytest.mark.parametrize(
    ("text", "word"), [("li", "line"), ("RECT 0,0", "rect"), ("c", "circle"), ("5,5", None), ("", None), ("lin", None)]
)
def test_command_words_and_their_short_forms(text: str, word: str | None) -> None:
    assert command_word(text) == word


WORDS = st.sampled_from(
    [
        "line",
        "pl",
        "arc",
        "circle",
        "rect",
        "select",
        "move",
        "layer",
        "delete",
        "close",
        "cw",
        "centre",
        "0,0",
        "@5,0",
        "@2<45",
        "10,10",
        "7",
        "1in",
        "add",
        "window",
        "x",
        "@",
        ",",
        "<",
        '"',
        "1,",
        "@<",
    ]
)


@given(st.lists(WORDS, max_size=7).map(" ".join))
def test_any_line_is_a_command_or_a_sentence(line: str) -> None:
    try:
        Document().run(line)
    except InputError as error:
        assert str(error).endswith(".")
