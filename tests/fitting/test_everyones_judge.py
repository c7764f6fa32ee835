"""The judge of curves asked about what it did not make: the exact rings, and what smoothing makes of the bitmap's
borders.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import shapely

from app.fitting.corner_smoothing.smooth import CornerSmoothingOptions, smooth
from app.fitting.corner_smoothing.smoothed_path import SmoothedPath
from app.fitting.fitted import lines_between
from app.fitting.point_curves.space_curve import SpaceCurve, curve_of_motions
from app.fitting.point_curves.tube import ToleranceTube, TubeAnswer, judge
from app.geometry.offset.offset import offset_levels
from app.geometry.outlines import nest
from app.geometry.primitives import CX, TURN, X0, X1, R, Rows, contour_rows, lengths, pack
from app.model.motion import MotionKind, Plane
from app.model.part import Contour
from app.raster.frame import BitmapFrame
from tests.fitting.paths import sampled, traces
from tests.part_shapes import circle, fig2, random_part
from tests.raster.shapes import KINDS

NEAR = ToleranceTube(1e-3)
"""mm; the oracle's chords leave its own arcs by a tenth of it."""
CHORD = 1e-4


def curve_of_rows(rows: Rows) -> SpaceCurve:
    """Lines and arcs at Z 0 as a curve; an arc without a chord is a circle."""
    count, flat, arc = len(rows), np.zeros((len(rows), 1)), rows[:, TURN] != 0
    turning = np.where(rows[:, TURN] > 0, MotionKind.ARC_CCW, MotionKind.ARC_CW)
    path = lines_between(np.vstack([np.zeros(3), np.hstack([rows[:, X1:CX], flat])]))
    motions = replace(
        path,
        start=np.hstack([rows[:, X0:X1], flat]),
        kind=np.where(arc, turning, MotionKind.LINE).astype(np.uint8),
        centre=np.where(arc[:, None], np.hstack([rows[:, CX:R], flat]), np.nan),
        plane=np.full(count, Plane.XY, np.uint8),
        turns=arc.astype(np.int32),
    )
    return curve_of_motions(motions)


def in_space(points: np.ndarray) -> np.ndarray:
    return np.column_stack([points, np.zeros(len(points))])


def in_tube(path: SmoothedPath, points: np.ndarray, tube: ToleranceTube) -> bool:
    """Whether the judge finds a closed path to go round with closed points (n, 2): from that at which it says that it
    starts, or from that nearest to its start of those about there; a circle may start anywhere.
    """
    near = np.arange(len(points)) if len(path.rows) == 1 else (path.ends[0] + np.arange(-20, 21)) % len(points)
    nearest = near[np.argmin(np.hypot(*(points[near] - path.rows[0, :2]).T))]
    loops = (np.roll(points, -int(first), axis=0) for first in (path.ends[0] % len(points), nearest))
    curve = curve_of_rows(path.rows)
    return any(judge(curve, in_space(np.vstack([loop, loop[:1]])), tube).answer is TubeAnswer.INSIDE for loop in loops)


def chords(rows: Rows) -> np.ndarray:
    """(n, 2) places on closed rows, no chord farther than CHORD from its arc."""
    steps = np.where(
        rows[:, 7] == 0, 1, np.ceil(lengths(rows) / np.sqrt(8 * CHORD * np.maximum(rows[:, 6], 1e-9)))
    ).astype(int)
    found = []
    for row, count in zip(rows, steps, strict=True):
        share = np.linspace(0, 1, count + 1)[:-1]
        first, last = (np.arctan2(row[k + 1] - row[5], row[k] - row[4]) for k in (0, 2))
        sweep = row[7] * ((row[7] * (last - first)) % (2 * np.pi))
        angle = first + sweep * share
        arc = row[4:6] + row[6] * np.column_stack([np.cos(angle), np.sin(angle)])
        found.append(arc if row[7] else row[:2] + share[:, None] * (row[2:4] - row[:2]))
    return np.concatenate(found)


def from_there(ring: shapely.LinearRing, start: np.ndarray, ccw: bool) -> np.ndarray:
    """The ring (n, 2) from the place nearest to a start and back there, in one sense."""
    points = shapely.get_coordinates(ring if ring.is_ccw == ccw else ring.reverse())
    line = shapely.LineString(points)
    at = line.project(shapely.Point(start))
    stations = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
    k = int(np.searchsorted(stations, at, side="right"))
    here = np.array(line.interpolate(at).coords)
    whole = np.concatenate([here, points[k:-1], points[:k], here])
    return whole[np.concatenate([[True], np.hypot(*np.diff(whole, axis=0).T) > 0])]


@pytest.mark.parametrize("seed", [None, 0, 1, 2, 5, 6, 7, 10, 11, 12])
def test_every_ring_keeps_within_a_micrometre_of_what_shapely_offsets(seed: int | None) -> None:
    contours: list[Contour] = fig2() if seed is None else random_part(seed)[0]
    regions = tuple(nest(contours))
    polygons = shapely.union_all(
        [
            shapely.Polygon(chords(contour_rows(outer)), [chords(contour_rows(island)) for island in islands])
            for outer, *islands in (region.contours for region in regions)
        ]
    )
    judged = 0
    for level in offset_levels(pack(regions), [0.7, 1.9, 3.3]):
        arcs = max(8, int(np.ceil(np.pi / 4 / np.sqrt(2 * CHORD / level.distance))))
        theirs = shapely.get_parts(polygons.buffer(-level.distance, quad_segs=arcs))
        rings = [ring for part in theirs for ring in (part.exterior, *part.interiors)]
        for ring in level.rings:
            assert not ring.polyline
            start = ring.rows[0, :2]
            oracle = min(rings, key=lambda each, at=start: each.distance(shapely.Point(at)))
            ccw = shapely.LinearRing(chords(ring.rows)).is_ccw
            points = in_space(from_there(oracle, start, ccw))
            answer = judge(curve_of_rows(ring.rows), points, NEAR)
            assert answer.answer is TubeAnswer.INSIDE, (level.distance, answer)
            moved = ring.rows.copy()
            moved[:, :6] += [2.1 * NEAR.radius, 0] * 3
            assert judge(curve_of_rows(moved), points, NEAR).answer is TubeAnswer.OUTSIDE
            judged += 1
    assert judged >= 3


@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind != "beyond"])
def test_what_smoothing_makes_of_a_border_is_in_a_tube_round_its_pixels(kind: str) -> None:
    frame = BitmapFrame(200, 200, 1.0)
    for seed in range(8):
        for trace in traces(frame, KINDS[kind](np.random.default_rng(seed), 190.0))[:4]:
            path = smooth(trace, CornerSmoothingOptions(0.75))
            assert in_tube(path, trace, ToleranceTube(6.0)), "mitres among it"
            aside = replace(path, rows=path.rows + np.array([9.0, 0, 9, 0, 9, 0, 0, 0]))
            assert not in_tube(aside, trace, ToleranceTube(6.0))


@pytest.mark.parametrize("amount", [0.02, 0.05])
def test_a_path_between_pixels_is_in_the_tube_of_twice_its_tolerance(amount: float) -> None:
    points = sampled(circle(20.0), 0.3)
    noise = np.random.default_rng(1).uniform(-amount, amount, points.shape)
    path = smooth(points + noise, CornerSmoothingOptions(2 * amount))
    assert in_tube(path, points + noise, ToleranceTube(4 * amount))
    assert not in_tube(path, points + noise, ToleranceTube(0.5 * amount)), "the noise itself is more"
