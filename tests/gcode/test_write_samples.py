"""Whole drawings: LinuxCNC's interpreter accepts its program and moves along the computed path to 1 um; every post's
reads back.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from app.formats.readers import read_drawing
from app.gcode.checks.check import CheckReference, check
from app.gcode.posts import load_post, post_names
from app.gcode.writer.write import write_files
from app.model.job import Job, OriginXY, OriginZ
from app.model.part import Units
from app.model.stock_box import stock_box, work_origin
from app.operations.compute import compute
from tests.conftest import ROOT
from tests.gcode.grbl_syntax import grbl_errors
from tests.gcode.one_file import write_program
from tests.gcode.rs274_oracle import assert_same_motion

FIG2 = ROOT / "resources" / "samples" / "fig2.dxf"
DRAWINGS = [
    FIG2,
    *(ROOT / "tests" / "data" / "dxf" / f"{name}.dxf" for name in ("apu-mount", "complex", "gear", "genshi", "insert")),
]


@pytest.mark.parametrize("drawing", DRAWINGS, ids=lambda path: path.stem)
def test_motion_of_a_whole_drawing(drawing: Path) -> None:
    part = read_drawing(drawing.name, drawing.read_bytes(), Units.MM).part
    job = Job(part, origin_xy=OriginXY.CENTRE, origin_z=OriginZ.BOTTOM)
    program = compute(job)
    assert len(program.moves) > 50
    for units in (Units.MM, Units.INCH):
        written = replace(job, out_units=units)
        nc = write_program(program, written, load_post(job.post))
        assert_same_motion(program.moves, nc, written, work_origin(job, stock_box(job, program.regions)))
        for name in post_names():
            post = load_post(name)
            for file in write_files(program, written, post):
                assert check(file.nc.text.encode("ascii"), file, CheckReference(program, written, post)).problems == ()
                assert name != "grbl" or grbl_errors(file.nc.text) == []
