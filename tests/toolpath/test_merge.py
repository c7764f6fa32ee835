"""Neighbouring arcs of one circle become one."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from app.geometry.primitives import Rows
from app.model.moves import Purpose
from app.toolpath.build import Stroke, merged


def arcs(angles: list[float], radius: float = 2.0, turn: float = 1.0) -> Rows:
    """Arcs round X 1 Y 1 from each angle to the next."""
    places = np.column_stack([1 + radius * np.cos(angles), 1 + radius * np.sin(angles)])
    rest = np.tile([1.0, 1.0, radius, turn], (len(angles) - 1, 1))
    return np.hstack([places[:-1], places[1:], rest])


def stroke(rows: Rows) -> Stroke:
    return Stroke(rows, np.full(len(rows), Purpose.CONTOUR, np.uint8), 0)


@pytest.mark.parametrize("turn", [1.0, -1.0])
def test_arcs_of_one_circle_become_one(turn: float) -> None:
    angles = (turn * np.array([0.1, 0.7, 1.9, 2.0])).tolist()
    line = np.array([[1 + 2 * math.cos(angles[-1]), 1 + 2 * math.sin(angles[-1]), 9.0, 9.0, 0, 0, 0, 0]])
    rows = np.concatenate([arcs(angles, turn=turn), line])
    found = merged(stroke(rows)).rows
    assert found.tolist() == [[*rows[0, :2], *rows[2, 2:4], 1.0, 1.0, 2.0, turn], line[0].tolist()]


def test_a_full_turn_stays_in_two() -> None:
    found = merged(stroke(arcs([0.0, 2.0, 4.0, 2 * math.pi]))).rows
    assert len(found) == 2
    assert found[0, 2:4].tolist() == found[1, :2].tolist()


def test_what_differs_stays_apart() -> None:
    rows = arcs([0.0, 0.5, 1.0])
    plain = stroke(rows)
    other = rows.copy()
    other[1, 4] += 1e-3
    assert len(merged(plain).rows) == 1
    assert len(merged(stroke(other)).rows) == 2
    assert len(merged(replace(plain, purpose=np.array([Purpose.CONTOUR, Purpose.LINK], np.uint8))).rows) == 2
    assert len(merged(replace(plain, least_z=np.array([-1.0, -2.0]))).rows) == 2
