"""What a user may say about how a drawing is to be read, beside its units and layers."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..core.errors import ParameterError
from ..core.options import option

LEAST_PER_INCH, MOST_PER_INCH = 1.0, 1e5
"""Units of the page to the inch: from an inch each to a quarter of a micrometre."""


OPTION_OF = {
    "layout": "layout",
    "to_zero": "to-zero",
    "pixels_per_inch": "px-per-inch",
    "without_layers": "skip-layer",
    "without_types": "skip-type",
}
"""The option of the command line, without its dashes, that asks for a field of `DrawingOptions`."""


@dataclass(frozen=True, slots=True)
class DrawingOptions:
    """How a drawing is to be read; the default leaves everything as the file has it.

    Attributes:
        overrule: units that are given hold although the drawing names others.
        layout: DXF: name of the layout in paper space to read instead of model space; "" = model space.
        to_zero: DXF and SVG: move the drawing so that the lower left corner of what is machined is zero.
        pixels_per_inch: SVG: user units to the inch where the file has no real size, 1 to 100,000; None = as its
            generator has it.
        without_layers: names of layers (in any case) whose curves are left out.
        without_types: DXF: types of entities (in any case), such as TEXT or HATCH, that are left out.
        lenient: layers to leave out that the drawing does not have are passed over.
    """

    overrule: bool = False
    layout: str = ""
    to_zero: bool = False
    pixels_per_inch: float | None = None
    without_layers: tuple[str, ...] = ()
    without_types: tuple[str, ...] = ()
    lenient: bool = False

    def __post_init__(self) -> None:
        given = self.pixels_per_inch
        if given is not None and not (math.isfinite(given) and LEAST_PER_INCH <= given <= MOST_PER_INCH):
            raise ParameterError(f"{option('px-per-inch')} is {given:g}; use {LEAST_PER_INCH:g} to {MOST_PER_INCH:g}.")


AS_DRAWN = DrawingOptions()
