"""Tools as a spreadsheet: one row a tool, a header row that names each column and its unit, `diameter_mm`.

Columns are parted by commas with decimal points, or by semicolons or tabs with decimal commas or points: as
spreadsheets write them. What a material's feeds are stands in three columns, `aluminium: surface_speed_m_min` and so
on. Lengths may be inches ("diameter_in"), feed rates inches a minute; a column without a unit is mm, mm/min, rpm or
degrees.
"""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

from ...core.errors import MOST_QUOTED, HitofudeError, InputError, printable
from ...core.toml_tables import QUOTED, brief
from ...core.wording import together
from ...model.fields import Unit, declared_of
from ...model.tool import FeedRow, HolderPoint, Tool, ToolMaterial
from ...model.tool_kind import ToolKind, tool_kinds
from .holders import outline_of
from .library import ReadTools, ToolLibrary, check_numbers, shortest_degrees

LENGTH = {"mm": 1.0, "in": 25.4, "inch": 25.4, "": 1.0}
RATE = {"mm_min": 1.0, "in_min": 25.4, "ipm": 25.4, "": 1.0}
_BY_UNIT = {
    Unit.LENGTH: LENGTH,
    Unit.SPEED: {"rpm": 1.0, "": 1.0},
    Unit.RATE: RATE,
    Unit.ANGLE: {"deg": math.pi / 180, "": math.pi / 180},
    Unit.OUTLINE: {"mm": 1.0, "": 1.0},
}
DECLARED = {key: placed.parameter.unit for key, placed in declared_of(Tool).items() if key != "feeds"}
UNITS: dict[str, dict[str, float]] = {
    key: _BY_UNIT.get(DECLARED[key], {"": 1.0}) for key in dict.fromkeys(("number", "name", "kind", *DECLARED))
}
"""The columns of tools, and the units that may stand behind their names."""

FEED_UNITS: dict[str, dict[str, float]] = {
    "surface_speed": {"m_min": 1.0, "": 1.0},
    "feed_per_tooth": LENGTH,
    "plunge_share": {"": 1.0},
}
ALSO = {
    "t": "number",
    "tool": "number",
    "tool_number": "number",
    "no": "number",
    "nr": "number",
    "dia": "diameter",
    "type": "kind",
    "description": "name",
    "comment": "remark",
    "teeth": "flutes",
    "speed": "spindle_speed",
    "rpm": "spindle_speed",
    "feed": "feed_rate",
    "plunge": "plunge_rate",
}
TEXTS = ("name", "kind", "tool_material", "remark", "holder")
COMMA = re.compile(r"[+-]?(\d{1,3}(\.\d{3})+|\d+),\d+")
THOUSANDS = re.compile(r"[+-]?\d{1,3}(\.\d{3})+")


@dataclass(frozen=True, slots=True)
class _Column:
    """What a column holds: a field of `Tool`, or with a material one of `FeedRow`; `unit` makes it mm, radians and so
    on.
    """

    field: str
    unit: float = 1.0
    material: str = ""


def read_tool_csv(name: str, data: bytes) -> ReadTools:
    """Return the tools of a spreadsheet; columns that it does not know are left out.

    Args:
        name: of the file, for sentences.
        data: its bytes: UTF-8, UTF-16 with its mark, or Latin-1.

    Raises:
        InputError: file, line and column, what is wrong and what is expected.
    """
    text = _text(data)
    rows = _rows(name, text)
    if not rows:
        raise InputError(
            f"{name}: the file is empty; its first row must name the columns, such as number, diameter_mm, kind."
        )
    header = [cell.strip() for cell in rows[0].cells]
    columns = [_column(cell) for cell in header]
    found = [column.field for column in columns if column and not column.material]
    for field in ("number", "diameter"):
        if found.count(field) != 1:
            raise InputError(
                f"{name}:{rows[0].line}: there must be one column named {field}{'_mm' * (field == 'diameter')}, "
                f"and there {'is none' if field not in found else 'are several'}."
            )
    spreadsheet = _Spreadsheet(name, header, columns, _decimal_comma(columns, rows))
    tools = tuple(spreadsheet.tool(line, cells) for line, cells in rows[1:] if any(cell.strip() for cell in cells))
    check_numbers(name, tools)
    passed = tuple(
        printable(f"{name}: column '{brief(cell, QUOTED)}' is none of a tool and is passed over.")
        for cell, column in zip(header, columns, strict=True)
        if column is None and cell
    )
    return ReadTools(ToolLibrary("", tools), passed)


def _text(data: bytes) -> str:
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return data.decode("utf-16", errors="replace")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("latin-1")


class _SheetRow(NamedTuple):
    """Cells of a row, and its 1-based line."""

    line: int
    cells: list[str]


def _rows(name: str, text: str) -> list[_SheetRow]:
    """Return the rows that hold anything."""
    first = next((line for line in text.splitlines() if line.strip()), "")
    outside = re.sub(r'"[^"]*"', "", first)
    mark = max(",;\t", key=outside.count)
    reader = csv.reader(io.StringIO(text.replace("\x00", ""), newline=""), delimiter=mark)
    try:
        return [_SheetRow(reader.line_num, cells) for cells in reader if any(cell.strip() for cell in cells)]
    except csv.Error as error:
        raise InputError(
            f"{name}:{reader.line_num}: this is no row of a spreadsheet ({str(error)[:MOST_QUOTED]}); save it as CSV "
            "again."
        ) from error


def _column(header: str) -> _Column | None:
    """Return what a column's header names; None where it is nothing of a tool."""
    material, _, title = header.rpartition(":")
    known = FEED_UNITS if material else UNITS
    key = re.sub(r"[^a-z0-9]+", "_", title.lower()).strip("_")
    for field in sorted((*known, *(() if material else ALSO)), key=len, reverse=True):
        unit = key[len(field) :].lstrip("_") if key == field or key.startswith(f"{field}_") else None
        name = field if field in known else ALSO[field]
        if unit is not None and unit in known[name]:
            return _Column(name, known[name][unit], material.strip())
    return None


def _decimal_comma(columns: list[_Column | None], rows: list[_SheetRow]) -> bool:
    """Tell whether numbers have decimal commas: one that can be nothing else shows it for the whole file."""
    cells = (
        cell
        for _, row in rows[1:]
        for column, cell in zip(columns, row, strict=False)
        if column and column.field not in TEXTS
    )
    return any(COMMA.fullmatch(re.sub(r"\s", "", cell)) for cell in cells)


@dataclass(frozen=True)
class _Spreadsheet:
    """A file whose columns are known."""

    name: str
    header: list[str]
    columns: list[_Column | None]
    decimal_comma: bool

    def tool(self, line: int, cells: list[str]) -> Tool:
        """Return the tool of a row."""
        values: dict[str, Any] = {}
        feeds: dict[str, dict[str, Any]] = {}
        for header, column, cell in zip(self.header, self.columns, cells, strict=False):
            if column is None or not cell.strip():
                continue
            into = feeds.setdefault(column.material, {"material": column.material}) if column.material else values
            into[column.field] = self._value(column, cell.strip(), f"{self.name}:{line}: {brief(header, QUOTED)}")
        place = f"{self.name}:{line}"
        for field in ("number", "diameter"):
            if field not in values:
                raise InputError(f"{place}: the row has no {field}; fill it in, or empty the whole row.")
        made: Tool = _built(lambda: Tool(**values, feeds=tuple(_feed_row(row) for row in feeds.values())), place)
        return made

    def _value(self, column: _Column, cell: str, place: str) -> Any:
        unit = DECLARED.get(column.field)
        if unit is Unit.TEXT:
            return cell
        if column.field == "tool_material":
            return _built(lambda: _tool_material(cell), place)
        if unit is Unit.CHOICE:
            return _built(lambda: _kind(cell), place)
        if unit is Unit.OUTLINE:
            return _built(lambda: _holder(cell), place)
        number = self._number(cell, place)
        if unit is Unit.COUNT:
            if number != int(number):
                raise InputError(f"{place} is {brief(cell, QUOTED)}; it must be a whole number.")
            return int(number)
        return number * column.unit

    def _number(self, cell: str, place: str) -> float:
        plain = re.sub(r"[\s'\u202f]", "", cell)
        if self.decimal_comma:
            if "." in plain and "," not in plain and not THOUSANDS.fullmatch(plain):
                raise InputError(
                    f"{place} is {brief(cell, QUOTED)}, but other numbers of this file have decimal commas; "
                    "use one sign throughout."
                )
            plain = plain.replace(".", "").replace(",", ".")
        try:
            number = float(plain)
        except ValueError as error:
            raise InputError(f"{place} is '{brief(cell, QUOTED)}'; it must be a number, such as 6.35.") from error
        if not math.isfinite(number):
            raise InputError(f"{place} is {brief(cell, QUOTED)}; it must be a number, such as 6.35.")
        return number


def _built(make: Callable[[], Any], place: str) -> Any:
    """Return what `make` makes; its error gets the place."""
    try:
        return make()
    except HitofudeError as error:
        raise InputError(f"{place}: {error}") from error


def _feed_row(values: dict[str, Any]) -> FeedRow:
    missing = [field for field in ("surface_speed", "feed_per_tooth") if field not in values]
    if missing:
        raise InputError(
            f"the feeds for {brief(values['material'], QUOTED)} lack {together(missing)}; fill it in, or empty the "
            "others."
        )
    return FeedRow(**values)


def _kind(cell: str) -> ToolKind:
    whole = cell.lower().strip()
    words = {whole, whole.removesuffix("mill").strip(" -_")}
    found = next((kind for kind in tool_kinds() if not words.isdisjoint((kind.value, *kind.aliases))), None)
    if found is None:
        raise InputError(f"'{brief(cell, QUOTED)}' is no kind of tool; use {', '.join(ToolKind.words())}.")
    return found


def _tool_material(cell: str) -> ToolMaterial:
    try:
        return ToolMaterial(cell.lower().strip())
    except ValueError as error:
        known = ", ".join(each.value for each in ToolMaterial)
        raise InputError(f"'{brief(cell, QUOTED)}' is nothing that edges are made of; use {known}.") from error


def _holder(cell: str) -> tuple[HolderPoint, ...]:
    """Return the outline that a text such as "0 x 10; 25 x 10" is, or that a name such as "ER20" has."""
    if re.search(r"[A-Za-z]{2}", cell):
        return outline_of(cell)
    points = re.findall(r"\s*([\d.eE+-]+)\s*x\s*([\d.eE+-]+)\s*(?:;|$)", cell)
    try:
        made = tuple((float(height), float(radius)) for height, radius in points)
    except ValueError:
        made = ()
    if not made or len(made) != cell.count("x"):
        raise InputError(f"'{cell}' is no holder; write height x radius for each point, such as 0 x 10; 25 x 10.")
    return made


def write_tool_csv(library: ToolLibrary, mark: str = ",") -> bytes:
    """Return a spreadsheet from which `read_tool_csv` makes the same tools; what is not known is an empty cell.

    Args:
        library: whose tools to write.
        mark: between columns; with a semicolon numbers have decimal commas, as spreadsheets of such countries want it.

    Raises:
        InputError: two tools have the same number.
    """
    check_numbers(library.name or "tool library", library.tools)
    materials = list(dict.fromkeys(row.material for tool in library.tools for row in tool.feeds))
    names = {field: f"{field}_{next(iter(units))}".rstrip("_") for field, units in (UNITS | FEED_UNITS).items()}
    text = io.StringIO(newline="")
    table = csv.writer(text, delimiter=mark, lineterminator="\r\n")
    table.writerow(
        [
            *(names[field] for field in UNITS),
            *(f"{material}: {names[field]}" for material in materials for field in FEED_UNITS),
        ]
    )
    for tool in library.tools:
        feeds = {row.material: row for row in tool.feeds}
        cells = [_cell(tool, field) for field in UNITS]
        cells += [
            getattr(feeds[material], field) if material in feeds else ""
            for material in materials
            for field in FEED_UNITS
        ]
        table.writerow(
            [
                repr(cell).replace(".", "," if mark == ";" else ".") if isinstance(cell, float) else cell
                for cell in cells
            ]
        )
    return text.getvalue().encode("utf-8-sig")


def _cell(tool: Tool, field: str) -> str | int | float:
    """Return what stands in a tool's cell."""
    value = getattr(tool, field)
    if field == "holder":
        return "; ".join(f"{height!r} x {radius!r}" for height, radius in tool.holder)
    if field == "kind":
        return tool.kind.value
    if field == "tool_material":
        return "" if tool.tool_material is ToolMaterial.UNKNOWN else tool.tool_material.value
    if field == "tip_angle" and value:
        return shortest_degrees(value)
    if value == 0:
        return ""
    return value if DECLARED[field] in (Unit.COUNT, Unit.TEXT) else float(value)
