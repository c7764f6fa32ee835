"""Job files: tools, operations, stock and origin as TOML; resources/samples/job.toml shows and explains every key."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from ...core.errors import InputError
from ...core.toml_tables import brief, parsed
from ...model.fields import ParameterPlace, declared_of, with_values
from ...model.job import Job, OriginXY, OriginZ
from ...model.layer_rules import LayerRule
from ...model.part import Part, Units
from ...model.tool import Tool
from .operations import operations_of
from .tables import (
    JobTable,
    JobText,
    one_of,
    read_text,
    reader_of,
    word,
)

UNITS = {
    "mm": Units.MM,
    "in": Units.INCH,
    "inch": Units.INCH,
    "cm": Units.CM,
    "m": Units.M,
    "ft": Units.FOOT,
    "um": Units.MICRON,
}
OUT_UNITS = {"mm": Units.MM, "in": Units.INCH, "inch": Units.INCH}
ORIGIN_XY = {
    "drawing": OriginXY.DRAWING,
    "lower-left": OriginXY.LOWER_LEFT,
    "centre": OriginXY.CENTRE,
    "center": OriginXY.CENTRE,
}
ORIGIN_Z = {"top": OriginZ.TOP, "bottom": OriginZ.BOTTOM}
FEEDS = {"tools": False, "proposed": True}
DEPTHS = {"operations": False, "drawing": True}
SETTINGS = ("stock", "origin", "heights", "drawing", "output", "copies", "keep_out", "sheet")
"""Tables that hold the job's own parameters, in the order in which they are written."""

TABLES = (*SETTINGS, "tool", "operation")
"""Of a job, in files of any kind."""

_RULES = "layer"
"""Of a job file alone: rules for layers; a project's table of that name holds the drawing's."""


@dataclass(frozen=True)
class WordList:
    """Words that stand for values, the first of several being the one that is written; and what they are."""

    words: Mapping[str, Any]
    what: str


WORDS = {
    "origin_xy": WordList(ORIGIN_XY, "origin in the plane"),
    "origin_z": WordList(ORIGIN_Z, "height of the origin"),
    "out_units": WordList(OUT_UNITS, "unit of an NC program"),
}
"""Of parameters of the job whose words in files are not those of their enum."""


def settings_of(table: str) -> Mapping[str, ParameterPlace]:
    """Return the parameters of the job that stand in a table of a job file, by their keys there."""
    return {
        placed.parameter.word or placed.key: placed
        for placed in declared_of(Job).values()
        if placed.parameter.table == table
    }


TOOL_KEYS: dict[str, Callable[[Any], Any]] = {key: reader_of(placed) for key, placed in declared_of(Tool).items()}
"""Keys of a [[tool]], and how each is read."""

ORIGIN_HELP = (
    "work origin: drawing (its own zero, default), lower-left or centre (of the stock); "
    "add ,bottom for Z 0 at the stock's underside rather than its top, such as centre,bottom"
)


def read_units(text: str) -> Units:
    """Return units by name: mm, in, cm, m, ft, um."""
    return one_of(text, UNITS, "unit")


def read_out_units(text: str) -> Units:
    """Return the units of an NC program by name: mm or in."""
    return one_of(text, OUT_UNITS, "unit of an NC program")


class StatedOrigin(NamedTuple):
    """A work origin as far as it is stated.

    Attributes:
        xy: in the plane. z: along Z; each None where nobody has said it.
    """

    xy: OriginXY | None = None
    z: OriginZ | None = None


def parse_origin(text: str) -> StatedOrigin:
    """Return the work origin that a text such as `centre,bottom`, `lower-left` or `bottom` names; None = not said.

    Raises:
        InputError: a word is no origin, or a second one of its sort.
    """
    xy: OriginXY | None = None
    z: OriginZ | None = None
    for said in text.split(","):
        if said.strip().lower() in ORIGIN_Z and z is None:
            z = one_of(said, ORIGIN_Z, "height of the origin")
        elif said.strip().lower() in ORIGIN_XY and xy is None:
            xy = one_of(said, ORIGIN_XY, "origin in the plane")
        else:
            raise InputError(
                f"'{text}' is no origin; use one of drawing, lower-left, centre, and then ,top or ,bottom if need be"
            )
    return StatedOrigin(xy, z)


@dataclass(frozen=True)
class JobFile:
    """What a job file says.

    Attributes:
        job: with an empty part.
        units: of a drawing that names none, or None.
        tables: that are in the file; what belongs to others has its default.
        rules: what is done on layers of any drawing; they make operations behind those of the job.
        proposes_feeds: whether tools are to get the speed and the feeds that are proposed for the stock's material.
        drawn_depths: whether shapes are to be cut to the depths that the drawing tells of them.
    """

    job: Job
    units: Units | None
    tables: frozenset[str] = frozenset()
    proposes_feeds: bool = False
    rules: tuple[LayerRule, ...] = ()
    drawn_depths: bool = False


def read_job(name: str, data: bytes) -> JobFile:
    """Return the job that a TOML text describes; what it leaves out takes its default.

    Args:
        name: shown in errors.
        data: the file's bytes, UTF-8.

    Raises:
        InputError: `name:line: key …`, what is wrong and what is expected.
    """
    text, tree = job_tree(name, data, "job.toml")
    return read_job_tables(text, tree)


class JobTree(NamedTuple):
    """A TOML file read: its text, which places are told by, and its tables."""

    text: JobText
    tables: dict[str, Any]


def job_tree(name: str, data: bytes, sample: str) -> JobTree:
    """Return the text and the tables of a TOML file; `sample` shows how such a file is written.

    Raises:
        InputError: it is none.
    """
    try:
        text = data.decode("utf-8-sig")
        tree = parsed(text)
    except UnicodeDecodeError as error:
        raise InputError(f"{name}: byte {error.start} is no UTF-8; save the file as UTF-8 text") from error
    except (ValueError, RecursionError) as error:
        raise InputError(
            f"{name}:{with_line(brief(str(error)), text)}; correct it as resources/samples/{sample} shows"
        ) from error
    return JobTree(JobText(name, tuple(text.splitlines())), tree)


def read_job_tables(text: JobText, tree: dict[str, Any]) -> JobFile:
    """Return the job of a file's tables.

    Raises:
        InputError: as `read_job`.
    """
    return _JobReader(text, tree).job_file()


def read_kept_job(text: JobText, tree: dict[str, Any]) -> Job:
    """Return the job of tables that `formats.job.write` has written, with an empty part; it may not be fit to be
    computed yet.

    Raises:
        InputError: as `read_job`.
    """
    return _JobReader(text, tree, kept=True).job_file().job


def with_line(message: str, text: str) -> str:
    """Turn tomllib's `… (at line 3, column 4)` into `3: …, column 4`."""
    match = re.fullmatch(r"(.*) \(at line (\d+), (column \d+)\)", message)
    if match:
        return f"{match[2]}: {match[1]}, {match[3]}"
    return f"{text.count(chr(10)) + 1}: {message.removesuffix(' (at end of document)')}"


_BEFORE, _BEHIND = {"drawing": ("units",)}, {"stock": ("feeds",), "drawing": ("depths",)}
"""Keys that stand beside the job's parameters in its tables: what is asked for when a job is made of the file."""


class _JobReader:
    """Reads the tables of one file; every error names the line."""

    def __init__(self, text: JobText, tree: dict[str, Any], kept: bool = False) -> None:
        """Begin with a file's tables; `kept`: as the program keeps them, also where they have no effect or lack
        something.
        """
        self._text, self._tree, self._kept = text, tree, kept

    def _wrong(self, table: str, text: str) -> InputError:
        return InputError(f"{self._text.name}:{self._text.line('', 0, table)}: {table} {text}")

    def _table(self, path: str) -> JobTable:
        values = self._tree.get(path, {})
        if not isinstance(values, dict):
            raise self._wrong(path, f"is a table; write [{path}] and its keys below")
        return JobTable(self._text, path, 0, values)

    def _tables(self, path: str) -> list[JobTable]:
        values = self._tree.get(path, [])
        if not isinstance(values, list) or not all(isinstance(each, dict) for each in values):
            raise self._wrong(path, f"is a list of tables; write [[{path}]] before each")
        return [JobTable(self._text, path, index, each) for index, each in enumerate(values)]

    def job_file(self) -> JobFile:
        """Return everything that the file says."""
        for key in self._tree:
            if key not in (*TABLES, _RULES):
                raise self._wrong(key, f"is no table of a job file; use {', '.join((*TABLES, _RULES))}")
        tables = {path: self._settings(path) for path in SETTINGS if path != "copies"}
        self._check_drawing(tables["drawing"])
        self._check_keep_out(tables["keep_out"])
        values = {key: value for table in tables.values() for key, value in table.taken.items()}
        units = values.pop("units", None)
        proposes, depths = values.pop("feeds", False), values.pop("depths", False)
        if proposes and not values.get("material"):
            raise tables["stock"].error("feeds", "needs a material; add material = 'aluminium', or take it out")
        job = self._text.built("stock", 0, lambda: with_values(Job(Part()), values))
        tools, operations = self._tool_list(), tuple(operations_of(self._tables("operation"), self._kept))
        tools = tools if "tool" in self._tree and (tools or self._kept) else job.tools
        rules = tuple(self._rules())
        ruled = "operation" in self._tree and (operations or self._kept)
        operations = operations if ruled or rules else job.operations
        copies = self._settings("copies")
        self._check_copies(copies)
        job = self._text.built("copies", 0, lambda: with_values(job, copies.taken))
        job = replace(job, tools=tools, operations=operations)
        for index, operation in enumerate(operations if "operation" in self._tree and not self._kept else ()):
            self._text.built("operation", index, lambda each=operation: job.cutter(each))  # type: ignore[misc]
        for index, rule in enumerate(rules):
            self._text.built("layer", index, lambda each=rule.operation: job.cutter(each))  # type: ignore[misc]
        return JobFile(job, units, frozenset(self._tree), proposes, rules, depths)

    def _rules(self) -> Iterator[LayerRule]:
        """Yield what is done on layers: an operation each, without curves."""
        tables = self._tables(_RULES)
        told: list[dict[str, Any]] = []
        for table in tables:
            for key in ("curves", "layers"):
                if key in table.values:
                    raise table.error(
                        key, "has no effect in a [[layer]], which says so by name and colour; take it out"
                    )
            table.take("name", read_text)
            table.take("colour", read_text)
            if table.values.get("depth") == "name":
                table.taken["depth_in_name"] = bool(table.values.pop("depth"))
            told.append(dict(table.taken))
            table.taken.clear()
        for index, (operation, values) in enumerate(zip(operations_of(tables, self._kept), told, strict=True)):
            yield self._text.built("layer", index, lambda op=operation, more=values: LayerRule(op, **more))  # type: ignore[misc]

    def _settings(self, path: str) -> JobTable:
        """Return a table of the job's parameters, its keys taken by those of the parameters."""
        table, declared = self._table(path), settings_of(path)
        if path == "drawing":
            table.take("units", word(UNITS, "unit"))
            table.take("depths", word(DEPTHS, "source of depths"))
        if path == "stock":
            table.take("feeds", word(FEEDS, "source of speeds and feeds"))
        for key, placed in declared.items():
            known = WORDS.get(placed.key)
            table.take(key, word(known.words, known.what) if known else reader_of(placed), placed.key)
        table.done(", ".join((*_BEFORE.get(path, ()), *declared, *_BEHIND.get(path, ()))))
        return table

    def _check_drawing(self, table: JobTable) -> None:
        if not 0 <= table.taken.get("join_tolerance", 0.0) < 1e5:
            raise table.error("join_tolerance", "must be 0 or more, in mm")

    def _check_copies(self, table: JobTable) -> None:
        for key, count in (("dx", "columns"), ("dy", "rows")):
            if table.taken.get(key) and table.taken.get(count, 1) == 1 and not self._kept:
                raise table.error(key, f"has no effect without {count}; add {count} = 2, or take it out")

    def _check_keep_out(self, table: JobTable) -> None:
        if table.taken.get("keep_out_height") and not table.taken.get("keep_out_layers") and not self._kept:
            raise table.error("height", "has no effect without layers; add layers = ['clamps'], or take it out")
        if not 0 <= table.taken.get("keep_out_height", 0.0) < 1e5:
            raise table.error("height", "must be 0 or more and less than 100000, in mm above the stock's top")

    def _tool_list(self) -> tuple[Tool, ...]:
        tools: list[Tool] = []
        for index, table in enumerate(self._tables("tool")):
            for key, read in TOOL_KEYS.items():
                table.take(key, read)
            table.done(", ".join(TOOL_KEYS))
            for key in ("number", "diameter"):
                if key not in table.taken:
                    raise table.error(key, f"is missing in this [[tool]]; add {key} = …")
            tool = self._text.built("tool", index, lambda taken=table.taken: Tool(**taken))  # type: ignore[misc]
            if any(other.number == tool.number for other in tools) and not self._kept:
                raise table.error("number", f"{tool.number} is taken by another tool; give each its own")
            tools.append(tool)
        return tuple(tools)
