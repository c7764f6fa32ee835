"""The shape language: a drawing in words, a command a line.

    line P P [P …] [close]                li
    polyline P P [arc via end] … [close]  pl    lines, and arcs by way of a point
    arc P P centre P [cw]                 ar    start, end, centre
    arc P P P                                   start, by way of, end
    circle P r                            ci
    rect P P                              re
    select all | none | CURVES | window P P | crossing P P | layer NAME     (before it: add, remove)
    delete [CURVES]   move @dx,dy [CURVES]   layer NAME [CURVES]   undo   redo

    let w = 60 + 2     let p = mid(a, b)     circle p w/4 as hole
    repeat 6 as i … end     if w > 50 … else … end     define bolt(c, r) … end

P is `x,y`, `r<angle`, `@dx,dy`, `@r<angle`, or anything that is a point. CURVES are numbers such as 4 7-9 and names given by
`as`. Numbers take units and arithmetic (`1in+8mm`) and are mm and degrees without a unit; functions are those of `functions`.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from app.edit import syntax
from app.edit.arguments import Arguments
from app.edit.command import Delete, Draw, Edit, Move, Redo, Session, SetLayer, Undo
from app.edit.select import By, How, Select
from app.edit.shapes import arc_about, arc_through, circle, curve_length, lines_through, rectangle
from app.edit.values import wrong
from app.errors import InputError
from app.model.curves import Arc, Line, Point

Command = Edit | Select | Undo | Redo

ALIASES = {
    "li": "line", "l": "line", "pl": "polyline", "ar": "arc", "a": "arc", "ci": "circle", "c": "circle", "re": "rect",
    "rectangle": "rect", "del": "delete", "erase": "delete", "mo": "move", "se": "select", "la": "layer", "u": "undo",
}
"""Short and other words for the commands."""


def command_word(text: str) -> str | None:
    """Return the command that a line begins with, aliases spelled out, or None when it begins with none."""
    first = text.split(maxsplit=1)[:1]
    word = ALIASES.get(first[0].lower(), first[0].lower()) if first else ""
    return word if word in _READERS else None


def read(written: syntax.Command, session: Session) -> Command:
    """Return what a command asks for.

    Raises:
        InputError: it cannot be read or asks for a shape that is none; a CommandError tells the place.
    """
    word = written.word.text.lower()
    reader = _READERS.get(ALIASES.get(word, word))
    if reader is None:
        raise wrong(f"'{word}' is no command; use {', '.join(_READERS)}.", written.place)
    words = Arguments(written, session.scope)
    command = reader(words, session)
    words.end()
    return command


def _line(words: Arguments, session: Session) -> Draw:
    points = [words.point(), words.point(), *words.points()]
    close = bool(words.accept("close"))
    curves = lines_through(points, close)
    total = sum(map(curve_length, curves))
    figures = f"{total:.3f} mm" if len(curves) == 1 else f"{len(curves)} sides, {total:.3f} mm"
    return Draw("Line", curves, figures, curves[-1].end)


def _polyline(words: Arguments, session: Session) -> Draw:
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
    return Draw("Polyline", tuple(curves), f"{len(curves)} segments, {total:.3f} mm", curves[-1].end)


def _arc(words: Arguments, session: Session) -> Draw:
    start, second = words.point(), words.point()
    if words.accept("centre", "center"):
        words.last = start
        centre = words.point("the centre x,y")
        curve = arc_about(start, second, centre, ccw=not words.accept("cw"))
        words.accept("ccw")
    else:
        curve = arc_through(start, second, words.point("the end of the arc, or centre x,y,"))
    figures = f"radius {curve.radius:.3f} mm, {abs(math.degrees(curve.sweep)):.2f}°"
    return Draw("Arc", (curve,), figures, curve.end)


def _circle(words: Arguments, session: Session) -> Draw:
    centre = words.point("the centre x,y")
    curve = circle(centre, words.length("the radius"))
    return Draw("Circle", (curve,), f"radius {curve.radius:.3f} mm", centre)


def _rect(words: Arguments, session: Session) -> Draw:
    a, b = words.point("a corner x,y"), words.point("the opposite corner x,y")
    return Draw("Rectangle", rectangle(a, b), f"{abs(b[0] - a[0]):.3f} by {abs(b[1] - a[1]):.3f} mm", b)


def _chosen(words: Arguments, session: Session, verb: str) -> frozenset[int]:
    ids = frozenset(words.ids()) or session.selection
    if not ids:
        raise InputError(f"Nothing is selected; select what to {verb}, or write its numbers after the command.")
    return ids


def _delete(words: Arguments, session: Session) -> Delete:
    return Delete(_chosen(words, session, "delete"))


def _move(words: Arguments, session: Session) -> Move:
    by = words.shift("the shift @dx,dy")
    return Move(_chosen(words, session, "move"), by)


def _layer(words: Arguments, session: Session) -> SetLayer:
    name = words.name("the name of a layer").strip()
    if not name:
        raise words.wrong("The name of the layer is empty; write a name.")
    return SetLayer(name, frozenset(words.ids()))


def _select(words: Arguments, session: Session) -> Select:
    how = How(words.accept("add", "remove"))
    kind = words.accept("all", "none", "window", "crossing", "layer")
    if kind in ("window", "crossing"):
        return Select(By(kind), how, box=_box(words.point("a corner x,y"), words.point("the opposite corner x,y")))
    if kind == "layer":
        return Select(By.LAYER, how, layer=words.name("the name of a layer"))
    if kind:
        return Select(By(kind), how)
    if not words.more:
        raise words.wrong("Write what to select: all, none, window, crossing, layer, or entity numbers.")
    return Select(By.IDS, how, frozenset(words.ids()))


def _box(a: Point, b: Point) -> tuple[float, float, float, float]:
    return (min(a[0], b[0]), min(a[1], b[1]), max(a[0], b[0]), max(a[1], b[1]))


_READERS: dict[str, Callable[[Arguments, Session], Command]] = {
    "line": _line, "polyline": _polyline, "arc": _arc, "circle": _circle, "rect": _rect, "select": _select, "delete": _delete,
    "move": _move, "layer": _layer, "undo": lambda words, session: Undo(), "redo": lambda words, session: Redo(),
}

COMMANDS = tuple(_READERS)
"""Every command by its full word."""
