"""The page on the shape language names all there is."""

import re

from app.core.resources import resource
from app.drafting.expressions.functions import FUNCTIONS
from app.drafting.language.interpret import MOST_CURVES, MOST_STATEMENTS
from app.drafting.language.language import ALIASES, COMMANDS

PAGE = resource("docs", "language.md").read_text(encoding="utf-8")


def test_every_command_and_function_is_on_the_page() -> None:
    words = set(re.findall(r"[a-z_0-9]+", PAGE))
    assert set(COMMANDS) <= words
    assert all(f"`{name}(" in PAGE for name in FUNCTIONS)


def test_every_short_word_on_the_page_is_one() -> None:
    rows = re.findall(r"^\| `([a-z]+)[^|]*\| ((?:`[a-z]+`(?:, )?)+) \|", PAGE, re.MULTILINE)
    assert len(rows) >= 15
    for _, shorts in rows:
        assert all(short in ALIASES for short in re.findall(r"[a-z]+", shorts))


def test_the_limits_are_the_programs() -> None:
    assert f"{MOST_STATEMENTS // 1000} 000 statements" in PAGE
    assert f"{MOST_CURVES // 1000} 000 curves" in PAGE
