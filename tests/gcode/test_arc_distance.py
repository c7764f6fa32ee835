"""The bound on the distance of a written motion from its stretch of an arc: never less than what is there, and hardly
more.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from app.gcode.checks.check_kernels import in_step


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
