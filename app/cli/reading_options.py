"""The options that say how a drawing is read, which all commands that read one share."""

from __future__ import annotations

import argparse

from ..model.read_options import DrawingOptions
from .command import number

NAMES = ("skip_layer", "skip_type", "layout", "to_zero", "px_per_inch")
"""Where argparse keeps them."""


def add_reading_options(group: argparse._ArgumentGroup | argparse.ArgumentParser) -> None:
    """Add the options to a group."""
    group.add_argument(
        "--skip-layer",
        metavar="NAME",
        action="append",
        default=[],
        help="leave out what lies on this layer, such as centre lines; may be repeated",
    )
    group.add_argument(
        "--skip-type",
        metavar="TYPE",
        action="append",
        default=[],
        help="of a DXF: leave out entities of this type, such as TEXT or HATCH; may be repeated",
    )
    group.add_argument(
        "--layout", metavar="NAME", help="of a DXF: read this layout of paper space instead of model space"
    )
    group.add_argument(
        "--to-zero",
        action="store_true",
        help="of a DXF or SVG: move the drawing so that its lower left corner is zero, however far away it lies",
    )
    group.add_argument(
        "--px-per-inch",
        metavar="N",
        type=number("density", unit="px"),
        help="of an SVG without a real size: its units to the inch (default: as the editor had that wrote it, else 96)",
    )


def reading(arguments: argparse.Namespace) -> DrawingOptions:
    """Return what was asked for.

    Raises:
        ParameterError: a value is out of its range.
    """
    return DrawingOptions(
        layout=arguments.layout or "",
        to_zero=arguments.to_zero,
        pixels_per_inch=arguments.px_per_inch,
        without_layers=tuple(arguments.skip_layer),
        without_types=tuple(arguments.skip_type),
    )
