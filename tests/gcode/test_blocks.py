"""Whole stretches of motions as text, against a plain writer that does one after the other, for every post and both
units.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.gcode.posts import ArcCentre, Numbers, Post, load_post, post_names
from app.gcode.writer.block_kernels import NO_FEED, UNKNOWN
from app.gcode.writer.blocks import Blocks, CycleHole
from app.model.moves import MoveKind
from app.model.part import Units
from tests.examples import examples

Row = tuple[int, int, int, int, int, int, int]


@dataclass
class OneByOne:
    """What the control knows, and the lines so far."""

    post: Post
    units: Units

    def __post_init__(self) -> None:
        self.lines: list[str] = []
        self.motion_line, self.number = 0, self.post.numbers.start
        self.forget()

    def forget(self) -> None:
        self.place, self.motion, self.feed, self.cycle = [UNKNOWN] * 3, "", NO_FEED, ""

    def spelled(self, count: int, decimals: int, zeros: bool) -> str:
        text = f"{abs(count):0{decimals + 1}}"
        text = ("-" if count < 0 else "") + (f"{text[:-decimals]}.{text[-decimals:]}" if decimals else text)
        return text if zeros or not decimals else text.rstrip("0")

    def rate(self, feed: int) -> str:
        text = self.spelled(feed, self.post.digits(self.units).F, zeros=False)
        text += "" if "." in text else "."
        return text if self.post.words.feed_point else text.rstrip(".")

    def say(self, text: str) -> None:
        numbers = self.post.numbers
        self.lines.append(f"N{self.number} {text}" if numbers.use else text)
        if numbers.use:
            self.number = self.number + numbers.step if self.number + numbers.step <= 99999 else numbers.start

    def end_cycle(self) -> None:
        if self.cycle:
            self.say(self.post.drilling.cancel)
            self.cycle = ""

    def move(self, row: Row) -> None:
        kind, *end, i, j, feed = row
        words, digits, said = self.post.words, self.post.digits(self.units), {}
        for axis, letter in enumerate("XYZ"):
            if end[axis] != UNKNOWN and (end[axis] != self.place[axis] or (kind > 1 and axis < 2)):
                said[letter] = letter + self.spelled(
                    end[axis], (digits.X, digits.Y, digits.Z)[axis], words.trailing_zeros
                )
        if kind > 1:
            absolute = self.post.arcs.centre is ArcCentre.ABSOLUTE
            x, y = (
                (0 if place == UNKNOWN else place) * absolute * 10 ** (digits.I - digits.X) for place in self.place[:2]
            )
            said |= {
                letter: letter + self.spelled(count, digits.I, words.trailing_zeros)
                for letter, count in (("I", i + x), ("J", j + y))
            }
        if not said:
            return
        self.end_cycle()
        if words.motion[kind] != self.motion or not words.modal_motion:
            said["G"] = words.motion[kind]
        if feed not in (NO_FEED, self.feed):
            said["F"], self.feed = "F" + self.rate(feed), feed
        self.say(" ".join(said[letter] for letter in words.order if letter in said))
        self.place, self.motion, self.motion_line = end, words.motion[kind], len(self.lines)


small = st.integers(-3, 3)
far = st.one_of(small, st.integers(-(10**9), 10**9))
feeds = st.sampled_from([1, 5, 10, 600, 6000, 12345])
moves = st.one_of(
    st.tuples(st.just(0), far, far, far, st.just(0), st.just(0), st.just(NO_FEED)),
    st.tuples(st.just(1), far, far, far, st.just(0), st.just(0), feeds),
    st.tuples(st.just(1), small, small, small, st.just(0), st.just(0), feeds),
    st.tuples(st.sampled_from([2, 3]), small, far, small, far, small, feeds),
)
stretches = st.lists(
    st.tuples(st.sampled_from(["", "", "M5", "forget", "up", "hole"]), st.lists(moves, max_size=8)), max_size=6
)


def with_variants(post: Post) -> tuple[Post, ...]:
    """The post itself, and one that does everything the other way."""
    words, centre = post.words, post.arcs.centre
    turned = replace(
        words,
        order=words.order[::-1],
        motion=("G00", "G01", "G02", "G03"),
        modal_motion=not words.modal_motion,
        trailing_zeros=not words.trailing_zeros,
        feed_point=not words.feed_point,
    )
    finer = replace(post.decimals.mm, X=2, Y=2, Z=3, I=6, J=6, F=0)
    other = ArcCentre.INCREMENTAL if centre is ArcCentre.ABSOLUTE else ArcCentre.ABSOLUTE
    return post, replace(
        post,
        words=turned,
        decimals=replace(post.decimals, mm=finer),
        numbers=Numbers(not post.numbers.use, 99950, 7),
        arcs=replace(post.arcs, centre=other),
    )


POSTS = [
    (name + kind, post)
    for name in post_names()
    for kind, post in zip(("", " turned"), with_variants(load_post(name)), strict=True)
]


@pytest.mark.parametrize("post", [post for _, post in POSTS], ids=[name for name, _ in POSTS])
@settings(max_examples=examples(60), deadline=None)
@given(stretches=stretches, units=st.sampled_from([Units.MM, Units.INCH]))
def test_stretches_are_written_as_one_motion_after_the_other(
    post: Post, stretches: list[tuple[str, list[Row]]], units: Units
) -> None:
    sheet, plain = Blocks(post, units), OneByOne(post, units)
    for before, rows in stretches:
        if before == "forget":
            sheet.forget()
            plain.forget()
        elif before == "up":
            sheet.rapid_z(7)
            plain.move((0, plain.place[0], plain.place[1], 7, 0, 0, NO_FEED))
        elif before == "hole":
            sheet.hole(
                CycleHole("G98 G81", 4, 5, -6, 2, 0, 300, 2), [(MoveKind.RAPID, (4, 5, 2)), (MoveKind.LINE, (4, 5, -6))]
            )
            plain.lines.append(sheet.lines[-1])
            if len(sheet.lines) > len(plain.lines):  # a cycle that was in force ended before
                plain.lines.insert(-1, sheet.lines[-2])
            plain.place, plain.motion, plain.feed, plain.cycle, plain.number = (
                [4, 5, -6],
                "",
                300,
                "G98 G81",
                int(sheet._state[5]),
            )
            plain.motion_line = sheet.motion_line
        elif before:
            sheet.block(before)
            plain.end_cycle()
            plain.say(before)
        done = []
        for row in rows:
            plain.move(row)
            done.append(plain.motion_line)
        assert sheet.motions(np.array(rows, np.int64).reshape(-1, 7)).tolist() == done
        assert sheet.lines == plain.lines
        assert sheet.motion_line == plain.motion_line


def test_stretches_longer_than_a_portion_go_on_as_they_began() -> None:
    """10,000 motions to and fro: every block says X alone, and N words begin again behind N99999."""
    post = replace(load_post("linuxcnc"), numbers=Numbers(True, 10, 10))
    sheet, rows = Blocks(post, Units.MM), np.zeros((10_000, 7), np.int64)
    rows[:, 0], rows[:, 1], rows[:, 6] = 1, np.arange(10_000) % 2, 600
    lines = sheet.motions(rows)
    assert lines.tolist() == list(range(1, 10_001))
    assert sheet.lines[:3] == ["N10 G1 X0.0000 Y0.0000 Z0.0000 F60", "N20 X0.0001", "N30 X0.0000"]
    assert sheet.lines[9998:] == ["N99990 X0.0000", "N10 X0.0001"]


def test_some_rows_of_a_table() -> None:
    """None of them is nothing; one that goes nowhere has the line of the one before."""
    sheet, rest = Blocks(load_post("fanuc"), Units.MM), (0, 0, NO_FEED)
    rows = np.array([(0, 9, 9, 9, *rest), (0, 1, 2, 3, *rest), (0, 1, 2, 3, *rest), (0, 1, 2, 4, *rest)])
    assert sheet.motions(rows, 1, 1).tolist() == []
    assert sheet.motions(rows, 1).tolist() == [1, 1, 2]
    assert sheet.lines == ["G0 X0.001 Y0.002 Z0.003", "Z0.004"]


def test_axes_that_nobody_knows_are_not_said_and_end_no_cycle() -> None:
    sheet = Blocks(load_post("linuxcnc"), Units.MM)
    sheet.rapid_z(50)
    assert sheet.lines == ["G0 Z0.0050"]
    sheet.hole(CycleHole("G98 G81", 4, 5, -6, 2, 0, 300, 1), [(MoveKind.RAPID, (4, 5, 2))])
    assert sheet.motions(np.array([(1, UNKNOWN, UNKNOWN, 2, 0, 0, 600)])).tolist() == [2]
    assert sheet.motions(np.array([(1, UNKNOWN, UNKNOWN, 3, 0, 0, 600)])).tolist() == [4]
    assert sheet.lines[2:] == ["G80", "G1 Z0.0003 F60"]
