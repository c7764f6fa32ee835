"""Which style an SVG element has: style sheets, attributes, and what it takes over from the element round it."""

from __future__ import annotations

import re
from collections import defaultdict
from dataclasses import dataclass, replace

from .colours import colour
from .xml import Node

_COMMENT = re.compile(r"/\*.*?(?:\*/|\Z)", re.DOTALL)
_SELECTOR = re.compile(r"(?:(\*)|([\w-]+)?(?:\.([\w-]+)|#([\w-]+))?)\Z")
_READ = ("display", "visibility", "fill", "stroke", "color", "clip-path", "mask", "transform", "transform-origin")
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
    """

    shown: bool = True
    visible: bool = True
    fill: str = "black"
    stroke: str = "none"
    color: str = ""
    clipped: bool = False
    transform: str = ""
    origin: str = ""

    @property
    def draws(self) -> bool:
        """True when an outline or an area is painted."""
        return self.fill != "none" or self.stroke != "none"

    @property
    def ink(self) -> str:
        """Colour of the outline, "#rrggbb", or "" where there is none."""
        return colour(self.color if self.stroke.lower() == "currentcolor" else self.stroke)


class StyleSheet:
    """The rules of all style elements of one file whose selectors are a type, a class, an id, or a type with one of
    these.
    """

    def __init__(self, root: Node) -> None:
        self._rules: dict[tuple[str, str, str], dict[str, str]] = defaultdict(dict)
        for node in root.every():
            if node.tag == "style":
                self._add(node.text)

    def _add(self, text: str) -> None:
        for block in _COMMENT.sub(" ", text).split("}"):
            selectors, _, body = block.partition("{")
            declared = declarations(body)
            for selector in selectors.split(",") if declared else ():
                found = _SELECTOR.match(selector.strip())
                if found and found[0]:
                    self._rules[found[2] or "", found[3] or "", found[4] or ""].update(declared)

    def style(self, node: Node, outer: SvgStyle) -> SvgStyle:
        """Return the style of an element inside one of style `outer`."""
        declared = {key: node.attributes[key] for key in _READ if key in node.attributes}
        for rule in self._matching(node):
            declared.update(rule)
        declared.update(declarations(node.attributes.get("style", "")))
        return _with(outer, {key: value for key, value in declared.items() if value != "inherit"})

    def _matching(self, node: Node) -> list[dict[str, str]]:
        if not self._rules:
            return []
        classes, own = node.attributes.get("class", "").split(), node.attributes.get("id", "")
        keys = [("", "", ""), (node.tag, "", "")]
        keys += [(tag, name, "") for tag in ("", node.tag) for name in classes]
        keys += [(tag, "", own) for tag in ("", node.tag) if own]
        return [self._rules[key] for key in keys if key in self._rules]


def declarations(text: str) -> dict[str, str]:
    """Return the properties in "name: value; name: value" that are of use here."""
    pairs = (part.partition(":") for part in text.split(";"))
    found = {key.strip().lower(): value.replace("!important", "").strip() for key, _, value in pairs}
    return {key: value for key, value in found.items() if key in _READ and value}


def _with(outer: SvgStyle, declared: dict[str, str]) -> SvgStyle:
    """Return the style with some properties set; only what hides a whole branch is kept from the element round it."""
    visibility = declared.get("visibility")
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
    )
