"""Regions that are settled without polygons: told as the polygons tell them, and never where a path is missing or too
near to a wall.
"""

from __future__ import annotations

import io
from dataclasses import replace

import ezdxf
import numpy as np
import pytest

from app.core.progress import NO_PROGRESS
from app.model.job import Job
from app.model.moves import Moves, Program
from app.operations.compute import compute
from app.toolpath.coverage.coverage import Coverage, measure, measure_beside_clear
from app.toolpath.coverage.proven import one_floor, settled
from app.usecases.job.options import MakeOptions
from app.usecases.job.plausible import read_for
from app.usecases.making.make import job_from_drawing
from app.verify.verdict import clear_moves, gouge_depths


def _job(corners: bool) -> tuple[Program, Job]:
    """Five circles of 8 mm, and if asked for a square of 8 mm, whose corners a cutter of 2 mm cannot reach."""
    document = ezdxf.new("R2000", units=4)
    for k in range(5):
        document.modelspace().add_circle((10 * k + 5, 5), 4)
    if corners:
        document.modelspace().add_lwpolyline([(1, 21), (9, 21), (9, 29), (1, 29)], close=True)
    text = io.StringIO()
    document.write(text)
    options = MakeOptions(contour_diameter=2.0, pocket_diameter=2.0)
    job = job_from_drawing(read_for("five.dxf", text.getvalue().encode(), options), options)
    return compute(job), job


def _plate() -> tuple[Program, Job]:
    """A plate of 40 mm with nine holes of 6 mm, and a notch with corners inside that a cutter of 2 mm cannot reach."""
    document = ezdxf.new("R2000", units=4)
    for k in range(9):
        document.modelspace().add_circle((10 * (k % 3) + 10, 10 * (k // 3) + 10), 3)
    document.modelspace().add_lwpolyline(
        [(0, 0), (40, 0), (40, 18), (36, 18), (36, 22), (40, 22), (40, 40), (0, 40)], close=True
    )
    text = io.StringIO()
    document.write(text)
    options = MakeOptions(contour_diameter=2.0, pocket_diameter=2.0)
    job = job_from_drawing(read_for("plate.dxf", text.getvalue().encode(), options), options)
    return compute(job), job


def _both(program: Program, job: Job) -> tuple[Coverage, Coverage]:
    """What is measured with the moves that are clear told, and without."""
    return measure_beside_clear(program, job, clear_moves(program.moves, gouge_depths(program, job), 1e-3)), measure(
        program, job
    )


def test_circles_are_settled_and_leave_nothing() -> None:
    program, job = _job(corners=False)
    area = one_floor(program, job)
    assert area is not None
    quick, slow = _both(program, job)
    (wanted,) = quick.targets
    assert wanted.floor is wanted.reach and wanted.out_of_reach is not None and wanted.beyond.is_empty
    assert quick.places == slow.places == ()
    assert quick.area_mm2 == pytest.approx(slow.area_mm2, abs=1e-9) and quick.area_mm2 == pytest.approx(
        5 * np.pi * 16, rel=1e-3
    )
    assert quick.floor_mm == slow.floor_mm


def test_corners_beside_settled_circles_are_told_as_before() -> None:
    program, job = _job(corners=True)
    quick, slow = _both(program, job)
    assert len(quick.places) == len(slow.places) == 4
    assert quick.unreachable_mm2 == pytest.approx(4 - np.pi, rel=0.05)
    assert quick.unreachable_mm2 == pytest.approx(slow.unreachable_mm2, abs=1e-9)
    assert quick.reachable_left_mm2 == 0
    assert quick.targets[0].floor.area == pytest.approx(slow.area_mm2, abs=1e-9)


def test_of_a_plate_only_what_is_round_open_squares_is_asked() -> None:
    program, job = _plate()
    quick, slow = _both(program, job)
    assert quick.reachable_left_mm2 == slow.reachable_left_mm2 == 0
    assert len(quick.places) == len(slow.places) == 6
    assert quick.unreachable_mm2 == pytest.approx(slow.unreachable_mm2, rel=1e-3)
    assert quick.unreachable_mm2 == pytest.approx(6 * (1 - np.pi / 4), rel=0.05)
    assert quick.area_mm2 == pytest.approx(slow.area_mm2, abs=1e-6)
    (wanted,) = quick.targets
    assert wanted.out_of_reach is not None
    assert wanted.out_of_reach.area == pytest.approx(quick.unreachable_mm2, rel=0.05)


def test_of_a_plate_what_has_no_path_is_left() -> None:
    """Every move is gone that ends within 4 mm of one place between holes, and so is what they cut."""
    program, job = _plate()
    end = program.moves.end
    keep = np.hypot(end[:, 0] - 15, end[:, 1] - 15) > 4
    fewer = replace(program, moves=Moves(**{name: column[keep] for name, column in program.moves.columns().items()}))  # type: ignore[arg-type]
    quick, slow = _both(fewer, job)
    assert slow.reachable_left_mm2 > 1
    assert quick.reachable_left_mm2 == pytest.approx(slow.reachable_left_mm2, rel=1e-3)


def test_a_circle_without_its_paths_is_left() -> None:
    program, job = _job(corners=False)
    middle = (program.moves.start[:, 0] + program.moves.end[:, 0]) / 2
    keep = (middle < 20) | (middle > 30)
    fewer = replace(program, moves=Moves(**{name: column[keep] for name, column in program.moves.columns().items()}))  # type: ignore[arg-type]
    quick, slow = _both(fewer, job)
    assert quick.reachable_left_mm2 == pytest.approx(slow.reachable_left_mm2, rel=1e-4)
    assert quick.reachable_left_mm2 > 45


def test_moves_that_are_not_known_to_be_clear_settle_nothing() -> None:
    program, job = _job(corners=False)
    none = measure_beside_clear(program, job, np.zeros(len(program.moves), np.bool_))
    assert none.targets[0].out_of_reach is None
    assert settled(program, job, [], NO_PROGRESS) is None


def test_moves_beyond_a_wall_are_not_clear() -> None:
    program, job = _job(corners=False)
    depths = gouge_depths(program, job)
    assert clear_moves(program.moves, depths, 1e-3)[depths.move].all()
    worse = replace(depths, depth=np.where(depths.move == depths.move[3], 0.002, depths.depth))
    assert np.flatnonzero(~clear_moves(program.moves, worse, 1e-3)[depths.move]).tolist() == [3]
