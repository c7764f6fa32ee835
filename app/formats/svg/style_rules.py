"""The text of a style sheet to its rules: which stand for themselves, and which within an at-rule."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import NamedTuple

_COMMENT = re.compile(r"/\*.*?(?:\*/|\Z)|<!--|-->", re.DOTALL)
_PART = re.compile(
    r"\"(?:\\.|[^\"\\])*\"|'(?:\\.|[^'\\])*'|url\([^\"')]*\)|[^\"'{};u]+|(?P<sign>[{};])|.", re.DOTALL | re.IGNORECASE
)
"""Signs within quotes and addresses end nothing: @import url(https://a.b/c?d;e);"""

_IMPORT = re.compile(r"@import\s+(url\([^)]*\)|\"[^\"]*\"|'[^']*')([^;{}]*)", re.IGNORECASE)
_NOT_FOR_SHAPES = re.compile(r"//fonts?\.|font[^/?#]*(?:[?#].*)?\Z", re.IGNORECASE)
"""In the address of a sheet that only brings letters, as those of web fonts do: its host, or the end of its path."""
_NOT_ON_SCREENS = re.compile(r"\s*(?:only\s+)?(?:print|speech)\b", re.IGNORECASE)

_HOLDS_RULES = re.compile(r"@(?:supports(?!\s+not\b)|layer|container|scope)\b", re.IGNORECASE)
"""At-rules whose rules are in force on a screen."""
_ELSEWHERE = re.compile(r"@(?!media\b)|@media\s+(?:only\s+)?(?:print|speech)\b|@media[^{]*\bprefers-", re.IGNORECASE)
"""At-rules without rules for shapes, and those for paper, voices and dark screens."""
_BRACES = re.compile(r"[{}]")
_DEEPEST = 10
"""At-rules and rules within one another."""
_MOST_SELECTORS = 1000
"""Of a rule within others, which goes on from each of theirs."""
_LONGEST, _MOST_LETTERS = 1000, 50_000
"""Letters of a selector, and of all those of a rule, within others: each & is as long as what stands for it."""
UNREADABLE = ":too-many"
"""Stands for selectors that are too many, too long, or nested too deep, to be followed."""
_OF_SELECTOR = re.compile(r"\"(?:\\.|[^\"\\])*\"|'(?:\\.|[^'\\])*'|(?P<sign>[,()\[\]])|[^\"',()\[\]]+|.", re.DOTALL)


class WrittenRule(NamedTuple):
    """The selectors of a rule, with commas between them, and the text of its declarations.

    One within an at-rule that hangs on what the drawing is looked at with has that in the place of its selectors.
    """

    selectors: str
    body: str


def is_on_screen(media: str) -> bool:
    """Tell whether a style element of these media, "" = any, holds on a screen."""
    return not media.strip() or any(
        word.strip().lower() in ("all", "screen", "only screen", "only all") for word in media.split(",")
    )


def without_comments(text: str) -> str:
    """Return the text of a style sheet or attribute without its comments."""
    return _COMMENT.sub(" ", text) if "/*" in text or "<!--" in text or "-->" in text else text


def may_hide(address: str) -> bool:
    """Tell whether the style sheet of an address may have rules for shapes, and brings more than letters."""
    return _NOT_FOR_SHAPES.search(address) is None


def imported(text: str) -> Iterator[str]:
    """Yield the statements by which a style sheet takes rules for a screen from elsewhere.

    Args:
        text: of a style element.
    """
    for each in _IMPORT.finditer(without_comments(text)):
        if may_hide(each[1]) and not all(map(_NOT_ON_SCREENS.match, each[2].split(","))):
            yield each[0]


def written_rules(text: str) -> Iterator[WrittenRule]:
    """Yield the rules of a style sheet, those of at-rules that are in force on a screen among them.

    Args:
        text: of a style element.
    """
    yield from _rules(without_comments(text), 0)


def _rules(text: str, depth: int) -> Iterator[WrittenRule]:
    for head, body in _blocks(text):
        if not head.startswith("@"):
            yield from _nested(head, body, depth)
        elif depth < _DEEPEST and (_HOLDS_RULES.match(head) or any(map(is_on_screen, _media(head)))):
            yield from _rules(body, depth + 1)
        elif not _ELSEWHERE.match(head):
            named = head.replace(",", " or")
            yield from (WrittenRule(named, inner) for _, inner in _blocks(body))


def _nested(head: str, body: str, depth: int) -> Iterator[WrittenRule]:
    """Yield a rule, and those that stand within it: their selectors go on from its own, or have & in its place."""
    if "{" not in body:
        yield WrittenRule(head, body)
        return
    yield WrittenRule(head, _own(body))
    for inner, text in _blocks(body):
        if depth >= _DEEPEST:
            yield WrittenRule(UNREADABLE, _BRACES.sub(";", text))
        elif inner.startswith("@"):
            yield from _within(head, _rules(f"{inner}{{&{{{text}}}}}", depth + 1))
        else:
            yield from _within(head, _nested(inner, text, depth + 1))


def _within(head: str, rules: Iterable[WrittenRule]) -> Iterator[WrittenRule]:
    """Yield rules that stand within one of these selectors."""
    outer = [each.strip() for each in selectors_of(head)]
    letters, longest = sum(map(len, outer)), max(map(len, outer))
    for selectors, declared in rules:
        inner = [each.strip() for each in selectors_of(selectors)]
        uses = [max(each.count("&"), 1) for each in inner]
        made_letters = letters * sum(uses) + len(outer) * sum(map(len, inner))
        too_long = longest * max(uses) + max(map(len, inner)) > _LONGEST or made_letters > _MOST_LETTERS
        if too_long or len(outer) * len(inner) > _MOST_SELECTORS:
            yield WrittenRule(UNREADABLE, declared)
        else:
            made = (each.replace("&", one) if "&" in each else f"{one} {each}" for one in outer for each in inner)
            yield WrittenRule(",".join(made), declared)


def selectors_of(text: str) -> list[str]:
    """Return selectors with commas between them, one each; commas within brackets and quotes part nothing."""
    if not any(sign in text for sign in "([\"'"):
        return text.split(",")
    found, begin, depth = list[str](), 0, 0
    for part in _OF_SELECTOR.finditer(text):
        sign = part["sign"]
        if sign == "," and not depth:
            found.append(text[begin : part.start()])
            begin = part.end()
        elif sign and sign != ",":
            depth = depth + 1 if sign in "([" else max(depth - 1, 0)
    return [*found, text[begin:]]


def _own(body: str) -> str:
    """Return the declarations of a rule without the rules that stand within it."""
    kept, begin, depth = "", 0, 0
    for part in _PART.finditer(body):
        if part["sign"] == "{":
            depth += 1
        elif part["sign"] == "}":
            depth, begin = max(depth - 1, 0), part.end()
        elif part["sign"] == ";" and not depth:
            kept, begin = kept + body[begin : part.end()], part.end()
    return kept if depth else kept + body[begin:]


def _media(head: str) -> list[str]:
    """Return the media of an @media, one each; none of another at-rule."""
    return [each for each in head[len("@media") :].split(",") if each.strip()] if head[:6].lower() == "@media" else []


def _blocks(text: str) -> Iterator[tuple[str, str]]:
    """Yield what stands before and within each pair of outer braces; statements such as @import are passed over."""
    begin = opened = depth = 0
    for part in _PART.finditer(text):
        sign = part["sign"]
        if sign == "{":
            opened, depth = (opened if depth else part.start()), depth + 1
        elif sign == "}" and depth > 1:
            depth -= 1
        elif sign == "}":
            if depth:
                yield text[begin:opened].strip(), text[opened + 1 : part.start()]
            begin, depth = part.end(), 0
        elif sign == ";" and not depth:
            begin = part.end()
    if depth:  # the sheet's end closes what is open
        yield text[begin:opened].strip(), text[opened + 1 :]
