"""The bound on the distance of a written motion from its stretch of an arc: never less than what is there, and hardly
more.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from app.gcode.checks import path
from app.gcode.checks.check_kernels import in_step
from app.gcode.checks.path import MotionOwners, ReferencePath
from app.model.motion import MotionKind, Motions, Plane
from app.model.moves import MoveKind


def points(arc: np.ndarray, t: np.ndarray) -> np.ndarray:
    radius, angle = arc[2] + (arc[3] - arc[2]) * t, arc[4] + arc[5] * t
    return arc[0] + radius * np.cos(angle) + 1j * (arc[1] + radius * np.sin(angle))


@pytest.mark.parametrize("seed", range(300))
def test_it_is_an_upper_bound_and_near(seed: int) -> None:
    chance = np.random.default_rng(seed)
    radius, sweep = (
        10.0 ** chance.uniform(-2, 3),
        chance.choice([-1, 1]) * 10.0 ** chance.uniform(-3, math.log10(2 * math.pi)),
    )
    meant = np.array(
        [*chance.normal(0, 10, 2), radius, radius * (1 + 1e-6 * chance.normal()), chance.uniform(-4, 4), sweep]
    )
    first, last = sorted(chance.uniform(0, 1, 2))
    error = 10.0 ** chance.uniform(-6, -2)
    size = last - first
    written = np.array(
        [
            *(meant[:2] + error * chance.normal(0, 1, 2)),
            radius + error * chance.normal(),
            radius + error * chance.normal(),
            meant[4] + sweep * first,
            sweep * size + error / radius * chance.normal(),
        ]
    )
    t = np.linspace(0, 1, 20_001)
    straight = bool(chance.integers(2))
    there = points(written, t)
    ends = np.array([there[0].real, there[0].imag, there[-1].real, there[-1].imag])
    if straight:
        there, written = there[0] + (there[-1] - there[0]) * t, np.zeros(6)
    found = np.empty(1)
    in_step(written[None], ends[None], meant[None], np.array([[first, last]]), found)
    true = float(np.max(np.abs(there - points(meant, first + size * t))))
    assert true <= found[0] * (1 + 1e-9) + 1e-12
    bulge = radius * (sweep * size) ** 2 / 512 if straight else 0.0
    assert found[0] <= 1.25 * true + 2 * bulge + 1e-9


def test_a_whole_turn_more_is_far_away() -> None:
    meant = np.array([[0, 0, 5, 5, 0.3, 1.0]])
    written = meant + [[0, 0, 0, 0, 0, 2 * math.pi]]
    found = np.empty(1)
    in_step(written, np.zeros((1, 4)), meant, np.array([[0.0, 1.0]]), found)
    assert found[0] > 5


@pytest.mark.parametrize("portion", [1, 4, 100_000])
def test_each_of_many_arcs_is_as_far_off_as_its_centre_whatever_is_looked_at_together(
    monkeypatch: pytest.MonkeyPatch, portion: int
) -> None:
    """Half circles of 10 mm from -X to +X, written round centres that lie 0, 0.01, 0.02 .. mm too high: so far is the
    top off, and a little more, as the radius grows. Every third one is written in two.
    """
    monkeypatch.setattr(path, "_AT_A_TIME", portion)
    count = 11
    x, off, zero = 20.0 * np.arange(count), 0.01 * np.arange(count), np.zeros(count)
    start, end = (np.column_stack([x + side, zero, zero]) for side in (-5.0, 5.0))
    meant = ReferencePath(
        start,
        end,
        np.column_stack([x, zero]),
        np.full(count, -np.pi),
        np.full(count, MoveKind.ARC_CW, np.uint8),
    )
    pieces = np.where(np.arange(count) % 3 == 0, 2, 1)
    move = np.repeat(np.arange(count), pieces)
    first = np.cumsum(pieces) - pieces
    second = np.append(False, move[1:] == move[:-1])
    top = np.column_stack([x, off + np.hypot(5.0, off), zero])[move]
    both = pieces[move] == 2
    motions = Motions(
        np.where(second[:, None], top, start[move]),
        np.where((both & ~second)[:, None], top, end[move]),
        np.column_stack([x, off, zero])[move],
        np.full(len(move), MotionKind.ARC_CW, np.uint8),
        np.full(len(move), Plane.XY, np.uint8),
        np.ones(len(move), np.int32),
        np.full(len(move), 100.0),
        np.arange(1, len(move) + 1, dtype=np.int32),
        np.zeros(len(move), np.int32),
    )
    owners = MotionOwners(np.arange(len(move)), move, first, pieces, first + pieces - 1)
    found = path.distances(motions, meant, owners)
    assert np.all(found >= off + np.hypot(5.0, off) - 5.0 - 1e-12)
    assert np.all(found <= 1.3 * off + 1e-9)
