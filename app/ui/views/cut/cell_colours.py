"""What the colours of the metal tell: how deep, by which tool, how far from the part, and in which order. No Qt."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from .cut_picture import ColourSpan, CutMoves, CutPicture, Floats, Heights, Numbered
from .relief import Bytes

Rgb8 = tuple[int, int, int]

OUT_OF_REACH, STOCK = 254, 255
"""Values of cells that no tool of the job reaches, and of those that nobody cut."""

STEPS = 254
CYCLE = 72
"""Places for things that are told apart by number: as often as it goes in, a cycle of eight or of nine colours."""

_FINE, _COARSE = 1.0, 10.0
FINE_PLACES = (0.47, 0.53)
"""Between which the scale of deviation shows what is within tolerance."""

_STOP_PLACES = np.array([0.0, 0.24, *FINE_PLACES, 0.76, 1.0])
_LEAST_SPAN = 1e-6


class CutColourBy(Enum):
    """What the colours of the metal tell; the value is its name for people."""

    METAL = "Metal"
    DEPTH = "Depth"
    TOOL = "Tool"
    SURFACE = "Surface"
    DEVIATION = "Deviation"
    MOVE = "Order"


@dataclass(frozen=True, slots=True)
class Colormap:
    """Colours to choose from, 0 to 255.

    Attributes:
        metal: what was cut. tools, surfaces: for things that are told apart by number.
        depth, order: ramps, from the top down and from the first move to the last.
        gouge, right, left, unreachable: too deep, within tolerance, too high, and too high for any tool of the job.
        stock: what was not cut.
    """

    metal: Rgb8
    tools: tuple[Rgb8, ...]
    surfaces: tuple[Rgb8, ...]
    depth: tuple[Rgb8, ...]
    order: tuple[Rgb8, ...]
    gouge: Rgb8
    right: Rgb8
    left: Rgb8
    unreachable: Rgb8
    stock: Rgb8


@dataclass(frozen=True, slots=True)
class ScaleTick:
    """A mark on the scale of a legend: where, 0 at the lower end and 1 at the upper one, and what it says."""

    at: float
    text: str
    remark: str = ""


@dataclass(frozen=True, eq=False)
class ColourKey:
    """What colours mean.

    Attributes:
        palette: (256, 4) uint8; the last two are out of reach and stock.
        ticks: of a scale, lower end first; none where the colours are told apart by name.
        names: colour and name of what is told apart.
    """

    palette: Bytes
    ticks: tuple[ScaleTick, ...] = ()
    names: tuple[tuple[Rgb8, str], ...] = ()


@dataclass(frozen=True, eq=False)
class CellColours:
    """The colour of every cell, (rows, columns) place in the palette, and what it means."""

    values: Bytes
    key: ColourKey


def possible(picture: CutPicture) -> tuple[CutColourBy, ...]:
    """Return what the colours of a picture can tell."""
    has = {
        CutColourBy.TOOL: picture.moves is not None and picture.move is not None,
        CutColourBy.DEVIATION: picture.deviation is not None,
        CutColourBy.MOVE: picture.move is not None,
    }
    has[CutColourBy.SURFACE] = has[CutColourBy.TOOL] and picture.moves is not None and len(picture.moves.surface) > 0
    return tuple(colour for colour in CutColourBy if has.get(colour, True))


def colour_text(picture: CutPicture, colour: CutColourBy) -> CutColourBy:
    """Return what the colours tell: METAL where what is asked for is not known."""
    return colour if colour in possible(picture) else CutColourBy.METAL


def values_of(picture: CutPicture, colour: CutColourBy, span: ColourSpan) -> Bytes:
    """Return (rows, columns) the place of every cell in the palette, the same by day and by night.

    It takes a while for many cells; the picture keeps it.

    Args:
        picture: the cells. colour: what is told, one of those that are possible.
        span: of the whole cut.
    """
    makers: dict[CutColourBy, Callable[[CutPicture, ColourSpan], Bytes]] = {
        CutColourBy.DEPTH: _depth_values,
        CutColourBy.DEVIATION: _deviation_values,
        CutColourBy.MOVE: _move_values,
        CutColourBy.TOOL: lambda picture, _: _numbered_values(
            picture, picture.moves.tools if picture.moves is not None else None
        ),
        CutColourBy.SURFACE: lambda picture, _: _numbered_values(
            picture, picture.moves.surfaces if picture.moves is not None else None
        ),
    }
    if colour not in picture.values:
        picture.values[colour] = makers.get(colour, _plain_values)(picture, span)
    return picture.values[colour]


def key_of(picture: CutPicture, colour: CutColourBy, inks: Colormap, span: ColourSpan) -> ColourKey:
    """Return what the colours mean."""
    moves = picture.moves
    makers: dict[CutColourBy, Callable[[], ColourKey]] = {
        CutColourBy.DEPTH: lambda: _depth_key(picture.top, inks, span),
        CutColourBy.DEVIATION: lambda: _deviation_key(picture.tolerance, inks, span),
        CutColourBy.MOVE: lambda: _move_key(moves.line if moves is not None else None, inks, span),
        CutColourBy.TOOL: lambda: _numbered_key(
            moves.tools[0] if moves is not None else None, "T{}", inks, _tool_cycle(moves, inks.tools)
        ),
        CutColourBy.SURFACE: lambda: _numbered_key(
            moves.surfaces[0] if moves is not None else None, "Surface {}", inks, inks.surfaces
        ),
    }
    return makers.get(colour, lambda: _plain_key(inks))()


def cell_colours(
    picture: CutPicture, colour: CutColourBy, inks: Colormap, span: ColourSpan | None = None
) -> CellColours:
    """Return the colours of a picture; those of the metal where what is asked for is not known."""
    colour, span = colour_text(picture, colour), span or picture.span
    return CellColours(values_of(picture, colour, span), key_of(picture, colour, inks, span))


def ramp(colours: tuple[Rgb8, ...], places: Floats | None = None) -> Floats:
    """Return 254 steps through colours, (254, 3).

    Args:
        colours: at least two.
        places: of each, from 0 to 1; None = evenly.
    """
    at = np.linspace(0.0, 1.0, len(colours)) if places is None else places
    steps = np.linspace(0.0, 1.0, STEPS)
    return np.column_stack([np.interp(steps, at, [colour[band] for colour in colours]) for band in range(3)])


def _palette(colours: Floats, inks: Colormap) -> NDArray[np.uint8]:
    """Return a palette that begins with colours, (k, 3)."""
    made = np.full((256, 4), 255.0)
    made[: len(colours), :3] = colours
    made[OUT_OF_REACH, :3], made[STOCK, :3] = _mixed(inks.stock, inks.unreachable, 0.45), inks.stock
    return np.round(made).astype(np.uint8)


def _places(shares: Heights) -> NDArray[np.uint8]:
    """Return the places in a ramp of shares, clipped to 0 to 1."""
    return (np.clip(shares, 0.0, 1.0) * np.float32(STEPS - 1) + np.float32(0.5)).astype(np.uint8)


def _plain_values(picture: CutPicture, span: ColourSpan) -> Bytes:
    return np.where(picture.uncut(), np.uint8(STOCK), np.uint8(0))


def _plain_key(inks: Colormap) -> ColourKey:
    return ColourKey(_palette(np.array([inks.metal], float), inks), names=((inks.metal, "Cut"), (inks.stock, "Stock")))


def _depth_values(picture: CutPicture, span: ColourSpan) -> Bytes:
    shares = (picture.heights - np.float32(span.lowest)) / np.float32(max(picture.top - span.lowest, _LEAST_SPAN))
    return np.where(picture.uncut(), np.uint8(STOCK), _places(shares))


def _depth_key(top: float, inks: Colormap, span: ColourSpan) -> ColourKey:
    height = max(top - span.lowest, _LEAST_SPAN)
    ticks = tuple(ScaleTick(float(at), f"{span.lowest + at * height:.3f}") for at in np.linspace(0.0, 1.0, 5))
    return ColourKey(_palette(ramp(inks.depth[::-1]), inks), ticks)


def _numbered_values(picture: CutPicture, numbers: Numbered | None) -> Bytes:
    """Return one colour for each number that the moves have."""
    if numbers is None or picture.move is None:
        return np.full(picture.heights.shape, STOCK, np.uint8)
    lookup = np.append(numbers[1] % CYCLE, STOCK).astype(np.uint8)
    return np.asarray(lookup[picture.move])


def _numbered_key(known: NDArray[np.int32] | None, name: str, inks: Colormap, cycle: tuple[Rgb8, ...]) -> ColourKey:
    numbers = known.tolist() if known is not None else []
    names = tuple((cycle[k % CYCLE % len(cycle)], name.format(number)) for k, number in enumerate(numbers))
    return ColourKey(_palette(np.array([cycle[k % len(cycle)] for k in range(CYCLE)], float), inks), names=names)


def _tool_cycle(moves: CutMoves | None, cycle: tuple[Rgb8, ...]) -> tuple[Rgb8, ...]:
    """Return the colours of the tools in the order of their first move, and the cycle where there are none."""
    if moves is None or not len(moves.tools[0]):
        return cycle
    return tuple(cycle[moves.ink_of(number) % len(cycle)] for number in moves.tools[0].tolist())


def _move_values(picture: CutPicture, span: ColourSpan) -> Bytes:
    move = picture.move if picture.move is not None else np.full(picture.heights.shape, -1, np.int32)
    return np.where(move < 0, np.uint8(STOCK), _places(move.astype(np.float32) / np.float32(span.last)))


def _move_key(lines: NDArray[np.int32] | None, inks: Colormap, span: ColourSpan) -> ColourKey:
    marks = [(at, round(at * span.last)) for at in (0.0, 0.25, 0.5, 0.75, 1.0)]
    ticks = tuple(
        ScaleTick(at, f"line {lines[min(k, len(lines) - 1)]}" if lines is not None and len(lines) else str(k))
        for at, k in marks
    )
    return ColourKey(_palette(ramp(inks.order), inks), ticks)


def _deviation_values(picture: CutPicture, span: ColourSpan) -> Bytes:
    """Return places on a scale that is fine round 0."""
    deviation = picture.deviation if picture.deviation is not None else np.zeros_like(picture.heights)
    fine = picture.tolerance * _FINE
    values = _places(np.interp(deviation, _stops(picture.tolerance, span), _STOP_PLACES).astype(np.float32))
    values[picture.uncut() & (np.abs(deviation) <= fine)] = STOCK
    if picture.unreachable is not None:
        values[picture.unreachable & (deviation > fine)] = OUT_OF_REACH
    return values


def _stops(tolerance: float, span: ColourSpan) -> Floats:
    """Return the deviations at which the scale bends: a tolerance, ten of them, and the worst each take a part of it,
    mm.
    """
    fine, coarse = tolerance * _FINE, tolerance * _COARSE
    worst = max(span.worst, 2 * coarse)
    return np.array([-worst, -coarse, -fine, fine, coarse, worst])


def _deviation_key(tolerance: float, inks: Colormap, span: ColourSpan) -> ColourKey:
    pale = [_mixed(inks.right, ink, 0.35) for ink in (inks.gouge, inks.left)]
    colours = (
        inks.gouge,
        _mixed(inks.right, inks.gouge, 0.7),
        pale[0],
        inks.right,
        inks.right,
        pale[1],
        _mixed(inks.right, inks.left, 0.7),
        inks.left,
    )
    steps = ramp(colours, np.array([0.0, 0.24, 0.4695, 0.47, 0.53, 0.5305, 0.76, 1.0]))
    remarks = ("gouge", "", "", "", "left")
    worst, coarse = _stops(tolerance, span)[[5, 4]].tolist()
    texts = (-worst, -coarse, 0.0, coarse, worst)
    ticks = tuple(
        ScaleTick(at, f"{value:+.3f}" if value else "0.000", f"± {tolerance:.3f}" if not value else remark)
        for at, value, remark in zip((0.0, 0.24, 0.5, 0.76, 1.0), texts, remarks, strict=True)
    )
    return ColourKey(_palette(steps, inks), ticks)


def _mixed(a: Rgb8, b: Rgb8, share: float) -> Rgb8:
    red, green, blue = (round(x + (y - x) * share) for x, y in zip(a, b, strict=True))
    return red, green, blue


def prepare(picture: CutPicture, colour: CutColourBy, span: ColourSpan | None = None) -> None:
    """Work out what showing a picture takes, on the thread of whoever made it.

    Args:
        picture: what is to be shown. colour: what its colours tell at first.
        span: of the whole cut, where the picture is a part of it.
    """
    _ = picture.relief, picture.lowest, picture.highest
    values_of(picture, colour_text(picture, colour), span or picture.span)
