"""Depths that the drawing of a project tells, as tables of its file: who tells each, and of which curves."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from ...core.errors import InputError
from ...core.toml_tables import spelled
from ...model.drawn_depths import DepthSource, DrawnDepth
from ..job.tables import JobTable, JobText, read_number, read_points, read_text, read_whole, word

_PATH = "told_depth"
_SOURCES = {each.value: each for each in DepthSource}


def depth_lines(depths: Iterable[DrawnDepth]) -> Iterator[str]:
    """Yield the tables of a project file."""
    for each in depths:
        yield from ("", f"[[{_PATH}]]", f"source = {spelled(each.source.value)}")
        if each.depth is not None:
            yield f"depth = {spelled(each.depth)}"
        yield from (f"words = {spelled(each.words)}", f"at = {spelled(each.at)}", f"curves = {spelled(each.curves)}")
        if each.height:
            yield f"height = {spelled(each.height)}"


def read_depths(lines: JobText, tables: Any) -> tuple[DrawnDepth, ...]:
    """Return what `depth_lines` has written.

    Args:
        lines: the file, for errors.
        tables: as TOML gives them.

    Raises:
        InputError: a value is missing, unknown, of another kind or out of its range, with its line.
    """
    if not isinstance(tables, list) or not all(isinstance(each, dict) for each in tables):
        raise InputError(
            f"{lines.name}:{lines.line('', 0, _PATH)}: {_PATH} is a list of tables; write [[{_PATH}]] before each."
        )
    return tuple(_depth(JobTable(lines, _PATH, index, dict(each))) for index, each in enumerate(tables))


def _depth(table: JobTable) -> DrawnDepth:
    table.take("source", word(_SOURCES, "source of a depth"))
    table.take("depth", _above_zero)
    table.take("words", read_text)
    table.take("at", lambda value: read_points([value])[0])
    table.take("curves", _numbers)
    table.take("height", read_number)
    table.done("source, depth, words, at, curves, height")
    for key in ("source", "words", "at"):
        if key not in table.taken:
            raise table.error(key, f"is missing in this [[{_PATH}]]; add {key} = …")
    taken = table.taken
    return DrawnDepth(
        taken["source"],
        taken.get("depth"),
        taken["words"],
        taken["at"],
        taken.get("curves", ()),
        taken.get("height", 0.0),
    )


def _above_zero(value: Any) -> float:
    if not (depth := read_number(value)) > 0:
        raise InputError("a depth is more than 0")
    return depth


def _numbers(value: Any) -> tuple[int, ...]:
    if not isinstance(value, list):
        raise InputError("it must be a list of the numbers of curves")
    return tuple(map(read_whole, value))
