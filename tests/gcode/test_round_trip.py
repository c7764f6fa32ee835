"""What is written, for every post, and read back in its dialect is the path that was meant: random jobs, mm and
inch.
"""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.gcode.checks.check import CheckReference, check
from app.gcode.posts import Coolant, Numbers, Post, load_post, post_names
from app.gcode.writer.write import write_files
from app.model.job import Job, OriginXY, OriginZ
from app.model.moves import Purpose
from app.model.part import Part, Units
from app.model.tool import Tool
from tests.examples import examples
from tests.gcode.programs import Path, job
from tests.gcode.test_write_motion import arc_steps, line_steps, random_path

POSTS = pytest.mark.parametrize("name", post_names())


@st.composite
def paths(draw: st.DrawFn) -> Path:
    """Some tools after one another, each with lines and arcs, or with holes."""
    path = Path()
    for _ in range(draw(st.integers(1, 3))):
        path.tool = draw(st.sampled_from((1, 2, 14)))
        path.operation, path.feed = draw(st.integers(0, 1)), draw(st.floats(1.0, 9000.0))
        if draw(st.integers(0, 3)):
            random_path(draw(st.lists(st.one_of(arc_steps, line_steps), min_size=1, max_size=15)), path)
        else:
            drill(
                path,
                draw(
                    st.lists(
                        st.tuples(st.integers(0, 9), st.integers(0, 9), st.floats(-9.0, 0.5)), min_size=1, max_size=5
                    )
                ),
            )
    return path


def drill(path: Path, holes: list[tuple[int, int, float]]) -> None:
    for x, y, bottom in holes:
        path.into_work(5.5 * x, 5.5 * y, bottom)
        path.rows[-1] = (*path.rows[-1][:3], Purpose.DRILL, *path.rows[-1][4:])
        path.out_of_work()


@st.composite
def jobs(draw: st.DrawFn) -> Job:
    tools = tuple(
        Tool(number, 3.0, spindle_speed=draw(st.floats(1.0, 30000.0)), name=draw(st.text(max_size=12)))
        for number in (1, 2, 14)
    )
    return job(
        part=Part(name=draw(st.text(max_size=40))),
        tools=tools,
        out_units=draw(st.sampled_from([Units.MM, Units.INCH])),
        origin_xy=draw(st.sampled_from(OriginXY)),
        origin_z=draw(st.sampled_from(OriginZ)),
        exact_path=draw(st.booleans()),
    )


@st.composite
def variants(draw: st.DrawFn, post: Post) -> Post:
    """The post with another coolant and with or without block numbers."""
    numbers = Numbers(draw(st.booleans()), 10, 10)
    return replace(post, coolant=replace(post.coolant, use=draw(st.sampled_from(Coolant))), numbers=numbers)


def test_pieces_of_a_circle_end_where_their_rounded_points_are() -> None:
    """Cut in equal shares of its angle instead, this circle is 2.7 um off in step at four decimals of an inch."""
    x, y = 0.9045, 3.3236
    path = Path().into_work(x + 1, y).line(x, y, -1.0).arc((x, y, -1.0), (x - 0.7, y)).out_of_work()
    program, task, post = path.program(), job(out_units=Units.INCH), load_post("fanuc")
    (file,) = write_files(program, task, post)
    assert check(file.nc.text.encode("ascii"), file, CheckReference(program, task, post)).problems == ()


@POSTS
@settings(max_examples=examples(40), deadline=None)
@given(data=st.data(), path=paths(), task=jobs())
def test_written_and_read_back_it_is_the_same(name: str, data: st.DataObject, path: Path, task: Job) -> None:
    post = data.draw(variants(load_post(name)))
    program = path.program()
    files = write_files(program, task, post)
    assert sum(len(file.nc.lines) for file in files) == len(program.moves)
    assert len(files) == 1 or post.file_per_tool
    for file in files:
        found = check(file.nc.text.encode("ascii"), file, CheckReference(program, task, post))
        assert [problem.message(name) for problem in found.problems] == []
        assert found.largest_distance_mm <= found.tolerance_mm
