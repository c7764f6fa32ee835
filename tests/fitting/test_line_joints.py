"""Where a line becomes an arc within a facet is found to the points' own digits, and nowhere where it does not."""

from __future__ import annotations

import math

import numpy as np
import pytest

from app.fitting.point_curves.line_joints import joint_behind
from app.fitting.point_curves.through_points import SplineLimits, joints_beside, sides_among, through_points
from app.model.motion import Floats


def line_and_arc(share: float, radius: float, count: int = 6, step: float = 0.05) -> Floats:
    """Points of a line along X to 0, 0 and of an arc that goes on; a share of the facet over the joint is line."""
    turn = step * (1 - share + np.arange(count))
    arc = np.column_stack([radius * np.sin(turn), radius * (1 - np.cos(turn)), np.zeros(count)])
    return np.vstack([[-30, 0, 0], [-radius * share * step, 0, 0], arc])


def turned(points: Floats) -> Floats:
    """Into space, by two turns."""
    a, b = 0.7, -1.1
    one = np.array([[math.cos(a), -math.sin(a), 0], [math.sin(a), math.cos(a), 0], [0, 0, 1]])
    other = np.array([[1, 0, 0], [0, math.cos(b), -math.sin(b)], [0, math.sin(b), math.cos(b)]])
    return points @ one.T @ other.T + [3, -8, 2]


@pytest.mark.parametrize("share", [0.1, 0.5, 0.9])
@pytest.mark.parametrize("radius", [4.0, 60.0])
def test_the_joint_of_a_line_and_an_arc_is_found_wherever_they_lie(share: float, radius: float) -> None:
    points = turned(line_and_arc(share, radius))
    joint = joint_behind(points[:2], points[2:], 1e-6)
    assert joint is not None and joint.radius == pytest.approx(radius, rel=1e-6)
    assert np.allclose(joint.place, turned(np.zeros((1, 3)))[0], atol=1e-6 * radius)
    asked = turned(np.array([[-0.2, 0.1, 0.0], [radius * math.sin(0.3), radius * (1 - math.cos(0.3)) + 0.02, 0.0]]))
    on = turned(np.array([[-0.2, 0.0, 0.0]]))[0]
    nearest = joint.nearest(asked)
    assert np.allclose(nearest[0], on, atol=1e-6 * radius)
    assert np.linalg.norm(nearest[1] - (joint.place + radius * joint.aside)) == pytest.approx(radius, rel=1e-9)


def test_digits_of_points_move_the_joint_by_little() -> None:
    points = line_and_arc(0.4, 20.0).round(4)
    joint = joint_behind(points[:2], points[2:], 6e-4)
    assert joint is not None and abs(joint.place[0]) < 0.02 and joint.place[1] == 0.0


def test_corners_ellipses_and_edges_are_no_joints() -> None:
    points = line_and_arc(0.5, 20.0)
    bent = points + [0, 0.05, 0] * (np.arange(len(points)) > 1)[:, None]
    t = 0.12 * (0.5 + np.arange(6))
    ellipse = np.column_stack([40 * np.sin(t), 6 * (1 - np.cos(t)) + 4 * np.sin(t) ** 3, np.zeros(6)])
    twisted = points + [0, 0, 0.02] * (np.arange(len(points))[:, None] % 2)
    for some in (bent, np.vstack([points[:2], ellipse]), twisted, points[:4], line_and_arc(0.0, 20.0)):
        assert joint_behind(some[:2], some[2:], 1e-4) is None


def test_of_a_path_every_side_is_looked_at_both_ways() -> None:
    half = line_and_arc(0.5, 20.0, 40, math.pi / 40)
    points = np.vstack([half[:-1], [[-20 * 0.5 * math.pi / 40, 40, 0], [-30, 40, 0]]])
    joints = joints_beside(points, sides_among(points), 1e-5)
    assert np.allclose(joints.places, [[0, 0, 0], [0, 40, 0]], atol=1e-5)
    made = through_points(points, np.array([0, len(points) - 1]), SplineLimits(1e-5, 0.05))
    off = np.where(
        made[:, 0] > 0, np.abs(np.hypot(made[:, 0], made[:, 1] - 20) - 20), np.abs(np.abs(made[:, 1] - 20) - 20)
    )
    assert off.max() < 5e-5  # a spline over the facets at both joints would be 0.0040 off
