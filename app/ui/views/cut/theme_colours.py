"""Colours and light of the Cut view made from the theme."""

from __future__ import annotations

from PySide6.QtGui import QColor

from ...framework.theme import Theme
from .cell_colours import Colormap, Rgb8
from .rendering.render_target import RenderStyle, Rgb, Rgba

_DEPTH = ((241, 233, 200), (150, 205, 180), (84, 162, 182), (76, 116, 180), (92, 84, 158))
_ORDER = ((59, 62, 145), (138, 79, 158), (204, 108, 139), (238, 159, 104), (246, 221, 128))


def render_style_of(theme: Theme) -> RenderStyle:
    """Return how the cut is painted by day or by night."""
    dark = theme.name == "dark"
    paths = (theme.rapid, theme.pocket, theme.plunge, theme.contour)
    rapid, pocket, plunge, contour = (_rgba(colour) for colour in paths)
    return RenderStyle(
        canvas=_share(theme.canvas),
        stock=_parts(colormap_of(theme).stock),
        hatch=_share(theme.unreachable),
        paths=(rapid, pocket, plunge, contour),
        strength=(0.36, 0.66, 0.10) if dark else (0.50, 0.56, 0.08),
        tools=tuple(_share(colour) for colour in theme.tools),
        steel=(0.76, 0.78, 0.81) if dark else (0.70, 0.72, 0.75),
        holder=(0.42, 0.45, 0.50) if dark else (0.44, 0.47, 0.52),
        edge=(0.80, 0.83, 0.88) if dark else (0.16, 0.18, 0.21),
        shadow=0.55 if dark else 0.30,
        facets=(_share(theme.regions[4]), contour[:3]),
    )


def colormap_of(theme: Theme) -> Colormap:
    """Return the colours that tell cells apart by day or by night."""
    dark = theme.name == "dark"
    metal = (178, 182, 188) if dark else (204, 207, 211)
    return Colormap(
        metal,
        tuple(_bytes(colour) for colour in theme.tools),
        tuple(_bytes(colour) for colour in theme.regions),
        _DEPTH,
        _ORDER,
        _bytes(theme.gouge),
        metal,
        _bytes(theme.left),
        _bytes(theme.unreachable),
        (92, 97, 105) if dark else (153, 158, 166),
    )


def _bytes(colour: QColor) -> Rgb8:
    return colour.red(), colour.green(), colour.blue()


def _parts(ink: Rgb8) -> Rgb:
    return ink[0] / 255, ink[1] / 255, ink[2] / 255


def _share(colour: QColor) -> Rgb:
    return colour.redF(), colour.greenF(), colour.blueF()


def _rgba(colour: QColor) -> Rgba:
    return (*_share(colour), 1.0)
