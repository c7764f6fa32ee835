"""Every word of the language has its usage, its colour and its place among the offers."""

import pytest

from app.drafting.expressions.functions import FUNCTIONS
from app.drafting.language.language import ALIASES, COMMANDS
from app.ui.framework.theme import DARK, LIGHT, mixed
from app.ui.views.language.completion import offers, word_before
from app.ui.views.language.highlight import SyntaxKind, pieces, syntax_colours
from app.ui.views.language.usage import WordKind, usage_of
from tests.ui.test_theme import contrast


@pytest.mark.parametrize("word", [*COMMANDS, *ALIASES])
def test_every_command_tells_how_it_is_written(word: str) -> None:
    usage = usage_of(word.upper())
    assert usage is not None and usage.kind is WordKind.COMMAND
    assert all(form.startswith(usage.word) and does.count("|") == 0 for form, does in usage.forms)


def test_every_function_is_told_from_a_command_of_its_name() -> None:
    for name, function in FUNCTIONS.items():
        usage = usage_of(name, function=True)
        assert usage is not None and usage.form == function.shown
    rotate = usage_of("rotate")
    assert rotate is not None and rotate.form.startswith("rotate P angle")
    assert usage_of("wobble") is None


def test_ways_of_a_command_and_its_own_words() -> None:
    arc = usage_of("ar")
    assert (
        arc is not None
        and len(arc.forms) == 4
        and arc.forms[3] == ("arc on P", "onward from the curve drawn last, without a corner")
    )
    assert {"centre", "cw", "radius", "large"} <= set(arc.options)


def test_what_a_line_is_made_of() -> None:
    line = 'circle mid(a, b) 1in+2 as hole # "x"'
    found = {line[start : start + length]: ink for start, length, ink in pieces(line)}
    assert found == {
        "circle": SyntaxKind.COMMAND,
        "mid": SyntaxKind.FUNCTION,
        "1in": SyntaxKind.NUMBER,
        "2": SyntaxKind.NUMBER,
        "as": SyntaxKind.BLOCK,
        '# "x"': SyntaxKind.REMARK,
    }
    assert [ink for _, _, ink in pieces('rotate 0,0 3 copy; layer "a#b"')] == [
        SyntaxKind.COMMAND,
        SyntaxKind.NUMBER,
        SyntaxKind.NUMBER,
        SyntaxKind.NUMBER,
        SyntaxKind.OPTION,
        SyntaxKind.COMMAND,
        SyntaxKind.TEXT,
    ]
    assert pieces("bolt place size") == [] and pieces("1in2")[0][1] == 1


@pytest.mark.parametrize("theme", [LIGHT, DARK])
def test_every_ink_can_be_read(theme) -> None:
    grounds = (theme.raised, mixed(theme.raised, theme.hover, 0.6))
    assert all(contrast(colour, ground) >= 4.5 for colour in syntax_colours(theme).values() for ground in grounds)


def test_offers_fit_the_place() -> None:
    names = [("width", False), ("bolt", True)]
    assert {"polygon", "polyline"} <= {offer.word for offer in offers("  po", names)}
    assert "bolt" in [offer.word for offer in offers("bo", names)] and not offers("wid", names)
    assert [offer.word for offer in offers("circle 0,0 wi", names)] == ["width"]
    inside = [offer.word for offer in offers("rect 0,0 ro", names)]
    assert inside[0] == "round" and "rotate" in inside
    assert "circle" in [offer.word for offer in offers("let a = 1; ci", names)]


@pytest.mark.parametrize("line", ["# ci", 'layer "ci', "circle 12", ""])
def test_nothing_is_offered_in_remarks_quotes_and_numbers(line: str) -> None:
    assert word_before(line) == ""
