"""Tool libraries: TOML files of tools that ship in `resources/tools`, and the user's own beside the settings.

The header that `write_library` puts above each file explains every key. Version 1 of the format; a file of a later one
is refused rather than half read. Whatever a `Tool` holds is written and read back the same, to the last bit; angles
are, where they are what some number of degrees is.
"""

from __future__ import annotations

import math
from dataclasses import MISSING, dataclass, make_dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple, get_type_hints

from ...core.errors import HitofudeError, InputError
from ...core.input_file import FileBytes
from ...core.resources import resource
from ...core.settings import config_folder
from ...core.toml_tables import read_tree, tables_of, write_tables
from ...model.fields import Unit, declared_of
from ...model.tool import Tool
from .holders import outline_of

FORMAT = 1
HEADER = """\
# A tool library of Hitofude. Lengths are mm, angles degrees, speeds rpm, feed rates mm/min.
# Every [[tool]] needs number (1 to 9999, each once) and diameter; what is left out is not known.
#   kind             flat, ball, bull (bull-nose), v, drill, taper (cone with a ball at its tip), reamer, tap,
#                    thread-mill
#   name, remark     texts
#   flutes           cutting edges
#   tool_material    what they are made of: unknown, hss (high-speed steel) or carbide
#   spindle_speed, feed_rate, plunge_rate
#   corner_radius    bull: of the rounded corner
#   tip_angle        v, drill, taper: full angle of the point or cone
#   tip_diameter     v: of the flat at the point; taper: of the ball at the tip; tap, thread-mill: within the teeth
#   flute_length, overall_length, stick_out (tip to holder), shank_diameter
#   holder           outline above its lower face: [[height, radius], ...], heights from 0 on; or a name, such as "ER20"
#   length_offset    what the control's tool table takes off (G43)
# Each [[tool.feeds]] below a tool is one material:
#   material, surface_speed (m/min, at the full diameter), feed_per_tooth (mm), plunge_share (of the feed, \
straight down)
"""
RANGES = {"format": (1, FORMAT)}


@dataclass(frozen=True, slots=True)
class ToolLibrary:
    """A named collection of tools.

    Attributes:
        name, remark: for people.
        tools: each number once.
    """

    name: str = ""
    tools: tuple[Tool, ...] = ()
    remark: str = ""


class ReadTools(NamedTuple):
    """Tools of a file, and a sentence for each thing in it that is left out."""

    library: ToolLibrary
    left_out: tuple[str, ...] = ()


def _tool(entry: Any) -> Tool:
    """Return the tool of an entry of a file.

    Raises:
        ParameterError: a value is out of its range.
    """
    values = {key: value for key in _KEYS if (value := getattr(entry, key)) is not None}
    if entry.tip_angle is not None:
        values["tip_angle"] = math.radians(entry.tip_angle)
    return Tool(**values)


def _entry(tool: Tool) -> Any:
    """Return a tool's entry, without what is as the model has it anyway."""
    values = {
        key: placed.of(tool)
        for key, placed in declared_of(Tool).items()
        if placed.default is MISSING or placed.of(tool) != placed.default
    }
    if tool.tip_angle:
        values["tip_angle"] = shortest_degrees(tool.tip_angle)
    return _Entry(**values)


_REMEMBERED = 16
"""Libraries."""

_LISTS = (Unit.OUTLINE, Unit.FEEDS)
_KEYS = sorted(declared_of(Tool), key=lambda key: declared_of(Tool)[key].parameter.unit in _LISTS)
"""Of a [[tool]], in the order in which they are written: what is no list first."""


def _entry_field(key: str, hint: Any) -> tuple[Any, ...]:
    """Return the field of an entry for a parameter of tools: None, or no list, where the file leaves it out."""
    placed = declared_of(Tool)[key]
    if placed.default is MISSING:
        return key, hint
    return (key, hint, ()) if placed.parameter.unit in _LISTS else (key, hint | None, None)


_Entry = make_dataclass(
    "_Entry",
    [_entry_field(key, get_type_hints(Tool)[key]) for key in _KEYS],
    namespace={"__post_init__": _tool},
    frozen=True,
)
"""A tool as the file has it."""

_File = make_dataclass(
    "_File",
    [("format", int), ("name", str, ""), ("remark", str, ""), ("tool", tuple[_Entry, ...], ())],  # type: ignore[valid-type]
    frozen=True,
)


def shortest_degrees(angle: float) -> float:
    """Return the shortest number of degrees that is exactly this angle, radians."""
    degrees = math.degrees(angle)
    near = (round(degrees, digits) for digits in range(14))
    return next((value for value in near if math.radians(value) == angle), degrees)


@lru_cache(maxsize=_REMEMBERED)
def read_library(name: str, data: bytes) -> ToolLibrary:
    """Return the library that a TOML text holds; those read last are remembered, for each is asked for by many.

    Args:
        name: of the file, for errors.
        data: its bytes, UTF-8.

    Raises:
        InputError: file, line and key, what is wrong and what is expected.
    """
    tree = read_tree(name, data)
    _draw_holders(name, tree)
    read: Any = tables_of(_File, tree, FileBytes(name, data), RANGES)
    tools = tuple(map(_tool, read.tool))
    check_numbers(name, tools)
    return ToolLibrary(read.name, tools, read.remark)


def _draw_holders(file: str, tree: dict[str, Any]) -> None:
    """Put outlines in the place of holders' names."""
    tools = tree.get("tool")
    for number, tool in enumerate(tools if isinstance(tools, list) else (), 1):
        if isinstance(tool, dict) and isinstance(tool.get("holder"), str):
            try:
                tool["holder"] = [list(point) for point in outline_of(tool["holder"])]
            except InputError as error:
                raise InputError(f"{file}: tool[{number}].holder: {error}") from error


def check_numbers(name: str, tools: tuple[Tool, ...]) -> None:
    """Check that no two tools of a file have the same number.

    Raises:
        InputError: two have.
    """
    numbers = [tool.number for tool in tools]
    for number in numbers:
        if numbers.count(number) > 1:
            raise InputError(
                f"{name}: T{number} is there {numbers.count(number)} times; give each tool its own number."
            )


def write_library(library: ToolLibrary) -> bytes:
    """Return the TOML text of a library, from which `read_library` makes the same one.

    Raises:
        InputError: two tools have the same number.
    """
    check_numbers(library.name or "tool library", library.tools)
    made = _File(FORMAT, library.name, library.remark, tuple(map(_entry, library.tools)))
    return f"{HEADER}\n{write_tables(made)}".encode()


def library_files() -> dict[str, Path]:
    """Return every library's file by its name, sorted; a user's file hides one of the same name that ships."""
    own = own_folder()
    found = [*resource("tools").glob("*.toml"), *(own.glob("*.toml") if own.is_dir() else ())]
    return dict(sorted({path.stem: path for path in found}.items()))


def own_folder() -> Path:
    """Return the folder of the user's own libraries; it need not exist yet."""
    return config_folder() / "tools"


class LoadedLibraries(NamedTuple):
    """Libraries by their files' names, and a sentence for each file that cannot be read."""

    libraries: dict[str, ToolLibrary]
    problems: tuple[str, ...]


def load_libraries() -> LoadedLibraries:
    """Return every library by its file's name, and a sentence for each file that cannot be read."""
    libraries: dict[str, ToolLibrary] = {}
    problems = []
    for stem, path in library_files().items():
        try:
            libraries[stem] = read_library(path.name, path.read_bytes())
        except HitofudeError as error:
            problems.append(str(error))
        except OSError as error:
            problems.append(f"{path}: {error.strerror}; the tools in it are left out.")
    return LoadedLibraries(libraries, tuple(problems))
