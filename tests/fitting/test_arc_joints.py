"""Where one arc becomes another within a facet is found to the points' own digits, and nowhere where none does."""

from __future__ import annotations

import math

import numpy as np
import pytest

from app.fitting.point_curves.arc_joints import arc_joints, joint_between
from app.fitting.point_curves.through_points import SplineLimits, through_points
from app.model.motion import Floats
from tests.fitting.test_line_joints import turned

COUNT = 6


def two_arcs(share: float, before: float, behind: float, step: float = 1.0) -> Floats:
    """Points of two arcs (radii, signed: positive to the left) that meet at 0, 0 in the direction of X; a share of the
    facet over the joint is the first arc's.
    """
    one = -step * (share + np.arange(COUNT))[::-1] / before
    other = step * (1 - share + np.arange(COUNT)) / behind
    x = np.concatenate([before * np.sin(one), behind * np.sin(other)])
    y = np.concatenate([before * (1 - np.cos(one)), behind * (1 - np.cos(other))])
    return np.column_stack([x, y, np.zeros_like(x)])


@pytest.mark.parametrize("share", [0.03, 0.5, 0.9])
@pytest.mark.parametrize("radii", [(30.0, -20.0), (40.0, 15.0), (-8.0, -3.0), (1e9, 12.0)])
def test_the_joint_of_two_arcs_is_found_wherever_they_lie(share: float, radii: tuple[float, float]) -> None:
    points = turned(two_arcs(share, *radii))
    joint = joint_between(points[:COUNT], points[COUNT:], 1e-3)
    assert joint is not None
    assert np.allclose(joint.place, turned(np.zeros((1, 3)))[0], atol=1e-6)
    assert np.abs(joint.curvatures) == pytest.approx(np.abs(1 / np.array(radii)), abs=1e-7)
    away = turned(two_arcs(share, *radii) + [0.0, 0.02, 0.0])
    on = joint.nearest(away)
    assert np.allclose(on, joint.nearest(on), atol=1e-9)
    assert np.linalg.norm(on - away, axis=1).max() <= 0.02 + 1e-9


def test_digits_of_points_move_the_joint_by_little() -> None:
    points = two_arcs(0.4, 30.0, -20.0).round(4)
    joint = joint_between(points[:COUNT], points[COUNT:], 4e-4)
    assert joint is not None and abs(joint.place[0]) < 0.02 and abs(joint.place[1]) < 1e-4


def test_what_bends_evenly_or_twists_has_no_joint() -> None:
    t = 0.05 * np.arange(40)
    circle = np.column_stack([20 * np.sin(t), 20 * (1 - np.cos(t)), 0 * t])
    ellipse = np.column_stack([40 * np.cos(t), 25 * np.sin(t), 0 * t])
    clothoid = np.column_stack([t - t**5 / 40, t**3 / 3 - t**7 / 42, 0 * t])
    helix = circle + np.array([0.0, 0.0, 0.4]) * t[:, None]
    for some in (circle, circle.round(4), ellipse, ellipse.round(4), clothoid * 10, helix, circle[:7]):
        assert arc_joints(some, np.zeros(len(some) - 1, np.bool_), 4e-4)[0] == []


@pytest.mark.parametrize("begin", [-3.5, -1.0])
def test_over_a_facet_much_longer_than_its_neighbours_an_even_curvature_has_no_joint(begin: float) -> None:
    """About an inflection several facets are one range: 7 mm beside chords of 1.5 mm, on a cubic."""
    steps = 1.48 * np.arange(10)
    x = np.concatenate([begin - steps[::-1], begin + 7.1 + steps])
    points = np.column_stack([x, 1.25e-4 * x**3, 0 * x]).round(4)
    assert arc_joints(points, np.zeros(len(points) - 1, np.bool_), 4e-3)[0] == []


def test_a_joint_at_the_end_of_a_facet_is_told_once() -> None:
    points = two_arcs(0.0, 30.0, -20.0)
    joints, chords = arc_joints(points, np.zeros(len(points) - 1, np.bool_), 1e-3)
    assert len(joints) == len(chords) == 1
    assert math.dist(joints[0].place, (0.0, 0.0, 0.0)) < 1e-6


@pytest.mark.parametrize("share", [0.0, 0.4])
def test_splines_on_both_sides_of_a_joint_keep_to_their_arcs(share: float) -> None:
    points = two_arcs(share, 30.0, -20.0, 3.0)
    filled = through_points(points, np.array([0, len(points) - 1]), SplineLimits(1e-5, 1.0))
    middle = np.where(filled[:, :1] < 0, [[0.0, 30.0]], [[0.0, -20.0]])
    radius = np.where(filled[:, 0] < 0, 30.0, 20.0)
    off = np.abs(np.hypot(*(filled[:, :2] - middle).T) - radius)
    assert off.max() < 4e-4  # a spline across the joint is 0.01 off
