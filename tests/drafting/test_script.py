"""Names, functions, blocks and commands of one's own: what a text of the shape language draws."""

import contextlib
import math
import time

import pytest

from app.core.errors import Cancelled, InputError
from app.core.progress import Progress
from app.drafting.document import Document, drawn
from app.drafting.expressions import effort
from app.drafting.expressions.errors import CommandError
from app.model.curves import Circle, Curve, Line
from tests.pace import slowed


def curves(text: str) -> tuple[Curve, ...]:
    document = Document()
    document.run_script(text)
    return tuple(e.curve for e in document.part.entities)


def test_names_stand_for_numbers_and_points() -> None:
    assert curves("let w = 60 + 2\nlet p = w/2, 10\nlet q = p + (1,1)*2\nline 0,0 w,0 p q") == (
        Line((0, 0), (62, 0)),
        Line((62, 0), (31, 10)),
        Line((31, 10), (33, 12)),
    )


def test_a_blank_ends_an_argument_except_in_brackets() -> None:
    assert curves("line 10,10 -5,3 (2 + 1),-2") == (Line((10, 10), (-5, 3)), Line((-5, 3), (3, -2)))
    assert curves("line 0,0 \\\n  5,0 # as long as it takes\n; ; line 1,1 2,2;") == (
        Line((0, 0), (5, 0)),
        Line((1, 1), (2, 2)),
    )


@pytest.mark.parametrize(
    ("point", "is_at"),
    [
        ("mid(0,0, 10,4)", (5, 2)),
        ("polar(1,1, 10, 90)", (1, 11)),
        ("10<180", (-10, 0)),
        ("rotate((2,0), 0,0, 90)", (0, 2)),
        ("mirror((3,1), (0,0), (0,5))", (-3, 1)),
        ("between(0,0, 10,0, 0.3)", (3, 0)),
        ("x((4,5)), y((4,5))", (4, 5)),
        ("max(1, 2, 7), min(3, -4)", (7, -4)),
        ("dist(0,0, 3,4), angle(0,0, 0,2)", (5, 90)),
        ("sqrt(2)^2, 2^3^2/512", (2, 1)),
        ("sin(30), cos(60°)", (0.5, 0.5)),
        ("atan2(1, 1), 0.5rad*pi/180deg*0", (45, 0)),
        ("round(2.6), floor(-0.5)", (3, -1)),
        ("mod(-1, 4), abs(-2)", (3, 2)),
        ("-(3,4)", (-3, -4)),
        ("(1,2)/2", (0.5, 1)),
        ("-2^2, 1/4in", (-4, 6.35)),
    ],
)
def test_functions_of_numbers_and_points(point: str, is_at: tuple[float, float]) -> None:
    document = Document()
    document.run(f"let p = {point}")
    assert document.session.names["p"] == pytest.approx(is_at, abs=1e-12)


SHAPES = (
    "line 0,0 10,0 as a\nline 4,-5 4,5 as b\ncircle 20,0 5 as c\narc 3,0 0,3 centre 0,0 as q\nrect 0,20 10,30 as box\n"
)


@pytest.mark.parametrize(
    ("point", "is_at"),
    [
        ("meet(a, b, 0,0)", (4, 0)),
        ("meet(c, c2, 20,9)", (22.5, math.sqrt(18.75))),
        ("tangent(20,13, c, 30,0)", (None, None)),
        ("foot(7,3, a)", (7, 0)),
        ("foot(40,0, c)", (25, 0)),
        ("start(a) + finish(b)", (4, 5)),
        ("middle(q)", (3 / math.sqrt(2),) * 2),
        ("centre(c)", (20, 0)),
        ("radius(c), length(a)", (5, 10)),
        ("length(c), length(q)", (10 * math.pi, 1.5 * math.pi)),
    ],
)
def test_functions_of_curves(point: str, is_at: tuple[float, float]) -> None:
    document = Document()
    document.run_script(SHAPES + "circle 25,0 5 as c2\n" + f"let p = {point}")
    p = document.session.names["p"]
    assert isinstance(p, tuple)
    if is_at[0] is None:
        assert math.dist(p, (20, 0)) == pytest.approx(5)
        assert (p[0] - 20) * (p[0] - 20) + (p[1] - 0) * (p[1] - 13) == pytest.approx(0, abs=1e-9)
        assert p[0] > 20
    else:
        assert p == pytest.approx(is_at, abs=1e-9)


def test_a_name_of_curves_can_be_deleted_and_moved() -> None:
    document = Document()
    document.run_script(SHAPES + "move @0,1 a c\ndelete box b")
    assert [e.id for e in document.part.entities] == [1, 3, 4]
    assert document.part.curve(1) == Line((0, 1), (10, 1))
    with pytest.raises(CommandError, match="no longer in the drawing"):
        document.run("line 0,0 start(b)")


def test_repeat_counts_from_nought_and_its_index_ends_with_it() -> None:
    drawn = curves("let i = 7\nrepeat 3 as i\n  repeat 2\n    circle 10*i,0 1\n  end\nend\ncircle i,i 1")
    assert [c.centre[0] for c in drawn if isinstance(c, Circle)] == [0, 0, 10, 10, 20, 20, 7]


def test_if_chooses() -> None:
    text = "let w = {}\nif w >= 5\n circle 0,0 1\nelse\n circle 0,0 2\nend"
    assert curves(text.format(5)) == (Circle((0, 0), 1),)
    assert curves(text.format(4)) == (Circle((0, 0), 2),)
    assert curves("if 1 != 1; circle 0,0 1; end") == ()


def test_a_command_of_ones_own_has_its_own_names() -> None:
    document = Document()
    document.run_script(
        "let r = 9\ndefine bolt(c, r)\n  let inner = r/2\n  circle c r\n  circle c inner\nend\n"
        "bolt 5,5 4 as head\nmove @1,0 head"
    )
    assert tuple(e.curve for e in document.part.entities) == (Circle((6, 5), 4), Circle((6, 5), 2))
    assert document.session.names["r"] == 9
    assert "inner" not in document.session.names


def test_what_a_block_draws_is_undone_together_with_its_names() -> None:
    document = Document()
    document.run("let n = 4")
    document.run("repeat n as i; circle 10*i,0 1; end")
    assert len(document.part.entities) == 4
    document.undo()
    assert not document.part.entities and "n" in document.session.names
    document.undo()
    assert "n" not in document.session.names
    document.redo()
    document.redo()
    assert len(document.part.entities) == 4


@pytest.mark.parametrize(
    ("text", "line", "column", "says"),
    [
        ("line 0,0 1,1\ncircle 0,0", 2, 11, "radius is expected"),
        ("let close = 3", 1, 5, "word of the language"),
        ("let a", 1, 6, "'='"),
        ("repeat 2\ncircle 0,0 1", 2, 13, "add end"),
        ("circle 0,0 nought(3)", 1, 12, "no function"),
        ("circle 0,0 sqrt(-1)", 1, 12, "no value"),
        ("circle 0,0 (1,2)", 1, 12, "a point; a number"),
        ("line 0,0 5", 1, 10, "a number; a point"),
        ("define a(x)\n b x\nend\na 1 2", 4, 1, "takes 1 value;"),
        ("define a(x)\n a x\nend\na 1", 2, 2, "without end"),
        ("repeat 2.5; circle 0,0 1; end", 1, 8, "whole number"),
        ("repeat 200000 as i\nrepeat 200000\nlet b = i\nend\nend", 3, 1, "200000 statements"),
        ("repeat 100000\nrepeat 100000\nend\nend", 2, 1, "200000 statements"),
        ("circle 0,0 1" + "+1" * 5000, 1, 2013, "more than 1000 terms"),
        ("circle 0,0 1.2.3", 1, 15, "the end of the line is"),
        ("repeat 2; undo; end", 1, 11, "lines of their own"),
        ("circle 0,0 5°", 1, 12, "does not fit"),
        ("let a = (0,0) + 3", 1, 17, "between a point and a number"),
        ("let a = 0^-1", 1, 11, "no value"),
        ('circle 0,0 "5"', 1, 12, "is a text"),
        ("line 0,0 1,1 as", 1, 16, "a name"),
        ("circle mid(1,2) 3", 1, 8, "Write mid(a, b)"),
        ("end", 1, 1, "no command"),
        ("circle 0,0 5\n  lime 0,0", 2, 3, "'lime' is no command"),
        ("let r = start(3)", 1, 15, "no curve 3"),
        ("line 0,0 1e9,0", 1, 10, "too large"),
        ("let a = meet(1,2)", 1, 14, "no curve 1"),
    ],
)
def test_what_is_wrong_is_told_with_line_and_column(text: str, line: int, column: int, says: str) -> None:
    document = Document()
    with pytest.raises(InputError) as caught:
        document.run_script(text, "plate.draw")
    assert str(caught.value).startswith(f"plate.draw:{line}: column {column}: "), caught.value
    assert says in str(caught.value)


TOO_MUCH = [
    "repeat 600 as k\nline 0,0 1,k+1\nend",
    "repeat 600 as k\nguide k,0 45\nend",
    "repeat 100\nif " + "1+" * 900 + "1 > 0\nend\nend",
    "repeat 100\nrepeat 0*(" + "1+" * 900 + "1)\nend\nend",
    "define f(n)\nif n > 0\nf n-1\nf n-1\nline 0,0 n,1\nend\nend\nf 12",
    "repeat 30\nspline degree 20 " + " ".join(f"{k},{k % 3}" for k in range(40)) + "\nend",
    "circle 0,0 1\nselect all\nrepeat 100\nmeasure\nend",
    "spline 0,0 1,1 2,0\nrepeat 600\nselect crossing 0,0 9,9\nend",
    "spline 0,0 1,1 2,0\nrepeat 90 as k\nline 0.5+k/90,-3 0.5+k/90,3 as v\ntrim v 0.5+k/90,2\nend",
    "line 0,0 1,1\nrepeat 900\nselect chain 1\nend",
    "line 0,0 1,1\nrepeat 900\nmove @1,0 1\nend",
    "line 0,0 1,1\nrepeat 900\nheal 0.1\nend",
    "line 0,0 0,1\nline 0,1 1,1\nrepeat 900\nfillet 0.001 1 2\nend",
]


@pytest.mark.parametrize("text", TOO_MUCH)
def test_what_is_repeated_is_counted(text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Every kind of statement counts where it stands in a block, and none that is written out."""
    monkeypatch.setattr(effort, "MOST_WORK", 20_000)
    with pytest.raises(
        InputError, match=r"^a\.draw:\d: column \d+: What this text repeats is too much work; repeat fewer times"
    ):
        drawn(text, "a.draw")


def test_what_is_written_out_is_drawn_however_much_it_is(monkeypatch: pytest.MonkeyPatch) -> None:
    """A limit on what is repeated refuses no drawing that was saved line by line."""
    monkeypatch.setattr(effort, "MOST_WORK", 20)
    saved = "\n".join("spline degree 9 " + " ".join(f"{k + n},{k % 3}" for k in range(10)) for n in range(40))
    assert len(drawn(saved).entities) == 40
    with pytest.raises(InputError, match="too much work"):
        drawn("repeat 40\n" + saved.partition("\n")[0] + "\nend")


@pytest.mark.exhaustive
@pytest.mark.parametrize(
    "text",
    [
        "repeat 60000 as k; line 0,0 1,k+1; end",
        "repeat 60000 as k; point k,0; end",
        "repeat 1000 as k; line 0,k 1,k; end; repeat 1000; select all; measure; end",
        "repeat 1000 as k; spline k,0 k+1,0 k,3; end; repeat 300; select crossing 0,0 100,100; end",
        "repeat 400 as k; spline 0,k 30,k 60,k 100,k; end; repeat 100 as k; line k/2,-1 k/2,500 as v; trim v k/2,0.5; "
        "end",
        "repeat 20000 as k; spline 0,0 1,1 2,k+3 3,5; end",
        "repeat 3000 as k; line k,0 k+1,0; end; repeat 20; heal 0.1; end",
        "let a = 1; repeat 100000; let a = " + "1+" * 900 + "1; end",
    ],
)
def test_whatever_is_repeated_ends_within_five_seconds_of_the_processor(text: str) -> None:
    drawn("line 0,0 1,1; spline 0,0 1,1 2,3; select all; measure")  # what is loaded is
    begun = time.process_time()
    with contextlib.suppress(InputError):
        drawn(text)
    assert (time.process_time() - begun) / slowed() < 5


def test_a_text_that_cannot_be_read_draws_nothing() -> None:
    document = Document()
    with pytest.raises(InputError):
        document.run_script("circle 0,0 5\nline 0,0 (1")
    assert not document.part.entities


def test_a_long_script_can_be_cancelled() -> None:
    import threading

    cancelled = threading.Event()
    seen: list[float] = []

    def listen(fraction: float, text: str) -> None:
        seen.append(fraction)
        if len(seen) == 50:
            cancelled.set()

    with pytest.raises(Cancelled):
        Document().run_script("circle 0,0 5\n" * 100, progress=Progress(listen, cancelled))
    assert seen == sorted(seen) and len(seen) == 50


def test_the_log_of_a_drawing_draws_it_again() -> None:
    document = Document()
    document.run_script(
        SHAPES + 'let w = 4\nundo\nundo\nredo\nselect crossing -1,-1 5,5\ndelete\nlayer "cut out"\n'
        "repeat 3 as k\n circle 10*k,50 3\nend\nselect all\nmove @2,3"
    )
    again = Document()
    again.run_script("\n".join(line.command for line in document.log))
    assert again.part == document.part
    assert again.session == document.session


CHAIN = """let w = {w}
if w < 1
  circle 0,0 1
else if w < 2
  circle 0,0 2
else  if w < 3 # so
  circle 0,0 3
else
  circle 0,0 4
end
"""


@pytest.mark.parametrize(("width", "radius"), [(0, 1), (1, 2), (2, 3), (3, 4)])
def test_else_if_takes_the_first_that_holds(width: int, radius: int) -> None:
    document = Document()
    document.run_script(CHAIN.format(w=width))
    assert [e.curve for e in document.part.entities] == [Circle((0, 0), radius)]


def test_else_if_goes_on_and_on_and_may_have_no_else() -> None:
    document = Document()
    lines = "".join(f"else if w == {k}\n  circle 0,0 {k}\n" for k in range(1, 300))
    document.run_script(
        f"let w = 299\nif w < 0\n  circle 9,9 9\n{lines}end\nif w < 0; circle 1,1 1; else if w < 1; circle 2,2 2; end\n"
    )
    assert [e.curve for e in document.part.entities] == [Circle((0, 0), 299)]
