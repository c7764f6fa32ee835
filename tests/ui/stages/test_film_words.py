"""The films speak Japanese: every word that a step shows has an entry, and the panel shows it."""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest

from app.core.catalogue import catalogue
from app.exhibits.films.making import make_film
from app.exhibits.films.step import FilmStep, PublishedText
from app.ui.views.stages.step_notes import NOTES, note

JAPANESE = catalogue("ja")
WORD = re.compile("[A-Za-z]{3}")


def words_of(step: FilmStep) -> Iterator[str]:
    """Everything of a step that is a word and not a number, a symbol, a unit or a name of the scene's surfaces."""
    yield from (step.name, step.says, step.settled)
    for figure in step.figures:
        yield figure.name
        yield from (value for value in (figure.value, figure.published) if isinstance(value, str))
    yield from (cell for row in step.table for cell in row if not re.match("12[abc] ", cell))


def english(texts: Iterator[str]) -> set[str]:
    return {text for text in texts if WORD.search(text) and JAPANESE.look_up(text) is None}


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
    assert JAPANESE.look_up("12\npublished: mean") == "12\n公開例: mean"
