"""The fast lane: what it does, what it leaves alone, and that its numbers are those of float(text)."""

import copy
import math

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from app.gcode.interpreter.program import MotionColumns
from tests.examples import examples
from tests.gcode.interpreter.plain_lane import LaneState, plain_blocks
from tests.gcode.interpreter.plain_oracle import Oracle, lane, same_bits

START, END, CENTRE = slice(0, 3), slice(3, 6), slice(6, 9)
KIND, PLANE, TURNS, FEED, LINE, STATE = range(9, 15)


def moving(**changes: object) -> LaneState:
    plain = LaneState(motion=1, feed=100.0)
    for name, value in changes.items():
        setattr(plain, name, value)
    return plain


def test_a_line_in_every_way_of_writing_it() -> None:
    texts = (
        "G1X1.5Y-2F100",
        "g01 x+1.5 y-2. f100",
        " G 1 X 1 . 5 Y - 2 F 1 0 0 ",
        "(a;b)G1(c)X1.5Y-2(d)F100;(e",
        "F100.0\tY-02X01.50 G1",
    )
    for text in texts:
        rows, at = lane(text + "\n")
        assert at == (len(text) + 1, 2), text
        assert len(rows) == 1 and rows[0][END] == (1.5, -2.0, 0.0) and rows[0][KIND] == 1 and rows[0][FEED] == 100.0


def test_rapids_have_no_feed_and_feed_words_alone_no_motion() -> None:
    rows, at = lane("F50\nG0 X1\nN20\n\nG1 Y1\n(end)")
    assert [(row[KIND], row[FEED], row[LINE]) for row in rows] == [(0, 0.0, 2), (1, 50.0, 5)] and at == (26, 7)


def test_it_changes_what_is_in_force() -> None:
    plain = moving(motion=-1, state=5)
    rows, _ = lane("G3 X2 I1 F30\nX1 Z4 R1\nM2", plain)
    assert plain.motion == 3 and plain.feed == 30.0 and plain.position.tolist() == [1.0, 0.0, 4.0]
    assert plain.known.tolist() == [0, -1, 1, -1, -1, -1] and [row[STATE] for row in rows] == [5, 5]


def test_incremental_words_do_not_make_an_axis_known() -> None:
    plain = moving(absolute=False, position=np.array([1.0, 2.0, 3.0]), shift=np.array([50.0, 0.0, 0.0]))
    rows, _ = lane("X1 Y-1\nX1", plain)
    assert [row[END] for row in rows] == [(2.0, 1.0, 3.0), (3.0, 1.0, 3.0)] and plain.known.tolist() == [
        -1,
        -1,
        -1,
        0,
        0,
        -1,
    ]


def test_shift_and_scale() -> None:
    plain = moving(scale=25.4, bare_scale=0.00254, shift=np.array([1.0, 0.0, 0.0]))
    rows, _ = lane("X1 Y1. F10", plain)
    assert rows[0][END] == (1 * 0.00254 + 1.0, 25.4, 0.0) and rows[0][FEED] == 254.0


@pytest.mark.parametrize(
    ("plane", "text", "centre"),
    [
        (0, "G2 X1 Y1 I1 J0", (1.0, 0.0, 0.0)),
        (1, "G2 Z1 X1 K1 I0", (0.0, 0.0, 1.0)),
        (2, "G2 Y1 Z1 J1 K0", (0.0, 1.0, 0.0)),
        (0, "G3 X2 I1 Z5", (1.0, 0.0, 0.0)),
        (0, "G3 X0 I-4", (-4.0, 0.0, 0.0)),
        (0, "G2 X2 R1", (1.0, 0.0, 0.0)),
    ],
)
def test_arcs_in_every_plane(plane: int, text: str, centre: tuple[float, ...]) -> None:
    rows, at = lane(text, moving(plane=plane))
    assert at == (len(text), 2) and rows[0][CENTRE] == centre and rows[0][PLANE] == plane and rows[0][TURNS] == 1


def test_absolute_centres_take_the_shift() -> None:
    rows, _ = lane(
        "G2 X1 Y1 I1 J0",
        moving(arc_absolute=True, shift=np.array([10.0, 20.0, 0.0]), position=np.array([10.0, 20.0, 5.0])),
    )
    assert rows[0][CENTRE] == (11.0, 20.0, 5.0)


NOT_PLAIN = [
    "M3",
    "S100",
    "T1",
    "/X1",
    "%",
    "O100",
    "X#1",
    "X[1]",
    "#1=2",
    "G4 P1",
    "G90 X1",
    "G17",
    "G53 X1",
    "G80",
    "G1.1 X1",
    "G2.0 X1 I1",
    "G5 X1",
    "X1 X2",
    "G1 G1 X1",
    "G0 G1 X1",
    "F1 F2 X1",
    "X1 N5",
    "N-1 X1",
    "N1.5 X1",
    "N X1",
    "X1e3",
    "X1 P2",
    "X1 H1",
    "X1 A1",
    "X",
    "X.",
    "X-",
    "X+-1",
    "X1.2.3",
    "X1-2",
    "X--1",
    "X(c)1",
    "X1(c).5",
    "(open",
    "(a(b) X1",
    "(a) X1 (b",
    "X1\x00",
    "X1\x01",
    "(a\x02)",
    ";a\x03",
    "X1 \xe9",
    "{",
    "X1\r",
    "X1 F0",
    "X1 F-1",
    "F-0.",
    "F1e9",
    "G1",
    "G0",
    "G2 I1",
    "X1 I1",
    "G1 X1 R1",
    "G1 X1 K1",
    "G2 X1",
    "G2 X2 I1 R1",
    "G2 X2 I1 K0",
    "G2 X2 K1",
    "G2 Z1 I0 J0",
    "G2 X0 R1",
    "G2 X2 R0",
    "G2 X0.01 R0.009",
    "G2 X2 R0.99",
    "G2 X2 I1.1",
    "G2 X0.001 I0.0005",
    "G2 Z1 R1",
    "I1",
    "R1",
    "X1234567",
    "X9999999999999999",
    "X1.0000000000000001",
    "X" + "1 " * 600,
    "(" + "a" * 2000 + ")",
    "G3 X1 I0.5 J[0]",
    "G 4",
    "X0x10",
    "Xnan",
    "Xinf",
    "X1_0",
    "G99999999999999999999",
    "N99999999999999999999 X1",
    "F99999999999999999999",
]


@pytest.mark.parametrize("text", NOT_PLAIN)
def test_whatever_is_unusual_is_left_alone(text: str) -> None:
    """Neither motion nor feed nor anything else of the line is done, and the lines before it are."""
    plain = moving()
    rows, at = lane(f"X5 Z0\nX0\n{text}\nX7\n".encode("latin-1"), plain)
    assert at == (9, 3) and [row[END] for row in rows] == [(5.0, 0.0, 0.0), (0.0, 0.0, 0.0)]
    assert plain.feed == 100.0 and plain.motion == 1 and plain.known.tolist() == [0, -1, 0, -1, -1, -1]


@pytest.mark.parametrize(
    ("text", "plain"),
    [
        ("X1", {"motion": -1}),
        ("X1", {"feed": math.nan}),
        ("G2 X1 I0.5", {"feed": math.nan}),
        ("X1 ;c", {"semicolon_comments": False}),
        ("G2 X1 I0.5", {"arc_absolute": True}),
        ("X1", {"position": np.array([1e6, 0.0, 0.0]), "absolute": False}),
        ("X1", {"scale": 2e6, "bare_scale": 2e6}),
    ],
)
def test_what_is_in_force_can_make_a_line_unusual(text: str, plain: dict[str, object]) -> None:
    assert lane(text, moving(**plain)) == ([], (0, 1))
    assert lane(text, moving())[0] or "G2" in text


def test_it_does_no_more_lines_than_asked_and_goes_on_from_there() -> None:
    text = "".join(f"X{k}\n" for k in range(30_000)).encode()
    plain, columns = moving(), MotionColumns()
    data = np.frombuffer(text, np.uint8)
    at = plain_blocks(data, (0, 1), plain, columns, 12_345)
    assert at[1] == 12_346 and len(columns) == 12_345
    assert plain_blocks(data, at, plain, columns, 10**9) == (len(text), 30_001)
    motions = columns.motions()
    assert np.array_equal(motions.end[:, 0], np.arange(30_000)) and np.array_equal(motions.line, np.arange(1, 30_001))


signs, blanks = st.sampled_from(["", "-", "+"]), st.sampled_from(["", "", " ", "\t", "  "])
written = st.one_of(
    st.from_regex(r"\A[0-9]{1,4}\.?\Z"),
    st.from_regex(r"\A[0-9]{0,4}\.[0-9]{1,10}\Z"),
    st.decimals(0, 9999, places=4).map(str),
)
comments = st.sampled_from(["", "", "", "(text)", "(T1 ; D=6)", "(MSG,hi)", "(é)"])


@st.composite
def lines(draw: st.DrawFn) -> str:
    """A line of words that cannot fail: no arcs, for their centres must fit."""
    kind = draw(st.sampled_from(["G0", "G1", "G00", "G01", "g1", "", ""]))
    letters = draw(st.permutations("XYZF"))[: draw(st.integers(1, 4))]
    if "X" not in letters and "Y" not in letters and "Z" not in letters:
        kind = ""
    words = [kind] + [_word(draw, letter) for letter in letters]
    number = draw(st.sampled_from(["", "", "N10 ", "n7"]))
    return (
        number
        + draw(blanks).join(word + draw(comments) for word in words)
        + draw(st.sampled_from(["", "", ";end", " "]))
    )


def _word(draw: st.DrawFn, letter: str) -> str:
    number = "1" + draw(written) if letter == "F" else draw(signs) + draw(written)
    gap = draw(blanks)
    return draw(st.sampled_from([letter, letter.lower()])) + gap + gap.join(number)


@st.composite
def arcs(draw: st.DrawFn) -> str:
    """An arc from wherever the tool is, its radii alike: half a circle back along one axis, in incremental words."""
    half = draw(st.decimals(1, 500, places=draw(st.sampled_from([0, 2, 4]))))
    axis = draw(st.integers(0, 1))
    form = f"{'IJ'[axis]}{half}" if draw(st.booleans()) else f"R{half}"
    return f"{draw(st.sampled_from(['G2', 'g03']))} {'XY'[axis]}{2 * half} {form} Z{draw(st.decimals(0, 9, places=2))}"


plains = st.builds(
    lambda scale, bare, shift, absolute, position: LaneState(
        position=np.array(position),
        motion=1,
        feed=10.0,
        scale=scale,
        bare_scale=scale * bare,
        absolute=absolute,
        shift=np.array(shift),
    ),
    st.sampled_from([1.0, 25.4]),
    st.sampled_from([1.0, 0.001]),
    st.tuples(*[st.floats(-100, 100)] * 3),
    st.booleans(),
    st.tuples(*[st.floats(-100, 100)] * 3),
)


@settings(max_examples=examples(300), deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(st.lists(lines(), max_size=20), plains)
def test_random_lines_mean_the_same_to_the_last_bit(texts: list[str], plain: LaneState) -> None:
    _assert_same(texts, plain)


@settings(max_examples=examples(150))
@given(st.lists(arcs(), max_size=8), plains)
def test_random_arcs_mean_the_same_to_the_last_bit(texts: list[str], plain: LaneState) -> None:
    plain.absolute, plain.bare_scale = False, plain.scale
    _assert_same(texts, plain)


def _assert_same(texts: list[str], plain: LaneState) -> None:
    oracle = Oracle(copy.deepcopy(plain))
    for number, text in enumerate(texts, 1):
        oracle.do(text, number)
    data = "\n".join(texts)
    rows, at = lane(data, plain)
    assert at[0] == len(data.encode()), data[at[0] :]
    assert same_bits(rows, oracle.rows)
    assert (
        same_bits([tuple(plain.position)], [tuple(oracle.plain.position)])
        and plain.known.tolist() == oracle.plain.known.tolist()
    )
    assert (plain.motion, plain.feed) == (oracle.plain.motion, oracle.plain.feed)
