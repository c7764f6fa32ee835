"""The box of many curves against the boxes of each."""

from __future__ import annotations

import numpy as np

from app.geometry.sample import bounds, bounds_of_all, union
from app.model.curves import Arc, Circle, Curve, Line, Spline

_KNOTS = (0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0)


def test_the_box_of_many_is_the_union_of_their_boxes() -> None:
    for seed in range(30):
        made = np.random.default_rng(seed)

        def place(spread: float, made: np.random.Generator = made) -> tuple[float, float]:
            x, y = made.normal(0, spread, 2).tolist()
            return x, y

        curves: list[Curve] = [
            Spline(3, tuple(place(spread) for _ in range(4)), _KNOTS) for spread in (0.2, 1.0, 3.0) for _ in range(4)
        ]
        if seed % 3:
            curves += [Line(place(1), place(1)), Circle(place(1), 0.7), Arc((2.0, 0.0), (0.0, 2.0), (0.0, 0.0), True)]
        assert bounds_of_all(curves) == union([bounds(each) for each in curves])
    assert bounds_of_all([]) is None
