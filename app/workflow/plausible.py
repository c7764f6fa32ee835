"""Whether a drawing's size can be meant with the tools that are to cut it; where not, its units are asked for before anything is computed.

A refusal and no finding: what would be computed is the wrong part, for minutes, and one word of the user settles it either way.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from pathlib import PurePath

from app.edit.sample import bounds, union
from app.errors import InputError
from app.files.drawing import Drawing, read_drawing
from app.model.part import Part, Units
from app.model.read_options import ReadOptions

_WIDEST, _LEAST_WIDE = 2000.0, 5000.0
"""So many times as long as the widest tool is wide, and so many mm, a part is no part any more: no machine for that tool takes it."""

_SMALLEST, _LARGEST_SMALL = 0.05, 0.5
"""Less of the smallest tool's width, and less than so many mm, is nothing to be milled."""

_UNITS = {Units.MM: "mm", Units.INCH: "in", Units.CM: "cm", Units.M: "m", Units.FOOT: "ft", Units.MICRON: "um"}
_SIZED = (".dxf", ".svg")
"""Drawings that may lack a unit, or name one that nobody chose; the others have units in their own words."""


def read_plausible(
    name: str, data: bytes, chosen: tuple[Units | None, tuple[str, ...]], how: ReadOptions, diameters: Callable[[Drawing], Iterable[float]],
) -> Drawing:  # fmt: skip
    """Return a drawing of a size that its tools can cut.

    Units that are given are those of a drawing that names none. Where it names some in which its size cannot be meant, they
    hold all the same, for that is what was asked.

    Args:
        name: of the file. data: its bytes.
        chosen: units and layers, as for `read_drawing`. how: what else is said about reading it.
        diameters: gives those of the tools, mm, for the drawing.

    Raises:
        InputError: the drawing cannot be used, or its size cannot be meant and no units are given.
    """
    units, layers = chosen
    drawing = read_drawing(name, data, units, layers, how)
    if PurePath(name).suffix.lower() not in _SIZED:
        return drawing
    doubt = doubt_of(drawing.part, layers, tuple(diameters(drawing)))
    if not doubt or units is drawing.part.units:
        return drawing
    if units is None:
        raise InputError(f"{PurePath(name).name}: {doubt}. {_question(drawing)}")
    return read_drawing(name, data, units, layers, replace(how, overrule=True))


def doubt_of(part: Part, layers: tuple[str, ...], diameters: tuple[float, ...]) -> str:
    """Return why a part's size cannot be meant, or "".

    Args:
        layers: that are machined; empty = all visible ones. diameters: of the tools, mm.
    """
    wanted = {layer.casefold() for layer in layers} or {layer.name.casefold() for layer in part.layers if layer.visible}
    box = union([bounds(entity.curve) for entity in part.entities if entity.layer.casefold() in wanted])
    if box is None or not diameters:
        return ""
    wide, high = box[2] - box[0], box[3] - box[1]
    longest, size = max(wide, high), f"the drawing is {wide:.6g} x {high:.6g} mm"
    if longest > max(_WIDEST * max(diameters), _LEAST_WIDE):
        return f"{size}, and the largest tool {max(diameters):g} mm: {longest / max(diameters):.0f} tools side by side"
    if longest < min(_SMALLEST * min(diameters), _LARGEST_SMALL):
        return f"{size}, and the smallest tool {min(diameters):g} mm: {min(diameters) / max(longest, 1e-9):.0f} times as wide"
    return ""


def _question(drawing: Drawing) -> str:
    word = _UNITS[drawing.part.units]
    others = " or ".join(f"--units {each}" for each in ("mm", "in", "m") if each != word)
    named = f"It names {word} as its units" if drawing.units_named else f"It names no units, and {word} is assumed"
    return f"{named}; say which are meant, {others}, or --units {word} if this is right."
