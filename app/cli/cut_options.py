"""The options of `cut`: their names, their help, how each value is read and what range it has."""

from __future__ import annotations

import argparse
import math
import re
from pathlib import Path
from typing import Any

from ..core.errors import HitofudeError, InputError
from ..core.wording import either
from ..drafting.expressions.errors import CommandError
from ..drafting.expressions.numbers import angle, length
from ..formats.job.toml import ORIGIN_HELP, parse_origin, read_units
from ..formats.readers import offered_suffixes
from ..formats.tools.holders import outline_of
from ..model.operation import LEAST_LENGTH
from ..model.tool import HolderPoint, Tool
from ..model.tool_kind import ToolKind, tool_kinds
from ..usecases.cutting.cut import CELLS, Engine
from ..usecases.cutting.setup_stock import FINEST, box_stock
from ..usecases.cutting.setup_tools import ToolHolding
from ..usecases.examine import CONTROLS
from .command import OptionParser, join_tolerance, number, typed
from .reading_options import NAMES, add_reading_options

EPILOG = """\
Tools that are not given with --tool are looked for in the job file, in the tool table, in the program's comments; the
stock in the job file (with --against DRAWING), in the comments, or else it is a box round the cuts, which is said. A
program that `make` has written tells everything. Coordinates are those of the program, tool lengths taken off. Several
programs are cut one after the other. D is a diameter: 6, 6mm, 0.25in, 1/4in. Lengths are mm unless a unit is written.
Mills given by --tool have two flutes and cut at their centre; a job file tells of others. Exit status 0: done and
clean; 1: with findings (gouge, metal left within reach, rapid, shank or holder in material, a start in the stock, …);
2: something cannot be used; 130: cancelled.
"""

HELD = "NUMBER=HOLDER:STICKOUT"
Corners = list[float]
"""x0, y0, z0, x1, y1, z1, mm."""

ENGINE_HELP = (
    "what computes the heights: cpu, the engine of record; gpu, within 1e-4 mm of it by the graphics system; patent, "
    "by facets in the depth buffer, the method of 1999; where the graphics system fails, cpu (default auto: gpu on "
    "graphics hardware, else cpu)"
)


def _shapes() -> str:
    """Return how a tool of each kind is told."""
    ways = {
        kind: either(
            ":".join(kind.spelled().split(":")[: len(kind.given) + 1 - fewer])
            for fewer in range(kind.omissible, -1, -1)
        )
        for kind in tool_kinds()
    }
    return ", ".join(ways.values())


def tool_given(text: str) -> tuple[int, Tool]:
    """Return a tool by a text such as `1=ball:6` or `2=v:1/4in:90`; 0 = the tool of a program that names none.

    Raises:
        InputError: it is not of that form, or its numbers make no tool.
    """
    match = re.fullmatch(r"\s*(\d{1,4})\s*=(.*)", text)
    if match is None or _kind_given(match[2]) is None:
        raise InputError(f"'{text}' is no tool; write NUMBER=KIND:DIAMETER, such as 1=ball:6: {_shapes()}")
    return int(match[1]), shape_given(match[2], max(int(match[1]), 1), text)


def shape_given(text: str, number: int = 1, written: str = "") -> Tool:
    """Return a tool of a number by a text such as `ball:6` or `v:1/4in:90`.

    Args:
        written: what it is part of, for errors.

    Raises:
        InputError: it is not of that form, or its numbers make no tool.
    """
    kind, written = _kind_given(text), written or text
    if kind is None:
        raise InputError(f"'{written}' is no tool; write KIND:DIAMETER, such as ball:6: {_shapes()}")
    values = text.split(":")[1:]
    if not len(kind.given) - kind.omissible <= len(values) <= len(kind.given):
        raise InputError(f"'{written}' has {_counted(values)} behind {kind.value}; write one of {_shapes()}")
    try:
        return _shaped(number, kind, values)
    except CommandError as error:
        raise InputError(f"'{written}': {error.reason}") from error
    except HitofudeError as error:
        raise InputError(f"'{written}': {error}") from error


def _kind_given(text: str) -> ToolKind | None:
    """Return the kind that a text such as `ball:6` begins with."""
    word, colon, _ = text.partition(":")
    return ToolKind.words().get(word.strip().lower()) if colon else None


def _shaped(tool: int, kind: ToolKind, values: list[str]) -> Tool:
    reported: dict[str, Any] = {
        key: math.radians(angle(value)) if key == "tip_angle" else length(value)
        for key, value in zip(kind.given, values, strict=False)
    }
    return Tool(tool, reported.pop("diameter"), kind, **reported)


def holder_given(text: str) -> tuple[int, ToolHolding]:
    """Return how a tool is held by a text such as `1=ER20:35`, holder and stick-out, or `1=0,10;25,15:35` by its
    outline.

    Raises:
        InputError: it is not of that form, there is no such holder, or its numbers make none.
    """
    match = re.fullmatch(r"\s*(\d{1,4})\s*=\s*([^:]+):([^:]+)", text)
    if match is None:
        raise InputError(f"'{text}' is no holder; write {HELD}, such as 1=ER20:35")
    try:
        stick_out = length(match[3])
        outline = (
            tuple(_point(point, text) for point in match[2].split(";"))
            if "," in match[2]
            else outline_of(match[2].strip())
        )
        tool = Tool(max(int(match[1]), 1), 1.0, stick_out=stick_out, holder=outline)
    except CommandError as error:
        raise InputError(f"'{text}': {error.reason}") from error
    except HitofudeError as error:
        raise InputError(f"'{text}': {error}") from error
    if not tool.stick_out:
        raise InputError(f"'{text}' has a stick-out of 0; tell how far the tool sticks out of the holder: {HELD}")
    return int(match[1]), ToolHolding(tool.stick_out, tool.holder)


def _point(text: str, whole: str) -> HolderPoint:
    values = text.split(",")
    if len(values) != 2:
        raise InputError(
            f"'{whole}' has {_counted(values)} in '{text}'; write height and radius of each point: 1=0,10;25,15:35"
        )
    return length(values[0]), length(values[1])


def stock_given(text: str) -> Corners | Path:
    """Return the corners of a box, or the file of a solid (.stl) or of heights (.npy).

    Raises:
        InputError: it is none of these.
    """
    path = Path(text)
    if path.suffix.lower() in (".stl", ".npy"):
        return path
    try:
        corners = _lengths(text, 6, "X0,Y0,Z0,X1,Y1,Z1")
        box_stock(corners)
    except InputError as error:
        raise InputError(f"{error}; or name a solid, .stl, or heights, .npy") from error
    except HitofudeError as error:
        raise InputError(f"'{text}': {error} Write the lower corner first: X0,Y0,Z0,X1,Y1,Z1") from error
    return corners


def window_given(text: str) -> tuple[float, float, float, float]:
    """Return a rectangle by four numbers.

    Raises:
        InputError: it is none, or empty.
    """
    x0, y0, x1, y1 = _lengths(text, 4, "X0,Y0,X1,Y1")
    if not (x1 > x0 and y1 > y0):
        raise InputError(f"'{text}' is empty; write the lower left corner first: X0,Y0,X1,Y1")
    return x0, y0, x1, y1


def _lengths(text: str, count: int, form: str) -> Corners:
    values = text.split(",")
    try:
        if len(values) == count:
            return [length(value) for value in values]
    except CommandError as error:
        raise InputError(f"'{text}': {error.reason.rstrip('.')}") from error
    raise InputError(f"'{text}' has {_counted(values)}; write {count}: {form}")


def _counted(values: list[str]) -> str:
    return f"{len(values)} number{'' if len(values) == 1 else 's'}"


def _cells(text: str) -> int:
    if not re.fullmatch(r"\d{1,6}", text.strip()) or not 1 <= int(text) <= FINEST:
        raise InputError(f"'{text}' is no number of cells; write a whole number from 1 to {FINEST}")
    return int(text)


def add_cut_options(parser: OptionParser) -> None:
    """Add the options of `hitofude cut`."""
    parser.add_argument(
        "programs",
        metavar="PROGRAM.ngc",
        type=Path,
        nargs="+",
        help="the NC program, or several in the order of cutting",
    )
    _program_options(parser.add_argument_group("program, tools and stock"))
    _look_options(parser.add_argument_group("how to look"))
    _part_options(parser.add_argument_group("the part that it is compared with"))
    _file_options(parser.add_argument_group("files"))


def _program_options(group: argparse._ArgumentGroup) -> None:
    group.add_argument(
        "--stock",
        metavar="BOX|FILE",
        type=typed(stock_given),
        help="X0,Y0,Z0,X1,Y1,Z1, or a closed SOLID.stl in mm, or HEIGHTS.npy with its .json beside it",
    )
    group.add_argument(
        "--tool",
        metavar="N=SHAPE",
        type=typed(tool_given),
        action="append",
        default=[],
        help=f"a tool by its T number (0: that of a program that names none): {_shapes()}; full angles in degrees; "
        "repeat",
    )
    group.add_argument(
        "--holder",
        metavar="N=HOLDER:STICKOUT",
        type=typed(holder_given),
        action="append",
        default=[],
        help="how a tool is held: a holder by name, such as ER20, or H,R;H,R; heights over its lower face and radii; "
        "repeat",
    )
    group.add_argument("--job", metavar="J.toml", type=Path, help="tools, operations, stock and origin, as for make")
    group.add_argument(
        "--tools",
        metavar="FILE",
        type=Path,
        help="tools: LinuxCNC's .tbl, a library .toml or .csv, or one of another program",
    )
    group.add_argument("--tool-units", choices=["mm", "in"], default="mm", help="of the lengths in a .tbl (default mm)")
    group.add_argument("--dialect", choices=list(CONTROLS), help="the control's language (default: as the text looks)")
    group.add_argument(
        "--block-delete",
        choices=["on", "off"],
        default="on",
        help="leave out the blocks that begin with a slash, or do them (default on)",
    )


def _look_options(group: argparse._ArgumentGroup) -> None:
    group.add_argument(
        "--grid",
        metavar="N",
        type=typed(_cells),
        default=CELLS,
        help=f"square cells along the longer side (default {CELLS})",
    )
    group.add_argument(
        "--window",
        metavar="X0,Y0,X1,Y1",
        type=typed(window_given),
        help="only this part of the stock, as finely; what goes wrong on the way is told of all of it",
    )
    group.add_argument(
        "--engine", choices=[engine.value for engine in Engine], default=Engine.AUTO.value, help=ENGINE_HELP
    )
    group.add_argument(
        "--facet",
        metavar="D",
        type=number("facet"),
        help="size of the facets of the engine patent, which it asks for (mm; default: as it was published, about two "
        "cells); try several and compare",
    )


def _part_options(group: argparse._ArgumentGroup) -> None:
    group.add_argument(
        "--against",
        metavar="PART",
        type=Path,
        help=f"a drawing ({' '.join(offered_suffixes())}), a closed solid (.stl), or a scene of surfaces (.toml)",
    )
    group.add_argument(
        "--depth",
        metavar="Z",
        type=number("depth", least=LEAST_LENGTH),
        help="of a drawing: from the top of the stock down to the floor (default: as the header of make tells)",
    )
    group.add_argument(
        "--stock-to-leave", metavar="MM", type=number("stock to leave", least=0.0), help="metal that stays on purpose"
    )
    group.add_argument(
        "--layer", metavar="NAME", action="append", default=[], help="only this layer of the drawing; may be repeated"
    )
    add_reading_options(group)
    group.add_argument(
        "--units",
        metavar="mm|in",
        type=typed(read_units),
        help="units of a program or a part that names none (default mm)",
    )
    group.add_argument("--origin", metavar="WHERE", type=typed(parse_origin), help=ORIGIN_HELP)
    group.add_argument(
        "--join-tolerance", metavar="MM", type=join_tolerance, help="join loose ends nearer than this, 0 to 10 mm"
    )
    group.add_argument(
        "--tolerance",
        metavar="MM",
        type=number("tolerance", least=LEAST_LENGTH),
        help="metal within this of the part is neither gouged nor left (default 0.01)",
    )


def _file_options(group: argparse._ArgumentGroup) -> None:
    group.add_argument(
        "--heights",
        metavar="OUT.npy",
        type=Path,
        help="what is left: float32 heights, and OUT.json with where they lie",
    )
    group.add_argument("--image", metavar="OUT.png", type=Path, help="a picture of what is left, from above")
    group.add_argument("--report", metavar="R.json", type=Path, help="everything that was measured, as JSON")
    group.add_argument("--quiet", action="store_true", help="say nothing but errors")


def check_cut_arguments(arguments: argparse.Namespace) -> None:
    """Refuse arguments of `cut` that do not go with one another.

    Raises:
        InputError: one line that names them.
    """
    for option in ("tool", "holder"):
        numbers = [given for given, _ in getattr(arguments, option)]
        twice = next((given for given in numbers if numbers.count(given) > 1), None)
        if twice is not None:
            raise InputError(f"--{option} {twice}=…: {option} {twice} is given twice; give each number once")
    if arguments.facet is not None and arguments.engine not in (Engine.AUTO.value, Engine.PATENT.value):
        raise InputError(f"--facet is of the engine patent, not of {arguments.engine}; take one of them away")
    _ensure_part(arguments)


def _ensure_part(arguments: argparse.Namespace) -> None:
    """Refuse options of a part that is not there, or that has no use for them."""
    what = (
        {".stl": "a solid", ".toml": "surfaces"}.get(arguments.against.suffix.lower(), "") if arguments.against else ""
    )
    solid = bool(what)
    names = ["depth", "layer", "join_tolerance", *NAMES] + (
        [] if solid else ["stock_to_leave", "units", "origin", "tolerance"]
    )
    given = next((name for name in names if getattr(arguments, name) not in (None, [], False)), None)
    if given is not None and (solid or arguments.against is None):
        option = "--" + given.replace("_", "-")
        why = f"says nothing of {what}, {arguments.against}"
        why = why if solid else "is of a part to compare with; name it: --against PART"
        raise InputError(f"{option} {why}" + ("; take it away" if solid else ""))
