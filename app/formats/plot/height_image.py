"""A field of heights as a picture from above, PNG: lit from the north-west, coloured by depth, gouges red, metal left
blue.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

Pixels = NDArray[np.uint8]
Shades = NDArray[np.float32]
Rgb = tuple[int, int, int]

SIDE = 1024
"""Pixels of the longer side, about; cells of a coarse field are drawn as squares of pixels."""

MARGIN, LEGEND, ROW = 24, 200, 24
"""Pixels round the picture, of the legend, and of a line of it."""
PAPER, INK, MUTED = (250, 250, 248), (30, 34, 39), (92, 98, 106)
"""Colours of the sheet, red, green and blue."""
GOUGE, LEFT, UNREACHABLE, NOTHING = (211, 47, 47), (41, 121, 255), (176, 168, 200), (58, 62, 68)
"""Colours of what is wrong, and of where no metal is."""
RAMP = ((236, 231, 214), (190, 205, 182), (132, 170, 160), (92, 128, 134), (70, 88, 108))
"""Colours of the metal from its top down."""

STEEP = 0.2
"""Slope at which a flank has half of the light or shadow that a wall has; cusps are far flatter than flanks."""

SHADOW, LIGHT, CORNER = 0.55, 0.35, 0.35
"""How much darker, lighter, and darker in corners, metal can be."""

_SEEN = 3
"""Pixels that what is wrong is at least wide, so that it is seen."""

_HATCH = 7
"""Pixels from stroke to stroke of what is out of reach."""

_FLOOR = 1e-4
"""mm over the floor up to which a mean of cells without metal can lie by rounding."""


@dataclass(frozen=True, eq=False)
class HeightImage:
    """What is drawn.

    Attributes:
        heights: (rows, cols) float32 mm, row 0 at the lowest Y.
        pitch: side of a cell, mm.
        top, floor: of the stock, mm; a cell at the floor has no metal.
        title: of the picture.
        deviation: (rows, cols) mm over the part; None = not compared.
        unreachable: (rows, cols) metal left that no tool reaches; None = not known.
        tolerance: within which metal is right, mm.
    """

    heights: NDArray[np.float32]
    pitch: float
    top: float
    floor: float
    title: str = ""
    deviation: NDArray[np.float32] | None = None
    unreachable: NDArray[np.bool_] | None = None
    tolerance: float = 0.0


def height_image(image: HeightImage) -> bytes:
    """Return the picture as PNG bytes: north up, about SIDE pixels along the longer side, and a legend right of it."""
    zoom = SIDE / max(image.heights.shape)
    size = _size(image.heights.shape, min(zoom, 1.0))
    heights = np.asarray(cv2.resize(image.heights, size, interpolation=cv2.INTER_AREA), np.float32)
    pitch = image.pitch * image.heights.shape[1] / size[0]
    colours = _lit(_colours(heights, image), heights, pitch)
    times = max(1, int(zoom))
    if times > 1:
        colours = np.asarray(cv2.resize(colours, (size[0] * times, size[1] * times), interpolation=cv2.INTER_NEAREST))
    colours, marks = _marked(colours, image)
    sheet = _sheet(np.flipud(colours))
    _legend(sheet, image, marks, pitch / times)
    return bytes(cv2.imencode(".png", sheet[..., ::-1], [cv2.IMWRITE_PNG_COMPRESSION, 3])[1].tobytes())


def _size(shape: tuple[int, ...], zoom: float) -> tuple[int, int]:
    """Return width and height, pixels."""
    return max(1, round(shape[1] * zoom)), max(1, round(shape[0] * zoom))


def _colours(heights: Shades, image: HeightImage) -> Pixels:
    """Return (rows, cols, 3) the colour of each depth."""
    depth = max(image.top - _deepest(image), 1e-9)
    place = np.clip((image.top - heights) * np.float32(255.0 / depth), 0, 255).astype(np.uint8)
    table = np.stack(
        [np.interp(np.linspace(0, len(RAMP) - 1, 256), range(len(RAMP)), [c[k] for c in RAMP]) for k in range(3)],
        axis=1,
    )
    colours = np.asarray(cv2.LUT(cv2.merge([place] * 3), table.round().astype(np.uint8)[None]), np.uint8)
    colours[heights <= np.float32(image.floor + _FLOOR)] = NOTHING
    return colours


def _deepest(image: HeightImage) -> float:
    """Return the lowest metal, mm; where there is none, the floor."""
    return max(float(image.heights.min()), image.floor)


def _lit(colours: Pixels, heights: Shades, pitch: float) -> Pixels:
    """Return the colours in light from the north-west, corners darker; flat metal keeps its colour."""
    scale = 1.0 / (8.0 * pitch * STEEP * math.sqrt(2.0))
    east = cv2.Sobel(heights, cv2.CV_32F, 1, 0, ksize=3, scale=scale, borderType=cv2.BORDER_REPLICATE)
    north = cv2.Sobel(heights, cv2.CV_32F, 0, 1, ksize=3, scale=scale, borderType=cv2.BORDER_REPLICATE)
    slope = east - north
    shade = slope / (1.0 + np.abs(slope))
    wide = max(3, min(heights.shape) // 40) | 1
    hollow = (cv2.blur(heights, (wide, wide), borderType=cv2.BORDER_REPLICATE) - heights) / np.float32(wide * pitch)
    dark = np.where(shade < 0, 1.0 + np.float32(SHADOW) * shade, 1.0) * (
        1.0 - np.float32(CORNER) * np.clip(hollow * 3, 0, 1)
    )
    light = np.float32(255.0 * LIGHT) * np.maximum(shade, 0)
    return np.asarray(np.clip(colours * dark[..., None] + light[..., None], 0, 255), np.uint8)


class _LegendMark(NamedTuple):
    """What a colour of the picture means."""

    name: str
    colour: Rgb


class _MarkedPixels(NamedTuple):
    """The picture with what is wrong put in, and what its colours mean."""

    colours: Pixels
    marks: list[_LegendMark]


def _marked(colours: Pixels, image: HeightImage) -> _MarkedPixels:
    """Return the colours with what is wrong put in, and names and colours of what there is of it."""
    if image.deviation is None:
        return _MarkedPixels(colours, [])
    size, marks = (colours.shape[1], colours.shape[0]), list[_LegendMark]()
    high = image.deviation > image.tolerance
    beyond = np.zeros_like(high) if image.unreachable is None else image.unreachable
    for name, colour, mask in (
        ("out of reach", UNREACHABLE, beyond),
        ("left", LEFT, high & ~beyond),
        ("gouge", GOUGE, image.deviation < -image.tolerance),
    ):
        if not mask.any():
            continue
        marks.append(_LegendMark(name, colour))
        _paint(colours, _seen(mask, size), colour, hatched=name == "out of reach")
    return _MarkedPixels(colours, marks[::-1])


def _seen(mask: NDArray[np.bool_], size: tuple[int, int]) -> NDArray[np.bool_]:
    """Return a mask of the picture's size in which nothing is lost, however small."""
    whole = (
        cv2.resize(
            mask.astype(np.float32),
            size,
            interpolation=cv2.INTER_AREA if size[0] < mask.shape[1] else cv2.INTER_NEAREST,
        )
        > 0
    )
    if size[0] > _SEEN * mask.shape[1]:
        return np.asarray(whole, bool)
    return np.asarray(cv2.dilate(whole.astype(np.uint8), np.ones((_SEEN, _SEEN), np.uint8)), bool)


def _paint(colours: Pixels, mask: NDArray[np.bool_], colour: Rgb, hatched: bool) -> None:
    """Put a colour over the metal, its light and shadow shining through; hatched in stripes from lower left to upper
    right.
    """
    if hatched:
        rows, cols = np.ogrid[: mask.shape[0], : mask.shape[1]]
        mask = mask & ((rows - cols) % _HATCH < _HATCH - 2)
    light = colours[mask].mean(axis=1, keepdims=True) / 160.0
    colours[mask] = np.clip(np.array(colour) * np.clip(light, 0.55, 1.15), 0, 255).astype(np.uint8)


def _sheet(metal: Pixels) -> Pixels:
    """Return the paper with the metal on it."""
    rows, cols = metal.shape[:2]
    sheet = np.full((max(rows, 11 * ROW) + 2 * MARGIN + ROW, cols + 3 * MARGIN + LEGEND, 3), PAPER, np.uint8)
    sheet[MARGIN : MARGIN + rows, MARGIN : MARGIN + cols] = metal
    cv2.rectangle(sheet, (MARGIN - 1, MARGIN - 1), (MARGIN + cols, MARGIN + rows), MUTED, 1)
    return sheet


def _legend(sheet: Pixels, image: HeightImage, marks: list[_LegendMark], pixel: float) -> None:
    """Draw title, depths, marks and the scale; `pixel` is the side of a pixel, mm."""
    x, y = sheet.shape[1] - MARGIN - LEGEND, MARGIN + 12
    _text(sheet, image.title[:26], (x, y), INK)
    y += ROW
    for k in range(5):
        depth = k / 4 * (_deepest(image) - image.top)
        _swatch(sheet, (x, y + k * ROW), RAMP[k], f"Z {image.top + depth:.3f} mm")
    y += 5 * ROW
    if image.heights.min() <= image.floor:
        marks = [_LegendMark("no metal", NOTHING), *marks]
    for k, (name, colour) in enumerate(marks):
        _swatch(sheet, (x, y + k * ROW), colour, name)
    if image.deviation is not None and not any(name in ("gouge", "left") for name, _ in marks):
        _text(sheet, f"within {image.tolerance:g} mm of the part", (x, y + len(marks) * ROW), MUTED)
    _scale(sheet, pixel)


def _swatch(sheet: Pixels, at: tuple[int, int], colour: Rgb, text: str) -> None:
    x, y = at
    cv2.rectangle(sheet, (x, y - 12), (x + 24, y + 4), colour, -1)
    _text(sheet, text, (x + 34, y), MUTED)


def _scale(sheet: Pixels, pixel: float) -> None:
    """Draw a bar of a round length below the metal."""
    most = 160 * pixel
    decade = 10.0 ** math.floor(math.log10(most))
    length = max(step * decade for step in (1.0, 2.0, 5.0) if step * decade <= most)
    y, end = sheet.shape[0] - MARGIN + 2, MARGIN + round(length / pixel)
    cv2.line(sheet, (MARGIN, y), (end, y), INK, 2)
    _text(sheet, f"{length:g} mm", (end + 10, y + 5), MUTED)


def _text(sheet: Pixels, text: str, at: tuple[int, int], colour: Rgb) -> None:
    shown = text.encode("ascii", "replace").decode()
    cv2.putText(sheet, shown, at, cv2.FONT_HERSHEY_SIMPLEX, 0.45, colour, 1, cv2.LINE_AA)
