"""Heights by graphics hardware against the engine of record and against brute force; a real OpenGL context draws
them.
"""

import threading
from collections.abc import Iterator, Mapping
from dataclasses import replace

import moderngl
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.ndimage import maximum_filter, minimum_filter

from app.core.errors import Cancelled, ParameterError
from app.core.progress import Progress
from app.model.motion import Floats, MotionKind, Motions, Plane
from app.model.stock_box import StockBox
from app.simulation.cutter import Cutter
from app.simulation.field.workpiece import BoxStock, Grid, Heights, HeightStock, Workpiece, height_difference
from app.simulation.gpu.graphics import standalone_context
from app.simulation.gpu.quads import quad_heights
from app.simulation.sweeps.course import Course
from app.simulation.sweeps.trim import trim
from tests.examples import examples
from tests.simulation.courses import CUTTERS, arc, box_piece, cells_of, course_of, joined, motions_of, polyline
from tests.simulation.reference import field, slopes
from tests.simulation.test_sweep import PLUNGES, REDUCED, WALKS, lines, walk


@pytest.fixture(scope="module")
def ctx() -> Iterator[moderngl.Context]:
    context = standalone_context()
    yield context
    context.release()


def drawn(ctx: moderngl.Context, piece: Workpiece, course: Course, cutters: Mapping[int, Cutter]) -> Heights:
    with ctx:
        heights = quad_heights(ctx, piece, course, cutters)
    assert np.all(heights <= piece.heights) and np.all(heights >= np.float32(piece.floor))
    return heights


def agree(
    ctx: moderngl.Context, piece: Workpiece, course: Course, cutters: Mapping[int, Cutter], rims: float = 1e-3
) -> Heights:
    """Compare with the engine of record: within 1e-4 mm, but for few cells that lie on walls."""
    want, got = trim(piece, course, cutters).heights, drawn(ctx, piece, course, cutters)
    found = height_difference(want, got)
    steps = maximum_filter(want, 3) - minimum_filter(want, 3)
    assert found.agrees and found.rims <= 2 + rims * want.size, found
    assert np.abs(want - got)[steps < piece.grid.pitch].max(initial=0) < 1e-4
    assert want.min() < piece.heights.max()
    return got


@pytest.mark.parametrize("cutter", CUTTERS)
@pytest.mark.parametrize("name", REDUCED)
def test_chains_agree_with_the_engine_of_record(ctx: moderngl.Context, name: str, cutter: str) -> None:
    agree(ctx, box_piece(cells=290), course_of(polyline(REDUCED[name])), {1: CUTTERS[cutter]})


ARCS = joined(
    [
        arc((5, 0, -3), (5, 0, -4), (0, 0, -3), turns=2),
        arc((2, 0, -5), (2, 0, -5), (0, 0, -5)),
        arc((0.4, 0.1, -6), (0.2, 0.3, -6), (0.2, 0.1, -6)),
        arc((-6, 3, -2), (-3, 6, -2), (-3, 3, -2), ccw=False),
        arc((-200, -9, -7), (0, 191, -7), (-200, 191, -7)),
        arc((7, -6, -2), (6, -7, -2), (6, -6, -2)),
        arc((-7, -7, -1), (-3, -7, -1), (-5, -7, -1), Plane.ZX),
    ]
)


@pytest.mark.parametrize("cutter", CUTTERS)
def test_arcs_of_every_size_agree_with_the_engine_of_record(ctx: moderngl.Context, cutter: str) -> None:
    agree(ctx, box_piece(cells=290), course_of(ARCS), {1: CUTTERS[cutter]})


@pytest.mark.parametrize("radius", [1.0, 40.0, 4_000.0, 4e6])
def test_a_wide_arc_is_exact_all_along(ctx: moderngl.Context, radius: float) -> None:
    """A ball round a quarter, or as much of it as meets the stock, 300 mm wide."""
    piece = BoxStock(StockBox(0, 0, -20, 300, 300)).over(Grid.over((0, 0, 300, 300), 512))
    motions = arc((150, 150, -2), (150 - radius, 150 + radius, -2), (150 - radius, 150, -2))
    got = drawn(ctx, piece, course_of(motions), {1: Cutter(5, 0, 5)})
    x, y = cells_of(piece).T
    far = np.hypot(x - (150 - radius), y - 150) - radius
    on = (y > 150) & (x > 150 - radius) & (np.abs(far) < 4.99)
    assert on.sum() > 50
    assert np.abs(got.ravel() - np.minimum(3 - np.sqrt(np.maximum(25 - far**2, 0)), 0))[on].max() < 2e-5


@pytest.mark.parametrize("cutter", CUTTERS)
@pytest.mark.parametrize("name", ["plunges", *WALKS])
def test_heights_are_those_of_brute_force(ctx: moderngl.Context, name: str, cutter: str) -> None:
    places = PLUNGES if name == "plunges" else WALKS[name]
    piece, paths = box_piece(cells=64), lines(places)
    got, cells = drawn(ctx, piece, course_of(polyline(places)), {1: CUTTERS[cutter]}).ravel(), cells_of(piece)
    chosen = np.random.default_rng(3).permutation(len(cells))[:120]
    moves = [(CUTTERS[cutter], path) for path in paths]
    want = field(moves, cells[chosen], 0.0, piece.floor)
    steep = slopes(moves, cells[chosen], want, 0.0, piece.floor)
    assert np.mean(steep > 50) < 0.2
    assert (np.abs(got[chosen] - want) / (1e-5 * (1 + steep)))[steep <= 50].max() < 1


place = st.tuples(st.floats(-8, 8), st.floats(-8, 8), st.floats(-9, 1))


@settings(max_examples=examples(40), deadline=None)
@given(st.lists(place, min_size=2, max_size=7), st.sampled_from(sorted(CUTTERS)))
def test_any_polyline_agrees(ctx: moderngl.Context, places: list[tuple[float, float, float]], cutter: str) -> None:
    piece, course = box_piece(cells=64), course_of(polyline(places))
    assert height_difference(
        trim(piece, course, {1: CUTTERS[cutter]}).heights, drawn(ctx, piece, course, {1: CUTTERS[cutter]})
    ).agrees


def far_away(motions: Motions, by: Floats) -> Motions:
    return replace(motions, start=motions.start + by, end=motions.end + by, centre=motions.centre + by)


@pytest.mark.parametrize("cutter", CUTTERS)
def test_large_stock_far_from_the_zero(ctx: moderngl.Context, cutter: str) -> None:
    """300 mm at X 5000, with ways as long as the stock and longer, and steep ones."""
    places = np.array(
        [
            [-400, -120, -3],
            [420, 130, -6.5],
            [-140, 140, -8],
            [-140, -140, -2],
            [140, -139, -30],
            [141, -138, 8],
            [30, 20, -9.0],
        ]
    )
    by, box = np.array([5000.0, -3000, 0]), (4850.0, -3150.0, 5150.0, -2850.0)
    motions = far_away(joined([polyline(places), arc((100, 0, -4), (-100, 0, -4), (0, 0, -4))]), by)
    piece = BoxStock(StockBox(*box[:2], -40, *box[2:], 0)).over(Grid.over(box, 1024))
    thick = CUTTERS[cutter]
    agree(ctx, piece, course_of(motions), {1: thick})


@pytest.mark.parametrize("cutter", ["ball", "bull", "flat"])
@pytest.mark.parametrize("pitch", [1e-3, 0.02])
def test_small_windows_of_long_ways(ctx: moderngl.Context, cutter: str, pitch: float) -> None:
    motions = joined(
        [
            polyline([(-400, -3, -2), (500, 3, -3.1), (0.1, 0.3, -3)]),
            arc((50, 0, -2.5), (-50, 0, -2.5), (0, 0, -2.5)),
            arc((0, -50, -2.9), (50, 0, -2.9), (0, 0, -2.9)),
        ]
    )
    stock = BoxStock(StockBox(-100, -100, -30, 100, 100))
    for x, y in ((2.0, 0.4), (-49, 6), (34, -35)):
        agree(ctx, stock.over(Grid(x, y, pitch, 200, 256)), course_of(motions), {1: CUTTERS[cutter]}, 0.01)


def test_several_tools_rapids_and_what_is_left_out(ctx: moderngl.Context) -> None:
    chains = [polyline(walk(k, 60, 0.7, 0.6)) for k in range(len(CUTTERS))]
    rapid = motions_of(np.array([[-9, -9, -9.0]]), np.array([[9, 9, -9.0]]), MotionKind.RAPID)
    motions = joined([*chains, rapid, polyline([(9, -9, -9), (-9, 9, -9)]), ARCS])
    tool = np.repeat(np.arange(1, len(chains) + 1), 59)
    tool = np.concatenate([tool, np.full(2, 2), np.full(len(ARCS), 3)]).astype(np.int32)
    cutters = dict(enumerate(CUTTERS.values(), 1))
    course = Course(motions, tool, (len(chains) * 59 + 1,))
    got = agree(ctx, box_piece(cells=300), course, cutters)
    assert np.all(drawn(ctx, box_piece(cells=300), Course(motions, tool), cutters) <= got)
    assert not np.array_equal(drawn(ctx, box_piece(cells=300), Course(motions, tool), cutters), got)


def test_what_an_earlier_program_has_left(ctx: moderngl.Context) -> None:
    first = trim(box_piece(cells=100), course_of(polyline(walk(1, 50, 1.0, 0.5))), {1: CUTTERS["ball"]}).workpiece
    second, cutters = course_of(polyline([(0, -5, -3), (0, 5, -9)])), {1: CUTTERS["bull"]}
    got = agree(ctx, HeightStock(first).over(first.grid), second, cutters)
    alone = drawn(ctx, box_piece(cells=100), second, cutters)
    assert np.abs(got - np.minimum(first.heights, alone)).max() < 1e-4, "the lower of what either cuts"
    assert (got < first.heights).any() and (got < alone).any()


def test_many_pieces_and_pictures(ctx: moderngl.Context, monkeypatch: pytest.MonkeyPatch) -> None:
    """Batches and tiles change nothing but rounding."""
    motions = joined([polyline(walk(51, 300, 0.8, 0.5)), ARCS])
    whole = drawn(ctx, box_piece(cells=300), course_of(motions), {1: CUTTERS["ball"]})
    monkeypatch.setattr("app.simulation.gpu.quads.LARGEST", 70)
    monkeypatch.setattr("app.simulation.gpu.quads.PORTION", 41)
    monkeypatch.setattr("app.simulation.gpu.quads.WORK", 1e4)
    parts = drawn(ctx, box_piece(cells=300), course_of(motions), {1: CUTTERS["ball"]})
    assert height_difference(whole, parts).agrees and height_difference(whole, parts).cells < 10


def test_nothing_to_do_and_nothing_below_the_floor(ctx: moderngl.Context) -> None:
    piece = box_piece(cells=40, depth=2.0)
    none = course_of(motions_of(np.zeros((0, 3)), np.zeros((0, 3))))
    assert np.array_equal(drawn(ctx, piece, none, {}), piece.heights)
    assert np.array_equal(
        drawn(ctx, piece, course_of(polyline([(90, 0, -1), (99, 0, -1)])), {1: CUTTERS["ball"]}), piece.heights
    )
    assert drawn(ctx, piece, course_of(polyline([(0, 0, 5), (0, 0, -7)])), {1: CUTTERS["flat"]}).min() == -2


def assert_adds(ctx: moderngl.Context) -> None:
    """Blending does what it does in a new context."""
    brush = ctx.program(
        vertex_shader="""#version 330
        void main() { gl_Position = vec4(gl_VertexID % 2 * 4 - 1, gl_VertexID / 2 * 4 - 1, 0, 1); }""",
        fragment_shader="#version 330\nout float told; void main() { told = 2.0; }",
    )
    target = ctx.framebuffer([ctx.texture((1, 1), 1, np.full(1, 3, np.float32), dtype="f4")])
    with ctx.scope(target, enable_only=ctx.BLEND):
        ctx.blend_func = ctx.ONE, ctx.ONE
        ctx.vertex_array(brush, []).render(ctx.TRIANGLES, vertices=3)
        ctx.blend_func = ctx.DEFAULT_BLENDING
        assert np.frombuffer(target.read(components=1, dtype="f4"), np.float32)[0] == 5


def test_a_context_is_left_as_it_was(ctx: moderngl.Context) -> None:
    with ctx:
        target = ctx.simple_framebuffer((4, 4))
        target.use()
        quad_heights(ctx, box_piece(), course_of(polyline([(0, 0, -1), (1, 0, -1)])), {1: CUTTERS["ball"]})
        assert ctx.fbo is target and ctx.error == "GL_NO_ERROR"
        assert_adds(ctx)


def test_a_job_stops_when_asked_and_tells_how_far_it_is(ctx: moderngl.Context) -> None:
    told: list[float] = []
    stop = threading.Event()
    course, cutters = course_of(polyline(walk(61, 50, 1.0, 0.5))), {1: CUTTERS["ball"]}
    with ctx:
        quad_heights(ctx, box_piece(), course, cutters, Progress(lambda fraction, text: told.append(fraction)))
        assert told == sorted(told) and told[-1] == 1.0
        stop.set()
        with pytest.raises(Cancelled):
            quad_heights(ctx, box_piece(), course, cutters, Progress(cancelled=stop))
        assert_adds(ctx)
        with pytest.raises(ParameterError, match=r"T1 cuts from line 1 on"):
            quad_heights(ctx, box_piece(), course, {})
