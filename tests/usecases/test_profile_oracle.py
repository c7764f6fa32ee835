"""Curves in regions of any outline r = f(z), as they are written: each place of the new text within the solids of
revolution about the old moves, by dense samples of both texts alone.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest

from app.fitting.point_curves.region_profile import profile_of_formula
from app.gcode.posts import load_post
from app.usecases.smoothing.result import SmoothOptions
from app.usecases.smoothing.smooth import smooth
from tests.usecases.test_smooth_oracle import ADVERSARIES, WAYS, paired, program
from tests.usecases.written_curves import Floats, along, moves_of, off, spread

PLACES = 12_000
OUTLINES: dict[str, Callable[[Floats], Floats]] = {
    "0.02 + 0.03*sin(pi*z)": lambda z: 0.02 + 0.03 * np.sin(math.pi * z),
    "0.02 + 0.01*cos(6*pi*z)": lambda z: 0.02 + 0.01 * np.cos(6 * math.pi * z),
    "0.03 / (1 + z**1.5)": lambda z: 0.03 / (1 + z**1.5),
    "max(0.01, 0.03 - abs(z-0.5)/10)": lambda z: np.maximum(0.01, 0.03 - np.abs(z - 0.5) / 10),
}


def out_of(places: Floats, points: Floats, outline: Callable[[Floats], Floats]) -> float:
    """How far places are out of the union of all solids, with balls at the points, mm; negative within."""
    ends = outline(np.array([0.0, 1.0]))
    least = np.full(len(places), np.inf)
    for a, b in pairwise(points):
        chord, to = b - a, places - a
        share = to @ chord / (chord @ chord)
        away = np.linalg.norm(to - share[:, None] * chord, axis=1)
        body = np.where((share >= 0) & (share <= 1), away - outline(np.clip(share, 0, 1)), np.inf)
        balls = np.linalg.norm(to, axis=1) - ends[0], np.linalg.norm(places - b, axis=1) - ends[1]
        least = np.minimum.reduce([least, body, *balls])
    return float(least.max())


@pytest.mark.parametrize(
    ("name", "formula", "way"),
    [
        pytest.param(
            name,
            formula,
            way,
            marks=[] if (name, formula, way) == ("bulge", next(iter(OUTLINES)), "knots") else pytest.mark.exhaustive,
        )
        for name in ("bulge", "crumbs", "reversal", "helix")
        for formula in OUTLINES
        for way in WAYS
    ],
)
def test_written_curves_are_within_the_solids_about_the_moves(name: str, formula: str, way: str) -> None:
    profile, outline, data = profile_of_formula(formula), OUTLINES[formula], program(ADVERSARIES[name][0]()[:600])
    (form, post), old = WAYS[way], data.decode()
    control = load_post(post)
    done = smooth(
        "p.nc", data, SmoothOptions(profile.radius, form, post=control, dialect=control.dialect, profile=profile)
    )
    new = done.data.decode()
    for k, (first, last) in paired(old.splitlines(), new.splitlines(), done).items():
        stretch = done.pieces[k].stretch
        moves = [move for move in moves_of(old) if stretch.first_line <= move.line <= stretch.last_line]
        points = np.vstack([moves[0].start, *(move.end for move in moves)])
        curve = along([move for move in moves_of(new) if first <= move.line <= last], PLACES)
        assert out_of(curve, points, outline) <= 1e-6, "the curve leaves the region"
        assert off(points, curve).max() <= outline(np.array([0.0, 1.0])).max() + 1e-5, "the curve leaves out a point"
        assert off(spread(points, PLACES), curve).max() <= profile.widest + 1e-5, "the curve leaves out some of a move"
