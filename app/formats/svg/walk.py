"""Walk an SVG tree: curves of its shapes, in place, with their layers, and a count of everything else."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from typing import NoReturn

import numpy as np

from ...core import tolerances
from ...core.errors import InputError
from ...geometry.affine import IDENTITY, Affine, transformed
from ...geometry.sample import Box, bounds_of_all
from ...model.curves import Circle, Curve, Ellipse, Line, Point, Spline
from ...model.layer_names import typed_name
from ...model.part import Layer
from ..drawing import LeftOutReason, LeftOutSort
from ..drawing_account import MOST_CURVES, LayeredCurve
from ..dxf.splines import MOST_POINTS
from .boxes import TransformReader
from .clips import Clip, ClipReader, Seen, covers, seen_of, viewport_clip
from .joined import beziers_joined, joined
from .lengths import FONT_LENGTH, LengthBasis, Viewport
from .numbers import UnreadableError, ViewBox, fitted, view_box
from .painted import bounding, closed_by_line
from .path import SvgPath
from .shapes import LENGTHS, SHAPES, measure, shape
from .strokes import PaintedOutlines
from .style import StyleSheet, SvgStyle
from .transforms import UnplacedError, transform
from .xml import DEEPEST, INKSCAPE, LINK, SODIPODI, Node

_LINK = f"{LINK} href"
_NOT_CURVES = ("image", "foreignObject", "video", "audio", "iframe", "canvas")
_MOVING = ("animate", "animateTransform", "animateMotion", "set", "script")
"""What changes a picture while it is looked at; what is read is how it is drawn."""
TEXTS = ("text", "flowRoot")
BLACK, WHITE = "#000000", "#ffffff"
_GROUND = 1e-3
"""By so much of a page its ground may be too small."""
_TOO_MUCH = f"the drawing unfolds to more than {MOST_CURVES} curves; use fewer copies, or save it in parts"
_ENGLISH = re.compile(r"(?:^|,)\s*en\b", re.IGNORECASE)
_SHADE = re.compile(r"\s*url\(\s*[\"']?#([^)\"']+?)[\"']?\s*\)(.*)", re.DOTALL)
"""A paint of this file, and what is taken where there is none of that name."""
_BREAK = re.compile(r"[\x00-\x1f]+")


@dataclass
class LayerNote:
    """What is known of a layer: whether it is shown and locked, its own colour, and those of its curves."""

    visible: bool = True
    locked: bool = False
    own: str = ""
    inks: set[str] = field(default_factory=set)

    def layer(self, name: str) -> Layer:
        """Return the layer; its colour is the one that all its outlines have, black being the ink of the theme."""
        found = next(iter(self.inks)) if len(self.inks) == 1 else "" if self.inks else self.own
        return Layer(name, "" if found == BLACK else found, self.visible, self.locked)


@dataclass(frozen=True, slots=True)
class SvgFault:
    """Where a shape's data cannot be read on: its line in the file, and what stands there if that is known."""

    line: int
    what: str = ""


@dataclass(frozen=True, slots=True)
class UnreadWords:
    """What a text says, which is not read, and its line in the file."""

    words: str
    line: int


@dataclass
class SvgContent:
    """What an SVG draws.

    Attributes:
        curves: mm, y upwards.
        left_out: elements that are no curves or draw none.
        nothing: places of shapes without length.
        faults: shapes whose data cannot be read to the end.
        unread: shapes that are missing, for a length of theirs cannot be read: it, and its line.
        unplaced: elements that are missing, for a transform of theirs cannot be followed: it, and its line.
        texts: that can be seen, and are missing too.
        of_font: shapes with lengths that depend on what a font is like.
        clipped: shapes that are read whole although a clip or a mask hides a part of them.
        layers: by name, in order.
        unread_rules: selectors of style sheets that are not followed. rules_hide: one of them may hide or move a shape.
        unfollowed: how many elements have a property that is not followed and that moves or forms them.
        beyond: shapes that lie wholly beyond the page. ground: a white area as large as the page, under all else.
        page_wide: how many other areas are as large, without an outline.
        within: outlines within what their own path paints on both sides of them, so that nobody sees them.
        painted: what is drawn on and along outlines.
    """

    curves: list[LayeredCurve] = field(default_factory=list)
    left_out: Counter[LeftOutSort] = field(default_factory=Counter)
    nothing: list[Point | None] = field(default_factory=list)
    faults: list[SvgFault] = field(default_factory=list)
    unread: list[SvgFault] = field(default_factory=list)
    unplaced: list[SvgFault] = field(default_factory=list)
    texts: list[UnreadWords] = field(default_factory=list)
    of_font: int = 0
    clipped: int = 0
    layers: dict[str, LayerNote] = field(default_factory=dict)
    unread_rules: list[str] = field(default_factory=list)
    rules_hide: bool = False
    unfollowed: Counter[str] = field(default_factory=Counter)
    beyond: int = 0
    ground: list[LayeredCurve] = field(default_factory=list)
    page_wide: int = 0
    within: int = 0
    painted: PaintedOutlines = field(default_factory=PaintedOutlines)


@dataclass(frozen=True, slots=True)
class InheritedState:
    """What an element takes over from those round it.

    Attributes:
        to: from its coordinates to the drawing's.
        view: size of the nearest viewport, user units.
        layer: name of the layer, "" for none.
        depth: of elements and uses round it; 0 for the root's children.
        copied: it is drawn by a `use`, so its own layers do not count.
        clips: what clips, masks and viewports round it leave to see.
    """

    to: Affine
    view: Viewport
    style: SvgStyle = field(default_factory=SvgStyle)
    layer: str = ""
    depth: int = 0
    copied: bool = False
    clips: tuple[Clip, ...] = ()

    @property
    def basis(self) -> LengthBasis:
        """What lengths are relative to."""
        return LengthBasis(self.view, self.style.em, self.style.rem)


class SvgWalker:
    """Reads one file."""

    def __init__(self, root: Node, name: str) -> None:
        self._root, self._name = root, name
        self._styles = StyleSheet(root)
        self._sheet = SvgContent(unread_rules=self._styles.unread, rules_hide=self._styles.unread_hides)
        self._ids: dict[str, Node] = {}
        self._named_layers = False
        for node in root.every():
            self._ids.setdefault(node.attributes.get("id", ""), node)
            self._named_layers |= _is_layer(node)
        self._open: list[int] = []
        self._page: Box | None = None
        self._transforms = TransformReader(self._styles.style, self._target)
        self._clips: ClipReader[InheritedState] = ClipReader(self._ids, self._in_place, self._target)

    def content(self, to: Affine, view: Viewport) -> SvgContent:
        """Return what the file draws.

        Args:
            to: from the root's user units to the drawing, mm, y upwards.
            view: size of the root's viewport, user units.

        Raises:
            InputError: a viewBox cannot be read; uses go in a circle, too deep, or unfold to too much.
        """
        self._size(self._root, {}, 0)
        style = self._styles.style(self._root, SvgStyle())
        self._sheet.unfollowed.update(style.unfollowed + ("a transform of the page",) * _moves(style.transform))
        self._page = _page_box(self._root, to, view)
        self._children(self._root.children, InheritedState(to, view, replace(style, rem=style.em)))
        self._without_ground(self._sheet)
        return self._sheet

    def _without_ground(self, content: SvgContent) -> None:
        """Leave out the ground that editors and plotting programs lay under a page, unless it is all that there is."""
        if content.ground and content.curves:
            content.left_out[LeftOutSort("shape", LeftOutReason.GROUND)] += 1
        elif content.ground:
            content.curves += content.ground
            content.layers.setdefault(content.ground[0].layer, LayerNote())

    def _size(self, node: Node, known: dict[int, tuple[int, int]], depth: int) -> tuple[int, int]:
        """Return how many elements an element unfolds to, with all copies, and in how many levels; a copy of itself
        counts once.

        Raises:
            InputError: there are too many of either.
        """
        if id(node) not in known and depth <= DEEPEST + 1:
            known[id(node)] = (1, 1)
            target = self._target(node) if node.tag == "use" else None
            inner = [self._size(child, known, depth + 1) for child in ([target] if target else node.children)]
            known[id(node)] = 1 + sum(count for count, _ in inner), 1 + max((levels for _, levels in inner), default=0)
        count, levels = known.get(id(node), (1, 1))
        if count > MOST_CURVES:
            self._refuse(node, _TOO_MUCH)
        if depth + levels > DEEPEST + 2:  # the root, and a copy in the deepest element
            self._refuse(node, f"copies of copies are nested deeper than {DEEPEST} levels; unlink some and save again")
        return count, levels

    def _target(self, use: Node) -> Node | None:
        link = use.attributes.get("href", use.attributes.get(_LINK, "")).strip()
        return self._ids.get(link[1:]) if link.startswith("#") and len(link) > 1 else None

    def _children(self, nodes: Iterable[Node], state: InheritedState) -> None:
        for node in nodes:
            self._one(node, state)

    def _one(self, node: Node, outer: InheritedState) -> None:
        try:
            self._element(node, outer)
        except UnplacedError as error:
            self._sheet.unplaced.append(SvgFault(node.line, str(error.args[0])))

    def _element(self, node: Node, outer: InheritedState) -> None:
        if node.attributes.get("requiredExtensions"):  # no viewer has any
            self._sheet.left_out[LeftOutSort(node.tag, LeftOutReason.INVISIBLE)] += 1
        elif node.tag in _NOT_CURVES or node.tag in _MOVING:
            self._sheet.left_out[LeftOutSort(node.tag)] += 1
        elif node.tag in TEXTS:
            self._text(node, self._inside(node, outer))
        elif node.tag in SHAPES or node.tag in _CONTAINERS:
            state = self._inside(node, outer)
            if state.style.geometry:
                sized = {**node.attributes, **state.style.geometry}
                node = replace(node, attributes=sized)
            if node.tag in SHAPES:
                self._draw(node, state)
                self._children((child for child in node.children if child.tag in _MOVING), state)
            elif node.tag == "use":
                self._use(node, state)
            elif node.tag == "svg":
                self._children(node.children, self._viewport(node, state, node))
            else:
                self._children(_chosen(node) if node.tag == "switch" else node.children, state)

    def _text(self, node: Node, state: InheritedState) -> None:
        """Note a text, which is not read; one without letters, or that nobody sees, is nothing."""
        words, style = node.words, state.style
        if not (style.shown and style.visible and style.draws):
            self._sheet.left_out[LeftOutSort(node.tag, LeftOutReason.INVISIBLE)] += 1
        elif words:
            self._sheet.left_out[LeftOutSort(node.tag)] += 1
            self._sheet.texts.append(UnreadWords(words, node.line))

    def _inside(self, node: Node, outer: InheritedState) -> InheritedState:
        """Return the state inside an element: its transform, its style, its layer, its clips."""
        state = self._in_place(node, outer)
        if not state.style.clips:
            return state
        plain = replace(state, style=SvgStyle(em=state.style.em, rem=state.style.rem), copied=True)
        return replace(state, clips=(*outer.clips, *self._clips.clips(state.style, plain)))

    def _in_place(self, node: Node, outer: InheritedState) -> InheritedState:
        """Return the state inside an element, without its own clips."""
        style, to, layer = self._with_paints(self._styles.style(node, outer.style)), outer.to, outer.layer
        self._sheet.unfollowed.update(style.unfollowed)
        if style.transform and style.shown:
            to = to.after(self._transforms.transform(node, style, outer.basis))
        named = "" if outer.copied else self._layer_name(node, outer.depth)
        if named:
            layer = named
            note = self._sheet.layers.setdefault(layer, LayerNote())
            note.visible &= style.shown
            note.locked |= node.attributes.get(f"{SODIPODI} insensitive") == "true"
            note.own = style.ink
            style = replace(style, shown=outer.style.shown)
        return replace(outer, to=to, style=style, layer=layer, depth=outer.depth + 1)

    def _with_paints(self, style: SvgStyle) -> SvgStyle:
        """Return a style with what is painted in place of shades and patterns that are not in the file."""
        if "url(" not in style.fill and "url(" not in style.stroke:
            return style
        fill, stroke = map(self._paint, (style.fill, style.stroke))
        return replace(style, fill=fill, stroke=stroke)

    def _paint(self, written: str) -> str:
        found = _SHADE.match(written)
        return written if found is None or found[1] in self._ids else found[2].strip() or "none"

    def _layer_name(self, node: Node, depth: int) -> str:
        """Return the name of the layer that a group is; a file without Inkscape's layers has its top groups that are
        named.
        """
        if node.tag != "g" or (not _is_layer(node) if self._named_layers else depth > 0):
            return ""
        own = (node.attributes.get(key, "") for key in (f"{INKSCAPE} label", "data-name"))
        labels = (_BREAK.sub(" ", each) for each in (*own, typed_name(node.attributes.get("id", ""))))
        return next((label for label in labels if label.strip()), "layer" if self._named_layers else "")

    def _use(self, node: Node, state: InheritedState) -> None:
        target = self._target(node)
        if target is None:
            self._sheet.left_out[LeftOutSort("use of what is not in the file")] += 1
            return
        if id(target) in self._open:
            self._refuse(node, f"#{target.attributes['id'][:60]} is used in itself; break the loop and save again")
        x, y = self._measured(node, ("x", "y"), state, (0.0, 0.0))
        state = replace(state, to=state.to.after(Affine(x0=x, y0=y)), copied=True)
        self._open.append(id(target))
        try:
            if target.tag in ("symbol", "svg"):
                inner = self._inside(target, state)
                self._children(target.children, self._viewport(target, inner, node))
            else:
                self._one(target, state)
        finally:
            self._open.pop()

    def _viewport(self, node: Node, state: InheritedState, sized: Node) -> InheritedState:
        """Return the state inside an element with a viewport of its own, whose size another one may give."""
        sizes = {key: value for key, value in sized.attributes.items() if key in ("width", "height")}
        placed = Node(node.tag, {**node.attributes, **sizes}, node.line)
        x, y = self._measured(placed, ("x", "y"), state, (0.0, 0.0))
        width, height = self._measured(placed, ("width", "height"), state, state.view)
        if state.style.overflow != "visible":
            edges = viewport_clip(ViewBox(x, y, width, height), state.to)
            state = replace(state, clips=(*state.clips, edges))
        if "viewBox" not in node.attributes:
            return replace(state, to=state.to.after(Affine(x0=x, y0=y)), view=(width, height))
        try:
            box = view_box(node.attributes["viewBox"])
        except UnreadableError:
            self._refuse(
                node,
                f"the viewBox {node.attributes['viewBox'][:60]!r} is not four numbers, the last two above 0; "
                "correct it",
            )
        to = fitted(box, ViewBox(x, y, width, height), node.attributes.get("preserveAspectRatio", ""))
        return replace(state, to=state.to.after(to), view=(box.width, box.height))

    def _measured(self, node: Node, keys: tuple[str, str], state: InheritedState, default: Viewport) -> Viewport:
        try:
            return measure(node, keys[0], state.basis, default[0]), measure(node, keys[1], state.basis, default[1])
        except UnreadableError as error:
            self._refuse(node, f"the length {error.args[0][:60]!r} cannot be read; write it in mm, px or user units")

    def _draw(self, node: Node, state: InheritedState) -> None:
        content, style = self._sheet, state.style
        if not (style.shown and style.visible and style.draws):
            reason = LeftOutReason.UNPAINTED if style.shown and style.visible else LeftOutReason.INVISIBLE
            content.left_out[LeftOutSort(node.tag, reason)] += 1
            return
        try:
            drawn = shape(node, state.basis, MOST_CURVES)
            if drawn is not None and not style.outlined:
                runs = [closed_by_line(run) for run in drawn.runs]
                drawn.runs = runs if style.evenodd else bounding(runs)
                content.within += len(runs) - len(drawn.runs)
            curves = self._placed(node, drawn, state.to) if drawn is not None else []
        except UnreadableError as error:
            content.unread.append(SvgFault(node.line, str(error.args[0])))
            return
        except (ValueError, ArithmeticError):  # numbers that are none, or beyond all measure
            content.left_out[LeftOutSort(node.tag, LeftOutReason.DAMAGED)] += 1
            return
        if drawn is not None and drawn.fault is not None:
            content.faults.append(SvgFault(node.line, drawn.why))
        for curve in curves:
            if isinstance(curve, Spline) and len(curve.control_points) > MOST_POINTS:
                self._refuse(
                    node, f"a curve has more than {MOST_POINTS} points; split it or thin it out in the CAD program"
                )
        if not curves:
            return
        seen = seen_of(curves, style.filled, state.clips) if state.clips else Seen.WHOLE
        if seen is Seen.NOTHING:
            content.left_out[LeftOutSort(node.tag, LeftOutReason.CLIPPED)] += 1
            return
        layer = state.layer or "0"
        box = _box_of(curves)
        if self._is_ground(style, curves, box):
            content.ground = [LayeredCurve(curve, layer) for curve in curves]
            return
        content.beyond += _apart(box, self._page)
        note = content.layers.setdefault(layer, LayerNote())
        note.inks |= {style.ink or BLACK} if style.outlined else set()
        content.clipped += seen is Seen.PART
        content.of_font += _of_font(node)
        pattern = self._ids.get(style.fill[5:].partition(")")[0]) if style.fill.startswith("url(#") else None
        content.painted.patterned += pattern is not None and pattern.tag == "pattern"
        content.painted.note(node, state, curves[0].start)
        content.curves += [LayeredCurve(curve, layer) for curve in curves]
        if len(content.curves) > MOST_CURVES:
            self._refuse(node, _TOO_MUCH)

    def _is_ground(self, style: SvgStyle, curves: list[Curve], box: Box | None) -> bool:
        """Tell whether a shape without an outline covers the page, is white, and the first one of the drawing."""
        content = self._sheet
        if style.outlined or not _covers(curves, box, self._page):
            return False
        white = style.colour_of_fill == WHITE and not (content.curves or content.ground)
        content.page_wide += not white
        return white

    def _placed(self, node: Node, drawn: SvgPath, to: Affine) -> list[Curve]:
        """Return the curves in the drawing; notes the place of a shape that draws nothing."""
        curves: list[Curve] = []
        for run in map(beziers_joined, drawn.runs):
            moved = [transformed(curve, to) for curve in run]
            self._sheet.nothing += [
                to.point(curve.start) for curve, there in zip(run, moved, strict=True) if there is None
            ]
            seen = [curve for curve in moved if curve is not None]
            curves += joined([curve for curve in seen if not _is_point(curve)] or seen[:1])
        if not any(drawn.runs):
            self._sheet.nothing.append(to.point(drawn.start) if drawn.start is not None else None)
        return [_forward(curve) for curve in curves] if node.tag in ("circle", "ellipse") else curves

    def _refuse(self, node: Node, what: str) -> NoReturn:
        raise InputError(f"{self._name}:{node.line}: {what}.")


def _forward(curve: Curve) -> Curve:
    """Return a whole circle or ellipse, which is drawn in no direction, as counter-clockwise from parameter 0."""
    if isinstance(curve, Ellipse):
        return Ellipse(curve.centre, curve.major, curve.ratio)
    return Circle(curve.centre, curve.radius) if isinstance(curve, Circle) else curve


def _page_box(root: Node, to: Affine, view: Viewport) -> Box | None:
    """Return what the page shows, mm; None where it has no size."""
    given = root.attributes.get("viewBox")
    box = view_box(given) if given else ViewBox(0.0, 0.0, *view)
    if not (box.width > 0 and box.height > 0):
        return None
    (x0, y0), (x1, y1) = to.point((box.x, box.y)), to.point((box.x + box.width, box.y + box.height))
    return (min(x0, x1), min(y0, y1), max(x0, x1), max(y0, y1))


def _box_of(curves: list[Curve]) -> Box | None:
    """Return the box of some curves; None where one has no place."""
    with np.errstate(all="ignore"):
        box = bounds_of_all(curves)
    return box if box is not None and all(map(math.isfinite, box)) else None


def _covers(curves: list[Curve], box: Box | None, page: Box | None) -> bool:
    """Tell whether a shape in a box holds all of a page, but for a little: a round one does not hold the corners."""
    if box is None or page is None:
        return False
    spare = _GROUND * max(page[2] - page[0], page[3] - page[1])
    wide = all(box[k] <= page[k] + spare and box[k + 2] >= page[k + 2] - spare for k in (0, 1))
    return wide and covers(curves, page, spare)


def _apart(box: Box | None, page: Box | None) -> bool:
    """Tell whether a box has nothing in common with a page."""
    if box is None or page is None:
        return False
    return any(box[k] > page[k + 2] or box[k + 2] < page[k] for k in (0, 1))


def _is_point(curve: Curve) -> bool:
    """True for a line between points that are one, as rounding leaves them where a path is closed."""
    return isinstance(curve, Line) and math.dist(curve.start, curve.end) < tolerances.WELD


def _moves(written: str) -> bool:
    """Tell whether a transform changes anything; one that cannot be read may."""
    try:
        return transform(written) != IDENTITY
    except UnreadableError:
        return True


def _of_font(node: Node) -> bool:
    """True where a place or size of a shape that is read depends on what a font is like."""
    return any(FONT_LENGTH.search(node.attributes.get(key, "")) for key in LENGTHS)


def _is_layer(node: Node) -> bool:
    return node.attributes.get(f"{INKSCAPE} groupmode") == "layer"


def _chosen(node: Node) -> list[Node]:
    """Return the first child of a switch that needs nothing special, in no language or in English, else in any."""
    plain = [child for child in node.children if not child.attributes.get("requiredExtensions")]
    languages = (child.attributes.get("systemLanguage", "en") for child in plain)
    meant = [child for child, language in zip(plain, languages, strict=True) if _ENGLISH.search(language)]
    return (meant or plain)[:1]


_CONTAINERS = ("g", "a", "switch", "svg", "use")
