"""Where a path lies, how large it is, which way it is driven and how finely it is cut makes no other curve of it.

Exact motions (turns by 90 degrees, mirrors, powers of two) give the very same splines and lines. All others round
points in their last bits, or decimals, and a decision that hangs on these may fall the other way: then a few blocks
more or less stand there, and the curve is another one of the tube. Never may the bound be missed.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.fitting.fitted import FittedPath
from app.fitting.line_arcs.arc_fit import ArcOptions, fit_arcs
from app.fitting.point_curves.proven_curve import SplineOptions, fit_splines
from app.fitting.point_curves.space_curve import curve_of_motions
from app.fitting.point_curves.tube import ToleranceTube, TubeAnswer, judge
from app.gcode.posts import load_post
from app.usecases.smoothing.result import OutputForm, SmoothOptions
from app.usecases.smoothing.smooth import smooth
from tests.examples import examples
from tests.usecases.test_smooth_oracle import WAYS, closed, eight, helix, noisy, paired, program, quantised, twisted
from tests.usecases.written_curves import Floats, along, moves_of, off

TOLERANCE = 0.02
PLACES = 20_000
CHORDS = 1e-4
"""mm at a scale of 1; how far a chord from one of so many places to the next may be from its curve."""

FITS: dict[str, Callable[[Floats, float], FittedPath]] = {
    "cubic": lambda points, tolerance: fit_splines(points, SplineOptions(ToleranceTube(tolerance))),
    "quintic": lambda points, tolerance: fit_splines(points, SplineOptions(ToleranceTube(tolerance), 5)),
    "arcs": lambda points, tolerance: fit_arcs(points, ArcOptions(tolerance)),
    "lines": lambda points, tolerance: fit_arcs(points, ArcOptions(tolerance, arcs=False)),
}
SHAPES = {"closed": closed, "eight": eight, "helix": helix, "noisy": noisy, "quantised": quantised, "twisted": twisted}

FEW = {"cubic": 1.4, "quintic": 1.4, "arcs": 1.15, "lines": 1.15}
"""One of two forms of a path may take so many times the blocks of the other: spans of splines are halved where the
proof fails, so that few decisions make many of them.
"""


@dataclass(frozen=True)
class Change:
    """Another form of the same path: `there` of its points, `back` of the curve; the tolerance goes with its scale."""

    there: Callable[[Floats], Floats]
    back: Callable[[Floats], Floats]
    scale: float = 1.0


def by(matrix: Floats, scale: float = 1.0) -> Change:
    """A turn or a mirror, and a scale."""
    return Change(lambda p: p @ matrix.T * scale, lambda p: p @ matrix / scale, scale)


def turn(angle: float) -> Floats:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1.0]])


def halves(points: Floats) -> Floats:
    """Every chord with its middle."""
    out = np.empty((2 * len(points) - 1, 3))
    out[::2], out[1::2] = points, (points[1:] + points[:-1]) / 2
    return out


def same(points: Floats) -> Floats:
    return points


EXACT = {
    "by 90 degrees": by(np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1.0]])),
    "by 180 degrees": by(np.diag([-1, -1, 1.0])),
    "mirrored": by(np.diag([-1, 1, 1.0])),
    "8 times": by(np.eye(3), 8),
}
ROUNDED = {
    "10 times": by(np.eye(3), 10),
    "turned": by(turn(0.7)),
    "elsewhere": Change(lambda p: p + [1000, -500, 20], lambda p: p - [1000, -500, 20]),
    "aslant": Change(lambda p: np.round(p @ turn(0.7).T, 4), lambda p: p @ turn(0.7)),
    "reversed": Change(lambda p: p[::-1], lambda p: p[::-1]),
    "split": Change(halves, same),
}


def plain(points: Floats) -> Floats:
    """As a program gives them: four decimals, none twice."""
    points = np.round(points, 4)
    return points[np.concatenate([[True], np.any(np.diff(points, axis=0) != 0, axis=1)])]


def blocks(path: FittedPath) -> int:
    """Motions, a spline for each of its control points."""
    splines = path.motions.splines.values()
    return len(path.motions) + sum(len(spline.points) - 1 for spline in splines)


def places(path: FittedPath) -> Floats:
    curve = curve_of_motions(path.motions)
    return curve.at(np.linspace(0, len(curve), max(PLACES, 20 * len(curve)) + 1))


def apart(one: Floats, two: Floats) -> float:
    return float(max(off(one, two).max(), off(two, one).max()))


def fitted(points: Floats, change: Change, name: str) -> tuple[FittedPath, Floats]:
    """Return what is fitted to the changed path, proven, and its places where the path was."""
    there, tolerance = np.ascontiguousarray(change.there(points)), TOLERANCE * change.scale
    path = FITS[name](there, tolerance)
    edge = 1e-6 * tolerance
    judgement = judge(curve_of_motions(path.motions), there, ToleranceTube(tolerance + edge))
    assert judgement.answer is TubeAnswer.INSIDE and judgement.bound <= tolerance + edge
    return path, change.back(places(path))


def about(one: int, two: int, times: float) -> bool:
    """Tell whether two numbers of blocks differ by a few only."""
    return max(one, two) <= max(times * min(one, two), min(one, two) + 3)


HERE = Change(same, same)


@pytest.mark.parametrize("change", EXACT)
@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("name", ["cubic", "quintic", "lines"])
def test_exact_motions_give_the_very_same_splines_and_lines(name: str, shape: str, change: str) -> None:
    points, back = plain(SHAPES[shape]()), EXACT[change].back
    (one, before), (two, after) = (fitted(points, way, name) for way in (HERE, EXACT[change]))
    assert one.last.tolist() == two.last.tolist()
    assert np.abs(one.motions.end - back(two.motions.end)).max() == 0
    for row, spline in one.motions.splines.items():
        assert np.abs(spline.points - back(two.motions.splines[row].points)).max() == 0
    assert apart(before, after) <= 1e-9


@pytest.mark.parametrize("change", EXACT)
@pytest.mark.parametrize("shape", SHAPES)
def test_exact_motions_give_as_many_arcs(shape: str, change: str) -> None:
    points = plain(SHAPES[shape]())
    (one, before), (two, after) = (fitted(points, way, "arcs") for way in (HERE, EXACT[change]))
    few = about(blocks(one), blocks(two), 1.05)
    assert few
    assert apart(before, after) <= 2 * TOLERANCE + CHORDS


@pytest.mark.parametrize("change", ROUNDED)
@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("name", FITS)
def test_scale_place_turn_sense_and_cuts_change_nothing_but_what_rounding_decides(
    name: str, shape: str, change: str
) -> None:
    points = plain(SHAPES[shape]())
    (one, before), (two, after) = (fitted(points, way, name) for way in (HERE, ROUNDED[change]))
    few = about(blocks(one), blocks(two), FEW[name])
    assert few, (blocks(one), blocks(two))
    assert apart(before, after) <= 2 * TOLERANCE + CHORDS


@given(
    waves=st.lists(st.tuples(st.floats(-3, 3), st.floats(-3, 3), st.floats(-0.5, 0.5)), min_size=1, max_size=5),
    count=st.integers(40, 400),
    angle=st.floats(0, math.tau),
    scale=st.floats(0.2, 20),
    name=st.sampled_from(sorted(FITS)),
    backward=st.booleans(),
)
@settings(max_examples=examples(25), deadline=None)
def test_any_path_keeps_its_bound_and_its_shape_wherever_it_lies(
    waves: list[tuple[float, float, float]], count: int, angle: float, scale: float, name: str, backward: bool
) -> None:
    t = np.linspace(0, math.tau, count)
    high = np.array(waves) / np.arange(1, len(waves) + 1)[:, None]
    x, y, z = high.T @ np.sin(np.outer(np.arange(1, len(waves) + 1), t) + np.arange(len(waves))[:, None])
    points = plain(np.column_stack([10 * np.cos(t) + x, 10 * np.sin(t) + y, z]))
    matrix, way = turn(angle), -1 if backward else 1
    change = Change(lambda p: (p @ matrix.T * scale)[::way], lambda p: p[::way] @ matrix / scale, scale)
    (one, before), (two, after) = (fitted(points, each, name) for each in (HERE, change))
    assert max(blocks(one), blocks(two)) < len(points)
    few = about(blocks(one), blocks(two), 2.0)
    assert few, (blocks(one), blocks(two))
    assert apart(before, after) <= 2 * TOLERANCE + CHORDS


def written(points: Floats, tolerance: float, way: str) -> tuple[int, Floats]:
    """Return how many blocks the points' stretch takes as it is written, and places of it, from its text."""
    form, post = WAYS[way]
    data = program(points)
    done = smooth("in.nc", data, SmoothOptions(tolerance, form, post=load_post(post), dialect=load_post(post).dialect))
    assert done.bound <= tolerance
    old, new = data.decode(), done.data.decode()
    (first, last), *others = paired(old.splitlines(), new.splitlines(), done).values()
    assert not others
    made = [move for move in moves_of(new) if first <= move.line <= last]
    return last - first + 1, along(made, PLACES)


IN_THE_TEXT = {name: change for name, change in (EXACT | ROUNDED).items() if name not in ("8 times", "turned")}


@pytest.mark.parametrize("change", IN_THE_TEXT)
@pytest.mark.parametrize("way", WAYS)
def test_a_program_of_another_place_size_or_sense_is_smoothed_alike(way: str, change: str) -> None:
    """In the text all is rounded to the control's decimals, of which a program ten times as large has ten times as
    many.
    """
    points, other = np.round(eight(), 3), IN_THE_TEXT[change]
    count, before = written(points, TOLERANCE, way)
    changed, after = written(other.there(points), TOLERANCE * other.scale, way)
    few = about(count, changed, 1.4 if WAYS[way][0] is OutputForm.NURBS else 1.15)
    assert few, (count, changed)
    assert apart(before, other.back(after)) <= 2 * TOLERANCE + CHORDS
    if way == "lines" and change in EXACT:
        assert count == changed and apart(before, other.back(after)) <= 1e-9
