"""Commands that change, cut or join what is drawn, choose it, or put it on layers: what their arguments mean."""

from __future__ import annotations

import re

from ...core.errors import InputError
from ...core.tolerances import WELD
from ...core.wording import counted
from ...geometry.transform import Similarity, mirroring, scaling, shift, turn
from ...model.curves import Arc, Circle, Curve, Line, Point, reversed_curve
from ...model.notes import Guide, Note
from ...model.part import Entity
from ..commands.command import (
    AddedCurve,
    Delete,
    DraftingSession,
    ReplaceCurves,
    SetLayer,
    SetLayerStyle,
    Transform,
    check_ids,
)
from ..commands.command_curves import chosen_curves
from ..commands.drafting import broken, extended, parallel, trimmed
from ..commands.offset_chain import chain_parallel
from ..commands.select import SelectCriterion, SelectEntities, SelectMode
from ..curves.chains import CurveChain, chained
from ..expressions.arguments import Arguments
from ..expressions.values import wrong
from .read_draw import box

MOST_COPIES = 10_000
"""Copies of one command; more are a slip of the keyboard, and fill the memory."""
_LOOKS = {"window": 0.04, "crossing": 0.04, "chain": 0.3}
"""To look for curves costs so much of what it costs to take them apart."""
_COLOUR = re.compile(r"#[0-9a-fA-F]{6}")


def _chosen(words: Arguments, session: DraftingSession, verb: str) -> frozenset[int]:
    ids = frozenset(words.ids()) or session.selection
    if not ids:
        raise InputError(f"Nothing is selected; select what to {verb}, or write its numbers after the command.")
    return ids


def delete(words: Arguments, session: DraftingSession) -> Delete:
    """Take curves away."""
    return Delete(_chosen(words, session, "delete"))


def move(words: Arguments, session: DraftingSession) -> Transform:
    """Shift curves."""
    by = words.shift("the shift @dx,dy")
    return Transform(_chosen(words, session, "move"), (shift(by),), "Move")


def copy(words: Arguments, session: DraftingSession) -> Transform:
    """Put copies of curves a shift away, several in a row where a number is given."""
    by = words.shift("the shift @dx,dy")
    count = words.count("the number of copies", 1, MOST_COPIES) if words.accept("times") else 1
    maps = tuple(shift((k * by[0], k * by[1])) for k in range(1, count + 1))
    return Transform(_chosen(words, session, "copy"), maps, "Copy", keep=True)


def rotate(words: Arguments, session: DraftingSession) -> Transform:
    """Turn curves about a centre."""
    centre = words.point("the centre x,y")
    return _mapped(words, session, turn(centre, words.angle("the angle")), "Rotate")


def scale(words: Arguments, session: DraftingSession) -> Transform:
    """Make curves larger or smaller about a centre."""
    centre = words.point("the centre x,y")
    return _mapped(words, session, scaling(centre, words.number("the factor")), "Scale")


def mirror(words: Arguments, session: DraftingSession) -> Transform:
    """Mirror curves about the line through two points."""
    a, b = words.point("a point of the mirror line"), words.point("another point of the mirror line")
    return _mapped(words, session, mirroring(a, b), "Mirror")


def _mapped(words: Arguments, session: DraftingSession, to: Similarity, name: str) -> Transform:
    keep = bool(words.accept("copy"))
    return Transform(_chosen(words, session, name.lower()), (to,), name, keep)


def array(words: Arguments, session: DraftingSession) -> Transform:
    """Put copies of curves in rows and columns, or round a centre."""
    if words.accept("polar"):
        centre = words.point("the centre x,y")
        count = words.count("the number of places", 2, MOST_COPIES)
        span = words.angle("the angle") if words.accept("over") else 360.0
        step = span / count if span % 360 == 0 else span / (count - 1)
        maps = tuple(turn(centre, k * step) for k in range(1, count))
    else:
        columns = words.count("the number of columns", 1, MOST_COPIES)
        rows = words.count("the number of rows", 1, MOST_COPIES)
        dx, dy = words.shift("the shift from column to column and row to row @dx,dy")
        if not 1 < columns * rows <= MOST_COPIES:
            raise words.wrong(f"{columns} by {rows} are {columns * rows} places; an array has 2 to {MOST_COPIES}.")
        maps = tuple(shift((i * dx, j * dy)) for j in range(rows) for i in range(columns))[1:]
    return Transform(_chosen(words, session, "repeat"), maps, "Array", keep=True)


def reverse(words: Arguments, session: DraftingSession) -> ReplaceCurves:
    """Let curves run the other way; those that join end to end all against the way of the first of them."""
    curves = chosen_curves(words, session, "reverse")
    turned = {
        number: reversed_curve(curve)
        for chain in chained(curves)
        for number, curve in zip(chain.numbers, chain.curves, strict=True)
    }
    pieces = {number: (curve,) for number, curve in turned.items() if curve != curves[number]}
    already = len(curves) - len(pieces)
    return ReplaceCurves(
        pieces, "Reverse", f"{len(pieces)} reversed" + (f", {already} ran that way." if already else ".")
    )


def layer(words: Arguments, session: DraftingSession) -> SetLayer:
    """Draw on a layer, put curves on it, or say how it looks."""
    name = words.name("the name of a layer").strip()
    if not name:
        raise words.wrong("The name of the layer is empty; write a name.")
    return SetLayer(name, frozenset(words.ids()))


def hide(words: Arguments, session: DraftingSession) -> SetLayerStyle:
    """Hide a layer: its curves are neither seen nor machined."""
    name = words.name("the name of a layer")
    return SetLayerStyle(name, {"visible": False}, f"Layer {name} is hidden.")


def show(words: Arguments, session: DraftingSession) -> SetLayerStyle:
    """Show a layer again."""
    name = words.name("the name of a layer")
    return SetLayerStyle(name, {"visible": True}, f"Layer {name} is shown.")


def lock(words: Arguments, session: DraftingSession) -> SetLayerStyle:
    """Lock a layer: its curves are not selected."""
    name = words.name("the name of a layer")
    return SetLayerStyle(name, {"locked": True}, f"Layer {name} is locked.")


def unlock(words: Arguments, session: DraftingSession) -> SetLayerStyle:
    """Unlock a layer."""
    name = words.name("the name of a layer")
    return SetLayerStyle(name, {"locked": False}, f"Layer {name} is unlocked.")


def colour(words: Arguments, session: DraftingSession) -> SetLayerStyle:
    """Give a layer a colour, or the ink's again."""
    name = words.name("the name of a layer")
    if words.accept("none"):
        return SetLayerStyle(name, {"colour": ""}, f"Layer {name} has the colour of ink.")
    place, value = words.place, words.name('a colour such as "#d55e00", or none')
    if not _COLOUR.fullmatch(value):
        raise wrong(f"'{value}' is no colour; write one such as \"#d55e00\", or none.", place)
    return SetLayerStyle(name, {"colour": value.lower()}, f"Layer {name} has a colour.")


def select(words: Arguments, session: DraftingSession) -> SelectEntities:
    """Choose curves."""
    how = SelectMode(words.accept("add", "remove"))
    kind = words.accept("all", "none", "window", "crossing", "layer", "chain")
    if kind in _LOOKS:
        words.takes((e.curve for e in session.part.entities), _LOOKS[kind])
    if kind in ("window", "crossing"):
        return SelectEntities(
            SelectCriterion(kind), how, box=box(words.point("a corner x,y"), words.point("the opposite corner x,y"))
        )
    if kind == "layer":
        return SelectEntities(SelectCriterion.LAYER, how, layer=words.name("the name of a layer"))
    if kind == "chain":
        return SelectEntities(SelectCriterion.CHAIN, how, _chosen(words, session, "follow"))
    if kind:
        return SelectEntities(SelectCriterion(kind), how)
    if not words.more:
        raise words.wrong("Write what to select: all, none, window, crossing, layer, or entity numbers.")
    return SelectEntities(SelectCriterion.IDS, how, frozenset(words.ids()))


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
