"""The bitmap way step by step, as the workstation's display memory showed it: for a class to watch, one stage at a
time.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import Enum
from typing import TypedDict

import numpy as np

from ..core.wording import counted
from ..fitting.corner_smoothing.smoothed_path import PieceKind
from ..geometry.primitives import Rows
from ..model.job import Job
from ..raster.border import borders_of, mark
from ..raster.fill import fill
from ..raster.frame import PixelCode, Plane
from ..raster.peel import correct_by_circles, peels
from ..raster.published import published_marks, published_scan, wrong_pixels
from ..raster.steps import StepState
from ..raster.trace import PixelChain, chain_rows
from ..raster.walls import Mask
from ..usecases.pixels.part import BitmapPart
from ..usecases.pixels.way import OperationPaths, PixelPath
from .published_stages import CODES, long_line, published_angles, published_stages


class Variant(Enum):
    """Which rules are followed where the text's own err: those that are always right, or the text's (206 to 208, 301,
    304, 401 to 407), each beside the settled one.
    """

    SETTLED = "settled"
    PUBLISHED = "published"


@dataclass(frozen=True)
class _Scene:
    """What all stages of one walk share."""

    part: BitmapPart
    variant: Variant


def stages(
    job: Job, part: BitmapPart, paths: Sequence[OperationPaths], variant: Variant = Variant.SETTLED
) -> Iterator[StepState]:
    """Yield the display memory after every step, in the text's order; each is made when it is asked for.

    Args:
        job: that the paths were made for; its first contour and pocket operation are shown.
        part: the pixels.
        paths: of each operation, as `compute_on_bitmap` gives them.
        variant: of the fill; the paths are those of the settled one.
    """
    scene = _Scene(part, variant)
    contour = next((each for each in paths if job.operations[each.index].FOLLOWS_WALLS), None)
    pocket = next(
        (each for each in paths if each is not contour and not job.operations[each.index].FOLLOWS_WALLS), None
    )
    yield StepState(110, (part.drawn != PixelCode.EMPTY).astype(np.uint8))
    shown = contour or pocket
    if shown is None:
        return
    outline = tuple(border.chain for border in borders_of(shown.area))
    plane = np.zeros_like(part.drawn)
    _put(plane, outline, PixelCode.CONTOUR)
    yield StepState(120, plane, outline)
    yield from _fill(scene, outline)
    if pocket is not None:
        yield from _frames(scene, pocket)
        yield from _inner_paths(scene, pocket)
    yield StepState(140, _all_paths(part, contour, pocket))
    shown_paths = [
        path for each in (contour, pocket) if each is not None for level in each.levels[:1] for path in level
    ]
    if variant is Variant.PUBLISHED:
        yield from published_stages(part, shown_paths, long_line(job, pocket or contour))
    else:
        yield from _smoothing(part, shown_paths)


def _put(plane: Plane, chains: Sequence[PixelChain], code: PixelCode) -> None:
    for chain in chains:
        plane[tuple(chain.pixels().T)] = code


def _fill(scene: _Scene, outline: tuple[PixelChain, ...]) -> Iterator[StepState]:
    """Steps 201-208 and 130."""
    frame = scene.part.frame
    seen: dict[int, Plane] = {}
    settled = fill(frame, chain_rows(frame, outline), seen.__setitem__).plane
    wrong, chains = None, outline
    if scene.variant is Variant.PUBLISHED:
        seen[206], chains = published_marks(seen[201])
        seen[208] = published_scan(seen[206])
        seen[130] = (seen[208] != PixelCode.EMPTY).astype(np.uint8)
        wrong = wrong_pixels(seen[208], settled)
    found = np.where(seen[206] == PixelCode.R, PixelCode.VERTEX, seen[203]).astype(np.uint8)
    yield StepState(201, seen[201])
    yield StepState(202, seen[202])
    yield StepState(203, seen[203], chains)
    yield StepState(204, seen[203].copy())
    yield StepState(205, found)
    yield StepState(206, seen[206])
    yield StepState(207, seen[206].copy())
    yield StepState(208, seen[208], wrong=wrong)
    yield StepState(130, seen[130], wrong=wrong)


def _frames(scene: _Scene, pocket: OperationPaths) -> Iterator[StepState]:
    """Steps 141-144: the outermost frames of all regions, one region after the other."""
    plane = pocket.area.astype(np.uint8)
    for region in scene.part.regions:
        area = pocket.area & (scene.part.label == region.number)
        if area.any():
            if scene.variant is Variant.PUBLISHED:
                yield from _shrink(plane, area, (region.number, pocket.steps.first, area_apart(area, pocket)))
            else:
                yield from _shrink(plane, area, (region.number, pocket.steps.first, None))
            yield from _frame(plane, area, pocket, region.number)
    frames = [path for level in pocket.levels[:1] for path in level]
    yield StepState(144, plane.copy(), tuple(path.chain for path in frames), _rows(frames))


def area_apart(area: Mask, pocket: OperationPaths) -> tuple[Mask, ...]:
    """Return what is left of an area after each peel by the settled rule, to hold the published one against."""
    return tuple(left for left, _ in peels(area, int(pocket.steps.first)))


def _shrink(plane: Plane, area: Mask, about: tuple[int, float, tuple[Mask, ...] | None]) -> Iterator[StepState]:
    """Steps 301-307 on one region, the plane goes along; as published where what the settled rule leaves is given."""
    region, radius, settled = about
    left, first = area, borders_of(area)
    for turn, (left, borders) in enumerate(peels(area, int(radius), keep_narrow=settled is not None), 1):
        traced = plane.copy()
        mark(traced, borders, PixelCode.TRACED)
        chains = tuple(border.chain for border in borders)
        beside = "" if settled is None else published_angles(chains)
        yield StepState(301, traced, chains, region=region, turn=turn, beside=beside)
        yield StepState(302, traced.copy(), region=region, turn=turn)
        if turn == 1:
            yield StepState(303, traced.copy(), chains, region=region)
        plane[area & ~left] = PixelCode.PROCESSED
        kept = (left, settled[min(turn, len(settled)) - 1]) if settled else None
        yield StepState(304, plane.copy(), region=region, turn=turn, **_beside_peel(kept))
        yield StepState(305, plane.copy(), region=region, turn=turn)
    read = plane.copy()
    mark(read, first, PixelCode.FRAME)
    yield StepState(306, read, tuple(border.chain for border in first), region=region)
    corrected = correct_by_circles(left, area, radius)
    plane[area & ~corrected] = PixelCode.PROCESSED
    kept = (corrected, correct_by_circles(settled[-1], area, radius)) if settled else None
    yield StepState(307, plane.copy(), region=region, **_beside_peel(kept))


class _Beside(TypedDict, total=False):
    """What a stage tells of the published rule."""

    wrong: Mask
    beside: str


def _beside_peel(both: tuple[Mask, Mask] | None) -> _Beside:
    """Return how what is left by the published rule differs from what the settled one leaves."""
    if both is None:
        return {}
    published, settled = both
    parts = tuple(len(borders_of(each)) for each in both)
    apart: Mask = published != settled
    words = (
        f"As published, {int(published.sum())} pixels are left, with {counted(parts[0], 'border')}; settled, "
        f"{int(settled.sum())} with {counted(parts[1], 'border')}."
    )
    return {"wrong": apart, "beside": words}


def _frame(plane: Plane, area: Mask, pocket: OperationPaths, region: int) -> Iterator[StepState]:
    """Steps 141-143 on one region: what is left, its border, and the overlap."""
    inside = area & (pocket.pixels >= 1)
    plane[area & ~inside] = PixelCode.PROCESSED
    yield StepState(141, plane.copy(), region=region)
    frames = [path for level in pocket.levels[:1] for path in level if area[path.chain.start]]
    chains = tuple(path.chain for path in frames)
    _put(plane, chains, PixelCode.FRAME)
    yield StepState(142, plane.copy(), chains, _rows(frames), region)
    _mark_overlap(plane, area & (pocket.pixels == 1))
    yield StepState(143, plane.copy(), region=region)


def _mark_overlap(plane: Plane, band: Mask) -> None:
    """Mark what lies within a step of a path, the path itself excepted: the next one begins behind it."""
    plane[band & (plane == PixelCode.CONTOUR)] = PixelCode.PROCESSED


def _inner_paths(scene: _Scene, pocket: OperationPaths) -> Iterator[StepState]:
    """Steps 145-148: path after path, in all regions."""
    plane = np.where(
        pocket.area, np.where(pocket.pixels >= 1, PixelCode.CONTOUR, PixelCode.PROCESSED), PixelCode.EMPTY
    ).astype(np.uint8)
    _put(plane, [path.chain for level in pocket.levels[:1] for path in level], PixelCode.FRAME)
    _mark_overlap(plane, pocket.pixels == 1)
    for level in range(2, len(pocket.levels) + 1):
        chains = tuple(path.chain for path in pocket.levels[level - 1])
        _put(plane, chains, PixelCode.TRACED)
        yield StepState(145, plane.copy(), chains, turn=level - 1)
        _put(plane, chains, PixelCode.RING)
        yield StepState(146, plane.copy(), chains, _rows(pocket.levels[level - 1]), turn=level - 1)
        _mark_overlap(plane, pocket.pixels == level)
        yield StepState(147, plane.copy(), turn=level - 1)
    yield StepState(148, plane.copy())


def _rows(paths: Sequence[PixelPath]) -> Rows:
    return np.concatenate([np.zeros((0, 8)), *(path.rows for path in paths)])


def _all_paths(part: BitmapPart, contour: OperationPaths | None, pocket: OperationPaths | None) -> Plane:
    plane = np.zeros_like(part.drawn)
    for each, codes in ((contour, (PixelCode.CONTOUR, PixelCode.CONTOUR)), (pocket, (PixelCode.FRAME, PixelCode.RING))):
        for depth, level in enumerate(each.levels if each is not None else ()):
            _put(plane, [path.chain for path in level], codes[min(depth, 1)])
    return plane


def _smoothing(part: BitmapPart, paths: Sequence[PixelPath]) -> Iterator[StepState]:
    """Steps 401-407 on some paths."""
    plane = np.zeros_like(part.drawn)
    _put(plane, [path.chain for path in paths], PixelCode.CONTOUR)
    done: list[Rows] = [np.zeros((0, 8))]
    for number in (401, 402, 403, 404, 405, 406, 407):
        for path in paths:
            if number == 404:
                _mark_vertices(plane, path)
            chosen = path.smoothed.kinds == number
            _mark_pieces(plane, path, chosen)
            done.append(path.rows[chosen])
        yield StepState(number, plane.copy(), rows=np.concatenate(done))


def _mark_pieces(plane: Plane, path: PixelPath, chosen: Mask) -> None:
    """Write the codes of some pieces into their pixels, vertices excepted."""
    pixels = path.chain.pixels()[:-1] if len(path.chain.directions) else path.chain.pixels()
    for k in np.flatnonzero(chosen).tolist():
        first, last = path.smoothed.ends[k : k + 2]
        own = pixels[np.arange(first, last + 1) % len(pixels)]
        own = own[plane[tuple(own.T)] != PixelCode.VERTEX]
        plane[tuple(own.T)] = CODES[PieceKind(path.smoothed.kinds[k])]


def _mark_vertices(plane: Plane, path: PixelPath) -> None:
    pixels = path.chain.pixels()[:-1] if len(path.chain.directions) else path.chain.pixels()
    corners = path.smoothed.ends[:-1][~path.smoothed.tangent & (path.smoothed.kinds != PieceKind.SPLINE)]
    plane[tuple(pixels[corners % len(pixels)].T)] = PixelCode.VERTEX
