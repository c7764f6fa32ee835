"""Commands that cut and join curves where they meet: what their arguments mean."""

from __future__ import annotations

from ...core.errors import InputError
from ...core.tolerances import WELD
from ...core.wording import counted
from ...model.curves import Arc, Circle, Curve, Line, Point
from ...model.notes import Guide, Note
from ...model.part import Entity
from ..commands.command import AddedCurve, DraftingSession, ReplaceCurves, check_ids
from ..commands.command_curves import chosen_curves
from ..commands.drafting import broken, extended, parallel, trimmed
from ..commands.offset_chain import chain_parallel
from ..curves.chains import CurveChain, chained
from ..expressions.arguments import Arguments

_EDGE = 0.25
"""To look where a curve crosses others costs so much of what it costs to take these apart."""


def trim(words: Arguments, session: DraftingSession) -> ReplaceCurves:
    """Take out the piece of a curve at a point, up to what crosses it."""
    number, curve = words.curve("the curve to trim")
    at = words.point("a point of the piece that goes")
    kept = trimmed(curve, at, _edges(words, session, number, "by"))
    return ReplaceCurves(
        {number: kept}, "Trim", f"{counted(len(kept), 'piece')} {'stays' if len(kept) == 1 else 'stay'}."
    )


def extend(words: Arguments, session: DraftingSession) -> ReplaceCurves:
    """Let the end of a line or arc go on to what lies ahead."""
    number, curve = words.curve("the line or arc to extend")
    at = words.point("a point near the end that goes on")
    made = extended(curve, at, _edges(words, session, number, "to"))
    return ReplaceCurves({number: (made,)}, "Extend", "1 extended.")


def _edges(words: Arguments, session: DraftingSession, number: int, word: str) -> list[Curve]:
    """Return what ends a trim or an extension: the curves and construction lines named, else all that are seen."""
    part = session.part
    chosen = frozenset(words.ids()) if words.accept(word) else None
    check_ids(part, chosen or frozenset())
    seen = {layer.name for layer in part.layers if layer.visible}

    def counts(item: Entity | Note) -> bool:
        return item.id != number and (item.layer in seen if chosen is None else item.id in chosen)

    guides = [note.shape.line for note in part.notes if isinstance(note.shape, Guide) and counts(note)]
    edges = [e.curve for e in part.entities if counts(e)]
    words.takes(edges, _EDGE)
    return edges + guides


def break_at(words: Arguments, session: DraftingSession) -> ReplaceCurves:
    """Break a curve at a point, or take out what lies between two."""
    number, curve = words.curve("the curve to break")
    first = words.point("a point of the curve")
    pieces = broken(curve, first, words.point("a second point") if words.more else None)
    return ReplaceCurves({number: pieces}, "Break", f"{counted(len(pieces), 'piece')}.")


def offset(words: Arguments, session: DraftingSession) -> ReplaceCurves:
    """Draw parallels at a distance, on the side of a point: of chains of curves as a whole, their corners joined."""
    away = words.length("the distance")
    side = words.point("a point on the side where the parallels go")
    curves = chosen_curves(words, session, "offset")
    if away < WELD:
        raise InputError(f"The distance is {away:.3f} mm; it must be greater than 0.")
    rounded = bool(words.accept("round"))
    made, nothing = list[AddedCurve](), list[InputError]()
    for contour in chained(curves):
        try:
            made += _parallels(contour, away, side, rounded)
        except InputError as error:
            nothing.append(error)
    if not made:
        raise nothing[0]
    return ReplaceCurves({}, "Offset", f"{len(made)} drawn.", tuple(made))


def _parallels(contour: CurveChain, away: float, side: Point, rounded: bool) -> list[AddedCurve]:
    if len(contour.curves) == 1 and isinstance(contour.curves[0], Line | Arc | Circle):
        return [AddedCurve(contour.numbers[0], parallel(contour.curves[0], away, side))]
    made = [AddedCurve(each.along, each.curve) for each in chain_parallel(contour, away, side, rounded)]
    if not made:
        raise InputError(
            f"Nothing of the contour is {away:.3f} mm away on that side; use less, or point at the other side."
        )
    return made
