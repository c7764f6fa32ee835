"""Words along curves, aligned, with fields that change from copy to copy."""

import math
from datetime import date
from itertools import pairwise
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.cli.main import main
from app.core.resources import resource
from app.drafting.curves.baseline import CurvedBaseline
from app.drafting.document import Document, drawn
from app.drafting.expressions.errors import CommandError
from app.drafting.expressions.syntax import TextSpan
from app.drafting.expressions.values import Length, Scope
from app.drafting.language.read_text import with_fields
from app.drafting.language.write import draw_text
from app.geometry.sample import bounds, sample
from app.model.curves import Arc, Curve, Line, Point
from app.model.job import Job
from app.toolpath.drawn_contours import drawn_contours
from tests.examples import examples

PLACE = TextSpan(1, 11, 10, 20)
RING = "circle 0,0 30 cw as ring\n"


def letters(script: str, before: int = 1) -> list[Curve]:
    return [entity.curve for entity in drawn(script).entities[before:]]


def extent(curves: list[Curve]) -> tuple[float, float, float, float]:
    boxes = [bounds(curve) for curve in curves]
    return (*(min(b[k] for b in boxes) for k in (0, 1)), *(max(b[k] for b in boxes) for k in (2, 3)))  # type: ignore[return-value]


@pytest.mark.parametrize(
    ("words", "written"),
    [
        ("No. {k + 1:3}", "No. 008"),
        ("{k}{k}", "77"),
        ("{k/2}", "3.5"),
        ("{k/3:.2}", "2.33"),
        ("{-k:3.1}", "-007.0"),
        ("{0.1 + 0.2}", "0.3"),
        ("{sqrt(k + 2)} mm", "3 mm"),
        ("{{k}}", "{k}"),
        ("plain: 3:4", "plain: 3:4"),
    ],
)
def test_fields_are_written_out(words: str, written: str) -> None:
    assert with_fields(words, PLACE, Scope({"k": 7.0})) == written


def test_lengths_are_in_the_unit_of_plain_numbers_and_the_date_is_today() -> None:
    assert with_fields("{w}", PLACE, Scope({"w": Length(76.2)}, plain=25.4)) == "3"
    before = date.today()
    assert with_fields("{date} { Date }", PLACE, Scope()) in {
        f"{day.isoformat()} {day.isoformat()}" for day in (before, date.today())
    }
    assert with_fields("{date}", PLACE, Scope({"date": 7.0})) == "7"


@pytest.mark.parametrize(
    ("words", "column", "says"),
    [
        ("a {k", 14, "{{"),
        ("a } b", 14, "}}"),
        ("a {k:x}", 14, "{k + 1:3}"),
        ("No. {k + z}", 21, "'z' has no value"),
        ("{k +}", 16, "expected"),
        ("{ }", 11, "empty"),
        ("{1,2}", 13, "a point"),
    ],
)
def test_what_is_no_field_is_told_with_its_place(words: str, column: int, says: str) -> None:
    with pytest.raises(CommandError) as told:
        with_fields(words, PLACE, Scope({"k": 7.0}))
    assert says in told.value.reason and (told.value.line, told.value.column) == (1, column)


def test_serial_numbers_change_from_copy_to_copy() -> None:
    script = 'repeat 3 as k\n  text 0,10*k 5 "No. {k + 9:3}" \nend'
    apart = "\n".join(f'text 0,{10 * k} 5 "No. {k + 9:03}"' for k in range(3))
    assert letters(script, 0) == letters(apart, 0)


@pytest.mark.parametrize(("alignment", "share"), [("left", 0.0), ("centre", 0.5), ("center", 0.5), ("right", 1.0)])
def test_words_are_aligned_to_their_point(alignment: str, share: float) -> None:
    x0, _, x1, _ = extent(letters(f'text 50,7 10 "HIH" align {alignment}', 0))
    assert 50 - x0 == pytest.approx(share * (x1 - x0))


def test_along_a_line_words_stand_as_from_a_point() -> None:
    plain = letters('text 3,4 5 "Engrave" angle 30', 0)
    along = letters('line 3,4 @80<30\ntext along 1 5 "Engrave"')
    for a, b in zip(plain, along, strict=True):
        assert (*a.start, *a.end) == pytest.approx((*b.start, *b.end), abs=1e-9)


def test_on_a_circle_every_letter_stands_on_its_tangent() -> None:
    """H has upright sides: they are as far from the centre, and their middle line goes through it."""
    curves = letters(RING + 'text along ring 5 "HHHHHH" align centre at 0,30')
    uprights = [curve for curve in curves if isinstance(curve, Line) and math.dist(curve.start, curve.end) > 4.9]
    assert len(uprights) == 12
    for a, b in zip(uprights[::2], uprights[1::2], strict=True):
        low = [min((line.start, line.end), key=lambda p: math.hypot(*p)) for line in (a, b)]
        high = [max((line.start, line.end), key=lambda p: math.hypot(*p)) for line in (a, b)]
        assert math.hypot(*low[0]) == pytest.approx(math.hypot(*low[1]))
        foot, top = _middle(*low), _middle(*high)
        assert math.hypot(*foot) == pytest.approx(30) and math.hypot(*top) == pytest.approx(35)
        assert foot[0] * top[1] - foot[1] * top[0] == pytest.approx(0, abs=1e-9)
    x0, _, x1, _ = extent(curves)
    assert x0 + x1 == pytest.approx(0, abs=1e-9)


def _middle(a: Point, b: Point) -> Point:
    return ((a[0] + b[0]) / 2, (a[1] + b[1]) / 2)


def test_back_turns_the_words_and_lift_takes_them_off_the_curve() -> None:
    """Inside the ring, upright at its foot: the mirror image of nothing, and lifted towards the centre."""
    outside = letters(RING + 'text along ring 5 "HI" align centre at 0,30 lift 2')
    inside = letters(RING + 'text along ring 5 "HI" align centre at 0,-30 back lift 2')
    far = [math.hypot(*p) for curve in outside for p in (curve.start, curve.end)]
    near = [math.hypot(*p) for curve in inside for p in (curve.start, curve.end)]
    assert min(far) > 32 - 1e-9 and max(far) < 37.6
    assert min(near) > 22 and max(near) < 28.3
    assert extent(inside)[3] < 0 < extent(outside)[1]


@settings(max_examples=examples(60), deadline=None)
@given(st.floats(0, 1), st.floats(-0.4, 0.4), st.booleans())
def test_a_place_along_curves_is_as_far_as_it_is_said(share: float, lift: float, closed: bool) -> None:
    """Against dense sampling: the way from the beginning to the foot of a letter is its share of the whole."""
    pieces = [Line((0, 0), (10, 0)), Arc((10, 0), (10, 10), (10, 5)), Line((10, 10), (0, 10))]
    pieces += [Arc((0, 10), (0, 0), (0, 5))] if closed else []
    baseline = CurvedBaseline.of(pieces, closed, lift)
    along = share * baseline.length
    to = baseline.placed(along, 0.0, 1.0)
    foot = to.b - 1j * lift * to.a
    dense = [complex(*p) for piece in pieces for p in _fine(piece)]
    ways = [abs(b - a) for a, b in pairwise(dense)]
    k = min(range(len(dense)), key=lambda k: abs(dense[k] - foot))
    assert abs(dense[k] - foot) < 0.02
    assert abs(to.a) == pytest.approx(1)
    gone = sum(ways[:k])
    assert min(abs(gone - along), abs(gone - along + baseline.length)) < 0.05
    apart = abs(baseline.nearest((foot.real, foot.imag)) - along)
    assert min(apart, baseline.length - apart if closed else apart) < 1e-6


def _fine(piece: Line | Arc) -> list[Point]:
    if isinstance(piece, Line):
        return [
            (piece.start[0] + t * (piece.end[0] - piece.start[0]), piece.start[1] + t * (piece.end[1] - piece.start[1]))
            for t in (k / 1000 for k in range(1001))
        ]
    return [
        (
            piece.centre[0] + piece.radius * math.cos(piece.start_angle + t * piece.sweep),
            piece.centre[1] + piece.radius * math.sin(piece.start_angle + t * piece.sweep),
        )
        for t in (k / 1000 for k in range(1001))
    ]


def test_words_go_along_splines_and_chains() -> None:
    wave = "spline 50,0 80,20 110,-10 140,10 as wave\n"
    curves = letters(wave + 'text along wave 6 "A wavy baseline"')
    line = sample(drawn(wave).entities[0].curve)
    feet = [min(math.dist(p, q) for q in line) for curve in curves for p in (curve.start, curve.end)]
    assert max(feet) < 6 * 1.4
    chain = letters("line 0,0 30,0\nline 60,0 30,0\n" + 'text along 1-2 5 "over the joint"', 2)
    assert [c.start for c in chain] == [c.start for c in letters('line 0,0 60,0\ntext along 1 5 "over the joint"')]


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ('text along 9 5 "A"', "9 is no curve"),
        ('text along 1-2 5 "A"', "2 chains"),
        ('text along 1 5 "much too long for it"', "make them 0.75 mm high"),
        ('text along 1 5 "AB" at 10,0 align left', "would stand from 10.000"),
        ('text 0,0 5 "AB" align up', "left, centre or right"),
        ('text 0,0 5 "AB" back', "not expected"),
        ('text along 1 5 "AB" angle 3', "not expected"),
    ],
)
def test_what_cannot_stand_there_says_why(line: str, says: str) -> None:
    document = Document()
    for each in ("line 0,0 10,0", "circle 50,0 9"):
        document.run(each)
    with pytest.raises(CommandError, match=says):
        document.run(line)


def test_a_name_along_of_a_drawing_made_before_is_a_point() -> None:
    assert letters('let along = 3,4\ntext along 5 "A"', 0) == letters('text 3,4 5 "A"', 0)


def test_the_log_draws_the_words_again() -> None:
    document = Document()
    for line in ("circle 0,0 30", 'text along 1 5 "round and round" back align centre'):
        document.run(line)
    assert drawn(document.recorded.text()).entities == document.part.entities


def test_single_strokes_bound_nothing_and_outlines_do() -> None:
    """An O of a single stroke is no pocket; where three strokes meet, as in an E, nothing is in doubt."""
    assert all(entity.lettering for entity in drawn('text 0,0 9 "OE"').entities)
    assert not any(entity.lettering for entity in drawn("circle 0,0 9").entities)
    job = Job(drawn('text 0,0 9 "OE"'))
    assert not drawn_contours(job).closed and not any(finding.counts for finding in drawn_contours(job).findings)


def test_what_is_lettering_stays_so_in_words_in_copies_and_until_it_is_said_otherwise() -> None:
    document = Document()
    for line in ("point 9,9", 'text 0,0 9 "OE"', "circle 50,0 3", "copy @0,20 2-4", "mirror 0,0 0,9 copy 2-4"):
        document.run(line)
    told = [entity.lettering for entity in document.part.entities]
    assert told.count(False) == 1
    assert [entity.lettering for entity in drawn(draw_text(document.part).text).entities] == told
    document.run("set 2-4 lettering no")
    assert [entity.lettering for entity in document.part.entities].count(False) == 4
    assert [e.lettering for e in drawn(draw_text(document.part).text).entities].count(False) == 4
    with pytest.raises(CommandError, match="yes or no"):
        document.run("set 2-4 lettering 5")


def test_the_sample_of_tags_is_clean(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "words.ngc"
    call = ["--layer", "words", "--side", "on", "--depth", "0.3", "--contour-tool", "0.5"]
    assert main(["make", str(resource("samples", "tags.draw")), *call, "-o", str(out)]) == 0, capsys.readouterr()
