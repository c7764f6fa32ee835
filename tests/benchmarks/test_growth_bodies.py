"""How long it takes to find what bounds bodies together: no faster than n log n in their number."""

from __future__ import annotations

import time

import numpy as np
import pytest

from app.verify.solid_depth import outer_faces
from tests.verify.test_outer_faces import many_balls

pytestmark = pytest.mark.benchmark
SIDES = (3, 6, 9)
MOST = 1.15


def test_many_bodies_take_as_long_as_they_are_many() -> None:
    outer_faces(many_balls(2))  # so that no kernel is loaded on the way
    spent = []
    for side in SIDES:
        solid, began = many_balls(side), time.process_time()
        outer_faces(solid)
        spent.append(time.process_time() - began)
    exponent = float(np.polyfit(np.log(np.square(SIDES)), np.log(spent), 1)[0])
    assert exponent < MOST, spent
