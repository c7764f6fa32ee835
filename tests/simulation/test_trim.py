"""Closed forms, what a cut tells beside its heights, windows, and how a job stops."""

import threading

import numpy as np
import pytest

from app.core.errors import Cancelled, ParameterError
from app.core.progress import Progress
from app.model.motion import MotionKind, Plane
from app.model.stock_box import StockBox
from app.simulation.cutter import Cutter
from app.simulation.field.workpiece import BoxStock, Grid, HeightStock
from app.simulation.sweeps.course import Course, Rapids, TrimOptions
from app.simulation.sweeps.trim import trim
from tests.simulation.courses import CUTTERS, arc, box_piece, cells_of, course_of, cut, joined, motions_of, polyline
from tests.simulation.test_sweep import differ, walk

TRACED = TrimOptions(trace=True)


@pytest.mark.parametrize("name", CUTTERS)
def test_a_plunge_leaves_the_profile(name: str) -> None:
    piece, cutter = box_piece(cells=100), CUTTERS[name]
    heights = cut(piece, polyline([(0.013, 0, 5), (0.013, 0, -2.5)]), cutter).heights
    radius = np.hypot(*(cells_of(piece) - [0.013, 0]).T).reshape(heights.shape)
    want = np.minimum(-2.5 + cutter.heights(radius), 0.0)
    assert np.abs(heights - want)[np.abs(radius - cutter.radius) > 1e-5].max() < 2e-6


def test_a_slot_of_a_flat_mill_is_a_stadium() -> None:
    piece = box_piece(cells=128)
    heights = cut(piece, polyline([(-4, 0.01, -2), (5, 0.01, -2)]), CUTTERS["flat"]).heights
    x, y = cells_of(piece).T
    inside = np.hypot(x - np.clip(x, -4, 5), y - 0.01) < 3
    assert np.array_equal(heights.ravel(), np.where(inside, np.float32(-2), np.float32(0)))


def test_a_ramp_of_a_ball_is_a_cylinder() -> None:
    piece = box_piece(cells=128)
    heights = cut(piece, polyline([(-30, 0, -9), (30, 0, 3)]), CUTTERS["ball"]).heights
    x, y = cells_of(piece).T
    with np.errstate(invalid="ignore"):
        ramp = -3 + 0.2 * x + 3 - np.sqrt(1 + 0.2**2) * np.sqrt(9 - y**2)
    want = np.where(np.abs(y) < 3, np.minimum(ramp, 0), 0).reshape(heights.shape)
    assert np.abs(heights - want)[np.abs(np.abs(y) - 3).reshape(heights.shape) > 0.1].max() < 3e-6


def test_a_ramp_of_a_flat_mill_is_cut_by_its_rear_rim() -> None:
    piece = box_piece(cells=128)
    heights = cut(piece, polyline([(-30, 0, -9), (30, 0, 3)]), CUTTERS["flat"]).heights
    x, y = cells_of(piece).T
    with np.errstate(invalid="ignore"):
        ramp = -3 + 0.2 * (x - np.sqrt(9 - y**2))
    want = np.where(np.abs(y) < 3, np.minimum(ramp, 0), 0).reshape(heights.shape)
    assert np.abs(heights - want)[np.abs(np.abs(y) - 3).reshape(heights.shape) > 0.1].max() < 3e-6


def test_two_passes_leave_the_scallop() -> None:
    piece = box_piece(size=8, cells=801)
    heights = cut(
        piece, polyline([(-20, -0.5, -1), (20, -0.5, -1), (20, 0.5, -1), (-20, 0.5, -1)]), CUTTERS["ball"]
    ).heights
    assert heights[400, 400] + 1 == pytest.approx(3 - np.sqrt(3**2 - 0.5**2), abs=1e-6)


@pytest.mark.parametrize(("degrees", "tip"), [(30, 0.0), (50, 0.0959), (60, 0.3660), (75, 1.3660)])
def test_a_cone_on_a_plane(degrees: float, tip: float) -> None:
    """A cone of diameter 1 and 90 degrees that touches a plane through the origin stands at these heights: published
    figures.
    """
    cutter, slope = Cutter(0.5, slope=1.0), np.tan(np.radians(degrees))
    piece = box_piece(size=0.02, cells=1)
    steep = [(-1, 0, tip - slope), (1, 0, tip + slope)]
    assert cut(piece, polyline(steep), cutter).heights[0, 0] == pytest.approx(0, abs=1e-4 * (1 + slope))


def test_nothing_is_below_the_floor_and_volume_ends_there() -> None:
    piece = box_piece(cells=400, depth=2.0)
    done = cut(piece, polyline([(0.003, 0, 5), (0.003, 0, -7)]), CUTTERS["flat"], TRACED)
    assert done.heights.min() == -2
    assert done.volume.sum() == pytest.approx(done.removed_volume)
    assert done.removed_volume == pytest.approx(np.pi * 9 * 2, rel=0.01)


def test_each_motion_has_its_volume_and_each_cell_its_motion() -> None:
    piece = box_piece(cells=150)
    parts = [
        polyline(walk(21, 30, 0.8, 0.5)),
        arc((5, 0, -3), (5, 0, -4), (0, 0, -3), turns=2),
        arc((2, 0, -5), (2, 0, -5), (0, 0, -5)),
    ]
    motions = joined(parts)
    done = cut(piece, motions, CUTTERS["bull"], TRACED)
    assert done.owner is not None
    assert done.volume.sum() == pytest.approx(done.removed_volume, rel=1e-6)
    assert np.array_equal(done.owner >= 0, done.heights < piece.heights)
    current, engaged = piece, []
    for row in range(len(motions)):
        others = tuple(k for k in range(len(motions)) if k != row)
        alone = trim(current, Course(motions, np.ones(len(motions), np.int32), others), {1: CUTTERS["bull"]})
        engaged.append(int(np.count_nonzero(current.heights - alone.heights > 1e-5)))
        current = alone.workpiece
    assert np.abs(current.heights - done.heights).max() < 2e-5
    assert done.engaged == pytest.approx(engaged, abs=5)


def test_a_rapid_through_metal_is_found_placed_and_sized() -> None:
    piece = box_piece(cells=200)
    hole = polyline([(0, 0, 5), (0, 0, -3)])
    home = motions_of(np.array([[0, 0, -3.0], [0, 0, 5.0]]), np.array([[0, 0, 5.0], [6, 0, 5.0]]), MotionKind.RAPID)
    through = motions_of(np.array([[6, 0, 5.0], [6, 0, 0.0]]), np.array([[6, 0, 0.0], [6, 4, -0.25]]), MotionKind.RAPID)
    done = cut(piece, joined([hole, home, through]), CUTTERS["flat"])
    assert [hit.motion for hit in done.rapids] == [4]
    assert done.rapids[0].depth == pytest.approx(0.25, abs=1e-5)
    assert done.rapids[0].z == pytest.approx(-0.25, abs=1e-5)
    assert np.hypot(done.rapids[0].x - 6, done.rapids[0].y - 4) < 3
    assert np.array_equal(done.heights, cut(piece, hole, CUTTERS["flat"]).heights)
    assert cut(piece, through, CUTTERS["flat"], TrimOptions(Rapids.CUT)).heights.min() == pytest.approx(-0.25)
    assert not cut(piece, through, CUTTERS["flat"], TrimOptions(Rapids.IGNORED)).rapids


@pytest.mark.parametrize("name", CUTTERS)
def test_rapids_back_along_what_was_cut_meet_nothing(name: str) -> None:
    places = walk(31, 40, 1.0, 0.6)
    back = motions_of(places[::-1][:-1], places[::-1][1:], MotionKind.RAPID)
    assert not cut(box_piece(cells=300), joined([polyline(places), back]), CUTTERS[name]).rapids


@pytest.mark.parametrize("name", ["ball", "bull", "taper"])
def test_a_window_has_the_heights_of_the_whole(name: str) -> None:
    """Cells of the window lie on cells of the whole, each third."""
    places = walk(41, 120, 0.8, 0.5)
    motions = joined([polyline(places), arc(places[-1], places[-1], places[-1] + [2, 0, 0], Plane.XY)])
    stock = BoxStock(StockBox(-10, -10, -30, 10, 10))
    coarse = Grid.over(stock.box, 100)
    fine = Grid(-4 * 0.2, -5 * 0.2, 0.2 / 3, 90, 90)
    whole, window = (cut(stock.over(grid), motions, CUTTERS[name]).heights for grid in (coarse, fine))
    shared = whole[45 : 45 + 30, 46 : 46 + 30]
    steps = np.hypot(*np.gradient(shared.astype(float))) / 0.2
    apart = np.abs(window[1::3, 1::3] - shared)
    assert (apart <= 1e-5 * (1 + steps)).mean() > 0.995
    assert np.median(apart) < 2e-6


def test_cells_of_a_micrometre() -> None:
    """A window of a quarter of a millimetre on the ball's flank, far from the ends of the move."""
    stock = BoxStock(StockBox(-10, -10, -30, 10, 10))
    grid = Grid(2.5, 1.0, 1e-3, 256, 256)
    heights = cut(stock.over(grid), polyline([(-40, 0, -2), (50, 0, -2)]), CUTTERS["ball"]).heights
    want = np.broadcast_to(-2 + 3 - np.sqrt(9 - grid.ys()[:, None] ** 2), heights.shape)
    assert np.abs(heights - want).max() < 2e-6


def test_many_pieces_are_cut_in_parts(monkeypatch: pytest.MonkeyPatch) -> None:
    motions = joined([polyline(walk(51, 80, 0.8, 0.5)), arc((5, 0, -3), (5, 0, -4), (0, 0, -3))])
    whole = cut(box_piece(cells=300), motions, CUTTERS["ball"], TRACED)
    monkeypatch.setattr("app.simulation.sweeps.sweeps.BATCH", 25)
    parts = cut(box_piece(cells=300), motions, CUTTERS["ball"], TRACED)
    assert differ(whole.heights, parts.heights) == 0
    assert whole.owner is not None and parts.owner is not None
    assert np.mean(whole.owner != parts.owner) < 0.01
    assert parts.volume == pytest.approx(whole.volume, abs=1e-3)


def test_a_second_setup_begins_with_what_the_first_has_left() -> None:
    first = cut(box_piece(cells=100), polyline([(-5, 0, -2), (5, 0, -2)]), CUTTERS["ball"])
    again = HeightStock(first.workpiece).over(first.workpiece.grid)
    both = cut(again, polyline([(0, -5, -3), (0, 5, -3)]), CUTTERS["flat"])
    assert np.array_equal(
        both.heights,
        np.minimum(
            first.heights, cut(box_piece(cells=100), polyline([(0, -5, -3), (0, 5, -3)]), CUTTERS["flat"]).heights
        ),
    )


def test_a_tool_that_nobody_has_described_is_named_with_its_line() -> None:
    with pytest.raises(ParameterError, match=r"T1 cuts from line 1 on.*1=flat:6"):
        trim(box_piece(), course_of(polyline([(0, 0, 0), (1, 0, -1)])), {})
    rapid = motions_of(np.zeros((1, 3)), np.ones((1, 3)), MotionKind.RAPID)
    assert not trim(box_piece(), course_of(rapid), {}).rapids


def test_no_motion_cuts_nothing() -> None:
    piece = box_piece()
    assert np.array_equal(
        trim(piece, course_of(motions_of(np.zeros((0, 3)), np.zeros((0, 3)))), {}).heights, piece.heights
    )


def test_a_job_stops_when_asked_and_tells_how_far_it_is() -> None:
    told: list[float] = []
    cut_progress = Progress(lambda fraction, text: told.append(fraction))
    trim(box_piece(cells=300), course_of(polyline(walk(61, 50, 1.0, 0.5))), {1: CUTTERS["ball"]}, TRACED, cut_progress)
    assert told[-1] == 1.0
    stop = threading.Event()
    stop.set()
    with pytest.raises(Cancelled):
        trim(
            box_piece(cells=300),
            course_of(polyline(walk(61, 50, 1.0, 0.5))),
            {1: CUTTERS["ball"]},
            TRACED,
            Progress(cancelled=stop),
        )


def test_the_way_to_a_place_that_nobody_knows_cuts_nothing() -> None:
    """Before its first words for X and Y the machine stands anywhere, also inside the stock."""
    from dataclasses import replace

    motions = replace(polyline([(0, 0, 0), (0, 0, -5), (6, 6, -5)]), known_from=(1, 1, 0))
    heights = cut(box_piece(cells=100), motions, CUTTERS["flat"]).heights
    assert heights[50, 50] == 0
    assert heights.min() == -5
