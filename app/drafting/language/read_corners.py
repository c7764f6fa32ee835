"""The commands `fillet` and `chamfer`: what their arguments mean."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import pairwise
from typing import NamedTuple

from ...core.errors import InputError
from ...core.wording import counted
from ...model.curves import Arc, Circle, Curve, Line, Point
from ..commands.command import AddedCurve, DraftingSession, ReplaceCurves, check_ids
from ..commands.corners import Side, chamfer, fillet, is_smooth, sharp
from ..curves.chains import chained
from ..curves.intersections import nearest_point
from ..curves.shapes import middle_of
from ..expressions.arguments import Arguments

Near = tuple[Point, Point]


class Corner(NamedTuple):
    """Two curves at a corner, and what lies between them."""

    first: Curve
    between: Curve | None
    second: Curve


class _CornerCurves(NamedTuple):
    """Curves by number in the order in which they were named, and where some were pointed at."""

    curves: dict[int, Curve]
    places: dict[int, Point]


class _CornerPair(NamedTuple):
    """Two curves by number, and where they meet; None = they were pointed at."""

    a: int
    b: int
    joint: Point | None = None


def fillet_of(words: Arguments, session: DraftingSession) -> ReplaceCurves:
    """Round the corner of two curves, or every corner among several; a radius of 0 makes it sharp."""
    radius = words.length("the radius")
    if radius < 0:
        raise InputError(f"The radius is {radius:.3f} mm; it must be greater than 0, or 0 for a sharp corner.")

    def work(a: Curve, b: Curve, near: Near) -> Corner:
        if radius > 0:
            return Corner(*fillet(_side(a), _side(b), radius, near))
        if isinstance(a, Circle) or isinstance(b, Circle):
            raise InputError("A circle has no end that could make a sharp corner; give a radius, or trim it.")
        first, second = sharp(_open(a), _open(b), near)
        return Corner(first, None, second)

    return _worked(words, session, "Fillet", work)


def chamfer_of(words: Arguments, session: DraftingSession) -> ReplaceCurves:
    """Cut the corner of two lines, or every corner among several."""
    first_size = words.length("how far the corner is cut back")
    sizes = first_size, words.length("how far on the second line") if words.accept("and") else first_size

    def work(a: Curve, b: Curve, near: Near) -> Corner:
        if not (isinstance(a, Line) and isinstance(b, Line)):
            raise InputError("Only the corner of two lines can be chamfered; round others with fillet.")
        return Corner(*chamfer(a, b, sizes, near))

    return _worked(words, session, "Chamfer", work)


def _side(curve: Curve) -> Side:
    if isinstance(curve, Line | Arc | Circle):
        return curve
    raise InputError(
        "An ellipse or a spline is no line and no arc; only corners of these can be rounded. Explode it before."
    )


def _open(curve: Curve) -> Line | Arc:
    side = _side(curve)
    assert not isinstance(side, Circle)
    return side


def _worked(
    words: Arguments, session: DraftingSession, name: str, work: Callable[[Curve, Curve, Near], Corner]
) -> ReplaceCurves:
    """Return the command that works on one corner after the other, each as the one before left it."""
    curves, places = _read(words, session)
    pairs = [_pointed(curves, places)] if len(curves) == 2 else list(_joints(curves))
    if not pairs:
        raise InputError("No two of these curves meet in a corner; name two curves.")
    drawn, added, refused = dict(curves), list[AddedCurve](), list[InputError]()
    for a, b, joint in pairs:
        near = (places[a], places[b]) if joint is None else _beside_joint(curves[a], curves[b], joint)
        try:
            curves[a], between, curves[b] = work(curves[a], curves[b], near)
        except InputError as error:
            refused.append(error)
            continue
        added += [AddedCurve(a, between)] if between is not None else []
    if len(refused) == len(pairs):
        raise refused[0]
    reply = counted(len(pairs) - len(refused), "corner") + (f", {len(refused)} left as before" if refused else "") + "."
    return ReplaceCurves(
        {k: (curve,) for k, curve in curves.items() if curve is not drawn[k]}, name, reply, tuple(added)
    )


def _read(words: Arguments, session: DraftingSession) -> _CornerCurves:
    """Return the curves that are named."""
    places, ids = dict[int, Point](), list[int]()
    while words.more:
        ids += words.some("a curve")
        if words.is_point():
            places[ids[-1]] = words.point()
    check_ids(session.part, frozenset(ids))
    ids = ids or sorted(session.selection)
    drawn = {e.id: e.curve for e in session.part.entities}
    curves = {number: drawn[number] for number in ids if number in drawn}
    if len(curves) < 2:
        raise InputError("Two curves or more make a corner; name them, or select them before.")
    words.takes(curves.values())
    return _CornerCurves(curves, places)


def _pointed(curves: dict[int, Curve], places: dict[int, Point]) -> _CornerPair:
    """Return a pair of curves; where nobody pointed at one its middle stands for it."""
    for number, curve in curves.items():
        places[number] = nearest_point(curve, places.get(number) or middle_of(curve))
    a, b = curves
    return _CornerPair(a, b)


def _joints(curves: dict[int, Curve]) -> Iterator[_CornerPair]:
    """Yield the neighbours end to end that do not go on in one another smoothly, and where they meet."""
    for chain in chained(curves):
        way = list(zip(chain.numbers, chain.curves, strict=True))
        for (a, one), (b, other) in pairwise([*way, way[0]] if chain.closed and len(way) > 1 else way):
            if not (isinstance(one, Line | Arc) and isinstance(other, Line | Arc) and is_smooth(one, other, one.end)):
                yield _CornerPair(a, b, one.end)


def _beside_joint(a: Curve, b: Curve, joint: Point) -> Near:
    """Return a place on each of two curves between their joint and their middle."""
    first, second = (
        nearest_point(curve, ((joint[0] + x) / 2, (joint[1] + y) / 2))
        for curve in (a, b)
        for x, y in [middle_of(curve)]
    )
    return first, second
