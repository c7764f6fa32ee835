"""Read any text and judge what comes back: no exception, in time, every number in its range, every problem with a
place.

Time is that of the processor, for others may be at work beside a test.
"""

import math
import multiprocessing
import resource
import time
from multiprocessing.connection import Connection

import numpy as np

from app.gcode.interpreter.dialect import Dialect
from app.gcode.interpreter.options import ReadOptions
from app.gcode.interpreter.program import NcProgram, Severity
from app.gcode.interpreter.reader import read_program
from app.gcode.interpreter.text import ProgramBuffer
from app.model.motion import MotionKind
from tests.pace import slowed

SECONDS, BYTES, MEGABYTES = 4.0, 1_000_000, 500
BUSY = 20
"""Times the seconds of the processor that a process is waited for: others may be at work."""


def judged(data: bytes, dialect: Dialect = Dialect.LINUXCNC) -> NcProgram:
    """Read a text within four seconds (and four more for each further megabyte) of cores of one's own; fail unless
    what comes back holds together.

    It has three tries, for a machine with much else to do is slow at times.
    """
    allowed, spent = SECONDS * max(1.0, len(data) / BYTES), math.inf
    for _ in range(3):
        if spent >= allowed:
            before, started = slowed(), time.process_time()
            program = read_program(data, ReadOptions(dialect))
            spent = (time.process_time() - started) / min(before, slowed())
    assert spent < allowed, f"{spent:.1f} s for {data[:2000]!r}"
    _judge_motions(program)
    _judge_problems(program, data)
    return program


def _judge_motions(program: NcProgram) -> None:
    motions, count = program.motions, len(program.motions)
    assert np.isfinite(motions.start).all() and np.isfinite(motions.end).all()
    arcs = (motions.kind == MotionKind.ARC_CW) | (motions.kind == MotionKind.ARC_CCW)
    assert np.isfinite(motions.centre[arcs]).all() and (motions.turns[arcs] >= 1).all()
    assert ((motions.line >= 1) & (motions.line <= program.line_count)).all()
    assert ((motions.state >= 0) & (motions.state < len(program.states))).all() and program.states
    assert not (motions.feed < 0).any() and not np.isinf(motions.feed).any()
    assert set(motions.splines) == set(np.flatnonzero(motions.kind == MotionKind.SPLINE).tolist())
    assert all(-1 <= row <= count for row in motions.known_from)
    assert all(0 <= row < count for row in program.homeward)
    for event in program.events:
        assert 0 <= event.before <= count and 1 <= event.line <= program.line_count and np.isfinite(event.value), event


def _judge_problems(program: NcProgram, data: bytes) -> None:
    errors = [problem for problem in program.problems if problem.severity is Severity.ERROR]
    assert errors in ([], list(program.problems[-1:]))
    if not program.problems:
        return
    text = ProgramBuffer(data)
    lines = text.data.decode(text.encoding).split("\n")
    for problem in program.problems:
        assert 1 <= problem.line <= program.line_count and problem.text.endswith((".", ")")), problem
        line = lines[problem.line - 1]
        assert 0 <= problem.column <= len(line) + 1, (problem, line[:80])
        assert not problem.column or line[problem.column - 1 :].lower().startswith(problem.word.lower()), (
            problem,
            line[:80],
        )
        assert problem.message("a.ngc").startswith(f"a.ngc:{problem.line}:")


def judged_apart(texts: list[bytes], dialect: Dialect, seconds: int = 60) -> str:
    """Judge texts in a process that may grow by 500 MB only, and take so many seconds of the processor; return what
    went wrong, or "".
    """
    read_program(b"G0 X1\n")  # the compiled lane is loaded once, not in each process
    ours, theirs = multiprocessing.get_context("fork").Pipe()
    child = multiprocessing.get_context("fork").Process(target=_judge_all, args=(theirs, texts, dialect, seconds))
    child.start()
    theirs.close()
    told = _told_in_time(ours, BUSY * seconds)
    child.kill()
    child.join()
    return told


def _told_in_time(ours: Connection, seconds: float) -> str:
    try:
        return str(ours.recv()) if ours.poll(seconds) else f"no answer within {seconds:g} s"
    except EOFError:
        return "the process died"


def _judge_all(answer: Connection, texts: list[bytes], dialect: Dialect, seconds: int) -> None:
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))  # which ends it
    with open("/proc/self/statm") as file:
        size = int(file.read().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (size + MEGABYTES * 2**20,) * 2)
    try:
        for text in texts:
            judged(text, dialect)
    except BaseException as problem:  # whatever it is, the parent is to hear of it
        answer.send(f"{type(problem).__name__}: {problem}")
    else:
        answer.send("")
