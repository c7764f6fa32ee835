"""Who wrote an SVG, and so how many user units an inch of it has: CSS has 96, some editors had others before."""

from __future__ import annotations

import re
from dataclasses import dataclass

from .xml import INKSCAPE, SODIPODI, Node

CSS_PER_INCH = 96.0
"""User units to the inch, as CSS has them."""
_OLD_INKSCAPE = 90.0
"""User units to the inch before Inkscape 0.92."""
_ILLUSTRATOR = 72.0
"""User units to the inch of Illustrator: points."""
KNOWN_PER_INCH = (CSS_PER_INCH, _OLD_INKSCAPE, _ILLUSTRATOR)
"""What is or was usual."""
_VERSION = re.compile(r"\s*(\d+)\.(\d+)")


@dataclass(frozen=True, slots=True)
class PixelDensity:
    """User units to the inch, and by whom: the editor's name, "" for what CSS says."""

    per_inch: float = CSS_PER_INCH
    editor: str = ""

    @property
    def pixel(self) -> float:
        """Size of a user unit, mm."""
        return 25.4 / self.per_inch


def density_of(root: Node) -> PixelDensity:
    """Return the density that the editor that wrote a file had.

    Args:
        root: with the comments before it.

    References:
        Inkscape 0.92 release notes (2017): 90 dpi became 96, as CSS has it. Adobe Illustrator writes points, 72 an
            inch.
    """
    if "Adobe Illustrator" in root.comments:
        return PixelDensity(_ILLUSTRATOR, "Adobe Illustrator")
    version = root.attributes.get(f"{INKSCAPE} version")
    found = _VERSION.match(version or "")
    if found and (int(found[1]), int(found[2])) < (0, 92):
        return PixelDensity(_OLD_INKSCAPE, f"Inkscape {found[1]}.{found[2]}")
    if version is None and f"{SODIPODI} version" in root.attributes:
        return PixelDensity(_OLD_INKSCAPE, "Sodipodi")
    return PixelDensity()
