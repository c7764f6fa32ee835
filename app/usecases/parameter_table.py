"""The manual's tables of all parameters of operations and of tools, from their declarations."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import MISSING

from ..core.toml_tables import Keyword
from ..model.fields import ParameterPlace, Unit, declared_of
from ..model.operation import Operation
from ..model.operation_kinds import parameters
from ..model.tool import Tool

HEAD = """# Parameters of operations

Each stands in a job file under its key, on the command line as its option, in the window under its name,
and in every program's header.

| Key | Option | Name | What it means | Values | Default | Of |
|---|---|---|---|---|---|---|
"""

TOOLS = """
# Parameters of tools

Each stands in a job file and in a tool library under its key, and in a spreadsheet as a column. What is 0 or empty is
not known.

| Key | Name | What it means | Values | Default |
|---|---|---|---|---|
"""


def parameter_table() -> str:
    """Return the page in Markdown; `resources/docs/parameters.md` is this text."""
    operations = (_cells(placed, kinds) for placed, kinds in parameters().values())
    tools = (_tool_cells(placed) for placed in declared_of(Tool).values())
    return HEAD + "".join(map(_row, operations)) + TOOLS + "".join(map(_row, tools))


def _row(cells: Iterator[str]) -> str:
    return f"| {' | '.join(cells)} |\n"


def _tool_cells(placed: ParameterPlace) -> Iterator[str]:
    declared = placed.parameter
    yield f"`{declared.key}`"
    yield declared.label
    yield declared.help
    yield _values(placed)
    yield "" if placed.default is MISSING else _default(placed)


def _cells(placed: ParameterPlace, kinds: tuple[type[Operation], ...]) -> Iterator[str]:
    declared = placed.parameter
    yield f"`{declared.key}`"
    yield f"`--{declared.option}`" if declared.option else ""
    yield declared.label
    yield declared.help + (f"; with {declared.needs.with_}" if declared.needs else "")
    yield _values(placed)
    yield _default(placed)
    yield ", ".join(kind.WORD for kind in kinds)


def _values(placed: ParameterPlace) -> str:
    declared = placed.parameter
    if placed.enum is not None:
        return ", ".join(str(each.value) for each in placed.enum)
    if isinstance(placed.default, Keyword):
        return ", ".join(placed.default.words())
    words = {
        Unit.FLAG: "true, false",
        Unit.NAMES: "names",
        Unit.CURVES: "selectors",
        Unit.POINTS: "points [x, y], mm",
        Unit.TEXT: "text",
        Unit.OUTLINE: "points [height, radius], mm, or a name",
        Unit.FEEDS: "rows of material, surface_speed, feed_per_tooth, plunge_share",
    }
    return words.get(declared.unit) or declared.range_words()


def _default(placed: ParameterPlace) -> str:
    declared, value = placed.parameter, placed.default
    if placed.enum is not None or isinstance(value, Keyword):
        return str(value.value)
    if value is None:
        return declared.auto
    if declared.unit is Unit.FLAG:
        return str(value).lower()
    if isinstance(value, int | float):
        return f"{declared.shown(value):g}{declared.sign}"
    return "none" if value == () else ""
