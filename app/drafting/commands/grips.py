"""Grips: the points by which a curve or a note is held, and what becomes of it when one of them is pulled elsewhere."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from enum import Enum

from ...core.errors import InputError
from ...core.tolerances import WELD
from ...geometry.sample import quadrants
from ...geometry.transform import Similarity, shift, transformed
from ...model.curves import Arc, Circle, Curve, Ellipse, Line, Point, Spline
from ...model.notes import Guide, Mark, Shape
from ...model.part import Part
from ..curves.shapes import arc_through, middle_of
from ..expressions.arguments import Arguments
from .command import DraftingSession, check_ids


class GripKind(Enum):
    """What a grip holds of its curve."""

    END = "end"
    MIDDLE = "middle"
    CENTRE = "centre"
    QUADRANT = "quadrant"
    AXIS = "axis"
    CONTROL = "control"
    PLACE = "place"


@dataclass(frozen=True, slots=True)
class Grip:
    """A point by which something is held, mm, and which of its kind it is."""

    at: Point
    hold: GripKind
    index: int = 0


def grips(curve: Curve) -> tuple[Grip, ...]:
    """Return the grips of a curve."""
    if isinstance(curve, Circle):
        return (Grip(curve.centre, GripKind.CENTRE), *(Grip(p, GripKind.QUADRANT) for p in quadrants(curve)))
    if isinstance(curve, Ellipse):
        ends = [curve.at(k * math.pi / 2) for k in range(4)]
        return (Grip(curve.centre, GripKind.CENTRE), *(Grip(p, GripKind.AXIS, k) for k, p in enumerate(ends)))
    if isinstance(curve, Spline):
        return tuple(Grip(p, GripKind.CONTROL, k) for k, p in enumerate(curve.control_points))
    found = [
        Grip(curve.start, GripKind.END, 0),
        Grip(curve.end, GripKind.END, 1),
        Grip(middle_of(curve), GripKind.MIDDLE),
    ]
    if isinstance(curve, Arc):
        found += [Grip(curve.centre, GripKind.CENTRE), *(Grip(p, GripKind.QUADRANT) for p in quadrants(curve))]
    return tuple(found)


def note_grips(shape: Shape) -> tuple[Grip, ...]:
    """Return where a mark, a guide or a dimension is held: its place, and points that it is led through."""
    if isinstance(shape, Mark):
        return (Grip(shape.at, GripKind.PLACE),)
    if isinstance(shape, Guide):
        return (Grip(shape.through, GripKind.PLACE),)
    return (Grip(shape.place, GripKind.PLACE), *(Grip(p, GripKind.CONTROL, k) for k, p in enumerate(shape.points)))


def pulled(curve: Curve, grip: Grip, to: Point) -> Curve:
    """Return a curve with one of its grips at another point.

    The middle of a line and every centre take the whole along; an end of an arc keeps the other end and the angle of
    the arc; its middle keeps both ends; a quadrant or the end of an axis keeps the centre.

    Raises:
        InputError: nothing would be left of the curve.
    """
    by = (to[0] - grip.at[0], to[1] - grip.at[1])
    if grip.hold is GripKind.CENTRE or (grip.hold is GripKind.MIDDLE and isinstance(curve, Line)):
        return transformed(curve, shift(by))
    if isinstance(curve, Line):
        return _checked(Line(to, curve.end) if grip.index == 0 else Line(curve.start, to))
    if isinstance(curve, Arc):
        return _pulled_arc(curve, grip, to)
    if isinstance(curve, Circle):
        return replace(curve, radius=_radius(curve.centre, to))
    if isinstance(curve, Ellipse):
        return _pulled_ellipse(curve, grip.index, to)
    return _pulled_spline(curve, grip.index, to)


def pulled_note(shape: Shape, grip: Grip, to: Point) -> Shape:
    """Return a note with one of its grips at another point."""
    if isinstance(shape, Mark):
        return Mark(to)
    if isinstance(shape, Guide):
        return replace(shape, through=to)
    if grip.hold is GripKind.PLACE:
        return replace(shape, place=to)
    return replace(shape, points=(*shape.points[: grip.index], to, *shape.points[grip.index + 1 :]))


@dataclass(frozen=True, slots=True)
class MoveGrip:
    """Take what is held at a point to another point."""

    ids: frozenset[int]
    at: Point
    to: Point
    name: str = "Pull"

    @property
    def reply(self) -> str:
        """A short sentence for the log."""
        return f"{len(self.ids)} pulled."

    def carried_out(self, session: DraftingSession) -> DraftingSession:
        """Return the session with the grips at their new place.

        Raises:
            InputError: an id that the part does not have, one without a grip at the point, or nothing would be left of
                a curve.
        """
        part = session.part
        notes = {note.id for note in part.notes} & self.ids
        check_ids(part, self.ids - notes)
        entities = tuple(
            replace(e, curve=pulled(e.curve, self._grip(e.id, grips(e.curve)), self.to)) if e.id in self.ids else e
            for e in part.entities
        )
        return replace(
            session,
            last=self.to,
            part=replace(
                part,
                entities=entities,
                notes=tuple(
                    replace(n, shape=pulled_note(n.shape, self._grip(n.id, note_grips(n.shape)), self.to))
                    if n.id in notes
                    else n
                    for n in part.notes
                ),
            ),
        )

    def _grip(self, number: int, among: tuple[Grip, ...]) -> Grip:
        nearest = min(among, key=lambda grip: math.dist(grip.at, self.at))
        if math.dist(nearest.at, self.at) > WELD:
            raise InputError(
                f"{number} is not held at {self.at[0]:.3f},{self.at[1]:.3f}; the nearest place to pull it by is "
                f"{nearest.at[0]:.3f},{nearest.at[1]:.3f}."
            )
        return nearest


def pull(words: Arguments, session: DraftingSession) -> MoveGrip:
    """Take a grip of curves to another point: `pull CURVES P to P`."""
    found: list[int] = []
    while words.more and not words.is_point():
        found.extend(words.some("a curve, or the point to pull at"))
    ids = frozenset(found) or session.selection
    if not ids:
        raise InputError("Nothing is selected; select what to pull, or write its numbers after the command.")
    at = words.point("the point to pull at")
    if not words.accept("to"):
        raise words.wrong("Write where the point is pulled to: to x,y.")
    return MoveGrip(ids, at, words.point("where it is pulled to"))


def grip_position(part: Part, ids: frozenset[int], at: Point) -> frozenset[int]:
    """Return which of these are pulled together at a point: all that have an end there, else the first that is held
    there at all.
    """
    ends, others = set(), list[int]()
    for entity in part.entities:
        if entity.id in ids:
            holds = {grip.hold for grip in grips(entity.curve) if math.dist(grip.at, at) <= WELD}
            if GripKind.END in holds:
                ends.add(entity.id)
            elif holds:
                others.append(entity.id)
    others += [
        n.id for n in part.notes if n.id in ids and any(math.dist(grip.at, at) <= WELD for grip in note_grips(n.shape))
    ]
    return frozenset(ends) or frozenset(others[:1])


def _radius(centre: Point, to: Point) -> float:
    radius = math.dist(centre, to)
    if radius < WELD:
        raise InputError("Nothing would be left of the curve; pull to another point.")
    return radius


def _checked(line: Line) -> Line:
    _radius(line.start, line.end)
    return line


def _pulled_arc(arc: Arc, grip: Grip, to: Point) -> Arc:
    if grip.hold is GripKind.MIDDLE:
        return arc_through(arc.start, to, arc.end)
    if grip.hold is GripKind.QUADRANT:
        factor = _radius(arc.centre, to) / arc.radius
        centre = complex(*arc.centre)
        made = transformed(arc, Similarity(complex(factor), centre * (1 - factor)))
        assert isinstance(made, Arc)
        return made
    kept, old = (complex(*p) for p in ((arc.end, arc.start) if grip.index == 0 else (arc.start, arc.end)))
    _radius((kept.real, kept.imag), to)
    centre = kept + (complex(*arc.centre) - kept) * (complex(*to) - kept) / (old - kept)
    made_centre = (centre.real, centre.imag)
    return replace(arc, start=to, centre=made_centre) if grip.index == 0 else replace(arc, end=to, centre=made_centre)


def _pulled_ellipse(curve: Ellipse, index: int, to: Point) -> Ellipse:
    """An end of the major axis turns and stretches it, one of the minor axis only makes it longer or shorter."""
    centre, major = complex(*curve.centre), complex(*curve.major)
    minor = abs(major) * curve.ratio
    away = (complex(*to) - centre) * (-1 if index >= 2 else 1)
    _radius(curve.centre, to)
    if index % 2 == 0:
        major = away
    else:
        minor = abs((away / (1j * major / abs(major))).real)
        _radius((0.0, 0.0), (minor, 0.0))
    ratio = minor / abs(major)
    if ratio <= 1:
        return replace(curve, major=(major.real, major.imag), ratio=ratio)
    swapped, quarter = major * 1j * ratio, math.pi / 2
    return replace(
        curve,
        major=(swapped.real, swapped.imag),
        ratio=1 / ratio,
        start_parameter=curve.start_parameter - quarter,
        end_parameter=curve.end_parameter - quarter,
    )


def _pulled_spline(curve: Spline, index: int, to: Point) -> Spline:
    points = list(curve.control_points)
    last = len(points) - 1
    both = index in (0, last) and math.dist(points[0], points[last]) <= WELD
    for place in (0, last) if both else (index,):
        points[place] = to
    return replace(curve, control_points=tuple(points))
