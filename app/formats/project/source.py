"""Which drawing the part of a project was read from, and how, as a table of the project file."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from ...core.errors import InputError
from ...core.toml_tables import spelled
from ...model.part import Part
from ...model.read_options import AS_DRAWN, DrawingOptions
from ...model.reading import DrawingSource, ReadingOptions
from ..job.tables import JobTable, JobText, read_flag, read_number, read_text, read_texts, word
from ..job.toml import UNITS
from ..job.write import word_of

_HOW = {
    "overrule": read_flag,
    "layout": read_text,
    "to_zero": read_flag,
    "pixels_per_inch": read_number,
    "without_layers": read_texts,
    "without_types": read_texts,
}
_KEYS = ("path", "units", "layers", *_HOW)


def source_lines(source: DrawingSource | None, part: Part) -> Iterator[str]:
    """Yield the table of a project file: what is as the drawing's file has it is not said.

    Args:
        source: of the part; None where it was drawn here.
        part: also tells what was assumed of a drawing that leaves it open, so that a program is told to be of the same.
    """
    if source is None:
        return
    yield from ("", "[source]", f"path = {spelled(source.path)}")
    reading = source.reading
    if reading.units is not None:
        yield f"units = {spelled(word_of(UNITS, reading.units))}"
    if reading.layers:
        yield f"layers = {spelled(reading.layers)}"
    how = reading.how if part.reading == AS_DRAWN else part.reading
    for key in _HOW:
        value = getattr(how, key)
        if value != getattr(AS_DRAWN, key):
            yield f"{key} = {spelled(value)}"


def read_source(lines: JobText, values: dict[str, Any]) -> DrawingSource | None:
    """Return what `source_lines` has written.

    Args:
        lines: the file, for errors.
        values: of the table; empty where it is not there.

    Raises:
        InputError: a value is missing, unknown, of another kind or out of its range, with its line.
    """
    if not values:
        return None
    table = JobTable(lines, "source", 0, dict(values))
    table.take("path", read_text)
    table.take("units", word(UNITS, "unit"))
    table.take("layers", read_texts)
    for key, read in _HOW.items():
        table.take(key, read)
    table.done(", ".join(_KEYS))
    taken = table.taken
    if not taken.get("path"):
        raise InputError(f"{lines.name}:{lines.line('source', 0, '')}: [source] names no drawing; give its path.")
    how = lines.built("source", 0, lambda: DrawingOptions(**{key: taken[key] for key in _HOW if key in taken}))
    return DrawingSource(taken["path"], ReadingOptions(taken.get("units"), taken.get("layers", ()), how))
