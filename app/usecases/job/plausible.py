"""Whether a drawing's size can be meant with the tools that are to cut it; where not, its units are asked for before
anything is computed.

A refusal and no finding: what would be computed is the wrong part, for minutes, and one word of the user settles it
either way.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from pathlib import PurePath

from ...core.errors import InputError
from ...core.options import option
from ...core.wording import either
from ...formats.drawing import Drawing
from ...formats.drawing_account import size_of
from ...formats.readers import format_of, read_drawing
from ...formats.reading_question import (
    UNIT_WORDS,
    ReadingChoice,
    ReadingQuestion,
    Size,
    SizeInUnits,
    UndecidedError,
    size_question,
    size_words,
)
from ...model.job import Job
from ...model.part import Part, Units
from ...model.reading import ReadingOptions
from .options import MakeOptions, job_with_options, layers_of_drawing

_WIDEST, _LEAST_WIDE = 2000.0, 5000.0
"""So many times as long as the widest tool is wide, and so many mm, a part is no part any more: no machine for that
tool takes it.
"""

_SMALLEST, _LARGEST_SMALL = 0.05, 0.5
"""Less of the smallest tool's width, and less than so many mm, is nothing to be milled."""

_UNITS = {Units.MM: "mm", Units.INCH: "in", Units.CM: "cm", Units.M: "m", Units.FOOT: "ft", Units.MICRON: "um"}
_LIKELY = (Units.MM, Units.INCH, Units.M)
"""Units that are offered."""


def read_plausible(
    name: str, data: bytes, reading: ReadingOptions, diameters: Callable[[Drawing], Iterable[float]]
) -> Drawing:
    """Return a drawing of a size that its tools can cut.

    Units that are given are those of a drawing that names none. Where it names some in which its size cannot be meant,
    they hold all the same, for that is what was asked.

    Args:
        name: of the file. data: its bytes.
        reading: how it is read.
        diameters: gives those of the tools, mm, for the drawing.

    Raises:
        InputError: the drawing cannot be used; `UndecidedError`: its size cannot be meant and nobody has said its
            units.
    """
    drawing = _read(name, data, reading)
    if not format_of(name).foreign:
        return drawing
    tools = tuple(diameters(drawing))
    reason = implausible_size(drawing.part, reading.layers, tools)
    if (
        not reason
        or reading.units is drawing.part.units
        or (reading.how.pixels_per_inch is not None and not drawing.units_named)
    ):
        return drawing
    if reading.units is None:
        sized = lambda units: _size_in(units, drawing, reading, name, data)  # noqa: E731 (read only when it is asked)
        raise UndecidedError(
            f"{PurePath(name).name}: {reason}. {_options(drawing)}", _question(drawing, reading, tools, sized)
        )
    return _read(name, data, replace(reading, how=replace(reading.how, overrule=True)))


def _read(name: str, data: bytes, reading: ReadingOptions) -> Drawing:
    return read_drawing(name, data, reading.units, reading.layers, reading.how)


def _size_in(units: Units, drawing: Drawing, reading: ReadingOptions, name: str, data: bytes) -> Size:
    """Return the size of a drawing in other units, mm: where they scale a page, by reading it so; (0, 0)
    where it cannot be.
    """
    if format_of(name).scaled_page:
        try:
            return size_of(_read(name, data, reading.in_units(units)).part, reading.layers)
        except InputError:
            return (0.0, 0.0)
    wide, high = size_of(drawing.part, reading.layers)
    factor = units.value / drawing.part.units.value
    return wide * factor, high * factor


def _question(
    drawing: Drawing, reading: ReadingOptions, tools: tuple[float, ...], sized: Callable[[Units], Size]
) -> ReadingQuestion:
    units, per_inch, size = drawing.part.units, drawing.contents.per_inch, size_of(drawing.part, reading.layers)
    if per_inch is not None:
        whence = f"It has no real size and was read with {per_inch:g} units to the inch"
        keep = ReadingChoice(f"Keep {per_inch:g} to the inch", reading.with_pixels(per_inch), size_words(size))
    else:
        whence = (
            f"The file names {UNIT_WORDS[units]}"
            if drawing.units_named
            else f"It names no units and was read in {UNIT_WORDS[units]}"
        )
        keep = ReadingChoice(f"Keep {UNIT_WORDS[units]}", replace(reading, units=units), size_words(size))
    others = [(each, sized(each)) for each in _LIKELY if each is not units or per_inch is not None]
    fitting = [SizeInUnits(each, found) for each, found in others if max(found) and not _doubt(found, tools)]
    return size_question(size, whence, keep, fitting, tools)


def read_for(name: str, data: bytes, options: MakeOptions) -> Drawing:
    """Return the drawing that a job machines.

    Raises:
        HitofudeError: it or an option cannot be used, or its size cannot be meant with the job's tools.
    """

    def diameters(drawing: Drawing) -> list[float]:
        return diameters_used(job_with_options(drawing.part, options))

    return read_plausible(
        name, data, ReadingOptions(options.units, layers_of_drawing(options), options.reading), diameters
    )


def diameters_used(job: Job) -> list[float]:
    """Return the diameters of the tools that a job's operations use, mm."""
    used = {operation.cut.tool for operation in job.operations if operation.cut.enabled}
    return [tool.diameter for tool in job.tools if tool.number in used]


def implausible_size(part: Part, layers: tuple[str, ...], diameters: tuple[float, ...]) -> str:
    """Return why a part's size cannot be meant, or "".

    Args:
        layers: that are machined; empty = all visible ones. diameters: of the tools, mm.
    """
    return _doubt(size_of(part, layers), diameters)


def _doubt(found: Size, diameters: tuple[float, ...]) -> str:
    wide, high = found
    if not (wide or high) or not diameters:
        return ""
    longest, size = max(wide, high), f"the drawing is {wide:.6g} x {high:.6g} mm"
    if longest > max(_WIDEST * max(diameters), _LEAST_WIDE):
        return f"{size}, and the largest tool {max(diameters):g} mm: {longest / max(diameters):.0f} tools side by side"
    if longest < min(_SMALLEST * min(diameters), _LARGEST_SMALL):
        return (
            f"{size}, and the smallest tool {min(diameters):g} mm: {min(diameters) / max(longest, 1e-9):.0f} times "
            "as wide"
        )
    return ""


def _options(drawing: Drawing) -> str:
    """Return what to say on the command line."""
    word = _UNITS[drawing.part.units]
    others = either(option("units", each) for each in ("mm", "in", "m") if each != word)
    per_inch = drawing.contents.per_inch
    if per_inch is not None:
        return (
            f"It has no real size; say which units are meant, {option('units', 'mm')} or {others}, or "
            f"{option('px-per-inch', f'{per_inch:g}')} if this is right."
        )
    named = f"It names {word} as its units" if drawing.units_named else f"It names no units, and {word} is assumed"
    return f"{named}; say which are meant, {others}, or {option('units', word)} if this is right."
