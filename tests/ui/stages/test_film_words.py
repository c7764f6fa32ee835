"""The films speak Japanese: every word that a step shows has an entry, and the panel shows it."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

import app
from app.core.catalogue import catalogue
from app.exhibits.films.making import make_film
from app.exhibits.films.step import FilmStep, PublishedText
from app.exhibits.published_stages import CODES
from app.ui.views.stages.step_notes import NOTES, note

JAPANESE = catalogue("ja")
WORD = re.compile("[A-Za-z]{3}")
KEPT = re.compile(r"`[^`]*`|sin\(pi\*z\)")
"""Lines to type, and formulas."""


def words_of(step: FilmStep) -> Iterator[str]:
    """Everything of a step that is a word and not a number, a symbol, a unit or a name of the scene's surfaces."""
    yield from (step.name, f"{step.number}  {step.name}", step.says, step.settled)
    for figure in step.figures:
        yield figure.name
        yield from (value for value in (figure.value, figure.published) if isinstance(value, str))
    yield from (cell for row in step.table for cell in row if not re.match("12[abc] ", cell))


def in_japanese(text: str) -> bool:
    """Whether nothing of a text is left in English: a colon, or a hole, may let a whole clause through as it is."""
    found = JAPANESE.look_up(text)
    return found is not None and not re.search("[a-z]{3}", KEPT.sub("", found))


def english(texts: Iterator[str]) -> set[str]:
    return {text for text in texts if WORD.search(text) and not in_japanese(text)}


def written(node: ast.expr) -> Iterator[str]:
    """The sentences that an expression of the source may be, with numbers where something is computed."""
    match node:
        case ast.Constant(value=str(text)):
            yield text
        case ast.JoinedStr(values=parts):
            yield "".join(str(part.value) if isinstance(part, ast.Constant) else "7" for part in parts)
        case ast.IfExp(body=one, orelse=other):
            yield from (*written(one), *written(other))
        case ast.BinOp(left=one, right=other):
            yield from (first + second for first in written(one) for second in written(other))


def sentences_of_films() -> Iterator[str]:
    """Name, sentence and note of every step, and names of its figures, as they stand in the source."""
    for path in (Path(app.__file__).parent / "exhibits" / "films").glob("*.py"):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.Call) and getattr(node.func, "id", "") in ("FilmStep", "FilmFigure"):
                asked = node.args[1:4] if getattr(node.func, "id", "") == "FilmStep" else node.args[:2]
                yield from (text for each in asked for text in written(each))


def sentences_of_published() -> Iterator[str]:
    """What the steps of text A come to by the text's own rules, as it stands in the source."""
    for name in ("stages.py", "published_stages.py"):
        path = Path(app.__file__).parent / "exhibits" / name
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.JoinedStr):
                yield from (text for text in written(node) if text.count(" ") > 3)


def test_no_sentence_in_the_source_of_the_films_stays_english_in_part() -> None:
    put_together = {"by 7: farthest effective point", "Spans that fail are halved. 7"}
    told = set(sentences_of_films())
    assert len(told) > 150 and put_together < told
    assert english(iter(told - put_together)) == set()


def test_what_was_published_is_told_in_japanese_beside_what_is_settled() -> None:
    kinds = [kind.name.lower().replace("_", " ") for kind in CODES]
    counted = {text for each in ("place", "border", "corner", *kinds) for text in (f"1 {each}", f"7 {each}s")}
    assert english(iter(counted | {"1 vertex", "7 vertices"})) == set()
    told = set(sentences_of_published())
    assert len(told) >= 6
    assert english(text.strip() for text in told) == set()


@pytest.mark.exhaustive
@pytest.mark.parametrize("text", [text for text in PublishedText if text is not PublishedText.A])
def test_every_step_of_a_film_is_told_in_japanese(text: PublishedText) -> None:
    film = make_film(text)
    assert english(word for step in film.steps for word in words_of(step)) == set()


@pytest.mark.parametrize("shape", [(400, 400), (240, 320)])
def test_every_note_of_text_a_is_told_in_japanese(shape: tuple[int, int]) -> None:
    assert english(note(number, shape) for number in NOTES) == set()
    assert (shape == (400, 400)) == ("1986" not in str(JAPANESE.look_up(note(110, shape))))


def test_a_number_and_its_name_a_value_and_what_was_published_are_put_together() -> None:
    assert JAPANESE.look_up("figure 4, round 2  The region") == "図4、2回目  領域"
    assert JAPANESE.look_up("S115  All within epsilon?") == "S115  すべてε以内か"
    assert JAPANESE.look_up("S116  A range is found") == "S116  区分の確定", "no number of things found"
    assert JAPANESE.look_up("12\npublished: mean") == "12\n公開例: mean"
