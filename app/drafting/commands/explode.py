"""The command `explode`: ellipses and splines become lines and arcs, circles two arcs."""

from __future__ import annotations

from ...core.errors import GeometryError, InputError
from ...model.curves import Arc, Circle, Curve, Ellipse, Line, Primitive, Spline
from ..expressions.arguments import Arguments
from .command import DraftingSession, ReplaceCurves
from .command_curves import chosen_curves


def simple(curve: Curve) -> tuple[Primitive, ...]:
    """Return a curve as lines and arcs or a circle, within 1 µm; a line, arc or circle as it is.

    Raises:
        InputError: it cannot be followed.
    """
    if not isinstance(curve, Ellipse | Spline):
        return (curve,)
    from ...geometry.arcs.arcs import lines_and_arcs  # not when the window opens

    try:
        return lines_and_arcs(curve).primitives
    except GeometryError as error:
        raise InputError(str(error)) from error


def exploded(curve: Curve) -> tuple[Line | Arc, ...]:
    """Return a curve as lines and arcs: a circle as two arcs, an ellipse or a spline as many as keep it within 1 µm."""
    made = list[Line | Arc]()
    for piece in simple(curve):
        made += _halves(piece) if isinstance(piece, Circle) else (piece,)
    return tuple(made)


def _halves(circle: Circle) -> tuple[Arc, Arc]:
    (x, y), right = circle.centre, circle.start
    left = (2 * x - right[0], y)
    return Arc(right, left, circle.centre, circle.ccw), Arc(left, right, circle.centre, circle.ccw)


def explode(words: Arguments, session: DraftingSession) -> ReplaceCurves:
    """Turn circles, ellipses and splines into lines and arcs."""
    curves = chosen_curves(words, session, "explode")
    pieces = {
        number: made
        for number, curve in curves.items()
        if not isinstance(curve, Line | Arc) and (made := exploded(curve))
    }
    if not pieces:
        raise InputError("Lines and arcs are as simple as curves can be; choose circles, ellipses or splines.")
    count = sum(map(len, pieces.values()))
    return ReplaceCurves(pieces, "Explode", f"{len(pieces)} exploded into {count} lines and arcs.")
