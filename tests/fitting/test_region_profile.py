"""Regions of any outline r = f(z): bounds that hold, and a judge whose inside is inside by dense sampling."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

from app.core.errors import ParameterError
from app.fitting.point_curves.region_profile import (
    CELLS,
    RegionProfile,
    judge_in_profile,
    profile_of_formula,
    profile_of_table,
)
from app.fitting.point_curves.space_curve import SpaceCurve, curve_of_nurbs
from app.fitting.point_curves.tube import ToleranceTube, TubeAnswer, judge
from app.model.motion import Nurbs

NAMES = {
    "pi": math.pi,
    "sin": np.sin,
    "cos": np.cos,
    "exp": np.exp,
    "sqrt": np.sqrt,
    "abs": np.abs,
    "min": np.minimum,
    "max": np.maximum,
}
FORMULAS = (
    "0.01",
    "0.01 + 0.08*z*(1-z)",
    "0.01 + 0.02*sin(pi*z)",
    "0.02 + 0.01*cos(6*pi*z)",
    "0.01 + 0.03*min(z, 1-z)",
    "max(0.01, 0.03 - abs(z-0.5)/10)",
    "0.01*exp(-z)",
    "sqrt(0.0001 + 0.003*z*(1-z))",
    "0.02 + (z-0.5)**2/20 - (z-0.5)**3/100",
    "0.03 / (1 + z**1.5)",
)


def value(formula: str, z: np.ndarray) -> np.ndarray:
    return np.asarray(eval(formula, {"__builtins__": {}}, NAMES | {"z": z})) + 0 * z


@pytest.mark.parametrize("formula", FORMULAS)
def test_bounds_hold_and_are_near(formula: str) -> None:
    profile = profile_of_formula(formula)
    z = np.concatenate([np.random.default_rng(0).uniform(0, 1, 50_000), np.arange(CELLS) / CELLS])
    r, cell = value(formula, z), (z * CELLS).astype(int)
    assert np.all(profile.low[cell] <= r) and np.all(r <= profile.high[cell])
    assert (r - profile.low[cell]).max() <= 5e-4
    assert profile.ends == pytest.approx(tuple(value(formula, np.array([0.0, 1.0]))), abs=1e-9)


def test_a_table_is_straight_between_its_places_however_near_they_are() -> None:
    rows = [(0, 0.01), (0.3, 0.05), (0.30001, 0.002), (0.7, 0.03), (1, 0.02)]
    profile = profile_of_table(",".join(f"{z}={r}" for z, r in rows))
    z = np.concatenate([np.linspace(0, 1, 99_999)[:-1], [0.3, 0.30001]])
    r, cell = np.interp(z, *np.array(rows).T), (z * CELLS).astype(int)
    assert np.all(profile.low[cell] <= r + 1e-15) and np.all(r <= profile.high[cell] + 1e-15)
    assert profile.inscribed.radius == 0.002


@pytest.mark.parametrize(
    "formula",
    ["z", "1/z", "__import__('os')", "z**z", "0.01+", "foo(z)", "'a'", "sin(z, z)", "1e400", "z.real", "20", "log(z)"]
    + ["9" * 400, "z * " + "9" * 400, "z ** " + "9" * 400, "9" * 5000, "-" * 20000 + "z", "1j * z", "1 / (z - 0.5)"],
)
def test_what_is_no_radius_is_refused(formula: str) -> None:
    with pytest.raises(ParameterError):
        profile_of_formula(formula)


@pytest.mark.parametrize(
    "table", ["", "0=0.01", "0=0.01,1", "0.1=0.01,1=0.02", "0=0.01,0.5=0.02,0.5=0.03,1=0.01", "a=b"]
)
def test_what_is_no_table_is_refused(table: str) -> None:
    with pytest.raises(ParameterError):
        profile_of_table(table)


def bulging(points: np.ndarray, off: float) -> SpaceCurve:
    """A spline through the points of a polyline that leaves each chord by about `off` in its middle, to and fro."""
    n = len(points) - 1
    chord = points[1:] - points[:-1]
    left = np.column_stack([-chord[:, 1], chord[:, 0], 0 * chord[:, 0]]) / np.linalg.norm(chord, axis=1)[:, None]
    pieces = np.stack(
        [
            points[:-1] + share * chord + (off * 4 / 3 if inner else 0) * left
            for share, inner in ((0, False), (1 / 3, True), (2 / 3, True), (1, False))
        ],
        axis=1,
    )
    control = np.concatenate([pieces[0, :1], pieces[:, 1:].reshape(-1, 3)])
    knots = np.concatenate([[0.0], np.repeat(np.arange(n + 1.0), 3), [float(n)]])
    return curve_of_nurbs(Nurbs(control, np.ones(len(control)), knots, 3))


def out_of(curve: SpaceCurve, points: np.ndarray, formula: str) -> float:
    """By dense samples alone: how far the curve is out of the union of the regions of all chords, mm."""
    places = curve.at(np.linspace(0, len(curve), 400 * len(curve) + 1))
    least = np.full(len(places), np.inf)
    for a, b in pairwise(points):
        chord = b - a
        share = (places - a) @ chord / (chord @ chord)
        off = np.linalg.norm(places - a - share[:, None] * chord, axis=1)
        body = np.where((share >= 0) & (share <= 1), off - value(formula, np.clip(share, 0, 1)), np.inf)
        balls = [
            np.linalg.norm(places - end, axis=1) - value(formula, np.array([z]))[0] for end, z in ((a, 0.0), (b, 1.0))
        ]
        least = np.minimum.reduce([least, body, *balls])
    return float(least.max())


@pytest.mark.parametrize("formula", FORMULAS)
def test_what_is_inside_is_inside_by_samples_and_what_is_not_is_refused(formula: str) -> None:
    angle = np.linspace(0, 2.5, 9)
    points = 10 * np.column_stack([np.cos(angle), np.sin(angle), 0.1 * angle])
    profile, answers = profile_of_formula(formula), set()
    for off in np.linspace(0, 1.3 * profile.widest, 27).tolist():
        curve = bulging(points, off)
        found, out = judge_in_profile(curve, points, profile), out_of(curve, points, formula)
        answers.add(found.answer)
        if found.answer is TubeAnswer.INSIDE:
            assert out <= 1e-4 and found.bound <= profile.widest + 1e-9
        else:
            assert out > -2e-3, "hardly anything that is well inside is refused"
    assert answers >= {TubeAnswer.INSIDE, TubeAnswer.OUTSIDE}


def test_a_waist_counts_where_a_cylinder_as_wide_as_the_rest_would_not_see_it() -> None:
    points = np.array([[0.0, 0, 0], [10, 0, 0], [20, 0, 0]])
    curve = bulging(points, 0.02)
    waist = profile_of_table("0=0.03,0.4=0.03,0.5=0.01,0.6=0.03,1=0.03")
    assert judge(curve, points, ToleranceTube(0.03)).answer is TubeAnswer.INSIDE
    found = judge_in_profile(curve, points, waist)
    assert found.answer is TubeAnswer.OUTSIDE and found.feet is None
    assert abs(found.place[0] % 10 - 5) < 1.1, "the witness is at the waist"


def test_a_barrel_by_its_formula_is_the_barrel() -> None:
    points = np.array([[0.0, 0, 0], [10, 0, 0], [20, 1, 0]])
    barrel = ToleranceTube(0.01, 0.03)
    outline: RegionProfile = profile_of_formula("sqrt(0.0001 + 4*0.0008*z*(1-z))")
    for off in np.linspace(0.0, 0.04, 9).tolist():
        if abs(off - 0.03) < 2e-4:
            continue
        curve = bulging(points, off)
        assert judge(curve, points, barrel).answer is judge_in_profile(curve, points, outline).answer
