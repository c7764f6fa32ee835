"""Which style an SVG element has: style sheets, attributes, and what it takes over from the element round it."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from itertools import chain, zip_longest
from typing import NamedTuple

from .colours import colour, is_clear
from .lengths import MEDIUM, letter_height, size_of_font
from .selectors import Selector, Specificity, keys_of, selector
from .style_rules import UNREADABLE, imported, is_on_screen, may_hide, selectors_of, without_comments, written_rules
from .transforms import INDIVIDUAL, written_transform
from .xml import LINKED, STYLES, Node

_READ = (
    "display",
    "visibility",
    "opacity",
    "fill-opacity",
    "stroke-opacity",
    "fill",
    "stroke",
    "color",
    "clip-path",
    "clip-rule",
    "mask",
    "mask-type",
    "overflow",
    "transform",
    "transform-origin",
    "transform-box",
    "font-size",
    "font",
    "fill-rule",
    "stroke-width",
    "stroke-dasharray",
    "vector-effect",
    "filter",
    "marker",
    "marker-start",
    "marker-mid",
    "marker-end",
)
_GEOMETRY = ("x", "y", "width", "height", "cx", "cy", "r", "rx", "ry")
"""Places and sizes of shapes, which a style sheet may give in the place of attributes."""

_UNFOLLOWED = ("offset-path", "d")
"""What a style sheet may say of a shape's place and form that is not read; as attributes they are something else."""

_OF_SHEETS = frozenset((*_READ, *_GEOMETRY, *_UNFOLLOWED, *INDIVIDUAL))
"""What is read of style sheets."""

_COLOURS = ("fill", "stroke", "color")

_INHERITED = ("inherit", "unset", "revert", "revert-layer")
"""Words by which a property is as where nothing is said of it: that of the element round it, or its first value."""
_OWN = ("clip-path", "mask", "opacity", "filter", *_UNFOLLOWED)
"""What no element takes over from the one round it, so that its first value is that of one of which nothing is said."""

_VISIBILITY = {"visible": True, "initial": True, "hidden": False, "collapse": False}
"""What else is said says nothing."""

_VARIABLE = re.compile(r"var\(\s*(--[\w-]+)\s*(?:,([^()]*))?\)", re.IGNORECASE)
_ZERO = re.compile(r"[+-]?0*\.?0+%?|-\d*\.?\d+%?")
"""An opacity of nothing; one below that is the same."""
_DEEPEST, _LONGEST = 10, 1000
"""Variables within variables, and letters of a value with all of them in place."""

_FREE_LETTERS, _MOST_FOLD = 20_000, 3
"""Letters that selectors may have for nothing, and how many times those of all sheets: rules within rules multiply."""
_LETTERS = ("color", "font-size", "font")
_OF_THE_MOMENT = re.compile(r":(?:hover|active|focus|visited|link|target|before|after|selection)\b|::", re.IGNORECASE)
"""What a drawing looks like under the mouse or in letters; it says nothing of its shapes."""

_HREF = re.compile(r"\shref\s*=\s*(\"[^\"]*\"|'[^']*')")
_IMPORTANT = re.compile(r"!\s*important", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class SvgStyle:
    """What decides whether a shape is seen, and in what colour.

    Attributes:
        shown: False under display: none.
        visible: False under visibility: hidden or collapse.
        fill, stroke, color: as written. fill_clear, stroke_clear: they are painted with no opacity at all.
        clips: its own clip and mask, as written. clip_evenodd: in a clip, areas are by that rule.
        overflow: of what it draws beyond its viewport, as written. alpha_mask: a mask of what is opaque, not light.
        faint: it is painted with some opacity between none and all, or that is not known.
        transform: all of the element's own, one after another; "" for none.
        origin: what that is about, if not the origin of coordinates, as written.
        variables: by name, --x, with what elements round it have set.
        geometry: places and sizes that style sheets give the element itself.
        em, rem: height of its letters, and of the root's, user units, which lengths may be in.
        box: what the origin lies in, as written. evenodd: areas are filled by that rule.
        width: of the outline, as written, "" = not said. scales: it grows with the drawing. dashed: it has gaps.
        filtered: it, or a group that it is in, is blurred, shadowed or the like.
        markers: values of the properties that put arrowheads and the like on it.
        unfollowed: what is said of its place or form and not read.
    """

    shown: bool = True
    visible: bool = True
    fill: str = "black"
    stroke: str = "none"
    color: str = ""
    fill_clear: bool = False
    stroke_clear: bool = False
    clips: tuple[str, ...] = ()
    clip_evenodd: bool = False
    overflow: str = ""
    alpha_mask: bool = False
    faint: bool = False
    transform: str = ""
    origin: str = ""
    variables: Mapping[str, str] = field(default_factory=dict)
    geometry: Mapping[str, str] = field(default_factory=dict)
    em: float = MEDIUM
    rem: float = MEDIUM
    box: str = ""
    evenodd: bool = False
    width: str = ""
    scales: bool = True
    dashed: bool = False
    filtered: bool = False
    markers: Mapping[str, str] = field(default_factory=dict)
    unfollowed: tuple[str, ...] = ()

    @property
    def draws(self) -> bool:
        """True when an outline or an area is painted."""
        return self.outlined or self.filled

    @property
    def filled(self) -> bool:
        """True when an area is painted."""
        return not (self.fill_clear or is_clear(self._resolved(self.fill)))

    @property
    def outlined(self) -> bool:
        """True when an outline is painted."""
        return not (self.stroke_clear or is_clear(self._resolved(self.stroke)))

    @property
    def marked(self) -> bool:
        """True when something is drawn on its corners or ends."""
        return any(value.strip().lower() not in ("none", "initial") for value in self.markers.values())

    @property
    def ink(self) -> str:
        """Colour of the outline, "#rrggbb", or "" where there is none."""
        return colour(self._resolved(self.stroke))

    @property
    def colour_of_fill(self) -> str:
        """Colour of the area, "#rrggbb", or "" where there is none."""
        return colour(self._resolved(self.fill)) if self.filled else ""

    def _resolved(self, paint: str) -> str:
        return self.color if paint.lower() == "currentcolor" else paint


class Declaration(NamedTuple):
    """A property and its value; important: no later one that is not takes its place."""

    name: str
    value: str
    important: bool = False


class _StyleRule(NamedTuple):
    """What a style sheet declares for the elements of a selector; of rules alike in specificity the last one counts."""

    specificity: Specificity
    number: int
    selector: Selector
    declared: list[Declaration]


class StyleSheet:
    """The rules of all style elements of one file.

    Attributes:
        unread: selectors of rules that could hide or show a shape, or place it, and that are not followed.
        unread_hides: one of them does more than to choose a colour.
    """

    def __init__(self, root: Node) -> None:
        self._rules: dict[str, list[_StyleRule]] = defaultdict(list)
        self._parents: dict[int, Node] = {}
        named = [each for each in root.every() if each.tag in (*STYLES, LINKED)]
        sheets = [each.text for each in named if each.tag in STYLES and _is_in_force(each)]
        linked = [f"link {each.attributes.get('href', '')}" for each in named if _is_linked_sheet(each)]
        instructed = [each for each in root.outer_sheets if may_hide(_address(each))]
        outer = [*instructed, *linked, *(each for text in sheets for each in imported(text))]
        self.unread: list[str] = [" ".join(written.split()) for written in outer]
        self.unread_hides = bool(self.unread)
        self._count = 0
        self._letters = _FREE_LETTERS + _MOST_FOLD * sum(map(len, sheets))
        for text in sheets:
            self._add(text)
        if self._count:
            self._parents = {id(child): node for node in root.every() for child in node.children}

    def _add(self, text: str) -> None:
        for selectors, body in written_rules(text):
            self._letters -= len(selectors)
            if self._letters < 0:
                self.unread.append(UNREADABLE)
                self.unread_hides = True
                return
            declared = list(declarations(body))
            for written in selectors_of(selectors) if declared else ():
                self._count += 1
                read = selector(written)
                if read is not None:
                    self._rules[read.key].append(_StyleRule(read.specificity, self._count, read, declared))
                elif not _OF_THE_MOMENT.search(written) and any(each.name not in _LETTERS for each in declared):
                    self.unread.append(" ".join(written.split()))
                    self.unread_hides |= any(map(_hides, declared))

    def style(self, node: Node, outer: SvgStyle) -> SvgStyle:
        """Return the style of an element inside one of style `outer`."""
        declared = [Declaration(key, node.attributes[key]) for key in _READ if key in node.attributes]
        for rule in self._matching(node):
            declared += rule.declared
        declared += declarations(node.attributes.get("style", ""))
        in_force = {
            each.name: each.value for important in (False, True) for each in declared if each.important is important
        }
        return _with(outer, {key: value for key, value in in_force.items() if _says(key, value)})

    def _matching(self, node: Node) -> list[_StyleRule]:
        if not self._count:
            return []
        asked = (rule for key in dict.fromkeys(keys_of(node)) for rule in self._rules.get(key, ()))
        return sorted((rule for rule in asked if rule.selector.takes(node, self._parent)), key=lambda rule: rule[:2])

    def _parent(self, node: Node) -> Node | None:
        return self._parents.get(id(node))


def _is_in_force(sheet: Node) -> bool:
    """Tell whether a style element is CSS for a screen."""
    language = sheet.attributes.get("type", "").strip().lower()
    return language in ("", "text/css") and is_on_screen(sheet.attributes.get("media", ""))


def _is_linked_sheet(node: Node) -> bool:
    """Tell whether an element names a style sheet for shapes on a screen in another file."""
    said, address = node.attributes.get("rel", "").lower().split(), node.attributes.get("href", "").strip()
    on_screen = node.tag == LINKED and "stylesheet" in said and is_on_screen(node.attributes.get("media", ""))
    return on_screen and may_hide(address)


def _address(instruction: str) -> str:
    """Return the address in an instruction before the root that names a style sheet, "" for none."""
    found = _HREF.search(instruction)
    return found[1][1:-1].strip() if found is not None else ""


def declarations(text: str) -> Iterator[Declaration]:
    """Yield the properties in "name: value; name: value" that are of use here."""
    for part in without_comments(text).split(";"):
        key, _, value = part.partition(":")
        name, kept = key.strip(), _IMPORTANT.sub("", value).strip()
        name = name if name.startswith("--") else name.lower()
        if kept and (name in _OF_SHEETS or name.startswith("--")):
            yield Declaration(name, kept, kept != value.strip())


def _hides(declared: Declaration) -> bool:
    """Tell whether a declaration may hide, show, move or form a shape; one that only paints it does not."""
    name, value, _ = declared
    paints = name in _LETTERS or name == "filter" or name.startswith("marker")
    return not paints and (name not in _COLOURS or is_clear(value))


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


def _says(name: str, value: str) -> bool:
    """Tell whether a value makes a property another than it is where nothing is said of it."""
    word = value.strip().lower()
    if name in _GEOMETRY:  # a style that says nothing of a place still takes the attribute's away
        return word != "inherit"
    return word not in _INHERITED and not (word == "initial" and name in _OWN)


def _is_zero(opacity: str | None) -> bool:
    return opacity is not None and _ZERO.fullmatch(opacity) is not None


def _clear(opacity: str | None, outer: bool) -> bool:
    return outer if opacity is None else _is_zero(opacity)


def _with(outer: SvgStyle, declared: dict[str, str]) -> SvgStyle:
    """Return the style with some properties set; only what hides a whole branch is kept from the element round it."""
    variables = outer.variables
    own = {key: value for key, value in declared.items() if key.startswith("--")}
    if own:
        variables = {**variables, **own}
    declared = {
        key: value
        for key, written in declared.items()
        if key not in own and (value := _resolved(written, variables)) and _says(key, value)
    }
    visible = _VISIBILITY.get(declared.get("visibility", "").lower(), outer.visible)
    size = declared.get("font-size", "") or size_of_font(f"{declared.get('font', '')} ")
    markers = {key: value for key, value in declared.items() if key.startswith("marker")}
    clips = tuple(declared[key] for key in ("clip-path", "mask") if declared.get(key, "none").strip().lower() != "none")
    opacities = [declared[key] for key in ("opacity", "fill-opacity") if key in declared]
    return replace(
        outer,
        shown=outer.shown and declared.get("display", "").lower() != "none" and not _is_zero(declared.get("opacity")),
        visible=visible,
        fill=declared.get("fill", outer.fill),
        stroke=declared.get("stroke", outer.stroke),
        fill_clear=_clear(declared.get("fill-opacity"), outer.fill_clear),
        stroke_clear=_clear(declared.get("stroke-opacity"), outer.stroke_clear),
        color=declared.get("color", outer.color),
        clips=clips,
        clip_evenodd=declared["clip-rule"] == "evenodd" if "clip-rule" in declared else outer.clip_evenodd,
        overflow=declared.get("overflow", ""),
        alpha_mask=declared.get("mask-type") == "alpha",
        faint=outer.faint or any(opacity.strip() not in ("1", "1.0", "100%") for opacity in opacities),
        transform=written_transform(declared),
        origin=declared.get("transform-origin", ""),
        variables=variables,
        geometry={key: declared[key] for key in _GEOMETRY if key in declared},
        em=letter_height(size, outer.em, outer.rem),
        box=declared.get("transform-box", ""),
        evenodd=declared["fill-rule"] == "evenodd" if "fill-rule" in declared else outer.evenodd,
        width=declared.get("stroke-width", outer.width),
        scales=declared.get("vector-effect") != "non-scaling-stroke",
        dashed=any("1" <= digit <= "9" for digit in declared["stroke-dasharray"])
        if "stroke-dasharray" in declared
        else outer.dashed,
        filtered=outer.filtered or declared.get("filter", "none").strip().lower() != "none",
        markers=({} if "marker" in markers else {**outer.markers}) | markers if markers else outer.markers,
        unfollowed=tuple(key for key in _UNFOLLOWED if declared.get(key, "none") not in ("none", "auto")),
    )
