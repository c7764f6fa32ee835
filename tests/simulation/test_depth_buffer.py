"""The published method against the engine of record, and against brute force; what happens without its parts.

Between which heights its own must lie is said by two other cutters: one slimmer and higher by all that facets, chords,
overlaps and rounding may leave, one wider and deeper by what chords and rounding may take. So cells beside walls need
no exception.
"""

import threading
from dataclasses import replace

import moderngl
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from app.core.errors import Cancelled, HitofudeError, ParameterError
from app.core.progress import Progress
from app.model.motion import Floats, MotionKind, Motions
from app.model.stock_box import StockBox
from app.simulation.cutter import Cutter
from app.simulation.field.workpiece import BoxStock, Grid, Heights, HeightStock, Workpiece, lowest_nearby
from app.simulation.gpu import depth_buffer
from app.simulation.gpu.depth_buffer import DepthBuffer, usual
from app.simulation.gpu.polyhedron import facet_error
from app.simulation.gpu.wedges import CHORD_SHARE, FacetSide, Tessellation
from app.simulation.sweeps.course import Course
from app.simulation.sweeps.trim import trim
from tests.examples import examples
from tests.simulation.courses import CUTTERS, box_piece, cells_of, course_of, cut, joined, motions_of, polyline
from tests.simulation.reference import field
from tests.simulation.test_pieces import SPLINES, spline_motion
from tests.simulation.test_sweep import ARCS, REDUCED, WALKS, lines, walk

SUBPIXEL = 1 / 256
SHARP = np.array([[-6.03, -5.02, -3], [4.01, -5.02, -4], [4.01, 5.03, -3], [-6.03, 5.03, -7], [-6.03, -5.02, 1.0]])


@pytest.fixture(scope="module")
def context() -> moderngl.Context:
    from app.simulation.gpu.graphics import standalone_context

    try:
        return standalone_context()
    except HitofudeError as reason:
        pytest.skip(str(reason))


def drawn(
    context: moderngl.Context,
    piece: Workpiece,
    course: Course | Motions,
    cutters: dict[int, Cutter] | Cutter,
    how: Tessellation | None = None,
) -> Heights:
    with context:
        engine = DepthBuffer(context, how)
        heights = engine.heights(
            piece,
            course if isinstance(course, Course) else course_of(course),
            cutters if isinstance(cutters, dict) else {1: cutters},
        )
        engine.release()
    return heights


def allowed(cutter: Cutter, pitch: float, facet: float) -> tuple[Cutter, Cutter]:
    """The cutters between which the method lies; the facet of a wall seen on edge, which may give any of its heights,
    is as wide as twice the error.
    """
    error = facet_error(cutter, facet)
    more, less = (
        error * (1 + CHORD_SHARE) + pitch**2 / (2 * cutter.radius) + pitch * SUBPIXEL,
        2 * error + pitch * SUBPIXEL,
    )
    slim, wide = cutter.shrunk(more), cutter.grown(less)
    assert slim is not None
    deeper = error * CHORD_SHARE + pitch * SUBPIXEL
    return replace(slim, lift=slim.lift + more), replace(wide, lift=wide.lift - deeper)


def astray(got: Heights, piece: Workpiece, motions: Motions, cutter: Cutter, facet: float | None = None) -> int:
    """How many cells lie where neither a slimmer nor a wider cutter explains them."""
    return int(np.count_nonzero(stray(got, piece, motions, cutter, facet)))


def stray(
    got: Heights, piece: Workpiece, motions: Motions, cutter: Cutter, facet: float | None = None
) -> NDArray[np.bool_]:
    """Which cells do."""
    slim, wide = allowed(cutter, piece.grid.pitch, facet or 2 * piece.grid.pitch)
    above, below = cut(piece, motions, slim).heights, cut(piece, motions, wide).heights
    assert np.all(got <= piece.heights)
    assert got.min() >= np.float32(piece.floor)
    return np.asarray((got > above + 2e-5) | (got < below - 2e-5))


SCENES = {
    **{name: polyline(places) for name, places in (WALKS | REDUCED).items()},
    **ARCS,
    **{f"spline, {name}": spline_motion(curve) for name, curve in SPLINES.items()},
}


@pytest.mark.parametrize("cutter", CUTTERS)
@pytest.mark.parametrize("scene", SCENES)
def test_heights_are_within_what_is_stated(context: moderngl.Context, scene: str, cutter: str) -> None:
    piece = box_piece(cells=290)
    got = drawn(context, piece, SCENES[scene], CUTTERS[cutter])
    assert astray(got, piece, SCENES[scene], CUTTERS[cutter]) == 0
    assert got.min() < -0.2


def winding(seed: int, count: int, step: float, bend: float, steep: float) -> Floats:
    """A way without a goal; where it leaves the plate it turns back."""
    rng = np.random.default_rng(seed)
    bearing, tilt = (np.cumsum(rng.normal(size=count) * bend) for _ in range(2))
    places = np.cumsum(np.column_stack([np.cos(bearing), np.sin(bearing), np.tan(steep * np.sin(tilt))]) * step, axis=0)
    places[:, :2] = np.abs((places[:, :2] + 40) % 160 - 80) - 40
    places[:, 2] = -8 + 6 * np.sin(places[:, 2] / 6)
    return places


@pytest.mark.parametrize("cutter", ["ball", "bull", "flat", "v"])
@pytest.mark.parametrize("steep", [0.0, 0.9, 1.5])
def test_nothing_stays_open_at_thousands_of_corners(context: moderngl.Context, steep: float, cutter: str) -> None:
    """Nor does a facet that is seen on edge gouge, but for a cell in a million on a wall, which has a height of those
    beside it.
    """
    piece = box_piece(size=100, cells=1500)
    for seed, (step, bend) in enumerate(((0.5, 0.01), (0.33, 0.0057), (0.05, 0.02), (2.0, 0.05))):
        motions = polyline(winding(seed, 2000, step, bend, steep))
        got = drawn(context, piece, motions, CUTTERS[cutter])
        lost = stray(got, piece, motions, CUTTERS[cutter])
        assert np.count_nonzero(lost) <= 1
        record = cut(piece, motions, CUTTERS[cutter]).heights
        assert np.all((got >= lowest_nearby(record)) & (got <= -lowest_nearby(-record)), where=lost)


def test_overlaps_close_what_rounding_would_leave_open(context: moderngl.Context) -> None:
    """A way as steep as 85 degrees on which, without them, one cell of 2 million stays as it was."""
    piece, motions = box_piece(size=100, cells=1500), polyline(winding(105, 3000, 0.33, 0.006, 1.5))
    assert astray(drawn(context, piece, motions, CUTTERS["ball"]), piece, motions, CUTTERS["ball"]) == 0


def test_the_error_of_a_level_pass_is_two_thirds_of_the_sagitta_on_average(context: moderngl.Context) -> None:
    piece = box_piece(size=4, cells=400)
    motions, ball = polyline([(-30, 0.0013, -3), (30, 0.0013, -3)]), CUTTERS["ball"]
    for facet in (0.2, 0.4):
        over = drawn(context, piece, motions, ball, Tessellation(facet)) - cut(piece, motions, ball).heights.astype(
            float
        )
        middle = over[150:250]
        sagitta = facet_error(ball, facet) / 2
        assert middle.min() > -2e-5
        assert middle.mean() == pytest.approx(2 / 3 * sagitta, rel=0.15)
        assert middle.max() <= 1.05 * sagitta


@pytest.mark.parametrize("cutter", ["ball", "bull", "flat", "v"])
def test_without_wedges_corners_stay_open(context: moderngl.Context, cutter: str) -> None:
    piece, motions = box_piece(cells=290), polyline(SHARP)
    whole, open_ = (
        drawn(context, piece, motions, CUTTERS[cutter], replace(usual(piece.grid), wedges=wedges))
        for wedges in (True, False)
    )
    assert astray(whole, piece, motions, CUTTERS[cutter]) == 0
    left = np.argwhere(open_ > whole + 0.5)
    assert len(left) > 50
    places = np.column_stack([piece.grid.xs()[left[:, 1]], piece.grid.ys()[left[:, 0]]])
    reach = np.min(np.linalg.norm(places[:, None] - SHARP[None, 1:-1, :2], axis=2), axis=1)
    assert reach.max() < 1.01 * CUTTERS[cutter].radius


def test_on_a_smooth_path_too_wedges_are_missed(context: moderngl.Context) -> None:
    piece, motions = (
        box_piece(cells=600),
        polyline([(8 * np.cos(a), 8 * np.sin(a), -3 - a / 4) for a in np.arange(0, 6.0, 0.05)]),
    )
    how = usual(piece.grid)
    assert astray(drawn(context, piece, motions, CUTTERS["ball"]), piece, motions, CUTTERS["ball"]) == 0
    assert (
        astray(
            drawn(context, piece, motions, CUTTERS["ball"], replace(how, wedges=False)), piece, motions, CUTTERS["ball"]
        )
        > 20
    )


def test_facets_of_the_wrong_side_leave_all_the_metal_under_the_ball(context: moderngl.Context) -> None:
    piece, motions = box_piece(cells=290), polyline(SHARP)
    how = usual(piece.grid)
    down, up, both = (
        drawn(context, piece, motions, CUTTERS["ball"], replace(how, side=side))
        for side in (FacetSide.DOWN, FacetSide.UP, FacetSide.BOTH)
    )
    assert astray(down, piece, motions, CUTTERS["ball"]) == 0
    assert astray(up, piece, motions, CUTTERS["ball"]) > 1000
    assert np.count_nonzero(up > down + 1) > 1000
    assert np.array_equal(both, down)


@pytest.mark.parametrize("cutter", CUTTERS)
def test_brute_force_agrees(context: moderngl.Context, cutter: str) -> None:
    piece, places = box_piece(cells=48), walk(2, 12, 2.0, 1.5)
    facet = 0.1
    got = drawn(context, piece, polyline(places), CUTTERS[cutter], Tessellation(facet)).ravel()
    touched = np.flatnonzero(got < 0)
    chosen = touched[:: max(1, len(touched) // 60)]
    slim, wide = allowed(CUTTERS[cutter], piece.grid.pitch, facet)
    above, below = (
        field([(tool, path) for path in lines(places + [0, 0, tool.lift])], cells_of(piece)[chosen], 0.0, piece.floor)
        for tool in (slim, wide)
    )
    assert len(chosen) > 50
    assert np.all((got[chosen] <= above + 2e-5) & (got[chosen] >= below - 2e-5))


def two_tools() -> tuple[Course, dict[int, Cutter]]:
    """A way cut by two tools by turns, with a rapid through metal, a motion that is left out, and a dwell."""
    places = walk(3, 14, 1.5, 0.5)
    rapid = motions_of(places[-1:], places[-1:] + [3, 0, -2], MotionKind.RAPID)
    dwell = polyline([(5.01, -7.02, -4), (5.01, -7.02, -4)])
    motions = joined([polyline(places[:8]), polyline(places[7:]), rapid, polyline([(0, 0, -9), (4, 4, -9)]), dwell])
    tool = np.where(np.arange(len(motions)) < 7, 3, 8).astype(np.int32)
    return Course(motions, tool, (len(motions) - 2,)), {3: CUTTERS["bull"], 8: CUTTERS["ball"]}


def test_tools_rapids_what_is_left_out_and_a_dwell(context: moderngl.Context) -> None:
    course, cutters = two_tools()
    piece = box_piece(cells=290)
    got, pitch = drawn(context, piece, course, cutters), piece.grid.pitch
    bounds = {number: allowed(cutter, pitch, 2 * pitch) for number, cutter in cutters.items()}
    above, below = (trim(piece, course, {number: both[k] for number, both in bounds.items()}).heights for k in (0, 1))
    assert np.all((got <= above + 2e-5) & (got >= below - 2e-5))
    assert got[int((-7.02 + 10) / pitch), int((5.01 + 10) / pitch)] < -3.9
    without = drawn(
        context, piece, Course(course.motions, course.tool, (*course.left_out, len(course.motions) - 1)), cutters
    )
    assert np.count_nonzero(without > got + 0.1) > 100


@pytest.mark.parametrize("way", ["nothing", "only rapids"])
def test_what_does_not_cut_leaves_the_piece(context: moderngl.Context, way: str) -> None:
    piece = box_piece(cells=20)
    motions = (
        Motions.none()
        if way == "nothing"
        else motions_of(np.array([[0, 0, 0.0]]), np.array([[5, 0, -5.0]]), MotionKind.RAPID)
    )
    assert np.array_equal(drawn(context, piece, motions, CUTTERS["ball"]), piece.heights)


def test_nothing_is_cut_below_the_floor_nor_above_the_metal(context: moderngl.Context) -> None:
    piece = box_piece(cells=200, depth=2.0)
    deep = polyline([(-7, 0.013, 3.0), (-2, 0.013, -40.0), (6, 0.013, -1.0)])
    first = drawn(context, piece, deep, CUTTERS["ball"])
    assert first.min() == -2
    assert astray(first, piece, deep, CUTTERS["ball"]) == 0
    left = HeightStock(replace(piece, heights=first)).over(piece.grid)
    shallow = polyline([(-9, 3, -0.5), (9, -3, -0.5)])
    assert astray(drawn(context, left, shallow, CUTTERS["flat"]), left, shallow, CUTTERS["flat"]) == 0


def test_large_grids_are_drawn_in_parts(context: moderngl.Context, monkeypatch: pytest.MonkeyPatch) -> None:
    grid = Grid(-10.0, -9.0, 0.1, 181, 200)
    piece, motions = BoxStock(StockBox(-10, -9, -30, 10, 9)).over(grid), polyline(WALKS["gentle walk"])
    whole = drawn(context, piece, motions, CUTTERS["ball"])
    monkeypatch.setattr(depth_buffer, "MOST_CELLS", 64)
    parts = drawn(context, piece, motions, CUTTERS["ball"])
    assert whole.min() < -5
    assert np.mean(np.abs(whole - parts) > 0.01) < 2e-4
    assert astray(parts, piece, motions, CUTTERS["ball"]) == 0


def test_a_window_has_facets_of_its_own(context: moderngl.Context) -> None:
    stock, motions = BoxStock(StockBox(-10, -10, -30, 10, 10)), polyline(walk(41, 120, 0.8, 0.5))
    window = stock.over(Grid(-1.0, -1.5, 0.005, 300, 250))
    for cutter in ("ball", "bull"):
        assert astray(drawn(context, window, motions, CUTTERS[cutter]), window, motions, CUTTERS[cutter]) == 0


def test_a_tool_that_nobody_knows_and_facets_that_are_none(context: moderngl.Context) -> None:
    piece, motions = box_piece(cells=20), polyline([(0, 0, 0), (5, 0, -5)])
    with pytest.raises(ParameterError, match="T1 cuts from line 1 on, but nobody has said what it is"):
        drawn(context, piece, motions, {2: CUTTERS["ball"]})
    with pytest.raises(ParameterError, match="larger than 0"):
        drawn(context, piece, motions, CUTTERS["ball"], Tessellation(0.0))
    with pytest.raises(ParameterError, match="too small"):
        drawn(context, piece, motions, CUTTERS["flat"], Tessellation(1e-5))


@pytest.mark.exhaustive
def test_it_tells_how_far_it_is_and_stops_when_asked(context: moderngl.Context) -> None:
    piece, course, told = box_piece(cells=100), course_of(polyline(walk(5, 400, 0.8, 1.0))), []
    stop = threading.Event()
    with context:
        engine = DepthBuffer(context, Tessellation(0.02))
        engine.heights(piece, course, {1: CUTTERS["ball"]}, Progress(lambda share, _: told.append(share)))
        stop.set()
        with pytest.raises(Cancelled):
            engine.heights(piece, course, {1: CUTTERS["ball"]}, Progress(cancelled=stop))
        engine.release()
    assert len(told) > 3
    assert told == sorted(told)
    assert told[-1] == 1.0


place = st.tuples(st.floats(-8, 8), st.floats(-8, 8), st.floats(-9, 1))


@settings(max_examples=examples(40), deadline=None)
@given(corners=st.lists(place, min_size=2, max_size=8), cutter=st.sampled_from(sorted(CUTTERS)))
def test_any_polyline(context: moderngl.Context, corners: list[tuple[float, float, float]], cutter: str) -> None:
    piece, motions = box_piece(cells=150), polyline([*corners, corners[-2], corners[-2]])
    assert astray(drawn(context, piece, motions, CUTTERS[cutter]), piece, motions, CUTTERS[cutter]) == 0
