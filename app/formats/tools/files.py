"""Tools in and out by the kind of file: a library (.toml), a spreadsheet (.csv), LinuxCNC's tool table (.tbl)."""

from __future__ import annotations

from pathlib import PurePath

from ...core.errors import InputError
from ...model.part import Units
from ...model.tool_table import TableRow, row_of
from .csv import read_tool_csv, write_tool_csv
from .library import ToolLibrary, read_library, write_library
from .tbl import read_tool_table, write_tool_table

SUFFIXES = (".toml", ".csv", ".tbl")


def read_tools(name: str, data: bytes, units: Units = Units.MM) -> tuple[ToolLibrary, tuple[str, ...]]:
    """Return the tools of a file, and a sentence for each thing in it that is left out.

    Args:
        name: of the file; its suffix tells the kind, and without its suffix it names tools that have no name of their
            own.
        data: its bytes.
        units: of a tool table, which names none.

    Raises:
        InputError: the file is none of these, or there is something wrong with it, or no tool in it.
    """
    suffix, stem = _suffix(name), PurePath(name).stem
    if suffix == ".toml":
        return read_library(name, data), ()
    if suffix == ".csv":
        library, passed = read_tool_csv(name, data)
        return ToolLibrary(stem, library.tools), passed
    tools, left_out = read_tool_table(name, data, units).tools(name)
    if not tools:
        raise InputError(left_out[0])
    return ToolLibrary(stem, tools), left_out


def read_rows(name: str, data: bytes, units: Units = Units.MM) -> tuple[TableRow, ...]:
    """Return what a control's tool table would hold of the tools of a file, as `read_tools` takes it.

    Raises:
        InputError: as `read_tools`.
    """
    if _suffix(name) == ".tbl":
        return read_tool_table(name, data, units).rows
    return tuple(row_of(tool) for tool in read_tools(name, data, units)[0].tools)


def write_tools(name: str, library: ToolLibrary, units: Units = Units.MM) -> bytes:
    """Return a file's bytes.

    Args:
        name: of the file; its suffix tells the kind.
        library: what to write; a tool table keeps number, diameter, length and name alone.
        units: of a tool table, MM or INCH.

    Raises:
        InputError: the suffix is none of these, or two tools have the same number.
    """
    suffix = _suffix(name)
    if suffix == ".toml":
        return write_library(library)
    return write_tool_csv(library) if suffix == ".csv" else write_tool_table(map(row_of, library.tools), units)


def _suffix(name: str) -> str:
    suffix = PurePath(name).suffix.lower()
    if suffix not in SUFFIXES:
        raise InputError(f"{name}: tools are read and written as {', '.join(SUFFIXES)}; choose a file that ends so.")
    return suffix
