"""Colours and type of the window, by day and by night. Path colours are Okabe-Ito, safe for colour-blind eyes."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from functools import cache, cached_property
from typing import Any

from PySide6.QtGui import QColor, QFont, QFontDatabase, QFontInfo

TEXT_PX = 13
HEADING_PX = 15

_WIDE_FALLBACK = "DejaVu Sans"
_QUIETER = ("Inter", "Noto Sans", "Liberation Sans")
"""Before the fallback, where they are installed: narrower, so that panels and tables have fewer words cut off."""


@dataclass(frozen=True)
class Theme:
    """Every colour that the window paints with.

    Attributes:
        paper, canvas: grounds of panels and of the drawing.
        raised: ground of fields that can be typed in; hover: ground under the mouse; chosen: of the selected row.
        ink, muted: text; both reach a contrast of 4.5 on paper, canvas and raised.
        hairline, grid, grid_major: separators and raster.
        accent: the bitmap's phosphor green; accent_ink: text on it; accent_text: green that can be read on paper.
        selection: the accent as a line: selected, or being drawn; a contrast of 3 on the canvas.
        pocket … unreachable: tool paths and findings; region_fill: the area to machine.
        error, warning, ok: verdicts, readable as text on paper. parameter: parameters and O words of NC text, splines.
        regions: cycle of eight for colouring by region; none is taken for plunge, contour, gouge or left material.
    """

    name: str
    paper: QColor
    canvas: QColor
    raised: QColor
    hover: QColor
    chosen: QColor
    ink: QColor
    muted: QColor
    hairline: QColor
    grid: QColor
    grid_major: QColor
    accent: QColor
    accent_ink: QColor
    accent_text: QColor
    selection: QColor
    pocket: QColor
    contour: QColor
    rest: QColor
    rapid: QColor
    plunge: QColor
    gouge: QColor
    left: QColor
    unreachable: QColor
    region_fill: QColor
    error: QColor
    warning: QColor
    ok: QColor
    parameter: QColor
    regions: tuple[QColor, ...]

    @cached_property
    def tools(self) -> tuple[QColor, ...]:
        """The cycle of nine for a program's tools, in their order, the same in every view; the first three are those of
        the Paths view.
        """
        three = (self.pocket, self.contour, self.rest)
        return (*three, *(colour for colour in self.regions if colour not in three))

    def faint(self, part: float) -> Theme:
        """Return the theme with `part` of each colour left, and the canvas for the rest: lines that lie over one
        another stay faint.
        """
        faded: dict[str, Any] = {
            f.name: mixed(self.canvas, getattr(self, f.name), part)
            for f in fields(self)
            if isinstance(getattr(self, f.name), QColor)
        }
        return replace(self, regions=tuple(mixed(self.canvas, colour, part) for colour in self.regions), **faded)

    def hex_colours(self) -> dict[str, str]:
        """Return every single colour as "#rrggbb" by its name, for style sheets and icons."""
        values = ((f.name, getattr(self, f.name)) for f in fields(self))
        return {name: value.name() for name, value in values if isinstance(value, QColor)}


def _regions(*names: str) -> tuple[QColor, ...]:
    return tuple(QColor(name) for name in names)


LIGHT = Theme(
    name="light",
    paper=QColor("#FAFAF8"),
    canvas=QColor("#FFFFFF"),
    raised=QColor("#FFFFFF"),
    hover=QColor("#EFF0ED"),
    chosen=QColor("#DDF6E8"),
    ink=QColor("#1E2227"),
    muted=QColor("#5F6670"),
    hairline=QColor("#DCDEDA"),
    grid=QColor("#F1F2F0"),
    grid_major=QColor("#E6E8E5"),
    accent=QColor("#2BD47D"),
    accent_ink=QColor("#08301B"),
    accent_text=QColor("#0B7A43"),
    selection=QColor("#10A45E"),
    pocket=QColor("#009E73"),
    contour=QColor("#E69F00"),
    rest=QColor("#CC79A7"),
    rapid=QColor("#8A8F98"),
    plunge=QColor("#D55E00"),
    gouge=QColor("#D32F2F"),
    left=QColor("#2979FF"),
    unreachable=QColor("#B0A8C8"),
    region_fill=QColor("#F3F5F2"),
    error=QColor("#C62828"),
    warning=QColor("#8A5A00"),
    ok=QColor("#0B7A43"),
    parameter=QColor("#6A4BB5"),
    regions=_regions("#009E73", "#CC79A7", "#7A6BC2", "#7F8C2A", "#56B4E9", "#882255", "#8A6A4A", "#3B4F9E"),
)

DARK = Theme(
    name="dark",
    paper=QColor("#16191D"),
    canvas=QColor("#101317"),
    raised=QColor("#1E2228"),
    hover=QColor("#23282E"),
    chosen=QColor("#15382A"),
    ink=QColor("#D8DCE2"),
    muted=QColor("#949BA5"),
    hairline=QColor("#2A2F36"),
    grid=QColor("#171B20"),
    grid_major=QColor("#20252B"),
    accent=QColor("#2BD47D"),
    accent_ink=QColor("#06251A"),
    accent_text=QColor("#3FDD8C"),
    selection=QColor("#2BD47D"),
    pocket=QColor("#1DB98C"),
    contour=QColor("#F0AE2B"),
    rest=QColor("#DB92B9"),
    rapid=QColor("#7C828C"),
    plunge=QColor("#EE7A2B"),
    gouge=QColor("#F0524F"),
    left=QColor("#4C8DFF"),
    unreachable=QColor("#8F86AC"),
    region_fill=QColor("#171B20"),
    error=QColor("#FF7B74"),
    warning=QColor("#F0AE2B"),
    ok=QColor("#3FDD8C"),
    parameter=QColor("#B5A4F0"),
    regions=_regions("#1DB98C", "#DB92B9", "#9C8EE0", "#A7B44A", "#7CC7F2", "#C4568F", "#B8926A", "#7484D8"),
)


def mixed(a: QColor, b: QColor, part: float) -> QColor:
    """Return `part` of b in a."""
    values = (round(x + (y - x) * part) for x, y in ((a.red(), b.red()), (a.green(), b.green()), (a.blue(), b.blue())))
    return QColor(*values)


def text_font(pixels: int = TEXT_PX, semibold: bool = False) -> QFont:
    """Return the system's font with tabular figures, so that numbers line up.

    A system that has chosen none answers with its fallback, which is wide and loud; a quieter one stands in its place.

    Args:
        pixels: height, 13 for text and 15 for headings.
        semibold: True for headings.
    """
    return _sized(QFont(_system_font()), pixels, semibold)


@cache
def _system_font() -> QFont:
    """Return the font of the desktop, or what stands in for it where the desktop has none."""
    font = QFontDatabase.systemFont(QFontDatabase.SystemFont.GeneralFont)
    found = QFontInfo(font).family()
    if found == _WIDE_FALLBACK:
        font.setFamilies([*_QUIETER, found])
    return font


def mono_font(pixels: int = TEXT_PX) -> QFont:
    """Return the system's fixed-pitch font, for commands and NC text."""
    return _sized(QFontDatabase.systemFont(QFontDatabase.SystemFont.FixedFont), pixels, False)


def _sized(font: QFont, pixels: int, semibold: bool) -> QFont:
    font.setPixelSize(pixels)
    font.setWeight(QFont.Weight.DemiBold if semibold else QFont.Weight.Normal)
    if hasattr(font, "setFeature"):
        font.setFeature(QFont.Tag("tnum"), 1)
    return font
