"""SVG in: curves in mm, y upwards from the page's lower edge, layers, units, and an account of what is left out."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import PurePath

from ...core.errors import InputError
from ...core.options import option
from ...geometry.affine import Affine
from ...model.finding import Finding, FindingKind
from ...model.layer_names import known_layers
from ...model.part import Layer, Part, Units
from ...model.read_options import AS_DRAWN, DrawingOptions
from ...model.reading import ReadingOptions
from ..drawing import Drawing, LeftOutSort, left_out_kinds
from ..drawing_account import (
    UsableCurves,
    all_left_out,
    listed,
    moving,
    on_layers,
    other_units,
    placement_findings,
    remark,
    size_of,
    strays_or_none,
    switched_off,
    usable_curves,
    without_length,
)
from ..reading_question import (
    AssumedDensity,
    FileContents,
    ReadingQuestion,
    Size,
    UndecidedError,
    far_question,
    pixels_question,
)
from .findings import paint_findings, reading_findings
from .generator import CSS_PER_INCH, KNOWN_PER_INCH, PixelDensity, density_of
from .lengths import LengthBasis, WrittenLength, length
from .numbers import UnreadableError, ViewBox, fitted, numbers, view_box
from .style import StyleSheet, SvgStyle
from .walk import TEXTS, SvgContent, SvgWalker
from .xml import Node, read_xml

HITOFUDE = "urn:hitofude:svg"
"""Namespace of what only this program writes: the attribute `zero`, the part's zero in user units of the page."""
_TEXTS = frozenset(map(LeftOutSort, TEXTS))
"""Texts that are seen, which have a sentence of their own."""
_SHOWN = {"in": Units.INCH, "cm": Units.CM}


@dataclass(frozen=True)
class _Page:
    """How the root's user units lie in the part.

    Attributes:
        to: from user units to mm, y upwards.
        view: width and height that percentages are of, user units.
        shown: units to show.
        named: the file tells a real size.
    """

    to: Affine
    view: tuple[float, float]
    shown: Units
    named: bool


def read_svg(
    data: bytes,
    name: str = "drawing.svg",
    units: Units | None = None,
    layers: tuple[str, ...] = (),
    how: DrawingOptions = AS_DRAWN,
) -> Drawing:
    """Return the curves of an SVG in mm, and what was left out.

    Zero is the page's lower left corner, as its width, height and viewBox give it; a page without a height has it at
    the top. Inkscape's layers become layers, hidden ones too; without them the named groups at the top. Text, pictures
    and what draws nothing are counted, not read, and so is what a clip or a mask hides; what one cuts is read whole,
    and a finding. Without a width or a height in mm,
    inches or points the file has no real size: it is in `units`, or in pixels, so many to the inch as `how` says, else
    as the editor had that wrote it, else 96.

    Args:
        data: the whole file.
        name: for messages and titles.
        units: of a user unit, where the file has no real size.
        layers: names of layers (in any case) whose curves are kept; empty = all.
        how: pixels to the inch, and whether everything is moved to zero.

    Raises:
        InputError: the file is no usable SVG, has no curves, or has not one of the layers.
    """
    opened = _opened(name, data, units, how)
    root, density, page = opened.root, opened.density, opened.page
    content, reading = SvgWalker(root, name).content(page.to, page.view), ReadingOptions(units, layers, how)

    def placed(to_zero: bool) -> UsableCurves:
        return usable_curves(content.curves, None, _anchors(content, layers, how.without_layers) if to_zero else None)

    found = placed(how.to_zero)
    unread = {
        LeftOutSort("shape of unreadable length"): len(content.unread),
        LeftOutSort("element of unreadable transform"): len(content.unplaced),
    }
    left_out = +(content.left_out + found.missing + Counter(unread))
    if not found.entities:
        why = (
            "all of the drawing lies beyond 1 km"
            if found.far
            else "the drawing has no lines, arcs or curves to machine"
        )
        far = bool(found.far and not how.to_zero)
        raise UndecidedError(
            f"{name}: {why}{f'; {moving()}' * far}{listed(left_out, '; left out: ')}.",
            far_question(found.far[0][0], reading, page.shown) if far else None,
        )
    shown = tuple(note.layer(layer) for layer, note in content.layers.items())
    part = Part(name=PurePath(name).stem, units=page.shown, layers=shown or (Layer(),)).with_entities(found.entities)
    assumed = not page.named and units is None  # told, so that whoever reads the drawing again takes the same
    part = replace(
        on_layers(part, layers, name), reading=replace(how, pixels_per_inch=density.per_inch) if assumed else how
    )
    findings = [
        *_units(units, page, density, how),
        *placement_findings(found),
        *reading_findings(content),
        *without_length(content.nothing + found.nothing),
        *paint_findings(content),
        *switched_off(part, layers),
        *all_left_out(Counter({sort: count for sort, count in content.left_out.items() if sort not in _TEXTS})),
    ]
    own = density_of(root)
    contents = FileContents(
        tuple(layer.name for layer in shown),
        units=page.shown if page.named else None,
        per_inch=None if page.named else own.per_inch,
        editor=own.editor,
    )
    question = strays_or_none(found, reading, placed)
    if question is None and not (page.named or units or how.pixels_per_inch):
        question = _about_pixels(root, density, size_of(part), page.to, reading)
    return Drawing(part, tuple(findings), left_out_kinds(left_out), page.named, contents, question)


@dataclass(frozen=True)
class _OpenedFile:
    """A file whose page is known, and how many of its units it takes for an inch where it names no size."""

    root: Node
    density: PixelDensity
    page: _Page


def _opened(name: str, data: bytes, units: Units | None, how: DrawingOptions) -> _OpenedFile:
    root = read_xml(data, name)
    if root.tag != "svg":
        raise InputError(
            f"{name}:{root.line}: this is not an SVG file, it begins with {root.tag[:60]}; export the drawing as SVG."
        )
    if units is not None and how.pixels_per_inch is not None:
        raise InputError(
            f"{name}: units and {option('px-per-inch')} say the same of a drawing in two ways; give one of them."
        )
    density = density_of(root) if how.pixels_per_inch is None else PixelDensity(how.pixels_per_inch)
    try:
        page = _page(root, units, density.pixel, how.overrule)
    except UnreadableError as error:
        raise InputError(
            f"{name}:{root.line}: the page's width, height or viewBox, {error.args[0][:60]!r}, cannot be read; "
            "give it a size above 0 and save it again."
        ) from None
    return _OpenedFile(root, density, page)


def _about_pixels(
    root: Node, density: PixelDensity, size: Size, to: Affine, reading: ReadingOptions
) -> ReadingQuestion:
    """Ask how large the page's units are; `size` is the drawing's now, mm, and `to` the map by which it has it."""
    wide, high = size

    def size_in(other: ReadingOptions) -> Size:
        per_inch = other.how.pixels_per_inch
        made = _page(root, other.units, PixelDensity(per_inch).pixel if per_inch else density.pixel).to
        return wide * made.xx / to.xx, high * made.yy / to.yy

    return pixels_question(AssumedDensity(density.per_inch, density.editor), KNOWN_PER_INCH, size_in, reading)


def _anchors(content: SvgContent, layers: tuple[str, ...], without: tuple[str, ...]) -> Callable[[str], bool]:
    """Return what tells whether a layer is machined, and so counts for where the drawing lies."""
    there = {*content.layers, *(each.layer for each in content.curves)}
    wanted, gone = (known_layers(names, there) for names in (layers, without))
    hidden = {layer for layer, note in content.layers.items() if not note.visible}
    return lambda layer: (
        layer.casefold() not in gone and (layer.casefold() in wanted if layers else layer not in hidden)
    )


def _page(root: Node, units: Units | None, pixel: float, overrule: bool = False) -> _Page:
    """Return the page.

    Args:
        units: of a user unit where the file has no real size, or, overruling it, even where it has one.
        pixel: its size, mm.

    Raises:
        UnreadableError: a length or the viewBox cannot be read.
    """
    style = StyleSheet(root).style(root, SvgStyle())
    width, height = (_given(root, key, style) for key in ("width", "height"))
    box = view_box(root.attributes["viewBox"]) if "viewBox" in root.attributes else None
    physical = next(
        (given for given in (width, height) if given is not None and given.is_physical and not overrule), None
    )
    shown = _SHOWN.get(physical.unit, Units.MM) if physical is not None else units or Units.MM
    if physical is None and units is not None:
        unit, width, height = units.value, None if box else width, None if box else height
    else:
        unit = pixel
    wide, high = (_mm(each, unit, style.em) for each in (width, height))
    if box is None:
        to, view = Affine(unit, 0.0, 0.0, unit), ((wide or 0.0) / unit, (high or 0.0) / unit)
    else:
        scale = wide / box.width if wide is not None else high / box.height if high is not None else unit
        wide, high = wide if wide is not None else scale * box.width, high if high is not None else scale * box.height
        to = fitted(box, ViewBox(0.0, 0.0, wide, high), root.attributes.get("preserveAspectRatio", ""))
        view = (box.width, box.height)
    zero = _zero(root)
    x, y = to.point(zero) if zero is not None else (0.0, high or 0.0)
    return _Page(Affine(1.0, 0.0, 0.0, -1.0, -x, y).after(to), view, shown, physical is not None)


def _given(root: Node, key: str, style: SvgStyle) -> WrittenLength | None:
    """Return the page's width or height; None where it is not given or only a share of a window.

    What a style sheet says of it counts where that alone has a size of its own: else it is the size of a window.
    """
    found = _written(root.attributes.get(key, ""))
    if found is None or not found.is_physical:
        with suppress(UnreadableError):
            sized = _written(style.geometry.get(key, ""))
            found = sized if sized is not None and sized.is_physical else found
    return found


def _written(text: str) -> WrittenLength | None:
    """Return a length above 0; None for nothing, or for a share of a window."""
    found = None if text.strip() in ("auto", "") else length(text)
    if found is None or found.is_share:
        return None
    if not 0 < found.user(LengthBasis((0.0, 0.0))) < math.inf:
        raise UnreadableError(text.strip())
    return found


def _mm(given: WrittenLength | None, unit: float, em: float) -> float | None:
    if given is None:
        return None
    return given.mm if given.is_physical else given.user(LengthBasis((0.0, 0.0), em, em)) * unit


def _zero(root: Node) -> tuple[float, float] | None:
    """Return the part's zero where this program has written it."""
    text = root.attributes.get(f"{HITOFUDE} zero")
    if text is None:
        return None
    given = numbers(text)
    if len(given) != 2 or not all(map(math.isfinite, given)):
        raise UnreadableError(text)
    return given[0], given[1]


def _units(given: Units | None, page: _Page, density: PixelDensity, how: DrawingOptions) -> Iterator[Finding]:
    if page.named:
        yield from other_units(given, page.shown)
        if how.pixels_per_inch is not None:
            yield remark(
                f"The drawing tells its real size; {option('px-per-inch')} counts only for what of it is in pixels of "
                "the page."
            )
    elif given is None and how.pixels_per_inch is None:
        who = f"It was written by {density.editor}, so " if density.editor else ""
        another = f", and {option('px-per-inch', f'{CSS_PER_INCH:g}')} if it was saved by another editor since"
        other = another if density.editor else ""
        text = (
            f"The drawing has no real size; {who}{density.per_inch:g} units to the inch are assumed. If a unit is 1 "
            f"mm or 1 inch, choose {option('units')}, or on opening{other}."
        )
        yield Finding(FindingKind.UNITS_ASSUMED, text, counts=False)
