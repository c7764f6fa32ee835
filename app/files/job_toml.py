"""Job files: tools, operations, stock and origin as TOML; resources/samples/job.toml shows and explains every key."""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, TypeVar

from app.errors import HitofudeError, InputError
from app.model.job import Job, OriginXY, OriginZ, Stock
from app.model.operation import ContourOperation, Cut, Direction, Operation, Order, PocketOperation
from app.model.part import Part, Units
from app.model.tool import Tool, ToolKind

UNITS = {"mm": Units.MM, "in": Units.INCH, "inch": Units.INCH, "cm": Units.CM, "m": Units.M, "ft": Units.FOOT, "um": Units.MICRON}
OUT_UNITS = {"mm": Units.MM, "in": Units.INCH, "inch": Units.INCH}
ORIGIN_XY = {"drawing": OriginXY.DRAWING, "lower-left": OriginXY.LOWER_LEFT, "centre": OriginXY.CENTRE, "center": OriginXY.CENTRE}
ORIGIN_Z = {"top": OriginZ.TOP, "bottom": OriginZ.BOTTOM}
ORIGIN_HELP = ("work origin: drawing (its own zero, default), lower-left or centre (of the stock); "
               "add ,bottom for Z 0 at the stock's underside rather than its top, such as centre,bottom")

Value = TypeVar("Value")
_MISSING = object()


def one_of(text: str, choices: Mapping[str, Value], what: str) -> Value:
    """Return what a word stands for.

    Raises:
        InputError: the word is none of the choices; it names them.
    """
    try:
        return choices[text.strip().lower()]
    except KeyError as error:
        raise InputError(f"'{text}' is no {what}; use {' or '.join(choices)}") from error


def read_units(text: str) -> Units:
    """Return units by name: mm, in, cm, m, ft, um."""
    return one_of(text, UNITS, "unit")


def read_out_units(text: str) -> Units:
    """Return the units of an NC program by name: mm or in."""
    return one_of(text, OUT_UNITS, "unit of an NC program")


def parse_origin(text: str) -> tuple[OriginXY | None, OriginZ | None]:
    """Return the work origin that a text such as `centre,bottom`, `lower-left` or `bottom` names; None = not said.

    Raises:
        InputError: a word is no origin, or a second one of its sort.
    """
    xy: OriginXY | None = None
    z: OriginZ | None = None
    for word in text.split(","):
        if word.strip().lower() in ORIGIN_Z and z is None:
            z = one_of(word, ORIGIN_Z, "height of the origin")
        elif word.strip().lower() in ORIGIN_XY and xy is None:
            xy = one_of(word, ORIGIN_XY, "origin in the plane")
        else:
            raise InputError(f"'{text}' is no origin; use one of drawing, lower-left, centre, and then ,top or ,bottom if need be")
    return xy, z


@dataclass(frozen=True)
class JobFile:
    """What a job file says.

    Attributes:
        job: with an empty part.
        units: of a drawing that names none, or None.
        tables: that are in the file; what belongs to others has its default.
    """

    job: Job
    units: Units | None
    tables: frozenset[str] = frozenset()


def read_job(name: str, data: bytes) -> JobFile:
    """Return the job that a TOML text describes; what it leaves out takes its default.

    Args:
        name: shown in errors.
        data: the file's bytes, UTF-8.

    Raises:
        InputError: `name:line: key …`, what is wrong and what is expected.
    """
    try:
        text = data.decode("utf-8-sig")
        tree = tomllib.loads(text)
    except UnicodeDecodeError as error:
        raise InputError(f"{name}: byte {error.start} is no UTF-8; save the job file as UTF-8 text") from error
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise InputError(f"{name}:{_with_line(str(error), text)}; correct it as resources/samples/job.toml shows") from error
    return _Reader(name, text, tree).job_file()


def _with_line(message: str, text: str) -> str:
    """Turn tomllib's `… (at line 3, column 4)` into `3: …, column 4`."""
    match = re.fullmatch(r"(.*) \(at line (\d+), (column \d+)\)", message)
    if match:
        return f"{match[2]}: {match[1]}, {match[3]}"
    return f"{text.count(chr(10)) + 1}: {message.removesuffix(' (at end of document)')}"


class _Table:
    """One table of the file: its keys are taken one by one, and what is left over is an error."""

    def __init__(self, reader: _Reader, path: str, index: int, values: dict[str, Any]) -> None:
        self._reader, self._path, self._index, self._values = reader, path, index, dict(values)
        self.taken: dict[str, Any] = {}

    def error(self, key: str, text: str) -> InputError:
        """Return an error at the line of a key."""
        line = self._reader.line(self._path, self._index, key)
        return InputError(f"{self._reader.name}:{line}: {key} {text}")

    def take(self, key: str, read: Callable[[Any], Any], target: str = "") -> None:
        """Read a key, where the table has it, into `taken`."""
        value = self._values.pop(key, _MISSING)
        if value is _MISSING:
            return
        try:
            self.taken[target or key] = read(value)
        except (InputError, TypeError, ValueError) as error:
            raise self.error(key, f"is {_shown(value)}: {error}") from error

    def done(self, known: str) -> None:
        """Complain about keys that nobody took."""
        for key in self._values:
            raise self.error(key, f"is no key of [{self._path or 'the file'}]; use {known}")


def _shown(value: object) -> str:
    return f"'{value}'" if isinstance(value, str) else str(value).lower() if isinstance(value, bool) else f"{value}"


def _number(value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise InputError("it must be a number, in mm, mm/min or rpm")
    return float(value)


def _whole(value: Any) -> int:
    if isinstance(value, bool) or not isinstance(value, int):
        raise InputError("it must be a whole number")
    return value


def _flag(value: Any) -> bool:
    if not isinstance(value, bool):
        raise InputError("it must be true or false")
    return value


def _text(value: Any) -> str:
    if not isinstance(value, str):
        raise InputError("it must be a text in quotes")
    return value


def _texts(value: Any) -> tuple[str, ...]:
    if not isinstance(value, list):
        raise InputError('it must be a list of texts, such as ["outline"]')
    return tuple(_text(item) for item in value)


def _word(choices: Mapping[str, Value], what: str) -> Callable[[Any], Value]:
    return lambda value: one_of(_text(value), choices, what)


class _Reader:
    """Reads the tables of one file; every error names the line."""

    def __init__(self, name: str, text: str, tree: dict[str, Any]) -> None:
        self.name, self._lines, self._tree = name, text.splitlines(), tree

    def line(self, path: str, index: int, key: str) -> int:
        """Return the 1-based line of a key in the index-th table of this path, or of its header."""
        current, count, header = "", -1, 1
        for number, text in enumerate(self._lines, 1):
            if match := re.match(r"\s*\[+\s*([\w.\"-]+)\s*\]+", text):
                current = match[1]
                count += current == path
                if current == path and count == index:
                    header = number
            elif current == path and (not path or count == index) and re.match(rf"\s*[\"']?{re.escape(key)}[\"']?\s*=", text):
                return number
        return header if path else next((n for n, text in enumerate(self._lines, 1) if key in text), 1)

    def _table(self, path: str) -> _Table:
        values = self._tree.get(path, {})
        if not isinstance(values, dict):
            raise InputError(f"{self.name}:{self.line('', 0, path)}: {path} is a table; write [{path}] and its keys below")
        return _Table(self, path, 0, values)

    def _tables(self, path: str) -> list[_Table]:
        values = self._tree.get(path, [])
        if not isinstance(values, list) or not all(isinstance(each, dict) for each in values):
            raise InputError(f"{self.name}:{self.line('', 0, path)}: {path} is a list of tables; write [[{path}]] before each")
        return [_Table(self, path, index, each) for index, each in enumerate(values)]

    def job_file(self) -> JobFile:
        """Return everything that the file says."""
        known = ("stock", "origin", "heights", "drawing", "output", "tool", "operation")
        for key in self._tree:
            if key not in known:
                raise InputError(f"{self.name}:{self.line('', 0, key)}: {key} is no table of a job file; use {', '.join(known)}")
        values: dict[str, Any] = {**self._origin(), **self._heights(), **self._output()}
        drawing = self._drawing()
        units = drawing.pop("units", None)
        job = self._built("stock", 0, lambda: replace(Job(Part()), **values, **drawing, **self._stock()))
        tools, operations = self._tool_list(job), self._operation_list(job)
        job = replace(job, tools=tools, operations=operations)
        for index, operation in enumerate(operations if "operation" in self._tree else ()):
            self._built("operation", index, lambda number=operation.cut.tool: job.tool(number))  # type: ignore[misc]
        return JobFile(job, units, frozenset(self._tree))

    def _built(self, path: str, index: int, build: Callable[[], Value]) -> Value:
        """Return a value built from a table; a value out of its range names the table's line."""
        try:
            return build()
        except InputError:
            raise
        except HitofudeError as error:
            raise InputError(f"{self.name}:{self.line(path, index, '')}: {error}") from error

    def _stock(self) -> dict[str, Any]:
        table = self._table("stock")
        table.take("margin", _number)
        table.take("thickness", _number)
        table.done("margin, thickness")
        return {"stock": Stock(**table.taken)}

    def _origin(self) -> dict[str, Any]:
        table = self._table("origin")
        table.take("xy", _word(ORIGIN_XY, "origin in the plane"), "origin_xy")
        table.take("z", _word(ORIGIN_Z, "height of the origin"), "origin_z")
        table.done("xy, z")
        return table.taken

    def _heights(self) -> dict[str, Any]:
        table = self._table("heights")
        table.take("safe_z", _number)
        table.take("retract_z", _number)
        table.done("safe_z, retract_z")
        return table.taken

    def _drawing(self) -> dict[str, Any]:
        table = self._table("drawing")
        table.take("units", _word(UNITS, "unit"))
        table.take("layers", _texts, "layer_names")
        table.take("join_tolerance", _number)
        table.done("units, layers, join_tolerance")
        if not 0 <= table.taken.get("join_tolerance", 0.0) < 1e5:
            raise table.error("join_tolerance", "must be 0 or more, in mm")
        return table.taken

    def _output(self) -> dict[str, Any]:
        table = self._table("output")
        table.take("post", _text)
        table.take("units", _word(OUT_UNITS, "unit of an NC program"), "out_units")
        table.take("order", _word({order.value: order for order in Order}, "order"))
        table.take("exact_path", _flag)
        table.done("post, units, order, exact_path")
        return table.taken

    def _tool_list(self, job: Job) -> tuple[Tool, ...]:
        tools: list[Tool] = []
        for index, table in enumerate(self._tables("tool")):
            table.take("number", _whole)
            for key in ("diameter", "spindle_speed", "feed_rate", "plunge_rate", "corner_radius", "tip_diameter"):
                table.take(key, _number)
            table.take("tip_angle", lambda value: math.radians(_number(value)))
            table.take("kind", _word({kind.value: kind for kind in ToolKind}, "kind of tool"))
            table.take("name", _text)
            table.take("flutes", _whole)
            table.done("number, diameter, kind, name, flutes, spindle_speed, feed_rate, plunge_rate, "
                       "corner_radius, tip_diameter, tip_angle")
            for key in ("number", "diameter"):
                if key not in table.taken:
                    raise table.error(key, f"is missing in this [[tool]]; add {key} = …")
            tool = self._built("tool", index, lambda taken=table.taken: Tool(**taken))  # type: ignore[misc]
            if any(other.number == tool.number for other in tools):
                raise table.error("number", f"{tool.number} is taken by another tool; give each its own")
            tools.append(tool)
        return tuple(tools) or job.tools

    def _operation_list(self, job: Job) -> tuple[Operation, ...]:
        operations = []
        for index, table in enumerate(self._tables("operation")):
            table.take("kind", _word({"pocket": PocketOperation, "contour": ContourOperation}, "kind of operation"))
            table.take("tool", _whole)
            for key in ("depth", "stepdown", "stock_to_leave"):
                table.take(key, _number)
            table.take("direction", _word({each.value: each for each in Direction}, "direction"))
            table.take("enabled", _flag)
            table.take("stepover", _number)
            table.done("kind, tool, depth, stepdown, stepover, stock_to_leave, direction, enabled")
            for key in ("kind", "tool"):
                if key not in table.taken:
                    raise table.error(key, f"is missing in this [[operation]]; add {key} = …")
            kind, stepover = table.taken.pop("kind"), table.taken.pop("stepover", None)
            if kind is ContourOperation and stepover is not None:
                raise table.error("stepover", "belongs to a pocket operation; remove it here")
            operations.append(self._built("operation", index, lambda k=kind, s=stepover, t=table.taken: _operation(k, s, t)))  # type: ignore[misc]
        return tuple(operations) or job.operations


def _operation(kind: type, stepover: float | None, cut: dict[str, Any]) -> Operation:
    return ContourOperation(Cut(**cut)) if kind is ContourOperation else PocketOperation(Cut(**cut), stepover)
