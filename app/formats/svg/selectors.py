"""Selectors of style sheets: which elements a rule is for, and which of two rules stands above the other.

The library for it (cssselect2) tries all ways to place the elements of "a b c" among those round an element: 19 s for
three of them within 90 groups. Here the places that may still be reached are a set, so that no file takes long.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import NamedTuple

from .xml import Node

_SIMPLE = re.compile(
    r"(?P<any>\*)|(?P<type>[\w-]+)|\.(?P<class>[\w-]+)|#(?P<id>[\w-]+)|(?P<root>:root)\b"
    r"|\[(?P<key>[\w-]+)(?:(?P<how>[~|^$*]?)=(?:\"(?P<a>[^\"]*)\"|'(?P<b>[^']*)'|(?P<c>[\w-]+)))?\]"
    r"|:not\((?P<not>[^()\s]+)\)"
)
_COMPOUNDS = re.compile(r"\s*(>)\s*|\s+")
MOST_PARTS = 20
"""Elements that one selector names; more is no style sheet of a drawing."""

ParentOf = Callable[[Node], Node | None]


class Specificity(NamedTuple):
    """How closely a selector tells its element; the larger one stands above."""

    ids: int = 0
    classes: int = 0
    types: int = 0

    def plus(self, other: Specificity) -> Specificity:
        """Return that of two compounds together."""
        return Specificity(self.ids + other.ids, self.classes + other.classes, self.types + other.types)


class _Asked(NamedTuple):
    """What is asked of an attribute: its name, by which sign, and the value; None = that it is there."""

    key: str
    how: str = ""
    value: str | None = None

    def holds(self, own: str | None) -> bool:
        """Tell whether an element's attribute is as asked; None = it has none."""
        if own is None or self.value is None:
            return own is not None
        if self.how in ("", "~"):
            return own == self.value if not self.how else self.value in own.split()
        if self.how == "|":
            return own == self.value or own.startswith(f"{self.value}-")
        found = {"^": own.startswith, "$": own.endswith, "*": own.__contains__}[self.how]
        return bool(self.value) and found(self.value)


@dataclass(frozen=True, slots=True)
class _Compound:
    """What is asked of one element.

    Attributes:
        tag: its type, or "".
        ids, classes: all of these. attributes: what is asked of them. others: compounds that it must not be.
        within: it is asked of an element anywhere round the one before; else of the very next one.
    """

    tag: str
    ids: frozenset[str]
    classes: frozenset[str]
    attributes: tuple[_Asked, ...]
    within: bool = True
    others: tuple[_Compound, ...] = ()

    def takes(self, node: Node) -> bool:
        own = node.attributes
        return (
            self.tag in ("", node.tag)
            and all(own.get("id") == name for name in self.ids)
            and self.classes.issubset(own.get("class", "").split())
            and all(asked.holds(own.get(asked.key)) for asked in self.attributes)
            and not any(other.takes(node) for other in self.others)
        )


@dataclass(frozen=True, slots=True)
class Selector:
    """Attributes: compounds: the element itself, then those round it, outwards. specificity: of all together."""

    compounds: tuple[_Compound, ...]
    specificity: Specificity

    @property
    def key(self) -> str:
        """What an element must have to come into question: "#id", ".class", a type, or "" for any."""
        own = self.compounds[0]
        return next((f"#{name}" for name in own.ids), next((f".{name}" for name in sorted(own.classes)), own.tag))

    def takes(self, node: Node, parent_of: ParentOf) -> bool:
        """Tell whether the selector is for an element."""
        if not self.compounds[0].takes(node):
            return False
        if len(self.compounds) == 1:
            return True
        way = list(_outwards(node, parent_of))
        reached = {0}  # places on the way outwards where what was asked so far may end
        for wanted in self.compounds[1:]:
            places = range(min(reached) + 1, len(way)) if wanted.within else [place + 1 for place in reached]
            reached = {place for place in places if place < len(way) and wanted.takes(way[place])}
            if not reached:
                return False
        return True


def _outwards(node: Node, parent_of: ParentOf) -> Iterator[Node]:
    """Yield an element and those round it."""
    inner: Node | None = node
    while inner is not None:
        yield inner
        inner = parent_of(inner)


def keys_of(node: Node) -> Iterator[str]:
    """Yield the keys of all selectors that may be for an element."""
    yield ""
    yield node.tag
    for name in node.attributes.get("class", "").split():
        yield f".{name}"
    if "id" in node.attributes:
        yield f"#{node.attributes['id']}"


def selector(text: str) -> Selector | None:
    """Read a selector; None where it has words that are not followed, such as :hover, + and ~."""
    parts, at = [], 0
    text = text.strip()
    for found in _COMPOUNDS.finditer(text):
        parts.append((text[at : found.start()], found[1] is None))
        at = found.end()
    parts.append((text[at:], True))
    if len(parts) > MOST_PARTS:
        return None
    compounds, total = [], Specificity()
    for part, within in parts:
        read = _compound(part, within)
        if read is None:
            return None
        compounds.append(read[0])
        total = total.plus(read[1])
    return Selector(tuple(reversed(compounds)), total)


def _compound(text: str, within: bool) -> tuple[_Compound, Specificity] | None:
    """Read what is asked of one element, and how closely that tells it; None where it cannot be read."""
    words: list[re.Match[str]] = []
    at = 0
    while at < len(text):
        found = _SIMPLE.match(text, at)
        if found is None or (words and (found["any"] or found["type"])):
            return None
        words.append(found)
        at = found.end()
    roots = sum(word["root"] is not None for word in words)
    tag = "svg" if roots else next((word["type"] for word in words if word["type"]), "")
    ids = frozenset(word["id"] for word in words if word["id"])
    classes = frozenset(word["class"] for word in words if word["class"])
    attributes = tuple(
        _Asked(word["key"], word["how"] or "", _first(word["a"], word["b"], word["c"])) for word in words if word["key"]
    )
    counted = Specificity(len(ids), len(classes) + len(attributes) + roots, bool(tag) and not roots)
    others = [_compound(word["not"], True) for word in words if word["not"]]
    kept = [other for other in others if other is not None]
    if not words or len(kept) < len(others):
        return None
    for _, more in kept:
        counted = counted.plus(more)
    return _Compound(tag, ids, classes, attributes, within, tuple(other for other, _ in kept)), counted


def _first(*values: str | None) -> str | None:
    return next((value for value in values if value is not None), None)
