"""Which style an SVG element has: style sheets, attributes, and what it takes over from the element round it."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from itertools import chain, zip_longest
from typing import NamedTuple

from .colours import colour
from .lengths import MEDIUM, letter_height, size_of_font
from .xml import Node

_COMMENT = re.compile(r"/\*.*?(?:\*/|\Z)", re.DOTALL)
_SELECTOR = re.compile(r"(?:(\*)|(:root|[\w-]+)?(?:\.([\w-]+)|#([\w-]+))?)\Z")
_READ = (
    "display",
    "visibility",
    "fill",
    "stroke",
    "color",
    "clip-path",
    "mask",
    "transform",
    "transform-origin",
    "font-size",
    "font",
)
_GEOMETRY = ("x", "y", "width", "height", "cx", "cy", "r", "rx", "ry")
"""Places and sizes of shapes, which a style sheet may give in the place of attributes."""

_VARIABLE = re.compile(r"var\(\s*(--[\w-]+)\s*(?:,([^()]*))?\)", re.IGNORECASE)
_DEEPEST, _LONGEST = 10, 1000
"""Variables within variables, and letters of a value with all of them in place."""

_UNITS = re.compile(r"(?<=[\d.])(?:px|deg)\b")


@dataclass(frozen=True, slots=True)
class SvgStyle:
    """What decides whether a shape is seen, and in what colour.

    Attributes:
        shown: False under display: none.
        visible: False under visibility: hidden or collapse.
        fill, stroke, color: as written.
        clipped: something hides a part of it.
        transform: the element's own, as the attribute would have it; "" for none.
        origin: what that is about, if not the origin of coordinates, as written.
        variables: by name, --x, with what elements round it have set.
        geometry: places and sizes that style sheets give the element itself.
        em, rem: height of its letters, and of the root's, user units, which lengths may be in.
    """

    shown: bool = True
    visible: bool = True
    fill: str = "black"
    stroke: str = "none"
    color: str = ""
    clipped: bool = False
    transform: str = ""
    origin: str = ""
    variables: Mapping[str, str] = field(default_factory=dict)
    geometry: Mapping[str, str] = field(default_factory=dict)
    em: float = MEDIUM
    rem: float = MEDIUM

    @property
    def draws(self) -> bool:
        """True when an outline or an area is painted."""
        return self.fill != "none" or self.stroke != "none"

    @property
    def ink(self) -> str:
        """Colour of the outline, "#rrggbb", or "" where there is none."""
        return colour(self.color if self.stroke.lower() == "currentcolor" else self.stroke)


class Declaration(NamedTuple):
    """A property and its value; important: no later one that is not takes its place."""

    name: str
    value: str
    important: bool = False


class StyleSheet:
    """The rules of all style elements of one file whose selectors are a type, a class, an id, or a type with one of
    these.
    """

    def __init__(self, root: Node) -> None:
        self._rules: dict[tuple[str, str, str], list[Declaration]] = defaultdict(list)
        for node in root.every():
            if node.tag == "style":
                self._add(node.text)

    def _add(self, text: str) -> None:
        for block in _COMMENT.sub(" ", text).split("}"):
            selectors, _, body = block.partition("{")
            declared = list(declarations(body))
            for selector in selectors.split(",") if declared else ():
                found = _SELECTOR.match(selector.strip())
                if found and found[0]:
                    tag = "svg" if found[2] == ":root" else found[2] or ""
                    self._rules[tag, found[3] or "", found[4] or ""] += declared

    def style(self, node: Node, outer: SvgStyle) -> SvgStyle:
        """Return the style of an element inside one of style `outer`."""
        declared = [Declaration(key, node.attributes[key]) for key in _READ if key in node.attributes]
        for rule in self._matching(node):
            declared += rule
        declared += declarations(node.attributes.get("style", ""))
        in_force = {
            each.name: each.value for important in (False, True) for each in declared if each.important is important
        }
        return _with(outer, {key: value for key, value in in_force.items() if value != "inherit"})

    def _matching(self, node: Node) -> list[list[Declaration]]:
        if not self._rules:
            return []
        classes, own = node.attributes.get("class", "").split(), node.attributes.get("id", "")
        keys = [("", "", ""), (node.tag, "", "")]
        keys += [(tag, name, "") for tag in ("", node.tag) for name in classes]
        keys += [(tag, "", own) for tag in ("", node.tag) if own]
        return [self._rules[key] for key in keys if key in self._rules]


def declarations(text: str) -> Iterator[Declaration]:
    """Yield the properties in "name: value; name: value" that are of use here."""
    for part in text.split(";"):
        key, _, value = part.partition(":")
        name, kept = key.strip(), value.replace("!important", "").strip()
        name = name if name.startswith("--") else name.lower()
        if kept and (name in _READ or name in _GEOMETRY or name.startswith("--")):
            yield Declaration(name, kept, kept != value.strip())


def _of_variable(found: re.Match[str], variables: Mapping[str, str]) -> str:
    """Return the value of a variable, or what stands there for one that is not set."""
    return (variables.get(found[1]) or (found[2] or "").strip())[: _LONGEST + 1]


def _resolved(value: str, variables: Mapping[str, str]) -> str:
    """Return a value with its variables in place; "" where one is not set, or they go too deep or too far."""
    for _ in range(_DEEPEST):
        if "var(" not in value.lower():
            return value
        parts = [_of_variable(found, variables) for found in _VARIABLE.finditer(value)]
        if not all(parts):
            return ""
        value = "".join(
            chain.from_iterable(zip_longest(_VARIABLE.sub("\0", value).split("\0"), parts, fillvalue=""))
        ).strip()
        if len(value) > _LONGEST:
            return ""
    return ""


def _with(outer: SvgStyle, declared: dict[str, str]) -> SvgStyle:
    """Return the style with some properties set; only what hides a whole branch is kept from the element round it."""
    variables = outer.variables
    own = {key: value for key, value in declared.items() if key.startswith("--")}
    if own:
        variables = {**variables, **own}
    declared = {
        key: value
        for key, written in declared.items()
        if key not in own and (value := _resolved(written, variables)) and value != "inherit"
    }
    visibility = declared.get("visibility")
    size = declared.get("font-size", "") or size_of_font(f"{declared.get('font', '')} ")
    hides = any(declared.get(key, "none") != "none" for key in ("clip-path", "mask"))
    return replace(
        outer,
        shown=outer.shown and declared.get("display") != "none",
        visible=outer.visible if visibility is None else visibility == "visible",
        fill=declared.get("fill", outer.fill),
        stroke=declared.get("stroke", outer.stroke),
        color=declared.get("color", outer.color),
        clipped=outer.clipped or hides,
        transform=_UNITS.sub("", declared.get("transform", "")),
        origin=declared.get("transform-origin", ""),
        variables=variables,
        geometry={key: declared[key] for key in _GEOMETRY if key in declared},
        em=letter_height(size, outer.em, outer.rem),
    )
