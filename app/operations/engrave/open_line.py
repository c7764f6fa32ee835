"""Paths with the cutter's centre on the drawn lines: engraving, slots, scribed outlines."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core import tolerances
from ...core.progress import Progress
from ...core.wording import in_plane
from ...geometry.distance import DistanceField
from ...geometry.primitives import Rows, contour_rows, lengths, points_at, reversed_rows, signed_area
from ...model.finding import Finding, FindingKind
from ...model.operation import Direction
from ...model.part import Contour
from ...model.tool import Tool
from ...toolpath.leads.contour_path import ContourPath, Floats
from ...toolpath.machining_areas import MachiningArea, ranks

_FINEST = tolerances.LEVEL
"""mm; how exactly the place is found where a clamp cuts a line off, on the safe side."""

_TELL = 50
"""Places that are told one by one; the rest is counted."""


class _CutOffPart(NamedTuple):
    """A part of a line that a clamp cuts off: its middle and how long it is, mm."""

    x: float
    y: float
    length: float


def line_paths(
    area: MachiningArea, tool: Tool, direction: Direction, progress: Progress
) -> tuple[tuple[ContourPath, ...], list[Finding]]:
    """Return the paths on an area's lines, and what of them clamps cut off.

    Climb milling keeps what a closed contour encloses on the right, or, where an odd number of others lie round it, on
    the left, as if the drawing were the outline of a part with its holes. Open lines go as they are drawn, or the other
    way for conventional milling.
    """
    loops = [contour for contour in area.lines if contour.closed]
    rank = dict(zip(map(id, loops), ranks([contour_rows(contour) for contour in loops]), strict=True))
    paths: list[ContourPath] = []
    cut_off: list[_CutOffPart] = []
    for k, contour in enumerate(area.lines):
        progress.step(k / len(area.lines), "Lines")
        # open lines before any loop that may free a part
        depth = rank[id(contour)] if contour.closed else len(loops)
        whole = _path_along(contour, depth, direction, k + 1 if contour.closed else 0)
        kept, lost = _beside_clamps(whole, area, tool.radius)
        paths.extend(kept)
        cut_off.extend(lost)
    return tuple(paths), _told(cut_off, tool)


def _path_along(contour: Contour, depth: int, direction: Direction, loop: int) -> ContourPath:
    """Return the path along a line, in the direction that is milled in.

    Args:
        depth: how many closed contours lie round it. loop: its number among these, 0 of an open line.
    """
    rows, climbs = contour_rows(contour), direction is Direction.CLIMB
    if not contour.closed:
        return ContourPath(
            rows if climbs else reversed_rows(rows), closed=False, region=0, rank=depth, area=0.0, loop=loop
        )
    enclosed, outer = signed_area(rows), depth % 2 == 0
    turns_wrong = (enclosed > 0) == (climbs if outer else not climbs)
    area = -abs(enclosed) if outer else abs(enclosed)
    return ContourPath(
        reversed_rows(rows) if turns_wrong else rows, closed=True, region=0, rank=depth, area=area, loop=loop
    )


def _beside_clamps(
    path: ContourPath, area: MachiningArea, radius: float
) -> tuple[list[ContourPath], list[_CutOffPart]]:
    """Return (what of a path is clear of clamps, what is not): by its name, as tools fit gaps."""
    row, low, high = clear_parts(path.rows, area.distances, radius - tolerances.NOMINAL)
    size = lengths(path.rows)
    begin = path.ends - size
    starts, stops = begin[row] + low * size[row], begin[row] + high * size[row]
    if len(row) == len(path.rows) and (high - low == 1).all():
        return [path], []
    spans: list[tuple[float, float]] = []
    for a, b in zip(starts.tolist(), stops.tolist(), strict=True):
        if spans and a - spans[-1][1] < tolerances.WELD:
            spans[-1] = spans[-1][0], b
        else:
            spans.append((a, b))
    length = path.length
    if path.closed and len(spans) > 1 and spans[0][0] < tolerances.WELD and spans[-1][1] > length - tolerances.WELD:
        spans = [*spans[1:-1], (spans[-1][0], length + spans[0][1])]
    elif path.closed and len(spans) == 1 and spans[0] == (0.0, length):
        return [path], []
    kept = [
        ContourPath(
            path.span(a, b, np.zeros(0))[0], closed=False, region=0, rank=path.rank, area=path.area, loop=path.loop
        )
        for a, b in spans
    ]
    return kept, _between(path, spans)


def _between(path: ContourPath, spans: list[tuple[float, float]]) -> list[_CutOffPart]:
    """Return each part of a path between some spans of it."""
    length = path.length
    if not spans:
        gaps = [(0.0, length)]
    elif path.closed:
        gaps = [(b, a) for (_, b), (a, _) in zip(spans, [*spans[1:], (spans[0][0] + length, 0.0)], strict=True)]
    else:
        gaps = [(b, a) for (_, b), (a, _) in zip([(0.0, 0.0), *spans], [*spans, (length, 0.0)], strict=True)]
    gaps = [(a, b) for a, b in gaps if b - a > _FINEST]
    places = path.points(np.array([(a + b) / 2 for a, b in gaps])) if gaps else np.zeros((0, 2))
    return [_CutOffPart(float(x), float(y), b - a) for (x, y), (a, b) in zip(places, gaps, strict=True)]


def clear_parts(
    rows: Rows, field: DistanceField, radius: float, bounded: bool = True
) -> tuple[NDArray[np.int64], Floats, Floats]:
    """Return (row, from, to) of all parts of rows, as fractions, in which a cutter is clear of what an area is bounded
    by; without `bounded`, of walls that bound nothing. Parts are as long as they are clear.

    Distance changes by no more than the way gone, so one distance, from the middle of a part, can decide it all; what
    it does not decide is divided. The smallest parts count as clear when both their ends and their middle are.
    """
    size = lengths(rows)
    row, low, high = np.arange(len(rows)), np.zeros(len(rows)), np.ones(len(rows))
    found: list[tuple[NDArray[np.int64], Floats, Floats]] = []
    while len(row):
        middle = points_at(rows[row], (low + high) / 2)
        half = (high - low) * size[row] / 2
        spare = field.nearest(middle)[0] - radius
        inside = field.inside(middle) if bounded else np.ones(len(row), np.bool_)
        small = half < _FINEST / 2
        both = np.minimum(*(field.nearest(points_at(rows[row], part))[0] for part in (low, high))) - radius
        clear = inside & ((spare >= half) | (small & (np.minimum(both, spare) >= 0)))
        reach = np.where(inside, -spare, spare + 2 * radius)  # nearer than this nothing is clear
        open_still = ~clear & ~small & (half > reach)
        found.append((row[clear], low[clear], high[clear]))
        again, a, b = row[open_still], low[open_still], high[open_still]
        row, low, high = (
            np.concatenate([again, again]),
            np.concatenate([a, (a + b) / 2]),
            np.concatenate([(a + b) / 2, b]),
        )
    rows_found, lows, highs = (np.concatenate([each[k] for each in found]) for k in range(3))
    order = np.lexsort((lows, rows_found))
    row, low, high = rows_found[order], lows[order], highs[order]
    parted = (row[1:] != row[:-1]) | (low[1:] != high[:-1])  # halves of halves meet to the last digit
    first, last = np.concatenate([[True], parted]), np.concatenate([parted, [True]])
    return (row[first], low[first], high[last]) if len(row) else (row, low, high)


def runs_of_parts(rows: Rows, row: NDArray[np.int64], low: Floats, high: Floats) -> Iterator[Rows]:
    """Yield runs of parts of rows that follow one another without a gap; around the ring's beginning, too."""
    parts = []
    for k, a, b in zip(row.tolist(), low.tolist(), high.tolist(), strict=True):
        part = rows[k].copy()
        part[:2], part[2:4] = points_at(rows[[k, k]], np.array([a, b]))
        parts.append(part)
    runs: list[list[np.ndarray]] = []
    for part in parts:
        if runs and np.hypot(*(runs[-1][-1][2:4] - part[:2])) < tolerances.WELD:
            part[:2] = runs[-1][-1][2:4]
            runs[-1].append(part)
        else:
            runs.append([part])
    if len(runs) > 1 and np.hypot(*(runs[-1][-1][2:4] - runs[0][0][:2])) < tolerances.WELD:
        runs[0] = [*runs.pop(), *runs[0]]
    return (np.array(run) for run in runs)


def _told(cut_off: list[_CutOffPart], tool: Tool) -> list[Finding]:
    findings = [
        Finding(
            FindingKind.LEFT_OUT,
            f"A keep-out area cuts {length:.3f} mm of a line off from T{tool.number} {tool.label} at "
            f"{in_plane(x, y)}; move the clamp and cut the rest.",
            x,
            y,
            amount=length,
        )
        for x, y, length in cut_off[:_TELL]
    ]
    more = cut_off[_TELL:]
    if more:
        length = sum(each.length for each in more)
        text = f"Keep-out areas cut {len(more)} more places of lines off, {length:.3f} mm in all."
        findings.append(Finding(FindingKind.LEFT_OUT, text, more[0].x, more[0].y, amount=length))
    return findings
