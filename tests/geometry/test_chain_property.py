"""Random outlines cut up, shuffled, reversed, drawn twice and shaken below the tolerance come back as the same
outlines.
"""

import math
import random
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.geometry.arcs.arcs import equally_far
from app.geometry.chaining.chain import chain
from app.geometry.primitives import contour_rows, points_at, signed_area
from app.model.curves import Arc, Circle, Curve, Line, Point, reversed_curve
from app.model.finding import FindingKind
from app.model.part import Contour, Entity
from tests.examples import examples

TOLERANCE = 0.01


def outline(rng: random.Random, x: float, y: float) -> list[Line | Arc]:
    """A star-shaped ring of 3 to 12 lines and shallow arcs round (x, y), within 10 mm of it."""
    count = rng.randint(3, 12)
    angles = [math.tau * (k + rng.uniform(-0.3, 0.3)) / count for k in range(count)]
    corners = [(x + r * math.cos(a), y + r * math.sin(a)) for a in angles for r in [rng.uniform(4, 9)]]
    ring: list[Line | Arc] = []
    for a, b in zip(corners, [*corners[1:], corners[0]], strict=True):
        bulge = rng.choice([0.0, 0.0, 0.1, -0.1, 0.05])
        if bulge == 0:
            ring.append(Line(a, b))
        else:
            h = (1 / bulge - bulge) / 4
            centre = ((a[0] + b[0]) / 2 - (b[1] - a[1]) * h, (a[1] + b[1]) / 2 + (b[0] - a[0]) * h)
            ring.append(Arc(a, b, centre, bulge > 0))
    return ring


def point_on(curve: Line | Arc, share: float) -> Point:
    if isinstance(curve, Line):
        return curve.start[0] + share * (curve.end[0] - curve.start[0]), curve.start[1] + share * (
            curve.end[1] - curve.start[1]
        )
    angle = curve.start_angle + share * curve.sweep
    return curve.centre[0] + curve.radius * math.cos(angle), curve.centre[1] + curve.radius * math.sin(angle)


def between(curve: Line | Arc, a: Point, b: Point) -> Line | Arc:
    return Line(a, b) if isinstance(curve, Line) else Arc(a, b, equally_far(a, b, curve.centre), curve.ccw)


def cut_up(rng: random.Random, ring: list[Line | Arc], shake: float) -> list[Line | Arc]:
    """Pieces of a ring in random order and direction, some twice, each end off by up to `shake` in x and y."""
    pieces: list[Line | Arc] = []
    for curve in ring:
        shares = [0.0, *([rng.uniform(0.3, 0.7)] if rng.random() < 0.4 else []), 1.0]
        ends = [curve.start, *(point_on(curve, s) for s in shares[1:-1]), curve.end]
        for a, b in pairwise(ends):
            shaken = [(p[0] + rng.uniform(-shake, shake), p[1] + rng.uniform(-shake, shake)) for p in (a, b)]
            piece = between(curve, shaken[0], shaken[1])
            pieces.append(piece)
            if rng.random() < 0.2:
                pieces.append(reversed_curve(piece))  # type: ignore[arg-type]
    rng.shuffle(pieces)
    return [reversed_curve(p) if rng.random() < 0.5 else p for p in pieces]  # type: ignore[misc]


def distance_from(ring: list[Line | Arc], points: np.ndarray) -> float:
    """Greatest distance of points from a ring, the ring as 2,000 points a curve."""
    dense = np.array([point_on(curve, k / 2000) for curve in ring for k in range(2001)])
    return max(float(np.hypot(*(dense - p).T).min()) for p in points)


def home_of(contour: Contour) -> tuple[int, int]:
    return round(contour.primitives[0].start[0] / 30), round(contour.primitives[0].start[1] / 30)


@pytest.mark.parametrize("shake", [0.0, 0.003])
@settings(max_examples=examples(60), deadline=None)
@given(seed=st.integers(0, 2**32))
def test_outlines_come_back(shake: float, seed: int) -> None:
    rng = random.Random(seed)
    rings = {(i, j): outline(rng, 30.0 * i, 30.0 * j) for i in range(3) for j in range(2)}
    pieces: list[Curve] = [piece for ring in rings.values() for piece in cut_up(rng, ring, shake)]
    rng.shuffle(pieces)
    made = chain([Entity(k, piece) for k, piece in enumerate(pieces, 1)], TOLERANCE)
    assert sorted(map(home_of, made.contours)) == sorted(rings)
    assert not [f.text for f in made.findings if f.counts]
    for contour in made.contours:
        ring = rings[home_of(contour)]
        original = contour_rows(Contour(tuple(ring)))
        rows = contour_rows(contour)
        assert contour.closed and contour.primitives[-1].end == contour.primitives[0].start
        assert all(a.end == b.start for a, b in zip(contour.primitives, contour.primitives[1:], strict=False))
        assert abs(signed_area(rows)) == pytest.approx(abs(signed_area(original)), abs=1e-6 + 100 * shake)
        if seed % 8 == 0:
            assert distance_from(ring, points_at(rows, np.full(len(rows), 0.37))) <= 0.006 + 4 * shake


@settings(max_examples=examples(40), deadline=None)
@given(seed=st.integers(0, 2**32))
def test_one_curve_taken_away_leaves_one_open_contour(seed: int) -> None:
    rng = random.Random(seed)
    ring = outline(rng, 0, 0)
    missing = ring.pop(rng.randrange(len(ring)))
    rng.shuffle(ring)
    made = chain([Entity(k, curve) for k, curve in enumerate([*ring, Circle((100, 100), 5)], 1)], TOLERANCE)
    assert sorted(c.closed for c in made.contours) == [False, True]
    (found,) = [f for f in made.findings if f.counts]
    assert found.amount == pytest.approx(math.dist(missing.start, missing.end))
    open_one = next(c for c in made.contours if not c.closed)
    assert {open_one.primitives[0].start, open_one.primitives[-1].end} == {missing.start, missing.end}


@st.composite
def scribbles(draw: st.DrawFn) -> list[Curve]:
    """Curves on a coarse grid, with small offsets, so that ends coincide, nearly coincide, overlap and cross."""
    offset = st.sampled_from([0.0, 0.0, 0.0, 1e-7, 5e-4, 0.004, 0.009])
    place = st.builds(lambda x, y, dx, dy: (x + dx, y - dy), st.integers(0, 3), st.integers(0, 3), offset, offset)
    found: list[Curve] = []
    for _ in range(draw(st.integers(1, 14))):
        a, b = draw(place), draw(place)
        kind = draw(st.sampled_from(["line", "line", "arc", "circle", "again"]))
        if kind == "circle":
            found.append(Circle(a, draw(st.sampled_from([0.003, 0.5, 1.0]))))
        elif kind == "again" and found:
            found.append(reversed_curve(draw(st.sampled_from(found))))
        elif kind == "arc" and a != b:
            bulge = draw(st.sampled_from([1.0, -1.0, 0.2, -0.4, 30.0]))
            h = (1 / bulge - bulge) / 4
            found.append(
                Arc(a, b, ((a[0] + b[0]) / 2 - (b[1] - a[1]) * h, (a[1] + b[1]) / 2 + (b[0] - a[0]) * h), bulge > 0)
            )
        else:
            found.append(Line(a, b))
    return found


@settings(max_examples=examples(300), deadline=None)
@given(scribbles(), st.sampled_from([0.0, 1e-3, 0.01, 0.5]))
def test_any_scribble_gives_sound_contours(curves: list[Curve], tolerance: float) -> None:
    made = chain([Entity(k, curve) for k, curve in enumerate(curves, 1)], tolerance)
    known = [k for contour in made.contours for k in contour.entity_ids]
    assert len(known) == len(set(known)) and set(known) <= set(range(1, len(curves) + 1))
    for contour in made.contours:
        assert all(a.end == b.start for a, b in pairwise(contour.primitives))
        assert contour.closed == (contour.primitives[0].start == contour.primitives[-1].end)
        for p in contour.primitives:
            assert isinstance(p, Circle) or p.start != p.end
            assert not isinstance(p, Arc) or abs(math.dist(p.start, p.centre) - math.dist(p.end, p.centre)) < 1e-9
    open_ones = [f for f in made.findings if f.kind is FindingKind.OPEN_CONTOUR]
    loose = [contour for contour in made.contours if not contour.closed]
    assert {k for f in open_ones for k in f.entity_ids} == {k for contour in loose for k in contour.entity_ids}
    assert all(finding.text.endswith(".") and "nan" not in finding.text for finding in made.findings)
