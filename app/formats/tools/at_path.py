"""Tools of a file or a folder: FreeCAD keeps a bit in each file, and a library of them beside."""

from __future__ import annotations

from pathlib import Path

from ...core.errors import InputError
from ...core.input_file import read_input
from ...model.part import Units
from .files import read_tools, suffixes
from .freecad import read_bits
from .library import ReadTools

MOST_BITS = 5000
"""Files of a folder; more are no folder of tools."""


def tools_at(path: Path, units: Units = Units.MM) -> ReadTools:
    """Return the tools of a file of any kind that is known, of a folder of FreeCAD's bits, or of a library of them.

    Args:
        path: of the file or folder; a library's bits are looked for beside it and in the folder `Bit` beside its own.
        units: of a tool table, which names none.

    Raises:
        InputError: it cannot be read, or there is no tool in it.
    """
    if path.is_dir():
        bits = _bits(path)
        if not bits:
            raise InputError(f"{path}: there is no tool bit, .fctb, in this folder; name a file of tools.")
        libraries = sorted([*path.glob("*.fctl"), *path.glob("Library/*.fctl"), *path.parent.glob("Library/*.fctl")])
        return read_bits(path.name, _read(bits), _read(libraries))
    if path.suffix.lower() == ".fctl":
        return read_bits(path.name, _read([*_bits(path.parent), *_bits(path.parent.parent / "Bit")]), _read([path]))
    return read_tools(path.name, read_input(path), units)


def tool_suffixes() -> tuple[str, ...]:
    """Return the suffixes of the files that `tools_at` reads."""
    return (*suffixes(), ".fctl")


def holds_tools(path: Path) -> bool:
    """Return whether a file is one of tools: by its suffix; of TOML, which jobs and scenes are too, by its tables."""
    suffix = path.suffix.lower()
    if suffix != ".toml":
        return suffix in tool_suffixes()
    try:
        lines = read_input(path).splitlines()
    except InputError:
        return False
    tables = [line.strip() for line in lines if line.lstrip().startswith(b"[")]
    return bool(tables) and all(table.startswith((b"[[tool]]", b"[[tool.")) for table in tables)


def _bits(folder: Path) -> list[Path]:
    """Return the bits of a folder and of the folders in it."""
    found = sorted([*folder.glob("*.fctb"), *folder.glob("*/*.fctb")]) if folder.is_dir() else []
    if len(found) > MOST_BITS:
        raise InputError(f"{folder}: there are {len(found)} tool bits in this folder; {MOST_BITS} are the most.")
    return found


def _read(paths: list[Path]) -> dict[str, bytes]:
    return {str(path): read_input(path) for path in dict.fromkeys(paths)}
