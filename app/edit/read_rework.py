"""Commands that cut and join curves where they meet: what their arguments mean."""

from __future__ import annotations

from itertools import combinations

from app.edit.arguments import Arguments
from app.edit.chains import Chain, chained
from app.edit.chosen import chosen_curves
from app.edit.command import Rework, Session
from app.edit.drafting import broken, chamfer, extended, fillet, parallel, trimmed
from app.edit.meet import foot
from app.edit.offset_chain import chain_parallel
from app.edit.shapes import middle_of
from app.errors import InputError
from app.model.curves import Arc, Circle, Curve, Line, Point
from app.tolerances import WELD


def trim(words: Arguments, session: Session) -> Rework:
    """Take out the piece of a curve at a point, up to what crosses it."""
    number, curve = words.curve("the curve to trim")
    at = words.point("a point of the piece that goes")
    kept = trimmed(curve, at, _edges(words, session, number, "by"))
    return Rework({number: kept}, "Trim", f"{len(kept)} pieces stay.")


def extend(words: Arguments, session: Session) -> Rework:
    """Let the end of a line or arc go on to what lies ahead."""
    number, curve = words.curve("the line or arc to extend")
    at = words.point("a point near the end that goes on")
    made = extended(curve, at, _edges(words, session, number, "to"))
    return Rework({number: (made,)}, "Extend", "1 extended.")


def _edges(words: Arguments, session: Session, number: int, word: str) -> list[Curve]:
    chosen = frozenset(words.ids()) if words.accept(word) else None
    return [e.curve for e in session.part.entities if e.id != number and (chosen is None or e.id in chosen)]


def break_at(words: Arguments, session: Session) -> Rework:
    """Break a curve at a point, or take out what lies between two."""
    number, curve = words.curve("the curve to break")
    first = words.point("a point of the curve")
    pieces = broken(curve, first, words.point("a second point") if words.more else None)
    return Rework({number: pieces}, "Break", f"{len(pieces)} pieces.")


def fillet_of(words: Arguments, session: Session) -> Rework:
    """Round the corner of two curves, or every corner among several."""
    radius = words.length("the radius")
    if radius <= 0:
        raise InputError(f"The radius is {radius:.3f} mm; it must be greater than 0.")
    work = _Corners(words, session)
    for a, b in work.corners():
        one, other = work.straight_or_round(a), work.straight_or_round(b)
        first, arc, second = fillet(one, other, radius, work.near(a, b))
        work.change(a, first, b, second, arc)
    return work.result("Fillet")


def chamfer_of(words: Arguments, session: Session) -> Rework:
    """Cut the corner of two lines, or every corner among several."""
    first_size = words.length("how far the corner is cut back")
    second_size = words.length("how far on the second line") if words.accept("and") else first_size
    work = _Corners(words, session)
    for a, b in work.corners():
        one, other = work.curves[a], work.curves[b]
        if not (isinstance(one, Line) and isinstance(other, Line)):
            continue
        first, across, second = chamfer(one, other, (first_size, second_size), work.near(a, b))
        work.change(a, first, b, second, across)
    return work.result("Chamfer")


def offset(words: Arguments, session: Session) -> Rework:
    """Draw parallels at a distance, on the side of a point: of chains of curves as a whole, their corners joined."""
    away = words.length("the distance")
    side = words.point("a point on the side where the parallels go")
    curves = chosen_curves(words, session, "offset")
    if away < WELD:
        raise InputError(f"The distance is {away:.3f} mm; it must be greater than 0.")
    rounded = bool(words.accept("round"))
    made, nothing = list[tuple[int, Curve]](), list[InputError]()
    for contour in chained(curves):
        try:
            made += _parallels(contour, away, side, rounded)
        except InputError as error:
            nothing.append(error)
    if not made:
        raise nothing[0]
    return Rework({}, "Offset", f"{len(made)} drawn.", tuple(made))


def _parallels(contour: Chain, away: float, side: Point, rounded: bool) -> list[tuple[int, Curve]]:
    if len(contour.curves) == 1 and isinstance(contour.curves[0], Line | Arc | Circle):
        return [(contour.numbers[0], parallel(contour.curves[0], away, side))]
    made = list[tuple[int, Curve]](chain_parallel(contour, away, side, rounded))
    if not made:
        raise InputError(f"Nothing of the contour is {away:.3f} mm away on that side; use less, or point at the other side.")
    return made


def _curve(session: Session, number: int) -> Curve:
    curve = session.part.curve(number)
    if curve is None:
        raise InputError(f"The drawing has no entity {number}; select what to change and repeat without numbers.")
    return curve


class _Corners:
    """Curves whose corners are worked on one after the other, each as the one before left it."""

    def __init__(self, words: Arguments, session: Session) -> None:
        """Read two curves, each with the point where it was pointed at; or the curves whose joined ends are corners."""
        self._pointed: dict[int, Point] = {}
        ids = list[int]()
        while words.more:
            ids += words.some("a curve")
            if words.is_point():
                self._pointed[ids[-1]] = words.point()
        ids = ids or sorted(session.selection)
        if len(set(ids)) < 2:
            raise InputError("Two curves or more make a corner; name them, or select them before.")
        self.curves = {number: _curve(session, number) for number in ids}
        self._ids, self._added = ids, list[tuple[int, Curve]]()

    def corners(self) -> list[tuple[int, int]]:
        """Return the pairs that are worked on: the two curves, or those whose ends are joined."""
        if len(self._ids) == 2:
            return [(self._ids[0], self._ids[1])]
        pairs = [(a, b) for a, b in combinations(self._ids, 2) if self._joint(a, b) is not None]
        if not pairs:
            raise InputError("No two of these curves have an end in common; name two curves that meet.")
        return pairs

    def _joint(self, a: int, b: int) -> Point | None:
        """Return the end that two curves have in common."""
        one, other = self.curves[a], self.curves[b]
        return next((p for p in (one.end, one.start) if p in (other.start, other.end)), None)

    def straight_or_round(self, number: int) -> Line | Arc:
        """Return a curve that is a line or an arc."""
        curve = self.curves[number]
        if not isinstance(curve, Line | Arc):
            raise InputError(f"Curve {number} is no line and no arc; only their corners can be rounded.")
        return curve

    def near(self, a: int, b: int) -> tuple[Point, Point]:
        """Return where both were pointed at: where nobody pointed, their middles."""
        one, other = (self._pointed.get(k) or middle_of(self.curves[k]) for k in (a, b))
        return foot(self.curves[a], one), foot(self.curves[b], other)

    def change(self, a: int, first: Curve, b: int, second: Curve, between: Curve) -> None:
        """Take the outcome of one corner."""
        self.curves[a], self.curves[b] = first, second
        self._added.append((a, between))

    def result(self, name: str) -> Rework:
        """Return the command that does it all."""
        return Rework({k: (curve,) for k, curve in self.curves.items()}, name, f"{len(self._added)} corners.", tuple(self._added))
