"""Tools in and out by the kind of file: a library (.toml), a spreadsheet (.csv), LinuxCNC's tool table (.tbl); in
alone: libraries of Fusion, FreeCAD and Vectric. Others can be registered.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import PurePath

from ...core.errors import InputError
from ...model.part import Units
from ...model.tool_table import TableRow, row_of
from .csv import read_tool_csv, write_tool_csv
from .library import ReadTools, ToolLibrary, read_library, write_library
from .tbl import read_tool_table, write_tool_table


@dataclass(frozen=True)
class ToolFormat:
    """A kind of file that holds tools.

    Attributes:
        suffix: of its files, in lower case, with the dot.
        read: returns the tools of a file's bytes, and a sentence for each thing left out; it takes the file's name and
            the units of lengths that name none, and raises InputError.
        write: returns a file's bytes; the units are those in which a kind that names none is written; None = the kind
            is read alone.
        rows: returns what a control's tool table would hold, where a file says that itself; None = of its tools.
    """

    suffix: str
    read: Callable[[str, bytes, Units], ReadTools]
    write: Callable[[ToolLibrary, Units], bytes] | None = None
    rows: Callable[[str, bytes, Units], tuple[TableRow, ...]] | None = None


_FORMATS: dict[str, ToolFormat] = {}


def register(format_: ToolFormat) -> None:
    """Make a kind of file known.

    Raises:
        ValueError: another kind has its suffix.
    """
    if _FORMATS.setdefault(format_.suffix, format_) is not format_:
        raise ValueError(f"two kinds of tool files have the suffix {format_.suffix}")


def read_tools(name: str, data: bytes, units: Units = Units.MM) -> ReadTools:
    """Return the tools of a file, and a sentence for each thing in it that is left out.

    Args:
        name: of the file; its suffix tells the kind, and without its suffix it names tools that have no name of their
            own.
        data: its bytes.
        units: of a tool table, which names none.

    Raises:
        InputError: the file is none of these, or there is something wrong with it, or no tool in it.
    """
    return _format(name).read(name, data, units)


def read_rows(name: str, data: bytes, units: Units = Units.MM) -> tuple[TableRow, ...]:
    """Return what a control's tool table would hold of the tools of a file, as `read_tools` takes it.

    Raises:
        InputError: as `read_tools`.
    """
    format_ = _format(name)
    if format_.rows is not None:
        return format_.rows(name, data, units)
    return tuple(row_of(tool) for tool in format_.read(name, data, units)[0].tools)


def write_tools(name: str, library: ToolLibrary, units: Units = Units.MM) -> bytes:
    """Return a file's bytes.

    Args:
        name: of the file; its suffix tells the kind.
        library: what to write; a tool table keeps number, diameter, length and name alone.
        units: of a tool table, MM or INCH.

    Raises:
        InputError: the suffix is none of these, or two tools have the same number.
    """
    write = _format(name).write
    if write is None:
        known = ", ".join(suffix for suffix, each in _FORMATS.items() if each.write)
        raise InputError(f"{name}: tools of this kind are read alone; write them as {known}.")
    return write(library, units)


def suffixes() -> tuple[str, ...]:
    """Return the suffixes of all kinds of files that are read."""
    return tuple(_FORMATS)


def _format(name: str) -> ToolFormat:
    suffix = PurePath(name).suffix.lower()
    if suffix not in _FORMATS:
        raise InputError(f"{name}: tools are read as {', '.join(_FORMATS)}; choose a file that ends so.")
    return _FORMATS[suffix]


def _read_csv(name: str, data: bytes, units: Units) -> ReadTools:
    library, passed = read_tool_csv(name, data)
    return ReadTools(ToolLibrary(PurePath(name).stem, library.tools), passed)


def _read_table(name: str, data: bytes, units: Units) -> ReadTools:
    tools, left_out = read_tool_table(name, data, units).tools(name)
    if not tools:
        raise InputError(left_out[0])
    return ReadTools(ToolLibrary(PurePath(name).stem, tools), left_out)


def _read_fusion(name: str, data: bytes, units: Units) -> ReadTools:
    from .fusion import read_fusion  # archives and databases: few commands read one

    return read_fusion(name, data)


def _read_bit(name: str, data: bytes, units: Units) -> ReadTools:
    from .freecad import read_bit

    return read_bit(name, data)


def _read_vectric(name: str, data: bytes, units: Units) -> ReadTools:
    from .vectric import read_vectric

    return read_vectric(name, data)


register(
    ToolFormat(
        ".toml",
        lambda name, data, units: ReadTools(read_library(name, data)),
        lambda library, units: write_library(library),
    )
)
register(ToolFormat(".csv", _read_csv, lambda library, units: write_tool_csv(library)))
register(
    ToolFormat(
        ".tbl",
        _read_table,
        lambda library, units: write_tool_table(map(row_of, library.tools), units),
        lambda name, data, units: read_tool_table(name, data, units).rows,
    )
)
register(ToolFormat(".tools", _read_fusion))
register(ToolFormat(".json", _read_fusion))
register(ToolFormat(".fctb", _read_bit))
register(ToolFormat(".vtdb", _read_vectric))
