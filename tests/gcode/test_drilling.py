"""Holes as canned cycles: written only where the control moves exactly as the moves do; rs274 and our reader are the
judges.
"""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.core.errors import ParameterError
from app.gcode.interpreter.options import ReadOptions
from app.gcode.interpreter.reader import read_program
from app.gcode.posts import Post, load_post, post_names
from app.gcode.writer.write import NcFile, write_files
from app.model.moves import MoveKind, Moves, Purpose
from app.model.part import Units
from tests.examples import examples
from tests.gcode.programs import Path, job
from tests.gcode.rs274_oracle import canonical_calls, exact_motions

GAP = 0.254
WITH_CYCLES = ("fanuc", "haas", "linuxcnc", "mach3")
POSTS = pytest.mark.parametrize("name", post_names())


class Holes(Path):
    """A path of holes."""

    def over(self, x: float, y: float, z: float = 1.0) -> Holes:
        height = self.rows[-1][0][2] if self.rows else 5.0
        self.rapid(x, y, height)
        return self.rapid(x, y, z) if height != z else self

    def feed_to(self, z: float) -> Holes:
        x, y, _ = self.rows[-1][0]
        self.line(x, y, z)
        self.rows[-1] = (*self.rows[-1][:3], Purpose.DRILL, *self.rows[-1][4:])
        return self

    def up(self, z: float) -> Holes:
        x, y, _ = self.rows[-1][0]
        return self.rapid(x, y, z)

    def drilled(self, x: float, y: float, bottom: float, back: float = 5.0) -> Holes:
        return self.over(x, y).feed_to(bottom).up(back)

    def pecked(self, x: float, y: float, bottom: float, step: float, back: float = 5.0) -> Holes:
        self.over(x, y)
        for z in steps(bottom, step):
            self.feed_to(z).up(1.0).up(z + GAP)
        return self.feed_to(bottom).up(back)

    def chipped(self, x: float, y: float, bottom: float, step: float, back: float = 5.0) -> Holes:
        self.over(x, y)
        for z in steps(bottom, step):
            self.feed_to(z).up(z + GAP)
        return self.feed_to(bottom).up(back)


def steps(bottom: float, step: float) -> list[float]:
    """Heights of the pecks from Z 1 down that are not the bottom."""
    heights, z = [], 1.0 - step
    while z > bottom + 1e-9:
        heights.append(z)
        z -= step
    return heights


def written(path: Path, post: Post, units: Units = Units.MM) -> NcFile:
    """The only file of a program of one tool, its motion proven to be that of the moves."""
    program = path.program()
    (file,) = write_files(program, job(out_units=units), post)
    assert_moves(file, program.moves, post)
    return file


def assert_moves(file: NcFile, moves: Moves, post: Post) -> None:
    """Assert that our reader, and for LinuxCNC its interpreter, moves as the moves do: kinds, ends, feeds, none
    missing.
    """
    read = read_program(file.nc.text.encode(), ReadOptions(dialect=post.dialect))
    assert read.problems == ()
    rows = [k for k in range(len(read.motions)) if read.motions.line[k] not in file.nc.home_lines]
    seen = [(int(read.motions.kind[k]), tuple(read.motions.end[k]), read.motions.feed[k]) for k in rows]
    assert_alike(seen, moves)
    assert {int(line) for line in file.nc.lines} <= {int(read.motions.line[k]) for k in rows}
    if post.title == "LinuxCNC":
        assert len(canonical_calls(file.nc.text)) > 0
        assert_alike([(int(m.kind), m.end, m.feed) for m in exact_motions(file.nc.text)], moves)


def assert_alike(seen: list[tuple[int, tuple[float, ...], float]], moves: Moves) -> None:
    """The approach along Z comes first; moves that go nowhere are left out on both sides."""
    meant = [(int(kind), tuple(end), feed) for kind, end, feed in zip(moves.kind, moves.end, moves.feed, strict=True)]
    meant = [
        one for k, one in enumerate(meant) if k == 0 or np.max(np.abs(np.subtract(one[1], meant[k - 1][1]))) > 5e-4
    ]
    seen = [one for k, one in enumerate(seen) if k == 0 or np.max(np.abs(np.subtract(one[1], seen[k - 1][1]))) > 5e-4][
        1:
    ]
    assert [one[0] for one in seen] == [one[0] for one in meant]
    for (kind, end, feed), (_, meant_end, meant_feed) in zip(seen, meant, strict=True):
        assert np.max(np.abs(np.subtract(end, meant_end))) <= 3e-3
        assert kind == MoveKind.RAPID or abs(feed - meant_feed) <= 0.13


def blocks(file: NcFile) -> list[str]:
    return [line for line in file.nc.text.splitlines() if line[0] not in "(%O"]


def test_a_row_of_holes() -> None:
    path = Holes(feed=120.0).drilled(10, 10, -6).drilled(20, 10, -6).drilled(20, 20, -7.5)
    file = written(path, load_post("linuxcnc"))
    body = blocks(file)
    start = body.index("G0 Z5.0000")
    assert body[start + 1 : start + 7] == [
        "X10.0000 Y10.0000",
        "G98 G81 X10.0000 Y10.0000 Z-6.0000 R1.0000 F120",
        "X20.0000 Y10.0000 Z-6.0000 R1.0000",
        "X20.0000 Y20.0000 Z-7.5000 R1.0000",
        "G80",
        "M5",
    ]
    lines = file.nc.lines.tolist()
    assert lines[1:] == [lines[0] + 1] * 3 + [lines[0] + 2] * 4 + [lines[0] + 3] * 4, (
        "the first move of a tool stands alone"
    )


def test_a_row_that_stays_low_between() -> None:
    path = Holes(feed=120.0).drilled(10, 10, -6, back=1.0).drilled(20, 10, -6, back=1.0).up(5.0)
    body = blocks(written(path, load_post("fanuc")))
    assert "G99 G81 X10. Y10. Z-6. R1. F120." in body and "X20. Y10. Z-6. R1." in body
    assert body[body.index("X20. Y10. Z-6. R1.") + 1 :][:2] == ["G80", "G0 Z5."]


def test_rows_that_end_at_different_heights_are_different_rows() -> None:
    path = Holes().drilled(10, 10, -6, back=1.0).drilled(20, 10, -6, back=1.0).up(5.0)
    path.drilled(30, 10, -6).drilled(30, 20, -6, back=1.0).up(5.0)
    text = written(path, load_post("haas")).nc.text
    assert [word for word in text.split() if word in ("G98", "G99", "G80")][1:] == [
        "G99",
        "G80",
        "G98",
        "G80",
        "G99",
        "G80",
    ]


def test_pecks_where_the_control_is_known_to_peck_so() -> None:
    path = Holes(feed=90.0).pecked(5, 5, -7, 2.5).pecked(9, 5, -7, 2.5).chipped(15, 5, -6, 3.5)
    body = blocks(written(path, load_post("linuxcnc")))
    assert "G98 G83 X5.0000 Y5.0000 Z-7.0000 R1.0000 Q2.5000 F90" in body
    assert "G98 G73 X15.0000 Y5.0000 Z-6.0000 R1.0000 Q3.5000" in body
    for name in ("fanuc", "haas", "mach3"):  # their gap is a setting of their own, and taken as the same
        assert {"G83", "G73"} <= set(written(path, load_post(name)).nc.text.split())


def test_pecks_of_another_gap_are_written_out() -> None:
    path = Holes().over(5, 5).feed_to(-2).up(1).up(-1.5).feed_to(-4).up(5)
    assert not {"G83", "G73", "G81"} & set(written(path, load_post("linuxcnc")).nc.text.split())


def test_uneven_pecks_are_written_out() -> None:
    path = Holes().over(5, 5).feed_to(-2).up(1).up(-2 + GAP).feed_to(-3).up(1).up(-3 + GAP).feed_to(-7).up(5)
    assert not {"G83", "G73", "G81"} & set(written(path, load_post("linuxcnc")).nc.text.split())


@POSTS
def test_grbl_has_no_cycles_and_the_others_cancel_theirs(name: str) -> None:
    path = Holes().drilled(10, 10, -6).rapid(0, 0, 5).rapid(0, 0, 1).line(0, 0, -1).line(5, 0, -1).out_of_work()
    body = blocks(written(path, load_post(name)))
    assert any("G81" in line for line in body) is (name in WITH_CYCLES)
    if name in WITH_CYCLES:
        after = body[next(k for k, line in enumerate(body) if "G81" in line) + 1 :]
        assert after[0] == "G80" and after[1].startswith("G0 X0")


def test_a_feed_that_is_no_drilling_is_no_hole() -> None:
    path = Path().into_work(5, 5).out_of_work()
    assert "G81" not in written(path, load_post("linuxcnc")).nc.text


def test_a_hole_that_is_left_at_feed_is_no_cycle() -> None:
    path = Holes().over(5, 5).feed_to(-6).line(5, 5, 1).up(5)
    assert "G81" not in written(path, load_post("linuxcnc")).nc.text


def test_two_speeds_in_one_hole_are_no_cycle() -> None:
    path = Holes().over(5, 5).feed_to(-2).up(-2 + GAP)
    path.feed = 60.0
    assert "G73" not in written(path.feed_to(-5).up(5), load_post("linuxcnc")).nc.text


def test_a_rapid_down_is_allowed_only_where_it_was_drilled() -> None:
    deeper = Holes().over(5, 5).feed_to(-2).up(1).up(-2.01)
    beside = Holes().over(5, 5).feed_to(-2).line(6, 5, 1).rapid(6, 5, -1)
    in_a_pocket = Path().into_work(5, 5, -2).rapid(5, 5, 1).rapid(5, 5, -1)
    for path in (deeper, beside, in_a_pocket):
        with pytest.raises(ParameterError, match="is a rapid down below retract Z 1"):
            write_files(path.rapid(*path.rows[-1][0][:2], 5).program(), job(), load_post("linuxcnc"))


holes = st.tuples(
    st.sampled_from(["drilled", "pecked", "chipped"]),
    st.integers(0, 3),
    st.integers(0, 3),
    st.floats(-9, -0.5),
    st.floats(0.4, 4),
    st.sampled_from([1.0, 5.0]),
)


@POSTS
@pytest.mark.parametrize("units", [Units.MM, Units.INCH], ids=["mm", "inch"])
@settings(max_examples=examples(12), deadline=None)
@given(rows=st.lists(holes, min_size=1, max_size=8))
def test_random_holes(name: str, units: Units, rows: list[tuple[str, int, int, float, float, float]]) -> None:
    path = Holes(feed=150.0)
    for kind, x, y, bottom, step, back in rows:
        getattr(path, kind)(10.0 + 10.0 * x, 10.0 * y, *((bottom, back) if kind == "drilled" else (bottom, step, back)))
    written(path.up(5.0), load_post(name), units)
