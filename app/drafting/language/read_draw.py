"""Commands that draw: what their arguments mean."""

from __future__ import annotations

import itertools
import math

from ...core.errors import InputError
from ...core.wording import counted
from ...model.curves import Arc, Curve, Line, Point, Spline, reversed_curve
from ..commands.command import DraftingSession, Draw
from ..curves.shapes import (
    arc_about,
    arc_along,
    arc_of_radius,
    arc_through,
    circle,
    circle_through,
    curve_length,
    ellipse,
    lines_through,
    polygon,
    rectangle,
    rounded_rectangle,
    slot,
    spline_through,
)
from ..expressions.arguments import Arguments

MOST_CORNERS = 1000
"""Of a regular polygon, at most."""


def line(words: Arguments, session: DraftingSession) -> Draw:
    """Lines from point to point."""
    points = [words.point(), words.point(), *words.points()]
    close = bool(words.accept("close"))
    curves = lines_through(points, close)
    total = sum(map(curve_length, curves))
    figures = f"{total:.3f} mm" if len(curves) == 1 else f"{len(curves)} sides, {total:.3f} mm"
    return Draw("Line", curves, figures, curves[-1].end)


def polyline(words: Arguments, session: DraftingSession) -> Draw:
    """Lines, and arcs by way of a point."""
    first = at = words.point()
    curves: list[Line | Arc] = []
    while words.more:
        if words.accept("close"):
            curves += lines_through([at, first]) if at != first else ()
            break
        if words.accept("arc"):
            curves.append(arc_through(at, words.point("a point on the arc"), words.point("the end of the arc")))
        else:
            curves += lines_through([at, words.point()])
        at = curves[-1].end
    if not curves:
        raise words.wrong("A polyline needs two points or more; write polyline x,y x,y.")
    total = sum(map(curve_length, curves))
    return Draw("Polyline", tuple(curves), f"{counted(len(curves), 'segment')}, {total:.3f} mm", curves[-1].end)


def arc(words: Arguments, session: DraftingSession) -> Draw:
    """An arc: about a centre, with a radius, through a point, or onward from the curve drawn last."""
    curve = _arc_onward(words, session) if words.accept("on") else _arc_between(words)
    figures = f"radius {curve.radius:.3f} mm, {abs(math.degrees(curve.sweep)):.2f}\u00b0"
    return Draw("Arc", (curve,), figures, curve.end)


def _arc_between(words: Arguments) -> Arc:
    start, second = words.point(), words.point()
    if words.accept("centre", "center"):
        words.last = start
        centre = words.point("the centre x,y")
        turn = words.accept("cw", "ccw")
        return arc_about(start, second, centre, ccw=turn != "cw")
    if words.accept("radius"):
        radius = words.length("the radius")
        flags = {words.accept("cw", "ccw", "large") for _ in range(2)}
        return arc_of_radius(start, second, radius, "cw" not in flags, "large" in flags)
    return arc_through(start, second, words.point("the end of the arc, or centre x,y,"))


def _arc_onward(words: Arguments, session: DraftingSession) -> Arc:
    before = next((e.curve for e in reversed(session.part.entities) if e.curve.end == session.last), None)
    if before is None:
        raise words.wrong(
            "Nothing that was drawn ends at the last point; draw a line or an arc before, or give a centre."
        )
    return arc_along(session.last, _heading(before), words.point("the end of the arc"))


def _heading(curve: Curve) -> float:
    """Return the direction in which a curve ends, radians."""
    if isinstance(curve, Line):
        return math.atan2(curve.end[1] - curve.start[1], curve.end[0] - curve.start[0])
    if isinstance(curve, Arc):
        turn = curve.start_angle + curve.sweep
        return turn + (math.pi / 2 if curve.sweep > 0 else -math.pi / 2)
    if isinstance(curve, Spline):
        (ax, ay), (bx, by) = curve.control_points[-2:]
        return math.atan2(by - ay, bx - ax)
    raise InputError("The curve drawn last has no end that an arc could go on from; give a centre.")


def circle_of(words: Arguments, session: DraftingSession) -> Draw:
    """A circle: by centre and radius, centre and point, two ends of a diameter, or three points."""
    if words.accept("through"):
        made = circle_through(words.point(), words.point("the second point"), words.point("the third point"))
    elif words.accept("diameter"):
        a, b = words.point(), words.point("the other end of the diameter")
        made = circle(((a[0] + b[0]) / 2, (a[1] + b[1]) / 2), math.dist(a, b) / 2)
    else:
        centre = words.point("the centre x,y")
        through = words.accept("through")
        made = circle(
            centre, math.dist(centre, words.point("a point of the circle")) if through else words.length("the radius")
        )
    curve: Curve = reversed_curve(made) if words.accept("cw") else made
    return Draw("Circle", (curve,), f"radius {made.radius:.3f} mm", made.centre)


def rect(words: Arguments, session: DraftingSession) -> Draw:
    """A rectangle by opposite corners; with round corners where a radius is given."""
    a, b = words.point("a corner x,y"), words.point("the opposite corner x,y")
    curves: tuple[Curve, ...] = (
        rounded_rectangle(a, b, words.length("the radius")) if words.accept("round") else rectangle(a, b)
    )
    return Draw("Rectangle", curves, f"{abs(b[0] - a[0]):.3f} by {abs(b[1] - a[1]):.3f} mm", b)


def polygon_of(words: Arguments, session: DraftingSession) -> Draw:
    """A regular polygon by number of corners, centre and a corner, or the middle of a side."""
    corners = words.count("the number of corners", 3, MOST_CORNERS)
    centre = words.point("the centre x,y")
    flat = words.accept("side")
    point = words.point("the middle of a side" if flat else "a corner")
    if flat:
        grown, turned = 1 / math.cos(math.pi / corners), math.pi / corners
        z = complex(point[0] - centre[0], point[1] - centre[1]) * grown * complex(math.cos(turned), math.sin(turned))
        point = (centre[0] + z.real, centre[1] + z.imag)
    curves = polygon(centre, corners, point)
    return Draw("Polygon", curves, f"{corners} sides of {curve_length(curves[0]):.3f} mm", centre)


def slot_of(words: Arguments, session: DraftingSession) -> Draw:
    """A slot by the centres of its ends and its width."""
    a, b = words.point("the centre of one end"), words.point("the centre of the other end")
    width = words.length("the width")
    return Draw("Slot", slot(a, b, width), f"{math.dist(a, b) + width:.3f} by {width:.3f} mm", b)


def ellipse_of(words: Arguments, session: DraftingSession) -> Draw:
    """An ellipse by centre, end of one half axis, and length of the other; a part of it from one angle to another."""
    centre, end = words.point("the centre x,y"), words.point("the end of a half axis")
    half = words.length("the length of the other half axis")
    span = (0.0, math.tau)
    if words.accept("from"):
        first = math.radians(words.angle("the parameter where it begins"))
        if not words.accept("to"):
            raise words.wrong("The part of an ellipse is written from angle to angle; add to and an angle.")
        span = (first, math.radians(words.angle("the parameter where it ends")))
    made = ellipse(centre, end, half, span, ccw=words.accept("cw", "ccw") != "cw")
    return Draw("Ellipse", (made,), f"half axes {math.dist(centre, end):.3f} and {half:.3f} mm", centre)


def spline_of(words: Arguments, session: DraftingSession) -> Draw:
    """A spline through points, or by control points, knots and weights."""
    if words.accept("degree"):
        made = _nurbs(words)
    else:
        points = [words.point(), *words.points()]
        made = spline_through(points, close=bool(words.accept("close")))
    return Draw("Spline", (made,), f"{curve_length(made):.3f} mm", made.end)


def _nurbs(words: Arguments) -> Spline:
    degree = words.count("the degree", 1, 25)
    points, knots, weights = words.points(), list[float](), list[float]()
    if words.accept("knots"):
        knots = words.numbers()
    if words.accept("weights"):
        weights = words.numbers()
    count = len(points)
    if count <= degree:
        raise words.wrong(f"A spline of degree {degree} needs {degree + 1} control points or more; there are {count}.")
    if not knots:
        inner = count - degree
        knots = [0.0] * degree + [k / inner for k in range(inner + 1)] + [1.0] * degree
    clamped = len(knots) == count + degree + 1 and len(set(knots[: degree + 1])) == len(set(knots[-degree - 1 :])) == 1
    if not clamped or any(b < a for a, b in itertools.pairwise(knots)) or knots[0] == knots[-1]:
        raise words.wrong(
            f"There must be {count + degree + 1} knots that do not fall, the first and the last {degree + 1} alike."
        )
    if weights and (len(weights) != count or min(weights) <= 0):
        raise words.wrong(f"There must be {count} weights, all greater than 0.")
    return Spline(degree, tuple(points), tuple(knots), tuple(weights))


def box(a: Point, b: Point) -> tuple[float, float, float, float]:
    """Return x0, y0, x1, y1 of the rectangle with these opposite corners."""
    return (min(a[0], b[0]), min(a[1], b[1]), max(a[0], b[0]), max(a[1], b[1]))
