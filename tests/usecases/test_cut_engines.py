"""Whose heights a cut has, what is compared with what, and what is said when the graphics system cannot."""

import threading

import moderngl
import numpy as np
import pytest

from app.core.errors import HitofudeError
from app.core.progress import Progress
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.simulation.engines import Compute, Cutters, Engine, Graphics, quads
from app.simulation.field.workpiece import Heights, Workpiece
from app.simulation.gpu.graphics import is_software, renderer_of, standalone_context
from app.simulation.sweeps.course import Course
from app.usecases.cutting.cut import CutOptions, CutProgram, cut
from app.usecases.cutting.ready_setup import ReadySetup, SetupRequest, setup_of
from app.usecases.cutting.report import cut_report
from app.usecases.cutting.setup_stock import box_stock
from app.usecases.cutting.setup_tools import ToolSource
from app.usecases.examine import ExamineOptions, examine

FIRST = "G21 G90 G17 G54\nT1 M6\nG0 Z5\nX10 Y10\nG1 Z-2 F100\nX40 Z-3\nG2 X30 Y20 I-10 J0\nG0 Z5\nG0 X20\nM2\n"
SECOND = "G21 G90 G17 G54\nT2 M6\nG0 Z5\nX10 Y18\nG1 Z-1 F100\nX40 Y4\nG0 Z-0.5\nX10 Y10\nZ5\nM2\n"
TOOLS = ToolSource("--tool", {1: Tool(1, 6.0, ToolKind.BALL), 2: Tool(2, 5.0)})
STAGES = 2


def ready(*texts: str) -> ReadySetup:
    programs = tuple(examine(f"{k}.ngc", text.encode(), ExamineOptions()) for k, text in enumerate(texts, 1))
    return setup_of(programs, SetupRequest((TOOLS,), stock=box_stock([0, 0, -10, 50, 30, 0])))


TWO = ready(FIRST, SECOND)


def run(engine: Engine, graphics: Graphics | None = None, **options: bool) -> CutProgram:
    return cut(TWO.setup, CutOptions(200, engine=engine, **options), graphics=graphics or Graphics())


def counted(jobs: list[Workpiece], fails_at: int = -1) -> Compute:
    """The engine itself; it notes what it is given, and may fail at one job, the trial not counted."""

    def compute(
        ctx: moderngl.Context, workpiece: Workpiece, course: Course, cutters: Cutters, progress: Progress
    ) -> Heights:
        if workpiece.grid.cols == 200:
            jobs.append(workpiece)
            if len(jobs) - 1 == fails_at:
                raise moderngl.Error("lost")
        return quads(ctx, workpiece, course, cutters, progress)

    return compute


def no_graphics() -> moderngl.Context:
    raise HitofudeError("There is no OpenGL 3.3 here. Install a graphics driver.")


def hardware() -> moderngl.Context:
    """A software context that says it is none; what it paints is true."""
    context = standalone_context()
    with context:
        context.info["GL_RENDERER"] = "a card"
    return context


def test_each_programs_stock_is_what_the_same_engine_left() -> None:
    jobs: list[Workpiece] = []
    record, done = run(Engine.CPU), run(Engine.GPU, Graphics(quads=counted(jobs)))
    assert len(jobs) == STAGES
    one = cut(ready(FIRST).setup, CutOptions(200, engine=Engine.GPU))
    assert np.array_equal(jobs[1].heights, one.cut.heights)
    assert np.abs(record.cut.heights - done.cut.heights).max() < 1e-4
    assert not np.array_equal(record.cut.heights, done.cut.heights)
    assert (
        done.engine_report.engine is Engine.GPU
        and done.engine_report.difference is not None
        and done.engine_report.difference.cells == 0
    )


def test_what_only_the_engine_of_record_tells_it_goes_on_telling() -> None:
    record, done = run(Engine.CPU), run(Engine.GPU)
    assert done.cut.owner is not None and record.cut.owner is not None
    assert np.mean(done.cut.owner != record.cut.owner) < 1e-3
    assert done.cut.volume == pytest.approx(record.cut.volume, abs=1e-3)
    assert [hit.motion for hit in done.cut.rapids] == [hit.motion for hit in record.cut.rapids] != []
    assert [finding.kind for finding in done.findings] == [finding.kind for finding in record.findings]


def test_no_graphics_system_is_said_once_and_the_processor_takes_over() -> None:
    record, done = run(Engine.CPU), run(Engine.GPU, Graphics(no_graphics))
    assert np.array_equal(record.cut.heights, done.cut.heights)
    said = [finding for finding in done.findings if "processor" in finding.text]
    want = (
        "The heights are the processor's, not those of the engine gpu: There is no OpenGL 3.3 here. Install a "
        "graphics driver."
    )
    assert [finding.text for finding in said] == [want]
    assert not said[0].counts
    data = cut_report(done, TWO).data
    assert data["engine"].startswith("cpu: ") and "There is no OpenGL 3.3 here" in data["engine"]
    assert data["apart_from_cpu"] is None


def test_a_context_that_is_lost_between_programs_is_said_once() -> None:
    jobs: list[Workpiece] = []
    done = run(Engine.GPU, Graphics(quads=counted(jobs, 1)))
    assert np.abs(done.cut.heights - run(Engine.CPU).cut.heights).max() < 1e-4
    assert sum("fails (lost)" in finding.text for finding in done.findings) == 1
    assert done.engine_report.engine is Engine.CPU


def test_automatically_software_is_not_taken_and_nothing_is_said() -> None:
    if not is_software(renderer()):
        pytest.skip("this machine has graphics hardware")
    jobs: list[Workpiece] = []
    for look in ({}, {"trace": False, "judge": False}):
        done = run(Engine.AUTO, Graphics(quads=counted(jobs), present=lambda: True), **look)
        assert done.engine_report.engine is Engine.CPU and not jobs
    done = run(Engine.AUTO, Graphics(no_graphics, present=lambda: True), trace=False, judge=False)
    assert not [finding for finding in done.findings if "processor" in finding.text]


def renderer() -> str:
    context = standalone_context()
    with context:
        name = renderer_of(context)
    context.release()
    return name


def test_automatically_a_look_is_hardwares_alone() -> None:
    jobs: list[Workpiece] = []
    graphics = Graphics(hardware, counted(jobs), present=lambda: True)
    looked, record = run(Engine.AUTO, graphics, trace=False, judge=False), run(Engine.CPU, trace=False, judge=False)
    assert (
        looked.engine_report.engine is Engine.GPU
        and looked.engine_report.renderer == "a card"
        and looked.engine_report.difference is None
    )
    assert np.abs(looked.cut.heights - record.cut.heights).max() < 1e-4 and len(jobs) == STAGES
    judged = run(Engine.AUTO, graphics)
    assert (
        judged.engine_report.engine is Engine.GPU
        and judged.engine_report.difference is not None
        and len(jobs) == 2 * STAGES
    )
    assert judged.cut.owner is not None and judged.cut.rapids
    broken = run(Engine.AUTO, Graphics(hardware, counted([], 0), present=lambda: True), trace=False, judge=False)
    assert broken.engine_report.engine is Engine.CPU and np.array_equal(broken.cut.heights, record.cut.heights)
    assert not [finding for finding in broken.findings if "processor" in finding.text]


def test_a_window_is_painted_and_the_whole_is_the_engine_of_records() -> None:
    jobs: list[Workpiece] = []
    options = CutOptions(200, (10.0, 5.0, 30.0, 20.0), engine=Engine.GPU)
    done = cut(TWO.setup, options, graphics=Graphics(quads=counted(jobs)))
    assert [job.grid for job in jobs] == [done.cut.before.grid] * STAGES
    assert done.engine_report.engine is Engine.GPU and done.cut.rapids


def test_the_context_is_used_on_the_working_thread_alone() -> None:
    where: list[int] = []

    def compute(
        ctx: moderngl.Context, workpiece: Workpiece, course: Course, cutters: Cutters, progress: Progress
    ) -> Heights:
        where.append(threading.get_ident())
        return quads(ctx, workpiece, course, cutters, progress)

    other = threading.Thread(target=run, args=(Engine.GPU, Graphics(quads=compute)))
    other.start()
    other.join()
    assert set(where) == {other.ident}


def test_automatically_nothing_is_opened_where_there_is_no_device() -> None:
    def opened() -> moderngl.Context:
        raise AssertionError("nobody asked for it")

    assert run(Engine.AUTO, Graphics(opened, present=lambda: False)).engine_report.engine is Engine.CPU
