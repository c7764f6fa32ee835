"""The one door to all formats of drawings: by the suffix of a file's name."""

from __future__ import annotations

from dataclasses import fields, replace
from pathlib import PurePath

from ..core.errors import InputError
from ..core.options import option
from ..core.wording import together
from ..model.layer_names import spelled
from ..model.part import Units
from ..model.read_options import AS_DRAWN, OPTION_OF, DrawingOptions
from ..model.reading import ReadingOptions
from .draw import DRAW
from .drawing import Drawing
from .dxf import DXF
from .project import PROJECT
from .registry import FORMATS, DrawingFormat, register
from .svg import SVG, SVGZ

for _format in (PROJECT, DXF, SVG, SVGZ, DRAW):  # what comes with the program, in the order in which it is offered
    register(_format)


def read_drawing(
    path_name: str,
    data: bytes,
    units: Units | None = None,
    layers: tuple[str, ...] = (),
    how: DrawingOptions = AS_DRAWN,
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
    format_ = format_of(name)
    check_options(how, name)
    drawing = _without_layers(format_.read(name, data, ReadingOptions(units, layers, how)), how, name)
    return drawing if format_.scaled_page else replace(drawing, part=replace(drawing.part, reading=how))


def suffixes() -> tuple[str, ...]:
    """Return the suffixes of all drawings that can be read, in lower case."""
    return tuple(FORMATS)


def offered_suffixes() -> tuple[str, ...]:
    """Return the suffixes that help and dialogs name."""
    return tuple(suffix for suffix, each in FORMATS.items() if suffix not in each.hidden)


def formats() -> tuple[DrawingFormat, ...]:
    """Return all formats, in the order of their registration."""
    return tuple(dict.fromkeys(FORMATS.values()))


def known_format(name: str) -> DrawingFormat | None:
    """Return the format of a file by the suffix of its name or path; None where it is no drawing's."""
    return FORMATS.get(PurePath(name).suffix.lower())


def format_of(name: str) -> DrawingFormat:
    """Return the format of a file by the suffix of its name or path.

    Raises:
        InputError: it is no drawing's.
    """
    found = known_format(name)
    if found is None:
        path = PurePath(name)
        raise InputError(
            f"{path.name}: drawings of type {path.suffix.lower() or 'without a suffix'} cannot be read; supported: "
            f"{', '.join(suffixes())}."
        )
    return found


def check_options(how: DrawingOptions, name: str) -> None:
    """Refuse what says nothing of a file.

    Raises:
        InputError: an option has no effect on such a file; or the file is no drawing.
    """
    taken = format_of(name).takes
    for each in _special():
        if getattr(how, each) and each not in taken:
            takers = [suffix for suffix, other in FORMATS.items() if each in other.takes]
            raise InputError(
                f"{option(OPTION_OF[each])} is for {together(takers)} drawings and says nothing of "
                f"{PurePath(name).name}; take it away."
            )


def fit_for(how: DrawingOptions, name: str) -> DrawingOptions:
    """Return options without those that say nothing of a file."""
    found = known_format(name)
    taken = found.takes if found else frozenset()
    return replace(how, **{each: getattr(AS_DRAWN, each) for each in _special() if each not in taken})


def _special() -> tuple[str, ...]:
    """Return the options that some formats alone take, in the order of their declaration."""
    special = {name for each in FORMATS.values() for name in each.takes}
    return tuple(each.name for each in fields(DrawingOptions) if each.name in special)


def _without_layers(drawing: Drawing, how: DrawingOptions, name: str) -> Drawing:
    """Return the drawing without the curves on some layers.

    Raises:
        InputError: there is no such layer, or nothing is left.
    """
    layers = how.without_layers
    if not layers:
        return drawing
    part = drawing.part
    known = [layer.name for layer in part.layers]
    found = spelled(layers, known)
    missing = [layer for layer, there in found.items() if there is None]
    if missing and not how.lenient:
        raise InputError(f"{name}: there is no layer {missing[0]} to leave out; the drawing has {', '.join(known)}.")
    gone = {there.casefold() for there in found.values() if there is not None}
    kept = tuple(entity for entity in part.entities if entity.layer.casefold() not in gone)
    if not kept:
        raise InputError(f"{name}: without layer {', '.join(layers)} nothing is left to machine; leave out less.")
    return replace(drawing, part=replace(part, entities=kept))
