"""Drawings in the shape language, as files."""

import random

import pytest

from app.core.errors import InputError
from app.core.resources import resource
from app.drafting.language.write import draw_text
from app.formats.readers import read_drawing
from app.geometry.chaining.chain import chain
from app.model.curves import Arc, Circle, Line
from app.model.part import Units

SAMPLE = resource("samples", "plate.draw")


def test_the_sample_plate_is_what_it_says() -> None:
    drawing = read_drawing(str(SAMPLE), SAMPLE.read_bytes())
    kinds = [type(e.curve) for e in drawing.part.entities]
    assert (kinds.count(Line), kinds.count(Arc), kinds.count(Circle)) == (4 + 4, 4 + 4, 4 + 1 + 6)
    assert drawing.part.name == "plate" and drawing.units_named and not drawing.findings
    holes = {e.curve.centre for e in drawing.part.entities if isinstance(e.curve, Circle) and e.curve.radius == 2.75}
    assert holes == {(8, 8), (82, 8), (8, 52), (82, 52)}


@pytest.mark.parametrize(
    ("name", "curves", "contours"), [("bolt-circle", 13, 12), ("gear", 24 * 6 + 4, 2), ("lever", 11, 4)]
)
def test_every_sample_draws_closed_contours(name: str, curves: int, contours: int) -> None:
    path = resource("samples", f"{name}.draw")
    part = read_drawing(str(path), path.read_bytes()).part
    assert len(part.entities) == curves
    chained = chain(part.entities, 0.01)
    assert len(chained.contours) == contours and all(contour.closed for contour in chained.contours)
    assert chained.findings == ()


def test_a_drawing_written_in_words_is_read_as_itself() -> None:
    part = read_drawing("plate.draw", SAMPLE.read_bytes()).part
    assert read_drawing("plate.draw", draw_text(part).text.encode()).part == part


def test_layers_keep_their_order_and_those_of_notes_stay() -> None:
    text = b"layer a; circle 0,0 5; layer b; circle 0,0 2; layer 0; point 1,1; order layer 0 after a"
    assert [layer.name for layer in read_drawing("a.draw", text).part.layers] == ["a", "0", "b"]


def test_only_the_layers_asked_for_are_kept() -> None:
    text = b"layer cut\ncircle 0,0 5\nlayer marks\ncircle 0,0 2\nhide marks"
    assert [e.layer for e in read_drawing("a.draw", text, None, ("cut",)).part.entities] == ["cut"]
    drawing = read_drawing("a.draw", text)
    assert [layer.name for layer in drawing.part.layers] == ["cut", "marks"]
    assert "Layer marks is switched off" in drawing.findings[0].text
    with pytest.raises(InputError, match="there is no layer holes; the drawing has cut, marks"):
        read_drawing("a.draw", text, None, ("holes",))


@pytest.mark.parametrize(
    ("data", "says"),
    [
        (b"", "draws nothing"),
        (b"# nothing but a remark\n", "draws nothing"),
        (b"circle 0,0 5\n\xff\n", r"a\.draw:2: this is no text"),
        (b"circle 0,0 5\nlime 0,0", r"a\.draw:2: column 1: 'lime' is no command"),
        (b"circle 0,0 5\n" * 2_000_000, "at most 20000000"),
        (b"rect 0,0 1,1\narray 20 25 @2,2 1-4\narray 10 10 @9,9 1-2000", "at most 100000"),
    ],
)
def test_a_text_that_is_no_drawing_is_refused(data: bytes, says: str) -> None:
    with pytest.raises(InputError, match=says):
        read_drawing("a.draw", data)


def test_other_units_are_told_and_not_used() -> None:
    drawing = read_drawing("a.draw", b"circle 0,0 5", Units.INCH)
    assert drawing.part.entities[0].curve == Circle((0, 0), 5)
    assert "names its own units" in drawing.findings[0].text


@pytest.mark.parametrize("seed", range(60))
def test_damaged_texts_are_drawings_or_sentences(seed: int) -> None:
    rng = random.Random(seed)
    data = bytearray(SAMPLE.read_bytes())
    for _ in range(rng.randint(1, 8)):
        at = rng.randrange(len(data))
        match rng.randrange(3):
            case 0:
                data[at] = rng.randrange(256)
            case 1:
                del data[at : at + rng.randint(1, 20)]
            case _:
                data[at:at] = data[rng.randrange(len(data)) :][: rng.randint(1, 20)]
    try:
        read_drawing("a.draw", bytes(data))
    except InputError as error:
        assert str(error).startswith("a.draw") and str(error).endswith(".")
