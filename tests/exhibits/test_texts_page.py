"""The page of the five texts: a row for every numbered step, in both languages, with a door and a test that exist."""

from __future__ import annotations

import re

import pytest

from app.core.resources import resource
from app.exhibits.films.making import make_film
from app.exhibits.films.step import TEXTS
from app.raster.steps import STEPS
from tests.conftest import ROOT

PAGES = ("texts.md", "texts_ja.md")


def rows(page: str) -> dict[str, list[list[str]]]:
    """The rows of each text's table, by its letter."""
    text = resource("docs", page).read_text(encoding="utf-8")
    parts = re.split(r"^## ([A-E])\. .*$", text, flags=re.MULTILINE)
    found = {}
    for letter, part in zip(parts[1::2], parts[2::2], strict=True):
        lines = [line for line in part.splitlines() if line.startswith("| ")]
        found[letter] = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines][1:]
    return found


@pytest.mark.parametrize("page", PAGES)
def test_every_step_has_a_row_with_a_door_and_a_test(page: str) -> None:
    found = rows(page)
    assert [row[0] for row in found["A"]] == [str(number) for number in STEPS]
    tests = {path.stem for path in (ROOT / "tests").rglob("test_*.py")}
    for letter, table in found.items():
        for row in table:
            assert len(row) == 5 and all(row), (letter, row)
            assert f"--text {letter}" in row[3]
            named = re.findall(r"test_\w+", row[4])
            assert named and set(named) <= tests, (row[0], named)


@pytest.mark.parametrize("page", PAGES)
@pytest.mark.parametrize("letter", ["C", "D", "E"])
def test_the_steps_of_a_film_are_those_of_the_page(page: str, letter: str) -> None:
    told = {row[0] for row in rows(page)[letter]}
    numbers = {step.number.partition(",")[0] for step in make_film(TEXTS[letter]).steps}
    assert numbers <= told and told - numbers <= {"pieces"}


def test_both_languages_have_the_same_rows() -> None:
    english, japanese = (rows(page) for page in PAGES)
    for letter in english:
        assert [row[0] for row in english[letter]] == [row[0] for row in japanese[letter]]
        assert [row[4] for row in english[letter]] == [row[4] for row in japanese[letter]]
