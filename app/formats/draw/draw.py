"""Drawings in the shape language, `.draw` files."""

from __future__ import annotations

from dataclasses import replace
from pathlib import PurePath

from ...core.errors import InputError
from ...drafting.document import drawn
from ...model.part import Layer, Part, Units
from ..drawing import Drawing
from ..drawing_account import on_layers, other_units, switched_off

MOST_BYTES = 20_000_000
"""Of a text that is read, at most."""


def read_draw(
    data: bytes, name: str = "part.draw", units: Units | None = None, layers: tuple[str, ...] = ()
) -> Drawing:
    """Return the drawing that a text of the shape language draws; its lengths are mm where they have no unit.

    Args:
        data: the whole file, UTF-8.
        name: for messages; its stem becomes the part's name.
        units: not used; a finding says so where they are others.
        layers: only curves on these are kept; empty = all.

    Raises:
        InputError: the text cannot be read or carried out, with line and column; or it has not one of the layers.
    """
    if len(data) > MOST_BYTES:
        raise InputError(
            f"{name}: the text has {len(data)} bytes; at most {MOST_BYTES} are read. Split it, or repeat with repeat."
        )
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data[: error.start].count(b"\n") + 1
        raise InputError(f"{name}:{line}: this is no text in UTF-8; save it as plain text.") from error
    part = _tidy(drawn(text, name))
    if not part.entities:
        raise InputError(f"{name}: the text draws nothing; draw with line, arc, circle or rect.")
    part = on_layers(replace(part, name=PurePath(name).stem), layers, name)
    return Drawing(part, (*other_units(units, Units.MM), *switched_off(part, layers)))


def _tidy(part: Part) -> Part:
    """Return the part without the layer that every drawing begins with, where others are there and it is empty."""
    used = {e.layer for e in part.entities} | {n.layer for n in part.notes}
    kept = tuple(layer for layer in part.layers if layer.name in used or layer.name != Layer().name)
    return replace(part, layers=kept or part.layers)
