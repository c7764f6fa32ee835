"""Curves in pieces: how far chords are from them, measured densely, and what a window leaves out."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from app.model.motion import Floats, MotionKind, Motions, Nurbs, Plane
from app.model.motion_path import arc_paths
from app.model.stock_box import StockBox
from app.simulation.field.workpiece import BoxStock, Grid
from app.simulation.sweeps.course import TrimOptions
from app.simulation.sweeps.pieces import CHORD, PieceSplitter, SweepPieces, SweepWindow
from tests.nurbs_oracle import nurbs_points
from tests.simulation.courses import CUTTERS, arc, box_piece, cut, joined, polyline
from tests.simulation.test_sweep import excess, walk

QUARTER = Nurbs(
    np.array([[6.0, 0, -3], [6, 6, -3], [0, 6, -3]]), np.array([1, np.sqrt(0.5), 1]), np.array([0, 0, 0, 1.0, 1, 1]), 2
)
CORNER = Nurbs(
    np.array([[-6.0, 0, -2], [-3, 4, -3], [0.0123, -4, -4], [3, 4, -3], [6, 0, -2]]),
    np.ones(5),
    np.array([0, 0, 0, 0.3, 0.3, 1, 1, 1.0]),
    2,
)
HEAVY = Nurbs(
    np.array([[-6.0, 0, -2], [-6, 9, -4], [6, -9, -4], [6, 0, -2], [7, 3, -2]]),
    np.array([1, 0.02, 50, 1, 3]),
    np.array([0, 0, 0, 0, 0.9, 1, 1, 1, 1]),
    3,
)
SPLINES = {"quarter": QUARTER, "corner within": CORNER, "heavy": HEAVY}
CURVES = {
    "helix": arc((4, 0, 0), (4, 0, -6), (0, 0, 0), turns=2),
    "G18": arc((-5, 1, -6), (5, 2, -6), (0, 1, -6), Plane.ZX, ccw=False),
    "G19": arc((1, -5, -1), (2, 5, -1), (1, 0, -1), Plane.YZ),
    "widening": arc((1, 0, 0), (-4, 0, -1), (0, 0, 0)),
}


def spline_motion(curve: Nurbs) -> Motions:
    one = polyline([curve.points[0], curve.points[-1]])
    return replace(one, kind=np.full(1, MotionKind.SPLINE, np.uint8), splines={0: curve})


def along(curve: Nurbs) -> Callable[[Floats], Floats]:
    last = float(curve.knots[-1])
    return lambda t: nurbs_points(curve, np.ravel(t) * last).reshape(*np.shape(t), 3)


def from_chords(pieces: SweepPieces, points: Floats) -> Floats:
    """How far (n,) points in order along a curve are from its chords: each from those near its share of the way."""
    way = pieces.end - pieces.start
    square = np.maximum(np.einsum("ij,ij->i", way, way), 1e-300)
    distances = np.full(len(points), np.inf)
    nearest = np.array(
        [np.argmin(np.einsum("ij,ij->i", d, d)) for d in ((pieces.start + pieces.end) / 2 - point for point in points)]
    )
    for beside in range(-2, 3):
        k = np.clip(nearest + beside, 0, len(way) - 1)
        share = np.clip(np.einsum("ij,ij->i", points - pieces.start[k], way[k]) / square[k], 0, 1)
        distances = np.minimum(distances, np.linalg.norm(pieces.start[k] + share[:, None] * way[k] - points, axis=1))
    return distances


@pytest.mark.parametrize("name", SPLINES)
def test_no_point_of_a_spline_is_far_from_its_chords(name: str) -> None:
    motions = spline_motion(SPLINES[name])
    pieces = PieceSplitter(motions).pieces(0, 1)
    assert np.array_equal(pieces.start[1:], pieces.end[:-1])
    assert np.array_equal(pieces.start[0], motions.start[0])
    assert np.allclose(pieces.end[-1], motions.end[0], rtol=0, atol=1e-12)
    points = along(SPLINES[name])(np.linspace(0, 1, 4001))
    assert 0.05 * CHORD < from_chords(pieces, points).max() <= CHORD


@pytest.mark.parametrize("name", CURVES)
def test_no_point_of_a_curve_is_far_from_its_chords(name: str) -> None:
    pieces = PieceSplitter(CURVES[name]).pieces(0, 1)
    assert np.array_equal(pieces.start[1:], pieces.end[:-1])
    assert np.array_equal([pieces.start[0], pieces.end[-1]], [CURVES[name].start[0], CURVES[name].end[0]])
    points = arc_paths(CURVES[name]).points(np.linspace(0, 1, 3001))[0]
    assert 0.05 * CHORD < from_chords(pieces, points).max() <= CHORD


@pytest.mark.parametrize("cutter", ["ball", "flat", "bull", "v"])
@pytest.mark.parametrize("name", ["quarter", "corner within"])
def test_a_spline_is_cut_like_brute_force(cutter: str, name: str) -> None:
    assert (
        excess(box_piece(cells=48), spline_motion(SPLINES[name]), [along(SPLINES[name])], CUTTERS[cutter], 40).max()
        <= 1
    )


def winding(count: int) -> Motions:
    """Helices all over a plate, with ways between them, one arc of another plane and a spline."""
    rng = np.random.default_rng(4)
    parts, at = [], np.array([0.0, 0.0, 1.0])
    for x, y in rng.uniform(-24, 24, (count, 2)):
        start = np.array([x, y, 0.0])
        parts += [
            polyline([at, start]),
            arc(start, start - [0, 0, 3], start + [2, 0, 0], turns=3),
            polyline(walk(7, 5, 0.5, 0.5) + start),
        ]
        at = parts[-1].end[-1]
    chain = joined(parts)
    curve = replace(QUARTER, points=QUARTER.points + [20, 20, 0])
    last = len(chain)
    over = arc((-30, 1, -2), (-20, 1, -2), (-25, 1, -2), Plane.ZX, ccw=False)
    return replace(joined([chain, over, spline_motion(curve)]), splines={last + 1: curve})


@pytest.mark.parametrize("cutter", ["ball", "bull"])
def test_a_window_leaves_curves_out_and_changes_no_bit(cutter: str, monkeypatch: pytest.MonkeyPatch) -> None:
    motions, stock = winding(30), BoxStock(StockBox(-50, -50, -30, 50, 50))
    whole = PieceSplitter(motions).counts.sum()
    for middle in motions.end[[2, 40, -1]]:
        grid = Grid(middle[0] - 2.5, middle[1] - 2.5, 5 / 200, 200, 200)
        window = SweepWindow(grid.box, np.full(len(motions), CUTTERS[cutter].radius))
        assert PieceSplitter(motions, window=window).counts.sum() < 0.3 * whole
        done = cut(stock.over(grid), motions, CUTTERS[cutter], TrimOptions(trace=True))
        with monkeypatch.context() as patch:
            patch.setattr(SweepWindow, "misses", lambda self, rows, low, high: np.zeros(len(rows), bool))
            every = cut(stock.over(grid), motions, CUTTERS[cutter], TrimOptions(trace=True))
        assert done.heights.min() < -1
        assert np.array_equal(done.heights, every.heights)
        assert done.owner is not None
        assert np.array_equal(done.owner, every.owner)
        assert np.array_equal(done.volume, every.volume)


@pytest.mark.parametrize("chord", [1e-5, 1e-3, 0.05])
def test_chords_are_as_near_as_the_caller_wants(chord: float) -> None:
    for motions, along_it in [
        *((curve, lambda t, c=curve: arc_paths(c).points(t)[0]) for curve in CURVES.values()),
        (spline_motion(QUARTER), along(QUARTER)),
        (spline_motion(HEAVY), along(HEAVY)),
    ]:
        pieces = PieceSplitter(motions, arcs_stay=False, chord=chord).pieces(0, 1)
        assert 0.05 * chord < from_chords(pieces, along_it(np.linspace(0, 1, 3001))).max() <= chord
        assert len(pieces) < len(PieceSplitter(motions, arcs_stay=False).pieces(0, 1))


def test_many_pieces_made_in_bands_are_those_of_each_motion_alone() -> None:
    turns = [arc((4 + k, 0, 0), (4 + k, 0, -6), (k, 0, 0), turns=3, ccw=bool(k % 2)) for k in range(4)]
    level = [arc((k, 1, -2), (k, -2.5, -2), (k, 0, -2), ccw=bool(k % 2)) for k in range(3)]
    motions = joined([*turns, polyline([(0, 0, 0), (9, 9, 0)]), *level, CURVES["G18"], CURVES["widening"]])
    splitter = PieceSplitter(motions)
    whole, alone = splitter.pieces(0, len(motions)), [splitter.pieces(k, k + 1) for k in range(len(motions))]
    assert len(whole) > 20_000
    for name in ("start", "end", "motion"):
        assert np.array_equal(getattr(whole, name), np.concatenate([getattr(each, name) for each in alone]))
    assert np.array_equal(whole.arcs, np.concatenate([each.arcs for each in alone]))
    assert np.array_equal(whole.arc[whole.arc >= 0], np.arange(len(whole.arcs)))
