"""Sentences about what of an SVG cannot be read, and what it shows otherwise than it is read."""

from __future__ import annotations

from collections.abc import Iterator

from ...core.wording import in_plane, together
from ...model.finding import Finding, FindingKind
from ..drawing_account import remark
from .strokes import BroadOutline
from .walk import SvgContent

_QUOTED = 40
"""Letters of a text that are told."""


def reading_findings(content: SvgContent) -> Iterator[Finding]:
    """Say what is damaged, missing, or read by a guess."""
    yield from _faults(content)
    yield from _unread(content)
    yield from _unplaced(content)
    yield from _texts(content)
    yield from _of_fonts(content)


def paint_findings(content: SvgContent) -> Iterator[Finding]:
    """Say what of the picture is not in the part, and what may lie elsewhere than in the picture."""
    yield from _clipped(content)
    yield from _unfollowed(content)
    yield from _within(content)
    yield from _beyond(content)
    for layer in content.painted.layers:
        yield _broad([each for each in content.painted.broad if each.layer == layer])
    yield from _details(content)
    yield from _unread_rules(content)


def _unfollowed(content: SvgContent) -> Iterator[Finding]:
    count = content.unfollowed.total()
    if count:
        what = "1 element is" if count == 1 else f"{count} elements are"
        yield Finding(
            FindingKind.LEFT_OUT,
            f"{what} moved or formed by {together(sorted(content.unfollowed))}, which is not followed, so that the "
            "part differs from the picture; ungroup it in the editor, or save as plain SVG.",
            amount=float(count),
        )


def _within(content: SvgContent) -> Iterator[Finding]:
    if content.within:
        what = "1 outline lies" if content.within == 1 else f"{content.within} outlines lie"
        yield remark(
            f"{what} within the area that the path paints (fill-rule: nonzero) and cannot be seen; left out.",
            float(content.within),
        )


def _beyond(content: SvgContent) -> Iterator[Finding]:
    if content.beyond:
        yield remark(
            "1 shape lies wholly beyond the page, where viewers show nothing; it is read like any other."
            if content.beyond == 1
            else f"{content.beyond} shapes lie wholly beyond the page, where viewers show nothing; they are read like "
            "any other.",
            float(content.beyond),
        )
    if content.page_wide:
        yield remark(
            "1 area without an outline is as large as the page and read like any other; where it is but the ground of "
            "the picture, delete it."
            if content.page_wide == 1
            else f"{content.page_wide} areas without an outline are as large as the page and read like any other; "
            "where they are but the ground of the picture, delete them.",
            float(content.page_wide),
        )


def _broad(alike: list[BroadOutline]) -> Finding:
    """Say that the middle lines of broad outlines on one layer are read."""
    (x, y), layer, count = alike[0].at, alike[0].layer, len(alike)
    least, most = min(each.width for each in alike), max(each.width for each in alike)
    wide = f"{most:.4g}" if most - least < 1e-3 * most else f"{least:.4g} to {most:.4g}"
    text = (
        f"1 outline on layer {layer} at {in_plane(x, y)} is drawn {wide} mm wide; its middle line is "
        "read. Turn the outline into a path where its borders are meant."
        if count == 1
        else f"{count} outlines on layer {layer}, the first at {in_plane(x, y)}, are drawn {wide} mm "
        "wide; their middle lines are read. Turn the outlines into paths where their borders are meant."
    )
    return Finding(FindingKind.ASSUMED, text, x, y, counts=False, amount=float(count), layer=layer)


def _details(content: SvgContent) -> Iterator[Finding]:
    painted = content.painted
    told = (
        (painted.dashed, "a dashed outline, which is read whole"),
        (painted.marked, "markers such as arrowheads, which are not read"),
        (painted.filtered, "a filter such as a blur or a shadow, which is not read"),
        (painted.patterned, "a pattern as its filling, which is not read"),
        (painted.unseen, "an outline of width 0, which is read though nobody sees it"),
    )
    for count, what in told:
        if count:
            who = "1 shape has" if count == 1 else f"{count} shapes have"
            yield remark(f"{who} {what}.", float(count))


def _faults(content: SvgContent) -> Iterator[Finding]:
    if content.faults:
        what = "1 shape has" if len(content.faults) == 1 else f"{len(content.faults)} shapes have"
        first = next((fault for fault in content.faults if fault.what), content.faults[0])
        why = f" ({first.what})" if first.what else ""
        text = (
            f"{what} data that cannot be read to the end, the first in line {first.line}{why}; what stands before is "
            "drawn. Check it."
        )
        yield Finding(FindingKind.LEFT_OUT, text, amount=float(len(content.faults)))


def _unread(content: SvgContent) -> Iterator[Finding]:
    """Name shapes that are missing since a length of theirs cannot be read."""
    if content.unread:
        first, count = content.unread[0], len(content.unread)
        what = "1 shape is" if count == 1 else f"{count} shapes are"
        where = "in" if count == 1 else "the first in"
        yield Finding(
            FindingKind.LEFT_OUT,
            f"{what} missing from the part, {where} line {first.line}: the length {first.what[:60]!r} cannot be read; "
            "write it in mm, px or user units.",
            amount=float(count),
        )


def _unplaced(content: SvgContent) -> Iterator[Finding]:
    """Name elements that are missing since it is not known where they lie."""
    if content.unplaced:
        first, count = content.unplaced[0], len(content.unplaced)
        what = "1 element is" if count == 1 else f"{count} elements are"
        where = "in" if count == 1 else "the first in"
        yield Finding(
            FindingKind.LEFT_OUT,
            f"{what} missing from the part, {where} line {first.line}: the transform {first.what[:60]!r} cannot be "
            "followed; ungroup it in the editor, or save as plain SVG.",
            amount=float(count),
        )


def _texts(content: SvgContent) -> Iterator[Finding]:
    """Say which texts are missing, and how many letters."""
    if content.texts:
        first, count = content.texts[0], len(content.texts)
        letters = sum(len("".join(each.words.split())) for each in content.texts)
        words = first.words if len(first.words) <= _QUOTED else f"{first.words[:_QUOTED]}…"
        text = (
            f'The text "{words}" in line {first.line} is missing from the part; turn it into a path in the editor.'
            if count == 1
            else f'{count} texts of {letters} letters in all, the first "{words}" in line {first.line}, are missing '
            "from the part; turn them into paths in the editor."
        )
        yield Finding(FindingKind.LEFT_OUT, text, amount=float(count))


def _of_fonts(content: SvgContent) -> Iterator[Finding]:
    """Say that lengths were read that depend on a font."""
    if content.of_font:
        what = "1 shape has" if content.of_font == 1 else f"{content.of_font} shapes have"
        yield remark(
            f"{what} lengths in ex or ch, which depend on a font; half of the height of the letters is taken. "
            "Measure one of them, or write them in mm.",
            float(content.of_font),
        )


def _clipped(content: SvgContent) -> Iterator[Finding]:
    if content.clipped:
        what = "1 shape is" if content.clipped == 1 else f"{content.clipped} shapes are"
        yield Finding(
            FindingKind.LEFT_OUT,
            f"{what} cut by a clip, a mask or the edge of a symbol, and read whole, so that the part differs from the "
            "picture; cut the paths themselves in the editor, or take the clip away.",
            amount=float(content.clipped),
        )


def _unread_rules(content: SvgContent) -> Iterator[Finding]:
    if content.unread_rules:
        count, first = len(content.unread_rules), content.unread_rules[0][:60]
        yield Finding(
            FindingKind.LEFT_OUT,
            f"{count} {'rule' if count == 1 else 'rules'} of the style sheet cannot be followed, the first for "
            f"{first}; check that nothing hidden is read.",
            counts=content.rules_hide,
            amount=float(count),
        )
