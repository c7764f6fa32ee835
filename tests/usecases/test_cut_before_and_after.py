"""The metal is the same before and after smoothing: what the written text cuts, held between two cuts of the text it
came from.

Let every place of the old path be within t of a place of the new one, and the other way round. The ball of radius r
about a centre of the new path then lies in the ball of radius r + t about one of the old path, and the ball of radius r
- t about a centre of the old path lies in the ball of radius r about one of the new path; so does all that stands above
each. In every cell the new height is hence not below that of the old centres with r + t, and not above that of the old
centres with r - t. It is a bound of bodies, not of heights: it also holds beside walls, where the heights themselves
may be millimetres apart. Here t is the bound that the certificate states, which is at most the tolerance.

What a cut rounds, 5e-6 (1 + slope) mm of height, is a shift by `ROUNDED` up and sideways, of both cuts: it goes into
the radii. What is left is one step of the heights' 32-bit numbers.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from app.exhibits.die_programs import PROGRAMS, finishing
from app.gcode.interpreter.options import PATIENT, ReadOptions
from app.gcode.interpreter.reader import read_program
from app.gcode.posts import load_post
from app.gcode.writer.linuxcnc_biarcs import driven
from app.model.stock_box import StockBox
from app.simulation.cutter import Cutter
from app.simulation.field.workpiece import BoxStock, Grid
from app.simulation.sweeps.course import Course, Rapids, TrimOptions
from app.simulation.sweeps.trim import trim
from app.usecases.smoothing.result import OutputForm, SmoothedProgram, SmoothOptions
from app.usecases.smoothing.smooth import smooth
from app.verify.course import course_of, picked
from tests.simulation.courses import joined
from tests.usecases.test_smooth_oracle import WAYS, program
from tests.usecases.written_curves import Floats

ROUNDED = 5e-6
SLACK = 2 * np.sqrt(2) * ROUNDED
CELLS = 500

STEP = float(np.spacing(np.float32(25.0)))
"""mm; of the heights, none of which is deeper."""

Case = tuple[bytes, float, StockBox]
"""Text, radius of the ball, and stock."""


def program_a(data: Path) -> Case:
    return program(finishing(PROGRAMS["A"])), PROGRAMS["A"].radius, StockBox(0.0, 0.0, -25.0, 100.0, 100.0)


def drop_cutter(data: Path) -> Case:
    return (data / "nc" / "test_pycam.ngc").read_bytes(), 3.0, StockBox(-10.0, -2.0, -14.0, 140.0, 52.0)


def waves(data: Path) -> Case:
    """Lines of waves to and fro that bend up, down and sideways, joined by round turns, and one level round about
    them.
    """
    x = np.linspace(-18, 18, 400)
    rows = []
    for k, y in enumerate(np.arange(-15, 15.1, 1.5)):
        row = np.column_stack([x, y + 0.6 * np.sin(x / 2), -5 + 2 * np.sin(x / 3 + 0.2 * y) + np.cos(y / 4)])
        rows.append(row[::-1] if k % 2 else row)
    turn = np.linspace(0, 2 * np.pi, 600)
    rows.append(np.column_stack([17 * np.cos(turn), 14 * np.sin(turn) + np.sin(6 * turn), np.full(600, -8.5)]))
    return program(np.vstack(rows)), 2.5, StockBox(-20.0, -20.0, -14.0, 20.0, 20.0)


CASES: dict[str, Callable[[Path], Case]] = {"program A": program_a, "drop cutter": drop_cutter, "waves": waves}

JOBS = [
    *(("program A", way, 0.01) for way in ("lines", "arcs", "knots")),
    *(("drop cutter", way, 0.02) for way in ("lines", "arcs", "knots")),
    *(("waves", way, tolerance) for way in WAYS for tolerance in (0.005, 0.05)),
]
"""Only the waves have a level stretch, without which G5.2 writes what arcs write."""


def smoothed(text: bytes, way: str, tolerance: float) -> SmoothedProgram:
    form, post = WAYS[way]
    insist = form is OutputForm.NURBS  # else arcs stand wherever they take fewer blocks
    return smooth("part.nc", text, SmoothOptions(tolerance, form, post=load_post(post), insist=insist))


def course(text: bytes, way: str) -> Course:
    """Return the course of a text as the control of a way reads it, all with one tool."""
    read = read_program(text, ReadOptions(load_post(WAYS[way][1]).dialect, limits=PATIENT))
    assert read.error is None
    known = course_of(read).course
    return replace(known, tool=np.ones_like(known.tool))


def as_driven(way: Course) -> Course:
    """Return a course with the arcs that LinuxCNC makes of splines in their place."""
    rows, parts, at = sorted(way.motions.splines), [], 0
    for row in [*rows, len(way.motions)]:
        parts.append(picked(way, np.arange(at, row)).motions)
        parts += [driven(way.motions.splines[row])] if row in way.motions.splines else []
        at = row + 1
    assert not rows or max(way.left_out, default=-1) < rows[0]
    motions = joined(parts)
    return Course(motions, np.ones(len(motions), np.int32), way.left_out)


def beside(way: Course, by: float) -> Course:
    """Return a course of straight motions, moved along Y."""
    shift = np.array([0.0, by, 0.0])
    return replace(way, motions=replace(way.motions, start=way.motions.start + shift, end=way.motions.end + shift))


def cut(stock: StockBox, way: Course, radius: float, more: float = 0.0) -> Floats:
    """Return the heights that a ball leaves, `more` larger about the same centres."""
    ball = Cutter(radius + more, 0.0, radius + more, lift=-more)
    grid = Grid.over((stock.x0, stock.y0, stock.x1, stock.y1), CELLS)
    return trim(BoxStock(stock).over(grid), way, {1: ball}, TrimOptions(Rapids.IGNORED)).heights.astype(np.float64)


def outside(case: Case, old: Course, new: Course, bound: float) -> tuple[int, int]:
    """Return in how many cells the new course cuts deeper, and in how many less deep, than the bound allows."""
    _, radius, stock = case
    low, high = (cut(stock, old, radius, side * (bound + SLACK)) for side in (1, -1))
    heights = cut(stock, new, radius)
    assert np.all(low <= high) and np.mean(heights < stock.z1) > 0.8, "nothing that is not cut tells anything"
    return int(np.sum(heights < low - STEP)), int(np.sum(heights > high + STEP))


@pytest.mark.parametrize(("name", "way", "tolerance"), JOBS)
def test_the_written_text_leaves_the_same_metal_within_the_bound(
    data: Path, name: str, way: str, tolerance: float
) -> None:
    case = CASES[name](data)
    done = smoothed(case[0], way, tolerance)
    assert 0 < done.bound <= tolerance
    old, new = course(case[0], way), course(done.data, way)
    assert len(new.motions) < len(old.motions), "what stays as it was proves nothing"
    assert bool(new.motions.splines) == (way in ("knots", "biarcs"))
    assert outside(case, old, new, done.bound) == (0, 0)
    if way == "biarcs":
        assert outside(case, old, as_driven(new), done.bound) == (0, 0)


@pytest.mark.parametrize("name", CASES)
def test_a_path_moved_sideways_by_less_keeps_to_the_bound_and_by_twice_as_much_misses_it_both_ways(
    data: Path, name: str
) -> None:
    case, bound = CASES[name](data), 0.02
    old = course(case[0], "lines")
    assert outside(case, old, beside(old, 0.99 * bound), bound) == (0, 0)
    assert min(outside(case, old, beside(old, 2 * bound), bound)) > 100


@pytest.mark.parametrize("way", WAYS)
def test_what_was_smoothed_three_times_as_coarsely_misses_the_bound(data: Path, way: str) -> None:
    case, tolerance = waves(data), 0.02
    old, new = course(case[0], way), course(smoothed(case[0], way, 3 * tolerance).data, way)
    assert min(outside(case, old, new, tolerance)) > 10
