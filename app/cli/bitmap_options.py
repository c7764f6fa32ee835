"""The options of the bitmap way, which `make` and `stages` share: how fine the bitmap is, how a picture is read."""

from __future__ import annotations

import argparse
from typing import Any

from ..core.errors import InputError
from ..raster.frame import POINTS
from ..raster.picture_options import InkMeaning, PictureOptions
from ..usecases.pixels.options import BitmapOptions, BitmapSize, is_picture
from .command import number


def add_bitmap_options(group: argparse._ArgumentGroup, bitmap_help: str) -> None:
    """Add the options to a group.

    Args:
        bitmap_help: what --bitmap does for this command.
    """
    group.add_argument("--bitmap", metavar="N", type=_whole("bitmap", 1), help=bitmap_help)
    group.add_argument(
        "--pitch",
        metavar="MM",
        type=number("pitch"),
        help="size of a pixel; the bitmap of a drawing is then as large as it must be",
    )
    group.add_argument(
        "--dpi",
        metavar="N",
        type=number("resolution", unit="dpi"),
        help="of a picture: pixels an inch, instead of --pitch",
    )
    group.add_argument(
        "--threshold",
        metavar="N",
        type=_whole("threshold", 1),
        help="of a picture: what is darker is ink, 1 to 255 (default: Otsu's)",
    )
    group.add_argument("--invert", action="store_true", help="of a picture: the ink is light on dark")
    group.add_argument(
        "--despeckle",
        metavar="N",
        type=_whole("despeckle", 0),
        help="of a picture: spots of up to this many pixels are no ink (default 4)",
    )
    group.add_argument(
        "--ink",
        choices=[each.value for each in InkMeaning],
        help="of a picture: its ink is lines round what is machined, or the areas themselves (default: by how thin it "
        "is)",
    )


def _whole(what: str, least: int) -> type[int]:
    """Return a reader of whole numbers from `least` on, for argparse."""

    def read(text: str) -> int:
        try:
            value = int(text)
        except ValueError as error:
            raise argparse.ArgumentTypeError(
                f"is wrong: '{text}' is no whole number; write the {what} as one"
            ) from error
        if value < least:
            raise argparse.ArgumentTypeError(f"is {value}; the {what} must be {least} or more")
        return value

    return read  # type: ignore[return-value]  # argparse wants a callable, and names types


def _or(value: Any, default: Any) -> Any:
    """Return what was given, which may be 0, else the default."""
    return default if value is None else value


def requested_bitmap(arguments: argparse.Namespace) -> BitmapOptions | None:
    """Return how to compute on pixels where that was asked for, or the file is a picture; None = exactly.

    Raises:
        HitofudeError: as `bitmap_options`.
    """
    options = bitmap_options(arguments)
    requested = arguments.bitmap is not None or arguments.pitch is not None or is_picture(arguments.drawing.name)
    return options if requested else None


def bitmap_options(arguments: argparse.Namespace) -> BitmapOptions:
    """Return what was asked for.

    Raises:
        InputError: an option does not go with the kind of file.
        ParameterError: a value is out of its range.
    """
    picture = is_picture(arguments.drawing.name)
    if picture and arguments.bitmap is not None:
        raise InputError(
            "--bitmap: a picture has its own pixels; leave the option away, and give their size by --pitch or --dpi"
        )
    for name in ("dpi", "threshold", "invert", "despeckle", "ink"):
        requested = getattr(arguments, name)
        if not picture and requested is not None and requested is not False:
            raise InputError(f"--{name}: {arguments.drawing.name} is no picture; leave the option away")
    size = BitmapSize(arguments.bitmap or (16 if arguments.pitch else POINTS), None if picture else arguments.pitch)
    read = PictureOptions(
        arguments.threshold,
        arguments.invert,
        _or(arguments.despeckle, PictureOptions().despeckle),
        arguments.pitch,
        arguments.dpi,
        InkMeaning(_or(arguments.ink, InkMeaning.AUTO)),
    )
    return BitmapOptions(size, read)
