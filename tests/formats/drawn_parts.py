"""Parts drawn at random, and whether two curves are the same geometry, for the tests of readers and writers."""

import math

import numpy as np
from hypothesis import strategies as st
from numpy.typing import NDArray

from app.geometry.arcs.bezier import pieces_of
from app.model.curves import Arc, Circle, Curve, Ellipse, Line, Point, Spline
from app.model.part import Entity, Layer, Part

SPREAD = 500.0
coordinates = st.one_of(st.integers(-500, 500).map(float), st.floats(-SPREAD, SPREAD))
points = st.tuples(coordinates, coordinates)
angles = st.floats(-math.pi, math.pi)


def on_circle(centre: Point, radius: float, angle: float) -> Point:
    return centre[0] + radius * math.cos(angle), centre[1] + radius * math.sin(angle)


def arc(centre: Point, radius: float, first: float, sweep: float) -> Arc:
    return Arc(on_circle(centre, radius, first), on_circle(centre, radius, first + sweep), centre, sweep > 0)


def clamped(
    degree: int, control: list[Point], weights: tuple[float, ...] = (), inner: list[float] | tuple[float, ...] = ()
) -> Spline:
    knots = [0.0] * (degree + 1) + sorted(inner) + [1.0] * (degree + 1)
    return Spline(degree, tuple(control), tuple(knots), weights)


lines = st.builds(Line, points, points).filter(lambda line: math.dist(line.start, line.end) > 1e-3)
sweeps = st.one_of(st.floats(0.05, math.tau - 0.05), st.just(math.pi), st.just(math.pi / 2))
signs = st.sampled_from([1.0, -1.0])
arcs = st.builds(lambda c, r, a, s, sign: arc(c, r, a, s * sign), points, st.floats(0.5, 300.0), angles, sweeps, signs)
circles = st.builds(Circle, points, st.floats(0.01, 300.0), st.booleans())
radii, ratios = st.floats(0.5, 300.0), st.floats(0.05, 0.99)
wholes = st.builds(lambda c, r, a, q: Ellipse(c, on_circle((0.0, 0.0), r, a), q), points, radii, angles, ratios)
parts_of = st.builds(
    lambda e, a, s, ccw: Ellipse(e.centre, e.major, e.ratio, a, a + s, ccw), wholes, angles, sweeps, st.booleans()
)


@st.composite
def splines(draw: st.DrawFn, degrees: tuple[int, ...], rational: bool = False) -> Spline:
    degree = draw(st.sampled_from(degrees))
    count = draw(st.integers(degree + 1, degree + 5))
    control = draw(st.lists(points, min_size=count, max_size=count, unique=True))
    weights = tuple(draw(st.lists(st.floats(0.5, 2.0), min_size=count, max_size=count))) if rational else ()
    knots = [0.1, 0.25, 0.5, 0.6, 0.8] * degree  # each at most as often as keeps the spline in one piece
    inner = draw(st.permutations(knots))[: count - degree - 1]
    return clamped(degree, control, weights, inner)


letters = st.characters(
    max_codepoint=0xFFFF, exclude_categories=["Cc", "Cn", "Cs"], exclude_characters='<>/\\":;?*|=`,'
)
names = st.text(letters, min_size=1, max_size=20)
colours = st.one_of(st.just(""), st.integers(1, 0xFFFFFF).map(lambda value: f"#{value:06x}"))


@st.composite
def parts(draw: st.DrawFn, curves: st.SearchStrategy[Curve]) -> Part:
    """A part on one to three layers, some of whose curves follow one another."""
    found = draw(
        st.lists(names.filter(lambda name: name.strip() == name), min_size=1, max_size=3, unique_by=str.casefold)
    )
    layers = tuple(Layer(name, draw(colours), draw(st.booleans()), draw(st.booleans())) for name in found)
    entities: list[Entity] = []
    for number, curve in enumerate(draw(st.lists(curves, min_size=1, max_size=6)), 1):
        if (
            entities
            and draw(st.booleans())
            and isinstance(curve, Line)
            and math.dist(entities[-1].curve.end, curve.end) > 1e-3
        ):
            curve = Line(entities[-1].curve.end, curve.end)
        entities.append(Entity(number, curve, draw(st.sampled_from(found))))
    return Part(tuple(entities), layers)


def trace(curve: Curve) -> NDArray[np.float64]:
    """Points that tell a curve: ends of a line, samples of an arc, the Bézier control points of a spline (with
    weights).
    """
    if isinstance(curve, Line):
        return np.array([curve.start, curve.end])
    if isinstance(curve, Arc):
        inner = [on_circle(curve.centre, curve.radius, curve.start_angle + curve.sweep * k / 8) for k in range(1, 8)]
        return np.array([curve.start, *inner, curve.end])
    if isinstance(curve, Circle):
        return np.array([on_circle(curve.centre, curve.radius, math.tau * k / 8) for k in range(8)])
    if isinstance(curve, Ellipse):
        first, last = curve.start_parameter, curve.end_parameter
        whole = last - first > math.tau - 1e-9
        places = [math.tau * k / 8 for k in range(8)] if whole else [first + (last - first) * k / 8 for k in range(9)]
        return np.array([curve.at(place) for place in (places if curve.ccw or whole else places[::-1])])
    control = pieces_of(curve).control
    return (control / control[:, :1, 2:]).reshape(-1, 3)


def apart(a: Curve, b: Curve) -> float:
    """Return how far two curves are from being the same, mm, whichever way they run; inf for curves of different
    kinds.
    """
    if type(a) is not type(b):
        return math.inf
    first, second = trace(a), trace(b)
    if first.shape != second.shape:
        return math.inf
    # the other end of the axis
    turned = [np.roll(second, 4, axis=0)] if isinstance(a, Ellipse) and len(first) == 8 else []
    return min(float(np.abs(first - other).max()) for other in (second, second[::-1], *turned))
