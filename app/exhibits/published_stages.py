"""Steps 301 and 401 to 407 by the text's own rules, as stages, each with what it comes to beside the settled rule."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from ..core.wording import counted
from ..fitting.corner_smoothing.published import PublishedPiece, PublishedSmoothing, average_angles, published_smoothing
from ..fitting.corner_smoothing.smoothed_path import PieceKind
from ..geometry.primitives import Rows
from ..model.job import Job
from ..model.motion import Floats
from ..raster.frame import PixelCode, Plane
from ..raster.steps import StepState
from ..raster.trace import PixelChain
from ..usecases.pixels.part import BitmapPart
from ..usecases.pixels.way import OperationPaths, PixelPath

CODES = {
    PieceKind.CIRCLE: PixelCode.CIRCLE,
    PieceKind.LONG_LINE: PixelCode.LONG_LINE,
    PieceKind.SHORT_LINE: PixelCode.SHORT_LINE,
    PieceKind.ARC: PixelCode.ARC,
    PieceKind.SPLINE: PixelCode.SPLINE,
}
_TOOLS = 10.0
"""A long line is as long as so many tool diameters."""
_LEAST = 8
"""Pixels of a line that is smoothed."""


def long_line(job: Job, paths: OperationPaths | None) -> float:
    """Return how long a long line is, mm: ten diameters of an operation's tool."""
    if paths is None:
        return 0.0
    return _TOOLS * job.tool(job.operations[paths.index].cut.tool).diameter


def centres(chain: PixelChain) -> Floats:
    """Return the pixels of a closed line as places, x to the right and y up, px."""
    pixels = chain.pixels()[:-1] if len(chain.directions) else chain.pixels()
    return np.column_stack([pixels[:, 1], -pixels[:, 0]]).astype(np.float64)


def published_angles(chains: Sequence[PixelChain]) -> str:
    """Return what formula I' tells of some borders (301), by the average of five vectors, and what it cannot tell."""
    found = [average_angles(centres(chain)) for chain in chains if len(chain.directions) >= _LEAST]
    if not found:
        return ""
    arccos, signed = (np.concatenate([pair[k] for pair in found]) for k in (0, 1))
    half, right = np.pi / 2, int(np.sum((signed < 0) & (arccos > np.pi / 2)))
    sharp = int(np.sum(arccos > half))
    return (
        f"By formula I' the averages of five vectors turn by {np.degrees(arccos.max()):.0f} degrees at most; never "
        f"more than 180, so that of {counted(sharp, 'place')} that turn by more than 90 it cannot tell the {right} "
        "that turn to the right. Settled: the sign of the cross product."
    )


def published_stages(part: BitmapPart, paths: Sequence[PixelPath], long: float) -> Iterator[StepState]:
    """Yield steps 401 to 407 by the published rules.

    Args:
        part: the pixels. paths: that are smoothed. long: how long a long line is, mm.
    """
    pitch = part.frame.pitch
    known = [path for path in paths if len(path.chain.directions) >= _LEAST]
    made = [published_smoothing(centres(path.chain), long / pitch) for path in known]
    plane = np.zeros_like(part.drawn)
    for path in known:
        plane[tuple(path.chain.pixels().T)] = PixelCode.CONTOUR
    rows: list[Rows] = [np.zeros((0, 8))]
    for number in (401, 402, 403, 404, 405, 406, 407):
        for path, smoothing in zip(known, made, strict=True):
            pixels = path.chain.pixels()[:-1]
            for piece in smoothing.pieces:
                if piece.kind == number:
                    _mark(plane, pixels[np.arange(piece.first, piece.last + 1) % len(pixels)], CODES[piece.kind])
                    rows.append(_rows(part, piece.places))
            if number == 404:
                plane[tuple(pixels[list(smoothing.vertices)].T)] = PixelCode.VERTEX
        words = _words(number, known, made, pitch)
        yield StepState(number, plane.copy(), rows=np.concatenate(rows), beside=words)


def _mark(plane: Plane, pixels: np.ndarray, code: PixelCode) -> None:
    kept = pixels[plane[tuple(pixels.T)] != PixelCode.VERTEX]
    plane[tuple(kept.T)] = code


def _rows(part: BitmapPart, places: Floats) -> Rows:
    """Return places, px, as straight rows (n, 8), mm."""
    own = np.column_stack([places[:, 0] + 0.5, -places[:, 1] + 0.5])
    points = part.frame.to_mm(own)
    made = np.zeros((max(len(points) - 1, 0), 8))
    made[:, :2], made[:, 2:4] = points[:-1], points[1:]
    return made


_KINDS = {
    401: PieceKind.CIRCLE,
    403: PieceKind.LONG_LINE,
    405: PieceKind.SHORT_LINE,
    406: PieceKind.ARC,
    407: PieceKind.SPLINE,
}


def _words(number: int, paths: Sequence[PixelPath], made: Sequence[PublishedSmoothing], pitch: float) -> str:
    """Return what a step comes to as published and as settled."""
    if number == 404:
        found, corners = sum(len(each.vertices) for each in made), sum(int(np.sum(~p.smoothed.tangent)) for p in paths)
        return f"As published, {counted(found, 'vertex', 'vertices')}; settled, {counted(corners, 'corner')}."
    if number not in _KINDS:
        return ""
    own = [piece for each in made for piece in each.pieces if piece.kind is _KINDS[number]]
    before = ""
    if number == 401:
        spread = min((each.spread for each in made), default=0.0)
        before = f"C of formula II changes by {100 * spread:.0f} percent at least. "
    if own and number != 407:
        sa, sb = (max(getattr(piece, name) for piece in own) for name in ("sa", "sb"))
        before += f"SA comes to {sa:.2f} and SB to {sb:.2f} px a pixel at most. "
    return before + _both(_KINDS[number], own, paths, pitch)


def _both(kind: PieceKind, own: Sequence[PublishedPiece], paths: Sequence[PixelPath], pitch: float) -> str:
    settled = sum(int(np.sum(path.smoothed.kinds == kind)) for path in paths)
    theirs = max((path.smoothed.deviation for path in paths), default=0.0)
    name = kind.name.lower().replace("_", " ")
    if not own:
        return f"As published, no {name}; settled, {settled}, all pieces up to {1000 * theirs:.0f} um."
    off = max(piece.off for piece in own)
    return (
        f"As published, {counted(len(own), name)}, up to {1000 * off * pitch:.0f} um ({off:.2f} px) off their pixels; "
        f"settled, {settled}, all pieces up to {1000 * theirs:.0f} um."
    )
