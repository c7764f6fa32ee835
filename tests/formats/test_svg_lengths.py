"""Lengths of an SVG in units of letters, in shares of the page, and as sums."""

import random
import time

import pytest

from app.formats.readers import read_drawing
from app.formats.svg.lengths import LengthBasis, length, letter_height, size_of_font
from app.formats.svg.numbers import UnreadableError
from app.model.curves import Circle

PAGE = 'width="100mm" height="50mm" viewBox="0 0 100 50" xmlns="http://www.w3.org/2000/svg"'
BASIS = LengthBasis((100.0, 50.0), 20.0, 10.0)


def read(body: str, page: str = PAGE):
    return read_drawing("a.svg", f"<svg {page}>{body}</svg>".encode(), None, ())


def radius(body: str, page: str = PAGE) -> float:
    (entity,) = read(body, page).part.entities
    assert isinstance(entity.curve, Circle)
    return entity.curve.radius


@pytest.mark.parametrize(
    ("text", "user"),
    [
        ("2em", 40.0),
        ("-.5E1em", -100.0),
        ("2rem", 20.0),
        ("3ex", 30.0),
        ("3ch", 30.0),
        ("50%", 50.0),
        ("25.4mm", 96.0),
        ("1In", 96.0),
        ("72pt", 96.0),
        ("101.6Q", 96.0),
        ("calc(50% - 2em)", 10.0),
        ("calc(2 * (1em + 3px) / 4 - -1rem)", 21.5),
        ("CALC(calc(25.4mm*2) - 96px)", 96.0),
        ("calc(-1 * (5px))", -5.0),
        ("calc(7)", 7.0),
        ("calc(1px + 2em + 3px)", 44.0),
    ],
)
def test_a_length_is_what_css_takes_it_for(text: str, user: float) -> None:
    assert length(text).user(BASIS, "x") == pytest.approx(user)


@pytest.mark.parametrize(
    "text",
    [
        "calc(1px + 2)",
        "calc(1px * 2px)",
        "calc(2 / 1px)",
        "calc(1px / 0)",
        "calc(1px",
        "calc(1px))",
        "calc()",
        "calc(1px 2px)",
        "calc(a)",
        "min(1px, 2px)",
        "calc(max(1px, 2px))",
        "5vw",
        "calc(1px + 5vw)",
        "1 2",
        "e5",
        "%",
        "calc(" * 5000 + "1px" + ")" * 5000,
        "calc(" + "1px + " * 20000,
    ],
)
def test_what_is_no_length_is_named(text: str) -> None:
    with pytest.raises(UnreadableError):
        length(text).user(BASIS)
    found = read(f'<circle r="9"/>\n<circle r="{text}"/>').findings
    (said,) = [each for each in found if "cannot be read" in each.text]
    assert said.counts and "in line 2: the length" in said.text and len(said.text) < 220


def test_sums_are_those_of_arithmetic() -> None:
    rng = random.Random(22)

    def sum_of(depth: int) -> tuple[str, float]:
        if depth == 0:
            value, (unit, size) = rng.randint(-9, 9), rng.choice([("px", 1), ("em", 20), ("rem", 10), ("%", 1)])
            return f"{value}{unit}", value * size
        (a, x), (b, y) = sum_of(depth - 1), sum_of(rng.randrange(depth))
        factor = rng.randint(1, 5)
        return rng.choice(
            [(f"{a} + {b}", x + y), (f"{a} - ({b})", x - y), (f"({a}) * {factor}", x * factor)]
            + [(f"calc({a}) / {factor}", x / factor), (f"{factor} * (({a}) + {b})", factor * (x + y))]
        )

    begun = time.process_time()
    for _ in range(500):
        text, value = sum_of(rng.randrange(5))
        assert length(f"calc({text})").user(BASIS, "x") == pytest.approx(value, abs=1e-9), text
    assert time.process_time() - begun < 2


@pytest.mark.parametrize(
    ("body", "wide"),
    [
        ('<g font-size="8"><circle r="1em"/></g>', 8.0),
        ('<g font-size="8"><g style="font-size:150%"><circle r="1em"/></g></g>', 12.0),
        ('<g font-size="8"><g style="font-size:2em"><circle r="1em" font-size="0.5em"/></g></g>', 8.0),
        ('<style>circle{font-size:3mm;r:2em}</style><circle r="1"/>', 6 / 25.4 * 96),
        ('<circle style="font: italic bold 5px/2 Arial; r: calc(1em + 1rem)"/>', 21.0),
        ('<g font-size="large"><circle r="1em"/></g>', 19.2),
        ('<g font-size="nonsense"><circle r="1em"/></g>', 16.0),
        ('<g font-size="-4px"><circle r="1em"/></g>', 16.0),
    ],
)
def test_letters_have_the_height_that_css_gives_them(body: str, wide: float) -> None:
    assert radius(body) == pytest.approx(wide)


def test_lengths_that_depend_on_a_font_are_said() -> None:
    (said,) = [each.text for each in read('<circle r="1ex"/><circle r="2ch"/><circle r="3em"/>').findings]
    assert said.startswith("2 shapes have lengths in ex or ch")


def test_a_page_may_be_as_wide_as_letters_or_sums() -> None:
    assert radius(
        '<circle r="10"/>',
        'width="10em" style="font-size:9.6px" viewBox="0 0 96 96" xmlns="http://www.w3.org/2000/svg"',
    ) == pytest.approx(25.4 / 9.6)
    page = 'width="calc(40mm + 1cm)" height="calc(100% - 2px)" viewBox="0 0 100 50" xmlns="http://www.w3.org/2000/svg"'
    assert radius('<circle r="10"/>', page) == 5.0


def test_the_shorthand_of_a_font_has_a_size() -> None:
    assert [size_of_font(f"{text} ") for text in ("12pt/1.5 Arial", "bold small serif", "caption", "900 2em x")] == [
        "12pt",
        "small",
        "",
        "2em",
    ]
    assert letter_height("larger", 10.0, 16.0) == 12.0 and letter_height("2rem", 10.0, 16.0) == 32.0
