"""What the colours of the metal tell: how deep, by which tool, how far from the part, and in which order. No Qt."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from app.ui.cut.picture import CutPicture, Floats, Heights

Rgb8 = tuple[int, int, int]

OUT_OF_REACH, STOCK = 254, 255
"""Values of cells that no tool of the job reaches, and of those that nobody cut."""

STEPS = 254
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
        gouge, right, left, unreachable: too deep, within tolerance, too high, and too high for any tool of the job.
        stock: what was not cut.
    """

    metal: Rgb8
    cycle: tuple[Rgb8, ...]
    depth: tuple[Rgb8, ...]
    order: tuple[Rgb8, ...]
    gouge: Rgb8
    right: Rgb8
    left: Rgb8
    unreachable: Rgb8
    stock: Rgb8


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
        values: (rows, columns) uint8 place in the palette.
        palette: (256, 4) uint8; the last two are out of reach and stock.
        ticks: of a scale, lower end first; none where the colours are told apart by name.
        names: colour and name of what is told apart.
    """

    values: NDArray[np.uint8]
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


def ramp(colours: tuple[Rgb8, ...], places: Floats | None = None) -> Floats:
    """Return 254 steps through colours, (254, 3).

    Args:
        colours: at least two.
        places: of each, from 0 to 1; None = evenly.
    """
    at = np.linspace(0.0, 1.0, len(colours)) if places is None else places
    steps = np.linspace(0.0, 1.0, STEPS)
    return np.column_stack([np.interp(steps, at, [colour[band] for colour in colours]) for band in range(3)])


def _palette(colours: Floats, inks: Inks) -> NDArray[np.uint8]:
    """Return a palette that begins with colours, (k, 3)."""
    made = np.full((256, 4), 255.0)
    made[: len(colours), :3] = colours
    made[OUT_OF_REACH, :3], made[STOCK, :3] = _mixed(inks.stock, inks.unreachable, 0.45), inks.stock
    return np.round(made).astype(np.uint8)


def _places(shares: Heights) -> NDArray[np.uint8]:
    """Return the places in a ramp of shares, clipped to 0 to 1."""
    return (np.clip(shares, 0.0, 1.0) * np.float32(STEPS - 1) + np.float32(0.5)).astype(np.uint8)


def _plain(picture: CutPicture, inks: Inks) -> Colouring:
    values = np.where(picture.uncut(), np.uint8(STOCK), np.uint8(0))
    return Colouring(values, _palette(np.array([inks.metal], float), inks), names=((inks.metal, "Cut"), (inks.stock, "Stock")))


def _by_depth(picture: CutPicture, inks: Inks) -> Colouring:
    uncut = picture.uncut()
    lowest = float(np.min(picture.heights, where=~uncut, initial=picture.top))
    span = max(picture.top - lowest, 1e-6)
    values = np.where(uncut, np.uint8(STOCK), _places((picture.heights - np.float32(lowest)) / np.float32(span)))
    ticks = tuple(Tick(float(at), f"{lowest + at * span:.3f}") for at in np.linspace(0.0, 1.0, 5))
    return Colouring(values, _palette(ramp(inks.depth[::-1]), inks), ticks)


def _by_tool(picture: CutPicture, inks: Inks) -> Colouring:
    return _by_number(picture, picture.moves.tool if picture.moves is not None else np.zeros(0, np.int32), "T{}", inks)


def _by_surface(picture: CutPicture, inks: Inks) -> Colouring:
    return _by_number(picture, picture.moves.surface if picture.moves is not None else np.zeros(0, np.int32), "Surface {}", inks)


def _by_number(picture: CutPicture, numbers: NDArray[np.int32], name: str, inks: Inks) -> Colouring:
    """Return one colour for each number that the moves have."""
    move = picture.move if picture.move is not None else np.full(picture.heights.shape, -1, np.int32)
    known, place = np.unique(numbers, return_inverse=True)
    count = min(len(inks.cycle), max(len(known), 1))
    lookup = np.append(place % count, STOCK).astype(np.uint8)
    named = tuple((inks.cycle[k % count], name.format(number)) for k, number in enumerate(known.tolist()))
    return Colouring(lookup[move], _palette(np.array(inks.cycle[:count], float), inks), names=named)


def _by_move(picture: CutPicture, inks: Inks) -> Colouring:
    move = picture.move if picture.move is not None else np.full(picture.heights.shape, -1, np.int32)
    last = max(int(move.max()), 1)
    values = np.where(move < 0, np.uint8(STOCK), _places((move / np.float32(last)).astype(np.float32)))
    lines = picture.moves.line if picture.moves is not None else None
    marks = [(at, round(at * last)) for at in (0.0, 0.25, 0.5, 0.75, 1.0)]
    ticks = tuple(Tick(at, f"line {lines[min(k, len(lines) - 1)]}" if lines is not None and len(lines) else str(k)) for at, k in marks)
    return Colouring(values, _palette(ramp(inks.order), inks), ticks)


def _by_deviation(picture: CutPicture, inks: Inks) -> Colouring:
    """Return the colours of a scale that is fine round 0: a tolerance, ten of them, and the worst each take a fifth."""
    deviation = picture.deviation if picture.deviation is not None else np.zeros_like(picture.heights)
    fine, coarse = picture.tolerance * _FINE, picture.tolerance * _COARSE
    worst = max(float(np.nanmax(np.abs(deviation))), 2 * coarse)
    stops = np.array([-worst, -coarse, -fine, fine, coarse, worst])
    places = np.array([0.0, 0.24, 0.47, 0.53, 0.76, 1.0])
    values = _places(np.interp(deviation, stops, places).astype(np.float32))
    values[picture.uncut() & (np.abs(deviation) <= fine)] = STOCK
    if picture.unreachable is not None:
        values[picture.unreachable & (deviation > fine)] = OUT_OF_REACH
    pale = [_mixed(inks.right, ink, 0.35) for ink in (inks.gouge, inks.left)]
    colours = (inks.gouge, _mixed(inks.right, inks.gouge, 0.7), pale[0], inks.right, inks.right, pale[1],
               _mixed(inks.right, inks.left, 0.7), inks.left)
    steps = ramp(colours, np.array([0.0, 0.24, 0.4695, 0.47, 0.53, 0.5305, 0.76, 1.0]))
    remarks = ("gouge", "", "", "", "left")
    texts = (-worst, -coarse, 0.0, coarse, worst)
    ticks = tuple(Tick(at, f"{value:+.3f}" if value else "0.000", f"± {picture.tolerance:.3f}" if not value else remark)
                  for at, value, remark in zip((0.0, 0.24, 0.5, 0.76, 1.0), texts, remarks, strict=True))
    return Colouring(values, _palette(steps, inks), ticks)


def _mixed(a: Rgb8, b: Rgb8, share: float) -> Rgb8:
    red, green, blue = (round(x + (y - x) * share) for x, y in zip(a, b, strict=True))
    return red, green, blue
