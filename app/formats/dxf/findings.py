"""Sentences about what reading a DXF met: decimal commas, radii below 0, blocks that no CAD program shows, texts and
hatches.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from ...core import tolerances
from ...core.options import option
from ...core.wording import in_plane, together
from ...geometry.sample import bounds, bounds_of_all
from ...model.curves import Curve
from ...model.finding import Finding, FindingKind
from ..drawing_account import remark
from .blocks import DrawnCurves
from .content import BrokenLine, ClippedBlock, DxfContent, HiddenInsert, WidePolyline
from .curves import is_unbroken
from .letters import TextCurves
from .numbers import DecimalCommas

_NAMED, _LETTERS = 3, 10
"""So many blocks, layers or fonts, and so many letters, are named in one sentence."""


def comma_findings(commas: DecimalCommas) -> Iterator[Finding]:
    """Say that decimal commas were read as points."""
    if commas.count:
        what = "1 number has a decimal comma" if commas.count == 1 else f"{commas.count} numbers have decimal commas"
        yield remark(
            f"{what}, the first, {commas.value}, in line {commas.line}; they are read as decimal points.",
            float(commas.count),
        )


def negative_radius_findings(content: DxfContent, size: float) -> Iterator[Finding]:
    """Say that circles and arcs are missing, for their radius is below 0; `size` is that of the drawing's unit, mm."""
    if content.negative:
        first = content.negative[0]
        x, y, radius = first.at[0] * size, first.at[1] * size, first.radius * size
        count = len(content.negative)
        what = (
            "1 circle or arc has a radius below 0 and is"
            if count == 1
            else f"{count} circles or arcs have a radius below 0 and are"
        )
        text = (
            f"{what} missing from the part{'' if count == 1 else ', the first'}: {radius:g} mm round "
            f"{in_plane(x, y)} on layer {first.layer}; draw it again."
        )
        yield Finding(FindingKind.LEFT_OUT, text, x, y, amount=float(count))


def about_unread(content: DxfContent, size: float) -> Iterator[Finding]:
    """Name texts and curves that are left out for what they are, a sentence a sort; `size`: the drawing's unit, mm."""
    for sort in dict.fromkeys(each.sort for each in content.unread):
        alike = [each for each in content.unread if each.sort == sort]
        x, y = alike[0].at[0] * size, alike[0].at[1] * size
        count, where = len(alike), f"at {in_plane(x, y)} on layer {alike[0].layer}"
        text = (
            f"1 {sort.said} {where} is not read."
            if count == 1
            else f"{count} {sort.said} are not read, the first {where}."
        )
        yield Finding(FindingKind.LEFT_OUT, text, x, y, counts=False, amount=float(count), layer=alike[0].layer)


def band_findings(bands: Sequence[WidePolyline], size: float) -> Iterator[Finding]:
    """Say that the middle lines of polylines with a width are read, a sentence a layer.

    Args:
        bands: on layers that are machined. size: of the drawing's unit, mm.
    """
    for layer in dict.fromkeys(each.layer for each in bands):
        alike = [each for each in bands if each.layer == layer]
        least, most = min(each.least for each in alike) * size, max(each.most for each in alike) * size
        wide = f"{most:.6g}" if least == most else f"{least:.6g} to {most:.6g}"
        x, y = alike[0].at[0] * size, alike[0].at[1] * size
        what = (
            f"1 polyline on layer {layer} is drawn as a band {wide} mm wide"
            if len(alike) == 1
            else f"{len(alike)} polylines on layer {layer} are drawn as bands {wide} mm wide, the first"
        )
        slot = option("slot-width")
        read, do = (
            ("its middle line is", f"Cut it as a slot of that width ({slot}), or draw its outline")
            if len(alike) == 1
            else ("their middle lines are", f"Cut them as slots of their widths ({slot}), or draw their outlines")
        )
        yield Finding(
            FindingKind.ASSUMED,
            f"{what} at {in_plane(x, y)}; {read} read. {do}.",
            x,
            y,
            counts=False,
            amount=float(len(alike)),
            layer=layer,
        )


def broken_line_findings(lines: Sequence[BrokenLine], size: float) -> Iterator[Finding]:
    """Say that curves with gaps, as centre lines have, are machined, a sentence a layer.

    Args:
        lines: on layers that are machined. size: of the drawing's unit, mm.
    """
    for layer in dict.fromkeys(each.layer for each in lines):
        alike = [each for each in lines if each.layer == layer]
        kinds, count = together(list(dict.fromkeys(each.line_type for each in alike))), len(alike)
        x, y = alike[0].at[0] * size, alike[0].at[1] * size
        what = (
            f"1 curve on layer {layer} at {in_plane(x, y)} is"
            if count == 1
            else f"{count} curves on layer {layer}, the first at {in_plane(x, y)}, are"
        )
        text = (
            f"{what} drawn in line type {kinds}, as centre lines and hidden edges are, and read like any other; what "
            f"is not to be machined belongs on a layer of its own, which {option('skip-layer')} leaves out."
        )
        yield Finding(FindingKind.ASSUMED, text, x, y, counts=False, amount=float(count), layer=layer)


def layer_findings(document: Any, used: Mapping[str, int]) -> Iterator[Finding]:
    """Say that layers are machined that never come on paper, or on which all is drawn as centre lines are.

    Args:
        document: of the library. used: how many curves each layer that is machined has.
    """
    for layer in document.layers:
        name = layer.dxf.name
        line_type, count = str(layer.dxf.get("linetype", "")), used.get(name, 0)
        plotted = layer.dxf.get("plot", 1) and name.casefold() != "defpoints"
        if count and not (plotted and is_unbroken(line_type)):
            what = "its curve is" if count == 1 else f"its {count} curves are"
            text = (
                f"Layer {name} is drawn in line type {line_type}, as centre lines and hidden edges are; {what} read "
                f"like any other. {option('skip-layer')} leaves it out."
                if plotted
                else f"Layer {name} is never plotted, as layers of construction lines are; {what} read like any other. "
                f"{option('skip-layer')} leaves it out."
            )
            yield Finding(FindingKind.ASSUMED, text, counts=False, amount=float(count), layer=name)


def hidden_insert_findings(content: DxfContent, size: float) -> Iterator[Finding]:
    """Name the blocks that are inserted on frozen layers, a sentence a layer; `size` is that of the drawing's unit,
    mm.
    """
    for layer in dict.fromkeys(each.layer for each in content.hidden):
        yield _hidden([each for each in content.hidden if each.layer == layer], size)


def _hidden(inserts: list[HiddenInsert], size: float) -> Finding:
    layer, blocks = inserts[0].layer, dict.fromkeys(each.block for each in inserts)
    curves = [on for each in inserts for on in each.curves]
    named = ", ".join(list(blocks)[:_NAMED]) + (f" and {len(blocks) - _NAMED} more" if len(blocks) > _NAMED else "")
    at = next((each.at for each in inserts if each.at is not None), None)
    first = "" if len(inserts) == 1 else "the first "
    where = f", {first}at {in_plane(at[0] * size, at[1] * size)}," if at is not None else ""
    what = f"Block {named} is" if len(inserts) == 1 else f"{len(inserts)} blocks ({named}) are"
    requested = " ".join(option("layer", each) for each in list(dict.fromkeys((layer, *curves)))[: _NAMED + 1])
    lost = "1 curve is" if len(curves) == 1 else f"{len(curves)} curves are"
    return remark(
        f"{what} inserted{where} on layer {layer}, which is frozen; {lost} not shown and not machined. "
        f"Say {requested} to machine them; in the window they are chosen in File, Reading options.",
        float(len(curves)),
    )


def upright_findings(count: int, curves: Sequence[Curve], climbs: bool) -> Iterator[Finding]:
    """Say that entities are seen edge-on; it counts where all of the drawing is, which then is no part.

    Args:
        count: of entities that are seen edge-on, wholly or in part. curves: what is machined, mm.
        climbs: whether one of these curves does, by itself.
    """
    if len(curves) > 1 and (count or climbs) and _is_a_view(count, curves, climbs):
        text = (
            "All of the drawing stands upright and is seen edge-on from above; lay it into the XY plane in the CAD "
            "program and save it again."
        )
        yield Finding(FindingKind.LEFT_OUT, text, amount=float(count))
    elif count:
        what = "1 entity stands" if count == 1 else f"{count} entities stand"
        yield remark(
            f"{what} upright and cannot be seen from above; if that is a front or a side view, lay it into the XY "
            "plane in the CAD program and save it again.",
            float(count),
        )


def _is_a_view(count: int, curves: Sequence[Curve], climbs: bool) -> bool:
    """Tell whether curves are those of a front or a side view: all on one line, and there are half as many upright
    entities, or the curves climb and lie over one another; slots of several depths, and ramps between them, lie beside
    one another.
    """
    box = bounds_of_all(curves)
    if box is None or min(box[2] - box[0], box[3] - box[1]) > tolerances.CURVE:
        return False
    spans = (max(x1 - x0, y1 - y0) for x0, y0, x1, y1 in map(bounds, curves))
    along = max(box[2] - box[0], box[3] - box[1])
    return 2 * count >= len(curves) or (climbs and sum(spans) > along + tolerances.CURVE)


def clip_findings(clipped: Sequence[ClippedBlock], size: float) -> Iterator[Finding]:
    """Say that clipped blocks are read whole.

    Args:
        clipped: with something hidden on layers that are machined. size: of the drawing's unit, mm.
    """
    if clipped:
        first, count = clipped[0], len(clipped)
        x, y = first.at[0] * size, first.at[1] * size
        what = (
            f"Block {first.name}, inserted at {in_plane(x, y)}, is clipped"
            if count == 1
            else f"{count} inserted blocks, the first ({first.name}) at {in_plane(x, y)}, are clipped"
        )
        text = (
            f"{what} and read whole, so that the part differs from what CAD programs show; explode and trim it there, "
            "or take the clip away."
        )
        yield Finding(FindingKind.LEFT_OUT, text, x, y, amount=float(count))


def text_findings(texts: Sequence[TextCurves], size: float) -> Iterator[Finding]:
    """Say that texts are read, in which fonts, and how to leave them out; and which letters are missing from them.

    Args:
        texts: on layers that are machined. size: of the drawing's unit, mm.
    """
    if not texts:
        return
    kinds = dict.fromkeys(each.kind for each in texts)
    out = f"leave them out with {' '.join(option('skip-type', kind) for kind in kinds)}"
    counts = Counter(pair for each in texts for pair in each.fonts)
    fonts = ", ".join(f"{count} {_in_font(*pair)}" for pair, count in counts.most_common(_NAMED))
    more = f" and {len(counts) - _NAMED} more fonts" if len(counts) > _NAMED else ""
    what = "1 text is" if len(texts) == 1 else f"{len(texts)} texts are"
    yield Finding(
        FindingKind.ASSUMED,
        f"{what} read as curves to machine: {fonts}{more}; {out}.",
        counts=False,
        amount=float(len(texts)),
    )
    yield from _assumed_places([each for each in texts if each.assumed], size)
    short = [each for each in texts if each.lacking]
    if short:
        letters = list(dict.fromkeys(letter for each in short for letter in each.lacking))
        named = " ".join(letter if letter.isprintable() else f"U+{ord(letter):04X}" for letter in letters[:_LETTERS])
        rest = f" and {len(letters) - _LETTERS} more" if len(letters) > _LETTERS else ""
        x, y = short[0].at[0] * size, short[0].at[1] * size
        where = (
            f"the text at {in_plane(x, y)}" if len(short) == 1 else f"{len(short)} texts, the first at {in_plane(x, y)}"
        )
        yield Finding(
            FindingKind.LEFT_OUT,
            f"No font here has {named}{rest}, missing from {where} on layer {short[0].layer}; "
            f"install the drawing's font, or {out}.",
            x,
            y,
            amount=float(len(short)),
        )


def _assumed_places(texts: Sequence[TextCurves], size: float) -> Iterator[Finding]:
    """Say that lines that run downwards in columns may stand elsewhere in other programs."""
    if texts:
        x, y = texts[0].at[0] * size, texts[0].at[1] * size
        what = "The text" if len(texts) == 1 else f"{len(texts)} texts, the first"
        runs = "runs" if len(texts) == 1 else "run"
        yield remark(
            f"{what} at {in_plane(x, y)} on layer {texts[0].layer} {runs} downwards in columns; its "
            "lines are broken where a column ends, and other programs may break them elsewhere. Compare it with the "
            "drawing, or explode it there.",
            float(len(texts)),
        )


def _in_font(requested: str, drawn: str) -> str:
    if drawn:
        return f"in {drawn}"
    return (
        f"in the engraving face, for font {requested} is not installed here"
        if requested
        else "in the engraving face, for no font is named"
    )


def hatch_findings(drawn: DrawnCurves) -> Iterator[Finding]:
    """Say that boundaries of hatches are read, how many lie on drawn curves, and how to leave them out."""
    if drawn.boundaries:
        what = "1 boundary of a hatch is" if drawn.boundaries == 1 else f"{drawn.boundaries} boundaries of hatches are"
        new = drawn.boundaries - drawn.repeated
        if not drawn.repeated:
            how = f"{what} read as outlines to machine"
        elif not new:
            how = f"{what} drawn as curves too, and not taken twice"
        else:
            how = f"{what} read as outlines to machine, but for {drawn.repeated} drawn as curves too"
        out = " ".join(option("skip-type", kind) for kind in drawn.kinds)
        yield remark(f"{how}; leave them out with {out}.", float(new))


def repeated_findings(names: tuple[str, ...]) -> Iterator[Finding]:
    """Count blocks that are defined again under a name that is taken: what they draw is missing."""
    if names:
        text = (
            f"Block '{names[0]}' is defined again under its name; the first one is drawn, as CAD programs do, and what "
            "the other draws is missing. Give it a name of its own in the CAD program."
            if len(names) == 1
            else f"{len(names)} blocks, '{names[0]}' for one, are defined again under their names; the first ones are "
            "drawn, as CAD programs do, and what the others draw is missing. Give them names of their own in the CAD "
            "program."
        )
        yield Finding(FindingKind.LEFT_OUT, text, amount=float(len(names)))


def stray_findings(strays: Mapping[str, int]) -> Iterator[Finding]:
    """Count what stands in a file where nothing is drawn; `strays`: how many of each type."""
    count = sum(strays.values())
    if count:
        kinds = together([f"{number} {kind}" for kind, number in strays.items()])
        text = (
            f"1 entity stands outside of the drawing and its blocks ({kinds}) and is missing from the part; save the "
            "drawing again from the CAD program."
            if count == 1
            else f"{count} entities stand outside of the drawing and its blocks ({kinds}) and are missing from the "
            "part; save the drawing again from the CAD program."
        )
        yield Finding(FindingKind.LEFT_OUT, text, amount=float(count))
