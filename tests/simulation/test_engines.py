"""Which engine computes, and what happens when the graphics system is none, fails, or lies: liars are given, nothing is
replaced.
"""

from collections.abc import Callable

import moderngl
import numpy as np
import pytest

from app.core.errors import Cancelled, HitofudeError
from app.core.progress import Progress
from app.simulation.engines import (
    Compute,
    CutStep,
    Cutters,
    Engine,
    EngineReport,
    Graphics,
    HeightEngine,
    hardware,
    published_error,
    quads,
    trial_of,
)
from app.simulation.field.workpiece import TOLERANCE, Heights, Workpiece, height_difference
from app.simulation.gpu.graphics import is_software, standalone_context
from app.simulation.sweeps.course import Course
from app.simulation.sweeps.trim import trim
from app.simulation.trial import CUTTERS, trial, tried
from tests.simulation.courses import CUTTERS as KINDS
from tests.simulation.courses import box_piece, course_of, polyline
from tests.simulation.test_sweep import REDUCED, walk

JOB = CutStep(box_piece(cells=120), course_of(polyline(walk(4, 60, 0.9, 0.6))), {1: KINDS["ball"]})


def spoiled(spoil: Callable[[Heights], None]) -> Compute:
    """A way to compute whose heights are spoiled."""

    def compute(
        ctx: moderngl.Context, workpiece: Workpiece, course: Course, cutters: Cutters, progress: Progress
    ) -> Heights:
        heights = quads(ctx, workpiece, course, cutters, progress).copy()
        spoil(heights)
        return heights

    return compute


def shift(heights: Heights) -> None:
    heights -= np.float32(2e-4)


def one_cell(heights: Heights) -> None:
    heights[np.unravel_index(np.argmin(heights), heights.shape)] -= np.float32(1.0)


def nothing(heights: Heights) -> None:
    heights[:] = np.nan


def half_precision(heights: Heights) -> None:
    heights[:] = heights.astype(np.float16)


LIES = {"shifted": shift, "one cell": one_cell, "no numbers": nothing, "half precision": half_precision}


def fails(ctx: moderngl.Context, workpiece: Workpiece, course: Course, cutters: Cutters, progress: Progress) -> Heights:
    raise moderngl.Error("the context is lost")


def later(job: CutStep, compute: Compute) -> Compute:
    """A way to compute that is right but for one job: it passes the trial."""

    def chosen(
        ctx: moderngl.Context, workpiece: Workpiece, course: Course, cutters: Cutters, progress: Progress
    ) -> Heights:
        return (compute if workpiece is job[0] else quads)(ctx, workpiece, course, cutters, progress)

    return chosen


def test_the_trial_is_a_hard_one() -> None:
    """Every cutter and every arc takes metal of its own, and a cutter that is 2 µm thicker shows."""
    piece, course = trial()
    whole = trim(piece, course, CUTTERS).heights
    for row in np.flatnonzero(course.motions.kind > 1).tolist():
        without = trim(piece, Course(course.motions, course.tool, (row,)), CUTTERS).heights
        assert not height_difference(whole, without).agrees
    for number in CUTTERS:
        assert not height_difference(
            whole, trim(piece, course, CUTTERS | {number: CUTTERS[number].grown(2e-3)}).heights
        ).agrees
    assert tried(lambda *job: trim(*job).heights).agrees


def test_cells_on_walls_are_no_lies_unless_they_are_many() -> None:
    record = np.zeros((50, 50), np.float32)
    record[:, 20:] = -3
    other = record.copy()
    other[10:20, 20] = 0
    assert (
        height_difference(record, other).agrees,
        height_difference(record, other).rims,
        height_difference(record, other).cells,
    ) == (True, 10, 10)
    other[10:40, 20] = 0
    assert not height_difference(record, other).agrees
    other = record.copy()
    other[5, 5] = -1
    assert (height_difference(record, other).astray, height_difference(record, other).largest) == (1, 1)
    assert height_difference(record, record + np.float32(0.9 * TOLERANCE)).agrees


def test_a_sound_system_passes_and_its_heights_are_taken() -> None:
    found = trial_of(Graphics(), Engine.GPU)
    assert found.fault == "" and found.renderer
    assert hardware(Graphics(present=lambda: True)) is not is_software(found.renderer)
    record = trim(*JOB).heights
    engine = HeightEngine(Engine.GPU, Graphics())
    heights = engine.beside(record, JOB)
    assert heights is not record and engine.requested
    assert engine.report.engine is Engine.GPU and engine.report.renderer == found.renderer and not engine.report.fault
    assert (
        engine.report.difference == height_difference(record, heights) and engine.report.difference.largest < TOLERANCE
    )


def test_the_published_method_states_its_error() -> None:
    record = trim(*JOB).heights
    engine = HeightEngine(Engine.PATENT, Graphics())
    heights = engine.beside(record, JOB)
    assert engine.report.engine is Engine.PATENT and engine.report.error == published_error(*JOB) > 0
    facet = 2 * JOB[0].grid.pitch
    assert 0.8 * facet**2 / (8 * 3) <= engine.report.error <= facet**2 / (8 * 3)
    assert heights is not record and not np.array_equal(heights, record)


@pytest.mark.parametrize("cutter", KINDS)
def test_creases_and_walls_of_facets_are_no_faults(cutter: str) -> None:
    for name in ("rough walk", "sharp", "raster 30.0"):
        job = CutStep(box_piece(cells=290), course_of(polyline(REDUCED[name])), {1: KINDS[cutter]})
        engine = HeightEngine(Engine.PATENT, Graphics())
        engine.beside(trim(*job).heights, job)
        assert engine.report.engine is Engine.PATENT, engine.report.fault


def test_the_engine_of_record_needs_no_graphics_system() -> None:
    def opened() -> moderngl.Context:
        raise AssertionError("nobody asked for it")

    engine, record = HeightEngine(Engine.CPU, Graphics(opened)), trim(*JOB).heights
    assert engine.beside(record, JOB) is record
    assert engine.report == EngineReport(Engine.CPU)


@pytest.mark.parametrize("lie", LIES)
def test_a_system_that_lies_is_found_out_by_the_trial(lie: str) -> None:
    graphics = Graphics(quads=spoiled(LIES[lie]))
    assert "computes wrong heights, in a trial up to" in trial_of(graphics, Engine.GPU).fault
    assert not hardware(graphics)
    record = trim(*JOB).heights
    engine = HeightEngine(Engine.GPU, graphics)
    assert not engine.requested and engine.beside(record, JOB) is record
    assert engine.report == EngineReport(Engine.CPU, fault=trial_of(graphics, Engine.GPU).fault)


@pytest.mark.parametrize("lie", LIES)
def test_a_system_that_lies_later_is_found_out_beside_the_engine_of_record(lie: str) -> None:
    graphics, record = Graphics(quads=later(JOB, spoiled(LIES[lie]))), trim(*JOB).heights
    engine = HeightEngine(Engine.GPU, graphics)
    assert engine.requested
    assert engine.beside(record, JOB) is record
    assert (
        engine.report.engine is Engine.CPU and "in cells" not in engine.report.fault and "mm off" in engine.report.fault
    )
    assert not engine.requested


def test_a_system_that_breaks_is_not_tried_again() -> None:
    tries: list[int] = []

    def breaks(*job: object) -> Heights:
        tries.append(1)
        raise moderngl.Error("the context is lost")

    engine = HeightEngine(Engine.GPU, Graphics(quads=later(JOB, breaks)))
    record = trim(*JOB).heights
    assert engine.alone(JOB) is None
    assert "fails (the context is lost)" in engine.report.fault
    assert engine.beside(record, JOB) is record and len(tries) == 1
    assert "fails (the context is lost)" in trial_of(Graphics(quads=fails), Engine.GPU).fault


def test_no_graphics_system_at_all() -> None:
    def opened() -> moderngl.Context:
        raise HitofudeError("There is no OpenGL 3.3 here. Install a graphics driver.")

    engine = HeightEngine(Engine.GPU, Graphics(opened))
    assert not engine.requested and engine.report.fault == "There is no OpenGL 3.3 here. Install a graphics driver"
    assert trial_of(Graphics(opened), Engine.GPU).renderer == ""


def test_an_error_that_nobody_raises_is_one() -> None:
    """Drivers keep errors until they are asked."""

    def silent(
        ctx: moderngl.Context, workpiece: Workpiece, course: Course, cutters: Cutters, progress: Progress
    ) -> Heights:
        heights = quads(ctx, workpiece, course, cutters, progress)
        ctx.enable_direct(0xFFFF)
        return heights

    assert "GL_INVALID_ENUM" in trial_of(Graphics(quads=silent), Engine.GPU).fault


def test_each_system_is_tried_once_and_its_context_given_back() -> None:
    contexts: list[moderngl.Context] = []

    def opened() -> moderngl.Context:
        contexts.append(standalone_context())
        return contexts[-1]

    graphics = Graphics(opened)
    assert trial_of(graphics, Engine.GPU) is trial_of(graphics, Engine.GPU) and len(contexts) == 1
    HeightEngine(Engine.GPU, graphics).alone(JOB)
    assert len(contexts) == 2
    assert all(type(context.mglo).__name__ == "InvalidObject" for context in contexts)


def test_stopping_is_no_fault() -> None:
    def stopped(*job: object) -> Heights:
        raise Cancelled

    engine = HeightEngine(Engine.GPU, Graphics(quads=later(JOB, stopped)))
    with pytest.raises(Cancelled):
        engine.alone(JOB)
    assert engine.requested and not engine.report.fault


def test_a_context_that_cannot_be_had_a_second_time_is_a_fall_back() -> None:
    opened: list[int] = []

    def once() -> moderngl.Context:
        opened.append(1)
        if len(opened) > 1:
            raise HitofudeError("There is no OpenGL 3.3 here.")
        return standalone_context()

    record = trim(*JOB).heights
    engine = HeightEngine(Engine.GPU, Graphics(once))
    assert engine.requested
    assert engine.beside(record, JOB) is record
    assert engine.report.engine is Engine.CPU
    assert "cannot be had again (There is no OpenGL 3.3 here.)" in engine.report.fault


def test_each_method_is_tried_for_itself() -> None:
    graphics = Graphics(quads=spoiled(next(iter(LIES.values()))))
    assert trial_of(graphics, Engine.GPU).fault
    assert not trial_of(graphics, Engine.PATENT).fault
    engine = HeightEngine(Engine.PATENT, graphics)
    engine.beside(trim(*JOB).heights, JOB)
    assert engine.report.engine is Engine.PATENT
    lying = Graphics(published=spoiled(LIES["no numbers"]))
    assert trial_of(lying, Engine.PATENT).fault
