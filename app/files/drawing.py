"""What every reader of drawings returns, and the one door to all of them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import PurePath

from app.errors import InputError
from app.model.finding import Finding
from app.model.part import Part, Units

PROJECTS = (".hito", ".hito~")
"""A project, and the backup of one."""

SUFFIXES = (*PROJECTS, ".dxf", ".svg", ".draw")
"""Suffixes of drawings that can be read, in lower case."""


@dataclass(frozen=True)
class Drawing:
    """A drawing as it was read.

    Attributes:
        part: its curves in mm.
        findings: what is worth saying about the file.
        left_out: (type, how many) of what is not machined, such as ("TEXT", 5).
        units_named: False when the file names no units and they had to be assumed or given.
    """

    part: Part
    findings: tuple[Finding, ...] = ()
    left_out: tuple[tuple[str, int], ...] = ()
    units_named: bool = True


def read_drawing(path_name: str, data: bytes, units: Units | None = None, layers: tuple[str, ...] = ()) -> Drawing:
    """Return the drawing in a file's bytes, by the suffix of its name.

    Args:
        path_name: the file's path or name; only its last part appears in messages.
        data: the whole file.
        units: of a drawing that names none.
        layers: only curves on these are kept; empty = all.

    Raises:
        InputError: the suffix is not supported, or the file cannot be used.
    """
    name = PurePath(path_name).name
    suffix = PurePath(path_name).suffix.lower()
    if suffix not in SUFFIXES:
        raise InputError(f"{name}: drawings of type {suffix or 'without a suffix'} cannot be read; supported: {', '.join(SUFFIXES)}.")
    if suffix == ".svg":
        from app.files.svg import read_svg

        return read_svg(data, name, units, layers)
    if suffix == ".draw":
        from app.files.draw import read_draw

        return read_draw(data, name, units, layers)
    if suffix in PROJECTS:
        from app.files.project import project_drawing

        return project_drawing(data, name, units, layers)
    from app.files.dxf import read_dxf

    return read_dxf(data, name, units, layers)
