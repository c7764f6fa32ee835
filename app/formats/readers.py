"""The one door to all readers of drawings: by the suffix of a file's name."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import PurePath

from ..core.errors import InputError
from ..model.part import Units
from ..model.read_options import AS_DRAWN, ReadOptions
from .drawing import Drawing

PROJECTS = (".hito", ".hito~")
"""A project, and the backup of one."""

SUFFIXES = (*PROJECTS, ".dxf", ".svg", ".draw")
"""Suffixes of drawings that can be read, in lower case."""


def read_drawing(
    path_name: str,
    data: bytes,
    units: Units | None = None,
    layers: tuple[str, ...] = (),
    how: ReadOptions = AS_DRAWN,
) -> Drawing:
    """Return the drawing in a file's bytes, by the suffix of its name.

    Args:
        path_name: the file's path or name; only its last part appears in messages.
        data: the whole file.
        units: of a drawing that names none.
        layers: only curves on these are kept; empty = all.
        how: what else is said about reading it.

    Raises:
        InputError: the suffix is not supported, the file cannot be used, or something that is said has no effect on it.
    """
    name = PurePath(path_name).name
    suffix = PurePath(path_name).suffix.lower()
    if suffix not in SUFFIXES:
        raise InputError(
            f"{name}: drawings of type {suffix or 'without a suffix'} cannot be read; supported: {', '.join(SUFFIXES)}."
        )
    how.check(name, suffix)
    drawing = _READERS[suffix](data, name, (units, layers), how)
    drawing = _without_layers(drawing, how, name)
    return drawing if suffix == ".svg" else replace(drawing, part=replace(drawing.part, reading=how))


def _without_layers(drawing: Drawing, how: ReadOptions, name: str) -> Drawing:
    """Return the drawing without the curves on some layers.

    Raises:
        InputError: there is no such layer, or nothing is left.
    """
    layers = how.without_layers
    if not layers:
        return drawing
    part, gone = drawing.part, {layer.casefold() for layer in layers}
    known = {layer.name.casefold() for layer in part.layers}
    missing = [layer for layer in layers if layer.casefold() not in known]
    if missing and not how.lenient:
        raise InputError(
            f"{name}: there is no layer {missing[0]} to leave out; the drawing has "
            f"{', '.join(layer.name for layer in part.layers)}."
        )
    kept = tuple(entity for entity in part.entities if entity.layer.casefold() not in gone)
    if not kept:
        raise InputError(f"{name}: without layer {', '.join(layers)} nothing is left to machine; leave out less.")
    return replace(drawing, part=replace(part, entities=kept))


_Chosen = tuple[Units | None, tuple[str, ...]]
"""Units of a drawing that names none, and the layers that are kept."""


def _svg(data: bytes, name: str, chosen: _Chosen, how: ReadOptions) -> Drawing:
    from .svg.svg import read_svg

    return read_svg(data, name, *chosen, how)


def _draw(data: bytes, name: str, chosen: _Chosen, _: ReadOptions) -> Drawing:
    from .draw import read_draw

    return read_draw(data, name, *chosen)


def _project(data: bytes, name: str, chosen: _Chosen, _: ReadOptions) -> Drawing:
    from .project.project import project_drawing

    return project_drawing(data, name, *chosen)


def _dxf(data: bytes, name: str, chosen: _Chosen, how: ReadOptions) -> Drawing:
    from .dxf.dxf import read_dxf

    return read_dxf(data, name, *chosen, how)


_READERS: dict[str, Callable[[bytes, str, _Chosen, ReadOptions], Drawing]] = {
    ".dxf": _dxf,
    ".svg": _svg,
    ".draw": _draw,
    **dict.fromkeys(PROJECTS, _project),
}
