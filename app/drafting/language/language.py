"""The shape language: a drawing in words, a command a line.

    line P P [P …] [close]                        li
    polyline P P [arc via end] … [close]          pl    lines, and arcs by way of a point
    arc P P centre P [cw]                         ar    start, end, centre
    arc P P radius r [cw] [large]                       start, end, radius
    arc P P P                                           start, by way of, end
    arc on P                                            onward from the curve drawn last, without a corner
    circle P r                                    ci    also: through P; diameter P P; through P P P
    rect P P [round r]                            re
    polygon n P P                                 pg    corners, centre, a corner; after side: the middle of a side
    slot P P width                                sl
    ellipse P P half [from a to a] [cw]           el    centre, end of a half axis, length of the other
    spline P P P … [close]                        sp    through points
    spline degree n P P … [knots k …] [weights w …]     by control points
    point P     guide P P | P angle | across P | up P
    dimension P P place P [across|up] | CURVE place P | angle P P P place P
    text P height "words" [font "name or file"] [align left|centre|right] [angle a]
    text along CURVE height "words" [font "name or file"] [align left|centre|right] [at P] [lift d] [back]

    select all | none | CURVES | window P P | crossing P P | layer NAME | chain CURVES     (before it: add, remove)
    delete [CURVES]     reverse [CURVES]     undo     redo     clear
    pull [CURVES] P to P      (an end, middle, centre, quadrant, control point, and what hangs on it)
    layer NAME [CURVES]     rename layer NAME to NAME     order layer NAME before|after NAME     remove layer NAME
    hide NAME     show NAME     lock NAME     unlock NAME     colour NAME "#rrggbb" | none     (of layers)
    set [CURVES] start P     also: end, middle, centre, place P; length, radius, diameter, major, minor; angle, sweep
    set [CURVES] layer NAME     set [CURVES] lettering yes|no     (strokes of letters, which bound nothing)
    heal tolerance [CURVES]
    move @dx,dy [CURVES]     copy @dx,dy [times n] [CURVES]     rotate P angle [copy] [CURVES]
    scale P factor [copy] [CURVES]     mirror P P [copy] [CURVES]
    array n n @dx,dy [CURVES]     array polar P n [over angle] [CURVES]

    trim CURVE P [by CURVES]     extend CURVE P [to CURVES]     break CURVE P [P]     offset d P [CURVES] [round]
    join [within d] [CURVES]     explode [CURVES]     measure P P     measure [CURVES]
    fillet r CURVE [P] CURVE [P]     fillet r CURVES     chamfer d [and d] CURVE [P] CURVE [P]     chamfer d CURVES

    let w = 60 + 2     let p = mid(a, b)     circle p w/4 as hole
    repeat 6 as i … end     if w > 50 … else … end     define bolt(c, r) … end

P is `x,y`, `r<angle`, `@dx,dy`, `@r<angle`, or anything that is a point. CURVES are numbers such as 4 7-9 and names
given by `as`; without any what is selected is meant. Numbers take units and arithmetic (`1in+8mm`) and are mm and
degrees without a unit; functions are those of `functions`.
"""

from __future__ import annotations

from collections.abc import Callable

from ..commands import layers
from ..commands.command import Clear, DraftingSession, Edit, Redo, Undo
from ..commands.explode import explode
from ..commands.grips import MoveGrip, pull
from ..commands.heal import Heal, heal
from ..commands.join import join
from ..commands.measure import MeasureCommand, measure
from ..commands.select import SelectEntities
from ..expressions import syntax
from ..expressions.arguments import Arguments
from ..expressions.effort import Effort
from ..expressions.values import wrong
from ..expressions.words import nearest_words
from . import read_corners as corners
from . import read_draw as draw
from . import read_edit as edit
from . import read_notes as notes
from .read_set import SetProperty, set_property
from .read_text import text

Command = (
    MoveGrip
    | Edit
    | notes.DrawNote
    | SetProperty
    | Heal
    | MeasureCommand
    | layers.LayerCommand
    | SelectEntities
    | Undo
    | Redo
)

ALIASES = {
    "li": "line",
    "l": "line",
    "pl": "polyline",
    "ar": "arc",
    "a": "arc",
    "ci": "circle",
    "c": "circle",
    "re": "rect",
    "rectangle": "rect",
    "del": "delete",
    "erase": "delete",
    "mo": "move",
    "se": "select",
    "la": "layer",
    "u": "undo",
    "pg": "polygon",
    "sl": "slot",
    "el": "ellipse",
    "sp": "spline",
    "co": "copy",
    "ro": "rotate",
    "mi": "mirror",
    "tr": "trim",
    "ex": "extend",
    "br": "break",
    "fi": "fillet",
    "cha": "chamfer",
    "o": "offset",
    "color": "colour",
}
"""Short and other words for the commands."""


def command_word(text: str) -> str | None:
    """Return the command that a line begins with, aliases spelled out, or None when it begins with none."""
    first = text.split(maxsplit=1)[:1]
    word = ALIASES.get(first[0].lower(), first[0].lower()) if first else ""
    return word if word in _READERS else None


def read(written: syntax.Command, session: DraftingSession, effort: Effort | None = None) -> Command:
    """Return what a command asks for; what it works on is counted as an effort.

    Raises:
        InputError: it cannot be read or asks for a shape that is none; a CommandError tells the place.
    """
    word = written.word.text.lower()
    reader = _READERS.get(ALIASES.get(word, word))
    if reader is None:
        near = nearest_words(word, (*_READERS, *session.commands))
        raise wrong(f"'{word}' is no command; {f'try {near}.' if near else 'F1 lists them all.'}", written.place)
    words = Arguments(written, session.scope, effort)
    command = reader(words, session)
    words.end()
    return command


_READERS: dict[str, Callable[[Arguments, DraftingSession], Command]] = {
    "line": draw.line,
    "polyline": draw.polyline,
    "arc": draw.arc,
    "circle": draw.circle_of,
    "rect": draw.rect,
    "polygon": draw.polygon_of,
    "slot": draw.slot_of,
    "ellipse": draw.ellipse_of,
    "spline": draw.spline_of,
    "point": notes.point,
    "guide": notes.guide,
    "dimension": notes.dimension,
    "text": text,
    "select": edit.select,
    "delete": edit.delete,
    "move": edit.move,
    "copy": edit.copy,
    "rotate": edit.rotate,
    "scale": edit.scale,
    "mirror": edit.mirror,
    "array": edit.array,
    "reverse": edit.reverse,
    "layer": edit.layer,
    "hide": edit.hide,
    "show": edit.show,
    "lock": edit.lock,
    "unlock": edit.unlock,
    "colour": edit.colour,
    "trim": edit.trim,
    "extend": edit.extend,
    "break": edit.break_at,
    "fillet": corners.fillet_of,
    "chamfer": corners.chamfer_of,
    "offset": edit.offset,
    "join": join,
    "explode": explode,
    "measure": measure,
    "pull": pull,
    "set": set_property,
    "rename": layers.rename,
    "order": layers.order,
    "remove": layers.remove,
    "heal": heal,
    "clear": lambda words, session: Clear(),
    "undo": lambda words, session: Undo(),
    "redo": lambda words, session: Redo(),
}

COMMANDS = tuple(_READERS)
"""Every command by its full word."""
