"""Method D across neighbouring passes: a raster over a polyhedron is told apart by the polyhedron's facets."""

from __future__ import annotations

import math

import numpy as np
import pytest

from app.fitting.point_curves.effective_method import EffectiveMethod, states_across
from app.fitting.point_curves.effective_points import EffectiveOptions, PointState
from app.usecases.smoothing.result import SmoothedProgram, SmoothOptions
from app.usecases.smoothing.smooth import smooth

R, SIDES, PASSES = 40.0, 14, 9


def height(x: np.ndarray) -> np.ndarray:
    """Of a cylinder's polygon: its corners lie on the circle."""
    angle = np.linspace(math.pi * 0.75, math.pi * 0.25, SIDES + 1)
    return np.interp(x, R * np.cos(angle), R * np.sin(angle) - R)


def raster() -> tuple[str, list[np.ndarray]]:
    """A zigzag along X over it, with points at the polygon's corners and between, a pass each 2 mm."""
    angle = np.linspace(math.pi * 0.75, math.pi * 0.25, SIDES + 1)
    x = np.unique(
        np.concatenate([R * np.cos(angle), np.linspace(-R * math.sqrt(0.5), R * math.sqrt(0.5), 71)]).round(4)
    )
    rows = []
    for k in range(PASSES):
        own = x if k % 2 == 0 else x[::-1]
        rows.append(np.column_stack([own, np.full(len(own), 2.0 * k), height(own)]))
    lines = [f"X{a:.4f} Y{b:.4f} Z{c:.4f}" for a, b, c in np.concatenate(rows).tolist()]
    head = f"G21 G90 G17 G94 G40 G49 G80\nT1 M6\nS8000 M3\nG0 X{x[0]:.4f} Y0.0\nG1 Z{rows[0][0, 2]:.4f} F200\n"
    return head + f"G1 {lines[1]} F600\n" + "\n".join(lines[2:]) + "\nG0 Z20.0\nM5\nM2\n", rows


def smoothed(across: bool) -> SmoothedProgram:
    method = EffectiveMethod(EffectiveOptions(0.005), across=across)
    return smooth("raster.ngc", raster()[0].encode(), SmoothOptions(0.15, effective=method))


def off_cylinder(places: np.ndarray) -> np.ndarray:
    return np.abs(np.hypot(places[:, 0], places[:, 2] + R) - R)


def test_effective_points_are_those_at_the_borders_of_facets() -> None:
    _, rows = raster()
    corners = [np.array([0, len(row) - 1]) for row in rows]
    states = states_across(rows, corners, 0.005)
    angle = np.linspace(math.pi * 0.75, math.pi * 0.25, SIDES + 1)
    for row, state in zip(rows[1:-1], states[1:-1], strict=True):
        inside = row[state == PointState.INVALID]
        kept = row[state == PointState.EFFECTIVE]
        beside = np.abs(kept[:, 0][:, None] - R * np.cos(angle)).min(axis=0)
        assert len(inside) > 0.4 * len(row)
        assert beside.max() < 0.05, "at every corner of the polygon, or a twentieth beside it, is a point that counts"
    assert np.all(states[0] == PointState.EFFECTIVE) and np.all(states[-1] == PointState.EFFECTIVE), "the cloud's rim"


def test_a_single_pass_has_no_neighbours() -> None:
    _, rows = raster()
    [state] = states_across(rows[:1], [np.array([0, len(rows[0]) - 1])], 0.005)
    assert np.all(state == PointState.EFFECTIVE)


@pytest.mark.parametrize("across", [False, True])
def test_a_raster_is_written_within_both_limits_whichever_way_points_are_told_apart(across: bool) -> None:
    done = smoothed(across)
    [piece] = [each for each in done.pieces if each.judgement is not None]
    assert piece.classes is not None and piece.near is not None and done.bound <= 0.15
    invalid = int(np.sum(piece.classes.state == PointState.INVALID))
    assert invalid > 0.4 * len(piece.points) * (PASSES - 2) / PASSES
    assert done.nearness is not None and done.farthest_point <= done.nearness
