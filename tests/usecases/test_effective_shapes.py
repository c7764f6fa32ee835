"""Method D on its purpose: a program made from facets goes, written anew, along the shape that the facets stood for.

The written text is evaluated by `written_curves`, which knows none of our reader and curves, and held against the shape
itself; beside it the same program smoothed by all of its points, and a plain spline through the facets' ends.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from scipy.interpolate import BSpline, CubicSpline
from scipy.spatial import cKDTree
from scipy.special import fresnel

from app.core.errors import InputError
from app.fitting.point_curves.correction import CorrectionOptions, CorrectionScope
from app.fitting.point_curves.effective_method import EffectiveMethod, second_embodiment
from app.fitting.point_curves.effective_points import EffectiveOptions, effective_points
from app.usecases.smoothing.report import report
from app.usecases.smoothing.result import OutputForm, SmoothedProgram, SmoothOptions
from app.usecases.smoothing.smooth import smooth
from tests.usecases.written_curves import Floats, moves_of

Shape = Callable[[Floats], Floats]
INNER = 4
"""Points within each facet."""
DIGIT = 1e-4
"""mm; of a program for LinuxCNC."""


def circle(t: Floats) -> Floats:
    return 50 * np.column_stack([np.cos(math.pi * t), np.sin(math.pi * t)])


def ellipse(t: Floats) -> Floats:
    return np.column_stack([40 * np.cos(math.pi * t), 25 * np.sin(math.pi * t)])


def offset_spline(t: Floats) -> Floats:
    """A cubic spline's parallel, 5 mm to its left."""
    control = np.array([[0, 0], [15, 0], [30, 18], [55, 20], [75, 2], [95, 6], [110, 30.0]])
    knots = np.concatenate([np.zeros(4), [0.25, 0.5, 0.75], np.ones(4)])
    curve = BSpline(knots, control, 3)
    way = curve.derivative()(t)
    return curve(t) + 5 * np.column_stack([-way[:, 1], way[:, 0]]) / np.linalg.norm(way, axis=1)[:, None]


def torus_section(t: Floats) -> Floats:
    """Half of where a plane 18 mm off its axis cuts a torus of 40 and 15 mm."""
    angle = math.pi * (0.1 + 0.8 * t)
    across = 40 + 15 * np.cos(angle)
    return np.column_stack([np.sqrt(across**2 - 18**2), 15 * np.sin(angle)])


def sine(t: Floats) -> Floats:
    return np.column_stack([100 * t, 8 * np.sin(4 * math.pi * t)])


def clothoid(t: Floats) -> Floats:
    along = 2.4 * (t - 0.5)
    return 40 * np.column_stack(fresnel(along)[::-1])


def airfoil(t: Floats) -> Floats:
    """NACA 0012, its chord 100 mm, round its nose."""
    v = 2 * t - 1
    half = 0.2969 * np.abs(v) - 0.1260 * v**2 - 0.3516 * v**4 + 0.2843 * v**6 - 0.1036 * v**8
    return np.column_stack([100 * v**2, 60 * np.sign(v) * half])


def two_arcs(before: float, behind: float, sweeps: tuple[float, float]) -> Shape:
    """Two arcs that meet smoothly: radii, signed, positive to the left, and sweeps, degrees."""
    turns = math.radians(sweeps[0]) * np.sign(before), math.radians(sweeps[1]) * np.sign(behind)
    first, second = turns[0] * before, turns[1] * behind

    def places(t: Floats) -> Floats:
        along = t * (first + second)
        own, rest = np.minimum(along, first) / before, np.maximum(along - first, 0.0) / behind
        one = before * np.column_stack([np.sin(own), 1 - np.cos(own)])
        other = behind * np.column_stack(
            [np.sin(turns[0] + rest) - math.sin(turns[0]), math.cos(turns[0]) - np.cos(turns[0] + rest)]
        )
        return one + other

    return places


SHAPES: dict[str, Shape] = {
    "circle": circle,
    "ellipse": ellipse,
    "offset": offset_spline,
    "torus": torus_section,
    "sine": sine,
    "clothoid": clothoid,
    "airfoil": airfoil,
    "s-curve": two_arcs(30, -20, (120, 150)),
    "widening": two_arcs(40, 15, (60, 120)),
}
JOINED = ("s-curve", "widening")
"""Shapes whose curvature jumps, within a facet: no one spline goes along them."""


@cache
def facet_ends(shape: str, sag: float) -> Floats:
    """Ends of facets that are all about so far off the shape in their middles, at most 20 % farther."""
    t = np.linspace(0, 1, 200_001)
    places = SHAPES[shape](t)
    way = np.gradient(places, t, axis=0)
    turn = np.gradient(np.unwrap(np.arctan2(way[:, 1], way[:, 0])), t)
    speed = np.linalg.norm(way, axis=1)
    density = np.sqrt(np.maximum(np.abs(turn) * speed, 0.05 * (np.abs(turn) * speed).max()) / (8 * sag))
    total = np.concatenate([[0], np.cumsum((density[1:] + density[:-1]) / 2 * np.diff(t))])
    count = math.ceil(total[-1])
    return SHAPES[shape](np.interp(np.linspace(0, total[-1], count + 1), total, t))


def faceted(shape: str, sag: float) -> bytes:
    """A program along the facets, with points within each."""
    return along_facets(facet_ends(shape, sag))


def along_facets(ends: Floats) -> bytes:
    """A program along chords, with points within each."""
    share = np.arange(1, INNER + 2) / (INNER + 1)
    points = (ends[:-1, None] + (ends[1:] - ends[:-1])[:, None] * share[None, :, None]).reshape(-1, 2)
    first = "G21 G90 G17 G94\nG0 X{:.4f} Y{:.4f} Z5\nG1 Z-1 F200\nF900\n".format(*ends[0])
    return (first + "".join(f"G1 X{x:.4f} Y{y:.4f}\n" for x, y in points) + "G0 Z5\nM2\n").encode()


@cache
def written(shape: str, sag: float, form: OutputForm, method: int) -> SmoothedProgram:
    choose = EffectiveOptions(max(sag / 10, 2 * DIGIT))
    effective = [None, EffectiveMethod(choose), EffectiveMethod(choose, second_embodiment())][method]
    options = SmoothOptions(2.5 * sag + 5 * DIGIT, form, effective=effective)
    return smooth("facets.ngc", faceted(shape, sag), options)


def off(shape: str, places: Floats) -> float:
    """How far places are from the shape at most: from the tangent at the nearest of many places of it."""
    t = np.linspace(-0.002, 1.002, 400_001) if shape in ("circle", "ellipse") else np.linspace(0, 1, 400_001)
    line = SHAPES[shape](t)
    near = np.clip(cKDTree(line).query(places)[1], 1, len(line) - 2)
    way = line[near + 1] - line[near - 1]
    apart = places - line[near]
    return float(np.max(np.abs(apart[:, 0] * way[:, 1] - apart[:, 1] * way[:, 0]) / np.linalg.norm(way, axis=1)))


def cut(done: SmoothedProgram) -> Floats:
    """Places of all that the written text cuts at its depth."""
    moves = [move for move in moves_of(done.data.decode()) if not move.rapid and move.start[2] == move.end[2] == -1]
    return np.vstack([move.at(np.linspace(0, 1, 400))[:, :2] for move in moves])


def plain_spline(shape: str, sag: float) -> float:
    """How far a spline through the facets' ends, as the program has them, is from the shape."""
    ends = np.round(facet_ends(shape, sag), 4)
    along = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(ends, axis=0), axis=1))])
    return off(shape, CubicSpline(along, ends)(np.linspace(0, along[-1], 100_000)))


def by_effective(done: SmoothedProgram, points: Floats) -> Floats:
    """The effective points that a program's report names, of all its points (n, 2)."""
    (stretch,) = report(done)["stretches"]["listed"]
    return points[[stretch["ranges"][0]["first"], *(each["last"] for each in stretch["ranges"])]]


def random_shape(seed: int) -> tuple[Shape, float]:
    """An ellipse or a wavy spline nobody has seen, and a sag."""
    random = np.random.default_rng(seed)
    sag = float(np.exp(random.uniform(math.log(0.002), math.log(0.05))))
    if seed % 2:
        a, b = random.uniform(10, 80, 2)
        return lambda t: np.column_stack([a * np.cos(math.pi * t), b * np.sin(math.pi * t)]), sag
    count = int(random.integers(5, 9))
    x = np.linspace(0, 100, count) + random.uniform(-4, 4, count)
    control = np.column_stack([x, random.uniform(-15, 15, count)])
    curve = BSpline(np.concatenate([np.zeros(4), np.linspace(0, 1, count - 2)[1:-1], np.ones(4)]), control, 3)
    return lambda t: curve(np.clip(t, 0, 1)), sag


@pytest.mark.exhaustive
@pytest.mark.parametrize("seed", [*range(10), 30, 62, 74, 78, 92])
def test_on_shapes_it_has_not_seen_it_is_as_good_as_the_plain_spline(seed: int, monkeypatch) -> None:
    """Through the ends of all facets, also where these turn by little: at an inflection."""
    shape, sag = random_shape(seed)
    monkeypatch.setitem(SHAPES, f"random {seed}", shape)
    done = written(f"random {seed}", sag, OutputForm.ARCS, 1)
    ends = facet_ends(f"random {seed}", sag)
    share = np.arange(1, INNER + 2) / (INNER + 1)
    inner = (ends[:-1, None] + (ends[1:] - ends[:-1])[:, None] * share[None, :, None]).reshape(-1, 2)
    points = by_effective(done, np.vstack([ends[:1], inner]).round(4))
    along = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    plain = off(f"random {seed}", CubicSpline(along, points)(np.linspace(0, along[-1], 100_000)))
    own, by_all = (
        off(f"random {seed}", cut(each)) for each in (done, written(f"random {seed}", sag, OutputForm.ARCS, 0))
    )
    assert done.nearness is not None and own <= 2 * plain + done.nearness
    assert np.abs(points - ends).max() < DIGIT
    assert own <= max(by_all / 10, 2 * plain, 2 * DIGIT + done.nearness)


FAMILY = [(shape, sag) for shape in SHAPES for sag in (0.004 if shape in JOINED else 0.002, 0.01, 0.05)]
COARSE = {("airfoil", 0.05)}
"""Round its nose, of radius 1.6 mm, five facets turn by more than one cubic does."""
SIXFOLD = {("sine", 0.05)}
"""Its facets are so few that the spline through the points alone comes no ten times nearer than they do."""
FAST = {("ellipse", 0.01), ("circle", 0.05), ("s-curve", 0.05)}


@pytest.mark.parametrize("form", [OutputForm.ARCS, OutputForm.NURBS], ids=lambda form: form.value)
@pytest.mark.parametrize(
    ("shape", "sag"),
    [
        pytest.param(*each, marks=[] if each in FAST else pytest.mark.exhaustive, id=f"{each[0]}-{each[1]}")
        for each in FAMILY
    ],
)
def test_the_curve_goes_along_the_shape_and_not_along_the_facets(shape: str, sag: float, form: OutputForm) -> None:
    """No farther from it than twice the plain spline through the points and what they and the blocks are rounded by."""
    by_points, by_all = (off(shape, cut(written(shape, sag, form, method))) for method in (1, 0))
    done = written(shape, sag, form, 1)
    assert done.nearness is not None
    assert by_points <= 2 * plain_spline(shape, sag) + done.nearness
    assert by_points <= max(by_all / (6 if (shape, sag) in SIXFOLD else 10), 2 * DIGIT + done.nearness)
    assert all(not piece.kept for piece in done.pieces)


@pytest.mark.parametrize("form", [OutputForm.ARCS, OutputForm.NURBS], ids=lambda form: form.value)
@pytest.mark.parametrize(
    ("shape", "sag"),
    [
        pytest.param(*each, marks=[] if each in FAST else pytest.mark.exhaustive, id=f"{each[0]}-{each[1]}")
        for each in FAMILY
        if each not in COARSE
    ],
)
def test_corrected_points_lead_nearer_to_the_shape_than_all_points(shape: str, sag: float, form: OutputForm) -> None:
    """Ten times, and no farther than twice the plain spline through the points, as the first embodiment."""
    corrected, by_all = (off(shape, cut(written(shape, sag, form, method))) for method in (2, 0))
    nearness = written(shape, sag, form, 2).nearness
    assert nearness is not None
    assert corrected <= max(by_all / (5 if (shape, sag) in SIXFOLD else 10), 2 * DIGIT + nearness)
    assert corrected <= 2 * plain_spline(shape, sag) + nearness


def irregular(shape: str, sag: float, height: str = "-1") -> bytes:
    """A program along facets with two to six points in each, wherever they happen to lie."""
    random, ends = np.random.default_rng(109), facet_ends(shape, sag)
    points = []
    for a, b in pairwise(ends):
        share = np.append(np.sort(random.uniform(0.08, 0.92, random.integers(2, 7))), 1.0)
        points.append(a + (b - a) * share[:, None])
    first = f"G21 G90 G17 G94\nG0 X{ends[0, 0]:.4f} Y{ends[0, 1]:.4f} Z5\nG1 Z{height} F200\nF900\n"
    return (first + "".join(f"G1 X{x:.4f} Y{y:.4f}\n" for x, y in np.vstack(points)) + "G0 Z5\nM2\n").encode()


@pytest.mark.parametrize("shape", ["ellipse", pytest.param("torus", marks=pytest.mark.exhaustive)])
@pytest.mark.parametrize(
    "correct",
    [
        None,
        second_embodiment(),
        pytest.param(second_embodiment((CorrectionScope.RATIO, 0.25)), marks=pytest.mark.exhaustive),
        pytest.param(second_embodiment((CorrectionScope.DISTANCE, 0.004)), marks=pytest.mark.exhaustive),
    ],
    ids=["effective", "corrected", "near ends", "by little"],
)
def test_points_may_lie_in_their_facets_anywhere(shape: str, correct: CorrectionOptions | None) -> None:
    """Two far apart between two near ones are no side of the shape: its facets tell sides, not the points in them."""
    sag = 0.01
    method = EffectiveMethod(EffectiveOptions(sag / 10), correct)
    done = smooth("a.ngc", irregular(shape, sag), SmoothOptions(0.0255, OutputForm.ARCS, effective=method))
    assert done.nearness is not None
    assert off(shape, cut(done)) <= 2 * plain_spline(shape, sag) + done.nearness < sag / 10


def test_what_is_level_stays_level_where_points_are_corrected() -> None:
    """To the last bit, at any height: LinuxCNC has splines at one height only."""
    method = EffectiveMethod(EffectiveOptions(0.001), second_embodiment())
    options = SmoothOptions(0.0255, OutputForm.NURBS, effective=method)
    done = smooth("a.ngc", irregular("ellipse", 0.01, "-1.37"), options)
    assert done.kinds.splines > 20 and not done.refusals


def test_a_step_to_the_next_row_stays_a_corner_however_wide_the_tolerance_is() -> None:
    """Of the tolerance the method has only what the facets are off; rows half a millimetre apart are not one curve."""
    x, facets = np.linspace(0, 20, 21), np.linspace(0, 20, 5)
    z = np.interp(x, facets, -((facets - 7) ** 2) / 80)
    rows = [np.column_stack([x, np.full(21, k / 2), z])[:: (-1) ** k] for k in range(4)]
    text = "".join("G1 X{:.4f} Y{:.4f} Z{:.4f} F900\n".format(*place) for place in np.vstack(rows))
    method = EffectiveMethod(EffectiveOptions(0.01), second_embodiment())
    done = smooth(
        "rows.ngc", f"G21 G90 G17 G94\nG0 X0 Y0 Z5\n{text}M2\n".encode(), SmoothOptions(0.4, effective=method)
    )
    (piece,) = done.pieces
    assert piece.classes is not None and piece.classes.moved.max() < 0.08
    places = np.vstack([move.at(np.linspace(0, 1, 400)) for move in moves_of(done.data.decode()) if not move.rapid])
    ends = [row[end] for row in rows for end in (0, -1)][1:]
    assert cKDTree(places).query(ends)[0].max() < 1e-9


@pytest.mark.parametrize("form", [OutputForm.ARCS, OutputForm.NURBS], ids=lambda form: form.value)
@pytest.mark.parametrize("correct", [None, second_embodiment()], ids=["effective", "corrected"])
@pytest.mark.parametrize("sag", [0.005, pytest.param(0.03, marks=pytest.mark.exhaustive)])
def test_a_line_that_goes_on_into_an_arc_stays_a_line(
    sag: float, correct: CorrectionOptions | None, form: OutputForm
) -> None:
    """A long line is no facet: nothing is corrected across it, and the curve beside it leaves in its direction."""
    count = math.ceil(math.pi / (2 * math.acos(1 - sag / 20)))
    turn = np.linspace(0, math.pi, count + 1)
    arc = np.column_stack([40 + 20 * np.sin(turn), 20 - 20 * np.cos(turn)])
    program = along_facets(np.vstack([[0, 0], arc, [0, 40]]))
    tolerance, choose = 2.5 * sag + 5 * DIGIT, EffectiveOptions(max(sag / 10, 2 * DIGIT))
    done = smooth("a.ngc", program, SmoothOptions(tolerance, form, effective=EffectiveMethod(choose, correct)))
    places = cut(done)
    from_line = np.where(places[:, 1] < 20, np.abs(places[:, 1]), np.abs(40 - places[:, 1]))
    from_arc = np.abs(np.hypot(places[:, 0] - 40, places[:, 1] - 20) - 20)
    away = np.where(places[:, 0] < 40, from_line, from_arc).max()
    assert done.nearness is not None
    assert away <= (done.nearness if correct is None else 2 * done.nearness) < sag / 3


SHARES = (0.15, 0.5, 0.85)


@pytest.mark.parametrize("form", [OutputForm.ARCS, pytest.param(OutputForm.NURBS, marks=pytest.mark.exhaustive)])
@pytest.mark.parametrize("correct", [None, second_embodiment()], ids=["effective", "corrected"])
@pytest.mark.parametrize(
    ("sag", "share"),
    [
        pytest.param(sag, share, marks=[] if (sag, share) == (0.03, 0.5) else pytest.mark.exhaustive)
        for sag in (0.005, 0.03)
        for share in SHARES
    ],
)
def test_a_facet_over_the_joint_of_a_line_and_an_arc_becomes_both(
    sag: float, share: float, correct: CorrectionOptions | None, form: OutputForm
) -> None:
    """So much of it is line, the rest is arc; ends of ranges on the line are within epsilon of it, as in the text."""
    step = 2 * math.acos(1 - sag / 20)
    turn = step * (1 - share + np.arange(math.floor(math.pi / step + share)))
    turn = turn[turn < math.pi - 0.3 * step]
    arc = np.column_stack([40 + 20 * np.sin(turn), 20 - 20 * np.cos(turn)])
    after = 20 * max(step - (math.pi - turn[-1]), 0.2 * step)
    program = along_facets(np.vstack([[0, 0], [40 - 20 * share * step, 0], arc, [40 - after, 40], [0, 40]]))
    choose = EffectiveOptions(max(sag / 10, 2 * DIGIT))
    done = smooth(
        "a.ngc", program, SmoothOptions(2.5 * sag + 5 * DIGIT, form, effective=EffectiveMethod(choose, correct))
    )
    places = cut(done)
    from_line = np.where(places[:, 1] < 20, np.abs(places[:, 1]), np.abs(40 - places[:, 1]))
    from_arc = np.abs(np.hypot(places[:, 0] - 40, places[:, 1] - 20) - 20)
    away = np.where(places[:, 0] < 40, from_line, from_arc).max()
    assert done.nearness is not None and done.nearness < sag / 10
    assert away <= 2 * done.nearness + (choose.epsilon if share > 0.5 else 0.0)
    if correct is None and share <= 0.5:
        assert away < sag / 50 + 2 * DIGIT


@pytest.mark.parametrize(
    ("shape", "digits", "wrong"),
    [("s-curve", 4, 0), ("ellipse", 3, 2), pytest.param("circle", 3, 0, marks=pytest.mark.exhaustive)],
)
def test_ends_of_facets_are_found_where_rounding_decides_where_the_loop_stops(
    shape: str, digits: int, wrong: int
) -> None:
    """Facets 0.002 mm off the shape bend by some last decimals: the text's loop alone goes a point too far."""
    ends = facet_ends(shape, 0.002)
    share = np.arange(1, INNER + 2) / (INNER + 1)
    inner = (ends[:-1, None] + (ends[1:] - ends[:-1])[:, None] * share[None, :, None]).reshape(-1, 2)
    points = np.vstack([ends[:1], inner]).round(digits)
    choose, seam = EffectiveOptions(2 * 10.0**-digits), [0, len(points) - 1]
    plain, settled = (
        effective_points(points, choose, seam, at_bends=True, settled=settled).ranges[:-1, 1]
        for settled in (False, True)
    )
    missed = [int(np.count_nonzero(found % (INNER + 1))) for found in (plain, settled)]
    assert missed[0] > missed[1] <= wrong
    assert off(shape, points[settled]) <= off(shape, points[plain])


def test_the_certificate_states_both_limits_and_each_point() -> None:
    done = written("ellipse", 0.01, OutputForm.ARCS, 1)
    told = report(done)
    ends = len(facet_ends("ellipse", 0.01))
    assert told["points"]["effective"] == ends and told["points"]["left_out"] == INNER * (ends - 1)
    assert told["points"]["farthest_mm"] <= told["points"]["nearness_mm"] == done.nearness == 4 * DIGIT
    assert told["tolerance"]["proven_mm"] <= told["tolerance"]["asked_mm"]
    (stretch,) = told["stretches"]["listed"]
    assert [each["first"] for each in stretch["ranges"]] == list(range(0, (INNER + 1) * (ends - 1), INNER + 1))
    assert [each["is"] for each in stretch["points"][: INNER + 2]] == ["effective", *["invalid"] * INNER, "effective"]
    assert f"nearness {done.nearness:g} mm to them" in done.data.decode()


def test_a_nearness_that_is_asked_for_is_kept() -> None:
    method = EffectiveMethod(EffectiveOptions(0.005), nearness=0.004)
    wide = smooth("facets.ngc", faceted("ellipse", 0.01), SmoothOptions(0.03, effective=method))
    assert wide.nearness == 0.004
    assert sum(piece.blocks[1] for piece in wide.pieces) < 0.7 * sum(
        piece.blocks[1] for piece in written("ellipse", 0.01, OutputForm.ARCS, 1).pieces
    )
    ends = facet_ends("ellipse", 0.01)
    places = cut(wide)
    apart = np.linalg.norm(np.diff(places, axis=0), axis=1).max()
    assert cKDTree(places).query(ends)[0].max() < math.hypot(0.004 + 1e-4, apart / 2)
    assert off("ellipse", places) < 0.0045


def test_a_nearness_below_the_digits_is_refused() -> None:
    method = EffectiveMethod(EffectiveOptions(0.005), nearness=1e-4)
    with pytest.raises(InputError, match=r"nearness of 0.0001 mm is too near to the last decimal"):
        smooth("facets.ngc", faceted("ellipse", 0.01), SmoothOptions(0.03, effective=method))
