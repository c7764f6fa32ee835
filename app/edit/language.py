"""The drawing language: one line, one action.

    line x,y x,y [x,y …] [close]              li
    polyline x,y x,y [arc via end] … [close]  pl    lines, and arcs by way of a point
    arc x,y x,y centre x,y [cw]               ar    start, end, centre
    arc x,y x,y x,y                                 start, by way of, end
    circle x,y r                              ci
    rect x,y x,y                              re
    select all | none | ID … | window x,y x,y | crossing x,y x,y | layer NAME     (before it: add, remove)
    delete [ID …]   move @dx,dy [ID …]   layer NAME [ID …]   undo   redo

A point is `x,y`, `@dx,dy` or `@r<angle`; numbers take units and arithmetic (`1in+8mm`) and are mm without a unit.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from app.edit.command import Context, Delete, Draw, Edit, Move, Redo, SetLayer, Undo
from app.edit.errors import CommandError
from app.edit.select import By, How, Select
from app.edit.shapes import arc_about, arc_through, circle, curve_length, lines_through, rectangle
from app.edit.words import Words, read_point
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


def parse(line: str, context: Context | None = None) -> Command:
    """Return the command that a line of the drawing language asks for.

    Args:
        line: one line, without a comment.
        context: what the line may refer to; by default an empty drawing.

    Raises:
        InputError: the line cannot be read or asks for a shape that is none; a CommandError tells the column.
    """
    context = context or Context()
    words = Words(line, context.last)
    column = words.column
    word = words.take("a command such as line, arc, circle or rect").text.lower()
    read = _READERS.get(ALIASES.get(word, word))
    if read is None:
        raise CommandError(f"'{word}' is no command; use {', '.join(_READERS)}.", column)
    command = read(words, context)
    words.end()
    return command


def _line(words: Words, context: Context) -> Draw:
    points = [words.point(), words.point(), *words.points()]
    close = bool(words.accept("close"))
    curves = lines_through(points, close)
    total = sum(map(curve_length, curves))
    figures = f"{total:.3f} mm" if len(curves) == 1 else f"{len(curves)} sides, {total:.3f} mm"
    return Draw("Line", curves, context.layer, figures, curves[-1].end)


def _polyline(words: Words, context: Context) -> Draw:
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
        raise CommandError("A polyline needs two points or more; write polyline x,y x,y.", words.column)
    total = sum(map(curve_length, curves))
    return Draw("Polyline", tuple(curves), context.layer, f"{len(curves)} segments, {total:.3f} mm", curves[-1].end)


def _arc(words: Words, context: Context) -> Draw:
    start, second = words.point(), words.point()
    if words.accept("centre", "center"):
        words.last = start
        centre = words.point("the centre x,y")
        curve = arc_about(start, second, centre, ccw=not words.accept("cw"))
        words.accept("ccw")
    else:
        curve = arc_through(start, second, words.point("the end of the arc, or centre x,y,"))
    figures = f"radius {curve.radius:.3f} mm, {abs(math.degrees(curve.sweep)):.2f}°"
    return Draw("Arc", (curve,), context.layer, figures, curve.end)


def _circle(words: Words, context: Context) -> Draw:
    centre = words.point("the centre x,y")
    curve = circle(centre, words.length("the radius"))
    return Draw("Circle", (curve,), context.layer, f"radius {curve.radius:.3f} mm", centre)


def _rect(words: Words, context: Context) -> Draw:
    a, b = words.point("a corner x,y"), words.point("the opposite corner x,y")
    return Draw("Rectangle", rectangle(a, b), context.layer, f"{abs(b[0] - a[0]):.3f} by {abs(b[1] - a[1]):.3f} mm", b)


def _chosen(words: Words, context: Context, verb: str) -> frozenset[int]:
    ids = frozenset(words.ids()) or context.selection
    if not ids:
        raise InputError(f"Nothing is selected; select what to {verb}, or write its numbers after the command.")
    return ids


def _delete(words: Words, context: Context) -> Delete:
    return Delete(_chosen(words, context, "delete"))


def _move(words: Words, context: Context) -> Move:
    word = words.take("the shift @dx,dy")
    if not word.text.startswith("@"):
        raise CommandError(f"'{word.text}' is no shift; write @dx,dy or @r<angle.", word.column)
    by = read_point(word.text, (0.0, 0.0), word.column)
    return Move(_chosen(words, context, "move"), by)


def _layer(words: Words, context: Context) -> SetLayer:
    name = words.name("the name of a layer").strip()
    if not name:
        raise CommandError("The name of the layer is empty; write a name.", words.column)
    return SetLayer(name, frozenset(words.ids()))


def _select(words: Words, context: Context) -> Select:
    how = How(words.accept("add", "remove"))
    kind = words.accept("all", "none", "window", "crossing", "layer")
    if kind in ("window", "crossing"):
        return Select(By(kind), how, box=_box(words.point("a corner x,y"), words.point("the opposite corner x,y")))
    if kind == "layer":
        return Select(By.LAYER, how, layer=words.name("the name of a layer"))
    if kind:
        return Select(By(kind), how)
    if not words.more:
        raise CommandError("Write what to select: all, none, window, crossing, layer, or entity numbers.", words.column)
    return Select(By.IDS, how, frozenset(words.ids()))


def _box(a: Point, b: Point) -> tuple[float, float, float, float]:
    return (min(a[0], b[0]), min(a[1], b[1]), max(a[0], b[0]), max(a[1], b[1]))


_READERS: dict[str, Callable[[Words, Context], Command]] = {
    "line": _line, "polyline": _polyline, "arc": _arc, "circle": _circle, "rect": _rect, "select": _select, "delete": _delete,
    "move": _move, "layer": _layer, "undo": lambda words, context: Undo(), "redo": lambda words, context: Redo(),
}
