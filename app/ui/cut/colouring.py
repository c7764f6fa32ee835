"""What the colours of the metal tell: how deep, by which tool, how far from the part, and in which order. No Qt."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from app.ui.cut.picture import CutPicture, Floats, Heights

Rgb8 = tuple[int, int, int]

OUT_OF_REACH = 2.0
"""Value of a cell that no tool of the job reaches."""

_STEPS = 256
_FINE, _COARSE = 1.0, 10.0


class CutColour(Enum):
    """What the colours of the metal tell; the value is its name for people."""

    METAL = "Metal"
    DEPTH = "Depth"
    TOOL = "Tool"
    SURFACE = "Surface"
    DEVIATION = "Deviation"
    MOVE = "Order"


@dataclass(frozen=True, slots=True)
class Inks:
    """Colours to choose from, 0 to 255.

    Attributes:
        metal: what was cut. cycle: for things that are told apart by number.
        depth, order: ramps, from the top down and from the first move to the last.
        gouge, right, left: too deep, within tolerance, too high.
    """

    metal: Rgb8
    cycle: tuple[Rgb8, ...]
    depth: tuple[Rgb8, ...]
    order: tuple[Rgb8, ...]
    gouge: Rgb8
    right: Rgb8
    left: Rgb8


@dataclass(frozen=True, slots=True)
class Tick:
    """A mark on the scale of a legend: where, 0 at the lower end and 1 at the upper one, and what it says."""

    at: float
    text: str
    remark: str = ""


@dataclass(frozen=True, eq=False)
class Colouring:
    """The colour of every cell, and what it means.

    Attributes:
        values: (rows, columns) float32 place in the palette, 0 to 1; NaN = stock; 2 = out of reach.
        palette: (k, 4) uint8.
        ticks: of a scale, lower end first; none where the colours are told apart by name.
        names: colour and name of what is told apart.
    """

    values: Heights
    palette: NDArray[np.uint8]
    ticks: tuple[Tick, ...] = ()
    names: tuple[tuple[Rgb8, str], ...] = ()


def possible(picture: CutPicture) -> tuple[CutColour, ...]:
    """Return what the colours of a picture can tell."""
    has = {CutColour.TOOL: picture.moves is not None and picture.move is not None, CutColour.DEVIATION: picture.deviation is not None,
           CutColour.MOVE: picture.move is not None}
    has[CutColour.SURFACE] = has[CutColour.TOOL] and picture.moves is not None and len(picture.moves.surface) > 0
    return tuple(colour for colour in CutColour if has.get(colour, True))


def colouring(picture: CutPicture, colour: CutColour, inks: Inks) -> Colouring:
    """Return the colours of a picture; those of the metal where what is asked for is not known."""
    makers: dict[CutColour, Callable[[CutPicture, Inks], Colouring]] = {
        CutColour.DEPTH: _by_depth, CutColour.TOOL: _by_tool, CutColour.SURFACE: _by_surface,
        CutColour.DEVIATION: _by_deviation, CutColour.MOVE: _by_move,
    }
    return makers.get(colour if colour in possible(picture) else CutColour.METAL, _plain)(picture, inks)


def ramp(colours: tuple[Rgb8, ...], places: Floats | None = None) -> NDArray[np.uint8]:
    """Return a palette of 256 steps through colours.

    Args:
        colours: at least two.
        places: of each, from 0 to 1; None = evenly.
    """
    at = np.linspace(0.0, 1.0, len(colours)) if places is None else places
    steps = np.linspace(0.0, 1.0, _STEPS)
    bands = [np.interp(steps, at, [colour[band] for colour in colours]) for band in range(3)]
    return np.round(np.column_stack([*bands, np.full(_STEPS, 255.0)])).astype(np.uint8)


def _plain(picture: CutPicture, inks: Inks) -> Colouring:
    values = np.where(picture.uncut(), np.float32(np.nan), np.float32(0.5))
    return Colouring(values, np.array([[*inks.metal, 255]], np.uint8), names=((inks.metal, "Cut"),))


def _by_depth(picture: CutPicture, inks: Inks) -> Colouring:
    uncut = picture.uncut()
    lowest = float(picture.heights[~uncut].min()) if not uncut.all() else picture.floor
    span = max(picture.top - lowest, 1e-6)
    values = np.where(uncut, np.float32(np.nan), np.clip((picture.heights - np.float32(lowest)) / np.float32(span), 0.0, 1.0))
    marks = np.linspace(0.0, 1.0, 5)
    ticks = tuple(Tick(float(at), f"{lowest + at * span:.3f}") for at in marks)
    return Colouring(values.astype(np.float32), ramp(inks.depth[::-1]), ticks)


def _by_tool(picture: CutPicture, inks: Inks) -> Colouring:
    return _by_number(picture, picture.moves.tool if picture.moves is not None else np.zeros(0, np.int32), "T{}", inks)


def _by_surface(picture: CutPicture, inks: Inks) -> Colouring:
    return _by_number(picture, picture.moves.surface if picture.moves is not None else np.zeros(0, np.int32), "Surface {}", inks)


def _by_number(picture: CutPicture, numbers: NDArray[np.int32], name: str, inks: Inks) -> Colouring:
    """Return one colour for each number that the moves have."""
    move = picture.move if picture.move is not None else np.full(picture.heights.shape, -1, np.int32)
    known, place = np.unique(numbers, return_inverse=True)
    colours = [inks.cycle[k % len(inks.cycle)] for k in range(len(known))]
    lookup = np.append((place + 0.5) / max(len(known), 1), np.nan).astype(np.float32)
    palette = np.array([[*colour, 255] for colour in colours], np.uint8)
    named = tuple((colour, name.format(number)) for colour, number in zip(colours, known.tolist(), strict=True))
    return Colouring(lookup[np.where(move < 0, len(numbers), move)], palette, names=named)


def _by_move(picture: CutPicture, inks: Inks) -> Colouring:
    move = picture.move if picture.move is not None else np.full(picture.heights.shape, -1, np.int32)
    last = max(int(move.max()), 1)
    values = np.where(move < 0, np.float32(np.nan), (move / np.float32(last)).astype(np.float32))
    lines = picture.moves.line if picture.moves is not None else None
    marks = [(at, round(at * last)) for at in (0.0, 0.25, 0.5, 0.75, 1.0)]
    ticks = tuple(Tick(at, f"line {lines[min(k, len(lines) - 1)]}" if lines is not None and len(lines) else str(k)) for at, k in marks)
    return Colouring(values, ramp(inks.order), ticks)


def _by_deviation(picture: CutPicture, inks: Inks) -> Colouring:
    """Return the colours of a scale that is fine round 0: a tolerance, ten of them, and the worst each take a fifth."""
    deviation = picture.deviation if picture.deviation is not None else np.zeros_like(picture.heights)
    fine, coarse = picture.tolerance * _FINE, picture.tolerance * _COARSE
    worst = max(float(np.nanmax(np.abs(deviation))), 2 * coarse)
    stops = np.array([-worst, -coarse, -fine, fine, coarse, worst])
    places = np.array([0.0, 0.24, 0.47, 0.53, 0.76, 1.0])
    values = np.interp(deviation, stops, places).astype(np.float32)
    if picture.unreachable is not None:
        values[picture.unreachable & (deviation > fine)] = OUT_OF_REACH
    pale = [_mixed(inks.right, ink, 0.35) for ink in (inks.gouge, inks.left)]
    colours = (inks.gouge, _mixed(inks.right, inks.gouge, 0.7), pale[0], inks.right, inks.right, pale[1],
               _mixed(inks.right, inks.left, 0.7), inks.left)
    palette = ramp(colours, np.array([0.0, 0.24, 0.4695, 0.47, 0.53, 0.5305, 0.76, 1.0]))
    remarks = ("gouge", "", "", "", "left")
    texts = (-worst, -coarse, 0.0, coarse, worst)
    ticks = tuple(Tick(at, f"{value:+.3f}" if value else "0.000", f"± {picture.tolerance:.3f}" if not value else remark)
                  for at, value, remark in zip((0.0, 0.24, 0.5, 0.76, 1.0), texts, remarks, strict=True))
    return Colouring(values, palette, ticks)


def _mixed(a: Rgb8, b: Rgb8, share: float) -> Rgb8:
    red, green, blue = (round(x + (y - x) * share) for x, y in zip(a, b, strict=True))
    return red, green, blue
