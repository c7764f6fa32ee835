"""Depths that a drawing tells: by elevation, by thickness, by texts beside shapes; and what is not understood."""

from __future__ import annotations

import io
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import ezdxf
import pytest

from app.core.errors import InputError
from app.drafting.history import HistoryState
from app.drafting.recorded_lines import RecordedLine
from app.formats.dxf.dxf import read_dxf
from app.formats.job.toml import read_job
from app.formats.project.project import Project, read_project, write_project
from app.model.drawn_depths import DepthSource, depth_words
from app.model.hole_operations import DrillOperation
from app.model.job import Job
from app.model.operation import CutParameters, Operation, PocketOperation
from app.model.part import Part
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.usecases.job.drawn_depths import with_drawn_depths
from app.usecases.job.options import MakeOptions
from app.usecases.making.make import make

Draw = Callable[[Any], None]


def dxf(draw: Draw, units: int = ezdxf.units.MM) -> bytes:
    document = ezdxf.new(units=units)
    draw(document.modelspace())
    text = io.StringIO()
    document.write(text)
    return text.getvalue().encode()


def square(space: Any, x: float, y: float, side: float, **how: Any) -> None:
    space.add_lwpolyline([(x, y), (x + side, y), (x + side, y + side), (x, y + side)], close=True, dxfattribs=how)


def word(space: Any, text: str, x: float, y: float, height: float = 2.0) -> None:
    space.add_text(text, height=height, dxfattribs={"layer": "texts"}).set_placement((x, y))


def pocket(depth: float = 1.0) -> Operation:
    return PocketOperation(CutParameters(1, depth=depth))


def floors(part: Part, operation: Operation | None = None) -> list[tuple[float, int]]:
    """Depth and number of contours of each operation of a job with one."""
    job = Job(part, tools=(Tool(1, 3.0), Tool(2, 6.0, ToolKind.DRILL)), operations=(operation or pocket(),))
    return [(each.cut.depth, len(each.cut.curves)) for each in with_drawn_depths(job).job.operations]


ANOTHER_NUMBER = ["t=4-6", "depth 4 to 6", "4-6 deep", "depth 1,000", "depth 4e1", "↓4'", "depth 4 µm", "t=4.5.6"]
"""Of which the first digits were taken for the depth."""


@pytest.mark.parametrize(
    ("words", "depth"),
    [
        ("↓4", 4.0),
        ("↧ 2.5", 2.5),
        ("t=4", 4.0),
        ("T 3,5", 3.5),
        ("depth 4", 4.0),
        ("DEPTH: 6 mm", 6.0),
        ("深さ4", 4.0),
        ("深さ 4.5mm", 4.5),
        ("4 deep", 4.0),
        ('depth .25"', 6.35),
        ("Ø6 ↓12", 12.0),
        ("z-3", 3.0),
        ("↓4 depth 4", 4.0),
        ('depth 1/4"', 6.35),
        ('1/4" deep', 6.35),
        ('1 1/2" deep', 38.1),
        ("depth 0.25 inch", 6.35),
        ("depth 5 cm", 50.0),
        ("t=4±0.1", 4.0),
        ("M6x1 - 12 deep", 12.0),
    ],
)
def test_words_tell_a_depth(words: str, depth: float) -> None:
    found = depth_words(words, 1.0)
    assert found is not None and found.depth == pytest.approx(depth, abs=1e-12)


@pytest.mark.parametrize("words", ["D6", "Ø6", "4 mm", "M6", "part 7", "Start 4", "20", "THRU", "d=8", "sheet 1", ""])
def test_words_of_other_things_tell_none(words: str) -> None:
    assert depth_words(words, 1.0) is None


@pytest.mark.parametrize("words", ["depth?", "↓", "↓4 ↓6", "depth as drawn", "↓0", *ANOTHER_NUMBER])
def test_words_that_are_not_understood_are_known_as_such(words: str) -> None:
    found = depth_words(words, 1.0)
    assert found is not None and found.depth is None


def test_numbers_are_in_the_units_of_the_drawing() -> None:
    part = read_dxf(dxf(lambda space: (square(space, 0, 0, 2), word(space, "t=.25", 0.2, 0.2, 0.1)), 1)).part
    assert floors(part) == [(pytest.approx(6.35), 1)]


@pytest.mark.parametrize(
    ("how", "depth"),
    [
        ({"elevation": -3.0}, 3.0),
        ({"thickness": -4.0}, 4.0),
        ({"thickness": 4.0}, 4.0),
        ({"elevation": -5.0, "thickness": 5.0}, 5.0),
        ({"elevation": -2.0, "thickness": -3.0}, 5.0),
        ({"elevation": -3.0, "extrusion": (0, 0, 1)}, 3.0),
    ],
)
def test_elevation_and_thickness_are_depths(how: dict[str, Any], depth: float) -> None:
    part = read_dxf(dxf(lambda space: (square(space, 0, 0, 20, **how), square(space, 30, 0, 20)))).part
    assert floors(part) == [(1.0, 1), (depth, 1)]


def test_lines_and_circles_of_a_solid_drawn_flat_count_from_the_highest() -> None:
    def draw(space: Any) -> None:
        square(space, 0, 0, 50, elevation=10)
        corners = [(5, 5), (25, 5), (25, 25), (5, 25)]
        for (x0, y0), (x1, y1) in zip(corners, [*corners[1:], corners[0]], strict=True):
            space.add_line((x0, y0, 6), (x1, y1, 6))
        space.add_circle((40, 40, 2.5), 5)

    part = read_dxf(dxf(draw)).part
    told = {each.depth: len(each.curves) for each in part.depths}
    assert told == {4.0: 4, 7.5: 1}


def test_a_block_lies_as_high_as_it_is_inserted() -> None:
    document = ezdxf.new(units=ezdxf.units.MM)
    square(document.blocks.new("B"), 0, 0, 10, elevation=-1)
    document.modelspace().add_blockref("B", (20, 0, -2))
    text = io.StringIO()
    document.write(text)
    assert [each.depth for each in read_dxf(text.getvalue().encode()).part.depths] == [3.0]


def test_a_leaning_curve_tells_no_depth() -> None:
    def draw(space: Any) -> None:
        square(space, 30, 0, 20, elevation=-2)
        for start, end in (((0, 0, 0), (20, 0, -2)), ((20, 0, -2), (0, 20, 0)), ((0, 20, 0), (0, 0, 0))):
            space.add_line(start, end)

    job = Job(read_dxf(dxf(draw)).part, operations=(pocket(),))
    made = with_drawn_depths(job)
    assert [each.cut.depth for each in made.job.operations] == [1.0, 2.0]
    assert [each.counts for each in made.findings] == [True, False]
    assert "lie elsewhere along Z" in made.findings[0].text


@pytest.mark.parametrize("inner", [2.0, 6.0])
def test_a_floor_within_a_floor_is_an_island_where_it_is_higher_and_cut_on_where_it_is_deeper(inner: float) -> None:
    def draw(space: Any) -> None:
        square(space, 0, 0, 60)
        square(space, 20, 20, 20)
        word(space, "t=4", 3, 3)
        word(space, f"t={inner:g}", 25, 30)

    part = read_dxf(dxf(draw)).part
    assert floors(part) == ([(2.0, 1), (4.0, 2)] if inner < 4 else [(4.0, 1), (6.0, 1)])
    job = Job(Part(), (Tool(1, 3.0),), (pocket(),))
    made = make("a.dxf", dxf(draw), MakeOptions(job=job, drawn_depths=True))
    assert made.report.data["left"]["reachable_mm2"] == 0 and made.report.data["gouge"]["max_mm"] == 0
    # both floors, but for what stands in corners that go inwards, beside a cutter of 1.5 mm
    corners = (4 - math.pi) * 1.5**2
    inner_corners = inner if inner < 4 else inner - 4
    removed = (60**2 - 20**2) * 4 + 20**2 * inner - corners * (4 + inner_corners)
    assert made.report.data["cut"]["removed_mm3"] == pytest.approx(removed, rel=2e-3)


def test_an_island_without_a_depth_stays_and_a_pocket_in_it_is_as_deep_as_the_one_around() -> None:
    def draw(space: Any) -> None:
        square(space, 0, 0, 90, elevation=-4)
        square(space, 20, 20, 50)
        square(space, 35, 35, 20)

    assert floors(read_dxf(dxf(draw)).part) == [(4.0, 3)]


def test_a_text_is_of_the_nearest_shape_and_letters_are_never_cut() -> None:
    def draw(space: Any) -> None:
        for k in range(3):
            space.add_circle((30 * k, 0), 3)
            word(space, f"↓{k + 4}", 30 * k + 5, -1)

    part = read_dxf(dxf(draw)).part
    drill = DrillOperation(CutParameters(2, depth=1.0))
    assert floors(part, drill) == [(4.0, 1), (5.0, 1), (6.0, 1)]
    letters = {number for each in part.depths for number in each.curves}
    job = Job(part, tools=(Tool(1, 1.0),), operations=(pocket(),))
    named = {each.number for op in with_drawn_depths(job).job.operations for each in op.cut.curves}  # type: ignore[union-attr]
    assert letters and named == {1, 2, 3}


@pytest.mark.parametrize(
    ("texts", "why"),
    [
        ([("t=4", 80.0, 50.0)], "no shape is near"),
        ([("t=4", 24.0, 9.0)], "two shapes are as near"),
        ([("t=4", 2.0, 2.0), ("t=5", 2.0, 12.0)], "another depth"),
        ([("depth", 2.0, 2.0)], "no depth, or several"),
    ],
)
def test_what_is_not_understood_is_named_and_guessed_by_nobody(texts: list[tuple[str, float, float]], why: str) -> None:
    def draw(space: Any) -> None:
        square(space, 0, 0, 20)
        square(space, 32, 0, 20)
        square(space, 0, 60, 20, elevation=-3)
        for text, x, y in texts:
            word(space, text, x, y)

    made = with_drawn_depths(Job(read_dxf(dxf(draw)).part, operations=(pocket(),)))
    assert [each.cut.depth for each in made.job.operations] == [1.0, 3.0]
    counting = [each for each in made.findings if each.counts]
    assert len(counting) == len(texts) and all(why in each.text for each in counting)


def test_a_drawing_that_tells_none_is_refused() -> None:
    job = Job(read_dxf(dxf(lambda space: square(space, 0, 0, 20))).part, operations=(pocket(),))
    with pytest.raises(InputError, match="tells no depth of a shape"):
        with_drawn_depths(job)


def test_a_project_keeps_what_was_told() -> None:
    def draw(space: Any) -> None:
        square(space, 0, 0, 20, elevation=-3)
        word(space, "depth", 2, 2)

    part = read_dxf(dxf(draw)).part
    state = HistoryState(Job(part), "0", (0.0, 0.0), {}, {}, RecordedLine(part))
    again = read_project("a.hito", write_project(Project(state))).state.job.part
    assert again.depths == part.depths and {each.source for each in again.depths} == {
        DepthSource.ELEVATION,
        DepthSource.TEXT,
    }


def test_a_job_file_and_the_command_ask_for_them(tmp_path: Path) -> None:
    from app.cli.main import main

    file = read_job("j.toml", b'[drawing]\ndepths = "drawing"\n')
    assert file.drawn_depths and not read_job("j.toml", b'[drawing]\ndepths = "operations"\n').drawn_depths
    (tmp_path / "a.dxf").write_bytes(dxf(lambda space: square(space, 0, 0, 20, elevation=-3)))
    out = tmp_path / "a.ngc"
    assert main(["make", str(tmp_path / "a.dxf"), "-o", str(out), "--depths", "drawing"]) in (0, 1)
    assert "depth=3" in out.read_text() and "depth=2" not in out.read_text()


def test_a_drawing_of_points_alone_is_drilled() -> None:
    from app.model.job import Stock

    def draw(space: Any) -> None:
        for x in (0, 20, 40):
            space.add_point((x, 5))

    drill = DrillOperation(CutParameters(2, depth=5.0), points=True)
    job = Job(Part(), (Tool(2, 6.0, ToolKind.DRILL),), (drill,), Stock(margin=5.0))
    made = make("points.dxf", dxf(draw), MakeOptions(job=job))
    assert made.clean and len(made.program.areas[0].regions) == 3
