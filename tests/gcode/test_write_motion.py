"""LinuxCNC's interpreter is the judge: it accepts every program, and its motion is the moves' own to 1 um."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.gcode.posts import ArcCentre, Numbers, load_post
from app.model.job import OriginXY, OriginZ
from app.model.part import Units
from tests.examples import examples
from tests.gcode.one_file import write_program
from tests.gcode.programs import Path, job, two_tools
from tests.gcode.rs274_oracle import assert_same_motion

LINUXCNC = load_post("linuxcnc")
UNITS = pytest.mark.parametrize("units", [Units.MM, Units.INCH])


def check(path: Path, units: Units = Units.MM, post=LINUXCNC) -> str:
    program, task = path.program(), job(out_units=units)
    nc = write_program(program, task, post)
    assert_same_motion(program.moves, nc, task)
    return nc.text


@UNITS
def test_two_tools_with_lines_arcs_full_circle_and_helix(units: Units) -> None:
    check(two_tools(), units)


@pytest.mark.parametrize(
    ("xy", "z", "origin"),
    [
        (OriginXY.DRAWING, OriginZ.BOTTOM, (0.0, 0.0, -8.0)),
        (OriginXY.LOWER_LEFT, OriginZ.TOP, (-2.0, -2.0, 0.0)),
        (OriginXY.LOWER_LEFT, OriginZ.BOTTOM, (-2.0, -2.0, -8.0)),
        (OriginXY.CENTRE, OriginZ.TOP, (20.0, 15.0, 0.0)),
    ],
)
def test_work_origins(xy: OriginXY, z: OriginZ, origin: tuple[float, float, float]) -> None:
    program, task = two_tools().program(), job(origin_xy=xy, origin_z=z)
    assert_same_motion(program.moves, write_program(program, task, LINUXCNC), task, origin)


def test_absolute_arc_centres_and_block_numbers_are_data() -> None:
    absolute = replace(
        LINUXCNC,
        arcs=replace(LINUXCNC.arcs, centre=ArcCentre.ABSOLUTE),
        numbers=Numbers(True, 10, 10),
        program=replace(
            LINUXCNC.program, start=tuple(line.replace("G91.1", "G90.1") for line in LINUXCNC.program.start)
        ),
    )
    program, task = two_tools().program(), job()
    text = write_program(program, task, absolute).text
    assert "N10 G17" in text
    assert_same_motion(program.moves, write_program(program, task, absolute), task)


def test_a_helix_of_one_turn_goes_down_evenly() -> None:
    text = check(Path().into_work(35, 22, -1).arc((35, 22, -3), (30, 22)).out_of_work())
    assert "G3 X25.0000 Y22.0000 Z-2.0000 I-5.0000 J0.0000 F600\nX35.0000 Y22.0000 Z-3.0000 I5.0000 J0.0000" in text


angles = st.floats(-math.pi, math.pi)
radii = st.one_of(st.floats(1e-5, 1e-2), st.floats(0.01, 50.0), st.floats(50.0, 1e7))
sweeps = st.one_of(
    st.floats(1e-7, 1e-3),
    st.floats(1e-3, 6.0),
    st.floats(6.0, math.tau - 1e-6),
    st.just(math.tau),
    st.floats(1e-10, 1e-6).map(lambda a: math.tau - a),
)
arc_steps = st.tuples(st.just("arc"), radii, angles, sweeps, st.booleans(), st.sampled_from([0.0, 0.0, -0.3]))
line_steps = st.tuples(st.just("line"), st.one_of(st.floats(0, 2e-4), st.floats(0, 30)), angles)


def random_path(steps: list[tuple[object, ...]], path: Path | None = None) -> Path:
    """Chain steps, behind a path if there is one; each begins where the one before ended. Arcs longer than 200 mm are
    cut short.
    """
    path = (path or Path()).into_work(1.23456, -6.54321)
    for step in steps:
        x, y, z = path.rows[-1][0]
        if step[0] == "line":
            path.line(x + step[1] * math.cos(step[2]), y + step[1] * math.sin(step[2]), z)
            continue
        _, radius, angle, sweep, ccw, dz = step
        sweep = min(sweep, 200 / radius)
        cx, cy = x - radius * math.cos(angle), y - radius * math.sin(angle)
        turn = sweep if ccw else -sweep
        end = (
            (x, y)
            if sweep == math.tau
            else (cx + radius * math.cos(angle + turn), cy + radius * math.sin(angle + turn))
        )
        gap = math.dist((x, y), end)
        if 0 < gap < 1e-8 or math.dist(end, (cx, cy)) == 0:
            continue
        path.arc((*end, z + dz), (cx, cy), ccw)
    return path.out_of_work()


@UNITS
@settings(max_examples=examples(40), deadline=None)
@given(steps=st.lists(st.one_of(arc_steps, line_steps), min_size=1, max_size=60))
def test_random_lines_and_arcs(units: Units, steps: list[tuple[object, ...]]) -> None:
    check(random_path(steps), units)
