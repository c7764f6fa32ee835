"""What the writer says that its text holds is what the text holds, by plain reading and by the control's interpreter."""

from __future__ import annotations

import math
import re
from dataclasses import replace

import numpy as np
import pytest

from app.model.job import OriginXY
from app.model.moves import MoveKind
from app.model.part import Units
from app.nc.post import ArcCentre, Post
from app.nc.posts import load_post
from app.nc.write import NcText, write_program
from tests.nc.programs import Path, job, two_tools
from tests.nc.rs274_oracle import exact_motions

LINUXCNC = load_post("linuxcnc")


def write(path: Path, post: Post = LINUXCNC, **changes: object) -> NcText:
    return write_program(path.program(), job(**changes), post)


def read_kinds(text: str) -> list[int]:
    """The G word of every motion block, read from the text alone."""
    kinds, motion = [], -1
    for line in text.splitlines():
        block = re.sub(r"\([^)]*\)", "", line)
        if word := re.search(r"\bG0?([0123])\b(?!\.)", block):
            motion = int(word[1])
        if re.search(r"[XYZ]-?\d", block):
            kinds.append(motion)
    return kinds


@pytest.mark.parametrize("units", [Units.MM, Units.INCH], ids=["mm", "inch"])
def test_every_motion_block_is_counted(units: Units) -> None:
    nc = write(two_tools(), out_units=units)
    assert nc.motions.kind.tolist() == read_kinds(nc.text)
    assert len(nc.motions.kind) > len(two_tools().moves())


@pytest.mark.parametrize("units", [Units.MM, Units.INCH], ids=["mm", "inch"])
def test_lengths_are_those_that_the_control_moves(units: Units) -> None:
    nc = write(two_tools(), out_units=units, origin_xy=OriginXY.CENTRE)
    motions = exact_motions(nc.text)
    assert [int(motion.kind) for motion in motions] == nc.motions.kind.tolist()
    moved = [length(motion.points(20_000)) for motion in motions]
    assert nc.motions.length[2:] == pytest.approx(moved[2:], abs=1e-5)
    assert nc.motions.length[:2].tolist() == [0.0, 0.0]


def test_absolute_centres_change_no_length() -> None:
    absolute = replace(LINUXCNC, arcs=replace(LINUXCNC.arcs, centre=ArcCentre.ABSOLUTE))
    there, here = write(two_tools(), absolute), write(two_tools())
    assert there.text != here.text
    assert there.motions.length == pytest.approx(here.motions.length)


def length(points: np.ndarray) -> float:
    return float(np.sum(np.linalg.norm(np.diff(points, axis=0), axis=1)))


def test_blocks_know_their_move() -> None:
    path = two_tools()
    nc, moves = write(path), path.moves()
    feed = nc.motions.kind != MoveKind.RAPID
    assert np.all(np.diff(nc.motions.move) >= 0)
    assert set(nc.motions.move.tolist()) == set(range(len(moves)))
    assert np.all((moves.kind[nc.motions.move] != MoveKind.RAPID) == feed)


def test_a_split_circle_counts_twice_and_is_as_long() -> None:
    nc = write(Path().into_work(10, 0).arc((10, 0, -1), (15, 0)).out_of_work())
    blocks = np.flatnonzero(nc.motions.kind == MoveKind.ARC_CCW)
    assert len(blocks) > 1
    assert len(set(nc.motions.move[blocks].tolist())) == 1
    assert float(np.sum(nc.motions.length[blocks])) == pytest.approx(math.tau * 5, abs=1e-3)


def test_a_path_that_ends_in_work_counts_its_lift() -> None:
    path = Path().into_work(1, 1).line(5, 1, -1)
    motions = write(path).motions
    assert (motions.kind[-1], motions.length[-1], motions.move[-1]) == (MoveKind.RAPID, 6.0, len(path.moves()) - 1)
