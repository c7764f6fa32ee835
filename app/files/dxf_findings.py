"""Sentences about what reading a DXF met: decimal commas, radii below 0, blocks that no CAD program shows."""

from __future__ import annotations

from collections.abc import Iterator

from app.files.drawing_account import remark
from app.files.dxf_blocks import Hidden, Sheet
from app.files.dxf_numbers import Commas
from app.model.finding import Finding, FindingKind

_NAMED = 3
"""So many blocks or layers are named in one sentence."""


def about_commas(commas: Commas) -> Iterator[Finding]:
    """Say that decimal commas were read as points."""
    if commas.count:
        what = "1 number has a decimal comma" if commas.count == 1 else f"{commas.count} numbers have decimal commas"
        yield remark(f"{what}, the first, {commas.value}, in line {commas.line}; they are read as decimal points.", float(commas.count))


def about_negative(sheet: Sheet, size: float) -> Iterator[Finding]:
    """Say that circles and arcs are missing, for their radius is below 0; `size` is that of the drawing's unit, mm."""
    if sheet.negative:
        first = sheet.negative[0]
        x, y, radius = first.at[0] * size, first.at[1] * size, first.radius * size
        count = len(sheet.negative)
        what = "1 circle or arc has a radius below 0 and is" if count == 1 else f"{count} circles or arcs have a radius below 0 and are"
        text = (f"{what} missing from the part{'' if count == 1 else ', the first'}: {radius:g} mm round ({x:.3f}, {y:.3f}) "
                f"on layer {first.layer}; draw it again.")
        yield Finding(FindingKind.LEFT_OUT, text, x, y, amount=float(count))


def about_hidden(sheet: Sheet, size: float) -> Iterator[Finding]:
    """Name the blocks that are inserted on frozen layers, a sentence a layer; `size` is that of the drawing's unit, mm."""
    for layer in dict.fromkeys(each.layer for each in sheet.hidden):
        yield _hidden([each for each in sheet.hidden if each.layer == layer], size)


def _hidden(inserts: list[Hidden], size: float) -> Finding:
    layer, blocks = inserts[0].layer, dict.fromkeys(each.block for each in inserts)
    curves = [on for each in inserts for on in each.curves]
    named = ", ".join(list(blocks)[:_NAMED]) + (f" and {len(blocks) - _NAMED} more" if len(blocks) > _NAMED else "")
    at = next((each.at for each in inserts if each.at is not None), None)
    first = "" if len(inserts) == 1 else "the first "
    where = f", {first}at ({at[0] * size:.3f}, {at[1] * size:.3f})," if at is not None else ""
    what = f"Block {named} is" if len(inserts) == 1 else f"{len(inserts)} blocks ({named}) are"
    wanted = " ".join(f"--layer {each}" for each in list(dict.fromkeys((layer, *curves)))[: _NAMED + 1])
    lost = "1 curve is" if len(curves) == 1 else f"{len(curves)} curves are"
    return remark(f"{what} inserted{where} on layer {layer}, which is frozen; {lost} not shown and not machined. "
                  f"Say {wanted} to machine them; in the window they are chosen in File, Reading options.", float(len(curves)))
